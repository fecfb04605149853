//! Gross errors: named, and harmless under robust weights.

use nalgebra::Vector3;
use rodcal::calibration::campaign::Targets;
use rodcal::calibration::{Calibration, Campaign, Mode, Options, Robust, Warning, calibrate};

use super::simulated::Simulator;

const SEEDS: u64 = 6;
/// Rows that a ball slipped at, on different clamps, and which way.
const SLIPPED: [(usize, [f64; 3]); 3] =
    [(5, [0.0012, 0.0016, 0.0]), (31, [-0.002, 0.0, 0.0]), (60, [0.0, -0.0012, 0.0016])];
/// How far the parameters may be from those of the clean recording, in standard errors of these.
/// Huber's weights let each of the three pull with 2.2 standard deviations; Tukey's let go of three
/// poses of 70 and weigh the rest anew.
const STRAY: [(Robust, f64); 2] = [(Robust::Huber, 2.0), (Robust::Tukey, 2.0)];

fn spoilt(campaign: &Campaign) -> Campaign {
    let mut campaign = campaign.clone();
    let Targets::Points(points) = &mut campaign.measurements.targets else { panic!("clamps measure points") };
    for (row, by) in SLIPPED {
        points[row] += Vector3::from(by);
    }
    campaign
}

fn calibrated(campaign: &Campaign, robust: Robust) -> Calibration<'_> {
    let found = calibrate(campaign, Mode::Fea, &Options::default().with_robust(robust)).unwrap();
    assert!(found.is_converged, "{robust:?}: {} {:?}", found.fit.reason, found.passes);
    found
}

/// Largest distance between the parameters of two calibrations, in standard errors of the first.
fn apart(clean: &Calibration, other: &Calibration) -> f64 {
    let pairs = clean.parameters.iter().zip(&other.parameters);
    pairs.map(|(a, b)| ((a.value - b.value) / a.std_error.unwrap()).abs()).fold(0.0, f64::max)
}

#[test]
fn gross_errors_are_named_and_do_no_harm() {
    let simulator = Simulator::new();
    for seed in 0..SEEDS {
        let (_, campaign) = simulator.run(seed);
        let slipped = spoilt(&campaign);
        let clean = calibrated(&campaign, Robust::None);
        let harmed = apart(&clean, &calibrated(&slipped, Robust::None));
        for (robust, stray) in STRAY {
            let found = calibrated(&slipped, robust);
            let strays = apart(&clean, &found);
            assert_eq!(found.outliers, SLIPPED.map(|(row, _)| row), "seed {seed}, {robust:?}");
            assert!(strays < stray, "seed {seed}, {robust:?}: {strays} standard errors from the clean robot");
            // the recording is worth the trouble
            assert!(
                harmed > 2.0 * strays,
                "seed {seed}, {robust:?}: {harmed} without weights, {strays} with"
            );
            // and the user is told, by name
            let told = found.warnings.iter().find_map(|warning| match warning {
                Warning::Outliers { poses, count_in_full } => Some((poses.clone(), *count_in_full)),
                _ => None,
            });
            let (poses, count_in_full) = told.unwrap();
            assert!(!count_in_full);
            for (row, _) in SLIPPED {
                let name = campaign.measurements.pose_name(row);
                assert!(
                    poses.iter().any(|(told, d)| *told == name && (d / 2e-3 - 1.0).abs() < 0.3),
                    "{poses:?}"
                );
            }
        }
    }
}

/// Least squares cannot let go of an outlier, but the user learns of it and what to do.
#[test]
fn least_squares_names_a_gross_error_too() {
    let (_, campaign) = Simulator::new().run(3);
    let slipped = spoilt(&campaign);
    let found = calibrated(&slipped, Robust::None);
    assert!(SLIPPED.iter().any(|(row, _)| found.outliers.contains(row)), "{:?}", found.outliers);
    let words: Vec<String> = found.warnings.iter().map(ToString::to_string).collect();
    assert!(words.iter().any(|words| words.contains("--robust huber")), "{words:?}");
}

/// Where there is nothing to weigh down, weights change next to nothing.
#[test]
fn robust_weights_leave_clean_recordings_alone() {
    let (_, campaign) = Simulator::new().run(2);
    let clean = calibrated(&campaign, Robust::None);
    for robust in [Robust::Huber, Robust::Tukey] {
        let found = calibrated(&campaign, robust);
        // 95 % efficiency: a twentieth of the variance more is √0.05 = 0.22 standard errors for one
        // parameter, and there are 32 of them
        let apart = apart(&clean, &found);
        assert!(apart < 0.9, "{robust:?}: {apart} standard errors");
        let wider = clean
            .parameters
            .iter()
            .zip(&found.parameters)
            .map(|(a, b)| b.std_error.unwrap() / a.std_error.unwrap());
        for wider in wider {
            assert!((0.8..1.3).contains(&wider), "{robust:?}: a standard error is {wider} times as large");
        }
    }
}
