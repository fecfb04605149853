//! All laws at all sites, each by its evidence, and the smooth curves that they compete with.

use nalgebra::DMatrix;
use std::f64::consts::PI;

use super::choice::Choice;
use super::looked::{FAR, Looked, MISSED, SAME, at_point};
use super::peak::Peak;
use super::posterior::Posterior;
use super::remainder::Remainder;
use super::site::Site;
use crate::inference::score::priors::{APART, PRIOR};
use crate::parallel::in_parallel;

/// Columns of a smooth curve.
const CURVE: usize = 6;
/// Laws whose evidence at the best point is so far (ln) behind the best need no closer look.
const BEHIND: f64 = 12.0;
/// Values of the number that is not linear, at most, that are tried with the variable as it is with
/// each.
const MOST_TRIED: usize = 6;
/// Of so many laws, the likeliest, all else is fitted anew.
const REFITTED: usize = 16;

/// A law with what data say of it.
#[derive(Debug, Clone)]
pub(super) struct Scanned {
    pub choice: Choice,
    pub posterior: Posterior,
    /// Coordinate of the number that is not linear where most of its posterior is.
    pub at: f64,
    /// Other coordinates that explain as much, of a variable as it is with the law there.
    pub also: Vec<f64>,
    /// Its numbers together, where it has several.
    pub peak: Option<Peak>,
    /// Ln of its odds against nothing, prior included.
    pub log_odds: f64,
    /// So much less than at its best numbers, which are not known, with its prior.
    pub price: f64,
}

impl Scanned {
    /// Laws that stand for as much of its posterior each.
    pub fn even(&self, count: usize) -> Vec<(Choice, f64)> {
        match &self.peak {
            Some(peak) => peak.even(count).into_iter().map(|point| at_point(self.choice, &point)).collect(),
            None if self.choice.constant().is_some() => {
                self.posterior.even(count).into_iter().map(|u| (self.choice, u)).collect()
            }
            None => vec![(self.choice, self.at)],
        }
    }
}

/// Everything that was tried, the likeliest first.
pub(super) struct Scan {
    pub laws: Vec<Scanned>,
    /// The likeliest smooth curve: number of its site, ln of its odds against nothing.
    pub curve: Option<(usize, f64)>,
}

/// Ln of the prior odds of a law, or of a curve, against nothing, before it is shared among `sites`
/// places and the `fellows` there.
pub(super) fn prior(sites: usize, fellows: usize) -> f64 {
    let unknown = 0.5 * PRIOR.2 / PRIOR.0;
    (unknown / (sites.max(1) * fellows.max(1)) as f64).ln()
}

/// Where a law is likeliest. Of waves that explain the same the slowest has the widest peak in
/// ln f, and so the most of the posterior.
fn middle(choice: Choice, posterior: &Posterior) -> f64 {
    let width = |u: f64| if choice.form.is_wave() { -u } else { 0.0 };
    let peaks = posterior.peaks(APART).into_iter();
    let highest = peaks.max_by(|a, b| (a.1 + width(a.0)).total_cmp(&(b.1 + width(b.0))));
    highest.unwrap_or_else(|| posterior.best()).0
}

/// All laws on a remainder; `size` is how large, about, what is left is.
pub(super) fn scan(remainder: &Remainder, sites: &[Site], size: f64) -> Scan {
    scan_some(remainder, sites, size, |_| true)
}

/// The same where the likeliest law may be a function of what sensors show, or should have shown:
/// that is what is predicted with the law there, for the stiffness that is fitted beside it is
/// another. What was recorded is no stand-in: what the law misses would explain itself by it.
pub(super) fn scan_as_predicted(
    remainder: &Remainder,
    sites: &mut [Site],
    size: f64,
    is_tried: impl Fn(&Choice) -> bool + Sync,
) -> Scan {
    let found = scan_some(remainder, sites, size, &is_tried);
    let Some(best) = found.laws.first() else { return found };
    let site = &sites[best.choice.site];
    let Some(recorded) = site.recorded.as_ref() else { return found };
    // with each of its values the variable is another: each is tried with its own
    let (number, choice) = (best.choice.site, best.choice);
    let as_predicted = |u: f64| -> Vec<f64> {
        let columns = choice.columns(site, u, size).columns;
        let other = remainder.no_displacement(&columns, recorded.with_law);
        let shown = |(by, value): (&Option<(usize, f64)>, &f64)| {
            by.map_or(*value, |(k, sign)| sign * (recorded.data[k] - other[k]))
        };
        recorded.by.iter().zip(&site.values).map(shown).collect()
    };
    let below = FAR.max(MISSED * best.posterior.best().1);
    let tried = best.posterior.highest(MOST_TRIED, (below, APART.ln()));
    let mut each: Vec<(Vec<f64>, Scanned)> = in_parallel(tried.len(), |k| {
        let mut own = sites.to_vec();
        own[number].values = as_predicted(tried[k].0);
        let found = scan_some(remainder, &own, size, |other| other.is(&choice)).laws.into_iter().next()?;
        Some((own.swap_remove(number).values, found))
    })
    .into_iter()
    .flatten()
    .collect();
    each.sort_by(|a, b| b.1.log_odds.total_cmp(&a.1.log_odds));
    let mut each = each.into_iter();
    let Some((values, likeliest)) = each.next() else { return found };
    let is_other = |law: &Scanned| {
        law.log_odds > likeliest.log_odds - APART.ln() && (law.at - likeliest.at).abs() > SAME
    };
    let others = each.map(|(_, law)| law).filter(is_other).map(|law| law.at).collect();
    sites[number].values = values;
    let mut found = scan_some(remainder, sites, size, is_tried);
    if let Some(law) = found.laws.iter_mut().find(|law| law.choice.is(&choice)) {
        law.also = others;
    }
    found
}

