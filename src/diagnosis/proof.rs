//! Held-out proof: the whole selection is repeated without a fold, and its story predicts that fold.

use nalgebra::{DMatrix, DVector};

use super::selection::Search;
use super::{Candidate, Chosen, Evidence, World};
use crate::statistics::{Random, percentile_interval};

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
}

/// Some of the data of a world.
struct Part<'a> {
    world: &'a dyn World,
    rows: &'a [usize],
}

impl World for Part<'_> {
    fn candidates(&self) -> &[Candidate] {
        self.world.candidates()
    }

    fn change(&self, story: &[Chosen]) -> DVector<f64> {
        let whole = self.world.change(story);
        DVector::from_fn(self.rows.len(), |i, _| whole[self.rows[i]])
    }
}

impl Evidence {
    /// The data of these rows.
    pub fn part(&self, rows: &[usize]) -> Evidence {
        let pick = |of: &[usize]| rows.iter().map(|&row| of[row]).collect();
        Evidence {
            residual: DVector::from_fn(rows.len(), |i, _| self.residual[rows[i]]),
            nuisance: DMatrix::from_fn(rows.len(), self.nuisance.ncols(), |i, k| self.nuisance[(rows[i], k)]),
            cell: pick(&self.cell),
            shared: pick(&self.shared),
            fold: pick(&self.fold),
            resolution: self.resolution,
            covariates: Vec::new(),
        }
    }
}

/// Selects without each fold in turn, and predicts it. `None` with fewer than two folds.
pub fn prove(world: &dyn World, evidence: &Evidence) -> Option<Proof> {
    let mut folds: Vec<usize> = evidence.fold.clone();
    folds.sort_unstable();
    folds.dedup();
    folds.retain(|&fold| fold != Evidence::KEPT);
    if folds.len() < 2 {
        return None;
    }
    let n = evidence.residual.len();
    // squares before and after, by fold
    let mut squares = Vec::new();
    let mut stories = Vec::new();
    for &fold in &folds {
        let of = |held_out: bool| -> Vec<usize> {
            (0..n).filter(|&row| (evidence.fold[row] == fold) == held_out).collect()
        };
        let (kept, held_out) = (of(false), of(true));
        let part = Part { world, rows: &kept };
        let training = evidence.part(&kept);
        let story = Search::new(&part, &training, &[]).best().0.chosen;
        let base = absorbed(evidence, &training.residual, &kept);
        let told = world.change(&story);
        let left: DVector<f64> = DVector::from_fn(kept.len(), |i, _| training.residual[i] - told[kept[i]]);
        let with = absorbed(evidence, &left, &kept);
        let square =
            |leaves: &dyn Fn(usize) -> f64| held_out.iter().map(|&row| leaves(row).powi(2)).sum::<f64>();
        let before = square(&|row| evidence.residual[row] - base[row]);
        let after = square(&|row| evidence.residual[row] - told[row] - with[row]);
        squares.push((before, after, held_out.len() as f64));
        stories.push(story);
    }
    let total = |of: &dyn Fn(&(f64, f64, f64)) -> f64| squares.iter().map(of).sum::<f64>();
    let count = total(&|s| s.2);
    let gain = 1.0 - total(&|s| s.1) / total(&|s| s.0).max(f64::MIN_POSITIVE);
    Some(Proof {
        before: (total(&|s| s.0) / count).sqrt(),
        after: (total(&|s| s.1) / count).sqrt(),
        gain,
        gain_interval: (squares.len() > 2).then(|| interval(&squares)).flatten(),
        stories,
    })
}

/// What the nuisance columns, fitted to `left` on the rows `kept`, add to every datum.
fn absorbed(evidence: &Evidence, left: &DVector<f64>, kept: &[usize]) -> DVector<f64> {
    let k = evidence.nuisance.ncols();
    if k == 0 {
        return DVector::zeros(evidence.residual.len());
    }
    let columns = DMatrix::from_fn(kept.len(), k, |i, j| evidence.nuisance[(kept[i], j)]);
    match crate::linalg::least_squares(&columns, left) {
        Ok(fitted) => &evidence.nuisance * fitted,
        // what is left cannot tell the columns apart: nothing is absorbed
        Err(_) => DVector::zeros(evidence.residual.len()),
    }
}

fn interval(squares: &[(f64, f64, f64)]) -> Option<(f64, f64)> {
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
