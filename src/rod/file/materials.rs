//! Materials of a rod file: isotropic ones, two independent moduli, or a laminate of plies.

use std::collections::BTreeMap;

use serde::Deserialize;
use toml::Spanned;

use super::check::Check;
use super::uncertainty::{RawUncertainty, of_table};
use crate::error::{Error, Result};
use crate::material::{Material, MaterialUncertainty, isotropic_poisson_ratio, laminate};
use crate::rod::Warning;
use crate::toml_text::Number;
use crate::units::{GPA, MM, MPA, significant};

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
    yield_strength_mpa: Option<Number>,
    shear_coefficient_factor: Option<Number>,
    youngs_modulus_percent: Option<Number>,
    shear_modulus_percent: Option<Number>,
    density_percent: Option<Number>,
    shear_coefficient_percent: Option<Number>,
}

/// The sections `[material.NAME]` of a file.
#[derive(Default, Deserialize)]
#[serde(transparent)]
pub struct MaterialTable(pub(super) BTreeMap<String, Spanned<RawMaterial>>);

impl MaterialTable {
    /// The materials by name, with the standard uncertainties of their tables, else of their kinds.
    ///
    /// # Errors
    /// As [`Rod::from_toml`](crate::rod::Rod::from_toml).
    pub fn checked(&self, check: &mut Check) -> Result<BTreeMap<String, Material>> {
        let usual = RawUncertainty::default();
        let of_name = |(name, raw): (&String, &Spanned<RawMaterial>)| {
            Ok((name.clone(), check.material(name, raw, &usual)?.material))
        };
        self.0.iter().map(of_name).collect()
    }
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
    /// The material with the standard uncertainties of its own table, else of the file's, else
    /// those of its kind.
    pub(super) fn material(
        &mut self,
        name: &str,
        raw: &Spanned<RawMaterial>,
        of_file: &RawUncertainty,
    ) -> Result<Checked> {
        let mut checked = self.moduli(name, raw)?;
        let fields = raw.get_ref();
        let material = &mut checked.material;
        let key = |field: &str| format!("material.{name}.{field}");
        if let Some(factor) = &fields.shear_coefficient_factor {
            material.shear_coefficient_factor =
                self.toml.positive(&key("shear_coefficient_factor"), factor)?;
        }
        if let Some(strength) = &fields.yield_strength_mpa {
            let (key, unit) = (key("yield_strength_mpa"), MPA);
            let megapascals = self.toml.positive(&key, strength)?;
            self.usual(&key, megapascals, "MPa", 5.0, 10_000.0);
            material.yield_strength = Some(megapascals * unit);
        }
        let known = &mut material.standard_uncertainty;
        for (field, own, file, target) in [
            (
                "youngs_modulus_percent",
                &fields.youngs_modulus_percent,
                &of_file.youngs_modulus_percent,
                &mut known.youngs_modulus,
            ),
            (
                "shear_modulus_percent",
                &fields.shear_modulus_percent,
                &of_file.shear_modulus_percent,
                &mut known.shear_modulus,
            ),
            ("density_percent", &fields.density_percent, &of_file.density_percent, &mut known.density),
            (
                "shear_coefficient_percent",
                &fields.shear_coefficient_percent,
                &of_file.shear_coefficient_percent,
                &mut known.shear_coefficient,
            ),
        ] {
            match (own, file) {
                (Some(own), _) => *target = self.percent(&key(field), own)?,
                (None, Some(file)) => *target = self.percent(&of_table(field), file)?,
                (None, None) => {}
            }
        }
        Ok(checked)
    }

