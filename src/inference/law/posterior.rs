//! What data say of a number that is not linear: its evidence on a grid that grows where the
//! posterior is.

use super::constant::OpenEnd;

/// Most times that the grid is made finer, and most points of it.
const ROUNDS: usize = 8;
const MOST: usize = 2000;
/// Ln of the density below its largest from which on a stretch counts for nothing.
const NOTHING: f64 = 5.0;
/// Ln of the density by which two neighbours may differ.
const STEP: f64 = 0.2;
/// For so many rounds every peak counts that is so far below the highest, or that has at least this
/// part of its evidence: the clearer a wave, the more of it is lost between the points of a grid.
const FLANKS: (usize, f64, f64) = (3, 40.0, 0.5);
/// Part of the whole from which on a peak counts, however low it is.
const MANY: f64 = 0.05;
/// Ln of the density below its largest up to which an end is open.
const OPEN: f64 = 2.0;
/// Parts that a stretch is cut into.
const PARTS: usize = 3;

/// Evidence over a coordinate whose prior is even between its ends.
#[derive(Debug, Clone)]
pub(super) struct Posterior {
    /// Coordinate and ln of the evidence there, ascending.
    points: Vec<(f64, f64)>,
}

impl Posterior {
    /// On a grid, ascending; `evidence` of many coordinates at once.
    pub fn new(grid: &[f64], evidence: &dyn Fn(&[f64]) -> Vec<f64>) -> Posterior {
        Posterior { points: grid.iter().copied().zip(evidence(grid)).collect() }
    }

    /// A normal one within its ends.
    pub fn normal(mean: f64, sd: f64, (low, high): (f64, f64)) -> Posterior {
        let at = |k: i32| mean + f64::from(k) / 8.0 * sd;
        let inside = (-40..=40).map(at).filter(|u| low < *u && *u < high);
        let all = std::iter::once(low).chain(inside).chain([high]);
        let point = |u: f64| (u, -0.5 * ((u - mean) / sd.max(f64::MIN_POSITIVE)).powi(2));
        Posterior { points: all.map(point).collect() }
    }

    /// Lowest and highest value that the density is known at.
    pub fn ends(&self) -> (f64, f64) {
        let end = |point: Option<&(f64, f64)>| point.map_or(0.0, |point| point.0);
        (end(self.points.first()), end(self.points.last()))
    }

    /// The likeliest coordinate and the ln of the evidence there.
    pub fn best(&self) -> (f64, f64) {
        let best = self.points.iter().copied().reduce(|a, b| if b.1 > a.1 { b } else { a });
        best.unwrap_or((0.0, f64::NEG_INFINITY))
    }

    /// The end at which it is not over: its density there is no less than e^−2 of the largest.
    pub fn open_end(&self) -> Option<OpenEnd> {
        let [first, .., last] = &self.points[..] else { return None };
        let (_, most) = self.best();
        match (first.1 > most - OPEN, last.1 > most - OPEN) {
            (_, true) => Some(OpenEnd::High),
            (true, false) => Some(OpenEnd::Low),
            (false, false) => None,
        }
    }

    /// With a finer grid where it counts.
    pub fn refine(&mut self, evidence: &dyn Fn(&[f64]) -> Vec<f64>) {
        for round in 0..ROUNDS {
            let (_, most) = self.best();
            let flanks = most - FLANKS.1.max((1.0 - FLANKS.2) * most);
            let at = |k: usize| self.points.get(k).map_or(f64::NEG_INFINITY, |point| point.1);
            // what looks low may be the flank of a narrow peak
            let is_flank = |k: usize| {
                round < FLANKS.0 && at(k) > flanks && at(k) >= at(k + 1) && (k == 0 || at(k) >= at(k - 1))
            };
            let is_coarse = |k: &usize| {
                let (one, other) = (at(*k), at(k + 1));
                let counts = one.max(other) > most - NOTHING || is_flank(*k) || is_flank(k + 1);
                counts && (one - other).abs() > STEP
            };
            let mut more = Vec::new();
            for k in (0..self.points.len().saturating_sub(1)).filter(is_coarse) {
                let (a, b) = (self.points[k].0, self.points[k + 1].0);
                more.extend((1..PARTS).map(|k| a + (b - a) * k as f64 / PARTS as f64));
            }
            if more.is_empty() || self.points.len() + more.len() > MOST {
                return;
            }
            let values = evidence(&more);
            self.points.extend(more.into_iter().zip(values));
            self.points.sort_by(|a, b| a.0.total_cmp(&b.0));
        }
    }

