//! What to measure on a rig, and readings to be filled in.

use serde_json::Value;

use super::Sandbox;

/// The blank readings of a plan with what the rod's compliance says, and a little scatter.
fn filled(sandbox: &Sandbox, rod: &str, template: &str) -> String {
    let compliance = sandbox.run(&format!("compliance {rod} --json")).json();
    let entry = |channel: usize, axis: usize| compliance["cf_um_per_n"][channel][axis].as_f64().unwrap();
    let mut text = String::new();
    for (k, line) in template.lines().enumerate() {
        let Some(blank) = line.strip_suffix(",,,") else {
            text += &format!("{line}\n");
            continue;
        };
        let cells: Vec<&str> = blank.split(',').collect();
        let (axis, load): (_, f64) = (cells[0], cells[1].parse().unwrap());
        let sign = if axis.starts_with('-') { -1.0 } else { 1.0 };
        let number = "xyz".find(axis.trim_start_matches('-')).unwrap();
        let offset = |channel: usize| {
            // no sine of the row: that comes and goes with one period, and is found
            let scatter = 2.0 * (43758.5453 * ((7 * k + 3 * channel) as f64).sin()).rem_euclid(1.0) - 1.0;
            format!("{:.2}", sign * load * entry(channel, number) + scatter)
        };
        text += &format!("{blank},{},{},{}\n", offset(0), offset(1), offset(2));
    }
    text
}

#[test]
fn a_plan_tells_what_it_says_and_its_readings_are_read() {
    let sandbox = Sandbox::new();
    let line = "design rig rods/2.toml --between friction,root_compliance --at-tip --noise-um 1 --out o";
    let json = sandbox.run(&format!("{line} --json")).json();
    let measurements = json["measurements"].as_array().unwrap();
    assert!(!measurements.is_empty() && json["minutes"].as_f64().unwrap() > 10.0, "{json}");
    assert!(
        measurements.iter().all(|one| one["load_station_mm"].is_null() && one["repeats"].as_u64() > Some(0))
    );
    let least = |effect: &str, against: Value| {
        let told = json["distinguished"].as_array().unwrap();
        let pair = told.iter().find(|pair| pair["effect"] == effect && pair["against"] == against).unwrap();
        pair["places"][0]["log_odds"].as_f64().unwrap()
    };
    for (effect, against) in [
        ("friction", "root_compliance".into()),
        ("root_compliance", "friction".into()),
        ("friction", Value::Null),
    ] {
        assert!(least(effect, against) >= 20f64.ln() - 1e-9, "{json}");
    }
    sandbox.write("mine.csv", &filled(&sandbox, "rods/2.toml", &sandbox.read("o/readings.csv")));
    let fit = sandbox.run("rig fit rods/2.toml mine.csv --json").json();
    assert!((fit["r_rod"].as_f64().unwrap() - 1.0).abs() < 0.02, "{fit}");
    let found = sandbox.run("diagnose rig rods/2.toml mine.csv --json").json();
    assert_eq!(
        (&found["verdict"], found["findings"].as_array().map(Vec::len)),
        (&"consistent".into(), Some(0))
    );
    let words = sandbox.run(line).succeeded().stdout.replace('\n', " ");
    assert!(words.contains("these effects, with") || words.contains("these effects in"), "{words}");
}

#[test]
fn r_rod_is_as_well_known_as_was_asked_for() {
    let sandbox = Sandbox::new();
    let json = sandbox.run("design rig rods/5.toml --r-rod-width-percent 1 --out o --json").json();
    assert!(json["r_rod"]["width_expected_percent"].as_f64().unwrap() <= 1.0, "{json}");
    sandbox.write("mine.csv", &filled(&sandbox, "rods/5.toml", &sandbox.read("o/readings.csv")));
    let fit = sandbox.run("rig fit rods/5.toml mine.csv --json").json();
    assert!((fit["r_rod"].as_f64().unwrap() - 1.0).abs() < 0.01, "{fit}");
}

#[test]
fn what_cannot_be_planned_is_refused() {
    let sandbox = Sandbox::new();
    for (line, expected) in [
        ("design rig rods/5.toml", "--between"),
        ("design rig rods/5.toml --between gremlins", "one of friction, pulley_friction"),
        (
            "design rig rods/5.toml --between bend_flexibility",
            "a plan that shows bend_flexibility is not possible",
        ),
        ("design rig rods/5.toml --r-rod-width-percent 0.001", "repeats"),
        ("design rig rods/5.toml --between friction --odds 1", "expected odds > 1"),
        ("design rig rods/5.toml --between friction --max-load=-3", "expected a number > 0"),
    ] {
        let answer = sandbox.run(line);
        assert_eq!((answer.status, answer.stdout.as_str()), (Some(2), ""), "{line}");
        assert!(answer.stderr.contains(expected), "{line}: {}", answer.stderr);
    }
}
