//! A trial as it is typed: sealed, answered in pieces, scored; and what is refused.

use super::Sandbox;

#[test]
fn a_trial_is_made_answered_in_pieces_and_scored() {
    let sandbox = Sandbox::empty();
    sandbox.run("trial make t --seed 3 --cases 3 --rig").succeeded();
    let readings = sandbox.read("t/rig/case-0001/readings.csv");
    assert!(readings.starts_with("# SIMULATED"));
    assert!(!sandbox.read("t/manifest.json").contains("seed"));
    sandbox.run("trial answer t --case-range 1..2").succeeded();
    sandbox.write("t/answers.jsonl", &(sandbox.read("t/answers.jsonl") + "{\"case\": \"rig/ca"));
    let answered = sandbox.run("trial answer t --json").json();
    assert_eq!((&answered["answered"], &answered["answered_before"]), (&1.into(), &2.into()));
    assert_eq!(sandbox.read("t/answers.jsonl").lines().count(), 3);
    let score = sandbox.run("trial score t t.key.jsonl --json").json();
    sandbox.run("trial score t t.key.jsonl --out page").succeeded();
    assert!(sandbox.read("page/index.html").contains("<dt>seed of the cases</dt><dd>3</dd>"));
    let count = |kind: &str| score[kind]["n"].as_u64().unwrap();
    let rate = |kind: &str, rate: &str| score[kind][rate]["of"].as_u64().unwrap();
    let files = rate("mistakes", "named") + rate("suspects", "remarked");
    assert_eq!(count("clean") + count("single") + count("pairs") + count("unknown") + files, 3);
    for key in ["coverage", "gain_over_oracle", "counterfactual_over_oracle", "next_measurement_ok"] {
        assert!(score.get(key).is_some(), "{key}");
    }
}

#[test]
fn other_readings_are_predicted_and_what_is_proposed_is_measured() {
    let sandbox = Sandbox::empty();
    for (directory, cases) in [("a", "1..3"), ("b", "1..2")] {
        sandbox.run(&format!("trial make {directory} --seed 8 --cases 3 --rig")).succeeded();
        sandbox.run(&format!("trial answer {directory} --case-range {cases}")).succeeded();
    }
    let score = sandbox.run("trial score a --json").json();
    // the same once more
    let answers = |directory: &str| -> Vec<String> {
        let text = sandbox.read(&format!("{directory}/answers.jsonl"));
        text.replace(&format!("{directory}/rig/"), "rig/").lines().take(2).map(str::to_owned).collect()
    };
    assert_eq!(answers("a"), answers("b"));
    assert_eq!(sandbox.read("a.key.jsonl"), sandbox.read("b.key.jsonl"));
    let asked = sandbox.read("b/rig/case-0003/asked.csv");
    assert!(asked.starts_with("# SIMULATED"), "{asked}");
    assert!(asked.lines().skip(2).all(|row| row.ends_with(",0")), "{asked}");
    assert!(score["counterfactual"].is_object(), "{score}");
    // whoever answers sees the question and nothing of what belongs there
    let key = sandbox.read("a.key.jsonl");
    assert!(key.contains("true_um") && !sandbox.read("a/manifest.json").contains("true_um"));
    sandbox.write("a/rig/case-0003/asked.csv", &format!("{asked}y,1,0\n"));
    for line in ["trial score a", "trial answer a --answers again.jsonl --case-range 3..3"] {
        let refused = sandbox.run(line);
        assert_eq!(refused.status, Some(2), "{line}");
        let says = "error: a/rig/case-0003/asked.csv: its SHA-256 is";
        assert!(refused.stderr.starts_with(says), "{}", refused.stderr);
    }
}

