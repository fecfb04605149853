//! Concealed-effect trials: recordings in which an effect is hidden, sealed in an envelope, and the score of whoever
//! answers what it was.
//!
//! The generator shares no physics with the models that answer: it knows file formats and nothing else of the program
//! (`tests/architecture.rs` keeps it so), and its mechanics are richer than theirs. What an answer could have known at
//! best is computed here too, by an oracle that knows every recording without its noise.

pub mod answers;
pub mod envelope;
pub mod rig;
pub mod score;
pub mod truth;
