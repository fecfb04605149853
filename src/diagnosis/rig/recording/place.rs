//! What the readings of one place say of the displacement that was imposed.
//!
//! A displacement is read with noise. Whatever follows its readings one by one (a wave of the step
//! between two settings, a curve with a kink at each), or knows better than they where the slide
//! was (a mean, a lag, a wave in time), takes their noise off the loads. So those of one setting
//! count as that [setting](super::recurring), and those of a [sweep](super::sweeps) as the sweep,
//! with the error of either as a column of every hypothesis. Where the zero of the display drifts,
//! or settings are too many, the rod meets each reading, and what follows the steps its setting.
//! Where the loads follow each reading, that was imposed:
//!
//! ```text
//! f = r·k·e     e, f: what displacement and load are off from one visit of a setting to the next
//!               that came from the same other setting, or off the sweep;  k: the stiffness;
//!               r = 1 or 0
//! ```

use std::collections::BTreeMap;

use nalgebra::DMatrix;

use super::estimate::Estimate;
use super::recurring::recurring;
use super::sweeps::swept;
use crate::rig::readings::Reading;

/// The r beyond which loads follow each reading, and how well it is known at least.
const FOLLOWS: f64 = 0.5;
const KNOWN: f64 = 0.25;

/// Standard deviations beyond which readings of settings are no noise.
const SURE: f64 = 4.0;
/// Where what was set is known from.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Known {
    /// From its own reading.
    Read,
    /// It was set again and again: from all readings of that.
    Set,
    /// It was set again and again, but a mean says less of it than its reading: its zero drifts, so
    /// that readings have something in common with those before them, or there are too many.
    Recurring,
    /// It was passed by a slide that moved on evenly: from the readings about it.
    Passed,
}

impl Known {
    /// True where it was set again and again.
    pub fn recurs(self) -> bool {
        matches!(self, Known::Set | Known::Recurring)
    }

    /// True where it has the noise of one reading.
    pub fn has_noise_of_reading(self) -> bool {
        matches!(self, Known::Read | Known::Recurring)
    }
}

/// Displacements along an axis that were read at one place, session by session and trial by trial,
/// and their loads.
pub struct Place {
    /// Rows of the file.
    pub rows: Vec<usize>,
    displacement: Vec<f64>,
    load: Vec<f64>,
    /// How many rows each trial of a session has.
    courses: Vec<usize>,
    /// Where times increase.
    times: Option<Vec<f64>>,
}

impl Place {
    /// Of these rows.
    pub fn of(readings: &[Reading], own: &[usize]) -> Place {
        let mut courses: BTreeMap<(Option<&str>, Option<&str>), Vec<usize>> = BTreeMap::new();
        for &i in own {
            let key = (readings[i].session.as_deref(), readings[i].trial.as_deref());
            courses.entry(key).or_default().push(i);
        }
        // in the order of their times, or as they stand
        let mut courses: Vec<Vec<usize>> = courses.into_values().collect();
        for course in &mut courses {
            if course.iter().all(|&i| readings[i].time.is_some()) {
                let time = |i: usize| readings[i].time.unwrap_or_default();
                course.sort_by(|&a, &b| time(a).total_cmp(&time(b)));
            }
        }
        let increase = |course: &Vec<usize>| {
            course
                .windows(2)
                .all(|two| readings[two[0]].time.is_some_and(|a| Some(a) < readings[two[1]].time))
        };
        let rows = courses.concat();
        let axis = |i: usize| readings[i].direction.axis.index();
        Place {
            displacement: rows.iter().filter_map(|&i| readings[i].offset[axis(i)]).collect(),
            load: rows.iter().map(|&i| readings[i].signed_load()).collect(),
            times: match courses.iter().all(increase) {
                true => rows.iter().map(|&i| readings[i].time).collect(),
                false => None,
            },
            courses: courses.iter().map(Vec::len).collect(),
            rows,
        }
    }

    /// Where the slide was that loads followed; nothing where that is as each reading says.
    pub fn estimate(&self) -> Option<(Known, Estimate)> {
        if let Some(set) = recurring(&self.displacement) {
            let follows = self.share(&self.visits(&set.values)).is_some_and(|r| r > FOLLOWS);
            let off: Vec<f64> = self.displacement.iter().zip(&set.values).map(|(u, set)| u - set).collect();
            let known = if is_noise(&off) && set.errors.ncols() > 0 { Known::Set } else { Known::Recurring };
            return (!follows).then_some((known, set));
        }
        let (set, off) = self.sweeps()?;
        let is_noise = self.share(&off).is_some_and(|r| r <= FOLLOWS);
        is_noise.then_some((Known::Passed, set))
    }

    /// e and f of the visits of settings.
    fn visits(&self, set: &[f64]) -> Vec<(f64, f64)> {
        let mut last: BTreeMap<[Option<u64>; 2], usize> = BTreeMap::new();
        let (mut visits, mut before) = (Vec::new(), None);
        for (k, value) in set.iter().enumerate() {
            let at = Some(value.to_bits());
            if let Some(other) = last.insert([before, at], k) {
                let change = |values: &[f64]| values[k] - values[other];
                visits.push((change(&self.displacement), change(&self.load)));
            }
            before = at;
        }
        visits
    }

