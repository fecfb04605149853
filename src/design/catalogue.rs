//! Tubes to choose from: the built-in catalogue, or a table of one's own.

use std::collections::{BTreeMap, HashSet};

use crate::delimited::{Row, Table, nearest_name};
use crate::error::{Error, Result};
use crate::material::{Material, MaterialUncertainty, listed};
use crate::rod::Pipe;
use crate::section::Round;
use crate::units::MM;

/// What a design file writes for [`built_in`].
pub const BUILT_IN: &str = "builtin";

/// The built-in catalogue as a table.
pub(super) const BUILT_IN_TEXT: &str = include_str!("built_in.csv");

/// The thinnest wall of a tube that bears itself, mm.
const THINNEST: f64 = 0.01;

/// A tube that can be bought.
#[derive(Debug, Clone, PartialEq)]
#[non_exhaustive]
pub struct Tube {
    /// Its name in the catalogue.
    pub name: String,
    /// Section and material.
    pub pipe: Pipe,
    /// Price of a metre, in the catalogue's currency, where it has one.
    pub price_per_m: Option<f64>,
    /// Where its size is from, where that is known.
    pub source: Option<String>,
}

/// Materials of the built-in catalogue by name: `steel`, `stainless`, `aluminium`,
/// `carbon-pultruded`, `carbon-wrapped`.
///
/// Metals: EN 1993-1-1 § 3.2.6 (E 210 GPa, ν 0.3), EN 10088-1 Annex E (1.4301: E 200 GPa, ρ 7900),
/// EN 1999-1-1 § 3.2.5 (E 70 GPa, ν 0.3, ρ 2700). Carbon: what makers' data sheets typically state
/// along the tube (pultruded, all fibres along it, 60 % of them; roll-wrapped with a half of the
/// plies along it); the next maker's differs by more than 5 %, which is their standard uncertainty
/// here. State your own.
///
/// ```
/// use rodcal::design::built_in_materials;
///
/// let materials = built_in_materials();
/// assert_eq!(materials["stainless"].density, 7900.0); // kg/m³, EN 10088-1
/// ```
pub fn built_in_materials() -> BTreeMap<String, Material> {
    let carbon = |name: &str, e: f64, g: f64| {
        let mut material = Material::anisotropic(name, e, g, 0.3, 1550.0);
        material.standard_uncertainty =
            MaterialUncertainty { density: 0.03, ..MaterialUncertainty::ANISOTROPIC };
        material
    };
    let all = [
        Material::isotropic("steel", 210e9, 0.3, 7850.0),
        Material::isotropic("stainless", 200e9, 0.3, 7900.0),
        Material::isotropic("aluminium", 70e9, 0.3, 2700.0),
        carbon("carbon-pultruded", 130e9, 5e9),
        carbon("carbon-wrapped", 70e9, 10e9),
    ];
    all.into_iter().map(|material| (material.name.clone(), material)).collect()
}

/// The built-in catalogue: common round tubes of steel (EN 10305-1), stainless steel (ISO 1127),
/// aluminium and carbon fibre.
///
/// ```
/// use rodcal::design::{built_in, built_in_materials};
///
/// let tubes = built_in(&built_in_materials())?;
/// assert!(tubes.len() > 20 && tubes.iter().any(|tube| tube.pipe.material.name == "steel"));
/// # Ok::<(), rodcal::Error>(())
/// ```
///
/// # Errors
/// None: a test reads it.
pub fn built_in(materials: &BTreeMap<String, Material>) -> Result<Vec<Tube>> {
    read(BUILT_IN, BUILT_IN_TEXT, materials)
}

/// A catalogue from the text of `file`, a table with the columns `name`, `material`,
/// `outer_diameter_mm`, `inner_diameter_mm` and, if there are prices, `price_per_m`.
///
/// # Errors
/// [`Error::Input`] with line and column for a column that is missing, a name that stands there
/// twice, a material that is not among `materials`, a tube that is none, a price below 0, and a
/// table without tubes.
pub(super) fn read(file: &str, text: &str, materials: &BTreeMap<String, Material>) -> Result<Vec<Tube>> {
    let is_number = |column: &str| column.ends_with("_mm") || column == "price_per_m";
    let table = Table::parse(file, text, is_number)?;
    for column in ["name", "material", "outer_diameter_mm", "inner_diameter_mm"] {
        if !table.has(column) {
            let found = format!("the catalogue has no column {column}");
            let expected = "name, material, outer_diameter_mm, inner_diameter_mm".to_owned();
            return Err(table.header_error(column, found, expected, None));
        }
    }
    let mut tubes: Vec<Tube> = Vec::new();
    let mut names = HashSet::new();
    for row in table.rows() {
        let tube = tube(&row, materials)?;
        if !names.insert(tube.name.clone()) {
            return Err(row.error("name", "a name of its own for each tube".into(), None));
        }
        tubes.push(tube);
    }
    if tubes.is_empty() {
        return Err(table.header_error(
            "",
            "the catalogue has no tubes".into(),
            "a row for each".into(),
            None,
        ));
    }
    Ok(tubes)
}

