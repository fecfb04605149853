//! The poses of a campaign without names, where one law does as well.

use super::prepared::{FirstLook, Prepared};
use crate::calibration::Calibration;
use crate::calibration::campaign::Campaign;
use crate::diagnosis::Limitation;
use crate::diagnosis::calibration::laws::sites::sites;
use crate::diagnosis::one_law::{Instead, compared, may_do, names};
use crate::error::Result;
use crate::inference::law::{Proposed, propose_where};
use crate::inference::{Diagnosis, ShownBy, diagnose};

/// More names than so many are more than one law can be.
const MOST_NAMES: usize = 3;

/// Poses that one law explains without any name.
pub struct OneLaw<'c> {
    pub prepared: Prepared<'c>,
    pub diagnosis: Diagnosis,
    pub law: Proposed,
}

/// What is said of the names, and the same poses without them where one law does as well as those
/// of `named`.
pub fn instead<'c>(
    campaign: &'c Campaign,
    calibration: &Calibration<'c>,
    look: &FirstLook,
    named: &Diagnosis,
) -> Result<Option<(Option<OneLaw<'c>>, Limitation)>> {
    let count = names(named).len();
    if count == 0 || count > MOST_NAMES {
        return Ok(None);
    }
    let prepared = Prepared::unnamed(campaign, calibration.clone(), look)?;
    let diagnosis = diagnose(&prepared.model, &prepared.evidence);
    if !diagnosis.discrepancy.as_ref().is_some_and(|left| left.shown_by == ShownBy::Curve) {
        return Ok(None);
    }
    let context = &prepared.context;
    let is_hopeful = |left: &_| may_do(left, &diagnosis, named);
    let Some(law) =
        propose_where(&prepared.model, &diagnosis, &|change| sites(context, change.len()), &is_hopeful)
    else {
        return Ok(None);
    };
    Ok(compared(&law, &diagnosis, named).map(|instead| match instead {
        Instead::Law(names) => (Some(OneLaw { prepared, diagnosis, law }), names),
        Instead::Rival(law) => (None, law),
    }))
}
