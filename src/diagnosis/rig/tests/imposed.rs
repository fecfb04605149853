//! Displacements that are set again and again, with the loads that a cell shows.

use super::*;
use crate::statistics::Random;

/// Steps from nothing to the largest displacement, µm, and what cycles there are.
const STEP: f64 = 62.5;
const STEPS: usize = 8;
const CYCLES: usize = 4;
/// Noise of the displacement, µm, and of the load, N.
const NOISE: (f64, f64) = (0.5, 0.01);

/// Cycles along y: what the cell shows of loads (N) that bend the rod as far, which way it moved
/// and when.
fn cycles(seed: u64, shown: impl Fn(&[f64], usize) -> f64) -> RigDiagnosis {
    drifting_cycles(seed, 0.0, shown)
}

/// The same while the zero of the displacement goes on by as many µm, with 600 s.
fn drifting_cycles(seed: u64, drift: f64, shown: impl Fn(&[f64], usize) -> f64) -> RigDiagnosis {
    let (stiffness, mut random) = (1.0 / compliance(&rod(""))[(1, 1)], Random::seeded(seed, 0));
    let places = (0..4 * STEPS * CYCLES).map(|k| {
        let quarter = (k % STEPS) as f64;
        let (there, back) = (quarter, STEPS as f64 - quarter);
        [there, back, -there, -back][k / STEPS % 4] * STEP
    });
    let places: Vec<f64> = places.collect();
    let loads: Vec<f64> = places.iter().map(|u| stiffness * u * UM).collect();
    let mut text = "# driven = \"displacement\"\naxis,load_n,time_s,dy_um\n".to_owned();
    for (k, place) in places.iter().enumerate().skip(1) {
        let load = shown(&loads, k) + NOISE.1 * random.normal();
        let (sign, read) = (if load < 0.0 { "-" } else { "" }, place + NOISE.0 * random.normal());
        let read = read + drift * (1.0 - (-20.0 * k as f64 / 600.0).exp());
        text += &format!("{sign}y,{:.3},{},{read:.1}\n", load.abs(), 20 * k);
    }
    diagnose(&readings(&text), Some(&rod(""))).unwrap()
}

/// Loads that are as they are.
fn as_they_are(loads: &[f64], k: usize) -> f64 {
    loads[k]
}

fn names(found: &RigDiagnosis) -> Vec<&'static str> {
    found.diagnosis.findings.iter().map(|finding| finding.effect.name).collect()
}

#[test]
fn what_the_readings_of_a_setting_scatter_is_no_wave_of_its_steps() {
    for seed in 1..4 {
        let found = cycles(seed, as_they_are);
        assert!(!found.diagnosis.is_mismatch(), "{seed}: {:?}", found.diagnosis.discrepancy);
    }
}

#[test]
fn what_bends_more_stiffly_is_no_wave_either() {
    let found = cycles(4, |loads, k| {
        let largest = loads.iter().fold(0.0, |most: f64, load| most.max(load.abs()));
        loads[k] * (1.0 + 0.02 * (loads[k] / largest).powi(2))
    });
    assert!(names(&found) == ["nonlinear_stiffness"] && found.diagnosis.discrepancy.is_none());
}

/// Friction adds to each change of the load, and a cell that lags keeps a part of it.
#[test]
fn friction_is_not_what_a_load_cell_does_that_lags() {
    let moved = |loads: &[f64], k: usize| loads[k] - loads[k - 1];
    let found = cycles(5, |loads, k| loads[k] + 0.2 * f64::signum(moved(loads, k)));
    assert!(names(&found) == ["friction"] && found.diagnosis.discrepancy.is_none());
    let force = found.diagnosis.findings[0].quantity("force_n").unwrap();
    assert!((force.value - 0.2).abs() < 0.01 && force.high - force.low < 0.02, "{force:?}");
    let found = cycles(6, |loads, k| loads[k] - 0.1 * moved(loads, k));
    assert!(names(&found) == ["sensor_lag"] && found.diagnosis.discrepancy.is_none());
    let share = found.diagnosis.findings[0].quantity("fraction").unwrap();
    assert!((share.value - 0.1).abs() < 0.005 && share.high - share.low < 0.01, "{share:?}");
    let found = cycles(9, |loads, k| loads[k] - 0.15 * f64::signum(moved(loads, k)));
    assert!(names(&found) == ["sensor_lag"] && found.diagnosis.discrepancy.is_none());
    let words = found.model.describe(&found.diagnosis.findings[0]).observed;
    // in even steps either takes as much off each change
    let is_either =
        words.ends_with("or it has a play as large as that") || words.ends_with("or is read too soon");
    assert!(words.starts_with("The load cell ") && is_either, "{words}");
}

