//! Where something is: the `place` of a finding in a diagnosis' JSON, and of what is concealed.

use std::fmt;

use serde::{Deserialize, Serialize};

/// A place by the keys of the diagnosis' JSON; a key that is absent says nothing. The form of a law
/// (`form`) is no place and is not read.
#[derive(Debug, Clone, Default, PartialEq, Serialize, Deserialize)]
#[serde(default)]
#[allow(missing_docs, reason = "the keys say what they are")]
pub struct Place {
    /// A part of rig, rod or robot.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub part: Option<String>,
    /// A joint of the rod, a clamp, a socket.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub name: Option<String>,
    #[serde(skip_serializing_if = "Option::is_none")]
    pub key: Option<Key>,
    #[serde(skip_serializing_if = "Option::is_none")]
    pub station_mm: Option<f64>,
    #[serde(skip_serializing_if = "Option::is_none")]
    pub channel: Option<String>,
    #[serde(skip_serializing_if = "Option::is_none")]
    pub towards: Option<String>,
    #[serde(skip_serializing_if = "Option::is_none")]
    pub loads_along: Option<Axes>,
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
    #[serde(skip_serializing_if = "Option::is_none")]
    pub joint: Option<Joints>,
    #[serde(skip_serializing_if = "Option::is_none")]
    pub driven_by: Option<usize>,
    /// Several places of one thing.
    #[serde(skip_serializing_if = "Vec::is_empty")]
    pub all: Vec<Place>,
}

/// Columns, keys or files as their file names them; what is said more closely follows behind a
/// comma: `dy_um, trial 2`.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(from = "String", into = "String")]
pub struct Key {
    parts: Vec<String>,
}

impl Key {
    const COMMA: &str = ", ";

    /// True where this says what `other` says, or says it more closely.
    pub fn refines(&self, other: &Key) -> bool {
        self.parts.first() == other.parts.first() && other.parts.iter().all(|part| self.parts.contains(part))
    }
}

impl From<String> for Key {
    fn from(text: String) -> Key {
        Key { parts: text.split(Key::COMMA).map(str::to_owned).collect() }
    }
}

impl From<Key> for String {
    fn from(key: Key) -> String {
        key.parts.join(Key::COMMA)
    }
}

/// One axis, or the two that turn together.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(untagged)]
#[allow(missing_docs, reason = "the names say what they are")]
pub enum Axes {
    One(String),
    Two([String; 2]),
}

/// One joint of the robot, from 1, or all of them.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(untagged)]
#[allow(missing_docs, reason = "the names say what they are")]
pub enum Joints {
    One(usize),
    All(AllJoints),
}

/// As JSON `all`.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(rename_all = "lowercase")]
#[allow(missing_docs, reason = "the names say what they are")]
pub enum AllJoints {
    All,
}

impl Place {
    /// Before what is said more closely of a name: `all clamps, y into z`.
    pub const CLOSER: &str = ", ";

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
        Place { key: Some(key.to_owned().into()), ..Place::default() }
    }

    /// A joint of the robot, from 0.
    pub fn joint(joint: usize) -> Place {
        Place { joint: Some(Joints::One(joint + 1)), ..Place::default() }
    }

    /// All joints of the robot.
    pub fn all_joints() -> Place {
        Place { joint: Some(Joints::All(AllJoints::All)), ..Place::default() }
    }

    /// With loads along this axis only.
    pub fn loads_along(self, axis: &str) -> Place {
        Place { loads_along: Some(Axes::One(axis.into())), ..self }
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
            Some(Axes::One(axis)) => axis.clone(),
            Some(Axes::Two(axes)) => axes.join(" and "),
            None => String::new(),
        };
        let or_nothing = |text: &Option<String>| text.clone().unwrap_or_default();
        if let Some(part) = &self.part {
            f.write_str(part)?;
            return if axes.is_empty() { Ok(()) } else { write!(f, ", loads along {axes}") };
        }
        let key = self.key.clone().map(String::from);
        if let Some(name) = self.name.as_ref().or(key.as_ref()) {
            f.write_str(name)?;
            return self.after_row.map_or(Ok(()), |row| write!(f, ", after row {row}"));
        }
        if let Some(station) = self.station_mm {
            return write!(f, "station {station:.1} mm");
        }
        if let Some(joint) = &self.joint {
            match (joint, self.driven_by) {
                (Joints::One(joint), Some(from)) => write!(f, "joint {from} to {joint}")?,
                (Joints::One(joint), None) => write!(f, "joint {joint}")?,
                (Joints::All(_), _) => f.write_str("all joints")?,
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
    use serde_json::{Value, json};

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
    fn a_key_may_say_more_than_another() {
        let key = |text: &str| Key::from(text.to_owned());
        assert!(key("dy_um, axis y, trial 2").refines(&key("dy_um, trial 2")));
        assert!(!key("dy_um, trial 2").refines(&key("dy_um, axis y, trial 2")));
        assert!(!key("dy_um and dz_um").refines(&key("dy_um")));
        assert_eq!(String::from(key("x_mm, y_mm, z_mm")), "x_mm, y_mm, z_mm");
    }

    #[test]
    fn what_is_written_is_read_again() {
        let place = Place::part("slide").loads_along("y");
        let json = serde_json::to_value(&place).unwrap();
        assert_eq!(json, json!({"part": "slide", "loads_along": "y"}));
        assert_eq!(serde_json::from_value::<Place>(json).unwrap(), place);
    }
}
