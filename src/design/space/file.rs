//! The design file: TOML, checked.

use std::collections::BTreeMap;
use std::path::Path;

use serde::Deserialize;
use toml::Spanned;

use super::DesignSpace;
use crate::design::catalogue::{self, BUILT_IN, Tube, built_in_materials};
use crate::design::figure::{Figure, Goal};
use crate::design::limits::{self, Limit};
use crate::design::values::{Bounds, Raw, limit, values};
use crate::error::{Error, Place, Result};
use crate::files;
use crate::limits as most;
use crate::material::Material;
use crate::rod::file::{Check, MaterialTable, RawFlexibility, RawJoint, RawMass, RawSleeve};
use crate::rod::{Joint, LumpedMass, Sleeve};
use crate::toml_text::{Number, Required, TomlText};
use crate::units::{DEG, GRAM, MM};

#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
struct RawSpace {
    geometry: RawGeometry,
    #[serde(default)]
    material: MaterialTable,
    catalogue: RawCatalogue,
    tip: Option<RawTip>,
    #[serde(default)]
    mass: Vec<RawMass>,
    #[serde(default)]
    joint: Vec<RawJoint>,
    #[serde(default)]
    sleeve: Vec<Spanned<RawSleeve>>,
    #[serde(default)]
    optional_sleeve: Vec<Spanned<RawSleeve>>,
    #[serde(default)]
    constraints: RawLimits,
    objectives: Spanned<RawGoals>,
}

#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
struct RawGeometry {
    l1_mm: Spanned<Raw>,
    l2_mm: Spanned<Raw>,
    gamma_deg: Option<Spanned<Raw>>,
    bend_radius_mm: Option<Spanned<Raw>>,
    bend_flexibility: Option<Spanned<RawFlexibility>>,
}

#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
struct RawCatalogue {
    file: Spanned<String>,
    same_tube: Option<bool>,
}

#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
struct RawTip {
    mass_g: Spanned<Raw>,
}

#[derive(Default, Deserialize)]
#[serde(deny_unknown_fields)]
struct RawLimits {
    max_mass_g: Option<Number>,
    max_flange_moment_nm: Option<Number>,
    max_tip_sag_um: Option<Number>,
    max_c_rod_um: Option<Number>,
    min_reach_mm: Option<Number>,
    min_first_frequency_hz: Option<Number>,
}

#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
struct RawGoals {
    #[serde(default)]
    minimise: Vec<Spanned<String>>,
    #[serde(default)]
    maximise: Vec<Spanned<String>>,
}

const REQUIRED: &Required = &[
    ("[geometry]", "a section [geometry] with l1_mm and l2_mm: numbers, lists or ranges {from, to, step}"),
    ("[catalogue]", "a section [catalogue] with file, a table of tubes or \"builtin\""),
    ("[objectives]", "a section [objectives] with minimise or maximise"),
    ("l1_mm", "the length from the flange to the corner in mm: a number, a list or a range {from, to, step}"),
    ("l2_mm", "the length from the corner to the ball centre in mm, likewise"),
    ("file", "a table of tubes, or \"builtin\""),
    ("mass_g", "the mass in g"),
    ("name", "a name in quotes"),
    ("material", "the name of one of the file's materials, or of a built-in one"),
    ("from_mm", "the distance from the flange along the centreline at which the sleeve begins, in mm"),
    ("to_mm", "the distance from the flange along the centreline at which the sleeve ends, in mm"),
    ("station_mm", "the distance from the flange along the centreline in mm"),
];

impl DesignSpace {
    /// Reads and checks a design file and the catalogue that it names, whose path is seen from the
    /// file's folder.
    ///
    /// # Errors
    /// [`crate::Error::File`] where one of them cannot be read; else as [`DesignSpace::from_toml`].
    pub fn read(path: &Path) -> Result<DesignSpace> {
        let file = path.display().to_string();
        let folder = path.parent().unwrap_or(Path::new(""));
        let catalogue = |name: &str| {
            let path = folder.join(name);
            Ok((path.display().to_string(), files::read_text(&path)?))
        };
        DesignSpace::from_toml(&file, &files::read_text(path)?, &catalogue)
    }

