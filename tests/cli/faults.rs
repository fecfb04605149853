//! What happens where the disk fails, stdout is full or the program is killed: the old files or the
//! new ones, and nothing in between.

use std::collections::BTreeMap;
use std::fs::OpenOptions;

use rodcal_base::files::faults::IN_ENVIRONMENT;

use super::{Answer, Sandbox};

const SIMULATE: &str = "simulate new/sim --rod rods/5.toml --poses 6 --validation 4";

#[cfg(target_os = "linux")]
#[test]
fn nothing_is_left_where_nothing_can_be_said() {
    let sandbox = Sandbox::new();
    sandbox.run("compliance rods/5.toml --out old").succeeded();
    let before = sandbox.listing();
    for line in [
        "compliance rods/2.toml --out new/report",
        "compliance rods/2.toml --out old",
        "compliance rods/2.toml --out old --json",
        "rig fit rods/5.toml stiffness_data/5.csv --out .",
        SIMULATE,
        "trial make new/t --seed 3 --cases 1 --rig",
    ] {
        let words: Vec<&str> = line.split_whitespace().collect();
        let full = OpenOptions::new().write(true).open("/dev/full").unwrap();
        let output = sandbox.command(&words).stdout(full).output().unwrap();
        let stderr = String::from_utf8(output.stderr).unwrap();
        assert_eq!(output.status.code(), Some(2), "{line}");
        assert!(stderr.contains("error: cannot write stdout: No space left"), "{line}: {stderr}");
        let after = sandbox.listing();
        assert!(
            after == before,
            "{line}: {:?}",
            after.keys().filter(|k| !before.contains_key(*k)).collect::<Vec<_>>()
        );
    }
}

/// Without what is only there until the next run.
fn lasting(mut listing: BTreeMap<String, Vec<u8>>) -> BTreeMap<String, Vec<u8>> {
    listing.retain(|name, _| !name.contains(".rodcal-") && !name.contains(".part"));
    listing
}

/// What stands there before: rods, a robot, a campaign, poses, a small search and an old report.
fn prepared(line: &str) -> Sandbox {
    let sandbox = Sandbox::new();
    let design = "[geometry]\nl1_mm = [150]\nl2_mm = [400, 525]\n[catalogue]\nfile = \"builtin\"\n\
        [objectives]\nminimise = [\"c_rod_um\", \"mass_g\"]\n";
    sandbox.write("design.toml", design);
    sandbox.write("poses.csv", "pose,q1_deg,q2_deg,q3_deg,q4_deg,q5_deg,q6_deg\n1,0,10,80,5,6,7\n");
    sandbox.run("compliance rods/5.toml --out old").succeeded();
    sandbox.run("compliance rods/2.toml --out older").succeeded();
    // what is written counts here, and not of how many poses
    sandbox.run("simulate small --rod rods/5.toml --poses 7 --validation 4").succeeded();
    if line.contains("sealed") {
        sandbox.run("trial make sealed --seed 3 --cases 1 --rig").succeeded();
    }
    if line.contains("trial score") {
        sandbox.run("trial answer sealed").succeeded();
    }
    sandbox
}

/// Files in which a long run keeps what it has, to go on from.
const KEPT: [&str; 2] = ["kept", "sealed/answers.jsonl"];

/// Commands that write. With each, operations of the disk that are struck.
const WRITING: [(&str, &[usize]); 15] = [
    ("compliance rods/2.toml --out old", &[1, 2, 5, 18, 35]),
    (SIMULATE, &[1, 3, 7, 18]),
    ("design rod design.toml --resume kept --out designs", &[1, 2, 4, 9, 42]),
    ("trial make t --seed 3 --cases 1 --rig", &[1, 2, 6, 32]),
    ("rig fit rods/5.toml stiffness_data/5.csv --out old", &[1, 4, 21]),
    ("calibrate small/campaign.toml --out old", &[2, 22]),
    ("predict robots/tx90.toml poses.csv --out new/tips", &[1, 2, 8]),
    ("design rig rods/5.toml --r-rod-width-percent 1 --out old", &[3, 11]),
    ("design poses campaigns/tx90-5/campaign.toml --count 20 --generate 60 --out old", &[2, 12]),
    ("diagnose rig rods/5.toml stiffness_data/5.csv --apply --out old", &[5, 27]),
    ("compare-runs old older --out runs", &[1, 9]),
    ("compare small/campaign.toml --draws 50 --out old", &[1, 14]),
    ("diagnose calibration small/campaign.toml --apply --out old", &[3, 19]),
    ("trial answer sealed", &[1, 2]),
    ("trial score sealed --out old", &[2, 13]),
];

