//! Classical laminate theory: from plies to the axial and shear modulus of a thin tube wall.
//!
//! Laminate axes: 1 along the pipe (the beam's axis), 2 around it; ply angles are counted from the
//! pipe's axis. The wall of a closed tube cannot curl, so its membrane stiffness alone decides:
//! with `A = Σ t_k Q̄_k` (N/m, 3×3) and `a = A⁻¹`,
//!
//! E = 1/(h a₁₁), G = 1/(h a₆₆), ν₁₂ = −a₁₂/a₁₁, h = Σ t_k.
//!
//! The order of the plies through the wall therefore does not matter here. An unbalanced laminate
//! couples extension with shear (a₁₆ ≠ 0): the tube then twists when it is pulled, which a beam
//! with E and G alone does not describe; [`Wall::coupling`] says how much is neglected.
//!
//! Source: R. M. Jones, *Mechanics of Composite Materials*, 2nd ed. (1999), Eqs 2.80–2.84 (Q̄) and
//! 4.22–4.24 (A).

use nalgebra::{Matrix3, Vector3};

/// One unidirectional ply; moduli in its own axes (1 along the fibre, 2 across it).
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Ply {
    /// Modulus along the fibre E₁, Pa.
    pub e1: f64,
    /// Modulus across the fibre E₂, Pa.
    pub e2: f64,
    /// In-plane shear modulus G₁₂, Pa.
    pub g12: f64,
    /// Major Poisson's ratio ν₁₂, dimensionless.
    pub nu12: f64,
    /// Thickness, m.
    pub thickness: f64,
    /// Angle between the fibre and the pipe's axis, rad.
    pub angle: f64,
}

/// What a beam needs to know of a laminated wall.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Wall {
    /// Young's modulus along the pipe, Pa.
    pub youngs_modulus: f64,
    /// Shear modulus of the wall, Pa.
    pub shear_modulus: f64,
    /// Contraction around the pipe per extension along it, ν₁₂, dimensionless.
    pub poisson_ratio: f64,
    /// Extension–shear coupling |a₁₆| / √(a₁₁ a₆₆): 0 for a balanced laminate, below 1 always.
    pub coupling: f64,
    /// Thickness of the wall h, m.
    pub thickness: f64,
}

impl Ply {
    /// Reduced stiffness Q̄ in laminate axes, Pa, for (ε₁, ε₂, γ₁₂).
    pub fn stiffness(&self) -> Matrix3<f64> {
        let nu21 = self.nu12 * self.e2 / self.e1;
        let scale = 1.0 / (1.0 - self.nu12 * nu21);
        let (q11, q22, q12, q66) = (self.e1 * scale, self.e2 * scale, self.nu12 * self.e2 * scale, self.g12);
        // Q̄ = Tᵀ Q T, T the transformation of engineering strains to ply axes (Jones Eq 2.78 and
        // 2.79)
        let (s, c) = self.angle.sin_cos();
        let to_ply = Matrix3::new(
            c * c,
            s * s,
            s * c, //
            s * s,
            c * c,
            -s * c, //
            -2.0 * s * c,
            2.0 * s * c,
            c * c - s * s,
        );
        let q = Matrix3::new(q11, q12, 0.0, q12, q22, 0.0, 0.0, 0.0, q66);
        to_ply.transpose() * q * to_ply
    }
}

/// The wall made of `plies`, or `None` where the plies have no invertible stiffness (no plies, or
/// moduli that are not positive).
///
/// ```
/// use rodcal::material::laminate::{Ply, wall};
///
/// // T300/5208 (Tsai and Hahn 1980, Table 1.7), quasi-isotropic: E = 69.7 GPa, ν = 0.30 (Table 4.4)
/// let ply = |degrees: f64| Ply {
///     e1: 181e9, e2: 10.3e9, g12: 7.17e9, nu12: 0.28, thickness: 0.125e-3, angle: degrees.to_radians(),
/// };
/// let wall = wall(&[0.0, 45.0, -45.0, 90.0].map(ply)).expect("plies of positive stiffness");
/// assert!((wall.youngs_modulus - 69.7e9).abs() < 0.1e9 && (wall.poisson_ratio - 0.30).abs() < 0.005);
/// // isotropic in its plane: G = E / 2(1+ν), and nothing couples extension with shear
/// let isotropic = wall.youngs_modulus / (2.0 * (1.0 + wall.poisson_ratio));
/// assert!((wall.shear_modulus / isotropic - 1.0).abs() < 1e-9 && wall.coupling < 1e-9);
/// ```
pub fn wall(plies: &[Ply]) -> Option<Wall> {
    let thickness: f64 = plies.iter().map(|ply| ply.thickness).sum();
    // A = Σ t Q̄
    let membrane: Matrix3<f64> = plies.iter().map(|ply| ply.stiffness() * ply.thickness).sum();
    // inverted after scaling by the thickness, so that the numbers are moduli
    let compliance = (membrane / thickness).try_inverse()?;
    let diagonal: Vector3<f64> = compliance.diagonal();
    let sound = diagonal.iter().all(|a| a.is_finite() && *a > 0.0) && thickness > 0.0;
    sound.then(|| Wall {
        youngs_modulus: 1.0 / diagonal[0],
        shear_modulus: 1.0 / diagonal[2],
        poisson_ratio: -compliance[(0, 1)] / diagonal[0],
        coupling: compliance[(0, 2)].abs() / (diagonal[0] * diagonal[2]).sqrt(),
        thickness,
    })
}

#[cfg(test)]
mod tests {
    use super::*;
    use approx::assert_relative_eq;

    /// T300/5208 of Tsai and Hahn, *Introduction to Composite Materials* (1980), Table 1.7.
    fn t300(angle_deg: f64) -> Ply {
        Ply {
            e1: 181e9,
            e2: 10.3e9,
            g12: 7.17e9,
            nu12: 0.28,
            thickness: 0.125e-3,
            angle: angle_deg.to_radians(),
        }
    }

    #[test]
    fn a_single_axial_ply_is_itself() {
        let wall = wall(&[t300(0.0)]).unwrap();
        assert_relative_eq!(wall.youngs_modulus, 181e9, max_relative = 1e-12);
        assert_relative_eq!(wall.shear_modulus, 7.17e9, max_relative = 1e-12);
        assert_relative_eq!(wall.poisson_ratio, 0.28, max_relative = 1e-12);
        assert_eq!(wall.coupling, 0.0);
    }

    #[test]
    fn an_off_axis_ply_follows_the_compliance_transformation() {
        // Jones Eq 2.97: 1/E_x = c⁴/E1 + (1/G12 − 2ν12/E1) s²c² + s⁴/E2
        let (s, c) = 30f64.to_radians().sin_cos();
        let expected = 1.0
            / (c.powi(4) / 181e9
                + (1.0 / 7.17e9 - 2.0 * 0.28 / 181e9) * (s * c).powi(2)
                + s.powi(4) / 10.3e9);
        let wall = wall(&[t300(30.0)]).unwrap();
        assert_relative_eq!(wall.youngs_modulus, expected, max_relative = 1e-12);
        assert!(wall.coupling > 0.3, "a single off-axis ply shears when it is pulled");
    }

    #[test]
    fn a_balanced_pair_does_not_couple() {
        assert!(wall(&[t300(45.0), t300(-45.0)]).unwrap().coupling < 1e-12);
    }

    #[test]
    fn nothing_comes_of_no_plies() {
        assert_eq!(wall(&[]), None);
    }
}
