//! A set that goes file by file into a directory that cannot be exchanged as a whole: somebody
//! works in it, or it holds more than files.
//!
//! The complete set is renamed to [`COMMIT`] in one step; from there on it is what will be there.
//! What fails is undone; what is killed is completed by the next run that writes there.

use std::io::Result;
use std::path::Path;

use super::content::failed;
use super::disk;
use super::leftovers::{TemporaryFolder, is_abandoned, names, remove_files};

/// The folder of a set on its way.
const COMMIT: &str = ".rodcal-commit";

/// Moves the files of `staged` into `directory`.
pub(super) fn commit(staged: &Path, directory: &Path) -> Result<()> {
    let saved = TemporaryFolder::new(directory)?;
    let names = names(staged)?;
    for name in &names {
        let (old, kept) = (directory.join(name), saved.path.join(name));
        if old.symlink_metadata().is_ok() {
            disk::link(&old, &kept).or_else(|_| disk::copy(&old, &kept))?;
        }
    }
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
/// [`crate::Error::File`] where it cannot be completed now either.
pub(super) fn finish(directory: &Path) -> crate::error::Result<()> {
    let begun = directory.join(COMMIT);
    if begun.is_dir() && is_abandoned(&begun) {
        go_on(directory).map_err(failed("write", directory))?;
    }
    Ok(())
}

/// Moves what is still in [`COMMIT`].
fn go_on(directory: &Path) -> Result<()> {
    let begun = directory.join(COMMIT);
    for name in names(&begun)? {
        disk::rename(&begun.join(&name), &directory.join(&name))?;
    }
    // everything is there
    let _ = disk::remove_directory(&begun);
    Ok(())
}
