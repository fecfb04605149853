//! All combinations, or a sample of them, on all processors, or in parts on many machines.

#[cfg(test)]
mod tests;

use std::ops::Range;

use super::figure::{Design, Figure, Figures};
use super::front::Front;
use super::limits::{Impossible, Limit};
use super::nearest::Nearest;
use super::space::{Choice, DesignSpace};
use crate::beam::TipSolver;
use crate::error::{Error, Result};
use crate::parallel::in_parallel;
use crate::rod::Rod;
use crate::statistics::Random;

/// Rods of one task, and tasks that are waited for together: memory is that of so many fronts.
const TASK: u64 = 4096;
const TASKS_AT_ONCE: u64 = 64;
/// A part of a search begins and ends at multiples of so many rods.
pub const PART: u64 = TASK;
/// Most designs of a front: beyond, too many goals pull in too many directions to choose from.
const MOST_DESIGNS: usize = 200_000;
/// The stream of random numbers of the first task.
const STREAM: u64 = 15 << 32;

/// Which rods are looked at.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Searched {
    /// Every combination of the design space.
    All,
    /// So many of them (first number), one at random of each of as many equal parts of the space;
    /// random numbers from a seed (second number).
    Samples(u64, u64),
}

/// What a search found.
#[derive(Debug, Clone)]
#[non_exhaustive]
pub struct Found {
    /// Rods that were looked at.
    pub evaluated: u64,
    /// Those that keep all limits.
    pub feasible: u64,
    /// The front, best in the first goal first. All figures but the price are known of each.
    pub front: Vec<Design>,
    /// For each limit of the space the number of rods that break it. A rod counts for every limit
    /// that it breaks; its frequency is looked at only where it keeps all others.
    pub broken: Vec<u64>,
    /// Combinations that are no rods, in the order of [`Impossible::ALL`].
    pub impossible: [u64; Impossible::COUNT],
    /// What comes nearest, where nothing keeps all limits.
    pub nearest: Option<Nearest>,
}

/// What a task adds up.
pub(super) struct Sum {
    pub front: Front,
    pub feasible: u64,
    pub broken: Vec<u64>,
    pub impossible: [u64; Impossible::COUNT],
    pub nearest: Nearest,
}

/// Looks at the rods of `space` and keeps those that nobody betters. `progress` is called with how
/// many more were looked at. The result does not depend on the number of threads.
///
/// ```
/// use rodcal::design::{DesignSpace, Figure, Searched, search};
///
/// let space = DesignSpace::from_toml("design.toml", "
///     [geometry]
///     l1_mm = 150
///     l2_mm = [400, 525]
///     [catalogue]
///     file = \"builtin\"
///     [objectives]
///     maximise = [\"reach_mm\"]
/// ", &|_| unreachable!())?;
/// let found = search(&space, Searched::All, &|_| {})?;
/// assert_eq!(found.evaluated, 2 * space.tubes.len() as u64);
/// let reach = found.front[0].figures.get(Figure::Reach).unwrap_or(0.0); // mm, as its key says
/// assert!((reach - 150f64.hypot(525.0)).abs() < 1e-9, "{reach}");
/// # Ok::<(), rodcal::Error>(())
/// ```
///
/// # Errors
/// As [`Search::new`] and [`Search::go_on`].
pub fn search(space: &DesignSpace, searched: Searched, progress: &(dyn Fn(u64) + Sync)) -> Result<Found> {
    let mut search = Search::new(space, searched)?;
    while !search.is_done() {
        search.go_on(progress)?;
    }
    search.found()
}

/// A search on its way, block by block: it may stop between two of them, be kept as text
/// ([`Search::to_text`]) and go on later. Where it stops changes nothing.
///
/// It may be done in parts too ([`Search::part`]), by others, and put together
/// ([`Search::take_in`]): the front of the parts' fronts is the front, and all counts are sums of
/// theirs.
pub struct Search<'s> {
    pub(super) space: &'s DesignSpace,
    pub(super) searched: Searched,
    /// Rods that the whole search looks at, and those of them that this one does.
    count: u64,
    pub(super) part: Range<u64>,
    pub(super) done: u64,
    pub(super) total: Sum,
}

