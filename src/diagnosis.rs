//! Which physics a model left out: the forward models of a rig and of a calibration, with all the
//! effects that they know.
//!
//! [`crate::inference`] finds which of them a recording needs. Here is what they are: one folder of
//! effects for each world (`rig/effects`, `calibration/effects`), and the model in which they act.

pub mod calibration;
mod diagnosed;
mod law_formula;
mod limitation;
mod one_law;
pub mod rig;
mod suspicion;

pub use diagnosed::Diagnosed;
pub use limitation::Limitation;
pub use suspicion::Suspicion;
