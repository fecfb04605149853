//! Errors that data share, and what the base model absorbs, taken out of residuals and columns.
//!
//! The errors of a group that shares one, of relative variance ρ, have the covariance σ²·(1 + ρ·J),
//! J all ones. With m data in the group
//!
//! (1 + ρ·J)^(−1/2) = 1 − (1 − 1/√(1 + ρ·m))/m · J
//!
//! makes them independent. Where neighbours in a group resemble each other, with the correlation φ,
//! its covariance is σ²·(R + ρ·J), R the φ^|i − j| of a first-order autoregression. With A·R·Aᵀ =
//! 1,
//!
//! (A·v)₁ = v₁   (A·v)ₜ = (vₜ − φ·vₜ₋₁)/√(1 − φ²)   and a = A·1,
//!
//! (1 − (1 − 1/√(1 + ρ·|a|²))/|a|² · a·aᵀ)·A takes its place. Where neighbours along a course have
//! errors in common, [`correlated_noise`](crate::inference::noise::correlated_noise) makes them
//! independent. What is left is projected
//! on the complement of the whitened nuisance columns, M = 1 − Q·Qᵀ.

use std::collections::{BTreeMap, HashMap};

use nalgebra::{DMatrix, DVector};

use crate::inference::Evidence;
use crate::inference::noise::correlated_noise::Filter;
use crate::inference::noise::correlation::{correlation, length};
use crate::inference::noise::shared_ratio::shared_ratio;
use crate::linalg::{least_squares, thin_svd, transposed_product};
use crate::parallel::checkpoint;

/// Length, relative to what it was, below which a nuisance column is a combination of the others.
const DEPENDENT: f64 = 1e-9;

/// Whitens and projects vectors of n data.
#[derive(Debug, Clone)]
pub struct Whitening {
    data: usize,
    /// Root of how much each datum counts; nothing where all count alike.
    roots: Vec<f64>,
    /// Rows of every group with more than one datum, and what is taken off along a.
    groups: Vec<(Vec<usize>, f64)>,
    /// Correlation φ of neighbours that share an error, beyond that.
    pub correlation: f64,
    /// Of errors that neighbours along a course have in common.
    correlated_noise: Option<Filter>,
    /// Ln of the volume that the whitened nuisance columns span.
    log_volume: f64,
    /// Orthonormal basis of the whitened nuisance columns.
    basis: Vec<DVector<f64>>,
    /// What each whitened nuisance column counts in each vector of the basis.
    coefficients: Vec<DVector<f64>>,
    /// How many nuisance columns there are.
    nuisance: usize,
    /// Ratio ρ of the variance of shared errors to that of errors of each datum.
    pub ratio: f64,
    /// Data less what the nuisance columns absorb.
    pub degrees_of_freedom: usize,
}

impl Whitening {
    /// For an evidence whose residuals, without what is explained already, are `left`: ρ is
    /// estimated from them.
    pub fn new(evidence: &Evidence, left: &DVector<f64>) -> Self {
        let correlation = evidence.correlation.unwrap_or_else(|| correlation(evidence, left));
        let ratio = evidence.shared_ratio.unwrap_or_else(|| shared_ratio(evidence, left, correlation));
        let is_even = evidence.weight.iter().all(|weight| *weight == 1.0);
        let roots = match is_even {
            true => Vec::new(),
            false => evidence.weight.iter().map(|weight| weight.sqrt()).collect(),
        };
        let mut members: BTreeMap<usize, Vec<usize>> = BTreeMap::new();
        for (row, &group) in evidence.shared.iter().enumerate() {
            members.entry(group).or_default().push(row);
        }
        let groups = members
            .into_values()
            .filter(|rows| rows.len() > 1)
            .map(|rows| {
                let share = 1.0 - 1.0 / (1.0 + ratio * length(rows.len(), correlation)).sqrt();
                (rows, share)
            })
            .collect();
        let mut whitening = Whitening {
            data: evidence.residual.len(),
            roots,
            groups,
            correlation,
            correlated_noise: evidence.correlated_noise.map(|noise| Filter::new(noise, &evidence.courses)),
            log_volume: 0.0,
            basis: Vec::new(),
            coefficients: Vec::new(),
            nuisance: evidence.nuisance.ncols(),
            ratio,
            degrees_of_freedom: evidence.residual.len(),
        };
        for (k, column) in evidence.nuisance.column_iter().enumerate() {
            let mut own = whitening.whitened(&column.into_owned());
            let mut coefficients = DVector::zeros(whitening.nuisance);
            coefficients[k] = 1.0;
            let before = own.norm();
            // twice is enough
            for _ in 0..2 {
                for (b, counts) in whitening.basis.iter().zip(&whitening.coefficients) {
                    let along = b.dot(&own);
                    own.axpy(-along, b, 1.0);
                    coefficients.axpy(-along, counts, 1.0);
                }
            }
            let length = own.norm();
            if length > DEPENDENT * before && length > 0.0 {
                whitening.basis.push(own / length);
                whitening.coefficients.push(coefficients / length);
                whitening.log_volume += length.ln();
            }
        }
        whitening.degrees_of_freedom -= whitening.basis.len().min(evidence.residual.len());
        whitening
    }

