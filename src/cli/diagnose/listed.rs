//! The effects of a library, for the help.

use rodcal::inference::Effect;
use rodcal::report::text::hanging;

/// A line for each effect: its name, and what happens.
pub fn listed<'a>(effects: impl Iterator<Item = &'a Effect>) -> String {
    effects.map(|effect| hanging(&format!("  {:<25}  ", effect.name), effect.summary, usize::MAX)).collect()
}
