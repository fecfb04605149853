//! Robots written back: a table to the last digit, a URDF with its new origins and everything else
//! as it was.

use nalgebra::Vector3;
use rodcal::answer::{calibrated_robot, simulate};
use rodcal::calibration::simulate::Plan;
use rodcal::calibration::{Campaign, Mode, Options, calibrate};
use rodcal::error::Error;
use rodcal::robot::{Body, Joint, Motion, Robot};
use rodcal::rod::Rod;

use super::product::product;
use super::urdfs::{ARMS, urdf};
use super::{Dice, difference, real, tx90};

#[test]
fn a_table_is_written_as_it_was_read() {
    let robot = tx90();
    let text = robot.to_toml(&["calibrated\nby hand \u{7}".to_owned()]).expect("a table");
    assert_eq!(Robot::from_text("tx90.toml", &text, None, None).expect(&text), robot);
    assert!(text.starts_with("# calibrated\n# by hand\nname = \"TX90\"\nsource = \""), "{text}");
    // nothing but the numbers as somebody would write them
    for line in [
        "theta_offset_deg = 90.0",
        "d_mm = -50.0",
        "limits_deg = [-147.5, 130.0]",
        "com_mm = [3.0, 129.0, 0.0]",
    ] {
        assert!(text.contains(line), "{line} is not in {text}");
    }
    assert!(!text.contains("type =") && !text.contains("\nname = \"joint"), "{text}");
}

#[test]
fn any_table_survives_to_the_last_bit() {
    let mut dice = Dice(3);
    let ulps = |a: f64, b: f64| a == b || a.next_up() == b || a.next_down() == b;
    let (mut count, mut exact) = (0, 0);
    for _ in 0..200 {
        let mut robot = tx90();
        robot.name = "a \"quoted\" \\ name\nof two lines".to_owned();
        robot.source = None;
        robot.joints[2].motion = Motion::Prismatic;
        robot.joints[2].limits = Some([-0.1 * dice.roll().abs(), 0.7]);
        robot.joints[4].body = None;
        for joint in &mut robot.joints {
            perturb(joint, &mut dice, 1.0);
            if joint.motion == Motion::Revolute {
                joint.compliance = dice.roll() * 1e-5;
            }
            if let Some(body) = &mut joint.body {
                *body = Body { mass: dice.roll().abs(), centre: dice.vector(1.0) };
            }
        }
        let text = robot.to_toml(&[]).expect("a table");
        let again = Robot::from_text("tx90.toml", &text, None, None).expect(&text);
        assert_eq!((&again.name, &again.source), (&robot.name, &robot.source));
        for (a, b) in again.joints.iter().zip(&robot.joints) {
            let (a, b) = (numbers(a), numbers(b));
            assert!(a.len() == b.len() && a.iter().zip(&b).all(|(a, b)| ulps(*a, *b)), "{a:?} {b:?}");
            count += a.len();
            exact += a.iter().zip(&b).filter(|(a, b)| a == b).count();
        }
    }
    assert!(exact * 10 > count * 9, "{exact} of {count} exact");
}

#[test]
fn a_robot_that_is_no_table_says_so() {
    let robot = Robot::from_text("robot.urdf", &urdf(ARMS[2].1), None, None).expect("an arm");
    let error = robot.to_toml(&[]).expect_err("it has a flange");
    assert_eq!(
        error.to_string(),
        "writing robot `arm` as a table is not possible: its first joint or its flange is not where a table has it"
    );
    assert_eq!(error.hint(), Some("write it into its URDF"));
}

/// Every parameter of every joint is changed; the URDF then has the calibrated kinematics.
fn check_written(name: &str, text: &str, base: &str, tip: &str) {
    let nominal = Robot::from_text("robot.urdf", text, Some(base), Some(tip)).expect(name);
    let mut dice = Dice(11);
    for scale in [1e-3, 0.3] {
        let mut calibrated = nominal.clone();
        for joint in &mut calibrated.joints {
            perturb(joint, &mut dice, scale);
        }
        calibrated.root.origin += dice.vector(scale);
        let tool = dice.vector(0.2);
        let written =
            calibrated.to_urdf("robot.urdf", text, Some(base), Some(tip), Some(tool), &[]).expect(name);
        assert!(written.has_tool, "{name}");
        let again =
            Robot::from_text("robot.urdf", &written.text, Some(base), Some(tip)).expect(&written.text);
        for _ in 0..50 {
            let q = dice.angles(nominal.joints.len());
            let mut expected = calibrated.flange_at(&q);
            expected.origin = expected.point(&tool);
            let by_reader = difference(&again.flange_at(&q), &expected);
            let by_product = difference(&product(&written.text, base, tip, &q), &expected);
            assert!(
                by_reader.max(by_product) < 1e-12,
                "{name}: {by_reader:e} {by_product:e}\n{}",
                written.text
            );
        }
    }
}

