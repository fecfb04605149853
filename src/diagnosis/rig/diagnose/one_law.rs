//! One law where several names would be needed.
//!
//! A root that gives way by M^0.6 is a compliant root, an offset of the load and a stiffness that
//! depends on it, together: each is there for what the others do not draw. Where three names or
//! more are needed, or two beside a curve, a law is looked for in their place. It is the answer
//! where it needs fewer numbers, leaves as little, and predicts readings that were held out as well
//! as the names do. One name beside a curve is a cause that is known, if not by its very law.

use crate::diagnosis::Limitation;
use crate::diagnosis::rig::laws::sites;
use crate::diagnosis::rig::model::RigModel;
use crate::diagnosis::rig::model::wanted::Wanted;
use crate::error::Result;
use crate::inference::law::{Law, Proposed, propose};
use crate::inference::{Diagnosis, Evidence, Finding, Kind, ShownBy, diagnose};
use crate::rig::readings::Readings;
use crate::rod::Rod;

/// So many names, a curve counted as one, are many.
const MANY: usize = 3;
/// A curve has more numbers than these.
const OF_CURVE: usize = 2;
/// A law that leaves at most so much more, as a factor, leaves as little: names may have a curve
/// beside them, which takes up a part of the scatter.
const AS_LITTLE: f64 = 1.15;

/// Numbers of the files may be off by so much more beside the law, as a sum of the squares of their
/// standard uncertainties.
const FARTHER: f64 = 9.0;

/// Readings that one law explains without any name.
pub(super) struct OneLaw {
    pub model: RigModel,
    pub evidence: Evidence,
    pub diagnosis: Diagnosis,
    pub law: Proposed,
    /// The names that would be needed instead.
    pub names: Limitation,
}

/// The same readings without names, where one law does as well as those of `named`.
pub(super) fn instead(
    readings: &Readings,
    (rod, bent): (Option<&Rod>, Option<&Rod>),
    named: &Diagnosis,
) -> Result<Option<OneLaw>> {
    let physics: Vec<&Finding> =
        named.findings.iter().filter(|finding| finding.kind() == Kind::Physics).collect();
    let has_curve = named.discrepancy.as_ref().is_some_and(|left| left.shown_by == ShownBy::Curve);
    let are_many = physics.len() + usize::from(has_curve) >= MANY;
    if !are_many || physics.len() < named.findings.len() {
        return Ok(None);
    }
    let of_names = physics.iter().map(|finding| finding.estimates.len()).sum::<usize>();
    let numbers = of_names + if has_curve { OF_CURVE } else { 0 };
    let (model, evidence, _) = RigModel::bent_as(readings, rod, &Wanted::Unnamed, bent)?;
    let diagnosis = diagnose(&model, &evidence);
    if !diagnosis.discrepancy.as_ref().is_some_and(|left| left.shown_by == ShownBy::Curve) {
        return Ok(None);
    }
    // what numbers of the files are then, as Σ z²
    let square = |background: &[f64]| -> f64 {
        diagnosis.settled.0.folded.clone().filter_map(|k| background.get(k)).map(|z| z * z).sum()
    };
    let Some(law) = propose(&model, &diagnosis, &|change| sites::sites(&model, change)) else {
        return Ok(None);
    };
    let does_as_well = law.law.as_ref().is_ok_and(|law| {
        let held_out = named.held_out.as_ref().map(|names| names.after);
        let predicts = law.held_out.zip(held_out).is_some_and(|(own, names)| own <= names);
        let farther = square(&law.beside.background) - square(named.hypothesis.background.as_slice());
        numbers_of(law) < numbers
            && farther < FARTHER
            && law.noise <= AS_LITTLE * named.noise
            && predicts
            && law.more.is_none()
    });
    if !does_as_well {
        return Ok(None);
    }
    let mut causes: Vec<&str> = physics.iter().map(|finding| finding.effect.cause).collect();
    causes.dedup();
    let names = Limitation::NamesForLaw(causes.join(", "), of_names);
    Ok(Some(OneLaw { model, evidence, diagnosis, law, names }))
}

fn numbers_of(law: &Law) -> usize {
    let own = law.amplitudes.len() + usize::from(law.constant.is_some()) + law.of_loop.len();
    own + law.second.as_ref().map_or(0, |second| numbers_of(&second.law))
}
