//! Compliance of a rod's tip: C^F (per newton of contact force) and C^g (per g of gravity).
//!
//! `Δx_TCP = C^g g_T + C^F F_T` (the paper's Eq 19): the tip's deflection in {T} under the gravity vector (in g)
//! and the contact force (in N), both expressed in {T}. `C[(m, n)]`: offset along axis m, load along axis n.

use nalgebra::Matrix3;

use crate::beam::{Load, Physics, RodModel};
use crate::closed_form;
use crate::error::{Error, Result};
use crate::rod::{BendFlexibility, Rod};
use crate::units::STANDARD_GRAVITY;

/// The paper's contact force of the three sensors on the ball, N in the device frame (§ 5.2).
pub const PAPER_CONTACT_FORCE: [f64; 3] = [1.10, 1.25, 1.05];

/// Enough for a smooth picture; the numbers do not depend on it.
pub const DEFAULT_ELEMENTS: usize = 200;

/// Compliance matrices of the tip in {T}.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Compliance {
    /// C^F, m/N; symmetric.
    pub force: Matrix3<f64>,
    /// C^g, m per g (9.80665 m/s²); not symmetric.
    pub gravity: Matrix3<f64>,
}

/// What one left-out term adds, and where that leaves the compliance.
#[derive(Debug, Clone, PartialEq)]
pub struct Step {
    /// The term in the user's words, for example "shear".
    pub term: &'static str,
    /// Compliance with this term and all before it.
    pub total: Compliance,
    /// What this term adds to the one before; the first step adds all of itself.
    pub added: Compliance,
}

impl Compliance {
    /// From the beam model with `physics` (FEA mode).
    ///
    /// # Errors
    /// As [`RodModel::new`] and [`crate::beam::Chain::solve`]; [`Error::Numerical`] where the result overflows.
    pub fn of_model(rod: &Rod, physics: &Physics, elements: usize) -> Result<Self> {
        let model = RodModel::new(rod, physics, elements, &[])?;
        let tip = model.tip();
        let response = model.chain.solve(&[Load::Force { node: tip }, Load::SelfWeight])?;
        let compliance = Compliance {
            force: response.motion(tip, 0).translation,
            gravity: response.motion(tip, 1).translation * STANDARD_GRAVITY,
        };
        // the solution was finite per m/s²; a rod of extreme numbers may not be per g
        match compliance.gravity.iter().all(|c| c.is_finite()) {
            true => Ok(compliance),
            false => Err(Error::Numerical {
                what: "compliance under gravity",
                why: "it is beyond double precision; is there a number of the rod in another unit?".into(),
            }),
        }
    }

    /// Compliance index c_rod = ΣΣ|C^g| + F ΣΣ|C^F|, m, with F (N) the size of the contact force.
    ///
    /// The paper's Eq 23; only absolute sums reproduce its Table 2.
    pub fn index(&self, contact_force: f64) -> f64 {
        self.gravity.abs().sum() + contact_force * self.force.abs().sum()
    }

    fn minus(&self, other: &Compliance) -> Compliance {
        Compliance { force: self.force - other.force, gravity: self.gravity - other.gravity }
    }
}

/// From bending and torsion alone (Calc, where the closed form applies) to the whole model, one term after
/// another: what each term adds to the ones before it. The terms add up to the whole exactly.
///
/// Terms the rod does not have are not listed; `shear` only where `physics` has it.
///
/// # Errors
/// As [`Compliance::of_model`].
pub fn steps(rod: &Rod, physics: &Physics, elements: usize) -> Result<Vec<Step>> {
    let mut so_far = Physics {
        axial: false,
        shear: false,
        bend: false,
        bend_flexibility: false,
        joints: false,
        masses: false,
        tip_mass: false,
    };
    let base = match closed_form::compliance(rod) {
        Ok(compliance) => Step { term: "Calc (Eqs 15, 17)", total: compliance, added: compliance },
        Err(_) => {
            let compliance = Compliance::of_model(rod, &so_far, elements)?;
            Step { term: "bending and torsion", total: compliance, added: compliance }
        }
    };
    let is_curved = rod.bend_radius > 0.0;
    let yields = |joint: &crate::rod::Joint| joint.bending > 0.0 || joint.torsion > 0.0;
    type Switch = fn(&mut Physics);
    let terms: [(&str, bool, Switch); 7] = [
        ("axial", physics.axial, |p| p.axial = true),
        ("shear", physics.shear, |p| p.shear = true),
        ("bend", physics.bend && is_curved, |p| p.bend = true),
        (
            "bend flexibility",
            physics.bend_flexibility && is_curved && rod.bend_flexibility != BendFlexibility::Beam,
            |p| p.bend_flexibility = true,
        ),
        ("joints", physics.joints && rod.joints.iter().any(yields), |p| p.joints = true),
        ("sleeves and holders", physics.masses && !rod.masses.is_empty(), |p| p.masses = true),
        ("tip mass", physics.tip_mass && rod.tip_mass > 0.0, |p| p.tip_mass = true),
    ];
    let mut steps = vec![base];
    for (term, is_present, switch_on) in terms {
        if !is_present {
            continue;
        }
        switch_on(&mut so_far);
        let total = Compliance::of_model(rod, &so_far, elements)?;
        let added = total.minus(&steps[steps.len() - 1].total);
        steps.push(Step { term, total, added });
    }
    Ok(steps)
}
