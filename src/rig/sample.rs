//! Readings of one line, their averages, and the test of a curve through them.

use super::readings::Phase;

/// Significance level of a lack of fit.
const SIGNIFICANCE: f64 = 0.01;

/// One reading of a line.
#[derive(Debug, Clone, Copy)]
pub struct Sample {
    /// Magnitude of the load, N.
    pub load: f64,
    /// Offset of the channel, m.
    pub offset: f64,
    /// Loading or unloading.
    pub phase: Phase,
    /// Which trial it belongs to; all alike where the file names none.
    pub trial: usize,
    /// Line in the file.
    pub line: usize,
}

/// The average of the repeats at one load.
#[derive(Debug, Clone, Copy, PartialEq)]
#[non_exhaustive]
pub struct Point {
    /// Magnitude of the load, N.
    pub load: f64,
    /// Loading or unloading.
    pub phase: Phase,
    /// Mean offset, m.
    pub mean: f64,
    /// Number of readings.
    pub count: f64,
    /// Offset less that of the fitted line, m.
    pub residual: f64,
}

/// F test of a curve against the scatter of repeats.
#[derive(Debug, Clone, Copy, PartialEq)]
#[non_exhaustive]
pub struct LackOfFit {
    /// F = s_f²/s_e²: variance of the averages about the curve over that of repeats about them.
    pub f: f64,
    /// Degrees of freedom of the averages, K − p: K loads, p coefficients of the curve.
    pub dof_fit: usize,
    /// N − K, less what trials take up where they differ.
    pub dof_repeats: usize,
    /// Probability of so large an F, were the curve right and all repeats independent.
    pub p_value: f64,
}

impl Sample {
    /// What it shares with its repeats: the bits of the load (0 and −0 are one), and the phase.
    pub(super) fn repeated(&self) -> (u64, Phase) {
        ((self.load + 0.0).to_bits(), self.phase)
    }
}

impl LackOfFit {
    /// The averages leave the curve by more than the repeats allow (p < 0.01).
    pub fn is_significant(&self) -> bool {
        self.p_value < SIGNIFICANCE
    }
}