    /// Reads and checks the text of a design file; `catalogue` finds the name and the text of a
    /// catalogue by what the file calls it.
    ///
    /// ```
    /// use rodcal::design::DesignSpace;
    ///
    /// let text = "
    ///     [geometry]
    ///     l1_mm = { from = 150, to = 450, step = 10 }
    ///     l2_mm = [400, 525, 600]
    ///     [catalogue]
    ///     file = \"builtin\"
    ///     [constraints]
    ///     max_mass_g = 800
    ///     [objectives]
    ///     minimise = [\"c_rod_um\", \"mass_g\"]
    /// ";
    /// let space = DesignSpace::from_toml("design.toml", text, &|_| unreachable!())?;
    /// assert_eq!(space.combinations(), 31 * 3 * space.tubes.len() as u64);
    /// # Ok::<(), rodcal::Error>(())
    /// ```
    ///
    /// # Errors
    /// [`crate::Error::Syntax`] or [`crate::Error::Input`] with line and column: keys and values
    /// that are none, no goal, prices that the catalogue does not have, what is wrong with the
    /// catalogue. How many combinations there are is no error of the file: a search of all of them
    /// says [`DesignSpace::too_much`].
    pub fn from_toml(
        file: &str,
        text: &str,
        catalogue: &dyn Fn(&str) -> Result<(String, String)>,
    ) -> Result<DesignSpace> {
        let toml = TomlText::new(file, text);
        let raw: RawSpace = toml.parse(REQUIRED)?;
        let geometry = &raw.geometry;
        let mut check = Check { toml, warnings: Vec::new() };
        let mut materials = built_in_materials();
        materials.extend(raw.material.checked(&mut check)?);
        let (of_catalogue, tubes) = tubes(&toml, &raw.catalogue, &materials, catalogue)?;
        let mut range = |key: &str, raw: Option<&Spanned<Raw>>, unit: f64, bounds, otherwise: f64| match raw {
            Some(raw) => {
                Ok(values(&mut check, key, raw, bounds)?.into_iter().map(|value| value * unit).collect())
            }
            None => Ok(vec![otherwise * unit]),
        };
        let l1 = range("geometry.l1_mm", Some(&geometry.l1_mm), MM, Bounds::LENGTH, 0.0)?;
        let l2 = range("geometry.l2_mm", Some(&geometry.l2_mm), MM, Bounds::LENGTH, 0.0)?;
        let gamma = range("geometry.gamma_deg", geometry.gamma_deg.as_ref(), DEG, Bounds::ANGLE, 90.0)?;
        let bend_radius =
            range("geometry.bend_radius_mm", geometry.bend_radius_mm.as_ref(), MM, Bounds::RADIUS, 0.0)?;
        let tip_mass = range("tip.mass_g", raw.tip.as_ref().map(|tip| &tip.mass_g), GRAM, Bounds::MASS, 0.0)?;
        let flexibility =
            geometry.bend_flexibility.as_ref().map(|raw| check.bend_flexibility(raw)).transpose()?;
        for (count, limit, what) in [
            (raw.mass.len(), most::ROD_PARTS, "masses"),
            (raw.joint.len(), most::ROD_PARTS, "joints"),
            (raw.sleeve.len(), most::ROD_PARTS, "sleeves"),
            (raw.optional_sleeve.len(), most::OPTIONAL_SLEEVES, "optional sleeves"),
        ] {
            most::check(file, count, limit, what)?;
        }
        // which rods are long enough, and hold the sleeves, is found out one by one
        let mut joints: Vec<Joint> = Vec::new();
        for joint in &raw.joint {
            joints.push(check.joint(joint, &joints, f64::INFINITY)?);
        }
        let masses = raw.mass.iter().map(|mass| check.lumped_mass(mass, f64::INFINITY));
        let masses: Vec<LumpedMass> = masses.collect::<Result<_>>()?;
        let mut sleeves_of = |raw: &[Spanned<RawSleeve>]| {
            raw.iter().map(|sleeve| check.sleeve_apart(sleeve, &materials)).collect::<Result<Vec<Sleeve>>>()
        };
        let (sleeves, optional_sleeves) = (sleeves_of(&raw.sleeve)?, sleeves_of(&raw.optional_sleeve)?);
        let keys = [
            Some(&geometry.l1_mm),
            Some(&geometry.l2_mm),
            geometry.gamma_deg.as_ref(),
            geometry.bend_radius_mm.as_ref(),
            raw.tip.as_ref().map(|tip| &tip.mass_g),
        ];
        let units = [MM, MM, DEG, MM, GRAM];
        let ranges = std::array::from_fn(|k| {
            let ends = keys[k].and_then(|raw| raw.get_ref().ends());
            ends.map(|ends| ends.map(|end| end * units[k]))
        });
        let counts = [l1.len(), l2.len(), gamma.len(), bend_radius.len(), tip_mass.len()];
        let longest = (0..counts.len()).rev().max_by_key(|&k| counts[k]).and_then(|k| keys[k]);
        let longest = longest.map_or(0, |raw| raw.span().start);
        let space = DesignSpace {
            file: file.to_owned(),
            longest: Place::of_offset(file, text, longest),
            content: format!("{text}\n{of_catalogue}"),
            l1,
            l2,
            gamma,
            bend_radius,
            bend_flexibility: flexibility.unwrap_or_default(),
            tip_mass,
            ranges,
            tubes,
            is_one_tube: raw.catalogue.same_tube.unwrap_or(true),
            masses,
            joints,
            sleeves,
            optional_sleeves,
            limits: limits(&toml, &raw.constraints)?,
            goals: goals(&toml, &raw.objectives)?,
            warnings: Vec::new(),
        };
        let mut diameters = space.tubes.iter().map(|tube| tube.pipe.section.height() / MM);
        if let Some(diameter) = diameters.find(|diameter| !(1.0..=1000.0).contains(diameter)) {
            check.usual("outer_diameter_mm of the catalogue", diameter, "mm", 1.0, 1000.0);
        }
        let space = DesignSpace { warnings: check.warnings, ..space };
        let price = space.goals.iter().any(|goal| goal.figure == Figure::Price);
        if let (true, Some(tube)) = (price, catalogue::without_price(&space.tubes)) {
            let found = format!("\"price\" is a goal, but tube {tube} has no price_per_m");
            return Err(toml.wrong(
                &raw.objectives,
                found,
                "a catalogue with a column price_per_m, filled in",
            ));
        }
        Ok(space)
    }
}

