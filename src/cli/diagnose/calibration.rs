//! `rodcal diagnose calibration CAMPAIGN`.

use std::path::PathBuf;

use clap::Args;
use rodcal::calibration::{self, Campaign, Options};
use rodcal::diagnosis::calibration::effects::registry;
use rodcal::diagnosis::calibration::{apply, mend};
use rodcal::{Result, report};

use super::listed::listed;
use crate::cli::neighbours::neighbours;
use crate::cli::calibrate::{ModeName, provenance};
use crate::cli::output::Outcome;

#[derive(Debug, Args)]
#[command(after_long_help = notes())]
pub struct Calibration {
    /// Campaign file (TOML): robot, rod, measurements. `docs/campaign-file.md` has its keys.
    campaign: PathBuf,
    /// How the rod's deflection is known [default: meas with rig readings, else fea with a rod, else none].
    #[arg(long, value_enum)]
    mode: Option<ModeName>,
    /// Also write the calibrated robot with what was found, for `calibrate`, `compare` and `predict`; for a URDF with a table of
    /// corrections beside it [without --out: in reports/diagnosed].
    #[arg(long)]
    apply: bool,
}

fn notes() -> String {
    let effects = listed(registry::ALL.iter().map(|known| &known.effect));
    format!(
        "\
The robot is calibrated first. Its residuals are explained by as few of these
effects as possible, each without the part that the calibration absorbs:

{effects}
Effects that these poses cannot distinguish, or cannot show, are listed. What
no effect explains is described, not named. The order of the rows is the order
of recording; columns time_s and temperature_c make more effects testable.

Exit status: 0 the calibration explains the poses; 1 it does not, and the first
line says why; 2 could not run."
    )
}

impl Calibration {
    pub fn run(&self) -> Result<Outcome> {
        let campaign = Campaign::read(&self.campaign)?;
        let mode = self.mode.map_or_else(|| calibration::default_mode(&campaign), ModeName::mode);
        let options = Options::default();
        let mended = mend(&campaign, mode, &neighbours(&campaign), &options)?;
        let found = mended.diagnose(&options)?;
        let mut report = report::diagnosis::calibration::report(&found);
        report.provenance = provenance(&campaign);
        let mut json = report::diagnosis::calibration::json(&found);
        let applied = if self.apply { apply(&found)? } else { None };
        match &applied {
            Some(applied) => report::diagnosis::calibration::applied(&mut report, &mut json, applied),
            None if self.apply => report
                .warnings
                .push("--apply has no effect: nothing was found that belongs to the robot".into()),
            None => {}
        }
        let mut outcome = Outcome::new(json, report);
        if let Some(applied) = applied {
            outcome.files = applied.files.into_iter().map(|(name, text)| (name, text.into_bytes())).collect();
            outcome.default_directory = Some(PathBuf::from("reports/diagnosed"));
        }
        outcome.status = u8::from(found.diagnosis.is_mismatch());
        Ok(outcome)
    }
}
