mod conventions;
mod fixtures;
mod frozen;
mod held;
mod moved_base;
mod other_masses;
mod parts;
mod rows;
mod sagging;
mod spots;

use nalgebra::Vector3;

use super::{Mended, Neighbours, mend, suspected};
use crate::calibration::campaign::{Campaign, Group, Recording, Targets};
use crate::calibration::{Mode, Options, calibrate};
use crate::robot::{Hayati, Joint, Motion, Robot};
use crate::spatial::Pose;
use crate::statistics::Random;
use crate::units::{DEG, MM, UM};

/// d, a (m) and α (°) of an arm of six joints.
const ARM: [(f64, f64, f64); 6] = [
    (0.09, 0.0, 90.0),
    (0.0, -0.43, 0.0),
    (0.0, -0.39, 0.0),
    (0.11, 0.0, 90.0),
    (0.095, 0.0, -90.0),
    (0.082, 0.0, 0.0),
];
const TOOL: [f64; 3] = [0.06, 0.01, 0.12];
const BASE: ([f64; 3], [f64; 3]) = ([0.8, -0.4, 0.2], [0.1, -0.2, 1.9]);

fn robot(error: f64, seed: u64) -> Robot {
    let mut random = Random::seeded(seed, 1);
    let mut joint = |(d, a, alpha): (f64, f64, f64)| {
        let mut off = |size: f64| error * size * random.normal();
        let link = Hayati {
            theta: off(1e-3),
            d: d + off(0.3 * MM),
            a: a + off(0.3 * MM),
            alpha: alpha * DEG + off(3e-4),
            beta: 0.0,
        };
        Joint::new("joint", Motion::Revolute, link)
    };
    Robot::new("arm", ARM.map(&mut joint).to_vec())
}

/// Poses over the workspace with 30 µm of noise, by a tracker; base and tip stated to a millimetre.
fn tracked(rows: usize, seed: u64) -> Campaign {
    tracked_with(TOOL, rows, seed)
}

fn tracked_with(tool: [f64; 3], rows: usize, seed: u64) -> Campaign {
    let (nominal, built) = (robot(0.0, seed), robot(1.0, seed));
    let mut random = Random::seeded(seed, 2);
    let base = Pose::from_xyz_rpy(BASE.0, BASE.1);
    let mut recording = Recording::new(6);
    for _ in 0..rows {
        let q: Vec<f64> = (0..6).map(|_| random.uniform(-2.4, 2.4)).collect();
        let noise = Vector3::from_fn(|_, _| 30.0 * UM * random.normal());
        recording.add(&q, base.point(&built.flange_at(&q).point(&tool.into())) + noise).unwrap();
    }
    let tool = Vector3::from(tool) + Vector3::new(0.7, -0.4, 0.3) * MM;
    Campaign::new(nominal, recording).unwrap().with_base(BASE.0, BASE.1).with_tool(tool)
}

fn tx90() -> Campaign {
    let file = std::path::Path::new(env!("CARGO_MANIFEST_DIR")).join("campaigns/tx90-5/campaign.toml");
    Campaign::read(&file).unwrap()
}

fn mended(campaign: &Campaign) -> Mended {
    let mode = if campaign.rod.is_some() { Mode::Fea } else { Mode::None };
    mend(campaign, mode, &Neighbours::default(), &Options::default()).unwrap()
}

/// Effects and places that were found.
fn found(campaign: &Campaign) -> Vec<(String, String)> {
    let all = mended(campaign).found;
    all.iter().map(|finding| (finding.effect.name.to_owned(), finding.location.to_string())).collect()
}

fn one(effect: &str, place: &str) -> Vec<(String, String)> {
    vec![(effect.to_owned(), place.to_owned())]
}

fn with_joints(campaign: &Campaign, change: impl Fn(&mut [f64])) -> Campaign {
    let mut wrong = campaign.clone();
    wrong.measurements.joint_values.chunks_mut(6).for_each(change);
    wrong
}

/// Positions as they would be read, in the frames of the clamps.
fn with_positions(campaign: &Campaign, change: impl Fn(Vector3<f64>) -> Vector3<f64>) -> Campaign {
    let mut wrong = campaign.clone();
    let devices: Vec<Pose> =
        (0..wrong.measurements.len()).map(|row| wrong.measurements.device(row)).collect();
    for (point, device) in points(&mut wrong).iter_mut().zip(devices) {
        *point = device.point(&change(device.inverse().point(point)));
    }
    wrong
}

fn points(campaign: &mut Campaign) -> &mut Vec<Vector3<f64>> {
    match &mut campaign.measurements.targets {
        Targets::Points(points) => points,
        Targets::Sockets(_) => panic!("measured points"),
    }
}

