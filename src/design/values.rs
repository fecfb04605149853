//! What a number may be: itself, one of a list, or one of a range.

use serde::Deserialize;
use toml::Spanned;

use crate::error::Result;
use crate::rod::file::Check;
use crate::toml_text::{Number, TomlText};
use crate::units::significant;

/// Most values of one key.
pub const MOST_VALUES: usize = crate::limits::DESIGN_VALUES;
/// Share of a step by which rounding may miss the end of a range.
const SLACK: f64 = 1e-9;

/// Combinations in a second, for an estimate of the time.
pub(super) const USUAL_SPEED: f64 = 1e6;

/// A time of computing (s) in words, roughly.
pub(super) fn duration(seconds: f64) -> String {
    let units = [(86_400.0 * 365.0, "years"), (86_400.0, "days"), (3600.0, "hours"), (60.0, "minutes")];
    let of_unit = units.into_iter().find(|(unit, _)| seconds > 2.0 * unit);
    let (unit, name) = of_unit.unwrap_or((1.0, "seconds"));
    format!("about {:.0} {name}", (seconds / unit).max(1.0))
}

/// Values of a key as the file has them.
#[derive(Debug, Deserialize)]
#[serde(untagged, expecting = "expected a number, a list of numbers, or a range {from, to, step}")]
pub(super) enum Raw {
    One(f64),
    List(Vec<f64>),
    Range(Range),
}

impl Raw {
    /// Both ends of a range.
    pub(super) fn ends(&self) -> Option<[f64; 2]> {
        match self {
            Raw::Range(range) => Some([range.from, range.to]),
            _ => None,
        }
    }
}

#[derive(Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) struct Range {
    from: f64,
    to: f64,
    step: f64,
}

/// What a key's values must be, and within which ones they usually are.
#[derive(Debug, Clone, Copy)]
pub(super) struct Bounds {
    pub least: f64,
    pub most: f64,
    pub expected: &'static str,
    pub unit: &'static str,
    pub usual: (f64, f64),
}

impl Bounds {
    pub const LENGTH: Bounds = Bounds {
        least: f64::MIN_POSITIVE,
        most: 1e6,
        expected: "lengths > 0 in mm, 1000000 at most",
        unit: "mm",
        usual: (1.0, 20_000.0),
    };
    pub const RADIUS: Bounds = Bounds {
        least: 0.0,
        most: 1e6,
        expected: "radii of 0 or more in mm, 1000000 at most",
        unit: "mm",
        usual: (1.0, 20_000.0),
    };
    pub const ANGLE: Bounds = Bounds {
        least: f64::MIN_POSITIVE,
        most: 180.0,
        expected: "angles in degrees, 0 < γ <= 180",
        unit: "degrees",
        usual: (10.0, 180.0),
    };
    pub const MASS: Bounds = Bounds {
        least: 0.0,
        most: 1e6,
        expected: "masses of 0 or more in g, 1000000 at most",
        unit: "g",
        usual: (0.1, 20_000.0),
    };
}

