//! Physics that nobody has named: columns against a robot whose links turn and whose tool and place
//! change.

use std::f64::consts::{PI, TAU};

use super::changed::{Case, Row, assert_changes};
use super::*;
use crate::calibration::Compensation;

/// From 0 to 1 over the recording.
fn scaled(values: Vec<f64>) -> Vec<f64> {
    let low = values.iter().copied().fold(f64::INFINITY, f64::min);
    let high = values.iter().copied().fold(f64::NEG_INFINITY, f64::max);
    values.into_iter().map(|value| (value - low) / (high - low)).collect()
}

#[test]
fn links_turn_and_joints_err_together() {
    let campaign = clamps(12);
    let calibration = calibrate(&campaign, Mode::Fea, &Options::default()).unwrap();
    let recording = &campaign.measurements;
    let angles = |j: usize| scaled((0..recording.len()).map(|row| recording.joints(row)[j]).collect());
    let (x, y) = (angles(1), angles(2));
    let either_way = |row: usize| {
        let step = |row: usize| recording.joints(row)[2] - recording.joints(row - 1)[2];
        if row == 0 { 0.0 } else { step(row).signum() }
    };
    let link = "link 3, turned by joint 2 and joint 3";
    let cases: Vec<Case> = vec![
        // the link's frame is where its table ends: α turns about its x axis, β about its y axis,
        // the next joint about z
        (
            "unknown",
            link,
            "about_x_cosines_10_urad",
            Box::new(|r, row, v| r.setup.links[2].alpha += v * (PI * x[row]).cos()),
        ),
        (
            "unknown",
            link,
            "about_y_cosines_01_urad",
            Box::new(|r, row, v| r.setup.links[2].beta += v * (PI * y[row]).cos()),
        ),
        (
            "unknown",
            link,
            "about_z_cosines_11_urad",
            Box::new(|r, row, v| r.q[3] += v * (PI * x[row]).cos() * (PI * y[row]).cos()),
        ),
        (
            "unknown",
            "joint 2 and joint 3, a surface",
            "joint_3_cosines_12_urad",
            Box::new(|r, row, v| r.q[2] += v * (PI * x[row]).cos() * (TAU * y[row]).cos()),
        ),
        (
            "unknown",
            "joint 3, a curve for each direction of approach",
            "reversed_cosine_0_urad",
            Box::new(move |r, row, v| r.q[2] += v * either_way(row)),
        ),
        (
            "unknown",
            "joint 3, a curve for each direction of approach",
            "reversed_cosine_2_urad",
            Box::new(|r, row, v| r.q[2] += v * either_way(row) * (TAU * y[row]).cos()),
        ),
        (
            "unknown",
            "joint 3, a curve for each sign of the torque",
            "reversed_cosine_2_urad",
            Box::new(|r, row, v| r.q[2] += v * r.torque()[2].signum() * (TAU * y[row]).cos()),
        ),
        (
            "unknown",
            "joint 4, twice per turn along its axis",
            "cos_2_along_um",
            Box::new(move |r, row, v| r.setup.links[3].d += v * (2.0 * recording.joints(row)[3]).cos()),
        ),
        (
            "unknown",
            "joint 3, a curve in the tool",
            "y_cosine_2_um",
            Box::new(|r, row, v| r.setup.tool.y += v * (TAU * y[row]).cos()),
        ),
    ];
    assert_changes(&campaign, &calibration, cases);
}

