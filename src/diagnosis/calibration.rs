//! The physics of a calibration: what could be left in the residuals of a robot that was calibrated
//! as well as it can be.
//!
//! The engine judges every effect after all that the calibration can absorb: its Jacobian is the
//! evidence's nuisance (`evidence.rs`). An effect is a displacement of the tip, to first order
//! through the calibrated kinematics, so that the response of a hypothesis is a sum of columns that
//! are made once (`linear_terms.rs`). Which effects there are, with all that is said of each:
//! `effects/`. The rivals that stand for physics nobody has named: `nonparametric.rs`.
//!
//! A diagnosis takes two steps: [`mend`] undoes what was written or wired wrongly, and
//! [`Mended::diagnose`] calibrates what was meant and asks its residuals for physics.
//!
//! ```
//! use rodcal::prelude::*;
//!
//! // simulated with nothing but noise
//! let campaign = Campaign::read("campaigns/tx90-5/campaign.toml".as_ref())?;
//! let mended = mend(&campaign, Mode::Meas, &Neighbours::default(), &Options::default())?;
//! let found = mended.diagnose()?;
//! assert!(mended.found.is_empty() && !found.diagnosis.is_mismatch());
//! # Ok::<(), rodcal::Error>(())
//! ```
//!
//! What a calibration absorbs cannot be seen: an eccentricity of the last joint is nothing where
//! the target lies on that joint's axis. Such effects are no candidates, but
//! [`absorbed`](crate::diagnosis::Diagnosed::absorbed) says which they are.

mod diagnose;
pub mod effects;
mod evidence;
mod in_order;
mod laws;
mod mistakes;
mod model;
mod next;
mod nonparametric;
#[cfg(test)]
mod tests;
mod transfer;
mod validated;
mod write_back;

pub use self::diagnose::memory::{MEMORY_LIMIT, check_memory, memory_needed};
pub use self::laws::textbook::remark;
pub use self::model::CalibrationModel;
pub use self::model::covariance::{ScatterSource, ScatterSources, Source};
pub use self::model::gear::{Curve, Gear};
pub use self::model::law::{Course, Frame, Law, RodLoad, TakenUp};
pub use self::model::validated::{OwnDiagnosis, Validated};
pub use self::validated::look_at_validation;
pub use self::write_back::apply::{Applied, apply};
pub use self::write_back::destination::law_destination;
pub use diagnose::{CalibrationDiagnosis, Happened, diagnose_as_recorded, diagnose_calibrated};
pub use effects::CalibrationEffect;
pub use effects::gear::GearError;
pub use mistakes::{Mended, Neighbours, mend, suspected};
