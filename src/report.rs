//! Reports: results as words, tables and pictures, in files that open anywhere.
//!
//! Data flows one way. A caller fills a [`Report`] with plain data; [`Report::files`] turns it into
//! the bytes of a self-contained page and of every table and figure on its own. Nothing here reads
//! or writes a file, and the same report always gives the same bytes.
//!
//! - [`chart`]: charts as data, drawn by [`chart::Figure::svg`]
//! - [`pictures`]: the pictures of a rod and of a calibration, from numbers to charts
//! - [`compliance`] · [`rig`] · [`design`] · [`diagnosis`]: results of the library as reports and
//!   as JSON
//! - [`text`]: a report for the terminal · [`table`]: tables to text, HTML, Markdown, CSV ·
//!   [`html`]: the page

mod arms;
mod axes;
pub mod calibration;
pub mod chart;
pub mod comparison;
pub mod compliance;
pub mod design;
pub mod diagnosis;
mod document;
mod draw;
mod event_labels;
mod file_name;
mod files;
pub mod forecast;
mod frame;
pub mod html;
mod labels;
mod legend;
mod length;
mod marks;
mod method;
pub mod pictures;
mod plot;
pub mod poses;
pub mod prediction;
mod prefix;
mod proxy;
pub mod rig;
pub mod rig_plan;
mod rod_drawing;
pub mod runs;
mod scale;
mod sensitivities;
mod swing;
mod switch;
pub mod table;
pub mod text;
mod unbroken;

pub use document::{Block, Card, PageLink, Report, Section, Tone};
