//! What readings without any effect scatter by: noise, zeros, and the nominal numbers of the files.
//!
//! ```text
//! Σ = Σ₀ + N·Nᵀ        N  what each number changes by its standard uncertainty
//! Σ₀ = s²·φ^|i − j| + z² + δᵢⱼ·q²/12     in a run and channel; z² also between runs that share a zero
//! ```
//!
//! Σ^(−1/2) is Σ₀'s Cholesky factor, then I − U·(1 − 1/√(1 + S²))·Uᵀ with U·S·Vᵀ what it makes of
//! N.

use std::collections::BTreeMap;

use nalgebra::{DMatrix, DVector};

use super::bench::Bench;
use super::noise::Noise;
use rodcal_base::linalg::thin_svd;

/// Makes readings of unit scatter.
pub struct Covariance {
    /// Readings that share a zero, and the Cholesky factor of their Σ₀.
    groups: Vec<(Vec<usize>, DMatrix<f64>)>,
    /// N, m.
    pub nominal: DMatrix<f64>,
    /// N over the noise.
    whitened: DMatrix<f64>,
    /// U, and 1 − 1/√(1 + S²).
    directions: (DMatrix<f64>, DVector<f64>),
}

impl Covariance {
    /// Of a bench and its noise.
    pub fn new(bench: &Bench, noise: &Noise) -> Covariance {
        let mut covariance = Covariance {
            groups: groups(bench, noise),
            nominal: nominal(bench),
            whitened: DMatrix::zeros(0, 0),
            directions: (DMatrix::zeros(0, 0), DVector::zeros(0)),
        };
        let columns: Vec<DVector<f64>> =
            covariance.nominal.column_iter().map(|c| covariance.over_noise(c.into_owned())).collect();
        let rows = covariance.nominal.nrows();
        covariance.whitened = match columns.is_empty() {
            true => DMatrix::zeros(rows, 0),
            false => DMatrix::from_columns(&columns),
        };
        let svd = if columns.is_empty() { None } else { thin_svd(&covariance.whitened).ok() };
        covariance.directions = match svd {
            Some(svd) => {
                let shrink = DVector::from_iterator(
                    svd.singular_values.len(),
                    svd.singular_values.iter().map(|s| 1.0 - 1.0 / (1.0 + s * s).sqrt()),
                );
                (svd.u, shrink)
            }
            None => (DMatrix::zeros(rows, 0), DVector::zeros(0)),
        };
        covariance
    }

    /// Σ^(−1/2)·v.
    pub fn whitened(&self, v: Vec<f64>) -> DVector<f64> {
        let v = self.over_noise(DVector::from_vec(v));
        let (u, shrink) = &self.directions;
        let along = u.tr_mul(&v).component_mul(shrink);
        v - u * along
    }

    /// Σ₀^(−1/2)·v: with the numbers of the files as they are.
    pub fn over_noise(&self, mut v: DVector<f64>) -> DVector<f64> {
        for (rows, lower) in &self.groups {
            let own = DVector::from_iterator(rows.len(), rows.iter().map(|&row| v[row]));
            if let Some(own) = lower.solve_lower_triangular(&own) {
                rows.iter().zip(own.iter()).for_each(|(&row, value)| v[row] = *value);
            }
        }
        v
    }

    /// What is left of a change of the readings, m, once the numbers of the files have taken up
    /// what they are likely to.
    pub fn left(&self, change: Vec<f64>) -> Vec<f64> {
        let change = DVector::from_vec(change);
        let n = self.whitened.ncols();
        let normal = self.whitened.tr_mul(&self.whitened) + DMatrix::identity(n, n);
        let right = self.whitened.tr_mul(&self.over_noise(change.clone()));
        let left = match normal.cholesky().filter(|_| n > 0) {
            Some(normal) => &change - &self.nominal * normal.solve(&right),
            None => change,
        };
        left.iter().copied().collect()
    }
}

