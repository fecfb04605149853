//! What the way of recording does: angles that are read before the arm has settled.
//!
//! ```text
//! readback_lag   Σ leverⱼ·f·(qⱼ − qⱼ before)       f: the share of the last move that was still to come when q was read
//! ```
//!
//! of one joint, or of all with one share.

use super::LAG;
use crate::diagnosis::calibration::scene::{Entry, Scene, entry, linear};

pub(super) fn all(scene: &Scene) -> Vec<Entry> {
    let fraction = || linear("fraction", 1.0, LAG);
    let joints: Vec<usize> = (0..scene.joint_count()).collect();
    let of_all = scene.column(|_, posture| joints.iter().map(|&j| posture.lever[j] * posture.step[j]).sum());
    let together = entry("readback_lag", "all joints", vec![(fraction(), of_all)]);
    let single = joints.iter().map(|&j| {
        let column = scene.turn(j, |_, posture| posture.step[j]);
        entry("readback_lag", format!("joint {}", j + 1), vec![(fraction(), column)])
    });
    std::iter::once(together).chain(single).collect()
}
