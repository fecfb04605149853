//! The fit that the calibration will make of what its poses see, and how it will weigh them.
//!
//! Nobody tells a calibration how much its poses scatter, unless the campaign states it: it weighs
//! them by what it leaves of them, and where groups differ each by its own ([`Noise`]). A clamp
//! whose place is wrong counts less where the fit leaves much of it, and more where it happens to
//! leave little.

use nalgebra::{Cholesky, DMatrix, DVector, Dyn, Matrix3xX};

use crate::calibration::campaign::Recording;
use crate::calibration::{Noise, Robust};
use crate::error::Result;
use crate::linalg::thin_svd;

/// Rounds in which scatter and weights settle, at most, and the relative change of noise below
/// which they have.
const ROUNDS: usize = 12;
const SETTLED: f64 = 1e-3;

/// Planned poses in units of what is known before, along the axes in which they show the robot
/// independently where all count alike: A = U·D·Vᵀ, P = V·diag(σ²/(d² + σ²))·Vᵀ.
pub(super) struct Fit {
    /// A·V: one column for each axis, m.
    along: DMatrix<f64>,
    /// d², m².
    squares: DVector<f64>,
    /// Axes V, a column each, in units of what is known before.
    axes: DMatrix<f64>,
    /// B′·V, m.
    unseen: DMatrix<f64>,
}

/// The same with its weights.
pub(super) struct Weighed<'f> {
    fit: &'f Fit,
    /// 1/σ² of every coordinate, 1/m².
    weights: DVector<f64>,
    /// P, where not all count alike.
    unequal: Option<Cholesky<f64, Dyn>>,
}

impl Fit {
    /// Of the slopes of the poses (m per unit), what is known before of the first of their columns,
    /// and the slopes at unseen poses. Of places that nobody knows it is a metre.
    pub fn new(poses: &[Matrix3xX<f64>], known: &[f64], unseen: &DMatrix<f64>) -> Result<Fit> {
        let columns = poses.first().map_or(0, |block| block.ncols());
        let mut known = known.to_vec();
        known.resize(columns, 1.0);
        // what fewer poses than unknowns leave free is an axis too
        let rows = DMatrix::from_fn((3 * poses.len()).max(columns), columns, |row, k| {
            poses.get(row / 3).map_or(0.0, |block| block[(row % 3, k)] * known[k])
        });
        let svd = thin_svd(&rows)?;
        let there = DMatrix::from_fn(unseen.nrows(), unseen.ncols(), |row, k| unseen[(row, k)] * known[k]);
        Ok(Fit {
            along: rows.rows(0, 3 * poses.len()) * &svd.v,
            squares: svd.singular_values.map(|d| d * d),
            unseen: there * svd.v.rows(0, unseen.ncols()),
            axes: svd.v,
        })
    }

    /// Number of axes.
    pub fn axes(&self) -> usize {
        self.squares.len()
    }

    /// As a calibration weighs its poses that sees all balls by so much elsewhere (m) of a robot
    /// that is so many standard deviations from its drawing. It begins with `noise`, m; a `stated`
    /// one stays.
    pub fn weighed(
        &self,
        recording: &Recording,
        seen: &DVector<f64>,
        robot: &DVector<f64>,
        noise: f64,
        stated: Option<f64>,
    ) -> Result<Weighed<'_>> {
        if let Some(stated) = stated {
            return Ok(self.with(recording, &Noise::assumed(stated, recording, true)));
        }
        let mut noise = Noise::assumed(noise, recording, false);
        let robot = self.axes.tr_mul(robot);
        let mut weighed = self.with(recording, &noise);
        for _ in 0..ROUNDS {
            let wrong = weighed.along_axes(seen) - weighed.solve(robot.clone());
            let left = seen - &self.along * wrong;
            let deviations: Vec<_> =
                left.as_slice().chunks_exact(3).map(nalgebra::Vector3::from_column_slice).collect();
            let variance = noise.pooled * noise.pooled;
            let determined: f64 = self.squares.iter().map(|square| square / (square + variance)).sum();
            let next = noise.estimate(recording, &deviations, determined.round() as usize, Robust::None)?;
            let change = next.of_group.iter().zip(&noise.of_group).map(|(a, b)| (a / b - 1.0).abs());
            let change = change.fold(0.0, f64::max);
            noise = next;
            weighed = self.with(recording, &noise);
            if change < SETTLED {
                break;
            }
        }
        Ok(weighed)
    }

    fn with(&self, recording: &Recording, noise: &Noise) -> Weighed<'_> {
        let of_row = |row: usize| noise.of_group[recording.rows[row / 3].group].powi(-2);
        let weights = DVector::from_fn(self.along.nrows(), |row, _| of_row(row));
        let is_equal = noise.of_group.iter().all(|sd| *sd == noise.of_group[0]);
        let unequal = if is_equal { None } else { self.unequal(&weights) };
        Weighed { fit: self, weights, unequal }
    }

    /// V ᵀ·P⁻¹·V = 1 + (A·V)ᵀ·W·A·V.
    fn unequal(&self, weights: &DVector<f64>) -> Option<Cholesky<f64, Dyn>> {
        let mut weighted = self.along.clone();
        weighted.column_iter_mut().for_each(|mut column| column.component_mul_assign(weights));
        Cholesky::new(DMatrix::identity(self.axes(), self.axes()) + self.along.tr_mul(&weighted))
    }
}

