//! A table as plain data, and as text, HTML, Markdown and CSV.

mod within;

use std::borrow::Cow;

use maud::{Markup, html};
use serde::{Deserialize, Serialize};

use super::scale::typeset;
use crate::delimited::{guarded, visible};
use crate::error::{Error, Result};

/// Columns and rows of finished cells. Numbers are written as in a program, "-1.5e-3"; what is for
/// people to read gets its minus sign here.
#[derive(Debug, Clone, Default, PartialEq, Serialize, Deserialize)]
pub struct Table {
    /// Short name for files, for example "compliance".
    pub name: String,
    /// What the table shows.
    pub caption: String,
    /// The columns.
    pub columns: Vec<Column>,
    /// The cells, row by row. Missing cells are empty, those beyond the last column are dropped.
    pub rows: Vec<Vec<String>>,
    /// Remarks below the table.
    pub notes: Vec<String>,
    /// Folded on a page, however short it is.
    pub is_folded: bool,
}

/// So many rows stand on a page and on a terminal; files hold all of them.
const MOST_ROWS: usize = 1000;

/// One column of a table.
#[derive(Debug, Clone, PartialEq, Eq, Serialize, Deserialize)]
pub struct Column {
    /// Heading.
    pub header: String,
    /// Unit of all its numbers; empty for texts and pure numbers.
    pub unit: String,
    /// Where its cells stand.
    pub align: Align,
    /// What it has to do with a unit that each row has of its own.
    pub row_unit: RowUnit,
}

/// Units by row: one column names them, others have numbers in them.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum RowUnit {
    /// Nothing.
    #[default]
    No,
    /// It names the unit.
    Names,
    /// Its numbers are in it.
    Has,
}

/// Where the cells of a column stand.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
pub enum Align {
    /// Texts.
    Left,
    /// Whole numbers.
    Right,
    /// Numbers, decimal points below one another.
    Point,
}

impl Column {
    /// A column of texts.
    pub fn text(header: impl Into<String>) -> Self {
        Column { header: header.into(), unit: String::new(), align: Align::Left, row_unit: RowUnit::No }
    }

    /// A column of numbers in a unit.
    pub fn number(header: impl Into<String>, unit: impl Into<String>) -> Self {
        Column { header: header.into(), unit: unit.into(), align: Align::Point, row_unit: RowUnit::No }
    }

    /// A column that names the unit of each row.
    pub fn units() -> Self {
        Column { row_unit: RowUnit::Names, ..Column::text("unit") }
    }

    /// A column of numbers in the unit of their row.
    pub fn in_row_unit(header: impl Into<String>) -> Self {
        Column { row_unit: RowUnit::Has, ..Column::number(header, "") }
    }
}

impl Table {
    /// An empty table.
    pub fn new(name: impl Into<String>, caption: impl Into<String>, columns: Vec<Column>) -> Self {
        Table { name: name.into(), caption: caption.into(), columns, ..Table::default() }
    }

    /// Adds a row.
    pub fn row<S: Into<String>>(&mut self, cells: impl IntoIterator<Item = S>) {
        self.rows.push(cells.into_iter().map(Into::into).collect());
    }

    /// Aligned plain text for terminals, lines ended by "\n".
    pub fn text(&self) -> String {
        let columns: Vec<Vec<String>> = (0..self.columns.len()).map(|i| self.text_column(i)).collect();
        let mut text = if self.caption.is_empty() { String::new() } else { format!("{}\n\n", self.caption) };
        for row in 0..columns.first().map_or(0, Vec::len) {
            let line = columns.iter().map(|cells| cells[row].as_str()).collect::<Vec<_>>().join("  ");
            text += line.trim_end();
            text.push('\n');
        }
        for note in &self.notes {
            text += &format!("  {note}\n");
        }
        text
    }

    /// GitHub-flavoured Markdown.
    pub fn markdown(&self) -> String {
        let line = |cells: Vec<String>| format!("| {} |\n", cells.join(" | "));
        // a tag would be one, and a terminal would obey a control character
        let plain =
            |text: &str| visible(&text.replace('<', "&lt;").replace(['\n', '\r', '\t'], " ")).into_owned();
        let escape = |cell: &str| plain(&cell.replace('\\', "\\\\").replace('|', "\\|"));
        let rule = |column: &Column| if column.align == Align::Left { ":--" } else { "--:" }.to_owned();
        let mut text =
            if self.caption.is_empty() { String::new() } else { format!("**{}**\n\n", plain(&self.caption)) };
        text += &line(self.columns.iter().map(|c| escape(&c.heading())).collect());
        text += &line(self.columns.iter().map(rule).collect());
        for row in 0..self.rows.len() {
            text += &line((0..self.columns.len()).map(|i| escape(self.cell(row, i))).collect());
        }
        for note in &self.notes {
            text += &format!("\n{}\n", plain(note));
        }
        text
    }