/// The likeliest laws and the curve, all else fitted anew with each at its best; the others go.
pub(super) fn refit(found: &mut Scan, remainder: &Remainder, sites: &[Site], size: f64) {
    found.laws.truncate(REFITTED);
    for law in &mut found.laws {
        let columns = law.choice.columns(&sites[law.choice.site], law.at, size).columns;
        law.log_odds += remainder.fit(&columns).gain - remainder.gain(&columns);
    }
    found.laws.sort_by(|a, b| b.log_odds.total_cmp(&a.log_odds));
    if let Some((site, log_odds)) = &mut found.curve {
        let columns = curve(&sites[*site], size);
        *log_odds += remainder.fit(&columns).gain - remainder.gain(&columns);
    }
}

/// The same of some laws, each with the prior that it has among all.
pub(super) fn scan_some(
    remainder: &Remainder,
    sites: &[Site],
    size: f64,
    is_tried: impl Fn(&Choice) -> bool + Sync,
) -> Scan {
    let all: Vec<Vec<Choice>> =
        sites.iter().enumerate().map(|(number, site)| Choice::all(number, site)).collect();
    let places = all.iter().filter(|choices| !choices.is_empty()).count();
    let evidence = |choice: Choice, us: &[f64]| {
        remainder.gains(us.len(), |k| choice.columns(&sites[choice.site], us[k], size).columns)
    };
    let by_site = in_parallel(sites.len(), |number| {
        let choices = &all[number];
        let of_choice = |&choice: &Choice| Looked::at(choice, &sites[number], &evidence);
        let laws: Vec<Looked> = choices.iter().filter(|c| is_tried(c)).map(of_choice).collect();
        let curve =
            (!laws.is_empty()).then(|| remainder.gain(&curve(&sites[number], size)) + prior(places, 1));
        (laws, curve)
    });
    let mut best_curve: Option<(usize, f64)> = None;
    let mut first = Vec::new();
    for (number, (laws, curve)) in by_site.into_iter().enumerate() {
        let even = prior(places, all[number].len());
        let prior = |choice: &Choice| even + (sites[number].share(choice.form) * choice.share()).ln();
        first.extend(laws.into_iter().map(|law| (prior(&law.choice), law)));
        if let Some(curve) = curve.filter(|curve| best_curve.is_none_or(|(_, best)| *curve > best)) {
            best_curve = Some((number, curve));
        }
    }
    // at most so much its odds may be
    let peak = |(prior, law): &(f64, Looked)| {
        let most = law.posterior.best().1;
        let numbers = usize::from(law.choice.constant().is_some()) + law.choice.shape().len();
        most + MISSED * numbers as f64 * most.max(0.0) + prior
    };
    let sure = |(prior, law): &(f64, Looked)| law.posterior.best().1 + prior;
    let highest = first.iter().map(sure).fold(f64::NEG_INFINITY, f64::max);
    // what is less likely than nothing is neither proposed nor a rival of what is
    let closer: Vec<bool> = first.iter().map(|law| peak(law) > (highest - BEHIND).max(0.0)).collect();
    let mut laws = in_parallel(first.len(), |k| {
        let (prior, law) = &first[k];
        let (choice, mut posterior) = (law.choice, law.posterior.clone());
        if closer[k] && choice.has_shape() {
            let (peak, also) = law.peak(&|points| {
                remainder.gains(points.len(), |k| {
                    let (choice, u) = at_point(choice, &points[k]);
                    choice.columns(&sites[choice.site], u, size).columns
                })
            });
            let (choice, at) = at_point(choice, &peak.at);
            let (mean, sd) = peak.moments(0);
            let posterior = Posterior::normal(mean, sd, posterior.ends());
            let log_odds = peak.log_evidence + prior;
            let price = peak.highest - log_odds;
            return Scanned { choice, posterior, at, log_odds, price, also, peak: Some(peak) };
        }
        if closer[k] {
            posterior.refine(&|us| evidence(choice, us));
        }
        let log_odds = posterior.log_evidence() + prior;
        let at = middle(choice, &posterior);
        let price = posterior.best().1 - log_odds;
        Scanned { choice, posterior, at, log_odds, price, also: Vec::new(), peak: None }
    });
    laws.retain(|law| law.log_odds > f64::NEG_INFINITY);
    laws.sort_by(|a, b| b.log_odds.total_cmp(&a.log_odds));
    Scan { laws, curve: best_curve }
}

/// A smooth curve over the variable of a site, Σ a_j·cos(πjx) with a_j ~ 1/(1 + j), for each of its
/// directions.
pub(super) fn curve(site: &Site, size: f64) -> DMatrix<f64> {
    let ((low, high), count) = (site.range(), site.levels().min(CURVE));
    let mut columns = DMatrix::zeros(site.values.len(), site.directions.len() * count);
    for (d, (_, weights)) in site.directions.iter().enumerate() {
        let largest = weights.iter().fold(0.0, |most: f64, w| most.max(w.abs())).max(f64::MIN_POSITIVE);
        for j in 0..count {
            for (i, x) in site.values.iter().enumerate().filter(|(_, x)| x.is_finite()) {
                let wave = (PI * j as f64 * (x - low) / (high - low)).cos();
                columns[(i, d * count + j)] = size / (1 + j) as f64 * weights[i] / largest * wave;
            }
        }
    }
    columns
}
