//! The nominal numbers of a rod, one by one: what each is, how well it is known, and the rod with
//! another value of it.
//!
//! Whoever compares a model with readings differentiates the compliance by these numbers, and
//! weighs each with its standard uncertainty before calling a difference a mismatch.

mod derivative;
mod number;
#[cfg(test)]
mod tests;

use self::number::ChangeUnit;
pub use self::number::{Feature, NominalNumber, Part, SectionConstant};
use super::{BendFlexibility, Joint, Pipe, Rod};
use crate::dual::Number;
use crate::material::Material;
use crate::material::laminate::Ply;
use crate::section::Section;

/// A nominal number with its value.
#[derive(Debug, Clone, PartialEq)]
#[non_exhaustive]
pub struct Nominal {
    /// Which number.
    pub number: NominalNumber,
    /// One standard deviation, in SI units; above 0.
    pub standard_uncertainty: f64,
    /// As the rod has it, in SI units.
    pub value: f64,
}

/// What sits within this distance of the flange, an end of the bend or the tip belongs to it, m.
const SAME_PLACE: f64 = 1e-6;

impl Nominal {
    /// Unit of the number for people, what one of it is in SI, and its value in SI; of what is
    /// known to a share the unit is a percent of the value.
    pub fn for_people(&self) -> (&'static str, f64, f64) {
        let si = 1.0 / self.number.in_unit(1.0, self.value);
        match self.number.change_unit() {
            ChangeUnit::Percent => ("%", si, 100.0 * si),
            ChangeUnit::Gram => ("g", si, self.value),
            ChangeUnit::Millimetre => ("mm", si, self.value),
        }
    }
}

impl Rod {
    /// The numbers of this rod that have a standard uncertainty above 0, in the order of the rod
    /// file.
    ///
    /// Of a part that the rod does not have (a bend without radius, a tip without mass) there are
    /// none. A joint or a mass at the flange, at the corner, at an end of the bend or at the tip
    /// belongs to that place: it has no station of its own.
    ///
    /// ```
    /// use rodcal::prelude::*;
    ///
    /// let rod = Rod::read("rods/5.toml".as_ref())?;
    /// let first = rod.nominal_numbers().remove(0);
    /// assert_eq!(first.number.to_string(), "l1");
    /// assert_eq!((first.value, first.standard_uncertainty), (0.150, 0.3e-3));
    /// # Ok::<(), rodcal::Error>(())
    /// ```
    pub fn nominal_numbers(&self) -> Vec<Nominal> {
        let known = |number: NominalNumber| {
            let value = self.value_of(&number)?;
            let standard_uncertainty = self.uncertainty_of(&number, value);
            Some(Nominal { number, standard_uncertainty, value })
        };
        self.all_numbers().into_iter().filter_map(known).filter(|n| n.standard_uncertainty > 0.0).collect()
    }

    /// All numbers of this rod that its beam model depends on, however well they are known, in the
    /// order of the rod file; of parts and places as [`Rod::nominal_numbers`]. What sits at one
    /// station is one thing, whose station is named once.
    pub fn numbers(&self) -> Vec<NominalNumber> {
        let mut stations: Vec<f64> = Vec::new();
        let mut is_new = |number: &NominalNumber| {
            let NominalNumber::Station(_) = number else { return true };
            let station = self.value_of(number).unwrap_or(f64::NAN);
            let is_new = stations.iter().all(|known| (known - station).abs() > SAME_PLACE);
            stations.push(station);
            is_new
        };
        self.all_numbers().into_iter().filter(|number| is_new(number)).collect()
    }

