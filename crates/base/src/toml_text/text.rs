//! The text of a TOML file, in which every value knows its place.

use serde::de::DeserializeOwned;
use toml::Spanned;

use crate::delimited::visible;
use crate::error::{Error, Place, Result};
use crate::expression::Fault;
use crate::limits;

/// A number that knows where it stands.
pub type Number = Spanned<f64>;

/// What a missing key or `[section]` should have been: pairs of its name and words for a message.
pub type Required = [(&'static str, &'static str)];

/// No quantity of this world is larger, and its fourth power times another still fits a double.
const LARGEST: f64 = 1e30;

/// What is smaller and must not be 0 would be 0 in another unit.
const SMALLEST: f64 = 1e-290;

/// The text of a file, to find the line of whatever is wrong.
#[derive(Debug, Clone, Copy)]
pub struct TomlText<'a> {
    pub(super) file: &'a str,
    pub(super) text: &'a str,
}

impl<'a> TomlText<'a> {
    /// The `text` of `file`, which only names it in errors.
    pub fn new(file: &'a str, text: &'a str) -> Self {
        TomlText { file, text }
    }

    /// The file, as it is named in errors.
    pub fn file(&self) -> &'a str {
        self.file
    }

    /// Reads the whole text; `required` has the words for keys that `T` cannot do without.
    ///
    /// # Errors
    /// [`Error::Input`] or [`Error::Syntax`] with line and column.
    pub fn parse<T: DeserializeOwned>(&self, required: &Required) -> Result<T> {
        limits::check(self.file, self.text.len(), limits::TOML_BYTES, "bytes")?;
        toml::from_str(self.text).map_err(|error| self.reworded(&error, required))
    }

    /// The number, if it is finite and of a size to reckon with.
    ///
    /// # Errors
    /// [`Error::Input`] otherwise; likewise of the next two.
    pub fn finite(&self, key: &str, number: &Number) -> Result<f64> {
        let value = *number.get_ref();
        if !value.is_finite() {
            return Err(self.is(key, number, "a finite number"));
        }
        if value.abs() > LARGEST {
            return Err(self.is(key, number, &format!("a number of at most {LARGEST:e} in size")));
        }
        Ok(value)
    }

    /// The number, if it is above 0.
    pub fn positive(&self, key: &str, number: &Number) -> Result<f64> {
        let value = self.finite(key, number)?;
        match value {
            SMALLEST.. => Ok(value),
            _ if value > 0.0 => Err(self.is(key, number, &format!("a number of at least {SMALLEST:e}"))),
            _ => Err(self.is(key, number, "a number > 0")),
        }
    }

    /// The number, if it is 0 or above.
    pub fn not_negative(&self, key: &str, number: &Number) -> Result<f64> {
        let value = self.finite(key, number)?;
        if value >= 0.0 { Ok(value) } else { Err(self.is(key, number, "a number >= 0")) }
    }

    /// The error that `key` has the value it has.
    pub fn is<T>(&self, key: &str, value: &Spanned<T>, expected: &str) -> Error {
        self.wrong(value, format!("`{key}` is {}", self.source(value)), expected)
    }

    /// The error that something is wrong where `place` stands.
    pub fn wrong<T>(&self, place: &Spanned<T>, found: String, expected: &str) -> Error {
        self.input(place.span().start, found, expected.to_owned(), None)
    }

    /// A fault of a formula, at its own place in the file where the formula stands on one line in
    /// plain quotes.
    pub fn in_formula(&self, formula: &Spanned<String>, fault: Fault) -> Error {
        let span = formula.span();
        let is_plain = self.text.get(span.start + 1..span.end.saturating_sub(1)) == Some(formula.get_ref());
        let offset = if is_plain { span.start + 1 + fault.at } else { span.start };
        self.input(offset, format!("{} in the formula", fault.found), fault.expected, None)
    }

    /// A value as the file has it, cut where it gets long.
    pub fn source<T>(&self, value: &Spanned<T>) -> String {
        cut(self.text.get(value.span()).unwrap_or_default())
    }

    pub(super) fn input(
        &self,
        offset: usize,
        found: String,
        expected: String,
        hint: Option<String>,
    ) -> Error {
        Error::Input { at: Place::of_offset(self.file, self.text, offset), found, expected, hint }
    }
}

/// One line of printable text, of a length that fits a message.
pub(super) fn cut(text: &str) -> String {
    const LONGEST: usize = 40;
    let line = text.trim().lines().next().unwrap_or_default();
    let mut characters = line.chars();
    let mut short: String = characters.by_ref().take(LONGEST).collect();
    if characters.next().is_some() {
        short.push_str(" …");
    }
    visible(&short).into_owned()
}
