//! Compliance of a rod's tip: C^F (per newton of contact force) and C^g (per g of gravity).
//!
//! `Δx_TCP = C^g g_T + C^F F_T` (the paper's Eq 19): the tip's deflection in {T} under the gravity
//! vector (in g) and the contact force (in N), both expressed in {T}. `C[(m, n)]`: offset along
//! axis m, load along axis n.

pub mod closed_form;
mod laws;
mod sensitivity;
mod steps;
mod strength;
mod study;

pub use laws::StaticLaws;
pub use sensitivity::{Sensitivity, sensitivities, standard_uncertainty};
pub use steps::{Step, steps};
pub use strength::{Overload, Strength, overload};
pub use study::{LINEAR_SHARE, Mode, Shape, StationResponse, Study, TipLoad};

use nalgebra::Matrix3;

use crate::beam::{Load, Physics, RodModel};
use crate::dual::Number;
use crate::error::{Error, Result};
use crate::rod::Rod;
use crate::units::STANDARD_GRAVITY;

/// Size of the paper's contact force, √(1.10² + 1.25² + 1.05²) N (§ 5.2).
///
/// ```
/// assert!((rodcal::prelude::paper_contact_force() - 1.969).abs() < 1e-3);
/// ```
pub fn paper_contact_force() -> f64 {
    let [x, y, z] = PAPER_CONTACT_FORCE;
    (x * x + y * y + z * z).sqrt()
}

/// The paper's contact force of the three sensors on the ball, N in the device frame (§ 5.2).
pub const PAPER_CONTACT_FORCE: [f64; 3] = [1.10, 1.25, 1.05];

/// Enough for a smooth picture; the numbers do not depend on it.
pub const DEFAULT_ELEMENTS: usize = 200;

/// Compliance matrices of the tip in {T}, 3 × 3: a force F on the tip, N, and gravity g, in g,
/// displace the ball by Δx = C^F·F + C^g·g, m.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Compliance<T = f64> {
    /// C^F, m/N; symmetric.
    pub force: Matrix3<T>,
    /// C^g, m per g (9.80665 m/s²); not symmetric.
    pub gravity: Matrix3<T>,
}

impl Compliance {
    /// From the beam model with `physics` (FEA mode).
    ///
    /// ```
    /// use rodcal::prelude::*;
    ///
    /// // Table 2 of the paper lists c_rod of its steel rods in µm; their tube is reconstructed
    /// for (rod, published) in [("rods/4.toml", 513.4), ("rods/5.toml", 403.7), ("rods/6.toml", 1306.2)] {
    ///     let rod = Rod::read(rod.as_ref())?;
    ///     let compliance = Compliance::of_model(&rod, &Physics::default(), DEFAULT_ELEMENTS)?;
    ///     let index = compliance.index(paper_contact_force()) / 1e-6;
    ///     assert!((index / published - 1.0).abs() < 0.015, "{index}");
    /// }
    /// # Ok::<(), rodcal::Error>(())
    /// ```
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

    fn minus(&self, other: &Compliance) -> Compliance {
        Compliance { force: self.force - other.force, gravity: self.gravity - other.gravity }
    }
}

impl<T: Number> Compliance<T> {
    /// Compliance index c_rod = ΣΣ|C^g| + F ΣΣ|C^F|, m, with F (N) the size of the contact force.
    ///
    /// The paper's Eq 23; only absolute sums reproduce its Table 2.
    ///
    /// ```
    /// use nalgebra::Matrix3;
    /// use rodcal::compliance::Compliance;
    ///
    /// let compliance = Compliance { force: Matrix3::identity() * 20e-6, gravity: Matrix3::repeat(-1e-6) };
    /// assert!((compliance.index(2.0) - 129e-6).abs() < 1e-18); // 9·1 µm + 2 N · 3·20 µm/N
    /// ```
    pub fn index(&self, contact_force: f64) -> T {
        let sum = |matrix: &Matrix3<T>| matrix.iter().map(|entry| entry.size()).sum::<T>();
        sum(&self.gravity) + sum(&self.force) * contact_force
    }
}
