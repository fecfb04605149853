//! What a campaign says about its calibration.

pub mod arrival;
pub mod beside;
pub mod coarse_angles;
pub mod forward_model;
pub mod hidden_mass;
pub mod hung;
pub mod leverage;
pub mod limits;
pub mod memory;
pub mod one_law;
pub mod prepared;
pub mod scatter;
pub mod sides;
pub mod tails;

use nalgebra::Vector3;

use self::arrival::unknown_arrival;
use self::beside::{calibrated_beside, unequal};
use self::coarse_angles::coarse_angles;
use self::hidden_mass::may_be_hidden;
use self::hung::{BesideMasses, beside_hidden_masses, may_bend, may_hide, with_rivals};
use self::limits::{far_out, limits, noisy};
use self::memory::check_memory;
use self::prepared::{FirstLook, Prepared};
use self::scatter::scattered;
use self::sides::{either, on_the_other_side, unknown_sides};
use self::tails::{Tailed, tailed};
use super::effects::contact::is_of_clamps;
use super::effects::gear::gear_joint;
use super::effects::{EVERY_ROW, registry};
use super::in_order::with_what_follows_the_order;
use super::laws::sites::sites;
use super::model::CalibrationModel;
use super::model::gear::Curve;
use super::next::next_measurements;
use super::write_back::destination::destination;
use crate::calibration::campaign::Campaign;
use crate::calibration::{Calibration, Mode, Options, calibrate};
use crate::diagnosis::{Diagnosed, Limitation};
use crate::error::Result;
use crate::inference::law::propose;
use crate::inference::{
    Discrepancy, Estimate, Finding, Hypothesis, Location, ShownBy, Sketch, Term, diagnose as infer, sketch,
};

/// A campaign's diagnosis.
pub type CalibrationDiagnosis<'c> = Diagnosed<CalibrationModel<'c>>;

/// Calibrates `campaign` as it was recorded and diagnoses what is left: for one that is known to be
/// free of mistakes, such as a simulated one. Of any other [`mend`](super::mend) undoes them first.
///
/// ```
/// use rodcal::diagnosis::calibration::diagnose_as_recorded;
/// use rodcal::prelude::*;
///
/// // simulated with a true rod that is 1.013 times as compliant as its model: too little to be seen
/// let campaign = Campaign::read("campaigns/tx90-5/campaign.toml".as_ref())?;
/// let found = diagnose_as_recorded(&campaign, Mode::Fea, &Options::default())?;
/// assert!(found.diagnosis.findings.is_empty());
/// # Ok::<(), rodcal::Error>(())
/// ```
///
/// # Errors
/// As [`calibrate`].
pub fn diagnose_as_recorded<'c>(
    campaign: &'c Campaign,
    mode: Mode,
    options: &Options,
) -> Result<CalibrationDiagnosis<'c>> {
    diagnose_calibrated(campaign, calibrate(campaign, mode, options)?)
}