/// A fixed trial; physics outside the library is said to be that.
#[test]
fn a_small_trial_is_answered_as_well_as_ever() {
    let sandbox = Sandbox::empty();
    sandbox.run("trial make t --seed 20261122 --cases 20").succeeded();
    sandbox.run("trial answer t").succeeded();
    let score = sandbox.run("trial score t --json").json();
    let count = |kind: &str, key: &str| score[kind][key].as_u64().unwrap();
    assert_eq!((count("clean", "n"), score["failed"].as_u64()), (4, Some(0)));
    assert!(count("clean", "false_names") + count("clean", "false_unexplained") == 0, "{}", score["clean"]);
    let single = &score["single"];
    assert!(count("single", "identifiable") == 4 && count("single", "location_ok") == 4, "{single}");
    // in the class wherever something is named
    let rate = |kind: &str, rate: &str| {
        let rate = &score[kind][rate];
        (rate["count"].as_u64().unwrap(), rate["of"].as_u64().unwrap())
    };
    assert_eq!(rate("single", "in_class_rate"), (5, 5), "{single}");
    assert!(count("pairs", "identifiable") == 1 && count("pairs", "both_found") == 1, "{}", score["pairs"]);
    let unknown = &score["unknown"];
    assert!(count("unknown", "identifiable") == 2 && count("unknown", "called_unknown") == 2, "{unknown}");
    // at the rig and of calibrations
    assert_eq!((rate("mistakes", "placed"), rate("mistakes", "silent")), ((3, 3), (0, 3)));
    assert_eq!(rate("mistakes", "invented").0, 0, "{}", score["mistakes"]);
    assert_eq!((rate("suspects", "remarked"), rate("suspects", "named")), ((1, 1), (0, 1)));
    for (key, least) in [("coverage", 0.75), ("gain_over_oracle", 0.9)] {
        assert!(score[key].as_f64().unwrap() > least, "{key}: {}", score[key]);
    }
    // what is asked for is predicted about as well as by an oracle
    let asked = &score["calibration"]["counterfactual"];
    assert!(asked["n"] == asked["answered"] && asked["n"].as_u64().unwrap() >= 1, "{asked}");
    assert!(asked["median"].as_f64().unwrap() < 1.5, "{asked}");
}

#[test]
fn poses_that_are_proposed_are_measured_by_the_same_robot() {
    let sandbox = Sandbox::empty();
    // play that may be a read-back lag (a tracker), a clamp's place that may be a move of the base
    let cases = [
        ("t", "--seed 102 --case-range 1..1 --conflicts"),
        ("u", "--seed 424243 --case-range 28..28 --calibration"),
    ];
    for (directory, drawn) in cases {
        sandbox.run(&format!("trial make {directory} {drawn}")).succeeded();
        sandbox.run(&format!("trial answer {directory}")).succeeded();
        let score = sandbox.run(&format!("trial score {directory} --json")).json();
        let next = &score["next_measurement_ok"];
        assert_eq!((&score["failed"], &next["not_done"]), (&0.into(), &serde_json::json!({})));
        assert_eq!((&next["n"], &next["ok"]), (&1.into(), &1.into()), "{next}");
        if directory == "t" {
            let counts = &score["calibration"]["conflicts"];
            assert_eq!(
                counts["read-back lag or play"]["backlash, not identifiable"]["backlash"], 1,
                "{counts}"
            );
        }
    }
    let asked = sandbox.read("t/calibration/case-0001/asked.csv");
    assert!(asked.starts_with("# SIMULATED") && asked.contains(",0.0000,0.0000,0.0000"), "{asked}");
    assert!(sandbox.read("t/calibration/case-0001/asked.toml").contains("contact_force_n"));
}

