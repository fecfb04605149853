//! Laws that no library has, concealed in campaigns.

use super::super::model::Configuration;
use super::*;
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
