//! What is left beside a law: a second one.

use nalgebra::{DMatrix, DVector};

use super::choice::Choice;
use super::folds::hold_out;
use super::remainder::Remainder;
use super::scan::{Scanned, scan_as_recorded};
use super::site::{Measure, Site};
use crate::inference::selection::NAMED;
use crate::inference::{Evidence, ForwardModel, Location, Term};

/// A law's amplitudes are known to so many times what is left.
const WIDE: f64 = 3.0;
/// So many laws, the likeliest, are tried without each fold.
const TRIED: usize = 64;

/// A model with what is known of its data: evidence, findings, how large what is left is and the
/// noise.
pub(super) type Data<'a> = (&'a dyn ForwardModel, &'a Evidence, &'a [Term], (f64, f64));

/// Where, and along which variable, most is left beside a law: all laws are tried once more, each
/// at its full price; `None` where none is likelier than chance by the odds of a name, or where the
/// search without each fold does not lower the held-out error by as much as a law has to.
/// `sites_with` are all places given what the law adds to each datum.
pub(super) fn most_left(
    (model, evidence, terms, (size, sigma)): Data,
    sites: &[Site],
    law: &Scanned,
    sites_with: impl Fn(&DVector<f64>) -> Vec<Site>,
) -> Option<(Location, Measure)> {
    let rows = || (0..evidence.residual.len()).collect();
    let columns = law.choice.columns(&sites[law.choice.site], law.at, WIDE * size).columns;
    let own = Remainder::new(model, evidence, terms, rows(), sigma).fit(&columns).own;
    let with = with_columns(evidence, &columns);
    let mut beside = sites_with(&own);
    let remainder = Remainder::new(model, &with, terms, rows(), sigma);
    let scan = scan_as_recorded(&remainder, &mut beside, (size, sigma));
    let second = scan.laws.first().filter(|law| law.log_odds > NAMED.ln())?;
    let tried: Vec<Choice> = scan.laws.iter().take(TRIED).map(|law| law.choice).collect();
    let folds = hold_out(model, &with, terms, &beside, (&[], &tried), (size, sigma))?;
    let site = &beside[second.choice.site];
    folds.is_lower(folds.with).then(|| (site.location.clone(), site.variable.clone()))
}

/// An evidence in which columns stand among what else may be there, their amplitudes free.
fn with_columns(evidence: &Evidence, columns: &DMatrix<f64>) -> Evidence {
    let known = evidence.background.ncols();
    let mut background = DMatrix::zeros(columns.nrows(), known + columns.ncols());
    background.columns_mut(0, known).copy_from(&evidence.background);
    background.columns_mut(known, columns.ncols()).copy_from(columns);
    Evidence { background, ..evidence.clone() }
}
