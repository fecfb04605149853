//! Numbers that follow from several values, such as the length of a displacement, with the 95 %
//! interval ± k·√(gᵀ·Σ·g): coverage factor k, gradient g, posterior covariance Σ (GUM: law of
//! propagation of uncertainty).

use std::ops::Range;

use nalgebra::{DVector, Vector3};

use crate::inference::{FindingPart, Quantity};

/// A number with its gradient by the first values of a part of a finding.
pub struct Length {
    pub value: f64,
    pub gradient: DVector<f64>,
}

impl Length {
    /// Half of its 95 % interval.
    pub fn half_interval(&self, part: &FindingPart) -> f64 {
        let count = self.gradient.len();
        let covariance = part.covariance.view((0, 0), (count, count));
        let variance = self.gradient.dot(&(covariance * &self.gradient));
        part.coverage_factor * variance.max(0.0).sqrt()
    }
}

/// A vector's length.
pub fn length(values: &[f64]) -> Length {
    weighted_length(values, &vec![1.0; values.len()])
}

/// √(Σ wₖ·xₖ²).
pub fn weighted_length(values: &[f64], weights: &[f64]) -> Length {
    let products = values.iter().zip(weights).map(|(x, w)| x * w);
    let weighted = DVector::from_iterator(values.len(), products);
    let value = weighted.dot(&DVector::from_column_slice(values)).sqrt();
    Length { value, gradient: weighted / value.max(f64::MIN_POSITIVE) }
}

/// Length of the vector of the first three values of a part, in `unit`.
pub fn size(part: &FindingPart, unit: f64) -> Quantity {
    size_of(part, 0..3, unit)
}

/// The same of its values in `range`.
pub fn size_of(part: &FindingPart, range: Range<usize>, unit: f64) -> Quantity {
    let values = &part.term.values[..part.term.values.len().min(range.end)];
    let counts: Vec<f64> = (0..values.len()).map(|k| f64::from(k >= range.start)).collect();
    let size = weighted_length(values, &counts);
    let half = size.half_interval(part);
    Quantity {
        value: size.value / unit,
        low: (size.value - half).max(0.0) / unit,
        high: (size.value + half) / unit,
    }
}

/// What the first three values of a part are along a unit vector, in their unit.
pub fn component(part: &FindingPart, along: &Vector3<f64>) -> Quantity {
    let count = part.term.values.len().min(3);
    let gradient = DVector::from_column_slice(&along.as_slice()[..count]);
    let value = gradient.dot(&DVector::from_column_slice(&part.term.values[..count]));
    let half = Length { value, gradient }.half_interval(part);
    Quantity { value, low: value - half, high: value + half }
}
