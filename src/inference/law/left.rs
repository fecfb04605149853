//! What is left beside a law: a second one, and both fitted together.

use nalgebra::{DMatrix, DVector};

use super::choice::{Choice, beside_each_other};
use super::described::{Data, Known, alike, described};
use super::folds::hold_out;
use super::pairs::{Numbered, settle};
use super::proposed::{Law, Second};
use super::remainder::Remainder;
use super::scan::{Scan, Scanned, refit, scan_as_predicted};
use super::site::{Measure, Site};
use crate::inference::score::priors::NAMED;
use crate::inference::{Evidence, Location};

/// A law's amplitudes are known to so many times what is left.
const WIDE: f64 = 3.0;
/// So many laws, the likeliest, are tried without each fold.
const TRIED: usize = 64;
/// Times that two laws are fitted, each beside the other.
const ROUNDS: usize = 2;

/// What is left beside a law.
pub(super) enum Left {
    Nothing,
    /// Where, and along which variable, most is left of which no law was made.
    Something(Location, Measure),
    /// The law as it is beside another one, and that.
    Laws(Box<Law>, Box<Second>),
}

/// A law as it was found alone: with those that the data do not distinguish from it, their held-out
/// errors, and the ln odds of the likeliest smooth curve.
pub(super) struct Alone<'a> {
    pub class: &'a [&'a Scanned],
    pub held_out: &'a [f64],
    pub curve: f64,
}

/// All laws are tried once more beside a law, each at its full price. Nothing is left where none is
/// likelier than chance by the odds of a name, or where the search without each fold does not lower
/// the held-out error by as much as a law has to. A second one is proposed as the first one is:
/// it is likelier than every smooth curve, and lowers the held-out error by itself. `sites_with`
/// are all places given what laws add to each datum.
pub(super) fn left_beside(
    known: &Known,
    first: &Alone,
    sites_with: impl Fn(&DVector<f64>) -> Vec<Site>,
) -> Left {
    let Some(law) = first.class.first() else { return Left::Nothing };
    let Data { model, evidence, terms, size, sigma } = known.data;
    let columns = columns(known, law, known.sites);
    let with = with_columns(evidence, &columns);
    let mut beside = sites_with(&known.remainder.fit(&columns).own);
    let remainder = Remainder::new(model, &with, terms, rows(evidence), sigma);
    let mut found = scan_as_predicted(&remainder, &mut beside, size, |_| true);
    let tried: Vec<Choice> = found.laws.iter().take(TRIED).map(|law| law.choice).collect();
    refit(&mut found, &remainder, &beside, size);
    let Some(best) = found.laws.first().filter(|law| law.log_odds > NAMED.ln()) else {
        return Left::Nothing;
    };
    let class = alike(&found, best);
    let choices: Vec<Choice> = class.iter().map(|law| law.choice).collect();
    let data = Data { evidence: &with, ..known.data };
    let Some(folds) = hold_out(&data, &beside, (&choices, &tried)) else { return Left::Nothing };
    if !folds.is_lower(folds.with) {
        return Left::Nothing;
    }
    let site = &beside[best.choice.site];
    let something = Left::Something(site.location.clone(), site.variable.clone());
    let curve = found.curve.map_or(f64::NEG_INFINITY, |(_, odds)| odds);
    if best.log_odds < curve || !folds.is_lower(folds.own[0]) {
        return something;
    }
    let second = Alone { class: &class, held_out: &folds.own, curve };
    let is_enough = |both: &Both| law.log_odds > first.curve || !both.is_more_left(known, &sites_with);
    match together(known, [first, &second], &beside, &sites_with, is_enough) {
        // two that bend little by little over one number are one curve, which neither is
        Some(([one, other], _)) if one.is_of_curve_with(&other) => something,
        Some(([mut one, other], log_odds)) => {
            // together they are so much likelier than the curve that draws both
            one.log_odds.1 = log_odds.max(law.log_odds + other.log_odds.0) - first.curve;
            let (first, law) = (one, other);
            Left::Laws(Box::new(first), Box::new(Second { law, held_out: (folds.without, folds.with) }))
        }
        None => something,
    }
}

/// Ln of what the data are likelier with a curve's columns, where those of a law are free already.
pub(super) fn gain_beside(data: &Data, law: &DMatrix<f64>, curve: &DMatrix<f64>) -> f64 {
    let &Data { model, evidence, terms, sigma, .. } = data;
    let with = with_columns(evidence, &(law * WIDE));
    Remainder::new(model, &with, terms, rows(evidence), sigma).gain(curve)
}

/// Columns of two laws.
struct Both([DMatrix<f64>; 2]);

