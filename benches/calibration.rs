//! Time of one calibration of a simulated TX90 campaign, beside what the bare QR factorisations of
//! its Jacobians cost, and over the number of poses. Only the ratios mean anything: run them in one
//! go.
//!
//! `cargo bench -p rodcal-benches --bench calibration`

#![allow(missing_docs, clippy::unwrap_used, clippy::print_stdout)]

use std::hint::black_box;
use std::time::{Duration, Instant};

use criterion::{Criterion, criterion_group, criterion_main};
use nalgebra::DMatrix;
use rodcal::beam::Physics;
use rodcal::calibration::campaign::Campaign;
use rodcal::calibration::simulate::{Plan, campaign_files, simulate};
use rodcal::calibration::{Compensation, Mode, Options, calibrate, calibrate_from, free_parameters, start};
use rodcal::compliance::Compliance;
use rodcal::linalg::RowReduction;
use rodcal::robot::Robot;
use rodcal::rod::Rod;

const ROD: &str = include_str!("../rods/5.toml");

/// The paper's campaign: 5 clamps × 30 poses.
fn campaign() -> Campaign {
    let (_, text) = Robot::builtin("tx90").unwrap();
    let robot = Robot::from_text("tx90.toml", text, None, None).unwrap();
    let rod = Rod::from_toml("5.toml", ROD).unwrap();
    let model = Compliance::of_model(&rod, &Physics::default(), 200).unwrap();
    let simulation = simulate(&robot, &rod, &model, &Plan::default()).unwrap();
    let files = campaign_files(&simulation, "builtin:tx90", "rod.toml");
    let find = |wanted: &str| match wanted {
        "rod.toml" => ROD.to_owned(),
        _ => files.iter().find(|(name, _)| name == wanted).unwrap().1.clone(),
    };
    Campaign::from_texts("campaign.toml", &find("campaign.toml"), &|name| Ok(find(name))).unwrap()
}

/// QR of `count` matrices of `rows` × 33.
fn bare_qr(rows: usize, count: usize) {
    let matrix = DMatrix::from_fn(rows, 33, |i, j| ((i * 33 + j) as f64 * 0.7).sin());
    for _ in 0..count {
        let mut reduction = RowReduction::new(33, rows);
        reduction.push(rows, |range, column, entries| {
            entries.copy_from_slice(&black_box(&matrix).column(column).as_slice()[range]);
        });
        black_box(reduction.triangle());
    }
}

fn one_calibration(c: &mut Criterion) {
    let campaign = campaign();
    let fit = calibrate(&campaign, Mode::Meas, &Options::default()).unwrap();
    println!("{} parameters, {} passes", fit.parameters.len(), fit.passes.len());
    let mut group = c.benchmark_group("150 poses x 32 parameters");
    group.sample_size(20).warm_up_time(Duration::from_millis(300)).measurement_time(Duration::from_secs(2));
    let compensation = Compensation::new(&campaign, Mode::Meas).unwrap();
    group.bench_function("calibrate", |b| {
        b.iter(|| {
            let start = start(&campaign).unwrap();
            let free = free_parameters(&campaign, &start, &compensation);
            let recording = &campaign.measurements;
            calibrate_from(&campaign, recording, start, &free, &compensation, &Options::default()).unwrap()
        });
    });
    group.bench_function("with rod model and validation", |b| {
        b.iter(|| calibrate(&campaign, Mode::Meas, &Options::default()).unwrap());
    });
    group.bench_function("one bare QR", |b| b.iter(|| bare_qr(450, 1)));
    group.finish();
}

/// Twelve thousand times the same pose is no campaign, but as much work as one.
fn many_poses(_: &mut Criterion) {
    let campaign = campaign();
    let compensation = Compensation::new(&campaign, Mode::Meas).unwrap();
    let fitted = calibrate(&campaign, Mode::Meas, &Options::default()).unwrap();
    let free: Vec<_> = fitted.parameters.iter().map(|p| p.parameter).collect();
    println!("poses   seconds per 1000 poses");
    for times in [1, 7, 67, 667] {
        let rows: Vec<usize> = (0..150 * times).map(|row| row % 150).collect();
        let recording = campaign.measurements.subset(&rows);
        let begin = Instant::now();
        let fit = calibrate_from(
            &campaign,
            &recording,
            fitted.start.clone(),
            &free,
            &compensation,
            &Options::default(),
        )
        .unwrap();
        let seconds = begin.elapsed().as_secs_f64();
        println!(
            "{:6}  {:.5}   converged: {}",
            rows.len(),
            1e3 * seconds / rows.len() as f64,
            fit.is_converged
        );
    }
}

criterion_group!(benches, one_calibration, many_poses);
criterion_main!(benches);
