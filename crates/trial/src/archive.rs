//! The archive of a trial, sealed: cases in one directory, what they conceal in a file of its own.
//!
//! ```text
//! DIR/manifest.json              how many cases, SHA-256 of every file of them and of the key; nothing of the seed
//! DIR/rig/case-0001/rod.toml     the rod as its file has it
//! DIR/rig/case-0001/readings.csv what was read
//! DIR/rig/case-0001/asked.csv    what would have been read here?
//! DIR/rig/case-0001/rod-2.toml   other rods, beside some of the cases
//! DIR/calibration/case-0003/     a campaign: campaign.toml, robot.toml, measurements.csv, and rod.toml where there is a rod;
//!                                asked.toml, asked.csv, asked_rod.toml: where would the ball be there?
//! DIR.key.jsonl                  the key: what it belongs to, then one line for each case
//! ```
//!
//! Whoever answers sees DIR alone. Whoever scores compares the hashes: the manifest has that of the
//! key's cases, and the first line of the key has that of the manifest, so that neither can have
//! been changed since, nor can a case have been dropped, added or cut. The seed decides everything;
//! it stands in the key.

mod make;

use std::collections::BTreeMap;
use std::path::{Path, PathBuf};

use serde::{Deserialize, Serialize};

pub use self::make::{Plan, StagedTrial, make};

use super::ground_truth::GroundTruth;
use rodcal_base::delimited::quoted;
use rodcal_base::error::{Error, Place, Result};
use rodcal_base::files;
use rodcal_base::limits;

/// Name of the manifest in a trial's directory.
pub const MANIFEST: &str = "manifest.json";
/// The folders of cases in it.
const SUITES: [&str; 2] = ["rig", "calibration"];

/// What a trial's directory says about itself.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Manifest {
    /// Program and version.
    pub made_by: String,
    /// Number of cases.
    pub cases: usize,
    /// SHA-256 of the key's cases: all of it below its first line.
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
        message: rodcal_base::delimited::message(&error.to_string()),
    })
}

/// The first line of a key.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
struct Head {
    trial: Seal,
}

/// What a key belongs to.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
struct Seal {
    made_by: String,
    cases: usize,
    /// SHA-256 of the manifest.
    manifest_sha256: String,
}

/// A manifest as text.
fn text_of(manifest: &Manifest) -> Result<String> {
    Ok(serde_json::to_string_pretty(manifest).map_err(unwritable)? + "\n")
}

/// The key's cases under what they belong to.
fn key_of(manifest: &Manifest, cases: &str) -> Result<String> {
    let seal = Seal {
        made_by: manifest.made_by.clone(),
        cases: manifest.cases,
        manifest_sha256: files::sha256(text_of(manifest)?.as_bytes()),
    };
    Ok(line(&Head { trial: seal })? + cases)
}

impl Manifest {
    /// Of a trial's directory.
    ///
    /// # Errors
    /// [`Error::File`], [`Error::Syntax`]; [`Error::Input`] where it names a file outside of its
    /// cases, or has another number of cases than it says.
    pub fn read(directory: &Path) -> Result<Manifest> {
        let path = directory.join(MANIFEST);
        let bytes = files::read_inside(directory, MANIFEST)?;
        let text = files::text_of_bytes(&path.display().to_string(), bytes)?;
        let manifest: Manifest = parsed(&path, 1, &text)?;
        let wrong = |found: String, expected: String| Error::Input {
            at: Place::whole_file(&path.display().to_string()),
            found,
            expected,
            hint: None,
        };
        if let Some(name) = manifest.files.keys().find(|name| !is_of_a_case(name)) {
            let expected = "files of cases, such as rig/case-0001/rod.toml".to_owned();
            return Err(wrong(format!("it names {}", quoted(name)), expected));
        }
        let count = manifest.case_names().len();
        limits::check(&path.display().to_string(), count, limits::TRIAL_CASES, "cases")?;
        if count != manifest.cases {
            let found = format!("it has files of {count} cases");
            return Err(wrong(found, format!("the {} that it says", manifest.cases)));
        }
        Ok(manifest)
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
        let hashes = self.hashes_of(case);
        for (name, sealed) in &hashes {
            let name = format!("{case}/{name}");
            compare(&directory.join(&name), &files::read_inside(directory, &name)?, sealed)?;
        }
        let mut there = files::names_in(&directory.join(case));
        there.retain(|name| !hashes.contains_key(name));
        self.refuse_unsealed(&directory.join(case), &there)
    }

