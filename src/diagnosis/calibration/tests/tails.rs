//! Heavy tails of the sensors of a device, each of which reads along an axis of its own.

use super::*;

/// Student's t with three degrees of freedom.
fn heavy(random: &mut Random) -> f64 {
    let square: f64 = (0..3).map(|_| random.normal().powi(2)).sum();
    random.normal() / (square / 3.0).sqrt()
}

/// One sensor far out by itself is one of its tails; as three numbers of {W} it would be three that
/// are far out together.
#[test]
fn a_sensor_with_heavy_tails_has_misread_no_pose() {
    let campaign = clamps(18);
    let mut named = Vec::new();
    for seed in 0..8 {
        let mut random = Random::seeded(seed, 7);
        let mut read: Vec<Vector3<f64>> = (0..campaign.measurements.len())
            .map(|_| Vector3::from_fn(|_, _| 14.4 * UM * heavy(&mut random)))
            .collect();
        read[40].x = 250.0 * UM;
        let off = |row: usize| campaign.measurements.device(row).rotation * read[row];
        let recorded = recorded(&campaign, &off, 0.0, 0);
        let found = diagnose_as_recorded(&recorded, Mode::Fea, &Options::default()).unwrap();
        let names =
            found.diagnosis.findings.iter().map(|f| format!("seed {seed}: {} {}", f.effect, f.location));
        named.extend(names);
    }
    assert!(named.is_empty(), "{named:#?}");
}
