//! `rodcal compliance ROD`.

use std::path::PathBuf;

use clap::{Args, ValueEnum};
use rodcal::compliance::{DEFAULT_ELEMENTS, Mode, Study, paper_contact_force};
use rodcal::rod::Rod;
use rodcal::units::MM;
use rodcal::{Error, Result, report};

use super::Theory;
use super::output::Outcome;

#[derive(Debug, Args)]
pub struct Compliance {
    /// Rod file (TOML).
    rod: PathBuf,
    /// Which of the two to report; the tables always show both.
    #[arg(long, value_enum, default_value_t = CliMode::Fea)]
    mode: CliMode,
    /// Beam theory of the fea mode (calc is Euler–Bernoulli by definition).
    #[arg(long, value_enum)]
    theory: Option<Theory>,
    /// Number of beam elements (fea); the result does not depend on it.
    #[arg(long, default_value_t = DEFAULT_ELEMENTS, value_parser = super::elements)]
    elements: usize,
    /// Also show what the rod does when it is loaded at this station (arc length from the flange, mm) …
    #[arg(long, value_name = "MM")]
    load_station: Option<f64>,
    /// … and read at this one; each is the tip unless given (fea).
    #[arg(long, value_name = "MM")]
    read_station: Option<f64>,
    /// Size of the contact force F in c_rod, N [default: the paper's, 1.97].
    #[arg(long, value_name = "N")]
    contact_force: Option<f64>,
}

#[derive(Debug, Clone, Copy, ValueEnum)]
enum CliMode {
    /// The paper's closed form: one uniform pipe, 90°, bending and torsion only.
    Calc,
    /// The beam finite-element model of the rod as built.
    Fea,
}

impl Compliance {
    pub fn run(&self) -> Result<Outcome> {
        let mode = match self.mode {
            CliMode::Calc => Mode::Calc,
            CliMode::Fea => Mode::Fea,
        };
        let force = self.contact_force.unwrap_or_else(paper_contact_force);
        if !(force.is_finite() && force >= 0.0) {
            return Err(Error::Argument {
                name: "--contact-force",
                found: force.to_string(),
                expected: "a force in N, 0 or more".into(),
            });
        }
        let rod = Rod::read(&self.rod)?;
        let physics = self.theory.unwrap_or(Theory::Timoshenko).physics();
        let tip = rod.length();
        let mut study = Study::new(rod, mode, physics, self.elements, force)?;
        if self.load_station.is_some() || self.read_station.is_some() {
            let at = |station: Option<f64>| station.map_or(tip, |mm| mm * MM);
            study = study.with_stations(at(self.load_station), at(self.read_station))?;
        }
        let mut report = report::compliance::report(&study);
        if let (CliMode::Calc, Some(Theory::Timoshenko)) = (self.mode, self.theory) {
            report.warnings.push(
                "calc is Euler–Bernoulli by definition; --theory timoshenko only changes the fea columns"
                    .into(),
            );
        }
        report.provenance = vec![
            ("rod file".into(), self.rod.display().to_string()),
            ("program".into(), concat!("rodcal ", env!("CARGO_PKG_VERSION")).into()),
        ];
        Ok(Outcome::new(report::compliance::json(&study), report))
    }
}