#[test]
fn another_key_and_changed_recordings_are_refused() {
    let sandbox = Sandbox::empty();
    sandbox.run("trial make t --seed 3 --cases 2 --rig").succeeded();
    sandbox.run("trial answer t").succeeded();
    let (key, rod) = (sandbox.read("t.key.jsonl"), sandbox.read("t/rig/case-0002/rod.toml"));
    let refuses = |line: &str, says: &str| {
        let answer = sandbox.run(line);
        assert_eq!((answer.status, answer.stdout.as_str()), (Some(2), ""), "{line}");
        assert!(answer.stderr.starts_with(&format!("error: {says}")), "{}", answer.stderr);
    };
    sandbox.write("t.key.jsonl", &key.replacen("case-0001", "case-0002", 1));
    refuses("trial score t", "t.key.jsonl: its SHA-256 is");
    sandbox.write("t.key.jsonl", &key);
    sandbox.write("t/rig/case-0002/rod.toml", &rod.replacen("l1_mm = ", "l1_mm = 1", 1));
    refuses("trial score t", "t/rig/case-0002/rod.toml: its SHA-256 is");
    sandbox.write("t/rig/case-0002/rod.toml", &rod);
    sandbox.write("t/rig/case-0002/rod-7.toml", &rod);
    for line in ["trial score t", "trial answer t --answers again.jsonl"] {
        refuses(line, "t/rig/case-0002/rod-7.toml: it is not in the manifest");
    }
    std::fs::remove_file(sandbox.path().join("t/rig/case-0002/rod-7.toml")).unwrap();
    // a manifest that leads elsewhere, and one that says less than there is
    let manifest = sandbox.read("t/manifest.json");
    sandbox.write("t/manifest.json", &manifest.replacen("rig/case-0001/", "rig/case-0001/../", 1));
    refuses("trial answer t --answers again.jsonl", "t/manifest.json: it names \"rig/case-0001/../");
    sandbox.write("t/manifest.json", &manifest.replacen("\"cases\": 2", "\"cases\": 1000000000000000000", 1));
    refuses("trial score t", "t/manifest.json: it has files of 2 cases, expected the 10");
    sandbox.write("t/manifest.json", &(manifest.clone() + "\n"));
    refuses("trial score t", "t/manifest.json: its SHA-256 is");
    sandbox.write("t/manifest.json", &manifest);
    // answers: to no case, and not to all
    let answers = sandbox.read("t/answers.jsonl");
    sandbox.write("t/answers.jsonl", &answers.replacen("rig/case-0001", "../case-0001", 1));
    refuses("trial score t", "t/answers.jsonl: an answer to \"../case-0001\", which is no case");
    sandbox.write("t/answers.jsonl", &answers.split_inclusive('\n').take(1).collect::<String>());
    let score = sandbox.run("trial score t").succeeded().stdout;
    assert!(score.starts_with("1 of 2 cases have no answer: the score is of the other 1.\n"), "{score}");
    // of a former version
    sandbox.write("t.key.jsonl", key.split_once('\n').unwrap().1);
    let score = sandbox.run("trial score t").succeeded().stdout;
    assert!(score.lines().nth(1).unwrap().starts_with("The key is of a former version"), "{score}");
}

#[test]
fn a_seed_that_may_be_guessed_is_warned_about_and_none_is_needed() {
    let sandbox = Sandbox::empty();
    let warned = sandbox.run("trial make t --seed 3 --cases 1 --rig").succeeded().warnings();
    assert!(warned.len() == 1 && warned[0].starts_with("the seed 3 has fewer"), "{warned:?}");
    for (name, seed) in [("u", ""), ("v", ""), ("w", " --seed 0x123456789abcdef0123456789abcdef")] {
        let made = sandbox.run(&format!("trial make {name} --cases 1 --rig{seed}")).succeeded();
        assert_eq!(made.warnings(), [""; 0]);
    }
    let key = sandbox.read("w.key.jsonl");
    assert!(key.contains("\"seed\":\"0x123456789abcdef0123456789abcdef\""), "{key}");
    assert_ne!(sandbox.read("u/rig/case-0001/readings.csv"), sandbox.read("v/rig/case-0001/readings.csv"));
}

#[test]
fn noise_can_be_that_of_a_real_recording() {
    let sandbox = Sandbox::empty();
    let rows: String = (0..16).map(|k| format!("{}\n", 1e-4 * f64::from(k % 5))).collect();
    sandbox.write("residuals.csv", &format!("residual\n{rows}"));
    sandbox.run("trial make t --seed 3 --cases 3 --rig --residuals residuals.csv").succeeded();
    sandbox.run("trial make u --seed 3 --cases 3 --rig").succeeded();
    let key = sandbox.read("t.key.jsonl");
    assert_eq!(key.matches("16 residuals of a recording").count(), 3, "{key}");
    // rod and loads are the same, what is read is not
    let [rod, other] = ["t", "u"].map(|trial| sandbox.read(&format!("{trial}/rig/case-0002/rod.toml")));
    assert!(rod == other && key != sandbox.read("u.key.jsonl"));
    sandbox.write("residuals.csv", "rest\n1\n2\n");
    let refused = sandbox.run("trial make v --seed 3 --cases 3 --rig --residuals residuals.csv");
    assert_eq!(refused.status, Some(2));
    assert!(refused.stderr.contains("residuals.csv") && refused.stderr.contains("residual"));
}
