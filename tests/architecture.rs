//! The floors of the house: a file imports only from its own room and from rooms below it
//! (ARCHITECTURE.md).
//!
//! The ground floor is the crate `rodcal-base`, whose rooms have their names in `src` too; trials
//! are the crate `rodcal-trial`, which the compiler keeps apart from everything but the ground.

#![allow(clippy::unwrap_used)]

use std::collections::BTreeSet;
use std::fs;
use std::path::{Path, PathBuf};

use rodcal_trial::effect_name::EffectName;

use crate::circles::tokens;

/// From the ground up. A room is a top-level module with everything under it.
const FLOORS: &[&[&str]] = &[
    // no domain words: crates/base
    &[
        "error",
        "expression",
        "limits",
        "files",
        "units",
        "delimited",
        "toml_text",
        "statistics",
        "parallel",
        "linalg",
        "linear_program",
        "least_squares",
        "optimal_design",
        "dual",
        "spatial",
    ],
    // the engine that knows no physics: nothing but the ground
    &["inference"],
    &["section", "material", "rod"],
    &["beam"],
    &["compliance"],
    &["rig"],
    &["robot"],
    &["calibration"],
    &["design"],
    &["diagnosis"],
    &["report"],
    // what is answered: the same for the command line and for Python
    &["answer"],
    // the library as its users see it
    &["prelude", "lib"],
    &["cli", "main"],
];

/// Where rooms are, and where what conceals effects is.
const ROOMS: [&str; 2] = ["src", "crates/base/src"];
const TRIAL: &str = "crates/trial/src";
const PNG: &str = "crates/png/src";
const PYTHON: &str = "python/src";

/// What only the files whose paths start so may name.
const DOORS: [(&str, &str); 16] = [
    // what conceals effects serves one command, and the library knows nothing of it
    ("rodcal_trial", "src/cli/trial"),
    ("faer", "crates/base/src/linalg"),
    ("plotters", "src/report/plot.rs"),
    // what is written is written whole, and faults can strike there
    ("std::fs", "crates/base/src/files"),
    ("rustix", "crates/base/src/files/disk.rs"),
    ("getrandom", "crates/base/src/statistics/random.rs"),
    ("resvg", "crates/png/src/lib.rs"),
    ("rayon", "crates/base/src/parallel.rs"),
    ("indicatif", "src/cli/progress.rs"),
    ("roxmltree", "src/robot/urdf/"),
    ("sha2", "crates/base/src/files"),
    ("rand", "crates/base/src/statistics/random.rs"),
    ("rand_chacha", "crates/base/src/statistics/random.rs"),
    ("rand_distr", "crates/base/src/statistics/random.rs"),
    ("pyo3", PYTHON),
    ("numpy", PYTHON),
];

/// Position of a room, counted through all floors: rooms on one floor are ordered too.
fn height(room: &str) -> usize {
    let rooms = FLOORS.iter().flat_map(|floor| floor.iter());
    let place = rooms.clone().position(|&known| known == room);
    place.unwrap_or_else(|| {
        panic!("`{room}` is new: give it a floor in tests/architecture.rs and ARCHITECTURE.md")
    })
}

fn sources(directory: &Path) -> Vec<PathBuf> {
    let mut files = Vec::new();
    for entry in fs::read_dir(directory).unwrap() {
        let path = entry.unwrap().path();
        if path.is_dir() {
            files.extend(sources(&path));
        } else if path.extension().is_some_and(|e| e == "rs") {
            files.push(path);
        }
    }
    files.sort();
    files
}

fn root() -> &'static Path {
    Path::new(env!("CARGO_MANIFEST_DIR"))
}

/// A source file: its path inside the project, its room and its text.
struct Source {
    file: String,
    room: String,
    text: String,
}

/// All files below a directory of the project.
fn files(directory: &str) -> Vec<Source> {
    let source = root().join(directory);
    let read = |path: PathBuf| {
        let inside = path.strip_prefix(&source).unwrap();
        let room = inside.iter().next().unwrap().to_str().unwrap().trim_end_matches(".rs").to_owned();
        let file = path.strip_prefix(root()).unwrap().to_str().unwrap().replace('\\', "/");
        Source { file, room, text: fs::read_to_string(&path).unwrap() }
    };
    sources(&source).into_iter().map(read).collect()
}

