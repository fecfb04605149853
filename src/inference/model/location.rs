//! Where an effect acts, as data.
//!
//! The engine only compares places; effects read them. [`Location`]'s `Display` is the text of
//! JSON and tables, and nothing reads that text back.

use std::fmt;

use crate::inference::Variable;
use crate::spatial::Axis;
use crate::units::MM;

/// A place. Joints, rows and the like are counted from 0 here and from 1 in texts, but for rows of
/// a file, which are counted from 1 everywhere.
#[derive(Debug, Clone, PartialEq)]
#[non_exhaustive]
pub enum Location {
    /// A part of rig, rod or robot as a whole.
    Part(Part),
    /// A part under loads along one axis only.
    UnderLoads {
        /// The part of rig or rod.
        part: Part,
        /// Axis of the loads.
        axis: Axis,
    },
    /// A part in one session, for which it was set up anew.
    InSession {
        /// The part of rig, rod or robot.
        part: Part,
        /// The session, as the file names it.
        session: String,
    },
    /// A part, by one of several forms of a law: `rod, since each load, t0 10 s`.
    Form {
        /// The part of rig, rod or robot.
        part: Part,
        /// The form, for people.
        form: String,
    },
    /// A joint of the rod, a clamp, a socket: what the user's file names.
    Named(String),
    /// What stands in the user's files: `dy_um and dz_um`.
    Key(Key),
    /// A place along the rod without a name, m from the flange.
    Station(f64),
    /// A sensor.
    Channel {
        /// The axis that it reads along.
        channel: Axis,
        /// One of several forms of a law, for people.
        form: Option<&'static str>,
    },
    /// A sensor that is turned from its axis towards another one.
    SensorTurn {
        /// Its own axis.
        from: Axis,
        /// The axis that it is turned towards.
        towards: Axis,
    },
    /// Loads that are turned from their axis towards another one.
    LoadTurn {
        /// Their own axis.
        from: Axis,
        /// The axis that they are turned towards.
        towards: Axis,
    },
    /// Loads along two axes, turned together about the third.
    LoadFrame {
        /// The two axes.
        axes: [Axis; 2],
        /// The third axis, about which they are turned.
        about: Axis,
    },
    /// Everything of a run after one row of the file.
    AfterRow {
        /// The run.
        run: Run,
        /// The last row before, from 1.
        row: usize,
        /// The channel, where it is not the one along the load.
        channel: Option<Axis>,
        /// True where the runs behind this one are shifted too, to the end of the file.
        for_good: bool,
    },
    /// One offset of one row of the file.
    Reading {
        /// Row, from 1.
        row: usize,
        /// Axis of the offset.
        channel: Axis,
    },
    /// A joint of the robot.
    Joint {
        /// Number from 0.
        joint: usize,
        /// One of several forms of a law, for people.
        form: Option<String>,
    },
    /// All joints of the robot.
    AllJoints,
    /// What one joint does to another.
    Coupling {
        /// The driving joint, from 0.
        from: usize,
        /// The driven joint, from 0.
        to: usize,
    },
    /// Every clamp.
    AllClamps,
    /// Something that moved after one row of the recording.
    Shift {
        /// The clamp, socket or plate; `None` is the robot's base.
        what: Option<String>,
        /// The last row before, from 0.
        row: usize,
        /// The same for people: `pose 7`, `row 12`.
        after: String,
    },
    /// A joint of the robot after one row of the recording.
    JointAfter {
        /// Number from 0.
        joint: usize,
        /// The last row before, from 0.
        row: usize,
        /// The same for people: `pose 7`.
        after: String,
    },
    /// One pose.
    Pose {
        /// Row, from 0.
        row: usize,
        /// For people: `pose 7`.
        name: String,
    },
    /// Several places of one finding.
    Several(Vec<Location>),
    /// Where physics that nobody has named is described by a smooth curve.
    Curve {
        /// The curve, for JSON and tables.
        label: String,
        /// Said of it: `follows the load (all readings alike)`.
        follows: String,
        /// The number that it is a function of, where there is one.
        along: Option<Variable>,
    },
}