    /// Ln of the determinant of W: −½·Σ ln(1 + ρ·|a|²) − ½·(m − 1)·ln(1 − φ²) over the groups.
    pub fn log_determinant(&self) -> f64 {
        let of_group = |(rows, _): &(Vec<usize>, f64)| {
            let shared = (self.ratio * length(rows.len(), self.correlation)).ln_1p();
            shared + (rows.len() - 1) as f64 * (1.0 - self.correlation * self.correlation).ln()
        };
        -0.5 * self.groups.iter().map(of_group).sum::<f64>()
    }

    /// Ln of what the density of the data is times that of the whitened and projected ones, but for
    /// what does not depend on the errors that neighbours have in common: ln |W| − ½·ln |NᵀWᵀWN|, N
    /// the nuisance.
    pub fn log_jacobian(&self) -> f64 {
        self.correlated_noise.as_ref().map_or(0.0, Filter::log_determinant) - self.log_volume
    }

    /// True where neighbours along a course have errors in common.
    pub fn is_correlated(&self) -> bool {
        self.correlated_noise.is_some()
    }

    /// False where no two data share an error, so that there is no ρ to be found.
    pub fn is_of_shared_errors(&self) -> bool {
        !self.groups.is_empty()
    }

    /// Whitened and projected.
    pub fn apply(&self, v: &DVector<f64>) -> DVector<f64> {
        let mut v = self.whitened(v);
        self.project(&mut v);
        v
    }

    /// Column by column.
    pub fn apply_columns(&self, columns: &DMatrix<f64>) -> DMatrix<f64> {
        let mut result = self.whitened_columns(columns);
        for mut column in result.column_iter_mut() {
            for b in &self.basis {
                column.axpy(-b.dot(&column), b, 1.0);
            }
        }
        result
    }

    /// Wᵀv of every column v, W what whitens without projecting: (W·c)ᵀv = cᵀ(Wᵀv).
    pub fn transposed(&self, vectors: &DMatrix<f64>) -> DMatrix<f64> {
        checkpoint();
        let mut result = vectors.clone();
        for mut column in result.column_iter_mut() {
            self.transpose(column.as_mut_slice());
        }
        result
    }

    /// The same of one vector.
    pub fn transposed_vector(&self, v: &DVector<f64>) -> DVector<f64> {
        let mut result = v.clone();
        self.transpose(result.as_mut_slice());
        result
    }

