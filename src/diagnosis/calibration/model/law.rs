//! How an effect acts, where it may act in several ways: as data, beside the candidate.
//!
//! The location of a candidate says the same to people; nothing reads it back from there.

use std::fmt;
use std::ops::Range;

use super::gear::Gear;
use crate::inference::Part;
use crate::robot::TorquePower;

/// The law of a candidate.
#[derive(Debug, Clone, PartialEq)]
#[non_exhaustive]
pub enum Law {
    /// The only one of its effect, or a curve that nobody has named.
    Only,
    /// An error of a gear or encoder.
    Gear(Gear),
    /// Play of a joint.
    Play(TakenUp),
    /// A stiffness that depends on the load.
    Nonlinear(TorquePower),
    /// Compliance of a joint whose loads nobody knows: one parameter for every frame beyond it
    /// where a weight may sit, by its joint; `None` is the flange.
    MassesUnknown(Vec<Option<usize>>),
    /// A link that bends about a point of its joint's axis, so far along it from the joint's
    /// origin, m.
    Bends(f64),
    /// A rod of another stiffness.
    Rod(RodLoad),
    /// A mass that nobody stated, or a rod of another one: what it does to the joints depends on
    /// how compliant they are.
    Hung(Hung),
    /// Drift.
    Drift(Course, Frame),
    /// Drift of a joint or its link, of the base's orientation, growth of the arm, or of what a
    /// tracker shows.
    Warms(Course, Warmed),
    /// A clamp, a socket or the sockets of a plate that moved, by their numbers among the groups of
    /// the recording.
    Moved(Vec<usize>),
    /// The scale of an axis of {W}, from 0, that is both of these, or the shear of two.
    Axes([usize; 2]),
}

/// What takes up the play of a joint.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
#[non_exhaustive]
pub enum TakenUp {
    /// The torque of its load.
    ByTorque,
    /// Friction: it stays at the side that it was driven to.
    ByApproach,
}

/// Where a mass hangs.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
#[non_exhaustive]
pub enum Hung {
    /// At the tip of the rod.
    Tip,
    /// At the flange.
    Flange,
    /// At the flange, from this row on, counted from 0.
    FlangeFrom(usize),
    /// At the flange, before this row, counted from 0.
    FlangeUntil(usize),
    /// Along the rod: as many times the rod's own mass, tip excepted, as there are too many.
    Rod,
}

/// The load under which a rod's stiffness is another one.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
#[non_exhaustive]
pub enum RodLoad {
    /// All of them.
    All,
    /// The contact force.
    Contact,
}

/// What a drift follows.
#[derive(Debug, Clone, Copy, PartialEq)]
#[non_exhaustive]
pub enum Course {
    /// The share of the recording that is over.
    Order,
    /// An exponential whose time constant is this share of the recording.
    WarmUp(f64),
    /// Temperature.
    Temperature,
    /// Time.
    Time,
}

/// Where a drift goes on in a fixed direction.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
#[non_exhaustive]
pub enum Frame {
    /// In {W}: the robot drifts on its base.
    World,
    /// In {T}: the tool drifts on its flange.
    Tool,
}

/// What of a joint drifts, or of all of them, or of the tracker that sees them, or of the base.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
#[non_exhaustive]
pub enum Warmed {
    /// Its zero.
    Zero,
    /// The length of the link that it moves.
    Length,
    /// The lengths of all links, by one share.
    Arm,
    /// The scale of the tracker, which stands somewhere.
    Tracker,
    /// How the base stands to what measures the tip.
    Turn,
}

impl Law {
    /// What a transmission error is a function of; `None` for any other law.
    pub fn gear(&self) -> Option<&Gear> {
        match self {
            Law::Gear(gear) => Some(gear),
            Law::Only
            | Law::Play(_)
            | Law::Nonlinear(_)
            | Law::MassesUnknown(_)
            | Law::Rod(_)
            | Law::Hung(_)
            | Law::Drift(..)
            | Law::Warms(..)
            | Law::Bends(_)
            | Law::Moved(_)
            | Law::Axes(_) => None,
        }
    }
}

