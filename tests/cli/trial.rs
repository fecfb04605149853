//! A trial as it is typed: sealed, answered in pieces, scored; and what is refused.

use super::Sandbox;

#[test]
fn a_trial_is_made_answered_in_pieces_and_scored() {
    let sandbox = Sandbox::empty();
    sandbox.run("trial make t --seed 3 --cases 5 --rig").succeeded();
    let readings = sandbox.read("t/rig/case-0001/readings.csv");
    assert!(readings.starts_with("# SIMULATED"));
    assert!(!sandbox.read("t/manifest.json").contains("seed"));
    sandbox.run("trial answer t --case-range 1..2").succeeded();
    sandbox.write("t/answers.jsonl", &(sandbox.read("t/answers.jsonl") + "{\"case\": \"rig/ca"));
    let answered = sandbox.run("trial answer t --json").json();
    assert_eq!((&answered["answered"], &answered["answered_before"]), (&3.into(), &2.into()));
    assert_eq!(sandbox.read("t/answers.jsonl").lines().count(), 5);
    let score = sandbox.run("trial score t t.key.jsonl --json").json();
    let of = |kind: &str| score[kind]["n"].as_u64().unwrap();
    assert_eq!(of("clean") + of("single") + of("pairs") + of("unknown"), 5);
    for key in ["coverage", "gain_over_oracle", "counterfactual_over_oracle", "next_measurement_ok"] {
        assert!(score.get(key).is_some(), "{key}");
    }
}

#[test]
fn other_readings_are_foretold_and_what_is_proposed_is_measured() {
    let sandbox = Sandbox::empty();
    for (directory, cases) in [("a", "1..24"), ("b", "1..8")] {
        sandbox.run(&format!("trial make {directory} --seed 7 --cases 24 --rig")).succeeded();
        sandbox.run(&format!("trial answer {directory} --case-range {cases}")).succeeded();
    }
    let score = sandbox.run("trial score a --json").json();
    // the same once more
    let answers = |directory: &str| -> Vec<String> {
        let text = sandbox.read(&format!("{directory}/answers.jsonl"));
        text.replace(&format!("{directory}/rig/"), "rig/").lines().take(8).map(str::to_owned).collect()
    };
    assert_eq!(answers("a"), answers("b"));
    assert_eq!(sandbox.read("a.key.jsonl"), sandbox.read("b.key.jsonl"));
    let asked = sandbox.read("b/rig/case-0003/asked.csv");
    assert!(asked.starts_with("# SIMULATED"), "{asked}");
    assert!(asked.lines().skip(2).all(|row| row.ends_with(",0")), "{asked}");
    let ratio = score["counterfactual_over_oracle"].as_f64().unwrap();
    assert!(ratio > 0.3 && ratio < 30.0, "{ratio}");
    let next = &score["next_measurement_ok"];
    assert!(next["n"].as_u64().unwrap() >= 3 && next["ok"].as_u64().unwrap() >= 1, "{next}");
    assert_eq!(next["not_done"], serde_json::json!({}));
    // whoever answers sees the question and nothing of what belongs there
    let key = sandbox.read("a.key.jsonl");
    assert!(key.contains("true_um") && !sandbox.read("a/manifest.json").contains("true_um"));
    sandbox.write("a/rig/case-0003/asked.csv", &asked.replacen("x,", "y,", 1));
    for line in ["trial score a", "trial answer a --answers again.jsonl --case-range 3..3"] {
        let refused = sandbox.run(line);
        assert_eq!(refused.status, Some(2), "{line}");
        let says = "error: a/rig/case-0003/asked.csv: its SHA-256 is";
        assert!(refused.stderr.starts_with(says), "{}", refused.stderr);
    }
}

