//! The Pareto front: designs that no other design betters in one goal without losing in another.
//!
//! Ties are kept, also those that rounding hides: two sums of the same lengths differ in their last
//! digits. What is compared are figures to ten digits, for all alike, so that the front is the same
//! in whatever order designs come in.

mod tree;

use self::tree::{Costs, Entry, Tree};
use super::figure::{Design, Figures, Goal};

/// Bits of a number that comparisons leave out: 32 of its 52 stay, which is a share of 2·10⁻¹⁰.
const LEFT_OUT: u32 = 20;

/// Designs that nobody betters so far.
#[derive(Debug, Clone)]
pub struct Front {
    goals: Vec<Goal>,
    designs: Tree,
}

impl Front {
    /// An empty front for these goals.
    pub fn new(goals: &[Goal]) -> Front {
        Front { goals: goals.to_vec(), designs: Tree::leaf(Vec::new()) }
    }

    /// Takes `design` in, unless one that is known betters it, and puts out those that it betters.
    ///
    /// A design betters another that is as good as it in every goal and better in one.
    pub fn offer(&mut self, design: Design) {
        let costs = costs(&self.goals, &design.figures);
        self.take(Entry { costs, design });
    }

    fn take(&mut self, entry: Entry) {
        let costs = &entry.costs;
        if costs.iter().any(|cost| cost.is_nan()) || self.designs.betters(costs) {
            return;
        }
        self.designs.prune(costs);
        self.designs.insert(entry);
    }

    /// Takes in all designs of another front.
    pub fn merge(&mut self, other: Front) {
        other.entries().into_iter().for_each(|entry| self.take(entry));
    }

    /// The designs, best in the first goal first, then in the second and so on, then by number.
    pub fn sorted(&self) -> Vec<Design> {
        let mut designs: Vec<Design> = self.entries().into_iter().map(|entry| entry.design).collect();
        designs.sort_by(|a, b| {
            let order = |goal: &Goal| goal.cost(&a.figures).total_cmp(&goal.cost(&b.figures));
            let by_goals = self.goals.iter().map(order).find(|order| order.is_ne());
            by_goals.unwrap_or_else(|| a.index.cmp(&b.index))
        });
        designs
    }

    /// Number of designs.
    pub fn len(&self) -> usize {
        self.designs.len()
    }

    /// True before any design.
    pub fn is_empty(&self) -> bool {
        self.len() == 0
    }

    fn entries(&self) -> Vec<Entry> {
        let mut entries = Vec::with_capacity(self.len());
        self.designs.collect(&mut entries);
        entries
    }
}

/// Whether figures are as good as others in every goal and better in one, to ten digits.
pub(super) fn betters(goals: &[Goal], figures: &Figures, other: &Figures) -> bool {
    let (own, other) = (costs(goals, figures), costs(goals, other));
    own.iter().zip(&other).all(|(own, other)| own <= other) && own != other
}

fn costs(goals: &[Goal], figures: &Figures) -> Costs {
    let mut costs = Costs::default();
    costs.iter_mut().zip(goals).for_each(|(cost, goal)| *cost = rounded(goal.cost(figures)));
    costs
}

/// The nearest number whose last bits are 0.
fn rounded(cost: f64) -> f64 {
    const ONE: u64 = 1 << LEFT_OUT;
    match cost.is_finite() {
        // the next one carries into the exponent, as it should
        true => f64::from_bits((cost.to_bits() + ONE / 2) & !(ONE - 1)),
        false => cost,
    }
}

#[cfg(test)]
mod tests {
    use super::super::figure::Figure;
    use super::*;
    use crate::statistics::Random;

    fn design(index: u64, c_rod: f64, reach: f64) -> Design {
        let mut figures = Figures([f64::NAN; 8]);
        figures.set(Figure::CRod, c_rod);
        figures.set(Figure::Reach, reach);
        Design { index, figures }
    }

    fn goals() -> [Goal; 2] {
        let goal = |figure, is_maximised| Goal { figure, is_maximised };
        [goal(Figure::CRod, false), goal(Figure::Reach, true)]
    }

