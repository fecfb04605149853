//! `rodcal diagnose calibration CAMPAIGN`.

use std::path::{Path, PathBuf};

use clap::Args;
use rodcal::calibration::campaign::FileNames;
use rodcal::calibration::{self, Campaign, Options};
use rodcal::diagnosis::calibration::effects::registry;
use rodcal::diagnosis::calibration::{check_memory, mend};
use rodcal::{Result, files, report};

use super::listed::listed;
use crate::cli::calibrate::{ModeName, provenance};
use crate::cli::neighbours::neighbours;
use crate::cli::output::Outcome;

#[derive(Debug, Args)]
#[command(after_long_help = notes())]
pub struct Calibration {
    /// Campaign file (TOML): robot, rod, measurements. `docs/campaign-file.md` has its keys.
    campaign: PathBuf,
    /// How the rod's deflection is known [default: meas with rig readings, else fea with a rod,
    /// else none].
    #[arg(long, ignore_case = true, value_enum)]
    mode: Option<ModeName>,
    /// Also write the calibrated robot with what was found, for `calibrate`, `compare` and
    /// `predict`, for a URDF with a table of corrections beside it; and the campaign without its
    /// mistakes, with all its files [without --out: in reports/diagnosed].
    #[arg(long)]
    apply: bool,
}

fn notes() -> String {
    let mistakes = listed(registry::MISTAKES.into_iter());
    let effects = listed(registry::ALL.iter().map(|known| &known.effect));
    format!(
        "\
Mistakes come first, and what follows is said of the corrected campaign:

{mistakes}
Then the robot is calibrated. Its residuals are explained by as few of these
effects as possible, each without the part that the calibration absorbs:

{effects}
Effects that these poses cannot distinguish, or cannot show, are listed. What
no effect explains is described, not named. The order of the rows is the order
of recording; columns time_s and temperature_c make more effects testable.

Exit status: 0 the calibration explains the poses; 1 it does not, and the first
line says why; 2 could not run."
    )
}

/// What a corrected campaign calls its files: all of them stand beside it.
fn names(campaign: &Campaign) -> FileNames {
    let base = |name: &str| {
        let end = Path::new(name).file_name();
        end.map_or_else(|| name.to_owned(), |end| end.to_string_lossy().into_owned())
    };
    let is_builtin = campaign.robot_file.starts_with("builtin:");
    FileNames {
        effects: campaign.effects_file.as_deref().map(base),
        robot: if is_builtin { campaign.robot_file.clone() } else { base(&campaign.robot_file) },
        rod: campaign.rod_file.as_deref().map(base),
        rig: campaign.readings.as_ref().map(|readings| base(&readings.file)),
        measurements: "measurements.csv".into(),
        validation: campaign.validation.as_ref().map(|_| "validation.csv".into()),
    }
}

/// Robot, rod and readings as they are, for a corrected campaign in another folder.
fn copies(campaign: &Campaign) -> Result<Vec<(String, Vec<u8>)>> {
    let names = names(campaign);
    let directory = Path::new(&campaign.file).parent().unwrap_or(Path::new(""));
    let mut copies = Vec::new();
    if let (Some(name), Some(file)) = (names.effects, &campaign.effects_file) {
        copies.push((name, files::read_bytes(&directory.join(file))?));
    }
    if !campaign.robot_file.starts_with("builtin:") {
        copies.push((names.robot, campaign.robot_text.clone().into_bytes()));
    }
    if let (Some(name), Some(file)) = (names.rod, &campaign.rod_file) {
        copies.push((name, files::read_bytes(&directory.join(file))?));
    }
    if let (Some(name), Some(readings)) = (names.rig, &campaign.readings) {
        copies.push((name, files::read_bytes(Path::new(&readings.file))?));
    }
    Ok(copies)
}

impl Calibration {
    pub fn run(&self) -> Result<Outcome> {
        let campaign = Campaign::read(&self.campaign)?;
        check_memory(&campaign)?;
        let mode = self.mode.map_or_else(|| calibration::default_mode(&campaign), ModeName::mode);
        let options = Options::default();
        let mended = mend(&campaign, mode, &neighbours(&campaign), &options)?;
        let found = mended.diagnose(&options)?;
        let mut report = report::diagnosis::calibration::report(&found);
        report.provenance = provenance(&campaign);
        let mut json = report::diagnosis::calibration::json(&found);
        let applied = if self.apply { mended.apply(&found, &names(&mended.campaign))? } else { None };
        match &applied {
            Some(applied) => report::diagnosis::calibration::applied(&mut report, &mut json, applied),
            None if self.apply => report
                .warnings
                .push("--apply has no effect: nothing was found that belongs to the robot or can be corrected in the campaign".into()),
            None => report::diagnosis::calibration::announced(&mut report, &found),
        }
        let mut outcome = Outcome::new(json, report);
        if let Some(applied) = applied {
            outcome.files = applied.files.into_iter().map(|(name, text)| (name, text.into_bytes())).collect();
            // what was not written anew is copied
            for copy in copies(&mended.campaign)? {
                if outcome.files.iter().all(|(name, _)| *name != copy.0) {
                    outcome.files.push(copy);
                }
            }
            outcome.default_directory = Some(PathBuf::from("reports/diagnosed"));
        }
        outcome.status = u8::from(found.diagnosis.is_mismatch());
        Ok(outcome)
    }
}
