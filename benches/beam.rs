//! Time of the rod's six load cases, model build included, over the number of elements; beside it a
//! banded and a dense stiffness method of our own on the same elements. Only the ratios mean
//! anything: run them in one go. Before that, how far each is off the independent references.
//!
//! `cargo bench -p rodcal-benches --bench beam`

#![allow(missing_docs, clippy::unwrap_used, clippy::print_stdout)]

mod reference;

use std::hint::black_box;
use std::time::Duration;

use criterion::{BenchmarkId, Criterion, criterion_group, criterion_main};
use nalgebra::Matrix3;
use reference::{Frame, banded, dense};
use rodcal::beam::Physics;
use rodcal::compliance::Compliance;
use rodcal::rod::Rod;
use serde_json::Value;

const ELEMENTS: [usize; 5] = [2, 20, 200, 2000, 20_000];
/// A dense matrix of more takes minutes and gigabytes.
const DENSE_UP_TO: usize = 200;
/// What the three methods must agree to at 20 elements, relative to the largest entry.
const SAME: f64 = 1e-9;

/// A rod and its exact compliance.
type Reference = (Rod, Compliance);

fn flexibility(rod: &Rod, elements: usize) -> Compliance {
    Compliance::of_model(rod, &Physics::default(), elements).unwrap()
}

/// Largest deviation over C^F and C^g, each relative to its largest entry.
fn deviation(found: &Compliance, reference: &Compliance) -> f64 {
    let relative = |a: &Matrix3<f64>, b: &Matrix3<f64>| (a - b).amax() / b.amax();
    relative(&found.force, &reference.force).max(relative(&found.gravity, &reference.gravity))
}

fn six_load_cases(c: &mut Criterion) {
    let rod = Rod::from_toml("5.toml", include_str!("../rods/5.toml")).unwrap();
    let ours = flexibility(&rod, 20);
    assert!(deviation(&banded::compliance(&rod, 20).unwrap(), &ours) < SAME);
    assert!(deviation(&dense::compliance(&rod, 20).unwrap(), &ours) < SAME);
    accuracy();

    let mut group = c.benchmark_group("six load cases");
    group.sample_size(10).warm_up_time(Duration::from_millis(300)).measurement_time(Duration::from_secs(2));
    for elements in ELEMENTS {
        group.bench_with_input(BenchmarkId::new("flexibility", elements), &elements, |b, &n| {
            b.iter(|| flexibility(black_box(&rod), n));
        });
        group.bench_with_input(BenchmarkId::new("banded", elements), &elements, |b, &n| {
            b.iter(|| banded::compliance(black_box(&rod), n).unwrap());
        });
        if elements <= DENSE_UP_TO {
            group.bench_with_input(BenchmarkId::new("dense", elements), &elements, |b, &n| {
                b.iter(|| dense::compliance(black_box(&rod), n).unwrap());
            });
        }
    }
    group.finish();
}

/// Prints how far each method is off the independent references (tests/references), Timoshenko's
/// theory: the worst of all rods for ours, of the sharp-cornered rods without joints and masses for
/// all three.
fn accuracy() {
    let references: Value =
        serde_json::from_str(include_str!("../tests/references/beam_references.json")).unwrap();
    let all: Vec<Reference> = references["cases"].as_array().unwrap().iter().map(rod_and_reference).collect();
    let plain: Vec<Reference> = all.iter().filter(|(rod, _)| Frame::describes(rod)).cloned().collect();
    println!("deviation from the references, relative to the largest entry");
    println!("{:>9}{:>12}{:>12}{:>12}{:>12}", "elements", "ours, all", "ours, plain", "banded", "dense");
    for n in ELEMENTS {
        let dense = match n <= DENSE_UP_TO {
            true => worst(&plain, |rod| dense::compliance(rod, n)),
            false => "–".into(),
        };
        println!(
            "{n:>9}{:>12}{:>12}{:>12}{dense:>12}",
            worst(&all, |rod| Some(flexibility(rod, n))),
            worst(&plain, |rod| Some(flexibility(rod, n))),
            worst(&plain, |rod| banded::compliance(rod, n)),
        );
    }
}

/// Largest deviation over `cases`; "fails" where one of them has no solution.
fn worst(cases: &[Reference], method: impl Fn(&Rod) -> Option<Compliance>) -> String {
    let found: Option<Vec<f64>> =
        cases.iter().map(|(rod, exact)| Some(deviation(&method(rod)?, exact))).collect();
    found.map_or("fails".into(), |all| format!("{:.0e}", all.into_iter().fold(0.0, f64::max)))
}

fn rod_and_reference(case: &Value) -> Reference {
    let rod = Rod::from_toml("reference", case["rod_toml"].as_str().unwrap()).unwrap();
    let result =
        case["results"].as_array().unwrap().iter().find(|result| result["theory"] == "timoshenko").unwrap();
    let matrix = |key: &str| Matrix3::from_fn(|m, n| result[key][m][n].as_f64().unwrap() * 1e-6);
    (rod, Compliance { force: matrix("cf_um_per_n"), gravity: matrix("cg_um_per_g") })
}

criterion_group!(benches, six_load_cases);
criterion_main!(benches);
