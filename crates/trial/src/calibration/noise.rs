//! Errors of what is read: normal, heavy-tailed or those of a real recording; correlated along the
//! rows; larger at some clamps; shown in steps.

use nalgebra::{DVector, Vector3};

use crate::chance::{happens, log_uniform, one_of};
use crate::rig::noise::{Shape, Source};
use rodcal_base::statistics::Random;
use rodcal_base::units::UM;

/// How often neighbours are correlated, and by how much (AR(1)).
const CORRELATED: (f64, [f64; 2]) = (0.2, [0.2, 0.6]);
/// How often clamps scatter unequally, and how many times as much the worst one.
const UNEQUAL: (f64, [f64; 2]) = (0.25, [1.5, 4.0]);
/// Steps of a display, m.
const STEPS: [f64; 4] = [0.1 * UM, 0.1 * UM, UM, 10.0 * UM];

/// The errors of a recording.
#[derive(Debug, Clone, PartialEq)]
pub struct Scatter {
    /// Standard deviation of a coordinate, m.
    pub sd: f64,
    pub shape: Shape,
    /// Of a row with the next.
    pub correlation: f64,
    /// By clamp or socket, over `sd`.
    pub of_group: Vec<f64>,
    /// What the display shows, m; nothing is shown of sockets.
    pub step: f64,
    /// True where the campaign states it.
    pub is_stated: bool,
}

impl Scatter {
    /// At so many clamps or sockets; from `residuals` of a real recording where there are any.
    pub fn draw(groups: usize, residuals: &[f64], random: &mut Random) -> Scatter {
        let sd = log_uniform(random, 10.0, 50.0) * UM;
        let heavy = happens(random, 0.3).then(|| 3 + random.index(6) as u32);
        let shape = match (residuals, heavy) {
            ([], None) => Shape::Normal,
            ([], Some(freedom)) => Shape::StudentT(freedom),
            _ => Shape::Bootstrap(residuals.to_vec()),
        };
        let [low, high] = CORRELATED.1;
        let correlation = if happens(random, CORRELATED.0) { random.uniform(low, high) } else { 0.0 };
        let mut of_group = vec![1.0; groups];
        if groups > 1 && happens(random, UNEQUAL.0) {
            let [low, high] = UNEQUAL.1;
            let worst = random.index(groups);
            of_group[worst] = random.uniform(low, high);
        }
        Scatter {
            sd,
            shape,
            correlation: if residuals.is_empty() { correlation } else { 0.0 },
            of_group,
            step: one_of(random, &STEPS, 0.0),
            is_stated: happens(random, 0.3),
        }
    }

    /// For people: `student-t (5), correlated 0.35, clamp 2 × 3.1`.
    pub fn description(&self) -> String {
        let mut description = match &self.shape {
            Shape::Normal => "normal".to_owned(),
            Shape::StudentT(freedom) => format!("student-t ({freedom})"),
            Shape::Bootstrap(residuals) => format!("{} residuals of a recording", residuals.len()),
        };
        if self.correlation > 0.0 {
            description += &format!(", correlated {:.2}", self.correlation);
        }
        let unequal = self.of_group.iter().enumerate().filter(|(_, factor)| **factor != 1.0);
        for (group, factor) in unequal {
            description += &format!(", fixture {} × {factor:.1}", group + 1);
        }
        description
    }

    fn of(&self, group: usize) -> f64 {
        self.of_group.get(group).copied().unwrap_or(1.0)
    }

    /// Errors of rows at these clamps or sockets, in the world, m.
    pub fn drawn(&self, groups: &[usize], random: &mut Random) -> Vec<Vector3<f64>> {
        let mut sources = [(); 3].map(|()| Source::new(&self.shape));
        let fresh = (1.0 - self.correlation * self.correlation).sqrt();
        let mut last: Option<Vector3<f64>> = None;
        let error = |&group: &usize| {
            let drawn = Vector3::from_fn(|axis, _| sources[axis].draw(random));
            let own = last.map_or(drawn, |last| last * self.correlation + drawn * fresh);
            last = Some(own);
            own * (self.sd * self.of(group))
        };
        groups.iter().map(error).collect()
    }

    /// Σ^(−1/2)·v for coordinates row by row, and the display's steps: v/σ, then (vₖ − φ·vₖ₋₁)/√(1
    /// − φ²).
    pub fn whitened(&self, groups: &[usize], v: &DVector<f64>) -> DVector<f64> {
        let mut white = v.clone();
        for (row, &group) in groups.iter().enumerate() {
            let variance = (self.sd * self.of(group)).powi(2) + self.step * self.step / 12.0;
            white.rows_mut(3 * row, 3).unscale_mut(variance.sqrt());
        }
        let fresh = (1.0 - self.correlation * self.correlation).sqrt();
        for k in (3..white.len()).rev() {
            white[k] = (white[k] - self.correlation * white[k - 3]) / fresh;
        }
        white
    }

    /// The standard deviation of a coordinate that a campaign states, m.
    pub fn stated(&self) -> Option<f64> {
        let is_one = self.of_group.iter().all(|factor| *factor == 1.0);
        (self.is_stated && is_one).then(|| (self.sd * self.sd + self.step * self.step / 12.0).sqrt())
    }

    /// As a display shows a coordinate, m.
    pub fn shown(&self, value: f64) -> f64 {
        if self.step > 0.0 { (value / self.step).round() * self.step } else { value }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn whitened_errors_have_unit_scatter_and_neighbours_that_know_nothing_of_each_other() {
        let groups: Vec<usize> = (0..90).map(|row| row / 30).collect();
        let scatter = Scatter {
            sd: 2e-5,
            shape: Shape::StudentT(6),
            correlation: 0.5,
            of_group: vec![1.0, 3.0, 1.0],
            step: 0.0,
            is_stated: false,
        };
        let (mut squares, mut products, mut count) = (0.0, 0.0, 0.0);
        for seed in 0..40 {
            let errors = scatter.drawn(&groups, &mut Random::seeded(seed, 1));
            let all = errors.iter().flat_map(|error| <[f64; 3]>::from(*error));
            let white = scatter.whitened(&groups, &DVector::from_iterator(3 * errors.len(), all));
            squares += white.norm_squared();
            products += (3..white.len()).map(|k| white[k] * white[k - 3]).sum::<f64>();
            count += white.len() as f64;
        }
        assert!((squares / count - 1.0).abs() < 0.06, "{}", squares / count);
        assert!((products / count).abs() < 0.03, "{}", products / count);
    }
}
