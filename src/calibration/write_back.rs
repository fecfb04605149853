//! The calibrated robot as a file of the format that it came in.

use nalgebra::Vector3;

use super::campaign::{Campaign, Recording, Targets};
use super::extrapolation::{self, Known};
use super::result::Calibration;
use crate::error::Result;
use crate::robot::{CalibratedRange, Effect, Joint, Parameter, Robot, Tip, Uncertainty, is_urdf};
use crate::units::{DEG, MM};

/// Name and text of the calibrated robot: a table with compliances, or the URDF with new origins,
/// its `tip_link` at the tip. Comments on top say where base and tip were found.
///
/// ```
/// use rodcal::prelude::*;
///
/// let campaign = Campaign::read("campaigns/tx90-5/campaign.toml".as_ref())?;
/// let calibration = calibrate(&campaign, Mode::Fea, &Options::default())?;
/// let (name, text) = write_back(&campaign, &calibration)?;
/// let robot = Robot::from_text(&name, &text, None, None)?;
/// let (written, found) = (robot.joints[1].link.a, calibration.setup.get(Parameter::A(1)));
/// assert!((written - found).abs() < 1e-12 && (written - 0.425).abs() < 2e-3);
/// # Ok::<(), rodcal::Error>(())
/// ```
///
/// # Errors
/// As [`crate::robot::Robot::to_toml`] and [`crate::robot::Robot::to_urdf`]; none in practice.
pub fn write_back(campaign: &Campaign, calibration: &Calibration) -> Result<(String, String)> {
    write_back_with(campaign, calibration, None, &[])
}

/// The same with more comments; `sd` is how well the robot predicts poses that were held out, m, in
/// place of the scatter that the calibration leaves.
///
/// ```
/// use rodcal::calibration::write_back_with;
/// use rodcal::prelude::*;
///
/// let campaign = Campaign::read("campaigns/tx90-5/campaign.toml".as_ref())?;
/// let calibration = calibrate(&campaign, Mode::Fea, &Options::default())?;
/// let comments = ["Measured on a Monday.".to_owned()];
/// let (name, text) = write_back_with(&campaign, &calibration, Some(40e-6), &comments)?;
/// assert!(text.contains("# Measured on a Monday."));
/// let sd = Robot::from_text(&name, &text, None, None)?.tip.and_then(|tip| tip.sd);
/// assert!(sd.is_some_and(|sd| (sd - 40e-6).abs() < 1e-9), "{sd:?}");
/// # Ok::<(), rodcal::Error>(())
/// ```
///
/// # Errors
/// As [`write_back`].
pub fn write_back_with(
    campaign: &Campaign,
    calibration: &Calibration,
    sd: Option<f64>,
    more: &[String],
) -> Result<(String, String)> {
    let setup = &calibration.setup;
    let robot = with_what_is_known(campaign, calibration, sd);
    let tool = setup.tool / MM;
    let mut comments = vec![
        first_line(campaign, calibration),
        format!("Tip in {{T}}: xyz_mm = [{:.4}, {:.4}, {:.4}]", tool.x, tool.y, tool.z),
    ];
    if matches!(campaign.measurements.targets, Targets::Points(_)) {
        let base = setup.base();
        let (place, turn) = (base.origin / MM, base.roll_pitch_yaw().map(|angle| angle / DEG));
        comments.push(format!(
            "Base {{0}} in {{W}}: xyz_mm = [{:.4}, {:.4}, {:.4}], rpy_deg = [{:.6}, {:.6}, {:.6}]",
            place.x, place.y, place.z, turn[0], turn[1], turn[2]
        ));
    }
    comments.extend_from_slice(more);
    if calibration.is_converged && !calibration.is_plausible() {
        comments.push("THE FIT IS NOT PLAUSIBLE: do not use these numbers.".into());
    }
    if !calibration.is_converged {
        comments.push("THE CALIBRATION DID NOT CONVERGE: do not use these numbers.".into());
    }
    if !is_urdf(&campaign.robot_text) {
        return Ok(("calibrated.toml".into(), robot.to_toml(&comments)?));
    }
    let (base, tip) = (campaign.base_link.as_deref(), campaign.tip_link.as_deref());
    let written =
        robot.to_urdf(&campaign.robot_file, &campaign.robot_text, base, tip, Some(setup.tool), &comments)?;
    Ok(("calibrated.urdf".into(), written.text))
}

