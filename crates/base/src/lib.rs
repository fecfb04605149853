//! The ground floor of rodcal: what knows nothing of rods and robots.
//!
//! - [`error`]: the one error type · [`files`]: text in, whole files out · [`units`]: SI inside,
//!   these at the boundary
//! - [`limits`]: how much a file may hold
//! - [`delimited`], [`toml_text`]: tables and TOML whose errors name file, line and column
//! - [`linalg`], [`least_squares`], [`linear_program`], [`dual`], [`spatial`], [`statistics`]:
//!   numbers
//! - [`expression`]: formulas that people write
//! - [`parallel`]: jobs side by side whose results do not depend on it

pub mod delimited;
pub mod dual;
pub mod error;
pub mod expression;
pub mod files;
pub mod least_squares;
pub mod limits;
pub mod linalg;
pub mod linear_program;
pub mod optimal_design;
pub mod parallel;
pub mod spatial;
pub mod statistics;
pub mod toml_text;
pub mod units;

pub use error::{Error, Result};
