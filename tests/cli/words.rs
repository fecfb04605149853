//! What a user reads. A changed word is shown by a failing snapshot: read it as somebody who has
//! never seen the program, and accept it only if it still teaches.

use super::{Sandbox, ran};

/// Compares with `tests/snapshots/NAME.snap`.
pub fn assert_reads(name: &str, text: &str) {
    let mut settings = insta::Settings::clone_current();
    settings.set_snapshot_path("../snapshots");
    settings.set_prepend_module_to_snapshot(false);
    settings.set_omit_expression(true);
    settings.bind(|| insta::assert_snapshot!(name, text));
}

#[test]
fn help_teaches() {
    let sandbox = Sandbox::empty();
    for (name, line) in [
        ("help", "--help"),
        ("help-compliance", "compliance --help"),
        ("help-rig-fit", "rig fit --help"),
        ("help-diagnose-rig", "diagnose rig --help"),
        ("help-calibrate", "calibrate --help"),
        ("help-compare", "compare --help"),
        ("help-simulate", "simulate --help"),
        ("help-trial-make", "trial make --help"),
    ] {
        let answer = sandbox.run(line).succeeded();
        assert_eq!(answer.stderr, "");
        assert_reads(name, &answer.stdout);
    }
}

#[test]
fn results_explain_themselves() {
    for (name, line) in [
        ("compliance", "compliance rods/5.toml"),
        ("rig-fit", "rig fit rods/5.toml stiffness_data/5.csv"),
        ("rig-fit-linear", "rig fit linear stiffness_data/nist-load-cell.csv"),
        ("diagnose-rig", "diagnose rig rods/5.toml stiffness_data/5.csv"),
        ("diagnose-rig-linear", "diagnose rig linear stiffness_data/nist-load-cell.csv"),
        ("demo", "demo"),
    ] {
        let answer = ran(line).answer.clone().succeeded();
        let told = format!("{}\n[stderr]\n{}", answer.stdout, answer.stderr);
        assert_reads(name, &told);
    }
}

/// Only tables may need more, and those say so by their rules.
#[test]
fn words_fit_a_terminal() {
    let sandbox = Sandbox::empty();
    for line in super::REPORTS {
        let answer = ran(line).answer.clone().succeeded();
        // a table is a block of lines, one of which is its rule
        for block in answer.stdout.split("\n\n").filter(|block| !block.contains("──  ──")) {
            let long = block.lines().find(|line| line.chars().count() > 100);
            assert_eq!(long, None, "{line}");
        }
    }
    for line in [
        "--help",
        "compliance --help",
        "rig --help",
        "rig fit --help",
        "diagnose --help",
        "diagnose rig --help",
        "calibrate --help",
        "compare --help",
        "simulate --help",
        "trial --help",
        "trial make --help",
        "trial answer --help",
        "trial score --help",
        "completions --help",
    ] {
        let help = sandbox.run(line).succeeded().stdout;
        assert_eq!(help.lines().find(|line| line.chars().count() > 100), None, "{line}");
    }
}

/// The examples in the help are typed by their readers. Those that README shows too, whatever the
/// name of their report, run in its test.
#[test]
fn the_examples_in_the_help_run() {
    let sandbox = Sandbox::new();
    let readme = include_str!("../../README.md");
    let help = sandbox.run("--help").succeeded().stdout;
    let examples: Vec<&str> = help.lines().filter_map(|line| line.strip_prefix("  rodcal")).collect();
    assert!(examples.len() >= 4, "{examples:?}");
    for example in examples {
        let command = example.split(" --out").next().unwrap_or_default();
        let is_shown =
            |line: &str| line.strip_prefix("rodcal").is_some_and(|shown| shown.starts_with(command));
        if command.is_empty() || !readme.lines().any(is_shown) {
            sandbox.run(example).succeeded();
        }
    }
}

/// So are the files that the help shows.
#[test]
fn the_files_in_the_help_are_good_files() {
    let sandbox = Sandbox::empty();
    let block = |help: &str, start: &str| -> String {
        let lines = help.lines().skip_while(|line| !line.trim().starts_with(start));
        lines.take_while(|line| !line.is_empty()).map(|line| format!("{}\n", line.trim())).collect()
    };
    let rod = block(&sandbox.run("compliance --help").stdout, "name =");
    let (_, pipe) = rod.split_once("[pipe1]").unwrap();
    sandbox.write("rod.toml", &format!("{rod}[pipe2]{pipe}"));
    sandbox.run("compliance rod.toml").succeeded();
    let readings = block(&sandbox.run("rig fit --help").stdout, "axis,");
    sandbox.write("readings.csv", &readings);
    let fit = sandbox.run("rig fit rod.toml readings.csv --json").json();
    assert_eq!(fit["slopes"].as_array().unwrap().len(), 2);
}

#[test]
fn completions_know_the_commands() {
    let sandbox = Sandbox::empty();
    for shell in ["bash", "zsh", "fish", "elvish", "powershell"] {
        let answer = sandbox.run(&format!("completions {shell}")).succeeded();
        assert_eq!(answer.stderr, "");
        for word in ["rodcal", "compliance", "fit", "contact-force", "json"] {
            assert!(answer.stdout.contains(word), "{shell}: {word}");
        }
        let json = sandbox.run(&format!("completions {shell} --json")).json();
        assert_eq!(json["completions"], answer.stdout);
    }
}

/// Of the program and of every command: its name, its options, nothing on stderr.
#[test]
fn man_pages_have_every_command() {
    let sandbox = Sandbox::empty();
    let page = |command: &str| {
        let answer = sandbox.run(&format!("man {command}")).succeeded();
        assert_eq!(answer.stderr, "");
        assert!(answer.stdout.contains(".TH rodcal") && answer.stdout.contains(".SH SYNOPSIS"), "{command}");
        answer.stdout.replace("\\-", "-")
    };
    assert!(page("").contains("rodcal-diagnose(1)") && page("").contains("--json"));
    assert!(page("rig").contains("rodcal-rig-fit(1)"));
    let fit = page("rig fit");
    assert!(fit.contains("rodcal-rig-fit") && fit.contains("--robust") && fit.contains("axis,"), "{fit}");
    for (command, expected) in
        [("man rig fly", "fly, expected one of fit"), ("man rig fit fit", "nothing after fit")]
    {
        let answer = sandbox.run(command);
        assert!(answer.status == Some(2) && answer.stderr.contains(expected), "{}", answer.stderr);
    }
}

#[test]
fn version() {
    let answer = Sandbox::empty().run("--version").succeeded();
    assert_eq!(answer.stdout, format!("rodcal {}\n", env!("CARGO_PKG_VERSION")));
}

#[test]
fn values_may_be_typed_in_capitals() {
    let sandbox = Sandbox::new();
    let [small, large] =
        ["fea", "FEA"].map(|mode| sandbox.run(&format!("compliance rods/5.toml --mode {mode}")));
    assert_eq!(small.succeeded().stdout, large.succeeded().stdout);
}
