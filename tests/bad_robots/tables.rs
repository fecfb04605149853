//! Mistakes in tables, and the message that each gets.

use rodcal::robot::Robot;

use super::{TABLE, check, in_words};

#[test]
fn a_mistake_in_a_table_is_named() {
    check(
        TABLE,
        &[
            (
                "\"hayati\"",
                "\"craig\"",
                "robot:2:14: `convention` is \"craig\", expected \"hayati\", Rz(θ+offset)·Tz(d)·Tx(a)·Rx(α)·Ry(β); with beta_deg = 0 that is standard DH",
            ),
            (
                "gravity_m_s2 = [0.0, 0.0, -9.80665]",
                "gravity_m_s2 = [0.0, -9.80665]",
                "robot:3:16: `gravity_m_s2` is [0.0, -9.80665], expected three numbers [x, y, z] in m/s² in the robot's base frame",
            ),
            (
                "gravity_m_s2 = [0.0, 0.0, -9.80665]",
                "gravity_m_s2 = -9.80665",
                "robot:3:16: `gravity_m_s2` is -9.80665, expected a list in brackets",
            ),
            (
                "gravity_m_s2 = [0.0, 0.0, -9.80665]",
                "gravity_m_s2 = [0, 0, inf]",
                "robot:3:23: `gravity_m_s2` is inf, expected a finite number",
            ),
            (
                "gravity_m_s2",
                "gravity_ms2",
                "robot:3:1: unknown key `gravity_ms2`, expected one of name, source, convention, gravity_m_s2, joint, tip, standard_uncertainty, uncertainty, calibrated, effect, law -> did you mean gravity_m_s2?",
            ),
            ("[[joint]]", "[joint]", "robot:15:3: a second section [joint], expected every section once"),
            (
                "[[joint]]",
                "[[joints]]",
                "robot:5:3: unknown section [joints], expected one of name, source, convention, gravity_m_s2, joint, tip, standard_uncertainty, uncertainty, calibrated, effect, law -> did you mean [joint]?",
            ),
            (
                "name = \"arm\"",
                "[effects]\nname = 1",
                "robot:1:2: unknown section [effects], expected one of name, source, convention, gravity_m_s2, joint, tip, standard_uncertainty, uncertainty, calibrated, effect, law -> did you mean [effect]?",
            ),
            (
                "d_mm = 150.0",
                "",
                "robot:5:1: there is no d_mm in [[joint]], expected the offset along the joint's axis in mm",
            ),
            (
                "a_mm = 50.0",
                "",
                "robot:5:1: there is no a_mm in [[joint]], expected the length of the link in mm",
            ),
            (
                "alpha_deg = 90.0",
                "",
                "robot:5:1: there is no alpha_deg in [[joint]], expected the twist of the link in degrees",
            ),
            (
                "alpha_deg = 90.0",
                "alpha = 90.0",
                "robot:9:1: unknown key `alpha`, expected one of name, type, theta_offset_deg, d_mm, a_mm, alpha_deg, beta_deg, compliance_urad_per_nm, mass_kg, com_mm, limits_deg, limits_mm -> did you mean alpha_deg?",
            ),
            (
                "d_mm = 150.0",
                "d_mm = 150 mm",
                "robot:7:8: `joint.d_mm` is 150 mm, expected a number -> write the number alone; its unit stands in the name of the key",
            ),
            ("d_mm = 150.0", "d_mm = nan", "robot:7:8: `joint.d_mm` is nan, expected a finite number"),
            (
                "d_mm = 150.0",
                "d_mm = 1e31",
                "robot:7:8: `joint.d_mm` is 1e31, expected a number of at most 1e30 in size",
            ),
            (
                "d_mm = 150.0",
                "d_mm = 150.0\nd_mm = 1",
                "robot:8:1: a second `d_mm`, expected every key once in its section",
            ),
            (
                "theta_offset_deg = 0.0",
                "theta_offset_deg = \"0\"",
                "robot:6:20: `joint.theta_offset_deg` is \"0\", expected a number -> write 0.0",
            ),
            (
                "mass_kg = 28.0",
                "mass_kg = -28.0",
                "robot:11:11: `joint.mass_kg` is -28.0, expected a number >= 0",
            ),
            (
                "mass_kg = 28.0",
                "",
                "robot:12:10: `joint.com_mm` is [0.0, 0.0, 1.0], expected a mass_kg in the same [[joint]], or no com_mm",
            ),
            (
                "com_mm = [0.0, 0.0, 1.0]",
                "com_mm = [0.0, 0.0, 1.0, 1.0]",
                "robot:12:10: `joint.com_mm` is [0.0, 0.0, 1.0, 1.0], expected three numbers [x, y, z] in mm in the joint's distal frame",
            ),
            (
                "limits_deg = [-180.0, 180.0]",
                "limits_deg = [180.0, -180.0]",
                "robot:13:14: `joint.limits_deg` is [180.0, -180.0], expected two numbers [lower, upper], the lower one first",
            ),
            (
                "limits_deg = [-180.0, 180.0]",
                "limits_deg = [180.0]",
                "robot:13:14: `joint.limits_deg` is [180.0], expected two numbers [lower, upper], the lower one first",
            ),
            (
                "limits_deg = [-180.0, 180.0]",
                "limits_mm = [-180.0, 180.0]",
                "robot:13:13: `joint.limits_mm` is [-180.0, 180.0], expected limits_deg: a revolute joint turns in degrees",
            ),
            (
                "limits_mm = [0.0, 100.0]",
                "limits_deg = [0.0, 100.0]",
                "robot:20:14: `joint.limits_deg` is [0.0, 100.0], expected limits_mm: a prismatic joint moves in mm",
            ),
            (
                "limits_mm = [0.0, 100.0]",
                "compliance_urad_per_nm = 1",
                "robot:20:26: `joint.compliance_urad_per_nm` is 1, expected no compliance: a prismatic joint does not turn",
            ),
            (
                "type = \"prismatic\"",
                "type = \"fixed\"",
                "robot:16:8: `joint.type` is \"fixed\", expected \"revolute\" or \"prismatic\"",
            ),
            (
                "type = \"prismatic\"",
                "type = prismatic",
                "robot:16:8: `joint.type` is prismatic, expected a number, or a text in quotes",
            ),
            ("name = \"arm\"", "name = 5", "robot:1:8: `name` is 5, expected a text in quotes"),
        ],
    );
}

#[test]
fn a_table_without_joints_is_none() {
    for (text, expected) in [
        (
            "",
            "robot: the file is empty, expected a section [[joint]] with d_mm, a_mm, alpha_deg for each joint, base to flange",
        ),
        (
            "name = \"arm\"",
            "robot: there is no [joint], expected a section [[joint]] with d_mm, a_mm, alpha_deg for each joint, base to flange",
        ),
        (
            "joint = []",
            "robot:1:9: the robot has no joint, expected a section [[joint]] with d_mm, a_mm, alpha_deg for each joint, base to flange",
        ),
        (
            "pose,q1_deg\n1,2",
            "robot:1:5: the line `pose,q1_deg`, expected key = value, or a [section] -> is this a table of readings (CSV)?",
        ),
    ] {
        let error = Robot::from_text("robot", text, None, None).expect_err(text);
        assert_eq!(in_words(&error), expected);
    }
}
