//! Readings without what the laws of the rod's file add to them: what is left is linear.

use nalgebra::{Matrix3, Vector3};

use super::readings::{Axis, Readings};
use crate::beam::{Physics, RodModel};
use crate::compliance::StaticLaws;
use crate::error::Result;
use crate::rod::law::should_show;
use crate::rod::{Rod, RodLaw, RodLawPlace};
use crate::units::UM;

/// The rod between what is loaded and what is read.
struct Between {
    stations: (f64, f64),
    /// From the one to the other, and where the load acts, m/N.
    compliance: [Matrix3<f64>; 2],
    laws: StaticLaws,
}

impl Between {
    fn new(rod: &Rod, physics: &Physics, elements: usize, stations: (f64, f64)) -> Result<Between> {
        let (load, read) = stations;
        let model = RodModel::new(rod, physics, elements, &[load, read])?;
        let from_load = |to| model.force_response(load, to).map(|response| response.translation);
        let compliance = [from_load(read)?, from_load(load)?];
        Ok(Between { stations, compliance, laws: StaticLaws::between(rod, load, read) })
    }
}

/// The readings less all laws that the load alone decides on.
///
/// # Errors
/// What the beam model refuses.
pub fn without_laws(readings: &Readings, rod: &Rod, physics: &Physics, elements: usize) -> Result<Readings> {
    let mut without = readings.clone();
    let tip = rod.length();
    let at = |station: Option<f64>| station.unwrap_or(tip).min(tip);
    let mut known: Vec<Between> = Vec::new();
    for row in &mut without.rows {
        for channel in Axis::ALL {
            let laws = rod.laws.iter().filter(|law| is_read_by(law, channel));
            if let Some(offset) = &mut row.offset[channel.index()] {
                laws.for_each(|law| *offset = UM * should_show(*offset / UM, |y| law.at(y, 1.0)));
            }
        }
        let stations = (at(row.load_station), at(row.read_station));
        let place = match known.iter().position(|own| own.stations == stations) {
            Some(place) => place,
            None => {
                known.push(Between::new(rod, physics, elements, stations)?);
                known.len() - 1
            }
        };
        let Between { compliance, laws, .. } = &known[place];
        let force = Vector3::ith(row.direction.axis.index(), f64::from(row.direction.sign) * row.load);
        let more = laws.displacement_between([&compliance[0], &compliance[1]], &force, &Vector3::zeros());
        for (offset, more) in row.offset.iter_mut().zip(more.iter()) {
            *offset = offset.map(|offset| offset - more);
        }
    }
    Ok(without)
}

fn is_read_by(law: &RodLaw, channel: Axis) -> bool {
    law.place == RodLawPlace::Sensor(channel) && law.is_static()
}
