//! What the engine finds in campaigns into which something was put, and in those into which nothing
//! was.

use super::evidence::noisy;
use super::*;
use crate::diagnosis::calibration::mistakes::mend;
use crate::inference::{DiscrepancyModel, Effect, Finding, Linearised, infer};
use crate::robot::{Kinematics, Setup};

/// A coordinate's noise in the simulated campaigns, m: 30 µm of repeatability and 3 µm of sensors.
const NOISE: f64 = 17.5 * UM;

/// What is found: effects with their locations, and whether something structured is left.
fn found(campaign: &Campaign) -> (Vec<String>, Option<String>) {
    let mode = crate::calibration::default_mode(campaign);
    let (model, evidence) = modelled(campaign, mode);
    let linear = Linearised::new(&model);
    let (_, hypothesis, unknown) = infer(&linear, &evidence, crate::inference::Pairs::Screened, None);
    let name = |term: &Term| {
        let candidate = &model.candidates()[term.candidate];
        format!("{}: {}", candidate.effect, candidate.location)
    };
    let left = unknown.map(|discrepancy| match discrepancy {
        DiscrepancyModel::Curve(longer) => longer.terms.last().map(name).unwrap_or_default(),
        DiscrepancyModel::Replicates => "repeats".to_owned(),
    });
    (hypothesis.terms.iter().map(name).collect(), left)
}

/// What is named in the end, after a second look at the rows near a shift.
fn named(campaign: &Campaign) -> Vec<String> {
    let found = diagnose_as_recorded(campaign, Mode::Fea, &Options::default()).unwrap();
    let name = |finding: &Finding| format!("{}: {}", finding.effect, finding.location);
    found.diagnosis.findings.iter().map(name).collect()
}

/// Displacement of the nominal robot's tip where the joints are turned, m.
fn turned(campaign: &Campaign, by: impl Fn(usize, &mut [f64])) -> Vec<Vector3<f64>> {
    let calibration = calibrate(campaign, Mode::None, &Options::default()).unwrap();
    let setup: &Setup = &calibration.setup;
    let mut kinematics = Kinematics::new(setup);
    let mut tip = |q: &[f64]| {
        kinematics.update(q, &vec![0.0; q.len()]);
        kinematics.tip
    };
    (0..campaign.measurements.len())
        .map(|row| {
            let before = campaign.measurements.joints(row).to_vec();
            let mut after = before.clone();
            by(row, &mut after);
            tip(&after) - tip(&before)
        })
        .collect()
}

#[test]
fn noise_is_not_named() {
    let campaign = clamps(30);
    let mut named = Vec::new();
    for seed in 0..6 {
        let (effects, unknown) = found(&recorded(&campaign, &|_| Vector3::zeros(), NOISE, seed));
        named.extend(effects.into_iter().chain(unknown).map(|name| format!("seed {seed} {name}")));
    }
    assert!(named.is_empty(), "{named:?}");
}

#[test]
fn a_ripple_of_a_gear_is_found_with_its_joint_and_frequency() {
    let campaign = clamps(30);
    for joint in [1, 2] {
        let off = turned(&campaign, |_, q| q[joint] += 100e-6 * (20.0 * q[joint] + 0.4).sin());
        for seed in 0..2 {
            let (effects, _) = found(&recorded(&campaign, &|row| off[row], NOISE, seed));
            let expected = format!("transmission_error: joint {}, ", joint + 1);
            assert!(effects.len() == 1 && effects[0].starts_with(&expected), "{effects:?}");
            let cycles: f64 = effects[0][expected.len()..].split(' ').next().unwrap().parse().unwrap();
            assert!((cycles - 20.0).abs() < 0.5, "{effects:?}");
        }
    }
}

#[test]
fn a_clamp_that_moved_is_found_with_its_row() {
    let campaign = clamps(30);
    let group = |row: usize| campaign.measurements.rows[row].group;
    for seed in 0..2 {
        let moved = Vector3::new(-200.0, 150.0, 80.0) * UM;
        let shift = |row: usize| if group(row) == 2 && row >= 73 { moved } else { Vector3::zeros() };
        let (effects, _) = found(&recorded(&campaign, &shift, NOISE, seed));
        // the last row of that clamp before the shift, and its neighbours
        let of_clamp: Vec<usize> = (0..campaign.measurements.len()).filter(|&row| group(row) == 2).collect();
        let last = of_clamp.iter().rposition(|&row| row < 73).unwrap();
        let near =
            (last - 1..=last + 1).map(|k| format!("clamp_shift: clamp 3, after pose {}", of_clamp[k] + 1));
        assert!(effects.len() == 1 && near.into_iter().any(|name| name == effects[0]), "{effects:?}");
    }
}

