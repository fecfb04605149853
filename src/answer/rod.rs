//! How much does a rod bend?

use super::Answer;
use crate::beam::Physics;
use crate::compliance::{DEFAULT_ELEMENTS, Mode, Study, paper_contact_force};
use crate::error::Result;
use crate::report;
use crate::rod::Rod;

/// How a rod is looked at.
#[derive(Debug, Clone)]
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

/// C^F, C^g and c_rod of a rod's model.
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
