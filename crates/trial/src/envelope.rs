//! The sealed envelope: cases in one directory, what they conceal in a file of its own.
//!
//! ```text
//! DIR/manifest.json              how many cases, SHA-256 of every file of them and of the key; nothing of the seed
//! DIR/rig/case-0001/rod.toml     the rod as its file has it
//! DIR/rig/case-0001/readings.csv what was read
//! DIR/rig/case-0001/asked.csv    what would have been read here?
//! DIR/rig/case-0001/rod-2.toml   other rods, beside some of the cases
//! DIR/calibration/case-0003/     a campaign: campaign.toml, robot.toml, measurements.csv, and rod.toml where there is a rod;
//!                                asked.toml, asked.csv, asked_rod.toml: where would the ball be there?
//! DIR.key.jsonl                  the key: one line for each case
//! ```
//!
//! Whoever answers sees DIR alone. Whoever scores compares the hashes, so that neither the key nor
//! a recording can have been changed since. The seed decides everything: draw one that nobody
//! guesses and keep it with the key.

use std::collections::BTreeMap;
use std::ops::Range;
use std::path::{Path, PathBuf};

use serde::{Deserialize, Serialize};

use super::Source;
use super::truth::Truth;
use rodcal_base::error::{Error, Place, Result};
use rodcal_base::files::{self, Existing};
use rodcal_base::parallel::in_parallel;

/// Name of the manifest in a trial's directory.
pub const MANIFEST: &str = "manifest.json";
/// Cases made before any of them is written.
const BLOCK: usize = 32;

/// What a trial's directory says about itself.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Manifest {
    /// Program and version.
    pub made_by: String,
    /// Number of cases.
    pub cases: usize,
    /// SHA-256 of the key.
    pub key_sha256: String,
    /// SHA-256 of each file, by its name in the directory.
    pub files: BTreeMap<String, String>,
}

/// Where the key goes unless somebody says otherwise: beside the directory.
///
/// # Errors
/// [`Error::Argument`] for a directory without a name of its own, as `.` is.
pub fn default_key(directory: &Path) -> Result<PathBuf> {
    let Some(name) = directory.file_name() else {
        return Err(Error::Argument {
            name: "DIR",
            found: directory.display().to_string(),
            expected: "a directory by its name, or the key's file too".into(),
        });
    };
    let mut name = name.to_owned();
    name.push(".key.jsonl");
    Ok(directory.with_file_name(name))
}

/// Draws cases by number and seals them; `made` is called after each.
///
/// # Errors
/// [`Error::Argument`] where the key would be in the trial's directory; [`Error::InTheWay`] where a
/// trial or a key is there already; [`Error::File`].
pub fn make(
    directory: &Path,
    key: &Path,
    source: &Source,
    range: Range<usize>,
    existing: Existing,
    made: impl Fn() + Sync + Send,
) -> Result<Manifest> {
    if key.starts_with(directory) {
        return Err(Error::Argument {
            name: "--key",
            found: format!("{}, which is in the trial's directory", key.display()),
            expected: "a place that whoever answers does not see".into(),
        });
    }
    // the answers to a trial belong to its cases, and nothing else knows what its key knows
    files::check_absent(&directory.join(MANIFEST), existing)?;
    files::check_absent(key, existing)?;
    let (mut hashes, mut lines) = (BTreeMap::new(), String::new());
    let mut next = range.start;
    while next < range.end {
        let block = BLOCK.min(range.end - next);
        let cases = in_parallel(block, |k| {
            let case = source.case(next + k);
            made();
            case
        });
        for case in cases {
            let named: Vec<(String, Vec<u8>)> =
                case.files.into_iter().map(|(name, text)| (name, text.into_bytes())).collect();
            for (name, bytes) in &named {
                hashes.insert(format!("{}/{name}", case.truth.case), files::sha256(bytes));
            }
            files::write_once(&directory.join(&case.truth.case), &named, existing)?;
            lines += &line(&case.truth)?;
        }
        next += block;
    }
    let manifest = Manifest {
        made_by: concat!("rodcal ", env!("CARGO_PKG_VERSION")).into(),
        cases: range.len(),
        key_sha256: files::sha256(lines.as_bytes()),
        files: hashes,
    };
    files::write_new(key, lines.as_bytes(), existing)?;
    let text = serde_json::to_string_pretty(&manifest).map_err(unwritable)? + "\n";
    files::write_new(&directory.join(MANIFEST), text.as_bytes(), existing)?;
    Ok(manifest)
}

/// One line of JSON.
///
/// # Errors
/// [`Error::Numerical`] for numbers that JSON has no words for.
pub(super) fn line(value: &impl Serialize) -> Result<String> {
    Ok(serde_json::to_string(value).map_err(unwritable)? + "\n")
}

pub(super) fn unwritable(error: serde_json::Error) -> Error {
    Error::Numerical { what: "writing JSON", why: error.to_string() }
}

/// Text of JSON, with its place in errors.
pub(super) fn parsed<T: serde::de::DeserializeOwned>(file: &Path, line: usize, text: &str) -> Result<T> {
    serde_json::from_str(text).map_err(|error| Error::Syntax {
        at: Place { file: file.display().to_string(), line: line + error.line() - 1, column: error.column() },
        message: error.to_string(),
    })
}

