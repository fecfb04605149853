//! Concealed-effect trials: recordings in which an effect is hidden, sealed in an envelope, and the score of whoever
//! answers what it was.
//!
//! The generator shares no physics with the models that answer: it knows file formats and nothing else of the program
//! (`tests/architecture.rs` keeps it so), and its mechanics are richer than theirs. What an answer could have known at
//! best is computed here too, by an oracle that knows every recording without its noise.

pub mod answers;
mod calibration;
pub mod envelope;
pub mod rig;
pub mod score;
pub mod truth;

/// A case: what is handed out and what is kept.
#[derive(Debug, Clone, PartialEq)]
pub struct Case {
    /// Name and text of each file.
    pub files: Vec<(String, String)>,
    /// What is concealed.
    pub truth: truth::Truth,
}

/// What is tried.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Half {
    /// Readings of rods at a stiffness rig.
    Rig,
    /// Recordings of arms.
    Calibration,
    /// Of three cases the third is a calibration.
    Both,
}

/// Case number `number` of the trial that belongs to `seed`.
fn case(seed: u64, number: usize, half: Half) -> Case {
    let is_calibration = half == Half::Calibration || (half == Half::Both && number.is_multiple_of(3));
    if is_calibration { calibration::case(seed, number) } else { rig::case(seed, number) }
}
