//! `rodcal trial make|answer|score`.

mod case;
mod report;

use std::ops::Range;
use std::path::{Path, PathBuf};

use clap::{Args, Subcommand};
use rodcal::delimited::visible;
use rodcal::parallel::in_parallel;
use rodcal::report::text::text_within;
use rodcal::{Error, Result, files};
use rodcal_trial::answers::{self, Answer};
use rodcal_trial::archive::{self, Manifest, Plan};
use rodcal_trial::rig::residuals;
use rodcal_trial::score::{self, PendingFollowUp};
use rodcal_trial::{Seed, Suite};
use serde_json::json;

use self::case::CaseFiles;
use super::output::{Outcome, width};
use super::progress::Progress;

/// Cases that are answered between two writes.
const BLOCK: usize = 8;
/// Columns that a score as plain lines takes.
const WIDE: usize = 100;

#[derive(Debug, Subcommand)]
pub enum Trial {
    /// Draw cases with concealed effects: recordings into DIR, what they conceal into a key beside
    /// it.
    Make(Make),
    /// Diagnose every case of DIR that has no answer yet; the key is not needed and not read.
    Answer(AnswerCases),
    /// Compare the answers with the key.
    Score(ScoreAnswers),
}

#[derive(Debug, Args)]
pub struct Make {
    /// Directory for the cases; made if missing.
    directory: PathBuf,
    /// Every random number comes from this seed, decimal or 0x and hexadecimal; whoever guesses it
    /// knows the key [default: 128 random bits].
    #[arg(long)]
    seed: Option<Seed>,
    /// Only rods at a rig; without this and --calibration two of three cases are of a rig.
    #[arg(long)]
    rig: bool,
    /// Only calibrations of arms.
    #[arg(long, conflicts_with = "rig")]
    calibration: bool,
    /// Only calibrations with effects that imitate each other, both sides of four pairs in turn: 80
    /// cases are ten of each.
    #[arg(long, conflicts_with_all = ["rig", "calibration"])]
    conflicts: bool,
    /// Number of cases.
    #[arg(long, value_name = "N", default_value_t = 400, value_parser = clap::value_parser!(u16).range(1..=9999))]
    cases: u16,
    /// Only the cases from A up to B, B included.
    #[arg(long, value_name = "A..B", value_parser = case_range)]
    case_range: Option<Range<usize>>,
    /// Noise from a real recording: a CSV with a column `residual` in any unit, from which it is
    /// drawn in stretches.
    #[arg(long, value_name = "FILE")]
    residuals: Option<PathBuf>,
    /// File for the key [default: DIR.key.jsonl]
    #[arg(long, value_name = "FILE")]
    key: Option<PathBuf>,
}

#[derive(Debug, Args)]
pub struct AnswerCases {
    /// Directory of the trial.
    directory: PathBuf,
    /// File for the answers, one line each; cases that stand in it already are left alone [default:
    /// DIR/answers.jsonl]
    #[arg(long, value_name = "FILE")]
    answers: Option<PathBuf>,
    /// Only the cases from A up to B, B included.
    #[arg(long, value_name = "A..B", value_parser = case_range)]
    case_range: Option<Range<usize>>,
}

#[derive(Debug, Args)]
pub struct ScoreAnswers {
    /// Directory of the trial.
    directory: PathBuf,
    /// The key [default: DIR.key.jsonl]
    key: Option<PathBuf>,
    /// File of the answers [default: DIR/answers.jsonl]
    #[arg(long, value_name = "FILE")]
    answers: Option<PathBuf>,
}

/// `3..7` as the numbers 3 to 7.
fn case_range(text: &str) -> std::result::Result<Range<usize>, String> {
    let numbers = text.split_once("..").and_then(|(a, b)| Some((a.parse().ok()?, b.parse().ok()?)));
    match numbers {
        Some((first, last)) if (1..=last).contains(&first) && last <= 9999 => Ok(first..last + 1),
        _ => Err("expected two numbers from 1 to 9999, for example 1..100".into()),
    }
}

impl Trial {
    pub fn run(&self) -> Result<Outcome> {
        match self {
            Trial::Make(make) => make.run(),
            Trial::Answer(answer) => answer.run(),
            Trial::Score(score) => score.run(),
        }
    }
}

impl Make {
    fn run(&self) -> Result<Outcome> {
        let range = self.case_range.clone().unwrap_or(1..usize::from(self.cases) + 1);
        let key = key_of(self.key.as_deref(), &self.directory)?;
        let suite = match (self.rig, self.calibration, self.conflicts) {
            (true, ..) => Suite::Rig,
            (_, true, _) => Suite::Calibration,
            (_, _, true) => Suite::Conflicts,
            _ => Suite::Both,
        };
        let residuals = self.residuals.as_deref().map(residuals::read).transpose()?.unwrap_or_default();
        let progress = Progress::new("cases", range.len());
        let plan = Plan { seed: self.seed, suite, residuals, range };
        let staged = archive::make(&self.directory, &key, &plan, || progress.one_more());
        progress.finish();
        let (staged, directory) = (staged?, self.directory.display().to_string());
        let shown = visible(&directory);
        let text = format!(
            "{} in {shown}, key in {} (keep it from whoever answers; it holds the seed).\nrodcal trial answer {shown}\n",
            counted(staged.manifest.cases),
            visible(&key.display().to_string())
        );
        let json = json!({
            "directory": directory,
            "key": key.display().to_string(),
            "cases": staged.manifest.cases,
            "key_sha256": staged.manifest.key_sha256,
        });
        let mut warnings = Vec::new();
        if staged.seed.is_small() {
            warnings.push(format!(
                "the seed {} has fewer than 65 bits and may be guessed, and with it the key: leave --seed out",
                staged.seed
            ));
        }
        Ok(Outcome { warnings, commit: Some(Box::new(|| staged.seal())), ..Outcome::plain(json, text) })
    }
}

