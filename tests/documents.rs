//! The documents say what the program knows: tables of effects come from the registries.

use std::path::Path;

use rodcal::diagnosis::{calibration, rig};
use rodcal::inference::Effect;

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

/// Also in the tables that people write: what an effect is confused with, and what separates them.
#[test]
fn every_effect_has_its_rivals_and_no_other_is_listed() {
    let text = document("docs/diagnosis.md");
    for (name, effects) in
        [("rivals on a rig", effects_of_a_rig()), ("rivals in a calibration", effects_of_a_calibration())]
    {
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
