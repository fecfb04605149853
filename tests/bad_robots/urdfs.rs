//! Mistakes in URDFs, and the message that each gets.

use rodcal::robot::Robot;

use super::{URDF, check, in_words};

#[test]
fn xml_that_is_none_is_named() {
    check(
        URDF,
        &[
            ("</robot>", "", "robot: no valid XML: the root node was opened but never closed"),
            ("</joint>", "</jiont>", "robot:15:3: no valid XML: expected 'joint' tag, not 'jiont'"),
            ("xyz=\"0 0 0.3\"", "xyz=0", "robot:12:17: no valid XML: expected a quote not '0'"),
            (
                "xyz=\"0 0 0.3\"",
                "xyz=\"0\" xyz=\"1\"",
                "robot:12:21: no valid XML: attribute 'xyz' is already defined",
            ),
            ("<robot", "<!DOCTYPE robot>\n<robot", "robot: no valid XML: XML with DTD detected"),
            (
                "<link name=\"camera\"/>",
                "<xacro:box/>",
                "robot:8:4: no valid XML: an unknown namespace prefix 'xacro'",
            ),
        ],
    );
    for (text, expected) in [
        ("<", "robot:1:2: no valid XML: invalid name token"),
        ("  <?xml version=\"1.0\"?>", "robot:1:3: no valid XML: unexpected XML declaration"),
        ("<!-- -->", "robot: no valid XML: the document does not have a root node"),
        (
            "<sdf/>",
            "robot:1:1: the outermost element is <sdf>, expected <robot>, as in a URDF -> an SDF is no URDF",
        ),
        (
            "<mujoco model=\"a\"/>",
            "robot:1:1: the outermost element is <mujoco>, expected <robot>, as in a URDF",
        ),
        (
            "<robot xmlns:xacro=\"http://www.ros.org/wiki/xacro\">\n <xacro:include filename=\"a\"/></robot>",
            "robot:2:2: a macro of xacro, expected a URDF without macros -> expand them first: xacro robot.urdf.xacro > robot.urdf",
        ),
        (
            "<robot/>",
            "robot: there is no link `base_link`, expected base_link to be a link of the file; it has none",
        ),
    ] {
        let error = Robot::from_text("robot", text, None, None).expect_err(text);
        assert_eq!(in_words(&error), expected);
    }
}

