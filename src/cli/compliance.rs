//! `rodcal compliance ROD`.

use std::path::PathBuf;

use clap::{Args, ValueEnum};
use rodcal::Result;
use rodcal::answer::{self, ComplianceOptions};
use rodcal::compliance::{DEFAULT_ELEMENTS, Mode, paper_contact_force};
use rodcal::rod::Rod;
use rodcal::units::MM;

use super::output::Outcome;
use super::values::{Theory, elements};

#[derive(Debug, Args)]
#[command(after_long_help = NOTES)]
pub struct Compliance {
    /// Rod file (TOML): lengths, angle, sections, materials, masses.
    rod: PathBuf,
    /// Which model the headline and the JSON are about; the tables show both.
    #[arg(long, ignore_case = true, value_enum, default_value_t = CliMode::Fea)]
    mode: CliMode,
    /// Beam theory of fea [default: timoshenko]; calc is Euler–Bernoulli by definition.
    #[arg(long, ignore_case = true, value_enum)]
    theory: Option<Theory>,
    /// Number of beam elements of fea. They are exact: the result does not depend on it.
    #[arg(long, default_value_t = DEFAULT_ELEMENTS, value_parser = elements)]
    elements: usize,
    /// Also show one point of the rod under a force at another (fea): where the force acts, as arc
    /// length from the flange in mm [default: the tip].
    #[arg(long, value_name = "MM", allow_negative_numbers = true)]
    load_station: Option<f64>,
    /// Likewise: which point is looked at [default: the tip].
    #[arg(long, value_name = "MM", allow_negative_numbers = true)]
    read_station: Option<f64>,
    /// Size of the contact force F in c_rod, in N [default: the paper's, 1.97].
    #[arg(long, value_name = "N", value_parser = contact_force, allow_negative_numbers = true)]
    contact_force: Option<f64>,
    /// Damping of the rod's swinging, in % of critical damping: settling times are those of it
    /// [default: 0.2, of bare tubes, and 1, with bonded or threaded joints].
    #[arg(long, value_name = "PERCENT", value_parser = damping, allow_negative_numbers = true)]
    damping_percent: Option<f64>,
}

const NOTES: &str = "\
A rod file holds at least this (the six rods of the paper are in rods/):

  name = \"5#\"
  [geometry]
  l1_mm = 150.0                  # flange to corner
  l2_mm = 525.0                  # corner to ball centre; 90° between unless
                                 # gamma_deg says otherwise
  [material.steel]
  youngs_modulus_gpa = 193.0
  poisson_ratio = 0.29
  density_kg_m3 = 7930.0
  [pipe1]                        # and the same under [pipe2]
  material = \"steel\"
  outer_diameter_mm = 32.0
  inner_diameter_mm = 30.0

Without [tip] mass_g the rod carries no ball; expect C^g to be too small then.
`rodcal --help` explains C^F, C^g and c_rod.";

#[derive(Debug, Clone, Copy, ValueEnum)]
enum CliMode {
    /// The paper's closed form, for two equal pipes at 90°: bending and torsion only.
    Calc,
    /// The beam finite-element model of the rod as built: any angle, bend, joints and masses.
    Fea,
}

/// The size of a force.
fn contact_force(text: &str) -> std::result::Result<f64, String> {
    match text.parse::<f64>() {
        Ok(force) if force.is_finite() && force >= 0.0 => Ok(force),
        _ => Err("expected a force in N, 0 or more".into()),
    }
}

/// A share of critical damping in per cent.
fn damping(text: &str) -> std::result::Result<f64, String> {
    match text.parse::<f64>() {
        Ok(percent) if percent > 0.0 && percent < 100.0 => Ok(percent),
        _ => Err("expected a damping in %, above 0 and below 100".into()),
    }
}

impl Compliance {
    pub fn run(&self) -> Result<Outcome> {
        let options = ComplianceOptions::default()
            .with_mode(match self.mode {
                CliMode::Calc => Mode::Calc,
                CliMode::Fea => Mode::Fea,
            })
            .with_physics(self.theory.unwrap_or(Theory::Timoshenko).physics())
            .with_elements(self.elements)
            .with_contact_force(self.contact_force.unwrap_or_else(paper_contact_force))
            .with_stations(self.load_station.map(|mm| mm * MM), self.read_station.map(|mm| mm * MM))
            .with_damping_ratio(self.damping_percent.map(|percent| 0.01 * percent));
        let mut answer = answer::compliance(Rod::read(&self.rod)?, &options)?;
        if let (CliMode::Calc, Some(Theory::Timoshenko)) = (self.mode, self.theory) {
            answer.report.warnings.push(
                "calc is Euler–Bernoulli by definition; --theory timoshenko only changes the fea columns"
                    .into(),
            );
        }
        answer.report.provenance = vec![
            ("rod file".into(), self.rod.display().to_string()),
            ("program".into(), concat!("rodcal ", env!("CARGO_PKG_VERSION")).into()),
        ];
        Ok(answer.into())
    }
}
