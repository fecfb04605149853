//! Which physics a model left out: locate a mismatch, name it, model it, show that the fit improves.
//!
//! The engine knows no physics. It sees a recording as numbers ([`Evidence`]) and the physics as candidates, each an
//! effect at a place with a few parameters ([`Candidate`]), and asks a [`World`] what would have been recorded if some of
//! them were real. Which effects there are, how they act together and how they are said to people is the world's business.

pub mod calibration;
mod choice;
mod diagnose;
mod evidence;
mod judgement;
mod kept;
mod lack_of_fit;
mod linear;
mod locate;
mod proof;
mod quantity;
mod replication;
pub mod rig;
mod score;
mod search;
mod selection;
mod sparse;
mod whitening;
mod words;
mod world;

#[cfg(test)]
mod tests;

pub use diagnose::{Diagnosis, Finding, Rival, Unexplained, diagnose, rms};
pub use evidence::{Covariate, Evidence};
pub use lack_of_fit::LackOfFit;
pub use locate::Structure;
pub use proof::Proof;
pub use quantity::Quantity;
pub use replication::Replica;
pub use search::Story;
pub use selection::NAMED;
pub use words::Words;
pub use world::{Candidate, Chosen, EffectParameter, World};
