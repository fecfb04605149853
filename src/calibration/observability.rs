//! How well a set of poses shows the parameters: condition number and the five observability
//! indices.
//!
//! With the singular values σ₁ ≥ … ≥ σₘ of the Jacobian of all poses and n poses
//!
//! ```text
//! O1 = (Π σᵢ)^(1/m) / √n     O2 = σₘ/σ₁     O3 = σₘ     O4 = σₘ²/σ₁     O5 = 1/Σ(1/σᵢ)
//! ```
//!
//! (Borm & Menq 1991; Driels & Pathre 1990; Nahvi & Hollerbach 1994, 1996; Sun & Hollerbach, *ICRA*
//! 2008). All five depend on units. Here residuals are in mm and parameters in mm, mrad and, for
//! compliances, in µrad/(N·m). Compare indices of one robot only, and only their ratios. The
//! condition number is that of columns of norm 1 and has no unit.

use nalgebra::DVector;

use super::problem::Residuals;
use crate::error::Result;
use crate::linalg::{thin_svd, with_unit_columns};
use crate::robot::Parameter;
use crate::units::{MM, URAD_PER_NM};

/// See the top of the file.
#[derive(Debug, Clone, Copy, PartialEq)]
#[non_exhaustive]
pub struct Observability {
    /// O1 … O5.
    pub indices: [f64; 5],
    /// σ₁/σₘ with columns of norm 1.
    pub condition: f64,
}

impl Observability {
    /// The unit of a parameter here, SI.
    pub(super) fn unit(parameter: Parameter) -> f64 {
        match parameter {
            Parameter::Compliance(_) => URAD_PER_NM,
            // a millimetre or a milliradian
            Parameter::BasePosition(_)
            | Parameter::BaseRotation(_)
            | Parameter::Theta(_)
            | Parameter::D(_)
            | Parameter::A(_)
            | Parameter::Alpha(_)
            | Parameter::Beta(_)
            | Parameter::Tool(_) => MM,
        }
    }

    /// Of the free parameters at `p`, without weights and without what is held.
    pub(super) fn new(problem: &Residuals, p: &DVector<f64>) -> Result<Self> {
        let poses = problem.recording.len();
        let unknown = problem.free.len();
        let weight = vec![1.0 / MM; poses];
        let pass = super::problem::Pass { weight, ..problem.pass.clone() };
        let plain = Residuals { setup: problem.setup.clone(), pass: &pass, held: &[], ..*problem };
        let mut corner = plain.information_root(p);
        let condition = thin_svd(&with_unit_columns(&corner).0)?.condition_number();
        for (k, parameter) in problem.free.iter().enumerate() {
            corner.column_mut(k).scale_mut(Self::unit(*parameter));
        }
        let sigma = thin_svd(&corner)?.singular_values;
        let (first, last) = (sigma.iter().next().copied(), sigma.iter().next_back().copied());
        let (first, last) = (first.unwrap_or(0.0), last.unwrap_or(0.0));
        let logarithms: f64 = sigma.iter().map(|s| s.ln()).sum();
        let o1 = (logarithms / unknown.max(1) as f64).exp() / (poses as f64).sqrt();
        let o5 = 1.0 / sigma.iter().map(|s| 1.0 / s).sum::<f64>();
        Ok(Observability { indices: [o1, last / first, last, last * last / first, o5], condition })
    }
}
