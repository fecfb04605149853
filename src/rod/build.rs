//! Rods without a file: built piece by piece, checked at the end.

use std::f64::consts::{FRAC_PI_2, PI};

use super::{BendFlexibility, Joint, LumpedMass, Pipe, Rod, Sleeve, StandardUncertainty};
use crate::error::{Error, Result};
use crate::material::MaterialUncertainty;
use crate::section::Section;
use crate::units::MM;

impl Rod {
    /// An L-shaped rod of one pipe with a sharp corner, nothing mounted on it and no mass at its
    /// tip; `l1` and `l2` in m. The `with_…` methods change that, [`Rod::checked`] checks the
    /// whole.
    ///
    /// ```
    /// use rodcal::prelude::*;
    ///
    /// let steel = Material::isotropic("steel", 193e9, 0.29, 7930.0);
    /// let rod = Rod::new("L", 0.150, 0.525, Pipe::new(Round::tube(0.032, 0.030), steel))
    ///     .with_tip_mass(0.060)
    ///     .checked()?;
    /// assert_eq!(rod.tip().as_slice(), [0.525, 0.0, 0.150]);
    /// // 7930 kg/m³ · π/4 (32² − 30²) mm² · 675 mm + 60 g
    /// assert!((rod.mass() - 0.58130).abs() < 1e-5);
    /// # Ok::<(), rodcal::Error>(())
    /// ```
    pub fn new(name: impl Into<String>, l1: f64, l2: f64, pipe: Pipe) -> Rod {
        Rod {
            name: name.into(),
            source: None,
            l1,
            l2,
            gamma: FRAC_PI_2,
            bend_radius: 0.0,
            bend_flexibility: BendFlexibility::Beam,
            pipe1: pipe.clone(),
            bend: pipe.clone(),
            pipe2: pipe,
            tip_mass: 0.0,
            masses: Vec::new(),
            joints: Vec::new(),
            sleeves: Vec::new(),
            laws: Vec::new(),
            linear_range: None,
            standard_uncertainty: StandardUncertainty::default(),
            warnings: Vec::new(),
        }
    }

    /// With the inside angle `gamma` between its pipes, rad: π/2 is the L, π a straight rod.
    pub fn with_angle(self, gamma: f64) -> Rod {
        Rod { gamma, ..self }
    }

    /// With an arc of `radius` (m, of the centreline) in place of the sharp corner. Stations beyond
    /// it move: mount masses, joints and sleeves after that.
    pub fn with_bend(self, radius: f64, flexibility: BendFlexibility) -> Rod {
        Rod { bend_radius: radius, bend_flexibility: flexibility, ..self }
    }

    /// With another pipe from the bend to the tip.
    pub fn with_pipe2(self, pipe: Pipe) -> Rod {
        Rod { pipe2: pipe, ..self }
    }

    /// With ball and ball holder of `mass` (kg) at the tip.
    pub fn with_tip_mass(self, mass: f64) -> Rod {
        Rod { tip_mass: mass, ..self }
    }

    /// With a ring or a holder of `mass` (kg) at a `station` (m from the flange).
    pub fn with_mass(mut self, name: impl Into<String>, station: f64, mass: f64) -> Rod {
        self.masses.push(LumpedMass { name: name.into(), station, mass });
        self
    }

    /// With a sleeve that bears with the straight pipe on or in which it sits, between two stations
    /// (m from the flange).
    pub fn with_sleeve(mut self, name: impl Into<String>, from: f64, to: f64, pipe: Pipe) -> Rod {
        self.sleeves.push(Sleeve { name: name.into(), from, to, pipe });
        self
    }

    /// With a compliant connection.
    pub fn with_joint(mut self, joint: Joint) -> Rod {
        self.joints.push(joint);
        self
    }