impl<'s> Search<'s> {
    /// Before any rod.
    ///
    /// # Errors
    /// [`DesignSpace::too_much`] for all of too many rods; [`Error::Argument`] for more than
    /// [`MOST_RODS`](super::MOST_RODS) samples, or none.
    pub fn new(space: &'s DesignSpace, searched: Searched) -> Result<Search<'s>> {
        let all = space.combinations();
        let count = match searched {
            Searched::Samples(samples, _) => samples.min(all),
            Searched::All => all,
        };
        if count == 0 {
            return Err(Error::Argument {
                name: "samples",
                found: "0".into(),
                expected: "at least one rod to look at".into(),
            });
        }
        if count > super::MOST_RODS {
            let too_many_samples = || Error::Argument {
                name: "samples",
                found: count.to_string(),
                expected: format!("at most {} rods", super::MOST_RODS),
            };
            let much = space.too_much().filter(|_| searched == Searched::All);
            return Err(much.unwrap_or_else(too_many_samples));
        }
        Ok(Search { space, searched, count, part: 0..count, done: 0, total: Sum::new(space) })
    }

    /// Before any rod of a part of the search: of those from `part.start` to below `part.end` in
    /// the order in which the whole search looks at its [`Search::count`] rods.
    ///
    /// # Errors
    /// As [`Search::new`]; [`Error::Argument`] for a part that begins or ends within what is looked
    /// at together ([`PART`]), or that is none of the search.
    pub fn part(space: &'s DesignSpace, searched: Searched, part: Range<u64>) -> Result<Search<'s>> {
        let whole = Search::new(space, searched)?;
        let is_bound = |at: u64| at.is_multiple_of(PART) || at == whole.count;
        if part.is_empty() || part.end > whole.count || !is_bound(part.start) || !is_bound(part.end) {
            return Err(Error::Argument {
                name: "part",
                found: format!("rods {} to {}", part.start, part.end),
                expected: format!("multiples of {PART}, and {} at most", whole.count),
            });
        }
        Ok(Search { done: part.start, part, ..whole })
    }

    /// Takes in what another search found, of the rods that come next.
    ///
    /// # Errors
    /// [`Error::Argument`] for one that is not done, or not of the rods that come next, or of
    /// another search; for a front of more than 200 000 designs.
    pub fn take_in(&mut self, next: Search<'_>) -> Result<()> {
        let is_same = next.searched == self.searched && next.space.content == self.space.content;
        if !is_same || !next.is_done() || next.part.start != self.done || next.part.end > self.part.end {
            return Err(Error::Argument {
                name: "part",
                found: format!("rods {} to {} of {}", next.part.start, next.done, next.space.file),
                expected: format!("all rods of a part of {} that begins at {}", self.space.file, self.done),
            });
        }
        self.total.merge(next.total);
        self.done = next.done;
        self.check_front()
    }

    /// Rods to look at in all.
    pub fn count(&self) -> u64 {
        self.count
    }

    /// Rods that were looked at.
    pub fn done(&self) -> u64 {
        self.done
    }

    /// True where nothing is left to look at.
    pub fn is_done(&self) -> bool {
        self.done == self.part.end
    }

    /// Looks at the next block of rods.
    ///
    /// # Errors
    /// [`Error::Argument`] for a front of more than 200 000 designs; what the beam model refuses.
    pub fn go_on(&mut self, progress: &(dyn Fn(u64) + Sync)) -> Result<()> {
        let (space, all, count, done) = (self.space, self.space.combinations(), self.count, self.done);
        let seed = match self.searched {
            Searched::Samples(samples, seed) if samples < all => Some(seed),
            _ => None,
        };
        let end = self.part.end.min(done + TASK * TASKS_AT_ONCE);
        let tasks = (end - done).div_ceil(TASK);
        let sums = in_parallel(tasks as usize, |task| {
            let from = done + task as u64 * TASK;
            let to = end.min(from + TASK);
            let mut random = seed.map(|seed| Random::seeded(seed, STREAM + from / TASK));
            let numbers = (from..to).map(|k| match &mut random {
                // one of the k-th of `count` equal parts
                Some(random) => {
                    let at = (k as f64 + random.uniform(0.0, 1.0)) / count as f64 * all as f64;
                    (at as u64).min(all - 1)
                }
                None => k,
            });
            let sum = Task::new(space).run(numbers);
            progress(to - from);
            sum
        });
        for sum in sums {
            self.total.merge(sum?);
        }
        self.done = end;
        self.check_front()
    }

    fn check_front(&self) -> Result<()> {
        if self.total.front.len() > MOST_DESIGNS {
            return Err(Error::Argument {
                name: "objectives",
                found: format!("a front of more than {MOST_DESIGNS} designs"),
                expected: "fewer goals, or some of them as limits".into(),
            });
        }
        Ok(())
    }

    /// What was found so far.
    ///
    /// # Errors
    /// What the beam model refuses.
    pub fn found(self) -> Result<Found> {
        let (space, total) = (self.space, self.total);
        let designs = total.front.sorted();
        let whole = in_parallel(designs.len(), |k| {
            let design = designs[k];
            match (design.figures.get(Figure::FirstFrequency), space.rod(design.index)) {
                (None, Ok(rod)) => Ok(Design { figures: design.figures.with_frequency(&rod)?, ..design }),
                _ => Ok(design),
            }
        });
        Ok(Found {
            evaluated: self.done - self.part.start,
            feasible: total.feasible,
            front: whole.into_iter().collect::<Result<_>>()?,
            broken: total.broken,
            impossible: total.impossible,
            nearest: (total.feasible == 0).then_some(total.nearest),
        })
    }
}

/// What a task reuses from rod to rod.
struct Task<'s> {
    space: &'s DesignSpace,
    solver: TipSolver,
    rod: Option<(Rod, Choice)>,
    is_frequency_a_goal: bool,
}

impl<'s> Task<'s> {
    fn new(space: &'s DesignSpace) -> Self {
        let is_frequency_a_goal = space.goals.iter().any(|goal| goal.figure == Figure::FirstFrequency);
        Task { space, solver: TipSolver::default(), rod: None, is_frequency_a_goal }
    }

