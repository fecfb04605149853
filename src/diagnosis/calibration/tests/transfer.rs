//! What was found in one campaign, predicted for the poses of another one.

use super::*;
use crate::calibration::Compensation;

/// Of the campaign's rows, the even ones as a recording of their own and the odd ones as what is
/// asked for.
fn halves(campaign: &Campaign) -> [Campaign; 2] {
    let rows = campaign.measurements.len();
    [0, 1].map(|first| {
        let rows: Vec<usize> = (first..rows).step_by(2).collect();
        Campaign { measurements: campaign.measurements.subset(&rows), ..campaign.clone() }
    })
}

fn points(campaign: &Campaign) -> &[Vector3<f64>] {
    let Targets::Points(points) = &campaign.measurements.targets else { panic!("no points") };
    points
}

/// Root mean square of a coordinate's error, µm.
fn error(predicted: &[Vector3<f64>], truth: &[Vector3<f64>]) -> f64 {
    let squares: f64 = predicted.iter().zip(truth).map(|(a, b)| (a - b).norm_squared()).sum();
    (squares / (3 * truth.len()) as f64).sqrt() / UM
}

#[test]
fn a_gear_acts_in_other_poses_and_a_misplaced_clamp_does_not() {
    let campaign = clamps(40);
    let calibration = calibrate(&campaign, Mode::Fea, &Options::default()).unwrap();
    let context = Context::new(&campaign, &calibration).unwrap();
    let turned = |row: usize| {
        let configuration = &context.configurations[row];
        configuration.tip_jacobian[2] * (200e-6 * (7.0 * configuration.joints[2]).sin())
    };
    let rows = &campaign.measurements.rows;
    let off = Vector3::new(400.0, -300.0, 200.0) * UM;
    // the ball is where the gear puts it; the clamp only says otherwise
    let stated = |row: usize| turned(row) + if rows[row].group == 1 { off } else { Vector3::zeros() };
    let truth = recorded(&campaign, &turned, 0.0, 1);
    let [recorded, _] = halves(&recorded(&campaign, &stated, 10.0 * UM, 1));
    let [_, asked] = halves(&truth);
    let found = diagnose_as_recorded(&recorded, Mode::Fea, &Options::default()).unwrap();
    let effects: Vec<&str> = found.diagnosis.findings.iter().map(|finding| finding.effect.name).collect();
    assert!(effects.contains(&"transmission_error") && effects.contains(&"clamp_pose"), "{effects:?}");
    let predicted = found.predicted(&asked).unwrap();
    let with = error(&predicted, points(&asked));
    assert!(with < 8.0, "{with} µm");
    // without what was found
    let mut nothing = found.clone();
    nothing.diagnosis.findings.clear();
    nothing.diagnosis.hypothesis.terms.clear();
    let without = error(&nothing.predicted(&asked).unwrap(), points(&asked));
    assert!(without > 5.0 * with, "{without} µm, {with} µm");
}

#[test]
fn another_force_bends_the_rod_by_its_compliance() {
    let campaign = clamps(25);
    let recorded = recorded(&campaign, &|_| Vector3::zeros(), 5.0 * UM, 2);
    let found = diagnose_as_recorded(&recorded, Mode::Fea, &Options::default()).unwrap();
    assert!(found.diagnosis.findings.is_empty());
    let more = Vector3::new(0.0, 1.5, -2.0);
    let pushed = Campaign { contact_force: campaign.contact_force.map(|f| f + more), ..campaign.clone() };
    let moved = found.predicted(&pushed).unwrap();
    let still = found.predicted(&campaign).unwrap();
    let compliance = Compensation::new(&campaign, Mode::Fea).unwrap().compliance.unwrap();
    let calibration = calibrate(&recorded, Mode::Fea, &Options::default()).unwrap();
    let context = Context::new(&recorded, &calibration).unwrap();
    let expected: Vec<Vector3<f64>> = (0..still.len())
        .map(|row| {
            let group = campaign.measurements.rows[row].group;
            let force = campaign.measurements.groups[group].device.rotation * more;
            let configuration = &context.configurations[row];
            still[row]
                + configuration.in_world(&compliance.force) * force
                + configuration.joint_deflection(&configuration.tip, &force)
        })
        .collect();
    let largest = moved.iter().zip(&still).map(|(a, b)| (a - b).norm() / UM).fold(0.0, f64::max);
    assert!(largest > 100.0, "{largest}");
    let off = error(&moved, &expected);
    assert!(off < 0.01 * largest, "{off} µm of {largest}");
}

#[test]
fn a_drift_goes_on_with_its_clock_and_asks_for_it() {
    let mut campaign = clamps(40);
    let rows = campaign.measurements.rows.iter_mut().zip(0..);
    rows.for_each(|(row, k)| row.temperature = Some(20.0 + f64::from(k % 60) * 0.05));
    let per_kelvin = Vector3::new(60.0, -40.0, 80.0) * UM;
    let drift = |row: usize| per_kelvin * (campaign.measurements.rows[row].temperature.unwrap() - 21.0);
    let [recorded, _] = halves(&recorded(&campaign, &drift, 5.0 * UM, 3));
    let [_, mut asked] = halves(&campaign);
    let found = diagnose_as_recorded(&recorded, Mode::Fea, &Options::default()).unwrap();
    assert_eq!(found.diagnosis.findings[0].effect.name, "thermal_drift");
    // 4 K warmer than the mean of the recording, whatever that is with which drifts are compared
    let mean = recorded.measurements.rows.iter().filter_map(|row| row.temperature).sum::<f64>()
        / recorded.measurements.len() as f64;
    let predicted = |kelvin: f64, asked: &mut Campaign| {
        asked.measurements.rows.iter_mut().for_each(|row| row.temperature = Some(mean + kelvin));
        found.predicted(asked).unwrap()
    };
    let (cold, warm) = (predicted(0.0, &mut asked), predicted(4.0, &mut asked));
    let drifted: Vec<Vector3<f64>> = cold.iter().map(|at| at + per_kelvin * 4.0).collect();
    let off = error(&warm, &drifted);
    assert!(off < 10.0, "{off} µm of 400");
    asked.measurements.rows.iter_mut().for_each(|row| row.temperature = None);
    let refused = found.predicted(&asked).unwrap_err().to_string();
    assert!(refused.contains("thermal_drift"), "{refused}");
    let mut other = asked;
    other.robot.joints.pop();
    assert!(found.predicted(&other).is_err());
}

#[test]
fn a_base_that_moved_stays_there() {
    let campaign = clamps(40);
    let by = Vector3::new(300.0, -500.0, 400.0) * UM;
    // the clamps in turn, so that no one of them is what moved
    let count = campaign.measurements.len();
    let turn: Vec<usize> = (0..count).map(|k| k % 5 * 40 + k / 5).collect();
    let campaign = Campaign { measurements: campaign.measurements.subset(&turn), ..campaign };
    let shifted = |row: usize| if row >= count / 2 { by } else { Vector3::zeros() };
    let [recorded, _] = halves(&recorded(&campaign, &shifted, 10.0 * UM, 4));
    let [_, asked] = halves(&campaign);
    let found = diagnose_as_recorded(&recorded, Mode::Fea, &Options::default()).unwrap();
    assert_eq!(found.diagnosis.findings[0].effect.name, "base_shift", "{:?}", found.diagnosis.findings);
    let predicted = found.predicted(&asked).unwrap();
    let moved: Vec<Vector3<f64>> = points(&asked).iter().map(|point| point + by).collect();
    let off = error(&predicted, &moved);
    assert!(off < 20.0, "{off} µm");
}
