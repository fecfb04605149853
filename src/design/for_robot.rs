//! Which rod for which robot: designs of a front by the accuracy that the robot will have, and
//! whether c_rod says it too.
//!
//! How one order follows another is Spearman's coefficient, the correlation r of the ranks, with
//! the interval tanh(artanh r ± 1.96·√(1.06/(n − 3))) (E. C. Fieller, H. O. Hartley, E. S.
//! Pearson, *Biometrika* 44 (1957) 470–481).

use super::forecast::{Budget, Forecast, Where};
use super::rods_and_modes::{RodForecast, rod_forecast};
use super::study::Study;
use crate::beam::Physics;
use crate::calibration::Mode;
use crate::calibration::campaign::Campaign;
use crate::compliance::paper_contact_force;
use crate::compliance::{Compliance, DEFAULT_ELEMENTS};
use crate::error::Result;
use crate::parallel::in_parallel;
use crate::rod::Rod;

/// Designs that are looked at: of a longer front so many, evenly from end to end.
const MOST: usize = 24;
/// Fewer have no order to speak of.
const FEWEST: usize = 5;
/// Errors that differ by less than this share are equal: they get one rank.
const EQUAL: f64 = 1e-3;

/// A rod with what is to be expected of it.
#[derive(Debug, Clone)]
#[non_exhaustive]
pub struct Ranked {
    /// Its name: `design 3`, or that of the rod to compare with.
    pub name: String,
    /// c_rod, m.
    pub c_rod: f64,
    /// What is to be expected; an error's words where the robot cannot be calibrated with it.
    pub forecast: std::result::Result<RodForecast, String>,
}

impl Ranked {
    /// In one mode.
    pub fn of(&self, mode: Mode) -> Option<&Forecast> {
        self.forecast.as_ref().ok()?.modes.iter().find(|forecast| forecast.mode == mode)
    }
}

/// How the error follows c_rod in one mode.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Proxy {
    /// The mode.
    pub mode: Mode,
    /// Spearman's coefficient.
    pub r: f64,
    /// Its 95 % interval.
    pub interval: [f64; 2],
    /// Least and largest root mean square error, m: what there is to gain.
    pub rms: [f64; 2],
}

/// The designs of a front for one robot: not the best of all rods, for the front is that of other
/// goals.
#[derive(Debug, Clone)]
#[non_exhaustive]
pub struct ForRobot {
    /// Best in mode fea first; what cannot be measured last.
    pub ranked: Vec<Ranked>,
    /// In each mode that all have.
    pub proxies: Vec<Proxy>,
    /// Designs of the front that were ranked, and how many it has.
    pub of_front: [usize; 2],
    /// What the forecast assumes.
    pub budget: Budget,
}

/// Forecasts of the shown designs of a front and of the rod to compare with.
///
/// # Errors
/// What the beam model refuses. A rod that the robot cannot be calibrated with is no error, unless
/// it cannot with any of them: then why it cannot with the first.
pub fn for_robot(
    study: &Study,
    campaign: &Campaign,
    budget: &Budget,
    at: &Where,
    count: Option<usize>,
) -> Result<ForRobot> {
    let shown = study.shown.len();
    let mut places: Vec<usize> = match shown {
        0..=MOST => (0..shown).collect(),
        _ => (0..MOST).map(|k| k * (shown - 1) / (MOST - 1)).collect(),
    };
    places.dedup();
    let mut rods: Vec<&Rod> = places.iter().map(|&k| &study.shown[k].rod).collect();
    rods.extend(study.base.as_ref().map(|base| &base.rod));
    let ranked = in_parallel(rods.len(), |k| {
        let compliance = Compliance::of_model(rods[k], &Physics::default(), DEFAULT_ELEMENTS)?;
        let forecast = rod_forecast(campaign, Some(rods[k]), budget, at, count);
        Ok((rods[k].name.clone(), compliance.index(paper_contact_force()), forecast))
    });
    let ranked: Vec<(String, f64, Result<RodForecast>)> = ranked.into_iter().collect::<Result<_>>()?;
    let is_any = ranked.iter().any(|(_, _, forecast)| forecast.is_ok());
    let mut known = Vec::new();
    for (name, c_rod, forecast) in ranked {
        match forecast {
            Err(error) if !is_any => return Err(error),
            forecast => known.push(Ranked { name, c_rod, forecast: forecast.map_err(|e| e.to_string()) }),
        }
    }
    let mut ranked = known;
    let error = |one: &Ranked, mode: Mode| one.of(mode).map(|forecast| forecast.rms);
    let proxies = Mode::ALL.into_iter().filter_map(|mode| {
        let pairs: Option<Vec<(f64, f64)>> = ranked
            .iter()
            .filter(|one| one.forecast.is_ok())
            .map(|one| Some((one.c_rod, error(one, mode)?)))
            .collect();
        proxy(mode, &pairs?)
    });
    let proxies = proxies.collect();
    ranked.sort_by(|a, b| {
        let rms = |one: &Ranked| error(one, Mode::Fea).unwrap_or(f64::INFINITY);
        rms(a).total_cmp(&rms(b))
    });
    let of_front = [places.len(), study.found.front.len()];
    Ok(ForRobot { ranked, proxies, of_front, budget: budget.clone() })
}

