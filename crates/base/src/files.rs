//! Text in, whole files out. The only place that touches the file system.
//!
//! Nothing that somebody else wrote is lost: see [`Existing`]. A set of files is there as a whole
//! or not at all: see [`Staged`]. What a killed run left behind goes with the next one that writes
//! there.

mod content;
mod disk;
mod encoding;
mod existing;
mod in_place;
mod leftovers;
mod lock;
mod marker;
mod single;
mod staged;

use std::collections::BTreeMap;
use std::path::{Path, PathBuf};

pub use self::content::{names_in, read_bytes, read_inside, sha256};
pub use self::disk::faults;
pub use self::encoding::text_of_bytes;
pub use self::existing::Existing;
pub use self::lock::{Lock, lock};
pub use self::marker::MARKER;
pub use self::single::{append, move_to, remove_tree, shorten, write_new, write_whole};
pub use self::staged::{Created, Staged, create_directories};

use self::existing::{Known, Standing, refuse};
use self::marker::Marker;
use crate::error::{Error, Result, Whose};

/// The other files of the directory of `path` with the same extension, sorted; none where the
/// directory cannot be read.
pub fn beside(path: &Path) -> Vec<PathBuf> {
    let directory = path.parent().filter(|parent| !parent.as_os_str().is_empty()).unwrap_or(Path::new("."));
    let entries = std::fs::read_dir(directory).into_iter().flatten();
    let is_like =
        |other: &PathBuf| other.extension() == path.extension() && other.file_name() != path.file_name();
    let mut others: Vec<PathBuf> =
        entries.filter_map(|entry| Some(entry.ok()?.path())).filter(is_like).collect();
    others.sort();
    others
}

/// Reads a text file: UTF-8, or UTF-16 with its mark; see [`text_of_bytes`].
///
/// # Errors
/// [`Error::File`] where it cannot be read, [`Error::Input`] with line and column where it is
/// neither.
pub fn read_text(path: &Path) -> Result<String> {
    text_of_bytes(&path.display().to_string(), read_bytes(path)?)
}

/// Writes all files, given by name and contents, into `directory`, or none of them; see [`Staged`].
///
/// # Errors
/// As [`Staged::new`] and [`Staged::commit`]; old files are then untouched.
pub fn write_together(directory: &Path, files: &[(String, Vec<u8>)], existing: Existing) -> Result<()> {
    Staged::new(directory, files, existing)?.commit()
}

/// Refuses files that [`write_together`] would refuse whatever their contents, before these are
/// known.
///
/// # Errors
/// [`Error::InTheWay`], [`Error::File`].
pub fn check_free(directory: &Path, names: &[&str], existing: Existing) -> Result<()> {
    let markers = [Some(Marker::read(directory)?), in_place::pending(directory)?];
    let known = Known::By(markers.into_iter().flatten().collect());
    let there = names.iter().map(|name| Ok((*name, Standing::at(&directory.join(name))?)));
    refuse(&there.collect::<Result<Vec<_>>>()?, existing, |name, there| known.whose(name, there))
}

