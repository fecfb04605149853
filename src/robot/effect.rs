//! Errors that geometry does not describe: how much farther a joint turns than it reads, and what
//! bends besides the joints.
//!
//! ```text
//! transmission_error   a·sin(n·q) + b·cos(n·q), or a table over q: linear between its rows,
//!                      constant beyond them
//! encoder_scale        (s − 1)·q
//! backlash             ½·b·sign(τ)
//! wrist_coupling       k·q of another joint
//! joint_compliance     c·τ
//! joint_nonlinear_stiffness  k₂·τ|τ| or k₃·τ³, beside the compliance
//! weight               c·(horizontal lever of a frame about the joint): the joint deflects under a
//!                      weight there that nobody knows
//! link_flexibility     the link before the joint bends: all beyond turns by k·M⊥ about the joint's
//!                      origin, or another point of its axis, M⊥ the moment about that of what pulls
//!                      beyond, without its part about the axis
//! gravity_tilt         the base tilts: all turns by k·Mₕ about the origin of {0}, Mₕ the horizontal
//!                      part of the moment there
//! ```

/// An error of a joint, a link or the base; what follows the move before is in `moves.rs`, what
/// bends in `structure.rs`. Joints count from 0.
#[derive(Debug, Clone, PartialEq)]
#[non_exhaustive]
pub enum Effect {
    /// A wave of so many cycles per revolution.
    Harmonic {
        /// Number of the joint, from 0.
        joint: usize,
        /// Cycles per revolution of the joint, n.
        cycles_per_rev: f64,
        /// Amplitude a of the sine, rad.
        sine: f64,
        /// Amplitude b of the cosine, rad.
        cosine: f64,
    },
    /// A table: angles (rad, ascending) with what is added to them (rad).
    Table {
        /// Number of the joint, from 0.
        joint: usize,
        /// Angle and correction.
        rows: Vec<(f64, f64)>,
    },
    /// A joint that turns s times as far as it reads.
    EncoderScale {
        /// Number of the joint, from 0.
        joint: usize,
        /// Ratio s of the angle turned to the angle read; 1 is no error.
        factor: f64,
    },
    /// Play, taken up by gravity's torque.
    Backlash {
        /// Number of the joint, from 0.
        joint: usize,
        /// b, rad.
        play: f64,
    },
    /// Play that friction holds open: the joint stays at the side that it was driven to.
    PlayByApproach {
        /// Number of the joint, from 0.
        joint: usize,
        /// The whole gap, rad.
        play: f64,
    },
    /// Friction that grows with the joint's load and keeps its drive wound up to the side that it
    /// was driven to.
    Friction {
        /// Number of the joint, from 0.
        joint: usize,
        /// Angle between the two directions of approach per torque, rad/(N·m).
        per_nm: f64,
    },
    /// Angles that were read before the arm had settled.
    Lag {
        /// The joint; `None` for all.
        joint: Option<usize>,
        /// Share of the last move that was still to come.
        fraction: f64,
    },
    /// A joint that deflects under its torque, in files that have no place for that at the joint.
    Compliance {
        /// Number of the joint, from 0.
        joint: usize,
        /// c, rad/(N·m).
        per_nm: f64,
    },
    /// A joint whose deflection is out of proportion to its torque.
    NonlinearStiffness {
        /// Number of the joint, from 0.
        joint: usize,
        /// Which power of the torque.
        power: TorquePower,
        /// k₂, rad/(N·m)², or k₃, rad/(N·m)³.
        coefficient: f64,
    },
    /// A link that bends across the axis of the joint beyond it.
    LinkFlexibility {
        /// The joint beyond it.
        joint: usize,
        /// k, rad/(N·m).
        per_nm: f64,
        /// Where on the joint's axis, from its origin, m.
        at: f64,
    },
    /// A base that tilts under the arm.
    GravityTilt {
        /// k, rad/(N·m).
        per_nm: f64,
    },
    /// A joint that deflects under an unknown weight at a frame beyond it.
    Weight {
        /// Number of the joint, from 0.
        joint: usize,
        /// The joint on whose axis the weight sits; `None` for the flange.
        at: Option<usize>,
        /// Turn per horizontal lever of the weight about the joint's axis, rad/m.
        per_metre: f64,
    },
    /// A joint that turns with another one.
    Coupling {
        /// The one that drives.
        from: usize,
        /// The one that is driven.
        joint: usize,
        /// k.
        fraction: f64,
    },
}

