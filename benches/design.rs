//! Time of a rod of a search: the tip alone, all figures of the tip, the whole search through the
//! public call on all processors. Beside it a plain loop in C (`benches/reference/rods.c`) and
//! PyNite (`benches/reference/pynite_rods.py`); only ratios of one go mean anything.
//!
//! `cargo bench -p rodcal-benches --bench design`

#![allow(missing_docs, clippy::unwrap_used)]

use std::hint::black_box;
use std::time::Duration;

use criterion::{Criterion, Throughput, criterion_group, criterion_main};
use rodcal::beam::TipSolver;
use rodcal::design::{DesignSpace, Figures, Searched, search};
use rodcal::rod::Rod;

/// As `rods.c`: 20 tubes, 2 angles, 250 × 500 lengths; here of 4 tubes.
const SPACE: &str = "
[geometry]
l1_mm = { from = 100, to = 349, step = 1 }
l2_mm = { from = 300, to = 799, step = 1 }
gamma_deg = [90, 120]
[catalogue]
file = \"tubes.csv\"
[material.steel]
youngs_modulus_gpa = 193
poisson_ratio = 0.29
density_kg_m3 = 7930
[tip]
mass_g = 60
[constraints]
max_mass_g = 900
min_reach_mm = 500
[objectives]
minimise = [\"c_rod_um\", \"mass_g\"]
";
const TUBES: &str = "name,material,outer_diameter_mm,inner_diameter_mm
a,steel,20,18
b,steel,25,23
c,steel,30,28
d,steel,35,33
";

fn rods(c: &mut Criterion) {
    let mut rod = Rod::from_toml("5.toml", include_str!("../rods/5.toml")).unwrap();
    let mut group = c.benchmark_group("a rod");
    group.sample_size(10).warm_up_time(Duration::from_millis(300)).measurement_time(Duration::from_secs(2));
    let mut solver = TipSolver::default();
    group.bench_function("tip", |b| {
        b.iter(|| {
            rod.l2 = black_box(0.525);
            solver.solve(&rod)
        });
    });
    group.bench_function("figures", |b| {
        b.iter(|| {
            rod.l2 = black_box(0.525);
            Figures::of(&rod, &mut solver)
        });
    });
    group.bench_function("first frequency", |b| b.iter(|| black_box(&rod).first_frequency().unwrap()));
    group.bench_function("derivatives by all numbers", |b| {
        b.iter(|| Figures::slopes(black_box(&rod)).unwrap())
    });
    group.finish();

    let space =
        DesignSpace::from_toml("d.toml", SPACE, &|name| Ok((name.to_owned(), TUBES.to_owned()))).unwrap();
    let mut group = c.benchmark_group("search");
    group.sample_size(10).measurement_time(Duration::from_secs(8));
    group.throughput(Throughput::Elements(space.combinations()));
    group.bench_function("a million rods", |b| b.iter(|| search(&space, Searched::All, &|_| {}).unwrap()));
    group.finish();
}

criterion_group!(design, rods);
criterion_main!(design);
