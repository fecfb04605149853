//! Poses that were misread, or scatter with heavy tails?
//!
//! A reading that is wrong stands alone; where the others have heavy tails too, it is one of them.
//! How heavy they are is never known from a few dozen poses, so whatever is said holds for all of
//! them, each as far as the poses make it likely. Residuals z of n rows, made alike by
//! `leverage.rs`, of which the k farthest are misread:
//!
//! ```text
//! p(z, k)   Σ ∫ Π t_ν(z; s) of the others · Π N(z; s² + m²) of those · n⁻ᵏ dln s     over ν and two forms;
//!           m what a misreading is off by, ½ mm at least
//! ```
//!
//! ν of a list that ends with the normal distribution; the integral by Laplace. z are in the
//! device's own axes, for it is a sensor that reads one coordinate; or with one tail for the three
//! of a row, which are off together where a pose was disturbed. A pose is misread where that is
//! likelier than a tail by the odds within which another explanation counts as indistinguishable:
//! each by itself.
//!
//! (K. L. Lange, R. J. A. Little, J. M. G. Taylor, *JASA* 84 (1989) 881–896.) With tails each row
//! counts by w ~ (ν + 3)/(ν + |z|²/s²), near the middle all alike, so that what is far out is
//! neither misread nor two opposite moves; the scatter of all stays what it is. What was misread
//! counts whole.

use std::f64::consts::PI;

use super::super::effects::events::{MISREAD, OUTLIER};
use super::leverage::alike;
use super::prepared::Prepared;
use crate::error::Result;
use crate::inference::{APART, Hypothesis, Term};
use crate::statistics::ln_gamma;
use nalgebra::{DMatrix, DVector, Vector3};

/// Degrees of freedom that are tried: the last has no tails.
const TAILS: [f64; 8] = [2.0, 3.0, 4.0, 5.0, 7.0, 10.0, 20.0, 1e4];
/// Numbers of a row that are off together: one by itself, or all three.
const TOGETHER: [usize; 2] = [1, 3];
/// Iterations of a scale.
const ROUNDS: usize = 30;

/// Rows that count by the tails of all.
pub struct Tailed {
    /// How much each row counts.
    pub weights: Vec<f64>,
    /// Rows that may as well have been misread.
    pub open: Vec<usize>,
}

/// Where a hypothesis calls rows misread although heavy tails of all explain some of them as well;
/// `left` is what it leaves.
pub fn tailed(prepared: &Prepared, hypothesis: &Hypothesis, left: &DVector<f64>) -> Result<Option<Tailed>> {
    let model = &prepared.model;
    let is_misread = |term: &&Term| *model.terms.candidates[term.candidate].effect == OUTLIER.effect;
    let (misread, others): (Vec<&Term>, Vec<&Term>) = hypothesis.terms.iter().partition(is_misread);
    let misread: Vec<Term> = misread.into_iter().cloned().collect();
    let rows: Vec<usize> = misread.iter().filter_map(|term| model.first_row(term)).collect();
    if rows.is_empty() {
        return Ok(None);
    }
    let whole = left + model.terms.response(&misread);
    let noise = hypothesis.sigma;
    let columns: Vec<DMatrix<f64>> = others.iter().map(|term| model.terms.columns(term.candidate)).collect();
    let all = alike(&prepared.evidence, &columns, &whole, noise, &|row| rows.contains(&row))?;
    let recording = &model.campaign.measurements;
    let in_device = |(row, z): (usize, Vector3<f64>)| recording.device(row).rotation.tr_mul(&z) / noise;
    let all: Vec<Vector3<f64>> = all.into_iter().enumerate().map(in_device).collect();
    let beyond = |odds: f64| misread_beyond(odds, &all, &rows, MISREAD / noise);
    let alone = beyond(APART);
    if alone.len() == rows.len() {
        return Ok(None);
    }
    let others: Vec<Vector3<f64>> =
        (0..all.len()).filter(|row| !alone.contains(row)).map(|row| all[row]).collect();
    let tails = Tails::likeliest(&others);
    let weights: Vec<f64> = all.iter().map(|z| tails.weight(z)).collect();
    let squares = |weight: &dyn Fn(usize) -> f64| -> f64 {
        (0..all.len())
            .filter(|row| !alone.contains(row))
            .map(|row| weight(row) * all[row].norm_squared())
            .sum()
    };
    let as_all = squares(&|_| 1.0) / squares(&|row| weights[row]).max(f64::MIN_POSITIVE);
    let own = |(row, weight): (usize, f64)| if alone.contains(&row) { 1.0 } else { weight * as_all };
    let open = beyond(1.0 / APART).into_iter().filter(|row| !alone.contains(row)).collect();
    Ok(Some(Tailed { weights: weights.into_iter().enumerate().map(own).collect(), open }))
}

