//! What every hypothesis holds: the numbers of the model's file, each known to its standard
//! uncertainty, and whatever else the base model is always a little wrong by.
//!
//! A number xₖ that is known to uₖ adds the column uₖ·∂predicted/∂xₖ, whose factor has the standard
//! normal as its prior (M. C. Kennedy, A. O'Hagan, *J. R. Stat. Soc. B* 63 (2001) 425–464;
//! J. Brynjarsdóttir, A. O'Hagan, *Inverse Problems* 30 (2014) 114007). Many such columns draw the
//! same: with N = U·S·Vᵀ the columns U·S, of which few are not zero, have the same prior, and
//!
//! ```text
//! x = V·z,   cov x = V·cov z·Vᵀ + (1 − V·Vᵀ)
//! ```

use nalgebra::{DMatrix, DVector, SymmetricEigen};

use super::{Evidence, Hypothesis};
use crate::linalg::transposed_product;

/// Singular value, relative to the largest, below which a direction draws nothing.
const NOTHING: f64 = 1e-6;
/// A number has moved if it is off by so many of its standard uncertainties, and by so many of what
/// is then left of them.
const MOVED: (f64, f64) = (0.3, 1.5);

/// A number of the model's file, or of the rig's set-up.
#[derive(Debug, Clone, PartialEq)]
pub struct NominalNumber {
    /// For people: `E of steel`.
    pub name: String,
    /// Unit for people.
    pub unit: &'static str,
    /// What one unit is in SI.
    pub si: f64,
    /// Nominal value, SI.
    pub value: f64,
    /// Standard uncertainty, SI.
    pub standard_uncertainty: f64,
}

/// What a recording says of a nominal number.
#[derive(Debug, Clone, PartialEq)]
pub struct NominalEstimate {
    /// The number.
    pub number: NominalNumber,
    /// Estimate and 95 % interval, SI.
    pub estimate: f64,
    /// Lower end.
    pub low: f64,
    /// Upper end.
    pub high: f64,
}

impl NominalEstimate {
    /// How far it moved, in standard uncertainties.
    pub fn moved(&self) -> f64 {
        (self.estimate - self.number.value) / self.number.standard_uncertainty
    }
}

/// An evidence whose nominal numbers stand among its background, and how to get them back.
pub(super) struct Folded {
    pub evidence: Evidence,
    /// V.
    basis: DMatrix<f64>,
    /// First of its columns in the background.
    first: usize,
}

/// Puts the nominal numbers into the background.
pub(super) fn folded(evidence: &Evidence) -> Folded {
    let first = evidence.background.ncols();
    if evidence.nominal.ncols() == 0 {
        return Folded { evidence: evidence.clone(), basis: DMatrix::zeros(0, 0), first };
    }
    let eigen = SymmetricEigen::new(transposed_product(&evidence.nominal, &evidence.nominal));
    let largest = eigen.eigenvalues.iter().copied().fold(0.0, f64::max);
    let mut kept: Vec<usize> = (0..eigen.eigenvalues.len())
        .filter(|&k| eigen.eigenvalues[k] > NOTHING * NOTHING * largest)
        .collect();
    kept.sort_by(|&a, &b| eigen.eigenvalues[b].total_cmp(&eigen.eigenvalues[a]));
    let basis = eigen.eigenvectors.select_columns(&kept);
    let own = &evidence.nominal * &basis;
    let mut background = DMatrix::zeros(evidence.residual.len(), first + own.ncols());
    background.columns_mut(0, first).copy_from(&evidence.background);
    background.columns_mut(first, own.ncols()).copy_from(&own);
    Folded { evidence: Evidence { background, ..evidence.clone() }, basis, first }
}

impl Folded {
    /// What the numbers explain of the recording, under a hypothesis.
    pub fn explained(&self, hypothesis: &Hypothesis) -> DVector<f64> {
        let count = self.basis.ncols();
        self.evidence.background.columns(self.first, count) * hypothesis.background.rows(self.first, count)
    }

    /// The numbers that moved, the farthest first.
    pub fn estimates(&self, hypothesis: &Hypothesis, coverage_factor: f64) -> Vec<NominalEstimate> {
        let count = self.basis.ncols();
        let factors = &self.basis * hypothesis.background.rows(self.first, count);
        let own = hypothesis.background_covariance.view((self.first, self.first), (count, count));
        let known = &self.basis * own * self.basis.transpose();
        let all = DMatrix::identity(factors.len(), factors.len());
        let covariance = known + (all - &self.basis * self.basis.transpose());
        let mut moved: Vec<NominalEstimate> = Vec::new();
        for (k, number) in self.evidence.nominal_numbers.iter().enumerate() {
            let (factor, sd) = (factors[k], covariance[(k, k)].max(0.0).sqrt());
            if factor.abs() < MOVED.0 || factor.abs() < MOVED.1 * (1.0 - sd * sd).max(0.0).sqrt() {
                continue;
            }
            let at = |factor: f64| number.value + factor * number.standard_uncertainty;
            let (low, high) = (factor - coverage_factor * sd, factor + coverage_factor * sd);
            moved.push(NominalEstimate {
                number: number.clone(),
                estimate: at(factor),
                low: at(low),
                high: at(high),
            });
        }
        moved.sort_by(|a, b| b.moved().abs().total_cmp(&a.moved().abs()));
        moved
    }
}
