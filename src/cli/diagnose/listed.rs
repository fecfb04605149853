//! The effects of a library, for the help.

use rodcal::inference::Effect;

/// A line for each effect: its name, and what happens.
pub fn listed<'a>(effects: impl Iterator<Item = &'a Effect>) -> String {
    effects.map(|effect| format!("  {:<25}  {}\n", effect.name, effect.summary)).collect()
}