    fn run(&mut self, numbers: impl Iterator<Item = u64>) -> Result<Sum> {
        let mut sum = Sum::new(self.space);
        for index in numbers {
            self.look_at(index, &mut sum)?;
        }
        Ok(sum)
    }

    fn look_at(&mut self, index: u64, sum: &mut Sum) -> Result<()> {
        let (space, choice) = (self.space, self.space.choice(index));
        let built = || {
            let [first, second] = choice.tubes.map(|tube| space.tubes[tube].pipe.clone());
            let mut rod = Rod::new("", choice.l1, choice.l2, first).with_pipe2(second);
            space.furnish(&mut rod, &choice);
            rod
        };
        let is_of_same_parts =
            |known: &Choice| known.tubes == choice.tubes && known.sleeves == choice.sleeves;
        let known = self.rod.take().filter(|(_, known)| is_of_same_parts(known));
        let mut rod = known.map_or_else(built, |(rod, _)| rod);
        space.shape(&choice, &mut rod);
        let judged = match space.possible(&rod) {
            Ok(()) => self.judge(index, &rod, sum),
            Err(why) => {
                sum.impossible[why as usize] += 1;
                Ok(())
            }
        };
        self.rod = Some((rod, choice));
        judged
    }

    fn judge(&mut self, index: u64, rod: &Rod, sum: &mut Sum) -> Result<()> {
        let mut figures = Figures::of(rod, &mut self.solver);
        if self.space.goals.iter().any(|goal| goal.figure == Figure::Price) {
            figures.set(Figure::Price, self.space.price(&self.space.choice(index)));
        }
        let limits = &self.space.limits;
        let of_tip = |limit: &&Limit| limit.figure != Figure::FirstFrequency;
        let broken_of = |figures: &Figures, is_asked: &dyn Fn(&&Limit) -> bool| -> Vec<&Limit> {
            limits.iter().filter(is_asked).filter(|limit| !limit.is_kept(figures)).collect()
        };
        let mut broken = broken_of(&figures, &of_tip);
        let swing = limits.iter().find(|limit| !of_tip(limit));
        let mut is_known = swing.is_none();
        let is_near = swing.is_some() && sum.feasible == 0;
        let mut is_asked = broken.is_empty() && self.is_frequency_a_goal;
        // the frequency costs more than all else: where an estimate will do, that is taken
        if let Some(limit) = swing.filter(|_| broken.is_empty() || is_near) {
            let rough = self.solver.frequency(rod);
            let with = |share: f64| figures.with(Figure::FirstFrequency, rough * (1.0 + share));
            let [low, high] = [with(-TipSolver::FREQUENCY_SHARE), with(TipSolver::FREQUENCY_SHARE)];
            let is_kept = limit.is_kept(&low);
            let is_broken = !limit.is_kept(&high);
            let is_nearer = || {
                let broken = broken_of(&high, &|_| true);
                broken.is_empty() || sum.nearest.would_take(&broken, &high)
            };
            is_asked = match (broken.is_empty(), is_kept, is_broken) {
                (true, true, _) => self.is_frequency_a_goal,
                (true, false, false) => true,
                _ => is_near && is_nearer(),
            };
            if is_broken && !is_asked {
                broken.push(limit);
            }
        }
        if is_asked {
            figures = figures.with_frequency(rod)?;
            is_known = true;
            broken.extend(swing.filter(|limit| !limit.is_kept(&figures)));
        }
        let design = Design { index, figures };
        if broken.is_empty() {
            sum.feasible += 1;
            sum.front.offer(design);
            return Ok(());
        }
        for (limit, count) in limits.iter().zip(&mut sum.broken) {
            let is_counted = of_tip(&limit) || broken.len() == 1;
            *count += u64::from(is_counted && broken.iter().any(|one| one.key == limit.key));
        }
        if sum.feasible == 0 && is_known {
            sum.nearest.offer(design, &broken);
        }
        Ok(())
    }
}

impl Sum {
    fn new(space: &DesignSpace) -> Sum {
        Sum {
            front: Front::new(&space.goals),
            feasible: 0,
            broken: vec![0; space.limits.len()],
            impossible: [0; Impossible::COUNT],
            nearest: Nearest::default(),
        }
    }

    fn merge(&mut self, other: Sum) {
        self.front.merge(other.front);
        self.feasible += other.feasible;
        self.broken.iter_mut().zip(other.broken).for_each(|(all, more)| *all += more);
        self.impossible.iter_mut().zip(other.impossible).for_each(|(all, more)| *all += more);
        self.nearest.merge(other.nearest);
    }
}
