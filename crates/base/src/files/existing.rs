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
    /// It is replaced, unless it is the key of a sealed trial.
    Replace,
}

pub(super) fn refuse(
    there: &[(&str, Option<Standing>)],
    existing: Existing,
    whose: impl Fn(&str, &Standing) -> Option<Whose>,
) -> Result<()> {
    let standing = there.iter().filter_map(|(name, there)| Some((*name, there.as_ref()?)));
    let whose = |name: &str, there: &Standing| match existing {
        _ if there.is_key => Some(Whose::Kept),
        Existing::Replace => None,
        Existing::Keep => whose(name, there),
    };
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

/// What is known of the files of a directory: by its marker, and by that of a set on its way there.
pub(super) enum Known {
    By(Vec<Marker>),
    Nothing,
}

/// How the key of a sealed trial begins: without it nobody can score the answers.
const KEY: &[u8] = b"{\"trial\":{\"made_by\":";

/// Also one of an earlier program, that has no such line: `{"case":"…","kind":`.
fn is_key(content: &[u8]) -> bool {
    const CASE: &[u8] = b"{\"case\":\"";
    const KIND: &[u8] = b"\",\"kind\":";
    let is_case = |rest: &[u8]| {
        let name = rest.iter().position(|&byte| byte == b'"').unwrap_or(rest.len());
        rest[name..].starts_with(KIND)
    };
    content.starts_with(KEY) || content.strip_prefix(CASE).is_some_and(is_case)
}

impl Known {
    /// Whose a file is, where it must not be replaced.
    pub(super) fn whose(&self, name: &str, there: &Standing) -> Option<Whose> {
        match self {
            Known::Nothing => Some(Whose::Kept),
            Known::By(markers) if markers.iter().any(|m| m.is_unchanged(name, &there.sha256)) => None,
            Known::By(markers) if markers.iter().any(|m| m.names(name)) => Some(Whose::Changed),
            Known::By(_) => Some(Whose::Unknown),
        }
    }
}

/// A file that stands where one is to be written.
pub(super) struct Standing {
    pub(super) path: PathBuf,
    /// Of its content; empty for a link, which is not a copy of what it leads to.
    pub(super) sha256: String,
    /// Whether it is the key of a sealed trial.
    is_key: bool,
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
        let path = path.to_owned();
        if !kind.is_file() {
            return Ok(Some(Standing { path, sha256: String::new(), is_key: false }));
        }
        let content = read_bytes(&path)?;
        Ok(Some(Standing { path, sha256: sha256(&content), is_key: is_key(&content) }))
    }
}
