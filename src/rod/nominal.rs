//! The nominal numbers of a rod, one by one: what each is, how well it is known, and the rod with
//! another value of it.
//!
//! Whoever compares a model with readings differentiates the compliance by these numbers, and
//! weighs each with its standard uncertainty before calling a difference a mismatch.

use std::fmt;

use super::{Pipe, Rod};
use crate::material::Material;
use crate::section::Section;
use crate::units::{GRAM, MM};

/// A number of the rod file that is known within a standard uncertainty.
///
/// ```
/// use rodcal::prelude::*;
/// use rodcal::rod::NominalNumber;
///
/// let rod = Rod::read("rods/5.toml".as_ref())?;
/// let number = NominalNumber::YoungsModulus("steel".into());
/// let compliance = |rod: &Rod| Compliance::of_model(rod, &Physics::default(), 10);
/// // the tip gives way by 1/E, but for torsion and shear
/// let softer = compliance(&rod.with(&number, 0.99 * 193e9))?;
/// let ratio = softer.force[(2, 2)] / compliance(&rod)?.force[(2, 2)];
/// assert!((ratio - 1.0 / 0.99).abs() < 1e-4);
/// assert_eq!((number.to_string(), number.key()), ("E of steel".into(), "youngs_modulus_percent"));
/// # Ok::<(), rodcal::Error>(())
/// ```
#[derive(Debug, Clone, PartialEq, Eq, Hash, PartialOrd, Ord)]
#[non_exhaustive]
pub enum NominalNumber {
    /// E of the material of this name, Pa, in every pipe made of it.
    YoungsModulus(String),
    /// G of the material of this name, Pa, in every pipe made of it.
    ShearModulus(String),
    /// ρ of the material of this name, kg/m³, in every pipe made of it.
    Density(String),
    /// What multiplies κ of every section of the material of this name, dimensionless, nominally 1.
    ShearCoefficient(String),
    /// Outer diameter of a tube or a round, m.
    OuterDiameter(Part),
    /// Inner diameter of a tube, m.
    InnerDiameter(Part),
    /// Width of a rectangle, m.
    Width(Part),
    /// Height of a rectangle, m.
    Height(Part),
    /// Wall thickness of a box, m.
    Wall(Part),
    /// A constant of a general section, m² or m⁴.
    Section(Part, SectionConstant),
    /// Flange to corner, L1, m.
    LengthL1,
    /// Corner to ball centre, L2, m.
    LengthL2,
    /// Radius of the bend, m.
    BendRadius,
    /// Where a sleeve, a holder or a joint sits, m from the flange.
    Station(Feature),
    /// Ball and ball holder, kg.
    TipMass,
}

/// One of the three parts that have a section of their own.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, PartialOrd, Ord)]
pub enum Part {
    /// Flange to bend. The bend goes with it where it is the same tube.
    Pipe1,
    /// The bend, where it is another tube than pipe 1.
    Bend,
    /// Bend to tip.
    Pipe2,
}

/// A constant of a [`crate::section::General`] section.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, PartialOrd, Ord)]
pub enum SectionConstant {
    /// A.
    Area,
    /// I_y.
    Iy,
    /// I_z.
    Iz,
    /// J.
    TorsionConstant,
}

/// Something that sits at a station.
#[derive(Debug, Clone, PartialEq, Eq, Hash, PartialOrd, Ord)]
pub enum Feature {
    /// The joint of this name.
    Joint(String),
    /// The mass of this name; masses of one name go together.
    Mass(String),
}

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

