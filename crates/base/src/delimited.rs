//! Tables of text cells that know where they stand: a header line, then rows, separated by `,`, `;` or tabs.
//!
//! `#` comment lines, blank lines, quoted cells, spaces around cells, CRLF and a byte-order mark are understood.
//! One record is one line: no measurement has a line break in a cell, and so an unclosed quote is found on its
//! own line instead of swallowing the rest of the file.

mod names;
mod numbers;

use std::borrow::Cow;

use crate::error::{Error, Place, Result};
pub use names::nearest_name;
pub use numbers::Dialect;
use numbers::{LARGEST, number_hint, parse_number};

/// A header and rows of as many cells.
#[derive(Debug, Clone)]
pub struct Table {
    file: String,
    header: Vec<Cell>,
    rows: Vec<Vec<Cell>>,
    dialect: Dialect,
}

/// One row of a [`Table`]; cells are asked for by the names of their columns.
#[derive(Debug, Clone, Copy)]
pub struct Row<'t> {
    table: &'t Table,
    cells: &'t [Cell],
}

/// Trimmed text and the place of its first character.
#[derive(Debug, Clone)]
struct Cell {
    text: String,
    line: usize,
    column: usize,
}

impl Table {
    /// Reads a table from `text`, the contents of `file`.
    ///
    /// `holds_numbers` tells by its name whether a column holds numbers; from those cells the decimal mark is found.
    /// The separator is that of the header. Decimal commas are read where `;` or tabs separate the cells.
    ///
    /// # Errors
    /// [`Error::Input`] for an empty or binary file, a header that is missing, nameless or ambiguous, a row with
    /// more or fewer cells than the header, stray quotes, and decimal marks that differ or may group thousands.
    pub fn parse(file: &str, text: &str, holds_numbers: impl Fn(&str) -> bool) -> Result<Table> {
        let text = text.strip_prefix('\u{feff}').unwrap_or(text);
        refuse_binary(file, text)?;
        let lines: Vec<(usize, &str)> = (1..)
            .zip(text.lines())
            .filter(|(_, line)| !line.trim().is_empty() && !line.trim_start().starts_with('#'))
            .collect();
        let Some(&(_, header)) = lines.first() else {
            let found =
                if text.trim().is_empty() { "the file is empty" } else { "the file has only comments" };
            return Err(Error::Input {
                at: Place::whole_file(file),
                found: found.into(),
                expected: "a header line with the names of the columns, then rows".into(),
                hint: None,
            });
        };
        let separator = separator_of(header);
        let mut records = split(file, &lines, separator);
        let mut table = Table {
            file: file.to_owned(),
            header: records.next().transpose()?.unwrap_or_default(),
            rows: Vec::new(),
            dialect: Dialect { separator, decimal_mark: '.' },
        };
        table.check_header()?;
        for cells in records {
            let cells = cells?;
            // spreadsheets append rows of nothing but separators
            if cells.iter().any(|cell| !cell.text.is_empty()) {
                table.check_width(&cells)?;
                table.rows.push(cells);
            }
        }
        table.dialect.decimal_mark = table.find_decimal_mark(holds_numbers)?;
        Ok(table)
    }

    /// Separator and decimal mark.
    pub fn dialect(&self) -> Dialect {
        self.dialect
    }

    /// The names of the columns as written, from left to right.
    pub fn columns(&self) -> impl Iterator<Item = &str> {
        self.header.iter().map(|cell| cell.text.as_str())
    }

    /// Whether there is a column of this name (upper and lower case are the same).
    pub fn has(&self, column: &str) -> bool {
        self.position(column).is_some()
    }

    /// The rows, top to bottom; rows without any text are left out.
    pub fn rows(&self) -> impl Iterator<Item = Row<'_>> {
        self.rows.iter().map(|cells| Row { table: self, cells })
    }

    /// An error about the header: at `column`, if there is one of that name, else at the header's line.
    pub fn header_error(&self, column: &str, found: String, expected: String, hint: Option<String>) -> Error {
        let at = match self.position(column) {
            Some(index) => self.place(&self.header[index]),
            None => Place { file: self.file.clone(), line: self.header[0].line, column: 0 },
        };
        Error::Input { at, found, expected, hint }
    }

    fn position(&self, column: &str) -> Option<usize> {
        self.header.iter().position(|cell| cell.text.eq_ignore_ascii_case(column))
    }

    fn place(&self, cell: &Cell) -> Place {
        Place { file: self.file.clone(), line: cell.line, column: cell.column }
    }

    fn check_header(&self) -> Result<()> {
        let error = |cell: &Cell, found, expected: &str, hint: &str| {
            Err(Error::Input {
                at: self.place(cell),
                found,
                expected: expected.into(),
                hint: Some(hint.into()),
            })
        };
        for (index, cell) in self.header.iter().enumerate() {
            let name = quoted(&cell.text);
            if cell.text.is_empty() {
                let found = format!("column {} has no name", index + 1);
                return error(
                    cell,
                    found,
                    "a name in every cell of the header",
                    "name the column or delete it",
                );
            }
            if cell.text.contains(" = ") {
                let found = format!("the first line is {name}");
                return error(cell, found, "the names of the columns", "is this a TOML file, not a table?");
            }
            if cell.text.parse::<f64>().is_ok_and(f64::is_finite) {
                let found = format!("the first line holds the number {name}");
                return error(cell, found, "the names of the columns", "put a header line above the numbers");
            }
            if self.position(&cell.text) != Some(index) {
                let found = format!("column {name} stands there twice");
                return error(cell, found, "every column once", "delete or rename one of the two");
            }
        }
        Ok(())
    }

    fn check_width(&self, cells: &[Cell]) -> Result<()> {
        if cells.len() == self.header.len() {
            return Ok(());
        }
        let hint = match self.dialect.separator {
            ',' if cells.len() > self.header.len() => {
                "numbers with decimal commas need `;` between the cells, also in the header".into()
            }
            _ => format!("leave cells blank, but write every {}", self.dialect.separator_name()),
        };
        Err(Error::Input {
            at: Place { file: self.file.clone(), line: cells[0].line, column: 0 },
            found: format!("the row has {}", counted(cells.len(), "cell")),
            expected: format!("{} as in the header", self.header.len()),
            hint: Some(hint),
        })
    }
}