#[test]
fn a_mistake_in_a_joint_is_named() {
    check(
        URDF,
        &[
            (
                "type=\"revolute\"",
                "type=\"revolut\"",
                "robot:9:32: `joint.type` is revolut, expected revolute, continuous, prismatic, fixed, floating or planar",
            ),
            (
                " type=\"revolute\"",
                "",
                "robot:9:3: <joint name=\"shoulder\"> has no type, expected revolute, continuous, prismatic, fixed, floating or planar",
            ),
            ("name=\"shoulder\" ", "", "robot:9:3: <joint> has no name, expected a name for each joint"),
            (
                "name=\"shoulder\"",
                "name=\" \"",
                "robot:9:16: `joint.name` is blank, expected a name for each joint",
            ),
            (
                "name=\"shoulder\"",
                "name=\"hand\"",
                "robot:16:16: `joint.name` is hand, expected a name of its own for each joint",
            ),
            (
                "type=\"revolute\"",
                "type=\"planar\"",
                "robot:9:3: joint `shoulder` between base_link and tip_link is planar, expected revolute, continuous, prismatic or fixed joints there",
            ),
            (
                "type=\"revolute\">",
                "type=\"revolute\"><mimic joint=\"elbow\"/>",
                "robot:9:3: joint `shoulder` mimics `elbow`, expected joints that move by themselves between base_link and tip_link",
            ),
            (
                "type=\"revolute\"",
                "type=\"fixed\"",
                "robot:7:3: no joint moves `tip_link` against `base_link`, expected a revolute, continuous or prismatic joint between base_link and tip_link",
            ),
            (
                "<parent link=\"base_link\"/>",
                "",
                "robot:9:3: <joint name=\"shoulder\"> has no <parent>, expected <parent link=\"…\"/>",
            ),
            (
                "<child link=\"upper_arm\"/>",
                "",
                "robot:9:3: <joint name=\"shoulder\"> has no <child>, expected <child link=\"…\"/>",
            ),
            (
                "<parent link=\"base_link\"/>",
                "<parent/>",
                "robot:10:5: <parent> has no link, expected the name of a link",
            ),
            (
                "<parent link=\"base_link\"/>",
                "<parent link=\"base-link\"/>",
                "robot:10:19: `parent.link` is base-link, expected one of the links base_link, upper_arm, tip_link, camera -> did you mean base_link?",
            ),
            (
                "<child link=\"upper_arm\"/>",
                "<child link=\"forearm\"/>",
                "robot:11:18: `child.link` is forearm, expected one of the links base_link, upper_arm, tip_link, camera",
            ),
            (
                "xyz=\"0 0 0.3\"",
                "xyz=\"0 0\"",
                "robot:12:18: `origin.xyz` is 0 0, expected three numbers with blanks between them",
            ),
            (
                "xyz=\"0 0 0.3\"",
                "xyz=\"0, 0, 0.3\"",
                "robot:12:18: `origin.xyz` is 0, 0, 0.3, expected three numbers with blanks between them -> write a decimal point, and blanks between numbers",
            ),
            (
                "rpy=\"0 0 0\"",
                "rpy=\"0 0 ${pi}\"",
                "robot:12:32: `origin.rpy` is 0 0 ${pi}, expected three numbers with blanks between them -> expand the macros first (xacro)",
            ),
            (
                "rpy=\"0 0 0\"",
                "rpy=\"0 0 nan\"",
                "robot:12:32: `origin.rpy` is 0 0 nan, expected three numbers with blanks between them",
            ),
            (
                "rpy=\"0 0 0\"",
                "quat_xyzw=\"0 0 0 1\"",
                "robot:12:38: `origin.quat_xyzw` is 0 0 0 1, expected the rotation as rpy=\"roll pitch yaw\" in radians",
            ),
            (
                "xyz=\"0 0 0.3\"",
                "xyz=\"0 0 1e31\"",
                "robot:12:18: `origin.xyz` is 0 0 1e31, expected numbers of at most 1e30 in size",
            ),
            (
                "<axis xyz=\"0 1 0\"/>",
                "<axis xyz=\"0 0 0\"/>",
                "robot:13:16: `axis.xyz` is 0 0 0, expected a direction",
            ),
            (
                "<axis xyz=\"0 1 0\"/>",
                "<axis xyz=\"z\"/>",
                "robot:13:16: `axis.xyz` is z, expected three numbers with blanks between them",
            ),
            ("lower=\"-2.5\"", "lower=\"low\"", "robot:14:19: `limit.lower` is low, expected a number"),
            (
                "lower=\"-2.5\"",
                "lower=\"2.6\"",
                "robot:14:19: `limit.lower` is 2.6, expected lower <= upper; these are 2.6 and 2.5",
            ),
        ],
    );
}

#[test]
fn a_mistake_in_a_link_is_named() {
    check(
        URDF,
        &[
            (
                "<link name=\"camera\"/>",
                "<link/>",
                "robot:8:3: <link> has no name, expected a name for each link",
            ),
            (
                "<link name=\"camera\"/>",
                "<link name=\"tip_link\"/>",
                "robot:8:15: `link.name` is tip_link, expected a name of its own for each link",
            ),
            (
                "<mass value=\"2.5\"/>",
                "",
                "robot:5:5: <inertial> has no <mass>, expected <mass value=\"…\"/> in kg",
            ),
            (
                "<mass value=\"2.5\"/>",
                "<mass/>",
                "robot:5:38: <mass> has no value, expected a mass >= 0 in kg",
            ),
            ("value=\"2.5\"", "value=\"-1\"", "robot:5:51: `mass.value` is -1, expected a mass >= 0 in kg"),
            (
                "value=\"2.5\"",
                "value=\"2,5\"",
                "robot:5:51: `mass.value` is 2,5, expected a number -> write a decimal point, and blanks between numbers",
            ),
            (
                "<origin xyz=\"0 0 0.1\"/>",
                "<origin xyz=\"0 0 z\"/>",
                "robot:5:28: `origin.xyz` is 0 0 z, expected three numbers with blanks between them",
            ),
        ],
    );
}

