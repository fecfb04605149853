//! Every test that uses the project as its users do, in one binary: sixteen took their time to
//! link.

#![allow(missing_docs)]

mod architecture;
mod bad_campaigns;
mod bad_readings;
mod bad_robots;
mod bad_rods;
mod beam_properties;
mod calibration;
mod campaigns;
mod circles;
mod cli;
mod diagnosis;
mod documents;
mod fuzz;
mod kinematics;
mod nist;
mod references;
mod rig_fit;
mod robot_files;
mod stopping;
mod validation;