    /// How much each datum counts.
    pub fn weights(&self) -> impl Iterator<Item = f64> + '_ {
        (0..self.data).map(|row| self.roots.get(row).map_or(1.0, |root| root * root))
    }

    /// |W·s|² of each step s that is 1 from one datum of a sequence on, whose data of a group are the last of it: with e = A·w,
    /// w the roots of these data, Σ e² − (2 − s)·s·(a·e)²/|a|² over the groups, s what is taken
    /// off. `None` are data that are not there.
    pub fn squares_of_steps(&self, sequences: &[Vec<Option<usize>>]) -> Vec<Vec<f64>> {
        let mut place: Vec<Option<(usize, usize)>> = vec![None; self.data];
        for (group, (rows, _)) in self.groups.iter().enumerate() {
            rows.iter().enumerate().for_each(|(k, &row)| place[row] = Some((group, k)));
        }
        let root = |row: usize| self.roots.get(row).copied().unwrap_or(1.0);
        let (slow, quick) = self.along();
        let of_sequence = |sequence: &Vec<Option<usize>>| {
            // of each group what its data have without the first one: Σ e², a·e; and what all have
            let mut known: HashMap<usize, Tail> = HashMap::new();
            let (mut square, mut squares) = (0.0, vec![0.0; sequence.len()]);
            for (at, row) in sequence.iter().enumerate().rev() {
                match row.map(|row| (row, place[row])) {
                    None => {}
                    Some((row, None)) => square += root(row).powi(2),
                    Some((row, Some((group, k)))) => {
                        let (rows, share) = &self.groups[group];
                        let tail = known.entry(group).or_default();
                        square -= tail.whole;
                        if let Some(next) = tail.first.replace(row) {
                            let e = (root(next) - self.correlation * root(row)) / quick;
                            (tail.square, tail.along) = (tail.square + e * e, tail.along + slow * e);
                        }
                        let e = if k == 0 { root(row) } else { root(row) / quick };
                        let along = tail.along + if k == 0 { e } else { slow * e };
                        let taken = share * (2.0 - share) / length(rows.len(), self.correlation);
                        tail.whole = tail.square + e * e - taken * along * along;
                        square += tail.whole;
                    }
                }
                squares[at] = square;
            }
            squares
        };
        sequences.iter().map(of_sequence).collect()
    }

    /// aₜ of all data of a group but the first, where it is 1; and √(1 − φ²).
    fn along(&self) -> (f64, f64) {
        let phi = self.correlation;
        (((1.0 - phi) / (1.0 + phi)).sqrt(), (1.0 - phi * phi).sqrt())
    }

    /// Orthonormal basis of the whitened nuisance.
    pub fn basis(&self) -> DMatrix<f64> {
        match self.basis.is_empty() {
            true => DMatrix::zeros(self.data, 0),
            false => DMatrix::from_columns(&self.basis),
        }
    }

    /// What the whitened nuisance columns (rows) count in the vectors of the basis (columns).
    pub fn coefficients(&self) -> DMatrix<f64> {
        match self.coefficients.is_empty() {
            true => DMatrix::zeros(self.nuisance, 0),
            false => DMatrix::from_columns(&self.coefficients),
        }
    }

    /// Qᵀv of whitened columns, Q the basis.
    pub fn along_basis(&self, whitened: &DMatrix<f64>) -> DMatrix<f64> {
        DMatrix::from_fn(self.basis.len(), whitened.ncols(), |k, j| self.basis[k].dot(&whitened.column(j)))
    }

    /// Column by column, not projected.
    pub fn whitened_columns(&self, columns: &DMatrix<f64>) -> DMatrix<f64> {
        let mut result = columns.clone();
        for mut column in result.column_iter_mut() {
            self.whiten(column.as_mut_slice());
        }
        result
    }

    /// Inner products CᵀMC of whitened columns once they are projected.
    pub fn projected_gram(&self, whitened: &DMatrix<f64>) -> DMatrix<f64> {
        let gram = transposed_product(whitened, whitened);
        if self.basis.is_empty() {
            return gram;
        }
        let along = transposed_product(&DMatrix::from_columns(&self.basis), whitened);
        gram - transposed_product(&along, &along)
    }

    /// Factors of the nuisance columns, those of the evidence, that fit `left` best.
    pub fn nuisance(&self, columns: &DMatrix<f64>, left: &DVector<f64>) -> DVector<f64> {
        if columns.ncols() == 0 {
            return DVector::zeros(0);
        }
        let left = self.whitened(left);
        if self.basis.len() == columns.ncols() {
            let mut factors = DVector::zeros(columns.ncols());
            for (b, counts) in self.basis.iter().zip(&self.coefficients) {
                factors.axpy(b.dot(&left), counts, 1.0);
            }
            return factors;
        }
        let whitened = self.whitened_columns(columns);
        // where a part of the data cannot tell the columns apart, the smallest factors that fit
        let smallest = |_| {
            let svd = thin_svd(&whitened)?;
            let rank = svd.rank(DEPENDENT);
            let along = svd.u.columns(0, rank).tr_mul(&left);
            let factors = along.component_div(&svd.singular_values.rows(0, rank));
            Ok::<_, crate::Error>(svd.v.columns(0, rank) * factors)
        };
        let fitted = least_squares(&whitened, &left).or_else(smallest);
        fitted.unwrap_or_else(|_| DVector::zeros(columns.ncols()))
    }

    /// Without the errors that data share, estimated from each group: (1 − (1 − 1/√(1 + ρ·m))/m ·
    /// J) times v, weights only in the group's mean.
    pub fn without_shared(&self, v: &DVector<f64>) -> DVector<f64> {
        let mut result = v.clone();
        for (rows, share) in &self.groups {
            let weight = |row: usize| self.roots.get(row).map_or(1.0, |root| root * root);
            let total: f64 = rows.iter().map(|&row| weight(row)).sum();
            let mean =
                rows.iter().map(|&row| weight(row) * v[row]).sum::<f64>() / total.max(f64::MIN_POSITIVE);
            rows.iter().for_each(|&row| result[row] -= share * mean);
        }
        result
    }

    /// Whitened, not projected.
    pub fn whitened(&self, v: &DVector<f64>) -> DVector<f64> {
        let mut v = v.clone();
        self.whiten(v.as_mut_slice());
        v
    }

    fn whiten(&self, v: &mut [f64]) {
        checkpoint();
        v.iter_mut().zip(&self.roots).for_each(|(v, root)| *v *= root);
        if let Some(filter) = &self.correlated_noise {
            filter.whiten(v);
        }
        if self.correlation > 0.0 {
            let (phi, (_, quick)) = (self.correlation, self.along());
            for (rows, _) in &self.groups {
                for pair in rows.windows(2).rev() {
                    v[pair[1]] = (v[pair[1]] - phi * v[pair[0]]) / quick;
                }
            }
        }
        self.take_shared(v);
    }

    fn transpose(&self, v: &mut [f64]) {
        self.take_shared(v);
        if self.correlation > 0.0 {
            let (phi, (_, quick)) = (self.correlation, self.along());
            for (rows, _) in &self.groups {
                let mut is_first = true;
                for pair in rows.windows(2) {
                    let own = if is_first { 1.0 } else { 1.0 / quick };
                    v[pair[0]] = own * v[pair[0]] - phi / quick * v[pair[1]];
                    is_first = false;
                }
                if let Some(&last) = rows.last() {
                    v[last] /= quick;
                }
            }
        }
        if let Some(filter) = &self.correlated_noise {
            filter.transpose(v);
        }
        v.iter_mut().zip(&self.roots).for_each(|(v, root)| *v *= root);
    }

    /// Takes s·(a·v)/|a|²·a off.
    fn take_shared(&self, v: &mut [f64]) {
        checkpoint();
        let (slow, _) = self.along();
        for (rows, share) in &self.groups {
            let sum = rows.iter().map(|&row| v[row]).sum::<f64>();
            let first = v[rows[0]];
            let along = share * (first + slow * (sum - first)) / length(rows.len(), self.correlation);
            v[rows[0]] -= along;
            for &row in &rows[1..] {
                v[row] -= slow * along;
            }
        }
    }

    fn project(&self, v: &mut DVector<f64>) {
        checkpoint();
        for b in &self.basis {
            v.axpy(-b.dot(v), b, 1.0);
        }
    }
}

/// What a group's data have along a, those from some datum on.
#[derive(Default)]
struct Tail {
    /// The first of them.
    first: Option<usize>,
    /// Σ e² and a·e of the others.
    square: f64,
    along: f64,
    /// |W·s|².
    whole: f64,
}

#[cfg(test)]
mod tests;
