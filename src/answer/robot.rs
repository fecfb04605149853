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
/// ```
/// use rodcal::answer::predict;
/// use rodcal::prelude::*;
/// use rodcal::robot::PredictionQuery;
///
/// // an arm of 0.5 m about one axis
/// let link = Hayati { a: 0.5, ..Hayati::default() };
/// let arm = Robot::new("arm", vec![Joint::new("one", Motion::Revolute, link)]);
/// let poses = vec![PredictionQuery::new("1", vec![std::f64::consts::FRAC_PI_2])];
/// let answer = predict(&arm, None, poses, false)?;
/// let pose = &answer.whole_json()["poses"][0];
/// assert!((pose["y_mm"].as_f64().unwrap_or(0.0) - 500.0).abs() < 1e-9, "{pose}");
/// # Ok::<(), rodcal::Error>(())
/// ```
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
///
/// ```
/// use rodcal::answer::predicted;
/// use rodcal::prelude::*;
/// use rodcal::report::prediction::Prediction;
/// use rodcal::robot::PredictionQuery;
///
/// let (file, text) = Robot::builtin("tx90").expect("the program carries it");
/// let robot = Robot::from_text(file, text, None, None)?;
/// let poses = (0..3).map(|k| PredictionQuery::new(k.to_string(), vec![0.1 * k as f64; 6])).collect();
/// let prediction = Prediction::new(&robot, [0.0; 3].into(), poses, false)?;
/// let answer = predicted(robot, prediction);
/// assert_eq!(answer.long.map(|poses| poses.count), Some(3)); // made as they are written
/// # Ok::<(), rodcal::Error>(())
/// ```
pub fn predicted(robot: Robot, prediction: Prediction) -> Answer {
    let answer = Answer::new(json(&robot, &prediction), report(&robot, &prediction));
    let (count, item) = (prediction.tips.len(), move |row| pose_json(&prediction, row));
    Answer { long: Some(LongList::new("poses", count, item)), ..answer }
}
