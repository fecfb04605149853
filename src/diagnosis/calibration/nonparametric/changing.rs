//! Rivals for what changes while the poses are recorded, and not everywhere alike: what multiplies
//! a load or a length, which no curve over the order of the poses alone can draw.
//!
//! ```text
//! a joint that yields otherwise   Jⱼ·τⱼ·Σ_k a_k·cos(π k x)    τⱼ its torque, x from 0 to 1 the
//!                                                            temperature, the time or the order
//!                                 a·Jⱼ·τⱼ from a row on, scanned
//! a tracker of another scale      p·Σ_k a_k·cos(π k x)        p the place of the ball in {W}, x the
//!                                                            order of the poses
//!                                 a·p from a row on, scanned
//! ```
//!
//! A grease that warms, a brake that cools, a harmonic drive whose preload fades: else links grow
//! in the place of the first, and a base that moved stands for the second. A bearing or a coupling
//! that yields at once is else a load that was put on or taken off.

use super::super::model::Context;
use super::super::model::entry::{Entry, linear};
use super::curve::{LEAST_TORQUE, MOST, TURN, cosine, curve, scaled};
use crate::diagnosis::calibration::effects::fixture::places_amid;
use crate::inference::{Location, Variable};

/// Cosines along the clock of a drive: it warms up or cools down.
const OF_DRIVE: usize = 2;
/// Error of a tracker's scale: what an interferometer makes of air that is off by 10 K.
const SCALE: f64 = 1e-5;
/// Rows from which on a scale may be another one, at even distances.
const JUMPS: usize = 24;

/// All of them; those of one kind have the prior of one curve together.
pub(super) fn all(context: &Context) -> Vec<Entry> {
    let mut kinds = clocks(context).into_iter().map(|clock| drives(context, clock)).collect::<Vec<_>>();
    kinds.extend(drives_from_a_row_on(context));
    kinds.push(scales(context));
    let shared = |mut entries: Vec<Entry>| {
        let share = 1.0 / entries.len().max(1) as f64;
        entries.iter_mut().for_each(|entry| entry.candidate.weight = share);
        entries
    };
    kinds.into_iter().flat_map(shared).collect()
}

type Clock = (Variable, &'static str, Vec<f64>);

/// What drives may follow, from 0 to 1 by row: the temperature, and the time, or else the order.
fn clocks(context: &Context) -> Vec<Clock> {
    let rows = &context.recording.rows;
    let times = rows.iter().map(|row| row.time).collect::<Option<Vec<f64>>>();
    let by_time = match times.and_then(|times| scaled(&times)) {
        Some(x) => Some((Variable::Time, "the time", x)),
        None => order(context).map(|x| (Variable::Order, "the order of the poses", x)),
    };
    let temperatures = context.recording.temperatures().and_then(|temperatures| scaled(&temperatures));
    let by_temperature = temperatures.map(|x| (Variable::Temperature, "the temperature", x));
    by_temperature.into_iter().chain(by_time).collect()
}

fn order(context: &Context) -> Option<Vec<f64>> {
    scaled(&(0..context.configurations.len()).map(|row| row as f64).collect::<Vec<_>>())
}

fn drives(context: &Context, (variable, name, x): Clock) -> Vec<Entry> {
    let of_joint = |j: usize| {
        let most = context.largest(|there| there.torque[j]);
        let parameters = (1..=OF_DRIVE).map(|k| {
            let column = context.turn(j, |row, there| there.torque[j] / most * cosine(k, x[row]));
            (linear(format!("cosine_{k}_urad"), TURN / (1 + k) as f64), column)
        });
        let joint = format!("joint {}", j + 1);
        let label = format!("{variable} × torque of {joint}");
        let follows = format!("follows the torque of {joint}, more or less with {name}");
        (most > LEAST_TORQUE).then(|| curve(label, follows, Some(variable), parameters.collect()))
    };
    match context.has_masses {
        true => context.revolute().into_iter().filter_map(of_joint).collect(),
        false => Vec::new(),
    }
}

/// For each joint: any one may wear.
fn drives_from_a_row_on(context: &Context) -> Vec<Vec<Entry>> {
    let places = places_amid(context);
    let Some(&first) = places.iter().min().filter(|_| context.has_masses) else { return Vec::new() };
    let of_joint = |j: usize| {
        let most = context.largest(|there| there.torque[j]);
        if most <= LEAST_TORQUE {
            return Vec::new();
        }
        let along = Some(Variable::Order);
        let turned = context.turn_from(j, first, |_, there| there.torque[j] / most);
        let always = curve("", "", along, vec![(linear("turn_urad", TURN), turned)]);
        let from = |&before: &usize| {
            let (joint, after) = (j + 1, context.pose_name(before - 1));
            let label = format!("torque of joint {joint}, after {after}");
            let follows = format!("follows the torque of joint {joint} from about {after} on");
            always.starting_at(before, Location::Curve { label, follows, along })
        };
        places.iter().map(from).collect::<Vec<_>>()
    };
    context.revolute().into_iter().map(of_joint).collect()
}

/// Of a recording that a tracker made.
fn scales(context: &Context) -> Vec<Entry> {
    let Some(x) = order(context).filter(|_| context.is_tracked()) else { return Vec::new() };
    let along = Some(Variable::Order);
    let follows = "follows the distance from the tracker, more or less with the order of the poses";
    let parameters = (1..=MOST).map(|k| {
        let column = context.column(|row, there| there.tip * cosine(k, x[row]));
        (linear(format!("cosine_{k}"), SCALE / (1 + k) as f64), column)
    });
    let mut entries = vec![curve("order × distance from the tracker", follows, along, parameters.collect())];
    let count = context.configurations.len();
    let mut jumps: Vec<usize> = (1..JUMPS).map(|k| k * count / JUMPS).collect();
    jumps.dedup();
    entries.extend(jumps.into_iter().filter(|&row| row > 0).map(|row| {
        let column = context.part(row..count, |_, there| there.tip);
        let before = context.pose_name(row - 1);
        let label = format!("distance from the tracker, after {before}");
        let follows = format!("follows the distance from the tracker from about {before} on");
        curve(label, follows, along, vec![(linear("scale", SCALE), column)])
    }));
    entries
}
