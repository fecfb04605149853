//! From readings to findings: mistakes first, then the physics of what is left.

mod another_rod;
mod as_measured;
mod limits;
mod one_law;

use super::effects::mistakes::UNIT_MISTAKE;
use super::effects::structure::STIFFNESS_SCALE;
use super::laws::sites;
use super::measurements::next;
use super::mistakes;
use super::mistakes::Mended;
use super::model::wanted::Wanted;
use super::model::{AsRecorded, RigDiagnosis, RigModel};
use super::own_effect::OwnEffect;
use super::recording::columns::load_column;
use super::write_back::as_found;
use crate::diagnosis::Diagnosed;
use crate::error::{Error, Place, Result};
use crate::inference::law::propose;
use crate::inference::{
    Diagnosis, Evidence, Finding, Location, Part, Rival, ShownBy, diagnose as infer, rms,
};
use crate::rig::readings::Readings;
use crate::rod::Rod;

/// Most rows of readings that are diagnosed.
pub(super) const MOST_ROWS: usize = 100_000;
/// Times that a rod is bent anew as it was found.
const MOST_BENT: usize = 3;
/// A number of the file that is so many standard uncertainties off is hardly what was meant.
const FAR: f64 = 2.0;
/// Part of the noise that a systematic error shows from.
const SHOWN: f64 = 0.3;

/// Diagnoses `readings` against the FEA model of `rod` as its file gives it, or, without a rod,
/// against straight lines through the origin.
///
/// ```
/// use rodcal::diagnosis::rig::diagnose;
/// use rodcal::prelude::*;
///
/// // without a rod: against straight lines through the origin
/// let mut table = "axis,load_n,dy_um\n".to_owned();
/// for step in 1..=8 {
///     let load = f64::from(step);
///     table += &format!("y,{load},{:.1}\n", 45.0 * load + 1.5 * load * load); // no straight line
/// }
/// let found = diagnose(&Readings::from_text("readings.csv", &table)?, None)?;
/// assert!(found.diagnosis.is_mismatch());
/// # Ok::<(), rodcal::Error>(())
/// ```
///
/// # Errors
/// See [`RigModel::new`].
pub fn diagnose(readings: &Readings, rod: Option<&Rod>) -> Result<RigDiagnosis> {
    diagnose_among(readings, rod, &[])
}

/// Diagnoses `readings` as [`diagnose`] does, where they may also be those of one of `others`: rods
/// with the names of their files, such as all that stand beside the given one.
///
/// Mistakes are looked for first. They stand before all other findings, which are those of the
/// corrected readings and the corrected rod.
///
/// ```
/// use rodcal::answer::rods_beside;
/// use rodcal::diagnosis::rig::diagnose_among;
/// use rodcal::prelude::*;
///
/// // readings of rod 5, with the file of another rod
/// let wrong = Rod::read("rods/2.toml".as_ref())?;
/// let readings = Readings::read("stiffness_data/5.csv".as_ref())?;
/// let others = rods_beside("rods/2.toml".as_ref());
/// let found = diagnose_among(&readings, Some(&wrong), &others)?;
/// assert_eq!(found.diagnosis.findings[0].effect.name, "rod_mistake");
/// # Ok::<(), rodcal::Error>(())
/// ```
///
/// # Errors
/// [`Error::Input`] for more than 100 000 rows; see also [`RigModel::new`].
pub fn diagnose_among(
    readings: &Readings,
    rod: Option<&Rod>,
    others: &[(String, Rod)],
) -> Result<RigDiagnosis> {
    diagnose_with(readings, rod, others, &[])
}

