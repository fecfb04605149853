//! What may be wrong with a calibration, with its names and numbers as a diagnosis states them.

use nalgebra::Vector3;

use rodcal_base::units::{GRAM, UM, URAD, URAD_PER_NM};

/// Step of a numerical derivative: m, rad or, of a drift, m/K or m/s; of other numbers relative to them.
const STEP: f64 = 1e-6;
const RELATIVE_STEP: f64 = 1e-4;

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
    /// Factor on a joint's angle.
    EncoderScale { joint: usize, factor: f64 },
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
    /// Factor on the rod's deflections.
    Rod(f64),
    /// Rows that are wrong, m.
    Outlier(Vec<(usize, Vector3<f64>)>),
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
}

impl Effect {
    /// The name of the effect; of those outside the library a name of the generator's own.
    pub fn name(&self, has_sockets: bool) -> &'static str {
        match self {
            Effect::Transmission { .. } => "transmission_error",
            Effect::Backlash { .. } => "backlash",
            Effect::Compliance { .. } => "joint_compliance",
            Effect::Nonlinear { .. } => "joint_nonlinear_stiffness",
            Effect::EncoderScale { .. } => "encoder_scale",
            Effect::Coupling { .. } => "wrist_coupling",
            Effect::ClampPose { .. } => "clamp_pose",
            Effect::Shift { .. } if has_sockets => "socket_shift",
            Effect::Shift { .. } => "clamp_shift",
            Effect::Drift { .. } => "thermal_drift",
            Effect::Payload(_) => "payload_mass",
            Effect::TipMass(_) => "tip_mass",
            Effect::Lag { .. } => "readback_lag",
            Effect::Rod(_) => "rod_stiffness",
            Effect::Outlier(_) => "outlier",
            Effect::LinkTorsion { .. } => "link twists with two joints",
            Effect::Ball(_) => "ball out of round",
            Effect::Wear { .. } => "worn tooth",
            Effect::Disturbance { .. } => "periodic disturbance",
            Effect::Refraction(_) => "refraction",
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
            Effect::EncoderScale { factor, .. } => vec![("factor", *factor)],
            // stated as a stiffness, as on a rig
            Effect::Rod(factor) => vec![("factor", 1.0 / factor)],
            Effect::Coupling { share, .. } | Effect::Lag { share, .. } => vec![("fraction", *share)],
            Effect::ClampPose { by, turn, .. } => {
                let mut six = three(SHIFT, by, UM);
                six.extend(three(["rx_urad", "ry_urad", "rz_urad"], turn, URAD));
                six
            }
            Effect::Shift { by, .. } => three(SHIFT, by, UM),
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
        }
    }

    /// How many numbers a model needs for it.
    pub fn freedom(&self) -> f64 {
        match self {
            Effect::Transmission { waves, beat, .. } => 2.0 * waves.len() as f64 * beat.map_or(1.0, |_| 3.0),
            Effect::Outlier(rows) => 3.0 * rows.len() as f64,
            Effect::Wear { .. } | Effect::Disturbance { .. } => 3.0,
            _ => self.parameters().len() as f64,
        }
    }

    /// What no other recording shows: it cannot be predicted.
    pub fn is_of_one_run(&self) -> bool {
        matches!(self, Effect::Shift { .. } | Effect::Outlier(_))
    }

    /// What a robot does whatever is measured with it; the rest happened to a fixture or to single rows.
    pub fn is_of_robot(&self) -> bool {
        !matches!(self, Effect::ClampPose { .. } | Effect::Shift { .. } | Effect::Outlier(_))
    }

    /// The effect with each of its numbers a little larger, and by how much; none for what no library has. How often a gear's
    /// wave repeats is known.
    pub fn larger(&self) -> Vec<(Effect, f64)> {
        let one = |change: &dyn Fn(&mut Effect)| {
            let mut larger = self.clone();
            change(&mut larger);
            (larger, STEP)
        };
        let axes = |of: fn(&mut Effect) -> Option<&mut Vector3<f64>>| -> Vec<(Effect, f64)> {
            let along = |axis: usize| {
                one(&|effect| {
                    if let Some(vector) = of(effect) {
                        vector[axis] += STEP;
                    }
                })
            };
            (0..3).map(along).collect()
        };
        let number = |of: fn(&mut Effect) -> Option<&mut f64>| -> Vec<(Effect, f64)> {
            let mut larger = self.clone();
            let step = of(&mut larger).map(|number| {
                let step = RELATIVE_STEP * *number;
                *number += step;
                step
            });
            step.map(|step| (larger, step)).into_iter().collect()
        };
        match self {
            Effect::Transmission { waves, .. } => (0..2 * waves.len())
                .map(|k| {
                    one(&|effect| {
                        if let Effect::Transmission { waves, .. } = effect {
                            // an amplitude, or a phase
                            waves[k / 2][1 + k % 2] += STEP;
                        }
                    })
                })
                .collect(),
            Effect::Outlier(rows) => (0..3 * rows.len())
                .map(|k| {
                    one(&|effect| {
                        if let Effect::Outlier(rows) = effect {
                            rows[k / 3].1[k % 3] += STEP;
                        }
                    })
                })
                .collect(),
            Effect::ClampPose { .. } => {
                let mut six = axes(|effect| match effect {
                    Effect::ClampPose { by, .. } => Some(by),
                    _ => None,
                });
                six.extend(axes(|effect| match effect {
                    Effect::ClampPose { turn, .. } => Some(turn),
                    _ => None,
                }));
                six
            }
            Effect::Shift { .. } | Effect::Drift { .. } => axes(|effect| match effect {
                Effect::Shift { by, .. } | Effect::Drift { by, .. } => Some(by),
                _ => None,
            }),
            Effect::LinkTorsion { .. }
            | Effect::Ball(_)
            | Effect::Wear { .. }
            | Effect::Disturbance { .. }
            | Effect::Refraction(_) => Vec::new(),
            _ => number(|effect| match effect {
                Effect::Backlash { play: size, .. }
                | Effect::Compliance { compliance: size, .. }
                | Effect::Nonlinear { per: size, .. }
                | Effect::EncoderScale { factor: size, .. }
                | Effect::Coupling { share: size, .. }
                | Effect::Lag { share: size, .. }
                | Effect::Payload(size)
                | Effect::TipMass(size)
                | Effect::Rod(size) => Some(size),
                _ => None,
            }),
        }
    }
}
