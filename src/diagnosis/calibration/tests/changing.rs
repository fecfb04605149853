//! What changes while the poses are recorded, and what is remembered: not what is like it, and not
//! nothing.

use super::*;
use crate::inference::ShownBy;

/// Names of what is found, what shows that something is left, and along what.
fn diagnosed(campaign: &Campaign, mode: Mode) -> (Vec<&'static str>, Option<ShownBy>, String) {
    let found = diagnose_as_recorded(campaign, mode, &Options::default()).unwrap();
    let names = found.diagnosis.findings.iter().map(|finding| finding.effect.name).collect();
    let left = found.diagnosis.discrepancy;
    let place = left.as_ref().and_then(|left| left.location.as_ref()).map(ToString::to_string);
    (names, left.map(|left| left.shown_by), place.unwrap_or_default())
}

/// Half of the variance over ten poses is something that moves; errors of a laboratory, of a
/// correlation of 0.6, are none.
#[test]
fn a_base_that_wanders_is_unexplained_and_the_noise_of_a_laboratory_is_not() {
    let campaign = clamps(24);
    let with = |length: f64, share: f64| {
        let (mut random, carried) = (Random::seeded(4, 9), (-1.0 / length).exp());
        let mut normal = || Vector3::from_fn(|_, _| random.normal());
        let mut slow = normal();
        let errors: Vec<Vector3<f64>> = (0..campaign.measurements.len())
            .map(|_| {
                slow = slow * carried + normal() * (1.0 - carried * carried).sqrt();
                slow * share.sqrt() + normal() * (1.0 - share).sqrt()
            })
            .collect();
        diagnosed(&recorded(&campaign, &|row| errors[row] * (30.0 * UM), 0.0, 0), Mode::Fea)
    };
    assert_eq!(with(10.0, 0.7), (vec![], Some(ShownBy::Neighbours), String::new()));
    assert_eq!(with(2.0, 1.0), (vec![], None, String::new()));
}

/// A drive that gets softer from pose to pose is no link that grows and no base that drifts.
#[test]
fn a_drive_that_softens_is_said_to_follow_its_torque() {
    let campaign = clamps(16);
    let calibration = calibrate(&campaign, Mode::Fea, &Options::default()).unwrap();
    let context = Context::new(&campaign, &calibration).unwrap();
    let rows = campaign.measurements.len() as f64;
    let by = |row: usize| {
        let there = &context.configurations[row];
        there.tip_jacobian[1] * (1.5e-6 * there.torque[1] * (row as f64 / rows - 0.5))
    };
    let (names, _, place) = diagnosed(&recorded(&campaign, &by, 20.0 * UM, 8), Mode::Fea);
    assert!(names.is_empty() && place.ends_with(" × torque of joint 2"), "{names:?} {place}");
}

/// A drive that warms while the robot works, cools and warms again is no two slips of the joint;
/// one that slips is.
#[test]
fn a_zero_that_goes_its_own_way_is_no_two_slips() {
    let campaign = clamps(24);
    let calibration = calibrate(&campaign, Mode::Fea, &Options::default()).unwrap();
    let context = Context::new(&campaign, &calibration).unwrap();
    let rows = campaign.measurements.len();
    let mut warm = 0.0;
    let heat: Vec<f64> = (0..rows)
        .map(|row| {
            let works = f64::from(u8::from(3 * row / rows != 1));
            warm += 8.0 / rows as f64 * (works - warm);
            warm
        })
        .collect();
    let turned = |zero: &dyn Fn(usize) -> f64| {
        let by = |row: usize| context.configurations[row].tip_jacobian[2] * (150e-6 * zero(row));
        diagnosed(&recorded(&campaign, &by, 20.0 * UM, 8), Mode::Fea)
    };
    let (names, _, place) = turned(&|row| heat[row]);
    assert!(names.is_empty() && place.ends_with("zero of joint 3"), "{names:?} {place}");
    let (names, left, _) = turned(&|row| f64::from(u8::from(2 * row > rows)));
    assert_eq!((names, left), (vec!["joint_shift"], None));
}

/// A base that turns little by little, or a tracker on a tripod that settles, is no row of slips;
/// one that was knocked is one.
#[test]
fn a_base_that_turns_is_no_row_of_slips() {
    let turned = |course: &dyn Fn(f64) -> f64| {
        let by =
            |row: usize, tip: &Vector3<f64>| Vector3::x().cross(tip) * (400e-6 * course(row as f64 / 100.0));
        tracked(100, &|row, tip| tip + by(row, tip))
    };
    let (names, left, _) = diagnosed(&turned(&|part| part), Mode::None);
    assert_eq!((names, left), (vec!["thermal_drift"], None));
    // there and back
    let (names, _, place) = diagnosed(&turned(&|part| (3.0 * part).sin()), Mode::None);
    assert!(names.is_empty() && place.contains("a curve of the base that turns"), "{names:?} {place}");
    let knocked = turned(&|part| f64::from(u8::from(part > 0.4)));
    let found = diagnose_as_recorded(&knocked, Mode::None, &Options::default()).unwrap();
    let [shift] = &found.diagnosis.findings[..] else { panic!("{:?}", found.diagnosis.findings) };
    let said = shift.description.to_string();
    let turn = said.split("turned by ").nth(1).and_then(|rest| rest.split(' ').next()).unwrap();
    assert!(
        (turn.parse::<f64>().unwrap() - 400.0).abs() < 40.0 && shift.effect.name == "base_shift",
        "{said}"
    );
}

