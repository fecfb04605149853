//! A set of files that is there as a whole or not at all.

use std::collections::BTreeMap;
use std::ffi::OsStr;
use std::os::unix::fs::MetadataExt;
use std::path::{Path, PathBuf};

use super::content::{failed, sha256};
use super::existing::{Existing, Known, Standing, refuse};
use super::leftovers::{self, TemporaryFolder, links};
use super::marker::{MARKER, Marker};
use super::{disk, in_place};
use crate::error::{Error, Result};

/// A set of files, complete in a folder of its own, before it stands where it belongs.
///
/// The folder is a sibling of the directory. [`Staged::commit`] lets the two change places in one
/// step, and with the new set go second names (hard links) of the files that stay; so at any moment
/// the old set is there or the new one. Where that cannot be (the directory is where somebody
/// works, it holds folders, or the file system has no such step) the set goes file by file
/// (see `in_place.rs`). Dropped without [`Staged::commit`], nothing has been written.
#[derive(Debug)]
#[must_use]
pub struct Staged {
    folder: TemporaryFolder,
    /// Its files.
    names: Vec<String>,
    /// Where it belongs, as the user named it and as it is.
    directory: PathBuf,
    real: PathBuf,
    created: Created,
}

/// With more files that stay, a second name for each takes longer than it is worth.
const MOST_KEPT: usize = 1000;

impl Staged {
    /// Writes files, given by name and contents, beside `directory`. Missing directories are
    /// created. [`MARKER`] says what was written, so that the program may replace it another time.
    ///
    /// # Errors
    /// [`Error::InTheWay`](crate::Error::InTheWay), [`Error::File`](crate::Error::File).
    pub fn new(directory: &Path, files: &[(String, Vec<u8>)], existing: Existing) -> Result<Staged> {
        in_place::finish(directory)?;
        let marker = Marker::read(directory)?;
        let text = marker.with(files);
        // by the marker a leftover is known for what it is, so it is the first
        let files: Vec<(&str, &[u8])> = std::iter::once((MARKER, text.as_slice()))
            .chain(files.iter().map(|(name, contents)| (name.as_str(), contents.as_slice())))
            .collect();
        let there = files.iter().map(|(name, _)| Ok((*name, Standing::at(&directory.join(name))?)));
        let there = there.collect::<Result<Vec<_>>>()?;
        let hashes: BTreeMap<&str, String> =
            files.iter().map(|(name, contents)| (*name, sha256(contents))).collect();
        let known = Known::By(vec![marker]);
        // the same bytes are no loss
        refuse(&there, existing, |name, there| match hashes.get(name) == Some(&there.sha256) {
            true => None,
            false => known.whose(name, there),
        })?;
        let is_there = directory.is_dir();
        let parent =
            directory.parent().filter(|parent| !parent.as_os_str().is_empty()).unwrap_or(Path::new("."));
        let named = |error| match error {
            Error::File { source, action, .. } => Error::File { path: directory.to_owned(), action, source },
            error => error,
        };
        let created = create_directories(if is_there { directory } else { parent }).map_err(named)?;
        let write = failed("write", directory);
        // of a link to a directory, the directory
        let real = match is_there {
            true => directory.canonicalize().map_err(&write)?,
            false => parent.canonicalize().map_err(&write)?.join(directory.file_name().unwrap_or_default()),
        };
        let beside = real.parent().unwrap_or(&real);
        leftovers::sweep(beside);
        leftovers::sweep(&real);
        let is_exchanged = !is_there || can_be_exchanged(&real, &files);
        let folder = match is_exchanged {
            true => TemporaryFolder::new(beside).or_else(|error| match is_there {
                true => TemporaryFolder::new(&real),
                false => Err(error),
            }),
            false => TemporaryFolder::new(&real),
        };
        let folder = folder.map_err(&write)?;
        for (name, contents) in &files {
            let written = disk::create_file(&folder.path.join(name))
                .and_then(|mut file| disk::write(&mut file, contents));
            written.map_err(failed("write", &directory.join(name)))?;
        }
        let names = files.iter().map(|(name, _)| (*name).to_owned()).collect();
        Ok(Staged { folder, names, directory: directory.to_owned(), real, created })
    }

