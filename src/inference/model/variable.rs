//! The numbers of a recording that a mismatch may follow.

use std::fmt;

use crate::spatial::Axis;

/// A number that every datum has, along which residuals may be structured.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
#[non_exhaustive]
pub enum Variable {
    /// Size of the load, N.
    Load,
    /// The load along the positive axis, N.
    SignedLoad,
    /// −1 while loading, 1 while unloading.
    Phase,
    /// Place in the order of recording.
    Order,
    /// Time, s.
    Time,
    /// Time since the run began, s.
    TimeInRun,
    /// Temperature, °C.
    Temperature,
    /// Number of the trial.
    Trial,
    /// Which sensor.
    Channel,
    /// Axis of the load.
    LoadAxis,
    /// Which clamp or socket.
    Fixture,
    /// A coordinate of the tip in {W}, m.
    Tip(Axis),
    /// Something of a joint, counted from 0.
    Joint(usize, JointVariable),
}

/// What of a joint.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
#[non_exhaustive]
pub enum JointVariable {
    /// Its angle, rad.
    Angle,
    /// The torque of all loads about its axis, N·m.
    Torque,
    /// The direction that it came from: 1 or −1.
    Approach,
    /// Its last move, rad.
    Move,
}

impl Variable {
    /// Unit for people; nothing for a number without one.
    pub fn unit(self) -> &'static str {
        match self {
            Variable::Load | Variable::SignedLoad => "N",
            Variable::Time | Variable::TimeInRun => "s",
            Variable::Temperature => "°C",
            Variable::Tip(_) => "m",
            Variable::Joint(_, JointVariable::Angle | JointVariable::Move) => "rad",
            Variable::Joint(_, JointVariable::Torque) => "N·m",
            Variable::Joint(_, JointVariable::Approach)
            | Variable::Phase
            | Variable::Order
            | Variable::Trial
            | Variable::Channel
            | Variable::LoadAxis
            | Variable::Fixture => "",
        }
    }

    /// As a title of an axis or of a row; `noun` is what was recorded, for example `readings`.
    pub fn title(self, noun: &str) -> String {
        match self {
            Variable::SignedLoad => "load with its sign".into(),
            Variable::Phase => "way up or down".into(),
            Variable::Order => format!("order of the {noun}"),
            Variable::TimeInRun => "time since the run began".into(),
            Variable::Channel => "sensor".into(),
            Variable::LoadAxis => "axis of the load".into(),
            Variable::Fixture => "clamp or socket".into(),
            Variable::Tip(axis) => format!("{axis} of the tip"),
            other => other.to_string(),
        }
    }

    /// True for what grows, or may have changed, as time went by.
    pub fn is_of_time(self) -> bool {
        matches!(
            self,
            Variable::Order | Variable::Time | Variable::TimeInRun | Variable::Temperature | Variable::Trial
        )
    }

    /// True for a number that only names groups.
    pub fn is_group(self) -> bool {
        matches!(self, Variable::Channel | Variable::LoadAxis | Variable::Phase)
    }
}

/// The name in JSON.
impl fmt::Display for Variable {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let name = match self {
            Variable::Load => "load",
            Variable::SignedLoad => "signed load",
            Variable::Phase => "phase",
            Variable::Order => "order",
            Variable::Time => "time",
            Variable::TimeInRun => "time in the run",
            Variable::Temperature => "temperature",
            Variable::Trial => "trial",
            Variable::Channel => "channel",
            Variable::LoadAxis => "axis",
            Variable::Fixture => "group",
            Variable::Tip(axis) => return write!(f, "{axis}"),
            Variable::Joint(joint, what) => {
                let what = match what {
                    JointVariable::Angle => "angle",
                    JointVariable::Torque => "torque",
                    JointVariable::Approach => "approach",
                    JointVariable::Move => "move",
                };
                return write!(f, "joint {} {what}", joint + 1);
            }
        };
        f.write_str(name)
    }
}
