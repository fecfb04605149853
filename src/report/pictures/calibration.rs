//! The pictures of a calibration: what it left at every pose, how far off the robot then is and
//! where, what was corrected, and how the ways of calibrating compare.
//!
//! Each function takes plain numbers and returns a figure with its caption. Numbers that are not
//! finite are left out. Where there are too many to be seen one by one, they are summed up and the
//! caption says how.

mod against;
mod convergence;
mod errors;
mod intervals;
mod isometric;
mod residuals;
mod vectors;
mod workspace;

pub use against::{Abscissa, residuals_against};
pub use convergence::{Convergence, convergence};
pub use errors::{MethodErrors, cumulative_errors, error_distribution};
pub use intervals::{ModeComparison, ParameterCorrection, mode_comparison, parameter_corrections};
pub use residuals::{ModeResiduals, PoseResidual, ResidualGroup, residuals_by_group};
pub use vectors::{PoseVector, residual_vectors, residual_vectors_of};
pub use workspace::{PoseError, error_over_workspace, uncertainty_over_workspace};

use super::super::scale::label;
use super::{significant, typeset};

/// As many points of one panel can still be distinguished.
const MOST_POINTS: usize = 2000;

/// A round number, or the multiple of one, with its unit.
fn round_amount(value: f64, step: f64, unit: &str) -> String {
    format!("{}\u{a0}{unit}", label(value, step))
}

/// A number with its unit, as it stands in titles, notes and captions.
fn amount(value: f64, unit: &str) -> String {
    format!("{}\u{a0}{unit}", typeset(&significant(value, 2)))
}
