//! What may be wrong with a calibration, with its names and numbers as a diagnosis states them.

use nalgebra::Vector3;

use crate::effect_name::EffectName;
use rodcal_base::units::{DEG, GRAM, MM, UM, URAD, URAD_PER_NM};

/// Step of a numerical derivative, of the effect's size; of a phase, rad.
const STEP: f64 = 1e-4;
/// Which axis of a device shows something, of a displacement along which one.
const CROSS: [[&str; 3]; 3] =
    [["x_per_x", "x_per_y", "x_per_z"], ["y_per_x", "y_per_y", "y_per_z"], ["z_per_x", "z_per_y", "z_per_z"]];

/// Something that is wrong, SI; joints and rows from 0.
#[derive(Debug, Clone, PartialEq)]
pub enum Effect {
    /// An error of a gear over its own angle: cycles per revolution, amplitude rad, phase; the
    /// whole swells and fades by `beat` with so many cycles per revolution.
    Transmission { joint: usize, waves: Vec<[f64; 3]>, beat: Option<[f64; 2]> },
    /// Play, rad: the joint lies against its load, or where it came from.
    Backlash { joint: usize, play: f64, by_approach: bool },
    /// A drive that is compliant although the file knows no masses, rad/(N·m).
    Compliance { joint: usize, compliance: f64 },
    /// A drive that turns by k·τ·|τ| or k·τ³.
    Nonlinear { joint: usize, cubic: bool, per: f64 },
    /// What a joint turns by more than it shows, of that.
    EncoderScale { joint: usize, more: f64 },
    /// A joint that takes its neighbour along.
    Coupling { from: usize, to: usize, share: f64 },
    /// A clamp that is not where the file says, m and rad.
    ClampPose { group: usize, by: Vector3<f64>, turn: Vector3<f64> },
    /// A clamp or a socket that is displaced from a row on, m.
    Shift { group: usize, from: usize, by: Vector3<f64> },
    /// The base drifts: m/K, or m/s without a thermometer.
    Drift { by: Vector3<f64>, by_time: bool },
    /// A mass at the flange, kg.
    Payload(f64),
    /// A mass at the tip, kg.
    TipMass(f64),
    /// Angles that were read before the arm was there: share of the last move.
    Lag { joint: Option<usize>, share: f64 },
    /// What the rod deflects by more than its model, of that.
    Rod(f64),
    /// Rows that are wrong, m.
    Outlier(Vec<(usize, Vector3<f64>)>),
    /// The ball is displaced in {T} from a row on, m: the tool slipped in its mount.
    ToolShift { from: usize, by: Vector3<f64> },
    /// The robot on its base, or the tracker, is displaced from a row on: m, and rad about the
    /// base.
    BaseShift { from: usize, by: Vector3<f64>, turn: Vector3<f64> },
    /// The contact force changes with the displacement in a clamp, or in all, N/m.
    Spring { group: Option<usize>, rate: f64 },
    /// Sensors of a clamp's device, or of all, show along axis `shown` so much more of a
    /// displacement along axis `along`, of that: a scale where both are one axis, else cross-talk.
    Sensor { group: Option<usize>, shown: usize, along: usize, more: f64 },
    /// The contact force of a clamp, or of all, is larger by so much, N in its frame.
    Force { group: Option<usize>, by: Vector3<f64> },
    /// The base is not level: gravity is turned about its x and y, rad.
    Level([f64; 2]),
    /// The base tilts under the arm, rad/(N·m).
    BaseTilt(f64),
    /// A joint's zero that follows temperature or time, rad/K or rad/s.
    ZeroDrift { joint: usize, per: f64, by_time: bool },
    /// A joint whose zero is another one from a row on, rad.
    JointShift { joint: usize, from: usize, by: f64 },
    /// An arm all of whose links grow with temperature or time, 1/K or 1/s.
    Growth { per: f64, by_time: bool },
    /// A joint that stops apart, by its load and the way it came, rad/(N·m).
    Friction { joint: usize, per: f64 },
    // ---- physics that no library has ----
    /// A link that twists about its x with the product of two joint angles, rad/rad².
    LinkTorsion { link: usize, joints: [usize; 2], per: f64 },
    /// A ball that is out of round: radius ± so much with the direction in which it is touched, m.
    Ball(f64),
    /// A worn tooth: play in a window of the joint's angle (middle, width) and nowhere else, rad.
    Wear { joint: usize, window: [f64; 2], play: f64 },
    /// Something that comes and goes with time: m, period s, phase.
    Disturbance { by: Vector3<f64>, period: f64, phase: f64 },
    /// A beam of light that bends: up by so much times the distance squared, 1/m.
    Refraction(f64),
    /// A bearing that wobbles: the axis of a joint goes sideways twice per turn, m, phase.
    Runout { joint: usize, by: f64, phase: f64 },
    /// A tool that flops in its mount: along its x by the side to which gravity pulls it, m.
    LooseMount(f64),
    /// Angles that still show some of the move before the last one.
    MoveHistory(f64),
}

