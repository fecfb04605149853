//! Tubes and solid rounds.

use std::f64::consts::PI;

use super::contraction::contraction;
use crate::dual::Number;

/// A circular section, hollow (tube) or solid (`inner_diameter = 0`).
///
/// ```
/// use rodcal::section::Round;
///
/// // 16 × 12 mm (Roark's Formulas, 7th ed., Table A.1): A = 28π mm², I = 700π mm⁴
/// let tube = Round::tube(0.016, 0.012);
/// assert!((tube.area() / 87.965e-6 - 1.0).abs() < 1e-5);
/// assert!((tube.second_moment() / 2199.1e-12 - 1.0).abs() < 1e-4);
/// assert_eq!(tube.torsion_constant(), 2.0 * tube.second_moment());
/// ```
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Round<T = f64> {
    /// Outer diameter D, m.
    pub outer_diameter: T,
    /// Inner diameter d, m; 0 for a solid round.
    pub inner_diameter: T,
}

impl Round {
    /// A tube; diameters in m.
    pub fn tube(outer_diameter: f64, inner_diameter: f64) -> Round {
        Round { outer_diameter, inner_diameter }
    }

    /// A solid round; diameter in m.
    pub fn solid(diameter: f64) -> Round {
        Round { outer_diameter: diameter, inner_diameter: 0.0 }
    }
}

impl<T: Number> Round<T> {
    /// Area A = π/4 (D² − d²), m².
    pub fn area(&self) -> T {
        let (outer, inner) = (self.outer_diameter, self.inner_diameter);
        // (D − d)(D + d) keeps its digits on thin walls, where D² − d² would cancel
        T::from(PI / 4.0) * (outer - inner) * (outer + inner)
    }

    /// Second moment of area about any diameter, I = π/64 (D⁴ − d⁴), m⁴.
    pub fn second_moment(&self) -> T {
        // I = A (D² + d²)/16
        self.area() * (self.outer_diameter.powi(2) + self.inner_diameter.powi(2)) / 16.0
    }

    /// Torsion constant, for a circular section the polar moment J = 2I, m⁴.
    pub fn torsion_constant(&self) -> T {
        self.second_moment() * 2.0
    }

    /// Shear coefficient κ of a hollow circle (solid: m = 0), dimensionless, of a material with
    /// `ratio` e = E/G (E along the pipe) and Poisson's ratio ν (contraction across the pipe):
    ///
    /// κ = 3e(1+m²)² / ((3.5e − ν)(1+m²)² + (10e − 8ν)m²), m = d/D.
    ///
    /// With e = 2(1+ν), an isotropic material, it is Cowper's
    /// κ = 6(1+ν)(1+m²)² / ((7+6ν)(1+m²)² + (20+12ν)m²). As e grows it falls to what a wall
    /// without contraction has (thin tube ½, solid 6/7).
    ///
    /// Sources: G. R. Cowper, "The Shear Coefficient in Timoshenko's Beam Theory", J. Appl. Mech.
    /// 33 (1966) 335–340; for anisotropic material S. Dharmarajan, H. McCutchen, "Shear
    /// Coefficients for Orthotropic Beams", J. Compos. Mater. 7 (1973) 530–535. The derivation is
    /// in docs/beam.md, a finite-element solution of the section in tests/validation/flexure.rs.
    ///
    /// ```
    /// use rodcal::section::Round;
    ///
    /// // Cowper's limits for ν = 0.3: solid 6(1+ν)/(7+6ν) = 0.886, thin 2(1+ν)/(4+3ν) = 0.531
    /// assert!((Round::solid(0.01).shear_coefficient(2.6, 0.3) - 0.886).abs() < 5e-4);
    /// assert!((Round::tube(1.0, 0.9999).shear_coefficient(2.6, 0.3) - 0.531).abs() < 5e-4);
    /// // a carbon tube of 30 × 26 mm, E 118 GPa, G 9.5 GPa
    /// let tube = Round::tube(0.030, 0.026);
    /// assert!((tube.shear_coefficient(118.0 / 9.5, 0.3) - 0.510).abs() < 5e-4);
    /// ```
    pub fn shear_coefficient(&self, ratio: T, poisson_ratio: T) -> T {
        // divided by e, so that ν/e is what remains of the material
        let s = contraction(ratio, poisson_ratio);
        let m2 = (self.inner_diameter / self.outer_diameter).powi(2);
        let ring = (m2 + 1.0).powi(2);
        ring * 3.0 / ((-s + 3.5) * ring + (-s * 8.0 + 10.0) * m2)
    }

    /// Wall thickness t = (D − d)/2, m; the radius for a solid round.
    pub fn wall(&self) -> T {
        (self.outer_diameter - self.inner_diameter) / 2.0
    }

    /// Mean radius of the wall r = (D + d)/4, m.
    pub fn mean_radius(&self) -> T {
        (self.outer_diameter + self.inner_diameter) / 4.0
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use approx::assert_relative_eq;

    const TUBE: Round = Round { outer_diameter: 0.016, inner_diameter: 0.012 };

    #[test]
    fn tube_16_by_12_has_the_textbook_constants() {
        // Roark's Formulas, 7th ed., Table A.1, hollow circle: A = π(R² − Ri²), I = π(R⁴ − Ri⁴)/4
        assert_relative_eq!(TUBE.area(), PI * (64e-6 - 36e-6), max_relative = 1e-14);
        assert_relative_eq!(TUBE.second_moment(), PI / 4.0 * (4096e-12 - 1296e-12), max_relative = 1e-14);
        assert_relative_eq!(TUBE.torsion_constant(), PI / 2.0 * (4096e-12 - 1296e-12), max_relative = 1e-14);
    }

    #[test]
    fn wall_and_mean_radius_describe_the_tube() {
        assert_relative_eq!(TUBE.wall(), 0.002, max_relative = 1e-14);
        assert_relative_eq!(TUBE.mean_radius(), 0.007, max_relative = 1e-14);
    }
}