#[test]
fn clean_campaigns_hold_no_mistake() {
    assert_eq!(found(&tx90()), []);
    for seed in 1..=4 {
        let mut campaign = tracked(60, seed);
        campaign.base_is_given = seed % 2 == 0;
        campaign.tool_is_given = seed > 2;
        assert_eq!(found(&campaign), [], "seed {seed}");
    }
}

#[test]
fn joints_that_count_the_other_way_round() {
    for joint in [1, 3, 4] {
        let wrong = with_joints(&tracked(60, 7), |q| q[joint] = -q[joint]);
        assert_eq!(found(&wrong), one("sign_mistake", &format!("q{}_deg", joint + 1)));
    }
}

#[test]
fn joint_columns_in_another_order() {
    assert_eq!(
        found(&with_joints(&tracked(60, 7), |q| q.swap(1, 2))),
        one("swap_mistake", "q2_deg and q3_deg")
    );
    assert_eq!(
        found(&with_joints(&tracked(60, 7), <[f64]>::reverse)),
        one("swap_mistake", "q1_deg … q6_deg")
    );
}

#[test]
fn angles_in_radians() {
    let wrong = with_joints(&tracked(60, 7), |q| q.iter_mut().for_each(|q| *q *= DEG));
    let mended = mended(&wrong);
    assert_eq!(mended.found[0].effect.name, "unit_mistake");
    assert_eq!(mended.found[0].location.to_string(), "q1_deg … q6_deg");
    assert!((mended.found[0].estimates[0].value - 1.0 / DEG).abs() < 1e-9);
}

#[test]
fn angles_in_gon() {
    let all = mended(&with_joints(&tracked(60, 7), |q| q.iter_mut().for_each(|q| *q /= 0.9)));
    assert_eq!(all.found[0].effect.name, "unit_mistake");
    assert_eq!(all.found[0].location.to_string(), "q1_deg … q6_deg");
    assert!((all.found[0].estimates[0].value - 0.9).abs() < 1e-9);
    assert_eq!(found(&with_joints(&tracked(60, 7), |q| q[2] /= 0.9)), one("unit_mistake", "q3_deg"));
}

#[test]
fn zeros_a_quarter_or_half_turn_away() {
    for (joint, degrees) in [(1, 90.0), (2, -90.0), (3, 180.0)] {
        let wrong = with_joints(&tracked(60, 7), |q| q[joint] -= degrees * DEG);
        let mended = mended(&wrong);
        assert_eq!(mended.found[0].effect.name, "offset_mistake", "joint {joint}");
        assert_eq!(mended.found[0].location.to_string(), format!("q{}_deg", joint + 1));
        assert_eq!(mended.found[0].estimates[0].value, degrees);
    }
}

#[test]
fn the_zero_of_the_first_joint_is_seen_by_the_stated_base_only() {
    let wrong = with_joints(&tracked(60, 7), |q| q[0] += 90.0 * DEG);
    assert_eq!(found(&wrong), one("offset_mistake", "q1_deg"));
    // or the base is stated in another way: turned about joint 1
    let rivals = &mended(&wrong).found[0].rivals;
    assert!(rivals.iter().any(|rival| rival.effect.name == "frame_mistake"), "{rivals:?}");
    let second = with_joints(&tracked(60, 7), |q| q[1] += 90.0 * DEG);
    assert!(mended(&second).found[0].rivals.iter().all(|rival| rival.effect.name != "frame_mistake"));
    let unstated = Campaign { base_is_given: false, ..wrong };
    assert_eq!(found(&unstated), []);
}

#[test]
fn positions_in_another_unit() {
    for (factor, clamps) in [(1e3, false), (25.4, false), (1e3, true)] {
        let campaign = if clamps { tx90() } else { tracked(60, 7) };
        let mended = mended(&with_positions(&campaign, |x| x / factor));
        assert_eq!(mended.found[0].effect.name, "unit_mistake");
        assert_eq!(mended.found[0].estimates[0].value, factor);
    }
}

#[test]
fn one_column_in_another_unit() {
    for factor in [1.0 / 25.4, 1e3] {
        let wrong = |x: Vector3<f64>| Vector3::new(x.x, x.y, x.z * factor);
        assert_eq!(found(&with_positions(&tx90(), wrong)), one("unit_mistake", "z_mm"), "{factor}");
    }
    // centimetres and thousandths of an inch, of a tracker
    for factor in [0.1, 1.0 / 0.0254] {
        let wrong = |x: Vector3<f64>| Vector3::new(x.x, x.y * factor, x.z);
        assert_eq!(found(&with_positions(&tracked(60, 7), wrong)), one("unit_mistake", "y_mm"), "{factor}");
    }
}

