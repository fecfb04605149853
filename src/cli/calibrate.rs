//! `rodcal calibrate CAMPAIGN`.

use std::path::PathBuf;

use clap::{Args, ValueEnum};
use rodcal::calibration::{self, Campaign, Mode, Options, Robust};
use rodcal::{Result, answer};

use super::output::Outcome;

#[derive(Debug, Args)]
pub struct Calibrate {
    /// Campaign file (TOML): robot, rod, measurements, validation.
    campaign: PathBuf,
    /// How the rod's deflection is known [default: meas with rig readings, else fea with a rod,
    /// else none].
    #[arg(long, ignore_case = true, value_enum)]
    mode: Option<ModeName>,
    /// What an outlier counts.
    #[arg(long, ignore_case = true, value_enum, default_value_t = Weights::None)]
    robust: Weights,
    /// Hold numbers of the robot whose correction is smaller than its standard error at their
    /// nominal values, and calibrate again.
    #[arg(long)]
    prune: bool,
    /// Also predict every pose from a calibration without it, in so many folds of consecutive
    /// poses.
    #[arg(long, value_name = "N", value_parser = clap::value_parser!(u16).range(2..=1000))]
    folds: Option<u16>,
}

#[derive(Debug, Clone, Copy, ValueEnum)]
pub enum ModeName {
    /// The rod is assumed rigid.
    None,
    /// The paper's closed form.
    Calc,
    /// The beam finite-element model.
    Fea,
    /// Measured on a rig.
    Meas,
}

#[derive(Debug, Clone, Copy, ValueEnum)]
pub enum Weights {
    /// Least squares: every pose counts the same.
    None,
    /// Outliers count less (Huber's weights on distances).
    Huber,
    /// Gross outliers do not count at all (Tukey's biweight on distances).
    Tukey,
}

impl ModeName {
    pub fn mode(self) -> Mode {
        match self {
            ModeName::None => Mode::None,
            ModeName::Calc => Mode::Calc,
            ModeName::Fea => Mode::Fea,
            ModeName::Meas => Mode::Meas,
        }
    }
}

impl Weights {
    pub fn robust(self) -> Robust {
        match self {
            Weights::None => Robust::None,
            Weights::Huber => Robust::Huber,
            Weights::Tukey => Robust::Tukey,
        }
    }
}

impl Calibrate {
    pub fn run(&self) -> Result<Outcome> {
        let campaign = Campaign::read(&self.campaign)?;
        let mode = self.mode.map_or_else(|| calibration::default_mode(&campaign), ModeName::mode);
        let options = Options::default().with_robust(self.robust.robust()).with_pruning(self.prune);
        let folds = self.folds.map(usize::from);
        let others = answer::neighbours(&campaign);
        let (answer, _) = answer::calibrate(&campaign, mode, &options, folds, &others)?;
        Ok(answer.into())
    }
}
