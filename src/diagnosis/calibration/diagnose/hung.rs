//! A mass that nobody stated, where the calibration has hidden it, or a rod heavier than its file.
//!
//! Half a kilogram at the tip is more torque on the wrist than rod and ball are, so that a
//! calibration that knows of none turns its weight into soft drives, about which a mass at the tip
//! draws something else: a rod that bends under its weight is then nearer to what is left. Where
//! rod or masses are what is found, each mass is therefore sought as the calibration itself would
//! see it (`hidden_mass.rs`), and the search is made about that robot too. Where several loads are
//! found, what it took two to explain about a robot that was calibrated with neither, one may
//! explain about its own: a robot beside each of them alone is sought as well, and is the better
//! one at the odds of any finding.
//!
//! What is found about a robot is asked again about the one that is calibrated beside it, and
//! counts where that one leaves what it says: drives that turn by a weight make columns that say
//! nothing of the arm without it.

use super::beside::{Again, Beside, Loads, calibrated_beside, calibrated_with, is_load};
use super::hidden_mass::beside_masses;
use super::prepared::{FirstLook, Prepared};
use crate::calibration::campaign::Campaign;
use crate::diagnosis::calibration::effects::registry::pulls;
use crate::diagnosis::calibration::model::CalibrationModel;
use crate::diagnosis::calibration::model::law::Hung;
use crate::error::Result;
use crate::inference::{APART, Diagnosis, Effect, Hypothesis, Location, NAMED, Rival, Sketch, Term, sketch};

/// Of more rows each calibration takes too long.
const MOST_ROWS: usize = 2000;
/// Times that a robot is calibrated once more beside what is found about it.
const FOLLOWED: usize = 3;
/// Ln of the odds by which the next of them has to be the likelier one, or to name something else,
/// to be followed on.
const ONWARD: f64 = 1.0;

/// True where a mass would bend rod or drives, and the poses are few enough to look for one.
pub fn may_bend(prepared: &Prepared) -> bool {
    prepared.model.campaign.measurements.len() <= MOST_ROWS && is_load(&prepared.model, Hung::Tip)
}

/// True where what was found bends rod or drives as a mass would.
pub fn may_hide(prepared: &Prepared, hypothesis: &Hypothesis) -> bool {
    may_bend(prepared) && loads(&prepared.model, hypothesis).next().is_some()
}

/// The terms of a hypothesis that pull or bend.
fn loads<'h>(model: &'h CalibrationModel, hypothesis: &'h Hypothesis) -> impl Iterator<Item = &'h Term> {
    hypothesis.terms.iter().filter(|term| pulls(model.terms.candidates[term.candidate].effect))
}

/// The most probable of a robot and of those beside a mass that its calibration has hidden.
pub struct BesideMasses<'c> {
    pub prepared: Prepared<'c>,
    /// What is found about the others that are about as probable.
    pub rivals: Vec<Rival>,
    /// False where it is the robot as it was given.
    pub is_another: bool,
    /// Ln of the probability of the poses with all that explains them best, about it or the robot
    /// as it was given.
    pub log_probability: f64,
}

/// Compares a robot with those beside a mass that the calibration has hidden, with those beside
/// each of several loads alone, and with the robot as it was calibrated where that is another one.
pub fn beside_hidden_masses<'c>(
    campaign: &'c Campaign,
    prepared: Prepared<'c>,
    look: &FirstLook,
) -> Result<BesideMasses<'c>> {
    let first = Found::about(prepared, false);
    let plain = first.log_probability();
    let first = first.followed(look, FOLLOWED)?;
    let masses = beside_masses(&first.prepared, first.sketch.hypothesis.sigma)?;
    let alone = beside_one_load(&first.prepared, &first.sketch.hypothesis)?;
    let calibration = first.prepared.model.calibration.clone();
    let about = |beside: Beside<'c>| -> Result<(Found<'c>, FirstLook)> {
        let left = Some(beside.calibration.deviations.iter().map(|deviation| -deviation).collect());
        let look = FirstLook { left, carried: beside.carried, ..look.clone() };
        let other = Prepared::about(campaign, calibration.clone(), beside.about, &look)?;
        Ok((Found::about(other, true), look))
    };
    let mut found = vec![first];
    if !found[0].prepared.is_as_calibrated() {
        let (own, look) = about(Beside::as_calibrated(calibration.clone()))?;
        // the given one was found from here on
        found.push(own.followed(&look, 0)?);
    }
    let masses = masses.into_iter().map(about).collect::<Result<Vec<_>>>()?;
    let likeliest = masses.iter().map(|(own, _)| own.log_probability()).fold(f64::NEG_INFINITY, f64::max);
    for (own, look) in masses {
        let times = if own.log_probability() >= likeliest { FOLLOWED } else { 0 };
        found.push(own.followed(&look, times)?);
    }
    // a load alone is another one than beside others, however improbable it is as it was there
    for (own, look) in alone.into_iter().map(about).collect::<Result<Vec<_>>>()? {
        found.push(own.followed(&look, FOLLOWED)?);
    }
    if found.iter().any(|other| other.holds) {
        found.retain(|other| other.holds);
    }
    let all: Vec<Vec<_>> = found.iter().map(Found::named).collect();
    let probability = |k: usize| found[k].log_probability();
    let by_probability = |a: &usize, b: &usize| probability(*a).total_cmp(&probability(*b));
    let best = (0..found.len()).max_by(by_probability).unwrap_or(0);
    // one load more is named at the odds of any finding
    let is_enough = |k: &usize| {
        let is_part = all[*k].len() < all[best].len() && all[*k].iter().all(|own| all[best].contains(own));
        is_part && !all[*k].is_empty() && probability(best) - probability(*k) < NAMED.ln()
    };
    let best = (0..found.len()).filter(is_enough).max_by(by_probability).unwrap_or(best);
    let chosen = probability(best);
    let own = &all[best];
    let mut rivals = Vec::new();
    for (k, named) in all.iter().enumerate() {
        let odds = (chosen - probability(k)).exp();
        // what stands beside all of that is nothing in its place
        if odds >= APART || (!own.is_empty() && own.iter().all(|known| named.contains(known))) {
            continue;
        }
        let others = named.iter().filter(|known| !own.contains(known)).cloned();
        rivals.extend(others.map(|(effect, location)| Rival::without_term(effect, location, odds)));
    }
    let Found { prepared, is_another, .. } = found.swap_remove(best);
    Ok(BesideMasses { prepared, rivals, is_another, log_probability: plain.max(chosen) })
}

