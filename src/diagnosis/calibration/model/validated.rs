//! Errors of a calibrated robot at its validation, of which a diagnosis has seen nothing.

/// By this factor an error has grown, and is not the same within what some poses show of it.
const WORSE: f64 = 1.1;
/// So many times the error that is expected is far from it.
const FAR: f64 = 2.0;
/// And so many times contradicts it, however the device may scatter.
const CONTRADICTS: f64 = 10.0;

/// Errors of a validation's poses.
#[derive(Debug, Clone, PartialEq)]
#[non_exhaustive]
pub struct Validated {
    /// Of the calibration as it is, m, one per pose.
    pub before: Vec<f64>,
    /// The same calibrated again with what was found; `None` where nothing of it can be written.
    pub after: Option<Vec<f64>>,
    /// Mean error that the recording leads to expect, m: of its poses while they were held out,
    /// with what was found; where none was held out, of the calibration's own.
    pub expected: f64,
    /// True where poses were held out.
    pub is_held_out: bool,
    /// What the validation shows by itself, where it is far from what is expected.
    pub own: Option<OwnDiagnosis>,
}

/// What the diagnosis of a validation by itself says.
#[derive(Debug, Clone, PartialEq)]
#[non_exhaustive]
pub struct OwnDiagnosis {
    /// What belongs to its poses and not to the robot, in words: `a shift (front/0, after row 2)`.
    pub events: Vec<String>,
    /// Errors without its events, m, one per pose; as they are where there is nothing of the kind.
    pub errors: Vec<f64>,
    /// What would belong to the robot, in words: `a transmission error (joint 3)`.
    pub of_robot: Vec<String>,
    /// What an error follows that no effect explains: `follows joint 2`; empty where it follows
    /// nothing that was recorded. `None` where all is explained but scatter.
    pub unexplained: Option<String>,
    /// What scatters without any cause, per coordinate, m.
    pub scatter: f64,
}

impl Validated {
    /// Mean error of the calibration as it is, and with what was found, m.
    pub fn means(&self) -> (f64, Option<f64>) {
        (mean(&self.before), self.after.as_deref().map(mean))
    }

    /// True where what was found makes the robot worse at these poses.
    pub fn is_worse(&self) -> bool {
        matches!(self.means(), (before, Some(after)) if after > WORSE * before)
    }

    /// True where the poses contradict what the recording leads to expect: something is named or
    /// seen, or the error is larger than any device that measures less accurately makes it.
    pub fn is_mismatch(&self) -> bool {
        let (before, after) = self.means();
        let is_larger = after.unwrap_or(before) > CONTRADICTS * self.expected;
        let is_seen = |own: &OwnDiagnosis| {
            !own.events.is_empty() || !own.of_robot.is_empty() || own.unexplained.is_some()
        };
        self.is_far() && (is_larger || self.own.as_ref().is_some_and(is_seen))
    }

    /// True where the error is far from what the recording leads to expect.
    pub fn is_far(&self) -> bool {
        let (before, after) = self.means();
        after.unwrap_or(before) > FAR * self.expected
    }
}

impl OwnDiagnosis {
    /// Mean error without its events, m.
    pub fn mean(&self) -> f64 {
        mean(&self.errors)
    }

    /// True where the rest is no longer far from what is `expected`, m.
    pub fn explain(&self, expected: f64) -> bool {
        self.mean() <= FAR * expected
    }
}

/// Mean length, m.
pub fn mean(errors: &[f64]) -> f64 {
    errors.iter().sum::<f64>() / errors.len().max(1) as f64
}
