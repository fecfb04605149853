//! Reports: results as words, tables and pictures, in files that open anywhere.
//!
//! Data flows one way. A caller fills a [`Report`] with plain data; [`Report::files`] turns it into the
//! bytes of a self-contained page and of every table and figure on its own. Nothing here reads or
//! writes a file, and the same report always gives the same bytes.
//!
//! - [`chart`]: charts as data, drawn by [`chart::Figure::svg`]
//! - [`pictures`]: the pictures of a rod and of a calibration, from numbers to charts
//! - [`compliance`] · [`rig`] · [`diagnosis`]: results of the library as reports and as JSON
//! - [`text`]: a report for the terminal · [`table`]: tables to text, HTML, Markdown, CSV · [`html`]: the page

mod axes;
pub mod calibration;
pub mod chart;
pub mod comparison;
pub mod compliance;
pub mod diagnosis;
mod draw;
mod flags;
pub mod html;
mod labels;
mod legend;
mod marks;
pub mod pictures;
mod plot;
pub mod prediction;
pub mod rig;
mod scale;
pub mod table;
pub mod text;

use serde::Serialize;

use crate::error::Result;
use chart::Figure;
use table::Table;

/// A report as plain data.
#[derive(Debug, Clone, Default, Serialize)]
pub struct Report {
    /// What was done, for example "Stiffness of rod 5#".
    pub title: String,
    /// The result in one sentence, with numbers and units.
    pub headline: String,
    /// What the reader must know before trusting it, one sentence or two each.
    pub warnings: Vec<String>,
    /// The body.
    pub sections: Vec<Section>,
    /// Where it all comes from: name and value, for example input files, options, version.
    pub provenance: Vec<(String, String)>,
}

/// A part of a report under its own heading.
#[derive(Debug, Clone, Default, Serialize)]
pub struct Section {
    /// Heading.
    pub heading: String,
    /// What stands below it, in this order.
    pub blocks: Vec<Block>,
}

/// A piece of a section.
#[derive(Debug, Clone, Serialize)]
pub enum Block {
    /// Plain words.
    Paragraph(String),
    /// Points of a list.
    List(Vec<String>),
    /// A table; numbered through the report.
    Table(Table),
    /// A figure; numbered through the report.
    Figure(Figure),
}

impl Section {
    /// A section with this heading and these blocks.
    pub fn new(heading: impl Into<String>, blocks: Vec<Block>) -> Self {
        Section { heading: heading.into(), blocks }
    }
}

impl Report {
    /// All figures in the order of the page.
    pub fn figures(&self) -> impl Iterator<Item = &Figure> {
        self.blocks().filter_map(|block| match block {
            Block::Figure(figure) => Some(figure),
            _ => None,
        })
    }

    /// All tables in the order of the page.
    pub fn tables(&self) -> impl Iterator<Item = &Table> {
        self.blocks().filter_map(|block| match block {
            Block::Table(table) => Some(table),
            _ => None,
        })
    }

    /// Names and bytes of all files of the report: `index.html`, each figure as SVG, each table as CSV and as Markdown.
    /// Write them with [`crate::files::write_together`].
    ///
    /// # Errors
    /// [`crate::Error::Numerical`] where a table cannot be written as CSV.
    pub fn files(&self) -> Result<Vec<(String, Vec<u8>)>> {
        let mut files = vec![("index.html".to_owned(), html::page(self).into_bytes())];
        for (i, figure) in self.figures().enumerate() {
            let name = file_name("figure", i, &figure.name);
            files.push((format!("{name}.svg"), figure.svg().into_bytes()));
        }
        for (i, table) in self.tables().enumerate() {
            let name = file_name("table", i, &table.name);
            files.push((format!("{name}.csv"), table.csv()?.into_bytes()));
            files.push((format!("{name}.md"), table.markdown().into_bytes()));
        }
        Ok(files)
    }

    fn blocks(&self) -> impl Iterator<Item = &Block> {
        self.sections.iter().flat_map(|section| &section.blocks)
    }
}

/// "figure-1-rod-shape": the number makes it unique, the rest is safe on every file system.
fn file_name(kind: &str, index: usize, name: &str) -> String {
    let safe: String =
        name.to_lowercase().chars().map(|c| if c.is_ascii_alphanumeric() { c } else { '-' }).collect();
    let words: Vec<&str> = safe.split('-').filter(|word| !word.is_empty()).collect();
    let number = (index + 1).to_string();
    [kind, &number].into_iter().chain(words).collect::<Vec<_>>().join("-")
}

#[cfg(test)]
mod tests {
    use super::chart::{Chart, Mark, Style};
    use super::*;

    fn report() -> Report {
        let line = |slope: f64| Mark::Line {
            label: "a & b".into(),
            points: vec![[0.0, 0.0], [10.0, 10.0 * slope]],
            style: Style::nth(1),
        };
        let chart = Chart::new("<one>", "x / mm", "y / µm").with(line(33.0));
        let mut table = Table::new("../C 22", "Compliance", vec![table::Column::number("C22", "µm/N")]);
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
