//! Points of loads and sensors, lengths and the angle that are not those of the files.

use nalgebra::{Matrix3, Vector3};

use super::*;
use crate::diagnosis::rig::diagnose;
use crate::diagnosis::rig::mechanics::structure::{Point, between};
use crate::inference::{Diagnosis, Finding, WrittenTo};
use crate::rod::NominalNumber;
use crate::statistics::Random;
use crate::units::{DEG, MM};

/// What a rig would show that loads and reads points of a rod: `columns` are those of the file,
/// `read` the displacement per force of each of its lines, m/N.
fn recorded(lines: &[(&str, Matrix3<f64>)], columns: &str) -> Readings {
    let mut random = Random::seeded(11, 0);
    let mut text = format!("trial,axis,load_n{columns},dx_um,dy_um,dz_um\n");
    for (trial, axis) in (1..5).flat_map(|trial| (0..3).map(move |axis| (trial, axis))) {
        for load in [5.0, 10.0, 15.0, 20.0] {
            for (stations, read) in lines {
                let [x, y, z] = [0, 1, 2].map(|channel| read[(channel, axis)] / UM * load + random.normal());
                text += &format!("{trial},{},{load}{stations},{x:.1},{y:.1},{z:.1}\n", ["x", "y", "z"][axis]);
            }
        }
    }
    readings(&text)
}

fn at(station: f64, arm: [f64; 3]) -> Point {
    Point { station, arm: Vector3::from(arm) }
}

fn seen(rod: &Rod, load: Point, read: Point) -> Matrix3<f64> {
    between(rod, &[[load, read]]).unwrap()[0]
}

/// A finding of this effect at this place leads, or it is a rival of what does.
fn assert_said(found: &Diagnosis, effect: &str, place: &str) {
    let is_it = |own: &str, location: String| own == effect && location == place;
    let is_said = found.findings.iter().any(|finding| {
        is_it(finding.effect.name, finding.location.to_string())
            || finding.rivals.iter().any(|rival| is_it(rival.effect.name, rival.location.to_string()))
    });
    assert!(is_said, "{effect} at {place}: {:#?}", found.findings);
}

fn only(found: &Diagnosis) -> &Finding {
    assert_eq!(found.findings.len(), 1, "{:#?}", found.findings);
    &found.findings[0]
}

fn assert_within(finding: &Finding, number: &str, expected: f64) {
    let own = finding.quantity(number).unwrap();
    assert!(own.low < expected && expected < own.high, "{number} {expected}: {own:?}");
}

/// Loads that hang before the tip, or beside it, where the file says nothing: the point is found,
/// and what is not there stays near nothing.
#[test]
fn loads_that_hang_elsewhere_are_found_and_are_no_softer_rod() {
    let rod = rod("");
    let tip = at(rod.length(), [0.0; 3]);
    let before = seen(&rod, at(rod.length() - 60.0 * MM, [0.0; 3]), tip);
    let found = diagnose(&recorded(&[("", before)], ""), Some(&rod)).unwrap();
    let finding = only(&found.diagnosis);
    assert_eq!(
        (finding.effect.name, finding.location.to_string().as_str()),
        ("load_point", "load point, along the rod")
    );
    assert_within(finding, "along_mm", -60.0);
    assert!(finding.description.observed.contains("towards the flange"), "{:?}", finding.description);
    assert_eq!(finding.written_to, WrittenTo::Recording);
    // what is written has the digits of a nanometre, not those of a division
    let corrected = found.correction().unwrap().unwrap().readings_csv;
    let cells = corrected.lines().filter(|line| !line.starts_with('#')).flat_map(|line| line.split(','));
    let decimals = cells.filter_map(|cell| cell.split_once('.')).map(|(_, decimals)| decimals.len());
    assert!(decimals.max().is_some_and(|most| most <= 3), "{corrected}");

    let beside = seen(&rod, at(rod.length(), [0.0, 15.0 * MM, 0.0]), tip);
    let found = diagnose(&recorded(&[("", beside)], ""), Some(&rod)).unwrap();
    assert_said(&found.diagnosis, "load_point", "load point, along y");
}

/// One of three stations of a sensor that is written 20 mm off: it is named, and not the unit of a
/// number of the rod.
#[test]
fn a_station_that_is_off_is_found_among_others() {
    let rod = rod("");
    let tip = at(rod.length(), [0.0; 3]);
    let lines: Vec<(String, Matrix3<f64>)> =
        [(120.0, 120.0), (420.0, 400.0), (1e3 * rod.length(), 1e3 * rod.length())]
            .map(|(stated, actual)| (format!(",{stated}"), seen(&rod, tip, at(actual * MM, [0.0; 3]))))
            .into();
    let lines: Vec<(&str, Matrix3<f64>)> = lines.iter().map(|(text, seen)| (text.as_str(), *seen)).collect();
    let found = diagnose(&recorded(&lines, ",read_station_mm"), Some(&rod)).unwrap();
    let finding = only(&found.diagnosis);
    let named = (finding.effect.name, finding.location.to_string());
    assert_eq!(named, ("sensor_point", "station 420.0 mm".into()));
    assert_within(finding, "along_mm", -20.0);
}