/// What a URDF has no place for, in a file beside it: tip, uncertainty, calibrated ranges, effects
/// and compliances. `None` for a table, which holds them itself.
///
/// ```
/// use rodcal::calibration::write_beside;
/// use rodcal::prelude::*;
///
/// let campaign = Campaign::read("campaigns/tx90-5/campaign.toml".as_ref())?;
/// let calibration = calibrate(&campaign, Mode::Fea, &Options::default())?;
/// assert_eq!(write_beside(&campaign, &calibration, None), None); // its robot is a table
/// # Ok::<(), rodcal::Error>(())
/// ```
pub fn write_beside(
    campaign: &Campaign,
    calibration: &Calibration,
    sd: Option<f64>,
) -> Option<(String, String)> {
    if !is_urdf(&campaign.robot_text) {
        return None;
    }
    let mut robot = with_what_is_known(campaign, calibration, sd);
    // there {T} is `tip_link`, which stands at the tip already where the file could take it up
    if holds_tip(campaign, calibration, &robot)
        && let Some(tip) = &mut robot.tip
    {
        tip.at = Vector3::zeros();
    }
    let compliant = robot.joints.iter().enumerate().filter(|(_, joint)| joint.compliance != 0.0);
    let of_joint = |(joint, own): (usize, &Joint)| Effect::Compliance { joint, per_nm: own.compliance };
    let compliances: Vec<Effect> = compliant.map(of_joint).collect();
    robot.effects.extend(compliances);
    // the file has no key for the uncertainty of what is written as an effect
    let comments = [
        first_line(campaign, calibration),
        "Beside calibrated.urdf: rodcal predict calibrated.urdf POSES --effects calibrated-effects.toml"
            .into(),
    ];
    Some(("calibrated-effects.toml".into(), robot.beside_to_toml(&comments)))
}

/// Whether `tip_link` of the calibrated URDF stands at the tip.
fn holds_tip(campaign: &Campaign, calibration: &Calibration, robot: &Robot) -> bool {
    let (file, text) = (&campaign.robot_file, &campaign.robot_text);
    let (base, tip) = (campaign.base_link.as_deref(), campaign.tip_link.as_deref());
    let written = robot.to_urdf(file, text, base, tip, Some(calibration.setup.tool), &[]);
    written.is_ok_and(|written| written.has_tool)
}

fn first_line(campaign: &Campaign, calibration: &Calibration) -> String {
    let (name, mode) = (&campaign.robot.name, calibration.mode.name());
    format!("{name}, calibrated by rodcal from {}, mode {mode}.", campaign.file)
}

/// The calibrated robot with its tip and with how sure all that is.
fn with_what_is_known(campaign: &Campaign, calibration: &Calibration, sd: Option<f64>) -> Robot {
    let setup = &calibration.setup;
    let mut robot = setup.calibrated();
    robot.tip = Some(Tip { at: setup.tool, sd: Some(sd.unwrap_or(calibration.noise.pooled)) });
    robot.uncertainty = uncertainty(calibration);
    robot.calibrated = Some(calibrated_range(calibration, &campaign.measurements));
    robot
}

/// The poses of a calibration, for those who ask for others.
fn calibrated_range(calibration: &Calibration, recording: &Recording) -> CalibratedRange {
    let free: Vec<Parameter> = calibration.parameters.iter().map(|p| p.parameter).collect();
    let known =
        Known { setup: &calibration.setup, free: &free, covariance: &calibration.fit.covariance.matrix };
    let range = |joint: usize| {
        let values = (0..recording.len()).map(|row| recording.joints(row)[joint]);
        values.fold((f64::INFINITY, f64::NEG_INFINITY), |(a, b), q| (a.min(q), b.max(q)))
    };
    let joints = (0..calibration.setup.robot.joints.len()).map(range).collect();
    CalibratedRange { joints, sd: extrapolation::sd(&known, recording) }
}

/// Covariance of what the data determine of the robot and its tool; `None` where the noise is
/// unknown.
fn uncertainty(calibration: &Calibration) -> Option<Uncertainty> {
    let all = &calibration.fit.covariance.matrix;
    let kept: Vec<usize> = (0..calibration.parameters.len())
        .filter(|&k| !calibration.parameters[k].parameter.is_base() && all[(k, k)].is_finite())
        .collect();
    let covariance = all.select_rows(&kept).select_columns(&kept);
    let parameters = kept.iter().map(|&k| calibration.parameters[k].parameter).collect();
    let is_known = !kept.is_empty() && covariance.iter().all(|x| x.is_finite());
    is_known.then_some(Uncertainty { parameters, covariance })
}