/// What stands in the user's files, by the names that it has there.
#[derive(Debug, Clone, PartialEq, Eq)]
#[non_exhaustive]
pub struct Key {
    /// Columns, keys, ids or files: `q4_deg`, `dy_um and dz_um`, `clamps 1 and 2`, `5.toml`.
    pub names: String,
    /// Which rows of them, from the widest to the narrowest: `axis y`, `trial 2`. Empty for all.
    pub rows: Vec<String>,
}

/// A part of rig, rod or robot that every file of its kind has.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
#[non_exhaustive]
pub enum Part {
    /// The rod as a whole.
    Rod,
    /// The rod's pipe from the flange to its bend, with its sleeves.
    Pipe1,
    /// That from its bend to the tip.
    Pipe2,
    /// How long the rod is from its flange to its corner, L1.
    Length1,
    /// How long it is from its corner to the tip, L2.
    Length2,
    /// The angle between its pipes, γ.
    Angle,
    /// The rod's connection to the flange or the clamp of the rig.
    Root,
    /// The bend between the rod's pipes.
    Bend,
    /// The slide through which the rig's loads act.
    Slide,
    /// The pulleys over which the rig's loads pull.
    Pulley,
    /// What the rig's loads hang on.
    Hanger,
    /// What holds the rod on the rig.
    Clamp,
    /// The tip of the rod, where its ball is.
    Tip,
    /// The flange of the robot.
    Flange,
    /// What the flange carries.
    Tool,
    /// The arm as a whole.
    Arm,
    /// The base of the robot.
    Base,
    /// What sees the tip of the robot from a place of its own.
    Tracker,
    /// All sensors of the rig.
    Sensors,
    /// Where the rig's loads act on the rod.
    LoadPoint,
    /// Where the rig's sensors read the rod.
    ReadPoint,
    /// The frame in which the rig's loads have their directions.
    LoadFrame,
}

/// One pass through the loads of an axis.
#[derive(Debug, Clone, PartialEq, Eq)]
#[non_exhaustive]
pub struct Run {
    /// Axis of the loads.
    pub axis: Axis,
    /// The trial, as the file names it, or else the run's number from 1; `None` for the only one.
    pub name: Option<RunName>,
}

impl Run {
    /// A run along an axis, by its name where there are several.
    pub fn new(axis: Axis, name: Option<RunName>) -> Run {
        Run { axis, name }
    }
}

/// What names a run.
#[derive(Debug, Clone, PartialEq, Eq)]
#[non_exhaustive]
pub enum RunName {
    /// By the file's own name.
    Trial(String),
    /// By its number along its axis, from 1.
    Number(usize),
}

impl Key {
    /// All rows of what has these names.
    pub fn new(names: impl Into<String>) -> Key {
        Key { names: names.into(), rows: Vec::new() }
    }

    /// Of these rows alone.
    pub fn rows(mut self, rows: impl Into<String>) -> Key {
        self.rows.push(rows.into());
        self
    }
}

impl From<Key> for Location {
    fn from(key: Key) -> Location {
        Location::Key(key)
    }
}

impl Location {
    /// What stands in the user's files, all rows of it.
    pub fn key(names: impl Into<String>) -> Location {
        Location::Key(Key::new(names))
    }

    /// True of what begins after the same row and lasts as long, of whatever channel.
    pub fn is_after_row_of(&self, other: &Location) -> bool {
        match (self, other) {
            (
                Location::AfterRow { run, row, for_good, .. },
                Location::AfterRow { run: other_run, row: other_row, for_good: other_lasts, .. },
            ) => (run, row, for_good) == (other_run, other_row, other_lasts),
            _ => false,
        }
    }

    /// The place without the form of the law there: how a joint errs is not where.
    pub fn place(&self) -> Location {
        match self {
            Location::Joint { joint, .. } => Location::Joint { joint: *joint, form: None },
            other => other.clone(),
        }
    }

    /// The joint, from 0, where the place is one joint of the robot.
    pub fn joint(&self) -> Option<usize> {
        match self {
            Location::Joint { joint, .. } | Location::JointAfter { joint, .. } => Some(*joint),
            _ => None,
        }
    }

    /// The joint of the robot that acts and the one that moves, from 0: what tells places of one
    /// effect apart in another search, where nothing else of them is the same.
    pub fn joints(&self) -> Option<[usize; 2]> {
        match self {
            Location::Joint { joint, .. } => Some([*joint, *joint]),
            Location::Coupling { from, to } => Some([*from, *to]),
            _ => None,
        }
    }

