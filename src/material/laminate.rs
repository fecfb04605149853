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

use crate::dual::{Dual, Number};

/// One unidirectional ply; moduli in its own axes (1 along the fibre, 2 across it).
#[derive(Debug, Clone, Copy, PartialEq)]
#[non_exhaustive]
pub struct Ply<T = f64> {
    /// Modulus along the fibre E₁, Pa.
    pub e1: T,
    /// Modulus across the fibre E₂, Pa.
    pub e2: T,
    /// In-plane shear modulus G₁₂, Pa.
    pub g12: T,
    /// Major Poisson's ratio ν₁₂, dimensionless.
    pub nu12: T,
    /// Thickness, m.
    pub thickness: T,
    /// Angle between the fibre and the pipe's axis, rad.
    pub angle: T,
}

impl Ply {
    /// A ply along the pipe's axis with moduli `[E₁, E₂, G₁₂]` (Pa), ν₁₂ and a thickness (m).
    pub fn new([e1, e2, g12]: [f64; 3], nu12: f64, thickness: f64) -> Ply {
        Ply { e1, e2, g12, nu12, thickness, angle: 0.0 }
    }

    /// With its fibre at this angle to the pipe's axis, rad.
    pub fn at_angle(self, angle: f64) -> Ply {
        Ply { angle, ..self }
    }
}

/// A number of the plies of a laminate.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, PartialOrd, Ord)]
pub enum PlyNumber {
    /// E₁ of all plies, Pa.
    E1,
    /// E₂ of all plies, Pa.
    E2,
    /// G₁₂ of all plies, Pa.
    G12,
    /// ν₁₂ of all plies, dimensionless.
    Nu12,
    /// Angle of the ply of this number, from 0, rad.
    Angle(usize),
}

impl PlyNumber {
    /// Those of a laminate of so many plies.
    pub fn all(plies: usize) -> impl Iterator<Item = PlyNumber> {
        let moduli = [PlyNumber::E1, PlyNumber::E2, PlyNumber::G12, PlyNumber::Nu12];
        moduli.into_iter().chain((0..plies).map(PlyNumber::Angle))
    }

