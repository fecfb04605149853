//! Files that stand where others are to be written, and whose they are.

use std::path::{Path, PathBuf};

use super::content::{failed, read_bytes, sha256};
use super::marker::Marker;
use crate::error::{Error, Result, Whose};

/// What happens to a file that stands where one is to be written.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Existing {
    /// It stays, and nothing is written, unless the program wrote it and nobody has changed it
    /// since ([`MARKER`](super::MARKER) says so), or it has the very bytes that are to be written.
    Keep,
    /// It is replaced.
    Replace,
}

pub(super) fn refuse(
    there: &[(&str, Option<Standing>)],
    existing: Existing,
    whose: impl Fn(&str, &Standing) -> Option<Whose>,
) -> Result<()> {
    if existing == Existing::Replace {
        return Ok(());
    }
    let standing = there.iter().filter_map(|(name, there)| Some((*name, there.as_ref()?)));
    let kept: Vec<(Whose, &Path)> =
        standing.filter_map(|(name, there)| Some((whose(name, there)?, there.path.as_path()))).collect();
    // all of one kind in one error
    match kept.first() {
        None => Ok(()),
        Some(&(whose, _)) => {
            let files = kept.iter().filter(|kept| kept.0 == whose).map(|kept| kept.1.to_owned());
            Err(Error::InTheWay { files: files.collect(), whose })
        }
    }
}

/// What is known of the files of a directory.
pub(super) enum Known {
    By(Marker),
    Nothing,
}

impl Known {
    /// Whose a file is, where it must not be replaced.
    pub(super) fn whose(&self, name: &str, there: &Standing) -> Option<Whose> {
        match self {
            Known::Nothing => Some(Whose::Kept),
            Known::By(marker) if marker.is_unchanged(name, &there.sha256) => None,
            Known::By(marker) if marker.names(name) => Some(Whose::Changed),
            Known::By(_) => Some(Whose::Unknown),
        }
    }
}

/// A file that stands where one is to be written.
pub(super) struct Standing {
    pub(super) path: PathBuf,
    /// Of its content; empty for a link, which is not a copy of what it leads to.
    pub(super) sha256: String,
}

impl Standing {
    pub(super) fn at(path: &Path) -> Result<Option<Standing>> {
        let kind = match path.symlink_metadata() {
            Ok(metadata) => metadata.file_type(),
            // not there, or below a file: creating the directory will say so
            Err(_) => return Ok(None),
        };
        if kind.is_dir() {
            let source = std::io::Error::from(std::io::ErrorKind::IsADirectory);
            return Err(failed("write", path)(source));
        }
        let sha256 = if kind.is_file() { sha256(&read_bytes(path)?) } else { String::new() };
        Ok(Some(Standing { path: path.to_owned(), sha256 }))
    }
}
