//! URDFs: the chain has the kinematics of the file, and masses hang where the file has them.

use nalgebra::Vector3;
use rodcal::robot::{Motion, Robot};

use super::product::product;
use super::{Dice, difference, real};

/// `<joint>`s with their links, base to tip: type, xyz, rpy, axis.
pub type Arm<'a> = &'a [(&'a str, &'a str, &'a str, &'a str)];

/// A URDF of an arm from `base_link` to `tip_link`.
pub fn urdf(arm: Arm) -> String {
    let mut text =
        String::from("<?xml version=\"1.0\"?>\n<robot name=\"arm\">\n  <link name=\"base_link\"/>\n");
    let mut parent = "base_link".to_owned();
    for (index, (kind, xyz, rpy, axis)) in arm.iter().enumerate() {
        let child = if index + 1 == arm.len() { "tip_link".to_owned() } else { format!("link_{index}") };
        text += &format!(
            "  <link name=\"{child}\"/>\n  <joint name=\"joint_{index}\" type=\"{kind}\">\n    \
             <parent link=\"{parent}\"/>\n    <child link=\"{child}\"/>\n    \
             <origin xyz=\"{xyz}\" rpy=\"{rpy}\"/>\n    <axis xyz=\"{axis}\"/>\n  </joint>\n"
        );
        parent = child;
    }
    text + "</robot>\n"
}

/// Arms that go to the corners of the conversion.
pub const ARMS: [(&str, Arm); 9] = [
    (
        "one joint, turned to a side",
        &[("revolute", "0.1 0.2 0.3", "0.1 0.2 0.3", "1 0 0"), ("fixed", "0 0 0.1", "0 1 0", "")],
    ),
    (
        "parallel axes, as of a SCARA",
        &[
            ("revolute", "0 0 0.3", "0 0 0", "0 0 1"),
            ("revolute", "0.3 0.1 0.05", "0 0 0.3", "0 0 1"),
            ("continuous", "0.25 0 0", "0 0 0", "0 0 -1"),
            ("prismatic", "0 0 -0.1", "3.141592653589793 0 0", "0 0 1"),
        ],
    ),
    (
        "skew axes",
        &[
            ("revolute", "0 0 0.3", "0.4 0 0", "0 0 1"),
            ("revolute", "0.3 0.1 0.05", "1 0.5 0.3", "0.1 0.9 -0.3"),
            ("revolute", "0.25 0 0.1", "-0.7 0 2", "-1 2 3"),
            ("fixed", "0 0 0.1", "0.1 0 0", ""),
            ("revolute", "0.25 -0.2 0.1", "-0.7 1.5 2", "2 -2 1"),
            ("fixed", "0 0 0.1", "0.1 0 0", ""),
            ("fixed", "0.05 0 0.1", "0 -0.3 0", ""),
        ],
    ),
    (
        "negative axes that intersect",
        &[
            ("revolute", "0 0 0.3", "0 0 0", "0 0 -1"),
            ("revolute", "0 0 0.4", "0 0 0", "0 -1 0"),
            ("revolute", "0 0 0.4", "0 0 0", "-1 0 0"),
            ("revolute", "0.1 0 0", "0 0 0", "0 0 -1"),
        ],
    ),
    (
        "prismatic joints, as of a gantry",
        &[
            ("prismatic", "0 0 1", "0 0 0", "1 0 0"),
            ("prismatic", "0.1 0 0.2", "0 0 0", "0 1 0"),
            ("prismatic", "0 0.1 0.2", "0 0 0", "0 0 -1"),
            ("revolute", "0.03 0 0.2", "0 0 0.7", "0 0.001 -1"),
            ("fixed", "0 0 0.1", "0 0 0", ""),
        ],
    ),
    (
        "axes tilted by 0.01 degrees",
        &[
            ("revolute", "0 0 0.3", "0.7 0 0", "0 1 0"),
            ("revolute", "0 0 0.4", "0.00017453292519943296 0 0", "0 1 0"),
            ("revolute", "0.4 0 0", "0 0 0.00017453292519943296", "0 -1 0"),
            ("revolute", "0.1 0.2 0", "0 0.5 -0.00017453292519943296", "0 1 0"),
            ("fixed", "0 0 0.1", "0 0 0", ""),
        ],
    ),
    (
        "coincident axes, and almost so",
        &[
            ("revolute", "0 0 0.3", "0 0 0", "0 0 1"),
            ("revolute", "0 0 0.4", "0 0 1", "0 0 1"),
            ("revolute", "0 0 0.4", "3.141592653589793 0 0", "0 0 1"),
            ("revolute", "1e-10 2e-11 0.1", "0 0 0", "0 0 1"),
            ("revolute", "1e-15 2e-15 0.1", "1e-12 0 0", "0 0 1"),
            ("fixed", "0.1 0 0", "0 0 0", ""),
        ],
    ),
    (
        "on both sides of ten degrees",
        &[
            ("revolute", "0 0 0.3", "0 0 0", "0 0 1"),
            ("revolute", "0.1 0.1 0.4", "0.1745 0 0", "0 0 1"),
            ("revolute", "0.1 -0.3 0.4", "0.1746 0 0", "0 0 1"),
            ("revolute", "0.1 0.1 0.4", "2.9670 0.01 0", "0 0 1"),
            ("revolute", "0.1 0.1 0.4", "2.9672 0.01 0", "0 0 1"),
            ("fixed", "0.1 0 0", "0 0 0", ""),
        ],
    ),
    (
        "pitched by 90 degrees, lengths of a crane",
        &[
            ("fixed", "3 0 0", "0 1.5707963267948966 0", ""),
            ("revolute", "0 0 7", "0.3 1.5707963267948966 0.2", "3e-200 0 4e-200"),
            ("fixed", "0 12 0", "1 -1.5707963267948966 0", ""),
            ("prismatic", "1 0 30", "0 1.5707963267948966 2", "0 1e29 0"),
            ("fixed", "0 0 2", "0 1.5707963267948966 0", ""),
        ],
    ),
];

