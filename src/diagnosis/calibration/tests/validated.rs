//! Validation poses, of which no search sees any.

use super::*;
use crate::calibration::campaign::{Recording, Refit};
use crate::calibration::{Warning, validate};
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
    assert_eq!(own.events, [format!("a shift of the base (after pose {})", knocked.before.len() / 2)]);
    assert!(knocked.is_mismatch());
    assert!(own.explain(knocked.expected) && own.mean() < 100.0 * UM, "{}", own.mean());
}

/// An error that follows an angle is the robot's; one that follows the order of the poses is not.
#[test]
fn what_follows_the_angles_of_the_validation_did_not_happen_there() {
    let wavy = validated(&|recording| {
        let turned: Vec<f64> = (0..recording.len()).map(|row| recording.joints(row)[1]).collect();
        points(recording).iter_mut().zip(turned).for_each(|(point, q)| point.z += 1.5 * MM * (4.0 * q).sin());
    });
    let own = wavy.own.clone().expect("it is far off");
    assert!(wavy.is_far() && own.events.is_empty() && own.errors == wavy.before, "{own:?}");
    assert!(!own.of_robot.is_empty() || own.unexplained.is_some(), "{own:?}");
    let drifting = validated(&|recording| {
        points(recording).iter_mut().enumerate().for_each(|(row, point)| point.y += 0.02 * MM * row as f64);
    });
    let own = drifting.own.clone().expect("it is far off");
    assert!(own.explain(drifting.expected) && own.events.len() == 1 && own.of_robot.is_empty(), "{own:?}");
}

/// A device that measures the validation less accurately is no error of the robot either.
#[test]
fn a_validation_that_is_measured_less_accurately_scatters() {
    let noisy = validated(&|recording| {
        let mut random = Random::seeded(8, 0);
        let noise = |_: usize| 100.0 * UM * random.normal();
        let noise: Vec<f64> = (0..3 * recording.len()).map(noise).collect();
        points(recording).iter_mut().zip(noise.chunks(3)).for_each(|(point, own)| {
            *point += Vector3::new(own[0], own[1], own[2]);
        });
    });
    let own = noisy.own.clone().expect("it is far off");
    assert!(own.events.is_empty() && own.of_robot.is_empty() && own.unexplained.is_none(), "{own:?}");
    assert!((own.scatter - 109.0 * UM).abs() < 20.0 * UM, "{}", own.scatter);
}

/// Positions that were written in another order than the angles.
#[test]
fn a_mistake_in_the_validation_alone_is_named() {
    let displaced = validated(&|recording| points(recording).rotate_left(1));
    let own = displaced.own.clone().expect("it is far off");
    assert_eq!(own.events, ["rows displaced (x_mm, y_mm, z_mm)"]);
    assert!(own.explain(displaced.expected), "{}", own.mean());
}

/// As it was recorded, the validation is as far off as the poses held out: nothing is looked into.
#[test]
fn a_validation_that_agrees_is_not_diagnosed() {
    let clean = validated(&|_| {});
    assert!(!clean.is_far() && !clean.is_mismatch() && clean.own.is_none() && clean.after.is_none());
    assert_eq!(clean.means(), (clean.before.iter().sum::<f64>() / clean.before.len() as f64, None));
}

/// With nothing fitted again, a validation that was measured with another tool, or from elsewhere,
/// says nothing of the robot.
#[test]
fn a_validation_with_another_tool_or_from_elsewhere_is_said() {
    let as_recorded = recorded(&clamps(12), &|_| Vector3::zeros(), 18.0 * UM, 3);
    let fitted = calibrate(&as_recorded, Mode::Fea, &Options::default()).unwrap();
    let mut campaign = as_recorded.clone();
    campaign.refit = Refit::Nothing;
    let events = |campaign: &Campaign| {
        let mut found = diagnose_as_recorded(campaign, Mode::Fea, &Options::default()).unwrap();
        look_at_validation(&mut found).unwrap();
        let validated = found.model.validated.unwrap();
        let own = validated.own.expect("it is far off");
        assert!(own.explain(validated.expected), "{own:?}");
        own.events
    };
    // a short rod
    assert_eq!(events(&campaign), ["another tool"]);
    // measured with the tool of the calibration, from elsewhere
    let recording = campaign.validation.as_mut().unwrap();
    let again = validate(&fitted.setup, recording, Refit::Nothing).unwrap();
    let shift = Vector3::new(5.0, -3.0, 2.0) * MM;
    points(recording).iter_mut().zip(&again.tips).for_each(|(point, tip)| *point = tip + shift);
    assert_eq!(events(&campaign), ["another place of tracker or base"]);
}

