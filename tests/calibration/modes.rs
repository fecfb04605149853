//! Modes of compensation: each needs its files, the better one wins, and the loop comes to rest
//! where its equations hold.

use nalgebra::{UnitQuaternion, Vector3};
use rodcal::calibration::simulate::Plan;
use rodcal::calibration::{
    Calibration, CompareOptions, Comparison, Mode, Options, calibrate, compare, default_mode, modes,
};
use rodcal::units::UM;

use super::lab::{PHYSICS, isometry};
use super::recovery::Clamped;
use super::rods;
use super::simulated::Simulator;

/// A campaign with a rod that is 1.3 times as soft as its model, and that sags by some millimetres.
fn soft() -> Simulator {
    let mut plan = Plan::of_poses(16, 60).with_rod_factor(1.3);
    plan.errors.joint_turn = 0.3e-3;
    (plan.repeatability, plan.scanner_noise) = (15.0 * UM, 20.0 * UM);
    let thin = rods::SOFT.replace("inner_diameter_mm = 12", "inner_diameter_mm = 7");
    Simulator::of(&thin.replace("outer_diameter_mm = 16", "outer_diameter_mm = 10"), plan)
}

fn of_mode<'a, 'c>(comparison: &'a Comparison<'c>, mode: Mode) -> (usize, &'a Calibration<'c>) {
    comparison.calibrations.iter().enumerate().find(|(_, c)| c.mode == mode).unwrap()
}

/// The truth is FEA × 1.3, and only a rig knows.
#[test]
fn what_was_measured_beats_what_was_modelled_beats_nothing() {
    let simulator = soft();
    let (_, campaign) = simulator.run(7);
    assert_eq!(modes(&campaign), Mode::ALL);
    let options = CompareOptions::default().with_draws(30);
    let comparison = compare(&campaign, &options, &|_| ()).unwrap();
    let mean = |mode| comparison.summary(of_mode(&comparison, mode).0).mean;
    let residual = |mode| {
        let residuals = of_mode(&comparison, mode).1.residuals();
        residuals.iter().sum::<f64>() / residuals.len() as f64
    };
    assert!(mean(Mode::Meas) < mean(Mode::Fea) && mean(Mode::Fea) < mean(Mode::None));
    assert!(residual(Mode::Meas) < residual(Mode::Fea) && residual(Mode::Fea) < residual(Mode::None));
    let difference = |mode, against| {
        *comparison.differences.iter().find(|d| d.mode == mode && d.against == against).unwrap()
    };
    for (mode, against) in [(Mode::Meas, Mode::None), (Mode::Fea, Mode::None)] {
        let d = difference(mode, against);
        assert!(d.is_significant, "{d:?}");
        assert!(d.interval.1 < 0.0 && d.interval.0 < d.mean && d.mean < d.interval.1, "{d:?}");
        assert!((d.mean - (mean(mode) - mean(against))).abs() < 1e-12);
    }
    // what remains in meas is repeatability: the rod is known to a percent
    let noise = of_mode(&comparison, Mode::Meas).1.noise.pooled;
    assert!((noise / 9.2e-6 - 1.0).abs() < 0.2, "{noise}");
}

#[test]
fn a_mode_without_its_files_says_what_is_missing() {
    let simulator = Simulator::new();
    let (_, whole) = simulator.run(1);
    assert_eq!(default_mode(&whole), Mode::Meas);
    let mut without_rig = whole.clone();
    without_rig.readings = None;
    assert_eq!(default_mode(&without_rig), Mode::Fea);
    assert_eq!(modes(&without_rig), [Mode::None, Mode::Calc, Mode::Fea]);
    let words = |campaign, mode| {
        let error = calibrate(campaign, mode, &Options::default()).unwrap_err();
        format!("{error} {}", error.hint().unwrap_or_default())
    };
    let told = words(&without_rig, Mode::Meas);
    assert!(told.contains("mode meas") && told.contains("rig = "), "{told}");
    let mut without_rod = without_rig.clone();
    without_rod.rod = None;
    assert_eq!(default_mode(&without_rod), Mode::None);
    assert_eq!(modes(&without_rod), [Mode::None]);
    for mode in [Mode::Calc, Mode::Fea, Mode::Meas] {
        let told = words(&without_rod, mode);
        assert!(told.contains(mode.name()) && told.contains("rod = "), "{told}");
    }
}

/// Every pass of the loop is on record, each nearer to rest than the one before, and at rest the
/// deflections are those that C^F and C^g give for the calibrated robot, by the laboratory's own
/// arithmetic.
#[test]
fn at_rest_the_deflections_satisfy_their_equation() {
    let mut made = Clamped::new(PHYSICS);
    made.noise = 20e-6;
    let campaign = made.campaign();
    let found = calibrate(&campaign, Mode::Calc, &Options::default()).unwrap();
    assert!(found.is_converged);
    let changes: Vec<f64> = found.passes.iter().map(|pass| pass.change).collect();
    assert!(changes.len() >= 3, "{changes:?}");
    assert!(changes[0] > 0.5e-3, "a soft rod bends by most of a millimetre: {changes:?}");
    assert!(changes.windows(2).all(|pair| pair[1] < 0.1 * pair[0]), "{changes:?}");
    assert!(*changes.last().unwrap() < 1e-9, "{changes:?}");
    let last = found.passes.last().unwrap();
    let squares: f64 = found.residuals().iter().map(|r| r * r).sum();
    assert!((last.rms - (squares / 75.0).sqrt()).abs() < 1e-9);

    // the laboratory takes the place that was found, and bends the same rod
    let mut lab = made.lab.clone();
    lab.robot = found.setup.calibrated();
    lab.base = isometry(&found.setup.base());
    lab.tool = found.setup.tool;
    let mut straight = lab.clone();
    straight.laws.sag = 0.0;
    straight.laws.push = 0.0;
    for (row, (clamp, q)) in made.poses.iter().enumerate() {
        let device: &UnitQuaternion<f64> = &made.devices[*clamp].rotation;
        let bent: Vector3<f64> = lab.tip(q, device) - straight.tip(q, device);
        assert!((bent - found.deflections[row]).norm() < 2e-9, "{bent} {}", found.deflections[row]);
        assert!((straight.tip(q, device) - found.tips[row]).norm() < 2e-9);
    }
    let mode_none = calibrate(&campaign, Mode::None, &Options::default()).unwrap();
    assert!(mode_none.deflections.iter().all(|d| d.norm() == 0.0));
}
