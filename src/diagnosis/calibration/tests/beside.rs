//! The robot that is calibrated beside what was found, against what was found about another.

use super::*;
use crate::diagnosis::calibration::diagnose::beside::{Again, calibrated_beside};
use crate::diagnosis::calibration::diagnose::hung::beside_hidden_masses;
use crate::diagnosis::calibration::diagnose::prepared::FirstLook;
use crate::inference::sketch;

/// The same with a base that moves by a tenth of a millimetre after pose 30, on clamps that stand
/// aside by so much, m.
fn on_clamps_aside(clean: &Campaign, aside: f64) -> Campaign {
    let mut random = Random::seeded(5, 0);
    let clamps = clean.measurements.groups.len();
    let off: Vec<_> = (0..clamps).map(|_| Vector3::from_fn(|_, _| aside * random.normal())).collect();
    let moved = |row: usize| if row < 30 { Vector3::zeros() } else { Vector3::new(80.0, -60.0, 0.0) * UM };
    let group = |row: usize| clean.measurements.rows[row].group;
    recorded(clean, &|row| off[group(row)] + moved(row), 8.0 * UM, 6)
}

/// A calibration knows nothing of where clamps may stand: that it leaves more than a hypothesis
/// beside which they do says nothing against that. Where nobody said so, it leaves as much.
#[test]
fn clamps_that_may_stand_aside_are_no_other_robot() {
    let clean = clamps(12);
    for uncertainty in [None, Some(60.0 * UM)] {
        let aside = uncertainty.unwrap_or_default();
        let campaign = Campaign { clamp_uncertainty: uncertainty, ..on_clamps_aside(&clean, aside) };
        let calibration = calibrate(&campaign, Mode::Fea, &Options::default()).unwrap();
        let prepared = Prepared::new(&campaign, calibration).unwrap();
        let found = sketch(&prepared.model, &prepared.evidence);
        assert!(!found.hypothesis.terms.is_empty(), "{uncertainty:?}");
        let again = calibrated_beside(&prepared, &found.hypothesis, &found.left).unwrap();
        assert!(!matches!(again, Again::Far(_)), "{uncertainty:?}");
    }
}

/// Of a base that drifts, and tilts as no base does: what is found about the robot that was
/// calibrated beside the drift is less probable than what is found about the one as it was
/// calibrated, which is one of those that are compared.
#[test]
fn the_robot_as_it_was_calibrated_is_compared_too() {
    let clean = clamps(25);
    let (model, _) = modelled(&clean, Mode::Fea);
    let candidate = find(&model, "gravity_tilt", "base");
    let tilt = model.by_row(&model.terms.response(&[Term { candidate, values: vec![-4.5e-6] }]));
    let drift = Vector3::new(100.0, 50.0, -50.0) * UM;
    let share = |row: usize| row as f64 / clean.measurements.rows.len() as f64;
    let campaign = recorded(&clean, &|row| tilt[row] + drift * share(row), 30.0 * UM, 5);
    let calibration = calibrate(&campaign, Mode::Fea, &Options::default()).unwrap();
    let plain = Prepared::new(&campaign, calibration.clone()).unwrap();
    let first = sketch(&plain.model, &plain.evidence);
    let beside = calibrated_beside(&plain, &first.hypothesis, &first.left).unwrap();
    let beside = beside.another().expect("another robot");
    let left = Some(plain.model.by_row(&first.left));
    let look = FirstLook { left, carried: beside.carried, ..FirstLook::default() };
    let moved = Prepared::about(&campaign, calibration, beside.about, &look).unwrap();
    let probability = |own: &Prepared| sketch(&own.model, &own.evidence).log_probability;
    assert!(probability(&moved) < first.log_probability - 3.0);
    let best = beside_hidden_masses(&campaign, moved, &look).unwrap();
    assert!(best.is_another && probability(&best.prepared) > first.log_probability - 0.1);
}
