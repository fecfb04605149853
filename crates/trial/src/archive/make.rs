//! Making a trial: case by case beside its place, and only when it is complete there.
//!
//! Until then the cases stand in `DIR.part` and the truths in `KEY.part`, seed and all. A run that
//! is killed leaves both, and the same command goes on with them; one that fails leaves nothing.
//! Only one run at a time works with them.

#[cfg(test)]
mod tests;

use std::collections::BTreeMap;
use std::ops::Range;
use std::path::{Component, Path, PathBuf};

use serde::{Deserialize, Serialize};

use super::{MANIFEST, Manifest, key_of, line, parsed, text_of};
use crate::ground_truth::GroundTruth;
use crate::{Seed, Source, Suite};
use rodcal_base::error::{Error, Place, Result, Whose};
use rodcal_base::files::{self, Created, Existing, Lock};
use rodcal_base::parallel::in_parallel;

/// Cases made before any of them is written.
const BLOCK: usize = 32;

/// What is to be made.
#[derive(Debug, Clone, PartialEq)]
pub struct Plan {
    /// Nothing: one that nobody guesses, or that of the run that is gone on with.
    pub seed: Option<Seed>,
    /// What is tried.
    pub suite: Suite,
    /// As [`Source::residuals`].
    pub residuals: Vec<f64>,
    /// Numbers of the cases.
    pub range: Range<usize>,
}

/// First line of what is kept of a trial that is being made.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
struct Begun {
    begun: Of,
}

#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
struct Of {
    made_by: String,
    seed: Seed,
    #[serde(rename = "half")]
    suite: String,
    first: usize,
    end: usize,
    residuals_sha256: String,
}

/// A trial that is complete and not yet in its place; dropped without [`StagedTrial::seal`] it is
/// gone.
#[derive(Debug)]
#[must_use]
pub struct StagedTrial {
    /// What its directory will say.
    pub manifest: Manifest,
    /// From which its cases were drawn.
    pub seed: Seed,
    part: Part,
    key_text: String,
}

/// What is there until a trial is complete.
#[derive(Debug)]
struct Part {
    directory: PathBuf,
    key: PathBuf,
    folder: PathBuf,
    truths: PathBuf,
    /// Directories above both that were missing.
    created: Vec<Created>,
    /// Of the truths; gone after them.
    _lock: Lock,
}

impl Drop for Part {
    fn drop(&mut self) {
        files::remove_tree(&self.folder);
        files::remove_tree(&self.truths);
    }
}

impl StagedTrial {
    /// Puts cases and key in their places.
    ///
    /// # Errors
    /// [`Error::File`], [`Error::InTheWay`] for a key that has come there; nothing is left then.
    pub fn seal(mut self) -> Result<()> {
        let Part { directory, key, folder, .. } = &self.part;
        // in this order: what is killed between the two goes on, for the same key may stand there
        let is_own = key.symlink_metadata().is_err();
        files::write_new(key, self.key_text.as_bytes(), Existing::Keep)?;
        files::move_to(folder, directory).inspect_err(|_| {
            // the same key may be that of a trial that has come there
            if is_own {
                files::remove_tree(key);
            }
        })?;
        self.part.created.drain(..).for_each(Created::keep);
        Ok(())
    }
}

/// Draws cases by number; `made` is called after each. An empty directory may stand where they go.
///
/// # Errors
/// [`Error::Argument`] where the key would be in the trial's directory; [`Error::InTheWay`] where a
/// trial or a key is there already; [`Error::Input`] where another one has been begun;
/// [`Error::File`].
pub fn make(directory: &Path, key: &Path, plan: &Plan, made: impl Fn() + Sync + Send) -> Result<StagedTrial> {
    if inside(&normal(key), &normal(directory)) {
        return Err(Error::Argument {
            name: "--key",
            found: format!("{}, which is in the trial's directory", key.display()),
            expected: "a place that whoever answers does not see".into(),
        });
    }
    let (folder, truths) = (with_part(directory)?, with_part(key)?);
    let lock = files::lock(&truths)?;
    let is_begun = lock.is_some();
    let kept = |path: &Path| Err(Error::InTheWay { files: vec![path.to_owned()], whose: Whose::Kept });
    let is_there = |path: &Path| path.symlink_metadata().is_ok();
    if is_there(directory) && !(directory.is_dir() && files::names_in(directory).is_empty()) {
        let manifest = directory.join(MANIFEST);
        if is_begun && is_sealed(&truths, key) {
            // killed when everything was done but this
            files::remove_tree(&truths);
        }
        return kept(if is_there(&manifest) { &manifest } else { directory });
    }
    if is_there(key) && !is_begun {
        return kept(key);
    }
    if is_there(&folder) && !is_begun {
        return kept(&folder);
    }
    let (seed, mut lines) = match is_begun {
        true => begun(&truths, plan)?,
        false => (plan.seed.map_or_else(Seed::secret, Ok)?, String::new()),
    };
    let above = |path: &Path| files::create_directories(path.parent().unwrap_or(Path::new("")));
    let created = vec![above(directory)?, above(key)?];
    let lock = match lock {
        Some(lock) => lock,
        None => {
            files::write_new(&truths, line(&Begun { begun: plan.of(seed) })?.as_bytes(), Existing::Keep)?;
            files::lock(&truths)?.ok_or_else(|| gone(&truths))?
        }
    };
    let (directory, key) = (directory.to_owned(), key.to_owned());
    let part = Part { directory, key, folder, truths, created, _lock: lock };
    let source = Source { seed, suite: plan.suite, residuals: plan.residuals.clone() };
    let mut next = plan.range.start + lines.lines().count();
    (plan.range.start..next).for_each(|_| made());
    while next < plan.range.end {
        let block = BLOCK.min(plan.range.end - next);
        let cases = in_parallel(block, |k| {
            let case = source.case(next + k);
            made();
            case
        });
        let mut new = String::new();
        for case in cases {
            let folder = part.folder.join(&case.truth.case);
            for (name, text) in case.files {
                files::write_whole(&folder.join(name), text.as_bytes())?;
            }
            new += &line(&case.truth)?;
        }
        // once its truth is kept a case is not made again
        files::append(&part.truths, new.as_bytes())?;
        lines += &new;
        next += block;
    }
    let truths: Vec<GroundTruth> = lines
        .lines()
        .enumerate()
        .map(|(k, line)| parsed(&part.truths, k + 2, line))
        .collect::<Result<_>>()?;
    let mut hashes = BTreeMap::new();
    for GroundTruth { case, .. } in &truths {
        for name in files::names_in(&part.folder.join(case)) {
            let name = format!("{case}/{name}");
            hashes.insert(name.clone(), files::sha256(&files::read_inside(&part.folder, &name)?));
        }
    }
    let manifest = Manifest {
        made_by: PROGRAM.into(),
        cases: plan.range.len(),
        key_sha256: files::sha256(lines.as_bytes()),
        files: hashes,
    };
    files::write_whole(&part.folder.join(MANIFEST), text_of(&manifest)?.as_bytes())?;
    Ok(StagedTrial { key_text: key_of(&manifest, &lines)?, manifest, seed, part })
}