impl NominalNumber {
    /// The key under which reports and JSON name it: the one of `[standard_uncertainty]` for what
    /// is stated in per cent, else that of the rod file, with its unit.
    pub fn key(&self) -> &'static str {
        match self {
            NominalNumber::YoungsModulus(_) => "youngs_modulus_percent",
            NominalNumber::ShearModulus(_) => "shear_modulus_percent",
            NominalNumber::Density(_) => "density_percent",
            NominalNumber::ShearCoefficient(_) => "shear_coefficient_percent",
            NominalNumber::OuterDiameter(_) => "outer_diameter_mm",
            NominalNumber::InnerDiameter(_) => "inner_diameter_mm",
            NominalNumber::Width(_) => "width_mm",
            NominalNumber::Height(_) => "height_mm",
            NominalNumber::Wall(_) => "wall_mm",
            NominalNumber::Section(_, SectionConstant::Area) => "area_percent",
            NominalNumber::Section(_, SectionConstant::Iy) => "iy_percent",
            NominalNumber::Section(_, SectionConstant::Iz) => "iz_percent",
            NominalNumber::Section(_, SectionConstant::TorsionConstant) => "j_percent",
            NominalNumber::LengthL1 => "l1_mm",
            NominalNumber::LengthL2 => "l2_mm",
            NominalNumber::BendRadius => "bend_radius_mm",
            NominalNumber::Station(_) => "station_mm",
            NominalNumber::TipMass => "mass_g",
        }
    }

    /// The table of the rod file it stands in, with the name where there is one: `material.steel`,
    /// `pipe1`, `geometry`, `joint.sleeve-a`, `tip`.
    pub fn place(&self) -> String {
        match self {
            NominalNumber::YoungsModulus(material)
            | NominalNumber::ShearModulus(material)
            | NominalNumber::Density(material)
            | NominalNumber::ShearCoefficient(material) => format!("material.{material}"),
            NominalNumber::OuterDiameter(part)
            | NominalNumber::InnerDiameter(part)
            | NominalNumber::Width(part)
            | NominalNumber::Height(part)
            | NominalNumber::Wall(part)
            | NominalNumber::Section(part, _) => part.key().to_owned(),
            NominalNumber::LengthL1 | NominalNumber::LengthL2 | NominalNumber::BendRadius => {
                "geometry".to_owned()
            }
            NominalNumber::Station(Feature::Joint(name)) => format!("joint.{name}"),
            NominalNumber::Station(Feature::Mass(name)) => format!("mass.{name}"),
            NominalNumber::TipMass => "tip".to_owned(),
        }
    }

    /// A change (SI) of this number from its `nominal` value (SI) in the unit of
    /// [`NominalNumber::key`]: per cent, mm or g.
    pub fn in_unit(&self, change: f64, nominal: f64) -> f64 {
        match self.key() {
            "mass_g" => change / GRAM,
            key if key.ends_with("_mm") => change / MM,
            _ => change / nominal * 100.0,
        }
    }
}

impl Part {
    /// Its table in the rod file.
    pub fn key(&self) -> &'static str {
        match self {
            Part::Pipe1 => "pipe1",
            Part::Bend => "bend",
            Part::Pipe2 => "pipe2",
        }
    }
}

impl fmt::Display for Part {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(match self {
            Part::Pipe1 => "pipe 1",
            Part::Bend => "the bend",
            Part::Pipe2 => "pipe 2",
        })
    }
}

impl fmt::Display for NominalNumber {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            NominalNumber::YoungsModulus(material) => write!(f, "E of {material}"),
            NominalNumber::ShearModulus(material) => write!(f, "G of {material}"),
            NominalNumber::Density(material) => write!(f, "density of {material}"),
            NominalNumber::ShearCoefficient(material) => write!(f, "shear coefficient of {material}"),
            NominalNumber::OuterDiameter(part) => write!(f, "outer diameter of {part}"),
            NominalNumber::InnerDiameter(part) => write!(f, "inner diameter of {part}"),
            NominalNumber::Width(part) => write!(f, "width of {part}"),
            NominalNumber::Height(part) => write!(f, "height of {part}"),
            NominalNumber::Wall(part) => write!(f, "wall of {part}"),
            NominalNumber::Section(part, SectionConstant::Area) => write!(f, "area of {part}"),
            NominalNumber::Section(part, SectionConstant::Iy) => write!(f, "I_y of {part}"),
            NominalNumber::Section(part, SectionConstant::Iz) => write!(f, "I_z of {part}"),
            NominalNumber::Section(part, SectionConstant::TorsionConstant) => write!(f, "J of {part}"),
            NominalNumber::LengthL1 => f.write_str("l1"),
            NominalNumber::LengthL2 => f.write_str("l2"),
            NominalNumber::BendRadius => f.write_str("bend radius"),
            NominalNumber::Station(Feature::Joint(name)) => write!(f, "station of joint {name}"),
            NominalNumber::Station(Feature::Mass(name)) => write!(f, "station of mass {name}"),
            NominalNumber::TipMass => f.write_str("tip mass"),
        }
    }
}