/// What of a file is no test: all of it before tests at its end, nothing of a file of tests. A line
/// that only names the file of its tests ends nothing.
fn of_the_program<'t>(file: &str, text: &'t str) -> &'t str {
    if file.ends_with("/tests.rs") || file.contains("/tests/") {
        return "";
    }
    text.split("#[cfg(test)]\nmod tests {").next().unwrap()
}

/// The code without the lines that are comments, which may show a name in an example.
fn without_comments(code: &str) -> String {
    code.lines().filter(|line| !line.trim_start().starts_with("//")).collect::<Vec<_>>().join("\n")
}

/// All files of the project's crates.
fn everything() -> Vec<Source> {
    ROOMS.iter().chain(&[TRIAL, PNG, PYTHON]).flat_map(|directory| files(directory)).collect()
}

/// All files that are in a room: the list of rooms at the top of a library is in none.
fn in_rooms() -> Vec<Source> {
    let all = ROOMS.iter().flat_map(|directory| files(directory));
    all.filter(|source| !source.file.ends_with("src/lib.rs")).collect()
}

/// Rooms that a text names: `crate::room::…`, `crate::{room, …}`, `rodcal_base::`, and `rodcal::`
/// in the binary.
fn named_rooms(text: &str) -> Vec<String> {
    let code: String =
        text.lines().map(|line| line.split("//").next().unwrap_or("")).collect::<Vec<_>>().join("\n");
    let is_name = |c: char| c.is_alphanumeric() || c == '_';
    let mut rooms = Vec::new();
    for prefix in ["crate::", "rodcal::", "rodcal_base::"] {
        for (start, _) in code.match_indices(prefix) {
            let rest = &code[start + prefix.len()..];
            if let Some(group) = rest.strip_prefix('{') {
                // only the names directly in this group, not those in groups inside it
                let mut depth = 0;
                let mut name = String::new();
                for c in group.chars() {
                    match c {
                        '{' => depth += 1,
                        '}' if depth == 0 => break,
                        '}' => depth -= 1,
                        _ if depth > 0 => {}
                        ',' => rooms.push(std::mem::take(&mut name)),
                        _ => name.push(c),
                    }
                }
                rooms.push(name);
            } else {
                rooms.push(rest.chars().take_while(|&c| is_name(c)).collect());
            }
        }
    }
    let first_word = |name: &String| name.trim().chars().take_while(|&c| is_name(c)).collect::<String>();
    rooms.iter().map(first_word).filter(|name| name.chars().next().is_some_and(char::is_lowercase)).collect()
}

#[test]
fn nothing_imports_from_above() {
    let mut count = 0;
    for Source { file, room, text } in in_rooms() {
        for named in named_rooms(&text) {
            count += 1;
            assert!(
                height(&named) <= height(&room),
                "{file} is in room `{room}` and imports from `{named}`, which is above it"
            );
        }
    }
    assert!(count > 60, "only {count} imports found: does the test still read them?");
}

/// Packages of this workspace that a package depends on, for its tests too.
fn members_needed(package: &str) -> Vec<String> {
    let manifest = |path: &str| -> toml::Table {
        fs::read_to_string(root().join(path)).unwrap().parse().unwrap_or_else(|e| panic!("{path}: {e}"))
    };
    let workspace = manifest("Cargo.toml");
    let common = workspace["workspace"]["dependencies"].as_table().unwrap();
    let is_member = |name: &str, how: &toml::Value| {
        let is_here = |how: &toml::Value| how.get("path").is_some();
        is_here(how) || common.get(name).is_some_and(is_here)
    };
    let package = manifest(package);
    let tables = ["dependencies", "dev-dependencies", "build-dependencies"];
    let all = tables.iter().filter_map(|table| package.get(*table)?.as_table()).flatten();
    all.filter(|(name, how)| is_member(name, how)).map(|(name, _)| name.clone()).collect()
}

