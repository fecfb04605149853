//! The outline of what is around a centreline: a polygon between two distances from it.

use super::super::super::scale::drawable;

/// Shorter than this a stretch is seen end on, mm.
const END_ON: f64 = 1e-6;
/// A corner sharper than this is cut off rather than mitred: the mitre's length over the distance.
const LONGEST_MITRE: f64 = 4.0;

/// A centreline as it is seen, with what is needed to draw along it.
pub(super) struct Outline {
    points: Vec<[f64; 2]>,
    /// Arc length of the undeformed rod at each point, mm.
    stations: Vec<f64>,
    /// Across the line at each point, as long as the mitre there; zero where all is seen end on.
    across: Vec<[f64; 2]>,
}

impl Outline {
    /// Of points as they are seen, at these stations (mm).
    pub(super) fn new(points: Vec<[f64; 2]>, stations: &[f64]) -> Self {
        let across = across(&points, &normals(&points));
        // a place without a point has no part in it
        let stations = stations.iter().take(points.len()).copied().collect();
        Outline { points, stations, across }
    }

    /// The same with its points elsewhere. What was seen end on stays without an outline of its
    /// own, however little of it is seen now.
    pub(super) fn moved(&self, points: Vec<[f64; 2]>) -> Self {
        let mut there = normals(&points);
        for (now, before) in there.iter_mut().zip(normals(&self.points)) {
            *now = now.filter(|_| before.is_some());
        }
        let stations = self.stations.iter().take(points.len()).copied().collect();
        Outline { across: across(&points, &there), points, stations }
    }

    /// From one station to another (mm), between two distances from the centreline (mm, to the
    /// left of its direction); empty where that is seen end on.
    pub(super) fn strip(&self, from: f64, to: f64, right: f64, left: f64) -> Vec<[f64; 2]> {
        let [right, mut left] = self.edges(from, to, right, left);
        left.extend(right.into_iter().rev());
        left
    }

    /// Both edges of such a strip, the right one first, each in the direction of the line.
    pub(super) fn edges(&self, from: f64, to: f64, right: f64, left: f64) -> [Vec<[f64; 2]>; 2] {
        let along = self.between(from, to);
        let length: f64 = along
            .windows(2)
            .map(|pair| f64::hypot(pair[1].0[0] - pair[0].0[0], pair[1].0[1] - pair[0].0[1]))
            .sum();
        if !drawable(length) || length <= END_ON {
            return [Vec::new(), Vec::new()];
        }
        [edge(&along, right), edge(&along, left)]
    }

    /// Where the line turns by more than a little within a stretch, at its sharpest.
    pub(super) fn turns(&self, from: f64, to: f64) -> Option<[f64; 2]> {
        const LITTLE: f64 = 1.02;
        let size = |n: &[f64; 2]| f64::hypot(n[0], n[1]);
        let all = self.between(from, to).into_iter();
        let sharpest = all.max_by(|a, b| size(&a.1).total_cmp(&size(&b.1)))?;
        (size(&sharpest.1) > LITTLE).then_some(sharpest.0)
    }

    /// Where a stretch that is seen end on lies.
    pub(super) fn end_on(&self, from: f64, to: f64) -> Option<[f64; 2]> {
        let is_end_on = self.strip(from, to, -1.0, 1.0).is_empty();
        self.between(from, to).first().map(|(point, _)| *point).filter(|_| is_end_on)
    }

    /// Points and what lies across them, from one station to another.
    fn between(&self, from: f64, to: f64) -> Vec<([f64; 2], [f64; 2])> {
        let inner = self.stations.iter().enumerate().filter(|(_, s)| **s > from && **s < to).map(|(k, _)| k);
        let mut along: Vec<_> = self.at(from).into_iter().collect();
        along.extend(inner.map(|k| (self.points[k], self.across[k])));
        along.extend(self.at(to));
        along
    }

    /// A place between two points of the line. An end on a point has the mitre of that point.
    fn at(&self, station: f64) -> Option<([f64; 2], [f64; 2])> {
        if let Some(k) = self.stations.iter().position(|s| (s - station).abs() < END_ON) {
            return Some((self.points[k], self.across[k]));
        }
        let after = self.stations.iter().position(|s| *s > station)?;
        let before = after.checked_sub(1)?;
        let share = (station - self.stations[before]) / (self.stations[after] - self.stations[before]);
        let (a, b) = (self.points[before], self.points[after]);
        let point = [a[0] + share * (b[0] - a[0]), a[1] + share * (b[1] - a[1])];
        Some((point, normal(a, b).unwrap_or(self.across[after])))
    }
}

