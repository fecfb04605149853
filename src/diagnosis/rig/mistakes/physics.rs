//! What a rod says of each line, and what ordinary physics may add to that: the rivals of every
//! mistake.
//!
//! ```text
//! b = G·C[m, n]·eᵗ + Σ size·column + own      b the slope of a line, m/N; G the factor of the mistakes
//! ```
//!
//! Columns: stiffness, shear, joints along the rod, one axis' loads, one channel, loads and sensors
//! turned; by themselves lengths, the angle and the points of loads and sensors; `own` is each
//! line's own. How large they may be is a [`MOODS`] entry: as files are, some times that, much,
//! and, one after another, one thing far off with the rest as files are.
//! Everything is relative to the rod, so that units do not matter, and the density is that of the
//! slopes as recorded, so that no rescaling is favoured.

mod columns;
mod far_off;
mod mood;

use nalgebra::{Cholesky, DMatrix, DVector, Matrix3, Vector3};

use self::columns::Columns;
use self::far_off::{SINGLE_ANGLE, SINGLE_POINT, Solved};
use self::mood::{MOODS, Mood};
use super::lines::Line;
use crate::diagnosis::rig::mechanics::structure::{End, Point, Softening, Structure, between};
use crate::error::Result;
use crate::rod::{NominalNumber, Rod};
use crate::spatial::Axis;

/// Points of loads, and of sensors, at so many stations at most.
const MOST_POINTS: usize = 12;

/// Lines have one factor in common where that of so large a share of them differs by less than ln
/// 2.
const COMMON: f64 = 0.8;
const NEAR: f64 = 0.693;
/// A slope that is known no better than to this share counts half.
const KNOWN: f64 = 0.05;

/// What it costs to say that a rod moves against its load: a passive structure cannot.
const AGAINST_THE_LOAD: f64 = 30.0;

/// From this share of the rod's own deflection on: less may be a sensor that is turned, or drift.
const AS_THE_ROD: f64 = 0.3;

/// A rod at the pairs of stations of the readings, m/N.
#[derive(Debug, Clone)]
pub(super) struct Physics {
    compliance: Vec<Matrix3<f64>>,
    shear: Vec<Matrix3<f64>>,
    /// Softer joints along the rod, each in bending and in torsion, by the whole rod's own
    /// flexibility.
    joints: Vec<Vec<Matrix3<f64>>>,
    /// Loads or sensors of one station that are elsewhere: along the rod, and beside it.
    points: Vec<Vec<Matrix3<f64>>>,
}

impl Physics {
    /// Of `rod` between pairs of load and read stations, m; `None` is the tip.
    pub fn new(rod: &Rod, pairs: &[[Option<f64>; 2]]) -> Result<Physics> {
        let tip = rod.length();
        let at = |station: Option<f64>| station.unwrap_or(tip).min(tip);
        let pairs: Vec<(f64, f64)> = pairs.iter().map(|[load, read]| (at(*load), at(*read))).collect();
        let mut structure = Structure::new(rod, pairs)?;
        let rotation = structure.rotation();
        let corner = rod.bend_start();
        // dense enough that a joint anywhere is one of them to a few percent
        let first = [0.0, 0.2, 0.4, 0.6, 0.8, 1.0].map(|share| share * corner);
        let second = [0.15, 0.3, 0.45, 0.6, 0.8].map(|share| corner + share * (tip - corner));
        let places = first.into_iter().chain(second);
        let mut joints = Vec::new();
        for place in places {
            joints.extend(structure.add_joint(place).into_iter().zip(rotation));
        }
        let whole = structure.softened(&Softening::default());
        let points = points(rod, &structure, &whole)?;
        let more = |softening: Softening| -> Vec<Matrix3<f64>> {
            structure.softened(&softening).iter().zip(&whole).map(|(soft, whole)| soft - whole).collect()
        };
        let joints = joints
            .into_iter()
            .map(|joint| more(Softening { joints: vec![joint], ..Softening::default() }))
            .collect();
        Ok(Physics {
            points,
            shear: more(Softening { shear: 0.5, ..Softening::default() }),
            compliance: whole,
            joints,
        })
    }

    /// Displacement per load of a pair of stations, m/N.
    pub fn compliance(&self, pair: usize) -> &Matrix3<f64> {
        &self.compliance[pair]
    }
}

