//! Physics that the library does not have gets none of its names.

use rodcal::answer::{self, ComplianceOptions};
use rodcal::report::{self, html};
use rodcal::rod::Rod;
use rodcal::statistics::Random;
use rodcal::units::UM;
use rodcal_trial::rig::{CaseSpec, Effect};

use super::Answer;

/// The headline.
fn assert_unknown(spec: &CaseSpec, effect: Effect) -> String {
    let name = effect.name();
    let answer = Answer::simulated(spec, &[effect], 21);
    assert_eq!(answer.effects(), [""; 0], "{name}: {}", answer.json["headline"]);
    let unexplained = &answer.json["unexplained"];
    assert!(
        unexplained["location"].is_string() && unexplained["rms_um"].is_f64(),
        "{name}: {}",
        answer.json["headline"]
    );
    answer.json["headline"].to_string()
}

/// Eight loads, so that a kink is no parabola.
fn spec() -> CaseSpec {
    CaseSpec { loads: (1..=8).map(|k| 1.25 * f64::from(k)).collect(), trials: 2, ..CaseSpec::default() }
}

#[test]
fn a_gap_that_closes() {
    assert_unknown(&spec(), Effect::GapCloses { load: 5.6, share: 0.7 });
}

#[test]
fn the_ripple_of_a_sensor() {
    assert_unknown(
        &spec(),
        Effect::Ripple { channel: 1, amplitude: 12.0 * UM, period: 130.0 * UM, phase: 0.4 },
    );
}

#[test]
fn a_sensor_at_its_limit() {
    assert_unknown(&spec(), Effect::Saturation { channel: 1, limit: 600.0 * UM });
}

#[test]
fn a_clamp_that_is_loose_one_way() {
    assert_unknown(&CaseSpec { both_ways: true, ..spec() }, Effect::LooseClamp(0.1));
}

/// Friction alone would be named otherwise, and so would its changes as slips, or as one of
/// several places.
#[test]
fn friction_that_wears_is_not_plain_friction() {
    let spec = CaseSpec { unloading: true, trials: 4, ..CaseSpec::default() };
    let answer = assert_unknown(&spec, Effect::WearingFriction { first: 0.1, last: 0.7 });
    assert!(answer.contains("acts like friction that changes from run to run"), "{answer}");
}

#[test]
fn friction_that_does_not_wear_is_friction() {
    let spec = CaseSpec { unloading: true, trials: 4, ..CaseSpec::default() };
    let answer = Answer::simulated(&spec, &[Effect::WearingFriction { first: 0.4, last: 0.4 }], 21);
    assert_eq!(answer.effects(), ["friction"], "{}", answer.json["headline"]);
}

/// Each load always comes after the same one on the way up, and after another one on the way down.
#[test]
fn a_load_that_stiffens_the_next_one_is_no_nonlinear_stiffness() {
    let spec = CaseSpec { unloading: true, trials: 2, ..CaseSpec::default() };
    let answer = assert_unknown(&spec, Effect::LoadBefore(-0.1));
    assert!(answer.contains("follows the load that hung before"), "{answer}");
}

/// Up and down along z, hung every 5 to 80 s; the first of each trial as usual. Only upwards creep
/// would explain it as well.
#[test]
fn a_rod_that_gives_way_less_the_faster_it_is_loaded() {
    let loads: Vec<f64> = (1..=8).chain((1..8).rev()).map(f64::from).collect();
    let (mut time, mut before) = (0.0, 0.0);
    let (rod, text) = along_z(&loads, |k, load| {
        let is_first = k % loads.len() == 0;
        let took = if is_first { 10.0 } else { [5.0, 10.0, 80.0, 20.0, 10.0, 40.0, 5.0][k % 7] };
        let speed = (load - if is_first { 0.0 } else { before }) / took;
        (time, before) = (time + took, load);
        (time, load * (1.0 - 0.04 * speed.signum() * (1.0 + speed.abs() / 0.005f64).log10()), 0.0)
    });
    let answer = Answer::of(Some(rod), &text);
    let headline = answer.json["headline"].as_str().unwrap();
    assert_eq!(answer.effects(), [""; 0], "{headline}");
    assert!(headline.contains("follows the speed at which the load was changed"), "{headline}");
    let law = &answer.json["law"];
    assert_eq!(law["variable"]["name"], "speed of loading", "{}", law["refused"]);
    // of a speed of either sign
    assert_eq!(law["expression"]["text"], "Δu/u = a·sgn(v)·ln(1 + |v|/v_0)");
}

