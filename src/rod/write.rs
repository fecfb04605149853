//! Writes a rod as a file, such that reading it gives the same rod.

use super::constants;
use super::{BendFlexibility, Pipe, Rod, RodLaw, StandardUncertainty};
use crate::material::Material;
use crate::section::Section;
use crate::toml_text::{comments, in_unit, quoted};
use crate::units::{DEG, GPA, GRAM, MM, MPA, PERCENT, URAD_PER_NM};

impl Rod {
    /// This rod as a file, the format of [`Rod::from_toml`], below `above`, lines of comments.
    ///
    /// Materials are written as moduli, a laminate as the two that a beam needs and Poisson's
    /// ratio; standard uncertainties where they are not the default. Every number has
    /// as many digits as it takes to read the very same one again; where the change of units makes
    /// that impossible, the last bit may differ.
    pub fn to_toml(&self, above: &[String]) -> String {
        let mut text = comments(above);
        let mut line = |line: String| text += &(line + "\n");
        line(format!("name = {}", quoted(&self.name)));
        if let Some(source) = &self.source {
            line(format!("source = {}", quoted(source)));
        }
        if let Some(range) = self.linear_range {
            line(format!("linear_range_n = {range:?}"));
        }
        line("\n[geometry]".into());
        for (key, value, unit) in [
            ("l1_mm", self.l1, MM),
            ("l2_mm", self.l2, MM),
            ("gamma_deg", self.gamma, DEG),
            ("bend_radius_mm", self.bend_radius, MM),
        ] {
            line(format!("{key} = {:?}", in_unit(value, unit)));
        }
        line(match self.bend_flexibility {
            BendFlexibility::Beam => "bend_flexibility = \"beam\"".into(),
            BendFlexibility::VonKarman => "bend_flexibility = \"von-karman\"".into(),
            BendFlexibility::AsmeB313 => "bend_flexibility = \"asme-b31.3\"".into(),
            BendFlexibility::Factor(k) => format!("bend_flexibility = {k:?}"),
        });
        let pipes = [("pipe1", &self.pipe1), ("bend", &self.bend), ("pipe2", &self.pipe2)];
        let of_sleeves = self.sleeves.iter().map(|sleeve| ("sleeve", &sleeve.pipe));
        let all: Vec<(&str, &Pipe)> = pipes.into_iter().chain(of_sleeves).collect();
        let materials = named(&all);
        for (name, material) in &materials {
            line(format!("\n[material.{}]", quoted(name)));
            line(format!("youngs_modulus_gpa = {:?}", in_unit(material.youngs_modulus, GPA)));
            line(format!("shear_modulus_gpa = {:?}", in_unit(material.shear_modulus, GPA)));
            line(format!("density_kg_m3 = {:?}", material.density));
            material_details(material).into_iter().for_each(&mut line);
        }
        let pipe_lines = |pipe: &Pipe| -> Vec<String> {
            let known = materials.iter().find(|(_, material)| *material == &pipe.material);
            let name = known.map_or(pipe.material.name.as_str(), |(name, _)| name.as_str());
            let sizes = section(&pipe.section).into_iter();
            let sizes = sizes.map(|(key, value, unit)| format!("{key} = {:?}", in_unit(value, unit)));
            [format!("material = {}", quoted(name))].into_iter().chain(sizes).collect()
        };
        for (key, pipe) in pipes {
            line(format!("\n[{key}]"));
            pipe_lines(pipe).into_iter().for_each(&mut line);
        }
        line(format!("\n[tip]\nmass_g = {:?}", in_unit(self.tip_mass, GRAM)));
        for mass in &self.masses {
            line(format!("\n[[mass]]\nname = {}", quoted(&mass.name)));
            line(format!("station_mm = {:?}", in_unit(mass.station, MM)));
            line(format!("mass_g = {:?}", in_unit(mass.mass, GRAM)));
        }
        for joint in &self.joints {
            line(format!("\n[[joint]]\nname = {}", quoted(&joint.name)));
            line(format!("station_mm = {:?}", in_unit(joint.station, MM)));
            line(format!("bending_urad_per_nm = {:?}", in_unit(joint.bending, URAD_PER_NM)));
            line(format!("torsion_urad_per_nm = {:?}", in_unit(joint.torsion, URAD_PER_NM)));
        }
        for sleeve in &self.sleeves {
            line(format!("\n[[sleeve]]\nname = {}", quoted(&sleeve.name)));
            line(format!("from_mm = {:?}", in_unit(sleeve.from, MM)));
            line(format!("to_mm = {:?}", in_unit(sleeve.to, MM)));
            pipe_lines(&sleeve.pipe).into_iter().for_each(&mut line);
        }
        self.laws.iter().flat_map(law).for_each(&mut line);
        let (own, usual) = (&self.standard_uncertainty, StandardUncertainty::default());
        let known = [
            ("diameter_mm", own.diameter, usual.diameter, MM),
            ("length_mm", own.length, usual.length, MM),
            ("tip_mass_g", own.tip_mass, usual.tip_mass, GRAM),
            ("section_percent", own.section, usual.section, PERCENT),
        ];
        if known.iter().any(|(_, own, usual, _)| own != usual) {
            line("\n[standard_uncertainty]".into());
        }
        for (key, own, _, unit) in known.into_iter().filter(|(_, own, usual, _)| own != usual) {
            line(format!("{key} = {:?}", in_unit(own, unit)));
        }
        text
    }
}

