//! Where something is: the `place` of a finding in a diagnosis' JSON, and of what is concealed.

use std::fmt;

use serde::{Deserialize, Serialize};
use serde_json::Value;

/// A place by the keys of the diagnosis' JSON; a key that is absent says nothing. The form of a law
/// (`form`) is no place and is not read.
#[derive(Debug, Clone, Default, PartialEq, Serialize, Deserialize)]
#[serde(default)]
#[allow(missing_docs)] // the keys say what they are
pub struct Place {
    /// A part of rig, rod or robot.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub part: Option<String>,
    /// A joint of the rod, a clamp, a socket.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub name: Option<String>,
    /// Columns, keys or files.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub key: Option<String>,
    #[serde(skip_serializing_if = "Option::is_none")]
    pub station_mm: Option<f64>,
    #[serde(skip_serializing_if = "Option::is_none")]
    pub channel: Option<String>,
    #[serde(skip_serializing_if = "Option::is_none")]
    pub towards: Option<String>,
    /// An axis, or a list of two.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub loads_along: Option<Value>,
    #[serde(skip_serializing_if = "Option::is_none")]
    pub about: Option<String>,
    #[serde(skip_serializing_if = "Option::is_none")]
    pub trial: Option<String>,
    #[serde(skip_serializing_if = "Option::is_none")]
    pub run: Option<usize>,
    #[serde(skip_serializing_if = "Option::is_none")]
    pub after_row: Option<usize>,
    #[serde(skip_serializing_if = "Option::is_none")]
    pub row: Option<usize>,
    /// The number of a joint of the robot, or `all`.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub joint: Option<Value>,
    #[serde(skip_serializing_if = "Option::is_none")]
    pub driven_by: Option<usize>,
    /// Several places of one thing.
    #[serde(skip_serializing_if = "Vec::is_empty")]
    pub all: Vec<Place>,
}

impl Place {
    /// A part of rig, rod or robot.
    pub fn part(part: &str) -> Place {
        Place { part: Some(part.into()), ..Place::default() }
    }

    /// A joint of the rod, a clamp, a socket.
    pub fn named(name: &str) -> Place {
        Place { name: Some(name.into()), ..Place::default() }
    }

    /// Columns, keys or files.
    pub fn key(key: &str) -> Place {
        Place { key: Some(key.into()), ..Place::default() }
    }

    /// A joint of the robot, from 0.
    pub fn joint(joint: usize) -> Place {
        Place { joint: Some((joint + 1).into()), ..Place::default() }
    }

    /// With loads along this axis only.
    pub fn loads_along(self, axis: &str) -> Place {
        Place { loads_along: Some(axis.into()), ..self }
    }

    /// True where nothing is said.
    pub fn is_nowhere(&self) -> bool {
        *self == Place::default()
    }
}

/// In the words of a diagnosis.
impl fmt::Display for Place {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        if !self.all.is_empty() {
            let all: Vec<String> = self.all.iter().map(Place::to_string).collect();
            return f.write_str(&all.join("; "));
        }
        let axes = match &self.loads_along {
            Some(Value::String(axis)) => axis.clone(),
            Some(Value::Array(axes)) => {
                axes.iter().filter_map(Value::as_str).collect::<Vec<_>>().join(" and ")
            }
            _ => String::new(),
        };
        let or_nothing = |text: &Option<String>| text.clone().unwrap_or_default();
        if let Some(part) = &self.part {
            f.write_str(part)?;
            return if axes.is_empty() { Ok(()) } else { write!(f, ", loads along {axes}") };
        }
        if let Some(name) = self.name.as_ref().or(self.key.as_ref()) {
            f.write_str(name)?;
            return self.after_row.map_or(Ok(()), |row| write!(f, ", after row {row}"));
        }
        if let Some(station) = self.station_mm {
            return write!(f, "station {station:.1} mm");
        }
        if let Some(joint) = &self.joint {
            match (joint.as_u64(), self.driven_by) {
                (Some(joint), Some(from)) => write!(f, "joint {from} to {joint}")?,
                (Some(joint), None) => write!(f, "joint {joint}")?,
                _ => f.write_str("all joints")?,
            }
            return self.after_row.map_or(Ok(()), |row| write!(f, ", after row {row}"));
        }
        if let Some(row) = self.row {
            return match &self.channel {
                Some(channel) => write!(f, "row {row} {channel}"),
                None => write!(f, "pose {row}"),
            };
        }
        if let Some(about) = &self.about {
            return write!(f, "{axes} about {about}");
        }
        if let Some(towards) = &self.towards {
            return write!(f, "{}{axes} towards {towards}", or_nothing(&self.channel));
        }
        let Some(row) = self.after_row else { return f.write_str(&or_nothing(&self.channel)) };
        f.write_str(&axes)?;
        match (&self.trial, self.run) {
            (Some(trial), _) => write!(f, ", trial {trial}")?,
            (None, Some(run)) => write!(f, ", run {run}")?,
            (None, None) => {}
        }
        write!(f, ", after row {row}")?;
        self.channel.as_ref().map_or(Ok(()), |channel| write!(f, ", {channel}"))
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use serde_json::json;

    #[test]
    fn a_place_is_read_without_the_form_of_its_law() {
        let read = |value: Value| serde_json::from_value::<Place>(value).unwrap();
        assert_eq!(read(json!({"part": "rod", "form": "since each load"})), Place::part("rod"));
        let slip = json!({"loads_along": "y", "trial": "2", "run": null, "after_row": 7, "channel": null});
        let slip = read(slip);
        assert_eq!((slip.to_string().as_str(), slip.after_row), ("y, trial 2, after row 7", Some(7)));
        let frame = read(json!({"loads_along": ["y", "z"], "about": "x"}));
        assert_eq!(frame.to_string(), "y and z about x");
        assert_eq!(read(json!({"joint": 6, "driven_by": 5})).to_string(), "joint 5 to 6");
        assert_eq!(read(json!({"joint": "all"})).to_string(), "all joints");
        let all = read(json!({"all": [{"row": 3, "channel": "dx"}, {"row": 4, "channel": "dy"}]}));
        assert_eq!(all.to_string(), "row 3 dx; row 4 dy");
        assert!(read(json!({"curve": "load"})).is_nowhere());
    }

    #[test]
    fn what_is_written_is_read_again() {
        let place = Place::part("slide").loads_along("y");
        let json = serde_json::to_value(&place).unwrap();
        assert_eq!(json, json!({"part": "slide", "loads_along": "y"}));
        assert_eq!(serde_json::from_value::<Place>(json).unwrap(), place);
    }
}
