//! Where a clamp stands and how it is turned, as its own poses say.
//!
//! With the place of one clamp free, the others place the robot, and the middle of its residuals is
//! how far it stands from where the file has it. How it is turned is the rotation D that brings
//! what its device showed closest to where the tips were (W. Kabsch, *Acta Cryst.* A32 (1976) 922):
//!
//! ```text
//! min Σ |tipᵢ − mean tip − D·(uᵢ − mean u)|²
//! ```
//!
//! A number that was typed wrongly is looked for behind both; where there is none, the place or the
//! rotation that was found is the frame that was meant.

use nalgebra::Vector3;

use super::super::draft::DraftChange;
use super::super::moves::turn;
use super::super::quick::{Worthwhile, placed, weight_of};
use super::super::typed::{Meant, decimals, meant, tidy};
use super::elsewhere::{LEAST_ROWS, WIDTH, width};
use super::{FittedDraft, MistakeSearch, SearchStep};
use crate::spatial::Pose;
use crate::statistics::median;
use crate::units::{DEG, MM};

/// Fewest clamps of which one may stand elsewhere: three place the robot.
const FEWEST: usize = 4;
/// A place or a rotation of its own is tried where the rows of a clamp do not fit: so many scales
/// off in the middle, or in a fit that leaves such a share of the reach.
const UNLIKE: f64 = 2.0;
const POOR: f64 = 1e-3;
/// The least that is called another place, m, and another rotation, rad: less is left to the
/// effects. A number that was meant lies within them too.
const LEAST: (f64, f64) = (2.0 * MM, 2.0 * DEG);
/// A neighbour is displaced alike where no more than this share of the displacement is left of it.
const SHARED: f64 = 0.3;
/// So many standard deviations are a rotation.
const SURE: f64 = 4.0;

/// A frame of a clamp as it was meant.
pub struct Meaning {
    pub clamp: usize,
    pub frame: Pose,
    /// Which of its three numbers was another one.
    pub typed: Option<(usize, Meant)>,
}

