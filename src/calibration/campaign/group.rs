//! What held the ball: clamps, sockets, or nothing.

use std::fmt;

use crate::spatial::Pose;

/// Where the ball was held.
#[derive(Debug, Clone, PartialEq)]
#[non_exhaustive]
pub struct Group {
    /// By the names of the user's files.
    pub name: GroupName,
    /// Device frame in {W}; the identity where there is no device.
    pub device: Pose,
}

/// What a group of rows is called. The text of it, `clamp 3` or `front/0`, is for people: nothing
/// reads it back.
///
/// ```
/// use rodcal::calibration::campaign::GroupName;
///
/// let [first, second] = ["0", "1"].map(|socket| GroupName::socket("front", socket));
/// assert_eq!(second.to_string(), "front/1");
/// assert!(first.is_set_up_with(&second) && first != second);
/// assert_eq!(GroupName::Clamp("3".into()).to_string(), "clamp 3");
/// ```
#[derive(Debug, Clone, PartialEq, Eq, PartialOrd, Ord)]
#[non_exhaustive]
pub enum GroupName {
    /// Nothing held it: a tracker saw the ball wherever it was.
    Tracked,
    /// The clamp of this id.
    Clamp(String),
    /// A socket.
    Socket {
        /// Where its plate stood.
        placement: String,
        /// Its number on the plate.
        socket: String,
    },
}

impl Group {
    /// A group of this name; its device stands at `device` in {W}.
    pub fn new(name: GroupName, device: Pose) -> Group {
        Group { name, device }
    }

    /// Of points that a tracker saw.
    pub fn tracked() -> Group {
        Group { name: GroupName::Tracked, device: Pose::IDENTITY }
    }
}

impl GroupName {
    /// A socket of a plate.
    pub fn socket(placement: impl Into<String>, socket: impl Into<String>) -> GroupName {
        GroupName::Socket { placement: placement.into(), socket: socket.into() }
    }

    /// True of points that a tracker saw.
    pub fn is_tracked(&self) -> bool {
        *self == GroupName::Tracked
    }

    /// True of what was set up in one piece: a clamp alone, the sockets of one placement.
    pub fn is_set_up_with(&self, other: &GroupName) -> bool {
        match (self, other) {
            (GroupName::Socket { placement, .. }, GroupName::Socket { placement: others, .. }) => {
                placement == others
            }
            _ => self == other,
        }
    }

    /// What was set up in one piece, for people: the clamp, or the placement of a socket.
    pub fn session(&self) -> String {
        match self {
            GroupName::Socket { placement, .. } => placement.clone(),
            GroupName::Tracked | GroupName::Clamp(_) => self.to_string(),
        }
    }
}

impl fmt::Display for GroupName {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            GroupName::Tracked => Ok(()),
            GroupName::Clamp(id) => write!(f, "clamp {id}"),
            GroupName::Socket { placement, socket } => write!(f, "{placement}/{socket}"),
        }
    }
}