/// Diagnoses what a finished calibration of `campaign` leaves. Mistakes in the files are not looked
/// for: of a campaign that may hold some [`mend`](super::mend) undoes them first.
///
/// ```
/// use rodcal::diagnosis::calibration::diagnose_calibrated;
/// use rodcal::prelude::*;
///
/// // simulated with nothing but noise of 18 µm, and a rod that the readings of its rig describe
/// let campaign = Campaign::read("campaigns/tx90-5/campaign.toml".as_ref())?;
/// let calibration = calibrate(&campaign, Mode::Meas, &Options::default())?;
/// let found = diagnose_calibrated(&campaign, calibration)?;
/// assert!(found.diagnosis.findings.is_empty());
/// assert!((found.diagnosis.noise - 18e-6).abs() < 4e-6, "{}", found.diagnosis.noise);
/// # Ok::<(), rodcal::Error>(())
/// ```
///
/// # Errors
/// As [`crate::calibration::Compensation::new`].
pub fn diagnose_calibrated<'c>(
    campaign: &'c Campaign,
    calibration: Calibration<'c>,
) -> Result<CalibrationDiagnosis<'c>> {
    check_memory(campaign)?;
    let mut prepared = Prepared::new(campaign, calibration)?;
    let mut look = FirstLook::default();
    let mut may_hide_masses = false;
    for round in 0..ROUNDS {
        let mut seen = sketch(&prepared.model, &prepared.evidence);
        // once is enough: a search beside it takes as long as the one before
        if round == 0
            && let Some(by_source) = scattered(campaign, &prepared, &seen, &look)?
        {
            (prepared, seen, look.covariance) =
                (by_source.prepared, by_source.sketch, Some(by_source.covariance));
        }
        let Sketch { hypothesis, left, correlated_noise, .. } = seen;
        prepared.evidence.correlated_noise = correlated_noise;
        may_hide_masses |= may_hide(&prepared, &hypothesis);
        let about = calibrated_beside(&prepared, &hypothesis, &left)?.another();
        let noise = unequal(&prepared, &hypothesis, &left)?;
        let is_equal = noise.is_none() == look.scatter.is_none();
        // groups of unequal scatter look like heavy tails as long as they count alike
        let is_asked = look.weights.is_none() && is_equal;
        let tails = if is_asked { tailed(&prepared, &hypothesis, &left)? } else { None };
        let moved_after = moved_after(&prepared, &hypothesis);
        let is_in_place = moved_after.iter().all(|row| look.moved_after.contains(row));
        // clamps get a second look: what is left says how well displacements are known
        let is_read = prepared.context.left_of_rows().is_some() || !is_of_clamps(&prepared.context);
        let other_side = on_the_other_side(&prepared, &hypothesis, &left);
        let is_same = about.is_none() && is_equal && tails.is_none() && other_side.is_empty();
        if is_same && is_in_place && is_read {
            break;
        }
        let turned = either(&look.turned, &other_side);
        let left = Some(prepared.model.by_row(&left));
        let (weights, far_out) = match tails {
            Some(Tailed { weights, open }) => (Some(weights), open),
            None => (look.weights, look.far_out),
        };
        let (about, carried) = match about {
            Some(beside) => (beside.about, beside.carried),
            None => (prepared.about, look.carried),
        };
        let covariance = look.covariance;
        look = FirstLook { scatter: noise, covariance, weights, far_out, left, moved_after, turned, carried };
        let calibration = prepared.model.calibration;
        prepared = Prepared::about(campaign, calibration, about, &look)?;
        prepared.evidence.correlated_noise = correlated_noise;
    }
    let mut rivals = Vec::new();
    if may_hide_masses {
        BesideMasses { prepared, rivals, .. } = beside_hidden_masses(campaign, prepared, &look)?;
    }
    let mut diagnosis = infer(&prepared.model, &prepared.evidence);
    // what nothing explains may be what such a mass has left
    let may_be_a_mass =
        diagnosis.discrepancy.as_ref().is_some_and(|left| left.shown_by != ShownBy::Neighbours);
    if !may_hide_masses && may_be_a_mass && may_bend(&prepared) && may_be_hidden(&prepared.model) {
        let is_another;
        BesideMasses { prepared, rivals, is_another, .. } = beside_hidden_masses(campaign, prepared, &look)?;
        if is_another {
            diagnosis = infer(&prepared.model, &prepared.evidence);
        }
    }
    let one_law = one_law::instead(campaign, &prepared.model.calibration, &look, &diagnosis)?;
    let (one_law, names) = match one_law {
        Some((Some(one), names)) => {
            let Prepared { not_testable, absorbed, .. } = prepared;
            prepared = Prepared { not_testable, absorbed, ..one.prepared };
            diagnosis = one.diagnosis;
            rivals.clear();
            (Some(one.law), Some(names))
        }
        Some((None, law)) => (None, Some(law)),
        None => (None, None),
    };
    let arrival = unknown_arrival(&prepared.model, &mut diagnosis);
    let Prepared { model, evidence, absorbed, not_testable, context, .. } = prepared;
    let next = next_measurements(&model, &context, &evidence, &diagnosis)?;
    for (finding, next) in diagnosis.findings.iter_mut().zip(next) {
        finding.next = next;
    }
    with_rivals(&mut diagnosis, rivals);
    with_what_follows_the_order(&model, &evidence, &mut diagnosis);
    let law = one_law.or_else(|| propose(&model, &diagnosis, &|change| sites(&context, change.len())));
    let mut limits = limits(&context, &model.calibration, &evidence);
    limits.extend(look.scatter.iter().flat_map(|noise| noisy(campaign, noise)));
    limits.extend(arrival);
    limits.extend(coarse_angles(&context, diagnosis.noise));
    limits.extend(names);
    limits.extend(unknown_sides(&context, &diagnosis));
    limits.extend(far_out(&context, &diagnosis, &look.far_out));
    let of_neighbours = evidence.correlated_noise;
    limits.extend(of_neighbours.map(|noise| Limitation::CorrelatedPoses(noise.share, noise.length)));
    let mut found = Diagnosed { model, evidence, diagnosis, not_testable, absorbed, limits, law };
    // what was named varies in whatever way, where it does not explain the poses at all
    let is_told = |left: &Discrepancy| left.shown_by != ShownBy::Varying;
    if !found.diagnosis.discrepancy.as_ref().is_some_and(is_told) && found.is_implausible() {
        let shape = found.diagnosis.after.clone();
        let rms = found.left_by_coordinate();
        found.diagnosis.discrepancy =
            Some(Discrepancy { candidate: None, location: None, shown_by: ShownBy::Size, rms, shape });
    }
    complete(&mut found);
    Ok(found)
}