/// Lengths and the angle: named, or the rival of what these readings cannot tell from them, and
/// written into the rod's file.
#[test]
fn a_length_or_an_angle_that_differs_is_found_and_written_back() {
    let file = rod("");
    for (number, actual, place, key) in [
        (NominalNumber::LengthL1, file.l1 - 20.0 * MM, "length l1", "length_mm"),
        (NominalNumber::LengthL2, file.l2 - 40.0 * MM, "length l2", "length_mm"),
        (NominalNumber::Angle, file.gamma + 2.0 * DEG, "angle γ", "gamma_deg"),
    ] {
        let actual_rod = file.with(&number, actual);
        let tip = at(actual_rod.length(), [0.0; 3]);
        let found = diagnose(&recorded(&[("", seen(&actual_rod, tip, tip))], ""), Some(&file)).unwrap();
        assert_said(&found.diagnosis, "rod_dimension", place);
        let finding = &found.diagnosis.findings[0];
        if finding.effect.name == "rod_dimension" {
            let unit = if key == "gamma_deg" { DEG } else { MM };
            assert_within(finding, key, actual / unit);
            // with what other numbers share of it
            let corrected = found.correction().unwrap().unwrap().rod;
            let moved = own_of(&corrected, place) - own_of(&file, place);
            let expected = finding.estimates[0].value - own_of(&file, place);
            assert!((moved / expected - 1.0).abs() < 0.1, "{place}: {moved} {expected}");
        }
    }
}

fn own_of(rod: &Rod, place: &str) -> f64 {
    match place {
        "length l1" => rod.l1,
        "length l2" => rod.l2,
        _ => rod.gamma,
    }
}

/// The point of loads whose station nobody stated is known to the uncertainty of lengths, and a
/// point at the tip, beyond which there is no rod, as well as any other.
#[test]
fn the_load_point_is_a_number_that_is_known_to_so_much() {
    let rod = rod("");
    let (model, evidence) = RigModel::new(&readings(UP_AND_DOWN), Some(&rod)).unwrap();
    let column = |evidence: &crate::inference::Evidence, name: &str| {
        let k = evidence.nominal_numbers.iter().position(|number| number.name == name).unwrap();
        evidence.nominal.column(k).into_owned()
    };
    let u = rod.standard_uncertainty.length;
    let tip = at(rod.length(), [0.0; 3]);
    let before = at(rod.length() - u, [0.0; 3]);
    let assert_is = |column: &DVector<f64>, moved: Matrix3<f64>| {
        for (datum, value) in model.data().iter().zip(column.iter()) {
            let expected = (seen(&rod, tip, tip) - moved)[(datum.channel.index(), 1)] * -datum.load;
            assert!((value - expected).abs() < 1e-12, "{value} {expected}");
        }
    };
    assert_is(&column(&evidence, "load point"), seen(&rod, before, tip));
    let stated = UP_AND_DOWN.replace("phase,", "phase,load_station_mm,").replace("load,0", "load,675,0");
    let (_, evidence) = RigModel::new(&readings(&stated), Some(&rod)).unwrap();
    assert_is(&column(&evidence, "station 675.0 mm"), seen(&rod, before, before));
    assert!(evidence.nominal_numbers.iter().all(|number| number.name != "load point"));
}

/// What cannot be another one is not tried: the angle of pipes in one line, the length of a pipe
/// that its bend takes up. Close to that the range ends there.
#[test]
fn a_dimension_has_the_range_that_a_rod_leaves_it() {
    let range = |rod: &Rod, place: &str| {
        let model = model(UP_AND_DOWN, rod);
        let candidates = model.candidates();
        let is_it = |c: &&Candidate| c.effect.name == "rod_dimension" && c.location.to_string() == place;
        candidates.iter().find(is_it).map(|own| own.parameters[0].bounds)
    };
    let with_angle = |degrees: &str| {
        let text = ROD.replace("gamma_deg = 90.0", &format!("gamma_deg = {degrees}"));
        assert!(text.contains(degrees));
        Rod::from_toml("rod", &text).unwrap()
    };
    assert_eq!(range(&with_angle("180.0"), "angle γ"), None);
    let (low, high) = range(&with_angle("172.0"), "angle γ").unwrap();
    assert!((low / DEG - 164.0).abs() < 1e-9 && (high / DEG - 180.0).abs() < 1e-9, "{low} {high}");
    let bent = ROD.replace("bend_radius_mm = 0.0 ", "bend_radius_mm = 149.9\n");
    let bent = Rod::from_toml("rod", &bent).unwrap();
    assert!(range(&bent, "length l1").is_none() && range(&bent, "length l2").is_some());
}
