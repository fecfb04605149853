//! Errors of gears and encoders as functions of the joint's own angle.
//!
//! ```text
//! harmonic   leverⱼ·(a·sin(n·qⱼ) + b·cos(n·qⱼ))     n cycles per revolution, whole numbers
//! wave       leverⱼ·((a + c·u)·sin(n·qⱼ) + (b + d·u)·cos(n·qⱼ))     u ∝ qⱼ − q̄ⱼ, n scanned: gear.rs
//! curve      leverⱼ·f(qⱼ)                            f a smooth curve: cosines.rs
//! ```
//!
//! Two cycles per revolution can be told apart over a range of ρ revolutions if they differ by 1/ρ or so; the scan has steps
//! of half of that, of one half at most, up to 40; c and d reach what lies between. Beyond, only what gears in use have: a
//! strain-wave gear of ratio i errs with i and 2·i cycles per revolution of its output, and the joint's motor with i.

use std::f64::consts::TAU;

use super::JOINT_ANGLE;
use crate::diagnosis::calibration::cosines::Cosines;
use crate::diagnosis::calibration::gear::Gear;
use crate::diagnosis::calibration::scene::{Entry, Scene, entry, linear};

const EFFECT: &str = "transmission_error";
const URAD: f64 = 1e-6;
/// Last frequency of the scan, cycles per revolution, and its widest step.
const SCAN: (f64, f64) = (40.0, 0.5);
/// Ratios of strain-wave gears that arms are built with.
const RATIOS: [f64; 8] = [50.0, 51.0, 80.0, 100.0, 101.0, 120.0, 121.0, 160.0];
/// Length scales ℓ of curves, rad, as 1/ℓ: their spectrum falls to 1/√e of its amplitude at √2/ℓ cycles per revolution.
const CURVES: [f64; 5] = [2.0, 4.0, 8.0, 16.0, 32.0];
/// Beyond so many cosines there is no curve: over a wide range a scan sees what is fine. Nor is there one of more than this
/// many for every pose: it would go through them all.
const MOST_COSINES: (usize, f64) = (160, 0.5);

pub(in crate::diagnosis::calibration) fn all(scene: &Scene) -> Vec<Entry> {
    let of_joint = |j: usize| {
        let (steps, half_step) = scan(scene, j);
        let whole = (1..=SCAN.0 as usize).map(|n| n as f64).chain(ratios());
        let harmonics = whole.map(move |n| harmonic(scene, j, n));
        let waves = steps.into_iter().map(move |n| wave(scene, j, n, half_step));
        harmonics.chain(waves).chain(CURVES.into_iter().filter_map(move |cycles| curve(scene, j, cycles)))
    };
    scene.revolute().into_iter().flat_map(of_joint).collect()
}

/// Cycles per revolution of a joint's waves, and half their step.
fn scan(scene: &Scene, j: usize) -> (Vec<f64>, f64) {
    let (low, high) = scene.range(j);
    let turns = (high - low) / TAU;
    // an integer number of steps per cycle, so that whole numbers are in the scan
    let per_cycle = (2.0 * turns).ceil().max(1.0 / SCAN.1);
    let steps = (1..=(SCAN.0 * per_cycle) as usize).map(|k| k as f64 / per_cycle);
    (steps.collect(), 0.5 / per_cycle)
}

/// Frequencies of gears in use beyond the scan, cycles per revolution.
fn ratios() -> Vec<f64> {
    let mut ratios: Vec<f64> = RATIOS.iter().flat_map(|ratio| [*ratio, 2.0 * ratio]).collect();
    ratios.sort_by(f64::total_cmp);
    ratios.dedup();
    ratios
}

fn harmonic(scene: &Scene, j: usize, cycles: f64) -> Entry {
    let gear = Gear::Harmonic { joint: j, cycles_per_rev: cycles };
    terms(scene, gear, format!("joint {}, {cycles} cycles/rev", j + 1), &["sin_urad", "cos_urad"])
}

fn wave(scene: &Scene, j: usize, cycles: f64, half_step: f64) -> Entry {
    let (low, high) = scene.range(j);
    let gear = Gear::Wave { joint: j, cycles_per_rev: cycles, middle: 0.5 * (low + high), half_step };
    let names = ["sin_urad", "cos_urad", "sin_urad_per_rad", "cos_urad_per_rad"];
    terms(
        scene,
        gear,
        format!("joint {}, near {} cycles/rev", j + 1, (cycles * 100.0).round() / 100.0),
        &names,
    )
}

fn terms(scene: &Scene, gear: Gear, location: String, names: &[&str]) -> Entry {
    let of_term = |(k, name): (usize, &&str)| {
        let column = scene.turn(gear.joint(), |_, posture| gear.term(k, posture.joints[gear.joint()]));
        (linear(*name, URAD, JOINT_ANGLE), column)
    };
    let parameters = names.iter().enumerate().map(of_term).collect();
    Entry { gear: Some(gear), ..entry(EFFECT, location, parameters) }
}

fn curve(scene: &Scene, j: usize, cycles: f64) -> Option<Entry> {
    let (low, high) = scene.range(j);
    let scale = 1.0 / cycles;
    let cosines = Cosines::new((low, high), scale);
    // the constant is the joint's offset
    let per_pose = (MOST_COSINES.1 * scene.postures.len() as f64) as usize;
    if !(3..=MOST_COSINES.0.min(per_pose)).contains(&cosines.sizes.len()) {
        return None;
    }
    let parameters = (1..cosines.sizes.len()).map(|k| {
        let column = scene.turn(j, |_, posture| cosines.value(k, posture.joints[j]));
        (linear(format!("cosine_{k}_urad"), URAD, JOINT_ANGLE * cosines.sizes[k]), column)
    });
    let location = format!("joint {}, a smooth curve, scale {:.2}°", j + 1, scale.to_degrees());
    let entry = entry(EFFECT, location, parameters.collect());
    Some(Entry { gear: Some(Gear::Curve { joint: j, cosines }), ..entry })
}
