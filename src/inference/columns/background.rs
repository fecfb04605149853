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

use crate::inference::{Evidence, Hypothesis, NominalEstimate};
use crate::linalg::transposed_product;
use crate::statistics::chi_squared_survival;

/// Singular value, relative to the largest, below which a direction draws nothing.
const NOTHING: f64 = 1e-6;
/// Standard deviation of an offset that data share for good, over that of a datum: a zero is one
/// reading or a few, taken a while ago.
const OFFSET: f64 = 1.5;
/// A number has moved if it is off by so many of its standard uncertainties.
const MOVED: f64 = 0.2;
/// Uncertainties are often stated too small: by so much, as a factor, is still no contradiction.
const UNDERSTATED: f64 = 2.0;
/// Probability below which numbers are not those of the file even so.
const IMPLAUSIBLE: f64 = 0.01;

/// An evidence whose nominal numbers stand among its background, and how to get them back.
pub struct Folded {
    pub evidence: Evidence,
    /// Basis V of the nominal numbers and offsets: a column each.
    basis: DMatrix<f64>,
    /// First of its columns in the background.
    first: usize,
}

/// Puts the nominal numbers and the offsets into the background.
pub fn folded(evidence: &Evidence) -> Folded {
    let first = evidence.background.ncols();
    let basis = basis(&evidence.nominal);
    let own = &evidence.nominal * &basis;
    let (count, offsets) = (own.ncols(), evidence.offsets.ncols());
    let mut background = DMatrix::zeros(evidence.residual.len(), first + count + offsets);
    background.columns_mut(0, first).copy_from(&evidence.background);
    background.columns_mut(first, count).copy_from(&own);
    // the columns of the nominal numbers stand in the background from here on
    let nominal = DMatrix::zeros(evidence.residual.len(), 0);
    let mut evidence = Evidence { background, nominal, folded: first..first + count, ..evidence.clone() };
    size_offsets(&mut evidence, 0.0);
    Folded { evidence, basis, first }
}

/// Factors of all nominal numbers, in standard uncertainties, given those of the background of the
/// folded evidence.
pub fn nominal_factors(evidence: &Evidence, background: &[f64]) -> DVector<f64> {
    let basis = basis(&evidence.nominal);
    let first = evidence.background.ncols();
    let own = |k: usize, _| background.get(first + k).copied().unwrap_or(0.0);
    let own = DVector::from_fn(basis.ncols(), own);
    basis * own
}

/// V without the directions that draw nothing.
fn basis(nominal: &DMatrix<f64>) -> DMatrix<f64> {
    if nominal.ncols() == 0 {
        return DMatrix::zeros(0, 0);
    }
    let eigen = SymmetricEigen::new(transposed_product(nominal, nominal));
    let largest = eigen.eigenvalues.iter().copied().fold(0.0, f64::max);
    let mut kept: Vec<usize> = (0..eigen.eigenvalues.len())
        .filter(|&k| eigen.eigenvalues[k] > NOTHING * NOTHING * largest)
        .collect();
    kept.sort_by(|&a, &b| eigen.eigenvalues[b].total_cmp(&eigen.eigenvalues[a]));
    eigen.eigenvectors.select_columns(&kept)
}

/// Gives the offsets, the last columns of the background, the size that goes with a noise: that of
/// the data which share one.
pub fn size_offsets(evidence: &mut Evidence, noise: f64) {
    let count = evidence.offsets.ncols();
    let first = evidence.background.ncols() - count;
    for k in 0..count {
        let offset = evidence.offsets.column(k);
        let spread = offset.iter().zip(&evidence.spread).find(|(own, _)| **own != 0.0);
        let own = spread.map_or(1.0, |(_, spread)| *spread) * noise;
        let column = offset * evidence.least_offset[k].hypot(OFFSET * own);
        evidence.background.set_column(first + k, &column);
    }
}