impl MistakeSearch<'_> {
    /// Other places and rotations of clamps.
    pub fn fixtures(&self, from: &FittedDraft) -> Vec<DraftChange> {
        let thin = &from.thin;
        let count = thin.devices.len();
        if self.draft.has_sockets() || count < FEWEST {
            return Vec::new();
        }
        let reach = self.bodies[thin.body].reach;
        let is_poor = from.fit.scale > POOR * reach;
        let mut all = Vec::new();
        for clamp in 0..count {
            let rows = rows_of(from, clamp);
            let others: Vec<usize> = (0..thin.len()).filter(|&at| thin.group[at] != clamp).collect();
            let left: Vec<f64> = rows.iter().map(|&at| from.fit.residuals[at]).collect();
            let is_unlike = median(&left).is_some_and(|left| left > UNLIKE * from.fit.scale);
            if rows.len() < LEAST_ROWS || width(thin, &others) < WIDTH * reach || !(is_unlike || is_poor) {
                continue;
            }
            if thin.loose.is_empty() {
                all.push(DraftChange::Placed(clamp));
            }
            all.extend(self.turned(from, clamp).map(|frame| DraftChange::Devices(vec![(clamp, frame)])));
        }
        all
    }

    /// A clamp turned as its poses say, where that is another rotation than it has.
    pub fn turned(&self, from: &FittedDraft, clamp: usize) -> Option<Pose> {
        let (thin, body) = (&from.thin, &self.bodies[from.thin.body]);
        let tips = from.fit.tips(thin, body);
        let weight = vec![1.0; thin.len()];
        let found = placed(&thin.seen, &tips, &weight, |at| thin.group[at] == clamp)?;
        let stated = thin.devices[clamp];
        let rows = rows_of(from, clamp);
        let middle = rows.iter().map(|&at| thin.seen[at]).sum::<Vector3<f64>>() / rows.len() as f64;
        let spread: f64 = rows.iter().map(|&at| (thin.seen[at] - middle).norm_squared()).sum();
        let sd = from.fit.scale / (spread / 3.0).sqrt().max(f64::MIN_POSITIVE);
        let angle = turn(&stated.rotation, &found.rotation);
        (angle > LEAST.1.max(SURE * sd)).then_some(Pose { rotation: found.rotation, ..stated })
    }

    /// False where a clamp stands so near its place that the effects find it, and where the pose
    /// before or after its own, in another clamp, is displaced about as far: then something moved
    /// after that pose, not the clamp.
    pub fn is_displaced(&self, state: &FittedDraft, clamp: usize) -> bool {
        let displacement = self.displacement(state, clamp);
        let (thin, off) = (&state.thin, state.fit.offsets(&state.thin, &self.bodies[state.thin.body]));
        let is_own = |at: usize| thin.group[at] == clamp;
        let is_alike = |at: usize| {
            let left = off[at] - displacement;
            !is_own(at) && left.norm() < SHARED * displacement.norm()
        };
        let is_shared = (1..thin.len()).any(|at| {
            let (before, after) = (at - 1, at);
            is_own(before) && is_alike(after) || is_own(after) && is_alike(before)
        });
        displacement.norm() > LEAST.0 && !is_shared
    }

    /// How far a clamp whose place is free stands from where the draft has it, m, in {W}.
    pub fn displacement(&self, state: &FittedDraft, clamp: usize) -> Vector3<f64> {
        let off = state.fit.offsets(&state.thin, &self.bodies[state.thin.body]);
        let rows = rows_of(state, clamp);
        let weights: Vec<f64> =
            rows.iter().map(|&at| weight_of(state.fit.residuals[at] / state.fit.scale)).collect();
        let sum: Vector3<f64> = rows.iter().zip(&weights).map(|(&at, weight)| off[at] * *weight).sum();
        sum / weights.iter().sum::<f64>().max(f64::MIN_POSITIVE)
    }

    /// A rotation once more, by the fit that it made.
    pub fn turned_again(&self, state: &FittedDraft) -> Option<FittedDraft> {
        let Some(SearchStep::Elsewhere(DraftChange::Devices(frames))) = state.steps.last() else {
            return None;
        };
        let &(clamp, frame) = frames.first()?;
        let (tips, thin) = (state.fit.tips(&state.thin, &self.bodies[state.thin.body]), &state.thin);
        let found = placed(&thin.seen, &tips, &vec![1.0; thin.len()], |at| thin.group[at] == clamp)?;
        let mut steps = state.steps.clone();
        *steps.last_mut()? = SearchStep::Elsewhere(DraftChange::Devices(vec![(
            clamp,
            Pose { rotation: found.rotation, ..frame },
        )]));
        self.state(&steps, Worthwhile::ANY).filter(|again| again.score > state.score)
    }

    /// What a frame that was found was meant to be.
    pub fn meaning(&self, best: &FittedDraft, change: &DraftChange) -> Option<Meaning> {
        match change {
            DraftChange::Placed(clamp) => {
                let mm = |pose: &Pose| [0, 1, 2].map(|axis| tidy(pose.origin[axis] / MM));
                let stated = self.draft.devices[*clamp];
                let mut frame = stated;
                frame.origin += self.displacement(best, *clamp);
                let places = decimals(self.draft.devices.iter().flat_map(mm));
                let typed = typed(mm(&stated), mm(&frame), LEAST.0 / MM, places);
                if let Some((axis, meant)) = &typed {
                    frame.origin = stated.origin;
                    frame.origin[*axis] = meant.value() * MM;
                }
                Some(Meaning { clamp: *clamp, frame, typed })
            }
            DraftChange::Devices(frames) => {
                let &(clamp, frame) = frames.first()?;
                let degrees = |pose: &Pose| pose.roll_pitch_yaw().map(|angle| tidy(angle / DEG));
                let stated = self.draft.devices[clamp];
                let (old, mut new) = (degrees(&stated), degrees(&frame));
                // the nearest of all that are the same
                (0..3).for_each(|k| new[k] -= 360.0 * ((new[k] - old[k]) / 360.0).round());
                let places = decimals(old.iter().copied());
                let typed = typed(old, new, LEAST.1 / DEG, places);
                let frame = match &typed {
                    None => frame,
                    Some((axis, meant)) => {
                        let mut angles = old;
                        angles[*axis] = meant.value();
                        Pose::from_xyz_rpy(stated.origin.into(), angles.map(|angle| angle * DEG))
                    }
                };
                Some(Meaning { clamp, frame, typed })
            }
            _ => None,
        }
    }

    /// The frame of a clamp that a change gives it.
    pub fn frame_meant(&self, best: &FittedDraft, change: &DraftChange) -> Option<(usize, Pose)> {
        self.meaning(best, change).map(|meaning| (meaning.clamp, meaning.frame))
    }
}

fn rows_of(state: &FittedDraft, clamp: usize) -> Vec<usize> {
    (0..state.thin.len()).filter(|&at| state.thin.group[at] == clamp).collect()
}

/// Which of three numbers was typed wrongly, and what was meant, where the other two are what was
/// found; of several the most usual slip.
fn typed(stated: [f64; 3], found: [f64; 3], near: f64, decimals: usize) -> Option<(usize, Meant)> {
    let mut off = (0..3).filter(|&axis| (stated[axis] - found[axis]).abs() > near);
    let axis = off.next().filter(|_| off.next().is_none())?;
    let distance = |meant: &Meant| (meant.value() - found[axis]).abs();
    let near = meant(stated[axis], decimals).into_iter().filter(|meant| distance(meant) < near);
    let best =
        near.max_by(|a, b| a.log_prior.total_cmp(&b.log_prior).then(distance(b).total_cmp(&distance(a))))?;
    Some((axis, best))
}
