//! A lab's own effects on a recording: candidates like those of the library.
//!
//! ```text
//! y + w·law(x, side; parameters)      w: what one unit of the place's result does to a reading
//! ```
//!
//! Places and variables are those of `laws/sites.rs`, so that what is proposed as a law can be
//! written down as an effect.

use std::sync::Arc;

use nalgebra::DVector;

use super::OwnEffect;
use super::law::OwnLaw;
use crate::diagnosis::rig::effects::entry::{Entry, candidate};
use crate::diagnosis::rig::effects::places::measured_channels;
use crate::diagnosis::rig::laws::measures::place_in_file;
use crate::diagnosis::rig::laws::sites::sites;
use crate::diagnosis::rig::mechanics::action::Action;
use crate::diagnosis::rig::model::RigModel;
use crate::error::{Error, Place, Result};
use crate::inference::law::Site;
use crate::inference::{Key, Location, Part};
use crate::rod::RodLawPlace;

/// The candidate that an effect is for a recording; `None` where the recording has no data for it.
///
/// # Errors
/// [`Error::Input`] for a place that rod and readings do not have, and for a law that is not 0
/// at its neutral values, or no number beside them.
pub fn entry(effect: &OwnEffect, model: &RigModel) -> Result<Option<Entry>> {
    let all = sites(model, &DVector::zeros(model.data().len()));
    let channels = measured_channels(model.data());
    let at_place = |site: &&Site| is_at(&effect.place, &site.location);
    if !all.iter().any(|site| at_place(&site)) && !all.is_empty() {
        let mut known: Vec<String> = all
            .iter()
            .filter_map(|site| place_in_file(&site.location))
            .map(|place| place.to_string())
            .collect();
        known.sort();
        known.dedup();
        return Err(wrong(&effect.at.0, format!("`place` is \"{}\"", effect.place), known.join(", ")));
    }
    let variable = effect.variable.measure();
    let own = all.iter().filter(at_place).filter(|site| site.variable == variable).find_map(|site| {
        // a law of all sensors has a direction for each that was read
        let direction = match (&site.location, &effect.place) {
            (Location::Part(Part::Sensors), RodLawPlace::Sensor(own)) => {
                channels.iter().position(|channel| channel == own)?
            }
            _ => 0,
        };
        Some((site, &site.directions.get(direction)?.1))
    });
    let Some((site, weights)) = own else { return Ok(None) };
    let data = site.concerned().filter(|&i| weights[i] != 0.0).map(|i| {
        let side = site.moves.get(i).copied().unwrap_or(1.0);
        (i, site.values[i] / site.variable.si, side, weights[i] * site.result.si)
    });
    let neutral = effect.parameters.iter().map(|parameter| parameter.neutral).collect();
    let names = effect.parameters.iter().map(|parameter| parameter.name.clone());
    let memory = effect.memory.map(|memory| (memory, site.clone(), names.collect()));
    let law = Arc::new(OwnLaw { law: effect.law.clone(), neutral, data: data.collect(), memory });
    check(effect, &law)?;
    let location = Location::from(Key::new(effect.effect.name).rows(effect.place.to_string()));
    let actions = (0..effect.parameters.len()).map(|k| Action::Own(Arc::clone(&law), k)).collect();
    Ok(Some((candidate(effect.effect, location, effect.parameters.clone()), actions)))
}

fn is_at(place: &RodLawPlace, location: &Location) -> bool {
    match location {
        // offsets of all channels, each by itself
        Location::Part(Part::Sensors) => matches!(place, RodLawPlace::Sensor(_)),
        other => place_in_file(other).as_ref() == Some(place),
    }
}

/// Nothing at the neutral values, and numbers once the first parameter is there.
fn check(effect: &OwnEffect, law: &OwnLaw) -> Result<()> {
    let mut values = vec![0.0; 2];
    values.extend(&law.neutral);
    for &(_, x, side, _) in &law.data {
        (values[0], values[1]) = (x, side);
        values[2] = law.neutral[0] + effect.parameters[0].size;
        if !law.law.at(&values).is_finite() {
            let found = format!("`law` is no number at the variable {x}");
            return Err(wrong(&effect.at.1, found, "a formula that is defined for every reading"));
        }
        values[2] = law.neutral[0];
        let nothing = law.law.at(&values);
        if nothing != 0.0 {
            let found = format!("`law` is {nothing} at the variable {x} with neutral parameters");
            return Err(wrong(&effect.at.1, found, "0 there: its first parameter as a factor"));
        }
    }
    Ok(())
}

fn wrong(at: &Place, found: String, expected: impl Into<String>) -> Error {
    Error::Input { at: at.clone(), found, expected: expected.into(), hint: None }
}
