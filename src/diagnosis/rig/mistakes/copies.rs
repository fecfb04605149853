//! Trials that are a copy of another one.
//!
//! Readings of the same loads in two trials are the same to the last digit now and then: with a
//! scatter of s and a display of step q in a share of p = q/(2·√π·s) of them; where the step hides
//! the scatter, in as many as other trials share. All n of a trial are by a chance of pⁿ. A
//! recording without noise repeats itself in every trial; only where others scatter, beside zeros
//! and slopes of their own, or, where none went through the same loads and stations as another, its
//! own readings scatter about each other, is one a copy.

use std::collections::BTreeMap;

use super::super::effects::mistakes::COPY_MISTAKE;
use super::super::numbering::numbered;
use super::lines::fit;
use super::part::Part;
use super::search::ODDS;
use crate::diagnosis::rig::recording::columns::{rows_of, trial_name};
use crate::diagnosis::rig::recording::datum::Datum;
use crate::diagnosis::rig::recording::resolution::resolution;
use crate::diagnosis::rig::recording::spread::about_scatter_of;
use crate::inference::Key;
use crate::spatial::Axis;
use crate::statistics::median;

/// Scatter that hardly any display rounds away, in steps.
const STEPS: f64 = 0.5;

/// No display shows less than this share of its largest reading.
const EXACT: f64 = 1e-7;

/// So many other trials show how far readings scatter.
const COMPARED: usize = 20;

/// What a trial shows: direction, stations, load, phase and channel of each reading, in turn, with
/// the reading, m.
type Shown = (i8, usize, [u64; 2], u64, bool, usize);
/// Axis of the load, channel and stations.
type LineKey = (Axis, Axis, [u64; 2]);

/// Trials whose readings are those of an earlier one; `data` of the copies.
pub(super) fn found(data: &[Datum]) -> Vec<Part> {
    let trial = numbered(data.iter().map(|datum| (datum.session_number, datum.trial_number)));
    let mut readings: BTreeMap<usize, Vec<usize>> = BTreeMap::new();
    trial.iter().enumerate().for_each(|(i, &trial)| readings.entry(trial).or_default().push(i));
    let key = |&i: &usize| -> Shown {
        let d = &data[i];
        let axis = d.direction.axis.index();
        (d.direction.sign, axis, d.stations(), d.load.to_bits(), d.is_unloading(), d.channel.index())
    };
    let protocols = numbered(readings.values().map(|own| own.iter().map(key).collect::<Vec<_>>()));
    let trials: Vec<&Vec<usize>> = readings.values().collect();
    // the same protocol and the same readings
    let values = |own: &Vec<usize>| own.iter().map(|&i| data[i].measured.to_bits()).collect::<Vec<_>>();
    let same = numbered(trials.iter().zip(&protocols).map(|(own, protocol)| (*protocol, values(own))));
    let mut found = Vec::new();
    for (t, own) in trials.iter().enumerate() {
        let Some(first) = (0..t).find(|&other| same[other] == same[t]) else { continue };
        let differs = |a: usize, b: usize| protocols[a] == protocols[b] && same[a] != same[b];
        let mut compared: Vec<(usize, usize)> =
            (0..trials.len()).filter(|&o| differs(t, o)).map(|o| (t, o)).take(COMPARED).collect();
        if compared.is_empty() {
            // other trials went through loads or stations of their own
            let pairs = (0..trials.len()).flat_map(|b| (0..b).map(move |a| (a, b)));
            compared = pairs.filter(|&(a, b)| differs(a, b)).take(COMPARED).collect();
        }
        let (mut scatters, mut freedom) = (Vec::new(), 0.0);
        for &(a, b) in &compared {
            for points in differences(data, trials[a], trials[b]).values().filter(|points| points.len() > 2) {
                // what two trials differ by beside a zero and a slope, which need no noise
                scatters.push(fit(points).scatter / 2f64.sqrt());
                freedom += (points.len() - 2) as f64;
            }
        }
        if scatters.is_empty() && same.iter().any(|other| *other != same[t]) {
            scatters = own_scatters(data, own);
            freedom = own.len() as f64;
        }
        // what few readings show may be less: √(ν/χ²) at two standard deviations of χ²
        let surely = (freedom / (freedom + 2.0 * (2.0 * freedom).sqrt())).sqrt();
        let scatter = surely * median(&scatters).unwrap_or(0.0);
        let step = display(data, own.iter().copied());
        let odds = if scatter > STEPS * step {
            let chance = step.max(1e-3 * scatter) / (2.0 * std::f64::consts::PI.sqrt() * scatter);
            let moving = own.iter().filter(|&&i| data[i].measured != 0.0).count();
            moving as f64 * -chance.min(1.0).ln()
        } else if compared.is_empty() {
            0.0
        } else {
            of_shares(data, compared.iter().map(|&(a, b)| (&trials[a][..], &trials[b][..])))
        };
        if odds < ODDS + (trials.len() as f64).ln() {
            continue;
        }
        let (name, original) = (name(data, own), name(data, trials[first]));
        found.push(Part {
            effect: &COPY_MISTAKE,
            observed: format!(
                "The {} readings of {name} are those of {original} to the last digit, where others scatter: {name} is left out; copy it again from its protocol",
                own.len()
            ),
            looks_like: format!("{name} looks like a copy of {original}"),
            location: Key::new(name),
            estimates: Vec::new(),
            explains: 0.0,
            data: (*own).clone(),
            rivals: Vec::new(),
        });
    }
    found
}

