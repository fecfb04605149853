//! Time of a whole diagnosis of a rig's recording, held-out folds included, on one core, beside one QR factorisation of as
//! many rows and as many columns as there are candidates. Only the ratio of the two means the same on every machine.
//!
//! `cargo bench --bench diagnosis`

#![allow(missing_docs, clippy::unwrap_used, clippy::print_stdout)]

use std::hint::black_box;
use std::time::Duration;

use criterion::{BenchmarkId, Criterion, criterion_group, criterion_main};
use nalgebra::DMatrix;
use rodcal::diagnosis::World;
use rodcal::diagnosis::rig::{RigWorld, diagnose};
use rodcal::rig::readings::Readings;
use rodcal::rod::Rod;
use rodcal::trial::rig::{Effect, Order};
use rodcal::units::UM;

/// Friction and a soft sensor: two effects to be found, in every fold again.
fn recording(trials: usize) -> (Rod, Readings) {
    let order = Order { trials, axes: vec![1, 2], ..Order::default() };
    let effects = [
        Effect::Friction { axis: None, force: 1.0, presliding: 0.5 * UM, scatter: 0.1 },
        Effect::SensorScale { channel: 2, factor: 1.05 },
    ];
    let made = order.made(&effects, 1);
    (
        Rod::from_toml("rod.toml", &made.rod).unwrap(),
        Readings::from_text("readings.csv", &made.readings).unwrap(),
    )
}

fn whole_diagnosis(c: &mut Criterion) {
    // a job of the pool works through its own jobs one after the other
    let run = |job: &(dyn Fn() + Sync)| {
        rodcal::parallel::in_parallel(1, |_| job());
    };
    let mut group = c.benchmark_group("diagnosis on one core");
    group.sample_size(10).warm_up_time(Duration::from_millis(200)).measurement_time(Duration::from_secs(2));
    // 28 readings in a trial
    for trials in [4, 11, 18] {
        let (rod, readings) = recording(trials);
        let (world, _) = RigWorld::new(&readings, Some(&rod)).unwrap();
        let (rows, columns) = (world.data().len(), world.candidates().len());
        println!("{rows} readings, {columns} candidates");
        group.bench_function(BenchmarkId::new("diagnose", rows), |b| {
            b.iter(|| run(&|| drop(black_box(diagnose(&readings, Some(&rod)).unwrap()))));
        });
        let matrix = DMatrix::from_fn(rows, columns, |i, j| ((i * columns + j) as f64 * 0.7).sin());
        group.bench_function(BenchmarkId::new("one QR of all candidates", rows), |b| {
            b.iter(|| run(&|| drop(black_box(matrix.clone().qr()))));
        });
    }
    group.finish();
}

criterion_group!(benches, whole_diagnosis);
criterion_main!(benches);
