//! Where is a robot's tip?

use nalgebra::Vector3;

use super::{Answer, LongList};
use crate::error::Result;
use crate::report::prediction::{Prediction, json, pose_json, report};
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
) -> Result<Answer> {
    let tool = tool.unwrap_or_else(|| robot.tip.map(|tip| tip.at).unwrap_or_default());
    let prediction = Prediction::new(robot, tool, poses, is_aligned)?;
    Ok(predicted(robot.clone(), prediction))
}

/// What a prediction says; its poses, of which there may be a million, as a long list.
pub fn predicted(robot: Robot, prediction: Prediction) -> Answer {
    let answer = Answer::new(json(&robot, &prediction), report(&robot, &prediction));
    let (count, item) = (prediction.tips.len(), move |row| pose_json(&prediction, row));
    Answer { long: Some(LongList::new("poses", count, item)), ..answer }
}
