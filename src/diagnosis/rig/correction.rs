//! A rod with what was found in it, and its compliance then.

use nalgebra::DVector;

use super::action::Action;
use super::model::{Body, RigDiagnosis, RigModel};
use super::written_law::written;
use crate::beam::Physics;
use crate::compliance::{Compliance, DEFAULT_ELEMENTS};
use crate::error::Result;
use crate::inference::background::nominal_factors;
use crate::inference::law::Law;
use crate::inference::{Finding, ForwardModel, Kind, Location, NominalParameter, Term, WrittenTo};
use crate::rig::{self, readings::Readings};
use crate::rod::{BendFlexibility, Joint, NominalNumber, Rod};
use crate::spatial::Direction;
use crate::units::UM;

/// Nobody weighs less, N.
const SMALLEST_LOAD: f64 = 1e-6;
const NM: f64 = 1e-3 * UM;

/// What a diagnosis makes of a rod.
#[derive(Debug, Clone)]
pub struct Correction {
    /// The rod with the parts that yield as they were found.
    pub rod: Rod,
    /// Its file.
    pub rod_toml: String,
    /// The readings without what was found to be the rig's and not the rod's (friction, offsets,
    /// drift, slips …): a file for `rig fit` and for the Meas mode.
    pub readings_csv: String,
    /// Compliance of the rod as its file gave it (FEA).
    pub before: Compliance,
    /// Compliance of the corrected rod.
    pub after: Compliance,
    /// r_rod of the readings as they are, by Eq 21, with what the paper's rule makes of it: C^g =
    /// r_rod × FEA. `None` where the readings give no such number.
    pub by_ratio: Option<(f64, Compliance)>,
    /// Mistakes that were undone in the readings or in the rod's file: what was wrong, with the
    /// correction.
    pub undone: Vec<String>,
    /// What was entered into the rod, in words.
    pub entered: Vec<String>,
    /// Findings that are the rig's: taken out of the readings, not entered into the rod.
    pub removed: Vec<String>,
    /// Findings that neither file can hold, in words.
    pub left_out: Vec<String>,
}

impl RigDiagnosis {
    /// Rod and readings as corrected; `None` without a rod, or where nothing was
    /// found and no number of the rod's file moved.
    ///
    /// # Errors
    /// What the beam model refuses of the corrected rod.
    pub fn correction(&self) -> Result<Option<Correction>> {
        let proposed = self.law.as_ref().and_then(|proposed| proposed.law.as_ref().ok());
        match self.model.rod() {
            Some(rod) => {
                // several numbers share what they explain: together they are as stiff as the
                // readings
                let moved = match self.diagnosis.nominal.is_empty() && proposed.is_none() {
                    true => Vec::new(),
                    false => self.moved(rod, proposed),
                };
                let found = Found { findings: &self.diagnosis.findings, moved: &moved, law: proposed };
                match found.findings.is_empty() && moved.is_empty() && proposed.is_none() {
                    true => Ok(None),
                    false => corrected(&self.model, rod, &found).map(Some),
                }
            }
            None => Ok(None),
        }
    }

    /// Where `--apply` writes a law: into the rod file where that knows its variable, or out of
    /// the readings.
    pub fn law_destination(&self, law: &Law) -> WrittenTo {
        match self.model.rod() {
            None => WrittenTo::Nowhere,
            Some(_) if written(law, "").is_some() => WrittenTo::Model,
            Some(_) => WrittenTo::Recording,
        }
    }

    /// Those of the nominal numbers that stand in the file of `rod` and are off by more than a
    /// trace; the others are the rig's.
    fn moved(&self, rod: &Rod, proposed: Option<&Law>) -> Vec<Moved> {
        let factors = match proposed {
            // with a law beside them they are others
            Some(law) => nominal_factors(&self.evidence, &law.beside.background),
            None => self.diagnosis.nominal_factors.0.clone(),
        };
        let numbers = rod.nominal_numbers();
        let known = self.evidence.nominal_numbers.iter().zip(factors.iter());
        let of_own = |(own, factor): (&NominalParameter, &f64)| {
            let number = numbers.iter().find(|number| number.number.to_string() == own.name)?;
            (factor.abs() > TRACE).then(|| (number.number.clone(), factor * own.standard_uncertainty))
        };
        known.filter_map(of_own).collect()
    }
}

