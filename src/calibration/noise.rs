//! How much single measurements scatter, and what they count: groups of unequal noise, outliers.

use crate::error::Result;
use crate::statistics::{chi_squared_quantile, f_survival, median};

use super::campaign::Recording;
use nalgebra::Vector3;

/// Below this probability that all groups scatter alike, each gets a noise of its own.
const UNEQUAL: f64 = 0.01;
/// Least noise that is believed, m: where deviations are smaller still, they are rounding, and
/// weights made of them would outweigh other knowledge, such as the distances of sockets.
const LEAST: f64 = 1e-8;
/// Fewest degrees of freedom for a noise of its own.
const FEWEST: f64 = 10.0;
/// So many times fewer rows of a group may be far out without being its noise.
const FEW: usize = 5;
/// The median of χ with three degrees of freedom.
const MEDIAN: f64 = 1.538_172_254_5;

/// What an outlier counts. The distance of a pose from the model is judged, not single coordinates.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
#[non_exhaustive]
pub enum Robust {
    /// As much as any other pose.
    #[default]
    None,
    /// Less, the farther out: Huber's weights min(1, k/u), k = 2.21.
    Huber,
    /// Nothing, beyond a bound: Tukey's biweight (1 − (u/c)²)², c = 5.49.
    Tukey,
}

/// u beyond which Huber's weight falls: exceeded as rarely by the length of a normal vector in
/// space as 1.345 by the size of a normal number.
const HUBER: f64 = 2.21;
/// Tukey's c for 95 % efficiency in three dimensions (R. Maronna et al., *Robust Statistics*, 2nd
/// ed., §6.4).
const TUKEY: f64 = 5.49;

/// What a deviation is worth for a variance made of the median of lengths, beside one for their
/// mean square: (2/3)·(f(m)·m)² with the density f of χ₃ at its median m.
const MEDIAN_EFFICIENCY: f64 = 0.527;

/// Noise of the recording: standard deviation of one coordinate, m.
#[derive(Debug, Clone, PartialEq)]
#[non_exhaustive]
pub struct Noise {
    /// Over all poses.
    pub pooled: f64,
    /// Of each group.
    pub of_group: Vec<f64>,
    /// Probability that groups of equal noise scatter as unequally as these (Bartlett); `None` for
    /// a single group.
    pub p_equal: Option<f64>,
    /// True where the campaign states it.
    pub is_stated: bool,
    /// What each row counts, 0…1.
    pub weights: Vec<f64>,
}

impl Noise {
    /// The same for all rows, before anything is known.
    pub fn assumed(sd: f64, recording: &Recording, is_stated: bool) -> Self {
        Noise {
            pooled: sd,
            of_group: vec![sd; recording.groups.len()],
            p_equal: None,
            is_stated,
            weights: vec![1.0; recording.len()],
        }
    }

    /// From the deviations of a fit of `rank` parameters.
    ///
    /// Every group has the share of the degrees of freedom that it has of the rows. A row that is
    /// far out of its group is no noise of the group, and is not counted where groups are compared.
    /// Robust weights are judged by the median length of the deviations in each group: the length
    /// of a normal vector in space has the median 1.538 σ.
    ///
    /// # Errors
    /// As [`chi_squared_quantile`]; none in practice.
    pub fn estimate(
        &self,
        recording: &Recording,
        deviations: &[Vector3<f64>],
        rank: usize,
        robust: Robust,
    ) -> Result<Noise> {
        let rows = recording.len();
        let share = (1.0 - rank as f64 / (3 * rows) as f64).max(1.0 / (3 * rows) as f64);
        let mut rows_by_group: Vec<Vec<usize>> = vec![Vec::new(); recording.groups.len()];
        for (row, entry) in recording.rows.iter().enumerate() {
            rows_by_group[entry.group].push(row);
        }
        let all: Vec<usize> = (0..rows).collect();
        let variance = |rows: &[usize]| -> f64 {
            match robust {
                Robust::None => {
                    let sum: f64 = rows.iter().map(|&row| deviations[row].norm_squared()).sum();
                    sum / (3.0 * rows.len() as f64 * share)
                }
                _ => {
                    let lengths: Vec<f64> = rows.iter().map(|&row| deviations[row].norm()).collect();
                    (median(&lengths).unwrap_or(0.0) / MEDIAN).powi(2) / share
                }
            }
        };
        let pooled = variance(&all);
        if robust == Robust::None {
            for rows in &mut rows_by_group {
                without_far(rows, deviations, recording.len())?;
            }
        }
        let of_group: Vec<f64> =
            rows_by_group.iter().map(|rows| if rows.is_empty() { pooled } else { variance(rows) }).collect();
        let worth = if robust == Robust::None { 1.0 } else { MEDIAN_EFFICIENCY };
        let dof: Vec<f64> =
            rows_by_group.iter().map(|rows| 3.0 * rows.len() as f64 * share * worth).collect();
        let p_equal = match self.is_stated {
            true => None,
            false => bartlett(&of_group, &dof)?,
        };
        let unequal = p_equal.is_some_and(|p| p < UNEQUAL);
        let sd = |group: usize| match unequal && dof[group] >= FEWEST {
            _ if self.is_stated => self.pooled,
            true => of_group[group].sqrt().max(LEAST),
            false => pooled.sqrt().max(LEAST),
        };
        let of_group: Vec<f64> = (0..of_group.len()).map(sd).collect();
        let weights = deviations
            .iter()
            .zip(&recording.rows)
            .map(|(deviation, row)| robust.weight(deviation.norm() / of_group[row.group]))
            .collect();
        let pooled = if self.is_stated { self.pooled } else { pooled.sqrt().max(LEAST) };
        Ok(Noise { pooled, of_group, p_equal, is_stated: self.is_stated, weights })
    }

