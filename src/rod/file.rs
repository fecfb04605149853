//! The reader of rod files (`rods/*.toml`): every error names the line and what would be right there.

use std::collections::BTreeMap;
use std::path::Path;

use serde::Deserialize;
use toml::Spanned;

use super::{BendFlexibility, Joint, LumpedMass, Pipe, Rod, Warning, tangent_length};
use crate::error::{Error, Place, Result};
use crate::files;
use crate::material::{Material, isotropic_poisson_ratio, laminate};
use crate::section::Round;
use crate::units::{GPA, GRAM, MM, URAD_PER_NM};

impl Rod {
    /// Reads and checks a rod file.
    ///
    /// # Errors
    /// [`Error::File`] where it cannot be read; [`Error::Syntax`] or [`Error::Input`] with line and column otherwise.
    pub fn read(path: &Path) -> Result<Rod> {
        Rod::from_toml(&path.display().to_string(), &files::read_text(path)?)
    }

    /// Reads and checks the text of a rod file; `file` names it in errors (and the rod, where it has no `name`).
    ///
    /// # Errors
    /// As [`Rod::read`].
    pub fn from_toml(file: &str, text: &str) -> Result<Rod> {
        let raw: RawRod = toml::from_str(text).map_err(|e| Error::Syntax {
            at: e.span().map_or(Place::whole_file(file), |s| Place::of_offset(file, text, s.start)),
            message: e.message().replace('\n', ", "),
        })?;
        Check { file, text }.rod(raw)
    }
}

type Number = Spanned<f64>;

#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
struct RawRod {
    name: Option<String>,
    linear_range_n: Option<Number>,
    geometry: RawGeometry,
    material: BTreeMap<String, Spanned<RawMaterial>>,
    pipe1: RawPipe,
    pipe2: RawPipe,
    bend: Option<RawPipe>,
    tip: Option<RawTip>,
    #[serde(default)]
    mass: Vec<RawMass>,
    #[serde(default)]
    joint: Vec<RawJoint>,
}

#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
struct RawGeometry {
    l1_mm: Number,
    l2_mm: Number,
    gamma_deg: Option<Number>,
    bend_radius_mm: Option<Number>,
    bend_flexibility: Option<Spanned<RawFlexibility>>,
}

#[derive(Deserialize)]
#[serde(untagged)]
enum RawFlexibility {
    Factor(f64),
    Name(String),
}

#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
struct RawMaterial {
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

#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
struct RawPipe {
    material: Spanned<String>,
    outer_diameter_mm: Number,
    inner_diameter_mm: Number,
}

#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
struct RawTip {
    mass_g: Number,
}

#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
struct RawMass {
    name: String,
    station_mm: Number,
    mass_g: Number,
}

#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
struct RawJoint {
    name: Spanned<String>,
    station_mm: Number,
    bending_urad_per_nm: Option<Number>,
    torsion_urad_per_nm: Option<Number>,
}

/// A material as checked, with what its laminate has to say to the pipes that use it.
struct Checked {
    material: Material,
    laminate_thickness: Option<f64>,
}

/// The file's text, to find the line of whatever is wrong.
struct Check<'a> {
    file: &'a str,
    text: &'a str,
}