fn tubes(
    toml: &TomlText,
    raw: &RawCatalogue,
    materials: &BTreeMap<String, Material>,
    find: &dyn Fn(&str) -> Result<(String, String)>,
) -> Result<(String, Vec<Tube>)> {
    let name = raw.file.get_ref();
    if name == BUILT_IN {
        return Ok((catalogue::BUILT_IN_TEXT.to_owned(), catalogue::built_in(materials)?));
    }
    if name.is_empty() {
        return Err(toml.is("catalogue.file", &raw.file, "a table of tubes, or \"builtin\""));
    }
    let (file, text) = find(name).map_err(|error| match error {
        Error::File { path, source, .. } => {
            let expected = format!(
                "a table of tubes, its path as seen from the design file, or \"{BUILT_IN}\"; {} cannot be read: {source}",
                path.display()
            );
            toml.is("catalogue.file", &raw.file, &expected)
        }
        other => catalogue::unreadable(other, "[catalogue] file"),
    })?;
    let tubes = catalogue::read(&file, &text, materials)?;
    Ok((text, tubes))
}

fn limits(toml: &TomlText, raw: &RawLimits) -> Result<Vec<Limit>> {
    let numbers = [
        &raw.max_mass_g,
        &raw.max_flange_moment_nm,
        &raw.max_tip_sag_um,
        &raw.max_c_rod_um,
        &raw.min_reach_mm,
        &raw.min_first_frequency_hz,
    ];
    let mut all = Vec::new();
    for ((key, figure, is_least), number) in limits::KEYS.into_iter().zip(numbers) {
        if let Some(number) = number {
            all.push(Limit { key, figure, value: limit(toml, key, number)?, is_least });
        }
    }
    Ok(all)
}

fn goals(toml: &TomlText, raw: &Spanned<RawGoals>) -> Result<Vec<Goal>> {
    let RawGoals { minimise, maximise } = raw.get_ref();
    let mut goals: Vec<Goal> = Vec::new();
    let both = [(minimise, false), (maximise, true)];
    for (name, is_maximised) in both.iter().flat_map(|(names, is)| names.iter().map(move |name| (name, *is)))
    {
        let known = Figure::ALL.into_iter().find(|figure| figure.key() == name.get_ref());
        let Some(figure) = known else {
            let keys: Vec<&str> = Figure::ALL.iter().map(|figure| figure.key()).collect();
            return Err(toml.is("objectives", name, &format!("one of {}", keys.join(", "))));
        };
        if goals.iter().any(|goal| goal.figure == figure) {
            return Err(toml.is("objectives", name, "every figure once, to be small or to be large"));
        }
        goals.push(Goal { figure, is_maximised });
    }
    if goals.is_empty() {
        return Err(toml.wrong(
            raw,
            "there is no goal".into(),
            "minimise or maximise with at least one figure",
        ));
    }
    Ok(goals)
}

#[cfg(test)]
mod tests {
    use super::*;