impl<'t> Row<'t> {
    /// The table that the row belongs to.
    pub fn table(&self) -> &'t Table {
        self.table
    }

    /// The row's line in the file, from 1.
    pub fn line(&self) -> usize {
        self.cells.first().map_or(0, |cell| cell.line)
    }

    /// A cell's text without the spaces around it; `None` where it is blank or there is no such column.
    pub fn text(&self, column: &str) -> Option<&'t str> {
        let cell = &self.cells[self.table.position(column)?];
        (!cell.text.is_empty()).then_some(cell.text.as_str())
    }

    /// A cell's number; `None` where it is blank or there is no such column.
    ///
    /// # Errors
    /// [`Error::Input`] where there is something else than a finite decimal number of at most 1e30 in size.
    pub fn number(&self, column: &str) -> Result<Option<f64>> {
        let Some(text) = self.text(column) else { return Ok(None) };
        let value = parse_number(text, self.table.dialect).ok_or_else(|| {
            self.error(column, "a number".into(), number_hint(text, self.table.dialect).map(str::to_owned))
        })?;
        if value.abs() > LARGEST {
            return Err(self.error(column, format!("a number of at most {LARGEST:e} in size"), None));
        }
        Ok(Some(value))
    }

    /// A cell's number where a blank is an error; otherwise as [`Row::number`].
    ///
    /// # Errors
    /// As for [`Row::number`], and where the cell is blank or there is no such column.
    pub fn required_number(&self, column: &str) -> Result<f64> {
        self.number(column)?.ok_or_else(|| self.error(column, "a number".into(), None))
    }

    /// An error about what stands in one cell; without such a column, about the row.
    pub fn error(&self, column: &str, expected: String, hint: Option<String>) -> Error {
        let Some(index) = self.table.position(column) else {
            return self.row_error(format!("there is no column {column}"), expected, hint);
        };
        let name = &self.table.header[index].text;
        let found = match self.text(column) {
            Some(text) => format!("{name} is {}", quoted(text)),
            None => format!("{name} is blank"),
        };
        Error::Input { at: self.table.place(&self.cells[index]), found, expected, hint }
    }

    /// An error about the row as a whole.
    pub fn row_error(&self, found: String, expected: String, hint: Option<String>) -> Error {
        let at = Place { file: self.table.file.clone(), line: self.line(), column: 0 };
        Error::Input { at, found, expected, hint }
    }
}

/// The text of the comment lines that a file begins with.
pub fn comments_above(text: &str) -> Option<String> {
    let comments = text.lines().map_while(|line| line.trim().strip_prefix('#'));
    let words = comments.map(str::trim).filter(|line| !line.is_empty()).collect::<Vec<_>>().join(" ");
    (!words.is_empty()).then_some(words)
}

/// `text` as a cell of a table that is written: between quotes where it would be taken for more than one cell.
pub fn cell(text: &str) -> String {
    match text.contains([',', ';', '"', '\n', '\r', '\t', '#']) || text.trim() != text {
        true => format!("\"{}\"", text.replace('"', "\"\"")),
        false => text.to_owned(),
    }
}

/// `text` between quotes, shortened and with control characters made visible, for a message.
pub fn quoted(text: &str) -> String {
    const LONGEST: usize = 40;
    let visible = |c: char| if c.is_control() { '\u{fffd}' } else { c };
    let short: String = text.chars().take(LONGEST).map(visible).collect();
    if text.chars().nth(LONGEST).is_some() { format!("\"{short}…\"") } else { format!("\"{short}\"") }
}

