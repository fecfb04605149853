//! Poses that were recorded in the order of an angle, or of a coordinate of their places: what
//! happened between them, or drifted, and what the robot does there look alike.

use std::collections::BTreeSet;

use nalgebra::DVector;

use super::model::CalibrationModel;
use super::model::law::{Course, Law};
use crate::calibration::campaign::Row;
use crate::inference::{
    Diagnosis, Discrepancy, Evidence, Finding, ForwardModel, JointVariable, Location, Plan, PlannedPose,
    PosePlan, Proposal, Rival, Term, UNKNOWN, Variable, separates,
};

/// Fewer poses on one side lie beyond the others by chance.
const FEWEST: usize = 4;
/// So large a share of the pairs of an earlier and a later pose have their angles in one order.
const IN_ORDER: f64 = 0.95;
/// Of an error that follows the angle in the order of which the poses were recorded.
const OR_THE_ORDER: &str = ", or the order of the poses, which is that of this angle";
/// So many poses are enough to see what happened come back.
const AGAIN: usize = 8;

/// Gives findings that happened between poses, or changed with the time, what else they may be
/// where the poses were recorded in the order of something else, and the poses that distinguish
/// the two. Of what has no name it is said that it may follow the one or the other.
pub(super) fn with_what_follows_the_order(
    model: &CalibrationModel,
    evidence: &Evidence,
    diagnosis: &mut Diagnosis,
) {
    let sigma = diagnosis.hypothesis.sigma;
    let order = Progress::of_all((0..model.campaign.measurements.len()).map(|row| row as f64).collect());
    for finding in diagnosis.findings.iter_mut().filter(|finding| finding.unnamed.is_none()) {
        let Some(progress) = progress(model, evidence, finding) else { continue };
        let Some(variable) = recorded_along(evidence, &progress) else { continue };
        let rival = Rival::without_term(&UNKNOWN, curve(variable), 1.0);
        finding.parts[0].unnamed = Some(rival.clone());
        finding.unnamed = Some(rival);
        if finding.next.as_ref().is_none_or(|next| next.separates_from.is_empty()) {
            let again = once_more(model, finding, &progress, variable, sigma);
            finding.next = again.or_else(|| finding.next.take());
        }
    }
    if let Some(Discrepancy { candidate: Some(candidate), location: Some(location), .. }) =
        &mut diagnosis.discrepancy
        && let Location::Curve { follows, along: Some(along), .. } = location
    {
        let values = vec![1.0; model.candidates()[*candidate].parameters.len()];
        let response = model.response(&[Term { candidate: *candidate, values }]);
        let progress = match along.is_of_time() {
            true => passed(model, evidence, *along, &response),
            false => Some(order),
        };
        match progress.and_then(|progress| recorded_along(evidence, &progress)) {
            Some(variable) if along.is_of_time() => *follows += &format!(", or {}", self::follows(variable)),
            Some(variable) if variable == *along => *follows += OR_THE_ORDER,
            _ => {}
        }
    }
}

/// How far something had come at each row.
pub(super) struct Progress {
    /// Whether it had happened, or what a clock showed. At clamps and sockets that it does not
    /// concern as little as ever: what follows an angle is the same there.
    pub at: Vec<f64>,
    /// False of rows at those.
    pub concerns: Vec<bool>,
}

impl Progress {
    /// Of what concerns all rows.
    pub fn of_all(at: Vec<f64>) -> Progress {
        Progress { concerns: vec![true; at.len()], at }
    }
}

/// The angle, or the coordinate of the tip, by which the rows at which less had happened differ
/// from those at which more had: nearly all pairs of such two lie one way. Of a step their share is
/// U/mn (H. B. Mann, D. R. Whitney, *Ann. Math. Stat.* 18 (1947) 50–60), of what passes evenly
/// (τ + 1)/2 (M. G. Kendall, *Biometrika* 30 (1938) 81–93).
pub(super) fn recorded_along(evidence: &Evidence, progress: &Progress) -> Option<Variable> {
    let at = &progress.at;
    let rows = || 0..at.len();
    let pairs = || rows().flat_map(|a| rows().map(move |b| (a, b))).filter(|&(a, b)| at[a] < at[b]);
    let (low, high) =
        at.iter().fold((f64::INFINITY, f64::NEG_INFINITY), |(low, high), &at| (low.min(at), high.max(at)));
    let on_side = |is_there: &dyn Fn(f64) -> bool| at.iter().filter(|at| is_there(**at)).count();
    if on_side(&|at| at < high).min(on_side(&|at| at > low)) < FEWEST {
        return None;
    }
    // at one clamp or socket the tip stays where it is, but for what moved it
    let is_everywhere = progress.concerns.iter().all(|concerns| *concerns);
    let is_place = |variable: Variable| match variable {
        Variable::Joint(_, JointVariable::Angle) => true,
        Variable::Tip(_) => is_everywhere,
        _ => false,
    };
    let shares = evidence.covariates.iter().filter(|own| is_place(own.variable)).map(|own| {
        let value = |row: usize| own.values[3 * row];
        let (mut rising, mut all) = (0.0, 0.0);
        for (a, b) in pairs() {
            all += 1.0;
            // equal ones lie no way
            rising += if value(a) < value(b) { 1.0 } else { f64::from(value(a) == value(b)) / 2.0 };
        }
        let share = rising / f64::max(all, 1.0);
        (own.variable, share.max(1.0 - share))
    });
    let most = shares.max_by(|a, b| a.1.total_cmp(&b.1))?;
    (most.1 > IN_ORDER).then_some(most.0)
}