/// What a material has besides E, G and ρ and what does not follow from them.
fn material_details(material: &Material) -> Vec<String> {
    let Material { name, youngs_modulus: e, shear_modulus: g, density, .. } = material;
    let mut lines = Vec::new();
    let mut read = Material::with_moduli(name, *e, *g, *density);
    // by moduli alone the ratio is the same but for its last bits
    if (read.poisson_ratio - material.poisson_ratio).abs() > 1e-12 {
        lines.push(format!("poisson_ratio = {:?}", material.poisson_ratio));
        read = Material::anisotropic(name, *e, *g, material.poisson_ratio, *density);
    }
    if material.shear_coefficient_factor != 1.0 {
        lines.push(format!("shear_coefficient_factor = {:?}", material.shear_coefficient_factor));
    }
    if let Some(strength) = material.yield_strength {
        lines.push(format!("yield_strength_mpa = {:?}", in_unit(strength, MPA)));
    }
    let (own, usual) = (&material.standard_uncertainty, &read.standard_uncertainty);
    for (key, own, usual) in [
        ("youngs_modulus_percent", own.youngs_modulus, usual.youngs_modulus),
        ("shear_modulus_percent", own.shear_modulus, usual.shear_modulus),
        ("density_percent", own.density, usual.density),
        ("shear_coefficient_percent", own.shear_coefficient, usual.shear_coefficient),
    ] {
        if own != usual {
            lines.push(format!("{key} = {:?}", in_unit(own, PERCENT)));
        }
    }
    lines
}

/// The lines of a law.
fn law(law: &RodLaw) -> Vec<String> {
    let mut lines = vec![
        format!("\n[[law]]\nplace = {}", quoted(&law.place.to_string())),
        format!("variable = {}", quoted(law.variable.key())),
        format!("formula = {}", quoted(&law.formula)),
    ];
    lines.extend(law.memory.map(|memory| format!("memory = {}", quoted(memory.key()))));
    lines.extend(constants::written(law.range, law.source.as_deref(), &law.constants));
    lines
}

/// Keys, values in SI and units of a section.
fn section(section: &Section) -> Vec<(&'static str, f64, f64)> {
    let fourth = MM * MM * MM * MM;
    match section {
        Section::Round(round) => vec![
            ("outer_diameter_mm", round.outer_diameter, MM),
            ("inner_diameter_mm", round.inner_diameter, MM),
        ],
        Section::Rectangle(rectangle) => [("width_mm", rectangle.width), ("height_mm", rectangle.height)]
            .into_iter()
            .chain(rectangle.wall.map(|wall| ("wall_mm", wall)))
            .map(|(key, value)| (key, value, MM))
            .collect(),
        Section::General(general) => vec![
            ("area_mm2", general.area, MM * MM),
            ("iy_mm4", general.iy, fourth),
            ("iz_mm4", general.iz, fourth),
            ("j_mm4", general.torsion_constant, fourth),
            ("kappa", general.shear_coefficient, 1.0),
        ],
    }
}