    /// Comma-separated values under one line of headings, units in brackets.
    ///
    /// # Errors
    /// [`Error::Numerical`] where the writer refuses; it has no reason to.
    pub fn csv(&self) -> Result<String> {
        let failed = |why: String| Error::Numerical { what: "a table as CSV", why };
        let mut writer = csv::Writer::from_writer(Vec::new());
        writer
            .write_record(self.columns.iter().map(|c| guarded(&c.heading()).into_owned()))
            .map_err(|e| failed(e.to_string()))?;
        for row in 0..self.rows.len() {
            let cells = (0..self.columns.len()).map(|i| guarded(self.cell(row, i)).into_owned());
            writer.write_record(cells).map_err(|e| failed(e.to_string()))?;
        }
        let bytes = writer.into_inner().map_err(|e| failed(e.to_string()))?;
        String::from_utf8(bytes).map_err(|e| failed(e.to_string()))
    }

    /// As many rows as anybody reads, and a note that says how many more there are, and
    /// `where_else`.
    pub(super) fn shortened(&self, where_else: &str) -> Cow<'_, Table> {
        let more = self.rows.len().saturating_sub(MOST_ROWS);
        if more == 0 {
            return Cow::Borrowed(self);
        }
        let mut notes = self.notes.clone();
        let rows = if more == 1 { "row" } else { "rows" };
        notes.push(format!("{} more {rows}: {where_else}.", typeset(&more.to_string())));
        Cow::Owned(Table {
            name: self.name.clone(),
            caption: self.caption.clone(),
            columns: self.columns.clone(),
            rows: self.rows[..MOST_ROWS].to_vec(),
            notes,
            is_folded: self.is_folded,
        })
    }

    /// A `<table>` with its notes; `number` goes before its caption.
    pub(super) fn html(&self, number: usize) -> Markup {
        let class = |column: &Column| if column.align == Align::Left { "left" } else { "number" };
        let cells: Vec<Vec<String>> =
            (0..self.columns.len()).map(|i| self.padded(i, '\u{2007}', '\u{2008}')).collect();
        // the page's script switches units
        let row_unit = |column: &Column| match column.row_unit {
            RowUnit::No => None,
            RowUnit::Names => Some("names"),
            RowUnit::Has => Some("has"),
        };
        html! {
            div.wide tabindex="0" role="region" aria-label=(format!("Table {number}")) { table {
                caption { b { "Table " (number) } ". " (self.caption) }
                thead { tr { @for column in &self.columns {
                    th class=(class(column)) scope="col" data-row-unit=[row_unit(column)] {
                        (column.header)
                        @if !column.unit.is_empty() { span.unit { (column.unit) } }
                    }
                } } }
                tbody { @for row in 0..self.rows.len() {
                    tr { @for (column, cells) in self.columns.iter().zip(&cells) {
                        td class=(class(column)) { (cells[row]) }
                    } }
                } }
            } }
            @for note in &self.notes { p.note { (note) } }
        }
    }

    fn cell(&self, row: usize, column: usize) -> &str {
        self.rows.get(row).and_then(|cells| cells.get(column)).map_or("", String::as_str)
    }

    /// Heading, unit, rule and cells of a column, all equally wide.
    fn text_column(&self, i: usize) -> Vec<String> {
        let column = &self.columns[i];
        let mut cells = vec![column.header.clone()];
        if self.columns.iter().any(|c| !c.unit.is_empty()) {
            cells.push(column.unit.clone());
        }
        let rule = cells.len();
        cells.extend(self.padded(i, ' ', ' '));
        let width = cells.iter().map(|cell| cell.chars().count()).max().unwrap_or(0);
        cells.insert(rule, "─".repeat(width));
        let pad = |cell: &String| match column.align {
            Align::Left => format!("{cell:<width$}"),
            Align::Right | Align::Point => format!("{cell:>width$}"),
        };
        cells.iter().map(pad).collect()
    }

    /// The cells of a column for people to read; where they align at the point, filled up behind it
    /// with `digit` and `point`, spaces as wide as those are.
    fn padded(&self, i: usize, digit: char, point: char) -> Vec<String> {
        let align = self.columns[i].align;
        let cells = (0..self.rows.len()).map(|row| {
            let cell = self.cell(row, i).replace(['\n', '\r', '\t'], " ");
            if align == Align::Left { cell } else { typeset(&cell) }
        });
        let cells: Vec<String> = cells.collect();
        // Everything behind the whole number that it begins with, "±" and what follows included;
        // words are not numbers and stand as they are.
        let behind = |cell: &str| {
            let whole = cell.trim_start_matches(['\u{2212}', '+']);
            let is_whole = |c: char| c.is_ascii_digit() || c == '\u{2009}';
            if whole.starts_with(is_whole) { whole.trim_start_matches(is_whole).chars().count() } else { 0 }
        };
        let is_number = |cell: &str| cell.chars().any(|c| c.is_ascii_digit());
        let longest = cells.iter().filter(|c| is_number(c)).map(|c| behind(c)).max().unwrap_or(0);
        if align != Align::Point {
            return cells;
        }
        let fill = |cell: &String| {
            let have = behind(cell);
            let spaces = (have..longest).map(|at| if at == 0 { point } else { digit });
            if is_number(cell) { cell.chars().chain(spaces).collect() } else { cell.clone() }
        };
        cells.iter().map(fill).collect()
    }
}

