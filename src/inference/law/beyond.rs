//! How far off a law may be half again beyond its data.
//!
//! What the data leave open there is the largest of three: how far rivals at its place are apart
//! from it, how far a wave is out of step with another of its periods, and, of the law alone, two
//! standard deviations of what its constants make of it,
//!
//! ```text
//! var Δ(x) = Σ p_s·(gᵀ·cov_s a·g + (gᵀ·a_s − Δ̄)²)
//! ```
//!
//! g(x; s) its functions there without the straight line through them at the data, which zeros and
//! stiffnesses take up, s the number that is not linear.

use std::f64::consts::PI;

use nalgebra::{DMatrix, DVector};

use super::form::{Form, FormConstant};
use super::memory::Memory;
use super::proposed::{Law, LawRival};
use super::remainder::Remainder;
use super::scan::Scanned;
use crate::linalg::least_squares;

/// How far beyond the data it is said how far laws are apart.
const FURTHER: f64 = 1.5;
/// Values of s by which its posterior counts.
const DRAWS: usize = 24;
/// Of the functions of a wave cosine and sine are one.
const OF_A_WAVE: usize = 2;
/// Standard deviations that count.
const WIDE: f64 = 2.0;

/// The variable half again beyond the data, SI, and how far off the law may be there, m; `None` of
/// a straight line, and of a law that follows what a memory makes of it, without rivals.
pub(super) fn further(law: &Law, scanned: &Scanned, remainder: &Remainder, size: f64) -> Option<(f64, f64)> {
    let at = FURTHER * law.site.range().1;
    let distances = comparable(law).map(|(_, rival)| apart(law, rival, at));
    let open = [out_of_step(law), unsure(law, scanned, (remainder, size), at)];
    distances.chain(open.into_iter().flatten()).reduce(f64::max).map(|most| (at, most))
}

/// How far its constants leave a law open at x, m; a straight line goes on as it is.
fn unsure(law: &Law, scanned: &Scanned, (remainder, size): (&Remainder, f64), x: f64) -> Option<f64> {
    let goes_on = law.form == Form::Polynomial(1);
    if goes_on || !matches!(law.memory, Memory::None | Memory::Side) {
        return None;
    }
    let (count, largest) = (law.form.count(), law.site.largest());
    let draws = scanned.even(DRAWS);
    let mut worst: f64 = 0.0;
    for (direction, (_, weights)) in law.site.directions.iter().enumerate() {
        let per_result = weights.iter().fold(0.0, |most: f64, w| most.max(w.abs()));
        let xs = positions(law, direction);
        let (mut mean, mut square) = (0.0, 0.0);
        for (choice, u) in &draws {
            let s = choice.at(*u);
            let own = choice.columns(&law.site, *u, size);
            let (factors, covariance) = remainder.factors(&own.columns);
            let g = DVector::from_fn(count, |j, _| {
                let function = |x: f64| choice.form.functions(x / largest, s)[j];
                let (level, slope) = line(&xs, &function);
                (function(x) - level - slope * x) * own.amplitudes[direction * count + j]
            });
            let first = direction * count;
            let value = g.dot(&factors.rows(first, count));
            let variance = g.dot(&(covariance.view((first, first), (count, count)) * &g));
            mean += value / draws.len() as f64;
            square += (value * value + variance) / draws.len() as f64;
        }
        worst = worst.max(WIDE * (square - mean * mean).max(0.0).sqrt() * per_result);
    }
    Some(worst)
}

/// How far a wave may be from what goes on half again beyond its data, m. Its phase is known in
/// their middle: from there on it is out of step by φ = 2π·X·(1/P_low − 1/P_high)/2, and by a
/// distance 2·A·sin(φ/2); of several periods by as much as there is.
fn out_of_step(law: &Law) -> Option<f64> {
    let Some((FormConstant::Period, period)) = &law.constant else { return None };
    let count = law.form.count();
    let amplitudes = law.values.0.chunks(count).zip(&law.site.directions).map(|(own, (_, weights))| {
        let largest = weights.iter().fold(0.0, |most: f64, w| most.max(w.abs()));
        own.iter().take(OF_A_WAVE).map(|a| a * a).sum::<f64>().sqrt() * largest
    });
    let largest = law.site.largest() / law.site.variable.si;
    let phase = match period.also.is_empty() {
        true => PI * largest * (1.0 / period.low - 1.0 / period.high),
        false => PI,
    };
    amplitudes.reduce(f64::max).map(|amplitude| 2.0 * amplitude * (0.5 * phase.min(PI)).sin())
}

/// Rivals with their numbers that differ from the law in nothing but form and constants.
pub(super) fn comparable(law: &Law) -> impl Iterator<Item = (usize, &LawRival)> {
    let is_alike = |rival: &LawRival| {
        rival.memory.is(law.memory)
            && rival.site.location == law.site.location
            && rival.site.result == law.site.result
            && rival.site.variable == law.site.variable
    };
    law.rivals.iter().enumerate().filter(move |(_, rival)| is_alike(rival))
}

/// How far two laws are apart at x, m, but for what zeros and stiffnesses take up.
pub(super) fn apart(law: &Law, rival: &LawRival, x: f64) -> f64 {
    let per_result =
        law.site.directions.iter().flat_map(|(_, w)| w).fold(0.0, |most: f64, w| most.max(w.abs()));
    let of_direction = |direction: usize| {
        let (level, slope) = nuisance_line(law, rival, direction);
        (law.at(direction, x) - rival.at(direction, x) - level - slope * x).abs() * per_result
    };
    (0..law.site.directions.len()).map(of_direction).fold(0.0, f64::max)
}

/// What the nuisance space (zeros and stiffnesses) takes up of the difference of two laws: the
/// straight line through it at the data, its level (m) and its slope (m per unit of the variable).
fn nuisance_line(law: &Law, rival: &LawRival, direction: usize) -> (f64, f64) {
    line(&positions(law, direction), &|x| law.at(direction, x) - rival.at(direction, x))
}

/// The variable at the data of a direction.
fn positions(law: &Law, direction: usize) -> Vec<f64> {
    law.points.iter().filter(|point| point.direction == direction).map(|point| point.x).collect()
}

/// Level and slope of the straight line through a function at these places.
fn line(xs: &[f64], function: &dyn Fn(f64) -> f64) -> (f64, f64) {
    let columns = DMatrix::from_fn(xs.len(), 2, |i, j| if j == 0 { 1.0 } else { xs[i] });
    let values = DVector::from_iterator(xs.len(), xs.iter().map(|&x| function(x)));
    least_squares(&columns, &values).map_or((0.0, 0.0), |line| (line[0], line[1]))
}
