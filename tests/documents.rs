//! The documents say what the program knows: tables of effects come from the registries.

#![allow(clippy::unwrap_used)]

use std::collections::BTreeSet;
use std::path::Path;
use std::process::Command;

use rodcal::diagnosis::{calibration, rig};
use rodcal::inference::Effect;
use serde_json::Value;

use crate::cli::{ran, said_in_turn};

fn document(name: &str) -> String {
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join(name);
    std::fs::read_to_string(&path).unwrap_or_else(|e| panic!("{}: {e}", path.display()))
}

fn effects_of_a_rig() -> Vec<&'static Effect> {
    rig::effects::registry::ALL.iter().map(|known| &known.effect).collect()
}

fn effects_of_a_calibration() -> Vec<&'static Effect> {
    calibration::effects::registry::ALL.iter().map(|known| &known.effect).collect()
}

/// A Markdown table of effects, one row for a record.
fn table(effects: &[&Effect]) -> String {
    let mut table = "| effect | kind | what happens | formula | usual size (1 σ) and its source \
                     | what a recording needs |\n|---|---|---|---|---|---|\n"
        .to_owned();
    for effect in effects {
        let cells = [effect.summary, effect.formula, effect.prior, effect.needs];
        let [summary, formula, prior, needs] = cells.map(|cell| cell.replace('|', "\\|"));
        let (name, kind) = (effect.name, effect.kind.name());
        table += &format!("| `{name}` | {kind} | {summary} | {formula} | {prior} | {needs} |\n");
    }
    table
}

/// What stands between `<!-- NAME: generated … -->` and `<!-- end -->`.
fn between_marks<'a>(document: &'a str, name: &str) -> &'a str {
    let start = document.find(&format!("<!-- {name}: generated")).unwrap_or_else(|| panic!("no mark {name}"));
    let rest = &document[start..];
    let (_, rest) = rest.split_once("-->\n").expect("the mark ends");
    rest.split_once("<!-- end -->").expect("the table ends").0
}

#[test]
fn the_tables_of_effects_are_those_of_the_registries() {
    let text = document("docs/diagnosis.md");
    for (name, effects) in [
        ("effects of a rig", effects_of_a_rig()),
        ("mistakes at a rig", rig::effects::registry::MISTAKES.to_vec()),
        ("mistakes in a campaign", calibration::effects::registry::MISTAKES.to_vec()),
        ("effects of a calibration", effects_of_a_calibration()),
    ] {
        let expected = table(&effects);
        assert!(
            between_marks(&text, name).trim() == expected.trim(),
            "docs/diagnosis.md: put this between the marks of \"{name}\":\n\n{expected}"
        );
    }
}

/// Also in the tables that people write: what is tried of a mistake, what an effect is confused
/// with and what separates them.
#[test]
fn the_tables_that_people_write_list_every_effect_and_no_other() {
    let text = document("docs/diagnosis.md");
    for (name, effects) in [
        ("what is tried at a rig", rig::effects::registry::MISTAKES.to_vec()),
        ("rivals on a rig", effects_of_a_rig()),
        ("rivals in a calibration", effects_of_a_calibration()),
    ] {
        let start = text.find(&format!("<!-- {name} -->")).unwrap_or_else(|| panic!("no mark {name}"));
        let table = text[start..].split_once("<!-- end -->").expect("the table ends").0;
        let first_cells = table.lines().filter_map(|line| line.strip_prefix("| `")?.split(" |").next());
        let mut named: Vec<String> =
            first_cells.flat_map(|cell| cell.split(", ")).map(|one| one.replace('`', "")).collect();
        let mut known: Vec<String> = effects.iter().map(|effect| effect.name.to_owned()).collect();
        named.sort_unstable();
        known.sort_unstable();
        assert_eq!(named, known, "docs/diagnosis.md, {name}");
    }
}

/// Name and number of every limit.
#[test]
fn the_page_of_limits_lists_those_of_the_code() {
    let code = document("crates/base/src/limits.rs");
    let constants = code.lines().filter_map(|line| line.strip_prefix("pub const ")?.split_once(": usize = "));
    let stated: Vec<String> = constants
        .map(|(name, number)| format!("| `{name}` | {} |", number.trim_end_matches(';').replace('_', "")))
        .collect();
    let page = document("docs/limits.md");
    let rows: Vec<&str> = page.lines().filter(|line| line.starts_with("| `")).collect();
    assert!(stated.len() > 10 && rows.len() == stated.len(), "{stated:?}");
    for (row, stated) in rows.iter().zip(stated) {
        assert!(row.starts_with(&stated), "{row}: the code has {stated}");
    }
}

