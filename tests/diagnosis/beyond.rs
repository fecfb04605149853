//! Physics that the library does not have gets none of its names.

use rodcal::answer::{self, ComplianceOptions};
use rodcal::report::{self, html};
use rodcal::rod::Rod;
use rodcal::statistics::Random;
use rodcal::units::UM;
use rodcal_trial::rig::{CaseSpec, Effect};

use super::Answer;

fn assert_unknown(spec: &CaseSpec, effect: Effect) {
    let name = effect.name();
    let answer = Answer::simulated(spec, &[effect], 21);
    assert_eq!(answer.effects(), [""; 0], "{name}: {}", answer.json["headline"]);
    let unexplained = &answer.json["unexplained"];
    assert!(
        unexplained["location"].is_string() && unexplained["rms_um"].is_f64(),
        "{name}: {}",
        answer.json["headline"]
    );
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

/// Three trials of eight loads along z read every 20 s; from 250 s on all sensors are off by what
/// decays within 60 s.
#[test]
fn what_sets_in_suddenly_and_decays() {
    let rod = include_str!("../../rods/5.toml");
    let known = Rod::from_toml("5.toml", rod).unwrap();
    let compliance = answer::compliance(known, &ComplianceOptions::default()).unwrap().json;
    let entry = |axis: usize| compliance["cf_um_per_n"][axis][2].as_f64().unwrap();
    let mut random = Random::seeded(3, 5);
    let mut text = "trial,axis,load_n,time_s,dx_um,dy_um,dz_um\n".to_owned();
    for k in 0..24 {
        let (trial, load, time) = (1 + k / 8, 1.5 * f64::from(1 + k % 8), 20.0 * f64::from(k));
        let share = if time < 250.0 { 0.0 } else { (-(time - 250.0) / 60.0).exp() };
        let [x, y, z] = [(0, 40.0), (1, -30.0), (2, 25.0)]
            .map(|(axis, um)| entry(axis) * load + um * share + random.normal());
        text += &format!("{trial},z,{load},{time},{x:.2},{y:.2},{z:.2}\n");
    }
    let answer = Answer::of(Some(rod), &text);
    let headline = answer.json["headline"].as_str().unwrap();
    assert_eq!(answer.effects(), [""; 0], "{headline}");
    // the first reading from then on stands in row 14
    assert!(headline.starts_with("An unexplained error sets in suddenly at row 14 and decays"), "{headline}");
    // drawn along what it follows
    let report = report::diagnosis::rig::report(&answer.found, None);
    assert!(html::page(&report).contains("time / s"), "{headline}");
}
