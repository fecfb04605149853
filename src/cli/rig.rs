//! `rodcal rig fit ROD READINGS`.

use std::path::{Path, PathBuf};

use clap::{Args, Subcommand, ValueEnum};
use rodcal::compliance::DEFAULT_ELEMENTS;
use rodcal::least_squares::{Robust, RobustScale};
use rodcal::rig::readings::Readings;
use rodcal::rod::Rod;
use rodcal::{Result, report, rig};

use super::Theory;
use super::output::Outcome;

#[derive(Debug, Subcommand)]
pub enum Rig {
    /// Slopes, friction, correction factors r and measured compliance from rig readings.
    Fit(Fit),
}

#[derive(Debug, Args)]
pub struct Fit {
    /// Rod file (TOML), or the word `linear`: no model, slopes and lack of fit only.
    rod: PathBuf,
    /// Readings (CSV): axis, load_n or load_kg, and any of dx_um, dy_um, dz_um.
    readings: PathBuf,
    /// Beam theory of the model the readings are compared with.
    #[arg(long, value_enum, default_value_t = Theory::Timoshenko)]
    theory: Theory,
    /// Number of beam elements of that model.
    #[arg(long, default_value_t = DEFAULT_ELEMENTS, value_parser = super::elements)]
    elements: usize,
    /// Weights against outliers.
    #[arg(long, value_enum, default_value_t = Weights::None)]
    robust: Weights,
}

#[derive(Debug, Clone, Copy, ValueEnum)]
enum Weights {
    /// Least squares.
    None,
    /// Huber, k = 1.345: outliers count less.
    Huber,
    /// Tukey's biweight, c = 4.685: gross outliers do not count.
    Tukey,
}

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
        let options = rig::Options {
            physics: self.theory.physics(),
            elements: self.elements,
            robust: match self.robust {
                Weights::None => Robust::None,
                Weights::Huber => Robust::Huber { k: 1.345, scale: RobustScale::Mad },
                Weights::Tukey => Robust::Tukey { c: 4.685, scale: RobustScale::Mad },
            },
        };
        let fit = rig::fit(&readings, rod.as_ref(), &options)?;
        let mut report = report::rig::report(&fit, &readings, rod.as_ref());
        report.provenance = vec![
            ("rod file".into(), self.rod.display().to_string()),
            ("readings".into(), self.readings.display().to_string()),
            ("program".into(), concat!("rodcal ", env!("CARGO_PKG_VERSION")).into()),
        ];
        Ok(Outcome::new(report::rig::json(&fit, &readings, rod.as_ref()), report))
    }
}
