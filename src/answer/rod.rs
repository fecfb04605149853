//! How much does a rod bend?

use super::Answer;
use crate::beam::Physics;
use crate::compliance::{DEFAULT_ELEMENTS, Mode, Study, paper_contact_force};
use crate::error::Result;
use crate::report;
use crate::rod::Rod;

/// How a rod is looked at.
#[derive(Debug, Clone)]
#[non_exhaustive]
pub struct ComplianceOptions {
    /// Which model the headline and the JSON are about.
    pub mode: Mode,
    /// Beam theory of the beam model.
    pub physics: Physics,
    /// Number of its elements; the result does not depend on it.
    pub elements: usize,
    /// Size of the contact force in c_rod, N.
    pub contact_force: f64,
    /// Where a force acts that is looked at too, as arc length from the flange, m; the tip where
    /// only the other is given.
    pub load_station: Option<f64>,
    /// Which point is looked at, likewise.
    pub read_station: Option<f64>,
    /// Damping ratio ζ of settling times, where it is known.
    pub damping_ratio: Option<f64>,
}

impl Default for ComplianceOptions {
    fn default() -> Self {
        ComplianceOptions {
            mode: Mode::Fea,
            physics: Physics::default(),
            elements: DEFAULT_ELEMENTS,
            contact_force: paper_contact_force(),
            load_station: None,
            read_station: None,
            damping_ratio: None,
        }
    }
}

impl ComplianceOptions {
    /// About this model.
    pub fn with_mode(self, mode: Mode) -> Self {
        ComplianceOptions { mode, ..self }
    }

    /// With this beam theory.
    pub fn with_physics(self, physics: Physics) -> Self {
        ComplianceOptions { physics, ..self }
    }

    /// With so many elements.
    pub fn with_elements(self, elements: usize) -> Self {
        ComplianceOptions { elements, ..self }
    }

    /// With a contact force of this size in c_rod, N.
    pub fn with_contact_force(self, contact_force: f64) -> Self {
        ComplianceOptions { contact_force, ..self }
    }

    /// Loaded at one arc length from the flange and read at another, m; `None` is the tip.
    pub fn with_stations(self, load_station: Option<f64>, read_station: Option<f64>) -> Self {
        ComplianceOptions { load_station, read_station, ..self }
    }

    /// With this damping ratio ζ, where it is known.
    pub fn with_damping_ratio(self, damping_ratio: Option<f64>) -> Self {
        ComplianceOptions { damping_ratio, ..self }
    }
}

/// C^F, C^g and c_rod of a rod's model.
///
/// ```
/// use rodcal::answer::{ComplianceOptions, compliance};
/// use rodcal::rod::Rod;
///
/// let rod = Rod::read("rods/5.toml".as_ref())?;
/// let answer = compliance(rod, &ComplianceOptions::default())?;
/// let c_rod = answer.json["c_rod_um"].as_f64().unwrap_or(0.0);
/// assert!((c_rod / 403.7 - 1.0).abs() < 0.015, "{c_rod}"); // the paper's Table 2, 403.7 µm
/// # Ok::<(), rodcal::Error>(())
/// ```
///
/// # Errors
/// As [`Study::new`] and [`Study::with_stations`].
pub fn compliance(rod: Rod, options: &ComplianceOptions) -> Result<Answer> {
    let tip = rod.length();
    let mut study = Study::new(rod, options.mode, options.physics, options.elements, options.contact_force)?;
    if options.load_station.is_some() || options.read_station.is_some() {
        study =
            study.with_stations(options.load_station.unwrap_or(tip), options.read_station.unwrap_or(tip))?;
    }
    study.damping_ratio = options.damping_ratio;
    Ok(Answer::new(report::compliance::json(&study), report::compliance::report(&study)))
}
