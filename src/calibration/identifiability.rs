//! Which combinations of the free parameters the recording says something about, and which it does
//! not.
//!
//! Every kind of parameter has a plausible range: how far a robot as built can be from its drawing.
//! With the Jacobian whitened by the noise and scaled by those ranges, a singular value below one
//! belongs to a direction that the data know less about than the drawing. Such a direction is held
//! where the nominal robot has it, and reported; nothing else is regularised.

use nalgebra::DMatrix;

use crate::error::Result;
use crate::linalg::thin_svd;
use crate::robot::{Parameter, Setup};

/// Scatter that an arm may have, as a share of its reach: an uncalibrated industrial arm is off by
/// millimetres per metre, and that is no scatter.
pub const MOST_SCATTER: f64 = 5e-3;

/// Share of its plausible range that a parameter may have from held directions and still count as
/// identified.
const SHARE: f64 = 0.1;
/// How firmly a direction is held: standard deviation relative to the plausible range.
const FIRMNESS: f64 = 1e-4;

/// A combination of parameters that the data do not identify.
#[derive(Debug, Clone, PartialEq)]
#[non_exhaustive]
pub struct UnidentifiedDirection {
    /// Coefficients of (ρ − ρ₀)/range, of norm 1, one per free parameter.
    pub direction: Vec<f64>,
    /// Plausible ranges, SI.
    pub ranges: Vec<f64>,
    /// Nominal values ρ₀, SI.
    pub nominal: Vec<f64>,
    /// The standard error of the combination by the data alone, relative to the plausible range; ∞
    /// for none.
    pub relative_error: f64,
}

impl UnidentifiedDirection {
    /// vᵀ·(ρ − ρ₀)/range over the firmness.
    pub(super) fn residual(&self, p: &[f64]) -> f64 {
        let offset = p.iter().zip(&self.nominal).map(|(p, p0)| p - p0);
        offset.zip(self.slopes()).map(|(offset, slope)| offset * slope).sum()
    }

    /// Its derivatives.
    pub(super) fn slopes(&self) -> impl Iterator<Item = f64> {
        self.direction.iter().zip(&self.ranges).map(|(v, range)| v / (range * FIRMNESS))
    }
}

/// How far a parameter of a robot as built may be from its nominal value, SI. The largest torque on
/// each joint, N·m, makes compliances comparable: no drive deflects by more than 10 mrad. Without
/// it a compliance may be anything.
///
/// ```
/// use rodcal::calibration::plausible_range;
/// use rodcal::robot::Parameter;
///
/// assert_eq!(plausible_range(Parameter::D(2), &[]), 0.02); // 20 mm
/// // a drive that carries 50 N·m deflects by no more than 10 mrad
/// assert_eq!(plausible_range(Parameter::Compliance(0), &[50.0]), 0.01 / 50.0);
/// ```
pub fn plausible_range(parameter: Parameter, largest_torques: &[f64]) -> f64 {
    match parameter {
        // base and tool may be anywhere, but a rough start has been there: what it has not seen, no
        // fit will
        Parameter::BasePosition(_) | Parameter::BaseRotation(_) => 0.02,
        Parameter::D(_) | Parameter::A(_) | Parameter::Tool(_) => 0.02,
        Parameter::Theta(_) => 0.1,
        Parameter::Alpha(_) | Parameter::Beta(_) => 0.04,
        Parameter::Compliance(joint) => {
            0.01 / largest_torques
                .get(joint)
                .map_or(f64::MIN_POSITIVE, |torque| torque.max(f64::MIN_POSITIVE))
        }
    }
}

/// The directions that `jacobian` (whitened, free parameters only, with all else the data can
/// absorb projected out) does not identify.
///
/// # Errors
/// As [`thin_svd`].
pub(super) fn unidentified(
    jacobian: &DMatrix<f64>,
    ranges: &[f64],
    setup: &Setup,
    free: &[Parameter],
) -> Result<Vec<UnidentifiedDirection>> {
    let scaled = DMatrix::from_fn(jacobian.nrows(), free.len(), |i, k| jacobian[(i, k)] * ranges[k]);
    let svd = thin_svd(&scaled)?;
    let nominal: Vec<f64> = free.iter().map(|&p| setup.get(p)).collect();
    Ok((0..free.len())
        .filter(|&k| svd.singular_values[k] < 1.0)
        .map(|k| UnidentifiedDirection {
            direction: svd.v.column(k).iter().copied().collect(),
            ranges: ranges.to_vec(),
            nominal: nominal.clone(),
            relative_error: 1.0 / svd.singular_values[k],
        })
        .collect())
}

/// For each free parameter whether it stands on data: false where held directions make more than a
/// tenth of its plausible range.
pub(super) fn identified(held: &[UnidentifiedDirection], count: usize) -> Vec<bool> {
    let share = |k: usize| held.iter().map(|held| held.direction[k].powi(2)).sum::<f64>().sqrt();
    (0..count).map(|k| share(k) < SHARE).collect()
}

/// How far a robot as built may be from its drawing in a parameter along the unidentified
/// directions, SI.
pub(super) fn unidentified_range(held: &[UnidentifiedDirection], k: usize) -> f64 {
    held.iter().map(|held| (held.direction[k] * held.ranges[k]).powi(2)).sum::<f64>().sqrt()
}
