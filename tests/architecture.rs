//! The floors of the house: a file imports only from its own room and from rooms below it (ARCHITECTURE.md).

#![allow(clippy::unwrap_used)]

use std::fs;
use std::path::{Path, PathBuf};

/// From the ground up. A room is a top-level module with everything under it.
const FLOORS: [&[&str]; 12] = [
    // no domain words
    &[
        "error",
        "files",
        "units",
        "delimited",
        "toml_text",
        "linalg",
        "statistics",
        "parallel",
        "least_squares",
        "spatial",
    ],
    &["section", "material", "rod"],
    &["beam"],
    &["compliance"],
    &["rig"],
    &["robot"],
    &["calibration"],
    &["diagnosis"],
    &["trial"],
    &["report"],
    // the library as its users see it
    &["prelude", "lib"],
    &["cli", "main"],
];

/// What only one file, or one folder, may name.
const DOORS: [(&str, &str); 11] = [
    ("faer", "src/linalg.rs"),
    ("plotters", "src/report/plot.rs"),
    ("std::fs", "src/files.rs"),
    ("resvg", "src/report/png.rs"),
    ("rayon", "src/parallel.rs"),
    ("indicatif", "src/cli/progress.rs"),
    ("roxmltree", "src/robot/urdf/"),
    ("sha2", "src/trial/envelope.rs"),
    ("rand", "src/statistics/random.rs"),
    ("rand_chacha", "src/statistics/random.rs"),
    ("rand_distr", "src/statistics/random.rs"),
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

/// Every source file with its path inside the project and its room.
fn files() -> Vec<(String, String, String)> {
    let root = Path::new(env!("CARGO_MANIFEST_DIR"));
    let source = root.join("src");
    sources(&source)
        .into_iter()
        .map(|path| {
            let inside = path.strip_prefix(&source).unwrap();
            let room = inside.iter().next().unwrap().to_str().unwrap().trim_end_matches(".rs").to_owned();
            let name = path.strip_prefix(root).unwrap().to_str().unwrap().replace('\\', "/");
            (name, room, fs::read_to_string(&path).unwrap())
        })
        .collect()
}

/// Rooms that a text names: `crate::room::…`, `crate::{room, …}`, and `rodcal::` in the binary.
fn named_rooms(text: &str) -> Vec<String> {
    let code: String =
        text.lines().map(|line| line.split("//").next().unwrap_or("")).collect::<Vec<_>>().join("\n");
    let is_name = |c: char| c.is_alphanumeric() || c == '_';
    let mut rooms = Vec::new();
    for prefix in ["crate::", "rodcal::"] {
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
    for (file, room, text) in files() {
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

/// What hides effects must not know how they are looked for: a generator that shared physics with the models would prove
/// only that they agree with themselves.
#[test]
fn trials_share_no_model_with_what_they_try() {
    // a fit that is shared could hide its own fault
    let is_shared = |room: &str| room == "trial" || (FLOORS[0].contains(&room) && room != "least_squares");
    let mut count = 0;
    for (file, _, text) in files().into_iter().filter(|(_, room, _)| room == "trial") {
        for named in named_rooms(&text) {
            count += 1;
            assert!(is_shared(&named), "{file} imports from `{named}`");
        }
    }
    assert!(count > 10, "only {count} imports found: does the test still read them?");
}

#[test]
fn every_room_in_the_plan_exists() {
    let rooms: Vec<String> = files().into_iter().map(|(_, room, _)| room).collect();
    for room in FLOORS.iter().flat_map(|floor| floor.iter()) {
        assert!(rooms.iter().any(|r| r == room), "`{room}` is in the plan and not in src");
    }
}

#[test]
fn heavy_dependencies_have_one_door_each() {
    for (file, _, text) in files() {
        let code = text.split("#[cfg(test)]").next().unwrap();
        for (name, door) in DOORS {
            let uses = code
                .lines()
                .any(|line| !line.trim_start().starts_with("//") && line.contains(&format!("{name}::")));
            let is_inside = file == door || (door.ends_with('/') && file.starts_with(door));
            assert!(!uses || is_inside, "{file} names {name}; only {door} may");
        }
    }
}

#[test]
fn the_library_never_prints() {
    for (file, room, text) in files() {
        if ["cli", "main"].contains(&room.as_str()) {
            continue;
        }
        for print in ["println!", "eprintln!", "print!(", "dbg!"] {
            assert!(!text.contains(print), "{file} contains {print}");
        }
    }
}

#[test]
fn imports_are_read_in_all_their_forms() {
    let text = "use crate::beam::Chain;\nuse crate::{rod::Rod, units::{MM, UM}};\n// crate::report\nlet x = crate::rig::fit(); use crate::Error;";
    assert_eq!(named_rooms(text), ["beam", "rod", "units", "rig"]);
}
