//! What the poses hardly show stays as the drawing has it: beyond them a calibrated robot is no
//! worse than the nominal one.

use nalgebra::Vector3;
use rodcal::calibration::{Mode, Options, calibrate};
use rodcal::robot::{Kinematics, Robot, Setup};
use rodcal::spatial::Pose;
use rodcal::units::{DEG, MM};

use super::lab::read;

const NOISE: f64 = 0.03 * MM;
const TOOL: [f64; 3] = [0.05, 0.02, 0.15];

/// Uniform in ±1, by a linear congruence: the laboratory draws by itself.
struct Draw(u64);

impl Draw {
    fn next(&mut self) -> f64 {
        self.0 = self.0.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
        (self.0 >> 11) as f64 / (1u64 << 52) as f64 - 1.0
    }

    fn normal(&mut self) -> f64 {
        (0..12).map(|_| self.next()).sum::<f64>() / 2.0
    }
}

fn tx90() -> Robot {
    let (file, text) = Robot::builtin("tx90").unwrap();
    Robot::from_text(file, text, None, None).unwrap()
}

/// One as it was built: `times` the standard uncertainties of its drawing off.
fn built(times: f64, draw: &mut Draw) -> Robot {
    let mut robot = tx90();
    for joint in &mut robot.joints {
        joint.link.d += times * MM * draw.normal();
        joint.link.a += times * MM * draw.normal();
        joint.link.alpha += times * 0.1 * DEG * draw.normal();
        joint.link.theta += times * 0.3 * DEG * draw.normal();
    }
    robot
}

fn tip(robot: &Robot, q: &[f64]) -> Vector3<f64> {
    let setup = Setup::new(robot, Pose::IDENTITY, Vector3::from(TOOL));
    let mut kinematics = Kinematics::new(&setup);
    kinematics.update(q, &[0.0; 6]);
    kinematics.tip
}

/// Poses with joints 4 and 6 within some degrees, or anywhere, as they are measured.
fn recorded(robot: &Robot, count: usize, wrist: f64, draw: &mut Draw) -> String {
    let mut csv = "pose,q1_deg,q2_deg,q3_deg,q4_deg,q5_deg,q6_deg,x_mm,y_mm,z_mm\n".to_owned();
    for pose in 1..=count {
        let ranges = [40.0, 30.0, 40.0, wrist, 40.0, wrist];
        let middle = [0.0, 20.0, 60.0, 20.0, 50.0, -30.0];
        let degrees: Vec<f64> =
            ranges.iter().zip(middle).map(|(range, middle)| middle + range * draw.next()).collect();
        let q: Vec<f64> = degrees.iter().map(|q| q * DEG).collect();
        let at = tip(robot, &q) + Vector3::from_fn(|_, _| NOISE * draw.normal());
        let cells: Vec<String> =
            degrees.iter().copied().chain(at.iter().map(|x| x / MM)).map(|x| format!("{x:.6}")).collect();
        csv += &format!("{pose},{}\n", cells.join(","));
    }
    csv
}

/// Mean errors at poses anywhere of the nominal robot where the campaign says that it stands, of
/// the robot as calibrated on narrow poses, and what the campaign's validation says of the latter.
fn errors(times: f64, seed: u64) -> (f64, f64) {
    let mut draw = Draw(seed);
    let actual = built(times, &mut draw);
    let measurements = recorded(&actual, 30, 8.0, &mut draw);
    let validation = recorded(&actual, 100, 110.0, &mut draw);
    let campaign = read(&[
        (
            "campaign.toml",
            "robot = \"builtin:tx90\"\nmeasurements = \"m.csv\"\nvalidation = \"v.csv\"\nvalidation_refit = \"none\"\n\
             [base]\nxyz_mm = [0, 0, 0]\n[tool]\nxyz_mm = [50, 20, 150]\n",
        ),
        ("m.csv", &measurements),
        ("v.csv", &validation),
    ]);
    let found = calibrate(&campaign, Mode::None, &Options::default()).unwrap();
    assert!(found.is_converged, "{} {:?}", found.fit.reason, found.passes);
    let after = found.validation.as_ref().unwrap().summary.mean;
    let nominal = tx90();
    let before = validation.lines().skip(1).map(|line| {
        let cells: Vec<f64> = line.split(',').map(|cell| cell.parse().unwrap()).collect();
        let q: Vec<f64> = cells[1..7].iter().map(|q| q * DEG).collect();
        (tip(&nominal, &q) - Vector3::from_column_slice(&cells[7..10]) * MM).norm()
    });
    (before.sum::<f64>() / 100.0, after)
}

