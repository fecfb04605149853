//! One run: what its `result.json` says, whatever command wrote it.

use serde_json::Value;

use crate::error::{Error, Place, Result};
use crate::limits;
use crate::statistics::HALF_95;

/// Commands that have commands of their own.
const FAMILIES: [&str; 4] = ["rig", "design", "diagnose", "trial"];
/// Degrees of freedom where the result does not say: a normal distribution.
const MANY: f64 = 1e9;

/// What a run found.
#[derive(Debug, Clone, PartialEq)]
pub struct Run {
    /// The folder, as the user named it.
    pub folder: String,
    /// As much of the end of it as distinguishes it from the others.
    pub label: String,
    /// "calibrate", "rig fit".
    pub subcommand: String,
    /// The whole command.
    pub command: String,
    /// Program and version.
    pub program: String,
    /// Every option by its name, and what it was set to, in words.
    pub options: Vec<(String, String)>,
    /// Files with the SHA-256 of their content.
    pub inputs: Vec<(String, String)>,
    /// What was estimated or calculated.
    pub parameters: Vec<Quantity>,
    /// How far off it is.
    pub errors: Vec<Quantity>,
    /// The verdict, where there is one.
    pub verdict: Option<String>,
    /// What a diagnosis found: effect and location.
    pub findings: Vec<String>,
}

/// A number of a run.
#[derive(Debug, Clone, PartialEq)]
pub struct Quantity {
    /// What it is.
    pub name: String,
    /// Its unit; empty for a pure number.
    pub unit: String,
    /// In that unit.
    pub value: f64,
    /// In that unit; nothing where the result has none, or the data do not identify the number.
    pub std_error: Option<f64>,
    /// Degrees of freedom of the standard error; very many where the result does not say.
    pub dof: f64,
    /// Which of several errors counts.
    pub precedence: Precedence,
}

/// Which of several errors counts: the first of these that both runs have, for it is of poses or
/// readings that the fit has not seen.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
pub enum Precedence {
    /// The mean at validation poses.
    Validation,
    /// The mean at held-out poses.
    HeldOutPoses,
    /// What findings leave of held-out data.
    HeldOutWithFindings,
    /// Any other number.
    Other,
}

impl Run {
    /// Of the text of `file`, the result in `folder`.
    ///
    /// # Errors
    /// [`Error::Syntax`] where the text is no JSON, [`Error::Input`] where it is no result that
    /// says what it was made of.
    pub fn from_text(folder: &str, file: &str, text: &str) -> Result<Run> {
        limits::check(file, text.len(), limits::RESULT_BYTES, "bytes")?;
        let json: Value = serde_json::from_str(text).map_err(|error| Error::Syntax {
            at: Place { file: file.into(), line: error.line(), column: error.column() },
            message: format!("no JSON: {}", crate::delimited::message(&error.to_string())),
        })?;
        let provenance = &json["provenance"];
        let (Some(command), Some(program)) = (provenance["command"].as_str(), provenance["program"].as_str())
        else {
            return Err(Error::Input {
                at: Place::whole_file(file),
                found: "there is no provenance".into(),
                expected: "the result of a command of rodcal with --out".into(),
                hint: Some("run the command again with --out".into()),
            });
        };
        let mut run = Run {
            folder: folder.into(),
            label: folder.into(),
            subcommand: subcommand(command),
            command: command.into(),
            program: program.into(),
            options: provenance["options"].as_object().into_iter().flatten().map(option).collect(),
            inputs: items(&provenance["inputs"]).filter_map(input).collect(),
            parameters: Vec::new(),
            errors: Vec::new(),
            verdict: json["verdict"].as_str().map(str::to_owned),
            findings: Vec::new(),
        };
        run.read("", &json);
        for mode in items(&json["modes"]) {
            let prefix = format!("{}: ", mode["mode"].as_str().unwrap_or("mode"));
            run.read(&prefix, mode);
        }
        if run.parameters.is_empty() && run.errors.is_empty() {
            run.parameters = figures(&json, "", Precedence::Other);
        }
        Ok(run)
    }

    fn read(&mut self, prefix: &str, json: &Value) {
        let named = |quantity: Quantity| Quantity { name: format!("{prefix}{}", quantity.name), ..quantity };
        let parameters = items(&json["parameters"]).filter_map(parameter);
        let parameters = parameters.chain(items(&json["slopes"]).filter_map(slope)).chain(ratios(json));
        self.parameters.extend(parameters.chain(compliances(json)).map(named));
        for finding in items(&json["findings"]) {
            let name = finding_name(finding);
            self.parameters.extend(items(&finding["parameters"]).filter_map(|p| found(&name, p)).map(named));
            self.findings.push(name);
        }
        self.errors.extend(items(&json["slopes"]).filter_map(scatter));
        // of several modes none counts more than another
        let precedence = |own: Precedence| if prefix.is_empty() { own } else { Precedence::Other };
        for (key, what, mean) in ERRORS {
            self.errors.extend(figures(&json[key], &format!("{prefix}{what}, "), precedence(mean)));
        }
        for (key, what, own) in SINGLE_ERRORS {
            let error = |value| Quantity {
                precedence: precedence(own),
                ..plain(format!("{prefix}{what}"), "µm", value)
            };
            self.errors.extend(json[key].as_f64().map(error));
        }
    }
}

