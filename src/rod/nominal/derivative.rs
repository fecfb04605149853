//! The rod whose numbers carry a derivative: formulas that take any [`Number`] differentiate
//! themselves.

use super::{NominalNumber, SAME_PLACE};
use crate::dual::{Dual, Number};
use crate::material::Material;
use crate::rod::{BendFlexibility, Joint, LumpedMass, Pipe, Rod, Sleeve};
use crate::section::{General, Rectangle, Round, Section};

impl Rod {
    /// This rod with the derivative of each of its numbers by one of them, all else equal: what
    /// [`Rod::with`] moves along moves along, and so does what sits at the station that moves.
    /// `None` where the rod does not have this number.
    ///
    /// ```
    /// use rodcal::prelude::*;
    /// use rodcal::rod::NominalNumber;
    ///
    /// let rod = Rod::read("rods/5.toml".as_ref())?;
    /// let mass = rod.derivative(&NominalNumber::LengthL2).expect("a rod has an L2").mass();
    /// // kg per metre of pipe 2
    /// assert_eq!((mass.re, mass.eps), (rod.mass(), rod.pipe2.mass_per_length()));
    /// # Ok::<(), rodcal::Error>(())
    /// ```
    pub fn derivative(&self, number: &NominalNumber) -> Option<Rod<Dual>> {
        let value = Dual::from(self.value_of(number)?).derivative();
        let mut rod = self.lifted();
        if let NominalNumber::Station(_) = number {
            let is_here = |station: &Dual| (station.re - value.re).abs() <= SAME_PLACE;
            rod.stations_mut().filter(|station| is_here(station)).for_each(|station| *station = value);
            return Some(rod);
        }
        Some(rod.with(number, value))
    }

    /// The same rod in numbers of another kind.
    pub fn lifted<T: Number>(&self) -> Rod<T> {
        let value_at = |x: f64| T::from(x);
        let joint = |joint: &Joint| Joint {
            name: joint.name.clone(),
            station: value_at(joint.station),
            bending: value_at(joint.bending),
            torsion: value_at(joint.torsion),
        };
        let mass = |mass: &LumpedMass| LumpedMass {
            name: mass.name.clone(),
            station: value_at(mass.station),
            mass: value_at(mass.mass),
        };
        let sleeve = |sleeve: &Sleeve| Sleeve {
            name: sleeve.name.clone(),
            from: value_at(sleeve.from),
            to: value_at(sleeve.to),
            pipe: sleeve.pipe.lifted(),
        };
        Rod {
            name: self.name.clone(),
            source: self.source.clone(),
            l1: value_at(self.l1),
            l2: value_at(self.l2),
            gamma: value_at(self.gamma),
            bend_radius: value_at(self.bend_radius),
            bend_flexibility: match self.bend_flexibility {
                BendFlexibility::Beam => BendFlexibility::Beam,
                BendFlexibility::VonKarman => BendFlexibility::VonKarman,
                BendFlexibility::AsmeB313 => BendFlexibility::AsmeB313,
                BendFlexibility::Factor(k) => BendFlexibility::Factor(value_at(k)),
            },
            pipe1: self.pipe1.lifted(),
            bend: self.bend.lifted(),
            pipe2: self.pipe2.lifted(),
            tip_mass: value_at(self.tip_mass),
            masses: self.masses.iter().map(mass).collect(),
            joints: self.joints.iter().map(joint).collect(),
            sleeves: self.sleeves.iter().map(sleeve).collect(),
            laws: self.laws.clone(),
            linear_range: self.linear_range,
            standard_uncertainty: self.standard_uncertainty,
            warnings: self.warnings.clone(),
        }
    }
}

impl Pipe {
    fn lifted<T: Number>(&self) -> Pipe<T> {
        let (lift, material) = (|x: f64| T::from(x), &self.material);
        let section = match self.section {
            Section::Round(round) => Section::Round(Round {
                outer_diameter: lift(round.outer_diameter),
                inner_diameter: lift(round.inner_diameter),
            }),
            Section::Rectangle(rectangle) => Section::Rectangle(Rectangle {
                width: lift(rectangle.width),
                height: lift(rectangle.height),
                wall: rectangle.wall.map(lift),
            }),
            Section::General(general) => Section::General(General {
                area: lift(general.area),
                iy: lift(general.iy),
                iz: lift(general.iz),
                torsion_constant: lift(general.torsion_constant),
                shear_coefficient: lift(general.shear_coefficient),
            }),
        };
        let material = Material {
            name: material.name.clone(),
            youngs_modulus: lift(material.youngs_modulus),
            shear_modulus: lift(material.shear_modulus),
            density: lift(material.density),
            poisson_ratio: lift(material.poisson_ratio),
            is_shear_modulus_derived: material.is_shear_modulus_derived,
            yield_strength: material.yield_strength.map(lift),
            shear_coefficient_factor: lift(material.shear_coefficient_factor),
            standard_uncertainty: material.standard_uncertainty,
            plies: material.plies.clone(),
        };
        Pipe { section, material }
    }
}
