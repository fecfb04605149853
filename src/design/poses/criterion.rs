//! What chosen poses shall be good for, and what it comes to in a unit that says something.

use nalgebra::DMatrix;

use crate::optimal_design::Criterion;

/// What chosen poses shall be good for.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
#[non_exhaustive]
pub enum PoseCriterion {
    /// O1 = (Π σᵢ)^(1/m)/√n, as the paper; the larger the better.
    O1,
    /// O4 = σₘ²/σ₁; the larger the better.
    O4,
    /// |M|: the geometric mean over all principal directions of what is left of the standard deviations before.
    D,
    /// tr(M⁻¹) in units of what is known before: the root mean square of the same over all
    /// parameters.
    A,
    /// The root mean square of the tip's error at unseen poses that noise and undetermined
    /// parameters make.
    Forecast,
}

impl PoseCriterion {
    /// All criteria, in the order of their discriminants.
    pub const ALL: [PoseCriterion; 5] =
        [PoseCriterion::O1, PoseCriterion::O4, PoseCriterion::D, PoseCriterion::A, PoseCriterion::Forecast];

    /// `o1`, `o4`, `d`, `a`, `forecast`.
    pub fn key(self) -> &'static str {
        ["o1", "o4", "d", "a", "forecast"][self as usize]
    }

    /// As it is written in a sentence.
    pub fn name(self) -> &'static str {
        ["O1", "O4", "D-optimality", "A-optimality", "the forecast"][self as usize]
    }

    /// What its value is, with its unit.
    pub fn name_and_unit(self) -> (&'static str, &'static str) {
        [
            ("O1", ""),
            ("O4", ""),
            ("share of the standard uncertainty that is left, geometric mean", ""),
            ("share of the standard uncertainty that is left, root mean square", ""),
            ("tip error at unseen poses from noise, root mean square", "µm"),
        ][self as usize]
    }

    /// True where a larger value is better.
    pub fn is_larger_better(self) -> bool {
        matches!(self, PoseCriterion::O1 | PoseCriterion::O4)
    }

    /// True for the indices, which know nothing of noise and of what is known before.
    pub(super) fn is_index(self) -> bool {
        self.is_larger_better()
    }

    /// As the exchange has it; `weight` is B′ᵀB′ averaged over the unseen poses.
    pub(super) fn of_design(self, columns: usize, weight: &DMatrix<f64>) -> Criterion {
        match self {
            PoseCriterion::O1 | PoseCriterion::D => Criterion::Determinant,
            PoseCriterion::O4 => Criterion::Smallest,
            PoseCriterion::A => Criterion::Trace(DMatrix::identity(columns, columns)),
            PoseCriterion::Forecast => Criterion::Trace(weight.clone()),
        }
    }

    /// From the exchange's value: `columns` unknowns, `count` poses, `constant` what ln |M| has of
    /// unknown places.
    pub(super) fn shown(self, value: f64, columns: usize, count: usize, constant: f64) -> f64 {
        let m = columns.max(1) as f64;
        match self {
            PoseCriterion::O1 => ((value - constant) / (2.0 * m)).exp() / (count as f64).sqrt(),
            PoseCriterion::O4 => value,
            PoseCriterion::D => (-(value - constant) / (2.0 * m)).exp(),
            PoseCriterion::A => (-value / m).max(0.0).sqrt(),
            PoseCriterion::Forecast => (-value).max(0.0).sqrt() / crate::units::UM,
        }
    }
}
