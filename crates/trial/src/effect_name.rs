//! Every effect and mistake that a trial conceals, or compares with what it conceals, by its name.
//!
//! Names stand here and nowhere else in this crate: in a key, and in the JSON of a diagnosis, which
//! has the same ones. What a lab calls an effect of its own is [`EffectName::Other`].

use std::cmp::Ordering;
use std::fmt;

use serde::{Deserialize, Serialize, Serializer};

/// Declares each effect once, with its name.
macro_rules! effects {
    ($($variant:ident = $name:literal,)*) => {
        /// What an effect or a mistake is called; ordered as its text is.
        #[derive(Debug, Clone, PartialEq, Eq, Deserialize)]
        #[serde(from = "String")]
        #[allow(missing_docs, reason = "the names say what they are")]
        pub enum EffectName {
            $($variant,)*
            /// A name that no trial conceals.
            Other(String),
        }

        impl EffectName {
            /// All that a trial knows.
            pub const ALL: &[EffectName] = &[$(EffectName::$variant,)*];

            /// As it stands in files.
            pub fn as_str(&self) -> &str {
                match self {
                    $(EffectName::$variant => $name,)*
                    EffectName::Other(name) => name,
                }
            }
        }
    };
}

effects! {
    // of rods at a rig
    BendFlexibility = "bend_flexibility",
    Creep = "creep",
    Friction = "friction",
    Hysteresis = "hysteresis",
    LoadMisalignment = "load_misalignment",
    LoadOffset = "load_offset",
    LoadPoint = "load_point",
    NonlinearStiffness = "nonlinear_stiffness",
    PipeStiffness = "pipe_stiffness",
    RodDimension = "rod_dimension",
    RootCompliance = "root_compliance",
    SensorMisalignment = "sensor_misalignment",
    SensorPoint = "sensor_point",
    ShearModulus = "shear_modulus",
    Slip = "slip",
    StiffnessScale = "stiffness_scale",
    // of both
    Backlash = "backlash",
    JointCompliance = "joint_compliance",
    Outlier = "outlier",
    SensorScale = "sensor_scale",
    ThermalDrift = "thermal_drift",
    // of calibrations
    BaseShift = "base_shift",
    ClampPose = "clamp_pose",
    ClampShift = "clamp_shift",
    ContactForceVariation = "contact_force_variation",
    ContactSpring = "contact_spring",
    EncoderScale = "encoder_scale",
    GravityDirection = "gravity_direction",
    GravityTilt = "gravity_tilt",
    JointFriction = "joint_friction",
    JointNonlinearStiffness = "joint_nonlinear_stiffness",
    JointShift = "joint_shift",
    PayloadMass = "payload_mass",
    ReadbackLag = "readback_lag",
    RodMass = "rod_mass",
    RodStiffness = "rod_stiffness",
    SocketShift = "socket_shift",
    TipMass = "tip_mass",
    ToolShift = "tool_shift",
    TransmissionError = "transmission_error",
    WristCoupling = "wrist_coupling",
    // mistakes of whoever writes things down
    CopyMistake = "copy_mistake",
    DistanceMistake = "distance_mistake",
    FrameMistake = "frame_mistake",
    OffsetMistake = "offset_mistake",
    RodMistake = "rod_mistake",
    RowMistake = "row_mistake",
    SaturatedSensor = "saturated_sensor",
    SignMistake = "sign_mistake",
    StuckSensor = "stuck_sensor",
    SwapMistake = "swap_mistake",
    TypingMistake = "typing_mistake",
    UnitMistake = "unit_mistake",
    // physics that no library has, of rods at a rig
    ClampLooseOneWay = "clamp loose one way",
    DampedSlide = "damped slide",
    GapThatCloses = "a gap that closes",
    HertzianSeat = "Hertzian seat",
    LoadHistory = "memory of the load before",
    OscillationInTime = "oscillation in time",
    RunningIn = "running in",
    SensorRipple = "sensor ripple",
    SensorSaturation = "sensor saturation",
    SlippingClamp = "clamp that slips little by little",
    SpeedOfLoading = "speed of loading",
    VaryingWall = "wall that varies along the rod",
    WearingFriction = "friction that wears",
    // and of calibrations
    BallOutOfRound = "ball out of round",
    LinkTorsion = "link twists with two joints",
    LooseTool = "tool loose in its mount",
    MoveHistory = "memory of the move before",
    PeriodicDisturbance = "periodic disturbance",
    Refraction = "refraction",
    WobblingBearing = "bearing that wobbles",
    WornTooth = "worn tooth",
}

impl From<&str> for EffectName {
    fn from(name: &str) -> EffectName {
        let known = EffectName::ALL.iter().find(|known| known.as_str() == name);
        known.cloned().unwrap_or_else(|| EffectName::Other(name.to_owned()))
    }
}

impl From<String> for EffectName {
    fn from(name: String) -> EffectName {
        EffectName::from(name.as_str())
    }
}

impl fmt::Display for EffectName {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.pad(self.as_str())
    }
}

impl Ord for EffectName {
    fn cmp(&self, other: &EffectName) -> Ordering {
        self.as_str().cmp(other.as_str())
    }
}

impl PartialOrd for EffectName {
    fn partial_cmp(&self, other: &EffectName) -> Option<Ordering> {
        Some(self.cmp(other))
    }
}

impl Serialize for EffectName {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        serializer.serialize_str(self.as_str())
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_name_is_read_as_it_is_written_and_stands_once() {
        let mut all: Vec<&EffectName> = EffectName::ALL.iter().collect();
        for name in &all {
            let json = serde_json::to_string(name).unwrap();
            assert_eq!(serde_json::from_str::<EffectName>(&json).unwrap(), **name);
        }
        assert_eq!(EffectName::from("of our own"), EffectName::Other("of our own".into()));
        all.sort();
        all.dedup_by_key(|name| name.as_str());
        assert_eq!(all.len(), EffectName::ALL.len());
    }
}
