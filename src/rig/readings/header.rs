//! What the comment lines above a table of readings say of the rig: `# key = value`.

use super::warning::Warning;
use crate::delimited::{Dialect, nearest_name, quoted};
use crate::error::{Error, Place, Result};
use crate::toml_text::in_unit;
use crate::units::{PERCENT, UM};

/// What is known of the rig besides its readings.
///
/// ```
/// use rodcal::rig::readings::{Driven, Readings};
///
/// let text = "# driven = \"displacement\"\n# noise_um = 1.5\naxis,load_n,dz_um\nz,1,4\nz,2,8\n";
/// let header = Readings::from_text("rig.csv", text)?.header;
/// assert_eq!(header.driven, Driven::Displacement);
/// assert!(header.noise.is_some_and(|noise| (noise - 1.5e-6).abs() < 1e-18));
/// assert_eq!(header.sensor_scale, 0.001); // unless stated
/// # Ok::<(), rodcal::Error>(())
/// ```
#[derive(Debug, Clone, Copy, PartialEq)]
#[non_exhaustive]
pub struct RigHeader {
    /// What was set and what was measured.
    pub driven: Driven,
    /// Stated noise of one reading, one standard deviation, m; `None`: not stated.
    pub noise: Option<f64>,
    /// Stated noise of a measured load, one standard deviation, N; `None`: not stated. Of
    /// displacement-driven recordings.
    pub load_noise: Option<f64>,
    /// Relative standard uncertainty of the scale of all loads, dimensionless; 0 is exact.
    pub load_scale: f64,
    /// Relative standard uncertainty of the scale of each sensor, dimensionless; 0 is exact.
    pub sensor_scale: f64,
    /// Channels whose scale is known from their own readings only.
    pub(crate) has_unknown_scale: [bool; 3],
}

/// What a rig sets; the other is what it measures.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub enum Driven {
    /// Weights are hung and offsets are read.
    #[default]
    Load,
    /// The tip is moved and the load is read.
    Displacement,
}

impl Default for RigHeader {
    /// Hung weights, noise not stated, scales of 0.1 %.
    fn default() -> Self {
        RigHeader {
            driven: Driven::Load,
            noise: None,
            load_noise: None,
            load_scale: 0.001,
            sensor_scale: 0.001,
            has_unknown_scale: [false; 3],
        }
    }
}

const KEYS: [&str; 5] = ["driven", "noise_um", "noise_n", "load_scale_percent", "sensor_scale_percent"];

impl RigHeader {
    pub(super) fn check(&self) -> Result<()> {
        let values = [
            ("noise", self.noise.unwrap_or(0.0)),
            ("load_noise", self.load_noise.unwrap_or(0.0)),
            ("load_scale", self.load_scale),
            ("sensor_scale", self.sensor_scale),
        ];
        match values.into_iter().find(|(_, value)| !(value.is_finite() && *value >= 0.0)) {
            None => Ok(()),
            Some((name, value)) => Err(Error::Argument {
                name,
                found: value.to_string(),
                expected: "one standard deviation >= 0, in SI units".into(),
            }),
        }
    }

    /// The comment lines that say what is not the default.
    pub(super) fn lines(&self) -> Vec<String> {
        let usual = RigHeader::default();
        let mut lines = Vec::new();
        if self.driven == Driven::Displacement {
            lines.push("driven = \"displacement\"".to_owned());
        }
        if let Some(noise) = self.noise {
            lines.push(format!("noise_um = {}", in_unit(noise, UM)));
        }
        if let Some(noise) = self.load_noise {
            lines.push(format!("noise_n = {noise}"));
        }
        if self.load_scale != usual.load_scale {
            lines.push(format!("load_scale_percent = {}", in_unit(self.load_scale, PERCENT)));
        }
        if self.sensor_scale != usual.sensor_scale {
            lines.push(format!("sensor_scale_percent = {}", in_unit(self.sensor_scale, PERCENT)));
        }
        lines
    }