/// Of what drifts the load is what is compared: it is the cell, or the zero of the displacement.
#[test]
fn a_load_that_drifts_has_newtons() {
    let found = cycles(7, |loads, k| loads[k] + 0.2 * k as f64 / 180.0);
    let [drift] = &found.diagnosis.findings[..] else { panic!("{:?}", names(&found)) };
    let words = found.model.describe(drift).observed;
    assert!(words.starts_with("The load cell drifts by 0.2") && words.contains("N per hour"), "{words}");
}

/// What readings of a setting are off its mean is noise only where it has nothing in common with
/// what came before.
#[test]
fn a_zero_of_the_display_that_drifts_is_a_drift() {
    let found = drifting_cycles(10, 5.0, as_they_are);
    let [drift] = &found.diagnosis.findings[..] else { panic!("{:?}", names(&found)) };
    let words = found.model.describe(drift).observed;
    assert!(words.contains("or the zero of dy the other way"), "{words}");
    // a number that is none of a reading is said
    let counts_as = |found: RigDiagnosis| found.model.displacements_count_as();
    assert_eq!(counts_as(found), None);
    assert!(counts_as(cycles(1, as_they_are)).is_some_and(|words| words.contains("mean")));
}

/// A rod that relaxes lacks a part of each change until six readings later: one law of two numbers,
/// where hysteresis, a curved stiffness and a drift draw it nearly.
#[test]
fn a_rod_that_relaxes_is_one_law_and_no_names() {
    const TIME: f64 = 120.0;
    for seed in [8, 9, 10, 16, 18] {
        let found = cycles(seed, |loads, k| {
            let still_there = |j: usize| (-20.0 * (k - j) as f64 / TIME).exp() * (loads[j] - loads[j - 1]);
            loads[k] + 0.03 * (1..=k).map(still_there).sum::<f64>()
        });
        assert_eq!(names(&found), Vec::<&str>::new(), "{seed}");
        let law = found.law.as_ref().unwrap().law.as_ref().unwrap();
        assert_eq!(law.memory, crate::inference::law::Memory::Lag);
        let (_, time) = law.constant.as_ref().unwrap();
        assert!(time.low < TIME && TIME < time.high && time.high < 3.0 * TIME, "{seed}: {time:?}");
    }
}

/// A slide that goes to and fro by 600 µm in 120 s, read each second with this noise, µm; loads (N)
/// of what bends the rod, changed from one second to the next by as much.
fn sweep(seed: u64, noise: f64, turns_sharply: bool, shown: impl Fn(f64, f64) -> f64) -> RigDiagnosis {
    let (stiffness, mut random) = (1.0 / compliance(&rod(""))[(1, 1)], Random::seeded(seed, 1));
    let place = |second: i32| {
        let swing = (f64::from(second) * std::f64::consts::TAU / 120.0).sin();
        600.0 * if turns_sharply { swing.asin() / std::f64::consts::FRAC_PI_2 } else { swing }
    };
    let load = |second: i32| stiffness * place(second) * UM;
    let mut text = "# driven = \"displacement\"\naxis,load_n,time_s,dy_um\n".to_owned();
    for k in 0..720 {
        let change = 0.5 * (load(k + 1) - load(k - 1));
        let load = shown(load(k), change) + 0.003 * random.normal();
        let sign = if load < 0.0 { "-" } else { "" };
        text += &format!("{sign}y,{:.4},{k},{:.2}\n", load.abs(), place(k) + noise * random.normal());
    }
    diagnose(&readings(&text), Some(&rod(""))).unwrap()
}

/// A display that scatters more than the load cell: means, lags and waves in time know better than
/// a reading where the slide was, which is no mismatch.
#[test]
fn noise_of_a_sweep_is_no_law() {
    for (seed, noise) in [(1, 0.5), (2, 0.5), (1, 2.0), (2, 2.0)] {
        for turns_sharply in [false, true] {
            let found = sweep(seed, noise, turns_sharply, |load, _| load);
            assert!(!found.diagnosis.is_mismatch(), "{seed} {noise} {turns_sharply}");
        }
    }
}

#[test]
fn a_damper_follows_the_speed() {
    let found = sweep(3, 0.1, false, |load, change| load + 0.2 * change);
    let law = found.law.as_ref().unwrap().law.as_ref().unwrap();
    assert!(law.site.variable.name.contains("speed"), "{:?}", law.site.variable.name);
    let [slope] = &law.amplitudes[..] else { panic!("{:?}", law.amplitudes) };
    assert!(slope.low < -0.2 && -0.2 < slope.high && slope.high - slope.low < 0.02, "{slope:?}");
}

/// A wave in time that goes on as the slide does is the slide.
#[test]
fn what_swings_as_the_slide_does_is_no_law_of_time() {
    let found = sweep(1, 0.5, false, |load, change| load + 0.2 * change);
    assert!(found.diagnosis.is_mismatch());
    let law = found.law.as_ref().and_then(|proposed| proposed.law.as_ref().ok());
    assert!(law.is_none_or(|law| !law.site.variable.name.contains("time")), "{law:?}");
}
