//! What a structure would be with other lengths, or with loads and sensors at other points.
//!
//! A length enters the compliance as a polynomial between two features of the rod: lever arms are
//! of first degree in it, what they bend of third. The polynomial through the structures at five
//! values is that one; of an angle, whose sine it follows, it is so to 2e-3 of the change.

use nalgebra::{Matrix3, Vector3};

use super::point::{Point, tangent};
use crate::rod::{NominalNumber, Rod};
use crate::spatial::Axis;

/// Which end of the way from a load to a reading.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum End {
    /// Where loads act.
    Load,
    /// Where sensors read.
    Reading,
}

/// What is another one.
#[derive(Debug, Clone, PartialEq)]
pub enum Varied {
    /// A number of the rod's file, of this value there.
    Number(NominalNumber, f64),
    /// The station of loads or sensors, by what is added, m: of those at this one. Beyond the tip
    /// the point is on its tangent.
    Along(End, f64),
    /// The same across the rod, along an axis of {T}.
    Beside(End, f64, Axis),
}

/// Structures at other values of one number.
#[derive(Debug, Clone)]
pub struct Variation<S> {
    /// The value of the file.
    neutral: f64,
    /// The other ones.
    nodes: Vec<(f64, S)>,
    pub varied: Varied,
}

/// Values beside the file's, as shares of the most; what is linear needs one of them.
const NODES: [f64; 4] = [-1.0, -0.5, 0.5, 1.0];

impl<S> Variation<S> {
    /// Of `rod` between these points, at values up to `most` from its own, made of `structure`;
    /// `None` where that refuses one of them.
    pub fn new(
        rod: &Rod,
        pairs: &[[Point; 2]],
        varied: Varied,
        most: f64,
        structure: impl Fn(&Rod, Vec<[Point; 2]>) -> Option<S>,
    ) -> Option<Variation<S>> {
        let neutral = if let Varied::Number(_, value) = varied { value } else { 0.0 };
        let shares = if let Varied::Beside(..) = varied { &NODES[3..] } else { &NODES[..] };
        let node = |share: &f64| {
            let value = neutral + share * most;
            let (rod, pairs) = changed(rod, pairs, &varied, value);
            Some((value, structure(&rod, pairs)?))
        };
        let nodes = shares.iter().map(node).collect::<Option<Vec<_>>>()?;
        Some(Variation { neutral, nodes, varied })
    }

    /// The other structures, each with its share of what changes at `value`: by the polynomial
    /// through all nodes, of which the file's is one.
    ///
    /// ```text
    /// Σ_k w_k(value)·(P_k − P_0)     w Lagrange's polynomials, which add up to one
    /// ```
    pub fn shares(&self, value: f64) -> impl Iterator<Item = (f64, &S)> {
        self.nodes.iter().enumerate().map(move |(k, (at, node))| {
            let others = self.nodes.iter().enumerate().filter(|(other, _)| *other != k);
            let values = others.map(|(_, (other, _))| *other).chain([self.neutral]);
            (values.map(|other| (value - other) / (at - other)).product(), node)
        })
    }

    /// Leaves nothing of what it does not concern.
    pub fn mask(&self, change: &mut Matrix3<f64>, pair: &[Point; 2], axes: &[bool; 3]) {
        let (Varied::Along(end, station) | Varied::Beside(end, station, _)) = &self.varied else {
            return;
        };
        let is_there = pair[*end as usize].station == *station;
        for axis in Axis::ALL.map(Axis::index).into_iter().filter(|axis| !(is_there && axes[*axis])) {
            match end {
                End::Load => change.column_mut(axis).fill(0.0),
                End::Reading => change.row_mut(axis).fill(0.0),
            }
        }
    }
}

/// The rod, and the pairs of points on it, where the number has another value.
fn changed(rod: &Rod, pairs: &[[Point; 2]], varied: &Varied, value: f64) -> (Rod, Vec<[Point; 2]>) {
    let tip = rod.length();
    match varied {
        Varied::Number(number, _) => {
            let mut other = rod.with(number, value);
            let stations: Vec<f64> =
                rod.joints.iter().map(|joint| moved(rod, &other, joint.station)).collect();
            other.joints.iter_mut().zip(stations).for_each(|(joint, own)| joint.station = own);
            let pairs = pairs.iter().map(|pair| pair.each_ref().map(|point| point.moved(rod, &other)));
            let pairs = pairs.collect();
            (other, pairs)
        }
        Varied::Along(end, station) => {
            let along = |point: &mut Point| {
                let at = (station + value).clamp(0.0, tip);
                *point = Point { station: at, arm: tangent(rod, tip) * (station + value - at) };
            };
            (rod.clone(), displaced(pairs, *end, *station, along))
        }
        Varied::Beside(end, station, axis) => {
            let beside = |point: &mut Point| point.arm = Vector3::ith(axis.index(), value);
            (rod.clone(), displaced(pairs, *end, *station, beside))
        }
    }
}

/// The pairs of which the points of one end at a station are displaced.
pub(super) fn displaced(
    pairs: &[[Point; 2]],
    end: End,
    station: f64,
    by: impl Fn(&mut Point),
) -> Vec<[Point; 2]> {
    let mut pairs = pairs.to_vec();
    let own = pairs.iter_mut().map(|pair| &mut pair[end as usize]);
    own.filter(|point| point.station == station).for_each(by);
    pairs
}

/// A station of one rod on another one whose pipes or bend are of another length: as far between
/// the same features.
pub(super) fn moved(rod: &Rod, other: &Rod, station: f64) -> f64 {
    let features = |rod: &Rod| [0.0, rod.bend_start(), rod.bend_end(), rod.length()];
    let (own, others) = (features(rod), features(other));
    let k = (1..3).find(|k| station <= own[*k]).unwrap_or(3);
    let share = (station - own[k - 1]) / (own[k] - own[k - 1]).max(f64::MIN_POSITIVE);
    others[k - 1] + share * (others[k] - others[k - 1])
}
