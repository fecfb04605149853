//! Loads that are put on, or taken off, while poses are recorded: columns against a robot that
//! carries them, and what is said of its poses.

use super::changed::{Case, Row, assert_changes, row};
use super::*;
use crate::calibration::Compensation;
use crate::inference::Finding;
use crate::robot::{Body, Kinematics};

/// Hangs so much more on the flange of a row, kg, at a point of {T}, m.
fn hang(row: &mut Row, mass: f64, point: Vector3<f64>) {
    let known = row.loads.payload.unwrap();
    let all = known.mass + mass;
    let centre = (known.centre * known.mass + point * mass) / all;
    row.loads.payload = Some(Body { mass: all, centre });
}

/// The same on the ball, under which the rod bends as well.
fn hang_on_ball(row: &mut Row, compensation: &Compensation, mass: f64) {
    let weight = row.loads.gravity * mass;
    let mut kinematics = Kinematics::new(&row.setup);
    kinematics.update(&row.q, &row.torque());
    let force = compensation.compliance.as_ref().unwrap().force;
    row.deflection += force * kinematics.flange.rotation.tr_mul(&weight);
    row.loads.tip_force += weight;
}

#[test]
fn a_load_changes_after_a_pose() {
    let campaign = clamps(12);
    let calibration = calibrate(&campaign, Mode::Fea, &Options::default()).unwrap();
    let compensation = Compensation::new(&campaign, Mode::Fea).unwrap();
    let flange = "load of the flange, after pose 20";
    let cases: Vec<Case> = vec![
        (
            "load_change",
            flange,
            "mass_kg",
            Box::new(|r, row, v| hang(r, if row >= 20 { v } else { 0.0 }, Vector3::zeros())),
        ),
        (
            "load_change",
            "load of the tip, after pose 20",
            "mass_g",
            Box::new(|r, row, v| hang_on_ball(r, &compensation, if row >= 20 { v } else { 0.0 })),
        ),
    ];
    assert_changes(&campaign, &calibration, cases);
}

/// What is found first where each row carries what `hang` hangs on it.
fn named(hang: &dyn Fn(&mut Row, usize, &Compensation), seed: u64) -> (String, String) {
    all_named(hang, seed).0.into_iter().next().unwrap_or_default()
}

/// All that is found there, and where something is left that has no name.
fn all_named(
    hang: &dyn Fn(&mut Row, usize, &Compensation),
    seed: u64,
) -> (Vec<(String, String)>, Option<String>) {
    let clean = clamps(16);
    let calibration = calibrate(&clean, Mode::Fea, &Options::default()).unwrap();
    let compensation = Compensation::new(&clean, Mode::Fea).unwrap();
    let carried = |at: usize| {
        let mut there = row(&clean, &calibration, &compensation, at);
        let before = there.tip();
        hang(&mut there, at, &compensation);
        there.tip() - before
    };
    let campaign = recorded(&clean, &carried, 15.0 * UM, seed);
    let found = diagnose_as_recorded(&campaign, Mode::Fea, &Options::default()).unwrap();
    let named = |own: &Finding| (own.effect.name.to_owned(), own.location.to_string());
    let left = found.diagnosis.discrepancy.as_ref().and_then(|left| left.location.as_ref());
    (found.diagnosis.findings.iter().map(named).collect(), left.map(ToString::to_string))
}

#[test]
fn a_load_that_was_taken_off_is_no_move_of_the_base() {
    let at = Vector3::new(0.02, 0.01, 0.08);
    let found = named(&|r, row, _| hang(r, if row < 40 { 8.0 } else { 0.0 }, at), 1);
    assert_eq!(found, ("load_change".into(), "load of the flange, after pose 40".into()));
}

#[test]
fn a_load_that_was_put_on_the_ball_is_no_move_of_the_base() {
    let found = named(&|r, row, with| hang_on_ball(r, with, if row < 30 { 0.0 } else { 0.4 }), 2);
    assert_eq!(found, ("load_change".into(), "load of the tip, after pose 30".into()));
}

/// A base that moved stays one.
#[test]
fn a_base_that_moved_is_no_load() {
    let found = named(
        &|r, row, _| r.off += Vector3::new(0.1e-3, -0.08e-3, 0.06e-3) * (if row >= 40 { 1.0 } else { 0.0 }),
        3,
    );
    assert_eq!(found, ("base_shift".into(), "after pose 40".into()));
}

/// A drive that gives way more from a pose on is none either: it has no name, but its torque is
/// what the poses follow.
#[test]
fn a_drive_that_softens_is_no_load() {
    for (seed, joint, factor) in [(4, 1, 1.6), (5, 1, 2.5)] {
        let softens =
            |r: &mut Row, row, _: &_| r.setup.compliance[joint] *= if row < 40 { 1.0 } else { factor };
        let (found, left) = all_named(&softens, seed);
        let expected = format!("torque of joint {}, after pose ", joint + 1);
        assert_eq!(found, [], "{seed}");
        assert!(left.as_ref().is_some_and(|left| left.starts_with(&expected)), "{seed}: {left:?}");
    }
}

/// What hangs beside the flange always is no load that was put on after the first poses.
#[test]
fn a_load_that_hangs_there_always_does_not_change() {
    for (seed, mass, at) in [
        (5, 10.0, Vector3::new(0.02, 0.01, 0.1)),
        (6, 15.0, Vector3::new(0.0, 0.15, 0.0)),
        (7, 20.0, Vector3::new(0.1, 0.0, 0.2)),
    ] {
        let (found, _) = all_named(&|r, _, _| hang(r, mass, at), seed);
        assert!(found.iter().all(|(effect, _)| effect != "load_change"), "{found:?}");
    }
}
