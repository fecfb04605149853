//! A header and rows, whose errors say where they stand.

use super::numbers::{Dialect, LARGEST, number_hint, parse_number};
use super::split::{Cell, separator_of, split};
use super::written::{quoted, short};
use crate::error::{Error, Place, Result};
use crate::limits;

/// A header and rows of as many cells.
#[derive(Debug, Clone)]
pub struct Table {
    pub(super) file: String,
    pub(super) header: Vec<Cell>,
    pub(super) rows: Vec<Vec<Cell>>,
    pub(super) dialect: Dialect,
}

/// One row of a [`Table`]; cells are asked for by the names of their columns.
#[derive(Debug, Clone, Copy)]
pub struct Row<'t> {
    table: &'t Table,
    cells: &'t [Cell],
}

impl Table {
    /// Reads a table from `text`, the contents of `file`.
    ///
    /// `holds_numbers` tells by its name whether a column holds numbers; from those cells the
    /// decimal mark is found. The separator is that of the header. Decimal commas are read where
    /// `;` or tabs separate the cells.
    ///
    /// # Errors
    /// [`Error::Input`] for an empty or binary file, a header that is missing, nameless or
    /// ambiguous, a row with more or fewer cells than the header, stray quotes, and decimal marks
    /// that differ or may group thousands.
    pub fn parse(file: &str, text: &str, holds_numbers: impl Fn(&str) -> bool) -> Result<Table> {
        let text = text.strip_prefix('\u{feff}').unwrap_or(text);
        refuse_binary(file, text)?;
        limits::check(file, text.len(), limits::TABLE_BYTES, "bytes")?;
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
        let columns = header.matches(separator).count() + 1;
        limits::check(file, columns, limits::TABLE_COLUMNS, "columns")?;
        limits::check(file, lines.len() - 1, limits::TABLE_ROWS, "rows")?;
        limits::check(file, (lines.len() - 1) * columns, limits::TABLE_CELLS, "cells")?;
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

    /// "the columns are x_mm, y_mm": for errors about one that is not there.
    pub fn columns_found(&self) -> String {
        /// More names than these hide what they are listed for.
        const MOST: usize = 12;
        let names: Vec<String> = self.columns().take(MOST).map(short).collect();
        let rest = match self.header.len().saturating_sub(MOST) {
            0 => String::new(),
            more => format!(" and {more} more"),
        };
        match names.as_slice() {
            [one] if rest.is_empty() => format!("the only column is {one}"),
            _ => format!("the columns are {}{rest}", names.join(", ")),
        }
    }

    /// Whether there is a column of this name (upper and lower case are the same).
    pub fn has(&self, column: &str) -> bool {
        self.position(column).is_some()
    }

    /// The rows, top to bottom; rows without any text are left out.
    pub fn rows(&self) -> impl Iterator<Item = Row<'_>> {
        self.rows.iter().map(|cells| Row { table: self, cells })
    }

    /// An error about the header: at `column`, if there is one of that name, else at the header's
    /// line.
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

    pub(super) fn place(&self, cell: &Cell) -> Place {
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

    /// A cell's text without the spaces around it; `None` where it is blank or there is no such
    /// column.
    pub fn text(&self, column: &str) -> Option<&'t str> {
        let cell = &self.cells[self.table.position(column)?];
        (!cell.text.is_empty()).then_some(cell.text.as_str())
    }

    /// A cell's number; `None` where it is blank or there is no such column.
    ///
    /// # Errors
    /// [`Error::Input`] where there is something else than a finite decimal number of at most 1e30
    /// in size.
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
            let hint = hint.or_else(|| Some(self.table.columns_found()));
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

fn counted(count: usize, noun: &str) -> String {
    format!("{count} {noun}{}", if count == 1 { "" } else { "s" })
}