    /// √weight over the noise, 1/m, by row.
    pub fn row_weights(&self, recording: &Recording) -> Vec<f64> {
        recording
            .rows
            .iter()
            .zip(&self.weights)
            .map(|(row, weight)| weight.sqrt() / self.of_group[row.group])
            .collect()
    }

    /// Rows that are farther out than the farthest of so many normal ones would be in one recording
    /// of a hundred.
    ///
    /// # Errors
    /// As [`chi_squared_quantile`]; none in practice.
    pub fn outliers(&self, recording: &Recording, deviations: &[Vector3<f64>]) -> Result<Vec<usize>> {
        let limit = far(recording.len())?;
        let is_far = |&row: &usize| deviations[row].norm() > limit * self.of_group[recording.rows[row].group];
        Ok((0..recording.len()).filter(is_far).collect())
    }
}

impl Robust {
    /// What a pose counts that is `u` standard deviations out.
    ///
    /// ```
    /// use rodcal::calibration::Robust;
    ///
    /// assert_eq!([1.0, 4.42].map(|u| Robust::Huber.weight(u)), [1.0, 0.5]); // 2.21/u beyond 2.21
    /// assert_eq!(Robust::Tukey.weight(6.0), 0.0);
    /// ```
    pub fn weight(self, u: f64) -> f64 {
        match self {
            Robust::None => 1.0,
            Robust::Huber => (HUBER / u).min(1.0),
            Robust::Tukey if u < TUKEY => (1.0 - (u / TUKEY).powi(2)).powi(2),
            Robust::Tukey => 0.0,
        }
    }
}

/// Takes from the `rows` of a group those that are far out, where they are few: one misread pose
/// would have all others of its clamp count less. Its median says which they may be; beside the
/// others' scatter s² each must be farther out than one row in a hundred recordings of so many is,
/// so that groups of normal noise stay as they are:
///
/// ```text
/// F = (|d|²/3)/s²,  s² = Σ |d|²/3n over the n others;    P(F₃,₃ₙ > F) < 0.01/rows
/// ```
fn without_far(rows: &mut Vec<usize>, deviations: &[Vector3<f64>], all: usize) -> Result<()> {
    let lengths: Vec<f64> = rows.iter().map(|&row| deviations[row].norm()).collect();
    let limit = far(rows.len())? * median(&lengths).unwrap_or(0.0) / MEDIAN;
    let (near, out): (Vec<usize>, Vec<usize>) =
        rows.iter().partition(|&&row| deviations[row].norm() <= limit);
    let Some(least) = out.iter().map(|&row| deviations[row].norm_squared()).reduce(f64::min) else {
        return Ok(());
    };
    let square: f64 = near.iter().map(|&row| deviations[row].norm_squared()).sum();
    if FEW * out.len() > rows.len() || square == 0.0 {
        return Ok(());
    }
    let count = near.len() as f64;
    if f_survival(least / (square / count), 3.0, 3.0 * count)? < 0.01 / all as f64 {
        *rows = near;
    }
    Ok(())
}

/// The length, in standard deviations, that the longest of so many normal vectors has in one
/// recording of a hundred.
fn far(count: usize) -> Result<f64> {
    Ok(chi_squared_quantile(1.0 - 0.01 / count.max(1) as f64, 3.0)?.sqrt())
}

/// Bartlett's test over the groups that have enough rows; `None` for fewer than two.
fn bartlett(variances: &[f64], dof: &[f64]) -> Result<Option<f64>> {
    let groups: Vec<(f64, f64)> =
        variances.iter().copied().zip(dof.iter().copied()).filter(|&(s, n)| n >= FEWEST && s > 0.0).collect();
    if groups.len() < 2 {
        return Ok(None);
    }
    crate::statistics::bartlett(&groups).map(Some)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::statistics::Random;

    fn normal(count: usize, random: &mut Random) -> Vec<Vector3<f64>> {
        (0..count).map(|_| Vector3::from_fn(|_, _| random.normal())).collect()
    }

    fn left(deviations: &[Vector3<f64>], all: usize) -> Vec<usize> {
        let mut rows = (0..deviations.len()).collect();
        without_far(&mut rows, deviations, all).unwrap();
        rows
    }

    #[test]
    fn one_far_row_is_no_noise_of_its_group_and_several_are() {
        let mut deviations = normal(8, &mut Random::seeded(1, 1));
        deviations[2] = Vector3::new(8.0, -6.0, 0.0);
        assert_eq!(left(&deviations, 40), [0, 1, 3, 4, 5, 6, 7]);
        deviations[5] = Vector3::new(0.0, 9.0, 5.0);
        assert_eq!(left(&deviations, 40).len(), 8);
        // as many as a fifth
        deviations.extend(normal(8, &mut Random::seeded(1, 2)));
        assert_eq!(left(&deviations, 40).len(), 14);
        // nothing is known of others that do not scatter
        let mut still = vec![Vector3::zeros(); 8];
        still[0] = Vector3::x();
        assert_eq!(left(&still, 40).len(), 8);
    }

    /// One recording in a hundred of normal noise loses a row, whatever the groups' size.
    #[test]
    fn groups_of_normal_noise_stay_as_they_are() {
        for (size, groups) in [(5, 10), (8, 12), (12, 5), (30, 5)] {
            let mut random = Random::seeded(2, size as u64);
            let recordings = 500;
            let lost = (0..recordings * groups)
                .filter(|_| left(&normal(size, &mut random), size * groups).len() < size);
            let lost = lost.count();
            assert!(lost <= 14, "{lost} of {recordings} with groups of {size}");
        }
    }
}
