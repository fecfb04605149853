//! Lines of readings: one sensor under the loads of one axis, as a slope that play, friction, a
//! zero and single wrong readings do not change.
//!
//! ```text
//! y = b·F + a + p·sign F      a, p with weak priors: a third of the largest reading
//! ```
//!
//! by iteratively reweighted least squares with Cauchy's weights (P. W. Holland, R. E.
//! Welsch, *Commun. Stat. A* 6 (1977) 813–827), so that a fifth of the readings may be wrong.

use nalgebra::{Matrix3, Vector3};

use crate::diagnosis::rig::recording::datum::Datum;
use crate::spatial::Axis;

/// Prior of what a line does not pass through the origin by, as a share of its largest reading.
const AWAY_FROM_ORIGIN: f64 = 0.3;
/// First guess of the scatter, likewise.
const FIRST_GUESS: f64 = 0.03;
/// Cauchy's constant: 95 % efficient under normal noise.
const CAUCHY: f64 = 2.385;
const ROUNDS: usize = 12;
/// Nothing is known better than this share of the largest reading.
const FLOOR: f64 = 1e-6;
/// No line is straighter than this share of its largest reading.
const STRAIGHT: f64 = 1e-4;
/// A load so many times the largest of the others decides alone where their line goes. It is wrong
/// where its reading is so many standard errors off that of the others, and on it at a load up to
/// so many times their largest.
const BEYOND: f64 = 3.0;
const ERRORS: f64 = 6.0;
const AMONG_OTHERS: f64 = 1.5;

/// A channel under loads along one axis at one pair of stations, as the file labels them.
#[derive(Debug, Clone)]
pub(super) struct Line {
    pub axis: Axis,
    pub channel: Axis,
    /// Where the load hangs and the sensor stands, m; `None` is the tip.
    pub stations: [Option<f64>; 2],
    /// Indices of its data.
    pub data: Vec<usize>,
    pub fit: Fit,
    /// The largest load, N.
    pub largest_load: f64,
    /// True where the loads differ: with their signs, or in size.
    pub has_slope: bool,
}

/// A robust straight line.
#[derive(Debug, Clone, Copy)]
pub(super) struct Fit {
    /// b, m/N, with its standard error.
    pub slope: f64,
    pub error: f64,
    /// a, m.
    pub zero: f64,
    /// p, m.
    pub play: f64,
    /// Scatter of a reading, m.
    pub scatter: f64,
}

impl Fit {
    /// What the line says of a signed load, m.
    pub fn at(&self, load: f64) -> f64 {
        let sign = if load == 0.0 { 0.0 } else { load.signum() };
        self.slope * load + self.zero + self.play * sign
    }
}

impl Line {
    /// True where a datum is on the line.
    pub fn holds(&self, datum: &Datum) -> bool {
        let stations = [datum.load_station, datum.read_station];
        (self.axis, self.channel, self.stations) == (datum.direction.axis, datum.channel, stations)
    }

    /// What a reading scatters by, m: no line is straighter than this share of its largest.
    pub fn scatter_of_readings(&self) -> f64 {
        self.fit.scatter.max(STRAIGHT * self.fit.slope.abs() * self.largest_load)
    }

    /// True where load and sensor are at one place: the rod gives way towards the load there.
    pub fn is_collocated(&self) -> bool {
        self.stations[0] == self.stations[1]
    }
}