/// Largest difference between chain and product over random joint values; m and 1.
fn worst(text: &str, base: &str, tip: &str) -> f64 {
    let robot = Robot::from_text("robot.urdf", text, Some(base), Some(tip)).expect(text);
    let mut dice = Dice(1);
    let of_pose = |_| {
        let q = dice.angles(robot.joints.len());
        difference(&robot.flange_at(&q), &product(text, base, tip, &q))
    };
    (0..200).map(of_pose).fold(0.0, f64::max)
}

#[test]
fn the_chain_of_a_real_robot_is_the_product_of_its_file() {
    for (file, base) in [
        ("mukca/kuka_14", "base_link"),
        ("mukca/panda_1", "panda_link0"),
        ("mukca/panda_2_clean", "panda_link0"),
    ] {
        let Some(text) = real(&format!("{file}/robot.urdf")) else { return };
        let worst = worst(&text, base, "ball_link");
        assert!(worst < 1e-12, "{file}: {worst:e}");
    }
}

#[test]
fn the_chain_of_any_arm_is_the_product_of_its_file() {
    for (name, arm) in ARMS {
        let worst = worst(&urdf(arm), "base_link", "tip_link");
        assert!(worst < 1e-12, "{name}: {worst:e}");
    }
}

#[test]
fn random_arms_are_their_products() {
    let mut dice = Dice(7);
    for _ in 0..25 {
        let three = |dice: &mut Dice, scale: f64| {
            let v = dice.vector(scale);
            format!("{} {} {}", v.x, v.y, v.z)
        };
        let kinds = ["revolute", "prismatic", "fixed", "continuous"];
        let mut joints: Vec<[String; 4]> = (0..8)
            .map(|_| {
                let kind = kinds[(dice.roll().abs() * 3.999) as usize].to_owned();
                [kind, three(&mut dice, 0.5), three(&mut dice, 3.0), three(&mut dice, 1.0)]
            })
            .collect();
        joints[0][0] = "revolute".to_owned();
        let arm: Vec<_> =
            joints.iter().map(|[k, p, r, a]| (k.as_str(), p.as_str(), r.as_str(), a.as_str())).collect();
        let worst = worst(&urdf(&arm), "base_link", "tip_link");
        assert!(worst < 1e-12, "{worst:e}: {joints:?}");
    }
}

/// What Hayati's β is for: the smallest tilt must not make the parameters jump.
#[test]
fn nearly_parallel_axes_have_nearly_the_links_of_parallel_ones() {
    let arm = |tilt: &str| {
        let joints: Arm = &[
            ("revolute", "0 0 0.3", "0 0 0", "0 1 0"),
            ("revolute", "0 -0.05 0.425", tilt, "0 1 0"),
            ("fixed", "0 0 0.1", "0 0 0", ""),
        ];
        Robot::from_text("robot.urdf", &urdf(joints), None, None).expect("an arm").joints[0].link
    };
    let tilt = 0.01f64.to_radians();
    let parallel = arm("0 0 0");
    assert!((parallel.a.abs() - 0.425).abs() < 1e-15 && parallel.d == 0.0, "{parallel:?}");
    for turn in [format!("{tilt} 0 0"), format!("0 0 {tilt}"), format!("{} 0 {tilt}", -tilt)] {
        let tilted = arm(&turn);
        let changes = [
            tilted.theta - parallel.theta,
            tilted.a - parallel.a,
            tilted.alpha - parallel.alpha,
            tilted.beta,
        ];
        assert!(changes.iter().all(|change| change.abs() <= tilt * 1.001), "{turn}: {tilted:?}");
        assert_eq!(tilted.d, 0.0);
    }
}

