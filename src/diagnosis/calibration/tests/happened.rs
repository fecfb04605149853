//! What happened to fixture and robot: columns against a fixture that is moved, and a robot that is
//! moved or warms up.

use std::f64::consts::PI;

use super::changed::{Case, Row, assert_changes};
use super::*;
use crate::calibration::Compensation;
use crate::calibration::campaign::{Distance, GroupName};
use crate::diagnosis::calibration::laws::sites::sites;
use crate::spatial::{Pose, exponential};

fn axis(axis: usize) -> Vector3<f64> {
    Vector3::ith(axis, 1.0)
}

/// What a device in another place than the file says adds to the recorded place of the tip: it
/// reads the tip in its own frame.
fn read_elsewhere(r: &mut Row<'_>, file: &Pose, shift: Vector3<f64>, turn: Vector3<f64>) {
    let actual = Pose { rotation: exponential(&turn) * file.rotation, origin: file.origin + shift };
    let tip = r.tip();
    r.off = file.point(&actual.inverse().point(&tip)) - tip;
}

#[test]
fn clamps_and_base_move_as_a_whole() {
    let campaign = clamps(12);
    let calibration = calibrate(&campaign, Mode::Fea, &Options::default()).unwrap();
    let recording = &campaign.measurements;
    let still = Vector3::zeros();
    let is_there = |row: usize| recording.groups[recording.rows[row].group].name.to_string() == "clamp 2";
    let device = recording.groups.iter().find(|group| group.name.to_string() == "clamp 2").unwrap().device;
    let own: Vec<usize> = (0..recording.len()).filter(|row| is_there(*row)).collect();
    // the share of its poses that are over
    let over = |row: usize| own.iter().position(|k| *k == row).map(|k| k as f64 / (own.len() - 1) as f64);
    let cases: Vec<Case> = vec![
        (
            "clamp_pose",
            "clamp 2",
            "dy_um",
            Box::new(move |r, row, v| {
                if is_there(row) {
                    read_elsewhere(r, &device, axis(1) * v, still);
                }
            }),
        ),
        (
            "clamp_pose",
            "clamp 2",
            "rx_urad",
            Box::new(move |r, row, v| {
                if is_there(row) {
                    read_elsewhere(r, &device, still, axis(0) * v);
                }
            }),
        ),
        (
            "clamp_shift",
            "clamp 2, after pose 16",
            "dz_um",
            Box::new(move |r, row, v| {
                if is_there(row) && row >= 16 {
                    read_elsewhere(r, &device, axis(2) * v, still);
                }
            }),
        ),
        (
            "base_shift",
            "after pose 20",
            "dy_um",
            Box::new(|r, row, v| r.setup.base_position.y += if row >= 20 { v } else { 0.0 }),
        ),
        (
            "base_shift",
            "after pose 20",
            "rz_urad",
            Box::new(|r, row, v| {
                let foot = r.at_rest(|kinematics| kinematics.joints[0].origin);
                r.turn_base(foot, axis(2) * if row >= 20 { v } else { 0.0 });
            }),
        ),
        (
            "base_shift",
            "after pose 20",
            "rx_urad",
            Box::new(|r, row, v| {
                let foot = r.at_rest(|kinematics| kinematics.joints[0].origin);
                r.turn_base(foot, axis(0) * if row >= 20 { v } else { 0.0 });
            }),
        ),
        (
            "clamp_drift",
            "clamp 2, evenly over its poses",
            "dy_um",
            Box::new(move |r, row, v| r.off.y -= v * over(row).unwrap_or(0.0)),
        ),
        (
            "clamp_drift",
            "clamp 2, settling over 20 % of its poses",
            "dx_um",
            Box::new(move |r, row, v| {
                let settled = |over: f64| 1.0 - (-over / 0.2).exp();
                r.off.x -= v * over(row).map_or(0.0, settled);
            }),
        ),
        (
            "unknown",
            "order at clamp 2, a curve in the world",
            "z_cosine_2_um",
            Box::new(move |r, row, v| {
                r.off.z += v * over(row).map_or(0.0, |over| (2.0 * PI * over).cos());
            }),
        ),
        ("outlier", "pose 7", "dz_um", Box::new(|r, row, v| r.off.z += if row == 6 { v } else { 0.0 })),
    ];
    assert_changes(&campaign, &calibration, cases);
}

