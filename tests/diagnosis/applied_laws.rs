//! A law that was proposed, written into the rod file, and read again.

use rodcal::rig;
use rodcal::rig::readings::{Axis, Readings};
use rodcal::rod::{LawMemory, Rod, RodLawPlace};
use rodcal::units::UM;
use rodcal_trial::rig::{CaseSpec, Effect, SimulatedCase};
use serde_json::Value;

use super::Answer;
use super::laws::{Row, spec, written};

/// Diagnosed, applied, and diagnosed again: rod file and readings as `--apply` writes them.
fn applied(rod: &str, readings: &str) -> (Answer, Answer, Rod) {
    let before = Answer::of(Some(rod), readings);
    assert_eq!(before.json["law"]["proposed"], true, "{}", before.json["headline"]);
    let correction = before.found.correction().unwrap().unwrap();
    let again = Rod::from_toml("rod.toml", &correction.rod_toml).unwrap();
    assert_eq!(again.to_toml(&[]), correction.rod.to_toml(&[]), "read as it was written");
    let after = Answer::of(Some(&correction.rod_toml), &correction.readings_csv);
    (before, after, again)
}

fn assert_settled(before: &Answer, after: &Answer, noise_um: f64) {
    let rms = |answer: &Answer| answer.json["rms_before_um"].as_f64().unwrap();
    assert!(after.is_consistent(), "{}", after.json["headline"]);
    assert!(after.json["law"].is_null(), "{}", after.json["law"]);
    assert!(rms(after) < 1.6 * noise_um && rms(after) < 0.5 * rms(before), "{} {}", rms(before), rms(after));
}

/// Of the load: C is what the rod has besides, and `rig fit` finds it in what is left.
#[test]
fn a_gap_that_closes_is_written_and_read() {
    let SimulatedCase { rod, readings, .. } =
        spec().simulated(&[Effect::GapCloses { load: 5.6, share: 0.7 }], 31);
    let (before, after, again) = applied(&rod, &readings);
    assert_settled(&before, &after, 1.0);
    let [law] = &again.laws[..] else { panic!("{:?}", again.laws) };
    assert_eq!((&law.place, law.unit()), (&RodLawPlace::Rod, "N"));
    assert!(law.at(4.0, 1.0) == 0.0 && (law.at(10.0, 1.0) + 0.3 * 4.4).abs() < 0.1, "{law}");
    let fit = |rod: &Rod| {
        let readings = Readings::from_text("f", &readings).unwrap();
        rig::fit(&readings, Some(rod), &rig::Options::default()).unwrap()
    };
    let mut without = again.clone();
    without.laws.clear();
    let (linear, bent) = (fit(&again), fit(&without));
    assert!(linear.warnings[0].to_string().contains("taken out of the readings"));
    let off = |fit: &rig::Fit| (fit.measured.as_ref().unwrap().rod_ratio.value - 1.0).abs();
    assert!(off(&linear) < 0.01 && off(&bent) > 0.05, "{} {}", off(&linear), off(&bent));
}

/// Of a sensor: it stays the rig's.
#[test]
fn the_ripple_of_a_sensor_is_written_and_read() {
    let ripple = Effect::Ripple { channel: 1, amplitude: 12.0 * UM, period: 130.0 * UM, phase: 0.4 };
    let SimulatedCase { rod, readings, .. } = spec().simulated(&[ripple], 32);
    let (before, after, again) = applied(&rod, &readings);
    assert_settled(&before, &after, 1.0);
    assert_eq!(again.laws[0].place, RodLawPlace::Sensor(Axis::Y));
    assert!(again.warnings.iter().any(|warning| warning.to_string().contains("the rig's")));
}

/// Of something that gives way.
#[test]
fn a_stop_is_written_and_read() {
    let (rod, readings) = written(&spec(), 33, |row| 25.0 * (row.load / 4.0).min(1.0));
    let (before, after, _) = applied(&rod, &readings);
    assert_settled(&before, &after, 1.0);
}

/// Up to 10 N and back, in steps of half a newton.
fn there_and_back() -> CaseSpec {
    CaseSpec { loads: (1..=20).map(|k| 0.5 * f64::from(k)).collect(), unloading: true, ..spec() }
}

/// Where a play of half width r is on that way, N.
fn play(row: &Row, half: f64) -> f64 {
    if row.side > 0.0 { (row.load - half).max(0.0) } else { (row.load + half).min(10.0 - half) }
}

