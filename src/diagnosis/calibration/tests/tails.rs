//! Heavy tails of the sensors of a device, each of which reads along an axis of its own.

use super::*;
use crate::diagnosis::Limitation;
use crate::units::MM;

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

/// A dozen poses at each of three clamps, whose rows have tails together: the calibration follows
/// them, so that one that it leaves out looks farther out than it is. What no tail makes is named,
/// and what either may be is said.
#[test]
fn the_farthest_of_a_few_poses_is_not_misread_and_one_that_no_tail_throws_is() {
    let campaign = clamps(7);
    let said = |seed: u64, misread: f64| {
        let mut random = Random::seeded(seed, 11);
        let mut row = || {
            let squares: f64 = (0..4).map(|_| random.normal().powi(2)).sum();
            Vector3::from_fn(|_, _| 20.0 * UM * random.normal() * (4.0 / squares).sqrt())
        };
        let mut off: Vec<Vector3<f64>> = (0..campaign.measurements.len()).map(|_| row()).collect();
        off[16] += Vector3::new(0.6, -0.6, 0.5) * misread;
        let recorded = recorded(&campaign, &|row| off[row], 0.0, 0);
        let found = diagnose_as_recorded(&recorded, Mode::Fea, &Options::default()).unwrap();
        let named = found.diagnosis.findings.iter().map(|f| f.location.to_string());
        let open = found.limits.iter().filter_map(|limit| match limit {
            Limitation::FarOut(poses) => Some(poses.join(", ")),
            _ => None,
        });
        (named.collect::<Vec<_>>(), open.collect::<Vec<_>>())
    };
    let clean: Vec<_> = (0..12).map(|seed| said(seed, 0.0)).collect();
    let named: Vec<_> = clean.iter().filter(|(named, _)| !named.is_empty()).collect();
    assert!(named.is_empty(), "{named:?}");
    let open = clean.iter().filter(|(_, open)| !open.is_empty()).count();
    assert!(open <= 3, "{open}");
    for seed in 1..=2 {
        assert_eq!(said(seed, 0.8 * MM), (vec!["pose 17".to_owned()], vec![]), "seed {seed}");
        assert_eq!(said(seed, 0.3 * MM), (vec![], vec!["pose 17".to_owned()]), "seed {seed}");
    }
}