#[test]
fn axes_of_the_device() {
    let flipped = |x: Vector3<f64>| Vector3::new(x.x, x.y, -x.z);
    let swapped = |x: Vector3<f64>| Vector3::new(x.y, x.x, x.z);
    assert_eq!(found(&with_positions(&tx90(), flipped)), one("sign_mistake", "z_mm"));
    assert_eq!(found(&with_positions(&tx90(), swapped)), one("swap_mistake", "x_mm and y_mm"));
    // a stated base tells which axis it is
    assert_eq!(found(&with_positions(&tracked(60, 7), flipped)), one("sign_mistake", "z_mm"));
    // without it all mirror images are one: each is a rival of the other
    let unstated = Campaign { base_is_given: false, ..with_positions(&tracked(60, 7), flipped) };
    let mended = mended(&unstated);
    let rivals: Vec<String> = mended.found[0].rivals.iter().map(|rival| rival.location.to_string()).collect();
    assert!(rivals.iter().any(|place| place == "x_mm and y_mm"), "{rivals:?}");
}

/// Both files come from the same export. Axes that take turns look like a tracker that stood
/// elsewhere, but for its place.
#[test]
fn a_validation_in_which_positions_are_as_wrong_is_corrected_too() {
    let right = tracked(60, 7);
    let seen = tracked(20, 7).measurements;
    let changes: [fn(Vector3<f64>) -> Vector3<f64>; 3] =
        [|x| x / 25.4, |x| Vector3::new(x.x, x.y, -x.z), |x| Vector3::new(x.y, x.z, x.x)];
    for change in changes {
        let as_wrong = with_positions(&tracked(20, 7), change).measurements;
        for validation in [&as_wrong, &seen] {
            let mut wrong = with_positions(&right, change);
            wrong.validation = Some(validation.clone());
            let meant = mended(&wrong).campaign.validation.unwrap();
            let off = |(a, b): (&Vector3<f64>, &Vector3<f64>)| (a - b).norm();
            let (Targets::Points(meant), Targets::Points(seen)) = (&meant.targets, &seen.targets) else {
                panic!("points");
            };
            assert!(meant.iter().zip(seen).map(off).fold(0.0, f64::max) < 1e-9, "{:?}", change(Vector3::x()));
        }
    }
}

/// The tracker stood elsewhere for the validation, so that its mirror image is nearer than itself.
#[test]
fn a_validation_from_another_place_is_not_mirrored_because_that_is_nearer() {
    let mut wrong = with_positions(&tracked(60, 7), |x| Vector3::new(-x.x, x.y, x.z));
    assert_eq!(found(&wrong), one("sign_mistake", "x_mm"));
    let away = Vector3::new(-2.0 * BASE.0[0], 0.0, 0.0);
    let seen = with_positions(&tracked(20, 7), |x| x + away).measurements;
    wrong.validation = Some(seen.clone());
    assert_eq!(mended(&wrong).campaign.validation.unwrap().targets, seen.targets);
}

#[test]
fn clamps_exchanged_and_frames_in_another_convention() {
    let campaign = tx90();
    let mut wrong = campaign.clone();
    let devices: Vec<Pose> = (0..60).map(|row| campaign.measurements.device(row)).collect();
    for row in &mut wrong.measurements.rows {
        row.group = [1, 0, 2, 3, 4][row.group];
    }
    for (row, device) in devices.iter().enumerate() {
        let there = wrong.measurements.device(row);
        let point = &mut points(&mut wrong)[row];
        *point = there.point(&device.inverse().point(point));
    }
    assert_eq!(found(&wrong), one("swap_mistake", "clamps 1 and 2"));

    let mut wrong = campaign.clone();
    for (k, group) in wrong.measurements.groups.iter_mut().enumerate() {
        let [roll, pitch, yaw] = group.device.roll_pitch_yaw();
        let turned = Pose::from_xyz_rpy(group.device.origin.into(), [yaw, pitch, roll]);
        let Targets::Points(points) = &mut wrong.measurements.targets else { panic!("measured points") };
        let rows = points.iter_mut().zip(&wrong.measurements.rows);
        for (point, _) in rows.filter(|(_, row)| row.group == k) {
            *point = turned.point(&group.device.inverse().point(point));
        }
        *group = Group { device: turned, ..group.clone() };
    }
    assert_eq!(found(&wrong), one("frame_mistake", "clamp rpy_deg (all)"));
}

#[test]
fn a_base_that_is_stated_the_other_way_round() {
    let campaign = tracked(60, 7);
    let inverse = Pose::from_xyz_rpy(BASE.0, BASE.1).inverse();
    let wrong = campaign.clone().with_base(inverse.origin.into(), inverse.roll_pitch_yaw());
    let mended = mended(&wrong);
    assert_eq!(mended.found[0].effect.name, "frame_mistake");
    assert_eq!(mended.found[0].location.to_string(), "base");
    assert!(!mended.suspicions[0].spoils_fit);
    assert!((Vector3::from_column_slice(&mended.campaign.base[..3]) - Vector3::from(BASE.0)).norm() < MM);
}

