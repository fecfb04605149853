//! How far off a law that remembers may be along a way that nobody recorded.
//!
//! At the data a few stop operators, one more or a loop of Bouc and Wen may draw the same; they
//! part where the variable turns round elsewhere. What the data leave open there is the largest
//! of how far rivals of any memory at its place are from the law, and of two standard
//! deviations of what its own numbers make of it, without the straight line of the variable
//! that zeros and stiffnesses take up at the data.

use nalgebra::{DMatrix, DVector};

use super::form::Form;
use super::memory::Memory;
use super::proposed::Law;
use super::remainder::Remainder;
use super::scan::Scanned;
use super::site::{Course, Instant, Site};
use crate::linalg::least_squares;

/// Where the way turns round, as shares of the largest value: once up and down, with smaller loops
/// within, of sizes that all loops of the data's range have.
const TURNS: [f64; 7] = [0.65, 0.2, 0.85, 0.4, 1.0, 0.05, 0.55];
/// Places between two turns.
const PLACES: usize = 8;
/// Laws that stand for as much of the posterior each.
const DRAWS: usize = 24;
/// Standard deviations that count.
const WIDE: f64 = 2.0;

/// How far off the law may be along such a way, m; `None` of a law without a loop.
pub(super) fn another_way(law: &Law, scanned: &Scanned, (remainder, size): (&Remainder, f64)) -> Option<f64> {
    if !has_loop(law.memory) {
        return None;
    }
    let way = way(&law.site);
    let count = law.form.count();
    let mut most: f64 = 0.0;
    for (direction, (_, weights)) in law.site.directions.iter().enumerate() {
        let per_result = weights.iter().fold(0.0, |most: f64, w| most.max(w.abs()));
        let bend = |form: Form, memory: Memory, s: f64| bends((form, memory, s), &law.site, &way, direction);
        let (mut mean, mut square) = (DVector::zeros(way.values.len()), DVector::zeros(way.values.len()));
        for (choice, u) in scanned.even(DRAWS) {
            let own = choice.columns(&law.site, u, size);
            let (factors, covariance) = remainder.factors(&own.columns);
            let first = direction * count;
            let mut g = bend(choice.form, choice.memory, choice.at(u));
            for (j, mut column) in g.column_iter_mut().enumerate() {
                column *= own.amplitudes[first + j];
            }
            let value = &g * factors.rows(first, count);
            let of_factors = &g * covariance.view((first, first), (count, count));
            for k in 0..value.len() {
                let variance = of_factors.row(k).dot(&g.row(k));
                mean[k] += value[k] / DRAWS as f64;
                square[k] += (value[k].powi(2) + variance) / DRAWS as f64;
            }
        }
        let variance: DVector<f64> = square - mean.component_mul(&mean);
        most = most.max(WIDE * variance.max().max(0.0).sqrt() * per_result);
        let along = |form: Form, memory: Memory, (amplitudes, s): &(Vec<f64>, f64)| {
            let own = amplitudes.iter().skip(direction * form.count()).take(form.count());
            bend(form, memory, *s) * DVector::from_iterator(form.count(), own.copied())
        };
        let own = along(law.form, law.memory, &law.values);
        let is_here = |site: &Site| {
            (&site.location, &site.result, &site.variable)
                == (&law.site.location, &law.site.result, &law.site.variable)
        };
        for rival in law.rivals.iter().filter(|rival| is_here(&rival.site) && has_loop(rival.memory)) {
            let apart = along(rival.form, rival.memory, &rival.values) - &own;
            most = most.max(apart.amax() * per_result);
        }
    }
    Some(most)
}

/// True for what follows a way, whenever it goes it.
fn has_loop(memory: Memory) -> bool {
    match memory {
        Memory::Stop | Memory::Play | Memory::Stops(_) | Memory::BoucWen(_) => true,
        Memory::None | Memory::Side | Memory::Lag | Memory::Lagged => false,
    }
}

/// A site of the same law that goes the way.
pub(super) fn way(site: &Site) -> Site {
    let (largest, mut from) = (site.largest(), 0.0);
    let mut values = Vec::with_capacity(TURNS.len() * PLACES);
    for turn in TURNS {
        values.extend((1..=PLACES).map(|k| largest * (from + (turn - from) * k as f64 / PLACES as f64)));
        from = turn;
    }
    let count = values.len();
    let instant = |i: usize| Instant { data: vec![i], elapsed: f64::NAN, sense: 1.0 };
    let course = Course { instants: (0..count).map(instant).collect(), start: 0.0 };
    let directions = site.directions.iter().map(|(name, _)| (name.clone(), vec![1.0; count])).collect();
    let moves = vec![1.0; count];
    Site { directions, values, recorded: None, moves, courses: vec![course], ..site.clone() }
}

/// The functions of a law along the way, a column each, without the straight lines through them at
/// the data of a direction.
fn bends((form, memory, s): (Form, Memory, f64), site: &Site, way: &Site, direction: usize) -> DMatrix<f64> {
    let seen = |site: &Site| -> Vec<(f64, [f64; 3])> {
        let (followed, _) = memory.remembered(site, s);
        let weights = &site.directions[direction].1;
        (0..followed.len())
            .filter(|&i| weights[i] != 0.0 && site.values[i].is_finite() && followed[i].is_finite())
            .map(|i| (site.values[i], form.functions(followed[i] / site.largest(), s)))
            .collect()
    };
    let (data, there) = (seen(site), seen(way));
    let columns = DMatrix::from_fn(data.len(), 2, |i, j| if j == 0 { 1.0 } else { data[i].0 });
    let values = DMatrix::from_fn(data.len(), form.count(), |i, j| data[i].1[j]);
    let lines: Vec<(f64, f64)> = values
        .column_iter()
        .map(|own| {
            let line = least_squares(&columns, &own.into_owned());
            line.map_or((0.0, 0.0), |line| (line[0], line[1]))
        })
        .collect();
    DMatrix::from_fn(there.len(), form.count(), |i, j| {
        let (x, functions) = there[i];
        functions[j] - lines[j].0 - lines[j].1 * x
    })
}
