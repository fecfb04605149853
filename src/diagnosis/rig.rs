//! The physics of a stiffness rig: what could have made its readings differ from the rod's model.
//!
//! Three stages act one after another, so that effects combine as they would on the bench (friction
//! on a rod whose modulus is off too): a nominal load becomes a force, a force becomes a
//! displacement, a displacement becomes a reading. Formulae: `action.rs` (stages), `slide.rs`
//! (friction and play along a course), `structure.rs` (compliance), `load_history.rs` (creep,
//! hysteresis). What was recorded when, in which session and run, and which way the load went:
//! `chronicle.rs`. Which effects there are and how large they usually are: `effects/`. The rivals
//! that stand for physics nobody has named: `nonparametric.rs`.
//!
//! Without a rod (`linear`) each line of readings has a slope c that nobody knows. The evidence
//! leaves it to the engine as a nuisance, and an effect that scales with the displacement takes the
//! slope that fits best with that effect in place (G. H. Golub, V. Pereyra, *SIAM J. Numer. Anal.*
//! 10 (1973) 413–432: separable least squares),
//!
//! ```text
//! change = c·(h − F) + shifts,   c = Σ h·(y − shifts)/Σ h²        h the load that is felt, F the nominal one
//! ```
//!
//! which is exact once the engine has fitted its own multiple of F.
//!
//! Where the displacement is imposed and the load is measured (`driven = "displacement"`), the
//! loads are what is compared: the same chain, solved for the load, of which each newton counts as
//! c₀ = max|u|/max|F| metres, so that loads and the readings of other sensors stand in one unit.

mod action;
mod another_rod;
mod as_measured;
mod build;
mod cases;
mod chronicle;
mod columns;
mod datum;
mod derivative;
mod diagnose;
mod display;
pub mod effects;
mod evidence;
mod feasible;
mod file_laws;
mod first_sight;
mod forward_model;
mod law_measures;
mod limits;
mod load_history;
mod mistakes;
mod model;
mod next;
mod nominal;
mod nonparametric;
mod numbering;
mod own;
mod own_effect;
mod own_law;
pub mod planned;
mod recovery;
mod remembered;
mod response;
mod sites;
mod slide;
mod state;
mod structure;
#[cfg(test)]
mod tests;
mod textbook;
mod transfer;
mod wanted;
mod widened;
mod write_back;
mod written_law;

pub use datum::Datum;
pub use diagnose::{diagnose, diagnose_among, diagnose_with};
pub use mistakes::suspected;
pub use model::{RigDiagnosis, RigModel};
pub use own_effect::OwnEffect;
pub use textbook::remark;
pub use write_back::{Correction, WrittenItem};
