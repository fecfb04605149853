//! Which physics a model left out: locate a mismatch, name it, model it, show that the fit
//! improves.
//!
//! The engine ([`crate::inference`]) knows no physics. Each room below is a forward model for it:
//! which effects there are, how they act together, how they are said to people and where they are
//! written.

pub mod calibration;
// pub mod rig;