/// All numbers of vectors.
fn all<'a>(vectors: impl IntoIterator<Item = &'a mut Vector3<f64>>) -> Vec<&'a mut f64> {
    vectors.into_iter().flat_map(Vector3::iter_mut).collect()
}

impl Effect {
    /// The name of the effect; of those outside the library a name of the generator's own.
    pub fn name(&self, has_sockets: bool) -> EffectName {
        match self {
            Effect::Transmission { .. } => EffectName::TransmissionError,
            Effect::Backlash { .. } => EffectName::Backlash,
            Effect::Compliance { .. } => EffectName::JointCompliance,
            Effect::Nonlinear { .. } => EffectName::JointNonlinearStiffness,
            Effect::EncoderScale { .. } => EffectName::EncoderScale,
            Effect::Coupling { .. } => EffectName::WristCoupling,
            Effect::ClampPose { .. } => EffectName::ClampPose,
            Effect::Shift { .. } if has_sockets => EffectName::SocketShift,
            Effect::Shift { .. } => EffectName::ClampShift,
            Effect::Drift { .. } => EffectName::ThermalDrift,
            Effect::Payload(_) => EffectName::PayloadMass,
            Effect::TipMass(_) => EffectName::TipMass,
            Effect::Lag { .. } => EffectName::ReadbackLag,
            Effect::Rod(_) => EffectName::RodStiffness,
            Effect::Outlier(_) => EffectName::Outlier,
            Effect::ToolShift { .. } => EffectName::ToolShift,
            Effect::BaseShift { .. } => EffectName::BaseShift,
            Effect::Spring { .. } => EffectName::ContactSpring,
            Effect::Sensor { .. } => EffectName::SensorScale,
            Effect::Force { .. } => EffectName::ContactForceVariation,
            Effect::Level(_) => EffectName::GravityDirection,
            Effect::BaseTilt(_) => EffectName::GravityTilt,
            Effect::ZeroDrift { .. } => EffectName::ThermalDrift,
            Effect::JointShift { .. } => EffectName::JointShift,
            Effect::Growth { .. } => EffectName::ThermalDrift,
            Effect::Friction { .. } => EffectName::JointFriction,
            Effect::LinkTorsion { .. } => EffectName::LinkTorsion,
            Effect::Ball(_) => EffectName::BallOutOfRound,
            Effect::Wear { .. } => EffectName::WornTooth,
            Effect::Disturbance { .. } => EffectName::PeriodicDisturbance,
            Effect::Refraction(_) => EffectName::Refraction,
            Effect::Runout { .. } => EffectName::WobblingBearing,
            Effect::LooseMount(_) => EffectName::LooseTool,
            Effect::MoveHistory(_) => EffectName::MoveHistory,
        }
    }

