//! What is loose, or moves where nothing says that it does, is none of the mistakes that it may be
//! taken for: displacements in a clamp are as small as it.

use super::*;
use crate::diagnosis::calibration::mistakes::mend;

/// The mistakes of a campaign that has noise of 15 µm beside what is done to each pose, in µm.
fn mistakes(campaign: &Campaign, by: &dyn Fn(usize) -> Vector3<f64>) -> Vec<String> {
    let recorded = recorded(campaign, &|row| by(row) * UM, 15.0 * UM, 3);
    let mended = mend(&recorded, Mode::Fea, &Neighbours::default(), &Options::default()).unwrap();
    mended.found.iter().map(|found| format!("{} {}", found.effect, found.location)).collect()
}

/// What is found for each of them where the tool rests, so much displaced in {T}, on the side to
/// which gravity presses it along a line of {T}.
#[test]
fn a_tool_that_is_loose_is_no_mistake() {
    let cases = [
        (14, [0.3, 0.0, -1.0], [1500.0, 0.0, 0.0]),
        (14, [0.0, 1.0, 0.0], [1500.0, 0.0, 0.0]),
        (14, [0.0, 0.0, 1.0], [0.0, 0.0, -600.0]),
        (24, [0.0, 1.0, 0.0], [0.0, 1000.0, 0.0]),
    ];
    for (poses, line, displaced) in cases {
        let campaign = clamps(poses);
        let calibration = calibrate(&campaign, Mode::Fea, &Options::default()).unwrap();
        let context = Context::new(&campaign, &calibration).unwrap();
        let found = mistakes(&campaign, &|row| {
            let there = &context.configurations[row];
            let side = (there.flange.rotation * Vector3::from(line)).dot(&there.gravity).signum();
            there.flange.rotation * Vector3::from(displaced) * side
        });
        assert!(found.is_empty(), "{poses} {line:?} {displaced:?}: {found:?}");
    }
}

/// Numbers of a smaller unit leave less of whatever is left, and are no better for it.
#[test]
fn what_moves_with_a_joint_is_no_unit() {
    let campaign = clamps(8);
    let calibration = calibrate(&campaign, Mode::Fea, &Options::default()).unwrap();
    let context = Context::new(&campaign, &calibration).unwrap();
    for joint in [1, 3, 5] {
        let found = mistakes(&campaign, &|row| {
            let there = &context.configurations[row];
            there.flange.rotation.column(1) * (2000.0 * (3.0 * there.joints[joint]).sin())
        });
        assert!(found.is_empty(), "joint {joint}: {found:?}");
    }
}

/// Gravity and contact force of the other sign are named as before.
#[test]
fn signs_of_what_loads_the_rod_are_named() {
    let right = clamps(14);
    let (mut gravity, mut force) = (right.clone(), right);
    (gravity.robot_file, gravity.robot.gravity) = ("robot.toml".into(), -gravity.robot.gravity);
    force.contact_force = force.contact_force.map(|force| -force);
    let nothing = |_: usize| Vector3::zeros();
    assert_eq!(mistakes(&gravity, &nothing), ["sign_mistake gravity_m_s2"]);
    assert_eq!(mistakes(&force, &nothing), ["sign_mistake contact_force_n"]);
}
