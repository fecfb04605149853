//! A curve of no law: a sum of cosines over a coordinate from 0 to 1.

use std::f64::consts::PI;
use std::sync::Arc;

use super::super::numbering::numbered;
use super::along::{Along, Coordinate, MOST_COLUMNS, rival};
use crate::diagnosis::rig::effects::entry::{Entry, UNBOUNDED, parameter};
use crate::diagnosis::rig::mechanics::action::{Action, Weights};
use crate::inference::Location;

/// A curve over a coordinate on some of the data; nothing where the coordinate has no meaning for
/// any.
pub(super) fn curve(
    along: Along,
    place: &str,
    coordinate: &Coordinate,
    group: &[usize],
    suffix: &str,
    size: f64,
    amplitude: impl Fn(usize) -> f64,
) -> Option<Entry> {
    let sizes: Vec<f64> = (0..MOST_COLUMNS).map(|j| size / (1 + j) as f64).collect();
    cosines(
        &format!("{}, {place}", along.name),
        (along, place),
        (coordinate, group),
        suffix,
        &sizes,
        amplitude,
    )
}

/// Σ_j a_j·cos(π j x), a_j of these sizes; of fewer values than columns as many columns.
pub(super) fn cosines(
    label: &str,
    (along, place): (Along, &str),
    (coordinate, group): (&Coordinate, &[usize]),
    suffix: &str,
    sizes: &[f64],
    amplitude: impl Fn(usize) -> f64,
) -> Option<Entry> {
    let known: Vec<(usize, f64)> = group.iter().filter_map(|&i| Some((i, coordinate[i]?))).collect();
    let different = numbered(known.iter().map(|(_, x)| x.to_bits())).into_iter().max()? + 1;
    let own: Arc<[usize]> = known.iter().map(|(i, _)| *i).collect();
    let (parameters, actions) = (0..different.min(sizes.len()))
        .map(|j| {
            let parameter = parameter(&format!("cosine_{j}_{suffix}"), 0.0, sizes[j], UNBOUNDED);
            let weight = |&(i, x): &(usize, f64)| amplitude(i) * (PI * j as f64 * x).cos();
            let values = known.iter().map(weight).collect();
            (parameter, Action::Shift(Weights { data: Arc::clone(&own), values }))
        })
        .unzip();
    let location = Location::Curve {
        label: label.to_owned(),
        follows: along.follows(place),
        along: Some(along.variable),
    };
    Some((rival(location, parameters), actions))
}

/// From 0 to 1; nothing where the values do not differ.
pub(super) fn scaled(values: &[Option<f64>]) -> Coordinate {
    let known = values.iter().flatten();
    let (least, most) = known.fold((f64::INFINITY, f64::NEG_INFINITY), |(a, b), v| (a.min(*v), b.max(*v)));
    let scale =
        |value: &Option<f64>| Some((value.as_ref()? - least) / (most - least)).filter(|x| x.is_finite());
    values.iter().map(scale).collect()
}