fn proxy(mode: Mode, pairs: &[(f64, f64)]) -> Option<Proxy> {
    if pairs.len() < FEWEST {
        return None;
    }
    let (c_rod, rms): (Vec<f64>, Vec<f64>) = pairs.iter().copied().unzip();
    let (x, y) = (ranks(&c_rod), ranks(&rms));
    let middle = (pairs.len() - 1) as f64 / 2.0;
    let product =
        |a: &[f64], b: &[f64]| -> f64 { a.iter().zip(b).map(|(a, b)| (a - middle) * (b - middle)).sum() };
    let scale = (product(&x, &x) * product(&y, &y)).sqrt();
    let r = if scale > 0.0 { product(&x, &y) / scale } else { 0.0 };
    let half = 1.959964 * (1.06 / (pairs.len() - 3) as f64).sqrt();
    // a perfect order has no end of its interval inside
    let z = r.clamp(-1.0 + 1e-12, 1.0 - 1e-12).atanh();
    let ends = rms.iter().fold([f64::INFINITY, 0.0f64], |[a, b], &x| [a.min(x), b.max(x)]);
    Some(Proxy { mode, r, interval: [(z - half).tanh(), (z + half).tanh()], rms: ends })
}

/// Ranks from 0; equal ones share the mean of theirs.
fn ranks(values: &[f64]) -> Vec<f64> {
    let is_equal = |a: f64, b: f64| (a - b).abs() <= EQUAL * a.abs().max(b.abs());
    let rank = |&own: &f64| {
        let below = values.iter().filter(|&&other| other < own && !is_equal(own, other)).count();
        let equal = values.iter().filter(|&&other| is_equal(own, other)).count();
        below as f64 + (equal - 1) as f64 / 2.0
    };
    values.iter().map(rank).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn orders_are_compared_by_their_ranks() {
        assert_eq!(ranks(&[3.0, 1.0, 3.0, 9.0]), [1.5, 0.0, 1.5, 3.0]);
        let value_at = |y: [f64; 6]| {
            let pairs: Vec<(f64, f64)> = (1..7).map(f64::from).zip(y).collect();
            proxy(Mode::Fea, &pairs).unwrap()
        };
        assert!((value_at([1.0, 4.0, 9.0, 16.0, 25.0, 36.0]).r - 1.0).abs() < 1e-12);
        // 1 − 6·Σd²/(n(n² − 1)) with d = 1, 1, 1, 1, 1, 1
        let swapped = value_at([2.0, 1.0, 4.0, 3.0, 6.0, 5.0]);
        assert!((swapped.r - (1.0 - 36.0 / 210.0)).abs() < 1e-12);
        let half = 1.959964 * (1.06f64 / 3.0).sqrt();
        assert!((swapped.interval[0] - (swapped.r.atanh() - half).tanh()).abs() < 1e-12);
        assert_eq!(value_at([5.0; 6]).r, 0.0);
        assert!(proxy(Mode::Fea, &[(1.0, 2.0); 4]).is_none());
    }
}