/// A clamp that slips at two loads, as (Prandtl and Ishlinskii) stops of 1.5 and 4 N side by side.
#[test]
fn a_clamp_that_slips_at_two_loads_is_written_and_read() {
    let stop = |row: &Row, half: f64| row.load - play(row, half);
    let (rod, readings) = written(&there_and_back(), 34, |row| 9.0 * stop(row, 1.5) + 6.0 * stop(row, 4.0));
    let (before, after, again) = applied(&rod, &readings);
    // zeros of the runs, and five numbers of a law that is up to 100 µm
    assert_settled(&before, &after, 1.2);
    let law = &before.json["law"];
    assert_eq!((&law["memory"], &law["second"]), (&"two stop operators".into(), &Value::Null), "{law}");
    assert_eq!(again.laws[0].memory, Some(LawMemory::TwoStops));
    for (symbol, truth) in [("r1", 1.5), ("r", 4.0), ("w1", 0.6), ("c1", 15.0)] {
        let all = law["constants"].as_array().unwrap();
        let own = all.iter().find(|own| own["symbol"] == symbol).unwrap();
        let [low, high] = ["lo", "hi"].map(|key| own[key].as_f64().unwrap());
        // at the clamp, or at the root, where it is the moment's
        if law["location"] == "clamp" || symbol == "w1" {
            assert!(0.97 * low < truth && truth < 1.03 * high, "{symbol}: {own}");
        }
    }
}

/// A clamp with a clearance in which it stays where it was left.
#[test]
fn a_play_is_written_and_read() {
    let (rod, readings) = written(&there_and_back(), 35, |row| 8.0 * play(row, 2.0));
    let (before, after, again) = applied(&rod, &readings);
    assert_settled(&before, &after, 1.0);
    assert_eq!(before.json["law"]["memory"], "play operator", "{}", before.json["law"]);
    assert_eq!(again.laws[0].memory, Some(LawMemory::Play));
}

/// Channel of the ripple, or the load: which of two laws one is.
fn kind(law: &Value) -> &str {
    match (law["location"].as_str(), law["variable"]["name"].as_str()) {
        (Some("dy"), Some("reading")) => "ripple",
        (Some("rod" | "clamp" | "root"), Some("load" | "moment")) => "load",
        (None, _) => "none",
        _ => "another",
    }
}

/// A gap that closes and the ripple of a sensor at once: both are proposed, and neither is a third
/// thing. Written, they leave nothing.
#[test]
fn two_laws_are_proposed_together() {
    let ripple = Effect::Ripple { channel: 1, amplitude: 12.0 * UM, period: 130.0 * UM, phase: 0.4 };
    let spec = CaseSpec { loads: (1..=20).map(|k| 0.5 * f64::from(k)).collect(), ..spec() };
    let mut found = Vec::new();
    for seed in 31..34 {
        let SimulatedCase { rod, readings, .. } =
            spec.simulated(&[Effect::GapCloses { load: 5.6, share: 0.7 }, ripple.clone()], seed);
        let before = Answer::of(Some(&rod), &readings);
        let (law, second) = (&before.json["law"], &before.json["law"]["second"]);
        found.push((kind(law).to_owned(), kind(second).to_owned()));
        if second.is_null() {
            continue;
        }
        let errors = ["heldout_without_um", "heldout_with_um"].map(|key| second[key].as_f64().unwrap());
        assert!(errors[1] < 0.95 * errors[0], "{second}");
        let [low, high] = if kind(second) == "ripple" {
            let all = second["constants"].as_array().unwrap();
            let period = all.iter().find(|own| own["symbol"] == "P").unwrap();
            ["lo", "hi"].map(|key| period[key].as_f64().unwrap())
        } else {
            [130.0; 2]
        };
        assert!(0.97 * low < 130.0 && 130.0 < 1.03 * high, "{second}");
        let correction = before.found.correction().unwrap().unwrap();
        assert_eq!(correction.rod.laws.len(), 2);
        let after = Answer::of(Some(&correction.rod_toml), &correction.readings_csv);
        assert_settled(&before, &after, 1.0);
    }
    let is_right =
        |(a, b): &&(String, String)| (a == "load" && b == "ripple") || (a == "ripple" && b == "load");
    assert!(found.iter().filter(is_right).count() >= 3, "{found:?}");
}
