//! Every column against a robot whose joints, masses and loads are changed, and which is then asked
//! where its tip is.

use nalgebra::Rotation3;

use super::changed::{Change, Row, row};
use super::*;
use crate::calibration::Compensation;
use crate::robot::{Body, Kinematics, Parameter};

#[test]
fn columns_are_what_a_changed_robot_does() {
    let mut campaign = clamps(12);
    campaign.constraints.fixed.push(Parameter::Compliance(3));
    let calibration = calibrate(&campaign, Mode::Fea, &Options::default()).unwrap();
    let compensation = Compensation::new(&campaign, Mode::Fea).unwrap();
    let (model, _) = CalibrationModel::new(&campaign, calibration.clone()).unwrap();
    let force = compensation.compliance.as_ref().unwrap().force;
    let weight = compensation.compliance.as_ref().unwrap().gravity / crate::units::STANDARD_GRAVITY;
    let recording = &campaign.measurements;
    let deviations = calibration.deviations.clone();
    let step = |row: usize, j: usize| recording.joints(row)[j] - recording.joints(row.saturating_sub(1))[j];
    let bend = move |row: &mut Row, pull: Vector3<f64>| {
        let mut kinematics = Kinematics::new(&row.setup);
        kinematics.update(&row.q, &row.torque());
        row.deflection += force * kinematics.flange.rotation.tr_mul(&pull);
    };
    let cases: Vec<(&str, &str, Box<Change>)> = vec![
        (
            "transmission_error",
            "joint 3, near 7.5 cycles/rev",
            Box::new(|r, _, v| r.q[2] += v * (7.5 * r.q[2]).sin()),
        ),
        ("encoder_scale", "joint 4", Box::new(|r, _, v| r.q[3] *= 1.0 + v)),
        ("wrist_coupling", "joint 5 to 6", Box::new(|r, _, v| r.q[5] += v * r.q[4])),
        ("readback_lag", "joint 2", Box::new(move |r, row, v| r.q[1] += v * step(row, 1))),
        (
            "readback_lag",
            "all joints",
            Box::new(move |r, row, v| (0..6).for_each(|j| r.q[j] += v * step(row, j))),
        ),
        ("joint_compliance", "joint 4", Box::new(|r, _, v| r.setup.compliance[3] += v)),
        (
            "joint_nonlinear_stiffness",
            "joint 2",
            Box::new(|r, _, v| {
                let torque = r.torque()[1];
                r.q[1] += v * torque * torque.abs();
            }),
        ),
        (
            "backlash",
            "joint 3",
            Box::new(|r, _, v| {
                let torque = r.torque()[2];
                r.q[2] += 0.5 * v * torque.signum();
            }),
        ),
        (
            "tip_mass",
            "tip",
            Box::new(move |r, _, v| {
                let weight = r.loads.gravity * v;
                bend(r, weight);
                r.loads.tip_force += weight;
            }),
        ),
        (
            "payload_mass",
            "flange",
            Box::new(|r, _, v| {
                // a heavier rod whose centre is where both are balanced
                let rod = r.loads.payload.unwrap();
                let mass = rod.mass + v;
                r.loads.payload = Some(Body { mass, centre: rod.centre * (rod.mass / mass) });
            }),
        ),
        (
            "gravity_direction",
            "base",
            Box::new(move |r, _, v| {
                let roll = Rotation3::new(r.setup.base().rotation.column(0) * v);
                let change = roll * r.loads.gravity - r.loads.gravity;
                let mut kinematics = Kinematics::new(&r.setup);
                kinematics.update(&r.q, &r.torque());
                r.deflection += weight * kinematics.flange.rotation.tr_mul(&change);
                r.loads.gravity += change;
            }),
        ),
        ("rod_stiffness", "rod", Box::new(|r, _, v| r.deflection *= 1.0 + v)),
        (
            "contact_force_variation",
            "all clamps",
            Box::new(move |r, row, v| {
                let device = &recording.groups[recording.rows[row].group].device;
                let pull = device.rotation.column(0) * v;
                bend(r, pull);
                r.loads.tip_force += pull;
            }),
        ),
        (
            "contact_spring",
            "all clamps",
            Box::new(move |r, row, v| {
                let device = &recording.groups[recording.rows[row].group].device;
                let Targets::Points(points) = &recording.targets else { panic!("no points") };
                // half way from the recorded to the predicted one
                let point = points[row] + 0.5 * deviations[row];
                let pull = device.rotation * device.inverse().point(&point) * v;
                bend(r, pull);
                r.loads.tip_force += pull;
            }),
        ),
        (
            "joint_friction",
            "joint 2",
            Box::new(move |r, row, v| {
                let torque = r.torque()[1];
                let approach = if row == 0 { 0.0 } else { step(row, 1).signum() };
                r.q[1] += 0.5 * v * torque.abs() * approach;
            }),
        ),
        (
            "thermal_drift",
            "joint 2, zero, with order",
            Box::new(|r, row, v| r.q[1] += v * (row as f64 / 59.0 - 0.5)),
        ),
        (
            "thermal_drift",
            "joint 2, length of its link, with order",
            Box::new(|r, row, v| {
                let both = [Parameter::A(1), Parameter::D(1)].map(|p| (p, r.setup.get(p)));
                let length = both[0].1.hypot(both[1].1);
                for (parameter, value) in both {
                    r.setup.set(parameter, value * (1.0 + v * (row as f64 / 59.0 - 0.5) / length));
                }
            }),
        ),
        (
            "tool_shift",
            "tool, after pose 3",
            Box::new(|r, row, v| r.setup.tool.x += if row >= 3 { v } else { 0.0 }),
        ),
        (
            "base_shift",
            "after pose 3",
            Box::new(|r, row, v| {
                r.setup.base_position.x += if row >= 3 { v } else { 0.0 };
            }),
        ),
        (
            "joint_shift",
            "joint 4, after pose 3",
            Box::new(|r, row, v| r.q[3] += if row >= 3 { v } else { 0.0 }),
        ),
        (
            "thermal_drift",
            "arm, with order",
            Box::new(|r, row, v| {
                let by = v * (row as f64 / 59.0 - 0.5);
                for parameter in (0..6).flat_map(|j| [Parameter::A(j), Parameter::D(j)]) {
                    r.setup.set(parameter, r.setup.get(parameter) * (1.0 + by));
                }
            }),
        ),
        (
            "thermal_drift",
            "tool, with order",
            Box::new(|r, row, v| {
                r.setup.tool.x += v * (row as f64 / 59.0 - 0.5);
            }),
        ),
    ];
    for (effect, location, change) in cases {
        let index = find(&model, effect, location);
        let parameter = &model.candidates()[index].parameters[0];
        let mut term = model.candidates()[index].neutral(index);
        term.values[0] += 0.01 * parameter.size;
        let predicted = model.response(&[term]);
        let mut difference = 0.0f64;
        for at in 0..recording.len() {
            let mut there = row(&campaign, &calibration, &compensation, at);
            let before = there.tip();
            change(&mut there, at, 0.01 * parameter.size);
            difference = difference.max((there.tip() - before - predicted.fixed_rows::<3>(3 * at)).norm());
        }
        // deflections are to first order: a hundredth of them is lost
        assert!(
            difference < 0.01 * predicted.amax(),
            "{effect} {location}: {difference} of {}",
            predicted.amax()
        );
        assert!(predicted.amax() > 0.0, "{effect} {location}");
    }
}

