//! Every effect of the registry has its words.

use nalgebra::DMatrix;

use super::*;
use crate::inference::{
    Description, Effect, Estimate, Finding, FindingPart, Hypothesis, Kind, Parameter, WrittenTo,
};

/// A finding of one candidate, as if it had been found at its usual size.
fn as_if(model: &CalibrationModel, candidate: usize) -> Finding {
    let found = &model.candidates()[candidate];
    let values: Vec<f64> = found.parameters.iter().map(|p| p.neutral + 2.0 * p.size).collect();
    let variances = found.parameters.iter().map(|p| (0.1 * p.size).powi(2)).collect();
    let covariance = DMatrix::from_diagonal(&DVector::from_vec(variances));
    let estimate = |p: &Parameter| Estimate {
        name: p.name.clone(),
        unit: p.unit,
        value: p.neutral + 2.0 * p.size,
        low: p.neutral + 1.8 * p.size,
        high: p.neutral + 2.2 * p.size,
    };
    let term = Term { candidate, values };
    let part = FindingPart {
        term: term.clone(),
        location: found.location.clone(),
        estimates: found.parameters.iter().map(estimate).collect(),
        first: 0,
        covariance: covariance.clone(),
        coverage_factor: 2.0,
        p_value: 0.0,
        explains: 0.0,
        rivals: Vec::new(),
        takes_numbers_place: false,
        unnamed: None,
    };
    let hypothesis = Hypothesis {
        terms: vec![term],
        log_probability: 0.0,
        sigma: 1.0,
        covariance,
        background: DVector::zeros(0),
        background_covariance: nalgebra::DMatrix::zeros(0, 0),
        determined: 1.0,
    };
    let parts = vec![part];
    let mut finding = Finding {
        effect: found.effect,
        location: found.location.place(),
        estimates: model.estimates(&parts, &hypothesis),
        place: model.place_among_estimates(&parts),
        description: Description { observed: String::new(), cause: String::new() },
        rivals: Vec::new(),
        unnamed: None,
        p_value: 0.0,
        explains: 0.0,
        found_in_folds: None,
        held_out_loss: None,
        written_to: found.effect.written_to,
        next: None,
        parts,
    };
    finding.description = model.describe(&finding);
    finding
}

/// The campaign with times and temperatures.
fn clocked() -> Campaign {
    let mut campaign = clamps(12);
    for (k, row) in campaign.measurements.rows.iter_mut().enumerate() {
        (row.time, row.temperature) = (Some(k as f64 * 30.0), Some(20.0 + k as f64 / 10.0));
    }
    campaign
}

#[test]
fn every_effect_has_words_and_its_number() {
    let campaign = clocked();
    let (model, _) = modelled(&campaign, Mode::None);
    let mut effects = Vec::new();
    let named = model.candidates().iter().enumerate().filter(|(_, c)| !c.is_nonparametric);
    for (index, candidate) in named {
        let effect = candidate.effect;
        let finding = as_if(&model, index);
        let text = finding.description.to_string();
        let is_bare = matches!(model.law(index), Law::MassesUnknown(_));
        assert!(is_bare || text.contains('±') || text.contains(" to "), "{effect}: {text}");
        assert!(!text.contains("NaN") && !text.contains('_'), "{effect}: {text}");
        assert!(!(effect.cause_at)(&candidate.location).contains('_'));
        if !effects.contains(&effect) {
            effects.push(effect);
        }
    }
    assert!(effects.len() >= 15, "{effects:?}");
}

#[test]
fn sentences_are_those_of_the_laws() {
    let campaign = clocked();
    let (model, _) = modelled(&campaign, Mode::None);
    let described =
        |effect: &str, location: &str| as_if(&model, find(&model, effect, location)).description.to_string();
    let cases = [
        (
            "backlash",
            "joint 4, by approach",
            "Joint 4 has 300 ± 30 µrad of play, taken up according to the direction of approach: play in its gear",
        ),
        (
            "backlash",
            "joint 5",
            "Joint 5 has 300 ± 30 µrad of play, taken up on the side that its load pulls to: play in its gear",
        ),
        (
            "backlash",
            "joint 6",
            "Joint 6 has 300 ± 30 µrad of play, taken up on the side that its load pulls to, or the \
             tool is loose in its mount: play in its gear",
        ),
        (
            "thermal_drift",
            "tool, with temperature",
            "The tool drifts by 35 ± 2 µm per kelvin with temperature: thermal drift",
        ),
        (
            "thermal_drift",
            "base, turning, with order",
            "The base turns against what measures it by 69 ± 4 µrad with order: thermal drift",
        ),
        (
            "clamp_drift",
            "clamp 2, evenly over its poses",
            "Clamp 2 drifts by 346 ± 20 µm, evenly over its poses: a clamp that settles, or its sensors' \
             zero that drifts",
        ),
        (
            "base_shift",
            "after pose 20",
            "The robot moved on its base by 1732 ± 100 µm and turned by 1732 ± 100 µrad after pose 20: a \
             slip of the robot on its base",
        ),
        (
            "clamp_shift",
            "clamp 2, after pose 16",
            "Clamp 2 moved by 1732 ± 100 µm after pose 16: a knock or a slip of the clamp",
        ),
        (
            "clamp_pose",
            "clamp 2",
            "Clamp 2 is 346 ± 20 µm away from its position in the campaign: a wrong clamp position in \
             the campaign",
        ),
        (
            "joint_shift",
            "joint 4, after pose 20",
            "The zero of joint 4 moved by 1000 ± 100 µrad after pose 20: a slip of the joint or of its encoder",
        ),
        (
            "thermal_drift",
            "arm, with temperature",
            "The arm grows by 20 ± 2 µm/m per kelvin with temperature, all its links alike: thermal drift",
        ),
        ("outlier", "pose 7", "Pose 7 is off by 1732 ± 100 µm: a misread or disturbed pose"),
        (
            "wrist_coupling",
            "joint 5 to 6",
            "Joint 6 turns by 200 ± 20 µrad for every radian of joint 5: coupled wrist gears",
        ),
        (
            "encoder_scale",
            "joint 4",
            "Joint 4 turns 200 ± 20 µrad per radian more than its encoder shows: the scale of its encoder",
        ),
        (
            "readback_lag",
            "all joints",
            "When the angles were read, 600 ± 60 µrad per radian of the last move of every joint were \
             still to come: readings before the arm had settled",
        ),
        (
            "rod_stiffness",
            "rod, under the contact force",
            "The rod is 100 ± 20 % softer than its model under the contact force: a rod stiffness that \
             differs from its model",
        ),
    ];
    for (effect, location, expected) in cases {
        assert_eq!(described(effect, location), expected);
    }
}

