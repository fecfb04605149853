//! A clamp that moves little by little while its own poses are recorded: bolts that settle, a stand
//! that warms, a sensor whose zero drifts. Several shifts describe that roughly. Sockets have no
//! measured points that a drift could be taken out of: there shifts stand for it.

use super::super::model::CalibrationModel;
use super::super::model::entry::linear;
use super::{
    CalibrationEffect, Context, Entry, SHIFT, Transfer, no_event, out_of_the_points, own_parameters, size,
};
use crate::inference::{Effect, Finding, Key, Kind, Location, NotTestable, Reported, Variable, WrittenTo};
use crate::units::{UM, capital};

/// How far a clamp drifts, m.
const DRIFT: f64 = 100.0 * UM;
/// Time constants of what settles, as parts of the poses of a clamp.
const SETTLING: [f64; 3] = [0.1, 0.2, 0.4];
/// Fewest poses of a clamp that show a drift, and so many clamps at most: of more, each has few
/// poses.
const FEWEST: usize = 8;
const MOST_CLAMPS: usize = 30;

/// A clamp that drifts.
pub static CLAMP_DRIFT: CalibrationEffect = CalibrationEffect {
    effect: Effect {
        name: "clamp_drift",
        kind: Kind::Physics,
        summary: "a clamp drifts while its poses are recorded",
        formula: "−t·x, or −t·(1 − e^(−x/x₁)): x is the share of its poses that are over, t how far it drifts",
        prior: "100 µm: bolts that settle, a stand that warms by 10 K",
        parameters: &[(&["dx_um", "dy_um", "dz_um"], "displacement of the clamp in {W}")],
        needs: "eight poses in a clamp, of thirty at most",
        cause: "a clamp that settles, or its sensors' zero that drifts",
        cause_at: |location| format!("drift ({location})"),
        written_to: WrittenTo::Recording,
        reported: Reported::Alone,
        seen_along: |_| vec![Variable::Order, Variable::Time],
        direct_check: None,
    },
    candidates: drifts,
    estimates: own_parameters,
    observed: drifted,
    write: out_of_the_points,
    transfer: Transfer::Nothing,
    event: no_event,
};

fn drifts(context: &Context, _: &mut Vec<NotTestable>) -> Vec<Entry> {
    let courses = || {
        let settles =
            SETTLING.map(|part| (format!("settling over {} % of its poses", 100.0 * part), Some(part)));
        std::iter::once(("evenly over its poses".to_owned(), None)).chain(settles)
    };
    let of_clamp = |(group, shares): (usize, Vec<f64>)| {
        let name = context.recording.groups[group].name.to_string();
        courses()
            .map(|(form, settling)| {
                let course = |x: f64| settling.map_or(x, |part| 1.0 - (-x / part).exp());
                let along = |(axis, name): (usize, &&str)| {
                    let pattern = &context.patterns.world[axis];
                    let column = context.along(pattern, |row, _| match shares[row] {
                        x if x.is_nan() => 0.0,
                        x => -course(x),
                    });
                    (linear(*name, DRIFT), column)
                };
                let location = Location::from(Key::new(name.clone()).rows(form));
                Entry::new(&CLAMP_DRIFT.effect, location, SHIFT.iter().enumerate().map(along).collect())
            })
            .collect::<Vec<_>>()
    };
    shares(context).into_iter().flat_map(of_clamp).collect()
}

/// For each clamp with enough poses its number and, by row, the share of its poses that are over,
/// from 0 to 1; NaN at others. Nothing of sockets, and of what a tracker sees.
pub(in super::super) fn shares(context: &Context) -> Vec<(usize, Vec<f64>)> {
    let (groups, rows) = (&context.recording.groups, &context.recording.rows);
    let has_clamps = !context.has_sockets() && groups.iter().all(|group| !group.name.is_tracked());
    if !has_clamps || groups.len() > MOST_CLAMPS {
        return Vec::new();
    }
    let of_group = |group: usize| {
        let own: Vec<usize> = (0..rows.len()).filter(|row| rows[*row].group == group).collect();
        let mut shares = vec![f64::NAN; rows.len()];
        own.iter().enumerate().for_each(|(k, row)| shares[*row] = k as f64 / (own.len().max(2) - 1) as f64);
        (own.len() >= FEWEST).then_some((group, shares))
    };
    (0..groups.len()).filter_map(of_group).collect()
}

fn drifted(finding: &Finding, _: &CalibrationModel) -> String {
    let by = size(finding, UM).with_unit("µm");
    match &finding.location {
        Location::Key(Key { names, rows }) => {
            format!("{} drifts by {by}, {}", capital(names), rows.join(", "))
        }
        other => format!("{} drifts by {by}", capital(other)),
    }
}