/// The same, with effects that a lab describes itself: they compete with those of the library.
///
/// ```
/// use rodcal::diagnosis::rig::{OwnEffect, diagnose_with};
/// use rodcal::prelude::*;
///
/// let rod = Rod::read("rods/5.toml".as_ref())?;
/// let readings = Readings::read("stiffness_data/5.csv".as_ref())?;
/// let own = OwnEffect::from_toml("own.toml", "
///     [[effect]]
///     name = \"foot\"
///     words = \"a foot\"
///     place = \"clamp\"
///     variable = \"load\"
///     law = \"a*tanh(F/3)\"
///     parameter = [{ name = \"a\", size = 20 }]
/// ")?;
/// let found = diagnose_with(&readings, Some(&rod), &[], &own)?;
/// // it was looked for; friction explains the readings better
/// assert_eq!(found.diagnosis.findings[0].effect.name, "friction");
/// # Ok::<(), rodcal::Error>(())
/// ```
///
/// # Errors
/// As [`diagnose_among`]; [`Error::Input`] for an effect that readings and rod do not fit.
pub fn diagnose_with(
    readings: &Readings,
    rod: Option<&Rod>,
    others: &[(String, Rod)],
    own: &[OwnEffect],
) -> Result<RigDiagnosis> {
    check_size(readings)?;
    let mut mended = mistakes::mended(readings, rod, others)?;
    let inferred = |mended: &Mended, bent: Option<&Rod>| {
        let (mended_readings, mended_rod) = match mended.has_data {
            true => (&mended.readings, mended.rod.as_ref()),
            false => (readings, rod),
        };
        let (model, evidence, not_testable) =
            RigModel::bent_as(mended_readings, mended_rod, &Wanted::AllAnd(own), bent.or(mended_rod))?;
        let diagnosis = infer(&model, &evidence);
        Ok::<_, Error>((model, evidence, not_testable, diagnosis))
    };
    let (mut model, mut evidence, mut not_testable, mut diagnosis) = inferred(&mended, None)?;
    // the slopes are those of another rod, but the readings are not
    if mended.other_rod().is_some_and(|rod| !another_rod::is_cured(rod.explains, &diagnosis)) {
        mended = mistakes::mended(readings, rod, &[])?;
        (model, evidence, not_testable, diagnosis) = inferred(&mended, None)?;
    }
    if mended.take_zeros_back(&diagnosis.findings) {
        (model, evidence, not_testable, diagnosis) = inferred(&mended, None)?;
    }
    let mut others = another_rod::others(&mended, &model, &evidence, &diagnosis);
    another_rod::add_rivals(&others, &model, &mut diagnosis);
    if let Some(meant) = others.first().filter(|meant| meant.is_meant()) {
        let mut taken = mended.clone();
        taken.take(meant.rod.clone(), meant.log_odds, meant.explains, meant.rivals.clone());
        let of_other = inferred(&taken, None)?;
        let (.., left) = &of_other;
        // of two rods that both leave something unexplained neither is the right one beyond doubt
        if left.discrepancy.is_none() && another_rod::is_cured(meant.explains, left) {
            mended = taken;
            (model, evidence, not_testable, diagnosis) = of_other;
            // that is decided
            others.clear();
        }
    }
    // a rod that is much softer than its file bends much farther, which may change what was found
    let mut bent = model.rod.clone();
    for _ in 0..MOST_BENT {
        let Some(found) = bends_farther(&model, bent.as_ref(), &diagnosis)? else { break };
        (model, evidence, not_testable, diagnosis) = inferred(&mended, Some(&found))?;
        another_rod::add_rivals(&others, &model, &mut diagnosis);
        bent = Some(found);
    }
    // what a lab describes itself it has named
    let one_law = match mended.found.is_empty() && own.is_empty() {
        true => one_law::instead(readings, (rod, bent.as_ref().or(rod)), &diagnosis)?,
        false => None,
    };
    let (one_law, names) = match one_law {
        Some((Some(one), names)) => {
            (model, evidence, diagnosis) = (one.model, one.evidence, one.diagnosis);
            (Some(one.law), Some(names))
        }
        Some((None, law)) => (None, Some(law)),
        None => (None, None),
    };
    as_measured::resize(&model, &evidence, &mut diagnosis);
    if mended.has_data {
        for k in 0..diagnosis.findings.len() {
            let next = next::next_measurement(&model, &evidence, &diagnosis, &diagnosis.findings[k])?;
            let units = mistakes::lookalikes(&model, &evidence, &diagnosis.findings, k);
            let finding = &mut diagnosis.findings[k];
            finding.next = next;
            if !units.is_empty() {
                // a unit is looked up, which is sooner done than any measurement
                finding.next = finding.direct_check(&units.iter().collect::<Vec<_>>());
                finding.rivals.splice(0..0, units);
            }
        }
    } else {
        // nothing is left that physics could be seen in
        diagnosis.findings.clear();
        diagnosis.discrepancy = None;
    }
    // of readings that a mistake has spoilt nobody knows what it has left
    let law = match (one_law, mended.found.is_empty()) {
        (Some(law), _) => Some(law),
        (None, true) => propose(&model, &diagnosis, &|change| sites::sites(&model, change)),
        (None, false) => None,
    };
    if !mended.found.is_empty() {
        let recorded = RigModel::with_effects(readings, rod, &Wanted::Like(&[])).ok();
        if let Some((recorded, evidence, _)) = &recorded {
            add_stiffness(&mut mended.found, recorded, evidence, &diagnosis);
        }
        // what the rod itself had to say of the readings' unit they do not say of the rod
        if mended.found.iter().any(mistakes::is_unknown_unit) {
            diagnosis.nominal.clear();
        }
        diagnosis.findings.splice(0..0, mended.found);
        let error = recorded.map(|(_, evidence, _)| rms(&evidence.residual));
        model.as_recorded =
            Some(Box::new(AsRecorded { readings: readings.clone(), rod: rod.cloned(), error }));
    }
    let mut limits = limits::limits(&model, &evidence);
    limits.extend(names);
    Ok(Diagnosed { absorbed: Vec::new(), not_testable, limits, law, diagnosis, evidence, model })
}

