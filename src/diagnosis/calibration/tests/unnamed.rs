//! Physics that nobody has named: columns against a robot whose links turn and whose tool and place
//! change.

use std::f64::consts::{PI, TAU};

use super::changed::{Case, Row, assert_changes};
use super::*;
use crate::calibration::Compensation;
use crate::calibration::campaign::Recording;
use crate::diagnosis::Limitation;

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
    let compensation = Compensation::new(&campaign, Mode::Fea).unwrap();
    let torque =
        |at: usize| super::changed::row(&campaign, &calibration, &compensation, at).torque()[2].abs();
    let most = (0..recording.len()).map(torque).fold(0.0, f64::max);
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
            "joint 4, turned by joint 2 and joint 3",
            "joint_4_cosines_21_urad",
            Box::new(|r, row, v| r.q[3] += v * (TAU * x[row]).cos() * (PI * y[row]).cos()),
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
            "joint 3, a curve times its torque",
            "reversed_cosine_2_urad",
            Box::new(|r, row, v| r.q[2] += v * r.torque()[2] / most * (TAU * y[row]).cos()),
        ),
        (
            "unknown",
            "joint 3, a wave 2.5 times per revolution, times its torque",
            "loaded_cos_urad",
            Box::new(move |r, row, v| {
                r.q[2] += v * r.torque()[2] / most * (2.5 * recording.joints(row)[2]).cos()
            }),
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
            "order, a walk in the world",
            "z_cosine_7_um",
            Box::new(|r, row, v| {
                r.setup.base_position.z += v * (7.0 * PI * row as f64 / (rows - 1) as f64).cos()
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

/// What is found of something that turns a joint by so much in each row: names, and where the rest
/// is.
fn of_turned(
    campaign: &Campaign,
    noise: f64,
    seed: u64,
    turned: impl Fn(usize) -> (usize, f64),
) -> (Vec<&'static str>, Option<String>) {
    let calibration = calibrate(campaign, Mode::Fea, &Options::default()).unwrap();
    let context = Context::new(campaign, &calibration).unwrap();
    let by = |row: usize| {
        let (joint, turn) = turned(row);
        context.configurations[row].tip_jacobian[joint] * turn
    };
    let recorded = recorded(campaign, &by, noise, seed);
    let found = diagnose_as_recorded(&recorded, Mode::Fea, &Options::default()).unwrap();
    let names = found.diagnosis.findings.iter().map(|f| f.effect.name).collect();
    let left = found.diagnosis.discrepancy.and_then(|left| left.location);
    (names, left.map(|at| at.to_string()))
}

/// A drive that gives way more at some angles than at others: most of it is a wave of its gear.
#[test]
fn a_compliance_that_follows_the_angle_is_no_error_of_the_gear() {
    let campaign = clamps(30);
    let calibration = calibrate(&campaign, Mode::Fea, &Options::default()).unwrap();
    let context = Context::new(&campaign, &calibration).unwrap();
    for (cycles, seed) in [(2.0, 1), (12.0, 0)] {
        let turned = |row: usize| {
            let there = &context.configurations[row];
            (1, 1e-6 * there.torque[1] * (cycles * there.joints[1] + 0.4).sin())
        };
        let place = format!("joint 2, a wave {cycles} times per revolution, times its torque");
        assert_eq!(of_turned(&campaign, 15.0 * UM, seed, turned), (vec![], Some(place)));
        // the same without a load is an error of the gear
        let unloaded = |row: usize| (1, 60e-6 * (cycles * context.configurations[row].joints[1] + 0.4).sin());
        assert_eq!(of_turned(&campaign, 15.0 * UM, seed, unloaded), (vec!["transmission_error"], None));
    }
}

/// A drive that is turned by what is left of earlier loads, of half a width of a fifth of their
/// range.
#[test]
fn what_earlier_torques_have_left_is_no_lag_and_no_slip() {
    let campaign = clamps(30);
    let calibration = calibrate(&campaign, Mode::Fea, &Options::default()).unwrap();
    let context = Context::new(&campaign, &calibration).unwrap();
    let torques: Vec<f64> = context.configurations.iter().map(|there| there.torque[1]).collect();
    let low = torques.iter().copied().fold(f64::INFINITY, f64::min);
    let width = 0.2 * (torques.iter().copied().fold(f64::NEG_INFINITY, f64::max) - low);
    let mut left = 0.0f64;
    let mut kept = Vec::new();
    for torque in &torques {
        left = left.max(torque - width).min(torque + width);
        kept.push((torque - left) / width);
    }
    for seed in 0..2 {
        let found = of_turned(&campaign, 15.0 * UM, seed, |row| (1, 60e-6 * kept[row]));
        assert_eq!(found, (vec![], Some("joint 2, what earlier torques have left".to_owned())));
    }
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

/// A tracker's points with a wave of 180 mm over the place along y: no few cosines describe it.
#[test]
fn a_fine_error_over_the_place_is_said_to_follow_it() {
    let with = |size: f64| {
        let robot = Robot::from_text("tx90.toml", ROBOT, None, None).unwrap();
        let tool = Vector3::new(0.06, 0.01, 0.12);
        let mut random = Random::seeded(11, 0);
        let mut recording = Recording::new(6);
        for _ in 0..70 {
            let q: Vec<f64> = (0..6).map(|_| random.uniform(-1.7, 1.7)).collect();
            let tip = robot.flange_at(&q).point(&tool);
            let noise = Vector3::from_fn(|_, _| 20.0 * UM * random.normal());
            let wave = Vector3::new(1.0, -0.5, 0.7) * (size * (TAU * tip.y / 0.18).sin());
            recording.add(&q, tip + wave + noise).unwrap();
        }
        let campaign = Campaign::new(robot, recording).unwrap().with_tool(tool);
        let found = diagnose_as_recorded(&campaign, Mode::None, &Options::default()).unwrap();
        let left = found.diagnosis.discrepancy.and_then(|left| left.location);
        (found.diagnosis.findings.len(), left.map(|location| location.to_string()))
    };
    assert_eq!(with(0.0), (0, None));
    let (findings, left) = with(150.0 * UM);
    let left = left.unwrap_or_default();
    assert!(findings == 0 && left.starts_with("place along y, "), "{findings} {left}");
}

/// What fades over several moves: the last three alone leave much of it.
#[test]
fn what_fades_from_move_to_move_is_said_to_follow_the_moves() {
    let campaign = clamps(16);
    let calibration = calibrate(&campaign, Mode::Fea, &Options::default()).unwrap();
    let context = Context::new(&campaign, &calibration).unwrap();
    let mut kept = 0.0;
    let shares: Vec<f64> = (context.configurations.iter())
        .map(|there| {
            kept = 0.75 * kept + there.step[1];
            4e-4 * kept
        })
        .collect();
    let by = |row: usize| context.configurations[row].tip_jacobian[1] * shares[row];
    let recorded = recorded(&campaign, &by, 10.0 * UM, 6);
    let found = diagnose_as_recorded(&recorded, Mode::Fea, &Options::default()).unwrap();
    let left = found.diagnosis.discrepancy.and_then(|left| left.location).map(|at| at.to_string());
    assert_eq!(left.as_deref(), Some("joint 2, its moves, of which 0.75 is left after the next"));
}

/// Play of joint 5 by load, where the true masses pull to the other side in a few poses of hardly
/// any load.
#[test]
fn poses_of_hardly_any_load_are_not_misread_beside_play() {
    let campaign = clamps(30);
    let calibration = calibrate(&campaign, Mode::Fea, &Options::default()).unwrap();
    let context = Context::new(&campaign, &calibration).unwrap();
    let torque = |row: usize| context.configurations[row].torque[4];
    let by = |row: usize| context.configurations[row].tip_jacobian[4] * 4e-4 * (torque(row) + 0.1).signum();
    let turned = (0..150).filter(|&row| torque(row) < 0.0 && torque(row) + 0.1 > 0.0).count();
    assert!(turned > 1, "{turned}");
    let recorded = recorded(&campaign, &by, 8.0 * UM, 7);
    let found = diagnose_as_recorded(&recorded, Mode::Fea, &Options::default()).unwrap();
    let names: Vec<String> =
        found.diagnosis.findings.iter().map(|f| format!("{} {}", f.effect, f.location)).collect();
    assert_eq!(names, ["backlash joint 5"]);
    let is_said =
        |limit: &Limitation| matches!(limit, Limitation::UnknownSide(4, poses) if poses.len() == turned);
    assert!(found.limits.iter().any(is_said), "{:?}", found.limits);
}
