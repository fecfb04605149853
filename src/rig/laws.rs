//! Readings without what the laws of the rod's file add to them: what is left is linear.

use nalgebra::{Matrix3, Vector3};

use super::readings::{Axis, Readings};
use crate::beam::{Physics, RodModel};
use crate::compliance::StaticLaws;
use crate::error::Result;
use crate::rod::law::should_show;
use crate::rod::{Rod, RodLaw, RodLawPlace};
use crate::units::UM;

/// The readings less all laws that the load alone decides on.
///
/// # Errors
/// What the beam model refuses.
pub fn without_laws(readings: &Readings, rod: &Rod, physics: &Physics, elements: usize) -> Result<Readings> {
    let mut without = readings.clone();
    let tip = rod.length();
    let at = |station: Option<f64>| station.unwrap_or(tip).min(tip);
    // between the two stations, and where the load acts
    let mut known: Vec<((f64, f64), [Matrix3<f64>; 2], StaticLaws)> = Vec::new();
    for row in &mut without.rows {
        for channel in Axis::ALL {
            let laws = rod.laws.iter().filter(|law| is_read_by(law, channel));
            if let Some(offset) = &mut row.offset[channel.index()] {
                laws.for_each(|law| *offset = UM * should_show(*offset / UM, |y| law.at(y, 1.0)));
            }
        }
        let pair = (at(row.load_station), at(row.read_station));
        let place = match known.iter().position(|(own, ..)| *own == pair) {
            Some(place) => place,
            None => {
                let model = RodModel::new(rod, physics, elements, &[pair.0, pair.1])?;
                let between = model.force_response(pair.0, pair.1)?.translation;
                let at_load = model.force_response(pair.0, pair.0)?.translation;
                known.push((pair, [between, at_load], StaticLaws::between(rod, pair.0, pair.1)));
                known.len() - 1
            }
        };
        let (_, [between, at_load], laws) = &known[place];
        let force = Vector3::ith(row.direction.axis.index(), f64::from(row.direction.sign) * row.load);
        let more = laws.displacement_between([between, at_load], &force, &Vector3::zeros());
        for (offset, more) in row.offset.iter_mut().zip(more.iter()) {
            *offset = offset.map(|offset| offset - more);
        }
    }
    Ok(without)
}

fn is_read_by(law: &RodLaw, channel: Axis) -> bool {
    law.place == RodLawPlace::Sensor(channel) && law.is_static()
}