/// What hides effects must not know how they are looked for: a generator that shared physics with
/// the models would prove only that they agree with themselves.
#[test]
fn trials_share_no_model_with_what_they_try() {
    assert_eq!(members_needed("crates/trial/Cargo.toml"), ["rodcal-base"]);
    let mut count = 0;
    for Source { file, text, .. } in files(TRIAL) {
        count += text.matches("rodcal_base::").count();
        // a fit that is shared could hide its own fault
        assert!(
            !named_rooms(&text).iter().any(|room| room == "least_squares"),
            "{file} uses the product's fit"
        );
    }
    assert!(count > 10, "only {count} imports found: does the test still read them?");
}

/// The Python package rests on the library alone, and nobody who builds the library compiles it.
#[test]
fn python_costs_rust_nothing() {
    assert_eq!(members_needed("python/Cargo.toml"), ["rodcal"]);
    let workspace: toml::Table = fs::read_to_string(root().join("Cargo.toml")).unwrap().parse().unwrap();
    let of_key = |key: &str| workspace["workspace"][key].as_array().unwrap();
    assert!(of_key("members").iter().any(|member| member.as_str() == Some("python")));
    assert!(of_key("default-members").iter().all(|member| member.as_str() != Some("python")));
    for package in
        ["Cargo.toml", "crates/base/Cargo.toml", "crates/trial/Cargo.toml", "crates/png/Cargo.toml"]
    {
        assert!(!members_needed(package).iter().any(|name| name == "rodcal-python"), "{package}");
    }
}

#[test]
fn the_ground_stands_on_nothing() {
    assert_eq!(members_needed("crates/base/Cargo.toml"), [""; 0]);
}

/// Words of rigs and robots, of which the engine has none outside its lists of places and
/// variables.
const PHYSICS: [&str; 24] = [
    "friction",
    "backlash",
    "gear",
    "clamp",
    "slide",
    "creep",
    "slip",
    "encoder",
    "torque",
    "gravity",
    "stiffness",
    "compliance",
    "elastic",
    "thermal",
    "tilt",
    "payload",
    "socket",
    "hanger",
    "sleeve",
    "modulus",
    "deflection",
    "inertia",
    "bearing",
    "wrist",
];

/// The engine copies records of effects and places into findings and looks into neither. A law may
/// have the shape of a loop (`law/bouc_wen.rs`): that is a form as an exponential is one, and what
/// it is a law of is not known there.
#[test]
fn inference_knows_no_physics() {
    let mut count = 0;
    for Source { file, text, .. } in files("src").into_iter().filter(|source| source.room == "inference") {
        for named in named_rooms(&text) {
            count += 1;
            assert!(
                FLOORS[0].contains(&named.as_str()) || named == "inference",
                "{file} imports from `{named}`"
            );
        }
        let code = of_the_program(&file, &text);
        let is_vocabulary = ["location.rs", "variable.rs"].iter().any(|own| file.ends_with(own));
        for word in PHYSICS {
            let is_said = code
                .lines()
                .map(|line| line.replace(".clamp(", "").to_lowercase())
                .any(|line| !line.trim_start().starts_with("//") && line.contains(word));
            assert!(is_vocabulary || !is_said, "{file} speaks of {word}");
        }
    }
    assert!(count > 10, "only {count} imports found: does the test still read them?");
}

/// Names of all effects and mistakes that a diagnosis has.
fn names_of_effects() -> Vec<&'static str> {
    use rodcal::diagnosis::{calibration, rig};
    let of_rig = rig::effects::registry::ALL.iter().map(|known| known.effect.name);
    let of_calibration = calibration::effects::registry::ALL.iter().map(|known| known.effect.name);
    let mistakes = rig::effects::registry::MISTAKES.iter().chain(&calibration::effects::registry::MISTAKES);
    let names: Vec<&str> = of_rig.chain(of_calibration).chain(mistakes.map(|mistake| mistake.name)).collect();
    assert!(names.len() > 60);
    names
}

/// Outside the registries an effect is a value: nothing compares its name.
#[test]
fn no_effect_is_compared_by_its_name() {
    let names = names_of_effects();
    let is_asked = |file: &str| file.contains("diagnosis") || file.contains("inference");
    for Source { file, text, .. } in files("src").into_iter().filter(|source| is_asked(&source.file)) {
        let code = without_comments(of_the_program(&file, &text));
        let is_family = file.contains("/effects/") || file.contains("/tests");
        for name in &names {
            let literal = format!("\"{name}\"");
            assert!(is_family || !code.contains(&literal), "{file} names {literal}");
        }
    }
}

