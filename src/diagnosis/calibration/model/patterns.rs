//! Directions that many columns are multiples of, row by row, as they are among the data.

use nalgebra::{Matrix3, Vector3};

use super::configuration::Configuration;
use crate::inference::Pattern;

/// Displacements of the tip in {W} at every row.
pub struct Patterns {
    /// The axes of {W}.
    pub world: [Pattern; 3],
    /// The axes of {T}.
    pub tool: [Pattern; 3],
    /// ∂tip/∂q of every joint.
    pub joint: Vec<Pattern>,
    /// ∂tip/∂(turn of all beyond a joint about an axis of its link).
    pub link: Vec<[Pattern; 3]>,
}

impl Patterns {
    pub fn new(configurations: &[Configuration], whitens: &[Matrix3<f64>]) -> Patterns {
        let pattern = |direction: &dyn Fn(&Configuration) -> Vector3<f64>| {
            pattern(configurations, whitens, |_, there| direction(there))
        };
        let joints = configurations.first().map_or(0, |there| there.tip_jacobian.len());
        let turned = |link: usize, axis: usize| {
            pattern(&|there: &Configuration| {
                let about = there.link[link].rotation.column(axis).into_owned();
                about.cross(&(there.tip - there.link[link].origin))
            })
        };
        Patterns {
            world: [0, 1, 2].map(|axis| pattern(&|_: &Configuration| Vector3::ith(axis, 1.0))),
            tool: [0, 1, 2]
                .map(|axis| pattern(&|there: &Configuration| there.flange.rotation.column(axis).into())),
            joint: (0..joints).map(|j| pattern(&|there: &Configuration| there.tip_jacobian[j])).collect(),
            link: (0..joints).map(|link| [0, 1, 2].map(|axis| turned(link, axis))).collect(),
        }
    }
}

/// A direction at every row, times what whitens it.
pub fn pattern(
    configurations: &[Configuration],
    whitens: &[Matrix3<f64>],
    direction: impl Fn(usize, &Configuration) -> Vector3<f64>,
) -> Pattern {
    let of_row = |(row, (there, whitens)): (usize, (&Configuration, &Matrix3<f64>))| {
        let direction: [f64; 3] = (whitens * direction(row, there)).into();
        direction
    };
    Pattern { block: 3, values: configurations.iter().zip(whitens).enumerate().flat_map(of_row).collect() }
}