/// Loads along x, y and z one after another: what fades meanwhile shows less of the last ones, as a
/// sensor that is turned would.
#[test]
fn a_display_that_fades_is_no_turned_sensor() {
    let rod = include_str!("../../rods/4.toml");
    let known = Rod::from_toml("4.toml", rod).unwrap();
    let compliance = answer::compliance(known, &ComplianceOptions::default()).unwrap().json;
    let entry = |channel: usize, axis: usize| compliance["cf_um_per_n"][channel][axis].as_f64().unwrap();
    let mut random = Random::seeded(3, 6);
    let mut text = "trial,axis,load_n,time_s,dx_um,dy_um,dz_um\n".to_owned();
    let loads: Vec<f64> = (1..=7).chain((1..7).rev()).map(|k| 1.4 * f64::from(k)).collect();
    let rows = 3 * 5 * loads.len();
    for k in 0..rows {
        let (axis, trial) = (k / (5 * loads.len()), k / loads.len() % 5 + 1);
        let (load, share) = (loads[k % loads.len()], k as f64 / rows as f64);
        let gain = [1.0 - 0.5 * share * share, 1.0, 1.0];
        let read = [0, 1, 2].map(|channel| gain[channel] * entry(channel, axis) * load + random.normal());
        let (time, [x, y, z]) = (120 * k, read);
        text += &format!("{trial},{},{load},{time},{x:.2},{y:.2},{z:.2}\n", ["x", "y", "z"][axis]);
    }
    let answer = Answer::of(Some(rod), &text);
    let headline = answer.json["headline"].as_str().unwrap();
    assert_eq!(answer.effects(), [""; 0], "{headline}");
    assert!(headline.contains("gain of dx"), "{headline}");
}

/// A rod, and its readings under three trials of these loads along z, N. `at`: the time, s, the
/// load that it carries, N, and a share of what all sensors are off by, of each number and load.
fn along_z(loads: &[f64], mut at: impl FnMut(usize, f64) -> (f64, f64, f64)) -> (&'static str, String) {
    let rod = include_str!("../../rods/5.toml");
    let known = Rod::from_toml("5.toml", rod).unwrap();
    let compliance = answer::compliance(known, &ComplianceOptions::default()).unwrap().json;
    let entry = |axis: usize| compliance["cf_um_per_n"][axis][2].as_f64().unwrap();
    let mut random = Random::seeded(3, 5);
    let mut text = "trial,axis,load_n,time_s,dx_um,dy_um,dz_um\n".to_owned();
    for k in 0..3 * loads.len() {
        let (trial, load) = (1 + k / loads.len(), loads[k % loads.len()]);
        let (time, carried, share) = at(k, load);
        let [x, y, z] = [(0, 40.0), (1, -30.0), (2, 25.0)]
            .map(|(axis, um)| entry(axis) * carried + um * share + random.normal());
        text += &format!("{trial},z,{load},{time},{x:.2},{y:.2},{z:.2}\n");
    }
    (rod, text)
}

/// Three trials of eight loads along z read every 20 s; from 250 s on all sensors are off by what
/// decays within 60 s.
#[test]
fn what_sets_in_suddenly_and_decays() {
    let loads: Vec<f64> = (1..=8).map(|k| 1.5 * f64::from(k)).collect();
    let (rod, text) = along_z(&loads, |k, load| {
        let time = 20.0 * k as f64;
        (time, load, if time < 250.0 { 0.0 } else { (-(time - 250.0) / 60.0).exp() })
    });
    let answer = Answer::of(Some(rod), &text);
    let headline = answer.json["headline"].as_str().unwrap();
    assert_eq!(answer.effects(), [""; 0], "{headline}");
    // the first reading from then on stands in row 14
    assert!(headline.starts_with("An unexplained error sets in suddenly at row 14 and decays"), "{headline}");
    // drawn along what it follows
    let report = report::diagnosis::rig::report(&answer.found, None);
    assert!(html::page(&report).contains("time / s"), "{headline}");
}