    #[test]
    fn the_front_is_that_of_comparing_all_with_all_in_any_order() {
        let mut random = Random::seeded(5, 0);
        // few values, so that there are ties
        let mut all: Vec<Design> = (0..400)
            .map(|k| design(k, random.uniform(0.0, 30.0).round(), random.uniform(0.0, 30.0).round()))
            .collect();
        let pair = |d: &Design| (d.figures.get(Figure::CRod).unwrap(), d.figures.get(Figure::Reach).unwrap());
        let beats = |a: &Design, b: &Design| {
            let ((c, r), (d, s)) = (pair(a), pair(b));
            c <= d && r >= s && (c < d || r > s)
        };
        let mut expected: Vec<u64> =
            all.iter().filter(|a| !all.iter().any(|b| beats(b, a))).map(|a| a.index).collect();
        expected.sort_unstable();
        for _ in 0..3 {
            let mut front = Front::new(&goals());
            all.iter().for_each(|&design| front.offer(design));
            let mut found: Vec<u64> = front.sorted().iter().map(|design| design.index).collect();
            assert!(front.sorted().windows(2).all(|two| pair(&two[0]).0 <= pair(&two[1]).0));
            found.sort_unstable();
            assert_eq!(found, expected);
            all.rotate_left(133);
        }
    }

    /// Many designs, so that the tree branches, and few values of some goals, so that there are
    /// ties.
    #[test]
    fn a_front_of_many_goals_is_that_of_comparing_all_with_all() {
        let figures = [Figure::CRod, Figure::Mass, Figure::Reach, Figure::Moment, Figure::Price];
        let goals: Vec<Goal> =
            figures.map(|figure| Goal { figure, is_maximised: figure == Figure::Reach }).to_vec();
        let mut random = Random::seeded(6, 0);
        for (count, goals) in [(3000, &goals[..2]), (1500, &goals[..3]), (1500, &goals[..])] {
            let mut all: Vec<Design> = (0..count)
                .map(|index| {
                    let mut figures = Figures([f64::NAN; 8]);
                    for (k, goal) in goals.iter().enumerate() {
                        let value = random.uniform(1.0, 40.0);
                        figures.set(goal.figure, if k % 2 == 0 { value } else { value.round() });
                    }
                    Design { index, figures }
                })
                .collect();
            let cost = |design: &Design, goal: &Goal| {
                let value = design.figures.get(goal.figure).unwrap();
                if goal.is_maximised { -value } else { value }
            };
            let is_better = |a: &Design, b: &Design| {
                let both = || goals.iter().map(|goal| (cost(a, goal), cost(b, goal)));
                both().all(|(a, b)| a <= b) && both().any(|(a, b)| a < b)
            };
            let kept = |a: &&Design| !all.iter().any(|b| is_better(b, a));
            let expected: Vec<u64> = all.iter().filter(kept).map(|design| design.index).collect();
            for _ in 0..2 {
                let [mut one, mut other] = [Front::new(goals), Front::new(goals)];
                for (k, &design) in all.iter().enumerate() {
                    if k % 3 == 0 { one.offer(design) } else { other.offer(design) }
                }
                one.merge(other);
                let mut found: Vec<u64> = one.sorted().iter().map(|design| design.index).collect();
                found.sort_unstable();
                assert_eq!((found.len(), &found), (one.len(), &expected));
                all.reverse();
            }
        }
    }

    #[test]
    fn what_differs_by_rounding_alone_is_a_tie() {
        let mut front = Front::new(&goals());
        let (sum, whole) = (0.1 + 0.2, 0.3);
        assert!(sum > whole);
        for (index, c_rod) in [(0, sum), (1, whole), (2, whole * (1.0 + 1e-8)), (3, whole * (1.0 - 1e-15))] {
            front.offer(design(index, c_rod, 700.0));
        }
        let mut found: Vec<u64> = front.sorted().iter().map(|design| design.index).collect();
        found.sort_unstable();
        assert_eq!(found, [0, 1, 3]);
    }

    #[test]
    fn equal_designs_are_both_kept_and_what_has_no_figure_is_not() {
        let mut front = Front::new(&goals());
        for design in [design(0, 1.0, 1.0), design(1, 1.0, 1.0), design(2, f64::NAN, 2.0)] {
            front.offer(design);
        }
        assert_eq!(front.sorted().iter().map(|design| design.index).collect::<Vec<_>>(), [0, 1]);
    }
}