/// What sits within this distance of the flange, an end of the bend or the tip belongs to it, m.
const SAME_PLACE: f64 = 1e-6;

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
        let mut numbers = vec![NominalNumber::LengthL1, NominalNumber::LengthL2];
        if self.bend_radius > 0.0 {
            numbers.push(NominalNumber::BendRadius);
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
            .chain(joints.map(|joint| Feature::Joint(joint.name.clone())));
        for feature in all {
            if !features.contains(&feature) {
                features.push(feature);
            }
        }
        numbers.extend(features.into_iter().map(NominalNumber::Station));
        let known = |number: NominalNumber| {
            let value = self.value_of(&number)?;
            let standard_uncertainty = self.uncertainty_of(&number, value);
            Some(Nominal { number, standard_uncertainty, value })
        };
        numbers.into_iter().filter_map(known).filter(|n| n.standard_uncertainty > 0.0).collect()
    }

    /// The value of a number, SI; `None` where this rod has no such number.
    pub fn value_of(&self, number: &NominalNumber) -> Option<f64> {
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
                let mut section = self.part(*part).section;
                dimension(&mut section, number).copied()
            }
            NominalNumber::LengthL1 => Some(self.l1),
            NominalNumber::LengthL2 => Some(self.l2),
            NominalNumber::BendRadius => Some(self.bend_radius),
            NominalNumber::Station(Feature::Joint(name)) => {
                self.joints.iter().find(|joint| joint.name == *name).map(|joint| joint.station)
            }
            NominalNumber::Station(Feature::Mass(name)) => {
                self.masses.iter().find(|mass| mass.name == *name).map(|mass| mass.station)
            }
            NominalNumber::TipMass => Some(self.tip_mass),
        }
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
    pub fn with(&self, number: &NominalNumber, value: f64) -> Rod {
        let mut rod = self.clone();
        let Some(nominal) = self.value_of(number) else { return rod };
        let mut of_material = |name: &str, field: fn(&mut Material) -> &mut f64| {
            for pipe in [&mut rod.pipe1, &mut rod.bend, &mut rod.pipe2] {
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
                };
                if let Some(own) = dimension(&mut own.section, number) {
                    *own = value;
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
            NominalNumber::TipMass => rod.tip_mass = value,
        }
        let (before, after, length) = (self.places(), rod.places(), rod.length());
        let kept = |station: f64| {
            let here = before.iter().zip(after).find(|(place, _)| (*place - station).abs() <= SAME_PLACE);
            here.map_or(station, |(_, moved)| moved).clamp(0.0, length.max(0.0))
        };
        let is_length =
            matches!(number, NominalNumber::LengthL1 | NominalNumber::LengthL2 | NominalNumber::BendRadius);
        let stations = rod.masses.iter_mut().map(|mass| &mut mass.station);
        for station in stations.chain(rod.joints.iter_mut().map(|joint| &mut joint.station)) {
            *station = if is_length { kept(*station) } else { station.clamp(0.0, length.max(0.0)) };
        }
        rod
    }

    /// Flange, both ends of the bend (or the corner, twice) and tip, stations in m.
    fn places(&self) -> [f64; 4] {
        [0.0, self.bend_start(), self.bend_end(), self.length()]
    }

    fn part(&self, part: Part) -> &Pipe {
        match part {
            Part::Pipe1 => &self.pipe1,
            Part::Bend => &self.bend,
            Part::Pipe2 => &self.pipe2,
        }
    }

    /// The parts from the flange on; the bend only where it has a length.
    fn parts(&self) -> Vec<(Part, &Pipe)> {
        let bend = (self.bend_radius > 0.0).then_some((Part::Bend, &self.bend));
        [(Part::Pipe1, &self.pipe1)].into_iter().chain(bend).chain([(Part::Pipe2, &self.pipe2)]).collect()
    }

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
            NominalNumber::Section(..) => own.section * value,
            NominalNumber::LengthL1
            | NominalNumber::LengthL2
            | NominalNumber::BendRadius
            | NominalNumber::Station(_) => own.length,
            NominalNumber::TipMass => own.tip_mass,
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
        ]
        .map(|constant| NominalNumber::Section(part, constant))
        .to_vec(),
    }
}

