//! `compare-runs`: what changed between results of one command, and what is no comparison.

use super::Sandbox;

/// Two rig fits, of which the second has every offset along y 3 % larger.
fn sandbox() -> Sandbox {
    let sandbox = Sandbox::new();
    let larger = |line: &str| match line.split(',').collect::<Vec<_>>()[..] {
        ["y", load, trial, dy, dz] => match dy.parse::<f64>() {
            Ok(dy) => format!("y,{load},{trial},{:.0},{dz}\n", 1.03 * dy),
            Err(_) => format!("{line}\n"),
        },
        _ => format!("{line}\n"),
    };
    let readings: String = sandbox.read("stiffness_data/5.csv").lines().map(larger).collect();
    assert_ne!(readings, sandbox.read("stiffness_data/5.csv"));
    sandbox.write("softer.csv", &readings);
    sandbox.run("rig fit rods/5.toml stiffness_data/5.csv --out a").succeeded();
    sandbox.run("rig fit rods/5.toml softer.csv --out b").succeeded();
    sandbox
}

#[test]
fn what_changed_is_said_with_its_significance() {
    let sandbox = sandbox();
    let json = sandbox.run("compare-runs a b --out c --json").json();
    let difference = &json["differences"][0];
    assert_eq!(json["subcommand"], "rig fit");
    let states: Vec<&str> = difference["inputs"]
        .as_array()
        .unwrap()
        .iter()
        .map(|input| input["state"].as_str().unwrap())
        .collect();
    assert_eq!(states, ["same", "changed"]);
    let [along_y, along_z] = [0, 1].map(|k| &difference["parameters"][k]);
    // what stands in the two results, by hand
    let slope = |folder: &str| -> (f64, f64) {
        let result: serde_json::Value =
            serde_json::from_str(&sandbox.read(&format!("{folder}/result.json"))).unwrap();
        let slope = &result["slopes"][0];
        (slope["um_per_n"].as_f64().unwrap(), slope["std_error"].as_f64().unwrap())
    };
    let ((a, error_a), (b, error_b)) = (slope("a"), slope("b"));
    let ratio = along_y["ratio"].as_f64().unwrap();
    assert!(
        (ratio - (b - a) / (error_a.powi(2) + error_b.powi(2)).sqrt()).abs() < 1e-9 && ratio > 5.0,
        "{ratio}"
    );
    assert_eq!((&along_y["significant"], &along_z["significant"]), (&true.into(), &false.into()));
    assert_eq!(along_z["difference"], 0.0);
    let page = sandbox.read("c/index.html").replace('\u{a0}', " ");
    assert!(page.contains("3 of 5 differ significantly") && page.contains("Runs of rodcal rig fit"));
    assert!(page.contains("<h2>Parameters</h2>") && page.contains("How far each parameter moved"));
    // results are read, not replaced
    let answer = sandbox.run("compare-runs a b --out a");
    assert_eq!(answer.status, Some(2));
    assert!(answer.stderr.starts_with("error: this command reads a/result.json"), "{}", answer.stderr);
}

#[test]
fn runs_on_the_same_recording_are_not_tested() {
    let sandbox = sandbox();
    sandbox.run("rig fit rods/5.toml stiffness_data/5.csv --robust huber --out huber").succeeded();
    let answer = sandbox.run("compare-runs a huber --json");
    assert!(answer.stderr.contains("the same recording (stiffness_data/5.csv)"), "{}", answer.stderr);
    let json = answer.json();
    let difference = &json["differences"][0];
    let options = serde_json::json!([{ "option": "--robust", "first": "none", "other": "huber" }]);
    assert_eq!(difference["options"], options);
    assert_eq!((&difference["tested"], &difference["parameters"][0]["significant"]), (&0.into(), &().into()));
    let same = sandbox.run("compare-runs a a").succeeded();
    assert!(
        same.stdout.starts_with("a against a: all inputs are the same; no parameter differs"),
        "{}",
        same.stdout
    );
}

#[test]
fn what_cannot_be_compared_is_refused() {
    let sandbox = sandbox();
    sandbox.run("compliance rods/5.toml --out other").succeeded();
    std::fs::create_dir(sandbox.path().join("broken")).unwrap();
    sandbox.write("broken/result.json", "{\n  \"rod\": }\n");
    std::fs::create_dir(sandbox.path().join("old")).unwrap();
    sandbox.write("old/result.json", "{}\n");
    for (line, error) in [
        ("compare-runs a rods", "`RUN` is rods, which holds no result.json"),
        ("compare-runs a nowhere", "cannot read nowhere/result.json: "),
        (
            "compare-runs a other",
            "`RUNS` is a (rodcal rig fit) and other (rodcal compliance), expected runs of one command",
        ),
        ("compare-runs a broken", "broken/result.json:2:10: no JSON"),
        ("compare-runs a old", "old/result.json: there is no provenance"),
        ("compare-runs a", "2 values required"),
    ] {
        let answer = sandbox.run(line);
        assert_eq!((answer.status, answer.stdout.as_str()), (Some(2), ""), "{line}");
        assert!(answer.stderr.starts_with(&format!("error: {error}")), "{line}\n{}", answer.stderr);
    }
}
