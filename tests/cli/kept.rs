//! What somebody else wrote, or changed, is never replaced unless `--force` says so.

use super::{Answer, Sandbox};

/// Every command that takes `--out`; none of them gets as far as its input here.
const REPORTS: [&str; 13] = [
    "demo",
    "compliance rods/5.toml",
    "rig fit rods/5.toml stiffness_data/5.csv",
    "diagnose rig rods/5.toml stiffness_data/5.csv --apply",
    "calibrate campaigns/tx90-5/campaign.toml",
    "compare campaigns/tx90-5/campaign.toml",
    "diagnose calibration campaigns/tx90-5/campaign.toml --apply",
    "predict robots/tx90.toml poses.csv",
    "design rod examples/design.toml",
    "design poses campaigns/tx90-5/campaign.toml --count 60",
    "design rig rods/5.toml --r-rod-width-percent 1",
    "trial score t",
    "compare-runs a b",
];

const SIMULATE: &str = "simulate sim --rod rods/5.toml --poses 6 --validation 4";

/// Refused with one error and a hint; what is there stays.
fn refused(sandbox: &Sandbox, line: &str, error: &str) {
    let hint = "hint: write to another place, or replace what is there with --force";
    refused_with(sandbox, line, error, hint);
}

fn refused_with(sandbox: &Sandbox, line: &str, error: &str, hint: &str) {
    let before = sandbox.listing();
    let Answer { status, stdout, stderr, .. } = sandbox.run(line);
    assert_eq!((status, stdout.as_str()), (Some(2), ""), "{line}\n{stderr}");
    assert_eq!(stderr, format!("error: {error}\n{hint}\n"), "{line}");
    assert!(sandbox.listing() == before, "{line}: something was written");
}

#[test]
fn no_report_replaces_a_page_of_somebody_else() {
    let sandbox = Sandbox::new();
    std::fs::create_dir_all(sandbox.path().join("reports/demo")).unwrap();
    sandbox.write("reports/demo/index.html", "mine");
    for line in REPORTS {
        let error = "reports/demo/index.html is there already, and rodcal did not write it";
        refused(&sandbox, &format!("{line} --out reports/demo"), error);
    }
    // where it goes by itself
    refused(&sandbox, "demo", "reports/demo/index.html is there already, and rodcal did not write it");
    std::fs::create_dir(sandbox.path().join("results")).unwrap();
    sandbox.write("results/result.json", "{}");
    let error = "results/result.json is there already, and rodcal did not write it";
    refused(&sandbox, "compliance rods/5.toml --out results", error);
    sandbox.run("compliance rods/5.toml --out results --force").succeeded();
    sandbox.run("compliance rods/2.toml --out results").succeeded();
    assert!(sandbox.read("results/result.json").contains("rods/2.toml"));
    assert!(!sandbox.read("results/index.html").contains("--force"));
}

#[test]
fn what_was_filled_in_is_not_lost() {
    let sandbox = Sandbox::new();
    let line = "design rig rods/5.toml --r-rod-width-percent 1 --out plan";
    sandbox.run(line).succeeded();
    sandbox.run(line).succeeded();
    let filled_in = sandbox.read("plan/readings.csv").replace("y,", "y, ");
    sandbox.write("plan/readings.csv", &filled_in);
    refused(&sandbox, line, "plan/readings.csv has been changed since rodcal wrote it");
    // another report beside it takes nothing away
    sandbox.run("compliance rods/5.toml --out plan").succeeded();
    assert_eq!(sandbox.read("plan/readings.csv"), filled_in);
    sandbox.run(&format!("{line} --force")).succeeded();
    assert_ne!(sandbox.read("plan/readings.csv"), filled_in);
}

