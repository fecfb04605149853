//! A search with everything that is to be said of its front.

use super::figure::{Design, Figure, Figures};
use super::front::betters;
use super::intervals::{Intervals, indistinguishable};
use super::refine::{Refined, refine, weights};
use super::search::{Found, Searched, search};
use super::space::DesignSpace;
use crate::beam::TipSolver;
use crate::error::{Error, Result};
use crate::parallel::in_parallel;
use crate::rod::{NominalNumber, Rod};

/// Designs of a front that are shown: of a longer one so many, evenly from end to end.
const MOST_SHOWN: usize = 48;
/// The intervals of so many are looked at; of a longer front those of the designs that are shown.
const MOST_KNOWN: usize = 500;

/// The designs of a front that are shown, and a rod to compare them with.
#[derive(Debug, Clone)]
#[non_exhaustive]
pub struct Study {
    /// What was asked for.
    pub space: DesignSpace,
    /// What was found.
    pub found: Found,
    /// The designs that are shown, best in the first goal first.
    pub shown: Vec<Shown>,
    /// How well designs of the front are known: all of them, of a very long front those that are
    /// shown.
    pub known: Vec<KnownDesign>,
    /// The rod that others are to better.
    pub base: Option<Base>,
    /// What became of one design between the grid's values, where that was asked for.
    pub refined: Option<Refined>,
}

/// How well the figures of one design of the front are known.
#[derive(Debug, Clone)]
#[non_exhaustive]
pub struct KnownDesign {
    /// Its place on the front, from 0.
    pub place: usize,
    /// Half widths of the 95 % intervals of its figures, and where they come from.
    pub intervals: Intervals,
    /// Places on the front of designs that cannot be distinguished from it.
    pub indistinguishable: Vec<usize>,
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
    /// Derivatives of its figures by every number of it, per SI unit.
    pub slopes: Vec<(NominalNumber, Figures)>,
    /// How well its figures are known.
    pub intervals: Intervals,
    /// Places on the front of designs that cannot be distinguished from it.
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
    /// Designs of the front that are as good in every goal and better in one; nobody, where a goal
    /// is the price.
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
        space: DesignSpace,
        searched: Searched,
        base: Option<Rod>,
        progress: &(dyn Fn(u64) + Sync),
    ) -> Result<Study> {
        let found = search(&space, searched, progress)?;
        Study::of_found(space, found, base)
    }

    /// Looks closer at what a search found.
    ///
    /// # Errors
    /// What the beam model refuses.
    pub fn of_found(space: DesignSpace, found: Found, base: Option<Rod>) -> Result<Study> {
        let last = found.front.len().saturating_sub(1);
        let places: Vec<usize> = match found.front.len() {
            count if count <= MOST_SHOWN => (0..count).collect(),
            _ => (0..MOST_SHOWN).map(|k| k * last / (MOST_SHOWN - 1)).collect(),
        };
        let of_interest: Vec<usize> = match found.front.len() {
            count if count <= MOST_KNOWN => (0..count).collect(),
            _ => places.clone(),
        };
        let closer = in_parallel(of_interest.len(), |k| {
            let Ok(rod) = space.rod(found.front[of_interest[k]].index) else { return Ok(None) };
            let slopes = Figures::slopes(&rod)?;
            Ok(Some((Intervals::of(&rod, &slopes), rod, slopes)))
        });
        let (mut shown, mut known) = (Vec::new(), Vec::new());
        for (closer, place) in closer.into_iter().zip(of_interest) {
            let Some((intervals, rod, slopes)) = closer? else { continue };
            let design = found.front[place];
            if places.contains(&place) {
                shown.push(Shown {
                    place,
                    design,
                    intervals: intervals.clone(),
                    rod: Rod { name: format!("design {}", place + 1), ..rod },
                    slopes,
                    tubes: space.tubes_of(design.index),
                    indistinguishable: Vec::new(),
                });
            }
            known.push(KnownDesign { place, intervals, indistinguishable: Vec::new() });
        }
        let same = {
            let designs: Vec<Design> = known.iter().map(|known| found.front[known.place]).collect();
            let intervals: Vec<Intervals> = known.iter().map(|known| known.intervals.clone()).collect();
            indistinguishable(&designs, &intervals, &space.goals)
        };
        let all: Vec<usize> = known.iter().map(|known| known.place).collect();
        for (known, same) in known.iter_mut().zip(same) {
            known.indistinguishable = same.into_iter().map(|k| all[k]).collect();
            if let Some(shown) = shown.iter_mut().find(|shown: &&mut Shown| shown.place == known.place) {
                shown.indistinguishable.clone_from(&known.indistinguishable);
            }
        }
        let base = base.map(|rod| Base::new(rod, &space, &found)).transpose()?;
        Ok(Study { space, found, shown, known, base, refined: None })
    }

    /// Refines the design at `place` of the front, from 0, for `goal`: as [`weights`] reads it.
    ///
    /// # Errors
    /// [`Error::Argument`] for a place beyond the front; as [`refine`] and [`weights`].
    pub fn with_refined(mut self, place: usize, goal: Option<&str>) -> Result<Study> {
        let weights = weights(&self.space, goal)?;
        self.refined = refine(&self.space, &self.found.front, place, &weights)?;
        match self.refined {
            Some(_) => Ok(self),
            None => Err(Error::Argument {
                name: "refine",
                found: format!("design {}", place + 1),
                expected: match self.found.front.len() {
                    1 => "design 1: the front has no other".to_owned(),
                    count => format!("one of the {count} designs of the front"),
                },
            }),
        }
    }
}

impl Base {
    fn new(rod: Rod, space: &DesignSpace, found: &Found) -> Result<Base> {
        let figures = Figures::of(&rod, &mut TipSolver::default()).with_frequency(&rod)?;
        let is_better = |design: &&Design| betters(&space.goals, &design.figures, &figures);
        let bettered_by = found.front.iter().filter(is_better).count();
        let is_known = |figure: Figure| figures.get(figure).is_some();
        let broken = space.limits.iter().filter(|limit| is_known(limit.figure) && !limit.is_kept(&figures));
        Ok(Base { bettered_by, broken: broken.map(|limit| limit.key).collect(), rod, figures })
    }
}
