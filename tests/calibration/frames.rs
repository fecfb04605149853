//! Where {W} lies, how the poses are ordered, and what the user takes the base for: none of it is
//! physics.

use std::f64::consts::{FRAC_PI_2, PI};

use nalgebra::{Isometry3, UnitQuaternion, Vector3};
use rodcal::calibration::{Calibration, Campaign, Mode, Options, calibrate};
use rodcal::robot::Parameter;

use super::arms::{self, SCARA, UR5};
use super::lab::{Dice, Lab, PHYSICS, isometry, millimetres, read};
use super::recovery::{Clamped, spoil};

/// Differences of parameters in standard errors: a fit may stop where a step is worth a millionth
/// of one.
const OF_AN_ERROR: f64 = 1e-6;
/// Of residuals and standard errors, relative; rounding, and what a millionth of a standard error
/// makes of it.
const ALIKE: f64 = 1e-6;

fn calibrated(campaign: &Campaign, mode: Mode) -> Calibration<'_> {
    let found = calibrate(campaign, mode, &Options::default()).unwrap_or_else(|error| panic!("{error}"));
    assert!(found.is_converged, "{:?}", found.passes);
    found
}

fn is_of_the_base(parameter: Parameter) -> bool {
    parameter.is_base()
}

/// Asserts that two calibrations found the same robot, with the same certainty.
fn assert_same_robot(what: &str, a: &Calibration, b: &Calibration) {
    assert_eq!(a.parameters.len(), b.parameters.len(), "{what}");
    for (a, b) in a.parameters.iter().zip(&b.parameters).filter(|(a, _)| !is_of_the_base(a.parameter)) {
        assert_eq!(a.parameter, b.parameter, "{what}");
        let (ea, eb) = (a.std_error.unwrap(), b.std_error.unwrap());
        assert!(
            (a.value - b.value).abs() < OF_AN_ERROR * ea,
            "{what}: {}: {} {}",
            a.parameter,
            a.value,
            b.value
        );
        assert!((ea / eb - 1.0).abs() < ALIKE, "{what}: {}: {ea} {eb}", a.parameter);
    }
    assert!(
        (a.noise.pooled / b.noise.pooled - 1.0).abs() < ALIKE,
        "{what}: {} {}",
        a.noise.pooled,
        b.noise.pooled
    );
}

/// Asserts that the residuals are the same too, those of `b` seen from a {W} moved by `by`.
fn assert_same_residuals(what: &str, a: &Calibration, b: &Calibration, by: &UnitQuaternion<f64>) {
    for (a, b) in a.deviations.iter().zip(&b.deviations) {
        assert!((by * a - b).norm() < ALIKE * 20e-6, "{what}: {a} {b}");
    }
}

/// Robots on floor, wall and ceiling. At a pitch of 90° roll and yaw are one, and anything made of
/// them breaks.
#[test]
fn moving_the_world_changes_nothing() {
    let mut made = Clamped::new(PHYSICS);
    made.noise = 20e-6;
    let campaign = made.campaign();
    let reference = calibrated(&campaign, Mode::Calc);
    let mut dice = Dice(41);
    let far = Vector3::new(3.0, -5.0, 1.0);
    let upright = |pitch: f64| {
        // such that the guess of the base has this pitch exactly
        let wanted = UnitQuaternion::from_euler_angles(0.0, pitch, 0.4);
        let now = Clamped::new(PHYSICS).guess.rotation;
        Isometry3::from_parts(far.into(), wanted * now.inverse())
    };
    for (what, by) in [
        ("anyhow", dice.motion(2.0, 3.0)),
        ("on a wall", upright(FRAC_PI_2)),
        ("on the other wall", upright(-FRAC_PI_2)),
        ("from the ceiling", Isometry3::new(far, Vector3::x() * PI)),
    ] {
        let mut moved = Clamped::new(PHYSICS).moved(&by);
        moved.noise = 20e-6;
        let campaign = moved.campaign();
        let found = calibrated(&campaign, Mode::Calc);
        assert_same_robot(what, &reference, &found);
        assert_same_residuals(what, &reference, &found, &by.rotation);
        // the base moves along
        let apart = (by * isometry(&reference.setup.base())).inverse() * isometry(&found.setup.base());
        assert!(apart.translation.vector.norm() < 1e-7 && apart.rotation.angle() < 1e-7, "{what}: {apart}");
    }
}