/// A robot with what is found about it.
struct Found<'c> {
    prepared: Prepared<'c>,
    sketch: Sketch,
    /// True where the robot that is calibrated beside that leaves what it says.
    holds: bool,
    /// False where it is the robot as it was given.
    is_another: bool,
}

impl<'c> Found<'c> {
    fn about(mut prepared: Prepared<'c>, is_another: bool) -> Found<'c> {
        let sketch = sketch(&prepared.model, &prepared.evidence);
        prepared.evidence.correlated_noise = sketch.correlated_noise;
        Found { prepared, sketch, holds: false, is_another }
    }

    /// The likeliest of this one and of so many more that are calibrated beside what is found, one
    /// after the other: of those that hold, where any does.
    fn followed(mut self, look: &FirstLook, times: usize) -> Result<Found<'c>> {
        let model = &self.prepared.model;
        let Sketch { hypothesis, left, .. } = &self.sketch;
        let again = calibrated_beside(&self.prepared, hypothesis, left)?;
        self.holds = !matches!(again, Again::Far(_));
        let Some(beside) = again.another().filter(|_| times > 0) else { return Ok(self) };
        let look = FirstLook { left: Some(model.by_row(left)), carried: beside.carried, ..look.clone() };
        let next = Prepared::about(model.campaign, model.calibration.clone(), beside.about, &look)?;
        let next = Found::about(next, true);
        let is_there =
            next.named() == self.named() && next.log_probability() < self.log_probability() + ONWARD;
        let next = next.followed(&look, if is_there { 0 } else { times - 1 })?;
        let worth = |own: &Found| (own.holds, own.log_probability());
        Ok(if worth(&self) > worth(&next) { self } else { next })
    }

    fn log_probability(&self) -> f64 {
        self.sketch.log_probability
    }

    /// What pulls or bends of it.
    fn named(&self) -> Vec<(&'static Effect, Location)> {
        let candidates = &self.prepared.model.terms.candidates;
        let candidate = |term: &Term| &candidates[term.candidate];
        let terms = loads(&self.prepared.model, &self.sketch.hypothesis).map(candidate);
        terms.map(|candidate| (candidate.effect, candidate.location.clone())).collect()
    }
}

/// Has what pulls or bends in a diagnosis stand beside what was found about other robots.
pub fn with_rivals(diagnosis: &mut Diagnosis, rivals: Vec<Rival>) {
    let Some(finding) = diagnosis.findings.iter_mut().find(|finding| pulls(finding.effect)) else { return };
    for rival in rivals {
        let is_it = |known: &Rival| known.effect == rival.effect && known.location == rival.location;
        if !finding.rivals.iter().any(is_it) {
            finding.rivals.push(rival);
        }
    }
    finding.rivals.sort_by(|a, b| a.odds.total_cmp(&b.odds));
}

/// Robots beside each of several loads of a hypothesis alone: what it takes two to explain about a
/// robot that was calibrated with neither, one may explain about its own.
fn beside_one_load<'c>(prepared: &Prepared<'c>, hypothesis: &Hypothesis) -> Result<Vec<Beside<'c>>> {
    let model = &prepared.model;
    let all: Vec<&Term> = loads(model, hypothesis).collect();
    if all.len() < 2 {
        return Ok(Vec::new());
    }
    let mut found = Vec::new();
    for alone in &all {
        let is_beside = |term: &&Term| term == alone || !all.contains(term);
        let terms: Vec<Term> = hypothesis.terms.iter().filter(is_beside).cloned().collect();
        found.extend(calibrated_with(model, &Loads::of(model, &terms))?);
    }
    Ok(found)
}