/// Those of some rows, the farthest ones, that are likelier to be misread than tails, each by these
/// odds; `by` is the least that a misreading is off by.
fn misread_beyond(odds: f64, all: &[Vector3<f64>], rows: &[usize], by: f64) -> Vec<usize> {
    let mut rows = rows.to_vec();
    rows.sort_by(|&a, &b| all[b].norm_squared().total_cmp(&all[a].norm_squared()).then(a.cmp(&b)));
    let misread = |count: usize| {
        let (off, others): (Vec<_>, Vec<_>) = (0..all.len()).partition(|row| rows[..count].contains(row));
        let pick = |some: Vec<usize>| -> Vec<Vector3<f64>> { some.into_iter().map(|row| all[row]).collect() };
        ln_misread(&pick(others), &pick(off), by) - count as f64 * odds.ln()
    };
    let mut best = (0, misread(0));
    for count in 1..=rows.len() {
        let own = misread(count);
        if own > best.1 {
            best = (count, own);
        }
    }
    rows.truncate(best.0);
    rows
}

/// Ln of the probability of all, of which some are off: by millimetres as well as by a fraction of
/// one, that is, by what these are.
fn ln_misread(others: &[Vector3<f64>], off: &[Vector3<f64>], by: f64) -> f64 {
    let count = 3.0 * off.len() as f64;
    let squares: f64 = off.iter().map(Vector3::norm_squared).sum();
    let usual = by.powi(2).max(squares / count.max(1.0));
    let price = if usual > by.powi(2) { 0.5 * count.ln() } else { 0.0 };
    let which = off.len() as f64 * ((others.len() + off.len()) as f64).ln();
    let forms: Vec<f64> = Tails::forms(others)
        .map(|tails| {
            let variance = tails.square + usual;
            tails.ln_probability - 0.5 * (count * (2.0 * PI * variance).ln() + squares / variance)
        })
        .collect();
    let most = forms.iter().copied().fold(f64::NEG_INFINITY, f64::max);
    most + forms.iter().map(|form| (form - most).exp()).sum::<f64>().ln() - which - price
}

/// Student's t for all.
struct Tails {
    /// ν, s², and ln of the probability of the data over all s.
    freedom: f64,
    square: f64,
    ln_probability: f64,
}

