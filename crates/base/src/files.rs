//! Text in, whole files out. The only place that touches the file system.

mod encoding;

use std::io::Write;
use std::path::{Path, PathBuf};

use sha2::{Digest, Sha256};

pub use encoding::text_of_bytes;

use crate::error::{Error, Result};

/// The other files of the directory of `path` with the same extension, sorted; none where the
/// directory cannot be read.
pub fn beside(path: &Path) -> Vec<PathBuf> {
    let directory = path.parent().filter(|parent| !parent.as_os_str().is_empty()).unwrap_or(Path::new("."));
    let entries = std::fs::read_dir(directory).into_iter().flatten();
    let is_like =
        |other: &PathBuf| other.extension() == path.extension() && other.file_name() != path.file_name();
    let mut others: Vec<PathBuf> =
        entries.filter_map(|entry| Some(entry.ok()?.path())).filter(is_like).collect();
    others.sort();
    others
}

/// SHA-256 (FIPS 180-4) of a content, in hexadecimal digits.
pub fn sha256(bytes: &[u8]) -> String {
    Sha256::digest(bytes).iter().map(|byte| format!("{byte:02x}")).collect()
}

/// Reads a text file: UTF-8, or UTF-16 with its mark; see [`text_of_bytes`].
///
/// # Errors
/// [`Error::File`] where it cannot be read, [`Error::Input`] with line and column where it is neither.
pub fn read_text(path: &Path) -> Result<String> {
    text_of_bytes(&path.display().to_string(), read_bytes(path)?)
}

/// The bytes of a file.
///
/// # Errors
/// [`Error::File`] where it cannot be read.
pub fn read_bytes(path: &Path) -> Result<Vec<u8>> {
    std::fs::read(path).map_err(|source| Error::File { path: path.to_owned(), action: "read", source })
}

/// Adds to the end of a file, which is made if missing, and waits until it is on the disk.
///
/// # Errors
/// [`Error::File`]; after a power cut a part of `contents` may be there.
pub fn append(path: &Path, contents: &[u8]) -> Result<()> {
    let written = std::fs::OpenOptions::new().create(true).append(true).open(path).and_then(|mut file| {
        file.write_all(contents)?;
        file.sync_data()
    });
    written.map_err(failed("write", path))
}

/// Writes a file whole or not at all: to a temporary file beside it, then renamed onto it.
/// Missing directories are created.
///
/// # Errors
/// [`Error::File`]; the old file, if any, is then untouched.
pub fn write_whole(path: &Path, contents: &[u8]) -> Result<()> {
    let (directory, name) = match (path.parent(), path.file_name()) {
        (Some(parent), Some(name)) if !parent.as_os_str().is_empty() => (parent, name),
        _ => (Path::new("."), path.as_os_str()),
    };
    write_together(directory, &[(name.to_string_lossy().into_owned(), contents.to_vec())])
}

/// Writes all files, given by name and contents, into `directory`, or none of them: each to a temporary file first,
/// and only when all of those are complete are they renamed. Missing directories are created.
///
/// # Errors
/// [`Error::File`]; old files are then untouched, unless a rename itself fails in the midst of the others.
pub fn write_together(directory: &Path, files: &[(String, Vec<u8>)]) -> Result<()> {
    std::fs::create_dir_all(directory).map_err(failed("create", directory))?;
    let mut finished = Vec::with_capacity(files.len());
    for (name, contents) in files {
        let path = directory.join(name);
        if path.is_dir() {
            let source = std::io::Error::from(std::io::ErrorKind::IsADirectory);
            return Err(failed("write", &path)(source));
        }
        let mut temporary = tempfile::Builder::new()
            .prefix(".rodcal-")
            .permissions(readable_by_all())
            .tempfile_in(directory)
            .map_err(failed("write", &path))?;
        temporary.write_all(contents).map_err(failed("write", &path))?;
        finished.push((temporary, path));
    }
    for (temporary, path) in finished {
        temporary.persist(&path).map_err(|e| failed("write", &path)(e.error))?;
    }
    Ok(())
}

fn failed(action: &'static str, path: &Path) -> impl Fn(std::io::Error) -> Error {
    move |source| Error::File { path: path.to_owned(), action, source }
}

#[cfg(unix)]
fn readable_by_all() -> std::fs::Permissions {
    std::os::unix::fs::PermissionsExt::from_mode(0o644)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn writing_replaces_the_whole_file_and_leaves_nothing_else() {
        let directory = tempfile::tempdir().unwrap();
        let path = directory.path().join("new").join("a.txt");
        write_whole(&path, b"long old text").unwrap();
        write_whole(&path, b"new").unwrap();
        assert_eq!(std::fs::read(&path).unwrap(), b"new");
        assert_eq!(std::fs::read_dir(path.parent().unwrap()).unwrap().count(), 1);
    }

    #[test]
    fn files_are_written_all_or_none() {
        let directory = tempfile::tempdir().unwrap();
        let (root, names) = (directory.path(), ["a.txt", "b.txt"]);
        std::fs::create_dir(root.join("b.txt")).unwrap();
        let files = names.map(|name| (name.to_owned(), b"new".to_vec()));
        let error = write_together(root, &files).unwrap_err().to_string();
        assert!(error.contains("cannot write") && error.contains("b.txt"), "{error}");
        assert_eq!(std::fs::read_dir(root).unwrap().count(), 1, "only the directory that was in the way");
        std::fs::remove_dir(root.join("b.txt")).unwrap();
        write_together(root, &files).unwrap();
        assert!(names.iter().all(|name| std::fs::read(root.join(name)).unwrap() == b"new"));
    }

    #[test]
    fn a_missing_file_is_named() {
        let error = read_text(Path::new("no/such.toml")).unwrap_err();
        assert!(error.to_string().starts_with("cannot read no/such.toml: "));
    }
}