/// A number of the rod's file that moved within its standard uncertainty, and by how much, SI.
type Moved = (NominalNumber, f64);

/// Standard uncertainties below which a nominal number has not moved.
const TRACE: f64 = 0.05;

/// What a diagnosis has to write.
struct Found<'a> {
    findings: &'a [Finding],
    moved: &'a [Moved],
    law: Option<&'a Law>,
}

impl Found<'_> {
    /// A finding's part as it is beside the law, where there is one.
    fn term(&self, own: &Term) -> Term {
        let beside = self.law.map_or(&[][..], |law| &law.beside.terms);
        beside.iter().find(|term| term.candidate == own.candidate).unwrap_or(own).clone()
    }
}

fn corrected(model: &RigModel, rod: &Rod, found: &Found) -> Result<Correction> {
    let findings = found.findings;
    let readings = model.readings();
    let mut corrected = rod.clone();
    let is_mistake = |finding: &&Finding| finding.kind() == Kind::Mistake;
    let undone: Vec<String> =
        findings.iter().filter(is_mistake).map(|finding| finding.description.observed.clone()).collect();
    let (mut entered, mut removed, mut left_out) = (Vec::new(), Vec::new(), Vec::new());
    let (mut all, mut of_rod) = (Vec::new(), Vec::new());
    for part in findings.iter().flat_map(|finding| &finding.parts) {
        let effect = model.candidates()[part.term.candidate].effect;
        let words = format!("{effect}, {}", part.location);
        let term = found.term(&part.term);
        all.push(term.clone());
        // a rod file has no sessions
        let is_of_session = matches!(part.location, Location::InSession { .. });
        match effect.written_to {
            // said as such
            _ if effect.kind == Kind::Mistake => {}
            WrittenTo::Model if is_of_session => removed.push(words),
            WrittenTo::Model => {
                enter(&mut corrected, model, &term);
                of_rod.push(term);
                entered.push(words);
            }
            WrittenTo::Recording => removed.push(words),
            WrittenTo::Nowhere => left_out.push(words),
        }
    }
    for (number, change) in found.moved {
        // a finding may have scaled it already
        let (Some(nominal), Some(now)) = (rod.value_of(number), corrected.value_of(number)) else { continue };
        let relative = if nominal == 0.0 { now + change } else { now * (1.0 + change / nominal) };
        corrected = corrected.with(number, relative);
        entered.push(format!("{number}, within its standard uncertainty"));
    }
    let mut of_rig = DVector::zeros(model.data().len());
    for law in found.law.into_iter().flat_map(Law::all) {
        match written(law, &format!("diagnose rig, {}", readings.file)) {
            Some(law) => {
                entered.push(format!("law, {}", law));
                corrected.laws.push(law);
            }
            // another recording has another time
            None => {
                removed.push(format!("law over the {}, {}", law.site.variable.name, law.site.location));
                of_rig += DVector::from_column_slice(&law.adds);
            }
        }
    }
    let provenance = format!("Rod {} with what its rig readings ({}) show", rod.name, readings.file);
    let mut above = vec![provenance + ":"];
    above.extend(undone.iter().map(|mistake| format!("{mistake} (done)")));
    above.extend([
        if entered.is_empty() { "no finding belongs to the rod".into() } else { entered.join("; ") },
        "Moduli are effective values: with them the beam model is as stiff as the rod was.".into(),
    ]);
    let rod_toml = corrected.to_toml(&above);
    // what a user will get from the file
    let corrected = Rod::from_toml(&rod.name, &rod_toml)?;
    let physics = Physics::default();
    let fit = rig::fit(readings, Some(rod), &rig::Options::default()).ok();
    let by_ratio = fit.and_then(|fit| fit.measured).map(|m| (m.rod_ratio.value, m.compliance));
    of_rig += model.response(&all) - model.response(&of_rod);
    Ok(Correction {
        readings_csv: without(readings, model, &of_rig, [&undone, &removed, &left_out]),
        before: of_file(model, rod, &physics)?,
        after: Compliance::of_model(&corrected, &physics, DEFAULT_ELEMENTS)?,
        rod: corrected,
        rod_toml,
        by_ratio,
        undone,
        entered,
        removed,
        left_out,
    })
}

