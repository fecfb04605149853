//! The first pose, of which nobody knows from where the arm came to it.
//!
//! Play by approach, friction and lag say nothing there, and do something. What is as far off at
//! the first pose as they move others is what they have done, and no misreading.

use nalgebra::Vector3;

use super::super::model::CalibrationModel;
use crate::diagnosis::Limitation;
use crate::inference::{Diagnosis, Finding, Kind, Location};

/// So many times as far as all others: the first move may be the longest.
const FARTHER: f64 = 2.0;

/// Share of the other poses that what joints keep of their way moves: a clamp has fewer.
const OTHERS: f64 = 0.8;

/// Takes the first pose out of the findings, where it is no farther off; it is a remark then.
pub fn unknown_arrival(model: &CalibrationModel, diagnosis: &mut Diagnosis) -> Option<Limitation> {
    let by_row = |finding: &Finding| model.by_row(&model.response_of(finding));
    let farthest = |rows: &[Vector3<f64>]| rows.iter().map(|row| row.norm()).fold(0.0, f64::max);
    let of_history: f64 = (diagnosis.findings.iter())
        .map(|finding| (finding, by_row(finding)))
        .filter(|(finding, rows)| is_of_history(finding, rows))
        .map(|(_, rows)| farthest(&rows))
        .sum();
    let is_first = |finding: &Finding| {
        finding.parts.len() == 1 && matches!(finding.location, Location::Pose { row: 0, .. })
    };
    let position = diagnosis.findings.iter().position(is_first)?;
    let off = farthest(&by_row(&diagnosis.findings[position]));
    (off < FARTHER * of_history).then(|| {
        let pose = diagnosis.findings.remove(position);
        Limitation::UnknownArrival(pose.location.to_string(), off)
    })
}

/// True for what moves nearly all poses but the first, of which it knows nothing.
fn is_of_history(finding: &Finding, rows: &[Vector3<f64>]) -> bool {
    let Some((first, others)) = rows.split_first() else { return false };
    let moved = others.iter().filter(|row| row.norm() > 0.0).count() as f64;
    finding.kind() == Kind::Physics && first.norm() == 0.0 && moved >= OTHERS * others.len() as f64
}
