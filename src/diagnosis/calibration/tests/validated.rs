//! Validation poses, of which no search sees any.

use super::*;
use crate::calibration::campaign::Recording;
use crate::diagnosis::calibration::Validated;
use crate::units::MM;

/// A recording of noise alone, and what its diagnosis says of a validation that `spoilt` changes.
fn validated(spoilt: &dyn Fn(&mut Recording)) -> Validated {
    let mut campaign = recorded(&clamps(12), &|_| Vector3::zeros(), 18.0 * UM, 3);
    spoilt(campaign.validation.as_mut().unwrap());
    let mut found = diagnose_as_recorded(&campaign, Mode::Fea, &Options::default()).unwrap();
    look_at_validation(&mut found).unwrap();
    assert!(found.diagnosis.findings.is_empty());
    found.model.validated.unwrap()
}

fn points(recording: &mut Recording) -> &mut [Vector3<f64>] {
    let Targets::Points(points) = &mut recording.targets else { unreachable!() };
    points
}

/// A tracker that was knocked while the validation was measured is no error of the robot.
#[test]
fn what_happened_in_the_validation_is_no_error_of_the_robot() {
    let knocked = validated(&|recording| {
        let half = recording.len() / 2;
        points(recording)[half..].iter_mut().for_each(|point| point.z += 1.5 * MM);
    });
    assert!(knocked.is_far(), "{knocked:?}");
    let own = knocked.own.clone().expect("something happened");
    assert_eq!(own.causes, [format!("a shift of the base (after pose {})", knocked.before.len() / 2)]);
    assert!(own.explain(knocked.expected) && own.mean() < 100.0 * UM, "{}", own.mean());
}

/// An error that follows the angles is the robot's: nothing happened.
#[test]
fn what_follows_the_angles_of_the_validation_did_not_happen_there() {
    let wavy = validated(&|recording| {
        let turned: Vec<f64> = (0..recording.len()).map(|row| recording.joints(row)[1]).collect();
        points(recording).iter_mut().zip(turned).for_each(|(point, q)| point.z += 1.5 * MM * (4.0 * q).sin());
    });
    assert!(wavy.is_far() && wavy.own.is_none(), "{:?}", wavy.own);
}

/// As it was recorded, the validation is as far off as the poses held out: nothing is looked into.
#[test]
fn a_validation_that_agrees_is_not_diagnosed() {
    let clean = validated(&|_| {});
    assert!(!clean.is_far() && clean.own.is_none() && clean.after.is_none());
    assert_eq!(clean.means(), (clean.before.iter().sum::<f64>() / clean.before.len() as f64, None));
}