/// The different materials of the pipes, each with a name of its own.
fn named<'a>(pipes: &[(&str, &'a Pipe)]) -> Vec<(String, &'a Material)> {
    let mut named: Vec<(String, &Material)> = Vec::new();
    for (key, pipe) in pipes {
        let material = &pipe.material;
        if named.iter().any(|(_, known)| *known == material) {
            continue;
        }
        let is_taken = named.iter().any(|(name, _)| *name == material.name);
        let name = if is_taken { format!("{} of {key}", material.name) } else { material.name.clone() };
        named.push((name, material));
    }
    named
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::section::{General, Rectangle};

    /// Written and read again.
    fn again(rod: &Rod) -> Rod {
        let text = rod.to_toml(&["first\nsecond".into()]);
        assert!(text.starts_with("# first\n# second\nname = "), "{text}");
        Rod::from_toml("rod", &text).expect(&text)
    }

    #[test]
    fn a_rod_that_is_written_is_read_as_the_same() {
        for text in [
            include_str!("../../rods/1.toml"),
            include_str!("../../rods/3.toml"),
            include_str!("../../rods/6.toml"),
        ] {
            let rod = Rod::from_toml("rod", text).unwrap();
            let written = again(&rod);
            for (a, b) in [(&rod.pipe1, &written.pipe1), (&rod.bend, &written.bend)] {
                assert_eq!(a.section, b.section);
                assert!((a.material.youngs_modulus / b.material.youngs_modulus - 1.0).abs() < 1e-15);
                assert!((a.material.shear_modulus / b.material.shear_modulus - 1.0).abs() < 1e-15);
            }
            assert_eq!((&rod.source, rod.l1, rod.gamma), (&written.source, written.l1, written.gamma));
            assert_eq!((&rod.masses, &rod.joints), (&written.masses, &written.joints));
            assert!(rod.sleeves.is_empty());
            assert_eq!(rod.tip_mass, written.tip_mass);
        }
    }

    #[test]
    fn parts_of_one_material_that_differ_get_names_of_their_own() {
        let joint = "[[joint]]\nname = \"a \\\"b\\\"\"\nstation_mm = 205\ntorsion_urad_per_nm = 1.5\n";
        let mut rod = Rod::from_toml("rod", &(include_str!("../../rods/5.toml").to_owned() + joint)).unwrap();
        rod.pipe2.material.youngs_modulus *= 0.7;
        rod.bend_flexibility = BendFlexibility::Factor(1.75);
        let mut collar = Pipe::new(crate::section::Round::tube(0.036, 0.032), rod.pipe1.material.clone());
        rod = rod.with_sleeve("over", 0.2, 0.25, collar.clone());
        collar.material.density *= 2.0;
        let tip = rod.length();
        rod = rod.with_sleeve("heavy", 0.5, tip, collar);
        let written = again(&rod);
        assert_eq!(written.joints, rod.joints);
        for (a, b) in written.sleeves.iter().zip(&rod.sleeves) {
            assert_eq!((&a.name, a.from, a.to), (&b.name, b.from, b.to));
            let [outer, known] = [a, b].map(|sleeve| sleeve.pipe.section.height());
            assert!((outer - known).abs() < 1e-15 && a.pipe.material.density == b.pipe.material.density);
        }
        assert_eq!(written.sleeves.len(), 2);
        assert_eq!(written.bend_flexibility, rod.bend_flexibility);
        assert_ne!(written.pipe1.material.youngs_modulus, written.pipe2.material.youngs_modulus);
    }
    #[test]
    fn sections_and_uncertainties_are_written_where_they_are_not_the_usual() {
        let plain = Rod::from_toml("rod", include_str!("../../rods/5.toml")).unwrap();
        let text = plain.to_toml(&[]);
        assert!(!text.contains("percent") && !text.contains("uncertainty"), "{text}");

        let mut rod = plain;
        rod.pipe2.section = Rectangle::hollow(0.01, 0.02, 0.0015).into();
        rod.pipe1.section =
            General { area: 2e-4, iy: 6e-9, iz: 2.3e-9, torsion_constant: 4e-9, shear_coefficient: 0.85 }
                .into();
        rod.bend.section = Rectangle::solid(0.01, 0.02).into();
        rod.pipe2.material = Material::anisotropic("carbon", 118e9, 9.5e9, 0.35, 1600.0);
        rod.pipe2.material.shear_coefficient_factor = 1.07;
        rod.pipe2.material.yield_strength = Some(205e6);
        rod.pipe2.material.standard_uncertainty.youngs_modulus = 0.03;
        rod.pipe1.material.standard_uncertainty.density = 0.0;
        rod.standard_uncertainty.length = 0.1 * MM;
        rod.standard_uncertainty.section = 0.02;
        let written = again(&rod);
        for (a, b) in [(&rod.pipe1, &written.pipe1), (&rod.bend, &written.bend), (&rod.pipe2, &written.pipe2)]
        {
            assert_eq!(
                (a.section, a.material.standard_uncertainty),
                (b.section, b.material.standard_uncertainty)
            );
            assert_eq!(a.material.shear_coefficient_factor, b.material.shear_coefficient_factor);
            assert_eq!(a.material.yield_strength, b.material.yield_strength);
            assert!((a.material.poisson_ratio - b.material.poisson_ratio).abs() < 1e-12);
        }
        assert_eq!(rod.standard_uncertainty, written.standard_uncertainty);
        assert_eq!(written.to_toml(&[]), rod.to_toml(&[]));
    }
}