/// Groups of errors in µm, what they are called, and what their mean counts.
const ERRORS: [(&str, &str, Precedence); 3] = [
    ("residual", "residual at the poses of the fit", Precedence::Other),
    ("validation", "error at validation poses", Precedence::Validation),
    ("cross_validation", "error at held-out poses", Precedence::HeldOutPoses),
];

/// Errors on their own, in µm, what they are called, and what they count.
const SINGLE_ERRORS: [(&str, &str, Precedence); 6] = [
    ("mean_error_um", "mean error that modes are compared by", Precedence::Other),
    ("noise_um", "scatter", Precedence::Other),
    ("rms_before_um", "rms without findings", Precedence::Other),
    ("rms_after_um", "rms with findings", Precedence::Other),
    ("heldout_before_um", "held-out rms without findings", Precedence::Other),
    ("heldout_after_um", "held-out rms with findings", Precedence::HeldOutWithFindings),
];

fn items(list: &Value) -> impl Iterator<Item = &Value> {
    list.as_array().into_iter().flatten()
}

fn input(input: &Value) -> Option<(String, String)> {
    Some((input["file"].as_str()?.to_owned(), input["sha256"].as_str()?.to_owned()))
}

fn plain(name: String, unit: &str, value: f64) -> Quantity {
    Quantity { name, unit: unit.into(), value, std_error: None, dof: MANY, precedence: Precedence::Other }
}

/// A parameter of a calibration; one that the data do not identify has no standard error worth the
/// name.
fn parameter(json: &Value) -> Option<Quantity> {
    let name = json["name"].as_str()?.replace('_', " ");
    let std_error = json["std_error"].as_f64().filter(|_| json["identifiable"].as_bool() != Some(false));
    let given = json["unit"].as_str().unwrap_or_default();
    let unit = match name_and_unit(&format!("_{given}")) {
        (words, unit) if words.is_empty() => unit,
        _ => given.to_owned(),
    };
    Some(Quantity { std_error, ..plain(name, &unit, json["value"].as_f64()?) })
}

fn slope(json: &Value) -> Option<Quantity> {
    let (channel, axis) = (json["channel"].as_str()?, json["axis"].as_str()?);
    let slope = plain(format!("slope of {channel} under load {axis}"), "µm/N", json["um_per_n"].as_f64()?);
    let dof = json["dof"].as_f64().unwrap_or(slope.dof);
    Some(Quantity { std_error: json["std_error"].as_f64(), dof, ..slope })
}

fn scatter(slope: &Value) -> Option<Quantity> {
    let (channel, axis) = (slope["channel"].as_str()?, slope["axis"].as_str()?);
    let name = format!("standard deviation from the line, {channel} under load {axis}");
    Some(plain(name, "µm", slope["residual_sd_um"].as_f64()?))
}

/// r of each axis, and r_rod.
fn ratios(json: &Value) -> impl Iterator<Item = Quantity> + '_ {
    let of_name = |name: String, value: &Value, [error, dof]: [&Value; 2]| {
        let dof = dof.as_f64().unwrap_or(MANY);
        Some(Quantity { std_error: error.as_f64(), dof, ..plain(name, "", value.as_f64()?) })
    };
    let each = json["r"].as_object().into_iter().flatten();
    let each = each.filter_map(move |(axis, r)| {
        of_name(format!("r{axis}"), r, [&json["r_std_error"][axis], &json["r_dof"][axis]])
    });
    each.chain(of_name("r_rod".into(), &json["r_rod"], [&json["r_rod_std_error"], &json["r_rod_dof"]]))
}

/// C^F and C^g of a model; what a rig measured stands in its slopes already.
fn compliances(json: &Value) -> Vec<Quantity> {
    let is_measured = json["slopes"].is_array();
    let matrices = [("C^F", "µm/N", "cf_um_per_n"), ("C^g", "µm/g", "cg_um_per_g")];
    let mut entries = Vec::new();
    for (name, unit, key) in matrices.into_iter().filter(|_| !is_measured) {
        for (i, row) in items(&json[key]).enumerate() {
            let row = items(row).enumerate().filter_map(|(k, entry)| Some((k, entry.as_f64()?)));
            entries.extend(row.map(|(k, value)| plain(format!("{name} {}{}", i + 1, k + 1), unit, value)));
        }
    }
    entries.extend(json["c_rod_um"].as_f64().map(|value| plain("c_rod".into(), "µm", value)));
    entries
}

