//! Errors that data share, and what the base model absorbs, taken out of residuals and columns.
//!
//! The errors of a group that shares one, of relative variance ρ, have the covariance σ²·(1 + ρ·J), J all ones. With m
//! data in the group
//!
//! (1 + ρ·J)^(−1/2) = 1 − (1 − 1/√(1 + ρ·m))/m · J
//!
//! makes them independent. What is left is projected on the complement of the whitened nuisance columns, M = 1 − Q·Qᵀ.

use std::collections::{BTreeMap, HashMap};

use nalgebra::{DMatrix, DVector};

use super::Evidence;
use crate::linalg::{least_squares, thin_svd, transposed_product};

/// ρ that is believed before the data: a zero that was read once is as good as any other reading.
const RATIO_BEFORE: f64 = 1.0;
/// What that belief counts, in degrees of freedom.
const BELIEF: f64 = 10.0;
/// Of fewer groups nobody knows which mean is far out; and how far that is, in robust standard
/// deviations.
const FEWEST_GROUPS: usize = 6;
const FAR: f64 = 3.0;
/// Length, relative to what it was, below which a nuisance column is a combination of the others.
const DEPENDENT: f64 = 1e-9;

/// Whitens and projects vectors of n data.
#[derive(Debug, Clone)]
pub struct Whitening {
    data: usize,
    /// Root of how much each datum counts; nothing where all count alike.
    roots: Vec<f64>,
    /// Rows of every group with more than one datum, and what is taken off times their mean.
    groups: Vec<(Vec<usize>, f64)>,
    /// Orthonormal basis of the whitened nuisance columns.
    basis: Vec<DVector<f64>>,
    /// What each whitened nuisance column counts in each vector of the basis.
    coefficients: Vec<DVector<f64>>,
    /// How many nuisance columns there are.
    nuisance: usize,
    /// ρ.
    pub ratio: f64,
    /// Data less what the nuisance columns absorb.
    pub degrees_of_freedom: usize,
}

impl Whitening {
    /// For an evidence whose residuals, without what is explained already, are `left`: ρ is estimated from them.
    pub fn new(evidence: &Evidence, left: &DVector<f64>) -> Self {
        let ratio = evidence.shared_ratio.unwrap_or_else(|| shared_ratio(evidence, left));
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
                let m = rows.len() as f64;
                (rows, 1.0 - 1.0 / (1.0 + ratio * m).sqrt())
            })
            .collect();
        let mut whitening = Whitening {
            data: evidence.residual.len(),
            roots,
            groups,
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
            }
        }
        whitening.degrees_of_freedom -= whitening.basis.len().min(evidence.residual.len());
        whitening
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

    /// |W·s|² of each step s that is 1 from one datum of a sequence on: with t the sum of the roots w of its data in a
    /// group, Σ w² − Σ (1 − 1/(1 + ρ·m))/m·t² over the groups. `None` are data that are not there.
    pub fn squares_of_steps(&self, sequences: &[Vec<Option<usize>>]) -> Vec<Vec<f64>> {
        let mut group_of: Vec<Option<usize>> = vec![None; self.data];
        for (group, (rows, _)) in self.groups.iter().enumerate() {
            rows.iter().for_each(|&row| group_of[row] = Some(group));
        }
        let of_sequence = |sequence: &Vec<Option<usize>>| {
            let mut total: HashMap<usize, f64> = HashMap::new();
            let (mut square, mut squares) = (0.0, vec![0.0; sequence.len()]);
            for (place, row) in sequence.iter().enumerate().rev() {
                if let Some(row) = *row {
                    let root = self.roots.get(row).copied().unwrap_or(1.0);
                    square += root * root;
                    if let Some(group) = group_of[row] {
                        let (rows, share) = &self.groups[group];
                        let before = total.entry(group).or_default();
                        let after = *before + root;
                        let per_square = share * (2.0 - share) / rows.len() as f64;
                        square -= per_square * (after * after - *before * *before);
                        *before = after;
                    }
                }
                squares[place] = square;
            }
            squares
        };
        sequences.iter().map(of_sequence).collect()
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
    pub fn along(&self, whitened: &DMatrix<f64>) -> DMatrix<f64> {
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

    /// Without the errors that data share, estimated from each group: (1 − (1 − 1/√(1 + ρ·m))/m · J)
    /// times v, weights only in the group's mean.
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
        v.iter_mut().zip(&self.roots).for_each(|(v, root)| *v *= root);
        self.take_shared(v);
    }

    fn transpose(&self, v: &mut [f64]) {
        self.take_shared(v);
        v.iter_mut().zip(&self.roots).for_each(|(v, root)| *v *= root);
    }

    fn take_shared(&self, v: &mut [f64]) {
        for (rows, share) in &self.groups {
            let mean = rows.iter().map(|&row| v[row]).sum::<f64>() / rows.len() as f64;
            for &row in rows {
                v[row] -= share * mean;
            }
        }
    }

    fn project(&self, v: &mut DVector<f64>) {
        for b in &self.basis {
            v.axpy(-b.dot(v), b, 1.0);
        }
    }
}

