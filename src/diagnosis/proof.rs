//! Held-out proof: the whole selection is repeated without a fold, and its story predicts that fold.

use nalgebra::DVector;

use super::judgement::judged;
use super::linear::Linearised;
use super::{Chosen, Evidence, World};
use crate::parallel::in_parallel;
use crate::statistics::{Random, percentile_interval};

/// Squares of a fold before and after, and how many data they are of.
type Squares = (f64, f64, f64);

/// Draws of the bootstrap over folds.
const DRAWS: usize = 1000;

/// Errors of data that the model had not seen.
#[derive(Debug, Clone)]
pub struct Proof {
    /// Root mean square of what the base model leaves of held-out data.
    pub before: f64,
    /// And of what the story found without them leaves.
    pub after: f64,
    /// 1 − after²/before², with its 95 % interval by drawing folds again; `None` with fewer than three folds.
    pub gain: f64,
    /// See `gain`.
    pub gain_interval: Option<(f64, f64)>,
    /// Stories of the folds.
    pub stories: Vec<Vec<Chosen>>,
    /// What the base model leaves of each datum while it is held out; NaN for data that never are.
    pub errors_before: DVector<f64>,
    /// And what the story of its fold leaves.
    pub errors_after: DVector<f64>,
}

impl Evidence {
    /// The data of these rows.
    pub fn part(&self, rows: &[usize]) -> Evidence {
        let pick = |of: &[usize]| rows.iter().map(|&row| of[row]).collect();
        Evidence {
            residual: self.residual.select_rows(rows),
            nuisance: self.nuisance.select_rows(rows),
            background: self.background.select_rows(rows),
            cell: pick(&self.cell),
            shared: pick(&self.shared),
            fold: pick(&self.fold),
            session: pick(&self.session),
            level: pick(&self.level),
            resolution: self.resolution,
            covariates: Vec::new(),
        }
    }
}

/// The story that the data `kept` tell by themselves, and what the base model and that story, fitted to them, leave of all data.
pub(super) fn learned(
    world: &Linearised<'_>,
    evidence: &Evidence,
    kept: &[usize],
) -> (DVector<f64>, DVector<f64>, Vec<Chosen>) {
    let (part, training) = (world.part(kept), evidence.part(kept));
    let (search, story, _) = judged(&part, &training);
    let none = search.told(&search.fit(&[]), evidence, &DVector::zeros(evidence.residual.len()));
    let all = search.told(&story, evidence, &world.change(&story.chosen));
    (&evidence.residual - none, &evidence.residual - all, story.chosen)
}

/// Selects without each fold in turn, and predicts it. `None` with fewer than two folds.
pub fn prove(world: &Linearised<'_>, evidence: &Evidence) -> Option<Proof> {
    let mut folds: Vec<usize> = evidence.fold.clone();
    folds.sort_unstable();
    folds.dedup();
    folds.retain(|&fold| fold != Evidence::KEPT);
    if folds.len() < 2 {
        return None;
    }
    let n = evidence.residual.len();
    let by_fold = in_parallel(folds.len(), |k| {
        let of = |held_out: bool| -> Vec<usize> {
            (0..n).filter(|&row| (evidence.fold[row] == folds[k]) == held_out).collect()
        };
        let (kept, held_out) = (of(false), of(true));
        let (before, after, story) = learned(world, evidence, &kept);
        (held_out.clone(), before.select_rows(&held_out), after.select_rows(&held_out), story)
    });
    let (mut errors_before, mut errors_after) = (DVector::repeat(n, f64::NAN), DVector::repeat(n, f64::NAN));
    let (mut squares, mut stories): (Vec<Squares>, Vec<Vec<Chosen>>) = (Vec::new(), Vec::new());
    for (held_out, before, after, story) in by_fold {
        squares.push((before.norm_squared(), after.norm_squared(), held_out.len() as f64));
        stories.push(story);
        for (k, &row) in held_out.iter().enumerate() {
            (errors_before[row], errors_after[row]) = (before[k], after[k]);
        }
    }
    let total = |of: &dyn Fn(&Squares) -> f64| squares.iter().map(of).sum::<f64>();
    let count = total(&|s| s.2);
    let gain = 1.0 - total(&|s| s.1) / total(&|s| s.0).max(f64::MIN_POSITIVE);
    Some(Proof {
        before: (total(&|s| s.0) / count).sqrt(),
        after: (total(&|s| s.1) / count).sqrt(),
        gain,
        gain_interval: (squares.len() > 2).then(|| interval(&squares)).flatten(),
        stories,
        errors_before,
        errors_after,
    })
}

fn interval(squares: &[Squares]) -> Option<(f64, f64)> {
    let mut random = Random::seeded(0, 0);
    let mut gains: Vec<f64> = (0..DRAWS)
        .map(|_| {
            let (mut before, mut after) = (0.0, 0.0);
            for _ in squares {
                let (b, a, _) = squares[random.index(squares.len())];
                before += b;
                after += a;
            }
            1.0 - after / before.max(f64::MIN_POSITIVE)
        })
        .collect();
    percentile_interval(&mut gains, 0.95)
}