/// Compliance of the rod as its file gave it; of the one that was meant where a mistake made it a
/// rod that cannot be computed.
fn of_file(model: &RigModel, meant: &Rod, physics: &Physics) -> Result<Compliance> {
    let of_file = Compliance::of_model(model.rod_of_file().unwrap_or(meant), physics, DEFAULT_ELEMENTS);
    of_file.or_else(|_| Compliance::of_model(meant, physics, DEFAULT_ELEMENTS))
}

/// Puts an effect of the structure into the rod.
/// The rod with what `findings` say of it.
pub(super) fn as_found(model: &RigModel, rod: &Rod, findings: &[Finding]) -> Rod {
    let mut found = rod.clone();
    let of_rod =
        findings.iter().filter(|f| f.effect.written_to == WrittenTo::Model && f.kind() == Kind::Physics);
    of_rod.flat_map(|finding| &finding.parts).for_each(|part| enter(&mut found, model, &part.term));
    found
}

fn enter(rod: &mut Rod, model: &RigModel, term: &Term) {
    let Body::Rod(structure) = &model.body else { return };
    let candidate = &model.candidates()[term.candidate];
    let is_it = |joint: &Joint| candidate.location == Location::Named(joint.name.clone());
    let declared = rod.joints.iter().position(is_it);
    // what these loads cannot show of a declared joint stays as it is
    let mut joint = declared.map(|index| rod.joints[index].clone());
    for (action, &value) in model.actions[term.candidate].iter().zip(&term.values) {
        match action {
            Action::Stiffness => scale(rod, value, value),
            Action::ShearModulus => scale(rod, 1.0, value),
            Action::Bend(_) => rod.bend_flexibility = BendFlexibility::Factor(value),
            Action::Joint(number, _) => {
                let joint = joint.get_or_insert_with(|| Joint {
                    name: candidate.location.to_string(),
                    station: structure.station(*number),
                    bending: 0.0,
                    torsion: 0.0,
                });
                // joints are added in pairs, bending first
                if number % 2 == 0 { joint.bending = value } else { joint.torsion = value }
            }
            Action::Station(_) => {
                if let Some(joint) = &mut joint {
                    (joint.station, joint.name) = (value, Location::Station(value).to_string());
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
/// A rod whose moduli are `factor` times as large.
pub(super) fn scaled(rod: &Rod, factor: f64) -> Rod {
    let mut rod = rod.clone();
    scale(&mut rod, factor, factor);
    rod
}

fn scale(rod: &mut Rod, e: f64, g: f64) {
    for pipe in [&mut rod.pipe1, &mut rod.bend, &mut rod.pipe2] {
        pipe.material.youngs_modulus *= e;
        pipe.material.shear_modulus *= g;
    }
}

/// The readings less `of_rig`, as a file.
fn without(
    readings: &Readings,
    model: &RigModel,
    of_rig: &DVector<f64>,
    [undone, removed, left_out]: [&[String]; 3],
) -> String {
    let mut readings = readings.clone();
    for (datum, change) in model.data().iter().zip(of_rig.iter()) {
        if let Some(imposed) = datum.imposed {
            // the load that the rod alone would need; it may have turned round
            let row = &mut readings.rows[datum.row - 1];
            let load = datum.signed_load() - change / imposed.per_newton;
            let sign = if load < 0.0 { -1 } else { 1 };
            row.direction = Direction { sign, ..row.direction };
            row.load = (load.abs() / SMALLEST_LOAD).round() * SMALLEST_LOAD;
            continue;
        }
        if let Some(offset) = &mut readings.rows[datum.row - 1].offset[datum.channel.index()] {
            // a nanometre is less than any sensor reads
            *offset = ((*offset - change) / NM).round() * NM;
        }
    }
    let listed = |what: &str, list: &[String]| match list {
        [] => format!("{what}: nothing."),
        list => format!("{what}: {}.", list.join("; ")),
    };
    let source = readings.source.as_deref().map(|source| format!("Recorded: {source}"));
    let mut above = vec![
        format!(
            "CORRECTED, not as recorded: the readings of {} without the effects of a diagnosis",
            readings.file
        ),
        listed("Mistakes undone", undone),
        listed("Removed, effects of the rig", removed),
        listed("Removed, so that the compliance at small loads directly after loading remains", left_out),
    ];
    above.extend(source);
    readings.to_csv(&above)
}
