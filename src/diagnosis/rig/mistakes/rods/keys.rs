//! Keys of the rod file in another unit, or a radius for a diameter; stations in another unit.

use super::workshop::is_possible;
use crate::diagnosis::rig::effects::mistakes::UNIT_MISTAKE;
use crate::diagnosis::rig::mistakes::labels::BESIDE;
use crate::diagnosis::rig::mistakes::possible::{PossibleMistake, exact};
use crate::diagnosis::rig::mistakes::relabelling::Relabelling;
use crate::inference::Key;
use crate::rod::{Pipe, Rod};
use crate::section::Section;
use crate::units::significant;

/// What a key holds instead of what its name says.
#[derive(Clone, Copy)]
pub(super) struct OtherUnit {
    /// True value over the one that was read.
    factor: f64,
    holds: Holds,
    log_prior: f64,
}

/// How that is said.
#[derive(Clone, Copy)]
enum Holds {
    /// A unit, and the key's own: `metres`, `millimetres`.
    Unit(&'static str, &'static str),
    /// A radius where a diameter belongs.
    Radius,
}

const fn of_length(factor: f64, unit: &'static str, log_prior: f64) -> OtherUnit {
    OtherUnit { factor, holds: Holds::Unit(unit, "millimetres"), log_prior }
}

const fn of_modulus(factor: f64, unit: &'static str, log_prior: f64) -> OtherUnit {
    OtherUnit { factor, holds: Holds::Unit(unit, "gigapascals"), log_prior }
}

const LENGTHS: [OtherUnit; 5] = [
    of_length(1e3, "metres", -0.5),
    of_length(25.4, "inches", -0.5),
    of_length(10.0, "centimetres", -1.0),
    of_length(1e-3, "micrometres", -2.0),
    of_length(0.1, "tenths of a millimetre", -2.5),
];
const RADIUS: OtherUnit = OtherUnit { factor: 2.0, holds: Holds::Radius, log_prior: -0.5 };
const MODULI: [OtherUnit; 4] = [
    of_modulus(1e-3, "megapascals", -0.5),
    of_modulus(1e-9, "pascals", -0.5),
    of_modulus(6.894_757, "Msi (10⁶ psi)", -0.5),
    of_modulus(1e3, "terapascals", -2.0),
];
const RADIANS: OtherUnit = OtherUnit {
    factor: 180.0 / std::f64::consts::PI,
    holds: Holds::Unit("radians", "degrees"),
    log_prior: 0.0,
};
/// How usual it is that of the diameters in one file the outer ones alone, or the inner ones, are
/// in another unit: ln.
const EITHER_DIAMETER: f64 = -4.0;
/// A key is right more often than a column: ln.
pub(super) const KEY: f64 = -0.5;

/// Columns of the stations of load and sensor.
const STATIONS: [&str; 2] = ["load_station_mm", "read_station_mm"];

impl OtherUnit {
    /// That these keys hold it, `rarer` (ln) than a column would.
    pub fn mistake(&self, keys: &[String], rarer: f64) -> PossibleMistake {
        let location = Key::new(keys.join(", "));
        let is_one = keys.len() == 1;
        let looks = if is_one { "looks as if it were" } else { "look as if they were" };
        PossibleMistake {
            effect: &UNIT_MISTAKE,
            observed: format!("{location} {}: {}", self.is_in(is_one), self.cure(is_one)),
            or_else: None,
            looks_like: format!("{location} {looks} in another unit"),
            location,
            relabelling: Relabelling::default(),
            log_prior: self.log_prior + rarer,
            estimates: vec![exact("factor", self.factor)],
            within: BESIDE,
        }
    }

    /// `are radii, not diameters`.
    fn is_in(&self, is_one: bool) -> String {
        let verb = if is_one { "is" } else { "are" };
        match self.holds {
            Holds::Radius if is_one => "is a radius, not a diameter".into(),
            Holds::Radius => "are radii, not diameters".into(),
            Holds::Unit(unit, own) => format!("{verb} in {unit}, not in {own}"),
        }
    }

    fn cure(&self, is_one: bool) -> String {
        let it = if is_one { "it" } else { "them" };
        let number = |x: f64| if x.fract() == 0.0 { format!("{x}") } else { significant(x, 5) };
        match self.factor >= 1.0 {
            true => format!("multiply {it} by {}", number(self.factor)),
            false => format!("divide {it} by {}", number((1.0 / self.factor).round())),
        }
    }
}

/// Stations of loads (0) or of sensors (1) in other units, with the factor on them.
pub(super) fn station_units(k: usize) -> impl Iterator<Item = (f64, PossibleMistake)> {
    let column = [STATIONS[k].to_owned()];
    LENGTHS.into_iter().map(move |unit| (unit.factor, unit.mistake(&column, 0.0)))
}

