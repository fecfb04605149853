//! Does what is found in some sessions predict the others?
//!
//! A recording may hold several sessions: clamps, placements of a fixture. Each is left out as a whole, the search included, and
//! predicted from the others: an effect of the robot must be there too, one that only describes a fixture is not.

use std::collections::BTreeMap;

use nalgebra::DVector;

use super::Evidence;
use super::linear::Linearised;
use super::proof::learned;
use crate::parallel::in_parallel;

/// A session that was predicted from the others.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Replica {
    /// Its number in [`Evidence::session`].
    pub session: usize,
    /// Root mean square of what the base model leaves of it.
    pub before: f64,
    /// And of what the story found without it leaves.
    pub after: f64,
}

/// Predicts each session from the others; nothing where there is one only.
pub(super) fn replicate(world: &Linearised<'_>, evidence: &Evidence) -> Vec<Replica> {
    let mut sessions: Vec<usize> = evidence.session.clone();
    sessions.sort_unstable();
    sessions.dedup();
    sessions.retain(|&session| session != Evidence::KEPT);
    if sessions.len() < 2 {
        return Vec::new();
    }
    let n = evidence.residual.len();
    in_parallel(sessions.len(), |k| {
        let session = sessions[k];
        let (out, kept): (Vec<usize>, Vec<usize>) = (0..n).partition(|&row| evidence.session[row] == session);
        let (before, after, _) = learned(world, evidence, &kept);
        Replica { session, before: left(evidence, &before, &out), after: left(evidence, &after, &out) }
    })
}

/// Root mean square of `errors` in `rows`, about the level of each group whose level nobody knows.
fn left(evidence: &Evidence, errors: &DVector<f64>, rows: &[usize]) -> f64 {
    let mut levels: BTreeMap<usize, (f64, f64)> = BTreeMap::new();
    for &row in rows {
        let (sum, count) = levels.entry(evidence.level[row]).or_default();
        *sum += errors[row];
        *count += 1.0;
    }
    let square = |&row: &usize| {
        let level = match evidence.level[row] {
            Evidence::KEPT => 0.0,
            level => levels[&level].0 / levels[&level].1,
        };
        (errors[row] - level).powi(2)
    };
    (rows.iter().map(square).sum::<f64>() / rows.len().max(1) as f64).sqrt()
}