impl Manifest {
    /// Of a trial's directory.
    ///
    /// # Errors
    /// [`Error::File`], [`Error::Syntax`].
    pub fn read(directory: &Path) -> Result<Manifest> {
        let path = directory.join(MANIFEST);
        parsed(&path, 1, &files::read_text(&path)?)
    }

    /// Names of the cases, in order: `rig/case-0001`.
    pub fn case_names(&self) -> Vec<String> {
        let mut names: Vec<String> =
            self.files.keys().filter_map(|f| Some(f.rsplit_once('/')?.0.into())).collect();
        names.dedup();
        names
    }

    /// SHA-256 of the files of a case, by their names in it.
    pub fn hashes_of(&self, case: &str) -> BTreeMap<String, String> {
        let inside = |file: &str| Some(file.strip_prefix(case)?.strip_prefix('/')?.to_owned());
        self.files.iter().filter_map(|(file, hash)| Some((inside(file)?, hash.clone()))).collect()
    }

    /// Refuses a case whose files are not those that were sealed.
    ///
    /// # Errors
    /// [`Error::File`], [`Error::Input`].
    pub fn check_case(&self, directory: &Path, case: &str) -> Result<()> {
        for (name, sealed) in self.hashes_of(case) {
            let path = directory.join(case).join(name);
            compare(&path, &files::read_bytes(&path)?, &sealed)?;
        }
        Ok(())
    }

    /// The key, if it is the one that was sealed.
    ///
    /// # Errors
    /// [`Error::File`], [`Error::Input`] for another key, [`Error::Syntax`].
    pub fn read_key(&self, key: &Path) -> Result<Vec<Truth>> {
        let bytes = files::read_bytes(key)?;
        compare(key, &bytes, &self.key_sha256)?;
        let text = files::text_of_bytes(&key.display().to_string(), bytes)?;
        text.lines().enumerate().map(|(number, line)| parsed(key, number + 1, line)).collect()
    }
}

fn compare(path: &Path, bytes: &[u8], sealed: &str) -> Result<()> {
    let found = files::sha256(bytes);
    if found == sealed {
        return Ok(());
    }
    Err(Error::Input {
        at: Place::whole_file(&path.display().to_string()),
        found: format!("its SHA-256 is {found}"),
        expected: format!("{sealed}, as the manifest seals it"),
        hint: Some("the file is of another trial, or was changed after the trial was made".into()),
    })
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::Half;

    fn source(seed: u64) -> Source {
        Source { seed, half: Half::Rig, residuals: Vec::new() }
    }

    fn trial(directory: &Path) -> (PathBuf, PathBuf) {
        let (trial, key) = (directory.join("t"), directory.join("t.key.jsonl"));
        make(&trial, &key, &source(5), 1..4, Existing::Keep, || {}).unwrap();
        (trial, key)
    }

    #[test]
    fn the_hash_is_that_of_the_standard() {
        // FIPS 180-4, the example "abc"
        assert!(files::sha256(b"abc").starts_with("ba7816bf8f01cfea"));
    }

    #[test]
    fn the_same_seed_makes_the_same_bytes_and_the_manifest_says_nothing_of_it() {
        let (a, b) = (tempfile::tempdir().unwrap(), tempfile::tempdir().unwrap());
        let ((a, key_a), (b, key_b)) = (trial(a.path()), trial(b.path()));
        for name in [MANIFEST, "rig/case-0001/readings.csv", "rig/case-0003/rod.toml"] {
            assert_eq!(files::read_bytes(&a.join(name)).unwrap(), files::read_bytes(&b.join(name)).unwrap());
        }
        assert_eq!(files::read_bytes(&key_a).unwrap(), files::read_bytes(&key_b).unwrap());
        let manifest = Manifest::read(&a).unwrap();
        assert_eq!(manifest.case_names(), ["rig/case-0001", "rig/case-0002", "rig/case-0003"]);
        assert!(!files::read_text(&a.join(MANIFEST)).unwrap().contains("seed"));
        assert_eq!(manifest.read_key(&key_a).unwrap().len(), 3);
        assert!(make(&a, &key_a, &source(6), 1..2, Existing::Keep, || {}).is_err());
        assert!(make(&b.join("new"), &b.join("new/key"), &source(6), 1..2, Existing::Keep, || {}).is_err());
        assert!(default_key(Path::new(".")).is_err());
    }

    #[test]
    fn another_key_and_a_changed_recording_are_refused() {
        let directory = tempfile::tempdir().unwrap();
        let (trial, key) = trial(directory.path());
        let manifest = Manifest::read(&trial).unwrap();
        assert!(manifest.check_case(&trial, "rig/case-0002").is_ok());
        files::append(&trial.join("rig/case-0002/readings.csv"), b"y,1,2\n").unwrap();
        let error = manifest.check_case(&trial, "rig/case-0002").unwrap_err();
        assert!(error.to_string().contains("readings.csv"), "{error}");
        files::append(&key, b"{}\n").unwrap();
        assert!(matches!(manifest.read_key(&key), Err(Error::Input { .. })));
    }
}
