//! Clamps that scatter unequally count by their own noise; clamps that scatter alike share one.

use rodcal::calibration::{Calibration, Campaign, Mode, Options, Warning, calibrate};

use super::lab::PHYSICS;
use super::recovery::Clamped;

/// The noise of each of three clamps, m.
fn campaign(noises: [f64; 3]) -> (Clamped, Campaign) {
    let of_each: Vec<Vec<String>> = noises
        .iter()
        .map(|&noise| {
            let mut made = Clamped::new(PHYSICS);
            made.noise = noise;
            made.measurements()
        })
        .collect();
    let made = Clamped::new(PHYSICS);
    // rows of a clamp with the noise of that clamp
    let rows: Vec<String> =
        made.poses.iter().enumerate().map(|(row, (clamp, _))| of_each[*clamp][row].clone()).collect();
    let campaign = made.campaign_with(&rows, "");
    (made, campaign)
}

fn calibrated(campaign: &Campaign) -> Calibration<'_> {
    let found = calibrate(campaign, Mode::Calc, &Options::default()).unwrap();
    assert!(found.is_converged, "{} {:?}", found.fit.reason, found.passes);
    found
}

#[test]
fn unequal_noise_is_found_and_used() {
    let (_, campaign) = campaign([10e-6, 60e-6, 10e-6]);
    let found = calibrated(&campaign);
    assert!(found.noise.p_equal.unwrap() < 1e-4);
    let [first, second, third] = found.noise.of_group[..] else { panic!("{:?}", found.noise.of_group) };
    // 25 poses, of whose 75 coordinates the parameters take a third: 10 to 20 %
    for (noise, truth) in [(first, 10e-6), (second, 60e-6), (third, 10e-6)] {
        assert!((0.6..1.6).contains(&(noise / truth)), "{noise} for {truth}");
    }
    let told = found.warnings.iter().find_map(|warning| match warning {
        Warning::UnequalNoise { noisiest, .. } => Some(noisiest.0.clone()),
        _ => None,
    });
    assert_eq!(told.as_deref(), Some("clamp 1"));
    // and better for it: weights of their own beat one weight for all
    let mut alike = campaign.clone();
    alike.noise = Some(30e-6);
    let alike = calibrated(&alike);
    let error = |found: &Calibration| -> f64 {
        let p = found.parameters.iter();
        p.map(|p| (p.std_error.unwrap()).ln()).sum()
    };
    assert!(error(&found) < error(&alike) - 5.0, "{} {}", error(&found), error(&alike));
}

#[test]
fn equal_noise_is_one_noise() {
    let (_, campaign) = campaign([20e-6; 3]);
    let found = calibrated(&campaign);
    assert!(found.noise.p_equal.unwrap() > 0.01);
    assert!(found.noise.of_group.iter().all(|&noise| noise == found.noise.pooled));
    assert!(!found.warnings.iter().any(|w| matches!(w, Warning::UnequalNoise { .. })));
    assert!((found.noise.pooled / 20e-6 - 1.0).abs() < 0.15, "{}", found.noise.pooled);
}
