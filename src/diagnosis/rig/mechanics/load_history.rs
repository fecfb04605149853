//! What a rod remembers of its loads: creep, hysteresis, and softening with temperature.

mod creep;
mod hysteresis;
mod memory;
#[cfg(test)]
mod tests;

pub use self::creep::{Changed, Clock, Onset, creep, is_stated, onsets};
pub use self::hysteresis::{Loop, hysteresis};
use self::memory::none;
pub use self::memory::{Memory, dwell, instants, moments, runs, shortest};
use crate::diagnosis::rig::recording::datum::Datum;

/// Which law a memory follows.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum History {
    /// Creep by a clock, with t₀ in s.
    Creep(Clock, f64),
    /// Hysteresis of a shape.
    Loop(Loop),
    /// Softening with temperature.
    Temperature,
}

/// Softening with temperature: displacement × (1 + k·(T − T̄)), T̄ the mean of the recording, K.
/// Nothing where a reading has no temperature, or where all have the same.
pub fn warmth(data: &[Datum]) -> Option<Memory> {
    let temperatures: Vec<f64> = data.iter().map(|d| d.temperature).collect::<Option<_>>()?;
    temperatures.iter().any(|one| *one != temperatures[0]).then_some(())?;
    let mean = temperatures.iter().sum::<f64>() / temperatures.len() as f64;
    Some(Memory { relative: temperatures.into_iter().map(|one| one - mean).collect(), ..none(data) })
}
