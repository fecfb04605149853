//! Where the ball was held, as the campaign file has it: it decides which columns its recordings
//! have.

use super::{Group, GroupName};
use crate::spatial::Pose;

/// Where the ball was, as the campaign file has it.
#[derive(Clone, Copy)]
pub(super) enum Seen<'a> {
    /// Measured in {W}.
    World,
    /// Measured in the device frame of one of these clamps.
    Clamps(&'a [Clamp]),
    /// Not measured: in a socket.
    Sockets(Sockets),
}

/// A clamp and its device frame in {W}.
pub(super) struct Clamp {
    pub id: String,
    pub device: Pose,
}

impl Clamp {
    /// As a recording has it.
    pub fn group(&self) -> Group {
        Group::new(GroupName::Clamp(self.id.clone()), self.device)
    }
}

/// What is known about the sockets of every placement.
#[derive(Clone, Copy)]
pub(super) struct Sockets {
    /// Between socket 0 and socket 1, m.
    pub distance: f64,
    /// Its standard deviation, m.
    pub sd: f64,
}

/// What a recording is for.
#[derive(Clone, Copy, PartialEq, Eq)]
pub(super) enum Role {
    Measurements,
    Validation,
}