#[test]
fn beyond_narrow_poses_a_calibrated_robot_is_no_worse_than_the_nominal_one() {
    // as exact as its drawing says, ten times better, three times worse
    for times in [0.1, 1.0, 3.0] {
        let all: Vec<(f64, f64)> = (1..=6).map(|seed| errors(times, seed)).collect();
        for (before, after) in &all {
            assert!(*after < before + 3.0 * NOISE, "{times}: {before:e} before, {after:e} after");
        }
        let gain: f64 = all.iter().map(|(before, after)| (after / before).ln()).sum::<f64>() / 6.0;
        assert!(gain < 0.0, "{times}: {all:?}");
    }
}

/// A robot of which one link is longer than drawn, and nothing else: pruned, it keeps that link and
/// little more, and the errors at other poses are no larger.
#[test]
fn what_the_data_do_not_support_is_held() {
    let mut draw = Draw(11);
    let mut actual = tx90();
    actual.joints[1].link.a += 2.0 * MM;
    let (measurements, validation) =
        (recorded(&actual, 40, 90.0, &mut draw), recorded(&actual, 100, 110.0, &mut draw));
    let campaign = read(&[
        (
            "campaign.toml",
            "robot = \"builtin:tx90\"\nmeasurements = \"m.csv\"\nvalidation = \"v.csv\"\nvalidation_refit = \"none\"\n\
             [tool]\nxyz_mm = [50, 20, 150]\n",
        ),
        ("m.csv", &measurements),
        ("v.csv", &validation),
    ]);
    let whole = calibrate(&campaign, Mode::None, &Options::default()).unwrap();
    let pruned = calibrate(&campaign, Mode::None, &Options::default().with_pruning(true)).unwrap();
    let own = |p: &&rodcal::calibration::Estimated| !p.parameter.is_placement();
    let (all, kept) = (whole.parameters.iter().filter(own).count(), pruned.parameters.iter().filter(own));
    assert!(kept.clone().all(|p| p.is_supported()));
    assert!(kept.clone().count() * 3 < all * 2, "{} of {all}", kept.clone().count());
    let a2 = kept.clone().find(|p| p.parameter.to_string() == "a2").unwrap();
    assert!((a2.value - a2.nominal - 2.0 * MM).abs() < 3.0 * a2.std_error.unwrap());
    let error = |found: &rodcal::calibration::Calibration| found.validation.as_ref().unwrap().summary.mean;
    assert!(error(&pruned) < 1.05 * error(&whole), "{:e} {:e}", error(&pruned), error(&whole));
    // and the nominal robot is far off at the same poses
    let before = pruned.before.as_ref().unwrap();
    assert!(before.validation.unwrap().mean > 10.0 * error(&pruned), "{before:?}");
    assert!(pruned.extrapolation.unwrap().ratio() < 2.0);
}

/// The zero of joint 5 was 5 degrees elsewhere while the calibration was recorded: the fit takes it
/// up, and the validation, recorded with the right zero, says that the result is worse than the
/// nominal robot.
#[test]
fn a_robot_that_is_worse_than_the_nominal_one_is_said_to_be() {
    let mut draw = Draw(5);
    let actual = built(0.3, &mut draw);
    let mut displaced = actual.clone();
    displaced.joints[4].link.theta += 5.0 * DEG;
    let files = |measured: &Robot, draw: &mut Draw| {
        (recorded(measured, 40, 90.0, draw), recorded(&actual, 40, 90.0, draw))
    };
    for (measured, is_worse) in [(&displaced, true), (&actual, false)] {
        let (measurements, validation) = files(measured, &mut draw);
        let campaign = read(&[
            (
                "campaign.toml",
                "robot = \"builtin:tx90\"\nmeasurements = \"m.csv\"\nvalidation = \"v.csv\"\n\
                 [tool]\nxyz_mm = [50, 20, 150]\n",
            ),
            ("m.csv", &measurements),
            ("v.csv", &validation),
        ]);
        let found = calibrate(&campaign, Mode::None, &Options::default()).unwrap();
        let said = found
            .warnings
            .iter()
            .map(ToString::to_string)
            .find(|words| words.contains("worse than the nominal"));
        assert_eq!(said.is_some(), is_worse, "{said:?}");
    }
}
