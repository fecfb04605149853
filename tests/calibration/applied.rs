//! Round trip: what is found and applied makes the robot as accurate as was promised, and nothing
//! is found again.

use std::collections::BTreeMap;
use std::path::Path;

use rodcal::calibration::campaign::FileNames;
use rodcal::calibration::{Calibration, Campaign, Mode, Options, Summary, calibrate};
use rodcal::diagnosis::calibration::{
    Applied, CalibrationDiagnosis, apply, diagnose_calibrated, look_at_validation,
};
use rodcal::prelude::*;
use rodcal::robot::{Effect, TorquePower};

use super::lab::Dice;

pub fn names(robot: &str, validation: Option<&str>) -> FileNames {
    let mut names = FileNames::new(robot, "measurements.csv");
    names.validation = validation.map(str::to_owned);
    names
}

/// The campaign that was written; `robot` is what stood in its robot file, where that was not
/// written.
pub fn written(applied: &Applied, robot: &str) -> Campaign {
    let files: BTreeMap<&str, &str> = applied.files.iter().map(|(a, b)| (a.as_str(), b.as_str())).collect();
    let open = |name: &str| Ok((*files.get(name).unwrap_or(&robot)).to_owned());
    Campaign::from_texts("campaign.toml", files["campaign.toml"], &open).unwrap()
}

fn held_out_rms(found: &CalibrationDiagnosis) -> f64 {
    3.0f64.sqrt() * found.diagnosis.held_out.as_ref().unwrap().after
}

fn validated(calibration: &Calibration) -> f64 {
    calibration.validation.as_ref().unwrap().summary.rms
}

const NOISE: f64 = 20e-6;

/// A robot with these effects, seen by a tracker.
fn tracked(effects: Vec<Effect>) -> Campaign {
    tracked_by(Vec::new(), effects)
}

/// The same of a robot whose file has some.
fn tracked_by(in_file: Vec<Effect>, effects: Vec<Effect>) -> Campaign {
    let (file, text) = Robot::builtin("tx90").unwrap();
    let mut nominal = Robot::from_text(file, text, None, None).unwrap();
    nominal.effects = in_file;
    let mut built = nominal.clone();
    built.joints[1].link.a += 0.4e-3;
    built.joints[2].link.theta += 0.3e-3;
    built.effects = effects;
    let (seen, unseen) = (100, 40);
    let mut dice = Dice(7);
    let q: Vec<f64> = (0..6 * (seen + unseen)).map(|_| 1.8 * dice.roll()).collect();
    // both recordings begin at rest
    let turned = [built.after_moves(&q[..6 * seen]), built.after_moves(&q[6 * seen..])].concat();
    let tool = nalgebra::Vector3::new(0.08, 0.0, 0.25);
    let mut recordings = [Recording::new(6), Recording::new(6)];
    for k in 0..seen + unseen {
        let noise = nalgebra::Vector3::from_fn(|_, _| NOISE * dice.normal());
        let tip = built.tip_at(tool, &turned[6 * k..][..6]).0 + noise;
        recordings[usize::from(k >= seen)].add(&q[6 * k..][..6], tip).unwrap();
    }
    let [measured, validation] = recordings;
    let mut campaign = Campaign::new(nominal, measured).unwrap().with_tool(tool);
    campaign.validation = Some(validation);
    campaign.refit = rodcal::calibration::campaign::Refit::Nothing;
    campaign
}

