//! What laws of a robot change and are functions of, as people read it: for proposing them and for
//! knowing them again in files.

use crate::inference::law::Measure;
use crate::inference::{Location, Part};
use crate::robot::{JointLawVariable, LawPlace, Motion};
use crate::units::{UM, URAD};

/// Where a law of a robot's file is proposed.
pub fn location(place: LawPlace) -> Location {
    match place {
        LawPlace::Joint(joint) | LawPlace::Axis(joint) => Location::Joint { joint, form: None },
        LawPlace::Link(_) => Location::key(place.to_string()),
        LawPlace::Tool => Location::Part(Part::Tool),
    }
}

/// What it changes there, multiplied by the value of `per_joint` where there is one.
pub fn changes(place: LawPlace, per_joint: Option<usize>, motions: &[Motion]) -> Measure {
    let measure = |symbol, name: String, unit, si| Measure { symbol, name, unit, si };
    match (place, per_joint) {
        (LawPlace::Joint(_), Some(_)) => measure("Δq/q'", place.changes(per_joint), "µrad/rad", URAD),
        (LawPlace::Joint(joint), None) => match motions[joint] {
            Motion::Revolute => measure("Δq", JointLawVariable::Angle(joint).to_string(), "µrad", URAD),
            Motion::Prismatic => measure("Δq", JointLawVariable::Position(joint).to_string(), "µm", UM),
        },
        (LawPlace::Link(_), _) => measure("Δφ/q'", place.changes(per_joint), "µrad/rad", URAD),
        (LawPlace::Axis(_) | LawPlace::Tool, _) => measure("Δx", place.changes(per_joint), "µm", UM),
    }
}

/// What it is a function of.
pub fn variable(variable: JointLawVariable) -> Measure {
    let (unit, si) = variable.unit();
    Measure { symbol: variable.symbol(), name: variable.to_string(), unit, si }
}