/// What a page links within the project: targets of Markdown's links, and of `href` and `src`.
fn linked(page: &str) -> Vec<&str> {
    let between = |start: &str, end: char| -> Vec<&str> {
        page.split(start).skip(1).filter_map(|rest| Some(rest.split_once(end)?.0)).collect()
    };
    let all = [between("](", ')'), between("href=\"", '"'), between("src=\"", '"')].concat();
    let path = |target: &'_ str| target.split('#').next().unwrap_or_default().len();
    let is_file = |target: &&str| !target.contains("://") && !target.contains(['<', ' ', '{']);
    all.into_iter().filter(is_file).map(|target| &target[..path(target)]).filter(|t| !t.is_empty()).collect()
}

#[test]
fn what_is_linked_exists() {
    assert_eq!(linked("[a](b.md#c) <a href=\"#x\"> [d](https://e) <img src=\"f.png\">"), ["b.md", "f.png"]);
    let root = Path::new(env!("CARGO_MANIFEST_DIR"));
    let (mut folders, mut count) = (vec![root.to_owned()], 0);
    while let Some(folder) = folders.pop() {
        for entry in std::fs::read_dir(&folder).unwrap() {
            let path = entry.unwrap().path();
            let name = path.file_name().unwrap_or_default().to_string_lossy().into_owned();
            // what a build or a run leaves behind is not the project's
            let is_made = name == "target" || path == root.join("reports/demo") || name.starts_with('.');
            if path.is_dir() && !is_made {
                folders.push(path);
            } else if name.ends_with(".md") || name.ends_with(".html") {
                let page = std::fs::read_to_string(&path).unwrap();
                for target in linked(&page) {
                    count += 1;
                    assert!(folder.join(target).exists(), "{}: there is no {target}", path.display());
                }
            }
        }
    }
    assert!(count > 100, "{count}");
}

/// Files and folders of the project, by their paths in it.
fn files_of_the_project() -> BTreeSet<String> {
    let root = Path::new(env!("CARGO_MANIFEST_DIR"));
    let (mut folders, mut files) = (vec![root.to_owned()], BTreeSet::new());
    while let Some(folder) = folders.pop() {
        for entry in std::fs::read_dir(&folder).unwrap() {
            let path = entry.unwrap().path();
            let name = path.file_name().unwrap_or_default().to_string_lossy().into_owned();
            if name == "target" || name.starts_with('.') && name != ".ci" {
                continue;
            }
            files.insert(path.strip_prefix(root).unwrap().to_string_lossy().replace('\\', "/"));
            if path.is_dir() {
                folders.push(path);
            }
        }
    }
    files
}

/// What stands between single backticks in the words of a page, code left out.
fn in_backticks(page: &str) -> Vec<&str> {
    let mut is_code = false;
    let words = page.lines().filter(|line| {
        let is_fence = line.trim_start().starts_with("```");
        is_code ^= is_fence;
        !is_code && !is_fence
    });
    words.flat_map(|line| line.split('`').skip(1).step_by(2)).collect()
}

/// Sources by the end of their paths (`mechanics/load_history.rs`), and whatever a path from the
/// root names.
#[test]
fn every_file_that_a_page_names_exists() {
    assert_eq!(in_backticks("a `b` c `d/e.rs`\n```\n`f`\n```\n`g`"), ["b", "d/e.rs", "g"]);
    const ROOTS: [&str; 8] =
        ["src/", "crates/", "tests/", "benches/", "python/", "examples/", "docs/", "stiffness_data/"];
    let files = files_of_the_project();
    let (mut unknown, mut count) = (Vec::new(), 0);
    for page in files.iter().filter(|file| file.ends_with(".md")) {
        for name in in_backticks(&document(page)) {
            let is_source = [".rs", ".py", ".snap"].iter().any(|end| name.ends_with(end));
            let is_path = ROOTS.iter().any(|start| name.starts_with(start));
            if !(is_source || is_path) || name.contains([' ', '*', '{', '<', '…', '#', ':']) {
                continue;
            }
            count += 1;
            let name = name.trim_end_matches('/');
            let is_end = |file: &String| file.strip_suffix(name).is_some_and(|rest| rest.ends_with('/'));
            let is_known = files.contains(name) || !is_path && files.iter().any(is_end);
            if !is_known {
                unknown.push(format!("{page}: {name}"));
            }
        }
    }
    assert!(count > 100 && unknown.is_empty(), "{count} files are named; there is no {unknown:#?}");
}

