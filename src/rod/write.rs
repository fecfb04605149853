//! Writes a rod as a file, such that reading it gives the same rod.

use super::{BendFlexibility, Pipe, Rod};
use crate::material::Material;
use crate::toml_text::{comments, in_unit, quoted};
use crate::units::{DEG, GPA, GRAM, MM, URAD_PER_NM};

impl Rod {
    /// This rod as a file, the format of [`Rod::from_toml`], below `above`, lines of comments.
    ///
    /// Materials are written as moduli, a laminate as the two that a beam needs. Every number has
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
        let materials = named(&pipes);
        for (name, material) in &materials {
            line(format!("\n[material.{}]", quoted(name)));
            line(format!("youngs_modulus_gpa = {:?}", in_unit(material.youngs_modulus, GPA)));
            line(format!("shear_modulus_gpa = {:?}", in_unit(material.shear_modulus, GPA)));
            line(format!("density_kg_m3 = {:?}", material.density));
        }
        for (key, pipe) in pipes {
            let known = materials.iter().find(|(_, material)| *material == &pipe.material);
            let name = known.map_or(pipe.material.name.as_str(), |(name, _)| name.as_str());
            line(format!("\n[{key}]\nmaterial = {}", quoted(name)));
            line(format!("outer_diameter_mm = {:?}", in_unit(pipe.section.outer_diameter, MM)));
            line(format!("inner_diameter_mm = {:?}", in_unit(pipe.section.inner_diameter, MM)));
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
        text
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
            assert_eq!(rod.tip_mass, written.tip_mass);
        }
    }

    #[test]
    fn parts_of_one_material_that_differ_get_names_of_their_own() {
        let joint = "[[joint]]\nname = \"a \\\"b\\\"\"\nstation_mm = 205\ntorsion_urad_per_nm = 1.5\n";
        let mut rod = Rod::from_toml("rod", &(include_str!("../../rods/5.toml").to_owned() + joint)).unwrap();
        rod.pipe2.material.youngs_modulus *= 0.7;
        rod.bend_flexibility = BendFlexibility::Factor(1.75);
        let written = again(&rod);
        assert_eq!(written.joints, rod.joints);
        assert_eq!(written.bend_flexibility, rod.bend_flexibility);
        assert_ne!(written.pipe1.material.youngs_modulus, written.pipe2.material.youngs_modulus);
    }
}
