//! A campaign of a robot and a rod that are known exactly.

use std::path::Path;

use serde_json::{Value, json};

use crate::beam::Physics;
use crate::calibration::simulate::{Plan, campaign_files, simulate_telling};
use crate::compliance::{Compliance, DEFAULT_ELEMENTS};
use crate::error::{Error, Result};
use crate::files;
use crate::robot::{Parameter, Robot, Setup, is_urdf};
use crate::rod::Rod;
use crate::units::MM;

/// A simulated campaign, not written yet.
#[derive(Debug, Clone)]
pub struct Simulated {
    /// Names and contents of its files; the campaign is `campaign.toml`.
    pub files: Vec<(String, Vec<u8>)>,
    /// The keys of `--json`: where the campaign will stand, and the true robot.
    pub json: Value,
    /// Number of poses.
    pub poses: usize,
    /// Names of robot and rod.
    pub names: [String; 2],
}

/// What a campaign calls the file of the robot `robot`, a file or `builtin:tx90`, and its text.
///
/// ```
/// use rodcal::answer::named_robot;
///
/// let (name, text) = named_robot("builtin:tx90")?;
/// assert!(name == "builtin:tx90" && text.contains("name = \"TX90\""));
/// assert_eq!(named_robot("robots/six-axis.urdf")?.0, "robot.urdf");
/// # Ok::<(), rodcal::Error>(())
/// ```
///
/// # Errors
/// [`Error::Argument`] for a robot that the program does not carry, [`Error::File`] for a file that
/// cannot be read.
pub fn named_robot(robot: &str) -> Result<(String, String)> {
    match robot.strip_prefix("builtin:") {
        Some(name) => match Robot::builtin(name) {
            Some((_, text)) => Ok((robot.to_owned(), text.to_owned())),
            None => Err(Error::Argument {
                name: "--robot",
                found: robot.to_owned(),
                expected: "builtin:tx90 or a file".into(),
            }),
        },
        None => {
            let text = files::read_text(Path::new(robot))?;
            let name = if is_urdf(&text) { "robot.urdf" } else { "robot.toml" };
            Ok((name.into(), text))
        }
    }
}

/// Simulates a campaign of `robot`, whose file the campaign calls `named.0` and whose text is
/// `named.1`, with a rod and the text of its file. `campaign` is where it will stand; `progress` is
/// called at every candidate and every pose.
///
/// ```
/// use rodcal::answer::{named_robot, simulate};
/// use rodcal::calibration::simulate::Plan;
/// use rodcal::prelude::*;
///
/// let named = named_robot("builtin:tx90")?;
/// let robot = Robot::from_text(&named.0, &named.1, None, None)?;
/// let rod = Rod::read("rods/5.toml".as_ref())?;
/// let plan = Plan::of_poses(8, 5);
/// let simulated = simulate(&robot, named, (&rod, rod.to_toml(&[])), &plan, "campaign.toml", &|| {})?;
/// assert_eq!(simulated.poses, 40); // 8 at each of the paper's 5 clamps
/// assert_eq!(simulated.json["r_rod"], 1.0);
/// # Ok::<(), rodcal::Error>(())
/// ```
///
/// # Errors
/// As [`simulate_telling`].
pub fn simulate(
    robot: &Robot,
    named: (String, String),
    rod: (&Rod, String),
    plan: &Plan,
    campaign: &str,
    progress: &(dyn Fn() + Sync),
) -> Result<Simulated> {
    let ((robot_name, robot_text), (rod, rod_text)) = (named, rod);
    let model = Compliance::of_model(rod, &Physics::default(), DEFAULT_ELEMENTS)?;
    let simulation = simulate_telling(robot, rod, &model, plan, progress)?;
    let mut files: Vec<(String, Vec<u8>)> = campaign_files(&simulation, &robot_name, "rod.toml")
        .into_iter()
        .map(|(name, text)| (name, text.into_bytes()))
        .collect();
    files.push(("rod.toml".into(), rod_text.into_bytes()));
    if !robot_name.starts_with("builtin:") {
        files.push((robot_name, robot_text.into_bytes()));
    }
    let drawn = Setup::new(robot, simulation.base_guess, rod.tip());
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
    let json = json!({
        "campaign": campaign,
        "robot": robot.name,
        "rod": rod.name,
        "seed": plan.seed,
        "poses": simulation.measurements.len(),
        "r_rod": plan.rod_factor,
        "tip_mm": (simulation.truth.tool / MM).as_slice(),
        "truth": truth,
    });
    let names = [robot.name.clone(), rod.name.clone()];
    Ok(Simulated { files, json, poses: simulation.measurements.len(), names })
}
