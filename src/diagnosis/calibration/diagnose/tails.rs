//! Poses that were misread, or scatter with heavy tails?
//!
//! A reading that is wrong stands alone; where the others have heavy tails too, it is one of them.
//! Residuals z in noises, of n rows:
//!
//! ```text
//! misread   Σ ln N(z; s) of the other rows + Σ ln N(z; s_m) of those − k·ln n        s_m what a misreading is off by, ½ mm at least
//! tails     Σ ln t_ν(z; s) of all                                                    ν of a list, s by maximum likelihood
//! ```
//!
//! z in the device's own axes, for it is a sensor that reads one coordinate; or with one tail for
//! the three of a row, which are off together where a pose was disturbed.
//!
//! (K. L. Lange, R. J. A. Little, J. M. G. Taylor, *JASA* 84 (1989) 881–896.) With tails each row
//! counts by w ~ (ν + 3)/(ν + |z|²/s²), near the middle all alike, so that what is far out is
//! neither misread nor two opposite moves; the scatter of all stays what it is.

use std::f64::consts::PI;

use super::super::effects::events::{MISREAD, OUTLIER};
use super::prepared::Prepared;
use crate::inference::{Hypothesis, Term};
use crate::statistics::ln_gamma;
use nalgebra::{DVector, Vector3};

/// Degrees of freedom that are tried.
const TAILS: [f64; 7] = [2.0, 3.0, 4.0, 5.0, 7.0, 10.0, 20.0];
/// Numbers of a row that are off together: one by itself, or all three.
const TOGETHER: [usize; 2] = [1, 3];
/// Iterations of a scale.
const ROUNDS: usize = 30;

/// How much each row counts where a hypothesis calls rows misread although heavy tails of all
/// explain them better; `left` is what it leaves.
pub fn weights(prepared: &Prepared, hypothesis: &Hypothesis, left: &DVector<f64>) -> Option<Vec<f64>> {
    let model = &prepared.model;
    let is_misread = |term: &&Term| *model.terms.candidates[term.candidate].effect == OUTLIER.effect;
    let misread: Vec<Term> = hypothesis.terms.iter().filter(is_misread).cloned().collect();
    let rows: Vec<usize> = misread.iter().filter_map(|term| model.first_row(term)).collect();
    if rows.is_empty() {
        return None;
    }
    let count = 3 * model.campaign.measurements.len();
    let whole = left + model.terms.response(&misread);
    let noise = hypothesis.sigma;
    let recording = &model.campaign.measurements;
    let in_device = |(row, z): (usize, &[f64])| -> [f64; 3] {
        (recording.device(row).rotation.tr_mul(&Vector3::from_column_slice(z)) / noise).into()
    };
    let all: Vec<f64> = whole.as_slice()[..count].chunks(3).enumerate().flat_map(in_device).collect();
    let tails = Tails::of(&all);
    let weight = |z: &[f64]| {
        let square = z.iter().map(|z| z * z).sum::<f64>() / tails.square;
        ((tails.freedom + 3.0) / (tails.freedom + square)).min(1.0)
    };
    let is_better = tails.ln_likelihood > ln_misread(&all, &rows, MISREAD / noise);
    is_better.then(|| {
        let weights: Vec<f64> = all.chunks(3).map(weight).collect();
        let squares = |z: &[f64]| z.iter().map(|z| z * z).sum::<f64>();
        let weighted: f64 = all.chunks(3).zip(&weights).map(|(z, weight)| weight * squares(z)).sum();
        let as_all = squares(&all) / weighted.max(f64::MIN_POSITIVE);
        weights.into_iter().map(|weight| weight * as_all).collect()
    })
}

/// Normal but for some rows.
fn ln_misread(all: &[f64], rows: &[usize], misread: f64) -> f64 {
    let (off, others): (Vec<_>, Vec<_>) = all.iter().enumerate().partition(|(k, _)| rows.contains(&(k / 3)));
    let squares = |some: &[(usize, &f64)]| some.iter().map(|(_, z)| *z * *z).sum::<f64>();
    let normal = |some: &[(usize, &f64)], variance: f64| {
        -0.5 * (some.len() as f64 * (2.0 * PI * variance).ln() + squares(some) / variance)
    };
    let own = squares(&others) / others.len().max(1) as f64;
    let which = rows.len() as f64 * (all.len() as f64 / 3.0).ln();
    // a reading is off by millimetres as well as by a fraction of one: by what these are
    let by = misread.powi(2).max(squares(&off) / off.len().max(1) as f64);
    let price = if by > misread.powi(2) { 0.5 * (off.len() as f64).ln() } else { 0.0 };
    normal(&others, own.max(f64::MIN_POSITIVE)) + normal(&off, own + by) - which - price
}

