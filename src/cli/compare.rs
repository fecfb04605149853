//! `rodcal compare CAMPAIGN`.

use std::path::PathBuf;

use clap::Args;
use rodcal::calibration::{self, Campaign, CompareOptions, Options};
use rodcal::{Result, report};

use super::calibrate::{Weights, provenance};
use super::output::Outcome;
use super::progress::Progress;

#[derive(Debug, Args)]
pub struct Compare {
    /// Campaign file (TOML): robot, rod, measurements, validation.
    campaign: PathBuf,
    /// What an outlier counts.
    #[arg(long, value_enum, default_value_t = Weights::None)]
    robust: Weights,
    /// Draws of the bootstrap that tells differences from chance.
    #[arg(long, value_name = "N", default_value_t = CompareOptions::default().draws, value_parser = draws)]
    draws: usize,
    /// Seed of the draws.
    #[arg(long, default_value_t = CompareOptions::default().seed)]
    seed: u64,
}

fn draws(text: &str) -> std::result::Result<usize, String> {
    match text.parse() {
        Ok(count) if (50..=100_000).contains(&count) => Ok(count),
        _ => Err("expected a whole number from 50 to 100000".into()),
    }
}

impl Compare {
    pub fn run(&self) -> Result<Outcome> {
        let campaign = Campaign::read(&self.campaign)?;
        let options = CompareOptions {
            calibration: Options { robust: self.robust.robust(), ..Options::default() },
            draws: self.draws,
            seed: self.seed,
            ..CompareOptions::default()
        };
        let progress = Progress::new("comparing modes", self.draws);
        let comparison = calibration::compare(&campaign, &options, &|_| progress.one_more())?;
        progress.finish();
        let mut report = report::comparison::report(&campaign, &comparison);
        report.provenance = provenance(&campaign);
        Ok(Outcome::new(report::comparison::json(&campaign, &comparison), report))
    }
}
