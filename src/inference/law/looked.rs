//! A first look at a law of several numbers, and where it is likeliest from there on.

use nalgebra::DVector;

use super::choice::Choice;
use super::grid;
use super::peak::{Peak, WIDEST};
use super::posterior::Posterior;
use super::site::Site;
use crate::inference::score::priors::APART;

/// Part of the evidence of a law that a first look may miss for each of its numbers that is not
/// linear: its peak is narrow.
pub(super) const MISSED: f64 = 0.25;
/// How far (ln) behind the likeliest other values of it may be at least, and how near two of them
/// are the same.
pub(super) const FAR: f64 = 30.0;
pub(super) const SAME: f64 = 0.01;
/// Places of a first look at a wave that changes from which on it is likeliest elsewhere: even
/// levels show it at several frequencies, as they show any wave.
const STARTS: usize = 6;

/// A law with what a first look says of it.
pub(super) struct Looked {
    /// With the likeliest shape.
    pub choice: Choice,
    /// Of the number that is not linear, of that shape.
    pub posterior: Posterior,
    /// Points of all numbers from where to go uphill.
    starts: Vec<DVector<f64>>,
}

impl Looked {
    /// All shapes of a first look; `evidence` of a law at many coordinates at once.
    pub fn at(choice: Choice, site: &Site, evidence: &dyn Fn(Choice, &[f64]) -> Vec<f64>) -> Looked {
        let grid = choice.grid(site);
        let own = |choice: Choice| (choice, Posterior::new(&grid, &|us| evidence(choice, us)));
        let mut shapes: Vec<(Choice, Posterior)> = choice.first_shapes().into_iter().map(own).collect();
        if shapes.is_empty() {
            shapes.push(own(choice));
        }
        shapes.sort_by(|a, b| b.1.best().1.total_cmp(&a.1.best().1));
        let highest = shapes[0].1.best().1;
        // a first look misses a part of each peak
        let below = FAR.max(2.0 * MISSED * highest);
        let count = if choice.form.is_wave() { STARTS } else { 1 };
        let of_shape = |(choice, posterior): &(Choice, Posterior)| {
            let shape = choice.shape();
            let point = |(u, gain)| (gain, DVector::from_vec([vec![u], shape.clone()].concat()));
            posterior.highest(count, (below, APART.ln())).into_iter().map(point).collect::<Vec<_>>()
        };
        let mut points: Vec<(f64, DVector<f64>)> = shapes.iter().flat_map(of_shape).collect();
        points.sort_by(|a, b| b.0.total_cmp(&a.0));
        let mut starts: Vec<DVector<f64>> = Vec::new();
        for (_, point) in points.into_iter().filter(|(gain, _)| *gain > highest - below) {
            let is_new =
                |other: &DVector<f64>| (choice.at(point[0]) - choice.at(other[0])).abs() > grid::OTHER;
            if starts.is_empty() || starts.len() < count && starts.iter().all(is_new) {
                starts.push(point);
            }
        }
        let (choice, posterior) = shapes.swap_remove(0);
        Looked { choice, posterior, starts }
    }

    /// Where all of its numbers are likeliest, and coordinates of the first one where they are not
    /// less likely by the odds of a rival; of waves that explain the same the slowest has the
    /// widest peak.
    pub fn peak(&self, evidence: &dyn Fn(&[DVector<f64>]) -> Vec<f64>) -> (Peak, Vec<f64>) {
        let ranges = [vec![self.posterior.ends()], self.choice.shape_ranges()].concat();
        let uphill = |start: &DVector<f64>| {
            let mut widest = vec![WIDEST; ranges.len()];
            if self.choice.form.is_wave() {
                // half of what is still in step
                let (low, high) = ranges[0];
                widest[0] = WIDEST.min(0.5 * grid::APART / (self.choice.at(start[0]) * (high - low)));
            }
            Peak::from(start.clone(), &ranges, &widest, evidence)
        };
        let mut peaks: Vec<Peak> = self.starts.iter().map(uphill).collect();
        peaks.sort_by(|a, b| b.log_evidence.total_cmp(&a.log_evidence));
        let best = peaks.swap_remove(0);
        let is_other = |peak: &&Peak| {
            peak.log_evidence > best.log_evidence - APART.ln() && (peak.at[0] - best.at[0]).abs() > SAME
        };
        let also = peaks.iter().filter(is_other).map(|peak| peak.at[0]).collect();
        (best, also)
    }
}

/// A law of several numbers with them: the coordinate of the first, and its shape.
pub(super) fn at_point(choice: Choice, point: &DVector<f64>) -> (Choice, f64) {
    let numbers = point.as_slice();
    (choice.shaped(&numbers[1..]), numbers[0])
}