/// Two laws, each as it is beside the other, and their ln odds against nothing; `None` where they
/// are not `enough`. Beside the other a law may have another form: all are tried once more.
fn together(
    known: &Known,
    alone: [&Alone; 2],
    beside: &[Site],
    sites_with: &dyn Fn(&DVector<f64>) -> Vec<Site>,
    enough: impl Fn(&Both) -> bool,
) -> Option<([Law; 2], f64)> {
    let laws = [*alone[0].class.first()?, *alone[1].class.first()?];
    let mut both = Both([columns(known, laws[0], known.sites), columns(known, laws[1], beside)]);
    let mut tried: [Option<Vec<Choice>>; 2] = [None, None];
    let mut prices = laws.map(|law| law.price);
    let mut numbered: [Option<Numbered>; 2] = [None, None];
    for _ in 0..ROUNDS {
        for free in [0, 1] {
            let (choices, columns, price, own) =
                both.beside(known, free, tried[free].as_deref(), sites_with, |known, found| {
                    let class = steady(found, laws[1 - free])?;
                    let best = class.first()?;
                    let choices = class.iter().map(|law| law.choice).collect();
                    let own = Numbered::new(best, &known.sites[best.choice.site]);
                    Some((choices, columns(known, best, known.sites), best.price, own))
                })?;
            (both.0[free], prices[free], numbered[free]) = (columns, price, own);
            tried[free].get_or_insert(choices);
        }
    }
    // what is alike in both is found by both together
    let mut wider = 1.0;
    if let [Some(a), Some(b)] = &mut numbered {
        let size = WIDE * known.data.size;
        let gains = |sets: &[DMatrix<f64>]| known.remainder.gains(sets.len(), |k| sets[k].clone());
        wider = settle([a, b], &gains, size);
        both = Both([a, b].map(|law| law.columns(0.0, size)));
    }
    if !enough(&both) {
        return None;
    }
    let described = |free: usize| {
        let Alone { class: before, held_out, curve } = *alone[free];
        both.beside(known, free, tried[free].as_deref(), sites_with, |known, found| {
            let class = steady(found, laws[1 - free])?;
            let error = |law: &&Scanned| {
                let number = before.iter().position(|own| own.choice.is(&law.choice))?;
                held_out.get(number).copied()
            };
            let held_out: Vec<Option<f64>> = class.iter().map(error).collect();
            described(known, &class, &held_out, curve)
        })
    };
    let [mut one, mut other] = [described(0)?, described(1)?];
    one.widen(wider);
    other.widen(wider);
    let log_odds = known.remainder.fit(&both.side_by_side()).gain - prices.iter().sum::<f64>();
    (!other.repeats(&one)).then_some(([one, other], log_odds))
}

/// The likeliest law beside another, and those that the data do not distinguish from it. Beside a
/// wave the first of two is one that goes on as it began, where that is among them: whatever is out
/// of step with another wave seems to change.
fn steady<'s>(found: &'s Scan, other: &Scanned) -> Option<Vec<&'s Scanned>> {
    let mut class = alike(found, found.laws.first()?);
    let is_steady = |law: &&Scanned| law.choice.form.is_wave() && !law.choice.has_shape();
    let is_changing = class.first().is_some_and(|law| law.choice.form.is_wave() && law.choice.has_shape());
    let first = class.iter().position(is_steady).filter(|_| is_changing && other.choice.form.is_wave());
    if let Some(first) = first {
        class[..=first].rotate_right(1);
    }
    Some(class)
}

impl Both {
    /// What is found for one of them, of some laws or of all, while the columns of the other are
    /// free.
    fn beside<T>(
        &self,
        known: &Known,
        free: usize,
        tried: Option<&[Choice]>,
        sites_with: &dyn Fn(&DVector<f64>) -> Vec<Site>,
        then: impl FnOnce(&Known, &Scan) -> Option<T>,
    ) -> Option<T> {
        let Data { model, evidence, terms, size, sigma } = known.data;
        let mut sites = sites_with(&self.adds(known)[1 - free]);
        let with = with_columns(evidence, &self.0[1 - free]);
        let remainder = Remainder::new(model, &with, terms, rows(evidence), sigma);
        let is_tried = |choice: &Choice| tried.is_none_or(|tried| tried.iter().any(|own| own.is(choice)));
        let mut found = scan_as_predicted(&remainder, &mut sites, size, is_tried);
        refit(&mut found, &remainder, &sites, size);
        let data = Data { evidence: &with, ..known.data };
        let beside = Known { data, sites: &sites, remainder: &remainder, background: known.background };
        then(&beside, &found)
    }

    fn side_by_side(&self) -> DMatrix<f64> {
        beside_each_other(&self.0[0], &self.0[1])
    }

    /// What each adds to each datum.
    fn adds(&self, known: &Known) -> [DVector<f64>; 2] {
        let [one, other] = &self.0;
        let (count, more) = (one.ncols(), other.ncols());
        let factors = known.remainder.fit(&self.side_by_side()).factors;
        [one * factors.rows(0, count), other * factors.rows(count, more)]
    }

    /// True where beside both another law, or a smooth curve, is likelier than chance by the odds
    /// of a name.
    fn is_more_left(&self, known: &Known, sites_with: &dyn Fn(&DVector<f64>) -> Vec<Site>) -> bool {
        let Data { model, evidence, terms, size, sigma } = known.data;
        let [one, other] = self.adds(known);
        let mut sites = sites_with(&(one + other));
        let with = with_columns(&with_columns(evidence, &self.0[0]), &self.0[1]);
        let remainder = Remainder::new(model, &with, terms, rows(evidence), sigma);
        let found = scan_as_predicted(&remainder, &mut sites, size, |_| true);
        let of_laws = found.laws.first().map_or(f64::NEG_INFINITY, |law| law.log_odds);
        of_laws.max(found.curve.map_or(f64::NEG_INFINITY, |(_, odds)| odds)) > NAMED.ln()
    }
}

/// Columns of a law at its numbers.
fn columns(known: &Known, law: &Scanned, sites: &[Site]) -> DMatrix<f64> {
    law.choice.columns(&sites[law.choice.site], law.at, WIDE * known.data.size).columns
}

fn rows(evidence: &Evidence) -> Vec<usize> {
    (0..evidence.residual.len()).collect()
}

/// An evidence in which columns stand among what else may be there, their amplitudes free.
fn with_columns(evidence: &Evidence, columns: &DMatrix<f64>) -> Evidence {
    Evidence { background: beside_each_other(&evidence.background, columns), ..evidence.clone() }
}
