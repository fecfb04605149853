//! README.md and docs/ promise nothing that does not run.

use std::path::Path;

use super::{Sandbox, ran};

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

/// What a command writes by a name that it was given: a folder, a file.
fn written(line: &str) -> Vec<&str> {
    let words: Vec<&str> = line.split_whitespace().collect();
    let first = match words[..] {
        ["simulate", name, ..] | ["trial", "make", name, ..] => Some(name),
        _ => None,
    };
    let options = words.windows(2).filter(|pair| ["--out", "--resume"].contains(&pair[0]));
    first.into_iter().chain(options.map(|pair| pair[1])).collect()
}

/// True where `line` reads what an `earlier` command writes.
fn reads(line: &str, earlier: &str) -> bool {
    let own = written(line);
    let is_inside = |word: &str, name: &str| {
        word.strip_prefix(name).is_some_and(|rest| rest.is_empty() || rest.starts_with('/'))
    };
    let read = || line.split_whitespace().filter(|word| !own.contains(word));
    written(earlier).iter().any(|name| read().any(|word| is_inside(word, name)))
}

#[test]
fn a_command_reads_what_an_earlier_one_writes() {
    assert!(reads("calibrate a/campaign.toml", "simulate a --rod r"));
    assert!(reads("trial answer c", "trial make c --cases 3"));
    assert!(reads("compare-runs reports/x/ reports/y", "calibrate q --out reports/x"));
    assert!(!reads("rig fit r d --out reports/x", "calibrate q --out reports/x"));
    assert!(!reads("compliance reports/xy/r.toml", "calibrate q --out reports/x"));
}

/// What would take minutes runs with less.
const LESS: [(&str, &str); 1] = [("--cases 200", "--cases 2")];

/// Runs every command of a document in its order. One that needs nothing of the others runs once in
/// all tests (`ran`); the others share a directory.
fn run(document: &str) -> usize {
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join(document);
    let text = std::fs::read_to_string(&path).unwrap_or_else(|e| panic!("{document}: {e}"));
    let sandbox = Sandbox::new();
    let mut lines: Vec<String> = Vec::new();
    // examples/regenerate.rs makes the pages of docs/; it is no command of the program
    for synopsis in commands(&text).iter().filter(|line| !line.contains("--example")) {
        let (line, options) = concrete(synopsis);
        if synopsis.contains('[') {
            let words = line.split(' ').skip(1).take_while(|word| word.chars().all(char::is_alphabetic));
            let subcommands: Vec<&str> = words.filter(|word| !["linear", "made"].contains(word)).collect();
            let help = sandbox.run(&format!("{} --help", subcommands.join(" "))).succeeded().stdout;
            for option in options {
                assert!(help.contains(&option), "{document}: {synopsis}: no {option}");
            }
        }
        let line = LESS.iter().fold(line, |line, (whole, less)| line.replace(whole, less));
        lines.extend(line.split(" && ").map(|one| {
            assert!(!one.contains(['|', '>', ';', '$']), "{document}: a shell would read `{one}`");
            one.strip_prefix("rodcal").unwrap_or(one).trim().to_owned()
        }));
    }
    for (k, line) in lines.iter().enumerate() {
        let is_alone = !lines[..k].iter().any(|earlier| reads(line, earlier))
            && !lines[k + 1..].iter().any(|later| reads(later, line));
        let answer = if is_alone { ran(line).answer.clone() } else { sandbox.run(line) };
        assert!(!answer.succeeded().stdout.is_empty(), "{document}: `rodcal {line}` says nothing");
    }
    lines.len()
}

/// The pages of docs/, by their names without `.md`; each is run by one of the tests below.
const GUIDES: [&[&str]; 3] = [
    &["add-an-effect", "calibrate-your-robot", "calibration", "diagnosis", "laws", "rig"],
    &["design", "from-readings-to-compliance", "least-squares", "requirements-to-rod", "simulation"],
    &["gallery", "trial", "why-they-disagree"],
];

fn run_guides(names: &[&str]) -> usize {
    names.iter().map(|name| run(&format!("docs/{name}.md"))).sum()
}

#[test]
fn every_command_of_the_readme_runs() {
    assert!(run("README.md") > 20);
}

#[test]
fn every_command_of_a_kept_report_runs() {
    assert_eq!(run("reports/trial/README.md"), 3);
}

#[test]
fn every_command_about_robots_and_rigs_runs() {
    assert!(run_guides(GUIDES[0]) > 10);
}

#[test]
fn every_command_about_design_runs() {
    assert!(run_guides(GUIDES[1]) > 10);
}

#[test]
fn every_command_of_the_gallery_and_of_trials_runs() {
    assert!(run_guides(GUIDES[2]) > 15);
}

#[test]
fn every_page_with_commands_is_run() {
    let project = Path::new(env!("CARGO_MANIFEST_DIR"));
    for entry in std::fs::read_dir(project.join("docs")).unwrap() {
        let path = entry.unwrap().path();
        let Some(name) = path.file_name().and_then(|name| name.to_str()?.strip_suffix(".md")) else {
            continue;
        };
        let has_commands = !commands(&std::fs::read_to_string(&path).unwrap()).is_empty();
        assert!(!has_commands || GUIDES.concat().contains(&name), "docs/{name}.md: put it into GUIDES");
    }
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

/// The pictures of README.md and of the gallery are what the program draws today. To renew one: run
/// its command with `--out DIR`, then copy the figure.
#[test]
fn the_pictures_in_the_documents_are_current() {
    let sandbox = Sandbox::new();
    for (command, figure, picture) in [
        ("rig fit rods/5.toml stiffness_data/5.csv", "figure-1-load-deflection", "load-deflection-5"),
        ("compliance rods/2.toml", "figure-3-shape-force", "shape-2"),
        ("calibrate campaigns/tx90-5/campaign.toml", "figure-1-error-distribution", "errors-tx90"),
        ("design rod examples/small-arm.toml", "figure-2-to-scale", "designs"),
        ("design rod examples/small-arm.toml", "figure-1-front", "front-small-arm"),
        ("compliance designs/design-012.toml", "figure-5-natural-modes", "modes-small-arm"),
        ("design poses campaigns/tx90-5/campaign.toml --count 60", "figure-1-pose-plan", "pose-plan-tx90"),
        (
            "design poses campaigns/tx90-5/campaign.toml --count 60",
            "figure-3-error-budget",
            "error-budget-tx90",
        ),
    ] {
        sandbox.run(&format!("{command} --out {picture}")).succeeded();
        let shown = Path::new(env!("CARGO_MANIFEST_DIR")).join(format!("docs/pictures/{picture}.svg"));
        assert!(
            sandbox.read(&format!("{picture}/{figure}.svg"))
                == std::fs::read_to_string(&shown).unwrap_or_default(),
            "docs/pictures/{picture}.svg is not what `rodcal {command}` draws"
        );
    }
}
