//! Results on stdout, warnings on stderr, and no offence where nobody listens.

use std::process::Stdio;

use super::{REPORTS, Sandbox, ran};

#[test]
fn warnings_go_to_stderr_and_with_json_also_into_it() {
    for line in REPORTS {
        let plain = ran(line).answer.clone().succeeded();
        let told = plain.warnings();
        assert!(!plain.stdout.contains("warning"), "{line}");
        let answer = ran(&format!("{line} --json")).answer.clone();
        assert_eq!(answer.warnings(), told, "{line}");
        let json = answer.json();
        let inside: Vec<&str> =
            json["warnings"].as_array().unwrap().iter().map(|w| w.as_str().unwrap()).collect();
        assert_eq!(inside, told, "{line}");
    }
}

/// Quiet hides warnings from stderr and from nowhere else, and never an error; verbose says what
/// was read and written. Neither changes the result.
#[test]
fn quiet_and_verbose_change_stderr_alone() {
    let sandbox = Sandbox::new();
    let line = "rig fit rods/2.toml stiffness_data/2.csv --json";
    let plain = sandbox.run(line).succeeded();
    let quiet = sandbox.run(&format!("-q {line}")).succeeded();
    assert!(!plain.stderr.is_empty() && quiet.stderr.is_empty(), "{}", quiet.stderr);
    assert_eq!(quiet.stdout, plain.stdout);
    let verbose = sandbox.run(&format!("{line} -v")).succeeded();
    assert_eq!(verbose.stdout, plain.stdout);
    for words in ["read rods/2.toml, SHA-256 ", "read stiffness_data/2.csv, ", "calculated and rendered in "]
    {
        assert!(verbose.stderr.contains(words), "{}", verbose.stderr);
    }
    let written = sandbox.run("compliance rods/5.toml --out told --verbose").succeeded();
    assert!(written.stderr.contains("wrote told/index.html, "), "{}", written.stderr);
    let page = sandbox.read("told/index.html");
    sandbox.run("-q compliance rods/5.toml --out told").succeeded();
    assert!(sandbox.read("told/index.html") == page);
    let refused = sandbox.run("-q compliance nowhere.toml");
    assert!(refused.stderr.starts_with("error: "), "{}", refused.stderr);
    assert!(sandbox.run("-q -v compliance rods/5.toml").stderr.contains("cannot be used with"));
}

#[test]
fn there_are_warnings_where_there_is_something_to_warn_about() {
    for (line, word) in [
        ("compliance rods/5.toml --mode calc --theory timoshenko", "calc is Euler–Bernoulli by definition"),
        ("rig fit rods/2.toml stiffness_data/2.csv", "beyond the 15.0 N"),
        ("rig fit rods/5.toml stiffness_data/5.csv", "crosses the load axis"),
        ("rig fit linear stiffness_data/nist-load-cell.csv", "not a straight line"),
        ("demo", "are reconstructed"),
    ] {
        let warnings = ran(line).answer.clone().succeeded().warnings();
        assert!(warnings.iter().any(|warning| warning.contains(word)), "{line}: {warnings:?}");
    }
    assert_eq!(ran("compliance rods/5.toml").answer.warnings(), [""; 0]);
}

/// `rodcal … | head -1`: the reader leaves before the end.
#[test]
fn an_early_leaver_is_no_error() {
    let sandbox = Sandbox::new();
    for line in REPORTS.into_iter().chain(["--help", "rig fit --help", "completions zsh", "--version"]) {
        // the demo's JSON goes the way of the others'
        let all: &[&str] = if line == "demo" { &[""] } else { &["", " --json"] };
        for more in all {
            let line = format!("{line}{more}");
            let words: Vec<&str> = line.split_whitespace().collect();
            let mut command = sandbox.command(&words);
            let mut child = command.stdout(Stdio::piped()).stderr(Stdio::piped()).spawn().unwrap();
            drop(child.stdout.take());
            let output = child.wait_with_output().unwrap();
            let stderr = String::from_utf8_lossy(&output.stderr);
            let status = i32::from(line.starts_with("diagnose"));
            assert_eq!(output.status.code(), Some(status), "{line}\n{stderr}");
            assert!(!stderr.contains("panicked") && !stderr.contains("error"), "{line}\n{stderr}");
        }
    }
}

/// `rodcal … 2>&1 | head -1`: neither warnings nor errors have a reader.
#[test]
fn a_closed_stderr_does_not_change_the_exit_status() {
    let sandbox = Sandbox::new();
    for (line, status) in [
        ("rig fit rods/5.toml stiffness_data/5.csv", 0),
        ("demo --json", 0),
        ("diagnose rig rods/5.toml stiffness_data/5.csv", 1),
        ("compliance nowhere.toml", 2),
        ("compliance rods/2.toml --mode calc", 2),
        ("frobnicate", 2),
    ] {
        let words: Vec<&str> = line.split_whitespace().collect();
        let mut command = sandbox.command(&words);
        let mut child = command.stdout(Stdio::piped()).stderr(Stdio::piped()).spawn().unwrap();
        drop(child.stdout.take());
        drop(child.stderr.take());
        assert_eq!(child.wait().unwrap().code(), Some(status), "{line}");
    }
}

#[cfg(target_os = "linux")]
#[test]
fn a_result_that_gets_lost_is_an_error() {
    let sandbox = Sandbox::new();
    let full = std::fs::OpenOptions::new().write(true).open("/dev/full").unwrap();
    let output = sandbox.command(&["compliance", "rods/5.toml"]).stdout(full).output().unwrap();
    assert_eq!(output.status.code(), Some(2));
    let stderr = String::from_utf8_lossy(&output.stderr);
    assert!(stderr.starts_with("error: cannot write stdout: "), "{stderr}");
}

/// The time stands in a report that asks for it, and in no other.
#[test]
fn a_report_has_a_time_where_it_is_asked_for() {
    let sandbox = Sandbox::new();
    let stamped = |line: &str, epoch: &str| {
        let words: Vec<&str> = line.split_whitespace().collect();
        let output = sandbox.command(&words).env("SOURCE_DATE_EPOCH", epoch).output().unwrap();
        (output.status.code(), String::from_utf8(output.stderr).unwrap())
    };
    assert_eq!(stamped("compliance rods/5.toml --stamp --out made", "1767225599").0, Some(0));
    let json: serde_json::Value = serde_json::from_str(&sandbox.read("made/result.json")).unwrap();
    assert_eq!(json["provenance"]["time"], "2025-12-31 23:59:59 UTC");
    assert!(sandbox.read("made/index.html").contains("<dt>time</dt><dd>2025-12-31 23:59:59 UTC</dd>"));
    assert_eq!(stamped("compliance rods/5.toml --out plain", "1767225599").0, Some(0));
    assert!(!sandbox.read("plain/result.json").contains("\"time\""));
    let (status, said) = stamped("compliance rods/5.toml --stamp --out none", "today");
    assert!(status == Some(2) && said.contains("`SOURCE_DATE_EPOCH` is \"today\""), "{said}");
    assert!(!sandbox.path().join("none").exists());
    let idle = sandbox.run("compliance rods/5.toml --stamp").succeeded();
    assert!(idle.stderr.contains("--stamp has no effect without --out"), "{}", idle.stderr);
}
