//! Robots of many kinds.

use rodcal::robot::Robot;

pub const UR5: &str = r#"
name = "UR5"
[[joint]]
d_mm = 89.159
a_mm = 0
alpha_deg = 90
[[joint]]
d_mm = 0
a_mm = -425
alpha_deg = 0
[[joint]]
d_mm = 0
a_mm = -392.25
alpha_deg = 0
[[joint]]
d_mm = 109.15
a_mm = 0
alpha_deg = 90
[[joint]]
d_mm = 94.65
a_mm = 0
alpha_deg = -90
[[joint]]
d_mm = 82.3
a_mm = 0
alpha_deg = 0
"#;

/// Three parallel axes and a quill.
pub const SCARA: &str = r#"
name = "SCARA"
[[joint]]
d_mm = 300
a_mm = 350
alpha_deg = 0
limits_deg = [-150, 150]
[[joint]]
d_mm = 0
a_mm = 300
alpha_deg = 0
limits_deg = [-150, 150]
[[joint]]
d_mm = 0
a_mm = 0
alpha_deg = 180
[[joint]]
type = "prismatic"
d_mm = 0
a_mm = 0
alpha_deg = 0
limits_mm = [0, 400]
"#;

/// Seven joints with the lengths of a KUKA LBR iiwa 14, and round masses.
pub const SEVEN: &str = r#"<?xml version="1.0"?>
<robot name="seven">
  <link name="base_link"/>
  <link name="link_1"><inertial><origin xyz="0 -0.03 0.12"/><mass value="4"/><inertia ixx="1" ixy="0" ixz="0" iyy="1" iyz="0" izz="1"/></inertial></link>
  <link name="link_2"><inertial><origin xyz="0 0.06 0.04"/><mass value="4"/><inertia ixx="1" ixy="0" ixz="0" iyy="1" iyz="0" izz="1"/></inertial></link>
  <link name="link_3"><inertial><origin xyz="0 0.03 0.13"/><mass value="3"/><inertia ixx="1" ixy="0" ixz="0" iyy="1" iyz="0" izz="1"/></inertial></link>
  <link name="link_4"><inertial><origin xyz="0 0.07 0.03"/><mass value="2.7"/><inertia ixx="1" ixy="0" ixz="0" iyy="1" iyz="0" izz="1"/></inertial></link>
  <link name="link_5"><inertial><origin xyz="0 0.02 0.08"/><mass value="1.7"/><inertia ixx="1" ixy="0" ixz="0" iyy="1" iyz="0" izz="1"/></inertial></link>
  <link name="link_6"><inertial><origin xyz="0 0 0"/><mass value="1.8"/><inertia ixx="1" ixy="0" ixz="0" iyy="1" iyz="0" izz="1"/></inertial></link>
  <link name="link_7"/>
  <link name="tip_link"/>
  <joint name="a1" type="revolute"><parent link="base_link"/><child link="link_1"/><origin xyz="0 0 0.1575" rpy="0 0 0"/><axis xyz="0 0 1"/><limit lower="-2.9" upper="2.9" effort="1" velocity="1"/></joint>
  <joint name="a2" type="revolute"><parent link="link_1"/><child link="link_2"/><origin xyz="0 0 0.2025" rpy="1.5707963267948966 0 3.141592653589793"/><axis xyz="0 0 1"/><limit lower="-2" upper="2" effort="1" velocity="1"/></joint>
  <joint name="a3" type="revolute"><parent link="link_2"/><child link="link_3"/><origin xyz="0 0.2045 0" rpy="1.5707963267948966 0 3.141592653589793"/><axis xyz="0 0 1"/><limit lower="-2.9" upper="2.9" effort="1" velocity="1"/></joint>
  <joint name="a4" type="revolute"><parent link="link_3"/><child link="link_4"/><origin xyz="0 0 0.2155" rpy="1.5707963267948966 0 0"/><axis xyz="0 0 1"/><limit lower="-2" upper="2" effort="1" velocity="1"/></joint>
  <joint name="a5" type="revolute"><parent link="link_4"/><child link="link_5"/><origin xyz="0 0.1845 0" rpy="-1.5707963267948966 3.141592653589793 0"/><axis xyz="0 0 1"/><limit lower="-2.9" upper="2.9" effort="1" velocity="1"/></joint>
  <joint name="a6" type="revolute"><parent link="link_5"/><child link="link_6"/><origin xyz="0 0 0.2155" rpy="1.5707963267948966 0 0"/><axis xyz="0 0 1"/><limit lower="-2" upper="2" effort="1" velocity="1"/></joint>
  <joint name="a7" type="revolute"><parent link="link_6"/><child link="link_7"/><origin xyz="0 0.081 0" rpy="-1.5707963267948966 3.141592653589793 0"/><axis xyz="0 0 1"/><limit lower="-3" upper="3" effort="1" velocity="1"/></joint>
  <joint name="ball" type="fixed"><parent link="link_7"/><child link="tip_link"/><origin xyz="0.09 0.03 0.12" rpy="0.2 0.1 0.3"/></joint>
</robot>
"#;

pub fn robot(text: &str) -> Robot {
    Robot::from_text("robot", text, None, None).unwrap_or_else(|error| panic!("{error}"))
}

/// A text of the [`SEVEN`] without masses.
pub fn weightless(urdf: &str) -> String {
    let of_line = |line: &str| match (line.find("<inertial>"), line.find("</inertial>")) {
        (Some(from), Some(to)) => format!("{}{}\n", &line[..from], &line[to + "</inertial>".len()..]),
        _ => format!("{line}\n"),
    };
    urdf.lines().map(of_line).collect()
}

pub fn tx90() -> (&'static str, Robot) {
    let (_, text) = Robot::builtin("tx90").unwrap();
    (text, robot(text))
}
