//! A report as plain data: title, headline, sections, tables and figures.

use serde::{Deserialize, Serialize};

use super::chart::Figure;
use super::table::Table;

/// A report as plain data.
#[derive(Debug, Clone, Default, Serialize, Deserialize)]
#[non_exhaustive]
pub struct Report {
    /// Name of its page among others of one directory, `rod` for `rod.html`; nothing for
    /// `index.html`.
    pub page: String,
    /// The other pages, where there are several.
    pub pages: Vec<PageLink>,
    /// What was done, for example "Stiffness of rod 5#".
    pub title: String,
    /// The result in one sentence, with numbers and units.
    pub headline: String,
    /// What a reader in a hurry takes away: the answer, before and after, how sure, the verdict.
    pub cards: Vec<Card>,
    /// What the reader must know before trusting it, one sentence or two each.
    pub warnings: Vec<String>,
    /// The body.
    pub sections: Vec<Section>,
    /// How its numbers were found, a paragraph each.
    pub method: Vec<String>,
    /// Where it all comes from: name and value, for example input files, options, version.
    pub provenance: Vec<(String, String)>,
    /// The file beside its page that has the result as JSON; empty where there is none.
    pub result_file: String,
}

/// Another page of the same directory.
#[derive(Debug, Clone, PartialEq, Eq, Serialize, Deserialize)]
pub struct PageLink {
    /// Its file: `rod.html`.
    pub file: String,
    /// Its title.
    pub title: String,
    /// What it answers, in a sentence.
    pub answer: String,
}

/// One number or word of the overview.
#[derive(Debug, Clone, PartialEq, Eq, Serialize, Deserialize)]
pub struct Card {
    /// What it is: "Error before and after".
    pub label: String,
    /// The number with its unit, or the word.
    pub value: String,
    /// What to know of it, in a few words.
    pub detail: String,
    /// How good it is.
    pub tone: Tone,
}

/// How good what a card says is; the words say it too, for whoever sees no colour.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Tone {
    /// Neither good nor bad.
    Neutral,
    /// As it should be.
    Good,
    /// To be looked at.
    Attention,
    /// Not as it should be.
    Bad,
}

impl Card {
    /// A card that is neither good nor bad.
    pub fn new(label: impl Into<String>, value: impl Into<String>, detail: impl Into<String>) -> Self {
        Card { label: label.into(), value: value.into(), detail: detail.into(), tone: Tone::Neutral }
    }

    /// The same with a tone.
    pub fn toned(self, tone: Tone) -> Self {
        Card { tone, ..self }
    }
}

/// A part of a report under its own heading.
#[derive(Debug, Clone, Default, Serialize, Deserialize)]
#[non_exhaustive]
pub struct Section {
    /// Heading.
    pub heading: String,
    /// What stands below it, in this order.
    pub blocks: Vec<Block>,
}

/// A piece of a section.
#[derive(Debug, Clone, Serialize, Deserialize)]
#[non_exhaustive]
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
    /// A report with a title and its result in one sentence, and nothing else yet.
    pub fn new(title: impl Into<String>, headline: impl Into<String>) -> Self {
        Report { title: title.into(), headline: headline.into(), ..Report::default() }
    }

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