/// ρ from repeats: the mean product of two deviations of one group, over what the mean square has beyond it.
///
/// Deviations are from the mean of the replicate group, so that nothing that repeats itself counts.
fn shared_ratio(evidence: &Evidence, left: &DVector<f64>) -> f64 {
    let mut replicates: BTreeMap<usize, (f64, f64)> = BTreeMap::new();
    for (row, &replicate_group) in evidence.replicate_group.iter().enumerate() {
        let (sum, count) = replicates.entry(replicate_group).or_default();
        *sum += left[row];
        *count += 1.0;
    }
    let (mut square, mut count) = (0.0, 0.0);
    let mut groups: BTreeMap<usize, (f64, f64, f64)> = BTreeMap::new();
    for (row, replicate_group) in evidence.replicate_group.iter().enumerate() {
        let (sum, repeats) = replicates[replicate_group];
        if repeats < 2.0 {
            continue;
        }
        // a deviation from a mean of r repeats has (r − 1)/r of the variance
        let deviation = (left[row] - sum / repeats) * (repeats / (repeats - 1.0)).sqrt();
        square += deviation * deviation;
        count += 1.0;
        let (total, squares, members) = groups.entry(evidence.shared[row]).or_default();
        *total += deviation;
        *squares += deviation * deviation;
        *members += 1.0;
    }
    // a step between two runs is no scatter of their zeros: a mean far out counts as far as usual
    let limit = match groups.len() >= FEWEST_GROUPS {
        true => {
            let mut means: Vec<f64> =
                groups.values().map(|(total, _, members)| (total / members).abs()).collect();
            means.sort_by(f64::total_cmp);
            FAR * 1.4826 * means[means.len() / 2]
        }
        false => f64::INFINITY,
    };
    let (mut product, mut pairs) = (0.0, 0.0);
    for (total, squares, members) in groups.into_values() {
        let mean = total / members;
        let clipped = mean.clamp(-limit, limit);
        let squares = squares - members * (mean * mean - clipped * clipped);
        product += (clipped * members).powi(2) - squares;
        pairs += members * (members - 1.0);
    }
    if count == 0.0 || pairs == 0.0 || square == 0.0 {
        return RATIO_BEFORE;
    }
    let mean_square = square / count;
    let shared = (product / pairs).clamp(0.0, 0.999 * mean_square);
    let own = mean_square - shared;
    // the belief counts as BELIEF data of this mean square, split as it says
    let split = RATIO_BEFORE / (1.0 + RATIO_BEFORE);
    (shared * count + split * mean_square * BELIEF) / (own * count + (1.0 - split) * mean_square * BELIEF)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::statistics::Random;

    /// 6 trials of 8 replicates.
    fn evidence(shared_sd: f64) -> Evidence {
        let mut random = Random::seeded(3, 0);
        let (mut residual, mut replicate_group, mut shared) = (Vec::new(), Vec::new(), Vec::new());
        for trial in 0..60 {
            let zero = shared_sd * random.normal();
            for load in 0..8 {
                residual.push(3.0 * load as f64 + zero + random.normal());
                replicate_group.push(load);
                shared.push(trial);
            }
        }
        Evidence {
            replicate_group,
            fold: shared.clone(),
            shared,
            ..Evidence::new(DVector::from_vec(residual))
        }
    }

    #[test]
    fn the_shared_error_is_found_in_the_repeats() {
        for (sd, ratio) in [(0.0, 0.0), (1.0, 1.0), (3.0, 9.0)] {
            let evidence = evidence(sd);
            let found = Whitening::new(&evidence, &evidence.residual).ratio;
            assert!((found - ratio).abs() < 0.15 + 0.35 * ratio, "{found} instead of {ratio}");
        }
    }

    #[test]
    fn whitening_is_the_inverse_root_of_the_covariance() {
        let evidence = Evidence { shared: vec![7; 480], ..evidence(1.0) };
        let whitening = Whitening::new(&evidence, &evidence.residual);
        let (rho, n) = (whitening.ratio, 480.0);
        // W·(1 + ρJ)·Wᵀ = 1: checked on two vectors
        let covariance = |v: &DVector<f64>| v + DVector::from_element(480, rho * v.sum());
        let e = DVector::from_fn(480, |i, _| f64::from(u8::from(i == 5)));
        let whitened = whitening.whitened(&covariance(&whitening.whitened(&e)));
        assert!((whitened - &e).norm() < 1e-9 * n);
    }

    #[test]
    fn steps_are_as_long_as_their_whitened_columns() {
        let weight = (0..480).map(|i| 0.2 + 0.8 * (0.3 * i as f64).sin().powi(2)).collect();
        let evidence = Evidence { weight, ..evidence(1.0) };
        let whitening = Whitening::new(&evidence, &evidence.residual);
        let all: Vec<Option<usize>> = (0..480).map(Some).collect();
        // every third one, the first hundred of them left out
        let some: Vec<Option<usize>> = (0..160).map(|k| (k >= 100).then_some(3 * k)).collect();
        let squares = whitening.squares_of_steps(&[all.clone(), some.clone()]);
        for (sequence, squares) in [all, some].iter().zip(squares) {
            for from in [0, 1, 7, 8, 101, 159] {
                let mut step = DVector::zeros(480);
                sequence[from..].iter().flatten().for_each(|&row| step[row] = 1.0);
                let expected = whitening.whitened(&step).norm_squared();
                assert!((squares[from] - expected).abs() < 1e-10 * (1.0 + expected), "{from}");
            }
        }
    }

    #[test]
    fn the_transposed_moves_whitening_to_the_other_side_of_a_product() {
        let weight = (0..480).map(|i| 0.2 + 0.8 * (0.3 * i as f64).sin().powi(2)).collect();
        let evidence = Evidence { weight, ..evidence(1.0) };
        let whitening = Whitening::new(&evidence, &evidence.residual);
        let (a, b) = (DVector::from_fn(480, |i, _| (0.1 * i as f64).cos()), &evidence.residual);
        let (left, right) = (whitening.whitened(&a).dot(b), a.dot(&whitening.transposed_vector(b)));
        assert!((left - right).abs() < 1e-10 * left.abs());
    }

    #[test]
    fn nuisance_columns_vanish() {
        let mut evidence = evidence(1.0);
        evidence.nuisance =
            DMatrix::from_fn(480, 3, |i, k| if k == 2 { 2.0 } else { (i as f64).powi(k as i32) });
        let whitening = Whitening::new(&evidence, &evidence.residual);
        assert_eq!(whitening.degrees_of_freedom, 478, "the third column is the first");
        let gone = whitening.apply(&evidence.nuisance.column(1).into_owned());
        assert!(gone.norm() < 1e-9 * evidence.nuisance.column(1).norm());
    }
}
