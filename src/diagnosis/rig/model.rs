//! Readings of a rig as the engine sees them: data, what turns forces into displacements,
//! candidates.

mod build;
mod cases;
mod derivative;
mod first_sight;
mod forward_model;
pub(super) mod nominal;
mod response;
pub(super) mod transfer;
pub(super) mod wanted;
mod widened;

use self::cases::Cases;
use self::nominal::KnownNumber;
use super::mechanics::action::Action;
use super::mechanics::slide::Course;
use super::mechanics::structure::Structure;
use super::own_effect::OwnEffect;
use super::recording::datum::Datum;
use super::recording::place::Known;
use crate::diagnosis::Diagnosed;
use crate::inference::Candidate;
use crate::rig::readings::Readings;
use crate::rod::{Rod, RodLaw};

/// A rig's diagnosis.
pub type RigDiagnosis = Diagnosed<RigModel>;

/// Readings of a rig with all the physics that might be in them.
#[derive(Debug, Clone)]
pub struct RigModel {
    pub(super) readings: Readings,
    pub(super) rod: Option<Rod>,
    pub(super) as_recorded: Option<Box<AsRecorded>>,
    pub(super) data: Vec<Datum>,
    /// What the rod as it bends would show, without the rig's effects, m: what the columns of the
    /// nominal numbers are shares of.
    pub(super) bent: Vec<f64>,
    /// What each of the nominal numbers is.
    pub(super) known_numbers: Vec<KnownNumber>,
    pub(super) body: Body,
    /// For each datum the pair of stations (with a rod) or the line (without).
    pub(super) place: Vec<usize>,
    /// Which data follow which, and the usual step of an imposed displacement (m).
    pub(super) course: Course,
    pub(super) step: f64,
    pub(super) cases: Cases,
    pub(super) candidates: Vec<Candidate>,
    /// For each candidate what its parameters do.
    pub(super) actions: Vec<Vec<Action>>,
    /// What laws of the rod's file add to each datum as predicted, m; nothing without any.
    pub(super) law_adds: Vec<f64>,
    /// Laws of the rod's file that the readings have no data for.
    pub(super) unused_laws: Vec<RodLaw>,
    /// Effects that the lab describes itself.
    pub(super) own: Vec<OwnEffect>,
}

/// Readings and rod before mistakes were undone, where there were any.
#[derive(Debug, Clone)]
pub(super) struct AsRecorded {
    pub(super) readings: Readings,
    pub(super) rod: Option<Rod>,
    /// Root mean square of what the rod's model leaves, m; `None` where the two cannot be compared.
    pub(super) error: Option<f64>,
}

/// What turns a force into a displacement.
#[derive(Debug, Clone)]
pub(super) enum Body {
    Rod(Box<Structure>),
    /// So many lines of unknown slopes.
    Lines(usize),
}

impl RigModel {
    /// Name of a session, by its number in
    /// [`Evidence::session`](crate::inference::Evidence::session).
    pub fn session(&self, number: usize) -> &str {
        let of_session = self.data.iter().find(|datum| datum.session_number == number);
        of_session.and_then(|datum| datum.session.as_deref()).unwrap_or("without a name")
    }

    /// The data in the order of recording, which is that of the evidence.
    pub fn data(&self) -> &[Datum] {
        &self.data
    }

    /// The readings, without the mistakes that were found.
    pub fn readings(&self) -> &Readings {
        &self.readings
    }

    /// The rod, where there is one, without the mistakes that were found.
    pub fn rod(&self) -> Option<&Rod> {
        self.rod.as_ref()
    }

    /// The readings as they were given, mistakes included.
    pub fn recorded(&self) -> &Readings {
        self.as_recorded.as_ref().map_or(&self.readings, |given| &given.readings)
    }

    /// The rod as its file gives it, mistakes included.
    pub fn rod_of_file(&self) -> Option<&Rod> {
        self.as_recorded.as_ref().map_or(self.rod.as_ref(), |given| given.rod.as_ref())
    }

    /// Laws of the rod's file that are not used, because the readings have no data for them.
    pub fn unused_laws(&self) -> &[RodLaw] {
        &self.unused_laws
    }

    /// Root mean square of what the model of the file leaves of the readings as they were given, m;
    /// `None` where no mistake was found, or where the two cannot be compared.
    pub fn recorded_error(&self) -> Option<f64> {
        self.as_recorded.as_ref()?.error
    }

    /// What a newton of a measured load counts, m/N; `None` where loads were set.
    pub fn per_newton(&self) -> Option<f64> {
        self.data.iter().find_map(|datum| datum.imposed).map(|imposed| imposed.per_newton)
    }

    /// What imposed displacements count as, in words, where that is not what was read of each.
    pub fn displacements_count_as(&self) -> Option<&'static str> {
        let are = |known: Known| self.data.iter().any(|d| d.imposed.is_some_and(|own| own.known == known));
        match (are(Known::Set), are(Known::Passed)) {
            (true, true) => {
                Some("the mean of all readings of each setting, and a smooth curve through each sweep")
            }
            (true, false) => Some("the mean of all readings of each setting"),
            (false, true) => Some("a smooth curve through the readings of each sweep"),
            (false, false) => None,
        }
    }

    /// Stated noise of an offset, m; where only loads were read or only their noise is stated, that
    /// of a load, with that of the displacement where that is known from its own reading.
    pub(super) fn stated_noise(&self) -> Option<f64> {
        let header = &self.readings.header;
        let of_load = self.per_newton().zip(header.load_noise).map(|(per_newton, noise)| per_newton * noise);
        if self.data.iter().any(|datum| datum.imposed.is_none()) {
            return header.noise.or(of_load);
        }
        let is_as_read =
            self.data.iter().any(|d| d.imposed.is_some_and(|imposed| imposed.known.has_noise_of_reading()));
        match (header.noise.filter(|_| is_as_read), of_load) {
            (Some(a), Some(b)) => Some(a.hypot(b)),
            (a, b) => a.or(b),
        }
    }
}
