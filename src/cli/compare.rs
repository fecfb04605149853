//! `rodcal compare CAMPAIGN`.

use std::path::PathBuf;

use clap::Args;
use rodcal::calibration::{Campaign, CompareOptions, Options};
use rodcal::rod::Rod;
use rodcal::{Error, Result, answer};

use super::calibrate::Weights;
use super::design::poses::Expected;
use super::output::Outcome;
use super::progress::Progress;

#[derive(Debug, Args)]
pub struct Compare {
    /// Campaign file (TOML): robot, rod, measurements, validation.
    campaign: PathBuf,
    /// What an outlier counts.
    #[arg(long, ignore_case = true, value_enum, default_value_t = Weights::None)]
    robust: Weights,
    /// Draws of the bootstrap that tells differences from chance.
    #[arg(long, value_name = "N", default_value_t = CompareOptions::default().draws, value_parser = draws)]
    draws: usize,
    /// Seed of the draws.
    #[arg(long, default_value_t = CompareOptions::default().seed)]
    seed: u64,
    /// What to expect of every mode before anything is recorded: the error budget from the planned
    /// poses.
    #[arg(long, help_heading = FORECAST)]
    forecast: bool,
    /// Forecast these rods (TOML) in place of the campaign's own.
    #[arg(long, value_name = "ROD", num_args = 1.., requires = "forecast", help_heading = FORECAST)]
    rods: Vec<PathBuf>,
    /// So many poses in all, chosen by O1 [default: those of the recording; for other rods as many,
    /// else 30 on each clamp].
    #[arg(long, value_name = "K", requires = "forecast", help_heading = FORECAST, value_parser = clap::value_parser!(u32).range(1..=20_000))]
    count: Option<u32>,
    #[command(flatten, next_help_heading = FORECAST)]
    expected: Expected,
}

const FORECAST: &str = "Forecast";

fn draws(text: &str) -> std::result::Result<usize, String> {
    match text.parse() {
        Ok(count) if (50..=100_000).contains(&count) => Ok(count),
        _ => Err("expected a whole number from 50 to 100000".into()),
    }
}

impl Compare {
    pub fn run(&self) -> Result<Outcome> {
        if self.forecast {
            return self.run_forecast();
        }
        if self.expected.is_stated() {
            return Err(Error::Argument {
                name: "what a forecast assumes",
                found: "stated without --forecast".into(),
                expected: "--forecast too".into(),
            });
        }
        let campaign = Campaign::read(&self.campaign)?;
        let calibration = Options::default().with_robust(self.robust.robust());
        let options = CompareOptions::default().with_calibration(calibration);
        let options = options.with_draws(self.draws).with_seed(self.seed);
        let progress = Progress::new("comparing modes", self.draws);
        let answer = answer::compare(&campaign, &options, &|_| progress.one_more())?;
        progress.finish();
        Ok(Outcome::from(answer).seeded(self.seed))
    }

    fn run_forecast(&self) -> Result<Outcome> {
        let campaign = Campaign::read_plan(&self.campaign)?;
        let rods: Vec<Rod> = self.rods.iter().map(|path| Rod::read(path)).collect::<Result<_>>()?;
        let budget = self.expected.budget(&campaign)?.with_seed(self.seed);
        let at = self.expected.place()?;
        let count = self.count.map(|count| count as usize);
        Ok(Outcome::from(answer::forecast(&campaign, &rods, budget, &at, count)?).seeded(self.seed))
    }
}