/// Power of the torque that a joint deflects with, besides the first.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
#[non_exhaustive]
pub enum TorquePower {
    /// τ|τ|.
    Square,
    /// τ³.
    Cube,
}

impl TorquePower {
    /// Of a torque.
    pub fn of(self, torque: f64) -> f64 {
        match self {
            TorquePower::Square => torque * torque.abs(),
            TorquePower::Cube => torque.powi(3),
        }
    }
}

/// What an effect follows.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum Follows {
    /// The angle of its joint.
    OwnAngle,
    /// Where all joints are, and what pulls at them.
    Configuration,
    /// The moves between poses.
    Moves,
    /// Moments that turn no joint.
    Moment,
}

impl Effect {
    /// The joint that it turns, or whose link it bends; `None` for all.
    pub fn joint(&self) -> Option<usize> {
        match self {
            Effect::Lag { joint, .. } => *joint,
            Effect::GravityTilt { .. } => None,
            Effect::Harmonic { joint, .. }
            | Effect::Table { joint, .. }
            | Effect::EncoderScale { joint, .. }
            | Effect::Backlash { joint, .. }
            | Effect::PlayByApproach { joint, .. }
            | Effect::Friction { joint, .. }
            | Effect::Weight { joint, .. }
            | Effect::Compliance { joint, .. }
            | Effect::NonlinearStiffness { joint, .. }
            | Effect::LinkFlexibility { joint, .. }
            | Effect::Coupling { joint, .. } => Some(*joint),
        }
    }

    /// What it follows, and so by whom it is computed.
    fn follows(&self) -> Follows {
        match self {
            Effect::Harmonic { .. } | Effect::Table { .. } | Effect::EncoderScale { .. } => Follows::OwnAngle,
            Effect::Backlash { .. }
            | Effect::Compliance { .. }
            | Effect::NonlinearStiffness { .. }
            | Effect::Weight { .. }
            | Effect::Coupling { .. } => Follows::Configuration,
            Effect::PlayByApproach { .. } | Effect::Friction { .. } | Effect::Lag { .. } => Follows::Moves,
            Effect::LinkFlexibility { .. } | Effect::GravityTilt { .. } => Follows::Moment,
        }
    }

    /// True where the torque of a joint, or a moment, matters.
    pub fn follows_load(&self) -> bool {
        match self {
            Effect::Backlash { .. }
            | Effect::Friction { .. }
            | Effect::Compliance { .. }
            | Effect::NonlinearStiffness { .. }
            | Effect::LinkFlexibility { .. }
            | Effect::GravityTilt { .. } => true,
            // an unknown weight is a number by itself
            Effect::Harmonic { .. }
            | Effect::Table { .. }
            | Effect::EncoderScale { .. }
            | Effect::PlayByApproach { .. }
            | Effect::Lag { .. }
            | Effect::Weight { .. }
            | Effect::Coupling { .. } => false,
        }
    }

    /// True of a function of its joint's own angle, which a table of corrections can hold.
    pub fn is_of_own_angle(&self) -> bool {
        self.follows() == Follows::OwnAngle
    }

    /// True where the move that led to a pose matters.
    pub fn follows_moves(&self) -> bool {
        self.follows() == Follows::Moves
    }

    /// True of a link that bends and a base that tilts.
    pub fn bends_structure(&self) -> bool {
        self.follows() == Follows::Moment
    }

