//! A search with everything that is to be said of its front.

use super::figure::{Figure, Figures, Goal};
use super::front::Design;
use super::intervals::{Intervals, indistinguishable};
use super::search::{Found, Searched, search};
use super::wish::Wish;
use crate::beam::TipSolver;
use crate::error::Result;
use crate::parallel::in_parallel;
use crate::rod::Rod;

/// Designs of a front whose intervals are looked at: of a longer one so many, evenly from end to end.
const MOST_SHOWN: usize = 48;

/// The designs of a front that are shown, and a rod to compare them with.
#[derive(Debug, Clone)]
#[non_exhaustive]
pub struct Study {
    /// What was asked for.
    pub wish: Wish,
    /// What was found.
    pub found: Found,
    /// The designs that are shown, best in the first goal first.
    pub shown: Vec<Shown>,
    /// The rod that others are to better.
    pub base: Option<Base>,
}

/// A design that is shown.
#[derive(Debug, Clone)]
#[non_exhaustive]
pub struct Shown {
    /// Its place on the front, from 0.
    pub place: usize,
    /// Its number and figures.
    pub design: Design,
    /// The rod.
    pub rod: Rod,
    /// Names of its tubes, one where they are the same.
    pub tubes: Vec<String>,
    /// How well its figures are known.
    pub intervals: Intervals,
    /// Places on the front of shown designs that cannot be distinguished from it.
    pub indistinguishable: Vec<usize>,
}

/// The rod that others are to better.
#[derive(Debug, Clone)]
#[non_exhaustive]
pub struct Base {
    /// The rod.
    pub rod: Rod,
    /// Its figures, without a price.
    pub figures: Figures,
    /// Designs of the front that are as good in every goal and better in one; nobody, where a goal is the price.
    pub bettered_by: usize,
    /// Limits that it breaks.
    pub broken: Vec<&'static str>,
}

impl Study {
    /// Searches, and looks closer at the front.
    ///
    /// # Errors
    /// As [`search`]; what the beam model refuses of `base`.
    pub fn new(
        wish: Wish,
        searched: Searched,
        base: Option<Rod>,
        progress: &(dyn Fn(u64) + Sync),
    ) -> Result<Study> {
        let found = search(&wish, searched, progress)?;
        let last = found.front.len().saturating_sub(1);
        let places: Vec<usize> = match found.front.len() {
            count if count <= MOST_SHOWN => (0..count).collect(),
            _ => (0..MOST_SHOWN).map(|k| k * last / (MOST_SHOWN - 1)).collect(),
        };
        let designs: Vec<Design> = places.iter().map(|&place| found.front[place]).collect();
        let intervals = in_parallel(designs.len(), |k| Intervals::of(&wish, &designs[k]));
        let intervals: Vec<Intervals> = intervals.into_iter().collect::<Result<_>>()?;
        let same = indistinguishable(&designs, &intervals, &wish.goals);
        let shown = places.iter().zip(&designs).zip(intervals).zip(same);
        let shown = shown.filter_map(|(((&place, design), intervals), same)| {
            let rod = wish.rod(design.index).ok()?;
            let tubes = wish.tubes_of(design.index);
            let indistinguishable = same.into_iter().map(|k| places[k]).collect();
            let name = format!("design {}", place + 1);
            Some(Shown {
                place,
                design: *design,
                rod: Rod { name, ..rod },
                tubes,
                intervals,
                indistinguishable,
            })
        });
        let shown = shown.collect();
        let base = base.map(|rod| Base::new(rod, &wish, &found)).transpose()?;
        Ok(Study { wish, found, shown, base })
    }

    /// The first goal, and the second where there is one.
    pub fn axes(&self) -> (Goal, Option<Goal>) {
        (self.wish.goals[0], self.wish.goals.get(1).copied())
    }
}

impl Base {
    fn new(rod: Rod, wish: &Wish, found: &Found) -> Result<Base> {
        let figures = Figures::of(&rod, &mut TipSolver::default())?.with_frequency(&rod)?;
        let betters = |design: &&Design| {
            let costs = |goal: &Goal| (goal.cost(&design.figures), goal.cost(&figures));
            wish.goals.iter().all(|goal| costs(goal).0 <= costs(goal).1)
                && wish.goals.iter().any(|goal| costs(goal).0 < costs(goal).1)
        };
        let bettered_by = found.front.iter().filter(betters).count();
        let is_known = |figure: Figure| figures.get(figure).is_some();
        let broken = wish.limits.iter().filter(|limit| is_known(limit.figure) && !limit.is_kept(&figures));
        Ok(Base { bettered_by, broken: broken.map(|limit| limit.key).collect(), rod, figures })
    }
}