/// A clamp that stands aside explains a part of the residuals, and nothing of where the base is.
#[test]
fn a_base_the_other_way_round_is_found_beside_a_clamp_that_stands_aside() {
    let right = tx90();
    let [x, y, z, roll, pitch, yaw] = right.base;
    let inverse = Pose::from_xyz_rpy([x, y, z], [roll, pitch, yaw]).inverse();
    let mut wrong = right.with_base(inverse.origin.into(), inverse.roll_pitch_yaw());
    let clamps: Vec<usize> = wrong.measurements.rows.iter().map(|row| row.group).collect();
    for (point, clamp) in points(&mut wrong).iter_mut().zip(clamps) {
        if clamp == 1 {
            *point += Vector3::new(0.2, -0.1, 0.1) * MM;
        }
    }
    assert_eq!(found(&wrong)[0], ("frame_mistake".into(), "base".into()));
}

#[test]
fn a_tip_that_is_stated_in_another_frame() {
    let [x, y, z] = TOOL;
    let wrong = tracked(60, 7).with_tool(Vector3::new(z, y, -x));
    assert_eq!(mended(&wrong).found[0].effect.name, "frame_mistake");
    assert_eq!(mended(&wrong).found[0].location.to_string(), "tool.xyz_mm");
}

#[test]
fn another_rod_and_another_robot_of_the_same_folder() {
    let campaign = tx90();
    let right = campaign.rod.clone().unwrap();
    let folder = std::path::Path::new(env!("CARGO_MANIFEST_DIR")).join("rods");
    let other = crate::rod::Rod::read(&folder.join("3.toml")).unwrap();
    let wrong = Campaign { tool: other.tip(), rod: Some(other), readings: None, ..campaign };
    let others = Neighbours { rods: vec![("5.toml".into(), right)], ..Neighbours::default() };
    let mended = mend(&wrong, Mode::Fea, &others, &Options::default()).unwrap();
    assert_eq!(mended.found[0].effect.name, "rod_mistake");
    assert_eq!(mended.found[0].location.to_string(), "5.toml");

    let campaign = tracked(60, 7);
    let mut larger = campaign.robot.clone();
    larger.joints.iter_mut().for_each(|joint| joint.link.a *= 1.3);
    let wrong = Campaign { robot: larger, ..campaign.clone() };
    let robots = vec![("arm.toml".into(), campaign.robot.clone(), String::new())];
    let others = Neighbours { robots, ..Neighbours::default() };
    let mended = mend(&wrong, Mode::None, &others, &Options::default()).unwrap();
    assert_eq!(mended.found[0].effect.name, "robot_mistake");
    assert_eq!(mended.campaign.robot, campaign.robot);
}

#[test]
fn columns_that_say_nothing() {
    let zero = with_positions(&tx90(), |_| Vector3::zeros());
    assert_eq!(found(&zero), one("stuck_sensor", "x_mm, y_mm, z_mm"));
    let copied = with_joints(&tracked(60, 7), |q| q[4] = q[3]);
    assert_eq!(found(&copied), one("copied_column", "q4_deg and q5_deg"));
    assert_eq!(found(&with_joints(&tracked(60, 7), |q| q[2] = 0.3)), one("stuck_sensor", "q3_deg"));
    assert!(!mended(&zero).has_data);
}

#[test]
fn two_mistakes_at_once() {
    let wrong = with_joints(&tracked(60, 7), |q| {
        q[2] = -q[2];
        q[4] += 90.0 * DEG;
    });
    let mut all = found(&wrong);
    all.sort();
    assert_eq!(all, [one("offset_mistake", "q5_deg"), one("sign_mistake", "q3_deg")].concat());
}

/// A tip 36 mm beside the last axis: with that joint's zero off by 90° it may stand elsewhere on
/// its circle by a rough guess, at a price that leaves the mistake less than 1000 : 1, but a
/// calibration does not go there.
#[test]
fn a_zero_of_the_last_joint_is_no_tip_that_stands_elsewhere() {
    let right = tracked_with([0.035, 0.01, 0.12], 60, 4);
    let wrong = with_joints(&right, |q| q[5] += 90.0 * DEG);
    assert!(!calibrate(&wrong, Mode::None, &Options::default()).unwrap().is_plausible());
    let mended = mended(&wrong);
    let names: Vec<(&str, String)> =
        mended.found.iter().map(|f| (f.effect.name, f.location.to_string())).collect();
    let [(effect, location)] = &names[..] else { panic!("{names:?}") };
    let is_zero = (*effect, location.as_str()) == ("offset_mistake", "q6_deg");
    let may_be_zero = mended.found[0].others().iter().any(|(effect, _)| effect.name == "offset_mistake");
    assert!(is_zero || may_be_zero, "{names:?}");
}