    /// The sweeps, where each course is one, with e and f.
    fn sweeps(&self) -> Option<(Estimate, Vec<(f64, f64)>)> {
        let mut all = Estimate { values: Vec::new(), errors: DMatrix::zeros(self.rows.len(), 0) };
        let mut off = Vec::new();
        for count in &self.courses {
            let first = all.values.len();
            let own = first..first + count;
            let (u, load) = (&self.displacement[own.clone()], &self.load[own.clone()]);
            let even: Vec<f64> = (0..*count).map(|k| k as f64).collect();
            let sweep = swept(u, self.times.as_ref().map_or(&even[..], |times| &times[own.clone()]))?;
            let loads = sweep.smooth(load);
            off.extend((0..*count).map(|k| (u[k] - sweep.estimate.values[k], load[k] - loads[k])));
            let known = all.errors.ncols();
            all.errors = all.errors.resize_horizontally(known + sweep.estimate.errors.ncols(), 0.0);
            all.errors
                .view_mut((first, known), sweep.estimate.errors.shape())
                .copy_from(&sweep.estimate.errors);
            all.values.extend(sweep.estimate.values);
        }
        Some((all, off))
    }

    fn line(&self) -> Vec<(f64, f64)> {
        self.displacement.iter().copied().zip(self.load.iter().copied()).collect()
    }

    /// r of these e and f; nothing where it is not known.
    fn share(&self, off: &[(f64, f64)]) -> Option<f64> {
        let (own, all) = (Line::of(off)?, Line::of(&self.line())?);
        (own.sd <= KNOWN * all.slope.abs()).then_some(own.slope / all.slope)
    }
}

/// Have the values nothing in common with those before them? A zero that drifts has
/// (J. von Neumann, *Ann. Math. Stat.* 12 (1941) 367–395):
///
/// ```text
/// Σ (eₖ₊₁ − eₖ)²/Σ eₖ² = 2 ± 2/√n
/// ```
fn is_noise(values: &[f64]) -> bool {
    let square: f64 = values.iter().map(|e| e * e).sum();
    let changes: f64 = values.windows(2).map(|own| (own[1] - own[0]).powi(2)).sum();
    changes >= (2.0 - SURE * 2.0 / (values.len() as f64).sqrt()) * square
}

/// A straight line through points, and the standard deviation of its slope.
struct Line {
    slope: f64,
    sd: f64,
}

impl Line {
    /// Nothing where the points do not say.
    fn of(points: &[(f64, f64)]) -> Option<Line> {
        const NUMBERS: f64 = 2.0;
        let count = points.len() as f64;
        let (x, y) = points.iter().fold((0.0, 0.0), |(x, y), own| (x + own.0 / count, y + own.1 / count));
        let sum = |product: fn(f64, f64) -> f64| {
            points.iter().map(|own| product(own.0 - x, own.1 - y)).sum::<f64>()
        };
        let (xx, xy, yy) = (sum(|x, _| x * x), sum(|x, y| x * y), sum(|_, y| y * y));
        let slope = xy / xx;
        let sd = ((yy - slope * xy).max(0.0) / (count - NUMBERS) / xx).sqrt();
        (count > NUMBERS && slope.is_finite() && sd.is_finite()).then_some(Line { slope, sd })
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::rig::readings::Readings;
    use crate::statistics::Random;

    #[test]
    fn what_drifts_is_no_noise() {
        let mut random = Random::seeded(2, 0);
        let noise: Vec<f64> = (0..128).map(|_| random.normal()).collect();
        assert!(is_noise(&noise));
        let drifting: Vec<f64> =
            noise.iter().enumerate().map(|(k, e)| e + 0.05 * (k as f64 - 63.5)).collect();
        assert!(!is_noise(&drifting));
    }

    /// Cycles of 33 settings, or a swing, 5 times; what is imposed is off by so much, and read with
    /// noise, µm.
    fn known(is_swing: bool, imposed: f64, noise: f64) -> Option<Known> {
        let mut random = Random::seeded(3, 0);
        let count: i32 = if is_swing { 600 } else { 320 };
        let mut text = "axis,load_n,time_s,dy_um\n".to_owned();
        for k in 0..count {
            let place = match is_swing {
                true => 400.0 * (f64::from(k) * std::f64::consts::TAU / 120.0).sin(),
                false => 25.0 * f64::from((k % 64 - 32).abs()) - 400.0,
            };
            let there = place + imposed * random.normal();
            let load = 0.02 * there + 0.003 * random.normal();
            let sign = if load < 0.0 { "-" } else { "" };
            text += &format!("{sign}y,{:.4},{k},{:.2}\n", load.abs(), there + noise * random.normal());
        }
        let rows = Readings::from_text("f", &text).unwrap().rows;
        let all: Vec<usize> = (0..rows.len()).collect();
        Place::of(&rows, &all).estimate().map(|(known, _)| known)
    }

    #[test]
    fn what_loads_follow_was_imposed() {
        assert_eq!(known(false, 0.0, 0.5), Some(Known::Set));
        assert_eq!(known(true, 0.0, 0.5), Some(Known::Passed));
        for is_swing in [false, true] {
            assert_eq!(known(is_swing, 0.5, 0.05), None, "{is_swing}");
        }
    }
}
