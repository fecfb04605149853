//! README.md and docs/ promise nothing that does not run.

use std::path::Path;
use std::process::Stdio;

use super::Sandbox;

/// The commands in the fenced blocks of `markdown`, as they would be typed with `rodcal` on the
/// path.
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

/// What stands for a user's own files in the synopses of docs/, with the files that a test has
/// instead.
const PLACEHOLDERS: [(&str, &str); 12] = [
    ("[--cases N]", "--cases 2"),
    ("[--draws N]", "--draws 50"),
    ("ROD", "rods/5.toml"),
    ("READINGS", "stiffness_data/5.csv"),
    ("CAMPAIGN", "campaigns/tx90-5/campaign.toml"),
    ("DIR", "made-here"),
    ("MODEL", "robots/tx90.toml"),
    ("POSES", "poses.csv"),
    ("KEY", "made-here.key.jsonl"),
    ("S", "7"),
    ("N", "7"),
    ("…", ""),
];

/// A synopsis without its options, for the test's files; and the options that it names.
fn concrete(synopsis: &str) -> (String, Vec<String>) {
    let synopsis = synopsis.split(" #").next().unwrap_or_default();
    let options = synopsis.split(|c: char| c.is_whitespace() || c == '[' || c == ']');
    let options = options.filter(|word| word.starts_with("--")).map(str::to_owned).collect();
    let mut line = synopsis.to_owned();
    for (placeholder, file) in PLACEHOLDERS.iter().take(2) {
        line = line.replace(placeholder, file);
    }
    let mut required = String::new();
    let mut depth = 0;
    for letter in line.chars() {
        depth += i32::from(letter == '[');
        if depth == 0 {
            required.push(letter);
        }
        depth -= i32::from(letter == ']');
    }
    let own = |word: &str| -> String {
        let known = PLACEHOLDERS.iter().find(|(placeholder, _)| *placeholder == word);
        known.map_or(word, |(_, file)| *file).to_owned()
    };
    (required.split_whitespace().map(own).collect::<Vec<_>>().join(" "), options)
}

#[test]
fn a_synopsis_becomes_a_command() {
    let (line, options) = concrete("rodcal rig fit ROD READINGS [--robust huber|tukey] [--json]  # words");
    assert_eq!(line, "rodcal rig fit rods/5.toml stiffness_data/5.csv");
    assert_eq!(options, ["--robust", "--json"]);
}

/// Whether one of `commands` reads what `line` writes with `--out`.
fn is_read_by(line: &str, commands: &[String]) -> bool {
    let directory = line.split(" --out ").nth(1).and_then(|rest| rest.split_whitespace().next());
    directory.is_some_and(|name| commands.iter().any(|command| command.contains(&format!("{name}/"))))
}

/// Every synopsis and every command of docs/ runs, and every option that one names exists. What the
/// README runs on the same files is not run again, unless a command further down reads what it
/// writes.
#[test]
fn every_command_of_the_docs_runs() {
    let project = Path::new(env!("CARGO_MANIFEST_DIR"));
    let of_name = |name: &Path| commands(&std::fs::read_to_string(name).unwrap());
    let of_readme = of_name(&project.join("README.md"));
    let mut documents: Vec<_> =
        std::fs::read_dir(project.join("docs")).unwrap().map(|entry| entry.unwrap().path()).collect();
    documents.retain(|path| path.extension().is_some_and(|extension| extension == "md"));
    documents.sort();
    let mut ran = 0;
    for document in documents {
        let sandbox = Sandbox::new();
        let typed = of_name(&document);
        for (synopsis, following) in typed.iter().zip(1..) {
            // examples/regenerate.rs makes the pages of docs/; it is no command of the program
            if synopsis.contains("--example") {
                continue;
            }
            let (line, options) = concrete(synopsis);
            let words = line.strip_prefix("rodcal").unwrap_or_default().trim();
            let subcommands = words.split(' ').take_while(|word| word.chars().all(char::is_alphabetic));
            let subcommands: Vec<&str> =
                subcommands.filter(|word| !["linear", "made"].contains(word)).collect();
            let help = sandbox.run(&format!("{} --help", subcommands.join(" "))).succeeded().stdout;
            for option in options {
                assert!(help.contains(&option), "{}: {synopsis}: no {option}", document.display());
            }
            let base = line.split(" --").next().unwrap_or_default();
            let again = of_readme.iter().any(|command| command.starts_with(base));
            if again && !is_read_by(&line, &typed[following..]) {
                continue;
            }
            sandbox.run(words).succeeded();
            ran += 1;
        }
    }
    assert!(ran >= 4, "docs/ show {ran} commands only");
}

/// The answers that the guides quote are what the program says today: the first two sentences of
/// each.
#[test]
fn the_answers_in_the_guides_are_current() {
    let guide = |name: &str| {
        let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("docs").join(name);
        std::fs::read_to_string(path)
            .unwrap()
            .replace("\n> ", " ")
            .split_whitespace()
            .collect::<Vec<_>>()
            .join(" ")
    };
    let sandbox = Sandbox::new();
    sandbox
        .run("simulate my-robot --rod rods/5.toml --robot robots/six-axis.urdf --poses 12 --validation 30")
        .succeeded();
    for (name, command) in [
        ("why-they-disagree.md", "diagnose rig linear stiffness_data/nist-load-cell.csv"),
        ("why-they-disagree.md", "diagnose rig rods/5.toml stiffness_data/5.csv"),
        ("../README.md", "diagnose rig rods/5.toml stiffness_data/5.csv"),
        ("from-readings-to-compliance.md", "rig fit rods/5.toml stiffness_data/5.csv"),
        ("calibrate-your-robot.md", "calibrate my-robot/campaign.toml --folds 5"),
        ("calibrate-your-robot.md", "diagnose calibration my-robot/campaign.toml"),
    ] {
        let answer = sandbox.run(command).succeeded().stdout;
        let headline = answer.split("\n\n").next().unwrap().split_whitespace().collect::<Vec<_>>().join(" ");
        // the guide leaves out whose answer it is
        let headline = headline.strip_prefix("six-axis, rod 5# compensated (meas): ").unwrap_or(&headline);
        for sentence in headline.split(". ").take(2) {
            assert!(guide(name).contains(sentence), "docs/{name} does not quote: {sentence}");
        }
    }
}

/// The README's picture is what the program draws today. To renew it: `rodcal rig fit rods/5.toml
/// stiffness_data/5.csv --out DIR`, then copy the first figure.
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