#[test]
fn a_tool_that_slipped_is_no_drift() {
    let campaign = clamps(30);
    let calibration = calibrate(&campaign, Mode::Fea, &Options::default()).unwrap();
    let context = Context::new(&campaign, &calibration).unwrap();
    let slip = Vector3::new(60.0, -150.0, 80.0) * UM;
    let moved = |row: usize| {
        if row < 75 { Vector3::zeros() } else { context.configurations[row].flange.rotation * slip }
    };
    for seed in 0..2 {
        let places = named(&recorded(&campaign, &moved, NOISE, seed));
        assert_eq!(places, ["tool_shift: tool, after pose 75"]);
    }
}

/// After a row that a first look passes over.
#[test]
fn a_joint_that_slipped_is_no_drift() {
    let campaign = clamps(30);
    let off = turned(&campaign, |row, q| q[3] += if row < 75 { 0.0 } else { 400e-6 });
    for seed in 0..2 {
        let places = named(&recorded(&campaign, &|row| off[row], NOISE, seed));
        assert_eq!(places, ["joint_shift: joint 4, after pose 75"]);
    }
}

#[test]
fn an_arm_that_grows_is_one_cause() {
    let campaign = clamps(30);
    let calibration = calibrate(&campaign, Mode::Fea, &Options::default()).unwrap();
    let context = Context::new(&campaign, &calibration).unwrap();
    let grown = |row: usize| {
        let there = &context.configurations[row];
        (there.flange.origin - there.origin[0]) * (250e-6 * row as f64 / 149.0)
    };
    for seed in 0..2 {
        let (effects, _) = found(&recorded(&campaign, &grown, NOISE, seed));
        assert_eq!(effects, ["thermal_drift: arm, with order"]);
    }
}

/// What it moves the tip by that a 5000th of every move was still to come, m.
fn lag(campaign: &Campaign) -> Vec<Vector3<f64>> {
    let recording = &campaign.measurements;
    turned(campaign, |row, q| {
        for (j, q) in q.iter_mut().enumerate() {
            *q += 2e-4 * (recording.joints(row)[j] - recording.joints(row.saturating_sub(1))[j]);
        }
    })
}

#[test]
fn a_readback_lag_is_no_backlash() {
    let campaign = clamps(30);
    let off = lag(&campaign);
    for seed in 0..2 {
        let (effects, _) = found(&recorded(&campaign, &|row| off[row], NOISE, seed));
        assert_eq!(effects, ["readback_lag: all joints"]);
    }
}

/// Of what was measured before the arm had settled the share has the other sign.
#[test]
fn what_was_read_late_is_said() {
    let campaign = clamps(30);
    let off = lag(&campaign);
    for (sign, words) in [(1.0, "When the angles were read, "), (-1.0, "When the positions were measured, ")]
    {
        let recorded = recorded(&campaign, &|row| off[row] * sign, NOISE, 1);
        let found = diagnose_as_recorded(&recorded, Mode::Fea, &Options::default()).unwrap();
        let observed = &found.diagnosis.findings[0].description.observed;
        let is_size =
            observed.contains(" µrad per radian of the last move") && !observed.contains(['-', '−']);
        assert!(observed.starts_with(words) && is_size, "{observed}");
    }
}

/// Of the first pose nobody knows where the arm came from: what a lag may have done there is no
/// outlier, six millimetres are one.
#[test]
fn the_way_to_the_first_pose_is_unknown() {
    let campaign = clamps(30);
    let off = lag(&campaign);
    let named_with = |first: Vector3<f64>| {
        let shift = |row: usize| off[row] + if row == 0 { first } else { Vector3::zeros() };
        named(&recorded(&campaign, &shift, NOISE, 1))
    };
    assert_eq!(named_with(Vector3::new(120e-6, -110e-6, 90e-6)), ["readback_lag: all joints"]);
    let far = named_with(Vector3::new(6e-3, 0.0, 0.0));
    assert!(far.contains(&"outlier: pose 1".to_owned()) && far.len() == 2, "{far:?}");
}

