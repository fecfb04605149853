//! The law of what is left: proposed where something is left that no effect explains.
//!
//! A law is a **place** × a **variable** × a **form** × a **memory**,
//!
//! ```text
//! Δy = w·Σ_j a_j·g_j(x/X; s)
//! ```
//!
//! w what one unit of the law does to a datum (the place says it), x the variable, X its largest
//! size, g the functions of the form, s its one number that is not linear (an exponent, a corner,
//! a period, a lag; of a loop three, or five). The amplitudes a are integrated in closed form
//! (`score.rs`), s on a grid with its prior, both beside the findings, the numbers of the files
//! and the zeros, which are fitted anew with every law. What a form costs is in that integral; its
//! prior is the share that its place and its fellows leave it.
//!
//! ```text
//! sites (forward model) → remainder → smooth curves → forms → held out → a law, or why there is none
//! ```
//!
//! A law is a proposal beside what is unexplained. It changes no finding.

mod another_way;
mod beyond;
mod bouc_wen;
mod choice;
mod constant;
mod described;
mod folds;
mod form;
mod grid;
mod left;
mod lists;
mod looked;
mod measured;
mod memory;
mod pairs;
mod peak;
mod posterior;
mod proposal;
mod proposed;
mod remainder;
mod scan;
mod shape;
mod site;
mod stops;

#[cfg(test)]
pub mod points;
#[cfg(test)]
mod tests;

pub use bouc_wen::LoopShape;
pub use constant::{Constant, OpenEnd};
pub use form::{Form, FormConstant};
pub use memory::Memory;
pub use proposal::{propose, propose_where};
pub use proposed::{Beside, Law, LawRival, NextRecord, Point, Proposed, Refusal, Second};
pub use site::{Course, Instant, Measure, Recorded, Site};
pub use stops::Stops;
