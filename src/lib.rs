//! **rodcal**: how much a bent measuring rod bends, how accurate a robot is once that is compensated,
//! and which physics a model left out.

pub mod beam;
pub mod closed_form;
pub mod compliance;
pub mod delimited;
pub mod error;
pub mod files;
pub mod material;
pub mod rig;
pub mod rod;
pub mod section;
pub mod spatial;
pub mod units;

pub use error::{Error, Result};