/// Words of the output that need no glossary.
const PLAIN: &str = "after against aligned alike along aluminium and answer answered asked assumed because before \
     below best better bettered beyond bin block both breaks by calibrated called carbon case \
     change chosen clean column command compensated content coordinate copied corrected count \
     criterion density diameter differ difference distrusted do done draw drawing estimated \
     evaluated everything expected explains failed failure false first folder found frequencies \
     from gamma geometry given headline hidden in index infeasible inner input invented is judged \
     key largest least left less locate looked material maximise meaning met min minimise minute \
     missed more name named not now of ok open option or other outer outside over pair part \
     passes pipe placed program proposed proven quadratic radius ranking ratio reading reason \
     recorded recording refined refused relax remarked rig right rotation second sensitivities \
     share shared shown silent single size source state subcommand supported swing table term \
     testable tested the to tube twice unanswered unknown unseen value wait wanted warning what \
     when where with word worst wrapped wrongly";
/// Units, and what is counted in them.
const UNITS: &str = "deg gpa hz kg mm mpa mrad nm percent rad rpy um urad xyz";

/// Words of two letters and more, without the s of a plural.
fn words(text: &str) -> BTreeSet<String> {
    let all = text.split(|c: char| !c.is_ascii_alphabetic()).filter(|word| word.len() > 1);
    let singular = |word: &str| word.strip_suffix('s').filter(|one| one.len() > 2).unwrap_or(word).to_owned();
    all.map(|word| singular(&word.to_lowercase())).collect()
}

/// The lines above the rule below a table's header, in every table of a text.
fn headers(text: &str) -> String {
    let lines: Vec<&str> = text.lines().collect();
    let is_rule = |line: &str| line.contains("─  ─") && line.chars().all(|c| c == '─' || c == ' ');
    let above = |rule: usize| {
        let start =
            lines[..rule].iter().rposition(|line| line.trim().is_empty()).map_or(0, |blank| blank + 1);
        lines[start..rule].join("\n")
    };
    let rules = (0..lines.len()).filter(|&k| is_rule(lines[k]));
    rules.map(|rule| above(rule) + "\n").collect()
}

/// The names of all numbers of an answer, however deep.
fn keys(value: &Value, all: &mut String) {
    match value {
        Value::Object(fields) => fields.iter().for_each(|(key, inner)| {
            *all += &format!("{key}\n");
            keys(inner, all);
        }),
        Value::Array(items) => items.iter().for_each(|item| keys(item, all)),
        _ => {}
    }
}

