//! Text in, whole files out. The only place that touches the file system.
//!
//! Nothing that somebody else wrote is lost: see [`Existing`].

mod content;
mod encoding;
mod marker;

use std::collections::BTreeMap;
use std::io::Write;
use std::path::{Path, PathBuf};

pub use self::content::{read_bytes, sha256};
pub use self::encoding::text_of_bytes;
pub use self::marker::MARKER;

use self::content::failed;
use self::marker::Marker;
use crate::error::{Error, Result, Whose};

/// What happens to a file that stands where one is to be written.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Existing {
    /// It stays, and nothing is written, unless the program wrote it and nobody has changed it
    /// since ([`MARKER`] says so), or it has the very bytes that are to be written.
    Keep,
    /// It is replaced.
    Replace,
}

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

/// Reads a text file: UTF-8, or UTF-16 with its mark; see [`text_of_bytes`].
///
/// # Errors
/// [`Error::File`] where it cannot be read, [`Error::Input`] with line and column where it is
/// neither.
pub fn read_text(path: &Path) -> Result<String> {
    text_of_bytes(&path.display().to_string(), read_bytes(path)?)
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

/// Writes a file whole or not at all: to a temporary file beside it, then renamed onto it. For a
/// file that the caller has read and knows as its own: what stands there is replaced. Missing
/// directories are created.
///
/// # Errors
/// [`Error::File`]; the old file, if any, is then untouched.
pub fn write_whole(path: &Path, contents: &[u8]) -> Result<()> {
    write_new(path, contents, Existing::Replace)
}

/// The same for a file that may be somebody else's.
///
/// # Errors
/// [`Error::File`], [`Error::InTheWay`]; the old file, if any, is then untouched.
pub fn write_new(path: &Path, contents: &[u8], existing: Existing) -> Result<()> {
    let (directory, name) = match (path.parent(), path.file_name()) {
        (Some(parent), Some(name)) if !parent.as_os_str().is_empty() => (parent, name),
        _ => (Path::new("."), path.as_os_str()),
    };
    write_once(directory, &[(name.to_string_lossy().into_owned(), contents.to_vec())], existing)
}

/// Writes all files, given by name and contents, into `directory`, or none of them: each to a
/// temporary file first, and only when all of those are complete are they renamed. Missing
/// directories are created. [`MARKER`] beside them says what was written, so that the program may
/// replace it another time.
///
/// # Errors
/// [`Error::InTheWay`], [`Error::File`]; old files are then untouched, unless a rename itself fails
/// in the midst of the others.
pub fn write_together(directory: &Path, files: &[(String, Vec<u8>)], existing: Existing) -> Result<()> {
    let marker = Marker::read(directory)?;
    // the marker comes last: if the power fails before it, the same files can be written again
    let files: Vec<_> = files.iter().cloned().chain([(MARKER.to_owned(), marker.with(files))]).collect();
    write(directory, &files, existing, &Known::By(marker))
}

/// The same without [`MARKER`], for what is written once: only the same bytes may stand there.
///
/// # Errors
/// As [`write_together`].
pub fn write_once(directory: &Path, files: &[(String, Vec<u8>)], existing: Existing) -> Result<()> {
    write(directory, files, existing, &Known::Nothing)
}

/// Refuses files that [`write_together`] would refuse whatever their contents, before these are
/// known.
///
/// # Errors
/// [`Error::InTheWay`], [`Error::File`].
pub fn check_free(directory: &Path, names: &[&str], existing: Existing) -> Result<()> {
    let known = Known::By(Marker::read(directory)?);
    let there = names.iter().map(|name| Ok((*name, Standing::at(&directory.join(name))?)));
    refuse(&there.collect::<Result<Vec<_>>>()?, existing, |name, there| known.whose(name, there))
}

/// Refuses a file that [`write_once`] would refuse, before its contents are known.
///
/// # Errors
/// [`Error::InTheWay`], [`Error::File`].
pub fn check_absent(path: &Path, existing: Existing) -> Result<()> {
    refuse(&[("", Standing::at(path)?)], existing, |_, _| Some(Whose::Kept))
}

/// Refuses to write over what was read: `inputs` by name and SHA-256, `files` as [`write_together`]
/// takes them.
///
/// # Errors
/// [`Error::InTheWay`].
pub fn check_apart(
    inputs: &[(String, String)],
    directory: &Path,
    files: &[(String, Vec<u8>)],
    existing: Existing,
) -> Result<()> {
    let read: BTreeMap<PathBuf, &String> =
        inputs.iter().filter_map(|(name, hash)| Some((Path::new(name).canonicalize().ok()?, hash))).collect();
    let is_lost = |(name, contents): &&(String, Vec<u8>)| {
        let path = directory.join(name).canonicalize().ok();
        path.and_then(|path| read.get(&path)).is_some_and(|hash| **hash != sha256(contents))
    };
    let lost: Vec<PathBuf> = files.iter().filter(is_lost).map(|(name, _)| directory.join(name)).collect();
    match lost.is_empty() || existing == Existing::Replace {
        true => Ok(()),
        false => Err(Error::InTheWay { files: lost, whose: Whose::Read }),
    }
}

fn write(directory: &Path, files: &[(String, Vec<u8>)], existing: Existing, known: &Known) -> Result<()> {
    let there = files.iter().map(|(name, _)| Ok((name.as_str(), Standing::at(&directory.join(name))?)));
    let there = there.collect::<Result<Vec<_>>>()?;
    let hashes: BTreeMap<&str, String> =
        files.iter().map(|(name, contents)| (name.as_str(), sha256(contents))).collect();
    // the same bytes are no loss
    refuse(&there, existing, |name, there| match hashes.get(name) == Some(&there.sha256) {
        true => None,
        false => known.whose(name, there),
    })?;
    std::fs::create_dir_all(directory).map_err(failed("create", directory))?;
    let mut finished = Vec::with_capacity(files.len());
    for ((name, contents), (_, there)) in files.iter().zip(there) {
        let path = directory.join(name);
        let mut temporary = tempfile::Builder::new()
            .prefix(".rodcal-")
            .permissions(readable_by_all())
            .tempfile_in(directory)
            .map_err(failed("write", &path))?;
        temporary.write_all(contents).map_err(failed("write", &path))?;
        finished.push((temporary, path, there.is_some()));
    }
    for (temporary, path, was_there) in finished {
        // what has come there in the meantime is not replaced either
        let renamed = match was_there || existing == Existing::Replace {
            true => temporary.persist(&path),
            false => temporary.persist_noclobber(&path),
        };
        renamed.map_err(|e| failed("write", &path)(e.error))?;
    }
    Ok(())
}

fn refuse(
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
enum Known {
    By(Marker),
    Nothing,
}

impl Known {
    /// Whose a file is, where it must not be replaced.
    fn whose(&self, name: &str, there: &Standing) -> Option<Whose> {
        match self {
            Known::Nothing => Some(Whose::Kept),
            Known::By(marker) if marker.is_unchanged(name, &there.sha256) => None,
            Known::By(marker) if marker.names(name) => Some(Whose::Changed),
            Known::By(_) => Some(Whose::Unknown),
        }
    }
}

/// A file that stands where one is to be written.
struct Standing {
    path: PathBuf,
    /// Of its content; empty for a link, which is not a copy of what it leads to.
    sha256: String,
}

impl Standing {
    fn at(path: &Path) -> Result<Option<Standing>> {
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

    /// Files of these names, each with this text.
    fn all(names: &[&str], text: &str) -> Vec<(String, Vec<u8>)> {
        names.iter().map(|name| ((*name).to_owned(), text.as_bytes().to_vec())).collect()
    }

    #[test]
    fn files_are_written_all_or_none() {
        let directory = tempfile::tempdir().unwrap();
        let root = directory.path();
        std::fs::create_dir(root.join("b.txt")).unwrap();
        let files = all(&["a.txt", "b.txt"], "new");
        let error = write_together(root, &files, Existing::Replace).unwrap_err().to_string();
        assert!(error.contains("cannot write") && error.contains("b.txt"), "{error}");
        assert_eq!(std::fs::read_dir(root).unwrap().count(), 1, "only the directory that was in the way");
        std::fs::remove_dir(root.join("b.txt")).unwrap();
        write_together(root, &files, Existing::Keep).unwrap();
        assert!(files.iter().all(|(name, bytes)| &std::fs::read(root.join(name)).unwrap() == bytes));
    }

    #[test]
    fn what_the_program_wrote_is_replaced_and_nothing_else() {
        let directory = tempfile::tempdir().unwrap();
        let root = directory.path();
        let read = |name: &str| std::fs::read_to_string(root.join(name)).unwrap();
        write_together(root, &all(&["a", "b"], "one"), Existing::Keep).unwrap();
        write_together(root, &all(&["a"], "two"), Existing::Keep).unwrap();
        // both are still known
        write_together(root, &all(&["a", "b"], "three"), Existing::Keep).unwrap();
        std::fs::write(root.join("b"), "mine").unwrap();
        let refused = |names: &[&str]| {
            let error = write_together(root, &all(names, "four"), Existing::Keep).unwrap_err();
            assert!(check_free(root, names, Existing::Keep).is_err());
            error.to_string()
        };
        assert!(refused(&["a", "b"]).ends_with("b has been changed since rodcal wrote it"));
        assert_eq!((read("a"), read("b")), ("three".into(), "mine".into()));
        std::fs::write(root.join("c"), "mine too").unwrap();
        assert!(refused(&["c", "d"]).ends_with("c is there already, and rodcal did not write it"));
        assert!(!root.join("d").exists());
        // what is the same is not lost
        write_together(root, &all(&["c"], "mine too"), Existing::Keep).unwrap();
        check_free(root, &["b"], Existing::Replace).unwrap();
        write_together(root, &all(&["a", "b"], "five"), Existing::Replace).unwrap();
        write_together(root, &all(&["a", "b"], "six"), Existing::Keep).unwrap();
        assert_eq!((read("a"), read("b"), read("c")), ("six".into(), "six".into(), "mine too".into()));
    }

    #[test]
    fn a_marker_of_somebody_else_says_nothing() {
        let directory = tempfile::tempdir().unwrap();
        let root = directory.path();
        std::fs::write(root.join("a"), "mine").unwrap();
        let own_list = format!("{}  a\n", sha256(b"mine"));
        std::fs::write(root.join(MARKER), &own_list).unwrap();
        let error = write_together(root, &all(&["a"], "new"), Existing::Keep).unwrap_err().to_string();
        assert!(error.contains("rodcal did not write them") && error.contains(MARKER), "{error}");
        assert_eq!(std::fs::read_to_string(root.join(MARKER)).unwrap(), own_list);
    }

    #[cfg(unix)]
    #[test]
    fn a_link_is_not_replaced_by_a_file() {
        let directory = tempfile::tempdir().unwrap();
        let root = directory.path();
        std::os::unix::fs::symlink("elsewhere", root.join("a")).unwrap();
        assert!(write_together(root, &all(&["a"], "new"), Existing::Keep).is_err());
        assert!(root.join("a").is_symlink() && !root.join("elsewhere").exists());
    }

    #[test]
    fn a_missing_file_is_named() {
        let error = read_text(Path::new("no/such.toml")).unwrap_err();
        assert!(error.to_string().starts_with("cannot read no/such.toml: "));
    }
}
