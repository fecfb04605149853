//! A rod with what was found in it, and its compliance then.

use nalgebra::DVector;

use super::readings::without;
use super::written_item::WrittenItem;
use crate::beam::Physics;
use crate::compliance::{Compliance, DEFAULT_ELEMENTS};
use crate::diagnosis::rig::effects::registry;
use crate::diagnosis::rig::laws::written::written;
use crate::diagnosis::rig::mistakes::is_unknown_unit;
use crate::diagnosis::rig::model::nominal::KnownNumber;
use crate::diagnosis::rig::model::{RigDiagnosis, RigModel};
use crate::error::Result;
use crate::inference::law::Law;
use crate::inference::nominal_factors;
use crate::inference::{Finding, ForwardModel, Kind, NominalParameter, Term, WrittenTo};
use crate::rig;
use crate::rod::{NominalNumber, Rod};

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
    /// What was entered into the rod.
    pub entered: Vec<WrittenItem>,
    /// What is the rig's: taken out of the readings, not entered into the rod.
    pub removed: Vec<WrittenItem>,
    /// What neither file can hold.
    pub left_out: Vec<WrittenItem>,
}

impl RigDiagnosis {
    /// Rod and readings as corrected; `None` without a rod, where nothing was found and no number
    /// of the rod's file moved, or where only the rod itself says what unit the readings have: its
    /// compliance by such readings would be the file's own.
    ///
    /// # Errors
    /// What the beam model refuses of the corrected rod.
    pub fn correction(&self) -> Result<Option<Correction>> {
        if self.unit_is_unknown() {
            return Ok(None);
        }
        let proposed = self.law.as_ref().and_then(|proposed| proposed.law.as_ref().ok());
        match self.model.rod() {
            Some(rod) => {
                // several numbers share what they explain: together they are as stiff as the
                // readings
                let moved = match self.diagnosis.nominal.is_empty() && proposed.is_none() {
                    true => Vec::new(),
                    false => self.moved(proposed),
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

    /// True where a factor on the readings was found that is no unit's.
    pub fn unit_is_unknown(&self) -> bool {
        self.diagnosis.findings.iter().any(is_unknown_unit)
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

    /// Those of the nominal numbers that stand in the rod's file and are off by more than a trace;
    /// the others are the rig's.
    fn moved(&self, proposed: Option<&Law>) -> Vec<Moved> {
        let factors = match proposed {
            // with a law beside them they are others
            Some(law) => nominal_factors(&self.evidence, &law.beside.background),
            None => self.diagnosis.nominal_factors.0.clone(),
        };
        let known = self.model.known_numbers.iter().zip(&self.evidence.nominal_numbers);
        let moved = |((known, own), factor): ((&KnownNumber, &NominalParameter), &f64)| match known {
            KnownNumber::OfRod(number) if factor.abs() > TRACE => {
                Some((number.clone(), factor * own.standard_uncertainty))
            }
            _ => None,
        };
        known.zip(factors.iter()).filter_map(moved).collect()
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
    let readings = model.readings();
    let mut corrected = rod.clone();
    let mistakes = found.findings.iter().filter(|finding| finding.kind() == Kind::Mistake);
    let undone: Vec<String> = mistakes.map(|finding| finding.description.observed.clone()).collect();
    let (mut entered, mut removed, mut left_out) = (Vec::new(), Vec::new(), Vec::new());
    let (mut all, mut of_rod) = (Vec::new(), Vec::new());
    for part in found.findings.iter().flat_map(|finding| &finding.parts) {
        let (effect, term) = (model.candidates()[part.term.candidate].effect, found.term(&part.term));
        all.push(term.clone());
        // it is said among the mistakes
        if effect.kind == Kind::Mistake {
            continue;
        }
        let item = WrittenItem::Effect(effect, part.location.clone());
        match registry::write(&term, model, &mut corrected) {
            WrittenTo::Model => {
                of_rod.push(term);
                entered.push(item);
            }
            WrittenTo::Recording => removed.push(item),
            WrittenTo::Nowhere => left_out.push(item),
        }
    }
    for (number, change) in found.moved {
        // a finding may have scaled it already
        let (Some(nominal), Some(now)) = (rod.value_of(number), corrected.value_of(number)) else { continue };
        let relative = if nominal == 0.0 { now + change } else { now * (1.0 + change / nominal) };
        corrected = corrected.with(number, relative);
        entered.push(WrittenItem::Number(number.clone()));
    }
    let mut of_rig = DVector::zeros(model.data().len());
    for law in found.law.into_iter().flat_map(Law::all) {
        match written(law, &format!("diagnose rig, {}", readings.file)) {
            Some(law) => {
                entered.push(WrittenItem::Law(law.clone()));
                corrected.laws.push(law);
            }
            // another recording has another time
            None => {
                removed.push(WrittenItem::of_recording(law));
                of_rig += DVector::from_column_slice(&law.adds);
            }
        }
    }
    let rod_toml = corrected.to_toml(&above(rod, &readings.file, &undone, &entered));
    // what a user will get from the file
    let corrected = Rod::from_toml(&rod.name, &rod_toml)?;
    let physics = Physics::default();
    let fit = rig::fit(readings, Some(rod), &rig::Options::default()).ok();
    let by_ratio = fit.and_then(|fit| fit.measured).map(|m| (m.rod_ratio.value, m.compliance));
    of_rig += model.response(&all) - model.response(&of_rod);
    Ok(Correction {
        readings_csv: without(model, &of_rig, &undone, [&removed, &left_out]),
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

/// The first lines of the corrected rod's file.
fn above(rod: &Rod, readings: &str, undone: &[String], entered: &[WrittenItem]) -> Vec<String> {
    let mut above = vec![format!("Rod {} with what its rig readings ({readings}) show:", rod.name)];
    above.extend(undone.iter().map(|mistake| format!("{mistake} (done)")));
    let entered: Vec<String> = entered.iter().map(WrittenItem::to_string).collect();
    above.extend([
        if entered.is_empty() { "no finding belongs to the rod".into() } else { entered.join("; ") },
        "Moduli are effective values: with them the beam model is as stiff as the rod was.".into(),
    ]);
    above
}

/// Compliance of the rod as its file gave it; of the one that was meant where a mistake made it a
/// rod that cannot be computed.
fn of_file(model: &RigModel, meant: &Rod, physics: &Physics) -> Result<Compliance> {
    let of_file = Compliance::of_model(model.rod_of_file().unwrap_or(meant), physics, DEFAULT_ELEMENTS);
    of_file.or_else(|_| Compliance::of_model(meant, physics, DEFAULT_ELEMENTS))
}

/// The rod with the physics of `findings` that is its own.
pub(in crate::diagnosis::rig) fn as_found(model: &RigModel, rod: &Rod, findings: &[Finding]) -> Rod {
    let mut found = rod.clone();
    let physics = findings.iter().filter(|finding| finding.kind() == Kind::Physics);
    for part in physics.flat_map(|finding| &finding.parts) {
        registry::write(&part.term, model, &mut found);
    }
    found
}
