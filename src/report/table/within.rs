//! A table in as many columns of text as a terminal has: cells broken between words, or one field a
//! line.

use super::{Align, Table};

/// Between two columns.
const GAP: usize = 2;

impl Table {
    /// [`Table::text`] in lines of at most `width` columns, as far as no single word is longer:
    /// cells and headings are broken between words; where even that is too wide, every row becomes
    /// a record with one field a line.
    pub fn text_within(&self, width: usize) -> String {
        let columns: Vec<Vec<String>> = (0..self.columns.len()).map(|i| self.padded(i, ' ', ' ')).collect();
        let widest = |texts: &mut dyn Iterator<Item = &str>| texts.map(length).max().unwrap_or(0);
        let headings = |i: usize| [self.columns[i].header.as_str(), self.columns[i].unit.as_str()];
        let natural: Vec<usize> = (0..columns.len())
            .map(|i| widest(&mut headings(i).into_iter().chain(columns[i].iter().map(String::as_str))))
            .collect();
        let total = |widths: &[usize]| widths.iter().sum::<usize>() + GAP * widths.len().saturating_sub(1);
        if total(&natural) <= width {
            return self.text();
        }
        // a number is never broken
        let least: Vec<usize> = (0..columns.len())
            .map(|i| {
                let heading = widest(&mut self.columns[i].header.split(' ').chain([headings(i)[1]]));
                let cells = columns[i].iter().map(String::as_str);
                heading.max(match self.columns[i].align {
                    Align::Left => widest(&mut cells.flat_map(|cell| cell.split(' '))),
                    Align::Right | Align::Point => widest(&mut { cells }),
                })
            })
            .collect();
        if total(&least) > width {
            return self.records(width, &columns);
        }
        let mut widths = natural;
        while total(&widths) > width {
            // the widest column that can be narrower
            let widest = (0..widths.len()).filter(|&i| widths[i] > least[i]).max_by_key(|&i| widths[i]);
            let Some(widest) = widest else { break };
            widths[widest] -= 1;
        }
        self.broken_rows(&widths, &columns)
    }

    fn broken_rows(&self, widths: &[usize], columns: &[Vec<String>]) -> String {
        let row = |cells: Vec<&str>| -> String {
            let broken: Vec<Vec<String>> =
                cells.iter().zip(widths).map(|(cell, &width)| lines(cell, width)).collect();
            let height = broken.iter().map(Vec::len).max().unwrap_or(0);
            let line = |k: usize| {
                let parts = broken.iter().zip(widths).zip(&self.columns).map(|((cell, &width), column)| {
                    let part = cell.get(k).map_or("", String::as_str);
                    if column.align == Align::Left {
                        format!("{part:<width$}")
                    } else {
                        format!("{part:>width$}")
                    }
                });
                parts.collect::<Vec<_>>().join("  ").trim_end().to_owned() + "\n"
            };
            (0..height).map(line).collect()
        };
        let mut text = if self.caption.is_empty() { String::new() } else { format!("{}\n\n", self.caption) };
        text += &row(self.columns.iter().map(|column| column.header.as_str()).collect());
        if self.columns.iter().any(|column| !column.unit.is_empty()) {
            text += &row(self.columns.iter().map(|column| column.unit.as_str()).collect());
        }
        let rules: Vec<String> = widths.iter().map(|&width| "─".repeat(width)).collect();
        text += &row(rules.iter().map(String::as_str).collect());
        for k in 0..self.rows.len() {
            text += &row(columns.iter().map(|cells| cells[k].as_str()).collect());
        }
        for note in &self.notes {
            text += &format!("  {note}\n");
        }
        text
    }

    /// One field a line, a blank line between two rows.
    fn records(&self, width: usize, columns: &[Vec<String>]) -> String {
        let names =
            self.columns.iter().map(|column| length(&column.header)).max().unwrap_or(0).min(width / 2);
        let mut text = if self.caption.is_empty() { String::new() } else { format!("{}\n\n", self.caption) };
        for k in 0..self.rows.len() {
            if k > 0 {
                text.push('\n');
            }
            for (column, cells) in self.columns.iter().zip(columns) {
                let value = format!("{} {}", cells[k].trim(), column.unit);
                let name = lines(&column.header, names);
                let value = lines(value.trim(), width.saturating_sub(names + GAP));
                // what is empty is not said
                let height = if cells[k].trim().is_empty() { 0 } else { name.len().max(value.len()) };
                for line in 0..height {
                    let part = |parts: &[String]| parts.get(line).cloned().unwrap_or_default();
                    text += format!("{:<names$}  {}", part(&name), part(&value)).trim_end();
                    text.push('\n');
                }
            }
        }
        for note in &self.notes {
            text += &format!("  {note}\n");
        }
        text
    }
}

fn length(text: &str) -> usize {
    text.chars().count()
}

/// Broken between words; what is short enough stays as it is, with its spaces.
fn lines(text: &str, width: usize) -> Vec<String> {
    if length(text) <= width {
        return vec![text.to_owned()];
    }
    let mut lines = vec![String::new()];
    for word in text.split(' ').filter(|word| !word.is_empty()) {
        match lines.last_mut() {
            Some(line) if line.is_empty() => line.push_str(word),
            Some(line) if length(line) + 1 + length(word) <= width => {
                line.push(' ');
                line.push_str(word);
            }
            _ => lines.push(word.to_owned()),
        }
    }
    lines
}

#[cfg(test)]
mod tests {
    use super::super::Column;
    use super::*;

    fn table() -> Table {
        let columns = vec![Column::text("what it is"), Column::number("size", "µm"), Column::text("remark")];
        let mut table = Table::new("t", "", columns);
        table.row(["friction in the slide", "12.5", "found in all folds"]);
        table.row(["play", "-3.25", ""]);
        table
    }

    #[test]
    fn a_table_that_fits_stays_as_it_is() {
        assert_eq!(table().text_within(100), table().text());
    }

    #[test]
    fn cells_are_broken_between_words_and_numbers_never() {
        let expected = [
            "what it is       size  remark",
            "                   µm",
            "──────────────  ─────  ─────────────",
            "friction in     12.5   found in all",
            "the slide              folds",
            "play            −3.25",
        ];
        assert_eq!(table().text_within(36).lines().collect::<Vec<_>>(), expected);
    }

    #[test]
    fn what_is_still_too_wide_becomes_records() {
        let expected = [
            "what it is  friction",
            "            in the",
            "            slide",
            "size        12.5 µm",
            "remark      found in",
            "            all folds",
            "",
            "what it is  play",
            "size        −3.25 µm",
        ];
        assert_eq!(table().text_within(22).lines().collect::<Vec<_>>(), expected);
    }

    #[test]
    fn no_line_is_longer_and_no_word_is_lost() {
        let words = |text: &str| -> usize {
            text.split_whitespace().filter(|word| !word.starts_with('─')).map(length).sum()
        };
        for width in 20..60 {
            let text = table().text_within(width);
            assert!(text.lines().all(|line| length(line) <= width), "{width}\n{text}");
            assert!(text.contains("12.5") && text.contains("−3.25"), "{width}\n{text}");
            // records name their fields in every row
            assert!(words(&text) + length("remark") >= words(&table().text()), "{width}\n{text}");
        }
    }
}
