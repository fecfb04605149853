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
