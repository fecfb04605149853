//! Joints, links and loads: columns against a robot that is turned and bent by what its formula
//! says.

use std::f64::consts::{PI, TAU};

use nalgebra::DMatrix;

use super::changed::{Case, Row, assert_changes};
use super::*;
use crate::beam::Physics;
use crate::calibration::Compensation;
use crate::robot::{Body, Robot};
use crate::units::STANDARD_GRAVITY;

/// Least and greatest angle of a joint, rad.
fn range(campaign: &Campaign, joint: usize) -> (f64, f64) {
    let angles = (0..campaign.measurements.len()).map(|row| campaign.measurements.joints(row)[joint]);
    angles.fold((f64::INFINITY, f64::NEG_INFINITY), |(low, high), q| (low.min(q), high.max(q)))
}

#[test]
fn gears_err_as_their_formulae_say() {
    let campaign = clamps(12);
    let calibration = calibrate(&campaign, Mode::Fea, &Options::default()).unwrap();
    let (low, high) = range(&campaign, 2);
    // two cycles per turn of the range, four at least over a full one
    let half_step = 0.5 / (2.0 * (high - low) / TAU).ceil().max(2.0);
    let wave = "joint 3, near 7.5 cycles/rev";
    // a much larger wave whose frequency is off by so much that the difference has amplitude v
    let off = move |q: f64, v: f64| (v / 100.0) * half_step * (q - 0.5 * (low + high));
    // a curve's interval reaches beyond the data by its scale
    let (least, most) = range(&campaign, 1);
    let x = move |q: f64| (q - least + 0.25) / (most - least + 0.5);
    let curve = "joint 2, a smooth curve, scale 14.32°";
    let cases: Vec<Case> = vec![
        (
            "transmission_error",
            "joint 3, 7 cycles/rev",
            "sin_urad",
            Box::new(|r, _, v| r.q[2] += v * (7.0 * r.q[2]).sin()),
        ),
        (
            "transmission_error",
            "joint 3, 7 cycles/rev",
            "cos_urad",
            Box::new(|r, _, v| r.q[2] += v * (7.0 * r.q[2]).cos()),
        ),
        ("transmission_error", wave, "cos_urad", Box::new(|r, _, v| r.q[2] += v * (7.5 * r.q[2]).cos())),
        (
            "transmission_error",
            wave,
            "sin_urad_per_rad",
            Box::new(move |r, _, v| {
                let phase = 7.5 * r.q[2];
                r.q[2] -= 100.0 * ((phase + off(r.q[2], v)).cos() - phase.cos());
            }),
        ),
        (
            "transmission_error",
            wave,
            "cos_urad_per_rad",
            Box::new(move |r, _, v| {
                let phase = 7.5 * r.q[2];
                r.q[2] += 100.0 * ((phase + off(r.q[2], v)).sin() - phase.sin());
            }),
        ),
        (
            "transmission_error",
            curve,
            "cosine_1_urad",
            Box::new(move |r, _, v| r.q[1] += v * (PI * x(r.q[1])).cos()),
        ),
        (
            "transmission_error",
            curve,
            "cosine_4_urad",
            Box::new(move |r, _, v| r.q[1] += v * (4.0 * PI * x(r.q[1])).cos()),
        ),
    ];
    assert_changes(&campaign, &calibration, cases);
}

#[test]
fn a_wave_between_two_steps_says_where_it_is() {
    let campaign = clamps(12);
    let calibration = calibrate(&campaign, Mode::Fea, &Options::default()).unwrap();
    let (model, _) = CalibrationModel::new(&campaign, calibration).unwrap();
    let wave_there = find(&model, "transmission_error", "joint 3, near 7.5 cycles/rev");
    let gear = model.law(wave_there).gear().unwrap();
    let (low, high) = range(&campaign, 2);
    // 3·sin(n·q + 0.4 + δ·(q − q̄)), to first order in δ
    let (off, middle) = (1e-3, 0.5 * (low + high));
    let wave = |q: f64| 3.0 * ((7.5 + off) * (q - middle) + 7.5 * middle + 0.4).sin();
    let angles: Vec<f64> = (0..200).map(|k| low + (high - low) * f64::from(k) / 199.0).collect();
    let terms = DMatrix::from_fn(200, 4, |row, k| gear.term(k, angles[row]));
    let predicted = DVector::from_iterator(200, angles.iter().map(|&q| wave(q)));
    let values = crate::linalg::least_squares(&terms, &predicted).unwrap();
    let (frequency, gradient) = gear.frequency(values.as_slice());
    assert!((frequency - 7.5 - off).abs() < 0.01 * off, "{frequency}");
    for k in 0..4 {
        let step = 1e-5;
        let at = |by: f64| {
            let mut moved = values.clone();
            moved[k] += by;
            gear.frequency(moved.as_slice()).0
        };
        let slope = (at(step) - at(-step)) / (2.0 * step);
        assert!((gradient[k] - slope).abs() < 1e-4 * gradient.amax(), "{k}: {} {slope}", gradient[k]);
    }
}