    fn all_numbers(&self) -> Vec<NominalNumber> {
        let mut numbers = vec![NominalNumber::LengthL1, NominalNumber::LengthL2, NominalNumber::Angle];
        if self.bend_radius > 0.0 {
            numbers.push(NominalNumber::BendRadius);
            if matches!(self.bend_flexibility, BendFlexibility::Factor(_)) {
                numbers.push(NominalNumber::BendFactor);
            }
        }
        let mut known: Vec<&str> = Vec::new();
        for (_, pipe) in self.parts() {
            let name = pipe.material.name.as_str();
            if known.contains(&name) {
                continue;
            }
            known.push(name);
            let name = || name.to_owned();
            numbers.extend([
                NominalNumber::YoungsModulus(name()),
                NominalNumber::ShearModulus(name()),
                NominalNumber::Density(name()),
                NominalNumber::ShearCoefficient(name()),
                NominalNumber::PoissonRatio(name()),
            ]);
        }
        for (part, pipe) in self.parts() {
            if part != Part::Bend || pipe.section != self.pipe1.section {
                numbers.extend(of_section(part, &pipe.section));
            }
        }
        if self.tip_mass > 0.0 {
            numbers.push(NominalNumber::TipMass);
        }
        let places = self.places();
        let is_free = |station: f64| places.iter().all(|place| (place - station).abs() > SAME_PLACE);
        let mut features: Vec<Feature> = Vec::new();
        let masses = self.masses.iter().filter(|mass| is_free(mass.station));
        let joints = self.joints.iter().filter(|joint| is_free(joint.station));
        let all = masses
            .map(|mass| Feature::Mass(mass.name.clone()))
            .chain(joints.map(|joint| Feature::Joint(joint.name.clone())))
            .chain(self.sleeves.iter().enumerate().flat_map(|(k, sleeve)| {
                let ends = [(Feature::SleeveFrom(k), sleeve.from), (Feature::SleeveTo(k), sleeve.to)];
                ends.into_iter().filter(|(_, station)| is_free(*station)).map(|(feature, _)| feature)
            }));
        for feature in all {
            if !features.contains(&feature) {
                features.push(feature);
            }
        }
        numbers.extend(features.into_iter().map(NominalNumber::Station));
        let mut more = |all: Vec<NominalNumber>| {
            all.into_iter().for_each(|number| {
                if !numbers.contains(&number) {
                    numbers.push(number);
                }
            })
        };
        for mass in &self.masses {
            more(vec![NominalNumber::Mass(mass.name.clone())]);
        }
        for joint in &self.joints {
            let name = || joint.name.clone();
            more(vec![NominalNumber::JointBending(name()), NominalNumber::JointTorsion(name())]);
        }
        numbers
    }
}

impl<T: Number> Rod<T> {
    /// The value of a number, SI; `None` where this rod has no such number.
    pub fn value_of(&self, number: &NominalNumber) -> Option<T> {
        let material = |name: &str| {
            self.parts().into_iter().map(|(_, pipe)| &pipe.material).find(|material| material.name == name)
        };
        match number {
            NominalNumber::YoungsModulus(name) => Some(material(name)?.youngs_modulus),
            NominalNumber::ShearModulus(name) => Some(material(name)?.shear_modulus),
            NominalNumber::Density(name) => Some(material(name)?.density),
            NominalNumber::ShearCoefficient(name) => Some(material(name)?.shear_coefficient_factor),
            NominalNumber::OuterDiameter(part)
            | NominalNumber::InnerDiameter(part)
            | NominalNumber::Width(part)
            | NominalNumber::Height(part)
            | NominalNumber::Wall(part)
            | NominalNumber::Section(part, _) => {
                let mut section = self.part(*part)?.section;
                match (&section, number) {
                    (Section::Round(round), NominalNumber::Wall(_)) => Some(round.wall()),
                    _ => dimension(&mut section, number).copied(),
                }
            }
            NominalNumber::LengthL1 => Some(self.l1),
            NominalNumber::LengthL2 => Some(self.l2),
            NominalNumber::BendRadius => Some(self.bend_radius),
            NominalNumber::Station(Feature::Joint(name)) => self.joint(name).map(|joint| joint.station),
            NominalNumber::Station(Feature::Mass(name)) => {
                self.masses.iter().find(|mass| mass.name == *name).map(|mass| mass.station)
            }
            NominalNumber::Station(Feature::SleeveFrom(k)) => self.sleeves.get(*k).map(|own| own.from),
            NominalNumber::Station(Feature::SleeveTo(k)) => self.sleeves.get(*k).map(|own| own.to),
            NominalNumber::TipMass => Some(self.tip_mass),
            NominalNumber::Angle => Some(self.gamma),
            NominalNumber::PoissonRatio(name) => Some(material(name)?.poisson_ratio),
            NominalNumber::BendFactor => match self.bend_flexibility {
                BendFlexibility::Factor(factor) => Some(factor),
                BendFlexibility::Beam | BendFlexibility::VonKarman | BendFlexibility::AsmeB313 => None,
            },
            NominalNumber::Mass(name) => {
                self.masses.iter().find(|mass| mass.name == *name).map(|mass| mass.mass)
            }
            NominalNumber::JointBending(name) => self.joint(name).map(|joint| joint.bending),
            NominalNumber::JointTorsion(name) => self.joint(name).map(|joint| joint.torsion),
            // E, G and ν are what a beam knows of them
            NominalNumber::Ply(..) => None,
        }
    }