    /// Turn of its joint, rad, at the joint values `q` (rad or m) under the torques `torque` (N·m;
    /// may be empty).
    ///
    /// ```
    /// use rodcal::robot::Effect;
    ///
    /// let eccentric = Effect::Harmonic { joint: 0, cycles_per_rev: 1.0, sine: 2e-4, cosine: 0.0 };
    /// assert!((eccentric.turn(&[30f64.to_radians()], &[]) - 1e-4).abs() < 1e-18);
    /// let play = Effect::Backlash { joint: 0, play: 2e-4 };
    /// assert_eq!(play.turn(&[0.0], &[-5.0]), -1e-4); // half the gap, towards the torque
    /// ```
    pub fn turn(&self, q: &[f64], torque: &[f64]) -> f64 {
        match self {
            Effect::Harmonic { joint, cycles_per_rev, sine, cosine } => {
                let (s, c) = (cycles_per_rev * q[*joint]).sin_cos();
                sine * s + cosine * c
            }
            Effect::Table { joint, rows } => interpolated(rows, q[*joint]),
            Effect::EncoderScale { joint, factor } => (factor - 1.0) * q[*joint],
            Effect::Backlash { joint, play } => match torque.get(*joint) {
                Some(torque) if *torque != 0.0 => 0.5 * play * torque.signum(),
                _ => 0.0,
            },
            Effect::Compliance { joint, per_nm } => torque.get(*joint).map_or(0.0, |torque| per_nm * torque),
            Effect::NonlinearStiffness { joint, power, coefficient } => {
                torque.get(*joint).map_or(0.0, |torque| coefficient * power.of(*torque))
            }
            Effect::Coupling { from, fraction, .. } => fraction * q[*from],
            // by the move before, by where all frames are, and what is no turn of a joint
            Effect::PlayByApproach { .. }
            | Effect::Friction { .. }
            | Effect::Lag { .. }
            | Effect::Weight { .. }
            | Effect::LinkFlexibility { .. }
            | Effect::GravityTilt { .. } => 0.0,
        }
    }
}

/// Between the rows of a table; the first and the last hold beyond it.
fn interpolated(rows: &[(f64, f64)], x: f64) -> f64 {
    let after = rows.partition_point(|row| row.0 <= x);
    match (after.checked_sub(1).map(|k| rows[k]), rows.get(after)) {
        (Some((x0, y0)), Some((x1, y1))) => y0 + (y1 - y0) * (x - x0) / (x1 - x0),
        (Some((_, y)), None) | (None, Some(&(_, y))) => y,
        (None, None) => 0.0,
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_table_is_straight_between_its_rows_and_constant_beyond() {
        let rows = vec![(0.0, 1.0), (1.0, 3.0), (2.0, 0.0)];
        let at = |x| Effect::Table { joint: 0, rows: rows.clone() }.turn(&[x], &[]);
        assert_eq!([-1.0, 0.0, 0.5, 1.0, 1.5, 2.0, 9.0].map(at), [1.0, 1.0, 2.0, 3.0, 1.5, 0.0, 0.0]);
    }

    #[test]
    fn play_follows_the_torque_and_a_coupling_the_other_joint() {
        let play = Effect::Backlash { joint: 1, play: 2e-4 };
        assert_eq!([-3.0, 0.0, 5.0].map(|t| play.turn(&[0.0; 2], &[0.0, t])), [-1e-4, 0.0, 1e-4]);
        assert_eq!(Effect::Coupling { from: 0, joint: 1, fraction: 0.5 }.turn(&[4.0, 0.0], &[]), 2.0);
    }

    #[test]
    fn a_stiffness_follows_a_power_of_the_torque_with_its_sign() {
        for (power, turn) in [(TorquePower::Square, 4e-6), (TorquePower::Cube, 8e-6)] {
            let effect = Effect::NonlinearStiffness { joint: 1, power, coefficient: 1e-6 };
            assert_eq!([-2.0, 0.0, 2.0].map(|t| effect.turn(&[0.0; 2], &[9.0, t])), [-turn, 0.0, turn]);
            assert_eq!(effect.turn(&[0.0; 2], &[]), 0.0);
        }
    }
}