impl Weighed<'_> {
    /// B′·(ρ̂ − ρ), m, where the balls are `seen` by so much elsewhere, m.
    pub fn correction(&self, seen: &DVector<f64>) -> DVector<f64> {
        &self.fit.unseen * self.along_axes(seen)
    }

    /// The same of a robot that is so many standard deviations from its drawing.
    pub fn left_of(&self, robot: &DVector<f64>) -> DVector<f64> {
        -&self.fit.unseen * self.solve(self.fit.axes.tr_mul(robot))
    }

    /// Vᵀ·(ρ̂ − ρ) = Vᵀ·P·Aᵀ·W·e.
    fn along_axes(&self, seen: &DVector<f64>) -> DVector<f64> {
        self.solve(self.fit.along.tr_mul(&seen.component_mul(&self.weights)))
    }

    /// Vᵀ·P·V·x.
    fn solve(&self, x: DVector<f64>) -> DVector<f64> {
        match (&self.unequal, self.weights.iter().next()) {
            (Some(factor), _) => factor.solve(&x),
            (None, Some(weight)) => x.zip_map(&self.fit.squares, |x, square| x / (1.0 + weight * square)),
            (None, None) => x,
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::calibration::campaign::{Group, Row, Station, Targets};
    use crate::statistics::Random;

    /// Two clamps, twenty poses each, that see the same three numbers.
    fn recording() -> Recording {
        let mut recording = Recording::new(1);
        recording.groups = vec![Group::tracked(), Group::tracked()];
        recording.stations = vec![Station::first("")];
        recording.targets = Targets::Sockets(Vec::new());
        let row = |k: usize| Row {
            pose: k.to_string(),
            line: k,
            group: k / 20,
            station: 0,
            time: None,
            temperature: None,
        };
        recording.rows = (0..40).map(row).collect();
        recording.joint_values = vec![0.0; 40];
        recording
    }

    fn fit() -> Fit {
        Fit::new(&vec![Matrix3xX::identity(3); 40], &[1.0; 3], &DMatrix::identity(3, 3)).unwrap()
    }

    #[test]
    fn a_clamp_of_which_much_is_left_counts_less() {
        let (recording, fit) = (recording(), fit());
        let mut random = Random::seeded(1, 0);
        let mut seen =
            |second: f64| DVector::from_fn(120, |k, _| if k < 60 { 1e-5 } else { second } * random.normal());
        let mean = |seen: &DVector<f64>, rows: std::ops::Range<usize>, axis: usize| {
            rows.clone().map(|row| seen[3 * row + axis]).sum::<f64>() / rows.len() as f64
        };
        let robot = DVector::zeros(3);
        // as noisy ones both count alike, whatever the noise that it begins with
        let alike = seen(1e-5);
        let found = fit.weighed(&recording, &alike, &robot, 1e-3, None).unwrap().correction(&alike);
        for axis in 0..3 {
            assert!((found[axis] - mean(&alike, 0..40, axis)).abs() < 1e-11, "{found}");
        }
        // one that scatters ten times as much counts a hundredth
        let apart = seen(1e-4);
        let found = fit.weighed(&recording, &apart, &robot, 1e-5, None).unwrap().correction(&apart);
        for axis in 0..3 {
            let [first, second] = [0..20, 20..40].map(|rows| mean(&apart, rows, axis));
            let share = (found[axis] - first) / (second - first);
            assert!((0.003..0.03).contains(&share), "{share}");
        }
        // a stated noise stays
        let stated = fit.weighed(&recording, &apart, &robot, 1e-5, Some(1e-5)).unwrap();
        assert!((stated.correction(&apart)[0] - mean(&apart, 0..40, 0)).abs() < 1e-11);
    }

    #[test]
    fn what_no_pose_shows_stays_as_far_from_the_drawing_as_it_was() {
        // one pose sees one number of three, to 1 µm
        let mut block = Matrix3xX::zeros(3);
        block[(0, 0)] = 1.0;
        let fit = Fit::new(&[block], &[1e-3; 3], &DMatrix::identity(3, 3)).unwrap();
        let mut recording = recording();
        recording.rows.truncate(1);
        let robot = DVector::from_vec(vec![1.0, 2.0, -3.0]);
        let seen = DVector::zeros(3);
        let left = fit.weighed(&recording, &seen, &robot, 1e-6, Some(1e-6)).unwrap().left_of(&robot);
        // 1/(1 + (1 mm/1 µm)²) of the first
        assert!((left[0] + 1e-9).abs() < 1e-14, "{left}");
        assert!((left[1] + 2e-3).abs() < 1e-14 && (left[2] - 3e-3).abs() < 1e-14, "{left}");
    }
}
