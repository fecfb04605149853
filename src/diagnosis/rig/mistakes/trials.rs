//! Mistakes in some of the trials: the others show what is right.
//!
//! Trials whose lines have the same slopes within a quarter are one class. Where there are several,
//! one of them is right: the one that the rod file says, else the largest. Each of the others is
//! compared with that one under every change of units, signs and names
//!
//! ```text
//! χ² = Σ ((s·G − r)/σ)²,   σ² = (G·s_e)² + r_e² + (0.01·r_max)²
//! ```
//!
//! s the slope of a line in one trial, with its error; r that of the line which the change makes of
//! it, in the trials that are right; r_max the largest under the same load. The scatter about the
//! lines counts too: it is that of the others times the factor on the readings.
//!
//! Trials at different stations have no line in common: there the rod file stands between them.

mod explained;
mod ratio;
mod right;
mod table;

pub(super) use self::table::Table;
