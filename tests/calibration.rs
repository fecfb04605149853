//! The calibration as a whole: campaigns whose truth is known to the last digit, made by a second
//! implementation of the physics; campaigns with noise, many times over; and real recordings.

#![allow(clippy::unwrap_used)]

mod applied;
mod applied_laws;
mod arms;
mod constraints;
mod forecast;
mod frames;
mod groups;
mod held_out;
mod identifiability;
mod lab;
mod modes;
mod narrow;
mod rank;
mod recorded;
mod recovery;
mod robust;
mod rods;
mod simulated;
mod sockets;
mod uncertainty;
mod written;
