//! The Pareto front: designs that no other design betters in one goal without losing in another.
//! Ties are kept.

use super::figure::{Figures, Goal};

/// A combination and its figures.
#[derive(Debug, Clone, Copy, PartialEq)]
#[non_exhaustive]
pub struct Design {
    /// Its number among all combinations.
    pub index: u64,
    /// Its figures.
    pub figures: Figures,
}

/// Designs that nobody betters so far.
#[derive(Debug, Clone)]
pub struct Front {
    goals: Vec<Goal>,
    /// In no particular order while designs come in.
    designs: Vec<Design>,
}

impl Front {
    /// An empty front for these goals.
    pub fn new(goals: &[Goal]) -> Front {
        Front { goals: goals.to_vec(), designs: Vec::new() }
    }

    /// A front of designs none of which betters another.
    pub(super) fn known(goals: &[Goal], designs: Vec<Design>) -> Front {
        Front { goals: goals.to_vec(), designs }
    }

    /// Takes `design` in, unless one that is known betters it, and puts out those that it betters.
    ///
    /// A design betters another that is as good as it in every goal and better in one.
    pub fn offer(&mut self, design: Design) {
        let goals = &self.goals;
        if goals.iter().any(|goal| goal.cost(&design.figures).is_nan()) {
            return;
        }
        let beats = |a: &Design, b: &Design| {
            let mut is_better = false;
            for goal in goals {
                let (own, other) = (goal.cost(&a.figures), goal.cost(&b.figures));
                if own > other {
                    return false;
                }
                is_better |= own < other;
            }
            is_better
        };
        if let Some(better) = self.designs.iter().position(|known| beats(known, &design)) {
            // who bettered one design is likely to better the next
            self.designs.swap(0, better);
            return;
        }
        self.designs.retain(|known| !beats(&design, known));
        self.designs.push(design);
    }

    /// Takes in all designs of another front.
    pub fn merge(&mut self, other: Front) {
        other.designs.into_iter().for_each(|design| self.offer(design));
    }

    /// The designs, best in the first goal first, then in the second and so on, then by number.
    pub fn sorted(&self) -> Vec<Design> {
        let mut designs = self.designs.clone();
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
        self.designs.is_empty()
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

    #[test]
    fn equal_designs_are_both_kept_and_what_has_no_figure_is_not() {
        let mut front = Front::new(&goals());
        for design in [design(0, 1.0, 1.0), design(1, 1.0, 1.0), design(2, f64::NAN, 2.0)] {
            front.offer(design);
        }
        assert_eq!(front.sorted().iter().map(|design| design.index).collect::<Vec<_>>(), [0, 1]);
    }
}
