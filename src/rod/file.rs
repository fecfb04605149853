//! The reader of rod files (`rods/*.toml`): every error names the line and what would be right
//! there.

mod check;
mod geometry;
mod laws;
mod materials;
mod parts;
mod sections;
mod uncertainty;

use std::collections::BTreeMap;
use std::path::Path;

use serde::Deserialize;
use toml::Spanned;

pub use self::check::Check;
pub use self::geometry::RawFlexibility;
use self::geometry::RawGeometry;
use self::laws::RawLaw;
pub use self::materials::MaterialTable;
pub use self::parts::{RawJoint, RawMass, RawSleeve};
use self::parts::{RawPipe, RawTip};
use self::uncertainty::RawUncertainty;
use super::{Rod, Warning};
use crate::error::Result;
use crate::files;
use crate::limits;
use crate::toml_text::{Number, Required, TomlText};

impl Rod {
    /// Reads and checks a rod file.
    ///
    /// ```
    /// use rodcal::rod::Rod;
    ///
    /// let rod = Rod::read("rods/4.toml".as_ref())?;
    /// assert_eq!(rod.tip().x, rod.l2); // an L: pipe II along x
    /// # Ok::<(), rodcal::Error>(())
    /// ```
    ///
    /// # Errors
    /// [`crate::Error::File`] where it cannot be read; [`crate::Error::Syntax`] or
    /// [`crate::Error::Input`] with line and column otherwise.
    pub fn read(path: &Path) -> Result<Rod> {
        Rod::from_toml(&path.display().to_string(), &files::read_text(path)?)
    }

    /// Reads and checks the text of a rod file; `file` names it in errors (and the rod, where it
    /// has no `name`).
    ///
    /// ```
    /// use rodcal::rod::Rod;
    ///
    /// const TEXT: &str = include_str!(concat!(env!("CARGO_MANIFEST_DIR"), "/rods/5.toml"));
    /// let rod = Rod::from_toml("rods/5.toml", TEXT)?;
    /// assert!((rod.length() - 0.675).abs() < 1e-12); // 150 mm + 525 mm, sharp corner
    /// assert!((rod.mass() - 0.58130).abs() < 1e-5);
    ///
    /// let error = Rod::from_toml("rods/5.toml", &TEXT.replace("= 150.0", "= -150.0")).unwrap_err();
    /// assert!(error.to_string().starts_with("rods/5.toml:11:9: `geometry.l1_mm` is -150.0"), "{error}");
    /// # Ok::<(), rodcal::Error>(())
    /// ```
    ///
    /// # Errors
    /// As [`Rod::read`].
    pub fn from_toml(file: &str, text: &str) -> Result<Rod> {
        let toml = TomlText::new(file, text);
        let raw: RawRod = toml.parse(REQUIRED)?;
        let mut check = Check { toml, warnings: Vec::new() };
        let mut rod = check.rod(&raw)?;
        rod.name = raw.name.unwrap_or_else(|| file_stem(file));
        rod.source = raw.source;
        rod.warnings = check.warnings;
        Ok(rod)
    }
}

#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
struct RawRod {
    name: Option<String>,
    source: Option<String>,
    linear_range_n: Option<Number>,
    geometry: RawGeometry,
    material: MaterialTable,
    pipe1: Spanned<RawPipe>,
    pipe2: Spanned<RawPipe>,
    bend: Option<Spanned<RawPipe>>,
    tip: Option<RawTip>,
    #[serde(default)]
    mass: Vec<RawMass>,
    #[serde(default)]
    joint: Vec<RawJoint>,
    #[serde(default)]
    sleeve: Vec<Spanned<RawSleeve>>,
    #[serde(default)]
    law: Vec<RawLaw>,
    #[serde(default)]
    standard_uncertainty: RawUncertainty,
}

