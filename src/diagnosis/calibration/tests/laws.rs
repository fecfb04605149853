//! Laws that no library has, concealed in campaigns.

use std::collections::BTreeSet;
use std::f64::consts::TAU;

use nalgebra::DMatrix;

use super::super::model::Configuration;
use super::*;
use crate::diagnosis::Limitation;
use crate::diagnosis::calibration::laws::sites::sites;
use crate::inference::law::points::{GrammarPoint, likeness};
use crate::inference::law::{Constant, Form, Law};
use crate::units::DEG;

const NOISE: f64 = 15.0 * UM;

/// A campaign with a displacement of each row (m, by the calibrated robot there), diagnosed; the
/// law that is proposed with the errors of held-out poses.
fn concealed(
    seed: u64,
    by: &dyn Fn(&Configuration) -> Vector3<f64>,
    then: impl FnOnce(&Law, (f64, f64), &CalibrationDiagnosis),
) {
    let clean = clamps(16);
    let calibration = calibrate(&clean, Mode::Fea, &Options::default()).unwrap();
    let context = Context::new(&clean, &calibration).unwrap();
    let campaign = recorded(&clean, &|row| by(&context.configurations[row]), NOISE, seed);
    let found = diagnose_as_recorded(&campaign, Mode::Fea, &Options::default()).unwrap();
    let proposed = found.law.as_ref().expect("something is left");
    let law = proposed.law.as_ref().unwrap_or_else(|refusal| panic!("{refusal:?}"));
    then(law, proposed.held_out.unwrap(), &found);
}

fn assert_holds(constant: &Constant, truth: f64) {
    assert!(constant.low < truth && truth < constant.high, "{truth} in {constant:?}");
    assert!(constant.high - constant.low < 0.3 * truth, "{constant:?}");
}

/// A cable between joints 2 and 3 pulls joint 4 by their product.
#[test]
fn a_cable_that_pulls_with_two_joints_is_a_product() {
    let pull = |there: &Configuration| there.tip_jacobian[3] * (500e-6 * there.joints[1] * there.joints[2]);
    concealed(5, &pull, |law, (without, with), found| {
        assert_eq!((law.form, law.site.location.to_string().as_str()), (Form::Polynomial(1), "joint 4"));
        assert_eq!(law.site.result.name, "turn of joint 4 per radian of joint 2");
        assert_eq!(law.site.variable.name, "angle of joint 3");
        assert_holds(&law.amplitudes[0], 500.0 * DEG);
        assert!(with < 1.3 * NOISE && without > 3.0 * with, "{without} {with}");
        assert!(found.diagnosis.findings.is_empty() && found.diagnosis.is_mismatch());
    });
}

/// A hose that is taut from one configuration of two joints on.
#[test]
fn a_hose_that_gets_taut_is_a_threshold() {
    let pull = |there: &Configuration| {
        there.tip_jacobian[3] * (1000e-6 * (there.joints[1] + there.joints[2] - 0.2).max(0.0))
    };
    concealed(6, &pull, |law, (without, with), _| {
        assert_eq!(law.form, Form::Threshold);
        assert_eq!(law.site.variable.name, "sum of the angles of joints 2 and 3");
        assert_holds(&law.amplitudes[0], 1000.0 * DEG);
        let (_, corner) = law.constant.as_ref().unwrap();
        assert!(corner.low < 0.2 / DEG && 0.2 / DEG < corner.high, "{corner:?}");
        // twice as much of it is no second law; another form of it is one, and so is what it adds
        // elsewhere
        let mut second = law.clone();
        second.adds.iter_mut().for_each(|add| *add *= -2.0);
        assert!(second.repeats(law));
        assert!(!Law { form: Form::Step, ..second.clone() }.repeats(law));
        second.adds.rotate_right(30);
        assert!(!second.repeats(law));
        assert!(with < 0.5 * without, "{without} {with}");
    });
}

/// A joint that gives way from a torque on is a law of its torque, and no stiffness that depends on
/// the load beside play.
#[test]
fn a_torque_from_which_on_a_joint_gives_way_is_one_law() {
    let gives_way = |there: &Configuration| {
        let torque = there.torque[1];
        there.tip_jacobian[1] * (12e-6 * torque.signum() * (torque.abs() - 60.0).max(0.0))
    };
    concealed(9, &gives_way, |law, (without, with), found| {
        assert!(found.diagnosis.findings.is_empty());
        assert!(found.limits.iter().any(|limit| matches!(limit, Limitation::NamesForLaw(..))));
        assert_eq!(law.site.location.to_string(), "joint 2");
        assert_eq!(law.site.variable.name, "torque of joint 2");
        // what the compliance that was calibrated takes up makes a stop of it
        let (_, corner) = law.constant.as_ref().unwrap();
        assert!(corner.low < 60.0 && 60.0 < corner.high, "{corner:?}");
        assert!(with < 0.5 * without, "{without} {with}");
    });
}