/// What follows `variable`, for people.
fn follows(variable: Variable) -> String {
    let what = match variable {
        Variable::Joint(joint, _) => format!("the angle of joint {}", joint + 1),
        Variable::Tip(axis) => format!("{axis} of the tip"),
        other => other.to_string(),
    };
    format!("follows {what}, in the order of which the poses were recorded")
}

fn curve(variable: Variable) -> Location {
    Location::Curve { label: variable.to_string(), follows: follows(variable), along: Some(variable) }
}

/// How far a finding had come at each row: whether it had happened, or the clock that it follows.
/// Nothing of what has nothing to do with the time.
fn progress(model: &CalibrationModel, evidence: &Evidence, finding: &Finding) -> Option<Progress> {
    let part = finding.parts.first()?;
    let rows = &model.campaign.measurements.rows;
    let law = model.law(part.term.candidate);
    if let Some(last) = part.location.moved_after() {
        let concerns = |row: &Row| !matches!(law, Law::Moved(groups) if !groups.contains(&row.group));
        let concerns: Vec<bool> = rows.iter().map(concerns).collect();
        let has_happened = |(row, concerns): (usize, &bool)| f64::from(*concerns && row > last);
        return Some(Progress { at: concerns.iter().enumerate().map(has_happened).collect(), concerns });
    }
    let along = (finding.effect.seen_along)(&part.location);
    if along.is_empty() || !along.iter().all(|variable| variable.is_of_time()) {
        return None;
    }
    let clock = match law {
        Law::Drift(Course::Temperature, _) | Law::Warms(Course::Temperature, _) => Variable::Temperature,
        _ => Variable::Order,
    };
    passed(model, evidence, clock, &model.response_of(finding))
}

/// What a clock had shown of what makes such a response.
fn passed(
    model: &CalibrationModel,
    evidence: &Evidence,
    clock: Variable,
    response: &DVector<f64>,
) -> Option<Progress> {
    let rows = &model.campaign.measurements.rows;
    let moved = model.by_row(response);
    let groups: BTreeSet<usize> =
        rows.iter().zip(moved).filter(|(_, by)| by.norm() > 0.0).map(|(row, _)| row.group).collect();
    let concerns: Vec<bool> = rows.iter().map(|row| groups.contains(&row.group)).collect();
    let shown = evidence.covariates.iter().find(|own| own.variable == clock)?;
    let own = || (0..rows.len()).filter(|row| concerns[*row]).map(|row| shown.values[3 * row]);
    let least = own().fold(f64::INFINITY, f64::min);
    let at = |row: usize| if concerns[row] { shown.values[3 * row] } else { least };
    Some(Progress { at: (0..rows.len()).map(at).collect(), concerns })
}

/// Some of the first poses after the last: what has happened by then is seen there too, what
/// follows the angle is not.
fn once_more(
    model: &CalibrationModel,
    finding: &Finding,
    progress: &Progress,
    variable: Variable,
    sigma: f64,
) -> Option<Proposal> {
    let recording = &model.campaign.measurements;
    let mut early: Vec<usize> = (0..recording.len()).filter(|row| progress.concerns[*row]).collect();
    early.truncate(match finding.location.moved_after() {
        Some(last) => early.iter().filter(|row| **row <= last).count(),
        None => early.len() / 2,
    });
    let some: Vec<usize> = early.iter().copied().step_by(early.len().div_ceil(AGAIN).max(1)).collect();
    // ½·‖change‖²/σ², and the change between early and late poses is no less than what it explains
    let log_odds = 3.0 * some.len() as f64 * finding.explains.powi(2) / (2.0 * sigma.powi(2));
    if !separates(log_odds) {
        return None;
    }
    let pose = |row: &usize| recording.rows[*row].pose.as_str();
    let is_unique = |row: &usize| recording.rows.iter().filter(|other| other.pose == pose(row)).count() == 1;
    let names: Vec<String> = match some.iter().all(is_unique) {
        true => some.iter().map(|row| pose(row).to_owned()).collect(),
        false => some.iter().map(|row| recording.pose_name(*row)).collect(),
    };
    let planned = |row: &usize| PlannedPose {
        joints: recording.joints(*row).to_vec(),
        group: recording.rows[*row].group,
        like: *row,
    };
    let plan = PosePlan { poses: some.iter().map(planned).collect(), new_fixture: None };
    Some(Proposal {
        description: format!("Measure poses {} once more, after the last one.", names.join(", ")),
        plan: Some(Plan::Poses(plan)),
        log_odds,
        separates_from: vec![(&UNKNOWN, curve(variable))],
    })
}
