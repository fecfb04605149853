//! README.md promises nothing that does not run.

use std::path::Path;
use std::process::Stdio;

use super::Sandbox;

/// The commands in the fenced blocks of `markdown`, as they would be typed with `rodcal` on the path.
fn commands(markdown: &str) -> Vec<String> {
    let (mut found, mut fenced) = (Vec::new(), false);
    for line in markdown.replace("\\\n", " ").lines().map(str::trim) {
        if line.starts_with("```") {
            fenced = !fenced;
            continue;
        }
        let typed = line.strip_prefix("$ ").unwrap_or(line);
        let after = |start: &str| typed.strip_prefix(start).filter(|r| r.is_empty() || r.starts_with(' '));
        let rest = match after("cargo run --release") {
            Some(rest) => Some(rest.trim_start().strip_prefix("-- ").unwrap_or(rest)),
            None => after("rodcal"),
        };
        if let Some(rest) = rest.filter(|_| fenced) {
            found.push(format!("rodcal {}", rest.trim()));
        }
    }
    found
}

#[test]
fn commands_are_found_in_both_spellings_and_only_in_blocks() {
    let markdown = "\
rodcal outside
```sh
cargo run --release     # everything
$ cargo run --release -- rig fit \\
    a b
rodcal
rodcal compliance c.toml --json   # a comment
rodcalibrate
cargo run --release-fast
cargo test
```
rodcal outside
";
    let expected = [
        "rodcal # everything",
        "rodcal rig fit      a b",
        "rodcal",
        "rodcal compliance c.toml --json   # a comment",
    ];
    let found: Vec<String> = commands(markdown).iter().map(|line| line.trim().to_owned()).collect();
    assert_eq!(found, expected);
}

/// A shell runs the lines, as it would for their reader: comments, pipes and redirections included.
#[cfg(unix)]
#[test]
fn every_command_of_the_readme_runs() {
    let readme = Path::new(env!("CARGO_MANIFEST_DIR")).join("README.md");
    let text =
        std::fs::read_to_string(readme).expect("README.md is missing: it has to show how rodcal is used");
    let commands = commands(&text);
    assert!(
        !commands.is_empty(),
        "README.md shows no command: expected lines \"rodcal …\" or \"cargo run --release -- …\" in fenced blocks"
    );
    let sandbox = Sandbox::new();
    let program = Path::new(env!("CARGO_BIN_EXE_rodcal")).parent().unwrap();
    let mut path = vec![program.to_owned()];
    path.extend(std::env::split_paths(&std::env::var_os("PATH").unwrap_or_default()));
    for command in commands {
        let output = std::process::Command::new("sh")
            .args(["-c", &command])
            .current_dir(sandbox.path())
            .env("PATH", std::env::join_paths(&path).unwrap())
            .stdin(Stdio::null())
            .output()
            .unwrap();
        let status = output.status.code();
        let may_find = status == Some(1) && command.contains("diagnose");
        assert!(
            status == Some(0) || may_find,
            "README.md: `{command}` ends with {status:?}\n{}",
            String::from_utf8_lossy(&output.stderr)
        );
        assert!(!output.stdout.is_empty(), "README.md: `{command}` says nothing");
    }
}

/// The README's picture is what the program draws today.
/// To renew it: `rodcal rig fit rods/5.toml stiffness_data/5.csv --out DIR`, then copy the first figure.
#[test]
fn the_picture_in_the_readme_is_current() {
    let sandbox = Sandbox::new();
    sandbox.run("rig fit rods/5.toml stiffness_data/5.csv --out report").succeeded();
    let shown = Path::new(env!("CARGO_MANIFEST_DIR")).join("docs/pictures/load-deflection-5.svg");
    assert!(
        sandbox.read("report/figure-1-load-deflection.svg") == std::fs::read_to_string(shown).unwrap(),
        "docs/pictures/load-deflection-5.svg is not what the program draws"
    );
}
