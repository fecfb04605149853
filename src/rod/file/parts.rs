//! The parts of a rod file: pipes, and what sits along them.

use std::collections::BTreeMap;

use serde::Deserialize;
use toml::Spanned;

use super::check::Check;
use super::materials::Checked;
use crate::delimited::nearest_name;
use crate::error::{Error, Result};
use crate::material::{Material, listed};
use crate::rod::{Joint, LumpedMass, Pipe, Rod, Sleeve, Warning};
use crate::toml_text::Number;
use crate::units::{GRAM, MM, URAD_PER_NM};

#[derive(Deserialize)]
#[serde(deny_unknown_fields, expecting = "a section with material, outer_diameter_mm, inner_diameter_mm")]
pub(super) struct RawPipe {
    material: Spanned<String>,
    pub outer_diameter_mm: Option<Number>,
    pub inner_diameter_mm: Option<Number>,
    pub width_mm: Option<Number>,
    pub height_mm: Option<Number>,
    pub wall_mm: Option<Number>,
    pub area_mm2: Option<Number>,
    pub iy_mm4: Option<Number>,
    pub iz_mm4: Option<Number>,
    pub j_mm4: Option<Number>,
    pub kappa: Option<Number>,
}

#[derive(Deserialize)]
#[serde(deny_unknown_fields, expecting = "a section [tip] with mass_g")]
pub(super) struct RawTip {
    mass_g: Number,
}

#[derive(Deserialize)]
#[serde(deny_unknown_fields, expecting = "a section [[mass]]")]
pub struct RawMass {
    name: String,
    station_mm: Number,
    mass_g: Number,
}

#[derive(Deserialize)]
#[serde(deny_unknown_fields, expecting = "a section [[joint]]")]
pub struct RawJoint {
    name: Spanned<String>,
    station_mm: Number,
    bending_urad_per_nm: Option<Number>,
    torsion_urad_per_nm: Option<Number>,
}

#[derive(Deserialize)]
#[serde(deny_unknown_fields, expecting = "a section [[sleeve]]")]
pub struct RawSleeve {
    name: String,
    from_mm: Number,
    to_mm: Number,
    material: Spanned<String>,
    outer_diameter_mm: Option<Number>,
    inner_diameter_mm: Option<Number>,
    width_mm: Option<Number>,
    height_mm: Option<Number>,
    wall_mm: Option<Number>,
    area_mm2: Option<Number>,
    iy_mm4: Option<Number>,
    iz_mm4: Option<Number>,
    j_mm4: Option<Number>,
    kappa: Option<Number>,
}

impl RawSleeve {
    /// What it has in common with a pipe.
    fn pipe(&self) -> RawPipe {
        RawPipe {
            material: self.material.clone(),
            outer_diameter_mm: self.outer_diameter_mm.clone(),
            inner_diameter_mm: self.inner_diameter_mm.clone(),
            width_mm: self.width_mm.clone(),
            height_mm: self.height_mm.clone(),
            wall_mm: self.wall_mm.clone(),
            area_mm2: self.area_mm2.clone(),
            iy_mm4: self.iy_mm4.clone(),
            iz_mm4: self.iz_mm4.clone(),
            j_mm4: self.j_mm4.clone(),
            kappa: self.kappa.clone(),
        }
    }
}

