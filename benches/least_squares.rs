//! A fit of 450 residuals and 32 parameters, beside the bare QR decompositions of as many
//! Jacobians: their ratio is what the search costs on top of what no Gauss–Newton method can do
//! without. And the time of one linear fit over the number of its rows, in blocks: it should grow
//! as they do.
//!
//! `cargo bench -p rodcal-benches --bench least_squares`; with the argument `fits 100` or
//! `factorisations 100` it does only that, for `valgrind --tool=callgrind`.

#![allow(missing_docs, clippy::unwrap_used, clippy::print_stdout)]

use std::hint::black_box;
use std::time::Duration;

use criterion::{BenchmarkId, Criterion};
use faer::Mat;
use nalgebra::{DMatrix, DVector};
use rodcal::least_squares::{Fit, Noise, Options, Prior, Problem, assembled, fit};

const PARAMETERS: usize = 32;
const ROWS_IN_BLOCK: usize = 240;
const TALL: [usize; 4] = [450, 3000, 30_000, 300_000];

/// rᵢ = sin(aᵢᵀp) − sin(aᵢᵀp₀) + noise: as smooth as a kinematic chain and with as little cost of
/// its own as possible.
struct Waves {
    /// aᵢᵀ, m × n.
    rows: DMatrix<f64>,
    measured: DVector<f64>,
}

/// A number in [−1, 1) for every index, without pattern enough to matter.
fn scatter(i: usize) -> f64 {
    let mut x = (i as u64).wrapping_add(0x9E37_79B9_7F4A_7C15).wrapping_mul(0xBF58_476D_1CE4_E5B9);
    x ^= x >> 31;
    x = x.wrapping_mul(0x94D0_49BB_1331_11EB);
    (x >> 11) as f64 / (1u64 << 52) as f64 - 1.0
}

impl Waves {
    fn new(m: usize) -> Self {
        let rows = DMatrix::from_fn(m, PARAMETERS, |i, j| 0.3 * scatter(i * PARAMETERS + j));
        let truth = DVector::from_fn(PARAMETERS, |j, _| 1.0 + 0.1 * scatter(j + 77));
        let angles = &rows * truth;
        let measured = DVector::from_fn(m, |i, _| angles[i].sin() + 1e-3 * scatter(i + 1_000_003));
        Waves { rows, measured }
    }

    fn start() -> DVector<f64> {
        DVector::from_element(PARAMETERS, 1.0)
    }

    fn block(&self, p: &DVector<f64>, first: usize, count: usize) -> DMatrix<f64> {
        let mut block = self.rows.rows(first, count).into_owned();
        let cosines = (&block * p).map(f64::cos);
        block.column_iter_mut().for_each(|mut column| column.component_mul_assign(&cosines));
        block
    }
}

impl Problem for Waves {
    fn parameter_count(&self) -> usize {
        PARAMETERS
    }

    fn residual_count(&self) -> usize {
        self.measured.len()
    }

    fn residuals(&self, p: &DVector<f64>) -> DVector<f64> {
        (&self.rows * p).map(f64::sin) - &self.measured
    }

    fn jacobian(&self, p: &DVector<f64>) -> DMatrix<f64> {
        assembled(self, p)
    }

    fn jacobian_blocks(&self, p: &DVector<f64>, visit: &mut dyn FnMut(usize, &DMatrix<f64>)) {
        let m = self.residual_count();
        for first in (0..m).step_by(ROWS_IN_BLOCK) {
            visit(first, &self.block(p, first, ROWS_IN_BLOCK.min(m - first)));
        }
    }
}

fn solve(waves: &Waves, options: &Options) -> Fit {
    let fit = fit(waves, black_box(&Waves::start()), options).unwrap();
    assert!(fit.is_converged(), "{}", fit.reason);
    fit
}

/// With a prior of little weight on every parameter, as a calibration has them.
fn with_priors() -> Options {
    let priors = (0..PARAMETERS).map(|parameter| Prior { parameter, value: 1.0, sd: 10.0 }).collect();
    Options { priors, noise: Noise::Known(1e-3), ..Options::default() }
}

/// faer's own solver, as it comes, on `count` copies of the Jacobian.
fn factorise(j: &Mat<f64>, count: usize) {
    for _ in 0..count {
        black_box(black_box(j).qr());
    }
}

fn copied(j: &DMatrix<f64>) -> Mat<f64> {
    Mat::from_fn(j.nrows(), j.ncols(), |i, k| j[(i, k)])
}

fn compare(c: &mut Criterion) {
    let waves = Waves::new(TALL[0]);
    let jacobian = copied(&waves.jacobian(&Waves::start()));
    let (plain, priors) = (Options::default(), with_priors());
    let iterations = solve(&waves, &plain).iterations;
    println!("{iterations} Jacobians, {} with priors", solve(&waves, &priors).iterations);

    let mut group = c.benchmark_group("450 x 32");
    group.sample_size(20).warm_up_time(Duration::from_millis(500)).measurement_time(Duration::from_secs(2));
    group.bench_function("bare QR of all Jacobians", |b| b.iter(|| factorise(&jacobian, iterations)));
    group.bench_function("fit", |b| b.iter(|| solve(&waves, &plain)));
    group.bench_function("fit with priors", |b| b.iter(|| solve(&waves, &priors)));
    group.bench_function("residuals and Jacobians alone", |b| {
        let start = Waves::start();
        b.iter(|| {
            for _ in 0..iterations {
                black_box(waves.residuals(black_box(&start)));
                waves.jacobian_blocks(&start, &mut |_, block| {
                    black_box(block);
                });
            }
        });
    });
    group.finish();

    let mut group = c.benchmark_group("rows");
    group.sample_size(10).warm_up_time(Duration::from_millis(300)).measurement_time(Duration::from_secs(2));
    for m in TALL {
        let waves = Waves::new(m);
        group
            .bench_with_input(BenchmarkId::new("fit", m), &waves, |b, waves| b.iter(|| solve(waves, &plain)));
    }
    group.finish();
}

fn main() {
    let arguments: Vec<String> = std::env::args().collect();
    let count = arguments.get(2).and_then(|count| count.parse().ok());
    let waves = Waves::new(TALL[0]);
    let plain = Options::default();
    match (arguments.get(1).map(String::as_str), count) {
        (Some("fits"), Some(count)) => (0..count).for_each(|_| {
            black_box(solve(&waves, &plain));
        }),
        (Some("factorisations"), Some(count)) => {
            // as many Jacobians as that many fits have
            let iterations = solve(&waves, &plain).iterations;
            let jacobian = copied(&waves.jacobian(&Waves::start()));
            factorise(&jacobian, count * iterations);
        }
        _ => {
            let mut criterion = Criterion::default().configure_from_args();
            compare(&mut criterion);
            criterion.final_summary();
        }
    }
}
