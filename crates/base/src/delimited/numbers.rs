//! Numbers in cells: how they are written, what is one, and advice on what is none.

use std::fmt;

/// How the cells of a file are separated and its numbers written. Its `Display` is a note for the
/// user.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Dialect {
    /// `,`, `;` or a tab.
    pub separator: char,
    /// `.` or `,`.
    pub decimal_mark: char,
}

/// The largest number a cell may hold: no quantity in any unit comes near, and its square is still
/// finite.
pub(super) const LARGEST: f64 = 1e30;

impl Dialect {
    pub(super) fn separator_name(self) -> String {
        if self.separator == '\t' { "tab".into() } else { format!("`{}`", self.separator) }
    }
}

impl fmt::Display for Dialect {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let mark = if self.decimal_mark == ',' { "commas" } else { "points" };
        write!(f, "read with {} separators and decimal {mark}", self.separator_name())
    }
}

/// A decimal number; `None` for anything else, such as "NaN", "0x1F" or "5 N".
pub(super) fn parse_number(text: &str, dialect: Dialect) -> Option<f64> {
    let other_mark = if dialect.decimal_mark == ',' { '.' } else { ',' };
    if text.contains(other_mark) {
        return None;
    }
    let plain = text.replace('\u{2212}', "-").replace(dialect.decimal_mark, ".");
    // `parse` alone would take "inf", "NaN" and "infinity" too
    plain.bytes().all(|b| b.is_ascii_digit() || b"+-.eE".contains(&b)).then(|| plain.parse().ok())?
}

/// What to do about a `text` that is no number.
pub(super) fn number_hint(text: &str, dialect: Dialect) -> Option<&'static str> {
    let lower = text.to_lowercase();
    let marks = text.chars().filter(|c| ".,".contains(*c)).count();
    let number_length =
        text.find(|c: char| !c.is_ascii_digit() && !".,+-\u{2212}".contains(c)).unwrap_or(text.len());
    let (number, unit) = text.split_at(number_length);
    let has_digit = number.contains(|c: char| c.is_ascii_digit());
    match () {
        _ if ["nan", "na", "n/a", "inf", "-", "--", "?", "none", "null"].contains(&lower.as_str()) => {
            Some("leave the cell blank where nothing was measured")
        }
        _ if has_digit
            && !unit.is_empty()
            && unit.chars().all(|c| !c.is_ascii_digit() && !c.is_control()) =>
        {
            Some("write the number alone; its unit stands in the name of the column")
        }
        _ if lower.starts_with("0x") => Some("write the number in decimal"),
        _ if marks > 1 && unit.is_empty() => Some("write nothing between thousands"),
        _ if text.contains(',') && dialect.separator == ',' => {
            Some("decimal commas are read where `;` separates the cells")
        }
        _ => None,
    }
}