/// The rod as it was found, where its deflections are so large that those of `bent` miss what
/// readings show.
fn bends_farther(model: &RigModel, bent: Option<&Rod>, diagnosis: &Diagnosis) -> Result<Option<Rod>> {
    let (Some(rod), Some(bent)) = (model.rod(), bent) else { return Ok(None) };
    let found = as_found(model, rod, &diagnosis.findings);
    if found == *bent {
        return Ok(None);
    }
    let more = model.large_deflections(&found)? - model.large_deflections(bent)?;
    Ok((more.amax() > SHOWN * diagnosis.noise).then_some(found))
}

/// A unit that leaves a rod of another stiffness than its file's is less sure than one that leaves
/// nothing: one rod that is so much softer or stiffer explains both.
fn add_stiffness(mistakes: &mut [Finding], recorded: &RigModel, evidence: &Evidence, left: &Diagnosis) {
    let is_stiffness = |finding: &Finding| *finding.effect == STIFFNESS_SCALE.effect;
    let is_left = left.findings.iter().any(is_stiffness)
        || left.discrepancy.as_ref().is_some_and(|left| left.shown_by == ShownBy::Numbers)
        || left.nominal.iter().any(|number| number.moved().abs() > FAR);
    if !mistakes::is_one_factor(recorded, evidence) {
        return;
    }
    // of a factor that is no unit's, or a rod's as well, numbers of its file may be the cause
    let loads = Location::key(load_column(recorded.readings.load_column));
    let is_like_a_rod = |mistake: &Finding| mistake.location == loads && mistakes::is_like_a_rod(mistake);
    let may_be = |mistake: &Finding| is_left || mistakes::is_unknown_unit(mistake) || is_like_a_rod(mistake);
    let units = mistakes.iter_mut().filter(|mistake| *mistake.effect == UNIT_MISTAKE);
    for mistake in units.filter(|mistake| may_be(mistake)) {
        let rod = Location::Part(Part::Rod);
        mistake.rivals.push(Rival::without_term(&STIFFNESS_SCALE.effect, rod, 1.0));
    }
}

/// Refuses what would take more memory or time than anybody has.
fn check_size(readings: &Readings) -> Result<()> {
    match readings.rows.get(MOST_ROWS) {
        None => Ok(()),
        Some(row) => Err(Error::Input {
            at: Place { file: readings.file.clone(), line: row.line, column: 0 },
            found: format!("{} rows of readings", readings.rows.len()),
            expected: format!("at most {MOST_ROWS} for a diagnosis"),
            hint: Some("diagnose some of the trials at a time".into()),
        }),
    }
}