/// Who only calibrates is warned.
#[test]
fn a_calibration_warns_of_a_validation_that_is_far_off() {
    let is_warned = |campaign: &Campaign| {
        let calibration = calibrate(campaign, Mode::Fea, &Options::default()).unwrap();
        calibration.warnings.iter().any(|warning| matches!(warning, Warning::ValidationFar { .. }))
    };
    let mut campaign = recorded(&clamps(12), &|_| Vector3::zeros(), 18.0 * UM, 3);
    assert!(!is_warned(&campaign));
    points(campaign.validation.as_mut().unwrap()).rotate_left(1);
    assert!(is_warned(&campaign));
}

/// A device whose scale is another one.
#[test]
fn a_scale_of_the_validation_alone_is_measured() {
    let scaled = validated(&|recording| points(recording).iter_mut().for_each(|point| *point *= 1.002));
    let own = scaled.own.clone().expect("it is far off");
    let [event] = &own.events[..] else { panic!("{:?}", own.events) };
    assert!(event.starts_with("positions that are 1.0020") && event.contains(" ± 0.0000"), "{event}");
    assert!(own.explain(scaled.expected), "{}", own.mean());
}

/// Angles of a joint in another scale.
#[test]
fn a_scale_of_an_encoder_in_the_validation_alone_is_measured() {
    let scaled = validated(&|recording| {
        recording.joint_values.iter_mut().skip(2).step_by(6).for_each(|q| *q *= 1.01);
    });
    let own = scaled.own.clone().expect("it is far off");
    let [event] = &own.events[..] else { panic!("{:?}", own.events) };
    assert!(event.starts_with("angles of joint 3 that are 1.0") && event.contains(" ± 0.0000"), "{event}");
    assert!(own.explain(scaled.expected), "{}", own.mean());
}

/// Poses in the order of an angle: a step of the robot's there looks like a base that moved.
#[test]
fn what_happened_cannot_be_distinguished_from_what_follows_the_order_of_the_poses() {
    let step = |is_sorted: bool| {
        validated(&|recording| {
            let mut order: Vec<usize> = (0..recording.len()).collect();
            order.sort_by(|a, b| recording.joints(*a)[1].total_cmp(&recording.joints(*b)[1]));
            let beyond = order[2 * order.len() / 3..].to_vec();
            points(recording).iter_mut().enumerate().for_each(|(row, point)| {
                point.z += if beyond.contains(&row) { 1.5 * MM } else { 0.0 };
            });
            if is_sorted {
                *recording = recording.subset(&order);
            }
        })
    };
    let own = step(true).own.expect("it is far off");
    let either = "or another cause that follows the angle of joint 2, in the order of which";
    assert!(own.events[0].contains("after pose") && own.events[0].contains(either), "{:?}", own.events);
    // in any other order it is the robot's
    let own = step(false).own.expect("it is far off");
    assert!(own.events.is_empty(), "{own:?}");
}

/// A joint that was mounted again after the calibration.
#[test]
fn a_zero_that_moved_before_the_validation_is_measured() {
    let moved = validated(&|recording| {
        recording.joint_values.iter_mut().skip(2).step_by(6).for_each(|q| *q += 0.3f64.to_radians());
    });
    let own = moved.own.clone().expect("it is far off");
    let [event] = &own.events[..] else { panic!("{:?}", own.events) };
    // the interval is about a thousandth of a degree
    assert!(event.starts_with("the zero of joint 3, which moved by -0.30"), "{event}");
    assert!(event.contains(" ± 0.001"), "{event}");
    assert!(own.explain(moved.expected), "{}", own.mean());
}
