//! What every part of the reader needs: the text with its places, and the warnings so far.

use crate::rod::Warning;
use crate::toml_text::TomlText;

/// What is checked, and what there is to say about it so far.
pub struct Check<'a> {
    pub toml: TomlText<'a>,
    pub warnings: Vec<Warning>,
}

impl Check<'_> {
    /// Warns about a number that is most likely in another unit. Nothing (0) is usual.
    pub fn usual(&mut self, key: &str, value: f64, unit: &'static str, least: f64, most: f64) {
        if value != 0.0 && !(least..=most).contains(&value) {
            self.warnings.push(Warning::Unusual { key: key.to_owned(), value, unit, least, most });
        }
    }
}
