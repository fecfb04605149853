//! The physics of a stiffness rig: what could have made its readings differ from the rod's model.
//!
//! Three stages act one after another, so that effects combine as they would on the bench (friction
//! on a rod whose modulus is off too): a nominal load becomes a force, a force becomes a
//! displacement, a displacement becomes a reading.
//!
//! | room | what stands there |
//! |---|---|
//! | `diagnose` | from readings to findings: the order of the steps |
//! | `recording` | data, their order, what repeats |
//! | `mistakes` | what is undone before there is a model |
//! | `effects` | which effects there are, how large they usually are, how each is said and written |
//! | `own_effect` | effects that a lab describes itself |
//! | `nonparametric` | the rivals that stand for physics nobody has named |
//! | `mechanics` | the formulas: load, structure, slide, history of the loads, display |
//! | `model` | readings and mechanics as the engine's forward model |
//! | `laws` | formulas of the rod's file, and those that are proposed |
//! | `measurements` | what could be measured next, or first |
//! | `write_back` | findings in the rod's file, or taken out of the readings |
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

mod diagnose;
pub mod effects;
mod laws;
mod measurements;
mod mechanics;
mod mistakes;
mod model;
mod nonparametric;
mod numbering;
mod own_effect;
mod recording;
#[cfg(test)]
mod tests;
mod write_back;

pub use diagnose::{diagnose, diagnose_among, diagnose_with};
pub use laws::textbook::remark;
pub use measurements::planned;
pub use mistakes::suspected;
pub use model::{RigDiagnosis, RigModel};
pub use own_effect::OwnEffect;
pub use recording::datum::Datum;
pub use write_back::{Correction, WrittenItem};