#[test]
fn a_calibrated_urdf_has_the_calibrated_kinematics() {
    for (name, arm) in ARMS {
        if arm.last().is_some_and(|(kind, ..)| *kind == "fixed") {
            check_written(name, &urdf(arm), "base_link", "tip_link");
        }
    }
    for (file, base) in [("mukca/kuka_14", "base_link"), ("mukca/panda_1", "panda_link0")] {
        let Some(text) = real(&format!("{file}/robot.urdf")) else { return };
        check_written(file, &text, base, "ball_link");
    }
}

const RICH: &str = "\u{feff}<?xml version='1.0'?>
<!-- drawn by <hand> & eye: µ -->
<robot  name = 'rich'>
  <material name=\"grey\"><color rgba=\"1 1 1 1\"/></material>
  <link name=\"base_link\"/>
  <link name=\"a\">
    <visual><origin xyz=\"9 9 9\"/><geometry><mesh filename=\"package://a/b.stl\"/></geometry></visual>
    <inertial><origin xyz=\"1 2 3\"/><mass value=\"2\"/><inertia ixx=\"1\"/></inertial>
  </link>
  <link name=\"b\"/><link name=\"tip_link\"/><link name=\"side\"/>
  <joint name=\"one\" type=\"revolute\"><!-- no origin -->
      <parent link=\"base_link\"/>
      <child link=\"a\"/>
      <axis xyz=\"0 0 1\"/>
  </joint>
  <joint type=\"revolute\" name=\"two\"><child link=\"b\"/><parent link=\"a\"/><origin rpy='0 0 0'
     xyz = '0.1 0 0'></origin><axis xyz=\"0 1 0\"/></joint>
  <joint name=\"end\" type=\"fixed\"><parent link=\"b\"/><child link=\"tip_link\"/></joint>
  <joint name=\"aside\" type=\"fixed\"><parent link=\"b\"/><child link=\"side\"/><origin xyz=\"1 0 0\"/></joint>
  <gazebo reference=\"a\"><origin xyz=\"0 0 0\"/></gazebo>
</robot>
<!-- end -->
";

#[test]
fn everything_but_the_origins_survives() {
    let robot = Robot::from_text("robot.urdf", RICH, None, None).expect("a good file");
    let unchanged = robot.to_urdf("robot.urdf", RICH, None, None, None, &[]).expect("the same");
    assert_eq!((unchanged.text.as_str(), unchanged.has_tool), (RICH, true));

    let mut calibrated = robot.clone();
    calibrated.joints[0].compliance = 2.5 * rodcal::units::URAD_PER_NM;
    calibrated.joints[0].link.theta += 0.25;
    calibrated.root.origin.z = 0.5;
    let tool = Vector3::new(0.0, 0.0, 0.125);
    let comments = ["Calibrated -- see\nthe ---report".to_owned()];
    let written = calibrated.to_urdf("robot.urdf", RICH, None, None, Some(tool), &comments).expect("a URDF");
    let comment = "<!--\n  Calibrated - - see\n  the - - -report\n  \
                   Not in this file, a URDF has no joint compliance: one 2.5 urad/(N m).\n-->\n<robot ";
    assert!(written.text.contains(comment), "{}", written.text);

    // what is new, taken out again, leaves what was there
    let origins: Vec<&str> = written
        .text
        .match_indices("<origin")
        .map(|(at, _)| written.text[at..].split_inclusive('>').next().unwrap())
        .collect();
    assert_eq!(
        origins,
        [
            "<origin xyz=\"9 9 9\"/>",
            "<origin xyz=\"1 2 3\"/>",
            "<origin xyz=\"0.0 0.0 0.5\" rpy=\"0.0 0.0 0.0\"/>",
            origins[3],
            "<origin xyz=\"0.0 0.0 0.125\" rpy=\"0.0 0.0 0.0\"/>",
            "<origin xyz=\"1 0 0\"/>",
            "<origin xyz=\"0 0 0\"/>",
        ]
    );
    let old_two = "<origin rpy='0 0 0'\n     xyz = '0.1 0 0'></origin>";
    let stripped = written
        .text
        .replace(comment, "<robot ")
        .replace(&format!("{}\n      <parent", origins[2]), "<parent")
        .replace(origins[3], old_two)
        .replace(origins[4], "");
    assert_eq!(stripped, RICH);
}