/// Refuses to write over what was read: `inputs` by name and SHA-256, `files` as [`write_together`]
/// takes them.
///
/// # Errors
/// [`Error::InTheWay`].
pub fn check_apart(
    inputs: &[(String, String)],
    directory: &Path,
    files: &[(String, Vec<u8>)],
    existing: Existing,
) -> Result<()> {
    let read: BTreeMap<PathBuf, &String> =
        inputs.iter().filter_map(|(name, hash)| Some((Path::new(name).canonicalize().ok()?, hash))).collect();
    let is_lost = |(name, contents): &&(String, Vec<u8>)| {
        let path = directory.join(name).canonicalize().ok();
        path.and_then(|path| read.get(&path)).is_some_and(|hash| **hash != sha256(contents))
    };
    let lost: Vec<PathBuf> = files.iter().filter(is_lost).map(|(name, _)| directory.join(name)).collect();
    match lost.is_empty() || existing == Existing::Replace {
        true => Ok(()),
        false => Err(Error::InTheWay { files: lost, whose: Whose::Read }),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn writing_replaces_the_whole_file_and_leaves_nothing_else() {
        let directory = tempfile::tempdir().unwrap();
        let path = directory.path().join("new").join("a.txt");
        write_whole(&path, b"long old text").unwrap();
        write_whole(&path, b"new").unwrap();
        assert_eq!(std::fs::read(&path).unwrap(), b"new");
        assert_eq!(std::fs::read_dir(path.parent().unwrap()).unwrap().count(), 1);
    }

    /// Files of these names, each with this text.
    fn all(names: &[&str], text: &str) -> Vec<(String, Vec<u8>)> {
        names.iter().map(|name| ((*name).to_owned(), text.as_bytes().to_vec())).collect()
    }

    #[test]
    fn files_are_written_all_or_none() {
        let directory = tempfile::tempdir().unwrap();
        let root = directory.path();
        std::fs::create_dir(root.join("b.txt")).unwrap();
        let files = all(&["a.txt", "b.txt"], "new");
        let error = write_together(root, &files, Existing::Replace).unwrap_err().to_string();
        assert!(error.contains("cannot write") && error.contains("b.txt"), "{error}");
        assert_eq!(std::fs::read_dir(root).unwrap().count(), 1, "only the directory that was in the way");
        std::fs::remove_dir(root.join("b.txt")).unwrap();
        write_together(root, &files, Existing::Keep).unwrap();
        assert!(files.iter().all(|(name, bytes)| &std::fs::read(root.join(name)).unwrap() == bytes));
    }

    #[test]
    fn what_the_program_wrote_is_replaced_and_nothing_else() {
        let directory = tempfile::tempdir().unwrap();
        let root = directory.path();
        let read = |name: &str| std::fs::read_to_string(root.join(name)).unwrap();
        write_together(root, &all(&["a", "b"], "one"), Existing::Keep).unwrap();
        write_together(root, &all(&["a"], "two"), Existing::Keep).unwrap();
        // both are still known
        write_together(root, &all(&["a", "b"], "three"), Existing::Keep).unwrap();
        std::fs::write(root.join("b"), "mine").unwrap();
        let refused = |names: &[&str]| {
            let error = write_together(root, &all(names, "four"), Existing::Keep).unwrap_err();
            assert!(check_free(root, names, Existing::Keep).is_err());
            error.to_string()
        };
        assert!(refused(&["a", "b"]).ends_with("b has been changed since rodcal wrote it"));
        assert_eq!((read("a"), read("b")), ("three".into(), "mine".into()));
        std::fs::write(root.join("c"), "mine too").unwrap();
        assert!(refused(&["c", "d"]).ends_with("c is there already, and rodcal did not write it"));
        assert!(!root.join("d").exists());
        // what is the same is not lost
        write_together(root, &all(&["c"], "mine too"), Existing::Keep).unwrap();
        check_free(root, &["b"], Existing::Replace).unwrap();
        write_together(root, &all(&["a", "b"], "five"), Existing::Replace).unwrap();
        write_together(root, &all(&["a", "b"], "six"), Existing::Keep).unwrap();
        assert_eq!((read("a"), read("b"), read("c")), ("six".into(), "six".into(), "mine too".into()));
    }

    #[test]
    fn a_marker_of_somebody_else_says_nothing() {
        let directory = tempfile::tempdir().unwrap();
        let root = directory.path();
        std::fs::write(root.join("a"), "mine").unwrap();
        let own_list = format!("{}  a\n", sha256(b"mine"));
        std::fs::write(root.join(MARKER), &own_list).unwrap();
        let error = write_together(root, &all(&["a"], "new"), Existing::Keep).unwrap_err().to_string();
        assert!(error.contains("rodcal did not write them") && error.contains(MARKER), "{error}");
        assert_eq!(std::fs::read_to_string(root.join(MARKER)).unwrap(), own_list);
    }

    /// What stands below a directory, temporary names left out, and how many of those there are.
    fn listing(directory: &Path) -> (BTreeMap<String, String>, usize) {
        let (mut found, mut temporary) = (BTreeMap::new(), 0);
        for entry in std::fs::read_dir(directory).into_iter().flatten().map(std::result::Result::unwrap) {
            let name = entry.file_name().into_string().unwrap();
            if name.starts_with(".rodcal-") {
                temporary += 1;
            } else if entry.file_type().unwrap().is_dir() {
                let (inside, more) = listing(&entry.path());
                temporary += more;
                found.extend(inside.into_iter().map(|(inner, text)| (format!("{name}/{inner}"), text)));
                found.insert(format!("{name}/"), String::new());
            } else {
                found.insert(name, std::fs::read_to_string(entry.path()).unwrap());
            }
        }
        (found, temporary)
    }

    /// Every operation of writing a set fails once, and is the last one of a run that is killed.
    #[test]
    fn a_fault_at_any_operation_leaves_the_old_set_or_the_new_one() {
        use super::faults::Fault;
        // what is there before: nothing; a set; with somebody's file; with somebody's folder
        for case in 0..4 {
            let (set, changed) = (all(&["a", "b"], "old"), all(&["b", "c"], "new"));
            let prepare = || {
                let directory = tempfile::tempdir().unwrap();
                let root = directory.path().join("x/y");
                if case > 0 {
                    write_together(&root, &set, Existing::Keep).unwrap();
                }
                if case == 2 {
                    std::fs::write(root.join("notes"), "mine").unwrap();
                }
                if case == 3 {
                    std::fs::create_dir(root.join("more")).unwrap();
                    std::fs::write(root.join("more/notes"), "mine").unwrap();
                }
                (directory, root)
            };
            let (whole, root) = prepare();
            let old = listing(whole.path()).0;
            write_together(&root, &changed, Existing::Keep).unwrap();
            let new = listing(whole.path()).0;
            assert!(old != new && new.keys().any(|name| name.ends_with("/c")));
            for kind in [Fault::Once, Fault::From] {
                let mut count = 0;
                loop {
                    count += 1;
                    let (directory, root) = prepare();
                    let write = || write_together(&root, &changed, Existing::Keep);
                    let (written, is_struck) = faults::with(kind(count), write);
                    let (mut there, temporary) = listing(directory.path());
                    let what = format!("case {case}, operation {count}, {kind:?}", kind = kind(count));
                    if written.is_ok() {
                        assert_eq!(there, new, "{what}");
                    } else if kind(count) == Fault::Once(count) {
                        assert!(there == old && temporary == 0, "{what}: {there:?}, {temporary} left");
                    } else if case == 3 {
                        // file by file: the next run that writes there completes it
                        check_free(&root, &["b", "c"], Existing::Keep).unwrap();
                        in_place::finish(&root).unwrap();
                        there = listing(directory.path()).0;
                    } else if case == 0 {
                        // empty directories may have been made
                        there.retain(|name, _| !name.ends_with('/'));
                        assert!(there.is_empty(), "{what}: {there:?}");
                        there = old.clone();
                    }
                    assert!(there == old || there == new, "{what}: {there:?}");
                    write_together(&root, &changed, Existing::Keep).unwrap();
                    assert_eq!(listing(directory.path()), (new.clone(), 0), "{what}, once more");
                    if !is_struck {
                        break;
                    }
                }
                assert!(count > 8, "only {count} operations: are they still counted?");
            }
        }
    }

    /// A folder of the name of a set on its way, from whoever, replaces nothing that is not known.
    #[test]
    fn what_only_looks_like_a_set_on_its_way_replaces_nothing() {
        let directory = tempfile::tempdir().unwrap();
        let root = directory.path();
        let begun = root.join(".rodcal-commit");
        std::fs::write(root.join("notes"), "mine").unwrap();
        std::fs::create_dir(&begun).unwrap();
        let refused = |name: &str| {
            let before = listing(directory.path()).0;
            let checked = check_free(root, &[name], Existing::Replace).map_err(|e| e.to_string());
            let written = write_together(root, &all(&[name], "new"), Existing::Replace);
            let error = written.unwrap_err().to_string();
            assert_eq!(checked, Err(error.clone()));
            assert!(error.starts_with("cannot complete") && error.contains(".rodcal-commit"), "{error}");
            assert_eq!(listing(directory.path()).0, before);
        };
        std::fs::write(begun.join("notes"), "evil").unwrap();
        refused("a");
        // with a marker that knows it
        let marker = Marker::default().with(&all(&["notes"], "evil"));
        std::fs::write(begun.join(MARKER), marker).unwrap();
        refused("a");
        // and with the hash of other notes
        std::fs::write(begun.join(".rodcal-replaced"), format!("{}  notes\n", sha256(b"theirs"))).unwrap();
        refused("a");
        std::os::unix::fs::symlink("elsewhere", begun.join("link")).unwrap();
        refused("a");
        std::fs::remove_dir_all(&begun).unwrap();
        std::os::unix::fs::symlink("elsewhere", &begun).unwrap();
        refused("a");
    }

    #[test]
    fn the_key_of_a_trial_is_never_replaced() {
        let directory = tempfile::tempdir().unwrap();
        let root = directory.path();
        let key = "{\"trial\":{\"made_by\":\"rodcal 0.1.0\"}}\n";
        write_together(root, &all(&["result.json"], key), Existing::Keep).unwrap();
        for existing in [Existing::Keep, Existing::Replace] {
            let error = write_together(root, &all(&["result.json"], "{}"), existing).unwrap_err();
            assert!(matches!(error, Error::InTheWay { whose: Whose::Kept, .. }), "{error}");
            assert!(check_free(root, &["result.json"], existing).is_err());
        }
        assert_eq!(read_text(&root.join("result.json")).unwrap(), key);
    }

    #[test]
    fn a_fault_at_any_operation_leaves_the_old_file_or_the_new_one() {
        use super::faults::Fault;
        for count in 1.. {
            let directory = tempfile::tempdir().unwrap();
            let path = directory.path().join("a");
            std::fs::write(&path, "old").unwrap();
            let (_, is_struck) = faults::with(Fault::From(count), || write_whole(&path, b"new"));
            let text = std::fs::read_to_string(&path).unwrap();
            assert!(text == if is_struck { "old" } else { "new" }, "operation {count}: {text}");
            write_whole(&path, b"new").unwrap();
            assert_eq!(listing(directory.path()).1, 0, "operation {count}");
            if !is_struck {
                assert!(count > 2);
                break;
            }
        }
    }

    #[test]
    fn what_a_live_run_is_about_to_write_is_not_swept() {
        let directory = tempfile::tempdir().unwrap();
        let root = directory.path().join("a");
        let staged = Staged::new(&root, &all(&["a"], "new"), Existing::Keep).unwrap();
        write_together(&directory.path().join("b"), &all(&["b"], "new"), Existing::Keep).unwrap();
        assert!(!root.exists());
        staged.commit().unwrap();
        assert!(root.join("a").exists());
    }

    #[cfg(unix)]
    #[test]
    fn a_link_is_not_replaced_by_a_file() {
        let directory = tempfile::tempdir().unwrap();
        let root = directory.path();
        std::os::unix::fs::symlink("elsewhere", root.join("a")).unwrap();
        assert!(write_together(root, &all(&["a"], "new"), Existing::Keep).is_err());
        assert!(root.join("a").is_symlink() && !root.join("elsewhere").exists());
    }

    #[test]
    fn a_missing_file_is_named() {
        let error = read_text(Path::new("no/such.toml")).unwrap_err();
        assert!(error.to_string().starts_with("cannot read no/such.toml: "));
    }
}
