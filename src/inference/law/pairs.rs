//! Where to begin with two laws that only together are what the data show.
//!
//! Two time constants at one place make a curve together. The likeliest law alone
//! has a number between both, beside which the second one is no other. Two waves of near periods
//! beat, as one does that grows, and are in step and out of it, as one does whose period changes.
//! So all pairs of first looks at what is remembered at a place, and at waves about one that
//! changes, are tried together; the better one of the likeliest pair is the first law.

use nalgebra::DMatrix;

use super::choice::{Choice, beside_each_other};
use super::described::Known;
use super::form::Form;
use super::memory::Memory;
use super::scan::{Scan, Scanned};
use super::site::Site;

/// Quantiles one standard deviation from the middle.
const ONE_SIGMA: (f64, f64) = (0.159, 0.841);
/// Numbers of two laws that are more alike (ρ²) are not known by second derivatives.
const MOST_ALIKE: f64 = 0.96;
/// Most steps of two laws' numbers, the largest one and the last one, in deviations of each alone.
const STEPS: usize = 12;
const FARTHEST: f64 = 3.0;
const SETTLED: f64 = 0.05;
/// Sites that are tried: those of so many laws, the likeliest.
const LIKELIEST: usize = 8;
/// Periods so near to that of a wave that changes, as a factor, may be those of two waves that do
/// not.
const NEAR: f64 = 1.4;
/// By what two waves are moved to where they are likeliest, in cycles over X.
const STEP_OF_A_WAVE: f64 = 0.03;

/// The first of two laws that are together likelier than these ln odds; `None` where no
/// pair is.
pub(super) fn beginning(known: &Known, found: &Scan, least: f64) -> Option<Scanned> {
    let mut numbers: Vec<usize> = found.laws.iter().take(LIKELIEST).map(|law| law.choice.site).collect();
    numbers.sort_unstable();
    numbers.dedup();
    let best = numbers.into_iter().filter_map(|number| likeliest_pair(known, found, number));
    let (first, log_odds) = best.reduce(|a, b| if b.1 > a.1 { b } else { a })?;
    (log_odds > least).then_some(first)
}

/// The better one of the likeliest pair at a site, and about the ln odds of both together.
fn likeliest_pair(known: &Known, found: &Scan, number: usize) -> Option<(Scanned, f64)> {
    let (site, size) = (&known.sites[number], known.data.size);
    let own = || found.laws.iter().filter(|law| law.choice.site == number);
    let is_remembered =
        |choice: &Choice| choice.form == Form::Polynomial(1) && choice.memory == Memory::Lagged;
    let changing = own().find(|law| law.choice.form.is_wave() && law.choice.has_shape());
    let is_tried = |law: &Scanned, u: f64| match changing {
        Some(wave) if law.choice.form.is_wave() && !law.choice.has_shape() => (u - wave.at).abs() < NEAR.ln(),
        _ => is_remembered(&law.choice),
    };
    let points: Vec<(&Scanned, f64)> = own()
        .flat_map(|law| law.choice.grid(site).into_iter().map(move |u| (law, u)))
        .filter(|(law, u)| is_tried(law, *u))
        .collect();
    let columns: Vec<DMatrix<f64>> =
        points.iter().map(|(law, u)| law.choice.columns(site, *u, size).columns).collect();
    let alone = known.remainder.gains(columns.len(), |k| columns[k].clone());
    let all = 0..points.len();
    let pairs: Vec<(usize, usize)> =
        all.clone().flat_map(|one| (one + 1..all.end).map(move |other| (one, other))).collect();
    let gains = known.remainder.gains(pairs.len(), |k| {
        let (one, other) = pairs[k];
        beside_each_other(&columns[one], &columns[other])
    });
    let (pair, mut gain) = pairs.into_iter().zip(gains).reduce(|a, b| if b.1 > a.1 { b } else { a })?;
    let price = |k: usize| points[k].0.price;
    let is_first = alone[pair.0] >= alone[pair.1];
    let first = if is_first { pair.0 } else { pair.1 };
    let (law, mut at) = points[first];
    // beside a wave that is out of step any other one seems to change
    if law.choice.form.is_wave() {
        let [mut one, mut other] = [pair.0, pair.1].map(|k| {
            let (law, at) = points[k];
            let deviation = STEP_OF_A_WAVE / law.choice.at(at);
            Numbered { choice: law.choice, site: site.clone(), at, deviation }
        });
        let gains = |sets: &[DMatrix<f64>]| known.remainder.gains(sets.len(), |k| sets[k].clone());
        settle([&mut one, &mut other], &gains, size);
        let both = beside_each_other(&one.columns(0.0, size), &other.columns(0.0, size));
        gain = gain.max(known.remainder.gain(&both));
        at = if is_first { one.at } else { other.at };
    }
    let log_odds = alone[first] - price(first);
    Some((Scanned { at, log_odds, ..law.clone() }, gain - price(pair.0) - price(pair.1)))
}