fn refuse_binary(file: &str, text: &str) -> Result<()> {
    let (at, found) = if text.starts_with("PK\u{3}\u{4}") {
        (Place::whole_file(file), "this is an Excel workbook")
    } else if let Some(offset) = text.find('\0') {
        (
            Place::of_offset(file, text, offset),
            "a NUL character; this is an Excel workbook or other binary file",
        )
    } else {
        return Ok(());
    };
    Err(Error::Input {
        at,
        found: found.into(),
        expected: "CSV text".into(),
        hint: Some("export it as CSV (in Excel: \"CSV UTF-8\")".into()),
    })
}

/// `;` or a tab where the header has one outside of quotes, else `,`.
fn separator_of(header: &str) -> char {
    let outside = || header.split('"').step_by(2);
    [';', '\t'].into_iter().find(|&s| outside().any(|part| part.contains(s))).unwrap_or(',')
}

/// The cells of each line: one record per line, since a quote that is still open at its end is an error.
fn split<'t>(
    file: &'t str,
    lines: &'t [(usize, &'t str)],
    separator: char,
) -> impl Iterator<Item = Result<Vec<Cell>>> + 't {
    let text = lines.iter().map(|&(_, line)| line).collect::<Vec<_>>().join("\n");
    let mut reader = csv::ReaderBuilder::new()
        .has_headers(false)
        .flexible(true)
        .delimiter(u8::try_from(separator).unwrap_or(b','))
        .from_reader(std::io::Cursor::new(text));
    let mut record = csv::StringRecord::new();
    lines.iter().map(move |&(number, line)| {
        let read = reader.read_record(&mut record);
        let cells = read.map_err(|_| 1).and_then(|_| place_cells(number, line, separator, &record));
        cells.map_err(|column| Error::Input {
            at: Place { file: file.to_owned(), line: number, column },
            found: "a stray quote or line break".into(),
            expected: "cells without quotes, or quotes directly around the whole cell".into(),
            hint: Some("close every quote on its line, and write a quote inside of quotes twice".into()),
        })
    })
}

/// What the csv reader unquoted is quoted again and compared with the line: this gives the cells' columns, and shows
/// every quote that the reader had to guess about. The error is the column of such a quote.
fn place_cells(
    number: usize,
    line: &str,
    separator: char,
    record: &csv::StringRecord,
) -> std::result::Result<Vec<Cell>, usize> {
    let mut cells = Vec::with_capacity(record.len());
    let (mut rest, mut column) = (line, 1);
    for (index, field) in record.iter().enumerate() {
        if index > 0 {
            rest = rest.strip_prefix(separator).ok_or(column)?;
            column += 1;
        }
        let is_quoted = rest.starts_with('"');
        let written: Cow<'_, str> =
            if is_quoted { format!("\"{}\"", field.replace('"', "\"\"")).into() } else { field.into() };
        rest = rest.strip_prefix(written.as_ref()).ok_or(column)?;
        let indent = written.chars().take_while(|c| c.is_whitespace()).count();
        if indent > 0 && field.trim_start().starts_with('"') {
            return Err(column + indent);
        }
        cells.push(Cell { text: field.trim().to_owned(), line: number, column: column + indent });
        column += written.chars().count();
    }
    if rest.is_empty() && !cells.is_empty() { Ok(cells) } else { Err(column) }
}

fn counted(count: usize, noun: &str) -> String {
    format!("{count} {noun}{}", if count == 1 { "" } else { "s" })
}

#[cfg(test)]
mod tests {
    use super::*;

    fn parse(text: &str) -> Result<Table> {
        Table::parse("f.csv", text, |name| name.ends_with("_mm"))
    }

    fn message(text: &str) -> String {
        parse(text)
            .and_then(|t| t.rows().try_for_each(|r| r.number("x_mm").map(drop)))
            .unwrap_err()
            .to_string()
    }

    #[test]
    fn comments_blanks_quotes_spaces_and_line_ends_are_understood() {
        let text = "\u{feff}# rig\r\n\r\n id , x_mm\r\n  # first\r\n\"a, \"\"b\"\"\", 1.5\r\n,,\r\nb,\r\n";
        let table = parse(text).unwrap();
        let rows: Vec<_> = table.rows().collect();
        assert_eq!(rows.len(), 2);
        assert_eq!((rows[0].line(), rows[0].text("ID")), (5, Some("a, \"b\"")));
        assert_eq!(rows[0].number("x_mm").unwrap(), Some(1.5));
        assert_eq!((rows[1].line(), rows[1].number("x_mm").unwrap()), (7, None));
    }

    #[test]
    fn stray_quotes_are_found_where_they_stand() {
        for (text, place) in [
            ("a,x_mm\nb,\"1\n2,3\n", "f.csv:2:3"),
            ("a,x_mm\n\"b\"c,1\n", "f.csv:2:1"),
            ("a,x_mm\nb, \"1\"\n", "f.csv:2:4"),
        ] {
            assert!(message(text).starts_with(&format!("{place}: a stray quote")), "{}", message(text));
        }
    }
}
