//! What a hypothesis cannot follow, against a calibration that absorbs its columns too.

use super::super::next::unfollowed::Unfollowed;
use super::*;

#[test]
fn unfollowed_is_what_a_calibration_that_absorbs_the_other_hypothesis_leaves() {
    let campaign = clamps(12);
    let (model, evidence) = modelled(&campaign, Mode::Fea);
    let evidence = crate::diagnosis::calibration::evidence::unknown_beforehand(&evidence);
    let term = |effect: &str, location: &str, value: f64| {
        let candidate = find(&model, effect, location);
        Term { candidate, values: vec![value; model.candidates()[candidate].parameters.len()] }
    };
    let joint = |joint: usize| term("joint_nonlinear_stiffness", &format!("joint {joint}"), 2e-9);
    let play = term("backlash", "joint 2", 3e-4);
    let lag = term("readback_lag", "joint 3", 1e-3);
    let pairs = [
        (vec![play.clone()], vec![joint(2)]),
        (vec![joint(2), lag.clone()], vec![play.clone(), joint(2)]),
        (vec![play.clone(), lag.clone()], vec![lag.clone(), joint(3), joint(5)]),
    ];
    for (a, b) in pairs {
        let candidates = a.iter().chain(&b).map(|term| term.candidate);
        let unfollowed = Unfollowed::new(&model.terms, &evidence, candidates).of(&a, &b);
        let mut all = evidence.clone();
        for term in &b {
            let (own, first) = (model.terms.columns(term.candidate), all.nuisance.ncols());
            all.nuisance = all.nuisance.resize_horizontally(first + own.ncols(), 0.0);
            all.nuisance.columns_mut(first, own.ncols()).copy_from(&own);
        }
        let whitening = Whitening::new(&all, &all.residual);
        let expected = whitening.apply(&model.terms.response(&a)).norm_squared();
        assert!(expected > 0.0);
        assert!((unfollowed / expected - 1.0).abs() < 1e-6, "{unfollowed:e} for {expected:e}");
    }
    // what a hypothesis holds itself it follows
    let own = vec![play, lag];
    let candidates = own.iter().map(|term| term.candidate);
    let unfollowed = Unfollowed::new(&model.terms, &evidence, candidates).of(&own, &own);
    let whole = model.terms.response(&own).norm_squared();
    assert!(unfollowed < 1e-9 * whole, "{unfollowed:e} of {whole:e}");
}