#[test]
fn the_order_of_the_poses_does_not_matter() {
    let mut made = Clamped::new(PHYSICS);
    made.noise = 20e-6;
    let rows = made.measurements();
    let mut order: Vec<usize> = (0..rows.len()).collect();
    let mut dice = Dice(43);
    for at in (1..order.len()).rev() {
        order.swap(at, ((dice.roll() + 1.0) / 2.0 * (at + 1) as f64) as usize);
    }
    let shuffled: Vec<String> = order.iter().map(|&row| rows[row].clone()).collect();
    let (campaign, other) = (made.campaign_with(&rows, ""), made.campaign_with(&shuffled, ""));
    let (reference, mut found) = (calibrated(&campaign, Mode::Calc), calibrated(&other, Mode::Calc));
    assert_same_robot("shuffled", &reference, &found);
    let mut sorted = found.deviations.clone();
    for (at, &row) in order.iter().enumerate() {
        sorted[row] = found.deviations[at];
    }
    found.deviations = sorted;
    assert_same_residuals("shuffled", &reference, &found, &UnitQuaternion::identity());
}

/// A guess of the base that is another world, and none at all.
#[test]
fn a_wrong_guess_of_the_base_leads_to_the_same_robot() {
    let mut made = Clamped::new(PHYSICS);
    made.noise = 20e-6;
    let campaign = made.campaign();
    let reference = calibrated(&campaign, Mode::Calc);
    let right = made.guess;
    for (what, turn) in
        [("about z", Vector3::z() * PI), ("about x", Vector3::x() * PI), ("about y", Vector3::y() * 2.0)]
    {
        made.guess = Isometry3::new(Vector3::new(4.0, 0.0, -3.0), turn) * right;
        let campaign = made.campaign();
        let found = calibrated(&campaign, Mode::Calc);
        assert_same_robot(what, &reference, &found);
        assert_same_residuals(what, &reference, &found, &UnitQuaternion::identity());
    }
}

#[test]
fn a_tracker_needs_no_word_about_the_base() {
    let mut dice = Dice(47);
    let base = Isometry3::new(Vector3::new(1.0, -2.0, 0.3), Vector3::new(2.5, 0.4, -1.0));
    let mut lab = Lab::new(arms::robot(UR5), base, Vector3::new(0.08, 0.03, 0.15));
    let every = Parameter::all(6);
    let links: Vec<Parameter> =
        every.into_iter().filter(|p| !matches!(p, Parameter::Compliance(_))).collect();
    spoil(&mut lab, &links, &mut dice);
    let mut csv = format!("pose{},x_mm,y_mm,z_mm\n", lab.header());
    for pose in 0..60 {
        let q = lab.anywhere(&mut dice);
        let noise = Vector3::from_fn(|_, _| 20e-6 * dice.normal());
        csv += &format!("{pose}{},{}\n", lab.cells(&q), millimetres(&(lab.rigid_tip(&q) + noise)));
    }
    let campaign = |sections: &str| {
        let text = format!(
            "robot = \"ur5.toml\"\nmeasurements = \"m.csv\"\n[tool]\nxyz_mm = [80, 30, 150]\n{sections}"
        );
        read(&[("campaign.toml", &text), ("ur5.toml", UR5), ("m.csv", &csv)])
    };
    let told = campaign(&format!("[base]\n{}", super::lab::placed(&base)));
    let reference = calibrated(&told, Mode::None);
    for (what, sections) in [
        ("nothing said", ""),
        ("turned round", "[base]\nxyz_mm = [1000, -2000, 300]\nrpy_deg = [0, 180, 90]\n"),
    ] {
        let campaign = campaign(sections);
        let found = calibrated(&campaign, Mode::None);
        assert_same_robot(what, &reference, &found);
        assert_same_residuals(what, &reference, &found, &UnitQuaternion::identity());
    }
}

/// A quill that stays at its height: balls in a plane look the same in a mirror, and no robot
/// stands in one.
#[test]
fn tips_in_a_plane_do_not_turn_the_base_inside_out() {
    let mut dice = Dice(53);
    for _ in 0..8 {
        let lab = Lab::new(arms::robot(SCARA), dice.motion(2.0, 3.0), Vector3::new(0.1, 0.05, 0.2));
        let mut csv = format!("pose{},x_mm,y_mm,z_mm\n", lab.header());
        for pose in 0..40 {
            let mut q = lab.anywhere(&mut dice);
            q[3] = 0.1;
            csv += &format!("{pose}{},{}\n", lab.cells(&q), millimetres(&lab.rigid_tip(&q)));
        }
        let text = "robot = \"scara.toml\"\nmeasurements = \"m.csv\"\n[tool]\nxyz_mm = [100, 50, 200]\n";
        let campaign = read(&[("campaign.toml", text), ("scara.toml", SCARA), ("m.csv", &csv)]);
        let found = calibrated(&campaign, Mode::None);
        assert!((found.setup.base().rotation.determinant() - 1.0).abs() < 1e-9);
        assert!(found.residuals().iter().all(|&r| r < 1e-8), "{:?}", found.passes);
        let apart = isometry(&found.setup.base()).inverse() * lab.base;
        assert!(apart.rotation.angle() < 1e-6, "{apart}");
    }
}
