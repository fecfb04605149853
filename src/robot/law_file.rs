//! The sections `[[law]]` of a robot file.

use serde::Deserialize;
use toml::Spanned;

use super::{JointLawVariable, LawPlace, RobotLaw};
use crate::error::Result;
use crate::limits;
use crate::rod::constants::{self, RawConstant};
use crate::toml_text::{Number, TomlText, quoted};

#[derive(Deserialize)]
#[serde(
    deny_unknown_fields,
    expecting = "a section [[law]] with place, variable, formula, range and its constants"
)]
pub(super) struct RawLaw {
    place: Spanned<String>,
    per_joint: Option<Spanned<usize>>,
    variable: Spanned<String>,
    formula: Option<Spanned<String>>,
    formula_x: Option<Spanned<String>>,
    formula_y: Option<Spanned<String>>,
    formula_z: Option<Spanned<String>>,
    range: Spanned<Vec<Number>>,
    source: Option<String>,
    #[serde(default)]
    constant: Vec<RawConstant>,
}

/// Where in its range a formula is tried.
const TRIED: usize = 8;
const NOTHING: &str = "0";

/// The laws of a robot of whose joints these are prismatic.
pub(super) fn read(toml: &TomlText, raw: &[Spanned<RawLaw>], is_prismatic: &[bool]) -> Result<Vec<RobotLaw>> {
    limits::check(toml.file(), raw.len(), limits::ROBOT_LAWS, "laws")?;
    raw.iter().map(|raw| law(toml, raw, is_prismatic)).collect()
}

fn law(toml: &TomlText, spanned: &Spanned<RawLaw>, is_prismatic: &[bool]) -> Result<RobotLaw> {
    let raw = spanned.get_ref();
    let joints = is_prismatic.len();
    let Some(place) = LawPlace::all(joints).find(|place| place.to_string() == *raw.place.get_ref()) else {
        let expected =
            format!("\"joint N\", \"axis of joint N\", \"link N\" (N from 1 to {joints}) or \"tool\"");
        return Err(toml.is("law.place", &raw.place, &expected));
    };
    let mut at_place = JointLawVariable::all(is_prismatic).into_iter().filter(|own| own.is_at(place));
    let Some(variable) = at_place.find(|own| own.to_string() == *raw.variable.get_ref()) else {
        return Err(toml.is("law.variable", &raw.variable, &variables_of(place)));
    };
    let per_joint = match &raw.per_joint {
        None => None,
        Some(number) => match number.get_ref().checked_sub(1) {
            Some(joint) if joint < joints && place != LawPlace::Tool => Some(joint),
            Some(_) if place == LawPlace::Tool => {
                return Err(toml.is(
                    "law.per_joint",
                    number,
                    "no such key: the tool follows its weight alone",
                ));
            }
            _ => return Err(toml.is("law.per_joint", number, &format!("a joint from 1 to {joints}"))),
        },
    };
    let formulas = formulas(toml, spanned, place)?;
    let constants = constants::read(toml, &raw.constant, variable.symbol())?;
    let range = constants::range(toml, &raw.range)?;
    let texts = formulas.iter().map(|text| text.map_or(NOTHING.to_owned(), |own| own.get_ref().clone()));
    let mut law = RobotLaw::new(place, per_joint, variable, texts.collect(), constants, range)
        // what is not there has no fault
        .map_err(|(k, fault)| toml.in_formula(formulas[k].unwrap_or(&raw.place), fault))?;
    law.source.clone_from(&raw.source);
    for k in 0..=TRIED {
        let x = range.0 + (range.1 - range.0) * k as f64 / TRIED as f64;
        let is_wrong = law.formulas_at(x, 1.0).position(|value| !value.is_finite());
        if let Some(formula) = is_wrong.and_then(|k| formulas[k]) {
            let found = format!("the formula is no number at {} = {x}", variable.symbol());
            return Err(toml.wrong(formula, found, "a formula that is defined in its range"));
        }
    }
    let is_own = matches!((place, variable), (LawPlace::Joint(a), JointLawVariable::Angle(b) | JointLawVariable::Position(b)) if a == b);
    if law.is_sided() && !(is_own && per_joint.is_none()) {
        let first = formulas.iter().flatten().next().copied().unwrap_or(&raw.place);
        let expected = "no `side`: the way that a joint came is known for its own angle alone";
        return Err(toml.is("law.formula", first, expected));
    }
    Ok(law)
}

