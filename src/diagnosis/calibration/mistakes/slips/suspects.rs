//! What may have happened to one row, as a list.

use std::f64::consts::PI;

use super::super::draft::{Cell, Draft, DraftChange, Rows};
use super::super::moves::PossibleMistake;
use super::super::names::{AXES, cell, column, place, pose_name};
use super::super::search::MistakeSearch;
use super::super::search::part::within;
use super::super::typed::{Meant, meant, tidy};
use crate::calibration::campaign::Recording;
use crate::diagnosis::calibration::effects::mistakes::TYPING_MISTAKE;
use crate::inference::{Effect, Estimate, Key};
use crate::robot::Motion;
use crate::units::{DEG, MM};

/// A joint of which nothing is known turns as far as its column shows, or this, rad.
const TURN: f64 = 2.0 * PI;

/// What may have happened to a row.
pub struct Suspect {
    pub effect: &'static Effect,
    pub change: DraftChange,
    pub location: Key,
    pub cure: String,
    pub why: String,
    pub estimates: Vec<Estimate>,
    pub log_prior: f64,
}

impl MistakeSearch<'_> {
    pub(super) fn unit(&self, draft: &Draft, joint: usize) -> f64 {
        match self.bodies[draft.body].robot.joints[joint].motion {
            Motion::Revolute => DEG,
            Motion::Prismatic => MM,
        }
    }

    /// Each number of a row as it may have been meant.
    pub(super) fn typed(
        &self,
        draft: &Draft,
        at: usize,
        columns: &[usize],
        recording: &Recording,
    ) -> Vec<Suspect> {
        let (row, count) = (draft.rows[at], draft.joint_count);
        let pose = pose_name(recording, row);
        let robot = self.bodies[draft.body].robot;
        let mut all = Vec::new();
        let mut add = |own: Cell, name: String, unit: f64, recorded: f64, places: usize| {
            let recorded = tidy(recorded / unit);
            for Meant { text, why, log_prior } in meant(recorded, places) {
                let value = text.parse::<f64>().unwrap_or(f64::NAN);
                if !self.is_reached(draft, own, value * unit) {
                    continue;
                }
                all.push(Suspect {
                    effect: &TYPING_MISTAKE,
                    change: DraftChange::Number { row, cell: own, value: value * unit },
                    location: cell(&name, &pose),
                    cure: format!("Write {text} for {recorded:.places$} as {name} of {pose}"),
                    why: why.into(),
                    estimates: vec![Estimate::as_written("meant", value, value, value)],
                    log_prior,
                });
            }
        };
        for (joint, &places) in columns.iter().enumerate().take(count) {
            let recorded = draft.joints(at)[joint];
            add(Cell::Joint(joint), column(robot, joint), self.unit(draft, joint), recorded, places);
        }
        for (axis, name) in AXES.into_iter().enumerate().filter(|_| !draft.has_sockets()) {
            add(Cell::Axis(axis), name.into(), MM, draft.seen[at][axis], columns[count + axis]);
        }
        all
    }

    /// False of an angle that a joint does not reach: a whole turn more brings a row home as well.
    fn is_reached(&self, draft: &Draft, cell: Cell, value: f64) -> bool {
        let Cell::Joint(joint) = cell else { return true };
        let own = &self.bodies[draft.body].robot.joints[joint];
        let column = draft.joints.iter().skip(joint).step_by(draft.joint_count);
        let farthest = column.fold(TURN, |most: f64, q| most.max(q.abs()));
        own.motion == Motion::Prismatic
            || own.limits.map_or(value.abs() <= farthest, |[low, high]| (low..=high).contains(&value))
    }

    /// What may happen to many rows, at one.
    pub(super) fn of_whole_row(&self, draft: &Draft, at: usize, recording: &Recording) -> Vec<Suspect> {
        let row = draft.rows[at];
        let rows = Rows::Between(row, row);
        let of_own = |own: &PossibleMistake| Suspect {
            effect: own.effect,
            change: within(rows, &own.change),
            location: cell(&own.location.names, &pose_name(recording, row)),
            cure: format!("{} {}", own.cure, place(recording, rows)),
            why: own.why.clone(),
            estimates: own.estimates.clone(),
            log_prior: own.log_prior,
        };
        // a row whose angles are its neighbour's may hold the wrong angles as well
        let is_beside = |by: isize| {
            let beside = at.checked_add_signed(by).filter(|&other| other < draft.len());
            beside.is_some_and(|other| draft.joints(other) == draft.joints(at))
        };
        let may_be = |own: &&PossibleMistake| match own.change {
            DraftChange::Rows { by, .. } => !is_beside(by),
            DraftChange::Zero { .. } => false,
            _ => true,
        };
        self.of_rows.iter().filter(may_be).map(of_own).collect()
    }
}
