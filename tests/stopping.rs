//! What takes long ends soon after somebody asks for it, wherever it is.

#![allow(clippy::unwrap_used)]

use std::fmt::Write;
use std::time::Duration;

use rodcal::answer::{self, ComplianceOptions};
use rodcal::parallel::{Stop, stoppable};
use rodcal::rig;
use rodcal::rig::readings::Readings;
use rodcal::rod::Rod;

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

/// Stops `work` at some moments, long before its end: it must leave without a result, however slow
/// the machine is.
fn ends(moments: &[u64], work: impl Fn() + Sync) {
    for &milliseconds in moments {
        let stop = Stop::default();
        std::thread::scope(|scope| {
            let worker = scope.spawn(|| stoppable(&stop, &work));
            std::thread::sleep(Duration::from_millis(milliseconds));
            stop.now();
            assert_eq!(worker.join().unwrap(), None, "asked for after {milliseconds} ms");
        });
    }
}

#[test]
fn a_fit_of_many_readings_ends() {
    let (rod, readings) = (rod(), readings(650, 51));
    ends(&[20, 300], || drop(rig::fit(&readings, Some(&rod), &rig::Options::default())));
}

#[test]
fn a_beam_of_many_elements_ends() {
    let rod = rod();
    let options = ComplianceOptions::default().with_elements(1_000_000);
    ends(&[20, 300], || drop(answer::compliance(rod.clone(), &options)));
}

#[test]
fn a_diagnosis_of_many_readings_ends() {
    let (rod, readings) = (rod(), readings(330, 100));
    ends(&[100, 1000, 3000], || drop(answer::diagnose_rig(&readings, Some(&rod), &[], None)));
}