    /// Laminates of the rod, by name, with their plies; each once.
    pub fn plies(&self) -> impl Iterator<Item = (&str, &[Ply])> {
        let mut known: Vec<&str> = Vec::new();
        self.parts().into_iter().filter_map(move |(_, pipe)| {
            let (name, plies) = (pipe.material.name.as_str(), pipe.material.plies.as_deref()?);
            let is_new = !known.contains(&name);
            known.push(name);
            is_new.then_some((name, plies))
        })
    }

    /// This rod with another `value` (SI) of one number, all else equal. A number that the rod does
    /// not have changes nothing.
    ///
    /// Pipes that share a material but not its values (after a correction) keep their ratio.
    /// Changing L1, L2 or the bend's radius takes along what sits at the corner, at the ends of the
    /// bend and at the tip; all other stations stay where they are, as far as they are still on the
    /// rod. A diameter of pipe 1 is also the bend's where the two are one tube.
    ///
    /// The value is not checked: [`Rod::checked`] does.
    pub fn with(&self, number: &NominalNumber, value: T) -> Rod<T> {
        let mut rod = self.clone();
        let Some(nominal) = self.value_of(number) else { return rod };
        let mut of_material = |name: &str, field: fn(&mut Material<T>) -> &mut T| {
            for pipe in rod.pipes_mut() {
                if pipe.material.name == name {
                    let own = field(&mut pipe.material);
                    *own = if *own == nominal { value } else { *own * (value / nominal) };
                }
            }
        };
        match number {
            NominalNumber::YoungsModulus(name) => of_material(name, |m| &mut m.youngs_modulus),
            NominalNumber::ShearModulus(name) => of_material(name, |m| &mut m.shear_modulus),
            NominalNumber::Density(name) => of_material(name, |m| &mut m.density),
            NominalNumber::ShearCoefficient(name) => {
                of_material(name, |m| &mut m.shear_coefficient_factor);
            }
            NominalNumber::OuterDiameter(part)
            | NominalNumber::InnerDiameter(part)
            | NominalNumber::Width(part)
            | NominalNumber::Height(part)
            | NominalNumber::Wall(part)
            | NominalNumber::Section(part, _) => {
                let is_one_tube = self.bend.section == self.pipe1.section;
                let own = match part {
                    Part::Pipe1 => &mut rod.pipe1,
                    Part::Bend => &mut rod.bend,
                    Part::Pipe2 => &mut rod.pipe2,
                    // it is there: its value was found
                    Part::Sleeve(k) => &mut rod.sleeves[*k].pipe,
                };
                match (&mut own.section, number) {
                    // a tube's outer diameter stays
                    (Section::Round(round), NominalNumber::Wall(_)) => {
                        round.inner_diameter = round.outer_diameter - value * 2.0;
                    }
                    (section, _) => dimension(section, number).into_iter().for_each(|own| *own = value),
                }
                if *part == Part::Pipe1 && is_one_tube {
                    rod.bend.section = rod.pipe1.section;
                }
            }
            NominalNumber::LengthL1 => rod.l1 = value,
            NominalNumber::LengthL2 => rod.l2 = value,
            NominalNumber::BendRadius => rod.bend_radius = value,
            NominalNumber::Station(Feature::Joint(name)) => {
                let own = rod.joints.iter_mut().filter(|joint| joint.name == *name);
                own.for_each(|joint| joint.station += value - nominal);
            }
            NominalNumber::Station(Feature::Mass(name)) => {
                let own = rod.masses.iter_mut().filter(|mass| mass.name == *name);
                own.for_each(|mass| mass.station += value - nominal);
            }
            NominalNumber::Station(Feature::SleeveFrom(k)) => rod.sleeves[*k].from = value,
            NominalNumber::Station(Feature::SleeveTo(k)) => rod.sleeves[*k].to = value,
            NominalNumber::TipMass => rod.tip_mass = value,
            NominalNumber::Angle => rod.gamma = value,
            NominalNumber::PoissonRatio(name) => of_material(name, |m| &mut m.poisson_ratio),
            NominalNumber::BendFactor => rod.bend_flexibility = BendFlexibility::Factor(value),
            NominalNumber::Mass(name) => {
                let own = rod.masses.iter_mut().filter(|mass| mass.name == *name);
                own.for_each(|mass| mass.mass += value - nominal);
            }
            NominalNumber::JointBending(name) => {
                let own = rod.joints.iter_mut().filter(|joint| joint.name == *name);
                own.for_each(|joint| joint.bending += value - nominal);
            }
            NominalNumber::JointTorsion(name) => {
                let own = rod.joints.iter_mut().filter(|joint| joint.name == *name);
                own.for_each(|joint| joint.torsion += value - nominal);
            }
            // it has no value here, and so did not come so far
            NominalNumber::Ply(..) => {}
        }
        let (before, after, length) = (self.places(), rod.places(), rod.length());
        let on_rod = |station: T| station.larger(T::zero()).smaller(length.larger(T::zero()));
        let kept = |station: T| {
            let is_here = |place: &T| (*place - station).value().abs() <= SAME_PLACE;
            let here = before.iter().zip(after).find(|(place, _)| is_here(place));
            on_rod(here.map_or(station, |(_, moved)| moved))
        };
        let is_length = matches!(
            number,
            NominalNumber::LengthL1
                | NominalNumber::LengthL2
                | NominalNumber::BendRadius
                | NominalNumber::Angle
        );
        for station in rod.stations_mut() {
            *station = if is_length { kept(*station) } else { on_rod(*station) };
        }
        rod
    }