#[test]
fn a_link_bends_about_its_joint_and_clamps_move_the_other_way() {
    let campaign = clamps(12);
    let calibration = calibrate(&campaign, Mode::Fea, &Options::default()).unwrap();
    let compensation = Compensation::new(&campaign, Mode::Fea).unwrap();
    let (model, _) = CalibrationModel::new(&campaign, calibration.clone()).unwrap();
    // the forearm at the elbow, and at the wrist, where a URDF may have its joint
    let of_link = |joint: usize, is_at_wrist: bool| {
        let is_it = |c: &Candidate| {
            let place = c.location.to_string();
            c.effect.name == "link_flexibility"
                && c.location.joint() == Some(joint)
                && place.ends_with(" mm along its axis") == is_at_wrist
        };
        model.candidates().iter().position(is_it).unwrap()
    };
    for (joint, is_at_wrist, at) in [2, 3].into_iter().flat_map(|j| [0, 17, 40].map(|at| (j, j == 3, at))) {
        let index = of_link(joint, is_at_wrist);
        let mut term = model.candidates()[index].neutral(index);
        term.values[0] = 1e-7;
        let predicted = model.response(&[term]);
        let there = row(&campaign, &calibration, &compensation, at);
        let mut kinematics = Kinematics::new(&there.setup);
        kinematics.update(&there.q, &there.torque());
        // the moment, force by force
        let (own, next) = (&kinematics.joints[joint], &kinematics.joints[joint + 1]);
        let along = if is_at_wrist { own.axis.dot(&(next.origin - own.origin)) } else { 0.0 };
        let origin = own.origin + own.axis * along;
        let mut moment = (kinematics.tip - origin).cross(&there.loads.tip_force);
        let rod = there.loads.payload.unwrap();
        moment += (kinematics.flange.point(&rod.centre) - origin).cross(&(there.loads.gravity * rod.mass));
        for j in joint..6 {
            let Some(body) = campaign.robot.joints[j].body else { continue };
            let centre = kinematics.joints[j].distal.point(&body.centre);
            moment += (centre - origin).cross(&(there.loads.gravity * body.mass));
        }
        let axis = kinematics.joints[joint].axis;
        let turn = Rotation3::new((moment - axis * axis.dot(&moment)) * 1e-7);
        let tip = there.tip();
        let expected = turn * (tip - origin) + origin - tip;
        let found: Vector3<f64> = predicted.fixed_rows::<3>(3 * at).into();
        assert!((found - expected).norm() < 1e-3 * expected.norm() + 1e-12, "{found} {expected}");
    }
    for (effect, location) in [("clamp_pose", "clamp 2"), ("clamp_shift", "clamp 2, after pose 16")] {
        let index = find(&model, effect, location);
        let mut term = model.candidates()[index].neutral(index);
        term.values[0] = 5.0 * UM;
        let predicted = model.response(&[term]);
        for (at, entry) in campaign.measurements.rows.iter().enumerate() {
            let is_moved = campaign.measurements.groups[entry.group].name.to_string() == "clamp 2"
                && (effect == "clamp_pose" || at > 15);
            assert_eq!(predicted[3 * at], if is_moved { -5.0 * UM } else { 0.0 }, "{effect} {at}");
        }
    }
}

#[test]
fn columns_are_the_derivatives_of_the_change() {
    let campaign = clamps(8);
    let (model, evidence) = modelled(&campaign, Mode::Fea);
    assert_eq!(evidence.recorded, 3 * campaign.measurements.len());
    for (index, candidate) in model.candidates().iter().enumerate().step_by(7) {
        let neutral = candidate.neutral(index);
        assert_eq!(model.response(std::slice::from_ref(&neutral)).norm(), 0.0);
        let columns = model.columns(std::slice::from_ref(&neutral), 0);
        for (k, parameter) in candidate.parameters.iter().enumerate() {
            let mut moved = neutral.clone();
            moved.values[k] += parameter.size;
            let difference = (model.response(&[moved]) - columns.column(k)).amax();
            assert!(difference <= 1e-9 * columns.amax(), "{} {}", candidate.effect, candidate.location);
        }
    }
}