impl Check<'_> {
    fn rod(&self, raw: RawRod) -> Result<Rod> {
        let mut warnings = Vec::new();
        let geometry = &raw.geometry;
        let l1 = self.positive("geometry.l1_mm", &geometry.l1_mm)? * MM;
        let l2 = self.positive("geometry.l2_mm", &geometry.l2_mm)? * MM;
        let gamma = self.angle(geometry.gamma_deg.as_ref())?;
        let bend_radius = self.bend_radius(geometry, l1, l2, gamma, &mut warnings)?;
        let bend_flexibility = self.bend_flexibility(geometry.bend_flexibility.as_ref())?;

        let mut materials = BTreeMap::new();
        for (name, material) in &raw.material {
            materials.insert(name.as_str(), self.material(name, material, &mut warnings)?);
        }
        let pipe1 = self.pipe("pipe1", &raw.pipe1, &materials, &mut warnings)?;
        let pipe2 = self.pipe("pipe2", &raw.pipe2, &materials, &mut warnings)?;
        let bend = match &raw.bend {
            Some(bend) => self.pipe("bend", bend, &materials, &mut warnings)?,
            None => pipe1.clone(),
        };
        let tube_radius = bend.section.outer_diameter / 2.0;
        if bend_radius > 0.0 && bend_radius < tube_radius {
            warnings.push(Warning::TightBend { radius: bend_radius, tube_radius });
        }

        let mut rod = Rod {
            name: raw.name.unwrap_or_else(|| file_stem(self.file)),
            l1,
            l2,
            gamma,
            bend_radius,
            bend_flexibility,
            pipe1,
            bend,
            pipe2,
            tip_mass: match &raw.tip {
                Some(tip) => self.not_negative("tip.mass_g", &tip.mass_g)? * GRAM,
                None => 0.0,
            },
            masses: Vec::new(),
            joints: Vec::new(),
            linear_range: match &raw.linear_range_n {
                Some(range) => Some(self.positive("linear_range_n", range)?),
                None => None,
            },
            warnings,
        };
        for mass in &raw.mass {
            rod.masses.push(LumpedMass {
                station: self.station("mass.station_mm", &mass.station_mm, rod.length())?,
                mass: self.not_negative("mass.mass_g", &mass.mass_g)? * GRAM,
                name: mass.name.clone(),
            });
        }
        for joint in &raw.joint {
            if rod.joints.iter().any(|other| other.name == *joint.name.get_ref()) {
                let found = format!("a second joint is named \"{}\"", joint.name.get_ref());
                return Err(self.wrong(joint.name.span().start, found, "a name of its own for each joint"));
            }
            let compliance = |key: &str, number: &Option<Number>| match number {
                Some(number) => Ok(self.not_negative(key, number)? * URAD_PER_NM),
                None => Ok(0.0),
            };
            rod.joints.push(Joint {
                name: joint.name.get_ref().clone(),
                station: self.station("joint.station_mm", &joint.station_mm, rod.length())?,
                bending: compliance("joint.bending_urad_per_nm", &joint.bending_urad_per_nm)?,
                torsion: compliance("joint.torsion_urad_per_nm", &joint.torsion_urad_per_nm)?,
            });
        }
        Ok(rod)
    }

    fn angle(&self, gamma: Option<&Number>) -> Result<f64> {
        let Some(number) = gamma else { return Ok(std::f64::consts::FRAC_PI_2) };
        let degrees = self.finite("geometry.gamma_deg", number)?;
        if degrees > 0.0 && degrees <= 180.0 {
            return Ok(degrees.to_radians());
        }
        let expected =
            "the inside angle between the pipes in degrees, 0 < gamma_deg <= 180 (180 is a straight rod)";
        Err(self.is("geometry.gamma_deg", number, expected))
    }

    fn bend_radius(
        &self,
        geometry: &RawGeometry,
        l1: f64,
        l2: f64,
        gamma: f64,
        warnings: &mut Vec<Warning>,
    ) -> Result<f64> {
        let Some(number) = &geometry.bend_radius_mm else { return Ok(0.0) };
        let radius = self.not_negative("geometry.bend_radius_mm", number)? * MM;
        if gamma == std::f64::consts::PI {
            if radius > 0.0 {
                warnings.push(Warning::NoBend);
            }
            return Ok(0.0);
        }
        let (tangent, shorter) = (tangent_length(radius, gamma), l1.min(l2));
        if tangent <= shorter {
            return Ok(radius);
        }
        let largest = radius * shorter / tangent;
        let expected = format!(
            "at most {:.3} mm: an arc tangent to both pipes takes {:.3} mm off each and the shorter one has {:.3} mm",
            largest / MM,
            tangent / MM,
            shorter / MM
        );
        Err(self.is("geometry.bend_radius_mm", number, &expected))
    }

    fn bend_flexibility(&self, raw: Option<&Spanned<RawFlexibility>>) -> Result<BendFlexibility> {
        let Some(raw) = raw else { return Ok(BendFlexibility::Beam) };
        let expected = "\"beam\", \"von-karman\", \"asme-b31.3\" or a factor > 0";
        let found = match raw.get_ref() {
            RawFlexibility::Name(name) => match name.as_str() {
                "beam" => return Ok(BendFlexibility::Beam),
                "von-karman" => return Ok(BendFlexibility::VonKarman),
                "asme-b31.3" => return Ok(BendFlexibility::AsmeB313),
                other => format!("\"{other}\""),
            },
            RawFlexibility::Factor(k) if k.is_finite() && *k > 0.0 => return Ok(BendFlexibility::Factor(*k)),
            RawFlexibility::Factor(k) => k.to_string(),
        };
        Err(self.wrong(raw.span().start, format!("`geometry.bend_flexibility` is {found}"), expected))
    }

    fn material(
        &self,
        name: &str,
        raw: &Spanned<RawMaterial>,
        warnings: &mut Vec<Warning>,
    ) -> Result<Checked> {
        let key = |field: &str| format!("material.{name}.{field}");
        let fields = raw.get_ref();
        let density = self.not_negative(&key("density_kg_m3"), &fields.density_kg_m3)?;
        let is_laminate = fields.ply_angles_deg.is_some() || fields.ply_e1_gpa.is_some();
        let moduli = (&fields.youngs_modulus_gpa, &fields.shear_modulus_gpa, &fields.poisson_ratio);
        let two_ways = "either youngs_modulus_gpa with shear_modulus_gpa or poisson_ratio, or a laminate's ply_e1_gpa, ply_e2_gpa, ply_g12_gpa, ply_nu12, ply_thickness_mm, ply_angles_deg";
        match moduli {
            (None, None, None) if is_laminate => self.laminate(name, raw, density, warnings),
            (Some(e), Some(g), None) if !is_laminate => {
                let e = self.positive(&key("youngs_modulus_gpa"), e)? * GPA;
                let g = self.positive(&key("shear_modulus_gpa"), g)? * GPA;
                let ratio = isotropic_poisson_ratio(e, g);
                let material = Material::with_moduli(name, e, g, density);
                if ratio > 0.5 {
                    warnings.push(Warning::Anisotropic { material: name.to_owned(), ratio });
                }
                Ok(Checked { material, laminate_thickness: None })
            }
            (Some(e), None, Some(nu)) if !is_laminate => {
                let e = self.positive(&key("youngs_modulus_gpa"), e)? * GPA;
                let ratio = self.finite(&key("poisson_ratio"), nu)?;
                if !(ratio > -1.0 && ratio <= 0.5) {
                    return Err(self.is(&key("poisson_ratio"), nu, "a Poisson's ratio, -1 < ν <= 0.5"));
                }
                Ok(Checked {
                    material: Material::isotropic(name, e, ratio, density),
                    laminate_thickness: None,
                })
            }
            _ => {
                let found = match moduli {
                    (Some(_), Some(_), Some(_)) => "has both shear_modulus_gpa and poisson_ratio",
                    _ if is_laminate => "mixes moduli and plies",
                    (None, ..) => "has no youngs_modulus_gpa",
                    _ => "has neither shear_modulus_gpa nor poisson_ratio",
                };
                Err(self.wrong(raw.span().start, format!("material `{name}` {found}"), two_ways))
            }
        }
    }

    fn laminate(
        &self,
        name: &str,
        raw: &Spanned<RawMaterial>,
        density: f64,
        warnings: &mut Vec<Warning>,
    ) -> Result<Checked> {
        let fields = raw.get_ref();
        let required = |field: &'static str, number: &Option<Number>| match number {
            Some(number) => self.positive(&format!("material.{name}.{field}"), number),
            None => {
                let found = format!("laminate `{name}` has no {field}");
                Err(self.wrong(
                    raw.span().start,
                    found,
                    "all of ply_e1_gpa, ply_e2_gpa, ply_g12_gpa, ply_nu12, ply_thickness_mm, ply_angles_deg",
                ))
            }
        };
        let ply = laminate::Ply {
            e1: required("ply_e1_gpa", &fields.ply_e1_gpa)? * GPA,
            e2: required("ply_e2_gpa", &fields.ply_e2_gpa)? * GPA,
            g12: required("ply_g12_gpa", &fields.ply_g12_gpa)? * GPA,
            nu12: required("ply_nu12", &fields.ply_nu12)?,
            thickness: required("ply_thickness_mm", &fields.ply_thickness_mm)? * MM,
            angle: 0.0,
        };
        let angles = match &fields.ply_angles_deg {
            Some(angles) if !angles.get_ref().is_empty() => angles,
            other => {
                let at = other.as_ref().map_or(raw.span().start, |a| a.span().start);
                return Err(self.wrong(
                    at,
                    format!("laminate `{name}` has no plies"),
                    "ply_angles_deg with one angle for each ply, for example [0, 45, -45, 90]",
                ));
            }
        };
        let plies = angles
            .get_ref()
            .iter()
            .map(|angle| {
                let degrees = self.finite(&format!("material.{name}.ply_angles_deg"), angle)?;
                Ok(laminate::Ply { angle: degrees.to_radians(), ..ply })
            })
            .collect::<Result<Vec<_>>>()?;
        // a positive definite Q needs ν12² < E1/E2 (Jones Eq 2.56)
        let stable = ply.nu12 * ply.nu12 < ply.e1 / ply.e2;
        let Some(wall) = laminate::wall(&plies).filter(|_| stable) else {
            let found = format!("the plies of laminate `{name}` have no positive stiffness");
            return Err(self.wrong(raw.span().start, found, "ply_nu12² < ply_e1_gpa / ply_e2_gpa"));
        };
        if wall.coupling > 0.01 {
            warnings.push(Warning::LaminateCoupling { material: name.to_owned(), coupling: wall.coupling });
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

    fn pipe(
        &self,
        which: &'static str,
        raw: &RawPipe,
        materials: &BTreeMap<&str, Checked>,
        warnings: &mut Vec<Warning>,
    ) -> Result<Pipe> {
        let name = raw.material.get_ref();
        let Some(checked) = materials.get(name.as_str()) else {
            let known = materials.keys().map(|k| format!("\"{k}\"")).collect::<Vec<_>>().join(", ");
            let expected = format!("one of the file's materials: {known}");
            let found = format!("`{which}.material` is \"{name}\"");
            return Err(self.wrong(raw.material.span().start, found, &expected));
        };
        let key = |field: &str| format!("{which}.{field}");
        let outer_diameter = self.positive(&key("outer_diameter_mm"), &raw.outer_diameter_mm)? * MM;
        let inner_diameter = self.not_negative(&key("inner_diameter_mm"), &raw.inner_diameter_mm)? * MM;
        if inner_diameter >= outer_diameter {
            let expected = format!("less than the outer diameter, {} mm", raw.outer_diameter_mm.get_ref());
            return Err(self.is(&key("inner_diameter_mm"), &raw.inner_diameter_mm, &expected));
        }
        let section = Round { outer_diameter, inner_diameter };
        if let Some(plies) = checked.laminate_thickness
            && (plies / section.wall() - 1.0).abs() > 0.01
        {
            let material = name.clone();
            warnings.push(Warning::LaminateThickness { material, plies, pipe: which, wall: section.wall() });
        }
        Ok(Pipe { section, material: checked.material.clone() })
    }

    /// A station on the rod, m. The tip may be named with the last digit rounded.
    fn station(&self, key: &str, number: &Number, length: f64) -> Result<f64> {
        let station = self.finite(key, number)? * MM;
        if station < 0.0 || station > length + 1e-6 {
            let expected = format!("a station on the rod, 0 to {:.3} mm (the tip)", length / MM);
            return Err(self.is(key, number, &expected));
        }
        Ok(station.min(length))
    }

    fn finite(&self, key: &str, number: &Number) -> Result<f64> {
        let value = *number.get_ref();
        if value.is_finite() { Ok(value) } else { Err(self.is(key, number, "a finite number")) }
    }

    fn positive(&self, key: &str, number: &Number) -> Result<f64> {
        let value = self.finite(key, number)?;
        if value > 0.0 { Ok(value) } else { Err(self.is(key, number, "a number > 0")) }
    }

    fn not_negative(&self, key: &str, number: &Number) -> Result<f64> {
        let value = self.finite(key, number)?;
        if value >= 0.0 { Ok(value) } else { Err(self.is(key, number, "a number >= 0")) }
    }

    fn is(&self, key: &str, number: &Number, expected: &str) -> Error {
        self.wrong(number.span().start, format!("`{key}` is {}", number.get_ref()), expected)
    }

    fn wrong(&self, offset: usize, found: String, expected: &str) -> Error {
        Error::Input {
            at: Place::of_offset(self.file, self.text, offset),
            found,
            expected: expected.to_owned(),
            hint: None,
        }
    }
}

/// `rods/5.toml` → `5`.
fn file_stem(file: &str) -> String {
    Path::new(file).file_stem().map_or_else(|| file.to_owned(), |s| s.to_string_lossy().into_owned())
}
