//! Two models of one recording: which of them makes it more probable.
//!
//! Each may use the effects that it has. The scatter is that of the first, for both: a probability
//! means something only beside others of the same data with the same errors.

use nalgebra::DVector;

use crate::inference::columns::background;
use crate::inference::columns::linearised::Linearised;
use crate::inference::noise::whitening::Whitening;
use crate::inference::search::Search;
use crate::inference::search::selection::{DiscrepancyModel, Pairs};
use crate::inference::{Diagnosis, Evidence, ForwardModel, Term};

/// The first model with its recording, which others are compared with.
#[non_exhaustive]
pub struct Compared {
    /// Of shared and own errors, as the best hypothesis leaves them.
    ratio: f64,
    correlation: f64,
    /// What goes with the size of offsets that data share, m.
    noise: f64,
    /// Ln of the probability that the recording then has.
    log_probability: f64,
}

impl Compared {
    /// The best hypothesis of a model, what it leaves unexplained included: that of its diagnosis,
    /// where this is the better one.
    pub fn new(model: &dyn ForwardModel, evidence: &Evidence, found: &Diagnosis) -> Compared {
        let (known, noise) = (&found.hypothesis.terms, found.noise);
        let own = plain(evidence);
        let before = best(model, &own, known, noise);
        // what the best hypothesis leaves is scatter
        let whitening = Whitening::new(&background::folded(&own).evidence, &before.left);
        let (ratio, correlation) = (whitening.ratio, whitening.correlation);
        let unsettled = Compared { ratio, correlation, noise, log_probability: 0.0 };
        let log_probability = best(model, &unsettled.alike(own), known, noise).log_probability;
        Compared { log_probability, ..unsettled }
    }

    /// Ln of how many times more probable the recording is by the best hypothesis of another
    /// model. Both evidences hold the same data.
    pub fn log_odds(&self, other: &dyn ForwardModel, evidence: &Evidence) -> f64 {
        best(other, &self.alike(plain(evidence)), &[], self.noise).log_probability - self.log_probability
    }

    /// The same data with errors that scatter alike.
    fn alike(&self, evidence: Evidence) -> Evidence {
        Evidence { shared_ratio: Some(self.ratio), correlation: Some(self.correlation), ..evidence }
    }
}

fn plain(evidence: &Evidence) -> Evidence {
    Evidence { is_robust: false, weight: evidence.even_weight(), information: 1.0, ..evidence.clone() }
}

struct Best {
    log_probability: f64,
    left: DVector<f64>,
}

fn best(model: &dyn ForwardModel, evidence: &Evidence, known: &[Term], noise: f64) -> Best {
    let model = &Linearised::new(model);
    let mut folded = background::folded(evidence);
    background::size_offsets(&mut folded.evidence, noise);
    let search = Search::new(model, &folded.evidence, &[]);
    let (hypothesis, left_over) = search.best(Pairs::Screened);
    let mut longest = match left_over {
        Some(DiscrepancyModel::Curve(longer)) => longer,
        _ => hypothesis,
    };
    // one search without weights may have stopped beside what is known
    if !known.is_empty() {
        let fitted = search.fit(known);
        if fitted.log_probability > longest.log_probability {
            longest = fitted;
        }
    }
    let response = model.response(&longest.terms);
    let left = &folded.evidence.residual - search.predicted(&longest, &folded.evidence, &response);
    Best { log_probability: longest.log_probability, left }
}
