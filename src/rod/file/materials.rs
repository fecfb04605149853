//! Materials of a rod file: isotropic ones, two independent moduli, or a laminate of plies.

use serde::Deserialize;
use toml::Spanned;

use super::check::Check;
use crate::error::{Error, Result};
use crate::material::{Material, isotropic_poisson_ratio, laminate};
use crate::rod::Warning;
use crate::toml_text::Number;
use crate::units::{GPA, MM, significant};

#[derive(Deserialize)]
#[serde(deny_unknown_fields, expecting = "a section [material.NAME], NAME being any name")]
pub(super) struct RawMaterial {
    density_kg_m3: Number,
    youngs_modulus_gpa: Option<Number>,
    shear_modulus_gpa: Option<Number>,
    poisson_ratio: Option<Number>,
    ply_e1_gpa: Option<Number>,
    ply_e2_gpa: Option<Number>,
    ply_g12_gpa: Option<Number>,
    ply_nu12: Option<Number>,
    ply_thickness_mm: Option<Number>,
    ply_angles_deg: Option<Spanned<Vec<Number>>>,
}

/// A material as checked, with what its laminate has to say to the pipes that use it.
pub(super) struct Checked {
    pub material: Material,
    /// Sum of the plies, m.
    pub laminate_thickness: Option<f64>,
}

const LAMINATE: &str =
    "all of ply_e1_gpa, ply_e2_gpa, ply_g12_gpa, ply_nu12, ply_thickness_mm, ply_angles_deg";

impl RawMaterial {
    fn is_laminate(&self) -> bool {
        let numbers =
            [&self.ply_e1_gpa, &self.ply_e2_gpa, &self.ply_g12_gpa, &self.ply_nu12, &self.ply_thickness_mm];
        self.ply_angles_deg.is_some() || numbers.iter().any(|number| number.is_some())
    }
}