/// What only the whole diagnosis knows of a finding: where it is written, and the whole error of a
/// gear.
fn complete(found: &mut CalibrationDiagnosis) {
    let wholes: Vec<Vec<Estimate>> =
        found.diagnosis.findings.iter().map(|finding| found.whole_error(finding)).collect();
    let CalibrationDiagnosis { model, diagnosis, .. } = found;
    if let Some(left) = &mut diagnosis.discrepancy {
        // of displacements, not of data that rows count for more or less
        left.rms = rms_by_coordinate(&model.by_row(&left.shape));
    }
    for (finding, whole) in diagnosis.findings.iter_mut().zip(wholes) {
        finding.written_to = destination(finding, model);
        finding.estimates.extend(whole);
        for part in &mut finding.parts {
            let Some(gear) = model.gear_of(part) else { continue };
            part.estimates.extend(gear.frequencies(part, &model.angles(gear.joint())));
        }
    }
}

/// Root mean square of a coordinate of displacements, m.
fn rms_by_coordinate(rows: &[Vector3<f64>]) -> f64 {
    let squares: f64 = rows.iter().map(|row| row.norm_squared()).sum();
    (squares / (3 * rows.len()).max(1) as f64).sqrt()
}

/// Rows, from 0, after which something has moved, where not every row was looked at.
fn moved_after(prepared: &Prepared, hypothesis: &Hypothesis) -> Vec<usize> {
    if prepared.context.configurations.len() <= EVERY_ROW {
        return Vec::new();
    }
    let location = |term: &Term| &prepared.model.terms.candidates[term.candidate].location;
    hypothesis.terms.iter().map(location).filter_map(Location::moved_after).collect()
}

/// So many times a search begins anew about the robot that is left beside what was found, with the
/// scatter that its clamps show then, with what poses count that are no farther out than the tails
/// of the others, with every row near to one after which something moved, and with displacements
/// corrected by what is left of them.
const ROUNDS: usize = 2;

/// Something that happened while the poses were recorded.
#[derive(Debug, Clone, PartialEq)]
#[non_exhaustive]
pub struct Happened {
    /// The first row, from 0, that it changed.
    pub row: usize,
    /// True for what moved before that row and stayed there; false for a single pose.
    pub stays: bool,
    /// For example `clamp 2 moved`, `pose 7`.
    pub label: String,
}

impl CalibrationDiagnosis<'_> {
    /// True where the findings leave more than any robot's error: in the scatter, or in the poses
    /// as they are. Clamps that scatter more than others count less in the former, and one pose
    /// that is far out is no scatter.
    pub fn is_implausible(&self) -> bool {
        let Some(most) = self.evidence.most_scatter else { return false };
        self.diagnosis.noise > most || self.left_by_coordinate() > most
    }

    /// Root mean square of a coordinate of what the findings leave of the poses, m.
    pub fn left_by_coordinate(&self) -> f64 {
        rms_by_coordinate(&self.model.by_row(&self.diagnosis.after))
    }

    /// All that was found of a joint's gear, joints counted from 0; `None` where nothing was.
    pub fn gear(&self, joint: usize) -> Option<Curve> {
        let mut positions = Vec::new();
        let mut parts = Vec::new();
        for part in self.diagnosis.findings.iter().flat_map(|finding| &finding.parts) {
            let own = self.model.gear_of(part).filter(|gear| gear.joint() == joint);
            if let Some(gear) = own {
                let values = part.term.values.clone();
                positions.extend(part.first..part.first + values.len());
                parts.push((gear.clone(), values));
            }
        }
        let covariance = &self.diagnosis.hypothesis.covariance;
        let covariance = covariance.select_rows(&positions).select_columns(&positions);
        let angles = self.model.angles(joint);
        (!parts.is_empty()).then(|| Curve::new(joint, parts, covariance, &angles))
    }

    /// The size of the whole error of the gear that a finding is about; nothing of any other.
    fn whole_error(&self, finding: &Finding) -> Vec<Estimate> {
        let Some((joint, part)) = gear_joint(finding).zip(finding.parts.first()) else {
            return Vec::new();
        };
        let angles = self.model.angles(joint);
        self.gear(joint).map_or_else(Vec::new, |curve| curve.estimates(&angles, part.coverage_factor))
    }

    /// What happened at single poses, in the order of the findings.
    pub fn happened(&self) -> Vec<Happened> {
        let mut happened = Vec::new();
        for part in self.diagnosis.findings.iter().flat_map(|finding| &finding.parts) {
            let effect = self.model.terms.candidates[part.term.candidate].effect;
            let label = registry::record(effect).and_then(|effect| (effect.event)(&part.location));
            let row = self.model.first_row(&part.term);
            let stays = part.location.moved_after().is_some();
            happened.extend(row.zip(label).map(|(row, label)| Happened { row, stays, label }));
        }
        happened
    }
}
