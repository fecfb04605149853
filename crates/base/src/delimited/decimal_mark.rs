//! Which decimal mark a file uses.

use super::table::Table;
use super::written::quoted;
use crate::error::{Error, Result};

impl Table {
    /// The mark that all numbers of the file share. Commas are refused where they may as well group
    /// thousands: `500`, `1,000`, `1,500` in one column, with no comma elsewhere in the file that
    /// can only be a decimal one.
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
