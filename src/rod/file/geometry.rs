//! The geometry of a rod file: lengths, angle and bend of the centreline.

use std::f64::consts::{FRAC_PI_2, PI};

use serde::Deserialize;
use toml::Spanned;

use super::check::Check;
use crate::error::{Error, Result};
use crate::rod::{BendFlexibility, Warning, tangent_length};
use crate::toml_text::Number;
use crate::units::{MM, significant};

#[derive(Deserialize)]
#[serde(deny_unknown_fields, expecting = "a section [geometry]")]
pub(super) struct RawGeometry {
    l1_mm: Number,
    l2_mm: Number,
    gamma_deg: Option<Number>,
    bend_radius_mm: Option<Number>,
    bend_flexibility: Option<Spanned<RawFlexibility>>,
}

#[derive(Deserialize)]
#[serde(untagged, expecting = "expected \"beam\", \"von-karman\", \"asme-b31.3\" or a factor > 0")]
pub enum RawFlexibility {
    Factor(f64),
    Name(String),
}

/// The centreline as [`crate::rod::Rod`] has it.
pub(super) struct Geometry {
    pub l1: f64,
    pub l2: f64,
    pub gamma: f64,
    pub bend_radius: f64,
    pub bend_flexibility: BendFlexibility,
}

impl Check<'_> {
    pub(super) fn geometry(&mut self, raw: &RawGeometry) -> Result<Geometry> {
        let l1 = self.length("geometry.l1_mm", &raw.l1_mm)?;
        let l2 = self.length("geometry.l2_mm", &raw.l2_mm)?;
        let gamma = match &raw.gamma_deg {
            Some(number) => self.angle(number)?,
            None => FRAC_PI_2,
        };
        let bend_radius = match &raw.bend_radius_mm {
            Some(number) => self.bend_radius(number, l1.min(l2), gamma)?,
            None => 0.0,
        };
        let bend_flexibility = match &raw.bend_flexibility {
            Some(raw) => self.bend_flexibility(raw)?,
            None => BendFlexibility::Beam,
        };
        Ok(Geometry { l1, l2, gamma, bend_radius, bend_flexibility })
    }

    fn length(&mut self, key: &str, number: &Number) -> Result<f64> {
        let value = self.toml.positive(key, number)?;
        self.usual(key, value, "mm", 1.0, 20_000.0);
        Ok(value * MM)
    }

    fn angle(&mut self, number: &Number) -> Result<f64> {
        let key = "geometry.gamma_deg";
        let degrees = self.toml.finite(key, number)?;
        // also what is 0 in radians
        if !(degrees.to_radians() > 0.0 && degrees <= 180.0) {
            let expected =
                "the inside angle between the pipes in degrees, 0 < gamma_deg <= 180 (180 is a straight rod)";
            return Err(self.toml.is(key, number, expected));
        }
        self.usual(key, degrees, "degrees", 10.0, 180.0);
        Ok(degrees.to_radians())
    }

    fn bend_radius(&mut self, number: &Number, shorter: f64, gamma: f64) -> Result<f64> {
        let key = "geometry.bend_radius_mm";
        let radius = self.toml.not_negative(key, number)? * MM;
        if gamma == PI {
            if radius > 0.0 {
                self.warnings.push(Warning::NoBend);
            }
            return Ok(0.0);
        }
        let tangent = tangent_length(radius, gamma);
        if tangent <= shorter {
            return Ok(radius);
        }
        // rounded down, so that it may be written into the file
        let largest_mm = (shorter / tangent_length(1.0, gamma) / MM * 1e3).floor() / 1e3;
        let expected = format!(
            "at most {largest_mm} mm: the arc is tangent to both pipes and takes {} mm off each, and the shorter one has {} mm",
            significant(tangent / MM, 4),
            significant(shorter / MM, 4)
        );
        Err(self.toml.is(key, number, &expected))
    }

    /// The error that the bend's flexibility asks for a round tube.
    pub(super) fn no_round_bend(&self, raw: &RawGeometry) -> Error {
        let expected = "\"beam\" or a factor > 0: \"von-karman\" and \"asme-b31.3\" are for round tubes, \
                        and the bend is none";
        match &raw.bend_flexibility {
            Some(raw) => self.toml.is("geometry.bend_flexibility", raw, expected),
            None => self.toml.wrong(&raw.l1_mm, "a bend that is no round tube".into(), expected),
        }
    }

    /// A bend's flexibility by its name, or as a factor.
    pub fn bend_flexibility(&self, raw: &Spanned<RawFlexibility>) -> Result<BendFlexibility> {
        let key = "geometry.bend_flexibility";
        match raw.get_ref() {
            RawFlexibility::Factor(k) => {
                let number = Spanned::new(raw.span(), *k);
                return self.toml.positive(key, &number).map(BendFlexibility::Factor);
            }
            RawFlexibility::Name(name) => match name.as_str() {
                "beam" => return Ok(BendFlexibility::Beam),
                "von-karman" => return Ok(BendFlexibility::VonKarman),
                "asme-b31.3" => return Ok(BendFlexibility::AsmeB313),
                _ => {}
            },
        }
        Err(self.toml.is(key, raw, "\"beam\", \"von-karman\", \"asme-b31.3\" or a factor > 0"))
    }
}