#[test]
fn files_beside_the_page_are_kept_too() {
    let sandbox = Sandbox::new();
    std::fs::create_dir(sandbox.path().join("own")).unwrap();
    for (name, line) in [
        ("own/5-diagnosed.toml", "diagnose rig rods/5.toml soft.csv --apply"),
        ("own/figure-1-waterfall.svg", "compliance rods/5.toml"),
        ("own/design-001.toml", "design rod design.toml"),
    ] {
        let readings = sandbox.read("stiffness_data/5.csv");
        sandbox.write("soft.csv", &readings);
        let design = "[geometry]\nl1_mm = [150]\nl2_mm = [400, 525]\n[catalogue]\nfile = \"builtin\"\n\
            [objectives]\nminimise = [\"c_rod_um\", \"mass_g\"]\n";
        sandbox.write("design.toml", design);
        sandbox.write(name, "mine");
        let error = format!("{name} is there already, and rodcal did not write it");
        refused(&sandbox, &format!("{line} --out own"), &error);
        std::fs::remove_file(sandbox.path().join(name)).unwrap();
    }
}

#[test]
fn a_simulation_replaces_its_own_files_alone() {
    let sandbox = Sandbox::new();
    sandbox.run(SIMULATE).succeeded();
    sandbox.run(&format!("{SIMULATE} --seed 2")).succeeded();
    let campaign = sandbox.read("sim/campaign.toml") + "# base as the tracker says\n";
    sandbox.write("sim/campaign.toml", &campaign);
    refused(&sandbox, SIMULATE, "sim/campaign.toml has been changed since rodcal wrote it");
    sandbox.run(&format!("{SIMULATE} --force")).succeeded();
    assert_ne!(sandbox.read("sim/campaign.toml"), campaign);
    // the rod as it is copied is no loss, another one would be
    sandbox.run("simulate rods --rod rods/5.toml --poses 6 --validation 4").succeeded();
    sandbox.write("rods/rod.toml", "name = \"mine\"\n");
    let line = "simulate rods --rod rods/5.toml --poses 6 --validation 4";
    refused(&sandbox, line, "rods/rod.toml has been changed since rodcal wrote it");
}

#[test]
fn a_trial_its_key_and_its_cases_are_made_once() {
    let sandbox = Sandbox::empty();
    let make = "trial make t --seed 3 --cases 2 --rig";
    let once = |line: &str, error: &str| {
        let hint =
            "hint: take another name: what stands there is written once, and --force does not replace it";
        for force in ["", " --force"] {
            refused_with(&sandbox, &format!("{line}{force}"), error, hint);
        }
    };
    sandbox.write("t.key.jsonl", "mine");
    once(make, "t.key.jsonl is there already");
    std::fs::remove_file(sandbox.path().join("t.key.jsonl")).unwrap();
    std::fs::create_dir(sandbox.path().join("t")).unwrap();
    // an empty directory is no trial
    sandbox.run(make).succeeded();
    once("trial make t --seed 4 --cases 1 --key k", "t/manifest.json is there already");
    once("trial make u --seed 4 --cases 1 --key t.key.jsonl", "t.key.jsonl is there already");
    sandbox.write("elsewhere", "mine");
    std::os::unix::fs::symlink("elsewhere", sandbox.path().join("link")).unwrap();
    once("trial make u --seed 4 --cases 1 --key link", "link is there already");
    for key in ["t/k", "./t/k", "u/../t/k"] {
        let answer = sandbox.run(&format!("trial make t --seed 4 --cases 1 --key {key}"));
        assert!(answer.stderr.contains("which is in the trial's directory"), "{}", answer.stderr);
    }
    // answers are added to answers
    sandbox.write("notes.txt", "mine, without an end");
    let answer = sandbox.run("trial answer t --answers notes.txt");
    assert!(answer.stderr.starts_with("error: notes.txt:1:1: "), "{}", answer.stderr);
    assert_eq!((answer.status, sandbox.read("notes.txt").as_str()), (Some(2), "mine, without an end"));
}

#[test]
fn a_search_goes_on_in_no_file_but_its_own() {
    let sandbox = Sandbox::new();
    let before = sandbox.listing();
    let answer = sandbox.run("design rod examples/design.toml --resume rods/5.toml");
    assert_eq!(answer.status, Some(2), "{}", answer.stderr);
    assert!(answer.stderr.starts_with("error: rods/5.toml"), "{}", answer.stderr);
    assert!(sandbox.listing() == before);
}
