//! Rivals that change within much less than the range of a number: no few cosines describe them.
//!
//! ```text
//! a wave        a·sin(2π n x) + b·cos(2π n x)      n cycles over the range of x, scanned
//! a fine curve  Σ_k a_k·cos(π k x)                 a_k ~ s·(1 + (π k l)²)^(−(ν + ½)/2)
//! a walk        Σ_k a_k·cos(π k x)                 a_k ~ s/k
//! ```
//!
//! a, b, a_k vectors, x from 0 to 1: the order of the poses (what comes back in waves, and what
//! walks), the place of the ball along an axis of {W}, or the displacement that the clamps' sensors
//! show along an axis of theirs, with vectors in the frame of the device. The sizes of the fine
//! curve are the spectrum of a Matérn process of length l and roughness ν = 3/2 (C. E. Rasmussen,
//! C. K. I. Williams, *Gaussian Processes for Machine Learning*, 2006, §4.2).

use std::f64::consts::{PI, TAU};

use super::super::effects::contact::is_of_clamps;
use super::super::model::Context;
use super::super::model::entry::{Column, Entry, linear};
use super::curve::{AXES, SIZE, cosine, curve, scaled};
use crate::inference::{Parameter, Pattern, Variable};
use crate::units::{MM, significant};

/// Most frequencies at which something may come back over a recording, and over a range that the
/// poses sample anywhere.
const RETURNS: usize = 200;
const WAVES: usize = 46;
/// Lengths of a fine curve, as shares of the range, and its roughness.
const LENGTHS: [f64; 2] = [0.1, 0.04];
const ROUGHNESS: f64 = 1.5;
/// A cosine is left out where it is smaller than this share of the first one, and so are those
/// beyond one for every so many poses.
const LEAST: f64 = 0.1;
/// Most cosines of a walk: they leave 6/(π²·40) = 1.5 % of its variance.
const MOST_OF_WALK: usize = 40;
const POSES: usize = 5;

/// All of them.
pub(super) fn all(context: &Context) -> Vec<Entry> {
    let mut entries = again_and_again(context);
    entries.push(walk(context));
    for axis in 0..3 {
        entries.extend(over_place(context, axis));
        entries.extend(over_displacement(context, axis));
    }
    entries
}

/// What follows a number of every row, from 0 to 1, along three directions of each row.
struct Along<'a> {
    context: &'a Context<'a>,
    x: Vec<f64>,
    directions: [Pattern; 3],
}

impl Along<'_> {
    /// A vector times a weight for each row.
    fn vectors(&self, name: &str, size: f64, weight: &dyn Fn(f64) -> f64) -> Vec<(Parameter, Column)> {
        let along = |(direction, letter): (&Pattern, &&str)| {
            let column = self.context.along(direction, |row, _| weight(self.x[row]));
            (linear(format!("{letter}_{name}_um"), size), column)
        };
        self.directions.iter().zip(&AXES).map(along).collect()
    }

    /// One with n cycles over the range.
    fn wave(&self, cycles: f64) -> Vec<(Parameter, Column)> {
        let phase = |x: f64| TAU * cycles * x;
        let mut parameters = self.vectors("sin", SIZE, &|x| phase(x).sin());
        parameters.extend(self.vectors("cos", SIZE, &|x| phase(x).cos()));
        parameters
    }

    /// Numbers of cycles, in steps of a half, which tell all frequencies apart: up to one for every
    /// three rows.
    fn cycles(&self, least: usize, most: usize) -> impl Iterator<Item = f64> {
        (least..=2 * self.x.len() / 3).take(most).map(|halves| 0.5 * halves as f64)
    }

    /// A Matérn process of length l.
    fn fine(&self, length: f64) -> Vec<(Parameter, Column)> {
        // (1 + (π k l)²)^(−(ν + ½)/2), the root of the spectrum
        let share = |k: usize| ((PI * k as f64 * length).powi(2) + 1.0).powf(-0.5 * (ROUGHNESS + 0.5));
        let orders = (1..=self.x.len() / POSES).take_while(|&k| share(k) > LEAST * share(1));
        let of_order = |k: usize| self.vectors(&format!("cosine_{k}"), SIZE * share(k), &|x| cosine(k, x));
        orders.flat_map(of_order).collect()
    }

    /// A random walk: the cosines of its Karhunen–Loève series, of the size s/k.
    fn walk(&self) -> Vec<(Parameter, Column)> {
        let orders = 1..=(self.x.len() / POSES).min(MOST_OF_WALK);
        let of_order = |k: usize| self.vectors(&format!("cosine_{k}"), SIZE / k as f64, &|x| cosine(k, x));
        orders.flat_map(of_order).collect()
    }

    /// Waves and fine curves over a range, m.
    fn entries(&self, label: &str, follows: &str, range: f64) -> Vec<Entry> {
        let wave = |cycles: f64| {
            let waves = format!("waves of {} mm", significant(range / cycles / MM, 2));
            curve(format!("{label}, {waves}"), format!("{follows}, in {waves}"), None, self.wave(cycles))
        };
        let fine = |length: f64| {
            // of whatever length: a place is no form
            curve(format!("{label}, a curve"), follows, None, self.fine(length))
        };
        self.cycles(3, WAVES).map(wave).chain(LENGTHS.map(fine)).collect()
    }
}

