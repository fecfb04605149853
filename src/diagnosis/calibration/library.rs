//! The effects that a calibration may have left out, where, and how large they usually are.
//!
//! A prior size is what a robot or a fixture of this kind is usually wrong by, not what these residuals say. All effects
//! are linear: the change of the recording is a sum of columns, each ∂tip/∂parameter through the calibrated kinematics.

mod events;
mod joints;
mod loads;
mod procedure;
pub(super) mod transmission;

pub(super) use self::events::base_moved;
use super::scene::{Entry, Scene};
use crate::units::{MM, UM};

/// Error of one joint angle, rad rms: a UR5 shows 60 to 110 µrad, a UR10 220 to 400.
pub(super) const JOINT_ANGLE: f64 = 150e-6;
/// Angle by which a joint or a link yields to its largest torque beyond what is modelled, rad: a tenth to a half of what
/// industrial drives yield by altogether (0.5 mrad).
pub(super) const YIELDING: f64 = 200e-6;
/// Scale of an encoder, rad per rad: 1 count in 10⁴, the share of an eccentric disc read over part of a turn.
pub(super) const ENCODER_SCALE: f64 = 1e-4;
/// What a wrist joint takes along of its neighbour, rad per rad.
pub(super) const COUPLING: f64 = 1e-4;
/// Share of a move that is not made yet when an angle is read: 100 to 1000 µrad of a move of 1 rad.
pub(super) const LAG: f64 = 3e-4;
/// Share by which a rod is softer than its model: 1 − 1/r is 0.27 rms over the r_rod of the paper's six rods.
pub(super) const SOFTNESS: f64 = 0.27;
/// Mass at the tip that was forgotten, kg: the paper's ball and holder have 55 g.
pub(super) const TIP_MASS: f64 = 0.05;
/// Mass at the flange that was forgotten, kg: an adapter, a cable.
pub(super) const FLANGE_MASS: f64 = 0.5;
/// Error of a contact force, N: sensor springs are stated to 10 or 20 % of 2 N.
pub(super) const CONTACT: f64 = 0.3;
/// Error of a clamp's place, m and rad: a fixture that was measured by a hand-held gauge.
pub(super) const CLAMP: (f64, f64) = (100.0 * UM, 0.5e-3);
/// What a knock does, m and rad: millimetres when one sees it, tenths when one does not.
pub(super) const KNOCK: (f64, f64) = (0.5 * MM, 0.5e-3);
/// Drift, m/K: an arm of steel of 1 m grows by 12 µm/K.
pub(super) const PER_KELVIN: f64 = 10.0 * UM;
/// Drift in a room that warms by 2 K in an hour, m/h; the same over a whole recording without a clock.
pub(super) const PER_HOUR: f64 = 20.0 * UM;
/// What a cold robot is off by, m: a UR5 starts a recording some 60 µm off.
pub(super) const WARM_UP: f64 = 50.0 * UM;
/// A pose that was read wrongly, m.
pub(super) const OUTLIER: f64 = 0.5 * MM;

/// An effect that these files cannot speak about, and why.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct NotTestable {
    /// Name of the effect.
    pub effect: String,
    /// What the files lack.
    pub reason: String,
}

/// Every effect, those that do nothing to this recording included; with the effects that it has no data for.
pub(super) fn all(scene: &Scene) -> (Vec<Entry>, Vec<NotTestable>) {
    let mut lacks = Vec::new();
    let mut entries = loads::all(scene, &mut lacks);
    entries.extend(joints::all(scene, &mut lacks));
    entries.extend(transmission::all(scene));
    entries.extend(procedure::all(scene));
    entries.extend(events::all(scene, &mut lacks));
    (entries, lacks)
}

fn lack(effect: &str, reason: &str) -> NotTestable {
    NotTestable { effect: effect.into(), reason: reason.into() }
}
