//! `rodcal rig fit ROD READINGS`.

use std::path::{Path, PathBuf};

use clap::{Args, Subcommand, ValueEnum};
use rodcal::compliance::DEFAULT_ELEMENTS;
use rodcal::least_squares::{Robust, RobustScale};
use rodcal::rig::readings::Readings;
use rodcal::rod::Rod;
use rodcal::{Result, answer, rig};

use super::output::Outcome;
use super::values::{Theory, elements};

#[derive(Debug, Subcommand)]
pub enum Rig {
    /// Fit a line to each load direction: slopes, friction, straightness, correction factors r and
    /// r_rod, measured C^F and C^g, each with its uncertainty.
    Fit(Fit),
}

#[derive(Debug, Args)]
#[command(after_long_help = NOTES)]
pub struct Fit {
    /// Rod file (TOML), or the word `linear`: no model, only slopes and whether the lines are
    /// straight.
    rod: PathBuf,
    /// Readings (CSV): how far the tip moved under each load.
    readings: PathBuf,
    /// Beam theory of the model the readings are compared with.
    #[arg(long, ignore_case = true, value_enum, default_value_t = Theory::Timoshenko)]
    theory: Theory,
    /// Number of beam elements of that model.
    #[arg(long, default_value_t = DEFAULT_ELEMENTS, value_parser = elements)]
    elements: usize,
    /// What an outlier counts.
    #[arg(long, ignore_case = true, value_enum, default_value_t = Weights::None)]
    robust: Weights,
}

#[derive(Debug, Clone, Copy, ValueEnum)]
enum Weights {
    /// Least squares: every reading counts the same.
    None,
    /// Outliers count less (Huber's weights, k = 1.345).
    Huber,
    /// Gross outliers do not count at all (Tukey's biweight, c = 4.685).
    Tukey,
}

const NOTES: &str = "\
Readings are offsets from the unloaded, zeroed rod, one row for each loading:

  axis,load_kg,trial,dy_um,dz_um
  y,0.5,1,185,
  y,1.0,1,416,
  z,0.5,1,,165
  z,1.0,1,,358

  axis                  direction of the load: x, y, z or -x, -y, -z
  load_n or load_kg     its size
  dx_um, dy_um, dz_um   offsets; at least one column; blank is 'not measured'
  trial                 number of the repeat, optional

Three loads or more, twice or more each, give every slope a standard error and
show whether the line is straight. A line that does not pass through zero means
friction in the slide or a tare. `rodcal --help` explains r and r_rod.";

impl Rig {
    pub fn run(&self) -> Result<Outcome> {
        let Rig::Fit(fit) = self;
        fit.run()
    }
}

impl Fit {
    fn run(&self) -> Result<Outcome> {
        let rod = if self.rod == Path::new("linear") { None } else { Some(Rod::read(&self.rod)?) };
        let readings = Readings::read(&self.readings)?;
        let options = rig::Options::default()
            .with_physics(self.theory.physics())
            .with_elements(self.elements)
            .with_robust(match self.robust {
                Weights::None => Robust::None,
                Weights::Huber => Robust::Huber { k: 1.345, scale: RobustScale::Mad },
                Weights::Tukey => Robust::Tukey { c: 4.685, scale: RobustScale::Mad },
            });
        let mut answer = answer::rig_fit(&readings, rod.as_ref(), &options)?;
        let model = rod.as_ref().map_or("none, straight lines".into(), |_| self.rod.display().to_string());
        answer.report.provenance = vec![
            ("rod file".into(), model),
            ("readings".into(), self.readings.display().to_string()),
            ("program".into(), concat!("rodcal ", env!("CARGO_PKG_VERSION")).into()),
        ];
        Ok(answer.into())
    }
}
