//! Where laws of a rod's file act.

use std::fmt;

use crate::spatial::Axis;

/// Where a law acts.
#[derive(Debug, Clone, PartialEq, Eq)]
#[non_exhaustive]
pub enum RodLawPlace {
    /// The rod as a whole.
    Rod,
    /// The clamp of the load.
    Clamp,
    /// The rod's root, at the flange.
    Root,
    /// The bend between the pipes, in its middle.
    Bend,
    /// The slide that guides the load.
    Slide,
    /// The sensor of an axis: `dy`.
    Sensor(Axis),
    /// The joint of this name.
    Joint(String),
}

impl RodLawPlace {
    /// The places that every rod has; its joints are places too.
    pub const OF_EVERY_ROD: [RodLawPlace; 8] = [
        RodLawPlace::Rod,
        RodLawPlace::Clamp,
        RodLawPlace::Root,
        RodLawPlace::Bend,
        RodLawPlace::Slide,
        RodLawPlace::Sensor(Axis::X),
        RodLawPlace::Sensor(Axis::Y),
        RodLawPlace::Sensor(Axis::Z),
    ];

    /// The place that a file calls so: one that every rod has, or else the joint of this name.
    pub fn named(name: &str) -> RodLawPlace {
        let of_every_rod = RodLawPlace::OF_EVERY_ROD.into_iter().find(|place| place.to_string() == name);
        of_every_rod.unwrap_or_else(|| RodLawPlace::Joint(name.to_owned()))
    }

    /// What a law does there to the rod's tip is known wherever the rod is; what it does at clamp,
    /// slide and sensors stays with the rig.
    pub fn is_of_rod(&self) -> bool {
        match self {
            RodLawPlace::Rod | RodLawPlace::Root | RodLawPlace::Bend | RodLawPlace::Joint(_) => true,
            RodLawPlace::Clamp | RodLawPlace::Slide | RodLawPlace::Sensor(_) => false,
        }
    }

    /// In sentences: `the root`, `sleeve-a`.
    pub fn description(&self) -> String {
        match self {
            RodLawPlace::Rod
            | RodLawPlace::Clamp
            | RodLawPlace::Root
            | RodLawPlace::Bend
            | RodLawPlace::Slide => {
                format!("the {self}")
            }
            RodLawPlace::Sensor(_) | RodLawPlace::Joint(_) => self.to_string(),
        }
    }
}

/// As in files.
impl fmt::Display for RodLawPlace {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            RodLawPlace::Rod => f.write_str("rod"),
            RodLawPlace::Clamp => f.write_str("clamp"),
            RodLawPlace::Root => f.write_str("root"),
            RodLawPlace::Bend => f.write_str("bend"),
            RodLawPlace::Slide => f.write_str("slide"),
            RodLawPlace::Sensor(axis) => write!(f, "d{axis}"),
            RodLawPlace::Joint(name) => f.write_str(name),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_place_is_named_as_it_is_written() {
        for place in RodLawPlace::OF_EVERY_ROD {
            assert_eq!(RodLawPlace::named(&place.to_string()), place);
        }
        assert_eq!(RodLawPlace::named("sleeve"), RodLawPlace::Joint("sleeve".into()));
    }
}