    /// Flange, both ends of the bend (or the corner, twice) and tip, stations in m.
    fn places(&self) -> [T; 4] {
        [T::zero(), self.bend_start(), self.bend_end(), self.length()]
    }

    /// The pipe of a part, where the rod has one.
    pub fn part(&self, part: Part) -> Option<&Pipe<T>> {
        match part {
            Part::Pipe1 => Some(&self.pipe1),
            Part::Bend => Some(&self.bend),
            Part::Pipe2 => Some(&self.pipe2),
            Part::Sleeve(k) => self.sleeves.get(k).map(|sleeve| &sleeve.pipe),
        }
    }

    /// The parts from the flange on, then the sleeves; the bend only where it has a length.
    fn parts(&self) -> Vec<(Part, &Pipe<T>)> {
        let bend = (self.bend_radius.value() > 0.0).then_some((Part::Bend, &self.bend));
        let sleeves = self.sleeves.iter().enumerate().map(|(k, sleeve)| (Part::Sleeve(k), &sleeve.pipe));
        let pipes = [(Part::Pipe1, &self.pipe1)].into_iter().chain(bend).chain([(Part::Pipe2, &self.pipe2)]);
        pipes.chain(sleeves).collect()
    }

    fn joint(&self, name: &str) -> Option<&Joint<T>> {
        self.joints.iter().find(|joint| joint.name == name)
    }
}

