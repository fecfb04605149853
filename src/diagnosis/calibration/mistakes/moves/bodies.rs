//! Robots, rods and contact forces that may have been meant instead.

use super::super::super::effects::mistakes::{ROBOT_MISTAKE, ROD_MISTAKE, SIGN_MISTAKE, UNIT_MISTAKE};
use super::super::draft::DraftChange;
use super::{List, Other, RARE, UNUSUAL, exact};
use crate::calibration::campaign::Campaign;
use crate::inference::Key;
use crate::units::{POUND_FORCE, STANDARD_GRAVITY};

/// A gram and a thousandth of a newton, N.
const GRAM: f64 = STANDARD_GRAVITY / 1e3;
const MILLINEWTON: f64 = 1e-3;
const FACTORS: [f64; 8] =
    [-1.0, 0.1, 10.0, STANDARD_GRAVITY, 1.0 / STANDARD_GRAVITY, POUND_FORCE, GRAM, MILLINEWTON];

/// What the contact force may have to be multiplied by; nothing where none is stated.
pub fn forces(campaign: &Campaign) -> Vec<f64> {
    let is_stated = campaign.rod.is_some() && campaign.contact_force.is_some_and(|force| force.norm() > 0.0);
    if is_stated { FACTORS.to_vec() } else { Vec::new() }
}

impl List<'_> {
    /// Bodies with the contact force times a factor.
    pub fn contact_forces(&mut self, forces: &[(usize, f64)]) {
        const KEY: &str = "contact_force_n";
        for &(body, factor) in forces {
            // a kilogram is nearly ten newtons: the slip must be the rarer one
            let is_decimal = factor == 10.0 || factor == 0.1;
            let (effect, cure, why) = if factor < 0.0 {
                (
                    &SIGN_MISTAKE,
                    format!("Multiply {KEY} by −1"),
                    "it is the force on the device, not on the ball",
                )
            } else if factor == STANDARD_GRAVITY {
                (&UNIT_MISTAKE, format!("Multiply {KEY} by 9.80665"), "it is in kilograms, not in newtons")
            } else if factor == POUND_FORCE {
                (&UNIT_MISTAKE, format!("Multiply {KEY} by 4.448"), "it is in pounds, not in newtons")
            } else if factor == GRAM {
                (&UNIT_MISTAKE, format!("Divide {KEY} by 102"), "it is in grams, not in newtons")
            } else if factor == MILLINEWTON {
                (&UNIT_MISTAKE, format!("Divide {KEY} by 1000"), "it is in millinewtons, not in newtons")
            } else if factor == 1.0 / STANDARD_GRAVITY {
                (&UNIT_MISTAKE, format!("Divide {KEY} by 9.80665"), "it was converted to newtons twice")
            } else {
                let (way, by) = if factor < 1.0 { ("Divide", 1.0 / factor) } else { ("Multiply", factor) };
                (&UNIT_MISTAKE, format!("{way} {KEY} by {by}"), "its decimal point is in the wrong place")
            };
            let force = self.add(effect, Key::new(KEY), DraftChange::Body(body, None), &cure, why);
            let rarer = if is_decimal { RARE } else { 0.0 };
            (force.log_prior, force.force) = (UNUSUAL + rarer, Some(factor));
            force.estimates = if factor < 0.0 { Vec::new() } else { exact("factor", factor) };
        }
    }

    pub fn files(&mut self, others: &[Other]) {
        for other in others {
            let Other { file, name, .. } = other;
            let change = DraftChange::Body(other.body, other.tip);
            let (effect, what) = if other.is_rod { (&ROD_MISTAKE, "rod") } else { (&ROBOT_MISTAKE, "robot") };
            let cure = format!("Write {what} = \"{file}\"");
            let why = format!("the poses are those of {what} {name}");
            self.add(effect, Key::new(file), change, &cure, &why).log_prior = UNUSUAL;
        }
    }
}