const PROGRAM: &str = concat!("rodcal ", env!("CARGO_PKG_VERSION"));

impl Plan {
    fn of(&self, seed: Seed) -> Of {
        let bytes: Vec<u8> = self.residuals.iter().flat_map(|residual| residual.to_le_bytes()).collect();
        Of {
            made_by: PROGRAM.into(),
            seed,
            suite: format!("{:?}", self.suite),
            first: self.range.start,
            end: self.range.end,
            residuals_sha256: files::sha256(&bytes),
        }
    }
}

/// Seed and truths of a trial that was begun, if it is the one that is planned; half a line at the
/// end is taken away.
fn begun(truths: &Path, plan: &Plan) -> Result<(Seed, String)> {
    let mut bytes = files::read_bytes(truths)?;
    let length = bytes.len();
    bytes.truncate(bytes.iter().rposition(|&byte| byte == b'\n').map_or(0, |last| last + 1));
    let text = files::text_of_bytes(&truths.display().to_string(), bytes)?;
    let another = || Error::Input {
        at: Place { file: truths.display().to_string(), line: 1, column: 0 },
        found: "another trial has been begun here".into(),
        expected: "the same options, to go on with it".into(),
        hint: Some("give another name, or remove this file and the .part folder of its cases".into()),
    };
    let (first, lines) = text.split_once('\n').ok_or_else(another)?;
    let Begun { begun } = serde_json::from_str(first).map_err(|_| another())?;
    let seed = plan.seed.unwrap_or(begun.seed);
    if begun != plan.of(seed) || lines.lines().count() > plan.range.len() {
        return Err(another());
    }
    if text.len() < length {
        files::shorten(truths, text.len())?;
    }
    Ok((seed, lines.to_owned()))
}

/// Somebody has removed what was just written.
fn gone(path: &Path) -> Error {
    let source = std::io::Error::from(std::io::ErrorKind::NotFound);
    Error::File { path: path.to_owned(), action: "write", source }
}

/// Whether the key holds all of the truths that are kept.
fn is_sealed(truths: &Path, key: &Path) -> bool {
    let (truths, key) = (files::read_text(truths), files::read_text(key));
    let below = |text: &str| text.split_once('\n').map(|(_, cases)| cases.to_owned());
    matches!((truths, key), (Ok(truths), Ok(key)) if below(&truths).is_some() && below(&truths) == below(&key))
}

/// `DIR.part`.
fn with_part(path: &Path) -> Result<PathBuf> {
    let Some(name) = path.file_name() else {
        return Err(Error::Argument {
            name: "DIR",
            found: path.display().to_string(),
            expected: "a directory by its name".into(),
        });
    };
    let mut name = name.to_owned();
    name.push(".part");
    Ok(path.with_file_name(name))
}

/// From the root, without `.`, `..` and, as far as there is something, links.
fn normal(path: &Path) -> PathBuf {
    let mut normal = std::env::current_dir().unwrap_or_default();
    for part in path.components() {
        match part {
            Component::ParentDir => drop(normal.pop()),
            Component::CurDir => {}
            part => normal.push(part),
        }
        normal = normal.canonicalize().unwrap_or(normal);
    }
    normal
}

fn inside(path: &Path, directory: &Path) -> bool {
    path.starts_with(directory)
}
