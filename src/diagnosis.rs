//! Which physics a model left out: locate a mismatch, name it, model it, show that the fit improves.
//!
//! The engine knows no physics. It sees a recording as numbers ([`Evidence`]) and the physics as candidates, each an
//! effect at a place with a few parameters ([`Candidate`]), and asks a [`World`] what would have been recorded if some of
//! them were real. Which effects there are, how they act together and how they are said to people is the world's business.

pub mod evidence;
pub mod rig;
pub mod world;

pub use evidence::Evidence;
pub use world::{Candidate, Chosen, EffectParameter, World};