/// A clamp that settles, or whose sensors drift, was not knocked twice; one that was knocked was.
#[test]
fn a_clamp_that_settles_was_not_knocked() {
    let campaign = clamps(24);
    let rows = campaign.measurements.rows.iter().enumerate();
    let own: Vec<usize> = rows.filter(|(_, row)| row.group == 1).map(|(row, _)| row).collect();
    let drifted = |course: &dyn Fn(f64) -> f64| {
        let over = |row: usize| own.iter().position(|k| *k == row).map(|k| k as f64 / own.len() as f64);
        let by = |row: usize| Vector3::z() * (300.0 * UM * over(row).map_or(0.0, course));
        diagnosed(&recorded(&campaign, &by, 20.0 * UM, 8), Mode::Fea)
    };
    let (names, left, _) = drifted(&|over| 1.0 - (-over / 0.15).exp());
    assert_eq!((names, left), (vec!["clamp_drift"], None));
    // there, back and beyond
    let (names, _, place) = drifted(&|over| (6.0 * over).sin());
    assert!(names.is_empty() && place == "order at clamp 2, a curve in the world", "{names:?} {place}");
    let (names, left, _) = drifted(&|over| f64::from(u8::from(over > 0.4)));
    assert_eq!((names, left), (vec!["clamp_shift"], None));
}

/// A tool that slips when gravity presses it by half of its weight, and stays there.
#[test]
fn a_tool_that_sticks_follows_what_it_was_last_pressed_to() {
    let campaign = clamps(24);
    let calibration = calibrate(&campaign, Mode::Fea, &Options::default()).unwrap();
    let context = Context::new(&campaign, &calibration).unwrap();
    let mut side = 0.0;
    let displaced: Vec<Vector3<f64>> = (context.configurations.iter())
        .map(|there| {
            let pressed = there.flange.rotation.column(1).dot(&there.gravity.normalize());
            if pressed.abs() > 0.5 {
                side = pressed.signum();
            }
            there.flange.rotation * Vector3::new(0.3, 1.0, 0.0) * (60.0 * UM * side)
        })
        .collect();
    let (names, _, place) = diagnosed(&recorded(&campaign, &|row| displaced[row], 20.0 * UM, 9), Mode::Fea);
    assert_eq!(names, Vec::<&str>::new());
    assert_eq!(place, "orientation, stuck along y of the tool, beyond 0.5 of its weight");
}

/// A tracker whose scale changes is neither an arm that grows nor a base or a tool that moved.
#[test]
fn a_tracker_of_another_scale_from_a_row_on_is_no_move() {
    let campaign = tracked(100, &|row, tip| tip * (1.0 + if row < 62 { 0.0 } else { 8e-5 }));
    let (names, _, place) = diagnosed(&campaign, Mode::None);
    assert!(names.is_empty() && place == "distance from the tracker, after pose 62", "{names:?} {place}");
}

/// Seen from 11 m, what air does to the scale of a laser, 1 µm/m per kelvin, is nearly a base that
/// drifts, and both are said; a camera that grows 3 m away is no such base. A base that drifts
/// keeps its name, for a tracker may always stand farther away.
#[test]
fn a_tracker_that_warms_is_told_from_a_base_that_drifts_or_said_beside_it() {
    let warmth = |row: usize| 2.0 * (row as f64 / 20.0).sin();
    let at = Vector3::new(2.5, 1.0, 0.8);
    let explained = |seen: &dyn Fn(usize, &Vector3<f64>) -> Vector3<f64>| {
        let mut campaign = tracked(120, seen);
        let rows = campaign.measurements.rows.iter_mut().enumerate();
        rows.for_each(|(k, row)| row.temperature = Some(21.0 + warmth(k)));
        let found = diagnose_as_recorded(&campaign, Mode::None, &Options::default()).unwrap();
        let [own] = &found.diagnosis.findings[..] else { panic!("{:?}", found.diagnosis.findings) };
        let rivals = own.rivals.iter().map(|rival| &rival.location);
        [&own.location].into_iter().chain(rivals).map(ToString::to_string).collect::<Vec<_>>()
    };
    let (tracker, base) = ("tracker, with temperature", "base, with temperature");
    let scaled =
        |k: f64, at: Vector3<f64>| move |row: usize, tip: &Vector3<f64>| tip + (tip - at) * (k * warmth(row));
    let far = explained(&scaled(1e-6, at * 4.0));
    assert!([tracker, base].iter().all(|place| far.iter().any(|said| said == place)), "{far:?}");
    let near = explained(&scaled(2e-5, at));
    assert_eq!(near, [tracker]);
    let drifting = explained(&|row, tip| tip + at * (4e-5 * warmth(row)));
    assert_eq!(drifting[0], base);
}

/// A tracker whose filter has not settled shows points on the straight way from the ones before: no
/// joints that were read too early, whose ways are arcs; and those keep their name.
#[test]
fn points_that_lag_are_no_angles_that_were_read_too_early() {
    let share = 2e-4;
    let last = std::cell::Cell::new(None);
    let filtered = tracked(120, &|_, tip| {
        let before: Vector3<f64> = last.replace(Some(*tip)).unwrap_or(*tip);
        tip + (before - tip) * share
    });
    let (names, left, _) = diagnosed(&filtered, Mode::None);
    assert_eq!((names, left), (vec!["tracker_lag"], None));
    let calibration = calibrate(&filtered, Mode::None, &Options::default()).unwrap();
    let context = Context::new(&filtered, &calibration).unwrap();
    let settled = tracked(120, &|_, tip| *tip);
    let late = |joints: std::ops::Range<usize>, share: f64| {
        let by = |row: usize| {
            let there = &context.configurations[row];
            joints.clone().map(|j| there.tip_jacobian[j] * (share * there.step[j])).sum()
        };
        diagnosed(&recorded(&settled, &by, 0.0, 1), Mode::None).0
    };
    assert_eq!(late(1..2, share), ["readback_lag"]);
    assert_eq!(late(0..6, share), ["readback_lag"]);
}
