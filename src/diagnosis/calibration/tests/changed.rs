//! A robot at one row whose joints, masses, loads and fixture may be changed, and which is then
//! asked where its tip is.

use super::*;
use crate::calibration::{Calibration, Compensation};
use crate::robot::{Kinematics, Loads, Setup};
use crate::spatial::exponential;

/// Share of a size at which columns are compared, and of their largest number by which they may
/// differ: deflections are to first order.
const STEP: f64 = 0.01;
const FIRST_ORDER: f64 = 0.01;

/// A robot at a row with all that may be changed.
pub(super) struct Row<'a> {
    pub setup: Setup<'a>,
    pub q: Vec<f64>,
    pub loads: Loads,
    /// Deflection in {T}, m.
    pub deflection: Vector3<f64>,
    /// What the fixture adds to the recorded place of the tip, m.
    pub off: Vector3<f64>,
}

impl Row<'_> {
    pub fn torque(&self) -> Vec<f64> {
        let mut kinematics = Kinematics::new(&self.setup);
        let mut torque = vec![0.0; self.q.len()];
        for _ in 0..8 {
            kinematics.update(&self.q, &torque);
            kinematics.torques(&self.loads, &mut torque);
        }
        torque
    }

    /// What is known of the robot at rest.
    pub fn at_rest<T>(&self, ask: impl FnOnce(&Kinematics) -> T) -> T {
        let mut kinematics = Kinematics::new(&self.setup);
        kinematics.update(&self.q, &self.torque());
        ask(&kinematics)
    }

    pub fn tip(&self) -> Vector3<f64> {
        self.at_rest(|kinematics| kinematics.tip + kinematics.flange.rotation * self.deflection) + self.off
    }

    /// Turns the whole robot about a point, by a rotation vector.
    pub fn turn_base(&mut self, about: Vector3<f64>, by: Vector3<f64>) {
        let turned = exponential(&by);
        self.setup.base_position = about + turned * (self.setup.base_position - about);
        self.setup.base_guess.rotation = turned * self.setup.base().rotation;
        self.setup.base_turn = Vector3::zeros();
    }
}

/// The calibrated robot at a row.
pub(super) fn row<'a>(
    campaign: &Campaign,
    calibration: &Calibration<'a>,
    compensation: &Compensation,
    row: usize,
) -> Row<'a> {
    let setup = calibration.setup.clone();
    let gravity = setup.base().rotation * setup.robot.gravity;
    let device = &campaign.measurements.groups[campaign.measurements.rows[row].group].device;
    let loads = Loads {
        gravity,
        payload: compensation.payload,
        tip_force: device.rotation * compensation.contact_force,
    };
    let (deflection, off) = (Vector3::zeros(), Vector3::zeros());
    let mut there = Row { setup, q: campaign.measurements.joints(row).to_vec(), loads, deflection, off };
    there.deflection =
        there.at_rest(|kinematics| kinematics.flange.rotation.tr_mul(&calibration.deflections[row]));
    there
}

/// What a parameter does to a row.
pub(super) type Change<'a> = dyn Fn(&mut Row<'a>, usize, f64) + 'a;

/// An effect, its location, one of its parameters, and what that does.
pub(super) type Case<'a> = (&'a str, &'a str, &'a str, Box<Change<'a>>);

/// Are the columns what the changes do?
pub(super) fn assert_changes<'a>(campaign: &Campaign, calibration: &Calibration<'a>, cases: Vec<Case<'a>>) {
    let compensation = Compensation::new(campaign, calibration.mode).unwrap();
    let context = Context::new(campaign, calibration).unwrap();
    // whatever of it the calibration would absorb
    let entries = entries(&context);
    let mut wrong = Vec::new();
    for (effect, location, name, change) in cases {
        let same = entries.iter().filter(|entry| entry.candidate.effect.name == effect);
        let places: Vec<String> = same.clone().map(|entry| entry.candidate.location.to_string()).collect();
        let found = same.zip(&places).find(|(_, place)| *place == location);
        let (entry, _) = found.unwrap_or_else(|| panic!("no {effect} at {location}: {places:?}"));
        let parameters = &entry.candidate.parameters;
        let names: Vec<&str> = parameters.iter().map(|parameter| parameter.name.as_str()).collect();
        let k = names.iter().position(|own| *own == name).unwrap_or_else(|| panic!("no {name} in {names:?}"));
        let value = STEP * parameters[k].size;
        let mut predicted = DVector::zeros(3 * campaign.measurements.len());
        entry.columns[k].add_to(&mut predicted, value);
        let mut difference = 0.0f64;
        for at in 0..campaign.measurements.len() {
            let mut there = row(campaign, calibration, &compensation, at);
            let before = there.tip();
            change(&mut there, at, value);
            let expected = context.counted(at, &(there.tip() - before));
            difference = difference.max((expected - predicted.fixed_rows::<3>(3 * at)).norm());
        }
        if predicted.amax() == 0.0 || difference > FIRST_ORDER * predicted.amax() {
            wrong.push(format!("{effect} {location} {name}: {difference:e} of {:e}", predicted.amax()));
        }
    }
    assert!(wrong.is_empty(), "{wrong:#?}");
}