#[test]
fn the_panda_gets_the_link_lengths_that_its_maker_publishes() {
    let Some(text) = real("mukca/panda_1/robot.urdf") else { return };
    let robot =
        Robot::from_text("robot.urdf", &text, Some("panda_link0"), Some("ball_link")).expect("a panda");
    // Craig's a and d in the maker's table; here a belongs to the joint in front of it
    let lengths = |number: fn(&rodcal::robot::Hayati) -> f64| -> Vec<f64> {
        robot.joints.iter().map(|joint| (number(&joint.link).abs() * 1e6).round() / 1e6).collect()
    };
    assert_eq!(lengths(|link| link.a), [0.0, 0.0, 0.0825, 0.0825, 0.0, 0.088, 0.0]);
    assert_eq!(lengths(|link| link.d), [0.0, 0.0, 0.316, 0.0, 0.384, 0.0, 0.0]);
    assert!((robot.root.origin - Vector3::new(0.0, 0.0, 0.333)).norm() < 1e-15);
    let joint = &robot.joints[3];
    assert_eq!((joint.name.as_str(), joint.motion), ("panda_joint4", Motion::Revolute));
    assert_eq!((joint.limits, joint.body, joint.compliance), (Some([-3.0718, -0.0698]), None, 0.0));
    assert_eq!((robot.name.as_str(), robot.gravity), ("panda", Vector3::new(0.0, 0.0, -9.80665)));
}

const MASSES: &str = r#"<robot name="">
  <link name="base_link"><inertial><mass value="1000"/></inertial></link>
  <link name="arm"><inertial><origin xyz="0 0 0.1"/><mass value="2"/></inertial></link>
  <link name="cover"><inertial><origin xyz="0 0 0.1" rpy="1 2 3"/><mass value="1"/></inertial></link>
  <link name="finger"><inertial><mass value="1"/></inertial></link>
  <link name="tip_link"><inertial><mass value="4"/></inertial></link>
  <link name="camera"><inertial><mass value="0"/></inertial></link>
  <joint name="shoulder" type="revolute">
    <origin xyz="0 0 1" rpy="0 0 1.5707963267948966"/>
    <parent link="base_link"/><child link="arm"/>
    <axis xyz="0 1 0"/><limit lower="0" upper="0" effort="1" velocity="1"/>
  </joint>
  <joint name="cover_joint" type="fixed">
    <origin xyz="0.5 0 0"/><parent link="arm"/><child link="cover"/>
  </joint>
  <joint name="finger_joint" type="prismatic">
    <mimic joint="wrist"/><origin xyz="0 0.2 0"/><parent link="cover"/><child link="finger"/>
  </joint>
  <joint name="wrist" type="continuous">
    <origin xyz="0 0 0.4"/><parent link="arm"/><child link="tip_link"/>
  </joint>
  <joint name="camera_joint" type="floating"><parent link="tip_link"/><child link="camera"/></joint>
</robot>"#;

/// Two bodies, added up by hand in `base_link`.
#[test]
fn what_moves_with_a_joint_is_its_body() {
    let robot = Robot::from_text("robots/masses.urdf", MASSES, None, None).expect("a good file");
    assert_eq!((robot.name.as_str(), robot.joints.len()), ("masses", 2));
    let [shoulder, wrist] = [0, 1].map(|joint| robot.joints[joint].body.expect("a body"));
    assert_eq!((shoulder.mass, wrist.mass), (4.0, 4.0));
    // in the arm's frame: 2 kg at (0, 0, 0.1), 1 kg at (0.5, 0, 0.1), 1 kg at (0.5, 0.2, 0)
    let in_arm = Vector3::new(0.25, 0.05, 0.075);
    let in_base = Vector3::new(-in_arm.y, in_arm.x, in_arm.z + 1.0);
    let distal = robot.joints[0].link.beyond(&robot.root);
    assert!((distal.point(&shoulder.centre) - in_base).norm() < 1e-15);
    let last = robot.joints[1].link.beyond(&distal);
    assert!((last.point(&wrist.centre) - Vector3::new(0.0, 0.0, 1.4)).norm() < 1e-15);
    // a range of nothing is none; an axis that is not stated is x
    assert_eq!((robot.joints[0].limits, robot.joints[1].limits), (None, None));
    assert!((last.rotation.column(2) - Vector3::y()).norm() < 1e-15, "arm's x is base's y");
}