    /// Its numbers, by their names at the boundary.
    pub fn parameters(&self) -> Vec<(&'static str, f64)> {
        let three = |names: [&'static str; 3], v: &Vector3<f64>, unit: f64| {
            names.into_iter().zip(v.iter().map(|v| v / unit).collect::<Vec<_>>()).collect::<Vec<_>>()
        };
        const SHIFT: [&str; 3] = ["dx_um", "dy_um", "dz_um"];
        match self {
            Effect::Transmission { waves, beat, .. } => match (waves.as_slice(), beat) {
                ([[cycles, amplitude, _]], None) => {
                    vec![("cycles_per_rev", *cycles), ("amplitude_urad", amplitude / URAD)]
                }
                _ => {
                    let squares: f64 = waves.iter().map(|[_, amplitude, _]| 0.5 * amplitude.powi(2)).sum();
                    vec![("rms_urad", squares.sqrt() / URAD), ("waves", waves.len() as f64)]
                }
            },
            Effect::Backlash { play, .. } => vec![("play_urad", play / URAD)],
            Effect::Compliance { compliance, .. } => {
                vec![("compliance_urad_per_nm", compliance / URAD_PER_NM)]
            }
            Effect::Nonlinear { cubic: true, per, .. } => vec![("urad_per_nm3", per / URAD)],
            Effect::Nonlinear { per, .. } => vec![("urad_per_nm2", per / URAD)],
            Effect::EncoderScale { more, .. } => vec![("factor", 1.0 + more)],
            // stated as a stiffness, as on a rig
            Effect::Rod(more) => vec![("factor", 1.0 / (1.0 + more))],
            Effect::Coupling { share, .. } | Effect::Lag { share, .. } => vec![("fraction", *share)],
            Effect::ClampPose { by, turn, .. } | Effect::BaseShift { by, turn, .. } => {
                let mut six = three(SHIFT, by, UM);
                six.extend(three(["rx_urad", "ry_urad", "rz_urad"], turn, URAD));
                six
            }
            Effect::Shift { by, .. } | Effect::ToolShift { by, .. } => three(SHIFT, by, UM),
            Effect::Spring { rate, .. } => vec![("n_per_mm", rate * MM)],
            Effect::Sensor { shown, along, more, .. } if shown == along => vec![("factor", 1.0 + more)],
            Effect::Sensor { shown, along, more, .. } => vec![(CROSS[*shown][*along], *more)],
            Effect::Force { by, .. } => three(["x_n", "y_n", "z_n"], by, 1.0),
            Effect::Level([roll, pitch]) => vec![("roll_deg", roll / DEG), ("pitch_deg", pitch / DEG)],
            Effect::BaseTilt(per) => vec![("tilt_urad_per_nm", per / URAD_PER_NM)],
            Effect::ZeroDrift { per, by_time: true, .. } => vec![("zero_urad_per_h", per * 3600.0 / URAD)],
            Effect::ZeroDrift { per, .. } => vec![("zero_urad_per_k", per / URAD)],
            Effect::JointShift { by, .. } => vec![("zero_urad", by / URAD)],
            Effect::Growth { per, by_time: true } => vec![("growth_um_per_m_per_h", per * 3600.0 / UM)],
            Effect::Growth { per, .. } => vec![("growth_um_per_m_per_k", per / UM)],
            Effect::Friction { per, .. } => vec![("urad_per_nm", per / URAD_PER_NM)],
            Effect::Drift { by, by_time: true } => {
                three(["x_um_per_h", "y_um_per_h", "z_um_per_h"], by, UM / 3600.0)
            }
            Effect::Drift { by, .. } => three(["x_um_per_k", "y_um_per_k", "z_um_per_k"], by, UM),
            Effect::Payload(mass) => vec![("mass_kg", *mass)],
            Effect::TipMass(mass) => vec![("mass_g", mass / GRAM)],
            Effect::Outlier(rows) => rows.iter().map(|(_, by)| ("um", by.norm() / UM)).collect(),
            Effect::LinkTorsion { per, .. } => vec![("urad_per_rad2", per / URAD)],
            Effect::Ball(amplitude) => vec![("um", amplitude / UM)],
            Effect::Wear { window, play, .. } => vec![
                ("play_urad", play / URAD),
                ("middle_deg", window[0].to_degrees()),
                ("width_deg", window[1].to_degrees()),
            ],
            Effect::Disturbance { by, period, .. } => vec![("um", by.norm() / UM), ("period_s", *period)],
            Effect::Refraction(per) => vec![("um_per_m2", per / UM)],
            Effect::Runout { by, .. } | Effect::LooseMount(by) => vec![("um", by / UM)],
            Effect::MoveHistory(share) => vec![("fraction", *share)],
        }
    }

    /// How many numbers a model needs for it.
    pub fn degrees_of_freedom(&self) -> f64 {
        match self {
            Effect::Transmission { waves, beat, .. } => 2.0 * waves.len() as f64 * beat.map_or(1.0, |_| 3.0),
            Effect::Outlier(rows) => 3.0 * rows.len() as f64,
            Effect::Wear { .. } | Effect::Disturbance { .. } => 3.0,
            _ => self.parameters().len() as f64,
        }
    }

    /// What no other recording shows: it cannot be predicted.
    pub fn is_of_one_run(&self) -> bool {
        matches!(
            self,
            Effect::Shift { .. }
                | Effect::Outlier(_)
                | Effect::ToolShift { .. }
                | Effect::BaseShift { .. }
                | Effect::JointShift { .. }
        )
    }

    /// What is left of it after the recording, away from the fixtures: what a robot does whatever
    /// is measured with it, and where it was moved to; not what happened to a fixture or to single
    /// rows.
    pub fn afterwards(&self) -> Option<Effect> {
        match self.clone() {
            Effect::ClampPose { .. }
            | Effect::Shift { .. }
            | Effect::Outlier(_)
            | Effect::Spring { .. }
            | Effect::Sensor { .. }
            | Effect::Force { .. } => None,
            Effect::ToolShift { by, .. } => Some(Effect::ToolShift { from: 0, by }),
            Effect::BaseShift { by, turn, .. } => Some(Effect::BaseShift { from: 0, by, turn }),
            Effect::JointShift { joint, by, .. } => Some(Effect::JointShift { joint, from: 0, by }),
            other => Some(other),
        }
    }