/// The values of `key` in the unit of its name, in the order of the file; those of a list that
/// stand there twice once.
///
/// # Errors
/// Those of the file: an empty list or range, a step that does not lead from one end to the other,
/// a value out of `bounds`, more than [`MOST_VALUES`].
pub(super) fn values(check: &mut Check, key: &str, raw: &Spanned<Raw>, bounds: Bounds) -> Result<Vec<f64>> {
    let toml = check.toml;
    let mut all = match raw.get_ref() {
        Raw::One(value) => vec![*value],
        Raw::List(values) => values.clone(),
        Raw::Range(Range { from, to, step }) => {
            if !from.is_finite() || !to.is_finite() {
                return Err(toml.is(key, raw, "a range between two finite numbers"));
            }
            if !step.is_finite() || *step <= 0.0 {
                return Err(toml.is(key, raw, "a range whose step is > 0"));
            }
            if to < from {
                return Err(toml.is(key, raw, "a range whose `to` is not below its `from`"));
            }
            let steps = (to - from) / step + SLACK;
            if steps >= MOST_VALUES as f64 {
                let count = match steps < 1e15 {
                    true => (steps as u64 + 1).to_string(),
                    false => significant(steps, 3),
                };
                let seconds = steps / USUAL_SPEED;
                let time = if seconds > 60.0 {
                    format!(", {} of computing or more", duration(seconds))
                } else {
                    String::new()
                };
                let expected =
                    format!("at most {MOST_VALUES} values where these are {count}{time}: take larger steps");
                return Err(toml.is(key, raw, &expected));
            }
            (0..=steps as usize).map(|k| from + k as f64 * step).collect()
        }
    };
    if all.is_empty() {
        return Err(toml.is(key, raw, "at least one value"));
    }
    if all.len() > MOST_VALUES {
        return Err(toml.is(key, raw, &format!("at most {MOST_VALUES} values")));
    }
    let ends = raw.get_ref().ends().into_iter().flatten();
    if all.iter().copied().chain(ends).any(|value| !(bounds.least..=bounds.most).contains(&value)) {
        return Err(toml.is(key, raw, bounds.expected));
    }
    let mut seen: Vec<f64> = Vec::new();
    if matches!(raw.get_ref(), Raw::List(_)) {
        all.retain(|value| {
            !seen.contains(value) && {
                seen.push(*value);
                true
            }
        });
    }
    // one that is most likely in another unit speaks for all
    let is_odd = |value: &&f64| **value != 0.0 && !(bounds.usual.0..=bounds.usual.1).contains(*value);
    if let Some(odd) = all.iter().find(is_odd) {
        check.usual(key, *odd, bounds.unit, bounds.usual.0, bounds.usual.1);
    }
    Ok(all)
}

/// A limit in the unit of its name.
pub(super) fn limit(toml: &TomlText, key: &str, number: &Number) -> Result<f64> {
    toml.positive(&format!("constraints.{key}"), number)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[derive(Deserialize)]
    struct One {
        x: Spanned<Raw>,
    }

    fn read(text: &str) -> Result<Vec<f64>> {
        let text = format!("x = {text}\n");
        let toml = TomlText::new("d.toml", &text);
        let one: One = toml.parse(&[])?;
        values(&mut Check { toml, warnings: Vec::new() }, "x", &one.x, Bounds::LENGTH)
    }

    #[test]
    fn numbers_lists_and_ranges_are_values() {
        assert_eq!(read("150").unwrap(), [150.0]);
        assert_eq!(read("[1, 2.5, 1]").unwrap(), [1.0, 2.5]);
        assert_eq!(read("{ from = 0.1, to = 0.4, step = 0.1 }").unwrap().len(), 4);
        assert_eq!(read("{ from = 10, to = 25, step = 10 }").unwrap(), [10.0, 20.0]);
        assert_eq!(read("{ from = 10, to = 10, step = 5 }").unwrap(), [10.0]);
    }

    #[test]
    fn what_is_no_set_of_values_is_refused_where_it_stands() {
        for (text, expected) in [
            ("[]", "expected at least one value"),
            ("0", "expected lengths > 0 in mm, 1000000 at most"),
            ("1e9", "expected lengths > 0 in mm, 1000000 at most"),
            ("[150, -1]", "expected lengths > 0 in mm"),
            ("{ from = 2, to = 1, step = 1 }", "expected a range whose `to` is not below its `from`"),
            ("{ from = 1, to = 2, step = 0 }", "expected a range whose step is > 0"),
            ("{ from = 1, to = 2, step = nan }", "expected a range whose step is > 0"),
            ("{ from = 1, to = nan, step = 1 }", "expected a range between two finite numbers"),
            ("{ from = 1, to = 2e6, step = 1 }", "expected at most 100000 values where these are 2000000"),
            ("\"long\"", "expected a number, a list of numbers, or a range {from, to, step}"),
        ] {
            let error = read(text).unwrap_err().to_string();
            assert!(error.starts_with("d.toml:1:5: ") && error.contains(expected), "{error}");
        }
    }
}
