//! `rodcal diagnose calibration CAMPAIGN`.

use std::path::PathBuf;

use clap::Args;
use rodcal::calibration::{self, Campaign, Options};
use rodcal::diagnosis::calibration::{apply, diagnose};
use rodcal::{Result, report};

use crate::cli::calibrate::{ModeName, provenance};
use crate::cli::output::Outcome;

#[derive(Debug, Args)]
#[command(after_long_help = NOTES)]
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

const NOTES: &str = "\
The robot is calibrated first. What that leaves is explained by as few of these
effects as it needs, each judged after all that the calibration can absorb:

  transmission_error   a gear or encoder errs with its joint's own angle
  backlash             play in a gear
  joint_compliance     a drive yields to its load
  joint_nonlinear_stiffness  it does so out of proportion
  encoder_scale        a joint turns more or less than its encoder says
  wrist_coupling       a wrist joint takes its neighbour along
  link_flexibility     a link bends
  gravity_tilt         the base yields to the arm's weight
  rod_stiffness        the rod is softer or stiffer than its model
  tip_mass, payload_mass     a mass that was forgotten
  contact_force_variation    the ball is pushed harder or softer than stated
  clamp_pose           a clamp is not where the campaign says
  clamp_shift, socket_shift, base_shift  something moved after one pose
  thermal_drift        the arm follows temperature, time or order
  readback_lag         angles were read before the arm had settled
  outlier              a pose is wrong

What these poses cannot tell apart is said, and so is what cannot be seen in
them. What no effect explains is described, and not named. The order of the
rows is the order of recording; columns time_s and temperature_c tell more.

Exit status: 0 the calibration explains the poses; 1 it does not, and the first
line says why; 2 could not run.";

impl Calibration {
    pub fn run(&self) -> Result<Outcome> {
        let campaign = Campaign::read(&self.campaign)?;
        let mode = self.mode.map_or_else(|| calibration::default_mode(&campaign), ModeName::mode);
        let found = diagnose(&campaign, mode, &Options::default())?;
        let mut report = report::diagnosis::calibration::report(&campaign, &found);
        report.provenance = provenance(&campaign);
        let mut json = report::diagnosis::calibration::json(&campaign, &found);
        let applied = if self.apply { apply(&campaign, &found)? } else { None };
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