impl Check<'_> {
    pub(super) fn pipe(
        &mut self,
        which: &'static str,
        raw: &Spanned<RawPipe>,
        materials: &BTreeMap<String, Checked>,
    ) -> Result<Pipe> {
        let key = |field: &str| format!("{which}.{field}");
        let named = &raw.get_ref().material;
        let material = named.get_ref();
        let Some(checked) = materials.get(material) else {
            return Err(self.unknown_material(&key("material"), named, materials));
        };
        let section = self.section(which, raw)?;
        if let (Some(plies), Some(wall)) = (checked.laminate_thickness, section.wall())
            && (plies / wall - 1.0).abs() > 0.01
        {
            let material = material.clone();
            self.warnings.push(Warning::LaminateThickness { material, plies, pipe: which, wall });
        }
        Ok(Pipe { section, material: checked.material.clone() })
    }

    fn unknown_material(
        &self,
        key: &str,
        name: &Spanned<String>,
        materials: &BTreeMap<String, Checked>,
    ) -> Error {
        let known: Vec<&str> = materials.keys().map(String::as_str).collect();
        let expected = match known.as_slice() {
            [] => "a material with a section [material.NAME]; the file has none".to_owned(),
            known => format!("one of the file's materials: {}", listed(known)),
        };
        let hint = nearest_name(name.get_ref(), &known).map(|near| format!("did you mean \"{near}\"?"));
        self.toml.is(key, name, &expected).with_hint(hint)
    }

    pub(super) fn tip(&mut self, raw: &RawTip) -> Result<f64> {
        self.mass("tip.mass_g", &raw.mass_g)
    }

    /// A mass on a rod of this length, m.
    pub fn lumped_mass(&mut self, raw: &RawMass, length: f64) -> Result<LumpedMass> {
        Ok(LumpedMass {
            name: raw.name.clone(),
            station: self.station("mass.station_mm", &raw.station_mm, length)?,
            mass: self.mass("mass.mass_g", &raw.mass_g)?,
        })
    }

    /// A joint beside those that are `known`, on a rod of this length, m.
    pub fn joint(&self, raw: &RawJoint, known: &[Joint], length: f64) -> Result<Joint> {
        let name = raw.name.get_ref().clone();
        if known.iter().any(|other| other.name == name) {
            let found = format!("a second joint is named {}", self.toml.source(&raw.name));
            return Err(self.toml.wrong(&raw.name, found, "a name of its own for each joint"));
        }
        let compliance = |key: &str, number: &Option<Number>| match number {
            Some(number) => Ok(self.toml.not_negative(key, number)? * URAD_PER_NM),
            None => Ok(0.0),
        };
        Ok(Joint {
            name,
            station: self.station("joint.station_mm", &raw.station_mm, length)?,
            bending: compliance("joint.bending_urad_per_nm", &raw.bending_urad_per_nm)?,
            torsion: compliance("joint.torsion_urad_per_nm", &raw.torsion_urad_per_nm)?,
        })
    }

    /// A sleeve on a rod that has those before it.
    pub(super) fn sleeve(
        &mut self,
        raw: &Spanned<RawSleeve>,
        rod: &Rod,
        materials: &BTreeMap<String, Checked>,
    ) -> Result<Sleeve> {
        let fields = raw.get_ref();
        let pipe = self.pipe("sleeve", &Spanned::new(raw.span(), fields.pipe()), materials)?;
        let sleeve = self.on(fields, pipe, rod.length())?;
        if let Some(expected) = rod.no_stretch(sleeve.from, sleeve.to) {
            return Err(self.toml.is("sleeve.to_mm", &fields.to_mm, &expected));
        }
        if let Some(other) = rod.in_the_way(&rod.sleeves, &sleeve.pipe.section, sleeve.from, sleeve.to) {
            let found = format!("the wall of sleeve {:?} would be where that of {other} is", fields.name);
            return Err(self.toml.wrong(raw, found, "a tube over it or in it"));
        }
        Ok(sleeve)
    }

    /// A sleeve for rods that are not known yet.
    ///
    /// # Errors
    /// [`Error::Input`] for a section, a material or stations that are none.
    pub fn sleeve_apart(
        &mut self,
        raw: &Spanned<RawSleeve>,
        materials: &BTreeMap<String, Material>,
    ) -> Result<Sleeve> {
        let checked = |(name, material): (&String, &Material)| {
            (name.clone(), Checked { material: material.clone(), laminate_thickness: None })
        };
        let checked: BTreeMap<String, Checked> = materials.iter().map(checked).collect();
        let fields = raw.get_ref();
        let pipe = self.pipe("sleeve", &Spanned::new(raw.span(), fields.pipe()), &checked)?;
        let sleeve = self.on(fields, pipe, f64::INFINITY)?;
        if sleeve.from >= sleeve.to {
            return Err(self.toml.is("sleeve.to_mm", &fields.to_mm, "an end beyond the beginning, from_mm"));
        }
        Ok(sleeve)
    }

    /// What is read of a sleeve on a rod of this length, m.
    fn on(&self, fields: &RawSleeve, pipe: Pipe, length: f64) -> Result<Sleeve> {
        let from = self.station("sleeve.from_mm", &fields.from_mm, length)?;
        let to = self.station("sleeve.to_mm", &fields.to_mm, length)?;
        Ok(Sleeve { name: fields.name.clone(), from, to, pipe })
    }

    /// A station on the rod, m. The tip may be named with the last digit rounded.
    fn station(&self, key: &str, number: &Number, length: f64) -> Result<f64> {
        let station = self.toml.finite(key, number)? * MM;
        if station < 0.0 || station > length + 1e-6 {
            let expected = match length.is_finite() {
                true => format!("a station on the rod, 0 to {:.3} mm (the tip)", length / MM),
                false => "a station on the rod, 0 mm (the flange) or more".to_owned(),
            };
            return Err(self.toml.is(key, number, &expected));
        }
        Ok(station.min(length))
    }

    /// A mass in g, kg.
    pub fn mass(&mut self, key: &str, number: &Number) -> Result<f64> {
        let grams = self.toml.not_negative(key, number)?;
        self.usual(key, grams, "g", 0.1, 20_000.0);
        Ok(grams * GRAM)
    }
}
