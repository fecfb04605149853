//! What is in a file, and the sum by which it is known.

use std::path::{Component, Path};

use sha2::{Digest, Sha256};

use crate::error::{Error, Place, Result};

/// The bytes of a file.
///
/// # Errors
/// [`Error::File`] where it cannot be read.
pub fn read_bytes(path: &Path) -> Result<Vec<u8>> {
    std::fs::read(path).map_err(|source| Error::File { path: path.to_owned(), action: "read", source })
}

/// The bytes of a file by its name below `directory`, which must not lead out of it: not `..`, no
/// path from the root, no link on the way.
///
/// # Errors
/// [`Error::Input`] for such a name, [`Error::File`] where it cannot be read.
pub fn read_inside(directory: &Path, name: &str) -> Result<Vec<u8>> {
    let refused = |found: &str| Error::Input {
        at: Place::whole_file(&directory.join(name).display().to_string()),
        found: found.into(),
        expected: format!("a file inside {}", directory.display()),
        hint: None,
    };
    let mut path = directory.to_owned();
    for part in Path::new(name).components() {
        let Component::Normal(part) = part else { return Err(refused("this name leads out of the folder")) };
        path.push(part);
        if path.is_symlink() {
            return Err(refused("this is a link"));
        }
    }
    match path.is_file() {
        true => read_bytes(&path),
        // a missing file says so; a pipe would wait for ever
        false if path.exists() => Err(refused("this is no file")),
        false => read_bytes(&path),
    }
}

/// The names in a directory, sorted; none where it cannot be read.
pub fn names_in(directory: &Path) -> Vec<String> {
    let entries = std::fs::read_dir(directory).into_iter().flatten().flatten();
    let mut names: Vec<String> =
        entries.map(|entry| entry.file_name().to_string_lossy().into_owned()).collect();
    names.sort();
    names
}

/// SHA-256 (FIPS 180-4) of a content, in hexadecimal digits.
pub fn sha256(bytes: &[u8]) -> String {
    Sha256::digest(bytes).iter().map(|byte| format!("{byte:02x}")).collect()
}

pub(super) fn failed(action: &'static str, path: &Path) -> impl Fn(std::io::Error) -> Error {
    move |source| Error::File { path: path.to_owned(), action, source }
}
