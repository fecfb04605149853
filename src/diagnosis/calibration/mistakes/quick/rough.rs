//! The start of a fit: base and tool by the nominal robot. Rows that a mistake touches hardly count
//! there either.

use nalgebra::{Matrix3, Vector3};

use super::super::draft::Draft;
use super::density::{MEDIAN, weight_of};
use super::loaded_robot::LoadedRobot;
use super::means::minus_means;
use crate::robot::Robot;
use crate::spatial::Pose;
use crate::statistics::median;

/// A fit that leaves more, as a share of the reach, fails.
pub const FAILED: f64 = 5e-3;
const MOST_TURNS: usize = 12;
/// Rows of which the median says what the nominal robot leaves.
const ENOUGH: usize = 60;
/// Times that the middle of a socket is looked for roughly.
const ROUGH_MEANS: usize = 4;

/// Base and tool by the nominal robot, with the median length of what is left, m.
pub(super) struct Rough {
    pub bases: Vec<Pose>,
    pub tool: Vector3<f64>,
    pub median: f64,
}

/// What the nominal robot leaves, m (median), of rows that are enough to see it.
pub fn left_by(draft: &Draft, robot: &Robot, reach: f64) -> f64 {
    rough(&draft.thinned(ENOUGH), robot, reach).map_or(f64::INFINITY, |rough| rough.median)
}

/// True where that is more than any robot leaves.
pub fn has_failed(draft: &Draft, body: &LoadedRobot) -> bool {
    left_by(draft, body.robot, body.reach) > FAILED * body.reach
}

/// Where base and tool are by a robot whose tip is `reach` (m) away from its first joint at most;
/// `None` where nothing can be computed.
pub(super) fn rough(draft: &Draft, robot: &Robot, reach: f64) -> Option<Rough> {
    let flanges: Vec<Pose> = (0..draft.len()).map(|row| robot.flange_at(draft.joints(row))).collect();
    if draft.has_sockets() {
        let tool = draft.tool.unwrap_or_default();
        let tips: Vec<Vector3<f64>> = flanges.iter().map(|flange| flange.point(&tool)).collect();
        let mut weight = vec![1.0; tips.len()];
        let mut middle = f64::INFINITY;
        for _ in 0..ROUGH_MEANS {
            let left: Vec<f64> = minus_means(&tips, draft, &weight).iter().map(|r| r.norm()).collect();
            middle = median(&left)?;
            weight = left.iter().map(|left| weight_of(left / (middle / MEDIAN).max(1e-9))).collect();
        }
        return Some(Rough { bases: Vec::new(), tool, median: middle });
    }
    let points: Vec<Vector3<f64>> = (0..draft.len()).map(|row| draft.point(row)).collect();
    let mut best: Option<Rough> = None;
    let guess = draft.tool.unwrap_or_default();
    // a clamp whose place is free places nothing
    let counts: Vec<f64> =
        draft.group.iter().map(|group| f64::from(u8::from(!draft.is_loose(*group)))).collect();
    for start in [guess, Vector3::zeros(), Vector3::x() * 0.1, Vector3::z() * 0.1] {
        let mut tool = start;
        let mut weight = counts.clone();
        let mut before = f64::INFINITY;
        for _ in 0..MOST_TURNS {
            let tips: Vec<Vector3<f64>> = flanges.iter().map(|flange| flange.point(&tool)).collect();
            let bases: Vec<Pose> = (0..draft.stations)
                .map(|station| placed(&tips, &points, &weight, |row| draft.station[row] == station))
                .collect::<Option<_>>()?;
            let mut sum = (Vector3::zeros(), 0.0);
            let mut left = Vec::with_capacity(points.len());
            for (row, flange) in flanges.iter().enumerate() {
                let base = &bases[draft.station[row]];
                let off = points[row] - base.point(&tips[row]);
                sum.0 += flange.rotation.tr_mul(&base.rotation.tr_mul(&off)) * weight[row];
                sum.1 += weight[row];
                left.push(off.norm());
            }
            let counted = left.iter().zip(&counts).filter(|(_, counts)| **counts > 0.0);
            let median = median(&counted.map(|(left, _)| *left).collect::<Vec<_>>())?;
            if !median.is_finite() {
                return None;
            }
            if best.as_ref().is_none_or(|best| median < best.median) {
                best = Some(Rough { bases, tool, median });
            }
            if median > 0.9 * before {
                break;
            }
            before = median;
            tool += sum.0 / f64::max(sum.1, f64::MIN_POSITIVE);
            let scale = (median / MEDIAN).max(1e-9);
            weight =
                left.iter().zip(&counts).map(|(left, counts)| counts * weight_of(left / scale)).collect();
        }
        if best.as_ref().is_some_and(|best| best.median < 3e-3 * reach) {
            break;
        }
    }
    best
}

/// The motion of some tips that brings them closest to their points (Kabsch), weighted.
pub fn placed(
    tips: &[Vector3<f64>],
    points: &[Vector3<f64>],
    weight: &[f64],
    is_of: impl Fn(usize) -> bool,
) -> Option<Pose> {
    let rows: Vec<usize> = (0..tips.len()).filter(|&row| is_of(row)).collect();
    let total: f64 = rows.iter().map(|&row| weight[row]).sum::<f64>().max(f64::MIN_POSITIVE);
    let mean = |points: &[Vector3<f64>]| {
        rows.iter().map(|&row| points[row] * weight[row]).sum::<Vector3<f64>>() / total
    };
    let (centre, goal) = (mean(tips), mean(points));
    let spread: Matrix3<f64> =
        rows.iter().map(|&row| (points[row] - goal) * (tips[row] - centre).transpose() * weight[row]).sum();
    if spread.iter().any(|x| !x.is_finite()) {
        return None;
    }
    let svd = spread.svd(true, true);
    let (u, v_t) = (svd.u?, svd.v_t?);
    let handed = (u.determinant() * v_t.determinant()).signum();
    // the smallest singular value is the last
    let rotation = u * Matrix3::from_diagonal(&Vector3::new(1.0, 1.0, handed)) * v_t;
    Some(Pose { rotation, origin: goal - rotation * centre })
}