#[test]
fn a_record_says_everything_of_its_effect() {
    let mut names: Vec<&str> = registry::ALL.iter().map(|known| known.effect.name).collect();
    names.sort_unstable();
    names.dedup();
    assert_eq!(names.len(), registry::ALL.len());
    for known in registry::ALL {
        let Effect { name, summary, formula, prior, parameters, needs, cause, .. } = &known.effect;
        for text in [summary, formula, prior, needs, cause] {
            assert!(!text.is_empty(), "{name}");
        }
        assert!(!parameters.is_empty() && !cause.contains('_'), "{name}");
        assert_eq!(registry::record(&known.effect).map(|own| own.effect.name), Some(*name));
        // what happened after one pose is marked there, and only that
        let place = Location::JointAfter { joint: 0, row: 0, after: "pose 1".into() };
        assert_eq!((known.event)(&place).is_some(), known.effect.kind == Kind::Event, "{name}");
    }
}

/// The candidates that are written are those whose record says so.
#[test]
fn findings_go_where_their_record_says() {
    let campaign = clocked();
    let (model, _) = modelled(&campaign, Mode::Fea);
    for (index, candidate) in model.candidates().iter().enumerate().filter(|(_, c)| !c.is_nonparametric) {
        let finding = as_if(&model, index);
        let mut extended = campaign.clone();
        let record = registry::record(candidate.effect).unwrap();
        let written = (record.write)(&finding, &model, &mut extended);
        let expected = candidate.effect.written_to;
        assert_eq!(written, expected, "{} {}", candidate.effect, candidate.location);
        let is_same_robot = extended.robot.effects == campaign.robot.effects
            && extended.robot.joints == campaign.robot.joints;
        assert_eq!(is_same_robot, written != WrittenTo::Model, "{}", candidate.effect);
        let is_same_recording = extended.measurements == campaign.measurements;
        assert_eq!(is_same_recording, written != WrittenTo::Recording, "{}", candidate.effect);
    }
}

/// Weights that nobody knows: each number is written at the frame that its name says, and frames
/// go with their parameters where one does nothing.
#[test]
fn a_weight_is_written_at_the_frame_of_its_number() {
    let mut campaign = clamps(12);
    campaign.robot.joints.iter_mut().for_each(|joint| joint.body = None);
    let (model, _) = modelled(&campaign, Mode::None);
    let mut count = 0;
    for (index, candidate) in model.candidates().iter().enumerate() {
        let Law::MassesUnknown(frames) = model.law(index) else { continue };
        let named = |at: &Option<usize>| {
            at.map_or("flange_urad_per_m".to_owned(), |k| format!("joint_{}_urad_per_m", k + 1))
        };
        let names: Vec<String> = candidate.parameters.iter().map(|known| known.name.clone()).collect();
        assert_eq!(frames.iter().map(named).collect::<Vec<_>>(), names);
        let mut extended = campaign.clone();
        let record = registry::record(candidate.effect).unwrap();
        (record.write)(&as_if(&model, index), &model, &mut extended);
        let at = |effect: &crate::robot::Effect| match effect {
            crate::robot::Effect::Weight { joint, at, .. } if Some(*joint) == candidate.location.joint() => {
                *at
            }
            other => panic!("{other:?}"),
        };
        assert_eq!(&extended.robot.effects.iter().map(at).collect::<Vec<_>>(), frames);
        count += frames.len();
    }
    assert!(count > 3, "{count}");
    let law = Law::MassesUnknown(vec![Some(3), Some(4), None]);
    assert_eq!(law.of_parameters(&[true, false, true]), Law::MassesUnknown(vec![Some(3), None]));
}
