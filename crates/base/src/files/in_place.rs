//! A set that goes file by file into a directory that cannot be exchanged as a whole: somebody
//! works in it, or it holds more than files.
//!
//! The complete set is renamed to [`COMMIT`] in one step; from there on it is what will be there.
//! What fails is undone; what is killed is completed by the next run that writes there. That run
//! replaces nothing but what stood there when the set was complete, by SHA-256 in [`REPLACED`]:
//! a folder of this name may come from anybody, and the files may have changed since.

use std::collections::BTreeMap;
use std::io::{Error, Result};
use std::path::Path;

use super::content::{failed, sha256};
use super::disk;
use super::existing::Standing;
use super::leftovers::{REPLACED, TemporaryFolder, is_abandoned, names, remove_files};
use super::marker::Marker;

/// The folder of a set on its way.
const COMMIT: &str = ".rodcal-commit";

/// Moves the files of `staged` into `directory`.
pub(super) fn commit(staged: &Path, directory: &Path) -> Result<()> {
    let saved = TemporaryFolder::new(directory)?;
    let names = names(staged)?;
    let mut replaced = String::new();
    for name in &names {
        let (old, kept) = (directory.join(name), saved.path.join(name));
        if old.symlink_metadata().is_ok() {
            disk::link(&old, &kept).or_else(|_| disk::copy(&old, &kept))?;
            replaced += &format!("{}  {}\n", sha256(&std::fs::read(&kept)?), name.to_string_lossy());
        }
    }
    disk::write(&mut disk::create_file(&staged.join(REPLACED))?, replaced.as_bytes())?;
    let begun = directory.join(COMMIT);
    disk::rename(staged, &begun)?;
    go_on(directory).inspect_err(|_| {
        for name in names.iter().filter(|name| begun.join(name).symlink_metadata().is_err()) {
            let (new, kept) = (directory.join(name), saved.path.join(name));
            let _ = match kept.symlink_metadata().is_ok() {
                true => disk::rename(&kept, &new),
                false => disk::remove_file(&new),
            };
        }
        remove_files(&begun);
    })
}

/// Completes a set that a killed run was putting in its place.
///
/// # Errors
/// [`crate::Error::File`] where it cannot be completed, or is none of the program's.
pub(super) fn finish(directory: &Path) -> crate::error::Result<()> {
    let begun = directory.join(COMMIT);
    if begun.symlink_metadata().is_err() || begun.is_dir() && !is_abandoned(&begun) {
        return Ok(());
    }
    pending(directory)?;
    go_on(directory).map_err(failed("write", directory))
}

/// What a killed run was writing into `directory`, by its marker; nothing where there is no such
/// set.
///
/// # Errors
/// [`crate::Error::File`] where what is there is not what a run leaves, or would replace what came
/// later.
pub(super) fn pending(directory: &Path) -> crate::error::Result<Option<Marker>> {
    let begun = directory.join(COMMIT);
    let wrong = |why: &str| {
        let why = Error::other(format!("{why}; if nothing in it is missed, remove it"));
        Err(failed("complete what a killed run left in", &begun)(why))
    };
    match begun.symlink_metadata() {
        Err(_) => return Ok(None),
        Ok(metadata) if metadata.is_dir() => {}
        Ok(_) => return wrong("it is no folder"),
    }
    let mut left = names(&begun).map_err(failed("read", &begun))?;
    left.retain(|name| name != REPLACED);
    // the marker goes last
    if left.is_empty() {
        return Ok(None);
    }
    let marker = Marker::read(&begun)?;
    let replaced = std::fs::read_to_string(begun.join(REPLACED)).unwrap_or_default();
    let replaced: BTreeMap<&str, &str> =
        replaced.lines().filter_map(|line| line.split_once("  ").map(|(hash, name)| (name, hash))).collect();
    for name in &left {
        let Some(name) = name.to_str() else { return wrong("rodcal did not write it") };
        let new = Standing::at(&begun.join(name))?;
        if !new.is_some_and(|new| marker.is_unchanged(name, &new.sha256)) {
            return wrong("rodcal did not write it, or somebody has changed it");
        }
        let old = Standing::at(&directory.join(name))?;
        if old.is_some_and(|old| replaced.get(name) != Some(&old.sha256.as_str())) {
            return wrong(&format!("{name} has come or changed beside it since"));
        }
    }
    Ok(Some(marker))
}

/// Moves what is still in [`COMMIT`].
fn go_on(directory: &Path) -> Result<()> {
    let begun = directory.join(COMMIT);
    for name in names(&begun)?.iter().filter(|name| *name != REPLACED) {
        disk::rename(&begun.join(name), &directory.join(name))?;
    }
    // everything is there
    remove_files(&begun);
    Ok(())
}