/// Nothing, and warming up: what calibration and library explain leaves nothing to look for a law
/// in.
#[test]
fn where_nothing_is_left_there_is_no_law() {
    let clean = clamps(16);
    let calibration = calibrate(&clean, Mode::Fea, &Options::default()).unwrap();
    let context = Context::new(&clean, &calibration).unwrap();
    let none = |_: usize| Vector3::zeros();
    let warms = |row: usize| {
        let there = &context.configurations[row];
        there.flange.rotation.column(1) * (200.0 * UM * (1.0 - (-(row as f64) / 20.0).exp()))
    };
    for by in [&none as &dyn Fn(usize) -> Vector3<f64>, &warms] {
        let campaign = recorded(&clean, by, NOISE, 7);
        let found = diagnose_as_recorded(&campaign, Mode::Fea, &Options::default()).unwrap();
        assert!(found.law.is_none() && found.diagnosis.discrepancy.is_none());
    }
}

/// What effects of the library are in the grammar: for each the beginning of a candidate's place,
/// and the law's place, variable and form.
const POINTS: [(&str, &str, (&str, &str), Form); 11] = [
    ("joint_compliance", "joint 2", ("joint 2", "torque of joint 2"), Form::Polynomial(1)),
    ("joint_nonlinear_stiffness", "joint 2", ("joint 2", "torque of joint 2"), Form::Polynomial(3)),
    ("backlash", "joint 2", ("joint 2", "torque of joint 2"), Form::Step),
    ("encoder_scale", "joint 3", ("joint 3", "angle of joint 3"), Form::Polynomial(1)),
    ("wrist_coupling", "joint 5 to 6", ("joint 6", "angle of joint 5"), Form::Polynomial(1)),
    ("transmission_error", "joint 3", ("joint 3", "angle of joint 3"), Form::Harmonic),
    ("joint_shift", "joint 3", ("joint 3", "number of poses before"), Form::Step),
    ("tool_shift", "tool", ("tool", "number of poses before"), Form::Step),
    ("thermal_drift", "joint 3, zero", ("joint 3", "number of poses before"), Form::Polynomial(1)),
    ("thermal_drift", "tool", ("tool", "number of poses before"), Form::Polynomial(1)),
    ("base_shift", "after pose", ("base", "number of poses before"), Form::Step),
];

/// What is no function of one variable at one place of the grammar: loads that bend the rod (each
/// of three weights along three axes), what happens at one clamp or pose, what acts along the axes
/// of a device or towards it, what turns a link or the base under a moment, waits that depend on
/// the way, and friction as large as the torque whatever its sign.
const NO_POINTS: [&str; 21] = [
    "rod_stiffness",
    "rod_mass",
    "tip_mass",
    "payload_mass",
    "load_change",
    "gravity_direction",
    "clamp_pose",
    "clamp_shift",
    "clamp_drift",
    "socket_shift",
    "outlier",
    "contact_force_variation",
    "contact_spring",
    "sensor_scale",
    "link_flexibility",
    "gravity_tilt",
    "readback_lag",
    "tracker_lag",
    "range_offset",
    "device_axes",
    "joint_friction",
];

/// Existing effects are points of the grammar: what they do to the poses is what a law does.
#[test]
fn the_library_is_a_part_of_the_grammar() {
    let campaign = clamps(12);
    let calibration = calibrate(&campaign, Mode::Fea, &Options::default()).unwrap();
    let context = Context::new(&campaign, &calibration).unwrap();
    let poses = campaign.measurements.len();
    let all = sites(&context, 3 * poses);
    let own = registry::candidates(&context).0;
    let columns = |entry: &Entry| {
        let mut matrix = DMatrix::zeros(3 * poses, entry.columns.len());
        for (k, column) in entry.columns.iter().enumerate() {
            column.add_to_slice(matrix.column_mut(k).as_mut_slice(), 1.0);
        }
        matrix
    };
    for (effect, location, (place, variable), form) in POINTS {
        let site =
            all.iter().find(|site| site.location.to_string() == place && site.variable.name == variable);
        let largest = site.unwrap_or_else(|| panic!("{place} over {variable}")).largest();
        let constants: Vec<f64> = match form {
            // after each pose, or at no torque
            Form::Step if variable == "number of poses before" => {
                (1..poses).map(|k| (k as f64 - 0.5) / largest).collect()
            }
            // so many waves in a turn
            Form::Harmonic => (1..8).map(|k| f64::from(k) * largest / TAU).collect(),
            _ => vec![0.0],
        };
        let point = GrammarPoint { place, variable, form, sides: false };
        let is_there = |entry: &&Entry| {
            let candidate = &entry.candidate;
            candidate.effect.name == effect && candidate.location.to_string().starts_with(location)
        };
        let mut likenesses =
            own.iter().filter(is_there).map(|entry| likeness(&all, point, &constants, &columns(entry)));
        assert!(likenesses.any(|likeness| likeness > 1.0 - 1e-6), "{effect}, {place} over {variable}");
    }
    let known: BTreeSet<&str> = POINTS.iter().map(|point| point.0).chain(NO_POINTS).collect();
    assert_eq!(known, registry::ALL.iter().map(|own| own.effect.name).collect());
}