/// One pose of a quiet clamp is no noise of that clamp, and beside a noisy one no heavy tail.
#[test]
fn a_misread_pose_beside_a_noisy_clamp_is_found() {
    let quiet = clamps(10);
    let rows = &quiet.measurements.rows;
    let misread = (0..rows.len()).find(|&row| rows[row].group == 3).unwrap();
    for seed in 1..=3 {
        let mut campaign = noisy(&quiet, |group| if group == 1 { 66.0 * UM } else { 16.0 * UM }, seed);
        let Targets::Points(points) = &mut campaign.measurements.targets else { panic!("points") };
        points[misread] += Vector3::new(350.0, -400.0, 250.0) * UM;
        let calibration = calibrate(&campaign, Mode::Fea, &Options::default()).unwrap();
        let of_group = &calibration.noise.of_group;
        assert!(of_group[3] < 0.7 * of_group[1] && calibration.outliers.contains(&misread), "{of_group:?}");
        let expected = format!("outlier: pose {}", campaign.measurements.rows[misread].pose);
        assert_eq!(named(&campaign), [expected], "seed {seed}");
    }
}

/// Nothing in the robot's file loads joint 4 of a symmetrical wrist, so that no calibration shows
/// how compliant it is. The forearm's centre of mass is where 20 % may be, beside its axis.
#[test]
fn what_a_centre_of_mass_loads_an_unloaded_drive_with_is_no_effect() {
    const COMPLIANCE: f64 = 120e-6;
    let clean = clamps(16);
    let calibration = calibrate(&clean, Mode::Fea, &Options::default()).unwrap();
    let context = Context::new(&clean, &calibration).unwrap();
    let forearm = clean.robot.joints[3].body.unwrap();
    let yields = |row: usize| {
        let there = &context.configurations[row];
        let aside = there.link[3].rotation.column(0) * 0.015;
        let torque = there.axis[3].dot(&aside.cross(&(there.gravity * forearm.mass)));
        there.tip_jacobian[3] * (COMPLIANCE * torque)
    };
    let most = (0..context.configurations.len()).map(|row| yields(row).norm()).fold(0.0, f64::max);
    assert!(most > 60.0 * UM, "{most}");
    for seed in [1, 2] {
        let campaign = recorded(&clean, &yields, 12.0 * UM, seed);
        let found = diagnose_as_recorded(&campaign, Mode::Fea, &Options::default()).unwrap().diagnosis;
        assert!(!found.is_mismatch(), "seed {seed}: {:?} {:?}", found.findings, found.discrepancy);
    }
}

/// What a stated tenth of the force, or the file of another rod, makes of a rod: whatever is named
/// for it, the file that may be meant is said beside it.
#[test]
fn a_force_in_kilograms_and_a_rod_of_the_folder_are_rivals_of_what_is_named_for_them() {
    let file = |text: &str| crate::rod::Rod::from_toml("rod", text).unwrap();
    let softer = ROD.replace("youngs_modulus_gpa = 193.0", "youngs_modulus_gpa = 25.0");
    assert_ne!(softer, ROD);
    let folder =
        |text: &str| Neighbours { rods: vec![("right.toml".into(), file(text))], ..Neighbours::default() };
    let said_beside = |campaign: &Campaign, others: &Neighbours| -> Vec<String> {
        let mended = mend(campaign, Mode::Fea, others, &Options::default()).unwrap();
        let findings = mended.diagnose().unwrap().diagnosis.findings;
        let of_one = |own: Finding| {
            let rivals = own.rivals.iter().map(|rival| format!("{} {}", rival.effect, rival.location));
            rivals.chain([format!("{} {}", own.effect, own.location)]).collect::<Vec<_>>()
        };
        findings.into_iter().flat_map(of_one).collect()
    };
    let said = |campaign: &Campaign| said_beside(campaign, &folder(&softer));
    let plan = || Plan { poses_per_clamp: 25, seed: 4, ..Plan::default() };
    let mut campaign = with_rods(ROD, ROD, plan());
    assert_eq!(said(&campaign), [""; 0]);
    campaign.contact_force = campaign.contact_force.map(|force| force / crate::units::STANDARD_GRAVITY);
    let of_kilograms = said(&campaign);
    assert!(of_kilograms.contains(&"unit_mistake contact_force_n".into()), "{of_kilograms:?}");
    // no unit of a force is half of a newton
    campaign.contact_force = campaign.contact_force.map(|force| 5.0 * force);
    assert!(!said(&campaign).iter().any(|own| own.starts_with("unit_mistake")));
    let of_rod = said(&with_rods(&softer, ROD, plan()));
    assert!(of_rod.contains(&"rod_mistake right.toml".into()), "{of_rod:?}");
    // the ball of another rod: its file is what is named, for the poses are those of it
    let heavier = ROD.replace("mass_g = 60", "mass_g = 180");
    assert_ne!(heavier, ROD);
    let of_ball = said_beside(&with_rods(&heavier, ROD, plan()), &folder(&heavier));
    assert_eq!(of_ball, ["rod_mistake right.toml"]);
}

