//! A single number that was another one while the validation was recorded: the zero of a joint, as
//! after a collision or where an encoder was mounted again; the scale of its encoder, or of the
//! measuring device.

use crate::calibration::campaign::{Recording, Refit, Targets};
use crate::calibration::{Calibration, Estimated, Validation, validate};
use crate::error::Result;
use crate::robot::{Motion, Parameter, Setup};
use crate::statistics::Estimate;
use crate::units::DEG;

/// So many times smaller an error becomes by another number or place, where that was wrong.
pub const CURED: f64 = 3.0;
/// A zero that moved farther is a mistake in the file rather, rad.
const LARGEST_TURN: f64 = 5.0 * DEG;
/// And so is a scale that is farther from 1.
const LARGEST_SCALE: f64 = 0.05;
/// Step of a slope, rad or 1.
const STEP: f64 = 1e-5;
/// Errors hardly bend within the largest change: the last of so many steps changes nothing.
const STEPS: usize = 4;

/// What has changed.
#[derive(Debug, Clone, Copy, PartialEq)]
enum Number {
    /// The zero of a joint, from 0, rad.
    Zero(usize),
    /// The scale of a joint's angles, from 0, less 1.
    Encoder(usize),
    /// The scale of measured positions, less 1.
    Scale,
}

/// A number that has changed, and all else without that.
pub struct Changed<'r> {
    number: Number,
    by: Estimate,
    /// The calibrated robot as it was then.
    pub setup: Setup<'r>,
    /// The recording as it should have been.
    pub recording: Recording,
}

/// The number by which the errors at `recording`, which are those of `before`, become far smaller,
/// where there is one.
///
/// # Errors
/// As [`validate`].
pub fn changed<'r>(
    setup: &Setup<'r>,
    recording: &Recording,
    refit: Refit,
    before: &Validation,
) -> Result<Option<Changed<'r>>> {
    let joints = setup.robot.joints.iter().enumerate();
    let turning = joints.filter(|(_, joint)| joint.motion == Motion::Revolute);
    let numbers = turning.flat_map(|(joint, _)| [Number::Zero(joint), Number::Encoder(joint)]);
    let has_points = matches!(recording.targets, Targets::Points(_));
    let taken = match (has_points, refit) {
        (false, _) => 3 * recording.groups.len(),
        (true, Refit::BaseTool) => 9,
        (true, Refit::Nothing) => 0,
    };
    let dof = (3 * recording.len()).saturating_sub(taken + 1);
    let mut best: Option<(f64, Changed<'r>)> = None;
    for number in numbers.chain(has_points.then_some(Number::Scale)) {
        let at = |by: f64| {
            let (setup, recording) = number.changed(setup, recording, by);
            validate(&setup, &recording, refit)
        };
        let Some((by, left)) = least(&at, before, number.largest(), dof)? else { continue };
        if best.as_ref().is_none_or(|(least, _)| left < *least) {
            let (setup, recording) = number.changed(setup, recording, by.value);
            best = Some((left, Changed { number, by, setup, recording }));
        }
    }
    Ok(best.filter(|(left, _)| before.summary.rms > CURED * left).map(|(_, changed)| changed))
}

impl Number {
    fn largest(self) -> f64 {
        match self {
            Number::Zero(_) => LARGEST_TURN,
            Number::Encoder(_) | Number::Scale => LARGEST_SCALE,
        }
    }

    /// Robot and recording with the number changed `by` so much.
    fn changed<'r>(self, setup: &Setup<'r>, recording: &Recording, by: f64) -> (Setup<'r>, Recording) {
        let (mut setup, mut recording) = (setup.clone(), recording.clone());
        match (self, &mut recording.targets) {
            (Number::Zero(joint), _) => {
                let theta = Parameter::Theta(joint);
                setup.set(theta, setup.get(theta) + by);
            }
            (Number::Encoder(joint), _) => {
                let (skipped, step) = (joint, recording.joint_count);
                recording.joint_values.iter_mut().skip(skipped).step_by(step).for_each(|q| *q /= 1.0 + by);
            }
            (Number::Scale, Targets::Points(points)) => {
                points.iter_mut().for_each(|point| *point /= 1.0 + by);
            }
            (Number::Scale, Targets::Sockets(_)) => {}
        }
        (setup, recording)
    }
}

impl Changed<'_> {
    /// In words, from where the `calibration` has it, as well as that is known.
    pub fn cause(&self, calibration: &Calibration) -> String {
        match self.number {
            Number::Zero(joint) => {
                let is_it = |own: &&Estimated| own.parameter == Parameter::Theta(joint);
                let known = calibration.parameters.iter().find(is_it).and_then(|own| own.std_error);
                let dof = calibration.fit.degrees_of_freedom;
                let known = Estimate { value: 0.0, std_error: known.or(Some(0.0)), dof };
                let by = Estimate::sum(&[self.by, known]).show(DEG);
                format!("the zero of joint {}, which moved by {by}°", joint + 1)
            }
            Number::Encoder(joint) => {
                let scale = Estimate { value: 1.0 + self.by.value, ..self.by }.show(1.0);
                format!("angles of joint {} that are {scale} times as large as they should be", joint + 1)
            }
            Number::Scale => {
                let scale = Estimate { value: 1.0 + self.by.value, ..self.by }.show(1.0);
                format!("positions that are {scale} times as large as they should be")
            }
        }
    }
}

/// The change of least squares, by Gauss and Newton, and the root mean square that it leaves, m;
/// `None` where it is larger than the `largest`, and where nothing shows it.
fn least(
    at: &dyn Fn(f64) -> Result<Validation>,
    before: &Validation,
    largest: f64,
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
        if by.abs() > largest {
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
