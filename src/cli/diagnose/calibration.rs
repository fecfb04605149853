//! `rodcal diagnose calibration CAMPAIGN`.

use std::path::{Path, PathBuf};

use clap::Args;
use rodcal::answer::{self, neighbours};
use rodcal::calibration::{self, Campaign};
use rodcal::diagnosis::calibration::effects::registry;
use rodcal::{Result, files};

use super::listed::listed;
use crate::cli::calibrate::ModeName;
use crate::cli::output::{self, Outcome};

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

Poses of a validation are searched for nothing. Where they are far off, they are
diagnosed by themselves.

Exit status: 0 the calibration explains the poses; 1 it does not, or its
validation contradicts it, and the first line says why; 2 could not run."
    )
}

impl Calibration {
    pub fn run(&self) -> Result<Outcome> {
        let campaign = Campaign::read(&self.campaign)?;
        let mode = self.mode.map_or_else(|| calibration::default_mode(&campaign), ModeName::mode);
        let directory = self.campaign.parent().unwrap_or(Path::new(""));
        let content = |name: &str| files::read_bytes(&directory.join(name));
        let apply = self.apply.then_some(&content as &dyn Fn(&str) -> Result<Vec<u8>>);
        let answer = answer::diagnose_calibration(&campaign, mode, &neighbours(&campaign), apply)?;
        let default_directory = (!answer.files.is_empty()).then(|| PathBuf::from(output::APPLIED));
        Ok(Outcome { default_directory, ..answer.into() })
    }
}
