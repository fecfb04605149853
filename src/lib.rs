//! **rodcal**: how much a bent measuring rod bends, how accurate a robot is once that is compensated,
//! and which physics a model left out.

pub mod beam;
pub mod calibration;
pub mod compliance;
pub mod delimited;
pub mod diagnosis;
pub mod error;
pub mod files;
pub mod inference;
pub mod least_squares;
pub mod linalg;
pub mod material;
pub mod parallel;
// pub mod report;
pub mod rig;
pub mod robot;
pub mod rod;
pub mod section;
pub mod spatial;
pub mod statistics;
pub mod toml_text;
pub mod trial;
pub mod units;

pub use error::{Error, Result};
