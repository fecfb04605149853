//! What a diagnosis needs of memory, before it begins.
//!
//! ```text
//! bytes ≈ 8·poses·columns·1.3 + 150 MB        columns: what all candidates have for each pose;
//!                                             half as much again with a rod
//! ```
//!
//! The columns of all candidates are most of it. What searches keep has limits of its own
//! (`inference/part_products.rs`, `gram_cache.rs`), and nothing grows with the square of the poses.

use crate::calibration::campaign::Campaign;
use crate::error::{Error, Result};
use crate::robot::Motion;

/// Bytes beyond which a diagnosis is refused.
pub const MEMORY_LIMIT: f64 = 2e9;
/// Numbers for each pose: of a joint's gear and approach; of a pair of joints and of a link by a
/// pair of them; of all else.
const OF_JOINT: f64 = 1450.0;
const OF_PAIR: f64 = 30.0;
const OF_LINK: f64 = 9.0;
const OF_ALL: f64 = 5000.0;
/// What all else that has a number for each pose takes beside the columns, and what does not grow
/// with the poses.
const BESIDE: f64 = 1.3;
/// So many times as much with a rod: robots with and without masses are compared, side by side.
const WITH_ROD: f64 = 1.5;
const ANYWAY: f64 = 150e6;

/// About the bytes that the diagnosis of so many poses takes with so many joints that turn, and
/// with a rod or without.
///
/// ```
/// use rodcal::diagnosis::calibration::memory_needed;
///
/// assert!(memory_needed(1000, 6, false) < 0.4e9);
/// assert!(memory_needed(10_000, 6, false) < 2e9);
/// assert!(memory_needed(10_000, 6, true) > 2e9);
/// ```
pub fn memory_needed(poses: usize, joints: usize, has_rod: bool) -> f64 {
    let (joints, pairs) = (joints as f64, 0.5 * joints as f64 * (joints as f64 - 1.0));
    let columns = OF_JOINT * joints + (OF_PAIR + OF_LINK * joints) * pairs + OF_ALL;
    let rods = if has_rod { WITH_ROD } else { 1.0 };
    8.0 * poses as f64 * columns * BESIDE * rods + ANYWAY
}

/// Refuses what needs too much.
///
/// ```
/// use rodcal::diagnosis::calibration::check_memory;
/// use rodcal::prelude::*;
///
/// let mut campaign = Campaign::read("campaigns/tx90-5/campaign.toml".as_ref())?;
/// check_memory(&campaign)?; // 60 poses
/// campaign.measurements = campaign.measurements.subset(&vec![0; 30_000]);
/// assert!(check_memory(&campaign).is_err());
/// # Ok::<(), rodcal::Error>(())
/// ```
///
/// # Errors
/// [`Error::NotApplicable`] where a diagnosis would need more than [`MEMORY_LIMIT`].
pub fn check_memory(campaign: &Campaign) -> Result<()> {
    let poses = campaign.measurements.len();
    let joints = campaign.robot.joints.iter().filter(|joint| joint.motion == Motion::Revolute).count();
    let needed = |poses: usize| memory_needed(poses, joints, campaign.rod.is_some());
    if needed(poses) <= MEMORY_LIMIT {
        return Ok(());
    }
    let most = (MEMORY_LIMIT - ANYWAY) / (needed(1) - ANYWAY);
    let every = (poses as f64 / most).ceil();
    Err(Error::NotApplicable {
        what: format!("a diagnosis of {}", campaign.file),
        why: format!(
            "its {poses} poses of {joints} joints need about {:.1} GB of memory; the limit is {:.0} GB",
            needed(poses) / 1e9,
            MEMORY_LIMIT / 1e9
        ),
        hint: format!(
            "diagnose at most {:.0} of them: one row in {every:.0}, or a part of the recording; calibrate takes all",
            most.floor()
        ),
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_is_too_much_is_refused_with_what_can_be_done() {
        use crate::calibration::campaign::Recording;
        use crate::robot::{Hayati, Joint, Robot};
        let joint = || Joint::new("one", Motion::Revolute, Hayati::default());
        let mut recording = Recording::new(6);
        for _ in 0..60_000 {
            recording.add(&[0.0; 6], Default::default()).unwrap();
        }
        let robot = Robot::new("arm", (0..6).map(|_| joint()).collect());
        let refused = |count: usize| {
            let rows: Vec<usize> = (0..count).collect();
            let campaign = Campaign::new(robot.clone(), recording.subset(&rows)).unwrap();
            check_memory(&campaign).map_err(|error| format!("{error}; {}", error.hint().unwrap_or_default()))
        };
        assert!(refused(10_000).is_ok());
        let message = refused(60_000).unwrap_err();
        assert!(message.contains("60000 poses of 6 joints") && message.contains("one row in 6"), "{message}");
    }
}
