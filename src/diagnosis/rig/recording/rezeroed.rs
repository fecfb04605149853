//! Whether the zero of a run holds for both directions of its axis.
//!
//! A rod that is pulled along y and then along −y hangs on another pulley in between. Whether the
//! sensors were zeroed there too, no column says; the readings do. In each run, sensor and
//! direction a straight line through the readings has an intercept a, and
//!
//! ```text
//! d = a₊ − a₋,      z² = (d_k − d_m)²/(se²(d_k) + se²(d_m))
//! ```
//!
//! compares it between two runs: whatever a rod, its play or its friction make of d, they make of
//! it in every run, a zero of its own does not. A slip in one of three runs moves two of their
//! three z², so a third of all is looked at: by chance alone that lies below 0.18.

use std::collections::BTreeMap;

use crate::spatial::Axis;

/// Share of the z² that lies farther out only where zeros were taken for each direction, and how
/// far out: a scatter of more than three times that of chance.
const APART: (f64, f64) = (1.0 / 3.0, 2.0);
/// Runs are compared with so many behind them.
const BEHIND: usize = 8;
/// Of fewer comparisons nobody can tell.
const FEWEST: usize = 6;
/// Readings of an intercept that knows its error.
const READINGS: usize = 3;

/// Axis of the load, and the sensor by its channel and place.
type Line = (Axis, (Axis, u64));

/// One reading.
pub(super) struct Shown {
    pub line: Line,
    pub run: usize,
    /// True for a load against the axis.
    pub is_against: bool,
    pub order: usize,
    /// N.
    pub load: f64,
    /// m.
    pub measured: f64,
}

/// True where every direction of a run begins with a zero of its own.
pub(super) fn is_zeroed_by_direction(shown: impl Iterator<Item = Shown>) -> bool {
    let mut sides: BTreeMap<(Line, usize), [Side; 2]> = BTreeMap::new();
    for reading in shown {
        sides.entry((reading.line, reading.run)).or_default()[usize::from(reading.is_against)].push(&reading);
    }
    if sides.values().any(|[up, down]| up.overlaps(down)) {
        return false;
    }
    let mut intercepts: BTreeMap<Line, Vec<[Intercept; 2]>> = BTreeMap::new();
    for ((line, _), [up, down]) in &sides {
        if let (Some(up), Some(down)) = (up.intercept(), down.intercept()) {
            intercepts.entry(*line).or_default().push([up, down]);
        }
    }
    let mut squares = Vec::new();
    for runs in intercepts.values() {
        let all = || runs.iter().flatten();
        let freedom: f64 = all().map(|own| own.freedom).sum();
        let variance = all().map(|own| own.square_sum).sum::<f64>() / freedom;
        let apart = |one: &[Intercept; 2], other: &[Intercept; 2]| {
            let d = |[up, down]: &[Intercept; 2]| up.value - down.value;
            let factor: f64 = one.iter().chain(other).map(|own| own.variance_factor).sum();
            (d(one) - d(other)).powi(2) / (variance * factor)
        };
        for (k, one) in runs.iter().enumerate() {
            let behind = runs[k + 1..].iter().take(BEHIND);
            squares.extend(behind.map(|other| apart(one, other)).filter(|square| square.is_finite()));
        }
    }
    squares.sort_by(f64::total_cmp);
    let third = (squares.len() as f64 * APART.0) as usize;
    squares.len() >= FEWEST && squares[third] > APART.1
}

/// The readings of one sensor in one direction of a run.
#[derive(Default)]
struct Side {
    load: Vec<f64>,
    measured: Vec<f64>,
    /// The first instant and the last.
    span: Option<(usize, usize)>,
}

/// Of the straight line through the readings of a side.
struct Intercept {
    value: f64,
    /// Its variance over that of a reading: 1/n + x̄²/Σ(x − x̄)².
    variance_factor: f64,
    /// Sum of the squared residuals, and what is left of their number.
    square_sum: f64,
    freedom: f64,
}

impl Side {
    fn push(&mut self, reading: &Shown) {
        self.load.push(reading.load);
        self.measured.push(reading.measured);
        let (first, last) = self.span.unwrap_or((reading.order, reading.order));
        self.span = Some((first.min(reading.order), last.max(reading.order)));
    }