#[test]
fn the_glossary_has_every_term_of_the_output() {
    let page = document("docs/glossary.md");
    let rows = || page.lines().filter_map(|line| line.strip_prefix("| ")?.split(" | ").next());
    let once: BTreeSet<&str> = rows().filter(|term| *term != "term").collect();
    assert_eq!(once.len(), rows().filter(|term| *term != "term").count(), "a term stands twice");
    let mut known = words(&once.into_iter().collect::<Vec<_>>().join(" "));
    known.extend(words(PLAIN));
    known.extend(words(UNITS));
    let mut said = String::new();
    let mistakes = rig::effects::registry::MISTAKES.iter().chain(&calibration::effects::registry::MISTAKES);
    for effect in effects_of_a_rig().iter().chain(&effects_of_a_calibration()).chain(mistakes) {
        said += &format!("{}\n", effect.name);
    }
    for line in [
        "diagnose rig rods/5.toml stiffness_data/5.csv",
        "diagnose calibration campaigns/tx90-5/campaign.toml",
        "calibrate campaigns/tx90-5/campaign.toml --mode fea --robust huber --folds 5",
        "rig fit rods/5.toml stiffness_data/5.csv",
        "design rod examples/design.toml",
        "design rig rods/2.toml --between joint_compliance,root_compliance",
        "design poses campaigns/tx90-5/campaign.toml --count 60",
        "compliance rods/5.toml",
        "compare campaigns/tx90-5/campaign.toml --draws 50",
        "compare campaigns/tx90-5/campaign.toml --forecast",
    ] {
        said += &headers(&ran(line).answer.stdout);
        let answer = &ran(&format!("{line} --json")).answer;
        keys(&serde_json::from_str(&answer.stdout).unwrap_or_else(|e| panic!("{line}: {e}")), &mut said);
    }
    for [text, json] in said_in_turn(&[
        "+predict robots/tx90.toml poses.csv",
        "+simulate sim --rod rods/5.toml --poses 6 --validation 4 --force",
        "compliance rods/5.toml --out first",
        "compliance rods/2.toml --out second",
        "+compare-runs first second",
        "trial make sealed --seed 3 --cases 1 --rig",
        "trial answer sealed",
        "+trial score sealed",
    ]) {
        said += &headers(&text);
        keys(&serde_json::from_str(&json).unwrap_or_else(|e| panic!("{json}: {e}")), &mut said);
    }
    let snapshots = Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/snapshots");
    for entry in std::fs::read_dir(snapshots).unwrap() {
        said += &headers(&std::fs::read_to_string(entry.unwrap().path()).unwrap());
    }
    let said = words(&said);
    let unknown: Vec<&String> = said.difference(&known).collect();
    assert!(said.len() > 200 && unknown.is_empty(), "docs/glossary.md has no row for {unknown:?}");
}

#[test]
fn headers_are_the_lines_above_a_rule() {
    assert_eq!(headers("Words\n\na   b\n    mm\n──  ──\n1    2\n"), "a   b\n    mm\n");
}

/// What stands for a commit in a text: seven hexadecimal digits or more, letters among them.
fn commits(text: &str) -> Vec<&str> {
    let words = text.split(|c: char| !(c.is_alphanumeric() || ".-".contains(c)));
    let is_hash = |word: &&str| {
        (7..=40).contains(&word.len())
            && word.bytes().all(|b| b.is_ascii_digit() || (b'a'..=b'f').contains(&b))
            && word.bytes().any(|b| b.is_ascii_digit())
            && word.bytes().any(|b| b.is_ascii_alphabetic())
    };
    words.map(|word| word.trim_matches('.')).filter(is_hash).collect()
}

#[test]
fn commits_are_told_from_numbers_and_seeds() {
    let text = "Of commit 1dafeb0, seed 0xea0bb410b770, J is 4.573634e-5 (`9b67b6f`). Seed 551075276.";
    assert_eq!(commits(text), ["1dafeb0", "9b67b6f"]);
}

/// Nothing is compared where there is no history: in a package, or in a shallow clone.
#[test]
fn every_commit_that_is_quoted_exists() {
    let root = Path::new(env!("CARGO_MANIFEST_DIR"));
    let git = |arguments: &[&str]| Command::new("git").arg("-C").arg(root).args(arguments).output().ok();
    let is_shallow = git(&["rev-parse", "--is-shallow-repository"]);
    if is_shallow.is_none_or(|answer| answer.stdout != b"false\n") || !root.join(".git").exists() {
        return;
    }
    let mut pages: Vec<String> =
        ["README.md", "ARCHITECTURE.md", "CONTRIBUTING.md"].map(str::to_owned).to_vec();
    let mut folders = vec!["docs".to_owned(), "reports".to_owned(), "tests/references".to_owned()];
    while let Some(folder) = folders.pop() {
        for entry in std::fs::read_dir(root.join(&folder)).unwrap().map(Result::unwrap) {
            let name = format!("{folder}/{}", entry.file_name().to_string_lossy());
            match entry.path().is_dir() {
                true => folders.push(name),
                false if name.ends_with(".md") => pages.push(name),
                false => {}
            }
        }
    }
    let mut count = 0;
    for page in pages {
        let text = document(&page);
        for commit in commits(&text) {
            count += 1;
            let answer = git(&["merge-base", "--is-ancestor", commit, "HEAD"]).unwrap();
            assert!(answer.status.success(), "{page}: {commit} is no commit that this one rests on");
        }
    }
    assert!(count > 5, "only {count} commits found: does the test still read them?");
}
