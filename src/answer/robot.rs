//! Where is a robot's tip?

use nalgebra::Vector3;

use super::Answer;
use crate::error::Result;
use crate::report::prediction::{Prediction, json, report};
use crate::robot::{PredictionQuery, Robot};

/// Tips at poses, with their uncertainties where the robot knows them; `tool` is the tip in {T}, m,
/// where it is not the one that the robot was calibrated with. Joint values are as poses of a table
/// are ([`Robot::poses_from_csv`]).
///
/// # Errors
/// As [`Prediction::new`].
pub fn predict(
    robot: &Robot,
    tool: Option<Vector3<f64>>,
    poses: Vec<PredictionQuery>,
    is_aligned: bool,
) -> Result<(Answer, Prediction)> {
    let tool = tool.unwrap_or_else(|| robot.tip.map(|tip| tip.at).unwrap_or_default());
    let prediction = Prediction::new(robot, tool, poses, is_aligned)?;
    Ok((Answer::new(json(robot, &prediction), report(robot, &prediction)), prediction))
}
