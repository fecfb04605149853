//! A report for the terminal: the same words and tables as the page, without the pictures.

use super::table::Table;
use super::unbroken::{JOINT, unbroken};
use super::{Block, Report, Section};

/// Columns that words may take at most.
const WIDTH: usize = 100;

/// The headline, then every section with its words and tables, which take what they need. Warnings
/// are left to stderr.
///
/// ```
/// use rodcal::report::{Report, text};
///
/// let report = Report::new("Stiffness of rod 5#", "Rod 5# is 1.5 % softer.");
/// assert_eq!(text::text(&report), "Rod 5# is 1.5 % softer.\n");
/// ```
pub fn text(report: &Report) -> String {
    text_within(report, usize::MAX)
}

/// The same on a terminal of so many columns: tables are broken between words, or become records.
pub fn text_within(report: &Report, width: usize) -> String {
    let mut text = wrapped_within(&report.headline, width);
    let has_words = |section: &&Section| section.blocks.iter().any(|b| !matches!(b, Block::Figure(_)));
    for section in report.sections.iter().filter(has_words) {
        let heading = &section.heading;
        text += &format!("\n{heading}\n{}\n", "─".repeat(heading.chars().count()));
        for block in &section.blocks {
            match block {
                Block::Paragraph(words) => text += &wrapped_within(words, width),
                Block::List(points) => points.iter().for_each(|point| text += &hanging("- ", point, width)),
                Block::Table(table) => text += &format!("\n{}", table_text(table, width)),
                Block::Figure(_) => {}
            }
        }
    }
    text
}

fn table_text(table: &Table, width: usize) -> String {
    let table = table.shortened("--json has them, and --out writes all into files");
    let bare = Table { caption: String::new(), notes: Vec::new(), ..Table::clone(&table) };
    let notes: String = table.notes.iter().map(|note| hanging("  ", note, width)).collect();
    let caption =
        if table.caption.is_empty() { String::new() } else { wrapped_within(&table.caption, width) + "\n" };
    caption + &bare.text_within(width) + &notes
}

/// Words in lines of at most so many columns, and of 100, each ended by "\n". Lines of the words
/// stay lines.
pub fn wrapped_within(words: &str, width: usize) -> String {
    words.lines().map(|line| hanging("", line, width)).collect()
}

/// One paragraph after `mark`, further lines below its first word, in lines of at most 100 columns.
/// What is longer than a line stays whole, and so does a number with its unit.
pub fn hanging(mark: &str, words: &str, width: usize) -> String {
    let width = width.min(WIDTH);
    let indent = mark.chars().count();
    let (mut text, mut column) = (mark.to_owned(), indent);
    for word in unbroken(words).split(' ').filter(|word| !word.is_empty()) {
        let length = word.chars().count();
        if column > indent && column + 1 + length > width {
            text += &format!("\n{:indent$}", "");
            column = indent;
        } else if column > indent {
            text.push(' ');
            column += 1;
        }
        text.extend(word.chars().map(|letter| if letter == JOINT { ' ' } else { letter }));
        column += length;
    }
    text + "\n"
}

#[cfg(test)]
mod tests {
    use super::super::table::Column;
    use super::*;

    #[test]
    fn words_and_tables_stand_under_their_heading() {
        let mut table =
            Table::new("c", "Compliance.", vec![Column::text("axis"), Column::number("C", "µm/N")]);
        table.row(["x", "-1.5"]);
        let report = Report {
            headline: "It bends.".into(),
            sections: vec![Section::new("Tip", vec![Block::Paragraph("See.".into()), Block::Table(table)])],
            ..Report::default()
        };
        insta::assert_snapshot!(text(&report), @r"
        It bends.

        Tip
        ───
        See.

        Compliance.

        axis     C
              µm/N
        ────  ────
        x     −1.5
        ");
    }

    #[test]
    fn words_wrap_and_nothing_gets_lost() {
        let words = "Dehnung µm/N ".repeat(40);
        let long = "x".repeat(120);
        let text = hanging("- ", &format!("{words}{long} end"), usize::MAX);
        let lines: Vec<&str> = text.lines().collect();
        assert!(lines.iter().all(|line| line.chars().count() <= WIDTH || line.trim() == long), "{text}");
        assert!(lines[1..].iter().all(|line| line.starts_with("  ") && !line.ends_with(' ')), "{text}");
        let back: Vec<&str> = text[2..].split_whitespace().collect();
        assert_eq!(back.join(" "), format!("{words}{long} end"));
        assert_eq!(wrapped_within("one\n\ntwo", WIDTH), "one\n\ntwo\n");
        assert_eq!(wrapped_within(&"y".repeat(WIDTH), WIDTH).lines().count(), 1);
        assert_eq!(wrapped_within(&format!("{} y", "y".repeat(WIDTH - 2)), WIDTH).lines().count(), 1);
        assert_eq!(wrapped_within(&format!("{} y", "y".repeat(WIDTH - 1)), WIDTH).lines().count(), 2);
    }
}
