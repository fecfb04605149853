//! Masses and centres in another unit: an arm with a rod, whose drives give way, seen by a tracker.

use super::*;
use crate::calibration::Compensation;
use crate::robot::{Body, Setup};
use crate::rod::Rod;

const ROD: &str = include_str!("../../../../../rods/5.toml");

/// The campaign of an arm whose drives give way by so many µrad/(N·m) each, as its files should be.
fn weighed(compliance: f64, tip_mass: f64, seed: u64) -> Campaign {
    let rod = Rod { tip_mass, ..Rod::from_toml("rod.toml", ROD).unwrap() };
    let mut campaign = tracked_with(rod.tip().into(), 120, seed);
    let mut built = robot(1.0, seed);
    for joints in [&mut campaign.robot.joints, &mut built.joints] {
        for joint in joints.iter_mut() {
            joint.body = Some(Body { mass: 8.0, centre: Vector3::new(-0.4 * joint.link.a, 0.03, 0.05) });
        }
    }
    campaign.robot_file = "robot.toml".into();
    campaign.rod = Some(rod);
    let compensation = Compensation::new(&campaign, Mode::Fea).unwrap();
    let base = Pose::from_xyz_rpy(BASE.0, BASE.1);
    let tip = campaign.rod.as_ref().unwrap().tip();
    let rigid = Setup::new(&built, base, tip);
    let mut bent = Setup::new(&built, base, tip);
    bent.compliance = vec![compliance * 1e-6; 6];
    let recording = campaign.measurements.clone();
    let tips = |setup: &Setup, with: &Compensation| with.tips(setup, &recording);
    let (loaded, plain) = (tips(&bent, &compensation), tips(&rigid, &Compensation::bare()));
    for (row, point) in points(&mut campaign).iter_mut().enumerate() {
        *point += loaded[row].0 - plain[row].0;
    }
    campaign
}

/// With masses and distances of centres in the robot's file times so much.
fn stated(mut campaign: Campaign, mass: f64, centre: f64) -> Campaign {
    for body in campaign.robot.joints.iter_mut().filter_map(|joint| joint.body.as_mut()) {
        (body.mass, body.centre) = (body.mass * mass, body.centre * centre);
    }
    campaign
}

#[test]
fn masses_in_grams_are_named_where_rod_and_drives_show_it() {
    for seed in [1, 2] {
        let campaign = weighed(60.0, 0.06, seed);
        assert_eq!(found(&campaign), [], "seed {seed}");
        let wrong = stated(campaign.clone(), 1e3, 1.0);
        assert_eq!(found(&wrong), one("unit_mistake", "mass_kg"), "seed {seed}");
        let meant = mended(&wrong).campaign;
        assert!((meant.robot.joints[1].body.unwrap().mass - 8.0).abs() < 1e-9);
        assert!(meant.robot_text.contains("mass_kg = 8"));
    }
}

/// The weight of links on stiff drives is all that there is: heavier links on stiffer ones do the
/// same.
#[test]
fn of_masses_that_do_nothing_nothing_is_said() {
    assert_eq!(found(&stated(weighed(1.0, 0.06, 3), 1e3, 1.0)), []);
}

/// Pounds are named; of masses that are wrong by another factor nothing is said, though they are
/// nearer to pounds than to kilograms.
#[test]
fn masses_in_pounds_are_no_masses_that_are_wrong() {
    for (seed, compliance, factor) in [(7, 150.0, 1.5), (9, 100.0, 1.7)] {
        let campaign = weighed(compliance, 0.06, seed);
        let pounds = found(&stated(campaign.clone(), 1.0 / 0.45359237, 1.0));
        assert_eq!(pounds, one("unit_mistake", "mass_kg"), "{seed}");
        assert_eq!(found(&stated(campaign, factor, 1.0)), [], "{seed} {factor}");
    }
}

#[test]
fn centres_in_another_unit_are_named_where_drives_show_it() {
    assert_eq!(found(&weighed(60.0, 0.06, 4)), []);
    for (seed, factor) in [(4, 1e-3), (5, 0.1)] {
        let campaign = weighed(60.0, 0.06, seed);
        assert_eq!(found(&stated(campaign, 1.0, factor)), one("unit_mistake", "com_mm"), "seed {seed}");
    }
}

/// 300 g that the file has as 0.3 g: the unit stands first, or beside a mass that nobody stated.
#[test]
fn a_mass_at_the_tip_in_kilograms_is_said() {
    let mut wrong = weighed(30.0, 0.3, 6);
    wrong.rod.as_mut().unwrap().tip_mass *= 1e-3;
    let mended = mended(&wrong);
    let diagnosis = mended.diagnose().unwrap().diagnosis;
    let finding = &diagnosis.findings[0];
    let own = (finding.effect.name, finding.location.to_string());
    let rivals = finding.rivals.iter().map(|rival| (rival.effect.name, rival.location.to_string()));
    let said: Vec<_> = std::iter::once(own).chain(rivals).collect();
    assert!(said.contains(&("unit_mistake", "tip.mass_g".into())), "{said:?}");
}
