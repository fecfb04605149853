//! The calibration as a whole: campaigns whose truth is known to the last digit, made by a second implementation of the
//! physics; campaigns with noise, many times over; and real recordings.

#![allow(clippy::unwrap_used)]

#[path = "calibration/arms.rs"]
mod arms;
#[path = "calibration/frames.rs"]
mod frames;
#[path = "calibration/lab.rs"]
mod lab;
#[path = "calibration/rank.rs"]
mod rank;
#[path = "calibration/recovery.rs"]
mod recovery;
#[path = "calibration/rods.rs"]
mod rods;