/// By how much the compliance changes with each length and the angle of the rod, and where loads
/// act, or sensors read, at another point: of each station, nearer to the flange and beside the
/// rod.
fn points(rod: &Rod, structure: &Structure, whole: &[Matrix3<f64>]) -> Result<Vec<Vec<Matrix3<f64>>>> {
    let size = SINGLE_POINT * rod.length();
    let less = |moved: Vec<Matrix3<f64>>| moved.iter().zip(whole).map(|(own, whole)| own - whole).collect();
    let mut points = Vec::new();
    for (number, value) in [
        (NominalNumber::LengthL1, rod.l1 * (1.0 + SINGLE_POINT)),
        (NominalNumber::LengthL2, rod.l2 * (1.0 + SINGLE_POINT)),
        (NominalNumber::Angle, rod.gamma - SINGLE_ANGLE),
    ] {
        let other = rod.with(&number, value);
        // a rod that cannot be is no rival
        if let Ok(moved) = between(&other, &structure.pairs_on(&other)) {
            points.push(less(moved));
        }
    }
    for end in [End::Load, End::Reading] {
        for station in structure.stations_of(end).into_iter().take(MOST_POINTS) {
            let nearer = Point { station: (station - size).max(0.0), arm: Vector3::zeros() };
            let beside = Axis::ALL.map(|axis| Point { station, arm: Vector3::ith(axis.index(), size) });
            for point in beside.into_iter().chain([nearer]) {
                points.push(less(between(rod, &structure.with_point(end, station, point))?));
            }
        }
    }
    Ok(points)
}

/// What a line of the file really is: channel m under loads along n, times G.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct View {
    pub channel: Axis,
    pub axis: Axis,
    pub factor: f64,
}

/// Lines of the file with the views of a hypothesis on them.
pub(super) struct Seen<'a> {
    pub lines: &'a [Line],
    /// For each line its pair of stations.
    pub pair: &'a [usize],
    pub physics: &'a Physics,
    pub views: Vec<View>,
}

/// How well a hypothesis explains the slopes.
#[derive(Debug, Clone, Copy)]
pub(super) struct Verdict {
    /// Ln of the density of the slopes.
    pub log_evidence: f64,
    /// Ln of the factor that all lines have in common, measured over expected.
    pub log_scale: f64,
    /// The same, where a line counts as far as its slope is known.
    pub log_scale_of_known: f64,
}

/// How much a line counts whose slope has this relative error.
fn known(line: &Line) -> f64 {
    1.0 / (1.0 + (line.fit.error / (KNOWN * line.fit.slope)).powi(2))
}

