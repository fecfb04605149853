//! A rod with what was found in it, and what becomes of its compliance.

use nalgebra::DVector;

use super::action::Action;
use super::library::place;
use super::{Body, RigWorld};
use crate::beam::Physics;
use crate::compliance::{Compliance, DEFAULT_ELEMENTS};
use crate::diagnosis::{Chosen, Diagnosis, World};
use crate::error::Result;
use crate::rig::{self, readings::Readings};
use crate::rod::{BendFlexibility, Joint, Rod};
use crate::units::UM;

const NM: f64 = 1e-3 * UM;

/// What a diagnosis makes of a rod.
#[derive(Debug, Clone)]
pub struct Correction {
    /// The rod with the parts that yield as they were found.
    pub rod: Rod,
    /// Its file.
    pub rod_toml: String,
    /// The readings without what was found to be the rig's and not the rod's (friction, offsets, drift, slips …): a file for
    /// `rig fit` and for the Meas mode.
    pub readings_csv: String,
    /// Compliance of the rod as its file gave it (FEA).
    pub before: Compliance,
    /// Compliance of the corrected rod.
    pub after: Compliance,
    /// r_rod of the readings as they are, by Eq 21, with what the paper's rule makes of it: C^g = r_rod × FEA. `None` where
    /// the readings give no such number.
    pub by_ratio: Option<(f64, Compliance)>,
    /// What was entered into the rod, in words.
    pub entered: Vec<String>,
    /// Findings that are the rig's: taken out of the readings, not entered into the rod.
    pub removed: Vec<String>,
    /// Findings that neither file can hold, in words.
    pub left_out: Vec<String>,
}

impl Correction {
    /// Of what `diagnosis` found in `readings` of `rod`.
    ///
    /// # Errors
    /// What the beam model refuses of the corrected rod.
    pub(super) fn new(
        rod: &Rod,
        readings: &Readings,
        world: &RigWorld,
        diagnosis: &Diagnosis,
    ) -> Result<Correction> {
        let mut corrected = rod.clone();
        let (mut entered, mut removed, mut left_out) = (Vec::new(), Vec::new(), Vec::new());
        let mut of_rod = Vec::new();
        for finding in &diagnosis.findings {
            let chosen = &finding.chosen;
            let said = format!("{}, {}", world.candidates()[chosen.candidate].effect, finding.place);
            let actions = &world.actions[chosen.candidate];
            if actions.iter().any(is_of_structure) {
                enter(&mut corrected, world, chosen);
                of_rod.push(chosen.clone());
                entered.push(said);
            } else if actions.iter().any(is_of_material) {
                left_out.push(said);
            } else {
                removed.push(said);
            }
        }
        let provenance = format!("Rod {} with what its rig readings ({}) show", rod.name, readings.file);
        let rod_toml = corrected.to_toml(&[
            provenance + ":",
            if entered.is_empty() { "nothing that is the rod's".into() } else { entered.join("; ") },
            "Materials are effective ones: moduli that make the beam model yield as the rod did.".into(),
        ]);
        // what a user will get from the file
        let corrected = Rod::from_toml(&rod.name, &rod_toml)?;
        let physics = Physics::default();
        let fit = rig::fit(readings, Some(rod), &rig::Options::default()).ok();
        let by_ratio = fit.and_then(|fit| fit.measured).map(|m| (m.rod_ratio.value, m.compliance));
        let all: Vec<Chosen> = diagnosis.findings.iter().map(|finding| finding.chosen.clone()).collect();
        let of_rig = world.change(&all) - world.change(&of_rod);
        Ok(Correction {
            readings_csv: without(readings, world, &of_rig, &removed, &left_out),
            before: Compliance::of_model(rod, &physics, DEFAULT_ELEMENTS)?,
            after: Compliance::of_model(&corrected, &physics, DEFAULT_ELEMENTS)?,
            rod: corrected,
            rod_toml,
            by_ratio,
            entered,
            removed,
            left_out,
        })
    }
}

/// True for what a rod file has a place for.
fn is_of_structure(action: &Action) -> bool {
    matches!(
        action,
        Action::Stiffness | Action::ShearModulus | Action::Bend(_) | Action::Joint(..) | Action::Station(_)
    )
}

/// True for what is the rod's, but has no place in its file.
fn is_of_material(action: &Action) -> bool {
    matches!(action, Action::PerLoad | Action::PerLoadSquared | Action::Memory(_))
}

/// Puts an effect of the structure into the rod.
fn enter(rod: &mut Rod, world: &RigWorld, chosen: &Chosen) {
    let Body::Rod(structure) = &world.body else { return };
    let candidate = &world.candidates()[chosen.candidate];
    let declared = rod.joints.iter().position(|joint| joint.name == candidate.location);
    // what these loads cannot show of a declared joint stays as it is
    let mut joint = declared.map(|index| rod.joints[index].clone());
    for (action, &value) in world.actions[chosen.candidate].iter().zip(&chosen.values) {
        match action {
            Action::Stiffness => scale(rod, value, value),
            Action::ShearModulus => scale(rod, 1.0, value),
            Action::Bend(_) => rod.bend_flexibility = BendFlexibility::Factor(value),
            Action::Joint(number, _) => {
                let joint = joint.get_or_insert_with(|| Joint {
                    name: candidate.location.clone(),
                    station: structure.station(*number),
                    bending: 0.0,
                    torsion: 0.0,
                });
                // joints are added in pairs, bending first
                if number % 2 == 0 { joint.bending = value } else { joint.torsion = value }
            }
            Action::Station(_) => {
                if let Some(joint) = &mut joint {
                    (joint.station, joint.name) = (value, place(value));
                }
            }
            _ => {}
        }
    }
    match (declared, joint) {
        (Some(index), Some(found)) => rod.joints[index] = found,
        (None, Some(found)) => rod.joints.push(found),
        (_, None) => {}
    }
}

/// Factors on E and G of all pipes.
fn scale(rod: &mut Rod, e: f64, g: f64) {
    for pipe in [&mut rod.pipe1, &mut rod.bend, &mut rod.pipe2] {
        pipe.material.youngs_modulus *= e;
        pipe.material.shear_modulus *= g;
    }
}

/// The readings less `of_rig`, as a file.
fn without(
    readings: &Readings,
    world: &RigWorld,
    of_rig: &DVector<f64>,
    removed: &[String],
    left_out: &[String],
) -> String {
    let mut readings = readings.clone();
    for (datum, change) in world.data().iter().zip(of_rig.iter()) {
        if let Some(offset) = &mut readings.rows[datum.row - 1].offset[datum.channel.index()] {
            // a nanometre is less than any sensor reads
            *offset = ((*offset - change) / NM).round() * NM;
        }
    }
    let of = |what: &str, list: &[String]| match list {
        [] => format!("{what}: nothing."),
        list => format!("{what}: {}.", list.join("; ")),
    };
    let source = readings.source.as_deref().map(|source| format!("Recorded: {source}"));
    let mut above = vec![
        format!(
            "CORRECTED, not as recorded: the readings of {} without what a diagnosis found",
            readings.file
        ),
        of("Taken out as the rig's", removed),
        of("Taken out, so that the compliance at small loads right after loading is left", left_out),
    ];
    above.extend(source);
    readings.to_csv(&above)
}