/// What conceals effects has a registry of its own: it must not know the library.
#[test]
fn a_trial_names_effects_in_its_registry_alone() {
    let library = names_of_effects();
    let own: Vec<&str> = EffectName::ALL.iter().map(EffectName::as_str).collect();
    for name in own.iter().filter(|name| name.contains('_')) {
        assert!(library.contains(name), "no diagnosis knows {name}");
    }
    let names: BTreeSet<&str> = library.iter().chain(&own).copied().collect();
    for Source { file, text, .. } in files(TRIAL) {
        let code = of_the_program(&file, &text);
        for name in &names {
            let literal = format!("\"{name}\"");
            let is_registry = file.ends_with("/effect_name.rs");
            assert!(is_registry || !code.contains(&literal), "{file} names {literal}");
        }
    }
}

/// `of(x)` says nothing of what comes out: only what stands behind its type, as `Rate::of`, may be
/// called so.
#[test]
fn nothing_is_called_of() {
    for Source { file, text, .. } in everything() {
        let tokens = tokens(&text);
        let before = |k: usize| k.checked_sub(1).map_or("", |k| tokens[k].as_str());
        for k in (0..tokens.len()).filter(|&k| tokens[k] == "of") {
            let near = tokens[k.saturating_sub(5)..tokens.len().min(k + 5)].join(" ");
            assert!(["::", ".", "fn"].contains(&before(k)), "{file}: {near}");
        }
    }
}

#[test]
fn every_room_in_the_plan_exists() {
    let rooms: Vec<String> =
        ROOMS.iter().flat_map(|directory| files(directory)).map(|source| source.room).collect();
    for room in FLOORS.iter().flat_map(|floor| floor.iter()) {
        assert!(rooms.iter().any(|r| r == room), "`{room}` is in the plan and not in the project");
    }
    for room in FLOORS[0] {
        let is_there = root().join(format!("crates/base/src/{room}.rs")).exists();
        assert!(is_there, "`{room}` is on the ground and not in crates/base");
    }
}

#[test]
fn heavy_dependencies_have_one_door_each() {
    for Source { file, text, .. } in everything() {
        let code = of_the_program(&file, &text);
        for (name, door) in DOORS {
            let uses = code
                .lines()
                .any(|line| !line.trim_start().starts_with("//") && line.contains(&format!("{name}::")));
            assert!(!uses || file.starts_with(door), "{file} names {name}; only {door} may");
        }
    }
}

#[test]
fn the_libraries_never_print() {
    for Source { file, room, text } in everything() {
        if file.starts_with("src/") && ["cli", "main"].contains(&room.as_str()) {
            continue;
        }
        for print in ["println!", "eprintln!", "print!(", "dbg!"] {
            assert!(!text.contains(print), "{file} contains {print}");
        }
    }
}

/// Rooms whose fronts give functions to a user: what they re-export, by their files. The prelude
/// has its own from them.
const FRONTS: [&str; 13] = [
    "answer",
    "beam",
    "calibration",
    "calibration/simulate",
    "compliance",
    "design",
    "diagnosis/calibration",
    "diagnosis/rig",
    "diagnosis/rig/measurements/planned",
    "inference",
    "report/html",
    "rig",
    "robot",
];
/// Functions of these fronts that take what only a finished diagnosis makes, or what only an engine
/// of one's own would: their tests are their examples.
const WITHOUT_EXAMPLE: [&str; 6] = ["law_destination", "minutes", "products", "ranking", "remark", "sketch"];

