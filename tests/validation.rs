//! Validation against published values: one example a test, each with its source and a tolerance with a reason.

#![allow(clippy::unwrap_used)]

#[path = "validation/beams.rs"]
mod beams;
#[path = "validation/flexure.rs"]
mod flexure;
#[path = "validation/paper.rs"]
mod paper;
#[path = "validation/sections.rs"]
mod sections;
