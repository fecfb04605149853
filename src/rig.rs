//! The stiffness rig: a clamped rod is loaded at its tip and the offsets of the tip are read.

pub mod readings;