#[test]
fn joints_and_base_give_way_to_their_torques() {
    let campaign = clamps(12);
    let calibration = calibrate(&campaign, Mode::Fea, &Options::default()).unwrap();
    let compensation = Compensation::new(&campaign, Mode::Fea).unwrap();
    let rod = compensation.compliance.unwrap();
    // the same rod of twice the density, with the same ball at its tip
    let dense = ROD.replace("density_kg_m3 = 7930", "density_kg_m3 = 15860");
    assert_ne!(dense, ROD);
    let dense = Rod::from_toml("rod", &dense).unwrap();
    let denser = Compliance::of_model(&dense, &Physics::default(), DEFAULT_ELEMENTS).unwrap();
    let [once, twice] = [campaign.rod.as_ref().unwrap(), &dense]
        .map(|rod| Body { mass: rod.mass(), centre: rod.centre_of_mass() });
    let recording = &campaign.measurements;
    // the last move of a joint that was one
    let came_from = |row: usize, j: usize| {
        let move_to = |row: &usize| recording.joints(*row)[j] - recording.joints(*row - 1)[j];
        (1..=row).rev().map(|row| move_to(&row)).find(|step| step.abs() > 1e-7).map_or(0.0, f64::signum)
    };
    let cases: Vec<Case> = vec![
        (
            "joint_nonlinear_stiffness",
            "joint 2, cubic",
            "urad_per_nm3",
            Box::new(|r, _, v| r.q[1] += v * r.torque()[1].powi(3)),
        ),
        (
            "backlash",
            "joint 4, by approach",
            "play_urad",
            Box::new(move |r, row, v| r.q[3] += 0.5 * v * came_from(row, 3)),
        ),
        (
            "gravity_tilt",
            "base",
            "tilt_urad_per_nm",
            Box::new(|r, _, v| {
                // all that weighs and pulls, force by force
                let (foot, mut moment) = r.at_rest(|kinematics| {
                    let foot = kinematics.joints[0].origin;
                    let weight = |body: &Body| r.loads.gravity * body.mass;
                    let mut moment = (kinematics.tip - foot).cross(&r.loads.tip_force);
                    let payload = r.loads.payload.unwrap();
                    moment += (kinematics.flange.point(&payload.centre) - foot).cross(&weight(&payload));
                    for (frames, joint) in kinematics.joints.iter().zip(&r.setup.robot.joints) {
                        let Some(body) = joint.body else { continue };
                        moment += (frames.distal.point(&body.centre) - foot).cross(&weight(&body));
                    }
                    (foot, moment)
                });
                // {W} is upright: a moment about the vertical turns nothing
                moment.z = 0.0;
                r.turn_base(foot, moment * v);
            }),
        ),
        (
            "rod_stiffness",
            "rod, under the contact force",
            "factor",
            Box::new(move |r, _, v| {
                let pull = r.at_rest(|kinematics| kinematics.flange.rotation.tr_mul(&r.loads.tip_force));
                r.deflection += rod.force * pull * v;
            }),
        ),
        (
            "rod_mass",
            "rod",
            "factor",
            Box::new(move |r, _, v| {
                let down = r.at_rest(|kinematics| kinematics.flange.rotation.tr_mul(&r.loads.gravity));
                r.deflection += (denser.gravity - rod.gravity) * down * (v / STANDARD_GRAVITY);
                let (known, more) = (r.loads.payload.unwrap(), twice.mass - once.mass);
                let moment = twice.centre * twice.mass - once.centre * once.mass;
                let mass = known.mass + v * more;
                let centre = (known.centre * known.mass + moment * v) / mass;
                r.loads.payload = Some(Body { mass, centre });
            }),
        ),
    ];
    assert_changes(&campaign, &calibration, cases);
}

#[test]
fn one_clamp_may_push_harder_than_the_others() {
    let campaign = clamps(12);
    let calibration = calibrate(&campaign, Mode::Fea, &Options::default()).unwrap();
    let force = Compensation::new(&campaign, Mode::Fea).unwrap().compliance.unwrap().force;
    let recording = &campaign.measurements;
    let push = |axis: usize| {
        move |r: &mut Row<'_>, row: usize, v: f64| {
            let group = &recording.groups[recording.rows[row].group];
            if group.name.to_string() != "clamp 4" {
                return;
            }
            let pull = group.device.rotation.column(axis) * v;
            let of_tool = r.at_rest(|kinematics| kinematics.flange.rotation.tr_mul(&pull));
            r.deflection += force * of_tool;
            r.loads.tip_force += pull;
        }
    };
    let cases: Vec<Case> = vec![
        ("contact_force_variation", "clamp 4", "y_n", Box::new(push(1))),
        ("contact_force_variation", "clamp 4", "z_n", Box::new(push(2))),
    ];
    assert_changes(&campaign, &calibration, cases);
}

#[test]
fn without_masses_a_weight_at_any_frame_turns_the_joint() {
    let mut campaign = clamps(12);
    (campaign.rod, campaign.contact_force) = (None, None);
    campaign.robot.joints.iter_mut().for_each(|joint| joint.body = None);
    let calibration = calibrate(&campaign, Mode::None, &Options::default()).unwrap();
    let weight = Body { mass: 1.0, centre: Vector3::zeros() };
    // joint 4's frame is where the link of joint 3 ends
    let mut loaded: Robot = campaign.robot.clone();
    loaded.joints[2].body = Some(weight);
    let only = |r: &mut Row<'_>, j: usize, v: f64| {
        r.setup.compliance = vec![0.0; 6];
        r.setup.compliance[j] = v / STANDARD_GRAVITY;
    };
    let cases: Vec<Case> = vec![
        (
            "joint_compliance",
            "joint 2, masses unknown",
            "joint_4_urad_per_m",
            Box::new(|r, _, v| {
                r.setup.robot = &loaded;
                only(r, 1, v);
            }),
        ),
        (
            "joint_compliance",
            "joint 3, masses unknown",
            "flange_urad_per_m",
            Box::new(move |r, _, v| {
                r.loads.payload = Some(weight);
                only(r, 2, v);
            }),
        ),
    ];
    assert_changes(&campaign, &calibration, cases);
}
