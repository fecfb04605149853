//! `rodcal simulate DIR`.

use std::path::PathBuf;

use clap::Args;
use rodcal::Result;
use rodcal::answer::{Simulated, named_robot, simulate};
use rodcal::calibration::simulate::{Plan, planned_poses};
use rodcal::delimited::visible;
use rodcal::files::{self, Existing, Staged};
use rodcal::robot::Robot;
use rodcal::rod::Rod;

use super::output::Outcome;
use super::progress::Progress;

#[derive(Debug, Args)]
pub struct Simulate {
    /// Directory for campaign.toml, measurements.csv, validation.csv, readings.csv, robot and rod
    /// file; made if missing.
    directory: PathBuf,
    /// Rod file (TOML).
    #[arg(long)]
    rod: PathBuf,
    /// Robot file (a table in TOML, or a URDF with the links base_link and tip_link), or
    /// `builtin:tx90`.
    #[arg(long, default_value = "builtin:tx90")]
    robot: String,
    /// Every random number comes from this seed.
    #[arg(long, default_value_t = Plan::default().seed)]
    seed: u64,
    /// Poses on each of the five clamps.
    #[arg(long, value_name = "N", default_value_t = Plan::default().poses_per_clamp as u16, value_parser = clap::value_parser!(u16).range(1..=1000))]
    poses: u16,
    /// Take these poses in place of chosen ones: a table (CSV) with clamp and joint columns, as
    /// `design poses --out` writes it for a simulated campaign of the same rod.
    #[arg(long, value_name = "FILE", conflicts_with = "poses")]
    planned: Option<PathBuf>,
    /// Poses of the validation.
    #[arg(long, value_name = "N", default_value_t = Plan::default().validation_poses as u16, value_parser = clap::value_parser!(u16).range(4..=10000))]
    validation: u16,
    /// Compliance of the true rod over that of its model.
    #[arg(long, value_name = "R", default_value_t = 1.0, value_parser = factor)]
    r_rod: f64,
}

/// What is not copied but made, and so new whenever an option changes.
const MADE: [&str; 4] = ["campaign.toml", "measurements.csv", "validation.csv", "readings.csv"];

fn factor(text: &str) -> std::result::Result<f64, String> {
    match text.parse::<f64>() {
        Ok(r) if r > 0.0 && r <= 100.0 => Ok(r),
        _ => Err("expected a number above 0 and up to 100".into()),
    }
}

impl Simulate {
    pub fn run(&self, existing: Existing) -> Result<Outcome> {
        files::check_free(&self.directory, &MADE, existing)?;
        let rod_text = files::read_text(&self.rod)?;
        let rod = Rod::from_toml(&self.rod.display().to_string(), &rod_text)?;
        let named = named_robot(&self.robot)?;
        let robot = Robot::from_text(&self.robot, &named.1, None, None)?;
        let planned = match &self.planned {
            Some(path) => planned_poses(&robot, &path.display().to_string(), &files::read_text(path)?)?,
            None => Vec::new(),
        };
        let poses = Plan::of_poses(self.poses.into(), self.validation.into());
        let mut plan = poses.with_seed(self.seed).with_rod_factor(self.r_rod);
        plan.planned = planned;
        let campaign = self.directory.join("campaign.toml").display().to_string();
        let progress = Progress::open("simulating poses");
        let tell = || progress.one_more();
        let Simulated { files, json, poses, names: [robot, rod], .. } =
            simulate(&robot, named, (&rod, rod_text), &plan, &campaign, &tell)?;
        progress.finish();
        let staged = Staged::new(&self.directory, &files, existing)?;
        let shown = visible(&campaign);
        let text = format!(
            "Simulated {poses} poses of {} with rod {} (seed {}).\nrodcal calibrate {shown}\nrodcal compare {shown}\n",
            visible(&robot),
            visible(&rod),
            self.seed
        );
        Ok(Outcome { commit: Some(Box::new(|| staged.commit())), ..Outcome::plain(json, text) })
    }
}
