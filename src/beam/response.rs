//! Load cases and what a chain does under them: the words that solving and checking share.

use nalgebra::{Matrix3, Vector3};

use crate::spatial::skew;

/// A block of three load cases, one along each axis of space.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Load {
    /// A force of 1 N at a node, along x, y and z.
    Force {
        /// Index of the node.
        node: usize,
    },
    /// A moment of 1 N·m at a node, about x, y and z.
    Couple {
        /// Index of the node.
        node: usize,
    },
    /// The weight of elements and masses under an acceleration of 1 m/s², along x, y and z.
    SelfWeight,
}

/// Displacement and rotation; column j belongs to the load along axis j, row i to axis i.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Motion {
    /// m per N, per N·m or per m/s².
    pub translation: Matrix3<f64>,
    /// rad per N, per N·m or per m/s².
    pub rotation: Matrix3<f64>,
}

/// Resultant of the loads beyond a cut, at the cut; columns as in [`Motion`].
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Resultant {
    /// N per unit load.
    pub force: Matrix3<f64>,
    /// N·m per unit load.
    pub moment: Matrix3<f64>,
}

/// What a chain does under the loads it was solved for.
#[derive(Debug, Clone)]
pub struct Response {
    pub(super) loads: usize,
    /// Node-major: all loads of node 0, then all of node 1, …
    pub(super) motions: Vec<Motion>,
}

/// Mass φ (kg), its first moment about a point s (kg·m), and a pure moment χ.
#[derive(Debug, Clone, Copy)]
pub(super) struct Carried {
    pub mass: f64,
    pub first_moment: Vector3<f64>,
    pub couple: f64,
}

impl Response {
    /// Displacement and rotation of `node` under the load block `load` (index into the slice given
    /// to [`super::Chain::solve`]).
    pub fn motion(&self, node: usize, load: usize) -> &Motion {
        &self.motions[node * self.loads + load]
    }

    #[cfg(test)]
    pub(super) fn motion_mut(&mut self, node: usize, load: usize) -> &mut Motion {
        &mut self.motions[node * self.loads + load]
    }
}

impl Carried {
    pub(super) const NOTHING: Carried =
        Carried { mass: 0.0, first_moment: Vector3::new(0.0, 0.0, 0.0), couple: 0.0 };

    /// M = [s]ₓ + χ·1, N·m per unit load.
    pub(super) fn moment(&self) -> Matrix3<f64> {
        skew(&self.first_moment) + Matrix3::from_diagonal_element(self.couple)
    }
}