/// Load, N, and difference, m, of the readings of two trials through the same loads, line by line.
fn differences(data: &[Datum], first: &[usize], second: &[usize]) -> BTreeMap<LineKey, Vec<(f64, f64)>> {
    let mut of_line: BTreeMap<LineKey, Vec<(f64, f64)>> = BTreeMap::new();
    for (&a, &b) in first.iter().zip(second) {
        let point = (data[a].signed_load(), data[a].measured - data[b].measured);
        of_line.entry(data[a].line_key()).or_default().push(point);
    }
    of_line
}

/// Odds against as many readings being the same to the last digit as a trial has, by the most that
/// two trials of `pairs` share in each line, beside a zero and a slope:
/// −Σ n·ln((most + ½)/(n + 1)), R. E. Krichevsky and V. K. Trofimov, *IEEE Trans. Inf. Theory* 27
/// (1981) 199–207.
fn of_shares<'a>(data: &[Datum], pairs: impl Iterator<Item = (&'a [usize], &'a [usize])>) -> f64 {
    let mut most: BTreeMap<_, [usize; 2]> = BTreeMap::new();
    for (first, second) in pairs {
        for (line, points) in differences(data, first, second) {
            let step = display(data, first.iter().copied().filter(|&i| data[i].line_key() == line));
            let usual = fit(&points);
            let is_alike = |(load, off): &&(f64, f64)| (off - usual.at(*load)).abs() < 0.5 * step;
            let own = [points.iter().filter(is_alike).count(), points.len()];
            let most = most.entry(line).or_insert(own);
            *most = (*most).max(own);
        }
    }
    let odds = |&[same, all]: &[usize; 2]| {
        let [same, all] = [same as f64, all as f64];
        -all * ((same + 0.5) / (all + 1.0)).ln()
    };
    most.values().map(odds).sum()
}

/// The step of the display of some readings, m.
fn display(data: &[Datum], own: impl Iterator<Item = usize> + Clone) -> f64 {
    let largest = own.clone().fold(0.0, |most: f64, i| most.max(data[i].measured.abs()));
    resolution(own.map(|i| &data[i])).max(EXACT * largest)
}

/// Scatter of the readings of each sensor of a trial about each other, m.
fn own_scatters(data: &[Datum], own: &[usize]) -> Vec<f64> {
    let of_channel = |channel: Axis| {
        let of_sensor: Vec<&Datum> =
            own.iter().map(|&i| &data[i]).filter(|datum| datum.channel == channel).collect();
        about_scatter_of(&of_sensor)
    };
    Axis::ALL.into_iter().filter_map(of_channel).collect()
}

/// `trial 3`, `rows 7 to 12`.
fn name(data: &[Datum], own: &[usize]) -> String {
    match trial_name(&data[own[0]]) {
        Some(trial) => format!("trial {trial}"),
        None => rows_of(own.iter().map(|&i| &data[i])),
    }
}
