//! Poses that were recorded in the order of an angle: what happened between them and what the robot
//! does there look alike.

use crate::calibration::campaign::{Recording, Targets};

/// Fewer poses on one side lie beyond the others by chance.
const FEWEST: usize = 4;
/// So large a share of the pairs of a pose before and one after has its angles in one order.
const IN_ORDER: f64 = 0.95;

/// The joint, from 0, by the angles of which the poses before `row`, from 0, differ most from those
/// after it, where nearly all pairs of one before and one after lie one way (the share of them is
/// U/mn: H. B. Mann, D. R. Whitney, *Ann. Math. Stat.* 18 (1947) 50–60). Of sockets only the poses
/// of one count.
pub fn in_order_of(recording: &Recording, row: usize) -> Option<usize> {
    let group = match recording.targets {
        Targets::Sockets(_) => recording.rows.get(row).map(|row| row.group),
        Targets::Points(_) => None,
    };
    let counts = |other: &usize| group.is_none_or(|group| recording.rows[*other].group == group);
    let (before, after): (Vec<usize>, Vec<usize>) =
        (0..recording.len()).filter(counts).partition(|other| *other < row);
    if before.len().min(after.len()) < FEWEST {
        return None;
    }
    let share = |joint: usize| {
        let angle = |row: &usize| recording.joints(*row)[joint];
        let below = |a: &usize| after.iter().filter(|b| angle(a) < angle(b)).count();
        let share = before.iter().map(below).sum::<usize>() as f64 / (before.len() * after.len()) as f64;
        share.max(1.0 - share)
    };
    let all = (0..recording.joint_count).map(|joint| (joint, share(joint)));
    let most = all.max_by(|a, b| a.1.total_cmp(&b.1))?;
    (most.1 > IN_ORDER).then_some(most.0)
}
