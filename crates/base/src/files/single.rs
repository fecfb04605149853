//! One file, whole or not at all.

use std::path::Path;

use super::content::failed;
use super::existing::{Existing, Known, Standing, refuse};
use super::staged::create_directories;
use super::{disk, leftovers, sha256};
use crate::error::Result;

/// Writes a file whole or not at all: to a temporary file beside it, then renamed onto it. For a
/// file that the caller has read and knows as its own: what stands there is replaced. Missing
/// directories are created.
///
/// # Errors
/// [`Error::File`](crate::Error::File); the old file, if any, is then untouched.
pub fn write_whole(path: &Path, contents: &[u8]) -> Result<()> {
    write_new(path, contents, Existing::Replace)
}

/// The same for a file that may be somebody else's: only the same bytes may stand there.
///
/// # Errors
/// [`Error::File`](crate::Error::File), [`Error::InTheWay`](crate::Error::InTheWay); the old file,
/// if any, is then untouched.
pub fn write_new(path: &Path, contents: &[u8], existing: Existing) -> Result<()> {
    let there = Standing::at(path)?;
    let is_same = there.as_ref().is_some_and(|there| there.sha256 == sha256(contents));
    let is_replaced = there.is_some();
    if !is_same {
        refuse(&[("", there)], existing, |name, there| Known::Nothing.whose(name, there))?;
    }
    let directory = path.parent().filter(|parent| !parent.as_os_str().is_empty()).unwrap_or(Path::new("."));
    let created = create_directories(directory)?;
    leftovers::sweep(directory);
    let (mut file, temporary) = leftovers::temporary_file(directory).map_err(failed("write", path))?;
    let written = disk::write(&mut file, contents).and_then(|()| {
        // what has come there in the meantime is not replaced either
        match is_replaced || existing == Existing::Replace {
            true => disk::rename(&temporary, path),
            false => disk::rename_to_free(&temporary, path),
        }
    });
    written.map_err(|error| {
        let _ = disk::remove_file(&temporary);
        failed("write", path)(error)
    })?;
    created.keep();
    Ok(())
}

/// Adds to the end of a file, which is made if missing, and waits until it is on the disk.
///
/// # Errors
/// [`Error::File`](crate::Error::File); after a power cut a part of `contents` may be there.
pub fn append(path: &Path, contents: &[u8]) -> Result<()> {
    let written = disk::open_to_append(path).and_then(|mut file| {
        disk::write(&mut file, contents)?;
        disk::sync(&file)
    });
    written.map_err(failed("write", path))
}

/// Takes from the end of a file all but its first bytes.
///
/// # Errors
/// [`Error::File`](crate::Error::File).
pub fn shorten(path: &Path, length: usize) -> Result<()> {
    disk::shorten(path, length as u64).map_err(failed("write", path))
}

/// Gives a folder another name; only an empty folder may stand there.
///
/// # Errors
/// [`Error::File`](crate::Error::File); the folder then keeps its name.
pub fn move_to(folder: &Path, name: &Path) -> Result<()> {
    disk::rename(folder, name).map_err(failed("write", name))
}

/// Removes a file, or a folder with everything in it, that the program made and nobody has got yet.
pub fn remove_tree(path: &Path) {
    let removed = match path.is_dir() && !path.is_symlink() {
        true => disk::remove_tree(path),
        false => disk::remove_file(path),
    };
    // what cannot be removed is still there, and the next run says so
    drop(removed);
}
