//! Lines into cells, each with its place.

use std::borrow::Cow;

use super::written::is_formula;
use crate::error::{Error, Place, Result};

/// Trimmed text and the place of its first character.
#[derive(Debug, Clone)]
pub(super) struct Cell {
    pub text: String,
    pub line: usize,
    pub column: usize,
}

/// `;` or a tab where the header has one outside of quotes, else `,`.
pub(super) fn separator_of(header: &str) -> char {
    let outside = || header.split('"').step_by(2);
    [';', '\t'].into_iter().find(|&s| outside().any(|part| part.contains(s))).unwrap_or(',')
}

/// The cells of each line: one record per line, since a quote that is still open at its end is an
/// error.
pub(super) fn split<'t>(
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

/// What the csv reader unquoted is quoted again and compared with the line: this gives the cells'
/// columns, and shows every quote that the reader had to guess about. The error is the column of
/// such a quote.
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
        // what keeps a spreadsheet from taking a text for a formula is no part of it
        let bare = field.trim();
        let bare = bare.strip_prefix('\'').filter(|rest| is_formula(rest)).map_or(bare, str::trim);
        cells.push(Cell { text: bare.to_owned(), line: number, column: column + indent });
        column += written.chars().count();
    }
    if rest.is_empty() && !cells.is_empty() { Ok(cells) } else { Err(column) }
}
