//! What happens where the disk fails, stdout is full or the program is killed: the old files or the
//! new ones, and nothing in between.

use std::collections::BTreeMap;
use std::fs::OpenOptions;

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

/// The fault-injecting writer stands in builds with debug assertions; `crates/base` and
/// `crates/trial` try every operation, a command here some.
#[test]
fn a_fault_leaves_the_old_files_or_the_new_ones() {
    if !cfg!(debug_assertions) {
        return;
    }
    for (line, step) in [
        ("compliance rods/2.toml --out old", 17),
        (SIMULATE, 17),
        ("design rod design.toml --resume kept --out designs", 41),
        ("trial make t --seed 3 --cases 1 --rig", 31),
    ] {
        let words: Vec<&str> = line.split_whitespace().collect();
        let prepared = || {
            let sandbox = Sandbox::empty();
            for name in ["rods/2.toml", "rods/5.toml"] {
                std::fs::create_dir_all(sandbox.path().join("rods")).unwrap();
                let text = std::fs::read(format!("{}/{name}", env!("CARGO_MANIFEST_DIR"))).unwrap();
                std::fs::write(sandbox.path().join(name), text).unwrap();
            }
            let design = "[geometry]\nl1_mm = [150]\nl2_mm = [400, 525]\n[catalogue]\nfile = \"builtin\"\n\
                [objectives]\nminimise = [\"c_rod_um\", \"mass_g\"]\n";
            sandbox.write("design.toml", design);
            if line.contains("old") {
                sandbox.run("compliance rods/5.toml --out old").succeeded();
            }
            sandbox
        };
        let whole = prepared();
        let old = whole.listing();
        whole.run(line).succeeded();
        let new = whole.listing();
        for kind in ["fail", "kill"] {
            for count in (1..).map(|k| 1 + step * k) {
                let sandbox = prepared();
                let fault = format!("{kind} {count}");
                let output = sandbox.command(&words).env("RODCAL_FAULT", &fault).output().unwrap();
                let (status, after) = (output.status.code(), sandbox.listing());
                let stderr = String::from_utf8(output.stderr).unwrap();
                match (kind, status) {
                    (_, Some(0)) => assert!(lasting(after) == new, "{line}, {fault}"),
                    ("fail", Some(2)) => {
                        assert!(
                            stderr.starts_with("error: cannot ") || stderr.contains("error: cannot"),
                            "{stderr}"
                        );
                        // a search is kept to go on from
                        let mut after = after;
                        after.retain(|name, _| name != "kept");
                        assert!(after == old, "{line}, {fault}: {:?}", after.keys());
                    }
                    ("kill", Some(137)) => {
                        let there = lasting(after);
                        let is_either = |set: &BTreeMap<String, Vec<u8>>| {
                            there.iter().all(|(name, bytes)| {
                                name.ends_with('/')
                                    || name == "kept"
                                    || name.starts_with("t.key")
                                    || set.get(name) == Some(bytes)
                            })
                        };
                        assert!(is_either(&old) || is_either(&new), "{line}, {fault}: {:?}", there.keys());
                    }
                    _ => panic!("{line}, {fault}: {status:?} {stderr}"),
                }
                // and the same command ends as if nothing had been
                let is_made_once = line.starts_with("trial") && lasting(sandbox.listing()) == new;
                let again: Answer = sandbox.run(line);
                let expected = if is_made_once { Some(2) } else { Some(0) };
                assert_eq!(again.status, expected, "{line}, {fault}: {}", again.stderr);
                assert!(sandbox.listing() == new, "{line}, {fault}: {:?}", sandbox.listing().keys());
                if status == Some(0) {
                    break;
                }
            }
        }
    }
}