    fn set(&mut self, key: &str, value: &str, decimal_mark: char) -> std::result::Result<(), &'static str> {
        const NUMBER: &str = "one standard deviation, a number >= 0";
        let number = || {
            let plain = if decimal_mark == ',' { value.replace(',', ".") } else { value.to_owned() };
            plain.parse::<f64>().ok().filter(|n| n.is_finite() && *n >= 0.0).ok_or(NUMBER)
        };
        match key {
            "driven" => {
                self.driven = match value.trim_matches(['"', '\'']) {
                    "load" => Driven::Load,
                    "displacement" => Driven::Displacement,
                    _ => return Err("\"load\" or \"displacement\""),
                }
            }
            "noise_um" => {
                self.noise = match number()? * UM {
                    noise if noise > 0.0 => Some(noise),
                    _ => return Err("one standard deviation of a reading > 0"),
                }
            }
            "noise_n" => {
                self.load_noise = match number()? {
                    noise if noise > 0.0 => Some(noise),
                    _ => return Err("one standard deviation of a measured load > 0"),
                }
            }
            "load_scale_percent" => self.load_scale = number()? * PERCENT,
            _ => self.sensor_scale = number()? * PERCENT,
        }
        Ok(())
    }
}

/// The header of the rig, the text of all other comment lines above the table, and warnings about
/// keys that are nearly known.
pub(super) fn read(
    file: &str,
    text: &str,
    dialect: Dialect,
) -> Result<(RigHeader, Option<String>, Vec<Warning>)> {
    let mut load_noise_at = None;
    let text = text.strip_prefix('\u{feff}').unwrap_or(text);
    let (mut header, mut seen, mut comments, mut warnings) =
        (RigHeader::default(), Vec::new(), Vec::new(), Vec::new());
    let above = text.lines().take_while(|line| line.trim().is_empty() || line.trim_start().starts_with('#'));
    for (number, line) in (1..).zip(above) {
        let comment = line.trim().trim_start_matches('#').trim();
        let statement = comment.split_once('=').map(|(key, value)| (key.trim(), value.trim()));
        let known = statement.and_then(|(key, value)| {
            Some((*KEYS.iter().find(|known| known.eq_ignore_ascii_case(key))?, value))
        });
        let Some((key, value)) = known else {
            if let Some((key, _)) = statement
                && !key.contains(char::is_whitespace)
                && let Some(nearest) = nearest_name(key, &KEYS)
            {
                warnings.push(Warning::UnknownKey { key: key.to_owned(), nearest });
            }
            if !comment.is_empty() {
                comments.push(comment);
            }
            continue;
        };
        let at = |piece: &str| {
            let before = line.find(piece).and_then(|start| line.get(..start)).unwrap_or_default();
            Place { file: file.to_owned(), line: number, column: before.chars().count() + 1 }
        };
        if seen.contains(&key) {
            return Err(Error::Input {
                at: at(comment),
                found: format!("a second {key}"),
                expected: "every key once".into(),
                hint: None,
            });
        }
        seen.push(key);
        // behind the value another comment may stand
        let value = value.split('#').next().unwrap_or_default().trim();
        if let Err(expected) = header.set(key, value, dialect.decimal_mark) {
            return Err(Error::Input {
                at: at(if value.is_empty() { comment } else { value }),
                found: format!("{key} is {}", quoted(value)),
                expected: expected.into(),
                hint: None,
            });
        }
        if key == "noise_n" {
            load_noise_at = Some(at(comment));
        }
    }
    if let Some(at) = load_noise_at.filter(|_| header.driven == Driven::Load) {
        return Err(Error::Input {
            at,
            found: "noise_n, the noise of a measured load, where loads are set".into(),
            expected: "driven = \"displacement\" beside it, or no noise_n".into(),
            hint: None,
        });
    }
    let comments = comments.join(" ");
    Ok((header, (!comments.is_empty()).then_some(comments), warnings))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::rig::readings::Readings;

    const TABLE: &str = "axis,load_n,dz_um\nz,1,4\nz,2,8\n";

    fn header_of(lines: &str) -> Result<Readings> {
        Readings::from_text("f", &format!("{lines}{TABLE}"))
    }

    #[test]
    fn statements_about_the_rig_are_read_and_all_else_is_its_source() {
        let readings = header_of(
            "\u{feff}# cell 3, 4 May\n#driven = displacement\n\n#  Noise_um= 1.5 # of one reading\n\
             # load_scale_percent = 0\n# sensor_scale_percent = 0.25\n# rod = 5#, x = y\n",
        )
        .unwrap();
        let RigHeader { driven, noise, load_noise, load_scale, sensor_scale, .. } = readings.header;
        assert_eq!(load_noise, None);
        assert_eq!((driven, load_scale, sensor_scale), (Driven::Displacement, 0.0, 0.0025));
        assert_eq!(noise, Some(1.5 * UM));
        assert_eq!(readings.source.as_deref(), Some("cell 3, 4 May rod = 5#, x = y"));
        assert_eq!(readings.warnings, []);
        assert_eq!(header_of("").unwrap().header, RigHeader::default());
        let commas = "# noise_um = 1,5\naxis;load_n;dz_um\nz;1,5;4\nz;2,5;8\n";
        assert_eq!(Readings::from_text("f", commas).unwrap().header.noise, Some(1.5 * UM));
    }

    #[test]
    fn nonsense_is_refused_where_it_stands() {
        for (lines, expected) in [
            (
                "# driven = velocity\n",
                "f:1:12: driven is \"velocity\", expected \"load\" or \"displacement\"",
            ),
            (
                "# a\n#noise_um = -1\n",
                "f:2:13: noise_um is \"-1\", expected one standard deviation, a number >= 0",
            ),
            (
                "# noise_um = 0\n",
                "f:1:14: noise_um is \"0\", expected one standard deviation of a reading > 0",
            ),
            (
                "# noise_um = 1,5\n",
                "f:1:14: noise_um is \"1,5\", expected one standard deviation, a number >= 0",
            ),
            (
                "# noise_um = inf\n",
                "f:1:14: noise_um is \"inf\", expected one standard deviation, a number >= 0",
            ),
            (
                "# load_scale_percent = \n",
                "f:1:3: load_scale_percent is \"\", expected one standard deviation, a number >= 0",
            ),
            (
                "# noise_n = 0.1\n",
                "f:1:3: noise_n, the noise of a measured load, where loads are set, expected driven = \
                 \"displacement\" beside it, or no noise_n",
            ),
            ("# noise_um = 1\n# noise_um = 1\n", "f:2:3: a second noise_um, expected every key once"),
        ] {
            assert_eq!(header_of(lines).unwrap_err().to_string(), expected);
        }
    }

    #[test]
    fn a_key_that_is_nearly_known_is_warned_about() {
        let readings = header_of("# noise_µm = 1.5\n# the rod = 5#\n").unwrap();
        let warnings: Vec<String> = readings.warnings.iter().map(ToString::to_string).collect();
        assert_eq!(warnings, ["the comment line with \"noise_µm\" is not read; did you mean noise_um?"]);
        assert_eq!(readings.header.noise, None);
    }

    #[test]
    fn a_header_that_is_written_is_read_as_the_same() {
        let header = RigHeader {
            driven: Driven::Displacement,
            noise: Some(1.37e-6),
            load_noise: Some(0.02),
            load_scale: 0.0,
            sensor_scale: 0.35 * PERCENT,
            ..RigHeader::default()
        };
        let readings = header_of("# made\n").unwrap().with_header(header).unwrap();
        let again = Readings::from_text("f", &readings.to_csv(&["made again".into()])).unwrap();
        assert_eq!((again.header, again.source.as_deref()), (header, Some("made again")));
        let wrong = RigHeader { noise: Some(-1.0), ..header };
        assert!(header_of("").unwrap().with_header(wrong).is_err());
    }
    /// The example of docs/rig.md is what it says it is.
    #[test]
    fn the_example_of_the_documents_is_read() {
        let text = include_str!("../../../docs/rig.md");
        let example = text.split("```csv\n").nth(1).and_then(|rest| rest.split("```").next()).unwrap();
        let readings = Readings::from_text("docs/rig.md", example).unwrap();
        let RigHeader { noise, load_scale, .. } = readings.header;
        assert_eq!((noise, load_scale), (Some(1.5 * UM), 0.01 * PERCENT));
        assert_eq!(readings.source.as_deref(), Some("cell 3, weights of class M1"));
        let sizes: Vec<usize> = readings.instants().iter().map(|instant| instant.rows.len()).collect();
        assert_eq!(sizes, [2, 2, 1]);
        assert_eq!(readings.rows[4].session.as_deref(), Some("tuesday"));
    }
}
