//! Where the tips of a draft are, by a robot as it stands in the fit, and how they move with its
//! numbers.

use nalgebra::{DMatrix, Vector3};

use super::super::draft::Draft;
use super::loaded_robot::LoadedRobot;
use super::means::minus_means;
use crate::robot::{Kinematics, Loads, Parameter, Setup};
use crate::spatial::{Pose, skew, times};
use crate::units::STANDARD_GRAVITY;

/// A state of the fit.
#[derive(Clone)]
pub(super) struct FitState<'a> {
    pub setup: Setup<'a>,
    pub bases: Vec<Pose>,
}

/// Torques and deflections where the robot stands now.
pub(super) fn load(
    draft: &Draft,
    body: &LoadedRobot,
    state: &FitState,
    torque: &mut [f64],
    deflection: &mut [Vector3<f64>],
) {
    let with = &body.compensation;
    let count = draft.joint_count;
    let mut kinematics = Kinematics::new(&state.setup);
    for row in 0..draft.len() {
        let torque = &mut torque[row * count..][..count];
        kinematics.update(draft.joints(row), torque);
        let device = &draft.devices[draft.group[row]];
        let in_world = times(&device.rotation, &with.contact_force);
        let tip_force = match state.bases.get(draft.station[row]) {
            Some(base) => base.rotation.tr_mul(&in_world),
            None => in_world,
        };
        let loads = Loads { gravity: body.robot.gravity, payload: with.payload, tip_force };
        kinematics.torques(&loads, torque);
        let r = &kinematics.flange.rotation;
        deflection[row] = r.tr_mul(&kinematics.structural_deflection(&loads));
        if let Some(compliance) = &with.compliance {
            let down = r.tr_mul(&body.robot.gravity) / STANDARD_GRAVITY;
            deflection[row] +=
                times(&compliance.gravity, &down) + times(&compliance.force, &r.tr_mul(&tip_force));
        }
    }
}

/// By row, in {W} of its station (with sockets in {0}); the columns of the free parameters and, by
/// station, of its base, are filled in where they are asked for.
pub(super) fn residuals(
    draft: &Draft,
    state: &FitState,
    torque: &[f64],
    deflection: &[Vector3<f64>],
    columns: Option<(&[Parameter], &mut DMatrix<f64>)>,
    weight: &[f64],
) -> Vec<Vector3<f64>> {
    let off = from_points(draft, tips(draft, state, torque, deflection, columns));
    minus_means(&off, draft, weight)
}

/// From the point of every row to its tip; with sockets the tip itself.
pub fn from_points(draft: &Draft, mut tips: Vec<Vector3<f64>>) -> Vec<Vector3<f64>> {
    if !draft.has_sockets() {
        tips.iter_mut().enumerate().for_each(|(row, tip)| *tip -= draft.point(row));
    }
    tips
}

/// The tips of the rows, and the columns as [`residuals`] has them.
pub(super) fn tips(
    draft: &Draft,
    state: &FitState,
    torque: &[f64],
    deflection: &[Vector3<f64>],
    mut columns: Option<(&[Parameter], &mut DMatrix<f64>)>,
) -> Vec<Vector3<f64>> {
    let count = draft.joint_count;
    let mut kinematics = Kinematics::new(&state.setup);
    let mut tips = Vec::with_capacity(draft.len());
    for row in 0..draft.len() {
        let torque = &torque[row * count..][..count];
        kinematics.update(draft.joints(row), torque);
        kinematics.tip += times(&kinematics.flange.rotation, &deflection[row]);
        let base = state.bases.get(draft.station[row]).copied().unwrap_or(Pose::IDENTITY);
        let tip = base.point(&kinematics.tip);
        tips.push(tip);
        if let Some((free, block)) = &mut columns {
            for (k, &parameter) in free.iter().enumerate() {
                let column = times(&base.rotation, &kinematics.column(parameter, torque));
                block.fixed_view_mut::<3, 1>(3 * row, k).copy_from(&column);
            }
            if !state.bases.is_empty() {
                let first = free.len() + 6 * draft.station[row];
                let arm = -skew(&(tip - base.origin));
                (0..3).for_each(|axis| block[(3 * row + axis, first + axis)] = 1.0);
                block.fixed_view_mut::<3, 3>(3 * row, first + 3).copy_from(&arm);
            }
        }
    }
    tips
}
