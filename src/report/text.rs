//! A report for the terminal: the same words and tables as the page, without the pictures.

use super::{Block, Report, Section};

/// The headline, then every section with its words and tables. Warnings are left to stderr.
pub fn text(report: &Report) -> String {
    let mut text = format!("{}\n", report.headline);
    let has_words = |section: &&Section| section.blocks.iter().any(|b| !matches!(b, Block::Figure(_)));
    for section in report.sections.iter().filter(has_words) {
        let heading = &section.heading;
        text += &format!("\n{heading}\n{}\n", "─".repeat(heading.chars().count()));
        for block in &section.blocks {
            match block {
                Block::Paragraph(words) => text += &format!("{words}\n"),
                Block::List(points) => points.iter().for_each(|point| text += &format!("- {point}\n")),
                Block::Table(table) => text += &format!("\n{}", table.text()),
                Block::Figure(_) => {}
            }
        }
    }
    text
}

#[cfg(test)]
mod tests {
    use super::super::table::{Column, Table};
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
}
