//! Joint angles that are written to few digits.

use super::*;
use crate::calibration::campaign::Recording;
use crate::diagnosis::Limitation;
use crate::units::DEG;

/// The digit that is said to be coarse, in degrees, where an arm was sent to angles of a step and
/// these were written to another one.
fn coarse(sent_to: f64, written_to: f64) -> Option<f64> {
    let robot = Robot::from_text("tx90.toml", ROBOT, None, None).unwrap();
    let tool = Vector3::new(0.06, 0.01, 0.12);
    let mut random = Random::seeded(5, 0);
    let mut recording = Recording::new(6);
    let rounded = |q: &f64, step: f64| (q / (step * DEG)).round() * step * DEG;
    for _ in 0..90 {
        let q: Vec<f64> = (0..6).map(|_| rounded(&random.uniform(-1.7, 1.7), sent_to)).collect();
        let noise = Vector3::from_fn(|_, _| 15.0 * UM * random.normal());
        let written: Vec<f64> = q.iter().map(|q| rounded(q, written_to)).collect();
        recording.add(&written, robot.flange_at(&q).point(&tool) + noise).unwrap();
    }
    let campaign = Campaign::new(robot, recording).unwrap().with_tool(tool);
    let found = diagnose_as_recorded(&campaign, Mode::None, &Options::default()).unwrap();
    assert!(found.diagnosis.findings.is_empty());
    found.limits.iter().find_map(|limit| match limit {
        Limitation::CoarseAngles(step, tip) => {
            assert!((tip / found.diagnosis.noise - 1.0).abs() < 0.25, "{tip} {}", found.diagnosis.noise);
            Some(*step)
        }
        _ => None,
    })
}

#[test]
fn angles_of_few_digits_are_remarked_where_they_scatter_the_tip() {
    assert_eq!(coarse(1e-6, 0.1), Some(0.1));
    assert_eq!(coarse(1e-6, 0.01), Some(0.01));
    assert_eq!(coarse(1e-6, 1e-4), None);
    // angles that were reached
    assert_eq!(coarse(0.1, 0.1), None);
}
