//! Calc mode: the paper's closed form for an L-shaped rod of one uniform pipe, Euler–Bernoulli
//! bending and torsion only: no extension, no shear, no bend, no joints, no sleeves, no tip mass.
//!
//! Source: Improved MultiCal, *Sensors* 23 (2023) 5717, Eqs 15 and 17.

use nalgebra::Matrix3;

use super::Compliance;
use crate::error::{Error, Result};
use crate::rod::Rod;
use crate::units::STANDARD_GRAVITY;

/// Compliance of `rod` by Eqs 15 and 17, in {T}.
///
/// ```
/// use rodcal::beam::Physics;
/// use rodcal::compliance::closed_form;
/// use rodcal::prelude::*;
///
/// let rod = Rod::read("rods/5.toml".as_ref())?;
/// let calc = closed_form::compliance(&rod)?;
/// let ei = 193e9 * rod.pipe1.section.second_moment();
/// assert!((calc.force[(0, 0)] / (0.150f64.powi(3) / (3.0 * ei)) - 1.0).abs() < 1e-12); // Eq 15
/// // the beam model without what the closed form leaves out is the same
/// let beam = Compliance::of_model(&rod, &Physics::BENDING_AND_TORSION, 10)?;
/// assert!((beam.force - calc.force).amax() < 1e-12 * calc.force.amax());
/// # Ok::<(), rodcal::Error>(())
/// ```
///
/// # Errors
/// [`Error::NotApplicable`] where the equations do not hold: an angle other than 90°, or two
/// different pipes.
pub fn compliance(rod: &Rod) -> Result<Compliance> {
    let refuse = |why: String| {
        Err(Error::NotApplicable {
            what: format!("Calc mode for rod \"{}\"", rod.name),
            why,
            hint: "use the finite-element model: --mode fea".into(),
        })
    };
    if (rod.gamma - std::f64::consts::FRAC_PI_2).abs() > 1e-12 {
        let degrees = rod.gamma.to_degrees();
        return refuse(format!("its closed form holds for gamma_deg = 90 and this rod has {degrees}"));
    }
    if !rod.is_uniform() {
        return refuse(
            "its closed form holds for one uniform pipe and pipe1 and pipe2 differ in section or material"
                .into(),
        );
    }
    let (l1, l2) = (rod.l1, rod.l2);
    // in the rod's plane and, for y, out of it: the paper's pipes are round and have one
    let [ei, ei_out] =
        rod.pipe1.section.second_moments().map(|about| rod.pipe1.material.youngs_modulus * about);
    let gj = rod.pipe1.material.shear_modulus * rod.pipe1.section.torsion_constant();

    // Eq 15
    let f11 = l1.powi(3) / (3.0 * ei);
    let f13 = -l1.powi(2) * l2 / (2.0 * ei);
    let f22 = (l1.powi(3) + l2.powi(3)) / (3.0 * ei_out) + l1 * l2.powi(2) / gj;
    let f33 = l2.powi(3) / (3.0 * ei) + l1 * l2.powi(2) / ei;

    // Eq 17, with q the weight per length under one g, N/m
    let q = rod.pipe1.mass_per_length() * STANDARD_GRAVITY;
    let g11 = q * (l1.powi(3) * l2 / (3.0 * ei) + l1.powi(4) / (8.0 * ei));
    let g13 = -q * l1.powi(2) * l2.powi(2) / (4.0 * ei);
    let g31 = -q * (l1.powi(3) * l2 / (6.0 * ei) + l1.powi(2) * l2.powi(2) / (2.0 * ei));
    let g33 = q * (l2.powi(4) / (8.0 * ei) + l1 * l2.powi(3) / (2.0 * ei));
    let g22 = q
        * (l2.powi(4) / (8.0 * ei_out)
            + l1.powi(3) * l2 / (3.0 * ei_out)
            + l1.powi(4) / (8.0 * ei_out)
            + l1 * l2.powi(3) / (2.0 * gj));

    Ok(Compliance {
        force: Matrix3::new(f11, 0.0, f13, 0.0, f22, 0.0, f13, 0.0, f33),
        gravity: Matrix3::new(g11, 0.0, g13, 0.0, g22, 0.0, g31, 0.0, g33),
    })
}
