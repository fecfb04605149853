//! The keys of a campaign file, as they stand there.

use serde::Deserialize;
use toml::Spanned;

use super::super::constraints::{RawParameters, RawPrior};
use crate::error::Error;
use crate::toml_text::{Number, Required};

/// The whole file.
#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
pub struct RawCampaign {
    pub robot: Spanned<String>,
    pub effects: Option<Spanned<String>>,
    pub rod: Option<Spanned<String>>,
    pub rig: Option<Spanned<String>>,
    pub contact_force_n: Option<Spanned<Vec<Number>>>,
    pub measurements: Option<Spanned<String>>,
    pub validation: Option<Spanned<String>>,
    pub base_link: Option<String>,
    pub tip_link: Option<String>,
    pub validation_refit: Option<Spanned<String>>,
    pub tool: Option<RawTool>,
    pub base: Option<RawBase>,
    #[serde(default)]
    pub clamp: Vec<RawClamp>,
    pub sockets: Option<RawSockets>,
    pub noise: Option<RawNoise>,
    pub accuracy: Option<RawAccuracy>,
    #[serde(default)]
    pub parameters: RawParameters,
    #[serde(default)]
    pub prior: Vec<RawPrior>,
}

/// What a campaign has beyond a plan.
#[derive(Deserialize)]
pub struct Recorded {
    #[serde(rename = "measurements")]
    _measurements: Spanned<String>,
}

#[derive(Deserialize)]
#[serde(deny_unknown_fields, expecting = "a section [tool] with xyz_mm")]
pub struct RawTool {
    pub xyz_mm: Spanned<Vec<Number>>,
}

#[derive(Deserialize)]
#[serde(deny_unknown_fields, expecting = "a section [base] with xyz_mm and rpy_deg")]
pub struct RawBase {
    pub xyz_mm: Option<Spanned<Vec<Number>>>,
    pub rpy_deg: Option<Spanned<Vec<Number>>>,
}

#[derive(Deserialize)]
#[serde(deny_unknown_fields, expecting = "a section [[clamp]] with id, xyz_mm, rpy_deg")]
pub struct RawClamp {
    pub id: Spanned<String>,
    pub xyz_mm: Spanned<Vec<Number>>,
    pub rpy_deg: Option<Spanned<Vec<Number>>>,
}

#[derive(Deserialize)]
#[serde(deny_unknown_fields, expecting = "a section [sockets] with distance_mm")]
pub struct RawSockets {
    pub distance_mm: Number,
    pub distance_sd_mm: Option<Number>,
}

#[derive(Deserialize)]
#[serde(deny_unknown_fields, expecting = "a section [noise] with position_um, clamp_um")]
pub struct RawNoise {
    pub position_um: Option<Number>,
    pub clamp_um: Option<Number>,
}

#[derive(Deserialize)]
#[serde(deny_unknown_fields, expecting = "a section [accuracy] with mean_um, max_um")]
pub struct RawAccuracy {
    pub mean_um: Option<Number>,
    pub max_um: Option<Number>,
}

/// What a campaign file cannot do without, in words.
pub const REQUIRED: &Required = &[
    ("robot", "`robot = \"FILE\"` in the first lines: a URDF, a robot in TOML, or \"builtin:tx90\""),
    ("measurements", "`measurements = \"FILE\"` in the first lines: the CSV file of the recorded poses"),
    ("xyz_mm", "a position [x, y, z] in mm"),
    ("id", "the clamp's name in quotes, as in the column clamp of the measurements"),
    ("distance_mm", "the distance between the sockets 0 and 1 of a placement in mm"),
    ("parameter", "the name of a parameter with its unit, such as \"a2_mm\""),
    ("value", "what the parameter is known to be, in the unit that its name ends with"),
    ("sd", "the standard deviation of that knowledge, in the unit that the parameter's name ends with"),
];

/// A key of the file itself that stands below a `[section]` belongs to that section, in TOML, not
/// to the file.
pub fn above_the_sections(error: Error) -> Error {
    const KEYS: [&str; 10] = [
        "robot",
        "effects",
        "rod",
        "rig",
        "contact_force_n",
        "measurements",
        "validation",
        "base_link",
        "tip_link",
        "validation_refit",
    ];
    let stray = match &error {
        Error::Input { found, .. } => found.strip_prefix("unknown key `").and_then(|f| f.strip_suffix('`')),
        _ => None,
    };
    match stray.filter(|key| KEYS.contains(key)) {
        Some(key) => {
            let hint = format!("write {key} above the first [section]");
            error.with_hint(Some(hint))
        }
        None => error,
    }
}
