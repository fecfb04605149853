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
    let terms: [(&str, bool, Switch); 8] = [
        ("axial", physics.axial, |p| p.axial = true),
        ("shear", physics.shear, |p| p.shear = true),
        ("bend", physics.bend && is_curved, |p| p.bend = true),
        (
            "bend flexibility",
            physics.bend_flexibility && is_curved && rod.bend_flexibility != BendFlexibility::Beam,
            |p| p.bend_flexibility = true,
        ),
        ("joints", physics.joints && rod.joints.iter().any(yields), |p| p.joints = true),
        ("stiffening sleeves", physics.sleeves && !rod.sleeves.is_empty(), |p| p.sleeves = true),
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

#[cfg(test)]
mod tests {
    use super::*;
    use crate::material::Material;
    use crate::rod::Pipe;
    use crate::section::{General, Section};
    use approx::assert_relative_eq;

    /// Of this many times 1 cm² and so on; κ is that of all, so that κGA adds up too.
    fn times(k: f64) -> Section {
        let (area, iy, iz, torsion_constant) = (k * 1e-4, k * 3e-9, k * 2e-9, k * 4e-9);
        General { area, iy, iz, torsion_constant, shear_coefficient: 0.5 }.into()
    }

    fn pipe(k: f64) -> Pipe {
        Pipe::new(times(k), Material::isotropic("steel", 193e9, 0.29, 7930.0))
    }

    /// A pipe in two sleeves over all its length is the pipe that has the sections of the three, in
    /// every respect.
    #[test]
    fn sleeves_over_a_whole_pipe_are_a_thicker_pipe() {
        for radius in [0.0, 0.05] {
            let bent = |first: f64, second: f64| {
                let rod = Rod::new("rod", 0.3, 0.45, pipe(first)).with_bend(radius, BendFlexibility::Beam);
                let bend = Rod { bend: pipe(1.0), ..rod };
                bend.with_pipe2(pipe(second)).with_mass("ring", 0.6, 0.1).with_tip_mass(0.05)
            };
            let (thin, thick) = (bent(1.0, 1.0), bent(3.0, 1.5));
            let (start, end, length) = (thin.bend_start(), thin.bend_end(), thin.length());
            let sleeved = (thin.with_sleeve("a", 0.0, start, pipe(0.5)))
                .with_sleeve("b", 0.0, start, pipe(1.5))
                .with_sleeve("c", end, length, pipe(0.5))
                .checked()
                .unwrap();
            let of_model = |rod: &Rod, physics: &Physics| Compliance::of_model(rod, physics, 20).unwrap();
            let whole = [&thick, &sleeved].map(|rod| of_model(rod, &Physics::WHOLE));
            assert!((whole[0].force - whole[1].force).amax() < 1e-12 * whole[0].force.amax());
            assert!((whole[0].gravity - whole[1].gravity).amax() < 1e-12 * whole[0].gravity.amax());
            assert_relative_eq!(sleeved.mass(), thick.mass(), max_relative = 1e-14);
            assert_relative_eq!(sleeved.centre_of_mass(), thick.centre_of_mass(), epsilon = 1e-14);
            let swing = |rod: &Rod| rod.natural_modes(2).unwrap()[1].frequency;
            assert_relative_eq!(swing(&sleeved), swing(&thick), max_relative = 1e-9);
            // and without them it is the thin pipe
            let bare = Physics { sleeves: false, ..Physics::WHOLE };
            assert_eq!(of_model(&sleeved, &bare), of_model(&bent(1.0, 1.0), &Physics::WHOLE));
            let steps = steps(&sleeved, &Physics::WHOLE, 20).unwrap();
            assert!(steps.iter().any(|step| step.term == "stiffening sleeves"));
            let last = &steps[steps.len() - 1].total;
            assert!((last.force - whole[1].force).amax() < 1e-12 * last.force.amax());
        }
    }
}