/// A fixed trial with room for one or two cases of bad luck, which a regression would use up.
#[test]
fn a_small_trial_is_answered_as_well_as_ever() {
    let sandbox = Sandbox::empty();
    sandbox.run("trial make t --seed 20261121 --cases 48").succeeded();
    sandbox.run("trial answer t").succeeded();
    let score = sandbox.run("trial score t --json").json();
    let count = |of: &str, key: &str| score[of][key].as_u64().unwrap();
    assert_eq!((count("clean", "n"), score["failed"].as_u64()), (20, Some(0)));
    assert!(count("clean", "false_names") + count("clean", "false_unexplained") <= 1, "{}", score["clean"]);
    let single = &score["single"];
    assert!(count("single", "identifiable") == 8 && count("single", "name_ok") >= 7, "{single}");
    assert!(count("single", "location_ok") >= 7, "{single}");
    // in the class wherever something is named; where nothing is, the numbers of the rod's file are
    // uncertain by as much
    let class = &single["in_class_rate"];
    assert!(class["of"].as_u64().unwrap() >= 9 && class["share"].as_f64().unwrap() >= 0.9, "{single}");
    assert!(count("pairs", "identifiable") == 4 && count("pairs", "both_found") >= 3, "{}", score["pairs"]);
    assert!(count("unknown", "wrongly_named") == 0, "{}", score["unknown"]);
    for (key, least) in [("coverage", 0.75), ("gain_over_oracle", 0.9)] {
        assert!(score[key].as_f64().unwrap() > least, "{key}: {}", score[key]);
    }
    // what is asked for is foretold about as well as by an oracle; that of a rod knows its file's
    // numbers exactly, which nobody does, so that its cases are compared with their noise
    for (half, key, most) in [("rig", "answer_over_noise_median", 1.0), ("calibration", "median", 1.5)] {
        let told = &score[half]["counterfactual"];
        assert!(told["n"] == told["answered"] && told["n"].as_u64().unwrap() >= 3, "{half}: {told}");
        assert!(told[key].as_f64().unwrap() < most, "{half}: {told}");
    }
}

#[test]
fn poses_that_are_proposed_are_measured_by_the_same_robot() {
    let sandbox = Sandbox::empty();
    // clamps whose places are ambiguous (108, 119, 120), sockets (103), a tracker (118)
    let mut settled = [0; 2];
    for (directory, cases) in [("t", "103..108"), ("u", "118..120")] {
        let make = format!("trial make {directory} --seed 1480989568 --case-range {cases} --calibration");
        sandbox.run(&make).succeeded();
        sandbox.run(&format!("trial answer {directory}")).succeeded();
        let score = sandbox.run(&format!("trial score {directory} --json")).json();
        let next = &score["next_measurement_ok"];
        assert_eq!((&score["failed"], &next["not_done"]), (&0.into(), &serde_json::json!({})));
        for (count, key) in settled.iter_mut().zip(["n", "ok"]) {
            *count += next[key].as_u64().unwrap();
        }
    }
    let [open, ok] = settled;
    assert!(open >= 2 && ok == open, "{ok} of {open}");
    let asked = sandbox.read("t/calibration/case-0103/asked.csv");
    assert!(asked.starts_with("# SIMULATED") && asked.contains(",0.0000,0.0000,0.0000"), "{asked}");
    assert!(sandbox.read("t/calibration/case-0103/asked.toml").contains("contact_force_n"));
}

#[test]
fn another_key_and_changed_recordings_are_refused() {
    let sandbox = Sandbox::empty();
    sandbox.run("trial make t --seed 3 --cases 2 --rig").succeeded();
    sandbox.run("trial answer t").succeeded();
    let (key, rod) = (sandbox.read("t.key.jsonl"), sandbox.read("t/rig/case-0002/rod.toml"));
    let refuses = |line: &str, file: &str| {
        let answer = sandbox.run(line);
        assert_eq!((answer.status, answer.stdout.as_str()), (Some(2), ""), "{line}");
        assert!(answer.stderr.starts_with(&format!("error: {file}: its SHA-256 is")), "{}", answer.stderr);
    };
    sandbox.write("t.key.jsonl", &key.replacen("case-0001", "case-0002", 1));
    refuses("trial score t", "t.key.jsonl");
    sandbox.write("t.key.jsonl", &key);
    sandbox.write("t/rig/case-0002/rod.toml", &rod.replacen("l1_mm = ", "l1_mm = 1", 1));
    refuses("trial score t", "t/rig/case-0002/rod.toml");
    assert_eq!(sandbox.run("trial make t --seed 4").status, Some(2));
    assert_eq!(sandbox.run("trial make u --seed 4 --key u/key.jsonl").status, Some(2));
}