/// Builds that tests are made in read faults from the environment; `crates/base` and `crates/trial`
/// try every operation, commands here some, and every third in `.ci/run`.
#[test]
fn a_fault_leaves_the_old_files_or_the_new_ones() {
    if !IN_ENVIRONMENT {
        assert!(!env!("CARGO_BIN_EXE_rodcal").contains("debug"), "tests are made in a build without faults");
        return;
    }
    std::thread::scope(|scope| {
        for (line, counts) in WRITING {
            scope.spawn(move || struck(line, counts));
        }
    });
}

/// So many runs in a row that no fault stops are those behind the last operation: what is swept may
/// fail without a word.
const BEHIND: usize = 4;

/// A command whose disk fails, or that is killed, at these operations in turn; with
/// `RODCAL_FAULTS=1` both at each that it has, with 3 at every third.
fn struck(line: &str, counts: &[usize]) {
    let step = std::env::var("RODCAL_FAULTS").ok().and_then(|step| step.parse::<usize>().ok());
    let all: Vec<usize> = step.map_or_else(Vec::new, |step| (1..200).step_by(step.max(1)).collect());
    let counts = if step.is_some() { &all } else { counts };
    let words: Vec<&str> = line.split_whitespace().collect();
    let first = prepared(line);
    let (whole, old) = (first.copied(), first.listing());
    whole.run(line).succeeded();
    let new = whole.listing();
    let mut unstruck = 0;
    let every_other = |kind: &str, k: usize| step.is_some() || k.is_multiple_of(2) == (kind == "fail");
    let strikes = ["fail", "kill"].into_iter().flat_map(|kind| {
        let own = counts.iter().enumerate().filter(move |(k, _)| every_other(kind, *k));
        own.map(move |(_, count)| (kind, count))
    });
    for (kind, count) in strikes {
        // from the first operation on for either kind
        unstruck = if *count == 1 { 0 } else { unstruck };
        if step.is_some() && unstruck >= BEHIND {
            continue;
        }
        let sandbox = first.copied();
        let fault = format!("{kind} {count}");
        let output = sandbox.command(&words).env("RODCAL_FAULT", &fault).output().unwrap();
        let (status, mut after) = (output.status.code(), sandbox.listing());
        let stderr = String::from_utf8(output.stderr).unwrap();
        unstruck = if matches!(status, Some(0 | 1)) { unstruck + 1 } else { 0 };
        match (kind, status) {
            ("fail", Some(2)) => {
                assert!(stderr.contains("error: cannot "), "{line}, {fault}: {stderr}");
                // a search is kept to go on from
                after.retain(|name, _| !KEPT.contains(&name.as_str()));
                let mut old = old.clone();
                old.retain(|name, _| !KEPT.contains(&name.as_str()));
                assert!(after == old, "{line}, {fault}: {:?}", after.keys());
            }
            ("kill", Some(137)) => {
                let there = lasting(after);
                let is_either = |set: &BTreeMap<String, Vec<u8>>| {
                    there.iter().all(|(name, bytes)| {
                        name.ends_with('/')
                            || KEPT.contains(&name.as_str())
                            || name.starts_with("t.key")
                            || set.get(name) == Some(bytes)
                    })
                };
                assert!(is_either(&old) || is_either(&new), "{line}, {fault}: {:?}", there.keys());
            }
            // fewer operations than that, or what is swept in the end: it may stay until the next
            // time
            (_, Some(0 | 1)) => assert!(lasting(after) == new, "{line}, {fault}"),
            _ => panic!("{line}, {fault}: {status:?} {stderr}"),
        }
        // and the same command ends as if nothing had been
        let is_made_once = line.starts_with("trial make") && lasting(sandbox.listing()) == new;
        let again: Answer = sandbox.run(line);
        match is_made_once {
            true => assert_eq!(again.status, Some(2), "{line}, {fault}"),
            false => drop(again.succeeded()),
        }
        assert!(sandbox.listing() == new, "{line}, {fault}: {:?}", sandbox.listing().keys());
    }
}