/// One edge, at a distance from the line. Points that lie behind a mitred end have no part in it:
/// the edge would run back to them.
fn edge(along: &[([f64; 2], [f64; 2])], by: f64) -> Vec<[f64; 2]> {
    let beside = |(p, n): &([f64; 2], [f64; 2])| [p[0] + by * n[0], p[1] + by * n[1]];
    let [first, inner @ .., last] = along else { return along.iter().map(beside).collect() };
    let (second, before) = (inner.first().unwrap_or(last), inner.last().unwrap_or(first));
    let (start, end) = (beside(first), beside(last));
    let is_near = |a: [f64; 2], b: [f64; 2]| f64::hypot(a[0] - b[0], a[1] - b[1]) <= LONGEST_MITRE * by.abs();
    let ahead = |a: [f64; 2], b: [f64; 2], way: [[f64; 2]; 2]| {
        (0..2).map(|i| (b[i] - a[i]) * (way[1][i] - way[0][i])).sum::<f64>() > 0.0
    };
    let has_part = |place: &&([f64; 2], [f64; 2])| {
        let q = beside(place);
        (!is_near(place.0, first.0) || ahead(start, q, [first.0, second.0]))
            && (!is_near(place.0, last.0) || ahead(q, end, [before.0, last.0]))
    };
    let kept = inner.iter().filter(has_part).map(beside);
    std::iter::once(start).chain(kept).chain([end]).collect()
}

/// To the left of the way from one point to another; `None` where there is none.
fn normal(a: [f64; 2], b: [f64; 2]) -> Option<[f64; 2]> {
    let (dx, dy) = (b[0] - a[0], b[1] - a[1]);
    let length = f64::hypot(dx, dy);
    (drawable(length) && length > END_ON).then(|| [-dy / length, dx / length])
}

/// Of each piece of a line.
fn normals(points: &[[f64; 2]]) -> Vec<Option<[f64; 2]>> {
    points.windows(2).map(|pair| normal(pair[0], pair[1])).collect()
}

/// The mitre at each point: (n₁ + n₂)/(1 + n₁·n₂) of the normals before and after it.
fn across(points: &[[f64; 2]], normals: &[Option<[f64; 2]>]) -> Vec<[f64; 2]> {
    let mitre = |k: usize| {
        // what is seen end on has the direction of what it leads to
        let before = normals[..k].iter().rev().find_map(|n| *n);
        let after = normals[k.min(normals.len())..].iter().find_map(|n| *n);
        let (a, b) = (before.or(after)?, after.or(before)?);
        let dot = a[0] * b[0] + a[1] * b[1];
        let scale = (1.0 + dot).max(2.0 / LONGEST_MITRE.powi(2));
        Some([(a[0] + b[0]) / scale, (a[1] + b[1]) / scale])
    };
    (0..points.len()).map(|k| mitre(k).unwrap_or([0.0, 0.0])).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Up 100 mm, then 200 mm to the right.
    fn corner() -> Outline {
        Outline::new(vec![[0.0, 0.0], [0.0, 100.0], [200.0, 100.0]], &[0.0, 100.0, 300.0])
    }

    #[test]
    fn a_tube_of_one_width_meets_itself_at_a_sharp_corner() {
        let upright = corner().strip(0.0, 100.0, -10.0, 10.0);
        assert_eq!(upright, [[-10.0, 0.0], [-10.0, 110.0], [10.0, 90.0], [10.0, 0.0]]);
        let across = corner().strip(100.0, 300.0, -10.0, 10.0);
        assert_eq!(across, [[-10.0, 110.0], [200.0, 110.0], [200.0, 90.0], [10.0, 90.0]]);
    }

    #[test]
    fn an_edge_does_not_run_back_behind_its_mitre() {
        let line = Outline::new(
            vec![[0.0, 0.0], [0.0, 95.0], [0.0, 100.0], [4.0, 100.0], [50.0, 100.0]],
            &[0.0, 95.0, 100.0, 104.0, 150.0],
        );
        // the inner corner is at (10, 90): what lies before it along x, or above it, is left out
        let [right, _] = line.edges(100.0, 150.0, -10.0, 10.0);
        assert_eq!(right, [[10.0, 90.0], [50.0, 90.0]]);
        let [right, left] = line.edges(0.0, 100.0, -10.0, 10.0);
        assert_eq!(right, [[10.0, 0.0], [10.0, 90.0]]);
        assert_eq!(left, [[-10.0, 0.0], [-10.0, 95.0], [-10.0, 110.0]]);
    }

    #[test]
    fn a_stretch_begins_between_two_points() {
        let part = corner().strip(150.0, 200.0, 0.0, 5.0);
        assert_eq!(part, [[50.0, 105.0], [100.0, 105.0], [100.0, 100.0], [50.0, 100.0]]);
    }

    #[test]
    fn what_is_seen_end_on_has_a_place_and_no_outline() {
        let above = Outline::new(vec![[0.0, 0.0], [0.0, 0.0], [200.0, 0.0]], &[0.0, 100.0, 300.0]);
        assert_eq!(above.end_on(0.0, 100.0), Some([0.0, 0.0]));
        assert!(above.strip(0.0, 100.0, -10.0, 10.0).is_empty());
        assert_eq!(above.end_on(100.0, 300.0), None);
        assert_eq!((corner().turns(80.0, 120.0), corner().turns(0.0, 80.0)), (Some([0.0, 100.0]), None));
        assert!(above.moved(vec![[0.0, 1.0]]).strip(0.0, 300.0, -1.0, 1.0).is_empty());
        assert!(Outline::new(Vec::new(), &[]).strip(0.0, 1.0, -1.0, 1.0).is_empty());
    }
}