/// The lines of `data`, of those channels that are `wanted`.
pub(super) fn lines(data: &[Datum], is_wanted: impl Fn(usize) -> bool) -> Vec<Line> {
    let mut found: Vec<Line> = Vec::new();
    for (index, datum) in data.iter().enumerate().filter(|(index, _)| is_wanted(*index)) {
        let stations = [datum.load_station, datum.read_station];
        match found.iter_mut().find(|line| line.holds(datum)) {
            Some(line) => line.data.push(index),
            None => found.push(Line {
                axis: datum.direction.axis,
                channel: datum.channel,
                stations,
                data: vec![index],
                fit: Fit { slope: 0.0, error: 0.0, zero: 0.0, play: 0.0, scatter: 0.0 },
                largest_load: 0.0,
                has_slope: false,
            }),
        }
    }
    for line in &mut found {
        let points: Vec<(f64, f64)> =
            line.data.iter().map(|&index| (data[index].signed_load(), data[index].measured)).collect();
        line.largest_load = points.iter().fold(0.0, |most: f64, (load, _)| most.max(load.abs()));
        line.has_slope = points.iter().any(|(load, _)| (load - points[0].0).abs() > 1e-6 * line.largest_load);
        line.fit = fit(&points);
    }
    found
}

/// A robust line through (signed load, reading).
pub(super) fn fit(points: &[(f64, f64)]) -> Fit {
    let largest = points.iter().fold(0.0, |most: f64, (_, y)| most.max(y.abs()));
    let load = points.iter().fold(0.0, |most: f64, (load, _)| most.max(load.abs()));
    let nothing = Fit { slope: 0.0, error: f64::INFINITY, zero: 0.0, play: 0.0, scatter: 0.0 };
    if load == 0.0 {
        return nothing;
    }
    let has_both = points.iter().any(|(load, _)| *load > 0.0) && points.iter().any(|(load, _)| *load < 0.0);
    let floor = FLOOR * largest.max(f64::MIN_POSITIVE);
    let mut scatter = (FIRST_GUESS * largest).max(floor);
    let mut weights = vec![1.0; points.len()];
    // loads in units of the largest, so that the matrix is well conditioned
    let row = |&(x, _): &(f64, f64)| {
        let sign = if x == 0.0 || !has_both { 0.0 } else { x.signum() };
        [x / load, 1.0, sign]
    };
    let rows: Vec<[f64; 3]> = points.iter().map(row).collect();
    let mut found = nothing;
    for _ in 0..ROUNDS {
        // Σ w·row·rowᵀ and Σ row·w·y in plain numbers: trials of mistakes do little else
        let mut normal = Matrix3::zeros();
        let mut right = Vector3::zeros();
        for ((row, (_, y)), weight) in rows.iter().zip(points).zip(&weights) {
            for i in 0..3 {
                for j in 0..=i {
                    normal[(i, j)] += row[i] * row[j] * weight;
                }
                right[i] += row[i] * (weight * y);
            }
        }
        for (i, j) in [(1, 0), (2, 0), (2, 1)] {
            normal[(j, i)] = normal[(i, j)];
        }
        let prior = (scatter / (AWAY_FROM_ORIGIN * largest).max(floor)).powi(2);
        normal[(1, 1)] += prior;
        normal[(2, 2)] += prior.max(1e-12);
        normal[(0, 0)] += 1e-12;
        let Some(inverse) = normal.try_inverse() else { return found };
        let values = inverse * right;
        found.slope = values[0] / load;
        found.zero = values[1];
        found.play = values[2];
        let mut sizes: Vec<f64> = points.iter().map(|&(x, y)| (y - found.at(x)).abs()).collect();
        let middle = sizes.len() / 2;
        let (_, &mut median, _) = sizes.select_nth_unstable_by(middle, f64::total_cmp);
        // the parameters take up some of the scatter of few points
        let few = (points.len() as f64 / (points.len() as f64 - 2.0).max(1.0)).sqrt();
        scatter = (1.4826 * few * median).max(floor);
        found.scatter = scatter;
        found.error = (scatter * inverse[(0, 0)].max(0.0).sqrt() / load).max(0.002 * found.slope.abs());
        for (&(x, y), weight) in points.iter().zip(&mut weights) {
            let r = (y - found.at(x)) / (CAUCHY * scatter);
            *weight = 1.0 / (1.0 + r * r);
        }
    }
    found
}

