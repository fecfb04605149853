//! What takes long ends soon after somebody asks for it, wherever it is.

#![allow(clippy::unwrap_used)]

use std::fmt::Write;
use std::time::{Duration, Instant};

use rodcal::answer::{self, ComplianceOptions};
use rodcal::parallel::{Stop, stoppable};
use rodcal::rig;
use rodcal::rig::readings::Readings;
use rodcal::rod::Rod;

/// A beam or a line asks at every element; tests run beside others.
const AT_ONCE: Duration = Duration::from_millis(500);
/// A diagnosis asks between its operations on all readings.
const SOON: Duration = Duration::from_secs(4);

fn rod() -> Rod {
    let path = concat!(env!("CARGO_MANIFEST_DIR"), "/rods/5.toml");
    Rod::read(path.as_ref()).unwrap()
}

/// Along each axis `loads` loads in `trials` trials, with an offset of each trial.
fn readings(loads: usize, trials: usize) -> Readings {
    let mut text = String::from("trial,axis,load_n,dx_um,dy_um,dz_um\n");
    for trial in 0..trials {
        for load in 1..=loads {
            for (k, axis) in ["x", "y", "z"].into_iter().enumerate() {
                let newton = 20.0 * load as f64 / loads as f64;
                let zero = (trial * 7919 % 13) as f64;
                let noise = ((trial * 31 + load * 17 + k) % 11) as f64 - 5.0;
                let offset = |axis: usize| if axis == k { 40.0 * newton + zero + noise } else { noise };
                let [dx, dy, dz] = [0, 1, 2].map(offset);
                writeln!(text, "{trial},{axis},{newton},{dx},{dy},{dz}").unwrap();
            }
        }
    }
    Readings::from_text("readings.csv", &text).unwrap()
}

/// Stops `work` at some moments and says the longest that it took to end.
fn longest_delay(moments: &[u64], work: impl Fn() + Sync) -> Duration {
    let delay = |milliseconds: &u64| {
        let stop = Stop::default();
        std::thread::scope(|scope| {
            let worker = scope.spawn(|| stoppable(&stop, &work).map(drop));
            std::thread::sleep(Duration::from_millis(*milliseconds));
            let asked = Instant::now();
            stop.now();
            worker.join().unwrap();
            asked.elapsed()
        })
    };
    moments.iter().map(delay).max().unwrap()
}

#[test]
fn a_fit_of_many_readings_ends() {
    let (rod, readings) = (rod(), readings(650, 51));
    let work = || drop(rig::fit(&readings, Some(&rod), &rig::Options::default()));
    let delay = longest_delay(&[50, 300, 1000], work);
    assert!(delay < AT_ONCE, "{delay:.2?}");
}

#[test]
fn a_beam_of_many_elements_ends() {
    let rod = rod();
    let options = ComplianceOptions { elements: 1_000_000, ..ComplianceOptions::default() };
    let work = || drop(answer::compliance(rod.clone(), &options));
    let delay = longest_delay(&[50, 300, 1000, 2000], work);
    assert!(delay < AT_ONCE, "{delay:.2?}");
}

#[test]
fn a_diagnosis_of_many_readings_ends() {
    let (rod, readings) = (rod(), readings(330, 100));
    let work = || drop(answer::diagnose_rig(&readings, Some(&rod), &[], None));
    let delay = longest_delay(&[100, 1000, 3000, 6000], work);
    assert!(delay < SOON, "{delay:.2?}");
}
