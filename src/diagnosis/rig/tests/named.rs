//! What is said of recordings that are simulated here, by hand.

use nalgebra::{Matrix3, Vector3};

use super::*;
use crate::diagnosis::Limitation;
use crate::statistics::Random;

/// Loads up and down along y and z in turns, each read half a minute and two minutes after it was
/// hung; zeroed a quarter of a minute before the first.
struct Bench {
    axis: Axis,
    load: f64,
    is_unloading: bool,
    trial: usize,
    zeroed: f64,
    hung: f64,
    time: f64,
}

fn bench(trials: usize) -> Vec<Bench> {
    let mut rows = Vec::new();
    let mut now = 0.0;
    for trial in 1..=trials {
        for axis in [Axis::Y, Axis::Z] {
            now += 240.0;
            let zeroed = now - 15.0;
            for (load, is_unloading) in [
                (3.0, false),
                (6.0, false),
                (9.0, false),
                (12.0, false),
                (9.0, true),
                (6.0, true),
                (3.0, true),
            ] {
                let of_row = |time| Bench { axis, load, is_unloading, trial, zeroed, hung: now, time };
                rows.extend([of_row(now + 30.0), of_row(now + 120.0)]);
                now += 150.0;
            }
            now += 10.0;
        }
    }
    rows
}

/// The recording of what is `shown` (m) in each row, at these temperatures, with 0.5 µm of noise.
fn recording(
    rows: &[Bench],
    celsius: impl Fn(f64) -> f64,
    shown: impl Fn(usize) -> Vector3<f64>,
    is_hung_known: bool,
) -> Readings {
    scattered(rows, celsius, shown, is_hung_known, 0.5)
}

/// The same with another noise, µm.
fn scattered(
    rows: &[Bench],
    celsius: impl Fn(f64) -> f64,
    shown: impl Fn(usize) -> Vector3<f64>,
    is_hung_known: bool,
    noise: f64,
) -> Readings {
    let mut random = Random::seeded(1, 0);
    let hung = if is_hung_known { ",loaded_at_s" } else { "" };
    let mut text = format!("axis,load_n,trial,phase,time_s,temperature_c,dx_um,dy_um,dz_um{hung}\n");
    for (index, row) in rows.iter().enumerate() {
        let read = shown(index).map(|own| own / UM + noise * random.normal());
        let phase = if row.is_unloading { "unload" } else { "load" };
        let hung = if is_hung_known { format!(",{}", row.hung) } else { String::new() };
        text += &format!(
            "{},{},{},{phase},{},{:.1},{:.2},{:.2},{:.2}{hung}\n",
            row.axis,
            row.load,
            row.trial,
            row.time,
            celsius(row.time),
            read.x,
            read.y,
            read.z
        );
    }
    readings(&text)
}

fn names(found: &RigDiagnosis) -> Vec<&'static str> {
    let mut names: Vec<_> = found.diagnosis.findings.iter().map(|own| own.effect.name).collect();
    names.sort_unstable();
    names
}

fn value(found: &RigDiagnosis, effect: &str, parameter: &str) -> crate::inference::Quantity {
    let own = found.diagnosis.findings.iter().find(|own| own.effect.name == effect).unwrap();
    own.quantity(parameter).unwrap()
}

/// A room that warms up by some kelvins and is read to a tenth of one.
fn room(time: f64) -> f64 {
    20.0 + 2.0 * (1.0 - (-time / 3000.0).exp()) + 0.3 * (time / 2500.0).sin()
}

