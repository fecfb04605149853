//! The numbers of a robot that a calibration can change, by name and unit.

use std::fmt;

use crate::units::Unit;

/// How often a robot has a parameter of a kind.
#[derive(Clone, Copy, PartialEq, Eq)]
enum Each {
    /// Once along x, y and z of {0} in {W}.
    BaseAxis,
    /// Once for each joint.
    Joint,
    /// Once along x, y and z of {T}.
    ToolAxis,
}

/// Declares [`Parameter`] together with the list of its kinds, so that none can be missing there.
macro_rules! parameters {
    ($(#[$of_type:meta])* pub enum Parameter { $($(#[$of_kind:meta])* $kind:ident($each:ident),)* }) => {
        $(#[$of_type])*
        pub enum Parameter {
            $($(#[$of_kind])* $kind(usize),)*
        }

        /// All kinds in the order of [`Parameter::all`].
        const KINDS: &[(Each, fn(usize) -> Parameter)] = &[$((Each::$each, Parameter::$kind),)*];
    };
}

parameters! {
    /// One number of the chain {W} → {0} → joints → {T} → tip. Joints count from 0 here, from 1 in
    /// names.
    ///
    /// ```
    /// use rodcal::robot::Parameter;
    ///
    /// let parameter = Parameter::from_key("c2_urad_per_nm", 6).expect("a joint of a robot with six");
    /// assert_eq!((parameter, parameter.to_string().as_str()), (Parameter::Compliance(1), "c2"));
    /// assert_eq!(parameter.unit().si, 1e-6);
    /// ```
    #[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, PartialOrd, Ord)]
    pub enum Parameter {
        /// Position of {0} in {W} along x, y, z (0, 1, 2), m.
        BasePosition(BaseAxis),
        /// Turn of {0} away from its first guess: rotation vector along x, y, z (0, 1, 2) of {W},
        /// rad. Unlike roll, pitch and yaw it is regular for a robot on a wall too.
        BaseRotation(BaseAxis),
        /// a of a joint's link, m.
        A(Joint),
        /// α, rad.
        Alpha(Joint),
        /// θ, rad.
        Theta(Joint),
        /// d, m.
        D(Joint),
        /// β, rad.
        Beta(Joint),
        /// Compliance c of a joint, rad/(N·m).
        Compliance(Joint),
        /// Tip in {T} along x, y, z (0, 1, 2), m.
        Tool(ToolAxis),
    }
}

/// What a parameter is a number of.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum ParameterGroup {
    /// Where {0} is in {W}.
    BasePosition,
    /// How {0} is turned in {W}.
    BaseRotation,
    /// Length of a link: a, d.
    LinkLength,
    /// Twist of a link: α, β.
    LinkTwist,
    /// Zero of a joint: θ.
    JointZero,
    /// Compliance of a joint: c.
    Compliance,
    /// Where the tip is in {T}.
    Tool,
}

impl Parameter {
    /// For people: `base x`, `theta2`, `tool z`.
    pub fn description(&self) -> String {
        self.to_string().replace('_', " ")
    }

    /// What it is a number of.
    ///
    /// ```
    /// use rodcal::robot::{Parameter, ParameterGroup};
    ///
    /// let lengths = Parameter::all(6).into_iter().filter(|p| p.group() == ParameterGroup::LinkLength);
    /// assert_eq!(lengths.count(), 12); // a and d of six links
    /// ```
    pub fn group(self) -> ParameterGroup {
        match self {
            Parameter::BasePosition(_) => ParameterGroup::BasePosition,
            Parameter::BaseRotation(_) => ParameterGroup::BaseRotation,
            Parameter::D(_) | Parameter::A(_) => ParameterGroup::LinkLength,
            Parameter::Alpha(_) | Parameter::Beta(_) => ParameterGroup::LinkTwist,
            Parameter::Theta(_) => ParameterGroup::JointZero,
            Parameter::Compliance(_) => ParameterGroup::Compliance,
            Parameter::Tool(_) => ParameterGroup::Tool,
        }
    }

    /// The joint, from 0, whose compliance it is.
    pub fn compliant_joint(self) -> Option<usize> {
        match self {
            Parameter::Compliance(joint) => Some(joint),
            Parameter::BasePosition(_)
            | Parameter::BaseRotation(_)
            | Parameter::A(_)
            | Parameter::Alpha(_)
            | Parameter::Theta(_)
            | Parameter::D(_)
            | Parameter::Beta(_)
            | Parameter::Tool(_) => None,
        }
    }

    /// True where it says where the robot stands.
    pub fn is_base(self) -> bool {
        match self.group() {
            ParameterGroup::BasePosition | ParameterGroup::BaseRotation => true,
            ParameterGroup::LinkLength
            | ParameterGroup::LinkTwist
            | ParameterGroup::JointZero
            | ParameterGroup::Compliance
            | ParameterGroup::Tool => false,
        }
    }

    /// True where it says where the robot stands or where its tip is, not how the robot is built.
    pub fn is_placement(self) -> bool {
        self.is_base() || self.group() == ParameterGroup::Tool
    }

    /// All parameters of a robot with `joints` joints, base to tip.
    pub fn all(joints: usize) -> Vec<Parameter> {
        let along_axes = |each: Each| {
            let kinds = KINDS.iter().filter(move |kind| kind.0 == each);
            kinds.flat_map(|(_, parameter)| (0..3).map(parameter))
        };
        let of_joints = (0..joints).flat_map(|joint| {
            let kinds = KINDS.iter().filter(|kind| kind.0 == Each::Joint);
            kinds.map(move |(_, parameter)| parameter(joint))
        });
        along_axes(Each::BaseAxis).chain(of_joints).chain(along_axes(Each::ToolAxis)).collect()
    }

    /// The unit it is shown in; inside it is SI.
    pub fn unit(self) -> Unit {
        match self.group() {
            ParameterGroup::BasePosition | ParameterGroup::LinkLength | ParameterGroup::Tool => {
                Unit::of_key("mm")
            }
            ParameterGroup::BaseRotation | ParameterGroup::LinkTwist | ParameterGroup::JointZero => {
                Unit::of_key("deg")
            }
            ParameterGroup::Compliance => Unit::of_key("urad_per_nm"),
        }
    }

    /// The name with its unit, as in files: `a2_mm`, `tool_x_mm`, `c3_urad_per_nm`.
    pub fn key(self) -> String {
        format!("{self}_{}", self.unit().suffix)
    }

    /// The parameter of a key or of a bare name, for a robot with `joints` joints.
    pub fn from_key(key: &str, joints: usize) -> Option<Parameter> {
        Parameter::all(joints).into_iter().find(|p| p.key() == key || p.to_string() == key)
    }
}

impl fmt::Display for Parameter {
    /// `base_x`, `base_rz`, `theta2`, `d2`, `a2`, `alpha2`, `beta2`, `c2`, `tool_z`.
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        const AXES: [&str; 3] = ["x", "y", "z"];
        match *self {
            Parameter::BasePosition(axis) => write!(f, "base_{}", AXES[axis]),
            Parameter::BaseRotation(axis) => write!(f, "base_r{}", AXES[axis]),
            Parameter::Theta(j) => write!(f, "theta{}", j + 1),
            Parameter::D(j) => write!(f, "d{}", j + 1),
            Parameter::A(j) => write!(f, "a{}", j + 1),
            Parameter::Alpha(j) => write!(f, "alpha{}", j + 1),
            Parameter::Beta(j) => write!(f, "beta{}", j + 1),
            Parameter::Compliance(j) => write!(f, "c{}", j + 1),
            Parameter::Tool(axis) => write!(f, "tool_{}", AXES[axis]),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_name_leads_back_to_its_parameter() {
        let all = Parameter::all(7);
        assert_eq!(all.len(), 6 + 7 * 6 + 3);
        let second: Vec<String> = all[12..18].iter().map(Parameter::to_string).collect();
        assert_eq!(second, ["a2", "alpha2", "theta2", "d2", "beta2", "c2"]);
        for parameter in all {
            assert_eq!(Parameter::from_key(&parameter.key(), 7), Some(parameter));
            assert_eq!(Parameter::from_key(&parameter.to_string(), 7), Some(parameter));
        }
        assert_eq!(Parameter::from_key("a8_mm", 7), None);
        assert_eq!(Parameter::Compliance(1).key(), "c2_urad_per_nm");
    }
}
