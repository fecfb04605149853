//! The physics as the engine sees it: candidates with parameters, and what they would do to a recording.

use nalgebra::{DMatrix, DVector};

/// Step of a derivative, relative to the size of a parameter.
const STEP: f64 = 1e-4;

/// One effect at one place.
#[derive(Debug, Clone, PartialEq)]
pub struct Candidate {
    /// Name of the effect, for example `friction`. Candidates of one name share that effect's prior probability.
    pub effect: String,
    /// Where, for example `slide` or `station 205.0 mm`.
    pub location: String,
    /// Its parameters; without effect at their neutral values.
    pub parameters: Vec<EffectParameter>,
    /// How much of its effect's prior probability it has, relative to the effect's other places.
    pub weight: f64,
    /// True for one of several forms of the same thing, such as laws of creep: a story holds one of them at most.
    pub is_alternative: bool,
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

    /// True where the change is a sum of the effects' columns, the same at all values: much is then computed once.
    fn is_linear(&self) -> bool {
        false
    }

    /// Where an effect is once its values are known; the candidate's location unless the values say more.
    fn place(&self, chosen: &Chosen) -> String {
        self.candidates()[chosen.candidate].location.clone()
    }

    /// ∂change/∂parameter times the size of the parameter, at the values of a story: one column for each parameter of the
    /// effect at `position`.
    fn columns(&self, story: &[Chosen], position: usize) -> DMatrix<f64> {
        let chosen = &story[position];
        let mut moved = story.to_vec();
        let parameters = &self.candidates()[chosen.candidate].parameters;
        let mut column = |(k, parameter): (usize, &EffectParameter)| {
            let h = STEP * parameter.size;
            moved[position].values[k] = chosen.values[k] + h;
            let more = self.change(&moved);
            moved[position].values[k] = chosen.values[k] - h;
            let less = self.change(&moved);
            moved[position].values[k] = chosen.values[k];
            (more - less) / (2.0 * STEP)
        };
        let columns: Vec<DVector<f64>> = parameters.iter().enumerate().map(&mut column).collect();
        DMatrix::from_columns(&columns)
    }
}

impl Candidate {
    /// The candidate at its neutral values.
    pub fn neutral(&self, index: usize) -> Chosen {
        Chosen { candidate: index, values: self.parameters.iter().map(|p| p.neutral).collect() }
    }

    /// Bounds of its parameters in sizes from the neutral values.
    pub(super) fn scaled_bounds(&self) -> impl Iterator<Item = (f64, f64)> {
        let scaled = |p: &EffectParameter| {
            let of = |bound: f64| (bound - p.neutral) / p.size;
            (of(p.bounds.0), of(p.bounds.1))
        };
        self.parameters.iter().map(scaled)
    }
}