    /// The rod itself, if it can be one.
    ///
    /// # Errors
    /// [`Error::Argument`] for a length or a modulus that is not positive, a wall without
    /// thickness, an angle beyond 0 < γ ≤ π, a bend that does not fit between the pipes, a
    /// flexibility for round tubes on a bend that is none, a mass, a compliance or a standard
    /// uncertainty that is negative, a station that is not on the rod, and a sleeve that is not on
    /// one straight pipe or whose wall is where that of another is. Numbers that are not finite are
    /// none of these.
    pub fn checked(self) -> Result<Rod> {
        positive("l1", self.l1)?;
        positive("l2", self.l2)?;
        if !(self.gamma > 0.0 && self.gamma <= PI) {
            return Err(wrong("gamma", self.gamma, "an angle in rad, 0 < gamma <= π"));
        }
        let sleeves = self.sleeves.iter().map(|sleeve| &sleeve.pipe);
        for pipe in [&self.pipe1, &self.bend, &self.pipe2].into_iter().chain(sleeves) {
            check_section(&pipe.section)?;
            let material = &pipe.material;
            positive("youngs_modulus", material.youngs_modulus)?;
            positive("shear_modulus", material.shear_modulus)?;
            not_negative("density", material.density)?;
            if !(material.poisson_ratio > -1.0 && material.poisson_ratio <= 1.0) {
                return Err(wrong("poisson_ratio", material.poisson_ratio, "-1 < ν <= 1"));
            }
            positive("shear_coefficient_factor", material.shear_coefficient_factor)?;
            if let Some(strength) = material.yield_strength {
                positive("yield_strength", strength)?;
            }
            let MaterialUncertainty { youngs_modulus, shear_modulus, density, shear_coefficient } =
                material.standard_uncertainty;
            for uncertainty in [youngs_modulus, shear_modulus, density, shear_coefficient] {
                not_negative("standard_uncertainty", uncertainty)?;
            }
        }
        not_negative("bend_radius", self.bend_radius)?;
        if self.bend_radius > 0.0 && self.tangent_length() > self.l1.min(self.l2) {
            return Err(wrong("bend_radius", self.bend_radius, "an arc that fits between the pipes"));
        }
        if let BendFlexibility::Factor(factor) = self.bend_flexibility {
            positive("bend_flexibility", factor)?;
        }
        if self.bend_radius > 0.0
            && self.bend_flexibility.is_for_tubes()
            && self.bend.section.as_round().is_none()
        {
            return Err(Error::Argument {
                name: "bend_flexibility",
                found: format!("{:?}", self.bend_flexibility),
                expected: "beam theory or a factor: the bend is no round tube".into(),
            });
        }
        let StandardUncertainty { diameter, length, tip_mass, section } = self.standard_uncertainty;
        for uncertainty in [diameter, length, tip_mass, section] {
            not_negative("standard_uncertainty", uncertainty)?;
        }
        not_negative("tip_mass", self.tip_mass)?;
        for mass in &self.masses {
            not_negative("mass", mass.mass)?;
            self.on_rod(mass.station)?;
        }
        for joint in &self.joints {
            not_negative("bending", joint.bending)?;
            not_negative("torsion", joint.torsion)?;
            self.on_rod(joint.station)?;
        }
        for (k, sleeve) in self.sleeves.iter().enumerate() {
            let Sleeve { name, from, to, pipe } = sleeve;
            let refuse = |found, expected| Err(Error::Argument { name: "sleeve", found, expected });
            if let Some(expected) = self.no_stretch(*from, *to) {
                return refuse(format!("\"{name}\" from {:.3} to {:.3} mm", from / MM, to / MM), expected);
            }
            if let Some(other) = self.in_the_way(&self.sleeves[..k], &pipe.section, *from, *to) {
                return refuse(
                    format!("\"{name}\" in the wall of {other}"),
                    "a tube over it or in it".into(),
                );
            }
        }
        Ok(self)
    }

    fn on_rod(&self, station: f64) -> Result<()> {
        if (0.0..=self.length()).contains(&station) {
            return Ok(());
        }
        Err(Error::Argument {
            name: "station",
            found: format!("{:.3} mm", station / MM),
            expected: format!("a station on the rod, 0 to {:.3} mm (the tip)", self.length() / MM),
        })
    }
}

fn check_section(section: &Section) -> Result<()> {
    match section {
        Section::Round(round) => {
            positive("outer_diameter", round.outer_diameter)?;
            not_negative("inner_diameter", round.inner_diameter)?;
            if round.inner_diameter >= round.outer_diameter {
                let expected = "less than the outer diameter";
                return Err(wrong("inner_diameter", round.inner_diameter, expected));
            }
        }
        Section::Rectangle(rectangle) => {
            positive("width", rectangle.width)?;
            positive("height", rectangle.height)?;
            if let Some(wall) = rectangle.wall {
                positive("wall", wall)?;
                if 2.0 * wall >= rectangle.width.min(rectangle.height) {
                    return Err(wrong("wall", wall, "less than half of width and height"));
                }
            }
        }
        Section::General(general) => {
            positive("area", general.area)?;
            positive("iy", general.iy)?;
            positive("iz", general.iz)?;
            positive("torsion_constant", general.torsion_constant)?;
            positive("shear_coefficient", general.shear_coefficient)?;
        }
    }
    Ok(())
}

/// What is smaller would be 0, or refused, in the unit that a file states it in.
const SMALLEST: f64 = 1e-280;

