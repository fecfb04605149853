//! The numbers of a robot that a calibration can change, by name and unit.

use std::fmt;

use crate::units::{DEG, MM, URAD_PER_NM};

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
    BasePosition(usize),
    /// Turn of {0} away from its first guess: rotation vector along x, y, z (0, 1, 2) of {W}, rad.
    /// Unlike roll, pitch and yaw it is regular for a robot on a wall too.
    BaseRotation(usize),
    /// θ of a joint's link, rad.
    Theta(usize),
    /// d, m.
    D(usize),
    /// a, m.
    A(usize),
    /// α, rad.
    Alpha(usize),
    /// β, rad.
    Beta(usize),
    /// Compliance c of a joint, rad/(N·m).
    Compliance(usize),
    /// Tip in {T} along x, y, z (0, 1, 2), m.
    Tool(usize),
}

/// The unit a parameter is shown in.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Unit {
    /// As people write it.
    pub symbol: &'static str,
    /// As keys end.
    pub suffix: &'static str,
    /// In SI.
    pub si: f64,
}

const MILLIMETRE: Unit = Unit { symbol: "mm", suffix: "mm", si: MM };
const DEGREE: Unit = Unit { symbol: "°", suffix: "deg", si: DEG };
const COMPLIANCE: Unit = Unit { symbol: "µrad/(N·m)", suffix: "urad_per_nm", si: URAD_PER_NM };

impl Parameter {
    /// True where it says where the robot stands or where its tip is, not how the robot is built.
    pub fn is_placement(&self) -> bool {
        matches!(self, Parameter::BasePosition(_) | Parameter::BaseRotation(_) | Parameter::Tool(_))
    }

    /// All parameters of a robot with `joints` joints, base to tip.
    pub fn all(joints: usize) -> Vec<Parameter> {
        let mut all: Vec<Parameter> = (0..3).map(Parameter::BasePosition).collect();
        all.extend((0..3).map(Parameter::BaseRotation));
        let link_parameters = [
            Parameter::A,
            Parameter::Alpha,
            Parameter::Theta,
            Parameter::D,
            Parameter::Beta,
            Parameter::Compliance,
        ];
        all.extend((0..joints).flat_map(|j| link_parameters.map(|kind| kind(j))));
        all.extend((0..3).map(Parameter::Tool));
        all
    }

    /// The unit it is shown in; inside it is SI.
    pub fn unit(self) -> Unit {
        match self {
            Parameter::BasePosition(_) | Parameter::D(_) | Parameter::A(_) | Parameter::Tool(_) => MILLIMETRE,
            Parameter::Compliance(_) => COMPLIANCE,
            Parameter::BaseRotation(_) | Parameter::Theta(_) | Parameter::Alpha(_) | Parameter::Beta(_) => {
                DEGREE
            }
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
        for parameter in all {
            assert_eq!(Parameter::from_key(&parameter.key(), 7), Some(parameter));
            assert_eq!(Parameter::from_key(&parameter.to_string(), 7), Some(parameter));
        }
        assert_eq!(Parameter::from_key("a8_mm", 7), None);
        assert_eq!(Parameter::Compliance(1).key(), "c2_urad_per_nm");
    }
}
