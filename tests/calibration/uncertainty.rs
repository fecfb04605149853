//! Do 95 % intervals hold the truth, is the noise that is reported the noise that there was, and is
//! nothing made of clean data?

use std::sync::LazyLock;

use rodcal::calibration::simulate::{Plan, Simulation};
use rodcal::calibration::{Campaign, Mode, Options, Robust, Warning, calibrate};
use rodcal::parallel::in_parallel;
use rodcal::statistics::student_t_quantile;

use super::simulated::Simulator;

const SEEDS: usize = 40;
/// Coordinates of 70 poses less 32 parameters.
const DOF: f64 = 178.0;

/// What one calibration said, held against the truth.
struct Said {
    /// Intervals that hold it.
    holds: usize,
    intervals: usize,
    /// Estimated noise over the true one.
    noise: f64,
    outliers: usize,
    noises_differ: bool,
}

/// Noise estimated, noise stated, Huber's weights.
static SAID: LazyLock<[Vec<Said>; 3]> = LazyLock::new(|| {
    let simulator = Simulator::new();
    let of_seeds = in_parallel(SEEDS, |seed| {
        let (simulation, mut campaign) = simulator.run(100 + seed as u64);
        let estimated = said(&simulation, &campaign, Robust::None);
        let huber = said(&simulation, &campaign, Robust::Huber);
        campaign.noise = Some(true_noise(&simulation.plan));
        [estimated, said(&simulation, &campaign, Robust::None), huber]
    });
    let mut kinds = [Vec::new(), Vec::new(), Vec::new()];
    for of_seed in of_seeds {
        kinds.iter_mut().zip(of_seed).for_each(|(kind, said)| kind.push(said));
    }
    kinds
});

/// One coordinate's noise: repeatability is told as the length of a vector.
fn true_noise(plan: &Plan) -> f64 {
    (plan.repeatability.powi(2) / 3.0 + plan.sensor_noise.powi(2)).sqrt()
}

fn said(simulation: &Simulation, campaign: &Campaign, robust: Robust) -> Said {
    let found = calibrate(campaign, Mode::Fea, &Options::default().with_robust(robust)).unwrap();
    let seed = simulation.plan.seed;
    assert!(found.is_converged, "seed {seed}: {} {:?}", found.fit.reason, found.passes);
    let width = match campaign.noise {
        Some(_) => 1.959_964,
        None => student_t_quantile(0.975, DOF).unwrap(),
    };
    let identified = found.parameters.iter().filter(|p| p.identifiable);
    // the turn of the base is told from the user's guess, and so is the truth
    let error = |p: &rodcal::calibration::Estimated| (p.value - simulation.truth.get(p.parameter)).abs();
    Said {
        holds: identified.clone().filter(|p| error(p) <= width * p.std_error.unwrap()).count(),
        intervals: identified.count(),
        noise: found.noise.pooled / true_noise(&simulation.plan),
        outliers: found.outliers.len(),
        noises_differ: found.warnings.iter().any(|w| matches!(w, Warning::UnequalNoise { .. })),
    }
}

/// Percentage of the intervals of all seeds that hold the truth.
fn coverage(said: &[Said]) -> f64 {
    let intervals: usize = said.iter().map(|s| s.intervals).sum();
    // nothing hides among the parameters that do not count
    assert!(intervals > 31 * SEEDS, "{intervals}");
    100.0 * said.iter().map(|s| s.holds).sum::<usize>() as f64 / intervals as f64
}

/// Parameters of one seed share their noise: 40 seeds are worth some 400 independent intervals, 95
/// ± 1.1 %.
#[test]
fn intervals_hold_the_truth_19_times_in_20() {
    for (said, kind) in SAID.iter().zip(["estimated", "stated", "huber"]) {
        let coverage = coverage(said);
        assert!((92.5..97.5).contains(&coverage), "noise {kind}: {coverage:.2} %");
    }
}

/// One seed's estimate has a standard deviation of 1/√(2·178) = 5.3 %, the mean of 40 one of 0.8 %;
/// Huber's, from a median, half as much again.
#[test]
fn the_noise_is_what_it_was() {
    let mean = |said: &[Said]| said.iter().map(|s| s.noise).sum::<f64>() / SEEDS as f64;
    let [estimated, stated, huber] = SAID.each_ref().map(|said| mean(said));
    assert!((estimated - 1.0).abs() < 0.02, "{estimated}");
    assert!((stated - 1.0).abs() < 1e-12, "{stated}");
    assert!((huber - 1.0).abs() < 0.03, "{huber}");
}

/// Outliers are those beyond what one clean recording in a hundred has, unequal noises likewise: of
/// 40 seeds more than three, with 1 % each, happen once in a thousand.
#[test]
fn clean_data_are_called_clean() {
    for (said, kind) in SAID.iter().zip(["estimated", "stated", "huber"]) {
        let with_outliers = said.iter().filter(|s| s.outliers > 0).count();
        let unequal = said.iter().filter(|s| s.noises_differ).count();
        assert!(with_outliers <= 3, "noise {kind}: outliers in {with_outliers} of {SEEDS} seeds");
        assert!(unequal <= 3, "noise {kind}: unequal noises in {unequal} of {SEEDS} seeds");
    }
}