/// `1 case`, `40 cases`.
fn counted(cases: usize) -> String {
    format!("{cases} case{}", if cases == 1 { "" } else { "s" })
}

impl AnswerCases {
    fn run(&self) -> Result<Outcome> {
        let manifest = Manifest::read(&self.directory)?;
        manifest.check_directory(&self.directory)?;
        let path = self.answers.clone().unwrap_or_else(|| self.directory.join("answers.jsonl"));
        let given = answers::read(&path)?;
        let number = |case: &str| case.rsplit('-').next().and_then(|number| number.parse::<usize>().ok());
        let is_asked = |case: &String| match (&self.case_range, number(case)) {
            (Some(range), Some(number)) => range.contains(&number),
            _ => true,
        };
        let asked: Vec<String> = manifest.case_names().into_iter().filter(is_asked).collect();
        if let (true, Some(range)) = (asked.is_empty(), &self.case_range) {
            return Err(Error::Argument {
                name: "--case-range",
                found: format!("{}..{}, where the trial has none", range.start, range.end - 1),
                expected: format!("some of its {}", counted(manifest.cases)),
            });
        }
        let open = answers::missing(&asked, &given);
        let progress = Progress::new("cases", open.len());
        let answered = open.chunks(BLOCK).try_for_each(|block| {
            let new = in_parallel(block.len(), |k| {
                let answer = self.answer(&manifest, &block[k]);
                progress.one_more();
                answer
            });
            answers::append(&path, &new.into_iter().collect::<Result<Vec<Answer>>>()?)
        });
        progress.finish();
        answered?;
        let text = format!(
            "{} answered, {} were before: {}\n",
            counted(open.len()),
            asked.len() - open.len(),
            visible(&path.display().to_string())
        );
        let json = json!({
            "answers": path.display().to_string(),
            "answered": open.len(),
            "answered_before": asked.len() - open.len(),
        });
        Ok(Outcome::plain(json, text))
    }

    fn answer(&self, manifest: &Manifest, case: &str) -> Result<Answer> {
        manifest.check_case(&self.directory, case)?;
        // what the diagnosis refuses is an answer too, and the other cases go on
        let files = CaseFiles { directory: self.directory.join(case), changed: Vec::new() };
        let (answer, predicted_um) =
            files.diagnosed().unwrap_or_else(|error| (json!({ "error": error.to_string() }), None));
        Ok(Answer { case: case.to_owned(), answer, sha256: manifest.hashes_of(case), predicted_um })
    }
}

impl ScoreAnswers {
    fn run(&self) -> Result<Outcome> {
        let key = key_of(self.key.as_deref(), &self.directory)?;
        let answers = self.answers.clone().unwrap_or_else(|| self.directory.join("answers.jsonl"));
        if !answers.exists() {
            return Err(Error::Argument {
                name: "--answers",
                found: format!("{}, which is not there", answers.display()),
                expected: "the file that `rodcal trial answer` writes".into(),
            });
        }
        let sealed = score::open(&self.directory, &key, &answers)?;
        let pending = sealed.pending();
        let progress = Progress::new("measured once more", pending.len());
        let outcomes = in_parallel(pending.len(), |k| {
            let outcome = self.follow_up(&pending[k]);
            progress.one_more();
            Ok((pending[k].case.clone(), outcome?))
        });
        progress.finish();
        let score = sealed.score(&outcomes.into_iter().collect::<Result<Vec<_>>>()?);
        // a directory on the command line says nothing of what was in it
        let read = [self.directory.join(archive::MANIFEST), key, answers];
        let hashed =
            |path: &PathBuf| Ok((path.display().to_string(), files::sha256(&files::read_bytes(path)?)));
        let mut inputs = read.iter().map(hashed).collect::<Result<Vec<_>>>()?;
        inputs.retain(|(file, _)| !std::env::args().any(|argument| argument == *file));
        let mut report = report::report(&score);
        report.provenance.extend(sealed.seed().map(|seed| ("seed of the cases".into(), seed.to_string())));
        // on a narrow terminal tables that fit it
        let text = match width() < WIDE {
            true => text_within(&report, width()),
            false => score.text(),
        };
        Ok(Outcome { text: Some(text), inputs, ..Outcome::new(score.json()?, report) })
    }

    /// Makes the measurement that an answer proposes and diagnoses the recording with it.
    fn follow_up(&self, pending: &PendingFollowUp) -> Result<score::Outcome> {
        let changed = match pending.files(&self.directory)? {
            Ok(files) => files,
            Err(outcome) => return Ok(outcome),
        };
        let files = CaseFiles { directory: self.directory.join(&pending.case), changed };
        Ok(match files.diagnosed() {
            Ok((diagnosis, _)) => score::Outcome::Diagnosed(diagnosis),
            Err(error) => score::Outcome::NotDone(error.to_string()),
        })
    }
}

fn key_of(key: Option<&Path>, directory: &Path) -> Result<PathBuf> {
    key.map_or_else(|| archive::default_key(directory), |key| Ok(key.to_owned()))
}
