//! `rodcal simulate DIR`.

use std::path::PathBuf;

use clap::Args;
use rodcal::beam::Physics;
use rodcal::calibration::simulate::{Plan, campaign_files, planned_poses, simulate_telling};
use rodcal::compliance::{Compliance, DEFAULT_ELEMENTS};
use rodcal::delimited::visible;
use rodcal::files::{self, Existing, Staged};
use rodcal::robot::{Parameter, Robot, Setup, is_urdf};
use rodcal::rod::Rod;
use rodcal::units::MM;
use rodcal::{Error, Result};
use serde_json::json;

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
        let (robot_name, robot_text) = self.robot_text()?;
        let robot = Robot::from_text(&self.robot, &robot_text, None, None)?;
        let model = Compliance::of_model(&rod, &Physics::default(), DEFAULT_ELEMENTS)?;
        let planned = match &self.planned {
            Some(path) => planned_poses(&robot, &path.display().to_string(), &files::read_text(path)?)?,
            None => Vec::new(),
        };
        let plan = Plan {
            seed: self.seed,
            planned,
            poses_per_clamp: self.poses.into(),
            validation_poses: self.validation.into(),
            rod_factor: self.r_rod,
            ..Plan::default()
        };
        let progress = Progress::open("simulating poses");
        let simulation = simulate_telling(&robot, &rod, &model, &plan, &|| progress.one_more())?;
        progress.finish();
        let mut written: Vec<(String, Vec<u8>)> = campaign_files(&simulation, &robot_name, "rod.toml")
            .into_iter()
            .map(|(name, text)| (name, text.into_bytes()))
            .collect();
        written.push(("rod.toml".into(), rod_text.into_bytes()));
        if !robot_name.starts_with("builtin:") {
            written.push((robot_name, robot_text.into_bytes()));
        }
        let staged = Staged::new(&self.directory, &written, existing)?;
        let campaign = self.directory.join("campaign.toml").display().to_string();
        let drawn = Setup::new(&robot, simulation.base_guess, rod.tip());
        let truth: Vec<_> = Parameter::all(robot.joints.len())
            .into_iter()
            .map(|parameter| {
                let unit = parameter.unit();
                let value = simulation.truth.get(parameter);
                json!({
                    "name": parameter.to_string(),
                    "unit": unit.suffix,
                    "value": value / unit.si,
                    "correction": (value - drawn.get(parameter)) / unit.si,
                })
            })
            .collect();
        let shown = visible(&campaign);
        let text = format!(
            "Simulated {} poses of {} with rod {} (seed {}).\nrodcal calibrate {shown}\nrodcal compare {shown}\n",
            simulation.measurements.len(),
            visible(&robot.name),
            visible(&rod.name),
            self.seed
        );
        let json = json!({
            "campaign": campaign,
            "robot": robot.name,
            "rod": rod.name,
            "seed": self.seed,
            "poses": simulation.measurements.len(),
            "r_rod": self.r_rod,
            "tip_mm": (simulation.truth.tool / MM).as_slice(),
            "truth": truth,
        });
        Ok(Outcome { commit: Some(Box::new(|| staged.commit())), ..Outcome::plain(json, text) })
    }

    /// What the campaign calls the robot's file, and its text.
    fn robot_text(&self) -> Result<(String, String)> {
        match self.robot.strip_prefix("builtin:") {
            Some(name) => match Robot::builtin(name) {
                Some((_, text)) => Ok((self.robot.clone(), text.to_owned())),
                None => Err(Error::Argument {
                    name: "--robot",
                    found: self.robot.clone(),
                    expected: "builtin:tx90 or a file".into(),
                }),
            },
            None => {
                let text = files::read_text(&PathBuf::from(&self.robot))?;
                let name = if is_urdf(&text) { "robot.urdf" } else { "robot.toml" };
                Ok((name.into(), text))
            }
        }
    }
}
