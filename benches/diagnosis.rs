//! Time of a whole diagnosis, held-out folds included. Of a rig's recording on one core, beside one
//! QR factorisation of as many rows and as many columns as there are candidates; of a campaign on
//! all cores, beside its calibration. Only the ratio of the two means the same on every machine.
//!
//! `cargo bench -p rodcal-benches --bench diagnosis`

#![allow(missing_docs, clippy::unwrap_used, clippy::print_stdout)]

use std::hint::black_box;
use std::time::Duration;

use criterion::{BenchmarkId, Criterion, criterion_group, criterion_main};
use nalgebra::DMatrix;
use rodcal::beam::Physics;
use rodcal::calibration::campaign::Campaign;
use rodcal::calibration::simulate::{Plan, campaign_files, simulate};
use rodcal::calibration::{Mode, Options, calibrate};
use rodcal::compliance::{Compliance, DEFAULT_ELEMENTS};
use rodcal::diagnosis::calibration;
use rodcal::diagnosis::rig::{RigModel, diagnose};
use rodcal::inference::ForwardModel;
use rodcal::rig::readings::Readings;
use rodcal::robot::Robot;
use rodcal::rod::Rod;
use rodcal::units::UM;
use rodcal_trial::rig::{CaseSpec, Effect};

/// Friction and a soft sensor: two effects to be found, in every fold again.
fn recording(trials: usize) -> (Rod, Readings) {
    let spec = CaseSpec { trials, axes: vec![1, 2], ..CaseSpec::default() };
    let effects = [
        Effect::Friction { axis: None, force: 1.0, presliding: 0.5 * UM, scatter: 0.1 },
        Effect::SensorScale { channel: 2, factor: 1.05 },
    ];
    let case = spec.simulated(&effects, 1);
    (
        Rod::from_toml("rod.toml", &case.rod).unwrap(),
        Readings::from_text("readings.csv", &case.readings).unwrap(),
    )
}

fn whole_diagnosis(c: &mut Criterion) {
    let one_core = rayon::ThreadPoolBuilder::new().num_threads(1).build().unwrap();
    let run = |job: &(dyn Fn() + Sync)| one_core.install(job);
    let mut group = c.benchmark_group("diagnosis on one core");
    group.sample_size(10).warm_up_time(Duration::from_millis(200)).measurement_time(Duration::from_secs(2));
    // 28 readings in a trial
    for trials in [4, 11, 18] {
        let (rod, readings) = recording(trials);
        let (model, _) = RigModel::new(&readings, Some(&rod)).unwrap();
        let (rows, columns) = (model.data().len(), model.candidates().len());
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

/// A TX90 whose joint 3 errs with its angle, on five clamps.
fn campaign(poses_per_clamp: usize) -> Campaign {
    const ERROR: &str =
        "[[effect]]\nname = \"transmission_error\"\njoint = 3\ncycles_per_rev = 11.4\nsin_urad = 250.0\n";
    let nominal = std::fs::read_to_string("robots/tx90.toml").unwrap();
    let rod_text = std::fs::read_to_string("rods/5.toml").unwrap();
    let robot = Robot::from_text("tx90.toml", &format!("{nominal}\n{ERROR}"), None, None).unwrap();
    let rod = Rod::from_toml("rod.toml", &rod_text).unwrap();
    let model = Compliance::of_model(&rod, &Physics::default(), DEFAULT_ELEMENTS).unwrap();
    let mut plan = Plan::default();
    plan.poses_per_clamp = poses_per_clamp;
    let files = campaign_files(&simulate(&robot, &rod, &model, &plan).unwrap(), "builtin:tx90", "rod.toml");
    let find = |wanted: &str| match wanted {
        "rod.toml" => rod_text.clone(),
        _ => files.iter().find(|(name, _)| name == wanted).unwrap().1.clone(),
    };
    Campaign::from_texts("campaign.toml", &find("campaign.toml"), &|name| Ok(find(name))).unwrap()
}

fn diagnosis_of_a_campaign(c: &mut Criterion) {
    let mut group = c.benchmark_group("diagnosis of a campaign");
    group.sample_size(10).warm_up_time(Duration::from_millis(200)).measurement_time(Duration::from_secs(3));
    for poses_per_clamp in [30, 200] {
        let campaign = campaign(poses_per_clamp);
        let (poses, options) = (campaign.measurements.len(), Options::default());
        group.bench_function(BenchmarkId::new("diagnose", poses), |b| {
            b.iter(|| black_box(calibration::diagnose_as_recorded(&campaign, Mode::Fea, &options).unwrap()));
        });
        group.bench_function(BenchmarkId::new("calibrate", poses), |b| {
            b.iter(|| black_box(calibrate(&campaign, Mode::Fea, &options).unwrap()));
        });
    }
    group.finish();
}

criterion_group!(benches, whole_diagnosis, diagnosis_of_a_campaign);
criterion_main!(benches);
