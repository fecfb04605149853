//! A tube of one material: how far a unit of length gives way to a unit of force or moment.

use std::f64::consts::PI;

/// A round tube of one material, SI.
#[derive(Debug, Clone, PartialEq)]
pub struct Tube {
    /// Name of the material in the rod file.
    pub material: &'static str,
    /// Young's modulus E, Pa.
    pub youngs_modulus: f64,
    /// Shear modulus G, Pa.
    pub shear_modulus: f64,
    /// Density, kg/m³.
    pub density: f64,
    /// Outer radius b, m.
    pub outer: f64,
    /// Inner radius a, m.
    pub inner: f64,
    /// The section's shear coefficient over that of the formula.
    pub coefficient: f64,
}

/// What a cross-section gives way per unit of length.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Flexibility {
    /// Extension per axial force, 1/EA, 1/N.
    pub axial: f64,
    /// Shear angle per transverse force, 1/κGA, rad/N.
    pub shear: f64,
    /// Curvature per bending moment, 1/EI, 1/(N·m²).
    pub bending: f64,
    /// Twist per torque, 1/GJ, 1/(N·m²).
    pub torsion: f64,
}

impl Tube {
    /// Area π(b² − a²), m².
    pub fn area(&self) -> f64 {
        PI * (self.outer - self.inner) * (self.outer + self.inner)
    }

    /// Second moment of area about a diameter, π(b⁴ − a⁴)/4, m⁴; the polar one is twice that.
    pub fn second_moment(&self) -> f64 {
        PI / 4.0 * (self.outer.powi(4) - self.inner.powi(4))
    }

    /// Shear coefficient of a hollow circle, m = a/b, e = E/G (S. Dharmarajan, H. McCutchen, *J.
    /// Compos. Mater.* 7 (1973) 530–535; with e = 2(1 + ν) it is G. R. Cowper's, *J. Appl. Mech.*
    /// 33 (1966) 335–340):
    ///
    /// κ = 3e(1 + m²)² / ((3.5e − ν)(1 + m²)² + (10e − 8ν)m²).
    ///
    /// ν = E/2G − 1 of an isotropic wall, 0.3 of any other.
    pub fn shear_coefficient(&self) -> f64 {
        let e = self.youngs_modulus / self.shear_modulus;
        let isotropic = e / 2.0 - 1.0;
        let nu = if (0.0..=0.5).contains(&isotropic) { isotropic } else { 0.3 };
        let ratio = (self.inner / self.outer).powi(2);
        let square = (1.0 + ratio) * (1.0 + ratio);
        3.0 * e / (3.5 * e - nu + (10.0 * e - 8.0 * nu) * ratio / square)
    }

    /// What it gives way, with E and G multiplied by factors.
    pub fn flexibility(&self, youngs_factor: f64, shear_factor: f64) -> Flexibility {
        let (e, g) = (self.youngs_modulus * youngs_factor, self.shear_modulus * shear_factor);
        Flexibility {
            axial: 1.0 / (e * self.area()),
            shear: 1.0 / (self.coefficient * self.shear_coefficient() * g * self.area()),
            bending: 1.0 / (e * self.second_moment()),
            torsion: 1.0 / (2.0 * g * self.second_moment()),
        }
    }

    /// How many times as flexible in bending a bend of radius R is as the straight tube, since its
    /// section becomes oval: the third approximation of von Kármán's series, with λ = tR/r² (t
    /// wall, r mean radius)
    ///
    /// k = (252 + 73912λ² + 2446176λ⁴ + 2822400λ⁶) / (3 + 3280λ² + 329376λ⁴ + 2822400λ⁶)
    ///
    /// (Th. von Kármán, Z. VDI 55 (1911) 1889; the same out of the plane: I. Vigness, Trans. ASME
    /// 65 (1943) 105). It goes to 1.65/λ for thin walls, and differs from the first approximation
    /// by half a per cent at λ = 0.5 and twofold at 0.1.
    pub fn ovalisation(&self, bend_radius: f64) -> f64 {
        let (wall, mean) = (self.outer - self.inner, (self.outer + self.inner) / 2.0);
        let l = (wall * bend_radius / (mean * mean)).powi(2);
        (252.0 + l * (73_912.0 + l * (2_446_176.0 + l * 2_822_400.0)))
            / (3.0 + l * (3_280.0 + l * (329_376.0 + l * 2_822_400.0)))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn tube(inner: f64) -> Tube {
        let (youngs_modulus, shear_modulus) = (200e9, 80e9);
        Tube {
            material: "steel",
            youngs_modulus,
            shear_modulus,
            density: 7900.0,
            outer: 8e-3,
            inner,
            coefficient: 1.0,
        }
    }

    #[test]
    fn a_thin_bend_is_clark_and_reissners_and_a_thick_one_a_beam() {
        let thin = tube(7.4e-3);
        let lambda = 0.6e-3 * 15e-3 / (7.7e-3f64).powi(2);
        assert!((thin.ovalisation(15e-3) / (1.65 / lambda) - 1.0).abs() < 0.06);
        assert!((tube(1e-3).ovalisation(1.0) - 1.0).abs() < 1e-3);
    }

    #[test]
    fn a_solid_round_has_cowpers_coefficient_of_a_circle() {
        // 6(1 + ν)/(7 + 6ν) with ν = 0.25
        assert!((tube(0.0).shear_coefficient() - 7.5 / 8.5).abs() < 1e-12);
        // carbon, 30 × 26 mm: ν is not E/2G − 1 = 5
        let carbon = Tube { youngs_modulus: 118e9, shear_modulus: 9.5e9, outer: 15e-3, ..tube(13e-3) };
        assert!((carbon.shear_coefficient() - 0.510).abs() < 5e-4);
        let flexibility = tube(6e-3).flexibility(1.0, 1.0);
        assert!((flexibility.bending * 200e9 * tube(6e-3).second_moment() - 1.0).abs() < 1e-12);
    }
}
