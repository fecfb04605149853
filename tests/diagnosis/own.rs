//! Effects that a lab describes itself: the three of docs/laws.md, each concealed in a recording.

use rodcal::diagnosis::rig::{OwnEffect, diagnose_with};
use rodcal::report;
use rodcal::rig::readings::Readings;
use rodcal::rod::Rod;
use rodcal_trial::rig::CaseSpec;
use serde_json::Value;

use super::interval;
use super::laws::{Row, spec, written};

/// The example of this number.
fn example(number: usize) -> String {
    let page = include_str!("../../docs/laws.md");
    let blocks = page.split("```toml\n").skip(1).map(|block| block.split("```").next().unwrap());
    blocks.map(str::to_owned).nth(number).unwrap()
}

/// The JSON of a recording with the effects of a file.
fn answer(text: &str, spec: &CaseSpec, along: impl Fn(&Row) -> f64) -> Value {
    let own = OwnEffect::from_toml("mine.toml", text).unwrap();
    let (rod, readings) = written(spec, 51, along);
    let rod = Rod::from_toml("rod.toml", &rod).unwrap();
    let readings = Readings::from_text("readings.csv", &readings).unwrap();
    let found = diagnose_with(&readings, Some(&rod), &[], &own).unwrap();
    report::diagnosis::rig::json(&found, None)
}

fn finding<'a>(answer: &'a Value, name: &str) -> &'a Value {
    let findings = answer["findings"].as_array().unwrap();
    let own = findings.iter().find(|finding| finding["effect"] == name);
    own.unwrap_or_else(|| panic!("no {name}: {}", answer["headline"]))
}

/// The interval of a parameter holds a value, and is not much wider than a quarter of it either
/// way.
fn assert_near(finding: &Value, name: &str, truth: f64) {
    let [low, value, high] = interval(finding, name);
    assert!((value - truth).abs() < 0.15 * truth.abs(), "{name}: {value}");
    assert!(low < truth && truth < high, "{name}: {low} to {high}");
    assert!(high - low < 0.6 * truth.abs(), "{name}: {low} to {high}");
}

#[test]
fn a_rubber_foot() {
    let answer = answer(&example(0), &spec(), |row| 40.0 * (1.0 - (-row.load / 3.0).exp()));
    let foot = finding(&answer, "rubber_foot");
    assert_near(foot, "a_um", 40.0);
    assert_near(foot, "b_n", 3.0);
    assert!(foot["words"].as_str().unwrap().starts_with("A rubber foot under the clamp (clamp): a_um = "));
    assert!(answer["heldout_gain"].as_f64().unwrap() > 0.8);
}

#[test]
fn a_scale_with_a_known_pitch() {
    let pitch = |row: &Row| match row.axis.as_str() {
        "y" => 9.0 * (std::f64::consts::TAU * row.predicted / 130.0).sin(),
        _ => 0.0,
    };
    let answer = answer(&example(1), &spec(), pitch);
    assert_near(finding(&answer, "pitch_of_the_scale"), "a_um", 9.0);
}

#[test]
fn friction_that_falls() {
    let spec = CaseSpec { unloading: true, axes: vec![1], ..spec() };
    let json = answer(&example(2), &spec, |row| {
        row.predicted / row.load * row.side * -1.5 * (-row.load / 3.0).exp()
    });
    let stribeck = finding(&json, "stribeck");
    assert_near(stribeck, "f_n", 1.5);
    assert_near(stribeck, "s_n", 3.0);
}

#[test]
fn an_effect_that_is_not_there_is_not_named() {
    let json = answer(&example(0), &spec(), |_| 0.0);
    assert_eq!(json["findings"].as_array().unwrap().len(), 0, "{}", json["headline"]);
    assert_eq!(json["verdict"], "consistent");
}

#[test]
fn errors_name_line_and_column() {
    let text = example(0);
    let refused = |text: &str| OwnEffect::from_toml("mine.toml", text).unwrap_err().to_string();
    let changed = |from: &str, to: &str| {
        assert!(text.contains(from), "{from}");
        refused(&text.replace(from, to))
    };
    for (from, to, expected) in [
        ("F/b_n", "F/c", "mine.toml:6:25: \"c\" in the formula, expected one of F, side, a_um, b_n"),
        ("F/b_n))", "F/b_n)", "mine.toml:6:29: the end in the formula, expected \")\""),
        (
            "\"rubber_foot\"",
            "\"friction\"",
            "mine.toml:2:8: `name` is \"friction\", expected a name that no effect",
        ),
        ("\"load\"", "\"lod\"", "mine.toml:5:12: `variable` is \"lod\", expected one of load,"),
        ("size = 20", "size = -1", "mine.toml:10:8: `size` is -1, expected a number > 0"),
        (
            "low = 0.5",
            "low = 50",
            "mine.toml:16:7: `low` is 50, expected bounds that hold the neutral value 5",
        ),
        ("law = ", "formula = ", "mine.toml:6:1: "),
    ] {
        let error = changed(from, to);
        assert!(error.starts_with(expected), "{from} → {to}: {error}");
    }
    // what only rod and readings can tell
    let (rod, readings) = written(&spec(), 51, |_| 0.0);
    let rod = Rod::from_toml("rod.toml", &rod).unwrap();
    let readings = Readings::from_text("readings.csv", &readings).unwrap();
    let refused = |from: &str, to: &str| {
        let own = OwnEffect::from_toml("mine.toml", &text.replace(from, to)).unwrap();
        diagnose_with(&readings, Some(&rod), &[], &own).unwrap_err().to_string()
    };
    let error = refused("place = \"clamp\"", "place = \"clmp\"");
    assert!(error.starts_with("mine.toml:4:9: `place` is \"clmp\", expected "), "{error}");
    let error = refused("a_um*(1", "a_um + (1");
    assert!(error.starts_with("mine.toml:6:7: `law` is "), "{error}");
    let error = refused("exp(-F/b_n)", "ln(-F/b_n)");
    assert!(error.starts_with("mine.toml:6:7: `law` is no number"), "{error}");
}

/// By Euler's method in small steps, up and down again.
#[test]
fn a_clamp_that_slips() {
    let (r, n, s) = (2.5, 2.0, 0.7);
    let state = std::cell::Cell::new((0.0, 0.0, 1.0));
    let spec = CaseSpec { unloading: true, axes: vec![1], ..spec() };
    let json = answer(&example(3), &spec, |row| {
        // a run begins on the way up
        let (mut z, before): (f64, f64) = match state.get() {
            (z, before, side) if side >= row.side => (z, before),
            _ => (0.0, 0.0),
        };
        let step = (row.load - before) / 1000.0;
        for _ in 0..1000 {
            let along = if z * step < 0.0 { 1.0 - 2.0 * s } else { 1.0 };
            z += step * (1.0 - along * (z / r).abs().powf(n));
        }
        state.set((z, row.load, row.side));
        8.0 * z
    });
    let own = finding(&json, "slipping_clamp");
    assert_near(own, "a_um", 8.0);
    assert_near(own, "r", 2.5);
}

/// A memory needs its constants among the parameters.
#[test]
fn a_memory_without_its_constants_is_refused() {
    let text = example(3).replace("name = \"n\", neutral = 2", "name = \"n\", neutral = 0.5");
    let error = OwnEffect::from_toml("mine.toml", &text.replace("low = 1, high = 8", "low = 0")).unwrap_err();
    assert!(
        error.to_string().contains("mine.toml:6:10") && error.to_string().contains("n from 1 to 8"),
        "{error}"
    );
}
