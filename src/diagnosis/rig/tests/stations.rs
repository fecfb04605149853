//! Several sensors along the rod, of which one is not as the others.

use super::*;
use crate::statistics::Random;
use crate::units::MM;

/// Along the second pipe, from the bend to the tip, mm.
const STATIONS: [f64; 4] = [250.0, 350.0, 450.0, 600.0];

/// Three trials under loads along y and z, noise 1 µm; `shown` of what a channel shows at a
/// station (mm) at a time (s), µm.
fn read(seed: u64, shown: impl Fn(f64, f64, f64) -> f64) -> RigDiagnosis {
    let (rod, mut random) = (rod(""), Random::seeded(seed, 0));
    let model = RodModel::new(&rod, &Physics::default(), 1, &STATIONS.map(|s| s * MM)).unwrap();
    let at = STATIONS.map(|s| model.force_response(rod.length(), s * MM).unwrap().translation);
    let mut text = "trial,axis,load_n,time_s,read_station_mm,dy_um,dz_um\n".to_owned();
    let mut time = 0.0;
    for (trial, axis) in (1..=3).flat_map(|trial| [Axis::Y, Axis::Z].map(|axis| (trial, axis))) {
        for load in [20.0, 4.0, 12.0, 8.0, 16.0] {
            time += 60.0;
            for (c, station) in at.iter().zip(STATIONS) {
                let [y, z] = [1, 2].map(|channel| {
                    shown(station, time, c[(channel, axis.index())] * load / UM) + random.normal()
                });
                text += &format!("{trial},{axis},{load},{time},{station},{y:.1},{z:.1}\n");
            }
        }
    }
    diagnose(&readings(&text), Some(&rod)).unwrap()
}

#[test]
fn sensors_at_one_station_may_read_too_much_or_drift() {
    let found = read(1, |_, _, bent| bent);
    assert!(!found.diagnosis.is_mismatch(), "{:?}", found.diagnosis.findings);
    let of_one = |found: &RigDiagnosis| {
        let [one] = &found.diagnosis.findings[..] else { panic!("{:?}", found.diagnosis.findings) };
        assert!(found.diagnosis.discrepancy.is_none());
        (one.effect.name, one.location.to_string(), found.model.describe(one).observed)
    };
    // in both channels alike, which another point of the rod is not
    let found = read(2, |station, _, bent| if station == 450.0 { 0.95 * bent } else { bent });
    let (name, place, words) = of_one(&found);
    assert_eq!((name, &place[..]), ("sensor_scale", "station 450.0 mm"));
    assert!(words.starts_with("The sensors at 450.0 mm read") && words.ends_with("% too low"), "{words}");
    let excess = found.diagnosis.findings[0].quantity("excess_percent").unwrap();
    assert!(excess.low < -5.0 && -5.0 < excess.high && excess.high < -4.0, "{excess:?}");
    let found =
        read(3, |station, time, bent| if station == 350.0 { bent + 20.0 * time / 1800.0 } else { bent });
    let (name, place, words) = of_one(&found);
    assert_eq!((name, &place[..]), ("thermal_drift", "sensors, at 350.0 mm"));
    assert!(
        words.starts_with("The sensors drift by dy ") && words.ends_with("µm per hour at 350.0 mm"),
        "{words}"
    );
}
