//! The readings of a rig without names, where one law does as well.

use crate::diagnosis::Limitation;
use crate::diagnosis::one_law::{Instead, compared, may_do, names};
use crate::diagnosis::rig::laws::sites;
use crate::diagnosis::rig::model::RigModel;
use crate::diagnosis::rig::model::wanted::Wanted;
use crate::error::Result;
use crate::inference::law::{Proposed, propose_where};
use crate::inference::{Diagnosis, Evidence, ShownBy, diagnose};
use crate::rig::readings::Readings;
use crate::rod::Rod;

/// Readings that one law explains without any name.
pub(super) struct OneLaw {
    pub model: RigModel,
    pub evidence: Evidence,
    pub diagnosis: Diagnosis,
    pub law: Proposed,
}

/// What is said of the names, and the same readings without them where one law does as well as
/// those of `named`.
pub(super) fn instead(
    readings: &Readings,
    (rod, bent): (Option<&Rod>, Option<&Rod>),
    named: &Diagnosis,
) -> Result<Option<(Option<OneLaw>, Limitation)>> {
    if names(named).is_empty() {
        return Ok(None);
    }
    let (model, evidence, _) = RigModel::bent_as(readings, rod, &Wanted::Unnamed, bent)?;
    let diagnosis = diagnose(&model, &evidence);
    if !diagnosis.discrepancy.as_ref().is_some_and(|left| left.shown_by == ShownBy::Curve) {
        return Ok(None);
    }
    let is_hopeful = |left: &_| may_do(left, &diagnosis, named);
    let Some(law) = propose_where(&model, &diagnosis, &|change| sites::sites(&model, change), &is_hopeful)
    else {
        return Ok(None);
    };
    Ok(compared(&law, &diagnosis, named).map(|instead| match instead {
        Instead::Law(names) => (Some(OneLaw { model, evidence, diagnosis, law }), names),
        Instead::Rival(law) => (None, law),
    }))
}
