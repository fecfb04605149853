//! Makes `campaigns/tx90-5/`: a small campaign of a TX90 with the paper's rod 5#, simulated.
//!
//! `cargo run --example regenerate -- campaign` writes its files; a test makes sure that they are
//! what this makes.
//!
//! Smaller than the paper's (12 poses on each clamp, 30 of validation), so that trying it takes no
//! time. The true rod is 1.013 times as compliant as its model, the published r_rod of 5#. What is
//! published and what is assumed stands in `docs/simulation.md`.

#![allow(clippy::unwrap_used)]

use std::path::Path;

use rodcal::beam::Physics;
use rodcal::calibration::simulate::{Plan, campaign_files, simulate};
use rodcal::compliance::{Compliance, DEFAULT_ELEMENTS};
use rodcal::robot::Robot;
use rodcal::rod::Rod;

const DIRECTORY: &str = "campaigns/tx90-5";
const R_ROD: f64 = 1.013;
const SEED: u64 = 5;

/// Names and contents of the files. `project` is the project's directory.
pub fn files(project: &Path) -> Vec<(String, String)> {
    let (name, text) = Robot::builtin("tx90").unwrap();
    let robot = Robot::from_text(name, text, None, None).unwrap();
    let rod = Rod::read(&project.join("rods/5.toml")).unwrap();
    let model = Compliance::of_model(&rod, &Physics::default(), DEFAULT_ELEMENTS).unwrap();
    let plan = Plan::of_poses(12, 30).with_seed(SEED).with_rod_factor(R_ROD);
    let simulation = simulate(&robot, &rod, &model, &plan).unwrap();
    campaign_files(&simulation, "builtin:tx90", "../../rods/5.toml")
        .into_iter()
        .map(|(name, text)| (format!("{DIRECTORY}/{name}"), text))
        .collect()
}

#[allow(dead_code)]
pub fn main() {
    let project = Path::new(env!("CARGO_MANIFEST_DIR"));
    for (name, text) in files(project) {
        rodcal::files::write_whole(&project.join(name), text.as_bytes()).unwrap();
    }
}
