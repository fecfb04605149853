//! The physics as the engine sees it: candidates with parameters, and what they would do to a recording.

use nalgebra::DVector;

/// One effect at one place.
#[derive(Debug, Clone, PartialEq)]
pub struct Candidate {
    /// Name of the effect, for example `friction`. Candidates of one name share that effect's prior probability.
    pub effect: String,
    /// Where, for example `slide` or `station 205.0 mm`.
    pub location: String,
    /// Its parameters; without effect at their neutral values.
    pub parameters: Vec<EffectParameter>,
    /// True for a smooth curve that stands for physics nobody has named: it competes, but is never a finding.
    pub is_unknown: bool,
}

/// A number that says how strong an effect is.
#[derive(Debug, Clone, PartialEq)]
pub struct EffectParameter {
    /// Name with its unit, for example `force_n`.
    pub name: String,
    /// What one unit of the name is in SI.
    pub unit: f64,
    /// Value at which nothing happens, SI.
    pub neutral: f64,
    /// Size at which the effect is typically met: standard deviation of its prior about the neutral value, SI.
    pub size: f64,
    /// Physical bounds, SI; ±∞ where there are none.
    pub bounds: (f64, f64),
}

/// A candidate that is taken for real.
#[derive(Debug, Clone, PartialEq)]
pub struct Chosen {
    /// Index among [`World::candidates`].
    pub candidate: usize,
    /// Values of its parameters, SI.
    pub values: Vec<f64>,
}

/// What would have been recorded.
pub trait World: Sync {
    /// All that might be real. The order is that of preference among equals.
    fn candidates(&self) -> &[Candidate];

    /// The recording with the chosen effects, all acting together, less the recording without any: one number per datum
    /// of the evidence, in its unit. Zeros for no effect, or for effects at their neutral values.
    fn change(&self, story: &[Chosen]) -> DVector<f64>;
}

impl Candidate {
    /// The candidate at its neutral values.
    pub fn neutral(&self, index: usize) -> Chosen {
        Chosen { candidate: index, values: self.parameters.iter().map(|p| p.neutral).collect() }
    }
}