fn variables_of(place: LawPlace) -> String {
    match place {
        LawPlace::Tool => "\"weight along x of the tool\", y or z".to_owned(),
        LawPlace::Joint(joint) => format!(
            "\"angle of joint N\" (\"position of joint N\" of a prismatic one), \"sum of the angles of joints N and N+1\", \
             \"difference of the angles of joints N and N+1\" or \"torque of joint {}\"",
            joint + 1
        ),
        LawPlace::Axis(_) | LawPlace::Link(_) => {
            "\"angle of joint N\" (\"position of joint N\" of a prismatic one), \"sum of the angles of joints N and N+1\" or \
             \"difference of the angles of joints N and N+1\""
                .to_owned()
        }
    }
}

/// One of a joint, three of any other place; what is not there is nothing.
fn formulas<'r>(
    toml: &TomlText,
    spanned: &'r Spanned<RawLaw>,
    place: LawPlace,
) -> Result<Vec<Option<&'r Spanned<String>>>> {
    let raw = spanned.get_ref();
    let along = [&raw.formula_x, &raw.formula_y, &raw.formula_z];
    match (place.formulas(), &raw.formula, along.into_iter().flatten().next()) {
        (1, Some(formula), None) => Ok(vec![Some(formula)]),
        (1, _, Some(along)) => Err(toml.is("law.formula_x, _y or _z", along, "formula: a joint has one")),
        (3, None, Some(_)) => Ok(along.map(Option::as_ref).to_vec()),
        (3, Some(formula), _) => {
            Err(toml.is("law.formula", formula, "formula_x, formula_y, formula_z: one for each axis"))
        }
        _ => {
            let expected =
                if place.formulas() == 1 { "formula" } else { "formula_x, formula_y or formula_z" };
            Err(toml.wrong(spanned, "a law without a formula".to_owned(), expected))
        }
    }
}

/// The section of a law.
pub(super) fn written(law: &RobotLaw) -> String {
    let mut lines = vec![format!("\n[[law]]\nplace = {}", quoted(&law.place.to_string()))];
    lines.extend(law.per_joint.map(|joint| format!("per_joint = {}", joint + 1)));
    lines.push(format!("variable = {}", quoted(&law.variable.to_string())));
    let keys: &[&str] = match law.formulas.len() {
        1 => &["formula"],
        _ => &["formula_x", "formula_y", "formula_z"],
    };
    lines.extend(keys.iter().zip(&law.formulas).map(|(key, own)| format!("{key} = {}", quoted(own))));
    lines.extend(constants::written(law.range, law.source.as_deref(), &law.constants));
    lines.join("\n") + "\n"
}

#[cfg(test)]
mod tests {
    use crate::robot::{Hayati, Joint, Motion, Robot};

    fn arm() -> Robot {
        let joint = |(name, motion)| Joint::new(name, motion, Hayati::default());
        let joints = [("a", Motion::Revolute), ("b", Motion::Revolute), ("c", Motion::Prismatic)];
        Robot::new("arm", joints.map(joint).to_vec())
    }

    const TWIST: &str = r#"
[[law]]
place = "link 1"
per_joint = 1
variable = "angle of joint 2"
formula_x = "a_x*sign(q)*min(abs(q)/q_0, 1)"
formula_y = "0"
formula_z = "2*q"
range = [-80.0, 75.5]
source = "by hand"
[[law.constant]]
name = "a_x"
value = 12.5
standard_uncertainty = 0.5
unit = "µrad"
[[law.constant]]
name = "q_0"
value = 20.0
standard_uncertainty = 0.2
correlation = [-0.5]
unit = "°"
"#;

