//! Trials at a stiffness rig: rods, protocols and what may be wrong with them.

mod bench;
mod cosserat;
mod drawing;
mod effect;
mod memory;
mod noise;
mod protocol;
mod tube;
