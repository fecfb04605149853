//! What all sensors show of the loads along an axis, each a curve of its own over the load: a load
//! that pulls sideways the more it weighs, a mount that turns.
//!
//! ```text
//! y_c + Σ_j a_cj·cos(π j x)      c the channel, x the rank of the load
//! ```

use super::along::{Coordinate, LOAD, rival, size};
use super::cosines::curve;
use crate::diagnosis::rig::effects::entry::Entry;
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
    each
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
