//! Mistakes of a part of the rows: of a stretch, or of one clamp.
//!
//! A fit of the other rows says where the tip was. About it each change is tried on every row; what
//! row i then gains, and the stretch that gains most (J. Bentley, *Commun. ACM* 27 (1984) 865–873):
//!
//! ```text
//! gᵢ = h(rᵢ) − h(r'ᵢ)      h(r) = ½·(ν + 3)·ln(1 + (r/s)²/ν)      max Σ gᵢ over from ≤ i ≤ to
//! ```
//!
//! r the distance of the tip from its point, r' the same with the change, s the scale of the fit,
//! ν = 4. Nothing is decided here: a stretch is only where a change would have to be looked for.

use nalgebra::Vector3;

use super::super::draft::{Draft, DraftChange, Rows};
use super::super::quick::{Fit, LoadedRobot, from_points, weight_of};
use crate::statistics::median;

/// Degrees of freedom of the distances' distribution.
const NU: f64 = 4.0;
/// A fit of some rows may be off where it knows nothing, as a share of the reach: as little as a
/// fit of most rows, or as much as one of a few.
pub const ELSEWHERE: [f64; 2] = [1e-3, 1e-2];
/// Rows that are farther out than so many scales do not fit; of a scale that is itself generous,
/// fewer.
pub const FAR: f64 = 8.0;
const FAR_ELSEWHERE: f64 = 2.0;

/// A joint turned by this much, rad or m, gives the direction in which it moves the tip; tips that
/// are nearer to its axis, as a share of the reach, say nothing of its zero.
const SMALL: f64 = 1e-5;
const LEVER: f64 = 0.02;
const STEPS_OF_NEWTON: usize = 3;
/// Standard error of a median times √n over the median distance from it: 1.4826·√(π/2).
const OF_A_MEDIAN: f64 = 1.858;

/// Where the tips are, as some rows say.
pub struct Reference<'a> {
    fit: &'a Fit,
    body: &'a LoadedRobot<'a>,
    /// A draft, and its tips.
    known: (&'a Draft, Vec<Vector3<f64>>),
    /// Of each socket the middle of its tips in {0}; zero where the points were measured.
    centres: Vec<Vector3<f64>>,
    /// s, m.
    pub scale: f64,
    /// Rows that are farther out do not fit, m.
    pub far: f64,
}