/// What comes back after so many rows: from twice over the recording to every third row, or as far
/// as the scan goes.
fn again_and_again(context: &Context) -> Vec<Entry> {
    let rows = context.configurations.len();
    let x = (0..rows).map(|row| row as f64 / rows as f64).collect();
    let along = Along { context, x, directions: context.patterns.world.clone() };
    let of_count = |count: f64| {
        let again = format!("again every {:.1} poses", rows as f64 / count);
        let (label, follows) = (format!("order, {again}"), format!("comes back {again}"));
        curve(label, follows, Some(Variable::Order), along.wave(count))
    };
    along.cycles(4, RETURNS).map(of_count).collect()
}

/// What goes on from every pose to the next, and does not come back.
fn walk(context: &Context) -> Entry {
    let rows = context.configurations.len();
    let x = (0..rows).map(|row| row as f64 / (rows.max(2) - 1) as f64).collect();
    let along = Along { context, x, directions: context.patterns.world.clone() };
    let follows = "walks with the order of the poses";
    curve("order, a walk in the world", follows, Some(Variable::Order), along.walk())
}

/// What depends on where the ball is along an axis of {W}: a rail, a tracker's lead, a table. A
/// fixture holds it in a few places, and is a rival of its own.
fn over_place(context: &Context, axis: usize) -> Vec<Entry> {
    if context.has_sockets() || is_of_clamps(context) {
        return Vec::new();
    }
    let places: Vec<f64> = context.configurations.iter().map(|there| there.tip[axis]).collect();
    let Some(x) = scaled(&places) else { return Vec::new() };
    let along = Along { context, x, directions: context.patterns.world.clone() };
    let letter = AXES[axis];
    let follows = format!("follows the place of the ball along {letter}");
    along.entries(&format!("place along {letter}"), &follows, range(&places))
}

/// What depends on the displacement that the sensors of the clamps show along an axis of theirs.
fn over_displacement(context: &Context, axis: usize) -> Vec<Entry> {
    if !is_of_clamps(context) || !context.shows_displacements() {
        return Vec::new();
    }
    let rows = 0..context.configurations.len();
    let shown: Vec<f64> = rows.clone().map(|row| context.displacement(row)[axis]).collect();
    let Some(x) = scaled(&shown) else { return Vec::new() };
    let direction =
        |which: usize| context.pattern(|row, _| context.recording.device(row).rotation.column(which).into());
    let along = Along { context, x, directions: [0, 1, 2].map(direction) };
    let letter = AXES[axis];
    let label = format!("displacement along {letter} of the clamps");
    let follows = format!("follows the displacement that the clamps' sensors show along {letter}");
    along.entries(&label, &follows, range(&shown))
}

fn range(values: &[f64]) -> f64 {
    values.iter().copied().fold(f64::NEG_INFINITY, f64::max)
        - values.iter().copied().fold(f64::INFINITY, f64::min)
}