/// Which of some loads, N, is so many `times` the largest of the others.
pub(super) fn far_load(loads: &[f64], times: f64) -> Option<usize> {
    let far = (0..loads.len()).max_by(|&a, &b| loads[a].abs().total_cmp(&loads[b].abs()))?;
    let others = loads[..far].iter().chain(&loads[far + 1..]);
    let largest = others.fold(0.0, |most: f64, load| most.max(load.abs()));
    (loads[far].abs() >= times * largest).then_some(far)
}

/// Which of the points (signed load N, reading m) of a line has a load far beyond the others and
/// the reading of a load among them: a robust fit would follow it.
pub(super) fn wrong_load(points: &[(f64, f64)]) -> Option<usize> {
    let loads: Vec<f64> = points.iter().map(|(load, _)| *load).collect();
    let far = far_load(&loads, BEYOND)?;
    let others = [&points[..far], &points[far + 1..]].concat();
    let largest = others.iter().fold(0.0, |most: f64, (load, _)| most.max(load.abs()));
    let differ = others.iter().any(|(load, _)| (load - others[0].0).abs() > 0.2 * largest);
    if others.len() < 3 || !differ {
        return None;
    }
    let line = fit(&others);
    let (load, reading) = points[far];
    let off = reading - line.at(load);
    // the load that the reading is of, over the one in the file
    let share = 1.0 + off / (line.slope * load);
    let is_among_others = (0.0..=AMONG_OTHERS * largest).contains(&(share * load.abs()));
    let is_off = off.abs() > ERRORS * line.scatter.hypot(line.error * load);
    (is_among_others && is_off).then_some(far)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_load_ten_times_too_large_is_wrong_where_its_reading_shows_it() {
        let right: Vec<(f64, f64)> = [5.0, 10.0, 15.0, 20.0, 10.0].map(|f| (f, 45e-6 * f)).to_vec();
        let mut wrong = right.clone();
        wrong[2].0 = 150.0;
        assert_eq!((wrong_load(&wrong), wrong_load(&right)), (Some(2), None));
        wrong[2].0 = -150.0;
        wrong[2].1 *= -1.0;
        assert_eq!(wrong_load(&wrong), Some(2));
        // a reading that is on the line says most about it
        wrong[2].1 = -45e-6 * 150.0;
        assert_eq!(wrong_load(&wrong), None);
        // friction of 2 N: small loads show nothing, and the large one is right
        let friction = [0.5, 1.0, 1.5, 20.0].map(|f| (f, 45e-6 * f64::max(f - 2.0, 0.0)));
        assert_eq!(wrong_load(&friction), None);
        // a sensor at its limit
        let cut_off = [1.0, 2.0, 3.0, 20.0].map(|f| (f, 45e-6 * f64::min(f, 10.0)));
        assert_eq!(wrong_load(&cut_off), None);
    }

    #[test]
    fn zero_play_and_a_wrong_reading_leave_the_slope() {
        let loads = [-20.0, -10.0, -5.0, 5.0, 10.0, 15.0, 20.0, 20.0];
        let mut points: Vec<(f64, f64)> =
            loads.iter().map(|&f: &f64| (f, 45e-6 * f + 1e-4 + 3e-5 * f.signum())).collect();
        points[6].1 += 5e-3;
        let fit = fit(&points);
        assert!((fit.slope / 45e-6 - 1.0).abs() < 0.02, "{fit:?}");
    }

    #[test]
    fn two_loads_are_a_line_and_one_is_hardly() {
        let two = fit(&[(5.0, 225e-6), (10.0, 450e-6)]);
        assert!((two.slope / 45e-6 - 1.0).abs() < 0.02, "{two:?}");
        let one = fit(&[(5.0, 225e-6), (5.0, 226e-6)]);
        assert!((one.slope / 45e-6 - 1.0).abs() < 0.2, "{one:?}");
    }
}
