//! What is in a file, and the sum by which it is known.

use std::path::Path;

use sha2::{Digest, Sha256};

use crate::error::{Error, Result};

/// The bytes of a file.
///
/// # Errors
/// [`Error::File`] where it cannot be read.
pub fn read_bytes(path: &Path) -> Result<Vec<u8>> {
    std::fs::read(path).map_err(|source| Error::File { path: path.to_owned(), action: "read", source })
}

/// SHA-256 (FIPS 180-4) of a content, in hexadecimal digits.
pub fn sha256(bytes: &[u8]) -> String {
    Sha256::digest(bytes).iter().map(|byte| format!("{byte:02x}")).collect()
}

pub(super) fn failed(action: &'static str, path: &Path) -> impl Fn(std::io::Error) -> Error {
    move |source| Error::File { path: path.to_owned(), action, source }
}