    /// The material with its moduli and the standard uncertainties of its kind.
    fn moduli(&mut self, name: &str, raw: &Spanned<RawMaterial>) -> Result<Checked> {
        let fields = raw.get_ref();
        let key = |field: &str| format!("material.{name}.{field}");
        let density = self.toml.not_negative(&key("density_kg_m3"), &fields.density_kg_m3)?;
        self.usual(&key("density_kg_m3"), density, "kg/m³", 100.0, 25_000.0);
        let moduli = (&fields.youngs_modulus_gpa, &fields.shear_modulus_gpa, &fields.poisson_ratio);
        let material = match moduli {
            (None, None, None) if fields.is_laminate() => return self.laminate(name, raw, density),
            (Some(e), Some(g), nu) if !fields.is_laminate() => {
                let e = self.modulus(&key("youngs_modulus_gpa"), e)?;
                let g = self.modulus(&key("shear_modulus_gpa"), g)?;
                match nu {
                    // across an anisotropic wall it may exceed that of any isotropic material
                    Some(nu) => {
                        let stated = self.poisson_ratio(name, nu, 1.0)?;
                        let material = Material::anisotropic(name, e, g, stated, density);
                        let ratio = isotropic_poisson_ratio(e, g);
                        if material.is_anisotropic() && (0.0..=0.5).contains(&ratio) {
                            let material = name.to_owned();
                            self.warnings.push(Warning::PoissonRatio { material, stated, ratio });
                        }
                        material
                    }
                    None => {
                        let ratio = isotropic_poisson_ratio(e, g);
                        if ratio > 0.5 {
                            self.warnings.push(Warning::Anisotropic { material: name.to_owned(), ratio });
                        }
                        Material::with_moduli(name, e, g, density)
                    }
                }
            }
            (Some(e), None, Some(nu)) if !fields.is_laminate() => {
                let e = self.modulus(&key("youngs_modulus_gpa"), e)?;
                Material::isotropic(name, e, self.poisson_ratio(name, nu, 0.5)?, density)
            }
            _ => return Err(self.undecided(name, raw)),
        };
        Ok(Checked { material, laminate_thickness: None })
    }

    fn poisson_ratio(&self, name: &str, number: &Number, largest: f64) -> Result<f64> {
        let key = format!("material.{name}.poisson_ratio");
        let ratio = self.toml.finite(&key, number)?;
        if ratio > -1.0 && ratio <= largest {
            return Ok(ratio);
        }
        Err(self.toml.is(&key, number, &format!("a Poisson's ratio, -1 < ν <= {largest}")))
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
        let nu = wall.poisson_ratio.clamp(0.0, 0.5);
        let mut material = Material::anisotropic(name, wall.youngs_modulus, wall.shear_modulus, nu, density);
        // lay-up and fibre content are not better known where E/G happens to be an isotropic one
        material.standard_uncertainty = MaterialUncertainty::ANISOTROPIC;
        material.plies = Some(plies.into());
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
        let by_moduli = read("youngs_modulus_gpa = 200\nshear_modulus_gpa = 80").pipe1.material;
        assert!(rod.pipe1.material.is_shear_modulus_derived && !by_moduli.is_shear_modulus_derived);
        assert_eq!(rod.pipe1.material, Material { is_shear_modulus_derived: true, ..by_moduli });
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
    #[test]
    fn an_anisotropic_material_may_state_its_poisson_ratio() {
        let rod = read("youngs_modulus_gpa = 118\nshear_modulus_gpa = 9.5\npoisson_ratio = 0.35");
        assert_eq!(rod.pipe1.material, Material::anisotropic("m", 118e9, 9.5e9, 0.35, 1600.0));
        assert_eq!(rod.warnings, []);
        let rod = read("youngs_modulus_gpa = 118\nshear_modulus_gpa = 9.5\nshear_coefficient_factor = 1.1");
        assert_eq!(rod.pipe1.material.poisson_ratio, 0.3);
        assert_eq!(rod.pipe1.material.shear_coefficient_factor, 1.1);
        assert_eq!(rod.warnings.len(), 1);
        let kappa = rod.pipe1.section.shear_coefficients(118.0 / 9.5, 0.3)[0];
        assert_relative_eq!(rod.pipe1.shear_coefficients()[0], 1.1 * kappa, max_relative = 1e-12);
    }
}