    /// The last row, from 0, before something moved that stayed there.
    pub fn moved_after(&self) -> Option<usize> {
        match self {
            Location::Shift { row, .. } | Location::JointAfter { row, .. } => Some(*row),
            _ => None,
        }
    }

    /// One place of several.
    pub fn and(self, other: Location) -> Location {
        match self {
            Location::Several(mut all) => {
                all.push(other);
                Location::Several(all)
            }
            one => Location::Several(vec![one, other]),
        }
    }
}

impl fmt::Display for Location {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Location::Part(part) => write!(f, "{part}"),
            Location::UnderLoads { part, axis } => write!(f, "{part}, loads along {axis}"),
            Location::InSession { part, session } => write!(f, "{part}, session {session}"),
            Location::Form { part, form } => write!(f, "{part}, {form}"),
            Location::Named(name) => f.write_str(name),
            Location::Key(key) => write!(f, "{key}"),
            Location::Station(station) => write!(f, "station {:.1} mm", station / MM),
            Location::Channel { channel, form: None } => write!(f, "d{channel}"),
            Location::Channel { channel, form: Some(form) } => write!(f, "d{channel}, {form}"),
            Location::SensorTurn { from, towards } => write!(f, "d{from} towards d{towards}"),
            Location::LoadTurn { from, towards } => write!(f, "{from} towards {towards}"),
            Location::LoadFrame { axes: [a, b], about } => write!(f, "{a} and {b} about {about}"),
            Location::AfterRow { run, row, channel, for_good } => {
                write!(f, "{run}, after row {row}")?;
                channel.map_or(Ok(()), |channel| write!(f, ", d{channel}"))?;
                if *for_good { write!(f, ", for good") } else { Ok(()) }
            }
            Location::Reading { row, channel } => write!(f, "row {row} d{channel}"),
            Location::Joint { joint, form: None } => write!(f, "joint {}", joint + 1),
            Location::Joint { joint, form: Some(form) } => write!(f, "joint {}, {form}", joint + 1),
            Location::AllJoints => f.write_str("all joints"),
            Location::Coupling { from, to } => write!(f, "joint {} to {}", from + 1, to + 1),
            Location::AllClamps => f.write_str("all clamps"),
            Location::Shift { what: Some(what), after, .. } => write!(f, "{what}, after {after}"),
            Location::Shift { what: None, after, .. } => write!(f, "after {after}"),
            Location::JointAfter { joint, after, .. } => write!(f, "joint {}, after {after}", joint + 1),
            Location::Pose { name, .. } => f.write_str(name),
            Location::Several(all) => {
                for (k, one) in all.iter().enumerate() {
                    let before = if k == 0 { "" } else { "; " };
                    write!(f, "{before}{one}")?;
                }
                Ok(())
            }
            Location::Curve { label, .. } => f.write_str(label),
        }
    }
}

impl fmt::Display for Key {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(&self.names)?;
        self.rows.iter().try_for_each(|rows| write!(f, ", {rows}"))
    }
}

impl fmt::Display for Part {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(match self {
            Part::Rod => "rod",
            Part::Pipe1 => "pipe 1",
            Part::Pipe2 => "pipe 2",
            Part::Length1 => "length l1",
            Part::Length2 => "length l2",
            Part::Angle => "angle γ",
            Part::Root => "root",
            Part::Bend => "bend",
            Part::Slide => "slide",
            Part::Pulley => "pulley",
            Part::Hanger => "hanger",
            Part::Clamp => "clamp",
            Part::Tip => "tip",
            Part::Flange => "flange",
            Part::Tool => "tool",
            Part::Arm => "arm",
            Part::Base => "base",
            Part::Tracker => "tracker",
            Part::Sensors => "sensors",
            Part::LoadPoint => "load point",
            Part::ReadPoint => "read point",
            Part::LoadFrame => "load frame",
        })
    }
}

impl fmt::Display for Run {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match &self.name {
            None => write!(f, "{}", self.axis),
            Some(RunName::Trial(name)) => write!(f, "{}, trial {name}", self.axis),
            Some(RunName::Number(number)) => write!(f, "{}, run {number}", self.axis),
        }
    }
}
