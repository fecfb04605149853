//! The parser's messages in the words of somebody who measures rods.
//!
//! What is not recognised here keeps the parser's own words, so that a new version of it can only
//! make messages plainer, never wrong.

use std::ops::Range;

use super::text::{Required, TomlText, cut};
use crate::delimited::nearest_name;
use crate::error::{Error, Place};

impl TomlText<'_> {
    pub(super) fn reworded(&self, error: &toml::de::Error, required: &Required) -> Error {
        let (span, message) = (error.span().unwrap_or(0..0), error.message());
        let known = self
            .unknown_key(message, &span)
            .or_else(|| self.missing_key(message, &span, required))
            .or_else(|| self.wrong_type(message, &span))
            .or_else(|| self.twice(message, &span))
            .or_else(|| self.no_value(message, &span))
            .or_else(|| self.no_statement(message, &span));
        known.unwrap_or_else(|| Error::Syntax {
            at: Place::of_offset(self.file, self.text, span.start),
            message: crate::delimited::message(message),
        })
    }

    fn unknown_key(&self, message: &str, span: &Range<usize>) -> Option<Error> {
        let (name, expected) = message.strip_prefix("unknown field `")?.split_once("`, expected ")?;
        let known: Vec<&str> = expected.split('`').skip(1).step_by(2).collect();
        let (found, is_section) = match self.is_header(span.start) {
            true => (format!("unknown section [{}]", cut(name)), true),
            false => (format!("unknown key `{}`", cut(name)), false),
        };
        let hint = match nearest_name(name, &known) {
            Some(near) if is_section => Some(format!("did you mean [{near}]?")),
            Some(near) => Some(format!("did you mean {near}?")),
            None if self.header_above(span.start).is_none() && !is_section => {
                Some("if it belongs to a section, write it below that section's [header]".to_owned())
            }
            None => None,
        };
        Some(self.input(span.start, found, format!("one of {}", known.join(", ")), hint))
    }

    fn missing_key(&self, message: &str, span: &Range<usize>, required: &Required) -> Option<Error> {
        let name = message.strip_prefix("missing field `")?.strip_suffix('`')?;
        let words = |key: &str| required.iter().find(|(k, _)| *k == key).map(|(_, words)| words.to_string());
        // the parser places what is missing at the top level nowhere, and the rest at its section's
        // header
        if span.is_empty() {
            let is_blank = |line: &str| line.trim().is_empty() || line.trim_start().starts_with('#');
            let (missing, expected) = match words(&format!("[{name}]")) {
                Some(words) => (format!("there is no [{name}]"), words),
                None => (format!("there is no `{name}`"), words(name)?),
            };
            let is_empty = self.text.lines().all(is_blank);
            let found = if is_empty { "the file is empty".to_owned() } else { missing };
            let at = Place::whole_file(self.file);
            return Some(Error::Input { at, found, expected, hint: None });
        }
        let section = match self.entry(span.start) {
            Some(entry) => entry.path,
            None => cut(self.text.get(span.clone())?),
        };
        Some(self.input(span.start, format!("there is no {name} in {section}"), words(name)?, None))
    }

    fn wrong_type(&self, message: &str, span: &Range<usize>) -> Option<Error> {
        let (kind, expected) = match message.strip_prefix("invalid type: ") {
            Some(rest) => rest.rsplit_once(", expected ")?,
            // what an enum says that none of its variants fits
            None => ("", message.strip_prefix("expected ")?),
        };
        let value = self.text.get(span.clone())?;
        let header = cut(value.split('#').next()?);
        let name = header.trim_matches(['[', ']']);
        let (found, expected, hint) = match expected {
            "a sequence" if header.starts_with('[') && kind == "map" => {
                (header.clone(), format!("[[{name}]] in double brackets, there may be several"), None)
            }
            "a sequence" => (self.said(span), "a list in brackets".to_owned(), None),
            _ if header.starts_with("[[") => {
                (header.clone(), format!("[{name}] in single brackets, there can be only one"), None)
            }
            "f64" => (self.said(span), "a number".to_owned(), number_hint(value)),
            "a string" => (self.said(span), "a text in quotes".to_owned(), None),
            "a map" => (self.said(span), "a section".to_owned(), None),
            other => (self.said(span), other.to_owned(), None),
        };
        Some(self.input(span.start, found, expected, hint))
    }

    fn twice(&self, message: &str, span: &Range<usize>) -> Option<Error> {
        let name = cut(self.text.get(span.clone()).filter(|_| message == "duplicate key")?);
        let (found, expected) = match self.is_header(span.start) {
            true => (format!("a second section [{name}]"), "every section once"),
            false => (format!("a second `{name}`"), "every key once in its section"),
        };
        Some(self.input(span.start, found, expected.to_owned(), None))
    }

    /// There is no reading what stands behind the `=`.
    fn no_value(&self, message: &str, span: &Range<usize>) -> Option<Error> {
        const ANY: &str = "a number, or a text in quotes";
        let Some(Entry { path, value, value_start }) = self.entry(span.start) else {
            // within a list of several lines
            let bare = self.text.get(span.clone())?;
            if bare.trim().is_empty() || !message.starts_with("string values must be") {
                return None;
            }
            return Some(self.input(span.start, cut(bare), ANY.to_owned(), None));
        };
        if value.starts_with(['"', '\'', '[', '{']) {
            return None;
        }
        let number = value.replace(',', ".").parse::<f64>();
        let (expected, hint) = match number {
            _ if value.is_empty() => ("a value behind the =", None),
            Ok(number) if !number.is_finite() => ("a finite number", None),
            Ok(_) => ("a number", number_hint(value)),
            Err(_) if begins_as_number(value) => ("a number", number_hint(value)),
            Err(_) => (ANY, None),
        };
        let found = match value {
            "" => format!("`{path}` is blank"),
            value => format!("`{path}` is {}", cut(value)),
        };
        Some(self.input(value_start, found, expected.to_owned(), hint))
    }

    /// A line that is no `key = value` and no `[section]`.
    fn no_statement(&self, message: &str, span: &Range<usize>) -> Option<Error> {
        if !["key with no value", "invalid key-value pair"].iter().any(|m| message.starts_with(m)) {
            return None;
        }
        let line_start = span.start - self.line_before(span.start).len();
        let line = cut(self.text.get(line_start..)?);
        let hint = line.contains([',', ';', '\t']).then(|| "is this a table of readings (CSV)?".to_owned());
        let found = format!("the line `{line}`");
        Some(self.input(span.start, found, "key = value, or a [section]".to_owned(), hint))
    }

    /// What stands there, with its key where there is one on the line.
    fn said(&self, span: &Range<usize>) -> String {
        let value = cut(self.text.get(span.clone()).unwrap_or_default());
        match self.entry(span.start) {
            Some(entry) => format!("`{}` is {value}", entry.path),
            None => value,
        }
    }

    /// The `key = value` on whose line, behind the `=`, the byte `offset` stands.
    fn entry(&self, offset: usize) -> Option<Entry<'_>> {
        let before = self.line_before(offset);
        let (key, _) = before.split_once('=')?;
        let is_bare = |c: char| c.is_alphanumeric() || "_-. \t".contains(c);
        let key = key.trim();
        if key.is_empty() || !key.chars().all(is_bare) {
            return None;
        }
        if before.contains('#') {
            return None;
        }
        let line_start = offset - before.len();
        let line = self.text[line_start..].lines().next().unwrap_or_default();
        let value = line.split_once('=')?.1.trim_start();
        let value_start = line_start + line.len() - value.len();
        let path = match self.header_above(offset) {
            Some(section) => format!("{}.{}", cut(section), cut(key)),
            None => cut(key),
        };
        Some(Entry { path, value: value.split('#').next().unwrap_or(value).trim(), value_start })
    }

    /// The name in the last `[section]` above the line of `offset`.
    fn header_above(&self, offset: usize) -> Option<&str> {
        let line_start = offset - self.line_before(offset).len();
        let header = self.text[..line_start].lines().rev().map(str::trim).find(|l| l.starts_with('['))?;
        Some(header.split('#').next().unwrap_or(header).trim().trim_matches(['[', ']']))
    }

    fn is_header(&self, offset: usize) -> bool {
        self.line_before(offset).trim_start().starts_with('[')
    }

    fn line_before(&self, offset: usize) -> &str {
        let before = self.text.get(..offset).unwrap_or(self.text);
        before.rsplit('\n').next().unwrap_or_default()
    }
}

/// A key with its section, and the text behind the `=` without its comment.
struct Entry<'t> {
    path: String,
    value: &'t str,
    value_start: usize,
}

/// How to write what was meant to be a number.
fn number_hint(value: &str) -> Option<String> {
    let bare = value.trim_matches(['"', '\'']).trim();
    if bare.rsplit_once(',').is_some_and(|(_, decimals)| decimals.len() == 3) {
        return Some("write a decimal point, and nothing between thousands".to_owned());
    }
    match bare.replace(',', ".").parse::<f64>() {
        Ok(number) if number.is_finite() => Some(format!("write {number:?}")),
        Ok(_) => None,
        Err(_) if begins_as_number(bare) => {
            Some("write the number alone; its unit stands in the name of the key".to_owned())
        }
        Err(_) => None,
    }
}

fn begins_as_number(text: &str) -> bool {
    text.trim_start_matches(['+', '-', '.', ',']).starts_with(|c: char| c.is_ascii_digit())
}