    /// True where the directions took turns, so that nothing was hung anew in between.
    fn overlaps(&self, other: &Side) -> bool {
        let (Some(own), Some(other)) = (self.span, other.span) else { return false };
        own.0 <= other.1 && other.0 <= own.1
    }

    fn intercept(&self) -> Option<Intercept> {
        let n = self.load.len() as f64;
        let [x, y] = [&self.load, &self.measured].map(|values| values.iter().sum::<f64>() / n);
        let about = |x: f64| self.load.iter().map(move |load| load - x);
        let spread: f64 = about(x).map(|d| d * d).sum();
        if self.load.len() < READINGS || spread == 0.0 {
            return None;
        }
        let slope = about(x).zip(&self.measured).map(|(d, m)| d * (m - y)).sum::<f64>() / spread;
        let left = about(x).zip(&self.measured).map(|(d, m)| m - y - slope * d);
        Some(Intercept {
            value: y - slope * x,
            variance_factor: 1.0 / n + x * x / spread,
            square_sum: left.map(|r| r * r).sum(),
            freedom: n - 2.0,
        })
    }
}

#[cfg(test)]
mod tests {
    use crate::diagnosis::rig::recording::columns::sensor_in_run;
    use crate::diagnosis::rig::recording::datum::{self, Datum};
    use crate::rig::readings::Readings;
    use crate::statistics::Random;

    /// Readings of three trials along ±y and ±z; `zeros`: how far the zeros of the directions
    /// scatter, µm, of which readings scatter by 1; `slip`: what −y of the second trial is off by.
    fn recording(zeros: f64, slip: f64, takes_turns: bool) -> Vec<Datum> {
        let mut random = Random::seeded(7, 0);
        let mut text = "axis,load_n,trial,dx_um,dy_um,dz_um\n".to_owned();
        for trial in 1..=3 {
            for axis in ["y", "z"] {
                let zero = [0; 6].map(|_| zeros * random.normal());
                let mut rows = Vec::new();
                for (side, sign) in ["", "-"].into_iter().enumerate() {
                    for load in [2.0, 4.0, 6.0, 8.0] {
                        let is_slipped = slip != 0.0 && trial == 2 && axis == "y" && sign == "-";
                        let mut read = |channel: usize| {
                            let friction = if sign == "-" { 3.0 } else { -3.0 };
                            let moved = if is_slipped { slip } else { 0.0 };
                            friction + load * 5.0 + moved + zero[3 * side + channel] + random.normal()
                        };
                        let [x, y, z] = [0, 1, 2].map(&mut read);
                        rows.push(format!("{sign}{axis},{load},{trial},{x},{y},{z}\n"));
                    }
                }
                if takes_turns {
                    rows = (0..4).flat_map(|k| [rows[k].clone(), rows[k + 4].clone()]).collect();
                }
                text += &rows.concat();
            }
        }
        datum::all(&Readings::from_text("f", &text).unwrap().rows)
    }

    #[test]
    fn zeros_of_directions_are_seen_in_the_readings() {
        let runs = |data: &[Datum]| data.iter().map(|d| d.run).max().unwrap() + 1;
        assert_eq!(runs(&recording(0.0, 0.0, false)), 6, "one zero for both directions");
        assert_eq!(runs(&recording(6.0, 0.0, false)), 12, "a zero for each");
        assert_eq!(runs(&recording(0.0, 40.0, false)), 6, "a slip is none");
        assert_eq!(runs(&recording(6.0, 0.0, true)), 6, "nobody zeroes between two readings");
    }

    #[test]
    fn the_zero_of_one_direction_is_that_of_its_rows() {
        let place = |data: &[Datum]| {
            let run: Vec<&Datum> = data.iter().filter(|d| d.run == 1).collect();
            sensor_in_run(run[0], run[run.len() - 1]).to_string()
        };
        assert_eq!(place(&recording(0.0, 0.0, false)), "dx_um, axis z, trial 1");
        assert_eq!(place(&recording(6.0, 0.0, false)), "dx_um, axis y, rows 5 to 8");
    }
}
