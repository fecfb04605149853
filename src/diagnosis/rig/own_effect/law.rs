//! What a lab's own effect does to the data of a recording.

use nalgebra::DVector;

use crate::diagnosis::rig::laws::remembered::remembered;
use crate::expression::Expression;
use crate::inference::DERIVATIVE_STEP;
use crate::inference::law::Site;
use crate::rod::LawMemory;

/// A formula at a place.
#[derive(Debug)]
pub struct OwnLaw {
    /// Of the variable, the side, and the parameters.
    pub law: Expression,
    /// Of the parameters.
    pub neutral: Vec<f64>,
    /// Of each datum that it concerns: its number, variable, side, and weight, m per unit of the
    /// result.
    pub data: Vec<(usize, f64, f64, f64)>,
    /// What the variable is instead, where it remembers: how, where, and names of the parameters.
    pub memory: Option<(LawMemory, Site, Vec<String>)>,
}

impl OwnLaw {
    /// What each of `count` readings changes by per `size` of the k-th of the `given` parameters:
    /// numbers and values.
    pub fn derivative(&self, count: usize, given: &[(usize, f64)], k: usize, size: f64) -> DVector<f64> {
        let mut column = DVector::zeros(count);
        for sign in [1.0, -1.0] {
            let mut moved = given.to_vec();
            moved[k].1 += sign * DERIVATIVE_STEP * size;
            self.add_to(column.as_mut_slice(), moved.into_iter(), 0.5 * sign / DERIVATIVE_STEP);
        }
        column
    }

    /// Adds what it does with these of its parameters, the others at their neutral values.
    pub fn add_to(&self, readings: &mut [f64], given: impl Iterator<Item = (usize, f64)>, times: f64) {
        let mut values = vec![0.0; 2 + self.neutral.len()];
        values[2..].copy_from_slice(&self.neutral);
        given.for_each(|(k, value)| values[2 + k] = value);
        let followed = self.memory.as_ref().map(|(memory, site, names)| {
            let own = |name: &str| names.iter().position(|own| own == name).map_or(0.0, |k| values[2 + k]);
            let si = site.variable.si;
            remembered(Some(*memory), site, own).into_iter().map(|x| x / si).collect::<Vec<f64>>()
        });
        for &(i, x, side, weight) in &self.data {
            (values[0], values[1]) = (followed.as_ref().map_or(x, |followed| followed[i]), side);
            let change = times * weight * self.law.at(&values);
            // what is not a number at some values of its parameters is no effect there
            readings[i] += if change.is_finite() { change } else { 0.0 };
        }
    }
}