/// Keys that may be in another unit, and the rod that was meant.
pub(super) struct Meant {
    pub keys: Vec<String>,
    pub unit: OtherUnit,
    pub rod: Rod,
}

/// All rods that may have been meant.
pub(super) fn in_other_units(rod: &Rod) -> Vec<Meant> {
    let mut found: Vec<Meant> = Vec::new();
    let mut add = |keys: &[&str], unit: OtherUnit, meant: Rod| {
        let keys = keys.iter().map(|key| (*key).to_owned()).collect();
        found.push(Meant { keys, unit, rod: meant });
    };
    for unit in LENGTHS {
        let factor = unit.factor;
        for (l1, l2, keys) in
            [(factor, 1.0, &["l1_mm"][..]), (1.0, factor, &["l2_mm"]), (factor, factor, &["l1_mm", "l2_mm"])]
        {
            add(keys, unit, Rod { l1: rod.l1 * l1, l2: rod.l2 * l2, ..rod.clone() });
        }
        if rod.bend_radius > 0.0 {
            add(&["bend_radius_mm"], unit, Rod { bend_radius: rod.bend_radius * factor, ..rod.clone() });
        }
    }
    if rod.gamma.to_degrees() <= std::f64::consts::PI + 1e-3 {
        add(&["gamma_deg"], RADIANS, Rod { gamma: rod.gamma * RADIANS.factor, ..rod.clone() });
    }
    found.extend(diameters_in_other_units(rod));
    found.extend(moduli_in_other_units(rod));
    found.retain(|meant| is_possible(&meant.rod));
    found
}

fn moduli_in_other_units(rod: &Rod) -> Vec<Meant> {
    let mut found = Vec::new();
    let mut materials: Vec<&str> = vec![&rod.pipe1.material.name];
    for pipe in std::iter::once(&rod.pipe2).chain(rod.sleeves.iter().map(|sleeve| &sleeve.pipe)) {
        if !materials.contains(&pipe.material.name.as_str()) {
            materials.push(&pipe.material.name);
        }
    }
    for material in materials {
        for unit in MODULI {
            let factor = unit.factor;
            for (e, g, key) in [
                (factor, factor, "youngs_modulus_gpa"),
                (factor, 1.0, "youngs_modulus_gpa"),
                (1.0, factor, "shear_modulus_gpa"),
            ] {
                let mut meant = rod.clone();
                for pipe in meant.pipes_mut() {
                    if pipe.material.name == material {
                        pipe.material.youngs_modulus *= e;
                        pipe.material.shear_modulus *= g;
                    }
                }
                found.push(Meant { keys: vec![format!("material.{material}.{key}")], unit, rod: meant });
            }
        }
    }
    found
}

/// Diameters of tubes; other sections have other keys.
fn diameters_in_other_units(rod: &Rod) -> Vec<Meant> {
    let mut found = Vec::new();
    if [&rod.pipe1, &rod.bend, &rod.pipe2].iter().any(|pipe| pipe.section.as_round().is_none()) {
        return found;
    }
    let is_solid = |pipe: &Pipe| pipe.section.as_round().is_some_and(|round| round.inner_diameter == 0.0);
    for unit in LENGTHS.into_iter().chain([RADIUS]) {
        let factor = unit.factor;
        for pipes in [[true, true], [true, false], [false, true]] {
            for (outer, inner) in [(factor, factor), (factor, 1.0), (1.0, factor)] {
                if outer != inner && [&rod.pipe1, &rod.pipe2].iter().any(|pipe| is_solid(pipe)) {
                    continue;
                }
                let rarer = if outer == inner { 0.0 } else { EITHER_DIAMETER };
                let unit = OtherUnit { log_prior: unit.log_prior + rarer, ..unit };
                let rescaled = |pipe: &Pipe| {
                    let mut pipe = pipe.clone();
                    if let Section::Round(round) = &mut pipe.section {
                        round.outer_diameter *= outer;
                        round.inner_diameter *= inner;
                    }
                    pipe
                };
                let mut meant = rod.clone();
                let mut keys = Vec::new();
                for (pipe, name) in [(&mut meant.pipe1, "pipe1"), (&mut meant.pipe2, "pipe2")] {
                    if !pipes[usize::from(name == "pipe2")] {
                        continue;
                    }
                    *pipe = rescaled(pipe);
                    let wrong = [(outer, "outer"), (inner, "inner")];
                    let is_solid = is_solid(pipe);
                    let wrong =
                        wrong.into_iter().filter(|(f, which)| *f != 1.0 && !(is_solid && *which == "inner"));
                    keys.extend(wrong.map(|(_, which)| format!("{name}.{which}_diameter_mm")));
                }
                // the bend is pipe 1's unless the file says otherwise
                if pipes[0] && rod.bend.section == rod.pipe1.section {
                    meant.bend = rescaled(&rod.bend);
                }
                found.push(Meant { keys, unit, rod: meant });
            }
        }
    }
    found
}