/// True where the numbers would have to be farther off than the file says they are known, even if
/// it says that twice too well; of a folded evidence, or some of its data:
///
/// ```text
/// p(χ²_d > |z|²/4) < 0.01,   d = Σ (1 − var z)      directions that the data determine
/// ```
pub fn is_implausible(evidence: &Evidence, hypothesis: &Hypothesis) -> bool {
    let square: f64 = evidence.folded.clone().map(|k| hypothesis.background[k].powi(2)).sum();
    let variance = |k: usize| hypothesis.background_covariance[(k, k)];
    let determined: f64 = evidence.folded.clone().map(|k| (1.0 - variance(k)).max(0.0)).sum();
    chi_squared_survival(square / UNDERSTATED.powi(2), determined.max(1.0))
        .is_ok_and(|probability| probability < IMPLAUSIBLE)
}

impl Folded {
    /// Factors of all numbers, in standard uncertainties, with their covariance.
    pub fn factors(&self, hypothesis: &Hypothesis) -> (DVector<f64>, DMatrix<f64>) {
        let count = self.basis.ncols();
        let factors = &self.basis * hypothesis.background.rows(self.first, count);
        let own = hypothesis.background_covariance.view((self.first, self.first), (count, count));
        let known = &self.basis * own * self.basis.transpose();
        let all = DMatrix::identity(factors.len(), factors.len());
        (factors, known + (all - &self.basis * self.basis.transpose()))
    }

    /// See [`is_implausible`]; or one number alone has to be that far off, whichever of the n:
    ///
    /// ```text
    /// n·p(χ²₁ > z²/4) < 0.01
    /// ```
    pub fn is_implausible(&self, hypothesis: &Hypothesis) -> bool {
        let (factors, _) = self.factors(hypothesis);
        let farthest = factors.iter().fold(0.0, |most: f64, factor| most.max(factor.powi(2)));
        let of_one = chi_squared_survival(farthest / UNDERSTATED.powi(2), 1.0);
        is_implausible(&self.evidence, hypothesis)
            || of_one.is_ok_and(|p| p * (factors.len() as f64).max(1.0) < IMPLAUSIBLE)
    }

    /// What the numbers that moved change in the data.
    pub fn response(&self, hypothesis: &Hypothesis) -> DVector<f64> {
        let count = self.basis.ncols();
        self.evidence.background.columns(self.first, count) * hypothesis.background.rows(self.first, count)
    }

    /// The numbers that moved, the farthest first.
    pub fn estimates(&self, hypothesis: &Hypothesis, coverage_factor: f64) -> Vec<NominalEstimate> {
        let (factors, covariance) = self.factors(hypothesis);
        let mut moved: Vec<NominalEstimate> = Vec::new();
        for (k, number) in self.evidence.nominal_numbers.iter().enumerate() {
            let (factor, sd) = (factors[k], covariance[(k, k)].max(0.0).sqrt());
            if factor.abs() < MOVED {
                continue;
            }
            let at = |factor: f64| number.value + factor * number.standard_uncertainty;
            moved.push(NominalEstimate {
                number: number.clone(),
                estimate: at(factor),
                low: at(factor - coverage_factor * sd),
                high: at(factor + coverage_factor * sd),
            });
        }
        moved.sort_by(|a, b| b.moved().abs().total_cmp(&a.moved().abs()));
        moved
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_zero_is_as_uncertain_as_readings_of_its_own_sensor() {
        let of_sensor = |row: usize, k: usize| f64::from(u8::from(row % 2 == k));
        let evidence = Evidence {
            offsets: DMatrix::from_fn(8, 2, of_sensor),
            least_offset: vec![0.0, 4.0],
            spread: (0..8).map(|row| [6.0, 1.0][row % 2]).collect(),
            ..Evidence::new(DVector::zeros(8))
        };
        let mut evidence = folded(&evidence).evidence;
        size_offsets(&mut evidence, 2.0);
        let sizes = [0, 1].map(|k| evidence.background.column(k).amax());
        assert_eq!(sizes, [6.0 * OFFSET * 2.0, 4.0f64.hypot(OFFSET * 2.0)]);
    }
}
