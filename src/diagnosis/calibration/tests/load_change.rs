//! Loads that are put on, or taken off, while poses are recorded: columns against a robot that
//! carries them, and what is said of its poses.

use super::changed::{Case, Row, assert_changes, row};
use super::*;
use crate::calibration::{Carried, Compensation};
use crate::inference::Finding;
use crate::robot::{Body, Kinematics};
use crate::units::STANDARD_GRAVITY;

/// Hangs so much more on the flange of a row, kg, at a point of {T}, m.
fn hang(row: &mut Row, mass: f64, point: Vector3<f64>) {
    let known = row.loads.payload.unwrap();
    let all = known.mass + mass;
    let centre = (known.centre * known.mass + point * mass) / all;
    row.loads.payload = Some(Body { mass: all, centre });
}

/// A moment of weight about the axes of {T} and no mass, N·m.
fn turn_payload(row: &mut Row, moment: Vector3<f64>) {
    let known = row.loads.payload.unwrap();
    let centre = known.centre + moment / (known.mass * STANDARD_GRAVITY);
    row.loads.payload = Some(Body { centre, ..known });
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
    let former = "former load of the flange, after pose 20";
    let moved = |r: &mut Row, v: f64| turn_payload(r, Vector3::new(0.0, v, 0.0));
    let cases: Vec<Case> = vec![
        (
            "load_change",
            flange,
            "mass_kg",
            Box::new(|r, row, v| hang(r, if row >= 20 { v } else { 0.0 }, Vector3::zeros())),
        ),
        (
            "load_change",
            flange,
            "moment_y_nm",
            Box::new(move |r, row, v| moved(r, if row >= 20 { v } else { 0.0 })),
        ),
        (
            "load_change",
            former,
            "mass_kg",
            Box::new(|r, row, v| hang(r, if row < 20 { -v } else { 0.0 }, Vector3::zeros())),
        ),
        (
            "load_change",
            former,
            "moment_y_nm",
            Box::new(move |r, row, v| moved(r, if row < 20 { -v } else { 0.0 })),
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

/// What is recorded there.
fn carrying(hang: &dyn Fn(&mut Row, usize, &Compensation), seed: u64) -> Campaign {
    let clean = clamps(16);
    let calibration = calibrate(&clean, Mode::Fea, &Options::default()).unwrap();
    let compensation = Compensation::new(&clean, Mode::Fea).unwrap();
    let carried = |at: usize| {
        let mut there = row(&clean, &calibration, &compensation, at);
        let before = there.tip();
        hang(&mut there, at, &compensation);
        there.tip() - before
    };
    recorded(&clean, &carried, 15.0 * UM, seed)
}

/// The only finding there.
fn only(hang: &dyn Fn(&mut Row, usize, &Compensation), seed: u64) -> Finding {
    let campaign = carrying(hang, seed);
    let found = diagnose_as_recorded(&campaign, Mode::Fea, &Options::default()).unwrap();
    let findings = found.diagnosis.findings;
    let names: Vec<_> = findings.iter().map(|own| (own.effect.name, own.location.to_string())).collect();
    let [finding] = &findings[..] else { panic!("{names:?}") };
    finding.clone()
}

/// Its interval holds a mass, kg, and is narrower than the mass; those of the centre (m) hold it at
/// twice their width, for one of six is off by chance.
fn assert_load(finding: &Finding, mass: f64, centre: Vector3<f64>) {
    let holds = |name: &str, value: f64, times: f64| {
        let own = finding.quantity(name).unwrap_or_else(|| panic!("no {name} in {:?}", finding.estimates));
        let (below, above) = (times * (own.value - own.low), times * (own.high - own.value));
        assert!(own.value - below <= value && value <= own.value + above, "{name} {value}: {own:?}");
        own.high - own.low
    };
    assert!(holds("mass_kg", mass, 1.0) < mass.abs());
    for (name, value) in ["centre_x_mm", "centre_y_mm", "centre_z_mm"].into_iter().zip(centre.iter()) {
        holds(name, value * 1e3, 2.0);
    }
}

/// All that is found there, and where something is left that has no name.
fn all_named(
    hang: &dyn Fn(&mut Row, usize, &Compensation),
    seed: u64,
) -> (Vec<(String, String)>, Option<String>) {
    let campaign = carrying(hang, seed);
    let found = diagnose_as_recorded(&campaign, Mode::Fea, &Options::default()).unwrap();
    let named = |own: &Finding| (own.effect.name.to_owned(), own.location.to_string());
    let left = found.diagnosis.discrepancy.as_ref().and_then(|left| left.location.as_ref());
    (found.diagnosis.findings.iter().map(named).collect(), left.map(ToString::to_string))
}

#[test]
fn a_load_that_was_taken_off_is_no_move_of_the_base() {
    for (seed, at) in [(1, Vector3::new(0.02, 0.01, 0.08)), (8, Vector3::new(0.0, 0.15, 0.05))] {
        let found = only(&|r, row, _| hang(r, if row < 40 { 8.0 } else { 0.0 }, at), seed);
        assert_eq!(found.effect.name, "load_change");
        assert_eq!(found.location.to_string(), "former load of the flange, after pose 40");
        assert_load(&found, -8.0, at);
    }
}

/// Beside the flange it is as heavy as it is there, and the words say where its centre is.
#[test]
fn a_load_beside_the_flange_has_its_mass_and_its_centre() {
    for (seed, at) in [(9, Vector3::new(0.15, 0.0, 0.05)), (10, Vector3::new(-0.05, 0.07, 0.1))] {
        let found = only(&|r, row, _| hang(r, if row >= 40 { 6.0 } else { 0.0 }, at), seed);
        assert_eq!(found.effect.name, "load_change");
        assert_eq!(found.location.to_string(), "load of the flange, after pose 40");
        assert_load(&found, 6.0, at);
        let words = found.description.to_string();
        assert!(words.contains("with its centre") && words.contains("mm along y"), "{words}");
    }
}

/// What always hangs there shows little but its moment: the interval of its mass holds the true one
/// whatever its centre, also where the form with its centre at the flange is the likelier one
/// (14), and where columns of drives that carry it say less of it than of a contact force (13).
#[test]
fn a_payload_beside_the_flange_is_one() {
    let cases = [(11, [0.0, 0.15, 0.05]), (13, [0.03, 0.0, 0.03]), (14, [0.0, 0.0, 0.05])];
    for (seed, at) in cases.map(|(seed, at)| (seed, Vector3::from(at))) {
        let found = only(&|r, _, _| hang(r, 8.0, at), seed);
        assert_eq!(found.effect.name, "payload_mass");
        let mass = found.quantity("mass_kg").unwrap();
        assert!(mass.low <= 8.0 && 8.0 <= mass.high, "{at}: {mass:?}");
    }
}

/// A drive turns by what hung there as the robot was calibrated, at the rows where it hung.
#[test]
fn drives_carry_what_hung_there() {
    let campaign = clamps(12);
    let calibration = calibrate(&campaign, Mode::Fea, &Options::default()).unwrap();
    let compensation = Compensation::new(&campaign, Mode::Fea).unwrap();
    let (mass, at) = (4.0, Vector3::new(0.1, -0.05, 0.08));
    let carried = [Carried { rows: 20..30, mass, moment: at * mass }];
    let context = Context::new(&campaign, &calibration).unwrap().carrying(&carried);
    for (index, hung) in [(19, 0.0), (20, mass), (29, mass), (30, 0.0)] {
        let mut there = row(&campaign, &calibration, &compensation, index);
        hang(&mut there, hung, at);
        for (torque, own) in there.torque().iter().zip(context.torque_with_carried(index)) {
            assert!((torque - own).abs() < 1e-3 * torque.abs() + 0.01, "row {index}: {own} for {torque} N·m");
        }
    }
}

#[test]
fn a_load_that_was_put_on_the_ball_is_no_move_of_the_base() {
    let found = named(&|r, row, with| hang_on_ball(r, with, if row < 30 { 0.0 } else { 0.4 }), 2);
    assert_eq!(found, ("load_change".into(), "load of the tip, after pose 30".into()));
}

/// A drive that gives way more from a pose on is no load: it has no name, but its torque is
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
