//! A joint whose zero moved between the calibration and its validation: as after a collision, or
//! where an encoder was mounted again.

use crate::calibration::campaign::{Recording, Refit, Targets};
use crate::calibration::{Validation, validate};
use crate::error::Result;
use crate::robot::{Motion, Parameter, Setup};
use crate::statistics::Estimate;
use crate::units::DEG;

/// So many times smaller an error becomes by another zero, or another place, where that was wrong.
pub const CURED: f64 = 3.0;
/// A larger one is a mistake in the file rather.
const LARGEST: f64 = 5.0 * DEG;
/// Step of a slope, rad.
const STEP: f64 = 1e-5;
/// The tip hardly bends within [`LARGEST`]: the last of so many steps changes nothing.
const STEPS: usize = 4;

/// A zero that has moved.
pub struct MovedZero<'r> {
    /// The joint, from 0.
    pub joint: usize,
    /// By how much, rad.
    pub by: Estimate,
    /// The calibrated robot with it.
    pub setup: Setup<'r>,
}

/// The joint by the zero of which the errors at `recording`, which are those of `before`, become
/// far smaller, where there is one.
///
/// # Errors
/// As [`validate`].
pub fn moved_zero<'r>(
    setup: &Setup<'r>,
    recording: &Recording,
    refit: Refit,
    before: &Validation,
) -> Result<Option<MovedZero<'r>>> {
    let mut best: Option<(f64, MovedZero<'r>)> = None;
    for (joint, own) in setup.robot.joints.iter().enumerate() {
        if own.motion != Motion::Revolute {
            continue;
        }
        let with = |by: f64| {
            let mut setup = setup.clone();
            let theta = Parameter::Theta(joint);
            setup.set(theta, setup.get(theta) + by);
            setup
        };
        let taken = match (&recording.targets, refit) {
            (Targets::Sockets(_), _) => 3 * recording.groups.len(),
            (Targets::Points(_), Refit::BaseTool) => 9,
            (Targets::Points(_), Refit::Nothing) => 0,
        };
        let dof = (3 * recording.len()).saturating_sub(taken + 1);
        let Some((by, left)) = least(&|by| validate(&with(by), recording, refit), before, dof)? else {
            continue;
        };
        if best.as_ref().is_none_or(|(least, _)| left < *least) {
            best = Some((left, MovedZero { joint, by, setup: with(by.value) }));
        }
    }
    Ok(best.filter(|(left, _)| before.summary.rms > CURED * left).map(|(_, moved)| moved))
}

/// The angle of least squares, rad, by Gauss and Newton, and the root mean square that it leaves;
/// `None` where it is none that a zero moves by, and where nothing shows it.
fn least(
    at: &dyn Fn(f64) -> Result<Validation>,
    before: &Validation,
    dof: usize,
) -> Result<Option<(Estimate, f64)>> {
    let (mut by, mut now, mut curvature) = (0.0, before.clone(), 0.0);
    for _ in 0..STEPS {
        let next = at(by + STEP)?;
        let slopes = next.deviations.iter().zip(&now.deviations).map(|(next, now)| (next - now) / STEP);
        let (mut square, mut along) = (0.0, 0.0);
        for (slope, off) in slopes.zip(&now.deviations) {
            square += slope.norm_squared();
            along += slope.dot(off);
        }
        // base and tool take it up where they are fitted again
        if square < 1e-6 * now.deviations.len() as f64 {
            return Ok(None);
        }
        by -= along / square;
        if by.abs() > LARGEST {
            return Ok(None);
        }
        now = at(by)?;
        curvature = square;
    }
    // s² = Σ r² / (ν · Σ (∂r/∂θ)²)
    let squares: f64 = now.errors.iter().map(|error| error * error).sum();
    let std_error = (dof > 0).then(|| (squares / (dof as f64 * curvature)).sqrt());
    Ok(Some((Estimate { value: by, std_error, dof }, now.summary.rms)))
}
