//! `rodcal predict MODEL POSES`.

use std::path::PathBuf;

use clap::Args;
use rodcal::robot::{Robot, corrections_from_csv};
use rodcal::units::MM;
use rodcal::{Result, answer, files};

use super::output::Outcome;

#[derive(Debug, Args)]
pub struct Predict {
    /// Calibrated robot (TOML or URDF), as `calibrate --out` and `diagnose calibration --apply`
    /// write it.
    model: PathBuf,
    /// Joint values (CSV): pose, q1_deg, q2_deg …
    poses: PathBuf,
    /// The tip in {T} in mm, as X,Y,Z [default: the tip that the model was calibrated with, else
    /// the flange].
    #[arg(long, value_name = "X,Y,Z", value_parser = three_numbers, allow_hyphen_values = true)]
    tool: Option<[f64; 3]>,
    /// What stands beside a URDF, as `calibrate --out` and `--apply` write it (TOML): tip,
    /// uncertainty, calibrated ranges and effects.
    #[arg(long, value_name = "FILE", conflicts_with = "corrections")]
    effects: Option<PathBuf>,
    /// State the uncertainty that is left after base and tool were aligned anew to these poses.
    #[arg(long)]
    aligned: bool,
    /// Table of corrections beside a URDF (CSV).
    #[arg(long, value_name = "FILE")]
    corrections: Option<PathBuf>,
    /// Base link of a URDF.
    #[arg(long, value_name = "LINK")]
    base_link: Option<String>,
    /// Tip link of a URDF.
    #[arg(long, value_name = "LINK")]
    tip_link: Option<String>,
}

impl Predict {
    pub fn run(&self) -> Result<Outcome> {
        let name = self.model.display().to_string();
        let text = files::read_text(&self.model)?;
        let mut robot = Robot::from_text(&name, &text, self.base_link.as_deref(), self.tip_link.as_deref())?;
        if let Some(path) = &self.effects {
            robot.add_beside(&path.display().to_string(), &files::read_text(path)?)?;
        }
        if let Some(path) = &self.corrections {
            let text = files::read_text(path)?;
            let more = corrections_from_csv(&path.display().to_string(), &text, robot.joints.len())?;
            robot.effects.extend(more);
        }
        let poses =
            robot.poses_from_csv(&self.poses.display().to_string(), &files::read_text(&self.poses)?)?;
        let tool = self.tool.map(|xyz| xyz.map(|x| x * MM).into());
        let mut answer = answer::predict(&robot, tool, poses, self.aligned)?;
        answer.report.provenance = vec![
            ("model".into(), name),
            ("poses".into(), self.poses.display().to_string()),
            ("program".into(), concat!("rodcal ", env!("CARGO_PKG_VERSION")).into()),
        ];
        Ok(answer.into())
    }
}

/// `X,Y,Z`.
fn three_numbers(text: &str) -> std::result::Result<[f64; 3], String> {
    let numbers: Vec<f64> =
        text.split(',').filter_map(|part| part.trim().parse().ok()).filter(|x: &f64| x.is_finite()).collect();
    let three = <[f64; 3]>::try_from(numbers).ok().filter(|_| text.split(',').count() == 3);
    three.ok_or_else(|| "three numbers are needed, in mm, as 0,0,250".into())
}