    /// Ln of the evidence, averaged over the prior.
    pub fn log_evidence(&self) -> f64 {
        let (_, most) = self.best();
        let [first, .., last] = &self.points[..] else { return most };
        if most == f64::NEG_INFINITY {
            return most;
        }
        most + (self.masses().map(|(_, mass)| mass).sum::<f64>() / (last.0 - first.0)).ln()
    }

    /// Each stretch with its mass, relative.
    fn masses(&self) -> impl Iterator<Item = ((f64, f64), f64)> + '_ {
        let (_, most) = self.best();
        let density = move |point: (f64, f64)| (point.1 - most).exp();
        self.points.windows(2).map(move |pair| {
            let mass = 0.5 * (density(pair[0]) + density(pair[1])) * (pair[1].0 - pair[0].0);
            ((pair[0].0, pair[1].0), mass)
        })
    }

    /// The coordinate below which so much of the posterior is.
    pub fn quantile(&self, p: f64) -> f64 {
        let whole: f64 = self.masses().map(|(_, mass)| mass).sum();
        let mut below = 0.0;
        for ((a, b), mass) in self.masses() {
            if below + mass >= p * whole && mass > 0.0 {
                return a + (b - a) * (p * whole - below) / mass;
            }
            below += mass;
        }
        self.best().0
    }

    /// Peaks that are at most `times` lower than the highest, each apart from higher ones by a
    /// valley `times` below its own height; the highest first. Coordinate and ln of the evidence.
    pub fn peaks(&self, times: f64) -> Vec<(f64, f64)> {
        let peaks = self.peaks_down_to(times.ln(), times.ln());
        peaks.into_iter().map(|k| self.points[k]).collect()
    }

    /// Coordinates of peaks that count: at most `times` lower than the highest, or with more than
    /// 5 % of the whole about them.
    pub fn modes(&self, times: f64) -> Vec<f64> {
        let (_, most) = self.best();
        let deep = times.ln();
        let whole: f64 = self.masses().map(|(_, mass)| mass).sum();
        let is_high = |k: &usize| self.points[*k].1 > most - deep || self.mass_about(*k, deep) > MANY * whole;
        let peaks = self.peaks_down_to(NOTHING.max(deep), deep).into_iter().filter(is_high);
        peaks.map(|k| self.points[k].0).collect()
    }

    /// The highest so many peaks down to `below` under the highest one, each apart from higher ones
    /// by a valley `deep` under it. Coordinate and ln of the evidence.
    pub fn highest(&self, count: usize, (below, deep): (f64, f64)) -> Vec<(f64, f64)> {
        self.peaks_down_to(below, deep).into_iter().take(count).map(|k| self.points[k]).collect()
    }

    fn peaks_down_to(&self, below: f64, deep: f64) -> Vec<usize> {
        let (_, most) = self.best();
        let mut by_height: Vec<usize> = (0..self.points.len()).collect();
        by_height.sort_by(|&a, &b| self.points[b].1.total_cmp(&self.points[a].1));
        let mut peaks: Vec<usize> = Vec::new();
        for k in by_height.into_iter().take_while(|&k| self.points[k].1 > most - below) {
            let is_apart = |&other: &usize| {
                let between = &self.points[k.min(other)..=k.max(other)];
                between.iter().any(|point| point.1 < self.points[k].1 - deep)
            };
            if peaks.iter().all(is_apart) {
                peaks.push(k);
            }
        }
        peaks
    }

    /// The mass about a point, as far as the density is no more than `deep` lower.
    fn mass_about(&self, k: usize, deep: f64) -> f64 {
        let is_in = |i: usize| self.points[i].1 > self.points[k].1 - deep;
        let first = (0..k).rev().take_while(|&i| is_in(i)).last().unwrap_or(k);
        let last = (k..self.points.len()).take_while(|&i| is_in(i)).last().unwrap_or(k);
        let within = self.masses().skip(first).take(last - first);
        within.map(|(_, mass)| mass).sum()
    }

    /// So many coordinates, each of which stands for as much of the posterior.
    pub fn even(&self, count: usize) -> Vec<f64> {
        (0..count).map(|k| self.quantile((k as f64 + 0.5) / count as f64)).collect()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A narrow normal density between the points of a coarse grid.
    #[test]
    fn a_narrow_peak_is_found_and_measured() {
        let (mean, sd) = (0.437, 0.004);
        let evidence = |us: &[f64]| us.iter().map(|u| -0.5 * ((u - mean) / sd).powi(2)).collect::<Vec<_>>();
        let grid: Vec<f64> = (0..=20).map(|k| f64::from(k) / 20.0).collect();
        let mut posterior = Posterior::new(&grid, &evidence);
        posterior.refine(&evidence);
        let (low, high) = (posterior.quantile(0.025), posterior.quantile(0.975));
        assert!((posterior.best().0 - mean).abs() < 0.2 * sd, "{:?}", posterior.best());
        assert!(
            (low - (mean - 1.96 * sd)).abs() < 0.15 * sd && (high - (mean + 1.96 * sd)).abs() < 0.15 * sd
        );
        // √(2π)·σ over a prior of width 1
        let expected = ((2.0 * std::f64::consts::PI).sqrt() * sd).ln();
        assert!((posterior.log_evidence() - expected).abs() < 0.02);
    }

    #[test]
    fn peaks_that_are_nearly_as_high_are_others() {
        let peak = |u: f64, at: f64| -0.5 * ((u - at) / 0.02).powi(2);
        let one = |&u: &f64| peak(u, 0.2).max(peak(u, 0.7) - 1.0).max(peak(u, 0.9) - 9.0);
        let evidence = |us: &[f64]| us.iter().map(one).collect::<Vec<_>>();
        let grid: Vec<f64> = (0..=20).map(|k| f64::from(k) / 20.0).collect();
        let mut posterior = Posterior::new(&grid, &evidence);
        posterior.refine(&evidence);
        let peaks = posterior.peaks(20.0);
        assert!(peaks.len() == 2 && (peaks[1].0 - 0.7).abs() < 0.005, "{peaks:?}");
    }

    /// Two that are as high, of which one alone is near a point of the first grid.
    #[test]
    fn a_high_peak_between_points_is_no_lower_than_one_at_a_point() {
        let peak = |u: f64, at: f64| 700.0 - (700.0 * ((u - at) / 0.02).powi(2)).min(650.0);
        let evidence = |us: &[f64]| us.iter().map(|u| peak(*u, 0.251).max(peak(*u, 0.715))).collect();
        let grid: Vec<f64> = (0..=40).map(|k| f64::from(k) / 40.0).collect();
        let mut posterior = Posterior::new(&grid, &|us| evidence(us));
        posterior.refine(&|us| evidence(us));
        let peaks = posterior.peaks(20.0);
        assert!(peaks.len() == 2 && (peaks[0].0 - peaks[1].0).abs() > 0.4, "{peaks:?}");
    }

    #[test]
    fn one_point_is_its_own_posterior() {
        let posterior = Posterior::new(&[0.0], &|_| vec![3.0]);
        assert_eq!((posterior.log_evidence(), posterior.quantile(0.3)), (3.0, 0.0));
        assert_eq!(posterior.even(2), [0.0, 0.0]);
    }
}