impl Law {
    /// Where the mass of a load hangs; `None` for any other law.
    pub fn hung(&self) -> Option<Hung> {
        if let Law::Hung(own) = self { Some(*own) } else { None }
    }

    /// The law of those parameters that are kept, of as many as `is_kept` has.
    pub fn of_parameters(self, is_kept: &[bool]) -> Law {
        match self {
            Law::MassesUnknown(frames) => {
                let kept = frames.into_iter().zip(is_kept).filter(|(_, is_kept)| **is_kept);
                Law::MassesUnknown(kept.map(|(frame, _)| frame).collect())
            }
            Law::Only
            | Law::Gear(_)
            | Law::Play(_)
            | Law::Nonlinear(_)
            | Law::Rod(_)
            | Law::Hung(_)
            | Law::Drift(..)
            | Law::Warms(..)
            | Law::Bends(_)
            | Law::Moved(_)
            | Law::Axes(_) => self,
        }
    }
}

impl Hung {
    /// The rows at which it hangs on the flange, of so many; `None` for what hangs elsewhere.
    pub fn rows_on_flange(self, count: usize) -> Option<Range<usize>> {
        match self {
            Hung::Flange => Some(0..count),
            Hung::FlangeFrom(row) => Some(row..count),
            Hung::FlangeUntil(row) => Some(0..row),
            Hung::Tip | Hung::Rod => None,
        }
    }
}

impl RodLoad {
    /// `under the contact force`; nothing for all loads.
    pub fn description(self) -> Option<&'static str> {
        match self {
            RodLoad::All => None,
            RodLoad::Contact => Some("under the contact force"),
        }
    }
}

impl Course {
    /// True for what needs a thermometer or a clock.
    pub fn is_clocked(self) -> bool {
        match self {
            Course::Temperature | Course::Time => true,
            Course::Order | Course::WarmUp(_) => false,
        }
    }

    /// Unit of a drift's parameters: at the end of their names, and for people.
    pub fn unit(self) -> (&'static str, &'static str) {
        match self {
            Course::Order | Course::WarmUp(_) => ("um", "µm"),
            Course::Temperature => ("um_per_k", "µm per kelvin"),
            Course::Time => ("um_per_h", "µm per hour"),
        }
    }

    /// The same of an angle.
    pub fn angle_unit(self) -> (&'static str, &'static str) {
        match self {
            Course::Order | Course::WarmUp(_) => ("urad", "µrad"),
            Course::Temperature => ("urad_per_k", "µrad per kelvin"),
            Course::Time => ("urad_per_h", "µrad per hour"),
        }
    }

    /// The same of lengths that grow by a share.
    pub fn share_unit(self) -> (&'static str, &'static str) {
        match self {
            Course::Order | Course::WarmUp(_) => ("um_per_m", "µm/m"),
            Course::Temperature => ("um_per_m_per_k", "µm/m per kelvin"),
            Course::Time => ("um_per_m_per_h", "µm/m per hour"),
        }
    }
}

impl fmt::Display for Course {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Course::Order => f.write_str("order"),
            Course::WarmUp(share) => {
                write!(f, "warm-up over {} % of the recording", 100.0 * share)
            }
            Course::Temperature => f.write_str("temperature"),
            Course::Time => f.write_str("time"),
        }
    }
}

impl Frame {
    /// What drifts.
    pub fn part(self) -> Part {
        match self {
            Frame::World => Part::Base,
            Frame::Tool => Part::Tool,
        }
    }
}

impl Warmed {
    /// For people: `zero, with temperature`.
    pub fn form(self, course: Course) -> String {
        match self {
            Warmed::Zero => format!("zero, with {course}"),
            Warmed::Length => format!("length of its link, with {course}"),
            Warmed::Arm | Warmed::Tracker => format!("with {course}"),
            Warmed::Turn => format!("turning, with {course}"),
        }
    }
}
