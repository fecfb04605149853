//! The library in one small program: rod, rig, calibration, diagnosis, and what to do with the
//! result.
//!
//! `cargo run --example library`

use rodcal::prelude::*;
use rodcal::units::{MM, UM};

#[allow(clippy::print_stdout)]
fn main() -> Result<()> {
    // 1. How much a rod bends, from its drawing
    let rod = Rod::read("rods/5.toml".as_ref())?;
    let model = Compliance::of_model(&rod, &Physics::default(), DEFAULT_ELEMENTS)?;
    let c_rod = model.index(paper_contact_force());
    println!("rod {}: c22 = {:.2} µm/N, c_rod = {:.1} µm", rod.name, model.force[(1, 1)] / UM, c_rod / UM);

    // 2. How much it really bends, from readings under known loads
    let readings = Readings::read("stiffness_data/5.csv".as_ref())?;
    let fit = rig::fit(&readings, Some(&rod), &rig::Options::default())?;
    for warning in &fit.warnings {
        println!("warning: {warning}");
    }
    if let Some(measured) = &fit.measured {
        println!(
            "r_rod = {}, c22 = {:.2} µm/N",
            measured.rod_ratio.show(1.0),
            measured.compliance.force[(1, 1)] / UM
        );
    }

    // 3. Calibrate the robot that the rod was mounted on, with the measured compliance
    let campaign = Campaign::read("campaigns/tx90-5/campaign.toml".as_ref())?;
    let mode = default_mode(&campaign);
    let options = Options::default();
    let calibration = calibrate(&campaign, mode, &options)?;
    for warning in &calibration.warnings {
        println!("warning: {warning}");
    }
    println!("calibrated with mode {}: {} parameters", mode.name(), calibration.parameters.len());
    println!("residual noise of a coordinate: {:.1} µm", calibration.noise.pooled / UM);
    if let Some(validation) = &calibration.validation {
        println!(
            "validation: mean {:.1} µm, max {:.1} µm",
            validation.summary.mean / UM,
            validation.summary.max / UM
        );
    }

    // 4. What rod and robot do that their models leave out
    let found = diagnosis::rig::diagnose(&readings, Some(&rod))?;
    for finding in &found.diagnosis.findings {
        println!("{} ({}): {}", finding.effect, finding.location, finding.description);
    }
    let of_robot = diagnosis::calibration::diagnose_calibrated(&campaign, calibration.clone())?;
    println!(
        "{} findings in the calibration, scatter {:.1} µm",
        of_robot.diagnosis.findings.len(),
        of_robot.diagnosis.noise / UM
    );

    // 5. Use it: where the tip is at a pose of the user's, and the robot as a file
    let tool = calibration.setup.tool;
    let (tip, _) = calibration.setup.calibrated().tip_at(tool, campaign.measurements.joints(0));
    println!("tip at pose 1: [{:.3}, {:.3}, {:.3}] mm in {{0}}", tip.x / MM, tip.y / MM, tip.z / MM);
    let (name, text) = write_back(&campaign, &calibration)?;
    println!("{name} has {} lines", text.lines().count());
    Ok(())
}