/// What each number of the files changes by its standard uncertainty, m.
pub fn nominal(bench: &Bench) -> DMatrix<f64> {
    let here = bench.readings(&[]);
    let columns: Vec<DVector<f64>> = (0..bench.actual.len())
        .map(|which| {
            let actual = bench.actual.moved(which, 1.0);
            let there = Bench { actual, ..bench.clone() }.readings(&[]);
            DVector::from_iterator(here.len(), there.iter().zip(&here).map(|(a, b)| a - b))
        })
        .collect();
    match columns.is_empty() {
        true => DMatrix::zeros(here.len(), 0),
        false => DMatrix::from_columns(&columns),
    }
}

fn groups(bench: &Bench, noise: &Noise) -> Vec<(Vec<usize>, DMatrix<f64>)> {
    let protocol = &bench.protocol;
    let cells = protocol.cells();
    let run = |row: usize| protocol.loadings[cells[row].loading].run;
    let mut rows: BTreeMap<(usize, usize), Vec<usize>> = BTreeMap::new();
    for (row, cell) in cells.iter().enumerate() {
        let zero = if protocol.zeroed_once { 0 } else { run(row) };
        rows.entry((zero, cell.channel)).or_default().push(row);
    }
    let display = protocol.quantum.powi(2) / 12.0;
    let of_group = |rows: Vec<usize>| {
        let channel = cells[rows[0]].channel;
        let zero = noise.zero_variance(channel, protocol.quantum);
        let variance = (noise.times[channel] * noise.sd).powi(2);
        let lower = DMatrix::from_fn(rows.len(), rows.len(), |i, j| {
            let neighbours = if i == j { 1.0 } else { noise.correlation.powi(i.abs_diff(j) as i32) };
            let is_run = run(rows[i]) == run(rows[j]);
            let own = if is_run { variance * neighbours } else { 0.0 };
            own + zero + if i == j { display } else { 0.0 }
        });
        Some((rows, lower.cholesky()?.unpack()))
    };
    rows.into_values().filter_map(of_group).collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::rig::actual::Actual;
    use crate::rig::bench::tests::bench;
    use rodcal_base::statistics::Random;

    fn drawn(seed: u64, bench: &Bench) -> Bench {
        let actual = Actual::drawn(&bench.drawing, &[], 1.0, &mut Random::seeded(seed, 0));
        Bench { actual, ..bench.clone() }
    }

    #[test]
    fn what_noise_zeros_and_numbers_do_has_unit_scatter() {
        let nominal = bench();
        let ideal = nominal.readings(&[]);
        let noise = Noise { correlation: 0.4, zero: 1.5, times: [1.0, 4.0, 1.0], ..Noise::normal(1e-6) };
        let covariance = Covariance::new(&drawn(0, &nominal), &noise);
        let (mut sum, runs) = (0.0, 60);
        for seed in 1..=runs {
            let real = drawn(seed, &nominal);
            let shown = noise.shown(&real, &real.readings(&[]), &mut Random::seeded(seed, 1));
            let off = shown.iter().zip(&ideal).map(|(a, b)| a - b).collect();
            sum += covariance.whitened(off).norm_squared() / shown.len() as f64;
        }
        // 54 readings in each of 60 draws: ± 0.025
        assert!((sum / runs as f64 - 1.0).abs() < 0.08, "{}", sum / runs as f64);
    }

    #[test]
    fn a_softer_rod_is_mostly_nuisance_and_a_single_step_is_not() {
        let bench = drawn(0, &bench());
        let covariance = Covariance::new(&bench, &Noise::normal(1e-6));
        let norm = |v: &[f64]| v.iter().map(|x| x * x).sum::<f64>().sqrt();
        let softer: Vec<f64> = bench.readings(&[]).iter().map(|reading| 0.005 * reading).collect();
        assert!(norm(&covariance.left(softer.clone())) < 0.1 * norm(&softer));
        let mut step = vec![0.0; softer.len()];
        step[4] = 1e-5;
        assert!(norm(&covariance.left(step.clone())) > 0.9 * norm(&step));
        let exact = Covariance::new(&super::super::bench::tests::bench(), &Noise::normal(1e-6));
        assert_eq!(exact.left(step.clone()), step);
    }
}