/// What a rod file cannot do without, in words.
const REQUIRED: &Required = &[
    ("[geometry]", "a section [geometry] with l1_mm and l2_mm"),
    ("[material]", "a section [material.NAME], NAME being any name, with its moduli and density"),
    ("[pipe1]", "a section [pipe1] (flange to bend) with material, outer_diameter_mm, inner_diameter_mm"),
    ("[pipe2]", "a section [pipe2] (bend to tip) with material, outer_diameter_mm, inner_diameter_mm"),
    ("l1_mm", "the length from the flange to the corner in mm"),
    ("l2_mm", "the length from the corner to the ball centre in mm"),
    ("density_kg_m3", "the density in kg/m³"),
    ("material", "the name of one of the file's materials"),
    ("mass_g", "the mass in g"),
    ("name", "a name in quotes"),
    ("place", "where a law acts: rod, clamp, root, slide, a joint's name, dx, dy or dz"),
    ("variable", "what a law is a function of"),
    ("formula", "a formula in quotes"),
    ("range", "where a law was recorded: [from, to], in the unit of its variable"),
    ("value", "the number, in its unit"),
    ("from_mm", "the distance from the flange along the centreline at which the sleeve begins, in mm"),
    ("to_mm", "the distance from the flange along the centreline at which the sleeve ends, in mm"),
    ("station_mm", "the distance from the flange along the centreline in mm"),
];

impl Check<'_> {
    /// The rod without its name and warnings.
    fn rod(&mut self, raw: &RawRod) -> Result<Rod> {
        let geometry = self.geometry(&raw.geometry)?;
        let standard_uncertainty = self.standard_uncertainty(&raw.standard_uncertainty)?;
        let mut materials = BTreeMap::new();
        for (name, material) in &raw.material.0 {
            let material = self.material(name, material, &raw.standard_uncertainty)?;
            materials.insert(name.clone(), material);
        }
        let pipe1 = self.pipe("pipe1", &raw.pipe1, &materials)?;
        let pipe2 = self.pipe("pipe2", &raw.pipe2, &materials)?;
        let bend = match &raw.bend {
            Some(bend) => self.pipe("bend", bend, &materials)?,
            None => pipe1.clone(),
        };
        let (radius, tube_radius) = (geometry.bend_radius, bend.section.height() / 2.0);
        if radius > 0.0 && geometry.bend_flexibility.is_for_tubes() && bend.section.as_round().is_none() {
            return Err(self.no_round_bend(&raw.geometry));
        }
        if radius > 0.0 && radius < tube_radius {
            self.warnings.push(Warning::TightBend { radius, tube_radius });
        }
        let mut rod = Rod {
            name: String::new(),
            source: None,
            l1: geometry.l1,
            l2: geometry.l2,
            gamma: geometry.gamma,
            bend_radius: geometry.bend_radius,
            bend_flexibility: geometry.bend_flexibility,
            pipe1,
            bend,
            pipe2,
            tip_mass: match &raw.tip {
                Some(tip) => self.tip(tip)?,
                None => 0.0,
            },
            masses: Vec::new(),
            joints: Vec::new(),
            sleeves: Vec::new(),
            laws: Vec::new(),
            linear_range: match &raw.linear_range_n {
                Some(range) => Some(self.toml.positive("linear_range_n", range)?),
                None => None,
            },
            standard_uncertainty,
            warnings: Vec::new(),
        };
        limits::check(self.toml.file(), raw.mass.len(), limits::ROD_PARTS, "masses")?;
        limits::check(self.toml.file(), raw.joint.len(), limits::ROD_PARTS, "joints")?;
        limits::check(self.toml.file(), raw.sleeve.len(), limits::ROD_PARTS, "sleeves")?;
        for mass in &raw.mass {
            let mass = self.lumped_mass(mass, rod.length())?;
            rod.masses.push(mass);
        }
        for joint in &raw.joint {
            let joint = self.joint(joint, &rod.joints, rod.length())?;
            rod.joints.push(joint);
        }
        for sleeve in &raw.sleeve {
            let sleeve = self.sleeve(sleeve, &rod, &materials)?;
            rod.sleeves.push(sleeve);
        }
        let loose = rod.sleeves.iter().filter_map(|sleeve| {
            let gap = 0.5 * rod.gap(sleeve)?;
            Some(Warning::LooseSleeve { sleeve: sleeve.name.clone(), gap })
        });
        self.warnings.extend(loose);
        self.laws(&raw.law, &mut rod)?;
        Ok(rod)
    }
}