#[test]
fn places_and_ways_to_hold_the_tool_move_it() {
    let campaign = clamps(12);
    let calibration = calibrate(&campaign, Mode::Fea, &Options::default()).unwrap();
    let compensation = Compensation::new(&campaign, Mode::Fea).unwrap();
    let recording = &campaign.measurements;
    let rows = recording.len();
    let tip = |row: usize| super::changed::row(&campaign, &calibration, &compensation, row).tip();
    let (y, z) = (
        scaled((0..rows).map(|row| tip(row).y).collect()),
        scaled((0..rows).map(|row| tip(row).z).collect()),
    );
    // an axis of {W} as the tool sees it
    let seen = |r: &Row, axis: usize| {
        r.at_rest(|kinematics| kinematics.flange.rotation.tr_mul(&Vector3::ith(axis, 1.0)))
    };
    // what the fixture sees of the tool, and where its axes are
    let device = |row: usize| recording.groups[recording.rows[row].group].device.rotation;
    let held =
        move |r: &Row, row: usize| r.at_rest(|kinematics| kinematics.flange.rotation.tr_mul(&device(row)));
    let is_there = |row: usize| recording.groups[recording.rows[row].group].name.to_string() == "clamp 4";
    let cases: Vec<Case> = vec![
        (
            "unknown",
            "orientation, the world's z in the tool",
            "x_y_um",
            Box::new(move |r, _, v| r.setup.tool.x += v * seen(r, 2).y),
        ),
        (
            "unknown",
            "orientation, the world's x in the tool",
            "z_xy_um",
            Box::new(move |r, _, v| r.setup.tool.z += v * seen(r, 0).x * seen(r, 0).y),
        ),
        (
            "unknown",
            "orientation, from the side (0.7 0.0 -0.7)",
            "yz_um",
            Box::new(move |r, row, v| {
                let side = Vector3::new(0.5f64.sqrt(), 0.0, -0.5f64.sqrt());
                let seen = held(r, row) * side;
                r.off += device(row) * side * (v * seen.y * seen.z);
            }),
        ),
        (
            "unknown",
            "orientation, as the fixture sees it",
            "y_zx_um",
            Box::new(move |r, row, v| r.off += device(row).column(1) * (v * held(r, row)[(2, 0)])),
        ),
        (
            // xy + yx over √2 of the tool, xz + zx over √2 of the fixture
            "unknown",
            "orientation, as the fixture sees it",
            "x_second_01_um",
            Box::new(move |r, row, v| {
                let q = held(r, row);
                let both = q[(0, 0)] * q[(1, 2)] + q[(0, 2)] * q[(1, 0)];
                r.off += device(row).column(0) * (v * both);
            }),
        ),
        (
            "unknown",
            "orientation, loose along x − z of the tool",
            "clearance_um",
            Box::new(move |r, _, v| {
                // gravity is along −z of {W}
                let side = Vector3::new(0.5f64.sqrt(), 0.0, -0.5f64.sqrt());
                let pressed = -seen(r, 2).dot(&side).signum();
                r.setup.tool += side * (v * pressed);
            }),
        ),
        (
            "unknown",
            "order, again every 5.0 poses",
            "z_sin_um",
            Box::new(|r, row, v| r.setup.base_position.z += v * (TAU * row as f64 / 5.0).sin()),
        ),
        (
            "unknown",
            "order, again every 5.0 poses",
            "x_cos_um",
            Box::new(|r, row, v| r.setup.base_position.x += v * (TAU * row as f64 / 5.0).cos()),
        ),
        (
            "unknown",
            "order, a curve in the world",
            "y_cosine_3_um",
            Box::new(|r, row, v| {
                r.setup.base_position.y += v * (3.0 * PI * row as f64 / (rows - 1) as f64).cos()
            }),
        ),
        (
            "unknown",
            "over the workspace",
            "x_cosines_012_um",
            Box::new(|r, row, v| r.setup.base_position.x += v * (PI * y[row]).cos() * (TAU * z[row]).cos()),
        ),
        (
            "unknown",
            "each clamp by itself",
            "z_group_3_um",
            Box::new(move |r, row, v| r.off.z += if is_there(row) { v } else { 0.0 }),
        ),
    ];
    assert_changes(&campaign, &calibration, cases);
}

/// A tool that rests on the side to which gravity presses it, along x of {T}: most of it is a tip
/// that is lighter, a rod that is stiffer or a link that bends.
#[test]
fn a_loose_tool_is_no_mass() {
    let campaign = clamps(20);
    let calibration = calibrate(&campaign, Mode::Fea, &Options::default()).unwrap();
    let context = Context::new(&campaign, &calibration).unwrap();
    let by = |row: usize| {
        let there = &context.configurations[row];
        let held: Vector3<f64> = there.flange.rotation.column(0).into();
        held * (80.0 * UM * held.dot(&there.gravity).signum())
    };
    let recorded = recorded(&campaign, &by, 30.0 * UM, 3);
    let found = diagnose_as_recorded(&recorded, Mode::Fea, &Options::default()).unwrap();
    let names: Vec<&str> = found.diagnosis.findings.iter().map(|f| f.effect.name).collect();
    assert!(names.is_empty(), "{names:?}");
    let left = found.diagnosis.discrepancy.and_then(|left| left.location).map(|at| at.to_string());
    assert_eq!(left.as_deref(), Some("orientation, loose along x of the tool"));
}

/// Joints that keep a share of the move before the last one: that runs against the last move on
/// average, and looks like lag.
#[test]
fn what_is_remembered_of_the_move_before_is_no_lag() {
    let campaign = clamps(12);
    let calibration = calibrate(&campaign, Mode::Fea, &Options::default()).unwrap();
    let context = Context::new(&campaign, &calibration).unwrap();
    let with = |back: usize| {
        let by = |row: usize| {
            let there = &context.configurations[row];
            let step =
                |j: usize| row.checked_sub(back).map_or(0.0, |row| context.configurations[row].step[j]);
            (0..6).map(|j| there.tip_jacobian[j] * 4e-4 * step(j)).sum()
        };
        let recorded = recorded(&campaign, &by, 20.0 * UM, 5);
        let found = diagnose_as_recorded(&recorded, Mode::Fea, &Options::default()).unwrap();
        let names: Vec<&str> = found.diagnosis.findings.iter().map(|f| f.effect.name).collect();
        let left = found.diagnosis.discrepancy.and_then(|left| left.location);
        (names, left.map(|location| location.to_string()))
    };
    assert_eq!(with(0), (vec!["readback_lag"], None));
    assert_eq!(with(1), (vec![], Some("order, the last moves of all joints".to_owned())));
}
