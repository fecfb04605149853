//! `rodcal diagnose rig ROD READINGS`, `rodcal diagnose calibration CAMPAIGN`.

mod calibration;

use std::path::{Path, PathBuf};

use clap::{Args, Subcommand};
use rodcal::diagnosis::rig::{RigDiagnosis, diagnose};
use rodcal::rig::readings::Readings;
use rodcal::rod::Rod;
use rodcal::{Result, report};

use super::output::Outcome;

#[derive(Debug, Subcommand)]
pub enum Diagnose {
    /// Which physics of rod or rig the model of a rod left out: located, named, fitted, proved on held-out readings.
    Rig(Rig),
    /// Which physics of robot, rod, fixture or procedure a calibration left out: which joint, clamp, time or pose.
    Calibration(calibration::Calibration),
}

#[derive(Debug, Args)]
#[command(after_long_help = NOTES)]
pub struct Rig {
    /// Rod file (TOML), or the word `linear`: straight lines through the origin, of any slope.
    rod: PathBuf,
    /// Readings (CSV): how far the tip moved under each load. `rodcal rig fit --help` shows one.
    readings: PathBuf,
    /// Also write what was found into a rod file and into readings that `compliance`, `rig fit`, `calibrate` and
    /// `compare` read, `*-diagnosed.toml` and `*-diagnosed.csv` [without --out: in reports/diagnosed].
    #[arg(long)]
    apply: bool,
}

const NOTES: &str = "\
The model is the rod as its file gives it, nothing fitted. Readings that differ
from it are explained by as few of these effects as they need:

  stiffness_scale      all of the rod is softer or stiffer than its file says
  shear_modulus        it twists and shears more easily
  joint_compliance     a joint yields: one of the file, or one found on the rod
  root_compliance      flange or adapter yield
  bend_flexibility     the pipe of the bend becomes oval
  friction             the slide takes off load, and holds it on the way down
  load_offset          a hanger or a tare adds to every load
  backlash             play before the rod bends
  creep                the deflection grows with the logarithm of time
  hysteresis           the way down is not the way up, and it is not friction
  nonlinear_stiffness  the stiffness depends on the load
  sensor_scale         a sensor shows too much or too little
  sensor_misalignment  a sensor, or a load (load_misalignment), is not square
  thermal_drift        readings follow temperature or time
  slip                 everything after one reading is shifted
  outlier              one reading is wrong

What these readings cannot tell apart is said, with the measurement that would.
What no effect explains is described, and not named. More columns tell more:
trial, phase (load, unload), time_s, temperature_c.

Exit status: 0 the readings agree with the model; 1 they do not, and the first
line says why; 2 could not run.";

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
        let found = diagnose(&readings, rod.as_ref())?;
        let mut report = report::diagnosis::report(&found, &readings, rod.as_ref());
        let model = rod.as_ref().map_or("none, straight lines".into(), |_| self.rod.display().to_string());
        report.provenance = vec![
            ("rod file".into(), model),
            ("readings".into(), self.readings.display().to_string()),
            ("program".into(), concat!("rodcal ", env!("CARGO_PKG_VERSION")).into()),
        ];
        let mut json = report::diagnosis::json(&found, &readings, rod.as_ref());
        let mut outcome_files = Vec::new();
        let mut default_directory = None;
        if self.apply {
            outcome_files = self.applied(&found);
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
    fn applied(&self, found: &RigDiagnosis) -> Vec<(String, Vec<u8>)> {
        let Some(correction) = &found.correction else { return Vec::new() };
        let stem = |path: &Path| path.file_stem().unwrap_or_default().to_string_lossy().into_owned();
        vec![
            (format!("{}-diagnosed.toml", stem(&self.rod)), correction.rod_toml.clone().into_bytes()),
            (format!("{}-diagnosed.csv", stem(&self.readings)), correction.readings_csv.clone().into_bytes()),
        ]
    }
}
