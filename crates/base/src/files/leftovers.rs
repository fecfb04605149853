//! What is only there until a set is complete, and what killed runs left of it.
//!
//! Temporary files and folders are called `.rodcal-PID-N` and locked by whoever makes them: the
//! lock goes with the process, and so the next run knows what nobody needs any more.

use std::ffi::OsString;
use std::fs::File;
use std::path::{Path, PathBuf};
use std::sync::atomic::{AtomicUsize, Ordering};

use super::disk;
use super::marker::{MARKER, Marker};

const PREFIX: &str = ".rodcal-";
/// What stood where the files of a set on its way go; see `in_place.rs`.
pub(super) const REPLACED: &str = ".rodcal-replaced";

/// A name in `directory` that no other run uses.
fn fresh(directory: &Path) -> PathBuf {
    static MADE: AtomicUsize = AtomicUsize::new(0);
    let number = MADE.fetch_add(1, Ordering::Relaxed);
    directory.join(format!("{PREFIX}{:x}-{number:x}", std::process::id()))
}

/// A folder that goes when it is dropped, unless it has been renamed.
#[derive(Debug)]
pub(super) struct TemporaryFolder {
    pub(super) path: PathBuf,
    /// Held as long as the process lives.
    _lock: Option<File>,
}

impl TemporaryFolder {
    pub(super) fn new(directory: &Path) -> std::io::Result<TemporaryFolder> {
        loop {
            let path = fresh(directory);
            match disk::create_directory(&path) {
                // of a killed run with the number of this one
                Err(error) if error.kind() == std::io::ErrorKind::AlreadyExists => continue,
                Err(error) => return Err(error),
                Ok(()) => {}
            }
            let lock = locked(&path);
            // another run may have taken it for a leftover before it was locked
            if path.exists() {
                return Ok(TemporaryFolder { path, _lock: lock });
            }
        }
    }
}

impl TemporaryFolder {
    /// Forgets a folder that stands elsewhere now.
    pub(super) fn keep(mut self) {
        self.path.clear();
    }
}

impl Drop for TemporaryFolder {
    fn drop(&mut self) {
        if !self.path.as_os_str().is_empty() {
            remove_files(&self.path);
        }
    }
}

/// A new file, locked, and its name.
pub(super) fn temporary_file(directory: &Path) -> std::io::Result<(File, PathBuf)> {
    loop {
        let path = fresh(directory);
        match disk::create_file(&path) {
            Err(error) if error.kind() == std::io::ErrorKind::AlreadyExists => continue,
            Err(error) => return Err(error),
            Ok(file) => {
                // a file system without locks is no reason not to write
                let _ = file.lock();
                if path.exists() {
                    return Ok((file, path));
                }
            }
        }
    }
}

fn locked(path: &Path) -> Option<File> {
    let handle = File::open(path).ok()?;
    handle.lock().ok()?;
    Some(handle)
}

/// What is in a folder, in order, and the marker last: by it the program knows what it wrote.
pub(super) fn names(folder: &Path) -> std::io::Result<Vec<OsString>> {
    let names = std::fs::read_dir(folder)?.map(|entry| Ok(entry?.file_name()));
    let mut names = names.collect::<std::io::Result<Vec<_>>>()?;
    names.sort_by_key(|name| (name == MARKER, name.clone()));
    Ok(names)
}

/// Removes a folder with the files in it; where one of them cannot be removed the rest stays, for
/// the next run.
pub(super) fn remove_files(folder: &Path) {
    let removed = names(folder).and_then(|names| {
        names.iter().try_for_each(|name| disk::remove_file(&folder.join(name)))?;
        disk::remove_directory(folder)
    });
    // what is left is no part of any result
    drop(removed);
}

/// Removes what killed runs left in a directory.
pub(super) fn sweep(directory: &Path) {
    let Ok(entries) = std::fs::read_dir(directory) else { return };
    for entry in entries.flatten() {
        let (name, path) = (entry.file_name(), entry.path());
        let Ok(kind) = entry.file_type() else { continue };
        let is_ours = name.to_str().is_some_and(is_temporary) && (kind.is_dir() || kind.is_file());
        if !is_ours || !is_abandoned(&path) {
            continue;
        }
        match kind.is_dir() {
            true => remove_known(&path),
            false => drop(disk::remove_file(&path)),
        }
    }
}

/// `.rodcal-1f3-0`.
fn is_temporary(name: &str) -> bool {
    let is_number = |text: &str| !text.is_empty() && text.bytes().all(|b| b.is_ascii_hexdigit());
    let numbers = name.strip_prefix(PREFIX).and_then(|rest| rest.split_once('-'));
    numbers.is_some_and(|(process, number)| is_number(process) && is_number(number))
}

/// Whether nobody who lives holds its lock.
pub(super) fn is_abandoned(path: &Path) -> bool {
    File::open(path).is_ok_and(|file| file.try_lock().is_ok())
}

/// Of a folder that was exchanged for the new one, what the program wrote and what has another name
/// elsewhere; anything else is somebody's.
fn remove_known(folder: &Path) {
    let marker = Marker::read(folder).unwrap_or_default();
    let has_other_name = |path: &Path| path.symlink_metadata().is_ok_and(|metadata| links(&metadata) > 1);
    let removed = names(folder).and_then(|names| {
        for name in names {
            let path = folder.join(&name);
            let is_known =
                name.to_str().is_some_and(|name| name == MARKER || name == REPLACED || marker.names(name));
            match is_known || has_other_name(&path) {
                true => disk::remove_file(&path)?,
                false => return Ok(()),
            }
        }
        disk::remove_directory(folder)
    });
    drop(removed);
}

/// So many names a file has.
pub(super) fn links(metadata: &std::fs::Metadata) -> u64 {
    std::os::unix::fs::MetadataExt::nlink(metadata)
}
