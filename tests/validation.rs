//! Validation against published values: one example a test, each with its source and a tolerance
//! with a reason.

#![allow(clippy::unwrap_used)]

mod beams;
mod flexure;
mod paper;
mod sections;
