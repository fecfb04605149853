//! **rodcal**: how much a bent measuring rod bends, how accurate a robot is once that is compensated,
//! and which physics a model left out.

pub mod beam;
pub mod calibration;
pub mod compliance;
pub mod diagnosis;
pub mod material;
pub mod report;
pub mod rig;
pub mod robot;
pub mod rod;
pub mod section;

// The ground floor has a crate of its own (`crates/base`); its rooms keep their names here.
pub use rodcal_base::units;
#[doc(hidden)]
pub use rodcal_base::{
    delimited, error, files, least_squares, linalg, parallel, spatial, statistics, toml_text,
};

pub use error::{Error, Result};