/// A plastic that loses a per cent per kelvin.
#[test]
fn a_rod_that_softens_fast_is_named_beside_another_modulus() {
    let file = rod("");
    let mut actual = file.clone();
    for pipe in [&mut actual.pipe1, &mut actual.bend, &mut actual.pipe2] {
        pipe.material.shear_modulus *= 0.55;
    }
    let (c, rows) = (compliance(&actual), bench(3));
    let mean = rows.iter().map(|row| room(row.time)).sum::<f64>() / rows.len() as f64;
    let shown = |index: usize| {
        let row: &Bench = &rows[index];
        let force = Vector3::ith(row.axis.index(), row.load);
        c * force * (1.0 + 0.01 * (room(row.time) - mean))
    };
    let found = diagnose(&recording(&rows, room, shown, false), Some(&file)).unwrap();
    assert_eq!(names(&found), ["shear_modulus", "thermal_softening"]);
    let per_kelvin = value(&found, "thermal_softening", "per_k");
    assert!((per_kelvin.value - 0.01).abs() < 0.0015, "{per_kelvin:?}");
}

/// What is left of the loads of earlier runs is as large as the rod is soft, not as its file says.
#[test]
fn creep_of_a_rod_much_softer_than_its_file_recovers_as_far_as_it_crept() {
    let (file, rows) = (rod(""), bench(3));
    let c: Matrix3<f64> = compliance(&file) / 0.6;
    // every change of a load creeps on by itself, off the zero of the run that it is read in
    let (growth, start) = (0.03, 1.0);
    let mut changes: Vec<(f64, Vector3<f64>)> = Vec::new();
    let mut hanging: (Axis, f64, f64) = (Axis::Y, 0.0, 0.0);
    for row in &rows {
        let (axis, load, until) = hanging;
        if row.axis != axis && load != 0.0 {
            changes.push((until, -Vector3::ith(axis.index(), load)));
            hanging = (row.axis, 0.0, until);
        }
        if hanging.1 != row.load {
            changes.push((row.hung, Vector3::ith(row.axis.index(), row.load - hanging.1)));
        }
        hanging = (row.axis, row.load, row.time);
    }
    let shown = |index: usize| {
        let row: &Bench = &rows[index];
        let since = |now: f64, then: f64| (1.0 + (now - then).max(0.0) / start).log10();
        let crept = |(then, force): &(f64, Vector3<f64>)| {
            let before = if *then < row.zeroed { since(row.zeroed, *then) } else { 0.0 };
            let own = if *then < row.time { since(row.time, *then) } else { 0.0 };
            force * growth * (own - before)
        };
        let force = Vector3::ith(row.axis.index(), row.load);
        c * (force + changes.iter().map(crept).sum::<Vector3<f64>>())
    };
    for is_hung_known in [true, false] {
        let found = diagnose(&recording(&rows, |_| 20.0, shown, is_hung_known), Some(&file)).unwrap();
        assert_eq!(names(&found), ["creep", "stiffness_scale"]);
        let creep = value(&found, "creep", "per_decade");
        assert!(creep.low < growth && growth < creep.high, "{creep:?}");
        let factor = value(&found, "stiffness_scale", "factor");
        assert!((factor.value - 0.6).abs() < 0.03, "{factor:?}");
        // when a load was hung says how far it has crept
        let is_exact = found.diagnosis.discrepancy.is_none() && (creep.value - growth).abs() < 0.05 * growth;
        assert!(is_exact || !is_hung_known, "{creep:?}");
    }
}

/// A root that turns by 200 µrad·(M/8 N·m)^0.6, read with 1.5 µm of noise: of names it takes a
/// compliant root, an offset of the load and a stiffness that depends on it.
#[test]
fn a_root_that_gives_way_by_a_power_is_one_law_and_no_names() {
    let (rod, rows) = (rod(""), bench(4));
    let (linear, tip) = (compliance(&rod), rod.tip());
    let shown = |index: usize| {
        let row: &Bench = &rows[index];
        let force = Vector3::ith(row.axis.index(), row.load);
        let moment = tip.cross(&force);
        let turn = moment.normalize() * 200e-6 * (moment.norm() / 8.0).powf(0.6);
        linear * force + turn.cross(&tip)
    };
    let found = diagnose(&scattered(&rows, |_| 20.0, shown, false, 1.5), Some(&rod)).unwrap();
    assert_eq!(names(&found), Vec::<&str>::new());
    assert!(found.limits.iter().any(|limit| matches!(limit, Limitation::NamesForLaw(..))));
    let law = found.law.as_ref().unwrap().law.as_ref().unwrap();
    assert_eq!(law.site.location.to_string(), "root");
    let (_, exponent) = law.constant.as_ref().unwrap();
    assert!(exponent.low < 0.6 && 0.6 < exponent.high, "{exponent:?}");
}

