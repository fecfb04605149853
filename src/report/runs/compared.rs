//! The runs that stand side by side, each with its difference from the first.

use super::{Difference, Run};
use crate::error::{Error, Result};

/// Runs of one command; each is compared with the first.
pub struct Runs {
    pub(super) runs: Vec<Run>,
    pub(super) differences: Vec<Difference>,
}

impl Runs {
    /// Of two runs or more.
    ///
    /// # Errors
    /// [`Error::Argument`] for less than two, and where not all are of one command.
    pub fn new(runs: Vec<Run>) -> Result<Runs> {
        let [first, others @ ..] = &runs[..] else {
            return Err(refused(
                "no run".into(),
                "the folders of two runs or more, as --out writes them".into(),
            ));
        };
        if others.is_empty() {
            let found = format!("{} alone", first.folder);
            return Err(refused(found, "the folders of two runs or more, as --out writes them".into()));
        }
        if let Some(other) = others.iter().find(|other| other.subcommand != first.subcommand) {
            let of_run = |run: &Run| format!("{} (rodcal {})", run.folder, run.subcommand);
            let found = format!("{} and {}", of_run(first), of_run(other));
            return Err(refused(found, "runs of one command".into()));
        }
        let differences =
            others.iter().map(|other| Difference::between(first, other)).collect::<Result<_>>()?;
        let labels = labels(&runs.iter().map(|run| run.folder.as_str()).collect::<Vec<_>>());
        let named = |(run, label): (Run, String)| Run { label, ..run };
        Ok(Runs { runs: runs.into_iter().zip(labels).map(named).collect(), differences })
    }

    /// Each run but the first, with its difference from that.
    pub(super) fn compared(&self) -> impl Iterator<Item = (&Run, &Difference)> {
        self.runs.iter().skip(1).zip(&self.differences)
    }
}

/// The shortest ends of paths, by whole names, that are all different; else the paths.
pub(super) fn labels(folders: &[&str]) -> Vec<String> {
    let end = |folder: &str, count: usize| -> String {
        let names: Vec<&str> = folder.split('/').filter(|name| !name.is_empty()).collect();
        names[names.len().saturating_sub(count)..].join("/")
    };
    let longest = folders.iter().map(|folder| folder.split('/').count()).max().unwrap_or(0);
    let are_apart = |labels: &Vec<String>| {
        let apart: std::collections::BTreeSet<&String> = labels.iter().collect();
        apart.len() == labels.len() && labels.iter().all(|label| !label.is_empty())
    };
    let ends = (1..=longest).map(|count| folders.iter().map(|folder| end(folder, count)).collect());
    let whole = || folders.iter().map(|folder| (*folder).to_owned()).collect();
    ends.into_iter().find(are_apart).unwrap_or_else(whole)
}

fn refused(found: String, expected: String) -> Error {
    Error::Argument { name: "RUNS", found, expected }
}