#[test]
fn a_tip_on_the_last_moving_link_leaves_the_tool_out() {
    let text = urdf(ARMS[1].1);
    let robot = Robot::from_text("robot.urdf", &text, None, None).expect("an arm");
    let mut calibrated = robot.clone();
    calibrated.joints[1].link.a += 0.001;
    let tool = Some(Vector3::new(0.0, 0.0, 0.1));
    let written =
        calibrated.to_urdf("robot.urdf", &text, None, None, tool, &["by hand".to_owned()]).expect("a URDF");
    assert!(!written.has_tool);
    assert!(
        written.text.contains("Not in this file, no fixed joint is there for it: the tool"),
        "{}",
        written.text
    );
    let q = [0.1, 0.2, 0.3, 0.4];
    let found = product(&written.text, "base_link", "tip_link", &q);
    assert!(difference(&found, &calibrated.flange_at(&q)) < 1e-14, "all but the tool is there");
}

#[test]
fn another_robot_is_refused() {
    let text = urdf(ARMS[1].1);
    let error = tx90().to_urdf("robot.urdf", &text, None, None, None, &[]).expect_err("another robot");
    assert_eq!(
        error.to_string(),
        "`robot` is a robot with 6 joints, expected the robot of this URDF, which has 4"
    );
    let mut robot = Robot::from_text("robot.urdf", &text, None, None).expect("an arm");
    robot.joints[0].link.d = f64::NAN;
    let error = robot.to_urdf("robot.urdf", &text, None, None, None, &[]).expect_err("not a number");
    assert!(matches!(error, Error::Argument { .. }), "{error}");
}

fn perturb(joint: &mut Joint, dice: &mut Dice, scale: f64) {
    let link = &mut joint.link;
    for number in [&mut link.theta, &mut link.d, &mut link.a, &mut link.alpha, &mut link.beta] {
        *number += dice.roll() * scale;
    }
}

fn numbers(joint: &Joint) -> Vec<f64> {
    let link = &joint.link;
    let mut all = vec![link.theta, link.d, link.a, link.alpha, link.beta, joint.compliance];
    all.extend(joint.limits.iter().flatten());
    all.extend(joint.body.iter().flat_map(|body| [body.mass, body.centre.x, body.centre.y, body.centre.z]));
    all
}

/// The URDF's `tip_link` stands at the tip afterwards: what stands beside it must not add the tool
/// once more.
#[test]
fn a_calibrated_urdf_with_what_stands_beside_it_predicts_as_it_was_calibrated() {
    let root = std::path::Path::new(env!("CARGO_MANIFEST_DIR"));
    let read = |name: &str| std::fs::read_to_string(root.join(name)).unwrap();
    let (robot_text, rod_text) = (read("robots/six-axis.urdf"), read("rods/5.toml"));
    let robot = Robot::from_text("robot.urdf", &robot_text, None, None).unwrap();
    let rod = Rod::from_toml("rod.toml", &rod_text).unwrap();
    let plan = Plan::of_poses(8, 5);
    let named = ("robot.urdf".to_owned(), robot_text);
    let simulated = simulate(&robot, named, (&rod, rod_text), &plan, "campaign.toml", &|| ()).unwrap();
    let text_of = |files: &[(String, Vec<u8>)], name: &str| {
        let (_, content) = files.iter().find(|(own, _)| own == name).expect("it is there");
        String::from_utf8(content.clone()).unwrap()
    };
    let open = |name: &str| Ok(text_of(&simulated.files, name));
    let campaign = Campaign::from_texts("campaign.toml", &open("campaign.toml").unwrap(), &open).unwrap();
    let calibration = calibrate(&campaign, Mode::Meas, &Options::default()).unwrap();

    let files = calibrated_robot(&campaign, &calibration).unwrap();
    let urdf = text_of(&files, "calibrated.urdf");
    let mut again = Robot::from_text("calibrated.urdf", &urdf, None, None).unwrap();
    again.add_beside("effects.toml", &text_of(&files, "calibrated-effects.toml")).unwrap();
    let tip = again.tip.expect("it stands beside").at;
    let calibrated = calibration.setup.calibrated();
    let mut dice = Dice(7);
    for _ in 0..10 {
        let q = dice.angles(6);
        let (expected, _) = calibrated.tip_at(calibration.setup.tool, &q);
        let (found, _) = again.tip_at(tip, &q);
        // the links' masses hang on the calibrated frames now, 1 mm and 1 mrad from the drawing's:
        // some 0.1 N·m more or less on joints of 3 to 400 µrad/(N·m)
        assert!((found - expected).norm() < 1e-6, "{found} {expected}");
    }
}
