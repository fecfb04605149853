//! **rodcal**: how much a bent measuring rod bends, how accurate a robot is once that is compensated,
//! and which physics a model left out.

pub mod error;
pub mod files;
pub mod least_squares;
pub mod linalg;
pub mod statistics;
pub mod units;

pub use error::{Error, Result};
