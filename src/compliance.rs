//! Compliance of a rod's tip: C^F (per newton of contact force) and C^g (per g of gravity).
//!
//! `Δx_TCP = C^g g_T + C^F F_T` (the paper's Eq 19): the tip's deflection in {T} under the gravity
//! vector (in g) and the contact force (in N), both expressed in {T}. `C[(m, n)]`: offset along
//! axis m, load along axis n.

pub mod closed_form;
mod steps;
mod study;

pub use steps::{Step, steps};
pub use study::{Mode, Shape, StationResponse, Study};

use nalgebra::Matrix3;

use crate::beam::{Load, Physics, RodModel};
use crate::error::{Error, Result};
use crate::rod::Rod;
use crate::units::STANDARD_GRAVITY;

/// Size of the paper's contact force, N.
pub fn paper_contact_force() -> f64 {
    let [x, y, z] = PAPER_CONTACT_FORCE;
    (x * x + y * y + z * z).sqrt()
}

/// The paper's contact force of the three sensors on the ball, N in the device frame (§ 5.2).
pub const PAPER_CONTACT_FORCE: [f64; 3] = [1.10, 1.25, 1.05];

/// Enough for a smooth picture; the numbers do not depend on it.
pub const DEFAULT_ELEMENTS: usize = 200;

/// Compliance matrices of the tip in {T}.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Compliance {
    /// C^F, m/N; symmetric.
    pub force: Matrix3<f64>,
    /// C^g, m per g (9.80665 m/s²); not symmetric.
    pub gravity: Matrix3<f64>,
}

impl Compliance {
    /// From the beam model with `physics` (FEA mode).
    ///
    /// # Errors
    /// As [`RodModel::new`] and [`crate::beam::Chain::solve`]; [`Error::Numerical`] where the
    /// result overflows.
    pub fn of_model(rod: &Rod, physics: &Physics, elements: usize) -> Result<Self> {
        let model = RodModel::new(rod, physics, elements, &[])?;
        let tip = model.tip();
        let response = model.chain.solve(&[Load::Force { node: tip }, Load::SelfWeight])?;
        let compliance = Compliance {
            force: response.motion(tip, 0).translation,
            gravity: response.motion(tip, 1).translation * STANDARD_GRAVITY,
        };
        // the solution was finite per m/s²; a rod of extreme numbers may not be per g
        match compliance.gravity.iter().all(|c| c.is_finite()) {
            true => Ok(compliance),
            false => Err(Error::Numerical {
                what: "compliance under gravity",
                why: "it is beyond double precision; is there a number of the rod in another unit?".into(),
            }),
        }
    }

    /// Compliance index c_rod = ΣΣ|C^g| + F ΣΣ|C^F|, m, with F (N) the size of the contact force.
    ///
    /// The paper's Eq 23; only absolute sums reproduce its Table 2.
    pub fn index(&self, contact_force: f64) -> f64 {
        self.gravity.abs().sum() + contact_force * self.force.abs().sum()
    }

    fn minus(&self, other: &Compliance) -> Compliance {
        Compliance { force: self.force - other.force, gravity: self.gravity - other.gravity }
    }
}
