//! Forecasts against what then happened: simulated campaigns of many kinds, each forecast from its
//! plan alone and then calibrated. The figures of `docs/design.md` are from it:
//!
//! `cargo run --release --example regenerate -- forecast [COUNT]`

use rodcal::calibration::simulate::{Plan, campaign_files, simulate};
use rodcal::calibration::{Campaign, planned_setup};
use rodcal::design::{Budget, Forecast, Forecaster, Where};
use rodcal::parallel::in_parallel;
use rodcal::prelude::*;
use rodcal::statistics::{Random, mean, median, standard_deviation};

/// Errors of a coordinate of each clamp's place, m.
const CLAMPS: [f64; 3] = [0.0, 30e-6, 100e-6];

struct Happened {
    mode: Mode,
    clamps: f64,
    forecast: Forecast,
    /// Mean validation error, m.
    mean: f64,
    /// Validation errors below the forecast 95 %.
    below: f64,
}

pub fn main(arguments: &[String]) -> Result<()> {
    let count = arguments.first().and_then(|text| text.parse().ok()).unwrap_or(200);
    let all: Vec<Happened> =
        in_parallel(count, |seed| campaign(seed as u64)).into_iter().collect::<Result<_>>()?;
    let modes = [Mode::None, Mode::Fea, Mode::Meas];
    said("all", &all.iter().collect::<Vec<_>>());
    for mode in modes {
        said(mode.name(), &all.iter().filter(|one| one.mode == mode).collect::<Vec<_>>());
    }
    for clamps in CLAMPS {
        let name = format!("clamps {} µm", clamps * 1e6);
        said(&name, &all.iter().filter(|one| one.clamps == clamps).collect::<Vec<_>>());
    }
    Ok(())
}

/// What was forecast and what happened, and how one follows the other: as both scatter by a share
/// of themselves, by weights 1/x².
fn said(name: &str, own: &[&Happened]) {
    let um = 1e6;
    let (x, y): (Vec<f64>, Vec<f64>) = own.iter().map(|one| (one.forecast.mean * um, one.mean * um)).unzip();
    let slope = |weights: &[f64]| {
        let total: f64 = weights.iter().sum();
        let weighted = |values: &[f64]| weights.iter().zip(values).map(|(w, v)| w * v).sum::<f64>() / total;
        let (mx, my) = (weighted(&x), weighted(&y));
        let products: Vec<f64> = x.iter().zip(&y).map(|(a, b)| (a - mx) * (b - my)).collect();
        let squares: Vec<f64> = x.iter().map(|a| (a - mx).powi(2)).collect();
        weighted(&products) / weighted(&squares)
    };
    let (plain, by_share) = (vec![1.0; x.len()], x.iter().map(|x| x.powi(-2)).collect::<Vec<_>>());
    let (plain, by_share) = (slope(&plain), slope(&by_share));
    let ratios: Vec<f64> = x.iter().zip(&y).map(|(a, b)| b / a).collect();
    let inside =
        own.iter().filter(|one| (one.forecast.interval[0]..=one.forecast.interval[1]).contains(&one.mean));
    println!(
        "{name:14} n {:3}  forecast {:6.1} happened {:6.1} µm  slope {by_share:.3} (plain {plain:.3})  mean ratio {:.3}, median {:.3}, sd {:.3} (forecast {:.3})  \
         within the interval {:.1} %  below the forecast 95 % {:.1} %",
        own.len(),
        mean(&x).unwrap_or(0.0),
        mean(&y).unwrap_or(0.0),
        mean(&ratios).unwrap_or(0.0),
        median(&ratios).unwrap_or(0.0),
        standard_deviation(&ratios).unwrap_or(0.0),
        mean(
            &own.iter()
                .map(|one| (one.forecast.interval[1] - one.forecast.interval[0]) / 3.92 / one.forecast.mean)
                .collect::<Vec<_>>()
        )
        .unwrap_or(0.0),
        100.0 * inside.count() as f64 / own.len() as f64,
        100.0 * own.iter().map(|one| one.below).sum::<f64>() / own.len() as f64,
    );
}

/// One campaign: rod, number of poses, noises, clamp errors and mode drawn from its seed.
fn campaign(seed: u64) -> Result<Happened> {
    let mut random = Random::seeded(seed, 11);
    let rod_file = ["rods/4.toml", "rods/5.toml", "rods/6.toml"][random.index(3)];
    let mode = [Mode::None, Mode::Fea, Mode::Meas][random.index(3)];
    let text = std::fs::read_to_string(rod_file).map_err(|source| Error::File {
        path: rod_file.into(),
        action: "read",
        source,
    })?;
    let rod = Rod::from_toml("rod.toml", &text)?;
    // the rod as built: every number as far from its file as it is known
    let mut built = rod.clone();
    for nominal in rod.nominal_numbers() {
        built = built.with(&nominal.number, nominal.value + nominal.standard_uncertainty * random.normal());
    }
    let model = Compliance::of_model(&built, &Physics::default(), 20)?;
    let clamps = CLAMPS[random.index(3)];
    let mut plan = Plan::default().with_seed(seed + 1).with_clamp_error(3f64.sqrt() * clamps);
    plan.poses_per_clamp = 6 + random.index(15);
    plan.repeatability = random.uniform(10e-6, 60e-6);
    let (file, text_of_robot) = Robot::builtin("tx90")
        .ok_or(Error::Numerical { what: "the example", why: "the program has no TX90".into() })?;
    let robot = Robot::from_text(file, text_of_robot, None, None)?;
    let simulation = simulate(&robot, &rod, &model, &plan)?;
    let files = campaign_files(&simulation, "builtin:tx90", "rod.toml");
    let open = |name: &str| -> Result<String> {
        let known = files.iter().find(|(known, _)| known == name).map(|(_, text)| text.clone());
        Ok(known.unwrap_or_else(|| text.clone()))
    };
    let own = open("campaign.toml")?;
    let mut campaign = Campaign::from_texts("campaign.toml", &own, &open)?;
    if mode != Mode::Meas {
        campaign.readings = None;
    }
    let noise = (plan.repeatability.powi(2) / 3.0 + plan.sensor_noise.powi(2)).sqrt();
    let budget = Budget::of(&campaign, Some(noise), Some(plan.repeatability), plan.scanner_noise)?;
    let budget = budget.with_clamps(clamps);
    let setup = planned_setup(&campaign)?;
    let poses: Vec<(usize, Vec<f64>)> = (0..campaign.measurements.len())
        .map(|row| (campaign.measurements.rows[row].group, campaign.measurements.joints(row).to_vec()))
        .collect();
    let forecast = Forecaster::new(&campaign, setup, budget, &Where::Validation)?.forecast(&poses, mode)?;
    let found = calibrate(&campaign, mode, &Options::default())?;
    let errors = found.validation.map(|validation| validation.errors).unwrap_or_default();
    let below = errors.iter().filter(|error| **error < forecast.p95).count() as f64;
    Ok(Happened {
        mode,
        clamps,
        mean: errors.iter().sum::<f64>() / errors.len() as f64,
        below: below / errors.len() as f64,
        forecast,
    })
}