/// Found once more, each of them would be taken out of the measured points only, and the robot that
/// is calibrated with those would be worse than one that knows nothing of it.
#[test]
fn what_gives_way_under_the_arm_s_weight_is_known_at_unseen_poses() {
    let square = TorquePower::Square;
    for (effect, name) in [
        (
            Effect::NonlinearStiffness { joint: 2, power: square, coefficient: 4e-7 },
            "joint_nonlinear_stiffness",
        ),
        (Effect::GravityTilt { per_nm: 6e-6 }, "gravity_tilt"),
        (Effect::Friction { joint: 2, per_nm: 10e-6 }, "joint_friction"),
    ] {
        let campaign = tracked(vec![effect]);
        let before = calibrate(&campaign, Mode::None, &Options::default()).unwrap();
        let mut found = diagnose_calibrated(&campaign, before.clone()).unwrap();
        look_at_validation(&mut found).unwrap();
        let effects: Vec<&str> = found.diagnosis.findings.iter().map(|finding| finding.effect.name).collect();
        assert_eq!(effects, [name]);
        let applied = apply(&found, &names("builtin:tx90", Some("validation.csv")), &[]).unwrap().unwrap();
        assert_eq!((applied.entered.len(), applied.removed.len(), applied.left_out.len()), (1, 0, 0));
        let again = written(&applied, "");
        let after = calibrate(&again, Mode::None, &Options::default()).unwrap();
        let validated_poses = found.model.validated.as_ref().unwrap();
        let (without, with) = validated_poses.means();
        let with = with.expect("it was written");
        assert!(with < without && !validated_poses.is_worse(), "{name}: {without} {with}");
        // what is said of the robot is true of the one that is written
        let own = after.validation.as_ref().unwrap().summary.mean;
        assert!((own - with).abs() < 1e-3 * with, "{name}: {own} {with}");
        let noise = 3.0f64.sqrt() * NOISE;
        let (was, is) = (validated(&before), validated(&after));
        assert!(is < 1.25 * noise && is < was && was > 1.3 * noise, "{name}: {was} {is}");
    }
}

/// A joint ahead of its drive, friction that pushes, a base that leans away from its load.
#[test]
fn what_nature_has_none_of_has_no_name() {
    for effect in [
        Effect::PlayByApproach { joint: 2, play: -400e-6 },
        Effect::Friction { joint: 2, per_nm: -10e-6 },
        Effect::GravityTilt { per_nm: -6e-6 },
    ] {
        let campaign = tracked(vec![effect.clone()]);
        let before = calibrate(&campaign, Mode::None, &Options::default()).unwrap();
        let found = diagnose_calibrated(&campaign, before).unwrap();
        let effects: Vec<&str> = found.diagnosis.findings.iter().map(|finding| finding.effect.name).collect();
        let own = ["backlash", "joint_friction", "gravity_tilt", "link_flexibility"];
        assert!(!effects.iter().any(|effect| own.contains(effect)), "{effect:?}: {effects:?}");
    }
}

/// A file may say too much, and what is written takes it back.
#[test]
fn less_than_the_robot_file_says_is_found_and_written() {
    let tilts = |per_nm: f64| Effect::GravityTilt { per_nm };
    let plays = |play: f64| Effect::PlayByApproach { joint: 2, play };
    for (says, is, sentence) in [
        (tilts(10e-6), tilts(2e-6), "The tilt of the base under the arm's moment is "),
        (
            plays(900e-6),
            plays(300e-6),
            "The play of joint 3, taken up according to the direction of approach, is ",
        ),
    ] {
        let mut campaign = tracked_by(vec![says], vec![is]);
        // read from a file, the moves would have been added
        campaign.measurements.take_up_moves(&campaign.robot, None);
        campaign.validation.as_mut().unwrap().take_up_moves(&campaign.robot, None);
        let before = calibrate(&campaign, Mode::None, &Options::default()).unwrap();
        let found = diagnose_calibrated(&campaign, before).unwrap();
        let [finding] = &found.diagnosis.findings[..] else { panic!("{:?}", found.diagnosis.findings) };
        let said = &finding.description.observed;
        assert!(said.starts_with(sentence) && said.contains(" less than the robot file says"), "{said}");
        let applied = apply(&found, &names("robot.toml", Some("validation.csv")), &[]).unwrap().unwrap();
        let again = written(&applied, "");
        let after = calibrate(&again, Mode::None, &Options::default()).unwrap();
        assert!(validated(&after) < 1.25 * 3.0f64.sqrt() * NOISE, "{}", validated(&after));
    }
}