/// A rod whose deflection grows with F^1.4 beside what is proportional is none whose stiffness
/// depends on the square of the load; one with F³ is.
#[test]
fn an_exponent_that_no_name_has_is_a_law() {
    let (rod, rows) = (rod(""), bench(4));
    let linear = compliance(&rod);
    let diagnosed = |share: f64, exponent: f64| {
        let shown = |index: usize| {
            let row: &Bench = &rows[index];
            let force = Vector3::ith(row.axis.index(), row.load);
            linear * force * (1.0 + share * (row.load / 12.0).powf(exponent - 1.0))
        };
        diagnose(&scattered(&rows, |_| 20.0, shown, false, 1.5), Some(&rod)).unwrap()
    };
    let found = diagnosed(0.2, 1.4);
    assert_eq!(names(&found), Vec::<&str>::new());
    let law = found.law.as_ref().unwrap().law.as_ref().unwrap();
    let (_, exponent) = law.constant.as_ref().unwrap();
    assert!(exponent.low < 1.4 && 1.4 < exponent.high, "{exponent:?}");
    assert!(found.limits.iter().any(|limit| matches!(limit, Limitation::NamesForLaw(..))));
    assert_eq!(names(&diagnosed(0.2, 3.0)), ["nonlinear_stiffness"]);
}

/// Two channels that wander off late in the recording, by 11 and by 5 µm within a tenth of it: no
/// slip at a reading of its own for each.
#[test]
fn a_drift_that_comes_late_is_no_slip() {
    let (rod, mut rows, mut now) = (rod(""), Vec::new(), 0.0);
    for trial in 1..=5 {
        for axis in Axis::ALL {
            now += 300.0;
            for load in [3.0, 6.0, 9.0, 12.0] {
                now += 45.0;
                let (zeroed, hung, time) = (now, now, now);
                rows.push(Bench { axis, load, is_unloading: false, trial, zeroed, hung, time });
            }
        }
    }
    let linear = compliance(&rod);
    let shown = |index: usize| {
        let row: &Bench = &rows[index];
        let late = 1.0 / (1.0 + (-(row.time / now - 0.7) / 0.04).exp());
        linear * Vector3::ith(row.axis.index(), row.load) + Vector3::new(0.0, 11.0, 5.0) * UM * late
    };
    let found = diagnose(&scattered(&rows, |_| 20.0, shown, false, 1.8), Some(&rod)).unwrap();
    assert!(!names(&found).contains(&"slip"), "{:?}", names(&found));
    assert!(found.diagnosis.is_mismatch());
}

/// Friction that differs from run to run has no name here; a rod much softer than its file keeps
/// its own beside it.
#[test]
fn a_soft_rod_is_named_beside_friction_that_changes() {
    let (rod, rows) = (rod(""), bench(3));
    let linear = compliance(&rod) / 0.7;
    let shown = |index: usize| {
        let row: &Bench = &rows[index];
        let run = 3 * row.trial + row.axis.index();
        let held = 0.3 + 0.25 * ((7 * run) % 11) as f64 / 10.0;
        let felt = row.load + if row.is_unloading { held } else { -held };
        linear * Vector3::ith(row.axis.index(), felt)
    };
    let found = diagnose(&recording(&rows, |_| 20.0, shown, false), Some(&rod)).unwrap();
    assert!(names(&found).contains(&"stiffness_scale"), "{:?}", names(&found));
}
