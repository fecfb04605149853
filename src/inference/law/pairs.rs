//! Where to begin with two laws of which neither alone is likelier than a curve.
//!
//! Two time constants, or two slips, at one place make a curve together. The likeliest law alone
//! has a number between both, beside which the second one is no other. So all pairs of first looks
//! at what is remembered at a place are tried together; the better one of the likeliest pair is
//! the first law.

use nalgebra::DMatrix;

use super::choice::Choice;
use super::described::Known;
use super::form::Form;
use super::left::beside_each_other;
use super::memory::Memory;
use super::scan::{Scan, Scanned};

/// Sites that are tried: those of so many laws, the likeliest.
const LIKELIEST: usize = 8;

/// The first of two laws that are together likelier than a curve of these ln odds; `None` where no
/// pair is.
pub(super) fn beginning(known: &Known, found: &Scan, curve: f64) -> Option<Scanned> {
    let mut numbers: Vec<usize> = found.laws.iter().take(LIKELIEST).map(|law| law.choice.site).collect();
    numbers.sort_unstable();
    numbers.dedup();
    let best = numbers.into_iter().filter_map(|number| likeliest_pair(known, found, number));
    let (first, log_odds) = best.reduce(|a, b| if b.1 > a.1 { b } else { a })?;
    (log_odds > curve).then_some(first)
}

/// The better one of the likeliest pair at a site, and about the ln odds of both together.
fn likeliest_pair(known: &Known, found: &Scan, number: usize) -> Option<(Scanned, f64)> {
    let (site, size) = (&known.sites[number], known.data.size);
    let is_remembered = |choice: &Choice| {
        choice.form == Form::Polynomial(1) && matches!(choice.memory, Memory::Stop | Memory::Lagged)
    };
    let laws: Vec<&Scanned> =
        found.laws.iter().filter(|law| law.choice.site == number && is_remembered(&law.choice)).collect();
    let points: Vec<(&Scanned, f64)> =
        laws.iter().flat_map(|law| law.choice.grid(site).into_iter().map(|u| (*law, u))).collect();
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
    let (pair, gain) = pairs.into_iter().zip(gains).reduce(|a, b| if b.1 > a.1 { b } else { a })?;
    let price = |k: usize| points[k].0.price;
    let first = if alone[pair.0] >= alone[pair.1] { pair.0 } else { pair.1 };
    let (law, at) = points[first];
    let log_odds = alone[first] - price(first);
    Some((Scanned { at, log_odds, ..law.clone() }, gain - price(pair.0) - price(pair.1)))
}