impl Seen<'_> {
    /// Expected slope of each line, m/N.
    pub fn expected(&self) -> Vec<f64> {
        (0..self.lines.len()).map(|k| self.slope(k, &self.physics.compliance)).collect()
    }

    /// Ln of the factor that the lines of some channels have in common, measured over expected: of
    /// those within 2 of their median, the one that leaves the least.
    pub fn log_scale_of(&self, channels: &[Axis]) -> f64 {
        let is_its = |line: &Line| channels.contains(&line.channel);
        let expected = self.expected();
        let (median, _) = self.log_scale(&expected, |line| f64::from(u8::from(is_its(line))));
        let (mut measured, mut squares) = (0.0, 0.0);
        for (line, expected) in self.lines.iter().zip(&expected).filter(|(line, _)| is_its(line)) {
            if ((line.fit.slope / expected).abs().ln() - median).abs() < NEAR {
                measured += line.largest_load.powi(2) * (line.fit.slope * expected).abs();
                squares += (line.largest_load * expected).powi(2);
            }
        }
        if squares > 0.0 { (measured / squares).ln() } else { median }
    }

    fn slope(&self, line: usize, parts: &[Matrix3<f64>]) -> f64 {
        let view = &self.views[line];
        view.factor * parts[self.pair[line]][(view.channel.index(), view.axis.index())]
    }

    /// Ln of the common factor: the median of the lines' own, weighted by what each shows of its
    /// load and by what it `counts`, which some wrong ones do not move; and whether nearly all have
    /// it.
    fn log_scale(&self, expected: &[f64], counts: impl Fn(&Line) -> f64) -> (f64, bool) {
        let most = self.largest(expected);
        let mut ratios: Vec<(f64, f64)> = Vec::new();
        for (k, line) in self.lines.iter().enumerate() {
            let (b, e) = (line.fit.slope, expected[k]);
            let relative = e.abs() * line.largest_load / (most[k] * line.largest_load).max(f64::MIN_POSITIVE);
            if relative > 0.1 && b != 0.0 && b.abs() > 3.0 * line.fit.error {
                ratios.push(((b / e).abs().ln(), relative * counts(line)));
            }
        }
        ratios.sort_by(|a, b| a.0.total_cmp(&b.0));
        let total: f64 = ratios.iter().map(|(_, weight)| weight).sum();
        let mut sum = 0.0;
        let mut median = 0.0;
        for (k, (ratio, weight)) in ratios.iter().enumerate() {
            sum += weight;
            if 2.0 * sum > total * (1.0 + 1e-9) {
                median = *ratio;
                break;
            }
            if 2.0 * sum >= total * (1.0 - 1e-9) {
                median = 0.5 * (ratio + ratios.get(k + 1).map_or(*ratio, |next| next.0));
                break;
            }
        }
        let near = ratios.iter().filter(|(ratio, _)| (ratio - median).abs() < NEAR);
        (median, near.map(|(_, weight)| weight).sum::<f64>() > COMMON * total)
    }

    /// For each line the largest slope that the rod has under the same load, m/N.
    fn largest(&self, expected: &[f64]) -> Vec<f64> {
        let of_view = |k: usize| {
            let view = &self.views[k];
            let column = self.physics.compliance[self.pair[k]].column(view.axis.index()).amax();
            (view.factor.abs() * column).max(expected[k].abs()).max(f64::MIN_POSITIVE)
        };
        (0..self.lines.len()).map(of_view).collect()
    }

    /// How well the slopes are explained, with all that ordinary physics may add.
    pub fn verdict(&self) -> Verdict {
        let expected = self.expected();
        let (log_scale, is_common) = self.log_scale(&expected, |_| 1.0);
        let (log_scale_of_known, _) = self.log_scale(&expected, known);
        let columns = self.columns(&expected);
        let mut terms = Vec::new();
        for (mood, is_first) in MOODS.iter().zip([true, false, false, false]) {
            let scales: &[f64] = if is_first { &[0.0] } else { &[0.0, log_scale] };
            for &scale in scales {
                let sizes = if is_common { scale.min(log_scale) } else { scale };
                let Some(solved) = self.solved(&expected, &columns, mood, scale, sizes) else { continue };
                let (about, prior) = mood.scale;
                let price = -0.5 * (scale / prior).powi(2) - (prior / about).ln();
                terms.push(mood.log_weight + price + solved.log_density);
                if is_first {
                    terms.extend(solved.with_one_far_off(&columns));
                }
            }
        }
        let best = terms.iter().copied().fold(f64::NEG_INFINITY, f64::max);
        let sum: f64 = terms.iter().map(|term| (term - best).exp()).sum();
        let log_evidence = best + sum.ln() - AGAINST_THE_LOAD * self.against_the_load() as f64;
        Verdict {
            log_evidence: if log_evidence.is_nan() { f64::NEG_INFINITY } else { log_evidence },
            log_scale,
            log_scale_of_known,
        }
    }

    /// Ln of the density of the slopes where one part gives way by nobody knows how much.
    pub fn log_evidence_of_loose(&self) -> f64 {
        let expected = self.expected();
        let columns = self.columns(&expected);
        let solved = |mood| Some((mood, self.solved(&expected, &columns, mood, 0.0, 0.0)?));
        let terms = MOODS.iter().filter_map(solved).flat_map(|(mood, solved)| {
            solved.with_one_loose(&columns).into_iter().map(|term| mood.log_weight + term)
        });
        terms.fold(f64::NEG_INFINITY, f64::max)
    }

    /// Lines that would move against their load.
    pub fn against_the_load(&self) -> usize {
        let is_against = |k: &usize| {
            let (line, view) = (&self.lines[*k], &self.views[*k]);
            let slope = line.fit.slope / view.factor;
            let error = line.fit.error / view.factor.abs();
            line.is_collocated() && view.axis == view.channel && slope < -4.0 * error && {
                // of a channel that shows the load at all
                let own = self.physics.compliance[self.pair[*k]][(view.axis.index(), view.axis.index())];
                slope.abs() > AS_THE_ROD * own
                    && line.fit.slope.abs() * line.largest_load > 5.0 * line.fit.scatter
            }
        };
        (0..self.lines.len()).filter(is_against).count()
    }

    fn columns(&self, expected: &[f64]) -> Columns {
        let n = self.lines.len();
        let column = |entry: &dyn Fn(usize) -> f64| DVector::from_fn(n, |k, _| entry(k));
        let compliance = |k: usize, channel: Axis, axis: Axis| {
            self.views[k].factor * self.physics.compliance[self.pair[k]][(channel.index(), axis.index())]
        };
        let mut turns = Vec::new();
        for (from, towards) in Axis::ALL.into_iter().flat_map(|a| Axis::ALL.map(|b| (a, b))) {
            if from == towards {
                continue;
            }
            turns.push(column(&|k| match self.views[k].axis == from {
                true => compliance(k, self.views[k].channel, towards),
                false => 0.0,
            }));
            turns.push(column(&|k| match self.views[k].channel == from {
                true => compliance(k, towards, self.views[k].axis),
                false => 0.0,
            }));
        }
        turns.retain(|turn| turn.amax() > 0.0);
        let part = |is_seen: &dyn Fn(&View) -> bool| {
            column(&|k| if is_seen(&self.views[k]) { expected[k] } else { 0.0 })
        };
        let whole = column(&|k| expected[k]);
        let shear = column(&|k| self.slope(k, &self.physics.shear));
        let joints: Vec<_> =
            self.physics.joints.iter().map(|joint| column(&|k| self.slope(k, joint))).collect();
        let points: Vec<_> =
            self.physics.points.iter().map(|point| column(&|k| self.slope(k, point))).collect();
        let axes: Vec<_> = Axis::ALL.map(|axis| part(&|view| view.axis == axis)).into();
        let channels: Vec<_> = Axis::ALL.map(|channel| part(&|view| view.channel == channel)).into();
        let squares = |columns: &[DVector<f64>]| {
            let mut sum = DMatrix::zeros(n, n);
            columns.iter().for_each(|column| sum.ger(1.0, column, column, 1.0));
            sum
        };
        let of_whole = squares(std::slice::from_ref(&whole));
        let of_shear = squares(std::slice::from_ref(&shear));
        let squares =
            [of_whole, of_shear, squares(&joints), squares(&axes), squares(&channels), squares(&turns)];
        Columns {
            shear,
            joints,
            points,
            axes,
            channels,
            turns,
            squares,
            own: DVector::from_vec(self.largest(expected)),
        }
    }

    /// The Gaussian model of one mood, solved. What physics adds is measured by the deflections
    /// `sizes` (ln of what they are of the rod's own): a part that gives way by less than nothing
    /// does not make a rod stiff.
    fn solved(
        &self,
        expected: &[f64],
        columns: &Columns,
        mood: &Mood,
        scale: f64,
        sizes: f64,
    ) -> Option<Solved> {
        let n = self.lines.len();
        let (scale, factor) = (scale.exp(), sizes.exp());
        let mut covariance = DMatrix::zeros(n, n);
        for (k, line) in self.lines.iter().enumerate() {
            covariance[(k, k)] = line.fit.error.powi(2) + (factor * mood.own * columns.own[k]).powi(2);
        }
        let sizes = [mood.scale.0, mood.shear, mood.joint, mood.axis, mood.channel, mood.turn];
        for (squares, size) in columns.squares.iter().zip(sizes) {
            let weight = (factor * size).powi(2);
            covariance.zip_apply(squares, |sum, square| *sum += weight * square);
        }
        let off = DVector::from_fn(n, |k, _| self.lines[k].fit.slope - scale * expected[k]);
        let root = Cholesky::new(covariance)?;
        let log_root: f64 = root.l_dirty().diagonal().iter().map(|d| d.ln()).sum();
        let solved = root.solve(&off);
        Some(Solved { log_density: -0.5 * off.dot(&solved) - log_root, root, solved })
    }
}
