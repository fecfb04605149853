//! What all sensors show of the loads along an axis, each a curve of its own over the load: a load
//! that pulls sideways the more it weighs, a mount that turns.
//!
//! ```text
//! y_c + Σ_j a_cj·cos(π j x)      c the channel, x the rank of the load
//! y_c + a_c·F, y_c + a_c·|F|     under loads along any axis: a stand that is moved by them
//! ```

use std::sync::Arc;

use super::along::{Coordinate, LOAD, Way, by_channel, rival, size};
use super::cosines::curve;
use crate::diagnosis::rig::effects::entry::{Entry, UNBOUNDED, parameter};
use crate::diagnosis::rig::mechanics::action::{Action, Weights};
use crate::diagnosis::rig::numbering::numbered;
use crate::diagnosis::rig::recording::datum::Datum;
use crate::inference::{Location, Parameter};
use crate::spatial::Axis;

/// For each axis along which loads pull, and for all of them together, where several channels are
/// read. `levels`: the load of each datum, from 0 to 1.
pub(super) fn under_loads(data: &[Datum], levels: &Coordinate) -> Vec<Entry> {
    let mut each: Vec<Entry> = Axis::ALL.into_iter().filter_map(|axis| along(data, levels, axis)).collect();
    if each.len() > 1 {
        let parameters = each.iter().flat_map(|(own, _)| own.parameters.clone()).collect();
        let actions = each.iter().flat_map(|(_, own)| own.clone()).collect();
        each.push((rival(location("all sensors under the loads of each axis"), parameters), actions));
    }
    each.extend(in_proportion(data));
    each
}

/// In proportion to the load, wherever it pulls to: a number for each of several channels. Along a
/// single axis these are the slopes of its lines.
fn in_proportion(data: &[Datum]) -> Vec<Entry> {
    let everything: Vec<usize> = (0..data.len()).collect();
    let channels = by_channel(&everything, data);
    let most = data.iter().fold(0.0, |most: f64, datum| most.max(datum.drive().abs()));
    let axes = numbered(data.iter().filter(|d| d.drive() != 0.0).map(|d| d.direction.axis));
    if channels.len() < 2 || axes.into_iter().max().unwrap_or(0) == 0 {
        return Vec::new();
    }
    let entry = |way: &Way| {
        let of_channel = |own: &Arc<[usize]>| {
            let weight = |&i: &usize| way.side(data[i].drive()) * data[i].drive().abs() / most;
            let weights = Weights { data: Arc::clone(own), values: own.iter().map(weight).collect() };
            let name = format!("d{}_um", data[own[0]].channel);
            (parameter(&name, 0.0, size(own, data), UNBOUNDED), Action::Shift(weights))
        };
        let (parameters, actions) = channels.iter().map(of_channel).unzip();
        let place = format!("all sensors under all loads, in proportion{}", way.in_sentences());
        (rival(location(&place), parameters), actions)
    };
    Way::of(data, &everything).iter().map(entry).collect()
}

fn location(place: &str) -> Location {
    let label = format!("{}, {place}", LOAD.name);
    Location::Curve { label, follows: LOAD.follows(place), along: Some(LOAD.variable) }
}

fn along(data: &[Datum], levels: &Coordinate, axis: Axis) -> Option<Entry> {
    let place = format!("all sensors under loads along {axis}");
    let is_under = |i: &usize| data[*i].direction.axis == axis;
    let all: Vec<usize> = (0..data.len()).filter(is_under).collect();
    // what pulls sideways is a share of what pulls along
    let size = size(&all, data);
    let (mut parameters, mut actions, mut channels) = (Vec::new(), Vec::new(), 0);
    for channel in Axis::ALL {
        let group: Vec<usize> = all.iter().copied().filter(|&i| data[i].channel == channel).collect();
        let Some((own, shifts)) = curve(LOAD, &place, levels, &group, "um", size, |_| 1.0) else { continue };
        let of_channel =
            |own: Parameter| Parameter { name: format!("{axis}_d{channel}_{}", own.name), ..own };
        parameters.extend(own.parameters.into_iter().map(of_channel));
        actions.extend(shifts);
        channels += 1;
    }
    (channels > 1).then(|| (rival(location(&place), parameters), actions))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::diagnosis::rig::recording::datum;
    use crate::rig::readings::Readings;

    fn found(text: &str) -> Vec<Entry> {
        in_proportion(&datum::all(&Readings::from_text("f", text).unwrap().rows))
    }

    #[test]
    fn a_stand_moves_all_sensors_by_the_load_wherever_that_pulls() {
        let found = found("axis,load_n,dy_um,dz_um\ny,10,1,0\n-y,5,-1,0\nz,5,0,2\n");
        let weights = |k: usize| match &found[k].1[1] {
            Action::Shift(weights) => weights.iter().collect::<Vec<_>>(),
            _ => panic!("a shift"),
        };
        // dz of every row: as the load points, and one way
        assert_eq!(weights(0), [(1, 1.0), (3, -0.5), (5, 0.5)]);
        assert_eq!(weights(1), [(1, 1.0), (3, 0.5), (5, 0.5)]);
        let label = "load, all sensors under all loads, in proportion, whichever way they point";
        assert_eq!((found.len(), found[1].0.location.to_string().as_str()), (2, label));
    }

    #[test]
    fn along_one_axis_it_is_a_stiffness() {
        assert!(found("axis,load_n,dy_um,dz_um\ny,10,1,0\ny,5,1,0\nz,0,0,2\n").is_empty());
    }
}