    const TEXT: &str = "[geometry]
l1_mm = 150
l2_mm = [400, 500]
[catalogue]
file = \"builtin\"
[constraints]
max_mass_g = 500
[objectives]
minimise = [\"c_rod_um\"]
";

    fn read(text: &str) -> Result<DesignSpace> {
        DesignSpace::from_toml("d.toml", text, &|name| {
            Ok((
                name.to_owned(),
                "name,material,outer_diameter_mm,inner_diameter_mm\na,own,30,28\n".to_owned(),
            ))
        })
    }

    #[test]
    fn what_is_no_design_space_is_refused_where_it_stands() {
        for (from, to, expected) in [
            ("c_rod_um", "c_rod", "d.toml:9:13: `objectives` is \"c_rod\", expected one of c_rod_um,"),
            ("minimise = [\"c_rod_um\"]", "", "d.toml:8:1: there is no goal"),
            ("\"c_rod_um\"", "\"mass_g\", \"mass_g\"", "d.toml:9:23: `objectives` is \"mass_g\""),
            ("c_rod_um", "price", "d.toml:8:1: \"price\" is a goal, but tube"),
            ("max_mass_g = 500", "max_mass_g = 0", "d.toml:7:14: `constraints.max_mass_g` is 0"),
            ("max_mass_g", "max_mas_g", "d.toml:7:1: unknown key `max_mas_g`"),
            ("[catalogue]", "[catalog]", "d.toml:4:2: unknown section [catalog]"),
            ("builtin", "", "d.toml:5:8: `catalogue.file` is \"\""),
            ("builtin", "t.csv", "t.csv:2:3: material is \"own\""),
            ("l1_mm = 150\n", "", "d.toml:1:1: there is no l1_mm in [geometry]"),
        ] {
            let error = read(&TEXT.replace(from, to)).unwrap_err().to_string();
            assert!(error.starts_with(expected), "{error}");
        }
        let own = "[material.own]\nyoungs_modulus_gpa = 100\npoisson_ratio = 0.3\ndensity_kg_m3 = 2000\n";
        let space = read(&(TEXT.replace("builtin", "t.csv") + own)).unwrap();
        assert_eq!((space.combinations(), space.rod(1).unwrap().pipe2.material.youngs_modulus), (2, 100e9));
    }

    #[test]
    fn what_is_most_likely_in_another_unit_is_said() {
        let said = |from: &str, to: &str| {
            let space = read(&TEXT.replace(from, to)).unwrap();
            space.warnings.iter().map(ToString::to_string).collect::<Vec<_>>().join("; ")
        };
        assert_eq!(said("150", "150"), "");
        assert!(said("150", "[0.15, 0.2]").contains("geometry.l1_mm"), "{}", said("150", "[0.15, 0.2]"));
        let radians = said("l1_mm = 150", "l1_mm = 150\ngamma_deg = 1.5708");
        assert!(radians.contains("is it given in degrees?"), "{radians}");
        let pascals = "[material.m]\nyoungs_modulus_gpa = 193000\npoisson_ratio = 0.3\ndensity_kg_m3 = 7930\n[catalogue]";
        assert!(said("[catalogue]", pascals).contains("youngs_modulus_gpa"));
    }

    #[test]
    fn what_would_take_days_says_how_many() {
        let range = "{ from = 100, to = 1000, step = 0.01 }";
        let space =
            read(&TEXT.replace("l1_mm = 150", &format!("l1_mm = {range}")).replace("[400, 500]", range));
        let space = space.unwrap();
        let tubes = space.tubes.len();
        let much = space.too_much().unwrap().to_string();
        let said = format!(
            "d.toml:2:9: 90001 l1_mm × 90001 l2_mm × {tubes} tubes are {} rods, about 5 days of computing, \
             expected at most 2000000000",
            space.combinations()
        );
        assert_eq!(much, said);
        assert!(read(TEXT).unwrap().too_much().is_none());
        // a frequency costs thirty times as much
        let goal = "[objectives]\nmaximise = [\"first_frequency_hz\"]";
        let slow = read(
            &TEXT
                .replace("l1_mm = 150", &format!("l1_mm = {range}"))
                .replace("[400, 500]", range)
                .replace("[objectives]", goal),
        );
        let much = slow.unwrap().too_much().unwrap().to_string();
        assert!(much.contains("about 155 days of computing"), "{much}");
    }

    #[test]
    fn every_combination_has_its_number() {
        let text =
            TEXT.replace("150", "[100, 150]").replace("[constraints]", "same_tube = false\n[constraints]");
        let space = read(&text).unwrap();
        let mut all: Vec<String> =
            (0..space.combinations()).map(|k| format!("{:?}", space.choice(k))).collect();
        all.sort();
        all.dedup();
        assert_eq!(all.len() as u64, space.combinations());
        assert_eq!(space.choice(1).l2, 0.5); // L2 varies fastest
    }
}
