//! Physics that the library does not have gets none of its names.

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
