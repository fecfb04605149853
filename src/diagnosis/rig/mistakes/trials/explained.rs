//! What is written otherwise in some trials than in the others.

use super::right::{Right, acts_on};
use super::table::{Cell, MOST_CLASSES, Table};
use crate::diagnosis::rig::effects::mistakes::SIGN_MISTAKE;
use crate::diagnosis::rig::mistakes::part::Part;
use crate::diagnosis::rig::mistakes::possible::PossibleMistake;
use crate::diagnosis::rig::mistakes::relabelling::Relabelling;
use crate::diagnosis::rig::mistakes::search::{ALIKE as NO_WORSE, ODDS, RARE};
use crate::rig::readings::LoadColumn;

/// Share of the squares of the deflections that a change must find, and that it may leave.
pub(super) const OFF: f64 = 0.05;
const LEFT: f64 = 0.02;

/// A mistake in the rows of some trials.
pub(in crate::diagnosis::rig::mistakes) struct InTrials {
    pub part: Part,
    /// What undoes it; `None` where nobody knows, so that these rows are left out.
    pub relabelling: Option<Relabelling>,
}

impl Table<'_> {
    /// What is written otherwise in some trials than in the others, by one of these `mistakes` or
    /// by a ratio that is no unit's.
    pub fn found(&self, mistakes: &[PossibleMistake], unit: LoadColumn) -> Vec<InTrials> {
        let classes = &self.classes;
        if classes.len() < 2 || classes.len() > MOST_CLASSES {
            return Vec::new();
        }
        let count = |class: &[usize]| self.trial.iter().filter(|trial| class.contains(trial)).count();
        // of those that are as large, the first
        let largest = |some: &mut dyn Iterator<Item = usize>| {
            some.fold(None, |best: Option<usize>, class| match best {
                Some(best) if count(&classes[best]) >= count(&classes[class]) => Some(best),
                _ => Some(class),
            })
        };
        let is_confirmed =
            |class: &usize| self.by_rod.is_some_and(|rod| self.is_confirmed(&classes[*class], rod));
        let confirmed = largest(&mut (0..classes.len()).filter(is_confirmed));
        let Some(right) = confirmed.or_else(|| largest(&mut (0..classes.len()))) else { return Vec::new() };
        let shown = self.lines_of(&classes[right]);
        let reference = if confirmed.is_some() { self.completed(&shown) } else { shown.clone() };
        let others = classes.iter().enumerate().filter(|(class, _)| *class != right);
        let explained = |class: &[usize]| {
            let known = self.explained(class, &reference, &shown, mistakes);
            known.or_else(|| self.ratio(class, &shown, unit))
        };
        others.filter_map(|(_, class)| explained(class)).collect()
    }

    /// What some trials hold instead, where one change brings them back to the others: those that
    /// are `right`, of which the recording itself has `shown` some.
    fn explained<'m>(
        &self,
        class: &[usize],
        right: &[Option<Right>],
        shown: &[Option<Right>],
        mistakes: &'m [PossibleMistake],
    ) -> Option<InTrials> {
        let tried = |one: &'m PossibleMistake| {
            let of_trials = |some: &[usize], relabelling: &Relabelling| {
                self.compared(some, right, relabelling, |line| acts_on(&one.relabelling, line))
            };
            let both = |some: &[usize]| {
                of_trials(some, &Relabelling::default()).zip(of_trials(some, &one.relabelling))
            };
            // a trial that has no line in common with the others of its class may be right
            let is_better =
                |trial: &usize| both(&[*trial]).is_some_and(|(before, after)| after.left < before.left);
            let class: Vec<usize> = class.iter().copied().filter(is_better).collect();
            let (before, after) = both(&class)?;
            let odds = RARE + one.log_prior + 0.5 * (before.misfit - after.misfit);
            Some(Tried { mistake: one, class, odds, before: before.left, left: after.left })
        };
        let mut tried: Vec<Tried> = mistakes.iter().filter_map(tried).collect();
        tried.sort_by(|a, b| b.odds.total_cmp(&a.odds));
        let Tried { mistake: best, class, odds, before, left } = tried.first()?;
        // signs of single lines are looked at reading by reading where others show the line
        let is_shown = |k: usize| {
            let is_in_class = class.iter().any(|&trial| self.cells[trial][k].is_some());
            is_in_class && shown[k].is_some() && acts_on(&best.relabelling, &self.lines[k])
        };
        let is_of_a_line = best.effect == &SIGN_MISTAKE
            && best.relabelling.reading != [[-1.0; 3]; 3]
            && (0..self.lines.len()).any(is_shown);
        if *before < OFF || *left > LEFT || *odds < ODDS || is_of_a_line {
            return None;
        }
        let place = self.place(class);
        let near = tried.iter().skip(1).take_while(|other| other.odds > odds - NO_WORSE);
        let here = |mistake: &PossibleMistake| mistake.location.clone().rows(&place);
        let rivals = near.map(|other| (other.mistake.effect, here(other.mistake)));
        let data: Vec<usize> = (0..self.data.len()).filter(|&i| class.contains(&self.trial[i])).collect();
        let most = class.iter().flat_map(|&trial| self.cells[trial].iter().flatten());
        let location = here(best);
        let part = Part {
            effect: best.effect,
            estimates: best.estimates.clone(),
            observed: format!("In {place}, {}", best.observed_in_some_rows()),
            looks_like: format!("in {place}, {}", best.looks_like),
            explains: most.map(Cell::size).fold(0.0, f64::max),
            rivals: rivals.filter(|(_, at)| *at != location).collect(),
            location,
            data,
        };
        Some(InTrials { part, relabelling: Some(best.relabelling.clone()) })
    }
}

/// A mistake in those trials of a class that it brings nearer to what is right.
struct Tried<'a> {
    mistake: &'a PossibleMistake,
    class: Vec<usize>,
    /// Ln of its odds against none.
    odds: f64,
    /// Shares of the squares of the deflections that are left without it and with it.
    before: f64,
    left: f64,
}