/// A campaign that was recorded with the rod `actual` and has the file of [`ROD`].
fn with_rod(actual: &str, seed: u64) -> Campaign {
    assert_ne!(actual, ROD);
    with_rods(actual, ROD, Plan { poses_per_clamp: 25, seed, ..Plan::default() })
}

/// Beside half a kilogram that nobody stated the calibration makes a soft wrist, about which a mass
/// at the tip draws something else than it does.
#[test]
fn a_mass_that_the_calibration_has_hidden_in_the_wrist() {
    let heavier = ROD.replace("mass_g = 60", "mass_g = 660");
    for seed in [1, 3] {
        assert_eq!(named(&with_rod(&heavier, seed)), ["tip_mass: tip"], "seed {seed}");
    }
}

/// So does a ball that the file has and the rod had not. Once in four recordings something small
/// stands beside it; in these two once at most.
#[test]
fn a_tip_that_is_lighter_than_stated() {
    let stated = ROD.replace("mass_g = 60", "mass_g = 400");
    let mut alone = 0;
    for seed in [21, 23] {
        let campaign = with_rods(ROD, &stated, Plan { poses_per_clamp: 30, seed, ..Plan::default() });
        let found = diagnose_as_recorded(&campaign, Mode::Fea, &Options::default()).unwrap();
        let findings = &found.diagnosis.findings;
        assert_eq!(findings.first().map(|finding| finding.effect.name), Some("tip_mass"), "seed {seed}");
        let mass = &findings[0].estimates[0];
        // 95 % intervals, widened to what three standard deviations are
        assert!((mass.value + 0.34).abs() < 0.75 * (mass.high - mass.low), "seed {seed}: {mass:?}");
        alone += usize::from(findings.len() == 1);
    }
    assert!(alone >= 1, "{alone}");
}

/// So does a rod that is not as heavy as its file says. Half as heavy again is as little as a ball
/// that is.
#[test]
fn a_rod_of_another_density() {
    let dense = |density: &str| ROD.replace("density_kg_m3 = 7930", &format!("density_kg_m3 = {density}"));
    for (density, seed) in [("31720", 2), ("2700", 3)] {
        assert_eq!(named(&with_rod(&dense(density), seed)), ["rod_mass: rod"], "{density}");
    }
    let campaign = with_rod(&dense("11895"), 1);
    let found = diagnose_as_recorded(&campaign, Mode::Fea, &Options::default()).unwrap();
    let [finding] = &found.diagnosis.findings[..] else { panic!("{:?}", found.diagnosis.findings) };
    assert_eq!(finding.effect.name, "tip_mass");
    assert_eq!(finding.rivals[0].effect.name, "rod_mass");
}

/// A contact force with a number of the wrong sign bends the rod by half a millimetre. Exchanged
/// pipes, or a turned wrist with a rod turned back, would have their tip elsewhere; a mass at the
/// flange was needed only beside a heavy rod.
#[test]
fn a_force_of_a_wrong_sign_is_neither_another_rod_nor_a_mass() {
    let heavier = ROD.replace("mass_g = 60", "mass_g = 460");
    let cases =
        [(ROD, 20, 8, [-1.0, 1.0, 1.0]), (&heavier, 25, 5, [1.0, -1.0, 1.0]), (ROD, 12, 1, [-1.0, 1.0, 1.0])];
    for (actual, poses_per_clamp, seed, signs) in cases {
        let mut campaign = with_rods(actual, ROD, Plan { poses_per_clamp, seed, ..Plan::default() });
        campaign.contact_force =
            campaign.contact_force.map(|force| force.component_mul(&Vector3::from(signs)));
        let mended = mend(&campaign, Mode::Fea, &Neighbours::default(), &Options::default()).unwrap();
        let found = mended.diagnose().unwrap().diagnosis.findings;
        let name = |finding: &Finding| format!("{}: {}", finding.effect, finding.location);
        let names: Vec<String> = found.iter().map(name).collect();
        assert_eq!(names, ["contact_force_variation: all clamps"], "seed {seed}");
        // the clamps stand on one edge
        let observed = &found[0].description.observed;
        assert_eq!(observed.contains("g more at the tip would do as well"), actual != ROD, "{observed}");
    }
}

