//! What repeated measurements say about candidates, from what each says once.
//!
//! Readings of one measurement scatter among themselves by V/R, R repeats; beside them stands what
//! is unknown for all of them, columns N of factors ~ N(0, 1): numbers of the rod, the clock's
//! trend. Then Σ₀ = V_R + N·Nᵀ and for columns C of candidates
//!
//! ```text
//! CᵀΣ₀⁻¹C = CᵀV_R⁻¹C − CᵀV_R⁻¹N·(1 + NᵀV_R⁻¹N)⁻¹·NᵀV_R⁻¹C
//! ```
//!
//! (M. A. Woodbury, Princeton Statist. Res. Group Memo. Rep. 42 (1950)), where [N C]ᵀV_R⁻¹[N C] is
//! the sum over measurements of R times what one repeat of each says: no matrix is as large as a
//! recording.

use nalgebra::DMatrix;

/// Of each measurement [N C]ᵀV⁻¹[N C], from one repeat.
#[derive(Debug)]
pub(super) struct Information {
    once: Vec<DMatrix<f64>>,
    /// Columns of N.
    unknown: usize,
}

impl Information {
    /// Of `columns` N and C, a row for each reading. Readings that share a zero are off by one more
    /// error in common, as large as their own, of the standard deviation `noise`; they are of one
    /// measurement, the reading's `owner`.
    pub(super) fn new(
        unknown: &DMatrix<f64>,
        candidates: &DMatrix<f64>,
        noise: f64,
        [owner, shared]: [&[usize]; 2],
        measurements: usize,
    ) -> Information {
        let width = unknown.ncols() + candidates.ncols();
        let mut once = vec![DMatrix::zeros(width, width); measurements];
        let mut groups: Vec<(usize, usize)> = owner.iter().copied().zip(shared.iter().copied()).collect();
        groups.sort_unstable();
        groups.dedup();
        for group in groups {
            let rows: Vec<usize> = (0..owner.len()).filter(|&i| (owner[i], shared[i]) == group).collect();
            let mut own = DMatrix::zeros(rows.len(), width);
            own.columns_mut(0, unknown.ncols()).copy_from(&unknown.select_rows(&rows));
            own.columns_mut(unknown.ncols(), candidates.ncols()).copy_from(&candidates.select_rows(&rows));
            // (1 + 1·1ᵀ)⁻¹ = 1 − 1·1ᵀ/(1 + n)
            let sum = own.row_sum();
            let within = own.tr_mul(&own) - sum.tr_mul(&sum) / (1.0 + rows.len() as f64);
            once[group.0] += within / (noise * noise);
        }
        Information { once, unknown: unknown.ncols() }
    }

    /// CᵀΣ₀⁻¹C of so many repeats of each measurement.
    pub(super) fn of_repeats(&self, counts: &[usize]) -> DMatrix<f64> {
        let width = self.once.first().map_or(self.unknown, DMatrix::ncols);
        let mut sum = DMatrix::zeros(width, width);
        for (once, &repeats) in self.once.iter().zip(counts).filter(|(_, repeats)| **repeats > 0) {
            sum += once * repeats as f64;
        }
        let (n, c) = (self.unknown, width - self.unknown);
        let known = sum.view((n, n), (c, c)).into_owned();
        let both = sum.view((0, n), (n, c)).into_owned();
        let whole = sum.view((0, 0), (n, n)) + DMatrix::identity(n, n);
        // 1 + a sum of squares: what is not definite is no number
        let Some(root) = whole.cholesky() else { return known * 0.0 };
        match root.l_dirty().solve_lower_triangular(&both) {
            Some(white) => known - white.tr_mul(&white),
            None => known * 0.0,
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::statistics::Random;

    /// Beside Σ₀ written out and inverted.
    #[test]
    fn it_is_that_of_the_whole_covariance() {
        const NOISE: f64 = 0.3;
        let (owner, shared) = ([0, 0, 0, 1, 1, 2, 2, 2, 2], [0, 0, 1, 2, 2, 3, 3, 4, 3]);
        let mut random = Random::seeded(2, 8);
        let mut drawn = |columns: usize| DMatrix::from_fn(owner.len(), columns, |_, _| random.normal());
        let (unknown, candidates) = (drawn(2) * 5.0, drawn(3));
        let information = Information::new(&unknown, &candidates, NOISE, [&owner, &shared], 3);
        for counts in [[1, 1, 1], [3, 12, 5], [4, 0, 3], [0, 0, 0]] {
            let rows: Vec<usize> = (0..owner.len()).filter(|&i| counts[owner[i]] > 0).collect();
            let n = unknown.select_rows(&rows);
            let own = DMatrix::from_fn(rows.len(), rows.len(), |i, j| {
                let [a, b] = [rows[i], rows[j]];
                let share = f64::from(u8::from(a == b)) + f64::from(u8::from(shared[a] == shared[b]));
                share * NOISE * NOISE / counts[owner[a]] as f64
            });
            let scatter = own + &n * n.transpose();
            let c = candidates.select_rows(&rows);
            let expected = match rows.is_empty() {
                true => DMatrix::zeros(3, 3),
                false => c.transpose() * scatter.try_inverse().unwrap() * c,
            };
            let found = information.of_repeats(&counts);
            assert!((found - &expected).norm() <= 1e-9 * expected.norm(), "{counts:?}");
        }
    }
}