    #[test]
    fn a_law_is_written_as_it_was_read() {
        let mut read = arm();
        read.add_beside("effects.toml", TWIST).unwrap();
        assert!(read.beside_to_toml(&[]).ends_with(TWIST), "{}", read.beside_to_toml(&[]));
        let text = read.to_toml(&[]).unwrap();
        assert_eq!(Robot::from_text("arm.toml", &text, None, None).unwrap(), read);
        let added = read.laws[0].along(&[0.5, 40f64.to_radians()], &[], &[], 1.0);
        assert!((added[0] - 6.25e-6).abs() < 1e-18 && (added[2] - 40e-6).abs() < 1e-18, "{added:?}");
    }

    /// Each with line and column, and what would be right.
    #[test]
    fn what_is_no_law_is_refused_where_it_stands() {
        let law = |place: &str, variable: &str, rest: &str| {
            format!("[[law]]\nplace = \"{place}\"\nvariable = \"{variable}\"\n{rest}\nrange = [-90, 90]\n")
        };
        let cases = [
            (law("joint 4", "angle of joint 1", "formula = \"q\""), ":2:9", "N from 1 to 3"),
            (law("base", "angle of joint 1", "formula = \"q\""), ":2:9", "\"tool\""),
            (law("joint 1", "torque of joint 2", "formula = \"τ\""), ":3:12", "\"torque of joint 1\""),
            (law("joint 1", "angle of joint 3", "formula = \"q\""), ":3:12", "prismatic"),
            (law("joint 1", "time", "formula = \"t\""), ":3:12", "angle of joint N"),
            (law("tool", "angle of joint 1", "formula_x = \"q\""), ":3:12", "weight along x"),
            (law("joint 1", "angle of joint 1", "formula = \"3*(q\""), ":4:16", ")"),
            (law("joint 1", "angle of joint 1", "formula = \"3*k\""), ":4:14", "\"k\" in the formula"),
            (law("joint 1", "angle of joint 1", "formula = \"1/q\""), ":4:11", "no number at q = 0"),
            (law("joint 1", "angle of joint 2", "formula = \"side*q\""), ":4:11", "own angle"),
            (law("joint 1", "angle of joint 2", "formula_y = \"q\""), ":4:13", "a joint has one"),
            (law("link 1", "angle of joint 2", "formula = \"q\""), ":4:11", "one for each axis"),
            (law("link 1", "angle of joint 2", ""), ":1:1", "formula_x"),
            (law("joint 1", "angle of joint 2", "formula = \"q\"\nper_joint = 4"), ":5:13", "from 1 to 3"),
            (law("tool", "weight along x of the tool", "formula_x = \"g\"\nper_joint = 1"), ":5:13", "alone"),
            (law("joint 1", "angle of joint 2", "formula = \"q\"\nrang = 3"), ":5:1", "rang"),
            (
                law("joint 1", "angle of joint 2", "formula = \"q\"").replace("-90, 90", "9, 9"),
                ":5:9",
                "[from, to]",
            ),
            (
                law("joint 1", "angle of joint 2", "formula = \"q\"")
                    + "[[law.constant]]\nname = \"q\"\nvalue = 1\n",
                ":7:8",
                "a name of its own",
            ),
            (
                law("joint 1", "angle of joint 2", "formula = \"q\"")
                    + "[[law.constant]]\nname = \"k\"\nvalue = 1\ncorrelation = [0.1]\n",
                ":9:15",
                "0 numbers",
            ),
            (
                law("joint 1", "angle of joint 2", "formula = \"q\"")
                    + "[[law.constant]]\nname = \"k\"\nvalue = 1\n\
                       [[law.constant]]\nname = \"l\"\nvalue = 1\ncorrelation = [0.9]\n\
                       [[law.constant]]\nname = \"m\"\nvalue = 1\ncorrelation = [0.9, -0.9]\n",
                ":16:15",
                "can have with each other",
            ),
        ];
        for (text, place, expected) in cases {
            let message = arm().add_beside("e.toml", &text).unwrap_err().to_string();
            assert!(
                message.contains(&format!("e.toml{place}")) && message.contains(expected),
                "{text}{message}"
            );
        }
    }
}
