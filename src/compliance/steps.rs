//! What Calc leaves out, term by term.

use super::{Compliance, closed_form};
use crate::beam::Physics;
use crate::error::Result;
use crate::rod::{BendFlexibility, Joint, Rod};

/// What one left-out term adds, and where that leaves the compliance.
#[derive(Debug, Clone, PartialEq)]
#[non_exhaustive]
pub struct Step {
    /// The term in the user's words, for example "shear".
    pub term: &'static str,
    /// Compliance with this term and all before it.
    pub total: Compliance,
    /// What this term adds to the one before; the first step adds all of itself.
    pub added: Compliance,
}

impl Step {
    /// The laws of the rod's file, after all others.
    pub(super) fn of_laws(before: &Compliance, total: Compliance) -> Step {
        Step { term: LAWS, total, added: total.minus(before) }
    }
}

/// What the laws of the rod's file are among the terms.
const LAWS: &str = "laws of its file, at the contact force and 1 g";

/// From bending and torsion alone (Calc, where the closed form applies) to the whole model, one
/// term after another: what each term adds to the ones before it. The terms add up to the whole
/// exactly.
///
/// Terms the rod does not have are not listed; `shear` only where `physics` has it.
///
/// ```
/// use rodcal::compliance::steps;
/// use rodcal::prelude::*;
///
/// let rod = Rod::read("rods/5.toml".as_ref())?;
/// let steps = steps(&rod, &Physics::default(), 20)?;
/// let terms: Vec<&str> = steps.iter().map(|step| step.term).collect();
/// assert_eq!(terms, ["Calc (Eqs 15, 17)", "axial", "shear", "tip mass"]);
/// let whole = Compliance::of_model(&rod, &Physics::default(), 20)?;
/// let sum: f64 = steps.iter().map(|step| step.added.gravity[(2, 2)]).sum();
/// assert!((sum / whole.gravity[(2, 2)] - 1.0).abs() < 1e-12);
/// # Ok::<(), rodcal::Error>(())
/// ```
///
/// # Errors
/// As [`Compliance::of_model`].
pub fn steps(rod: &Rod, physics: &Physics, elements: usize) -> Result<Vec<Step>> {
    let mut so_far = Physics::BENDING_AND_TORSION;
    let base = match closed_form::compliance(rod) {
        Ok(compliance) => Step { term: "Calc (Eqs 15, 17)", total: compliance, added: compliance },
        Err(_) => {
            let compliance = Compliance::of_model(rod, &so_far, elements)?;
            Step { term: "bending and torsion", total: compliance, added: compliance }
        }
    };
    let is_curved = rod.bend_radius > 0.0;
    let yields = |joint: &Joint| joint.bending > 0.0 || joint.torsion > 0.0;
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
