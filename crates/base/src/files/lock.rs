//! A file that one run alone works with.

use std::fs::{File, TryLockError};
use std::io::{Error, ErrorKind};
use std::os::unix::fs::MetadataExt;
use std::path::Path;

use super::content::failed;
use crate::error::Result;

/// No other run has the file as long as this is there.
#[derive(Debug)]
#[must_use]
pub struct Lock {
    _file: File,
}

/// Takes a file for this run alone; `None` where there is none.
///
/// # Errors
/// [`Error::File`](crate::Error::File) where another run has it, or it cannot be opened.
pub fn lock(path: &Path) -> Result<Option<Lock>> {
    let taken = || Error::new(ErrorKind::ResourceBusy, "another run is at work with it");
    let file = match File::open(path) {
        Err(error) if error.kind() == ErrorKind::NotFound => return Ok(None),
        opened => opened.map_err(failed("write", path))?,
    };
    match file.try_lock() {
        Err(TryLockError::WouldBlock) => return Err(failed("write", path)(taken())),
        // a file system without locks: two runs at once are then nobody's business
        Ok(()) | Err(TryLockError::Error(_)) => {}
    }
    // what was opened may have gone, or been replaced, before it was taken
    let is_same = |there: std::fs::Metadata| {
        file.metadata().is_ok_and(|own| (own.dev(), own.ino()) == (there.dev(), there.ino()))
    };
    match path.symlink_metadata().is_ok_and(is_same) {
        true => Ok(Some(Lock { _file: file })),
        false => Err(failed("write", path)(taken())),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_file_is_one_runs_until_that_is_done() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("kept");
        assert!(lock(&path).unwrap().is_none());
        std::fs::write(&path, "x").unwrap();
        let own = lock(&path).unwrap().unwrap();
        let refused = lock(&path).unwrap_err().to_string();
        assert!(refused.contains("another run is at work with it"), "{refused}");
        drop(own);
        assert!(lock(&path).unwrap().is_some());
    }
}