/// A law with a number that is not linear, as it is beside another one.
pub(super) struct Numbered {
    choice: Choice,
    site: Site,
    at: f64,
    /// Standard deviation of its coordinate while the other's is fixed.
    deviation: f64,
}

impl Numbered {
    /// `None` of a law without such a number, and of a loop, whose three stand for themselves.
    pub fn new(law: &Scanned, site: &Site) -> Option<Numbered> {
        let (low, high) = (law.posterior.quantile(ONE_SIGMA.0), law.posterior.quantile(ONE_SIGMA.1));
        let deviation = 0.5 * (high - low);
        let is_known = law.choice.constant().is_some() && law.peak.is_none() && deviation > 0.0;
        is_known.then(|| Numbered { choice: law.choice, site: site.clone(), at: law.at, deviation })
    }

    /// At so many deviations from its number, each of the root mean square `size`.
    pub fn columns(&self, steps: f64, size: f64) -> DMatrix<f64> {
        self.choice.columns(&self.site, self.at + steps * self.deviation, size).columns
    }
}

/// Moves the numbers of two laws to where both together are likeliest, by Newton's method; by what
/// factor their intervals are wider where neither is fixed. With H the second derivatives of the ln
/// evidence g by both,
///
/// ```text
/// (H⁻¹)₁₁·H₁₁ = 1/(1 − ρ²),   ρ² = H₁₂²/(H₁₁·H₂₂)
/// ```
///
/// `gains` are g of sets of columns, each of the root mean square `size`.
pub(super) fn settle(
    laws: [&mut Numbered; 2],
    gains: &dyn Fn(&[DMatrix<f64>]) -> Vec<f64>,
    size: f64,
) -> f64 {
    let [one, other] = laws;
    let mut wider = 1.0;
    let mut likeliest = (f64::NEG_INFINITY, [one.at, other.at]);
    for _ in 0..STEPS {
        let about = [-1.0, 0.0, 1.0];
        let all = about.iter().flat_map(|a| about.iter().map(move |b| (*a, *b)));
        let g = gains(
            &all.map(|(a, b)| beside_each_other(&one.columns(a, size), &other.columns(b, size)))
                .collect::<Vec<_>>(),
        );
        let at = |a: usize, b: usize| g[3 * a + b];
        // uphill alone
        if at(1, 1) < likeliest.0 {
            break;
        }
        likeliest = (at(1, 1), [one.at, other.at]);
        // in deviations
        let slope = [0.5 * (at(2, 1) - at(0, 1)), 0.5 * (at(1, 2) - at(1, 0))];
        let bend = [2.0 * at(1, 1) - at(0, 1) - at(2, 1), 2.0 * at(1, 1) - at(1, 0) - at(1, 2)];
        let mixed = 0.25 * (at(0, 2) + at(2, 0) - at(2, 2) - at(0, 0));
        if bend.iter().any(|own| !own.is_finite() || *own <= 0.0) || !mixed.is_finite() {
            break;
        }
        let alike = (mixed * mixed / (bend[0] * bend[1])).min(MOST_ALIKE);
        let mixed = mixed.signum() * (alike * bend[0] * bend[1]).sqrt();
        let determinant = bend[0] * bend[1] - mixed * mixed;
        let step = [
            (bend[1] * slope[0] - mixed * slope[1]) / determinant,
            (bend[0] * slope[1] - mixed * slope[0]) / determinant,
        ];
        wider = (1.0 - alike).sqrt().recip();
        let step = step.map(|own| own.clamp(-FARTHEST, FARTHEST));
        one.at += step[0] * one.deviation;
        other.at += step[1] * other.deviation;
        if step.iter().all(|own| own.abs() < SETTLED) {
            break;
        }
    }
    [one.at, other.at] = likeliest.1;
    wider
}
