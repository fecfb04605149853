//! A report as plain data: title, headline, sections, tables and figures.

use serde::Serialize;

use super::chart::Figure;
use super::table::Table;

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

    fn blocks(&self) -> impl Iterator<Item = &Block> {
        self.sections.iter().flat_map(|section| &section.blocks)
    }
}