/// Student's t for all.
struct Tails {
    /// ν, s², and ln of the likelihood less the price of the choice of ν.
    freedom: f64,
    square: f64,
    ln_likelihood: f64,
}

impl Tails {
    fn of(all: &[f64]) -> Tails {
        let forms = TOGETHER.into_iter().flat_map(|together| TAILS.map(|freedom| (together, freedom)));
        let tried = forms.map(|(together, freedom)| Tails::with(all, together, freedom));
        let likelier = |a: Tails, b: Tails| if b.ln_likelihood > a.ln_likelihood { b } else { a };
        tried.reduce(likelier).unwrap_or(Tails {
            freedom: 1.0,
            square: 1.0,
            ln_likelihood: f64::NEG_INFINITY,
        })
    }

    /// Of data of which so many neighbours are off together.
    fn with(all: &[f64], together: usize, freedom: f64) -> Tails {
        let (n, d) = (all.len().max(1) as f64, together as f64);
        let squares: Vec<f64> = all.chunks(together).map(|z| z.iter().map(|z| z * z).sum()).collect();
        let mut square = squares.iter().sum::<f64>() / n;
        for _ in 0..ROUNDS {
            let weighted = |z: &f64| (freedom + d) / (freedom + z / square) * z;
            square = (squares.iter().map(weighted).sum::<f64>() / n).max(f64::MIN_POSITIVE);
        }
        let constant =
            ln_gamma(0.5 * (freedom + d)) - ln_gamma(0.5 * freedom) - 0.5 * d * (freedom * PI * square).ln();
        let tail = |z: &f64| -0.5 * (freedom + d) * (z / square / freedom).ln_1p();
        let choices = (TAILS.len() * TOGETHER.len()) as f64;
        let ln_likelihood = n / d * constant + squares.iter().map(tail).sum::<f64>() - choices.ln();
        Tails { freedom, square, ln_likelihood }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::statistics::Random;

    /// How much more heavy tails explain than a misread last row.
    /// With the last `count` rows misread, by `by` noises at least.
    fn tails_over_misread(all: &[f64], count: usize, by: f64) -> f64 {
        let rows: Vec<usize> = (all.len() / 3 - count..all.len() / 3).collect();
        Tails::of(all).ln_likelihood - ln_misread(all, &rows, by)
    }

    #[test]
    fn a_wrong_reading_among_normal_ones_is_no_tail_and_a_far_one_of_heavy_tails_is() {
        let mut random = Random::seeded(3, 0);
        let mut normal: Vec<f64> = (0..297).map(|_| random.normal()).collect();
        let mut heavy: Vec<f64> = (0..297)
            .map(|_| {
                let squares: f64 = (0..4).map(|_| random.normal().powi(2)).sum();
                random.normal() * (2.0 / squares).sqrt()
            })
            .collect();
        // two poses that are off by millimetres where the others scatter by hundredths of one
        let mut far = normal.clone();
        far.extend([90.0, -70.0, 60.0, 40.0, 80.0, -50.0]);
        assert!(tails_over_misread(&far, 2, 11.0) < -10.0, "{}", tails_over_misread(&far, 2, 11.0));
        normal.extend([12.0, -9.0, 7.0]);
        heavy.extend([5.0, 0.3, -1.0]);
        // one coordinate that is far out among others of the same tails, and a row
        let mut random = Random::seeded(5, 0);
        let mut scale = || {
            let squares: f64 = (0..4).map(|_| random.normal().powi(2)).sum();
            (2.0 / squares).sqrt()
        };
        let rows: Vec<f64> = (0..99).map(|_| scale()).collect();
        let mut rows: Vec<f64> =
            rows.into_iter().flat_map(|scale| [0; 3].map(|_| scale * random.normal())).collect();
        rows.extend([5.0, -5.0, 4.0]);
        assert!(tails_over_misread(&rows, 1, 25.0) > 5.0, "{}", tails_over_misread(&rows, 1, 25.0));
        assert!(tails_over_misread(&normal, 1, 25.0) < -10.0, "{}", tails_over_misread(&normal, 1, 25.0));
        assert!(tails_over_misread(&heavy, 1, 25.0) > 5.0, "{}", tails_over_misread(&heavy, 1, 25.0));
    }
}