#[test]
fn effects_that_follow_a_load_are_warned_of_where_no_mass_is_known() {
    for (effect, is_warned) in [
        (Effect::GravityTilt { per_nm: 3e-6 }, true),
        (Effect::EncoderScale { joint: 1, factor: 1.0001 }, false),
    ] {
        let mut campaign = tracked(vec![effect.clone()]);
        campaign.robot.effects = vec![effect];
        campaign.robot.joints.iter_mut().for_each(|joint| joint.body = None);
        let calibration = calibrate(&campaign, Mode::None, &Options::default()).unwrap();
        let said: Vec<String> = calibration.warnings.iter().map(ToString::to_string).collect();
        let of_effects = said.iter().any(|said| said.contains("effects that follow a load"));
        assert_eq!(of_effects, is_warned, "{said:?}");
    }
}

#[test]
fn a_simulated_robot_is_as_accurate_as_promised_and_nothing_is_found_again() {
    let campaign = tracked(vec![
        Effect::Harmonic { joint: 0, cycles_per_rev: 13.0, sine: 200e-6, cosine: 0.0 },
        Effect::PlayByApproach { joint: 3, play: 900e-6 },
        Effect::Lag { joint: Some(1), fraction: 4e-4 },
    ]);
    let before = calibrate(&campaign, Mode::None, &Options::default()).unwrap();
    let found = diagnose_calibrated(&campaign, before.clone()).unwrap();
    let effects: Vec<&str> = found.diagnosis.findings.iter().map(|finding| finding.effect.name).collect();
    for effect in ["transmission_error", "backlash", "readback_lag"] {
        assert!(effects.contains(&effect), "{effects:?}");
    }
    let applied = apply(&found, &names("builtin:tx90", Some("validation.csv")), &[]).unwrap().unwrap();
    assert_eq!((applied.entered.len(), applied.removed.len(), applied.left_out.len()), (effects.len(), 0, 0));
    let again = written(&applied, "");
    assert!(again.robot.has_moves());
    let after = calibrate(&again, Mode::None, &Options::default()).unwrap();
    // base and geometry are those of the calibration that was written
    assert!((Summary::of(&after.residuals()).mean / applied.mean - 1.0).abs() < 1e-3);
    // 40 poses of three coordinates: their rms is known to 6 %, twice that is asked for
    let (promised, reached) = (held_out_rms(&found), validated(&after));
    assert!(reached < 1.1 * promised && reached < 0.4 * validated(&before), "{promised} {reached}");
    let second = diagnose_calibrated(&again, after.clone()).unwrap();
    assert!(second.diagnosis.findings.is_empty(), "{:?}", second.diagnosis.findings);
    // what is written is what was read: the moves are added once
    let read = again.measurements.read_joints(7).iter().zip(campaign.measurements.joints(7));
    assert!(read.into_iter().all(|(read, joint)| (read - joint).abs() < 1e-8));
}

