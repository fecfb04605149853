//! Which rod for which robot: designs of a front by the accuracy that the robot will have, and
//! whether c_rod says it too.

use super::forecast::{Budget, Forecast, Where};
use super::proxy::{Proxy, proxies};
use super::rods_and_modes::{RodForecast, c_rod, rod_forecast};
use super::study::Study;
use crate::calibration::Mode;
use crate::calibration::campaign::Campaign;
use crate::error::Result;
use crate::parallel::in_parallel;
use crate::rod::Rod;

/// Designs that are looked at: of a longer front so many, evenly from end to end.
const MOST: usize = 24;
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
/// ```
/// use rodcal::design::{Budget, DesignSpace, Searched, Study, Where, for_robot};
/// use rodcal::prelude::*;
///
/// let space = DesignSpace::from_toml("design.toml", "
///     [geometry]
///     l1_mm = 150
///     l2_mm = 525
///     [catalogue]
///     file = \"builtin\"
///     [objectives]
///     minimise = [\"c_rod_um\"]
/// ", &|_| unreachable!())?;
/// let study = Study::new(space, Searched::All, None, &|_| {})?;
/// let campaign = Campaign::read("campaigns/tx90-5/campaign.toml".as_ref())?;
/// let budget = Budget::of(&campaign, Some(17.6e-6), Some(30e-6), 0.0)?;
/// let found = for_robot(&study, &campaign, &budget, &Where::Validation, Some(20))?;
/// assert_eq!(found.of_front, [1, 1]);
/// let forecast = found.ranked[0].of(Mode::Fea).expect("the robot reaches the clamps with it");
/// assert!((20e-6..100e-6).contains(&forecast.mean), "{}", forecast.mean);
/// # Ok::<(), rodcal::Error>(())
/// ```
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
        let forecast = rod_forecast(campaign, Some(rods[k]), budget, at, count);
        Ok((rods[k].name.clone(), c_rod(rods[k])?, forecast))
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
    let known =
        ranked.iter().filter_map(|one| Some((one.c_rod, one.forecast.as_ref().ok()?.modes.as_slice())));
    let proxies = proxies(&known.collect::<Vec<_>>());
    ranked.sort_by(|a, b| {
        let rms = |one: &Ranked| error(one, Mode::Fea).unwrap_or(f64::INFINITY);
        rms(a).total_cmp(&rms(b))
    });
    let of_front = [places.len(), study.found.front.len()];
    Ok(ForRobot { ranked, proxies, of_front, budget: budget.clone() })
}
