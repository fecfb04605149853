//! The physics of a calibration: what could be left in the residuals of a robot that was calibrated
//! as well as it can be.
//!
//! The engine judges every effect after all that the calibration can absorb: its Jacobian is the
//! evidence's nuisance (`evidence.rs`). An effect is a displacement of the tip, to first order
//! through the calibrated kinematics, so that the response of a hypothesis is a sum of columns that
//! are made once (`linear_terms.rs`). Which effects there are, with all that is said of each:
//! `effects/`. The rivals that stand for physics nobody has named: `nonparametric.rs`.
//!
//! What a calibration absorbs cannot be seen: an eccentricity of the last joint is nothing where
//! the target lies on that joint's axis. Such effects are no candidates, but
//! [`absorbed`](crate::inference::Diagnosed::absorbed) says which they are.

mod apply;
mod beside;
mod configuration;
mod context;
mod correction_table;
mod cosines;
mod diagnose;
pub mod effects;
mod entry;
mod evidence;
mod feasible_poses;
mod forward_model;
mod gear;
mod law;
mod law_measures;
mod limits;
mod linear_terms;
mod memory;
mod mistakes;
mod model;
mod next;
mod nominal;
mod nonparametric;
mod patterns;
mod prepared;
mod sites;
mod tails;
#[cfg(test)]
mod tests;
mod textbook;
mod torque_uncertainty;
mod transfer;
mod unfollowed;
mod vector;
mod written_law;

pub use apply::{Applied, apply, law_destination};
pub use diagnose::{CalibrationDiagnosis, Happened, diagnose, diagnose_calibrated};
pub use effects::CalibrationEffect;
pub use gear::{Curve, Gear};
pub use law::{Course, Frame, Law, Power, RodLoad, TakenUp};
pub use memory::{MEMORY_LIMIT, check_memory, memory_needed};
pub use mistakes::{Mended, Neighbours, Suspicion, mend, suspected};
pub use model::CalibrationModel;
pub use textbook::remark;
