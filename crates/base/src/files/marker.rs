//! By what the program knows the files that it wrote.

use std::collections::BTreeMap;
use std::path::Path;

use super::content::{read_bytes, sha256};
use crate::error::Result;

/// The file in a directory of the program's that names what it wrote there, with the SHA-256 of
/// each as it was written. `sha256sum --check` reads it too.
pub const MARKER: &str = "rodcal.sha256";

const FIRST_LINE: &str =
    "# What rodcal wrote here. It replaces these files as long as nobody has changed them.";

/// What [`MARKER`] says.
#[derive(Debug, Default)]
pub(super) struct Marker {
    /// SHA-256 by the file's name.
    written: BTreeMap<String, String>,
    /// Of the marker itself as it stands; nothing where there is none, or somebody else's.
    own: Option<String>,
}

impl Marker {
    /// Of a directory; one that says nothing where there is none, or none of the program's.
    pub(super) fn read(directory: &Path) -> Result<Marker> {
        let path = directory.join(MARKER);
        if !path.is_file() {
            return Ok(Marker::default());
        }
        let bytes = read_bytes(&path)?;
        let text = String::from_utf8_lossy(&bytes);
        let Some(rest) = text.strip_prefix(FIRST_LINE) else { return Ok(Marker::default()) };
        let pair = |line: &str| line.split_once("  ").map(|(hash, name)| (name.to_owned(), hash.to_owned()));
        Ok(Marker { written: rest.lines().filter_map(pair).collect(), own: Some(sha256(&bytes)) })
    }

    /// Whether the program wrote a file of this name.
    pub(super) fn names(&self, name: &str) -> bool {
        self.written.contains_key(name)
    }

    /// Whether what stands under this name is what the program wrote.
    pub(super) fn is_unchanged(&self, name: &str, sha256: &str) -> bool {
        let known = if name == MARKER { self.own.as_ref() } else { self.written.get(name) };
        known.is_some_and(|known| known == sha256)
    }

    /// The marker's text when these are written too.
    pub(super) fn with(&self, files: &[(String, Vec<u8>)]) -> Vec<u8> {
        let mut written = self.written.clone();
        written.extend(files.iter().map(|(name, contents)| (name.clone(), sha256(contents))));
        let lines: String = written.iter().map(|(name, hash)| format!("{hash}  {name}\n")).collect();
        format!("{FIRST_LINE}\n{lines}").into_bytes()
    }
}