/// `../shared/real`, where it is there: sockets and a URDF, whose findings stand beside it.
#[test]
#[allow(clippy::print_stderr)]
fn a_real_arm_is_better_at_poses_that_it_has_not_seen() {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("../shared/real/mukca/kuka_14");
    let read = |name: &str| std::fs::read_to_string(folder.join(name)).ok();
    let (Some(rows), Some(urdf)) = (read("all.csv"), read("robot.urdf")) else {
        eprintln!("skipped: there is no ../shared/real/mukca/kuka_14");
        return;
    };
    // blocks of four rows of the spots that did not move are held out
    let rows: Vec<&str> = rows.lines().filter(|line| !line.starts_with('#')).collect();
    let is_out = |k: usize, row: &str| !row.contains("raised_left") && k / 4 % 4 == 3;
    let table = |out: bool| -> String {
        let own = rows[1..].iter().enumerate().filter(|(k, row)| is_out(*k, row) == out);
        std::iter::once(rows[0]).chain(own.map(|(_, row)| *row)).map(|row| format!("{row}\n")).collect()
    };
    let (seen, unseen) = (table(false), table(true));
    let open = |name: &str| {
        Ok(match name {
            "robot.urdf" => urdf.clone(),
            "measurements.csv" => seen.clone(),
            _ => unseen.clone(),
        })
    };
    let text = "robot = 'robot.urdf'\nmeasurements = 'measurements.csv'\nvalidation = 'validation.csv'\n\
                tip_link = 'ball_link'\n[sockets]\ndistance_mm = 50.0\n";
    let campaign = Campaign::from_texts("campaign.toml", text, &open).unwrap();
    let before = calibrate(&campaign, Mode::None, &Options::default()).unwrap();
    let found = diagnose_calibrated(&campaign, before.clone()).unwrap();
    let applied = apply(&found, &names("robot.urdf", Some("validation.csv")), &[]).unwrap().unwrap();
    assert!(applied.left_out.is_empty() && applied.removed.len() > 2, "{:?}", applied.left_out);
    let again = written(&applied, &urdf);
    let after = calibrate(&again, Mode::None, &Options::default()).unwrap();
    // 113 µm and 77 µm rms where this was written
    let reached = validated(&after);
    assert!(reached < 0.7 * validated(&before) && reached < 1.05 * held_out_rms(&found), "{reached}");
    let second = diagnose_calibrated(&again, after.clone()).unwrap();
    assert!(second.diagnosis.findings.is_empty(), "{:?}", second.diagnosis.findings);
}

/// `../shared/real`, where it is there: what the gears of a UR5 do in the middle fifth of the poses
/// by one joint's angle, none of which was seen. 110 and 60 µm where this was written.
#[test]
#[allow(clippy::print_stderr)]
fn gears_of_a_real_arm_are_known_where_nobody_has_looked() {
    const JOINT: &str = "q3_deg";
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("../shared/real/ur5");
    let read = |name: &str| std::fs::read_to_string(folder.join(name)).ok();
    let (Some(rows), Some(robot), Some(text)) =
        (read("measurements.csv"), read("robot.toml"), read("campaign.toml"))
    else {
        eprintln!("skipped: there is no ../shared/real/ur5");
        return;
    };
    // every second pose says as much, in half the time
    let rows: Vec<&str> = rows.lines().filter(|line| !line.starts_with('#')).collect();
    let rows: Vec<&str> = rows[..1].iter().chain(rows[1..].iter().step_by(2)).copied().collect();
    let column = rows[0].split(',').position(|name| name == JOINT).unwrap();
    let angle = |row: &str| row.split(',').nth(column).unwrap().parse::<f64>().unwrap();
    let mut angles: Vec<f64> = rows[1..].iter().map(|row| angle(row)).collect();
    angles.sort_by(f64::total_cmp);
    let middle = angles[2 * angles.len() / 5]..angles[3 * angles.len() / 5];
    let table = |out: bool| -> String {
        let own = rows[1..].iter().filter(|row| middle.contains(&angle(row)) == out);
        std::iter::once(&rows[0]).chain(own).map(|row| format!("{row}\n")).collect()
    };
    let (seen, unseen) = (table(false), table(true));
    let open = |name: &str| {
        Ok(match name {
            "robot.toml" => robot.clone(),
            "measurements.csv" => seen.clone(),
            _ => unseen.clone(),
        })
    };
    let text = format!("validation = 'validation.csv'\nvalidation_refit = 'none'\n{text}");
    let campaign = Campaign::from_texts("campaign.toml", &text, &open).unwrap();
    let before = calibrate(&campaign, Mode::None, &Options::default()).unwrap();
    let found = diagnose_calibrated(&campaign, before.clone()).unwrap();
    let applied = apply(&found, &names("robot.toml", Some("validation.csv")), &[]).unwrap().unwrap();
    let again = written(&applied, &robot);
    let after = calibrate(&again, Mode::None, &Options::default()).unwrap();
    let mean = |found: &Calibration| found.validation.as_ref().unwrap().summary.mean;
    assert!(mean(&after) < 0.75 * mean(&before), "{} and {}", mean(&before), mean(&after));
}
