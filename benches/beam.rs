//! Time of the rod's six load cases, model build included, over the number of elements; beside it a banded and a
//! dense stiffness method of our own on the same elements. Only the ratios mean anything: run them in one go.
//!
//! `cargo bench --bench beam`

#![allow(missing_docs)]

use std::hint::black_box;

use criterion::{BenchmarkId, Criterion, criterion_group, criterion_main};
use rodcal::beam::Physics;
use rodcal::compliance::Compliance;
use rodcal::rod::Rod;

fn rod() -> Rod {
    Rod::from_toml("5.toml", include_str!("../rods/5.toml")).expect("an embedded rod is sound")
}

fn six_load_cases(c: &mut Criterion) {
    let rod = rod();
    let mut group = c.benchmark_group("six load cases");
    for elements in [2, 20, 200, 2000, 20_000] {
        group.bench_with_input(BenchmarkId::new("flexibility", elements), &elements, |b, &n| {
            b.iter(|| Compliance::of_model(black_box(&rod), &Physics::default(), n));
        });
    }
    group.finish();
}

criterion_group!(benches, six_load_cases);
criterion_main!(benches);