    /// Refuses a directory with cases that were not sealed.
    ///
    /// # Errors
    /// [`Error::Input`].
    pub fn check_directory(&self, directory: &Path) -> Result<()> {
        let sealed = self.case_names();
        SUITES.iter().try_for_each(|suite| {
            let mut there = files::names_in(&directory.join(suite));
            there.retain(|name| !sealed.contains(&format!("{suite}/{name}")));
            self.refuse_unsealed(&directory.join(suite), &there)
        })
    }

    fn refuse_unsealed(&self, directory: &Path, there: &[String]) -> Result<()> {
        let Some(first) = there.first() else { return Ok(()) };
        Err(Error::Input {
            at: Place::whole_file(&directory.join(first).display().to_string()),
            found: "it is not in the manifest".into(),
            expected: "what was sealed and nothing else".into(),
            hint: Some("remove it: it was put there after the trial was made".into()),
        })
    }

    /// The key, if it is the one that was sealed with the manifest in `directory`, and whether it
    /// says so: one of a former version says nothing of the manifest.
    ///
    /// # Errors
    /// [`Error::File`], [`Error::Input`] for another key or other cases, [`Error::Syntax`].
    pub fn read_key(&self, directory: &Path, key: &Path) -> Result<(Vec<GroundTruth>, bool)> {
        let name = key.display().to_string();
        let text = files::text_of_bytes(&name, files::read_bytes(key)?)?;
        let (first, rest) = text.split_once('\n').unwrap_or((&text, ""));
        let head = serde_json::from_str::<Head>(first).ok();
        let cases = if head.is_some() { rest } else { &text };
        compare(key, cases.as_bytes(), &self.key_sha256)?;
        let wrong = |found: String, expected: String| Error::Input {
            at: Place::whole_file(&name),
            found,
            expected,
            hint: Some("key and manifest are of different trials, or one was changed since".into()),
        };
        if let Some(Head { trial }) = &head {
            let manifest = directory.join(MANIFEST);
            compare(&manifest, &files::read_inside(directory, MANIFEST)?, &trial.manifest_sha256)?;
        }
        let above = usize::from(head.is_some());
        let truths = cases.lines().enumerate().map(|(number, line)| parsed(key, number + 1 + above, line));
        let truths: Vec<GroundTruth> = truths.collect::<Result<_>>()?;
        let mut named: Vec<&str> = truths.iter().map(|truth| truth.case.as_str()).collect();
        named.sort_unstable();
        if named != self.case_names() {
            let (found, expected) = (named.len(), self.cases);
            let found = format!("it has {found} cases, not all those of the manifest");
            return Err(wrong(found, format!("the {expected} cases of the manifest, once each")));
        }
        Ok((truths, head.is_some()))
    }
}

/// `rig/case-0001/rod.toml`.
fn is_of_a_case(name: &str) -> bool {
    let parts: Vec<&str> = name.split('/').collect();
    let [suite, case, file] = parts[..] else { return false };
    let is_number = |text: &str| !text.is_empty() && text.bytes().all(|b| b.is_ascii_digit());
    let is_plain = |c: char| c.is_ascii_alphanumeric() || "._-".contains(c);
    SUITES.contains(&suite)
        && case.strip_prefix("case-").is_some_and(is_number)
        && !file.is_empty()
        && !file.starts_with('.')
        && file.chars().all(is_plain)
}

fn compare(path: &Path, bytes: &[u8], sealed: &str) -> Result<()> {
    let found = files::sha256(bytes);
    if found == sealed {
        return Ok(());
    }
    Err(Error::Input {
        at: Place::whole_file(&path.display().to_string()),
        found: format!("its SHA-256 is {found}"),
        expected: format!("{sealed}, as it was sealed"),
        hint: Some("the file is of another trial, or was changed after the trial was made".into()),
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_hash_is_that_of_the_standard() {
        // FIPS 180-4, the example "abc"
        assert!(files::sha256(b"abc").starts_with("ba7816bf8f01cfea"));
    }

    #[test]
    fn only_files_of_cases_are_files_of_a_trial() {
        assert!(is_of_a_case("rig/case-0001/rod.toml") && is_of_a_case("calibration/case-12/rod-2.toml"));
        for name in [
            "../x",
            "/etc/passwd",
            "rig/../x",
            "rig/case-0001/..",
            "rig/case-0001",
            "rig/case-1/a/b",
            "rig/case-x/a",
            "x/case-1/a",
            "rig/case-1/",
            "rig/case-1/.a",
            "rig//a",
            "rig/case-1/a\n",
            "rig/case-1/a\\b",
            "",
        ] {
            assert!(!is_of_a_case(name), "{name}");
        }
    }
}