/// An option as it stands in the provenance: its value, or whether it is set.
fn option((name, value): (&String, &Value)) -> (String, String) {
    let value = match value {
        Value::Null => "not given".to_owned(),
        Value::Bool(is_set) => if *is_set { "on" } else { "off" }.to_owned(),
        Value::String(text) => text.clone(),
        other => other.to_string(),
    };
    (format!("--{name}"), value)
}

fn finding_name(finding: &Value) -> String {
    let word = |key: &str| finding[key].as_str().unwrap_or_default().replace('_', " ");
    format!("{}, {}", word("effect"), word("location"))
}

/// A parameter of a finding; its 95 % interval gives its standard error.
fn found(finding: &str, json: &Value) -> Option<Quantity> {
    let (name, unit) = name_and_unit(json["name"].as_str()?);
    let width = json["hi"].as_f64().zip(json["lo"].as_f64()).map(|(hi, lo)| hi - lo);
    let quantity = plain(format!("{finding}: {name}"), &unit, json["value"].as_f64()?);
    Some(Quantity { std_error: width.map(|width| width / (2.0 * HALF_95)), ..quantity })
}

/// The numbers directly in an object, and in the objects in it; its `mean_um` counts as `mean`.
fn figures(json: &Value, prefix: &str, mean: Precedence) -> Vec<Quantity> {
    let mut figures = Vec::new();
    for (key, value) in json.as_object().into_iter().flatten() {
        let (name, unit) = name_and_unit(key);
        match value {
            Value::Number(number) => {
                let precedence = if key == "mean_um" { mean } else { Precedence::Other };
                let figure =
                    |value| Quantity { precedence, ..plain(format!("{prefix}{name}"), &unit, value) };
                figures.extend(number.as_f64().map(figure));
            }
            Value::Object(_) if prefix.is_empty() && key != "provenance" => {
                figures.extend(self::figures(value, &format!("{name}, "), mean));
            }
            _ => {}
        }
    }
    figures
}

/// The words of a key and the unit at its end: "bending", "µrad/(N·m)" of `bending_urad_per_nm`.
pub fn name_and_unit(key: &str) -> (String, String) {
    const UNITS: [(&str, &str); 17] = [
        ("_um_per_mm", "µm/mm"),
        ("_um_per_n", "µm/N"),
        ("_um_per_g", "µm/g"),
        ("_um_per_k", "µm/K"),
        ("_urad_per_nm", "µrad/(N·m)"),
        ("_n_per_mm", "N/mm"),
        ("_percent", "%"),
        ("_urad", "µrad"),
        ("_mm", "mm"),
        ("_um", "µm"),
        ("_kg", "kg"),
        ("_deg", "°"),
        ("_hz", "Hz"),
        ("_nm", "N·m"),
        ("_n", "N"),
        ("_g", "g"),
        ("_s", "s"),
    ];
    let ending = UNITS.iter().find_map(|(end, unit)| Some((key.strip_suffix(end)?, *unit)));
    let (words, unit) = ending.unwrap_or((key, ""));
    (words.replace('_', " "), unit.to_owned())
}

/// "rig fit" of "rodcal --json rig fit ROD READINGS".
fn subcommand(command: &str) -> String {
    let mut words = command.split(' ').skip(1).filter(|word| !word.starts_with('-'));
    let first = words.next().unwrap_or_default();
    match words.next() {
        Some(second) if FAMILIES.contains(&first) => format!("{first} {second}"),
        _ => first.to_owned(),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_subcommand_is_found_among_flags() {
        for (command, expected) in [
            ("rodcal calibrate c.toml --mode fea", "calibrate"),
            ("rodcal --json rig fit a b", "rig fit"),
            ("rodcal demo", "demo"),
            ("rodcal diagnose --png rig a b", "diagnose rig"),
        ] {
            assert_eq!(subcommand(command), expected);
        }
    }

    #[test]
    fn a_unit_is_no_word() {
        assert_eq!(name_and_unit("heldout_before_um"), ("heldout before".into(), "µm".into()));
        assert_eq!(name_and_unit("bending_urad_per_nm"), ("bending".into(), "µrad/(N·m)".into()));
        assert_eq!(name_and_unit("factor"), ("factor".into(), String::new()));
    }

    #[test]
    fn what_is_no_result_is_refused_with_its_place() {
        let refused = |text: &str| Run::from_text("a", "a/result.json", text).unwrap_err().to_string();
        assert!(
            refused("{\n  \"r\": }").starts_with("a/result.json:2:8: no JSON"),
            "{}",
            refused("{\n  \"r\": }")
        );
        for text in ["{}", "[]", "3", "{\"provenance\": {\"command\": 3}}"] {
            assert!(refused(text).starts_with("a/result.json: there is no provenance"), "{text}");
        }
    }
}
