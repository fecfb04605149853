//! A base that moved by so much that poses before and after fit no common one.

use super::super::motion::motion_estimates;
use super::*;
use crate::statistics::HALF_95;

#[test]
fn a_base_that_moved_is_found_at_its_row_and_becomes_a_station() {
    for (row, way, angle) in [(31, 0.05, 1.0 * DEG), (20, 0.5, 10.0 * DEG), (42, 1.5, 40.0 * DEG)] {
        let mut wrong = tracked(60, 7);
        let motion = Pose::from_xyz_rpy([way, 0.0, 0.0], [angle, 0.0, 0.0]);
        points(&mut wrong)[row..].iter_mut().for_each(|point| *point = motion.point(point));
        let mended = mended(&wrong);
        assert_eq!(mended.found.len(), 1);
        assert_eq!(mended.found[0].effect.name, "base_shift");
        assert_eq!(mended.found[0].location.to_string(), format!("after pose {row}"));
        let calibrated = calibrate(&mended.campaign, Mode::None, &Options::default()).unwrap();
        let rms = calibrated.rms();
        assert!((rms - 30.0 * UM * 3f64.sqrt()).abs() < 20.0 * UM, "{rms}");
        assert!(!suspected(&wrong, Mode::None, &Neighbours::default()).unwrap().is_empty());
        assert!(suspected(&mended.campaign, Mode::None, &Neighbours::default()).unwrap().is_empty());
    }
}

/// Angles that were read before the arm had settled scatter the poses of either base, and turn it,
/// by more than noise does; once that is found the move is known as well as without.
#[test]
fn how_far_a_base_moved_is_measured_beside_what_was_found() {
    let (names, settled) = measured(0.0);
    assert_eq!(names, ["base_shift"]);
    let (names, lagging) = measured(2e-4);
    assert_eq!(names, ["base_shift", "readback_lag"]);
    for ((off, standard_error), (_, without)) in lagging.into_iter().zip(settled) {
        assert!(off.abs() < 3.0 * standard_error, "{off} {standard_error}");
        assert!(standard_error < 2.0 * without, "{standard_error} {without}");
    }
}

/// What is found where a share of each move is still to come when the angles are read: the names,
/// and by how much each number of the base's move is off, with its standard error.
fn measured(lag: f64) -> (Vec<&'static str>, Vec<(f64, f64)>) {
    let mut wrong = tracked(90, 7);
    let motion = Pose::from_xyz_rpy([0.05, 0.02, -0.01], [2e-3, -3e-3, 1.0 * DEG]);
    let arrived = wrong.measurements.joint_values.clone();
    for (k, read) in wrong.measurements.joint_values.iter_mut().enumerate().skip(6) {
        *read += lag * (arrived[k] - arrived[k - 6]);
    }
    points(&mut wrong)[45..].iter_mut().for_each(|point| *point = motion.point(point));
    let mended = mended(&wrong);
    let found = mended.diagnose().unwrap();
    let base = Pose::from_xyz_rpy(BASE.0, BASE.1);
    let truth = motion_estimates(&base, &motion.then(&base));
    let estimates = found.diagnosis.findings[0].estimates.iter().zip(truth);
    let off = estimates.map(|(own, truth)| (own.value - truth.value, (own.high - own.low) / (2.0 * HALF_95)));
    (found.diagnosis.findings.iter().map(|finding| finding.effect.name).collect(), off.collect())
}