impl Rod {
    /// One standard deviation of a number of this `value`, SI.
    fn uncertainty_of(&self, number: &NominalNumber, value: f64) -> f64 {
        let material = |name: &str| {
            let all = self.parts();
            let found = all.iter().find(|(_, pipe)| pipe.material.name == *name);
            found.map_or(&self.pipe1.material, |(_, pipe)| &pipe.material).standard_uncertainty
        };
        let own = &self.standard_uncertainty;
        match number {
            NominalNumber::YoungsModulus(name) => material(name).youngs_modulus * value,
            NominalNumber::ShearModulus(name) => material(name).shear_modulus * value,
            NominalNumber::Density(name) => material(name).density * value,
            NominalNumber::ShearCoefficient(name) => material(name).shear_coefficient * value,
            NominalNumber::OuterDiameter(_)
            | NominalNumber::InnerDiameter(_)
            | NominalNumber::Width(_)
            | NominalNumber::Height(_)
            | NominalNumber::Wall(_) => own.diameter,
            NominalNumber::Section(_, SectionConstant::ShearCoefficient) => 0.0,
            NominalNumber::Section(..) => own.section * value,
            NominalNumber::LengthL1
            | NominalNumber::LengthL2
            | NominalNumber::BendRadius
            | NominalNumber::Station(_) => own.length,
            NominalNumber::TipMass => own.tip_mass,
            // what the file has no standard uncertainty for is taken to be as stated
            NominalNumber::Angle
            | NominalNumber::PoissonRatio(_)
            | NominalNumber::BendFactor
            | NominalNumber::Mass(_)
            | NominalNumber::JointBending(_)
            | NominalNumber::JointTorsion(_)
            | NominalNumber::Ply(..) => 0.0,
        }
    }
}

/// The numbers of a section. A bore of 0 is exact: a solid round has none.
fn of_section(part: Part, section: &Section) -> Vec<NominalNumber> {
    match section {
        Section::Round(round) => {
            let bore = (round.inner_diameter > 0.0).then_some(NominalNumber::InnerDiameter(part));
            [NominalNumber::OuterDiameter(part)].into_iter().chain(bore).collect()
        }
        Section::Rectangle(rectangle) => {
            let wall = rectangle.wall.map(|_| NominalNumber::Wall(part));
            [NominalNumber::Width(part), NominalNumber::Height(part)].into_iter().chain(wall).collect()
        }
        Section::General(_) => [
            SectionConstant::Area,
            SectionConstant::Iy,
            SectionConstant::Iz,
            SectionConstant::TorsionConstant,
            SectionConstant::ShearCoefficient,
        ]
        .map(|constant| NominalNumber::Section(part, constant))
        .to_vec(),
    }
}

/// The field of `section` that `number` names, where the section has it.
fn dimension<'s, T: Number>(section: &'s mut Section<T>, number: &NominalNumber) -> Option<&'s mut T> {
    let (round, rectangle, general) = match section {
        Section::Round(round) => (Some(round), None, None),
        Section::Rectangle(rectangle) => (None, Some(rectangle), None),
        Section::General(general) => (None, None, Some(general)),
    };
    match number {
        NominalNumber::OuterDiameter(_) => round.map(|round| &mut round.outer_diameter),
        NominalNumber::InnerDiameter(_) => round.map(|round| &mut round.inner_diameter),
        NominalNumber::Width(_) => rectangle.map(|rectangle| &mut rectangle.width),
        NominalNumber::Height(_) => rectangle.map(|rectangle| &mut rectangle.height),
        NominalNumber::Wall(_) => rectangle.and_then(|rectangle| rectangle.wall.as_mut()),
        NominalNumber::Section(_, constant) => general.map(|general| match constant {
            SectionConstant::Area => &mut general.area,
            SectionConstant::Iy => &mut general.iy,
            SectionConstant::Iz => &mut general.iz,
            SectionConstant::TorsionConstant => &mut general.torsion_constant,
            SectionConstant::ShearCoefficient => &mut general.shear_coefficient,
        }),
        NominalNumber::YoungsModulus(_)
        | NominalNumber::ShearModulus(_)
        | NominalNumber::Density(_)
        | NominalNumber::ShearCoefficient(_)
        | NominalNumber::LengthL1
        | NominalNumber::LengthL2
        | NominalNumber::BendRadius
        | NominalNumber::Station(_)
        | NominalNumber::TipMass
        | NominalNumber::Angle
        | NominalNumber::PoissonRatio(_)
        | NominalNumber::BendFactor
        | NominalNumber::Mass(_)
        | NominalNumber::JointBending(_)
        | NominalNumber::JointTorsion(_)
        | NominalNumber::Ply(..) => None,
    }
}
