//! `rodcal diagnose rig ROD READINGS`, `rodcal diagnose calibration CAMPAIGN`.

mod calibration;
mod listed;

use std::path::{Path, PathBuf};

use clap::{Args, Subcommand};
use rodcal::diagnosis::rig::effects::registry;
use rodcal::diagnosis::rig::{Correction, diagnose_among};
use rodcal::rig::readings::Readings;
use rodcal::rod::Rod;
use rodcal::{Result, files, report};

use self::listed::listed;
use super::output::Outcome;

/// More rods than these in one directory are not compared.
const MOST_NEIGHBOURS: usize = 50;

#[derive(Debug, Subcommand)]
pub enum Diagnose {
    /// Which physics the model of a rod left out: located, named, measured, confirmed on held-out
    /// readings.
    Rig(Rig),
    /// Which physics of robot, rod, fixture or procedure a calibration left out: which joint,
    /// clamp, time or pose.
    Calibration(calibration::Calibration),
}

#[derive(Debug, Args)]
#[command(after_long_help = notes())]
pub struct Rig {
    /// Rod file (TOML), or the word `linear`: straight lines through the origin, of any slope.
    rod: PathBuf,
    /// Readings (CSV): how far the tip moved under each load. `rodcal rig fit --help` shows one.
    readings: PathBuf,
    /// Also write what was found into a rod file and into readings that `compliance`, `rig fit`,
    /// `calibrate` and `compare` read, `*-diagnosed.toml` and `*-diagnosed.csv` [without --out: in
    /// reports/diagnosed].
    #[arg(long)]
    apply: bool,
}

fn notes() -> String {
    let effects = listed(registry::ALL.iter().map(|known| &known.effect));
    format!(
        "\
The model is the rod as its file gives it; nothing is fitted. Readings that
differ from it are explained by as few of these effects as possible:

{effects}
Effects that these readings cannot distinguish are listed, with the measurement
that would distinguish them. What no effect explains is described, not named.
Optional columns make more effects testable: trial, phase (load, unload),
time_s, temperature_c, session, loaded_at_s.

Exit status: 0 the readings agree with the model; 1 they do not, and the first
line says why; 2 could not run."
    )
}

impl Diagnose {
    pub fn run(&self) -> Result<Outcome> {
        match self {
            Diagnose::Rig(rig) => rig.run(),
            Diagnose::Calibration(calibration) => calibration.run(),
        }
    }
}

impl Rig {
    fn run(&self) -> Result<Outcome> {
        let rod = if self.rod == Path::new("linear") { None } else { Some(Rod::read(&self.rod)?) };
        let readings = Readings::read(&self.readings)?;
        let others = if rod.is_some() { neighbours(&self.rod) } else { Vec::new() };
        let found = diagnose_among(&readings, rod.as_ref(), &others)?;
        let correction = found.correction()?;
        let mut report = report::diagnosis::rig::report(&found, correction.as_ref());
        let model = rod.as_ref().map_or("none, straight lines".into(), |_| self.rod.display().to_string());
        report.provenance = vec![
            ("rod file".into(), model),
            ("readings".into(), self.readings.display().to_string()),
            ("program".into(), concat!("rodcal ", env!("CARGO_PKG_VERSION")).into()),
        ];
        let mut json = report::diagnosis::rig::json(&found, correction.as_ref());
        let mut outcome_files = Vec::new();
        let mut default_directory = None;
        if self.apply {
            outcome_files =
                correction.as_ref().map(|correction| self.applied(correction)).unwrap_or_default();
            if outcome_files.is_empty() {
                report.warnings.push(match rod {
                    Some(_) => "--apply has no effect: nothing was found that could be applied".into(),
                    None => "--apply has no effect without a rod file".into(),
                });
            } else {
                default_directory = Some(PathBuf::from("reports/diagnosed"));
                json["applied"] = outcome_files.iter().map(|(name, _)| name.as_str()).collect();
            }
        }
        let mut outcome = Outcome::new(json, report);
        outcome.files = outcome_files;
        outcome.default_directory = default_directory;
        outcome.status = u8::from(found.diagnosis.is_mismatch());
        Ok(outcome)
    }

    /// Names and contents of the rod file and the readings with what was found.
    fn applied(&self, correction: &Correction) -> Vec<(String, Vec<u8>)> {
        let stem = |path: &Path| path.file_stem().unwrap_or_default().to_string_lossy().into_owned();
        vec![
            (format!("{}-diagnosed.toml", stem(&self.rod)), correction.rod_toml.clone().into_bytes()),
            (format!("{}-diagnosed.csv", stem(&self.readings)), correction.readings_csv.clone().into_bytes()),
        ]
    }
}

/// The rods whose files stand beside `file`, by their file names: one of them may have been on the
/// rig.
pub fn neighbours(file: &Path) -> Vec<(String, Rod)> {
    let named = |path: PathBuf| {
        let name = path.file_name()?.to_string_lossy().into_owned();
        Some((name, Rod::read(&path).ok()?))
    };
    files::beside(file).into_iter().take(MOST_NEIGHBOURS).filter_map(named).collect()
}
