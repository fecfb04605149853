//! `rodcal compare-runs RUN RUN…`.

use std::path::PathBuf;

use clap::Args;
use rodcal::report::runs::{Run, Runs, json, report};
use rodcal::{Error, Result, files};

use super::output::Outcome;
use super::provenance::RESULT;

#[derive(Debug, Args)]
#[command(after_long_help = NOTES)]
pub struct CompareRuns {
    /// Folders of results of one command, as --out writes them: two or more. Each is compared with
    /// the first.
    #[arg(required = true, num_args = 2.., value_name = "RUN")]
    runs: Vec<PathBuf>,
}

const NOTES: &str = "\
It reads result.json of each folder: which input files have another content
(by SHA-256), how far each parameter moved in units of its standard error, how
the errors changed, what was found in one run and not in the other.

A difference is significant where chance alone makes one as large among all
parameters in 5 % of cases at most. Of two runs on the same recording this is
not stated: their random errors are partly common.";

impl CompareRuns {
    pub fn run(&self) -> Result<Outcome> {
        let read = |folder: &PathBuf| {
            let path = folder.join(RESULT);
            if folder.is_dir() && !path.exists() {
                return Err(Error::Argument {
                    name: "RUN",
                    found: format!("{}, which holds no {RESULT}", folder.display()),
                    expected: "a folder that a command of rodcal wrote with --out".into(),
                });
            }
            let text = files::read_text(&path)?;
            Run::from_text(&folder.display().to_string(), &path.display().to_string(), &text)
        };
        let runs = Runs::new(self.runs.iter().map(read).collect::<Result<_>>()?)?;
        Ok(Outcome::new(json(&runs), report(&runs)))
    }
}