impl Tails {
    /// All that are tried.
    fn forms(all: &[Vector3<f64>]) -> impl Iterator<Item = Tails> + '_ {
        let squares = |together: usize| -> Vec<f64> {
            let numbers: Vec<f64> = all.iter().flat_map(|z| [z.x, z.y, z.z]).collect();
            numbers.chunks(together).map(|z| z.iter().map(|z| z * z).sum()).collect()
        };
        TOGETHER.into_iter().flat_map(move |together| {
            let squares = squares(together);
            TAILS.map(move |freedom| Tails::with(&squares, together, freedom))
        })
    }

    /// The likeliest that are heavy.
    fn likeliest(all: &[Vector3<f64>]) -> Tails {
        let [.., none] = TAILS;
        let is_heavy = |tails: &Tails| tails.freedom < none;
        let likelier = |a: Tails, b: Tails| if b.ln_probability > a.ln_probability { b } else { a };
        let nothing = Tails { freedom: 1.0, square: 1.0, ln_probability: f64::NEG_INFINITY };
        Tails::forms(all).filter(is_heavy).fold(nothing, likelier)
    }

    /// Of the sums of squares of data of which so many neighbours are off together.
    fn with(squares: &[f64], together: usize, freedom: f64) -> Tails {
        let (rows, d) = (squares.len().max(1) as f64, together as f64);
        let n = rows * d;
        let mut square = squares.iter().sum::<f64>() / n;
        for _ in 0..ROUNDS {
            let weighted = |z: &f64| (freedom + d) / (freedom + z / square) * z;
            square = (squares.iter().map(weighted).sum::<f64>() / n).max(f64::MIN_POSITIVE);
        }
        let constant =
            ln_gamma(0.5 * (freedom + d)) - ln_gamma(0.5 * freedom) - 0.5 * d * (freedom * PI * square).ln();
        let tail = |z: &f64| -0.5 * (freedom + d) * (z / square / freedom).ln_1p();
        // Fisher's information of ln s
        let information = 2.0 * n * freedom / (freedom + d + 2.0);
        let ln_probability =
            rows * constant + squares.iter().map(tail).sum::<f64>() + 0.5 * (2.0 * PI / information).ln();
        Tails { freedom, square, ln_probability }
    }

    fn weight(&self, z: &Vector3<f64>) -> f64 {
        ((self.freedom + 3.0) / (self.freedom + z.norm_squared() / self.square)).min(1.0)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::statistics::Random;

    /// As many rows, each number or each row with tails of its own; a normal scatter where ν is
    /// large.
    fn scattered(count: usize, freedom: usize, are_rows: bool, seed: u64) -> Vec<Vector3<f64>> {
        let mut random = Random::seeded(seed, 0);
        let scale = |random: &mut Random| {
            let squares: f64 = (0..freedom).map(|_| random.normal().powi(2)).sum();
            (freedom as f64 / squares).sqrt()
        };
        let mut row = || {
            let common = scale(&mut random);
            Vector3::from_fn(|_, _| {
                let own = if are_rows { common } else { scale(&mut random) };
                own * random.normal()
            })
        };
        (0..count).map(|_| row()).collect()
    }

    const HUNDREDTHS: f64 = 25.0;

    /// The rows at the end that are misread, of so many that are called so.
    fn alone(mut all: Vec<Vector3<f64>>, far: &[[f64; 3]], by: f64) -> Vec<usize> {
        let first = all.len();
        all.extend(far.iter().map(|z| Vector3::from(*z)));
        let rows: Vec<usize> = (first..all.len()).collect();
        misread_beyond(APART, &all, &rows, by).into_iter().map(|row| row - first).collect()
    }

    #[test]
    fn a_wrong_reading_among_normal_ones_is_no_tail_and_a_far_one_of_heavy_tails_is() {
        // two poses that are off by millimetres where the others scatter by hundredths of one
        let normal = || scattered(99, 400, false, 3);
        let far = [[90.0, -70.0, 60.0], [40.0, 80.0, -50.0]];
        assert_eq!(alone(normal(), &far, 11.0).len(), 2);
        assert_eq!(alone(normal(), &[[12.0, -9.0, 7.0]], HUNDREDTHS), [0]);
        // one coordinate that is far out among others of the same tails, and a row
        assert!(alone(scattered(99, 4, false, 3), &[[7.0, 0.4, -1.4]], HUNDREDTHS).is_empty());
        assert!(alone(scattered(99, 4, true, 5), &[[7.0, -7.0, 6.0]], HUNDREDTHS).is_empty());
        // and one that no such tails make
        assert_eq!(alone(scattered(99, 4, true, 5), &[[80.0, -60.0, 40.0]], HUNDREDTHS), [0]);
    }

    /// What the tails are is not known from so few; one is misread beside a tail.
    #[test]
    fn thirty_poses_leave_tails_open_and_a_misread_one_apart() {
        let mut named = 0;
        for seed in 0..60 {
            let mut all = scattered(33, 4, true, seed);
            let farthest = (0..33).max_by(|&a, &b| all[a].norm().total_cmp(&all[b].norm())).unwrap();
            let far = all.swap_remove(farthest);
            named += alone(all, &[far.into()], HUNDREDTHS).len();
        }
        assert!(named <= 1, "{named}");
        let far = [[6.0, -4.0, 5.0], [30.0, -20.0, 20.0]];
        assert_eq!(alone(scattered(33, 4, true, 2), &far, HUNDREDTHS), [1]);
    }
}