    /// Its value, SI.
    pub fn value_in(self, plies: &[Ply]) -> Option<f64> {
        let first = plies.first()?;
        match self {
            PlyNumber::E1 => Some(first.e1),
            PlyNumber::E2 => Some(first.e2),
            PlyNumber::G12 => Some(first.g12),
            PlyNumber::Nu12 => Some(first.nu12),
            PlyNumber::Angle(ply) => plies.get(ply).map(|ply| ply.angle),
        }
    }
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

impl<T: Number> Ply<T> {
    /// Reduced stiffness Q̄ in laminate axes, Pa, for (ε₁, ε₂, γ₁₂).
    pub fn stiffness(&self) -> Matrix3<T> {
        let nu21 = self.nu12 * self.e2 / self.e1;
        let scale = T::one() / (T::one() - self.nu12 * nu21);
        let (q11, q22, q12, q66) = (self.e1 * scale, self.e2 * scale, self.nu12 * self.e2 * scale, self.g12);
        // Q̄ = Tᵀ Q T, T the transformation of engineering strains to ply axes (Jones Eq 2.78 and
        // 2.79)
        let (s, c) = (self.angle.sin(), self.angle.cos());
        let zero = T::zero();
        let to_ply = Matrix3::new(
            c * c,
            s * s,
            s * c, //
            s * s,
            c * c,
            -s * c, //
            s * c * -2.0,
            s * c * 2.0,
            c * c - s * s,
        );
        let q = Matrix3::new(q11, q12, zero, q12, q22, zero, zero, zero, q66);
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
/// let along = Ply::new([181e9, 10.3e9, 7.17e9], 0.28, 0.125e-3);
/// let ply = |degrees: f64| along.at_angle(degrees.to_radians());
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

/// ∂E, ∂G (Pa) and ∂ν of the wall by one number of its plies (SI): with C = (A/h)⁻¹,
/// ∂C = −C·∂(A/h)·C. The plies' thickness, one for all, changes none of them. A ν beyond what an
/// isotropic material can have is taken for the nearest that it can, and does not change.
///
/// `None` as [`wall`], and for a ply that there is not.
pub fn slopes(plies: &[Ply], number: PlyNumber) -> Option<[f64; 3]> {
    let value_at = |k: usize| {
        let ply = plies[k];
        let own = |is_it: bool, x: f64| if is_it { Dual::from(x).derivative() } else { Dual::from(x) };
        Ply {
            e1: own(number == PlyNumber::E1, ply.e1),
            e2: own(number == PlyNumber::E2, ply.e2),
            g12: own(number == PlyNumber::G12, ply.g12),
            nu12: own(number == PlyNumber::Nu12, ply.nu12),
            thickness: Dual::from(ply.thickness),
            angle: own(number == PlyNumber::Angle(k), ply.angle),
        }
    };
    number.value_in(plies)?;
    let thickness: f64 = plies.iter().map(|ply| ply.thickness).sum();
    let membrane: Matrix3<Dual> =
        (0..plies.len()).map(|k| value_at(k).stiffness() * value_at(k).thickness).sum();
    let compliance = membrane.map(|entry| entry.re / thickness).try_inverse()?;
    let change = -compliance * membrane.map(|entry| entry.eps / thickness) * compliance;
    let (a11, a12, a66) = (compliance[(0, 0)], compliance[(0, 1)], compliance[(2, 2)]);
    let (d11, d12, d66) = (change[(0, 0)], change[(0, 1)], change[(2, 2)]);
    // E = 1/a₁₁, G = 1/a₆₆, ν = −a₁₂/a₁₁
    let is_kept = (0.0..=0.5).contains(&(-a12 / a11));
    let of_ratio = if is_kept { (a12 * d11 / a11 - d12) / a11 } else { 0.0 };
    Some([-d11 / (a11 * a11), -d66 / (a66 * a66), of_ratio])
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

    /// Against central differences of fourth order, of a laminate that is not balanced.
    #[test]
    fn slopes_are_those_of_differences() {
        let plies: Vec<Ply> = [0.0, 30.0, -45.0, 80.0].map(t300).to_vec();
        let value_at = |number: PlyNumber, by: f64| {
            let mut plies = plies.clone();
            for (k, ply) in plies.iter_mut().enumerate() {
                match number {
                    PlyNumber::E1 => ply.e1 += by,
                    PlyNumber::E2 => ply.e2 += by,
                    PlyNumber::G12 => ply.g12 += by,
                    PlyNumber::Nu12 => ply.nu12 += by,
                    PlyNumber::Angle(own) if own == k => ply.angle += by,
                    PlyNumber::Angle(_) => {}
                }
            }
            let wall = wall(&plies).unwrap();
            [wall.youngs_modulus, wall.shear_modulus, wall.poisson_ratio]
        };
        let mut numbers = 0;
        for number in PlyNumber::all(plies.len()) {
            numbers += 1;
            let step = 1e-3 * number.value_in(&plies).unwrap().abs().max(0.1);
            let [one, two, less, twice] = [1.0, 2.0, -1.0, -2.0].map(|k| value_at(number, k * step));
            let found = slopes(&plies, number).unwrap();
            for k in 0..3 {
                let expected = (8.0 * (one[k] - less[k]) - (two[k] - twice[k])) / (12.0 * step);
                let scale = expected.abs().max(1e-3 * value_at(number, 0.0)[k] / step);
                assert!(
                    (found[k] - expected).abs() < 1e-6 * scale,
                    "{number:?} {k}: {} {expected}",
                    found[k]
                );
            }
        }
        assert_eq!(numbers, 8);
        assert!(slopes(&plies, PlyNumber::Angle(4)).is_none() && slopes(&[], PlyNumber::E1).is_none());
    }
}