#[test]
fn what_warms_up_grows_with_its_clock() {
    let mut campaign = clamps(12);
    // faster and faster, and colder first
    let time = |row: usize| 100.0 * row as f64 + (row * row) as f64;
    let temperature = |row: usize| 21.0 + (0.2 * row as f64).sin();
    for (k, row) in campaign.measurements.rows.iter_mut().enumerate() {
        (row.time, row.temperature) = (Some(time(k)), Some(temperature(k)));
    }
    let calibration = calibrate(&campaign, Mode::Fea, &Options::default()).unwrap();
    let rows = campaign.measurements.len();
    let about_mean = |number: &dyn Fn(usize) -> f64| {
        let mean = (0..rows).map(number).sum::<f64>() / rows as f64;
        (0..rows).map(|row| number(row) - mean).collect::<Vec<f64>>()
    };
    let warmth = about_mean(&temperature);
    let clock = about_mean(&time);
    let share = about_mean(&|row| time(row) / time(rows - 1));
    let cold = about_mean(&|row| (-time(row) / (0.1 * time(rows - 1))).exp());
    let cases: Vec<Case> = vec![
        (
            "thermal_drift",
            "base, with temperature",
            "x_um_per_k",
            Box::new(|r, row, v| r.setup.base_position.x += v * warmth[row]),
        ),
        (
            "thermal_drift",
            "tool, with time",
            "z_um_per_h",
            Box::new(|r, row, v| r.setup.tool.z += v * clock[row]),
        ),
        (
            "thermal_drift",
            "base, with order",
            "y_um",
            Box::new(|r, row, v| r.setup.base_position.y += v * share[row]),
        ),
        (
            "thermal_drift",
            "base, turning, with temperature",
            "rx_urad_per_k",
            Box::new(|r, row, v| {
                let foot = r.at_rest(|kinematics| kinematics.joints[0].origin);
                r.turn_base(foot, axis(0) * v * warmth[row]);
            }),
        ),
        (
            "unknown",
            "time, a curve of the base that turns about the vertical",
            "about_2_cosine_3_urad",
            Box::new(|r, row, v| {
                let foot = r.at_rest(|kinematics| kinematics.joints[0].origin);
                r.turn_base(foot, axis(2) * v * (3.0 * PI * time(row) / time(rows - 1)).cos());
            }),
        ),
        (
            "thermal_drift",
            "tool, with warm-up over 10 % of the recording",
            "x_um",
            Box::new(|r, row, v| r.setup.tool.x += v * cold[row]),
        ),
    ];
    assert_changes(&campaign, &calibration, cases);
}

/// The clamps as sockets of two plates; that the ball is not quite in them moves no column.
pub(super) fn sockets() -> Campaign {
    let mut campaign = clamps(12);
    let names = [("front", "0"), ("front", "1"), ("front", "2"), ("back", "0"), ("back", "1")];
    for (group, (placement, socket)) in campaign.measurements.groups.iter_mut().zip(names) {
        group.name = GroupName::socket(placement, socket);
    }
    campaign.measurements.targets = Targets::Sockets(Vec::new());
    campaign
}

#[test]
fn a_socket_moves_alone_and_a_plate_turns_about_its_middle() {
    let mut campaign = sockets();
    let rows = &campaign.measurements.rows;
    let group = |row: usize| rows[row].group;
    let rows_of =
        |is_there: &dyn Fn(usize) -> bool| (0..rows.len()).filter(|&row| is_there(group(row))).collect();
    let (of_socket, of_plate): (Vec<usize>, Vec<usize>) =
        (rows_of(&|group| group == 1), rows_of(&|group| group < 3));
    let (last_of_socket, last_of_plate) = (of_socket[4], of_plate[9]);
    campaign.measurements.targets =
        Targets::Sockets(vec![Distance { between: [0, 1], value: 0.25, sd: 1e-5 }]);
    let calibration = calibrate(&campaign, Mode::Fea, &Options::default()).unwrap();
    let compensation = Compensation::new(&campaign, Mode::Fea).unwrap();
    let tips =
        of_plate.iter().map(|&row| super::changed::row(&campaign, &calibration, &compensation, row).tip());
    let middle = tips.sum::<Vector3<f64>>() / of_plate.len() as f64;
    let groups: Vec<usize> = rows.iter().map(|row| row.group).collect();
    let (socket, plate) = (
        format!("front/1, after row {}", last_of_socket + 1),
        format!("front, after row {}", last_of_plate + 1),
    );
    let plate_of = groups.clone();
    let turn = move |about: usize| {
        let groups = plate_of.clone();
        move |r: &mut Row<'_>, row: usize, v: f64| {
            if groups[row] < 3 && row > last_of_plate {
                // where the robot says that the ball is, had the plate not turned
                let tip = r.tip();
                r.off = middle + exponential(&(axis(about) * -v)) * (tip - middle) - tip;
            }
        }
    };
    let shift = move |r: &mut Row<'_>, row: usize, v: f64| {
        r.off.y -= if groups[row] == 1 && row > last_of_socket { v } else { 0.0 };
    };
    let cases: Vec<Case> = vec![
        ("socket_shift", &socket, "dy_um", Box::new(shift)),
        ("socket_shift", &plate, "rx_urad", Box::new(turn(0))),
        ("socket_shift", &plate, "rz_urad", Box::new(turn(2))),
    ];
    assert_changes(&campaign, &calibration, cases);
}

/// A socket's place is free: where the ball is beside the middle of it is what scatters itself, and
/// follows itself.
#[test]
fn in_sockets_nothing_follows_where_the_ball_is() {
    let follows_place = |campaign: &Campaign| {
        let calibration = calibrate(campaign, Mode::Fea, &Options::default()).unwrap();
        let context = Context::new(campaign, &calibration).unwrap();
        let (model, _) = CalibrationModel::new(campaign, calibration.clone()).unwrap();
        let labels = model.terms.candidates.iter().map(|own| own.location.to_string());
        let curves = labels.filter(|label| label == "over the workspace").count();
        let sites = sites(&context, 3 * campaign.measurements.len());
        let laws = sites.iter().filter(|site| site.variable.name.starts_with("position along")).count();
        (curves, laws)
    };
    assert_eq!(follows_place(&clamps(12)), (1, 3));
    assert_eq!(follows_place(&sockets()), (0, 0));
}
