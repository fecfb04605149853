//! Numbers in cells: which decimal mark a file uses, what is a number, and advice on what is none.

use std::fmt;

use super::{Table, quoted};
use crate::error::{Error, Result};

/// How the cells of a file are separated and its numbers written. Its `Display` is a note for the user.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Dialect {
    /// `,`, `;` or a tab.
    pub separator: char,
    /// `.` or `,`.
    pub decimal_mark: char,
}

/// The largest number a cell may hold: no quantity in any unit comes near, and its square is still finite.
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

impl Table {
    /// The mark that all numbers of the file share. Commas are refused where they may as well group thousands:
    /// `500`, `1,000`, `1,500` in one column, with no comma elsewhere in the file that can only be a decimal one.
    pub(super) fn find_decimal_mark(&self, holds_numbers: impl Fn(&str) -> bool) -> Result<char> {
        if self.dialect.separator == ',' {
            return Ok('.');
        }
        let numeric: Vec<usize> =
            (0..self.header.len()).filter(|&i| holds_numbers(&self.header[i].text)).collect();
        let marked = || {
            let cells = self.rows.iter().flat_map(|row| numeric.iter().map(move |&i| (i, &row[i])));
            cells.filter_map(|(i, cell)| Some((i, cell, single_mark(&cell.text)?)))
        };
        let Some((_, first, mark)) = marked().next() else { return Ok('.') };
        if let Some((index, odd, _)) = marked().find(|&(_, _, other)| other != mark) {
            return Err(Error::Input {
                at: self.place(odd),
                found: format!("{} is {}", self.header[index].text, quoted(&odd.text)),
                expected: format!(
                    "`{mark}` as decimal mark, as in {} in line {}",
                    quoted(&first.text),
                    first.line
                ),
                hint: Some("use one decimal mark in the whole file, and nothing between thousands".into()),
            });
        }
        let has_short_integers = |index: usize| {
            let column = || self.rows.iter().map(|row| row[index].text.trim_start_matches(SIGNS));
            let mut integers = column().filter(|text| is_digits(text)).peekable();
            integers.peek().is_some() && integers.all(|text| text.len() <= 3)
        };
        if mark == ',' && marked().all(|(_, cell, _)| may_group_thousands(&cell.text)) {
            let unclear: Vec<bool> = (0..self.header.len()).map(has_short_integers).collect();
            if let Some((index, cell, _)) = marked().find(|&(index, _, _)| unclear[index]) {
                return Err(Error::Input {
                    at: self.place(cell),
                    found: format!(
                        "{} is {}, with a decimal comma or a comma between thousands",
                        self.header[index].text,
                        quoted(&cell.text)
                    ),
                    expected: "numbers that can be read in one way only".into(),
                    hint: Some("write 1000 without a comma, and 1.000 with a decimal point".into()),
                });
            }
        }
        Ok(mark)
    }
}

const SIGNS: [char; 3] = ['+', '-', '\u{2212}'];

fn is_digits(text: &str) -> bool {
    !text.is_empty() && text.bytes().all(|b| b.is_ascii_digit())
}

/// The decimal mark of a number that has exactly one `.` or `,`.
fn single_mark(text: &str) -> Option<char> {
    let numeric = |c: char| c.is_ascii_digit() || SIGNS.contains(&c) || ".,eE".contains(c);
    let mut marks = text.chars().filter(|c| ".,".contains(*c));
    let mark = marks.next()?;
    (marks.next().is_none() && text.chars().all(numeric)).then_some(mark)
}

/// Whether the comma of `1,234` may stand between thousands.
fn may_group_thousands(text: &str) -> bool {
    text.trim_start_matches(SIGNS).split_once(',').is_some_and(|(thousands, rest)| {
        is_digits(thousands)
            && is_digits(rest)
            && thousands.len() <= 3
            && rest.len() == 3
            && !thousands.starts_with('0')
    })
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

#[cfg(test)]
mod tests {
    use super::*;

    fn parse(text: &str) -> Result<Table> {
        Table::parse("f.csv", text, |name| name.ends_with("_mm"))
    }

    fn numbers(text: &str) -> Vec<Option<f64>> {
        parse(text).unwrap().rows().map(|row| row.number("x_mm").unwrap()).collect()
    }

    fn message(text: &str) -> String {
        parse(text)
            .and_then(|t| t.rows().try_for_each(|r| r.number("x_mm").map(drop)))
            .unwrap_err()
            .to_string()
    }

    #[test]
    fn decimal_commas_are_read_where_all_numbers_have_them() {
        assert_eq!(numbers("id;x_mm\n1.5;1,5\na;\u{2212}2\n"), [Some(1.5), Some(-2.0)]);
        assert_eq!(numbers("id\tx_mm\n\t1,5e-3\n"), [Some(1.5e-3)]);
        assert_eq!(numbers("id;x_mm\na;1.5\n"), [Some(1.5)]);
        let note = parse("id;x_mm\na;1,5\n").unwrap().dialect().to_string();
        assert_eq!(note, "read with `;` separators and decimal commas");
    }

    #[test]
    fn a_comma_that_may_group_thousands_needs_a_proof() {
        assert_eq!(numbers("x_mm;y\n1,234;\n2,468;\n"), [Some(1.234), Some(2.468)]);
        assert_eq!(numbers("x_mm;y\n1,234;\n500;\n0,500;\n"), [Some(1.234), Some(500.0), Some(0.5)]);
        let error = message("x_mm;y\n500;\n1,000;\n");
        assert!(
            error.starts_with("f.csv:3:1: x_mm is \"1,000\", with a decimal comma or a comma"),
            "{error}"
        );
        assert_eq!(message("x_mm;y\n1,5;\n1.234,5;\n"), "f.csv:3:1: x_mm is \"1.234,5\", expected a number");
    }

    #[test]
    fn only_finite_decimal_numbers_are_numbers() {
        for bad in ["NaN", "inf", "-infinity", "0x1F", "5 N", "1e", ".", "--1", "1.2.3", "1_000", "٣"] {
            let expected = format!("f.csv:2:4: x_mm is \"{bad}\", expected a number");
            assert_eq!(message(&format!("id,x_mm\nµ, {bad}\n")), expected);
        }
        let error = message("x_mm\n1e999\n");
        assert_eq!(error, "f.csv:2:1: x_mm is \"1e999\", expected a number of at most 1e30 in size");
        assert_eq!(numbers("x_mm\n+1.\n.5\n-1E3\n"), [Some(1.0), Some(0.5), Some(-1000.0)]);
    }
}