/// The field of `section` that `number` names, where the section has it.
fn dimension<'s>(section: &'s mut Section, number: &NominalNumber) -> Option<&'s mut f64> {
    match (section, number) {
        (Section::Round(round), NominalNumber::OuterDiameter(_)) => Some(&mut round.outer_diameter),
        (Section::Round(round), NominalNumber::InnerDiameter(_)) => Some(&mut round.inner_diameter),
        (Section::Rectangle(rectangle), NominalNumber::Width(_)) => Some(&mut rectangle.width),
        (Section::Rectangle(rectangle), NominalNumber::Height(_)) => Some(&mut rectangle.height),
        (Section::Rectangle(rectangle), NominalNumber::Wall(_)) => rectangle.wall.as_mut(),
        (Section::General(general), NominalNumber::Section(_, constant)) => Some(match constant {
            SectionConstant::Area => &mut general.area,
            SectionConstant::Iy => &mut general.iy,
            SectionConstant::Iz => &mut general.iz,
            SectionConstant::TorsionConstant => &mut general.torsion_constant,
        }),
        _ => None,
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::rod::{BendFlexibility, Joint};
    use crate::section::{Rectangle, Round};
    use approx::assert_relative_eq;

    fn material(name: &str) -> Material {
        Material::isotropic(name, 193e9, 0.29, 7930.0)
    }

    /// 150 and 525 mm, a bend of 50 mm in the tube of pipe 1, a box as pipe 2.
    fn rod() -> Rod {
        let joint = |name: &str, station| Joint { name: name.into(), station, bending: 1e-6, torsion: 0.0 };
        let rod = Rod::new("r", 0.150, 0.525, Pipe::new(Round::tube(0.032, 0.030), material("steel")))
            .with_bend(0.050, BendFlexibility::Beam)
            .with_pipe2(Pipe::new(Rectangle::hollow(0.02, 0.03, 0.001), material("aluminium")))
            .with_tip_mass(0.06);
        let (end, tip) = (rod.bend_end(), rod.length());
        rod.with_joint(joint("at the bend", end))
            .with_joint(joint("sleeve", 0.4))
            .with_mass("ring", 0.4, 0.03)
            .with_mass("holder", tip, 0.01)
            .checked()
            .unwrap()
    }

    #[test]
    fn every_number_that_is_not_exact_is_there_with_its_uncertainty() {
        let (rod, percent) = (rod(), 0.01);
        let found: Vec<(String, f64, f64)> = rod
            .nominal_numbers()
            .into_iter()
            .map(|n| (n.number.to_string(), n.value, n.standard_uncertainty))
            .collect();
        let g = 193e9 / 2.58;
        let mut expected = vec![
            ("l1".to_owned(), 0.150, 0.3e-3),
            ("l2".to_owned(), 0.525, 0.3e-3),
            ("bend radius".to_owned(), 0.050, 0.3e-3),
        ];
        for name in ["steel", "aluminium"] {
            expected.extend([
                (format!("E of {name}"), 193e9, 193e9 * percent),
                (format!("G of {name}"), g, g * 2.0 * percent),
                (format!("density of {name}"), 7930.0, 7930.0 * percent),
                (format!("shear coefficient of {name}"), 1.0, 3.0 * percent),
            ]);
        }
        for (name, value) in [
            ("outer diameter of pipe 1", 0.032),
            ("inner diameter of pipe 1", 0.030),
            ("width of pipe 2", 0.02),
            ("height of pipe 2", 0.03),
            ("wall of pipe 2", 0.001),
        ] {
            expected.push((name.to_owned(), value, 0.03e-3));
        }
        expected.push(("tip mass".to_owned(), 0.06, 0.5e-3));
        expected.push(("station of mass ring".to_owned(), 0.4, 0.3e-3));
        expected.push(("station of joint sleeve".to_owned(), 0.4, 0.3e-3));
        assert_eq!(found.len(), expected.len(), "{found:?}");
        for (found, expected) in found.iter().zip(&expected) {
            assert_eq!(found.0, expected.0);
            assert_relative_eq!(found.1, expected.1, max_relative = 1e-14);
            assert_relative_eq!(found.2, expected.2, max_relative = 1e-12);
        }
        let mut exact = rod;
        exact.standard_uncertainty.length = 0.0;
        exact.pipe2.material.standard_uncertainty.youngs_modulus = 0.0;
        let left: Vec<String> = exact.nominal_numbers().iter().map(|n| n.number.to_string()).collect();
        assert!(!left.iter().any(|name| name.contains("station") || name == "l1"), "{left:?}");
        assert!(left.contains(&"E of steel".into()) && !left.contains(&"E of aluminium".into()));
    }

    #[test]
    fn one_number_changes_and_nothing_else() {
        let rod = rod();
        for Nominal { number, value, standard_uncertainty } in rod.nominal_numbers() {
            assert_eq!(rod.with(&number, value), rod, "{number}");
            let changed = rod.with(&number, value + standard_uncertainty);
            assert_ne!(changed, rod, "{number}");
            assert_eq!(changed.value_of(&number), Some(value + standard_uncertainty));
            assert!(changed.clone().checked().is_ok(), "{number}");
            for other in rod.nominal_numbers().into_iter().filter(|other| other.number != number) {
                assert_eq!(changed.value_of(&other.number), Some(other.value), "{number} {}", other.number);
            }
        }
        let unknown = NominalNumber::YoungsModulus("brass".into());
        assert_eq!((rod.with(&unknown, 1.0), rod.value_of(&unknown)), (rod.clone(), None));
    }

    #[test]
    fn what_sits_at_an_end_goes_with_it_and_the_rest_stays() {
        let rod = rod();
        for (number, value) in [
            (NominalNumber::LengthL1, 0.149),
            (NominalNumber::LengthL2, 0.524),
            (NominalNumber::LengthL2, 0.526),
            (NominalNumber::BendRadius, 0.051),
        ] {
            let changed = rod.with(&number, value);
            assert_relative_eq!(changed.joints[0].station, changed.bend_end(), max_relative = 1e-14);
            assert_eq!((changed.joints[1].station, changed.masses[0].station), (0.4, 0.4));
            assert_relative_eq!(changed.masses[1].station, changed.length(), max_relative = 1e-14);
        }
        let ring = NominalNumber::Station(Feature::Mass("ring".into()));
        let moved = rod.with(&ring, 0.41);
        assert_eq!((moved.masses[0].station, moved.joints[1].station), (0.41, 0.4));
    }

    #[test]
    fn a_bend_of_the_tube_of_pipe_1_goes_with_it_and_another_does_not() {
        let mut rod = rod();
        let outer = NominalNumber::OuterDiameter(Part::Pipe1);
        let changed = rod.with(&outer, 0.033);
        assert_eq!(changed.bend.section, changed.pipe1.section);
        rod.bend.section = Round::tube(0.033, 0.029).into();
        assert_eq!(rod.with(&outer, 0.034).bend, rod.bend);
        let names: Vec<String> = rod.nominal_numbers().iter().map(|n| n.number.to_string()).collect();
        assert!(names.contains(&"outer diameter of the bend".to_owned()), "{names:?}");
    }

    #[test]
    fn pipes_that_were_corrected_apart_keep_their_ratio() {
        let mut rod = rod();
        rod.pipe2.material = Material { youngs_modulus: 0.8 * 193e9, ..material("steel") };
        let changed = rod.with(&NominalNumber::YoungsModulus("steel".into()), 1.01 * 193e9);
        assert_relative_eq!(changed.pipe1.material.youngs_modulus, 1.01 * 193e9, max_relative = 1e-14);
        assert_relative_eq!(changed.pipe2.material.youngs_modulus, 0.808 * 193e9, max_relative = 1e-14);
    }

    #[test]
    fn names_and_units_are_those_of_the_file() {
        for (number, key, place, change, nominal, expected) in [
            (
                NominalNumber::YoungsModulus("steel".into()),
                "youngs_modulus_percent",
                "material.steel",
                2e9,
                200e9,
                1.0,
            ),
            (NominalNumber::InnerDiameter(Part::Bend), "inner_diameter_mm", "bend", 1e-4, 0.03, 0.1),
            (NominalNumber::LengthL1, "l1_mm", "geometry", -2e-4, 0.15, -0.2),
            (NominalNumber::TipMass, "mass_g", "tip", 1e-3, 0.06, 1.0),
            (
                NominalNumber::Section(Part::Pipe2, SectionConstant::Iz),
                "iz_percent",
                "pipe2",
                1e-10,
                2e-9,
                5.0,
            ),
            (NominalNumber::Station(Feature::Joint("a".into())), "station_mm", "joint.a", 1e-3, 0.2, 1.0),
        ] {
            assert_eq!((number.key(), number.place().as_str()), (key, place));
            assert_relative_eq!(number.in_unit(change, nominal), expected, max_relative = 1e-12);
        }
    }
}
