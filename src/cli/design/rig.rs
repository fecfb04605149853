//! `rodcal design rig ROD`.

use std::path::PathBuf;

use clap::{ArgGroup, Args};
use rodcal::diagnosis::rig::planned::Bench;
use rodcal::rod::Rod;
use rodcal::units::UM;
use rodcal::{Result, answer};

use super::super::output::Outcome;

#[derive(Debug, Args)]
#[command(after_long_help = NOTES)]
#[command(group(ArgGroup::new("goal").required(true).args(["between", "r_rod_width_percent"])))]
pub struct DesignRig {
    /// Rod file (TOML).
    rod: PathBuf,
    /// Effects to be distinguished from each other and from nothing, with commas between them.
    #[arg(long, value_name = "EFFECTS", value_delimiter = ',')]
    between: Vec<String>,
    /// Or: how wide the 95 % interval of r_rod may be, in %.
    #[arg(long, value_name = "PERCENT", value_parser = positive, allow_negative_numbers = true)]
    r_rod_width_percent: Option<f64>,
    /// Odds to be expected against what it is not.
    #[arg(long, value_name = "ODDS", default_value_t = 20.0, value_parser = more_than_one, allow_negative_numbers = true)]
    odds: f64,
    /// Largest load that rod and rig bear, in N.
    #[arg(long, value_name = "N", default_value_t = 10.0, value_parser = positive, allow_negative_numbers = true)]
    max_load: f64,
    /// Standard deviation of a reading, in µm.
    #[arg(long, value_name = "UM", default_value_t = 2.0, value_parser = positive, allow_negative_numbers = true)]
    noise_um: f64,
    /// Loads hang and sensors stand at the tip only.
    #[arg(long)]
    at_tip: bool,
}

const NOTES: &str = "\
Effects are named as in the answers of `rodcal diagnose rig`, for example
joint_compliance, root_compliance, stiffness_scale, shear_modulus, friction,
load_offset, sensor_scale, creep. Each is taken to be of its usual size.

With --out the readings to be filled in are written too (readings.csv), for
`rodcal rig fit` and `rodcal diagnose rig`.";

fn positive(text: &str) -> std::result::Result<f64, String> {
    match text.parse::<f64>() {
        Ok(number) if number.is_finite() && number > 0.0 => Ok(number),
        _ => Err("expected a number > 0".into()),
    }
}

fn more_than_one(text: &str) -> std::result::Result<f64, String> {
    match text.parse::<f64>() {
        Ok(number) if number.is_finite() && number > 1.0 => Ok(number),
        _ => Err("expected odds > 1, such as 20".into()),
    }
}

impl DesignRig {
    pub fn run(&self) -> Result<Outcome> {
        let rod = Rod::read(&self.rod)?;
        let bench = Bench { largest_load: self.max_load, noise: self.noise_um * UM, is_at_tip: self.at_tip };
        let width = self.r_rod_width_percent.map(|percent| percent / 100.0);
        let mut answer = answer::design_rig(&rod, &self.between, width, self.odds, &bench)?;
        answer.report.provenance = vec![
            ("rod file".into(), self.rod.display().to_string()),
            ("program".into(), concat!("rodcal ", env!("CARGO_PKG_VERSION")).into()),
        ];
        Ok(answer.into())
    }
}
