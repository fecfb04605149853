//! Every mistake that a campaign's files may hold, as a list of what undoes each.

pub(super) mod bodies;
mod conventions;
mod frames;
mod joints;
pub(super) mod links;
pub(super) mod masses;
pub(super) mod of_rows;
mod positions;
pub(super) mod robots;
pub(super) mod rods;

use nalgebra::Vector3;

pub(super) use self::conventions::turn;
use super::super::effects::mistakes::SIGN_MISTAKE;
use super::draft::{Draft, DraftChange};
use super::names::column;
use crate::calibration::campaign::Campaign;
use crate::inference::{Effect, Estimate, Key};
use crate::robot::Robot;
use crate::rod::Rod;

/// Ln of how much rarer some mistakes are.
const UNUSUAL: f64 = -1.0;
const RARE: f64 = -2.0;

/// A mistake that may have been made, with what is said of it.
#[derive(Clone)]
pub(super) struct PossibleMistake {
    pub effect: &'static Effect,
    pub location: Key,
    pub change: DraftChange,
    pub log_prior: f64,
    /// What the contact force is multiplied by, where that is all.
    pub force: Option<f64>,
    pub estimates: Vec<Estimate>,
    /// What to do: `Multiply q4_deg by −1`.
    pub cure: String,
    /// Why: `its sign is wrong`.
    pub why: String,
}

impl PossibleMistake {
    /// Whether a force or gravity changes its sign.
    pub fn is_load(&self) -> bool {
        self.effect == &SIGN_MISTAKE && matches!(self.change, DraftChange::Body(..))
    }

    /// What explains poses as well, at such odds.
    pub fn with_odds(&self, odds: f64) -> (&'static Effect, Key, f64) {
        (self.effect, self.location.clone(), odds)
    }
}

/// A robot as its file may be meant.
pub struct Reading {
    pub robot: Robot,
    pub(super) effect: &'static Effect,
    pub(super) key: String,
    pub(super) log_prior: f64,
    pub(super) estimates: Vec<Estimate>,
    pub(super) cure: String,
    pub(super) why: &'static str,
}

/// A robot or rod of another file.
pub(super) struct Other {
    pub file: String,
    pub name: String,
    pub is_rod: bool,
    /// The tip of a rod.
    pub tip: Option<Vector3<f64>>,
    /// Its number among the bodies.
    pub body: usize,
}

/// All that these files could show.
pub(super) fn all(
    campaign: &Campaign,
    draft: &Draft,
    others: &[Other],
    forces: &[(usize, f64)],
    robots: &[(usize, &Reading)],
    exchanged: Option<(usize, &Rod)>,
    zeros: &[(usize, f64)],
) -> Vec<PossibleMistake> {
    let mut list = List { campaign, draft, moves: Vec::new(), is_of_rows: false };
    list.joints();
    list.zeros(zeros);
    list.positions();
    list.rows();
    list.displaced_columns();
    list.clamps();
    list.base();
    list.tool();
    list.files(others);
    list.contact_forces(forces);
    list.robots(robots);
    list.exchanged_pipes(exchanged);
    list.moves
}

struct List<'a> {
    campaign: &'a Campaign,
    draft: &'a Draft,
    moves: Vec<PossibleMistake>,
    /// True for what some rows hold and others do not.
    is_of_rows: bool,
}

/// An exact number.
pub(super) fn exact(name: &str, value: f64) -> Vec<Estimate> {
    vec![Estimate::as_written(name, value, value, value)]
}

impl List<'_> {
    pub(super) fn add(
        &mut self,
        effect: &'static Effect,
        location: Key,
        change: DraftChange,
        cure: &str,
        why: &str,
    ) -> &mut PossibleMistake {
        self.moves.push(PossibleMistake {
            effect,
            location,
            change,
            log_prior: 0.0,
            force: None,
            estimates: Vec::new(),
            cure: cure.into(),
            why: why.into(),
        });
        let last = self.moves.len() - 1;
        &mut self.moves[last]
    }

    pub(super) fn column(&self, joint: usize) -> String {
        column(&self.campaign.robot, joint)
    }
}
