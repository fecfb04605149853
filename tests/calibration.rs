//! The calibration as a whole: campaigns whose truth is known to the last digit, made by a second implementation of the
//! physics; campaigns with noise, many times over; and real recordings.

#![allow(clippy::unwrap_used)]

#[path = "calibration/arms.rs"]
mod arms;
#[path = "calibration/frames.rs"]
mod frames;
#[path = "calibration/groups.rs"]
mod groups;
#[path = "calibration/held_out.rs"]
mod held_out;
#[path = "calibration/identifiability.rs"]
mod identifiability;
#[path = "calibration/lab.rs"]
mod lab;
#[path = "calibration/modes.rs"]
mod modes;
#[path = "calibration/rank.rs"]
mod rank;
#[path = "calibration/recorded.rs"]
mod recorded;
#[path = "calibration/recovery.rs"]
mod recovery;
#[path = "calibration/robust.rs"]
mod robust;
#[path = "calibration/rods.rs"]
mod rods;
#[path = "calibration/simulated.rs"]
mod simulated;
#[path = "calibration/sockets.rs"]
mod sockets;
#[path = "calibration/uncertainty.rs"]
mod uncertainty;
#[path = "calibration/wishes.rs"]
mod wishes;
#[path = "calibration/written.rs"]
mod written;
