//! The cross-section of a pipe: diameters, a rectangle, or the constants of any other section.

use toml::Spanned;

use super::check::Check;
use super::parts::RawPipe;
use crate::error::{Error, Result};
use crate::section::{General, Rectangle, Round, Section};
use crate::toml_text::Number;
use crate::units::MM;

/// A key and its number, where the file has it.
type Key<'r> = (&'static str, &'r Option<Number>);

const ROUND: &str = "outer_diameter_mm and inner_diameter_mm";
const RECTANGLE: &str = "width_mm and height_mm (wall_mm: a box)";
const GENERAL: &str = "area_mm2, iy_mm4, iz_mm4, j_mm4 and kappa";

impl Check<'_> {
    pub(super) fn section(&mut self, which: &str, raw: &Spanned<RawPipe>) -> Result<Section> {
        let fields = raw.get_ref();
        let diameters: [Key<'_>; 2] = [
            ("outer_diameter_mm", &fields.outer_diameter_mm),
            ("inner_diameter_mm", &fields.inner_diameter_mm),
        ];
        let sides: [Key<'_>; 3] =
            [("width_mm", &fields.width_mm), ("height_mm", &fields.height_mm), ("wall_mm", &fields.wall_mm)];
        let constants: [Key<'_>; 5] = [
            ("area_mm2", &fields.area_mm2),
            ("iy_mm4", &fields.iy_mm4),
            ("iz_mm4", &fields.iz_mm4),
            ("j_mm4", &fields.j_mm4),
            ("kappa", &fields.kappa),
        ];
        let given = |keys: &[Key<'_>]| keys.iter().any(|(_, number)| number.is_some());
        match (given(&diameters), given(&sides), given(&constants)) {
            (true, false, false) => self.round(which, raw).map(Section::Round),
            (false, true, false) => self.rectangle(which, raw).map(Section::Rectangle),
            (false, false, true) => self.general(which, raw).map(Section::General),
            (false, false, false) => {
                let found = format!("[{which}] has no cross-section");
                Err(self.toml.wrong(raw, found, &format!("{ROUND}, or {RECTANGLE}, or {GENERAL}")))
            }
            _ => {
                let all = || diameters.iter().chain(&sides).chain(&constants);
                let stated: Vec<&str> = all().filter(|(_, n)| n.is_some()).map(|&(key, _)| key).collect();
                let found = format!("[{which}] has {}", stated.join(", "));
                Err(self.toml.wrong(
                    raw,
                    found,
                    &format!("one of the three: {ROUND}; {RECTANGLE}; {GENERAL}"),
                ))
            }
        }
    }

    fn round(&mut self, which: &str, raw: &Spanned<RawPipe>) -> Result<Round> {
        let fields = raw.get_ref();
        let key = |field: &str| format!("{which}.{field}");
        let (outer, inner) = match (&fields.outer_diameter_mm, &fields.inner_diameter_mm) {
            (Some(outer), Some(inner)) => (outer, inner),
            (None, _) => {
                return Err(self.missing(which, raw, "outer_diameter_mm", "the outer diameter in mm"));
            }
            (_, None) => {
                let expected = "the inner diameter in mm, 0 for a solid rod";
                return Err(self.missing(which, raw, "inner_diameter_mm", expected));
            }
        };
        let outer_mm = self.toml.positive(&key("outer_diameter_mm"), outer)?;
        let inner_mm = self.toml.not_negative(&key("inner_diameter_mm"), inner)?;
        if inner_mm >= outer_mm {
            let expected = format!("less than the outer diameter, {} mm", self.toml.source(outer));
            return Err(self.toml.is(&key("inner_diameter_mm"), inner, &expected));
        }
        self.usual(&key("outer_diameter_mm"), outer_mm, "mm", 1.0, 1000.0);
        Ok(Round { outer_diameter: outer_mm * MM, inner_diameter: inner_mm * MM })
    }

    fn rectangle(&mut self, which: &str, raw: &Spanned<RawPipe>) -> Result<Rectangle> {
        let fields = raw.get_ref();
        let key = |field: &str| format!("{which}.{field}");
        let mut sides = [0.0; 2];
        let numbers = [
            ("width_mm", &fields.width_mm, "the side normal to the rod's plane in mm"),
            ("height_mm", &fields.height_mm, "the side in the rod's plane in mm"),
        ];
        for ((field, number, expected), side) in numbers.into_iter().zip(&mut sides) {
            let Some(number) = number else { return Err(self.missing(which, raw, field, expected)) };
            *side = self.toml.positive(&key(field), number)?;
            self.usual(&key(field), *side, "mm", 1.0, 1000.0);
        }
        let [width, height] = sides;
        let wall = match &fields.wall_mm {
            None => None,
            Some(number) => {
                let wall = self.toml.positive(&key("wall_mm"), number)?;
                if 2.0 * wall >= width.min(height) {
                    let expected =
                        format!("less than half of the shorter side, {} mm", width.min(height) / 2.0);
                    return Err(self.toml.is(&key("wall_mm"), number, &expected));
                }
                Some(wall * MM)
            }
        };
        Ok(Rectangle { width: width * MM, height: height * MM, wall })
    }

    fn general(&mut self, which: &str, raw: &Spanned<RawPipe>) -> Result<General> {
        let fields = raw.get_ref();
        let mut constants = [0.0; 5];
        let numbers = [
            ("area_mm2", &fields.area_mm2, "the area in mm²"),
            ("iy_mm4", &fields.iy_mm4, "the second moment of area for bending in the rod's plane in mm⁴"),
            ("iz_mm4", &fields.iz_mm4, "the second moment of area for bending out of the rod's plane in mm⁴"),
            ("j_mm4", &fields.j_mm4, "the torsion constant in mm⁴"),
            ("kappa", &fields.kappa, "the shear coefficient, 5/6 for a rectangle"),
        ];
        for ((field, number, expected), constant) in numbers.into_iter().zip(&mut constants) {
            let Some(number) = number else { return Err(self.missing(which, raw, field, expected)) };
            *constant = self.toml.positive(&format!("{which}.{field}"), number)?;
        }
        let [area, iy, iz, torsion, kappa] = constants;
        if let Some(number) = fields.kappa.as_ref().filter(|_| kappa > LARGEST_KAPPA) {
            let expected = format!("a shear coefficient, 0 < κ <= {LARGEST_KAPPA} (5/6 for a rectangle)");
            return Err(self.toml.is(&format!("{which}.kappa"), number, &expected));
        }
        // J of a section is at most its polar moment, which only a circle reaches
        let polar = iy + iz;
        if let Some(number) = fields.j_mm4.as_ref().filter(|_| torsion > polar * (1.0 + 1e-3)) {
            let expected = format!("at most iy_mm4 + iz_mm4 = {polar}, the polar moment");
            return Err(self.toml.is(&format!("{which}.j_mm4"), number, &expected));
        }
        let fourth = MM * MM * MM * MM;
        Ok(General {
            area: area * (MM * MM),
            iy: iy * fourth,
            iz: iz * fourth,
            torsion_constant: torsion * fourth,
            shear_coefficient: kappa,
        })
    }

    /// The error that a key of a pipe is missing.
    fn missing(&self, which: &str, raw: &Spanned<RawPipe>, field: &str, expected: &str) -> Error {
        self.toml.wrong(raw, format!("there is no {field} in [{which}]"), expected)
    }
}

/// No section is stiffer in shear than its area, but for what contraction adds.
const LARGEST_KAPPA: f64 = 1.2;
