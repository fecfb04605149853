//! The beam model against references that share no code with it: 18 rods, two theories, tip and
//! stations, from the unit-load integral in 40-digit arithmetic (`tests/references/README.md` says
//! how they were made and which other solvers agree with them).

#![allow(clippy::unwrap_used)]

use nalgebra::Matrix3;
use rodcal::beam::{Physics, RodModel};
use rodcal::compliance::Compliance;
use rodcal::rod::Rod;
use serde::Deserialize;

/// Relative to the largest entry; the references are rounded to the nearest double.
const ROUNDING: f64 = 1e-11;

#[derive(Deserialize)]
struct References {
    cases: Vec<Case>,
}

#[derive(Deserialize)]
struct Case {
    name: String,
    rod_toml: String,
    tip_mm: [f64; 3],
    tip_station_mm: f64,
    mass_g: f64,
    results: Vec<Reference>,
}

#[derive(Deserialize)]
struct Reference {
    theory: String,
    cf_um_per_n: [[f64; 3]; 3],
    cg_um_per_g: [[f64; 3]; 3],
    c_rod_um: f64,
    #[serde(default)]
    stations: Vec<Stations>,
}

#[derive(Deserialize)]
struct Stations {
    load_station_mm: f64,
    read_station_mm: f64,
    displacement_um_per_n: [[f64; 3]; 3],
    rotation_urad_per_n: [[f64; 3]; 3],
}

fn references() -> References {
    serde_json::from_str(include_str!("references/beam_references.json")).unwrap()
}

fn matrix(rows: &[[f64; 3]; 3]) -> Matrix3<f64> {
    Matrix3::from_fn(|m, n| rows[m][n])
}

fn assert_close(what: &str, ours: Matrix3<f64>, reference: &[[f64; 3]; 3]) {
    let reference = matrix(reference);
    let error = (ours * 1e6 - reference).amax() / reference.amax();
    assert!(error <= ROUNDING, "{what}: off by {error:.1e}\n{}{reference}", ours * 1e6);
}

fn for_each_reference(check: impl Fn(&str, &Rod, &Physics, &Reference)) {
    let references = references();
    assert_eq!(references.cases.len(), 18);
    for case in &references.cases {
        let rod = Rod::from_toml(&case.name, &case.rod_toml).unwrap();
        assert_eq!(case.results.len(), 2);
        for reference in &case.results {
            let shear = reference.theory == "timoshenko";
            let name = format!("{}, {}", case.name, reference.theory);
            check(&name, &rod, &Physics::default().with_shear(shear), reference);
        }
    }
}

#[test]
fn geometry_and_mass() {
    for case in references().cases {
        let rod = Rod::from_toml(&case.name, &case.rod_toml).unwrap();
        let tip = rod.tip() * 1e3;
        for (ours, reference) in tip.iter().zip(case.tip_mm) {
            assert!((ours - reference).abs() < 1e-9, "{}: tip at {tip}", case.name);
        }
        assert!((rod.length() * 1e3 - case.tip_station_mm).abs() < 1e-9, "{}", case.name);
        assert!((rod.mass() * 1e3 - case.mass_g).abs() < 1e-9 * case.mass_g, "{}", case.name);
    }
}

#[test]
fn compliance_of_the_tip() {
    let force = (1.10f64 * 1.10 + 1.25 * 1.25 + 1.05 * 1.05).sqrt();
    for_each_reference(|name, rod, physics, reference| {
        for elements in [1, 50] {
            let ours = Compliance::of_model(rod, physics, elements).unwrap();
            assert_close(&format!("{name}, C^F"), ours.force, &reference.cf_um_per_n);
            assert_close(&format!("{name}, C^g"), ours.gravity, &reference.cg_um_per_g);
            let index = ours.index(force) * 1e6;
            assert!((index / reference.c_rod_um - 1.0).abs() < ROUNDING, "{name}: c_rod {index}");
        }
    });
}

#[test]
fn response_between_stations() {
    for_each_reference(|name, rod, physics, reference| {
        for stations in &reference.stations {
            let (load, read) = (stations.load_station_mm * 1e-3, stations.read_station_mm * 1e-3);
            let model = RodModel::new(rod, physics, 30, &[load, read]).unwrap();
            let motion = model.force_response(load, read).unwrap();
            let what = format!("{name}, load at {load}, read at {read}");
            assert_close(&what, motion.translation, &stations.displacement_um_per_n);
            assert_close(&what, motion.rotation, &stations.rotation_urad_per_n);
        }
    });
}

/// What displacement elements extrapolate to, and what is left of this program's 60 elements in the
/// fourth mode, which twists.
const EXTRAPOLATED: f64 = 3e-7;
const OF_SIXTY: f64 = 6e-6;

#[derive(Deserialize)]
struct Swinging {
    name: String,
    rod_toml: String,
    first_frequencies_hz: Vec<f64>,
}

/// `tests/references/natural_frequencies.py`: Timoshenko elements of twelve freedoms (Przemieniecki
/// 1968; Friedman and Kosmatka 1993), which know stiffnesses, not flexibilities.
#[test]
fn rods_swing_as_displacement_elements_do() {
    let cases: Vec<Swinging> =
        serde_json::from_str(include_str!("references/natural_frequencies.json")).unwrap();
    assert_eq!(cases.len(), 2);
    for case in cases {
        let rod = Rod::from_toml("rod.toml", &case.rod_toml).unwrap();
        let fine = RodModel::new(&rod, &Physics::WHOLE, 800, &[]).unwrap().chain;
        let count = case.first_frequencies_hz.len();
        for (modes, allowed) in [
            (rod.natural_modes(count).unwrap(), OF_SIXTY),
            (fine.natural_modes(count).unwrap(), EXTRAPOLATED),
        ] {
            assert_eq!(modes.len(), count);
            for (mode, reference) in modes.iter().zip(&case.first_frequencies_hz) {
                let error = (mode.frequency / reference - 1.0).abs();
                assert!(error <= allowed, "{}: {} Hz, {reference} Hz", case.name, mode.frequency);
            }
        }
    }
}