#[test]
fn links_that_are_no_tree_are_named() {
    check(
        URDF,
        &[
            (
                "<child link=\"camera\"/>",
                "<child link=\"tip_link\"/>",
                "robot:21:3: link `tip_link` is the child of joint `mount` too, expected one joint for each link to hang on; it hangs on `hand`",
            ),
            (
                "<parent link=\"base_link\"/>",
                "<parent link=\"tip_link\"/>",
                "robot:4:3: link `upper_arm` hangs on itself by a circle of joints, expected a tree of links",
            ),
            (
                "<child link=\"upper_arm\"/>",
                "<child link=\"base_link\"/>",
                "robot:3:3: link `base_link` hangs on itself by a circle of joints, expected a tree of links",
            ),
            (
                "<parent link=\"upper_arm\"/>",
                "<parent link=\"camera\"/>",
                "robot:7:3: no joint moves `tip_link` against `base_link`, expected a revolute, continuous or prismatic joint between base_link and tip_link",
            ),
        ],
    );
}

#[test]
fn links_that_are_not_there_are_named() {
    for (base, tip, expected) in [
        (
            Some("baselink"),
            None,
            "robot: there is no link `baselink`, expected base_link to be one of the links base_link, upper_arm, tip_link, camera -> did you mean base_link?",
        ),
        (
            None,
            Some("flange"),
            "robot: there is no link `flange`, expected tip_link to be one of the links base_link, upper_arm, tip_link, camera",
        ),
        (
            Some("tip_link"),
            Some("base_link"),
            "robot:3:3: link `base_link` does not hang on `tip_link`, expected a tip_link that hangs on other links -> it is the other way round: exchange base_link and tip_link",
        ),
        (
            Some("camera"),
            Some("tip_link"),
            "robot:7:3: link `tip_link` does not hang on `camera`, expected a base_link that it hangs on: upper_arm, base_link",
        ),
        (
            Some("tip_link"),
            None,
            "robot:7:3: no joint moves `tip_link` against `tip_link`, expected a revolute, continuous or prismatic joint between base_link and tip_link",
        ),
    ] {
        let error = Robot::from_text("robot", URDF, base, tip).expect_err(expected);
        assert_eq!(in_words(&error), expected);
    }
    // many names are cut to those at both ends
    let links: String = (0..40).map(|i| format!("<link name=\"l{i}\"/>")).collect();
    let error =
        Robot::from_text("robot", &format!("<robot>{links}</robot>"), None, None).expect_err("no base_link");
    assert!(
        error.to_string().ends_with("the links l0, l1, l2, l3, l4, l5, …, l34, l35, l36, l37, l38, l39"),
        "{error}"
    );
}

/// Every element inherits the namespaces above it: 200 nested ones with 60 each took 59 s.
#[test]
fn a_document_has_few_namespaces() {
    let open: String = (0..200)
        .map(|depth| {
            let own: String = (0..60).map(|k| format!(" xmlns:a{depth}_{k}=\"u{depth}_{k}\"")).collect();
            format!("<a{own}>")
        })
        .collect();
    let text = format!("<robot name=\"r\">{open}{}</robot>", "</a>".repeat(200));
    let error = Robot::from_text("robot", &text, None, None).expect_err("12 000 namespaces");
    assert!(
        in_words(&error).starts_with("robot: it has 12000 namespaces, expected at most 100"),
        "{}",
        in_words(&error)
    );
}