fn tube(row: &Row<'_>, materials: &BTreeMap<String, Material>) -> Result<Tube> {
    let text = |column: &str| {
        row.text(column).ok_or_else(|| row.error(column, format!("the {column} of the tube"), None))
    };
    let (name, material) = (text("name")?, text("material")?);
    let Some(known) = materials.get(material) else {
        let names: Vec<&str> = materials.keys().map(String::as_str).collect();
        let hint = nearest_name(material, &names).map(|near| format!("did you mean {near}?"));
        let expected = format!(
            "one of {}, or a section [material.NAME] of that name in the design file",
            listed(&names)
        );
        return Err(row.error("material", expected, hint));
    };
    let (outer, inner) =
        (row.required_number("outer_diameter_mm")?, row.required_number("inner_diameter_mm")?);
    if outer <= 0.0 {
        return Err(row.error("outer_diameter_mm", "a diameter > 0 in mm".into(), None));
    }
    if !(0.0..outer).contains(&inner) {
        let expected = format!("0 for a solid round, or less than the outer diameter, {outer}");
        return Err(row.error("inner_diameter_mm", expected, None));
    }
    if inner > 0.0 && outer - inner < 2.0 * THINNEST {
        let expected = format!("{:.2} at most: a wall of {THINNEST} mm", outer - 2.0 * THINNEST);
        return Err(row.error("inner_diameter_mm", expected, None));
    }
    let price_per_m = row.number("price_per_m")?;
    if price_per_m.is_some_and(|price| price < 0.0) {
        return Err(row.error("price_per_m", "a price of 0 or more".into(), None));
    }
    let pipe = Pipe::new(Round::tube(outer * MM, inner * MM), known.clone());
    Ok(Tube { name: name.to_owned(), pipe, price_per_m, source: row.text("source").map(str::to_owned) })
}

/// The error of a design that asks for prices of a catalogue without.
pub(super) fn without_price(tubes: &[Tube]) -> Option<&str> {
    tubes.iter().find(|tube| tube.price_per_m.is_none()).map(|tube| tube.name.as_str())
}

/// An error of whatever is wrong with a catalogue's file as such.
pub(super) fn unreadable(error: Error, file: &str) -> Error {
    error.with_hint(Some(format!(
        "the catalogue of {file}; a path is seen from there, \"{BUILT_IN}\" is the built-in one"
    )))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_built_in_catalogue_is_read_and_every_tube_has_a_wall_and_a_source() {
        let tubes = built_in(&built_in_materials()).unwrap();
        assert!(tubes.len() > 50);
        for tube in &tubes {
            let wall = tube.pipe.section.wall().unwrap();
            assert!((0.9 * MM..4.0 * MM).contains(&wall) && tube.source.is_some(), "{tube:?}");
        }
    }

    #[test]
    fn what_is_no_tube_is_refused_where_it_stands() {
        let head = "name,material,outer_diameter_mm,inner_diameter_mm,price_per_m\n";
        for (rows, expected) in [
            ("a,stel,16,14,\n", "t.csv:2:3: material is \"stel\""),
            ("a,steel,16,16,\n", "t.csv:2:12: inner_diameter_mm is \"16\""),
            ("a,steel,16,15.9999,\n", "t.csv:2:12: inner_diameter_mm is \"15.9999\", expected 15.98 at most"),
            ("a,steel,0,0,\n", "t.csv:2:9: outer_diameter_mm is \"0\""),
            ("a,steel,16,14,-1\n", "t.csv:2:15: price_per_m is \"-1\""),
            ("a,steel,16,14,1\na,steel,20,18,1\n", "t.csv:3:1: name is \"a\""),
            ("a,steel,16,,1\n", "t.csv:2:12: inner_diameter_mm is blank"),
            ("", "t.csv:1: the catalogue has no tubes"),
        ] {
            let error = read("t.csv", &format!("{head}{rows}"), &built_in_materials()).unwrap_err();
            assert!(error.to_string().starts_with(expected), "{error}");
        }
        let error = read("t.csv", "name,material\na,steel\n", &built_in_materials()).unwrap_err();
        assert!(error.to_string().contains("no column outer_diameter_mm"), "{error}");
    }
}
