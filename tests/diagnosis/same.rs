//! What says the same gets the same diagnosis.

use rodcal::units::{STANDARD_GRAVITY, UM};
use rodcal_trial::rig::{CaseSpec, Columns, Effect};
use serde_json::Value;

use super::Answer;

fn spec() -> CaseSpec {
    CaseSpec { axes: vec![1, 2], ..CaseSpec::default() }
}

fn effects() -> [Effect; 2] {
    [
        Effect::Friction { axis: None, force: 1.0, presliding: 0.5 * UM, scatter: 0.1 },
        Effect::SensorScale { channel: 2, factor: 1.05 },
    ]
}

/// A file as rows of cells; comments dropped.
fn table(text: &str) -> Vec<Vec<String>> {
    let lines = text.lines().filter(|line| !line.starts_with('#'));
    lines.map(|line| line.split(',').map(str::to_owned).collect()).collect()
}

fn text(table: &[Vec<String>]) -> String {
    table.iter().map(|row| row.join(",") + "\n").collect()
}

/// Two diagnoses say the same, numbers to a part in a thousand: odds are sensitive.
fn assert_same(a: &Value, b: &Value, at: &str) {
    match (a, b) {
        (Value::Number(x), Value::Number(y)) => {
            let (x, y) = (x.as_f64().unwrap(), y.as_f64().unwrap());
            assert!((x - y).abs() <= 1e-3 * x.abs().max(y.abs()) + 1e-12, "{at}: {x} and {y}");
        }
        (Value::Array(x), Value::Array(y)) => {
            assert_eq!(x.len(), y.len(), "{at}");
            x.iter().zip(y).enumerate().for_each(|(k, (x, y))| assert_same(x, y, &format!("{at}[{k}]")));
        }
        (Value::Object(x), Value::Object(y)) => {
            for (key, x) in x {
                assert_same(x, &y[key], &format!("{at}.{key}"));
            }
        }
        _ => assert_eq!(a, b, "{at}"),
    }
}

fn assert_same_diagnosis(a: &Answer, b: &Answer) {
    for key in
        ["verdict", "headline", "findings", "unexplained", "noise_um", "rms_after_um", "heldout_after_um"]
    {
        assert_same(&a.json[key], &b.json[key], key);
    }
}

#[test]
fn names_of_trials_mean_nothing() {
    let case = spec().simulated(&effects(), 31);
    let plain = Answer::of_case(&case);
    for names in [["3", "1", "2"], ["c", "a", "b"], ["after lunch", "0", "-1"]] {
        let mut renamed = table(&case.readings);
        let column = renamed[0].iter().position(|name| name == "trial").unwrap();
        for row in &mut renamed[1..] {
            let number: usize = row[column].parse().unwrap();
            row[column] = names[number - 1].into();
        }
        assert_same_diagnosis(&plain, &Answer::of(Some(&case.rod), &text(&renamed)));
    }
}

#[test]
fn columns_may_stand_in_any_order() {
    let case = spec().simulated(&effects(), 32);
    let plain = Answer::of_case(&case);
    let columns = table(&case.readings)[0].len();
    for turn in 1..columns {
        let mut turned = table(&case.readings);
        turned.iter_mut().for_each(|row| row.rotate_left(turn));
        turned.iter_mut().for_each(|row| {
            if turn % 2 == 0 {
                row.reverse()
            }
        });
        assert_same_diagnosis(&plain, &Answer::of(Some(&case.rod), &text(&turned)));
    }
}

#[test]
fn kilograms_are_newtons() {
    let case = spec().simulated(&effects(), 33);
    let mut kilograms = table(&case.readings);
    let column = kilograms[0].iter().position(|name| name == "load_n").unwrap();
    kilograms[0][column] = "load_kg".into();
    for row in &mut kilograms[1..] {
        let load: f64 = row[column].parse().unwrap();
        row[column] = (load / STANDARD_GRAVITY).to_string();
    }
    assert_same_diagnosis(&Answer::of_case(&case), &Answer::of(Some(&case.rod), &text(&kilograms)));
    let columns = Columns { kilograms: true, ..spec().columns };
    let case = CaseSpec { columns, ..spec() }.simulated(&effects(), 33);
    assert!(case.readings.contains("load_kg"));
}
