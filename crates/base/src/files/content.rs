//! What is in a file, and the sum by which it is known.

use std::fs::File;
use std::io::Read;
use std::path::{Component, Path};

use sha2::{Digest, Sha256};

use crate::error::{Error, Place, Result};
use crate::limits;

/// The bytes of a file.
///
/// # Errors
/// [`Error::File`] where it cannot be read, [`Error::Input`] beyond [`limits::FILE_BYTES`].
pub fn read_bytes(path: &Path) -> Result<Vec<u8>> {
    let mut bytes = Vec::new();
    let most = limits::FILE_BYTES as u64;
    // what says nothing of its length (a pipe, a device) is not read for ever either
    let length = File::open(path).and_then(|file| match file.metadata()?.len() {
        length if length > most => Ok(length),
        _ => file.take(most + 1).read_to_end(&mut bytes).map(|length| length as u64),
    });
    match length.map_err(failed("read", path))? {
        length if length > most => Err(Error::Input {
            at: Place::whole_file(&path.display().to_string()),
            found: match bytes.is_empty() {
                true => format!("it has {length} bytes"),
                false => "it has no end in sight".into(),
            },
            expected: format!("at most {most} bytes"),
            hint: None,
        }),
        _ => Ok(bytes),
    }
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
