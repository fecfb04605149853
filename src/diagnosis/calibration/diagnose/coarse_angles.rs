//! Joint angles that are written to so few digits that the tip scatters by it.
//!
//! ```text
//! σ² = Σⱼ stepⱼ²/12·|Jⱼ|²/3       of a coordinate, mean over the poses; rounding errors are uniform
//! ```
//!
//! Angles to which an arm was sent, and which it reached, are round without any error: then less is
//! left than rounding would leave.

use super::super::model::Context;
use super::super::model::covariance::Source;
use crate::diagnosis::Limitation;
use crate::units::DEG;

/// Variance of rounding over that which is left: less is not worth a word, more is not there.
const SHARE: std::ops::RangeInclusive<f64> = 0.25..=2.0;

/// The remark where rounding is a large part of what is left, m per coordinate.
pub fn coarse_angles(context: &Context, left: f64) -> Option<Limitation> {
    let coarsest = context.written.iter().copied().fold(0.0, f64::max);
    let rows = 0..context.configurations.len();
    let squares: f64 = rows.map(|row| Source::Written.spread(context, row).trace() / 3.0).sum();
    let variance = squares / context.configurations.len().max(1) as f64;
    SHARE
        .contains(&(variance / left.powi(2)))
        .then(|| Limitation::CoarseAngles(coarsest / DEG, variance.sqrt()))
}