    /// True for what no library has.
    pub fn is_beyond(&self) -> bool {
        matches!(
            self,
            Effect::LinkTorsion { .. }
                | Effect::Ball(_)
                | Effect::Wear { .. }
                | Effect::Disturbance { .. }
                | Effect::Refraction(_)
                | Effect::Runout { .. }
                | Effect::LooseMount(_)
                | Effect::MoveHistory(_)
        )
    }

    /// What it is proportional to.
    fn sizes(&mut self) -> Vec<&mut f64> {
        match self {
            Effect::Transmission { waves, .. } => waves.iter_mut().map(|wave| &mut wave[1]).collect(),
            Effect::Outlier(rows) => all(rows.iter_mut().map(|(_, by)| by)),
            Effect::ClampPose { by, turn, .. } | Effect::BaseShift { by, turn, .. } => all([by, turn]),
            Effect::Shift { by, .. }
            | Effect::ToolShift { by, .. }
            | Effect::Drift { by, .. }
            | Effect::Force { by, .. }
            | Effect::Disturbance { by, .. } => all([by]),
            Effect::Level(turn) => turn.iter_mut().collect(),
            Effect::Backlash { play: size, .. }
            | Effect::Compliance { compliance: size, .. }
            | Effect::Nonlinear { per: size, .. }
            | Effect::EncoderScale { more: size, .. }
            | Effect::Coupling { share: size, .. }
            | Effect::Lag { share: size, .. }
            | Effect::Spring { rate: size, .. }
            | Effect::Sensor { more: size, .. }
            | Effect::ZeroDrift { per: size, .. }
            | Effect::JointShift { by: size, .. }
            | Effect::Growth { per: size, .. }
            | Effect::Friction { per: size, .. }
            | Effect::LinkTorsion { per: size, .. }
            | Effect::Wear { play: size, .. }
            | Effect::Runout { by: size, .. }
            | Effect::Payload(size)
            | Effect::TipMass(size)
            | Effect::Rod(size)
            | Effect::BaseTilt(size)
            | Effect::Ball(size)
            | Effect::Refraction(size)
            | Effect::LooseMount(size)
            | Effect::MoveHistory(size) => vec![size],
        }
    }

    /// A share of it.
    pub fn scaled(mut self, share: f64) -> Effect {
        self.sizes().into_iter().for_each(|size| *size *= share);
        self
    }

    /// The effect with each of its numbers a little larger; none for what no library has. How often
    /// a gear's wave repeats is known.
    pub fn larger(&self) -> Vec<Effect> {
        if self.is_beyond() {
            return Vec::new();
        }
        let mut known = self.clone();
        let sizes: Vec<f64> = known.sizes().into_iter().map(|size| *size).collect();
        let step = STEP * sizes.iter().fold(0.0, |most: f64, size| most.max(size.abs()));
        let one = |k: usize| {
            let mut larger = self.clone();
            larger.sizes().into_iter().skip(k).take(1).for_each(|size| *size += step);
            larger
        };
        let mut all: Vec<Effect> = (0..sizes.len()).map(one).collect();
        if let Effect::Transmission { joint, waves, beat } = self {
            all.extend((0..waves.len()).map(|k| {
                let mut waves = waves.clone();
                waves[k][2] += STEP;
                Effect::Transmission { joint: *joint, waves, beat: *beat }
            }));
        }
        all
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn half_of_an_effect_is_half_of_its_numbers_and_each_can_grow() {
        let shift = Effect::ToolShift { from: 3, by: Vector3::new(1.0, -2.0, 0.0) };
        assert_eq!(shift.clone().scaled(0.5).parameters()[1], ("dy_um", -1.0 / UM));
        assert_eq!(shift.larger().len(), 3);
        assert_eq!(shift.afterwards(), Some(Effect::ToolShift { from: 0, by: Vector3::new(1.0, -2.0, 0.0) }));
        let rod = Effect::Rod(0.25).scaled(2.0);
        assert!((rod.parameters()[0].1 - 1.0 / 1.5).abs() < 1e-12);
        let gear = Effect::Transmission { joint: 0, waves: vec![[3.0, 1e-4, 0.1]; 2], beat: None };
        assert_eq!(gear.larger().len(), 4);
        assert!(Effect::MoveHistory(0.1).larger().is_empty() && Effect::MoveHistory(0.1).is_beyond());
    }
}
