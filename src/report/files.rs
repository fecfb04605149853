//! A report as files.

use super::document::Report;
use super::file_name::{file_name, page_name};
use super::html;
use crate::delimited::visible_lines;
use crate::error::Result;

impl Report {
    /// Names and bytes of all files of the report: `index.html` (or its own page), each figure as
    /// SVG, each table as CSV and as Markdown. Write them with [`crate::files::write_together`].
    ///
    /// # Errors
    /// [`crate::Error::Numerical`] where a table cannot be written as CSV.
    pub fn files(&self) -> Result<Vec<(String, Vec<u8>)>> {
        // control characters of names are no HTML and no XML
        let shown = |text: String| visible_lines(&text).into_owned().into_bytes();
        let mut files = vec![(page_name(&self.page), shown(html::page(self)))];
        for (i, figure) in self.figures().enumerate() {
            let name = file_name(&self.page, "figure", i + 1, &figure.name);
            files.push((format!("{name}.svg"), shown(figure.svg())));
        }
        for (i, table) in self.tables().enumerate() {
            let name = file_name(&self.page, "table", i + 1, &table.name);
            files.push((format!("{name}.csv"), table.csv()?.into_bytes()));
            files.push((format!("{name}.md"), table.markdown().into_bytes()));
        }
        Ok(files)
    }
}

#[cfg(test)]
mod tests {
    use super::super::chart::{Chart, Figure, Mark, Style};
    use super::super::document::{Block, Section};
    use super::super::table;
    use super::*;

    fn report() -> Report {
        let line = |slope: f64| Mark::Line {
            label: "a & b".into(),
            points: vec![[0.0, 0.0], [10.0, 10.0 * slope]],
            style: Style::nth(1),
        };
        let chart = Chart::new("<one>", "x / mm", "y / µm").with(line(33.0));
        let mut table =
            table::Table::new("../C 22", "Compliance", vec![table::Column::number("C22", "µm/N")]);
        table.row(["33.0"]);
        Report {
            title: "Rod".into(),
            headline: "It bends.".into(),
            sections: vec![Section::new(
                "Lines",
                vec![Block::Figure(Figure::from(chart).named("lines")), Block::Table(table)],
            )],
            ..Report::default()
        }
    }

    #[test]
    fn every_figure_and_table_is_also_a_file_of_a_safe_name() {
        let files = report().files().expect("renders");
        let names: Vec<&str> = files.iter().map(|(name, _)| name.as_str()).collect();
        assert_eq!(names, ["index.html", "figure-1-lines.svg", "table-1-c-22.csv", "table-1-c-22.md"]);
        assert!(files.iter().all(|(_, bytes)| !bytes.is_empty()));
    }

    #[test]
    fn the_same_report_gives_the_same_bytes() {
        assert_eq!(report().files().expect("renders"), report().files().expect("renders"));
    }

    #[test]
    fn a_report_is_also_data() {
        let json = serde_json::to_value(report()).expect("serialises");
        assert_eq!(json["sections"][0]["blocks"][1]["Table"]["rows"][0][0], "33.0");
    }
}
