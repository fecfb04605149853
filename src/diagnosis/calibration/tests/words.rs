//! Every effect of the library has its words.

use nalgebra::DMatrix;

use super::*;
use crate::diagnosis::Finding;
use crate::diagnosis::calibration::findings::mismatches;
use crate::diagnosis::calibration::{cause, cause_at, diagnose};

/// The diagnosis as if one candidate had been found, at its usual size.
fn as_if<'c>(
    found: &CalibrationDiagnosis<'c>,
    campaign: &Campaign,
    candidate: usize,
) -> CalibrationDiagnosis<'c> {
    let of = &found.world.candidates()[candidate];
    let values: Vec<f64> = of.parameters.iter().map(|p| p.neutral + 2.0 * p.size).collect();
    let sizes: Vec<f64> = of.parameters.iter().map(|p| (0.1 * p.size).powi(2)).collect();
    let interval = |p: &crate::diagnosis::EffectParameter| {
        (p.neutral + 2.0 * p.size, p.neutral + 1.8 * p.size, p.neutral + 2.2 * p.size)
    };
    let mut found = found.clone();
    found.diagnosis.story.covariance = DMatrix::from_diagonal(&DVector::from_vec(sizes));
    found.diagnosis.findings = vec![Finding {
        chosen: Chosen { candidate, values },
        place: of.location.clone(),
        parameters: of.parameters.iter().map(interval).collect(),
        first: 0,
        reach: 2.0,
        p_value: 0.0,
        rms: 0.0,
        rivals: Vec::new(),
    }];
    found.mismatches = mismatches(&found.world, campaign, &found.diagnosis);
    found
}

#[test]
fn every_effect_of_the_library_has_words_and_its_number() {
    let mut campaign = clamps(12);
    for (k, row) in campaign.measurements.rows.iter_mut().enumerate() {
        (row.time, row.temperature) = (Some(k as f64 * 30.0), Some(20.0 + k as f64 / 100.0));
    }
    let found = diagnose(&campaign, Mode::None, &Options::default()).unwrap();
    let mut effects = Vec::new();
    for (index, candidate) in found.world.candidates().iter().enumerate().filter(|(_, c)| !c.is_unknown) {
        let effect = candidate.effect.as_str();
        assert!(cause(effect).is_some(), "{effect} has no words");
        let found = as_if(&found, &campaign, index);
        let words = found.words(&found.mismatches[0]).to_string();
        let is_bare = candidate.location.ends_with("masses unknown");
        assert!(is_bare || words.contains('±') || words.contains(" to "), "{effect}: {words}");
        assert!(!words.contains("NaN") && !words.contains('_'), "{effect}: {words}");
        assert!(!cause_at(effect, &candidate.location).contains('_'));
        if !effects.contains(&effect) {
            effects.push(effect);
        }
    }
    for absorbed in &found.world.absorbed {
        assert!(cause(&absorbed.effect).is_some(), "{}", absorbed.effect);
    }
    assert!(cause("socket_shift").is_some() && effects.len() >= 15, "{effects:?}");
}