fn positive(name: &'static str, value: f64) -> Result<()> {
    match value >= SMALLEST && value.is_finite() {
        true => Ok(()),
        false if value > 0.0 => Err(wrong(name, value, "a number of at least 1e-280, in SI units")),
        false => Err(wrong(name, value, "a number > 0, in SI units")),
    }
}

fn not_negative(name: &'static str, value: f64) -> Result<()> {
    match value >= 0.0 && value.is_finite() {
        true => Ok(()),
        false => Err(wrong(name, value, "a number >= 0, in SI units")),
    }
}

fn wrong(name: &'static str, value: f64, expected: &str) -> Error {
    Error::Argument { name, found: value.to_string(), expected: expected.to_owned() }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::material::Material;
    use crate::section::{Rectangle, Round};

    fn rod() -> Rod {
        let steel = Material::isotropic("steel", 193e9, 0.29, 7930.0);
        Rod::new("5#", 150.0 * MM, 525.0 * MM, Pipe::new(Round::tube(32.0 * MM, 30.0 * MM), steel))
    }

    #[test]
    fn a_rod_that_is_built_is_the_rod_that_is_read() {
        let text = include_str!("../../rods/5.toml");
        let read = Rod::from_toml("rods/5.toml", text).unwrap();
        let built = Rod { source: read.source.clone(), ..rod().with_tip_mass(0.06).checked().unwrap() };
        assert_eq!(built, read);
    }

    #[test]
    fn what_cannot_be_is_refused_by_name() {
        let joint = |station, bending| Joint { name: "j".into(), station, bending, torsion: 0.0 };
        let bent = |radius| rod().with_bend(radius, BendFlexibility::Beam);
        let sleeve = |from, to, inner| {
            let pipe = Pipe::new(Round::tube(0.036, inner), rod().pipe1.material);
            rod().with_sleeve("s", from, to, pipe)
        };
        assert!(sleeve(0.15, 0.675, 0.032).checked().is_ok());
        for (rod, name) in [
            (Rod { l1: 0.0, ..rod() }, "l1"),
            (Rod { l2: f64::NAN, ..rod() }, "l2"),
            (rod().with_angle(4.0), "gamma"),
            (bent(-0.1), "bend_radius"),
            (bent(0.151), "bend_radius"),
            (rod().with_bend(0.1, BendFlexibility::Factor(0.0)), "bend_flexibility"),
            (rod().with_tip_mass(-1.0), "tip_mass"),
            (rod().with_mass("ring", 0.7, 0.1), "station"),
            (rod().with_mass("ring", 0.1, f64::INFINITY), "mass"),
            (rod().with_joint(joint(0.1, -1e-6)), "bending"),
            (rod().with_joint(joint(f64::NAN, 1e-6)), "station"),
            (sleeve(0.1, 0.2, 0.032), "sleeve"),
            (sleeve(0.1, 0.1, 0.032), "sleeve"),
            (sleeve(0.1, f64::NAN, 0.032), "sleeve"),
            (sleeve(0.2, 0.3, 0.031), "sleeve"),
            (sleeve(0.2, 0.3, 0.05), "inner_diameter"),
            (rod().with_pipe2(Pipe::new(Round::tube(0.01, 0.01), rod().pipe1.material)), "inner_diameter"),
        ] {
            let Err(Error::Argument { name: found, .. }) = rod.checked() else { panic!("{name}") };
            assert_eq!(found, name);
        }
        assert!(bent(0.150).with_mass("ring", 0.6, 0.1).checked().is_ok());
        let steel = rod().pipe1.material;
        let bar = |section: Rectangle| Rod::new("bar", 0.15, 0.5, Pipe::new(section, steel.clone()));
        let solid = bar(Rectangle::solid(0.01, 0.02));
        assert!(solid.clone().with_bend(0.05, BendFlexibility::Factor(2.0)).checked().is_ok());
        let (mut vague, mut ratio) = (rod(), rod());
        vague.standard_uncertainty.length = -1e-3;
        ratio.pipe2.material.poisson_ratio = 1.5;
        for (rod, name) in [
            (bar(Rectangle::solid(0.01, 0.0)), "height"),
            (bar(Rectangle::hollow(0.01, 0.02, 0.005)), "wall"),
            (solid.with_bend(0.05, BendFlexibility::VonKarman), "bend_flexibility"),
            (vague, "standard_uncertainty"),
            (ratio, "poisson_ratio"),
        ] {
            let Err(Error::Argument { name: found, .. }) = rod.checked() else { panic!("{name}") };
            assert_eq!(found, name);
        }
    }
}
