//! Two models of one recording: which of them makes it more probable.
//!
//! Each may use the effects that it has. The scatter is that of the first, for both: a probability
//! means something only beside others of the same data with the same errors.

use nalgebra::DVector;

use super::background;
use super::linearised::Linearised;
use super::search::Search;
use super::selection::{DiscrepancyModel, Pairs};
use super::whitening::Whitening;
use super::{Evidence, ForwardModel};

/// Ln of how many times more probable a recording is by the best hypothesis of the second model,
/// what it leaves unexplained included, than by that of the first. Both evidences hold the same
/// data.
pub fn log_odds(
    (first, own): (&dyn ForwardModel, &Evidence),
    (second, other): (&dyn ForwardModel, &Evidence),
) -> f64 {
    let plain = |evidence: &Evidence| Evidence {
        is_robust: false,
        weight: vec![1.0; evidence.residual.len()],
        information: 1.0,
        ..evidence.clone()
    };
    let (own, other) = (plain(own), plain(other));
    let before = best(first, &own);
    // what the best hypothesis leaves is scatter
    let whitening = Whitening::new(&background::folded(&own).evidence, &before.left);
    let alike = |evidence: &Evidence| Evidence {
        shared_ratio: Some(whitening.ratio),
        correlation: Some(whitening.correlation),
        ..evidence.clone()
    };
    best(second, &alike(&other)).log_probability - best(first, &alike(&own)).log_probability
}

struct Best {
    log_probability: f64,
    left: DVector<f64>,
}

fn best(model: &dyn ForwardModel, evidence: &Evidence) -> Best {
    let model = &Linearised::new(model);
    let folded = background::folded(evidence);
    let search = Search::new(model, &folded.evidence, &[]);
    let (hypothesis, left_over) = search.best(Pairs::Screened);
    let longest = match left_over {
        Some(DiscrepancyModel::Curve(longer)) => longer,
        _ => hypothesis,
    };
    let response = model.response(&longest.terms);
    let left = &folded.evidence.residual - search.predicted(&longest, &folded.evidence, &response);
    Best { log_probability: longest.log_probability, left }
}