    /// Puts the set where it belongs.
    ///
    /// # Errors
    /// [`Error::File`](crate::Error::File); what was there is then untouched.
    pub fn commit(self) -> Result<()> {
        // what is declared last goes first: the folder before the directory that it stands in
        let Staged { created, directory, real, names, folder } = self;
        let done = match real.is_dir() {
            _ if folder.path.parent() == Some(&real) => in_place::commit(&folder.path, &real),
            // only an empty directory may have come there
            false => disk::rename(&folder.path, &real),
            true => exchange(&folder.path, &real, &names),
        };
        done.map_err(failed("write", &directory))?;
        folder.keep();
        created.keep();
        Ok(())
    }
}

/// Whether a directory holds nothing but files, few besides those that are written, and nobody who
/// works in it would be left in a place without a name.
fn can_be_exchanged(real: &Path, files: &[(&str, &[u8])]) -> bool {
    let (Ok(own), Some(parent)) = (real.metadata(), real.parent()) else { return false };
    let is_same_disk = parent.metadata().is_ok_and(|parent| parent.dev() == own.dev());
    let is_worked_in = std::env::current_dir().is_ok_and(|here| here == real);
    let Ok(entries) = std::fs::read_dir(real) else { return false };
    let mut count = 0;
    let is_plain = entries.take(MOST_KEPT + files.len() + 1).all(|entry| {
        count += 1;
        entry.is_ok_and(|entry| entry.file_type().is_ok_and(|kind| kind.is_file() || kind.is_symlink()))
    });
    is_plain
        && count <= MOST_KEPT + files.len()
        && is_same_disk
        && !is_worked_in
        && !own.permissions().readonly()
}

/// Lets a directory and the folder with the new set change places, then removes what was replaced.
fn exchange(folder: &Path, real: &Path, names: &[String]) -> std::io::Result<()> {
    let is_new = |name: &OsStr| name.to_str().is_some_and(|name| names.iter().any(|new| new == name));
    let mut kept = leftovers::names(real)?;
    kept.retain(|name| !is_new(name));
    std::fs::set_permissions(folder, real.metadata()?.permissions())?;
    let linked = kept.iter().try_for_each(|name| disk::link(&real.join(name), &folder.join(name)));
    // somebody else's file may have no second name; not every file system exchanges
    if linked.and_then(|()| disk::exchange(folder, real)).is_err() {
        for name in &kept {
            match disk::remove_file(&folder.join(name)) {
                Err(error) if error.kind() != std::io::ErrorKind::NotFound => return Err(error),
                _ => {}
            }
        }
        return in_place::commit(folder, real);
    }
    // the folder is now what was there; what is left of it goes with the next run
    drop(remove_replaced(folder, real, &is_new));
    Ok(())
}

fn remove_replaced(folder: &Path, real: &Path, is_new: &impl Fn(&OsStr) -> bool) -> std::io::Result<()> {
    for name in leftovers::names(folder)? {
        let path = folder.join(&name);
        let is_elsewhere = || path.symlink_metadata().is_ok_and(|metadata| links(&metadata) > 1);
        match is_new(&name) || is_elsewhere() {
            true => disk::remove_file(&path)?,
            // what came while the two were exchanged
            false => disk::rename_to_free(&path, &real.join(&name))?,
        }
    }
    disk::remove_directory(folder)
}

/// Directories that were made, and go again unless they are kept.
#[derive(Debug)]
#[must_use]
pub struct Created(Vec<PathBuf>);

impl Created {
    /// Lets them stay.
    pub fn keep(mut self) {
        self.0.clear();
    }
}

impl Drop for Created {
    fn drop(&mut self) {
        for path in self.0.iter().rev() {
            let _ = disk::remove_directory(path);
        }
    }
}

/// Makes a directory and those above it that are missing.
///
/// # Errors
/// [`Error::File`](crate::Error::File); nothing has been made then.
pub fn create_directories(directory: &Path) -> Result<Created> {
    let mut missing: Vec<&Path> = directory
        .ancestors()
        .take_while(|path| !path.as_os_str().is_empty() && path.symlink_metadata().is_err())
        .collect();
    missing.reverse();
    let mut created = Created(Vec::new());
    for path in missing {
        match disk::create_directory(path) {
            Ok(()) => created.0.push(path.to_owned()),
            // by another run
            Err(error) if error.kind() == std::io::ErrorKind::AlreadyExists => {}
            Err(error) => return Err(failed("create", directory)(error)),
        }
    }
    match directory.as_os_str().is_empty() || directory.is_dir() {
        true => Ok(created),
        false => Err(failed("create", directory)(std::io::ErrorKind::NotADirectory.into())),
    }
}