impl<'a> Reference<'a> {
    /// By a fit of all rows of `draft`.
    pub fn of_all(draft: &'a Draft, body: &'a LoadedRobot<'a>, fit: &'a Fit) -> Reference<'a> {
        let mut centres = vec![Vector3::zeros(); draft.devices.len()];
        let tips = fit.tips(draft, body);
        if draft.has_sockets() {
            for (group, centre) in centres.iter_mut().enumerate() {
                let own = || draft.group.iter().zip(&tips).filter(|(own, _)| **own == group);
                *centre = Vector3::from_fn(|axis, _| {
                    let values: Vec<f64> = own().map(|(_, tip)| tip[axis]).collect();
                    median(&values).unwrap_or(0.0)
                });
            }
        }
        Reference { fit, body, known: (draft, tips), centres, scale: fit.scale, far: FAR * fit.scale }
    }

    /// By a fit of some rows of `draft`, which may be off by a share of the reach elsewhere.
    pub fn of_some(
        draft: &'a Draft,
        body: &'a LoadedRobot<'a>,
        fit: &'a Fit,
        elsewhere: f64,
    ) -> Reference<'a> {
        let all = Reference::of_all(draft, body, fit);
        let elsewhere = elsewhere * body.reach;
        Reference { scale: fit.scale.max(elsewhere), far: all.far.max(FAR_ELSEWHERE * elsewhere), ..all }
    }

    /// Distances of the tips from their points, m.
    pub fn lengths(&self, draft: &Draft) -> Vec<f64> {
        self.offsets(draft).iter().map(|off| off.norm()).collect()
    }

    /// From the points to their tips, m.
    pub fn offsets(&self, draft: &Draft) -> Vec<Vector3<f64>> {
        let off = from_points(draft, self.tips(draft));
        off.iter().zip(&draft.group).map(|(off, &group)| off - self.centres[group]).collect()
    }

    /// The tip of every row of `draft`: most changes leave those of most rows where they are.
    fn tips(&self, draft: &Draft) -> Vec<Vector3<f64>> {
        let (known, tips) = &self.known;
        let is_known = |&at: &usize| {
            at < known.len()
                && known.joints(at) == draft.joints(at)
                && known.station[at] == draft.station[at]
                && known.devices[known.group[at]] == draft.devices[draft.group[at]]
        };
        let others: Vec<usize> = (0..draft.len()).filter(|at| !is_known(at)).collect();
        let mut there: Vec<Vector3<f64>> = tips.clone();
        there.resize(draft.len(), Vector3::zeros());
        let moved = self.fit.tips(&draft.part(&others), self.body);
        others.iter().zip(moved).for_each(|(&at, tip)| there[at] = tip);
        there
    }

    /// What each row of `draft` gains by being as in `changed`; nothing where it is not there, or
    /// does not fit then either.
    pub fn gains(&self, draft: &Draft, lengths: &[f64], changed: &Draft) -> Vec<f64> {
        let cost = |length: f64| 0.5 * (NU + 3.0) * ((length / self.scale).powi(2) / NU).ln_1p();
        let new = self.lengths(changed);
        let gain = |(row, old): (&usize, &f64)| match changed.rows.binary_search(row) {
            Ok(at) if new[at] > self.far => (cost(*old) - cost(new[at])).min(0.0),
            Ok(at) => cost(*old) - cost(new[at]),
            Err(_) => 0.0,
        };
        draft.rows.iter().zip(lengths).map(gain).collect()
    }

    /// By how much the zero of a joint is off in `rows` of `draft`, in the middle, and its standard
    /// error: what turns each tip the farthest towards its point, by a few steps of Newton's.
    pub fn zero(&self, draft: &Draft, joint: usize, rows: &[usize]) -> Option<(f64, f64)> {
        let mut draft = draft.part(rows);
        let (mut sum, mut error) = (0.0, 0.0);
        for _ in 0..STEPS_OF_NEWTON {
            let off = self.offsets(&draft);
            let moved = self.offsets(&draft.with(&DraftChange::Zero { joint, by: SMALL }));
            let by = |row: usize| {
                let along = (moved[row] - off[row]) / SMALL;
                let square = along.norm_squared();
                (square > (LEVER * self.body.reach).powi(2)).then(|| -along.dot(&off[row]) / square)
            };
            let all: Vec<f64> = (0..draft.len()).filter_map(by).collect();
            let by = median(&all)?;
            let apart: Vec<f64> = all.iter().map(|own| (own - by).abs()).collect();
            error = OF_A_MEDIAN * median(&apart)? / (all.len() as f64).sqrt();
            draft = draft.with(&DraftChange::Zero { joint, by });
            sum += by;
        }
        Some((sum, error))
    }

    /// By how much the zero of a joint drifts with a clock, which has a number for each row of the
    /// recording, by least squares with the weights of the fit:
    ///
    /// ```text
    /// c = −Σ w·x·(J·r) / Σ w·x²·|J|²       J what a turn of the joint moves the tip by, r how far it is off
    /// ```
    pub fn drift(&self, draft: &Draft, joint: usize, clock: &[f64]) -> Option<f64> {
        let off = self.offsets(draft);
        let moved = self.offsets(&draft.with(&DraftChange::Zero { joint, by: SMALL }));
        let (mut product, mut square) = (0.0, 0.0);
        for ((off, moved), row) in off.iter().zip(&moved).zip(&draft.rows) {
            let (along, x) = ((moved - off) / SMALL, *clock.get(*row)?);
            let weight = weight_of(off.norm() / self.scale);
            product += weight * x * along.dot(off);
            square += weight * x * x * along.norm_squared();
        }
        (square > 0.0).then(|| -product / square)
    }
}

/// The stretch, or the clamp, whose rows gain most, and how much.
pub fn most(draft: &Draft, gains: &[f64]) -> Option<(Rows, f64)> {
    let (first, last, gain) = stretch(gains)?;
    let mut best = (Rows::Between(draft.rows[first], draft.rows[last]), gain);
    let mut of_clamp = vec![0.0; draft.devices.len()];
    gains.iter().zip(&draft.group).for_each(|(gain, &group)| of_clamp[group] += gain);
    for (clamp, &gain) in of_clamp.iter().enumerate().filter(|_| !draft.has_sockets()) {
        if draft.devices.len() > 1 && gain > best.1 {
            best = (Rows::OfClamp(clamp), gain);
        }
    }
    Some(best)
}

/// First and last of the neighbours whose sum is greatest, and that sum.
fn stretch(gains: &[f64]) -> Option<(usize, usize, f64)> {
    let mut best: Option<(usize, usize, f64)> = None;
    let (mut first, mut sum) = (0, 0.0);
    for (at, gain) in gains.iter().enumerate() {
        if sum <= 0.0 {
            (first, sum) = (at, 0.0);
        }
        sum += gain;
        if sum > best.map_or(0.0, |(_, _, most)| most) {
            best = Some((first, at, sum));
        }
    }
    best
}

/// The change in some rows alone.
pub fn within(rows: Rows, change: &DraftChange) -> DraftChange {
    DraftChange::Within(rows, Box::new(change.clone()))
}

#[cfg(test)]
mod tests {
    use super::stretch;

    #[test]
    fn the_neighbours_that_gain_most() {
        assert_eq!(stretch(&[-1.0, 2.0, 0.0, 3.0, -9.0, 4.0]), Some((1, 3, 5.0)));
        assert_eq!(stretch(&[-1.0, 0.0]), None);
        assert_eq!(stretch(&[]), None);
    }
}