impl Check<'_> {
    pub(super) fn material(&mut self, name: &str, raw: &Spanned<RawMaterial>) -> Result<Checked> {
        let fields = raw.get_ref();
        let key = |field: &str| format!("material.{name}.{field}");
        let density = self.toml.not_negative(&key("density_kg_m3"), &fields.density_kg_m3)?;
        self.usual(&key("density_kg_m3"), density, "kg/m³", 100.0, 25_000.0);
        let moduli = (&fields.youngs_modulus_gpa, &fields.shear_modulus_gpa, &fields.poisson_ratio);
        match moduli {
            (None, None, None) if fields.is_laminate() => self.laminate(name, raw, density),
            (Some(e), Some(g), None) if !fields.is_laminate() => {
                let e = self.modulus(&key("youngs_modulus_gpa"), e)?;
                let g = self.modulus(&key("shear_modulus_gpa"), g)?;
                let ratio = isotropic_poisson_ratio(e, g);
                if ratio > 0.5 {
                    self.warnings.push(Warning::Anisotropic { material: name.to_owned(), ratio });
                }
                let material = Material::with_moduli(name, e, g, density);
                Ok(Checked { material, laminate_thickness: None })
            }
            (Some(e), None, Some(nu)) if !fields.is_laminate() => {
                let e = self.modulus(&key("youngs_modulus_gpa"), e)?;
                let ratio = self.toml.finite(&key("poisson_ratio"), nu)?;
                if !(ratio > -1.0 && ratio <= 0.5) {
                    return Err(self.toml.is(&key("poisson_ratio"), nu, "a Poisson's ratio, -1 < ν <= 0.5"));
                }
                let material = Material::isotropic(name, e, ratio, density);
                Ok(Checked { material, laminate_thickness: None })
            }
            _ => Err(self.undecided(name, raw)),
        }
    }

    /// Neither the one way to state a material nor the other.
    fn undecided(&self, name: &str, raw: &Spanned<RawMaterial>) -> Error {
        let fields = raw.get_ref();
        let (found, expected) =
            match (&fields.youngs_modulus_gpa, &fields.shear_modulus_gpa, &fields.poisson_ratio) {
                _ if fields.is_laminate() => (
                    "has ply_… keys and a modulus or ratio of its own",
                    "one of the two: the plies alone make E and G".to_owned(),
                ),
                (Some(_), Some(_), Some(_)) => {
                    ("has shear_modulus_gpa and poisson_ratio", "one of the two".to_owned())
                }
                (None, ..) => {
                    ("has no youngs_modulus_gpa", format!("youngs_modulus_gpa, or for a laminate {LAMINATE}"))
                }
                _ => ("has neither shear_modulus_gpa nor poisson_ratio", "one of the two".to_owned()),
            };
        self.toml.wrong(raw, format!("material `{name}` {found}"), &expected)
    }

    fn laminate(&mut self, name: &str, raw: &Spanned<RawMaterial>, density: f64) -> Result<Checked> {
        let fields = raw.get_ref();
        let missing = |field: &str| {
            let found = format!("laminate `{name}` has no {field}");
            self.toml.wrong(raw, found, LAMINATE)
        };
        let key = |field: &str| format!("material.{name}.{field}");
        let given = |number: &Option<Number>, field| number.clone().ok_or_else(|| missing(field));
        let e1 = given(&fields.ply_e1_gpa, "ply_e1_gpa")?;
        let e2 = given(&fields.ply_e2_gpa, "ply_e2_gpa")?;
        let g12 = given(&fields.ply_g12_gpa, "ply_g12_gpa")?;
        let nu12 = given(&fields.ply_nu12, "ply_nu12")?;
        let thickness = given(&fields.ply_thickness_mm, "ply_thickness_mm")?;
        let angles = fields.ply_angles_deg.as_ref().ok_or_else(|| missing("ply_angles_deg"))?;

        let ply = laminate::Ply {
            e1: self.modulus(&key("ply_e1_gpa"), &e1)?,
            e2: self.modulus(&key("ply_e2_gpa"), &e2)?,
            g12: self.modulus(&key("ply_g12_gpa"), &g12)?,
            nu12: self.toml.positive(&key("ply_nu12"), &nu12)?,
            thickness: self.toml.positive(&key("ply_thickness_mm"), &thickness)? * MM,
            angle: 0.0,
        };
        // a positive definite Q needs ν12² < E1/E2 (Jones Eq 2.56)
        let largest = (ply.e1 / ply.e2).sqrt();
        if ply.nu12 >= largest {
            let expected = format!("less than √(ply_e1_gpa / ply_e2_gpa), {}", significant(largest, 4));
            return Err(self.toml.is(&key("ply_nu12"), &nu12, &expected));
        }
        let mut plies = Vec::new();
        for angle in angles.get_ref() {
            let degrees = self.toml.finite(&key("ply_angles_deg"), angle)?;
            plies.push(laminate::Ply { angle: degrees.to_radians(), ..ply });
        }
        if plies.is_empty() {
            let expected = "one angle for each ply, for example [0, 45, -45, 90]";
            return Err(self.toml.is(&key("ply_angles_deg"), angles, expected));
        }
        let Some(wall) = laminate::wall(&plies) else {
            let found = format!("the plies of laminate `{name}` have no positive stiffness");
            return Err(self.toml.wrong(raw, found, "moduli of similar size"));
        };
        if wall.coupling > 0.01 {
            let coupling = wall.coupling;
            self.warnings.push(Warning::LaminateCoupling { material: name.to_owned(), coupling });
        }
        let material = Material {
            name: name.to_owned(),
            youngs_modulus: wall.youngs_modulus,
            shear_modulus: wall.shear_modulus,
            density,
            poisson_ratio: wall.poisson_ratio.clamp(0.0, 0.5),
        };
        Ok(Checked { material, laminate_thickness: Some(wall.thickness) })
    }

    /// A modulus in GPa as the file has it, Pa.
    fn modulus(&mut self, key: &str, number: &Number) -> Result<f64> {
        let value = self.toml.positive(key, number)?;
        self.usual(key, value, "GPa", 0.01, 2000.0);
        Ok(value * GPA)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::rod::Rod;
    use approx::assert_relative_eq;

    fn read(material: &str) -> Rod {
        let pipe = "material = \"m\"\nouter_diameter_mm = 16\ninner_diameter_mm = 14\n";
        let text = format!(
            "[geometry]\nl1_mm = 150\nl2_mm = 300\n[pipe1]\n{pipe}[pipe2]\n{pipe}\
             [material.m]\ndensity_kg_m3 = 1600\n{material}"
        );
        Rod::from_toml("rod.toml", &text).expect(material)
    }

    #[test]
    fn poisson_ratio_and_shear_modulus_are_two_ways_to_say_the_same() {
        let rod = read("youngs_modulus_gpa = 200\npoisson_ratio = 0.25");
        assert_eq!(rod.pipe1.material, Material::isotropic("m", 200e9, 0.25, 1600.0));
        assert_eq!(
            rod.pipe1.material,
            read("youngs_modulus_gpa = 200\nshear_modulus_gpa = 80").pipe1.material
        );
    }

    #[test]
    fn a_laminate_becomes_the_moduli_of_its_wall() {
        let plies = "ply_e1_gpa = 181\nply_e2_gpa = 10.3\nply_g12_gpa = 7.17\nply_nu12 = 0.28\n";
        let rod = read(&format!(
            "{plies}ply_thickness_mm = 0.125\nply_angles_deg = [0, 90, 0.0, 45, -45, 0, 0, 0]"
        ));
        let angles = [0.0, 90.0, 0.0, 45.0, -45.0, 0.0, 0.0, 0.0f64];
        let ply = |angle: f64| laminate::Ply {
            e1: 181e9,
            e2: 10.3e9,
            g12: 7.17e9,
            nu12: 0.28,
            thickness: 0.125e-3,
            angle: angle.to_radians(),
        };
        let wall = laminate::wall(&angles.map(ply)).expect("a sound laminate");
        let material = &rod.pipe1.material;
        assert_relative_eq!(material.youngs_modulus, wall.youngs_modulus, max_relative = 1e-12);
        assert_relative_eq!(material.shear_modulus, wall.shear_modulus, max_relative = 1e-12);
        assert_relative_eq!(material.poisson_ratio, wall.poisson_ratio, max_relative = 1e-12);
        assert_eq!((material.density, rod.warnings), (1600.0, vec![])); // eight plies fill the wall of 1 mm
    }
}