/// `rods/5.toml` → `5`.
fn file_stem(file: &str) -> String {
    Path::new(file).file_stem().map_or_else(|| file.to_owned(), |s| s.to_string_lossy().into_owned())
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::material::{Material, MaterialUncertainty};
    use crate::rod::{BendFlexibility, Joint, LumpedMass, Pipe, Sleeve, StandardUncertainty};
    use crate::section::{Rectangle, Round, Section};
    use crate::units::{GRAM, MM, URAD_PER_NM};
    use approx::assert_relative_eq;

    /// The rod of INTERFACES.md, without its comments.
    const EXAMPLE: &str = r#"
name = "5#"
[geometry]
l1_mm = 150.0
l2_mm = 525.0
gamma_deg = 90.0
bend_radius_mm = 0.0
[material.steel]
youngs_modulus_gpa = 193.0
shear_modulus_gpa = 74.8
density_kg_m3 = 7930.0
[pipe1]
material = "steel"
outer_diameter_mm = 16.0
inner_diameter_mm = 12.0
[pipe2]
material = "steel"
outer_diameter_mm = 16.0
inner_diameter_mm = 12.0
[tip]
mass_g = 55.0
[[mass]]
name = "ring"
station_mm = 205.0
mass_g = 30.0
[[joint]]
name = "sleeve-a"
station_mm = 205.0
bending_urad_per_nm = 2.0
torsion_urad_per_nm = 3.0
"#;

    fn read(text: &str) -> Rod {
        Rod::from_toml("rods/5.toml", text).expect(text)
    }

    #[test]
    fn a_rod_file_is_read_into_si_units() {
        let pipe = Pipe {
            section: Round::tube(16.0 * MM, 12.0 * MM).into(),
            material: Material::with_moduli("steel", 193e9, 74.8e9, 7930.0),
        };
        let expected = Rod {
            name: "5#".into(),
            source: None,
            l1: 0.15,
            l2: 525.0 * MM,
            gamma: std::f64::consts::FRAC_PI_2,
            bend_radius: 0.0,
            bend_flexibility: BendFlexibility::Beam,
            pipe1: pipe.clone(),
            bend: pipe.clone(),
            pipe2: pipe,
            tip_mass: 55.0 * GRAM,
            masses: vec![LumpedMass { name: "ring".into(), station: 205.0 * MM, mass: 30.0 * GRAM }],
            joints: vec![Joint {
                name: "sleeve-a".into(),
                station: 205.0 * MM,
                bending: 2.0 * URAD_PER_NM,
                torsion: 3.0 * URAD_PER_NM,
            }],
            sleeves: vec![],
            laws: vec![],
            linear_range: None,
            standard_uncertainty: StandardUncertainty::default(),
            warnings: vec![],
        };
        let rod = read(EXAMPLE);
        assert_eq!(rod, expected);
        // and in numbers, should a constant be wrong
        assert_relative_eq!(rod.l2, 0.525, max_relative = 1e-15);
        assert_relative_eq!(rod.tip_mass, 0.055, max_relative = 1e-15);
        assert_relative_eq!(rod.joints[0].torsion, 3e-6, max_relative = 1e-15);
    }

    #[test]
    fn whole_numbers_need_no_decimal_point() {
        let integers = EXAMPLE.replace(".0\n", "\n");
        assert!(integers.contains("l1_mm = 150\n"));
        assert_eq!(read(&integers), read(EXAMPLE));
    }

    #[test]
    fn what_is_not_stated_has_its_default() {
        let required_only = EXAMPLE.split("[tip]").next().unwrap_or_default();
        let text = ["name = \"5#\"\n", "gamma_deg = 90.0\n", "bend_radius_mm = 0.0\n"]
            .iter()
            .fold(required_only.to_owned(), |text, line| text.replace(line, ""));
        let expected = Rod {
            name: "5".into(), // of the file
            source: None,
            tip_mass: 0.0,
            masses: vec![],
            joints: vec![],
            ..read(EXAMPLE)
        };
        assert_eq!(read(&text), expected);
        let stiff_joint = EXAMPLE.replace("bending_urad_per_nm = 2.0", "");
        assert_eq!(read(&stiff_joint).joints[0].bending, 0.0);
    }

    #[test]
    fn a_bend_may_be_a_pipe_of_its_own_and_of_its_own_flexibility() {
        let solid = "[bend]\nmaterial = \"steel\"\nouter_diameter_mm = 15\ninner_diameter_mm = 0\n[tip]";
        let text = EXAMPLE.replace("[tip]", solid);
        assert_eq!(read(&text).bend.section, Round::solid(15.0 * MM).into());
        for (value, flexibility) in [
            ("\"beam\"", BendFlexibility::Beam),
            ("\"von-karman\"", BendFlexibility::VonKarman),
            ("\"asme-b31.3\"", BendFlexibility::AsmeB313),
            ("2", BendFlexibility::Factor(2.0)),
            ("1.25", BendFlexibility::Factor(1.25)),
        ] {
            let bend = format!("bend_radius_mm = 40\nbend_flexibility = {value}");
            let rod = read(&EXAMPLE.replace("bend_radius_mm = 0.0", &bend));
            assert_eq!((rod.bend_radius, rod.bend_flexibility), (0.04, flexibility));
        }
    }

    const SLEEVE: &str = "[[sleeve]]\nname = \"collar\"\nfrom_mm = 100\nto_mm = 150\nmaterial = \"steel\"\n\
                          outer_diameter_mm = 20\ninner_diameter_mm = 16\n";

    #[test]
    fn a_sleeve_is_a_pipe_over_a_stretch_of_a_straight_one() {
        let rod = read(&format!("{EXAMPLE}{SLEEVE}"));
        let pipe = Pipe { section: Round::tube(0.020, 0.016).into(), material: rod.pipe1.material.clone() };
        assert_eq!(rod.sleeves, [Sleeve { name: "collar".into(), from: 0.1, to: 0.15, pipe }]);
        // one in the bore, and one over the other
        let more = SLEEVE.replace("= 20", "= 12").replace("= 16", "= 0");
        let over = SLEEVE.replace("= 20", "= 24").replace("= 16", "= 20");
        assert_eq!(read(&format!("{EXAMPLE}{SLEEVE}{more}{over}")).sleeves.len(), 3);
    }

    #[test]
    fn a_sleeve_far_from_any_wall_is_warned_about() {
        let warned = |text: &str| {
            let rod = read(&format!("{EXAMPLE}{text}"));
            rod.warnings.iter().map(ToString::to_string).collect::<Vec<_>>().join("; ")
        };
        assert_eq!(warned(SLEEVE), "");
        let wide = SLEEVE.replace("= 20", "= 30").replace("= 16", "= 26");
        assert!(warned(&wide).starts_with("sleeve \"collar\" is 5.0 mm away from the nearest wall"));
        // one over another that is bonded is bonded
        let between = SLEEVE.replace("= 20", "= 25");
        assert_eq!(warned(&format!("{between}{wide}")), "");
    }

    #[test]
    fn a_sleeve_that_cannot_be_is_refused_with_what_would_be_right() {
        let on_a_pipe = "a stretch of one straight pipe, 0 to 150 mm or 150 to 675 mm";
        for (key, value, expected) in [
            ("to_mm = 150", "to_mm = 160", on_a_pipe),
            ("to_mm = 150", "to_mm = 100", on_a_pipe),
            ("to_mm = 150", "to_mm = 900", "a station on the rod, 0 to 675.000 mm"),
            ("from_mm = 100\n", "", "the distance from the flange along the centreline at which the sleeve"),
            ("= 16", "= 15", "the wall of sleeve \"collar\" would be where that of pipe1 is"),
            ("= 20", "= 16", "less than the outer diameter"),
            ("\"steel\"", "\"stell\"", "one of the file's materials: \"steel\""),
            ("to_mm", "till_mm", "till_mm"),
        ] {
            let text = format!("{EXAMPLE}{}", SLEEVE.replacen(key, value, 1));
            let error = Rod::from_toml("rods/5.toml", &text).unwrap_err().to_string();
            assert!(error.starts_with("rods/5.toml:") && error.contains(expected), "{error}");
        }
        let twice = Rod::from_toml("5", &format!("{EXAMPLE}{SLEEVE}{SLEEVE}")).unwrap_err().to_string();
        assert!(twice.contains("where that of sleeve \"collar\" is"), "{twice}");
        let many = Rod::from_toml("5", &format!("{EXAMPLE}{}", SLEEVE.repeat(101))).unwrap_err().to_string();
        assert!(many.contains("sleeves"), "{many}");
    }

    #[test]
    fn the_tip_is_a_station_even_when_rounded() {
        let rod = read(&EXAMPLE.replace("205.0", "675.0005"));
        assert_eq!(rod.joints[0].station, rod.length());
    }
    #[test]
    fn a_section_may_be_a_rectangle_a_box_or_its_constants() {
        let with = |section: &str| {
            let pipe2 = "[pipe2]\nmaterial = \"steel\"\n";
            let diameters = "outer_diameter_mm = 16.0\ninner_diameter_mm = 12.0";
            let text = EXAMPLE.replace(&format!("{pipe2}{diameters}"), &format!("{pipe2}{section}"));
            read(&text).pipe2.section
        };
        assert_eq!(with("width_mm = 10\nheight_mm = 20"), Rectangle::solid(10.0 * MM, 20.0 * MM).into());
        assert_eq!(
            with("width_mm = 10\nheight_mm = 20\nwall_mm = 1.5"),
            Rectangle::hollow(10.0 * MM, 20.0 * MM, 1.5 * MM).into()
        );
        let general = "area_mm2 = 200\niy_mm4 = 6000\niz_mm4 = 2000\nj_mm4 = 4000\nkappa = 0.85";
        let Section::General(general) = with(general) else { panic!("a general section") };
        for (found, expected) in [
            (general.area, 2e-4),
            (general.iy, 6e-9),
            (general.iz, 2e-9),
            (general.torsion_constant, 4e-9),
            (general.shear_coefficient, 0.85),
        ] {
            assert_relative_eq!(found, expected, max_relative = 1e-14);
        }
    }

    #[test]
    fn standard_uncertainties_are_those_of_the_material_the_file_or_the_kind() {
        let of_kind = read(EXAMPLE);
        assert_eq!(of_kind.standard_uncertainty, StandardUncertainty::default());
        assert_eq!(of_kind.pipe1.material.standard_uncertainty, MaterialUncertainty::ISOTROPIC);
        let stated = "youngs_modulus_percent = 1.5\nshear_modulus_percent = 0\ndiameter_mm = 0.05\n\
                      length_mm = 0\ntip_mass_g = 1\n";
        let own =
            EXAMPLE.replace("density_kg_m3 = 7930.0", "density_kg_m3 = 7930.0\nyoungs_modulus_percent = 0.5");
        for (text, youngs) in [(EXAMPLE, 0.015), (own.as_str(), 0.005)] {
            let rod = read(&format!("{text}[standard_uncertainty]\n{stated}"));
            let StandardUncertainty { diameter, length, tip_mass, section } = rod.standard_uncertainty;
            assert_relative_eq!(diameter, 0.05e-3, max_relative = 1e-14);
            assert_relative_eq!(tip_mass, 1e-3, max_relative = 1e-14);
            assert_eq!((length, section), (0.0, 0.01));
            let material = rod.pipe2.material.standard_uncertainty;
            assert_relative_eq!(material.youngs_modulus, youngs, max_relative = 1e-14);
            assert_eq!((material.shear_modulus, material.density), (0.0, 0.01));
            assert_eq!(material.shear_coefficient, 0.03);
        }
        let carbon = EXAMPLE.replace("shear_modulus_gpa = 74.8", "shear_modulus_gpa = 9.5");
        assert_eq!(read(&carbon).pipe1.material.standard_uncertainty, MaterialUncertainty::ANISOTROPIC);
    }
    /// The sections and standard uncertainties that docs/rod-file.md shows are read.
    #[test]
    fn the_examples_of_the_documents_are_read() {
        let document = include_str!("../../docs/rod-file.md");
        let piece = |heading: &str| {
            let below = document.split(heading).nth(1).unwrap_or_default();
            below.split("```toml\n").nth(1).and_then(|rest| rest.split("```").next()).unwrap_or_default()
        };
        let above = EXAMPLE.split("[pipe1]").next().unwrap_or_default();
        let rod = read(&format!("{above}{}", piece("## Cross-sections")));
        let (solid, boxed) = (Rectangle::solid(0.010, 0.020), rod.pipe2.section);
        assert_eq!(boxed, Rectangle::hollow(10.0 * MM, 20.0 * MM, 1.5 * MM).into());
        // the constants are those of the solid rectangle
        let [iy, iz] = rod.bend.section.second_moments();
        assert_relative_eq!(iy, solid.second_moments()[0], max_relative = 1e-5);
        assert_relative_eq!(iz, solid.second_moments()[1], max_relative = 3e-5);
        assert_relative_eq!(
            rod.bend.section.torsion_constant(),
            solid.torsion_constant(),
            max_relative = 2e-5
        );

        let rod = read(&format!("{EXAMPLE}{}", piece("## Sleeves")));
        assert_eq!(rod.sleeves.len(), 1);
        let rod = read(&format!("{EXAMPLE}{}", piece("## Standard uncertainties")));
        assert_eq!(rod.standard_uncertainty, StandardUncertainty::default());
        assert_eq!(rod.pipe1.material.standard_uncertainty, MaterialUncertainty::ISOTROPIC);
    }
}