#[test]
fn what_the_calibration_absorbs_is_said() {
    let campaign = clamps(12);
    let calibration = calibrate(&campaign, Mode::Fea, &Options::default()).unwrap();
    let Prepared { model, absorbed, not_testable, .. } = Prepared::new(&campaign, calibration).unwrap();
    // joint compliances are fitted
    let compliance = &effects::joints::JOINT_COMPLIANCE.effect;
    let second = Location::Joint { joint: 1, form: None };
    let is_it = |effect: &Effect, location: &Location| effect == compliance && *location == second;
    assert!(absorbed.iter().any(|a| is_it(a.effect, &a.location) && a.unabsorbed < 0.02), "{absorbed:?}");
    assert!(model.candidates().iter().all(|c| !is_it(c.effect, &c.location)));
    let untested: Vec<&str> = not_testable.iter().map(|not| not.effect.name).collect();
    assert_eq!(untested, ["thermal_drift"]);
}

/// What no physics does, a tip that is lighter by three times what is modelled, does not make one
/// of its numbers absurd.
#[test]
fn no_mass_is_negative_and_no_drive_turns_against_its_load() {
    let campaign = clamps(30);
    let calibration = calibrate(&campaign, Mode::Fea, &Options::default()).unwrap();
    let context = Context::new(&campaign, &calibration).unwrap();
    let entries = entries(&context);
    let tip = entries.iter().find(|entry| entry.candidate.effect.name == "tip_mass").unwrap();
    let modelled = campaign.rod.as_ref().unwrap().tip_mass;
    assert_eq!(tip.candidate.parameters[0].bounds.0, -modelled);
    let mut moved = DVector::zeros(3 * campaign.measurements.len());
    tip.columns[0].add_to(&mut moved, -3.0 * modelled);
    let lighter = |row: usize| moved.fixed_rows::<3>(3 * row).into_owned();
    let campaign = recorded(&campaign, &lighter, NOISE, 1);
    let found = diagnose_as_recorded(&campaign, Mode::Fea, &Options::default()).unwrap();
    let compliance = &found.model.calibration.setup.compliance;
    assert!(compliance.iter().all(|c| *c >= 0.0), "{compliance:?}");
    for finding in &found.diagnosis.findings {
        let masses = finding.estimates.iter().filter(|estimate| estimate.name.starts_with("mass_"));
        assert!(masses.clone().all(|mass| mass.value >= -modelled && mass.low >= -modelled), "{finding:?}");
    }
}

/// What held-out poses lose most without, first.
#[test]
fn the_stronger_of_two_effects_is_said_first() {
    let campaign = clamps(24);
    let calibration = calibrate(&campaign, Mode::Fea, &Options::default()).unwrap();
    let context = Context::new(&campaign, &calibration).unwrap();
    let both = |gear: f64, coupling: f64| {
        let by = |row: usize| {
            let there = &context.configurations[row];
            let (wave, turned) = ((11.3 * there.joints[1]).sin(), there.joints[4]);
            there.tip_jacobian[1] * (gear * wave) + there.tip_jacobian[5] * (coupling * turned)
        };
        let found = recorded(&campaign, &by, 15.0 * UM, 2);
        let found = diagnose_as_recorded(&found, Mode::Fea, &Options::default()).unwrap().diagnosis;
        found.findings.iter().map(|finding| finding.effect.name).collect::<Vec<_>>()
    };
    assert_eq!(both(400e-6, 2e-4), ["transmission_error", "wrist_coupling"]);
    assert_eq!(both(60e-6, 1.5e-3), ["wrist_coupling", "transmission_error"]);
}