impl Column {
    fn heading(&self) -> String {
        if self.unit.is_empty() { self.header.clone() } else { format!("{} [{}]", self.header, self.unit) }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn table() -> Table {
        let columns = vec![Column::text("rod"), Column::number("C22", "µm/N"), Column::number("off", "%")];
        let mut table = Table::new("compliance", "Compliance at the tip", columns);
        table.row(["5# steel", "33.0", "-1.2"]);
        table.row(["2# carbon | <b>", "7.81", "27"]);
        table.row(["unknown", "n/a"]);
        table.notes.push("C22: along y under a force along y.".into());
        table
    }

    #[test]
    fn text_is_aligned_at_the_point() {
        insta::assert_snapshot!(table().text(), @"
        Compliance at the tip

        rod                C22   off
                          µm/N     %
        ───────────────  ─────  ────
        5# steel         33.0   −1.2
        2# carbon | <b>   7.81  27
        unknown            n/a
          C22: along y under a force along y.
        ");
    }

    #[test]
    fn a_number_with_its_uncertainty_is_aligned_at_its_own_point() {
        let mut table = Table::new("t", "", vec![Column::number("c_rod", "µm")]);
        for cell in ["88.92 ± 1.9", "1101 ± 105", "-3", "–"] {
            table.row([cell]);
        }
        insta::assert_snapshot!(table.text(), @r"
                c_rod
                   µm
        ─────────────
          88.92 ± 1.9
        1101 ± 105
          −3
                    –
        ");
    }

    #[test]
    fn markdown_escapes_its_bars() {
        insta::assert_snapshot!(table().markdown(), @r"
        **Compliance at the tip**

        | rod | C22 [µm/N] | off [%] |
        | :-- | --: | --: |
        | 5# steel | 33.0 | -1.2 |
        | 2# carbon \| &lt;b> | 7.81 | 27 |
        | unknown | n/a |  |

        C22: along y under a force along y.
        ");
    }

    #[test]
    fn csv_keeps_numbers_machine_readable() {
        insta::assert_snapshot!(table().csv().expect("writes"), @"
        rod,C22 [µm/N],off [%]
        5# steel,33.0,-1.2
        2# carbon | <b>,7.81,27
        unknown,n/a,
        ");
    }

    #[test]
    fn html_escapes_its_cells_and_sets_a_minus() {
        let html = table().html(1).into_string();
        assert!(html.contains("| &lt;b&gt;") && html.contains("−1.2") && !html.contains("<b>|"), "{html}");
    }

    #[test]
    fn html_says_which_numbers_are_in_the_unit_of_their_row() {
        let columns = vec![Column::text("of"), Column::in_row_unit("value"), Column::units()];
        let html = Table::new("t", "", columns).html(1).into_string();
        assert_eq!(html.matches("data-row-unit").count(), 2);
        assert!(
            html.contains("data-row-unit=\"has\">value") && html.contains("data-row-unit=\"names\">unit")
        );
    }

    #[test]
    fn an_empty_table_is_fine() {
        let table = Table::default();
        assert_eq!(table.text(), "");
        assert_eq!(table.csv().expect("writes").trim(), "\"\"");
        table.html(1);
    }
}