/// The functions that a file re-exports, each with the module that it is from: lower-case names of
/// its `pub use`.
fn functions_given(text: &str) -> BTreeSet<(String, String)> {
    let given = text.split("\npub use ").skip(1).filter_map(|rest| Some(rest.split_once(';')?.0));
    let parts = given.filter_map(|path| match path.split_once('{') {
        Some((module, names)) => Some((module.trim_end_matches("::"), names.trim_end_matches('}'))),
        None => path.rsplit_once("::"),
    });
    let all = parts.flat_map(|(path, names)| {
        let module = path.rsplit("::").next().unwrap_or_default().to_owned();
        names.split(',').map(move |name| (module.clone(), name.trim().to_owned()))
    });
    all.filter(|(_, name)| name.starts_with(|c: char| c.is_ascii_lowercase())).collect()
}

#[test]
fn what_a_room_gives_is_read_with_where_it_is_from() {
    let text = "mod a;\npub use a::b::{C, d};\npub use e::f;\nuse g::h;\n";
    let found = functions_given(text);
    let pairs: Vec<(&str, &str)> =
        found.iter().map(|(module, name)| (module.as_str(), name.as_str())).collect();
    assert_eq!(pairs, [("b", "d"), ("e", "f")]);
}

/// The documentation above each function that stands at the margin of a file.
fn documented_functions(text: &str) -> Vec<(String, String)> {
    let lines: Vec<&str> = text.lines().collect();
    let starts = (0..lines.len()).filter(|&k| lines[k].starts_with("pub fn "));
    let described = |k: usize| {
        let name = lines[k]["pub fn ".len()..].split(['(', '<']).next().unwrap().to_owned();
        let above =
            lines[..k].iter().rev().take_while(|line| line.starts_with("///") || line.starts_with("#["));
        (name, above.copied().collect::<Vec<_>>().into_iter().rev().collect::<Vec<_>>().join("\n"))
    };
    starts.map(described).collect()
}

#[test]
fn every_function_for_users_has_an_example_that_asserts() {
    let sources: Vec<Source> = files("src");
    let (mut lacking, mut count) = (Vec::new(), 0);
    for front in FRONTS {
        let own = |source: &&Source| source.file == format!("src/{front}.rs");
        let text = &sources.iter().find(own).unwrap_or_else(|| panic!("there is no {front}")).text;
        let given = functions_given(text);
        let inside =
            |file: &str| file.starts_with(&format!("src/{front}/")) || file == format!("src/{front}.rs");
        for Source { file, text, .. } in sources.iter().filter(|source| inside(&source.file)) {
            // a file's own functions are given by it alone
            let is_front = *file == format!("src/{front}.rs");
            let module = file.trim_end_matches(".rs").rsplit('/').next().unwrap_or_default();
            for (name, above) in documented_functions(text) {
                let is_given = is_front || given.contains(&(module.to_owned(), name.clone()));
                if !is_given || WITHOUT_EXAMPLE.contains(&name.as_str()) {
                    continue;
                }
                count += 1;
                if !(above.contains("/// ```\n") && above.contains("assert")) {
                    lacking.push(format!("{file}: {name}"));
                }
            }
        }
    }
    assert!(count > 60, "only {count} functions found: does the test still read them?");
    assert!(lacking.is_empty(), "no example that asserts something: {lacking:#?}");
}

/// Columns that a line of words has at most; tables, equations and code take what they need.
const WIDTH: usize = 100;

#[test]
fn comments_are_no_wider_than_a_page() {
    let mut wide = Vec::new();
    for Source { file, text, .. } in everything().into_iter().chain(files("tests")) {
        let mut is_code = false;
        for (number, line) in text.lines().enumerate() {
            let Some(words) = line.trim_start().strip_prefix("//") else { continue };
            let words = words.trim_start_matches(['/', '!']);
            is_code ^= words.trim_start().starts_with("```");
            let is_words = !words.contains("   ") && !words.trim_start().starts_with('|');
            let is_wide = line.chars().count() > WIDTH && words.trim().contains(' ');
            if is_wide && is_words && !is_code {
                wide.push(format!("{file}:{}: {line}", number + 1));
            }
        }
    }
    assert!(wide.is_empty(), "{wide:#?}");
}

#[test]
fn imports_are_read_in_all_their_forms() {
    let text = "use crate::beam::Chain;\nuse crate::{rod::Rod, units::{MM, UM}};\n// crate::report\nlet x = crate::rig::fit(); use crate::Error;";
    assert_eq!(named_rooms(text), ["beam", "rod", "units", "rig"]);
}
