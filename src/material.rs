//! Materials of pipes: isotropic ones, and laminates reduced to the two moduli a beam needs.

pub mod laminate;

/// The linear elastic constants a straight or curved pipe needs.
#[derive(Debug, Clone, PartialEq)]
#[non_exhaustive]
pub struct Material {
    /// Name in the rod file.
    pub name: String,
    /// Young's modulus along the pipe E, Pa.
    pub youngs_modulus: f64,
    /// Shear modulus of the wall G, Pa.
    pub shear_modulus: f64,
    /// Density ρ, kg/m³.
    pub density: f64,
    /// Poisson's ratio ν in Cowper's shear coefficient, dimensionless.
    pub poisson_ratio: f64,
}

impl Material {
    /// The isotropic material with Young's modulus (Pa), Poisson's ratio and density (kg/m³): G = E
    /// / 2(1+ν).
    ///
    /// ```
    /// use rodcal::material::Material;
    ///
    /// let steel = Material::isotropic("steel", 193e9, 0.29, 7930.0);
    /// assert!((steel.shear_modulus - 74.806e9).abs() < 1e6); // 193 GPa / 2.58
    /// ```
    pub fn isotropic(name: &str, youngs_modulus: f64, poisson_ratio: f64, density: f64) -> Self {
        Material {
            name: name.to_owned(),
            youngs_modulus,
            shear_modulus: youngs_modulus / (2.0 * (1.0 + poisson_ratio)),
            density,
            poisson_ratio,
        }
    }

    /// The material with independent Young's and shear moduli (Pa).
    ///
    /// Cowper's coefficient is derived for isotropic material, with ν = E/2G − 1. The same ν is
    /// used where the two moduli leave the isotropic range −1 < ν ≤ ½ (unidirectional carbon does):
    /// κ of a thin tube then still stays between ½ and ⅔.
    pub fn with_moduli(name: &str, youngs_modulus: f64, shear_modulus: f64, density: f64) -> Self {
        Material {
            name: name.to_owned(),
            youngs_modulus,
            shear_modulus,
            density,
            poisson_ratio: isotropic_poisson_ratio(youngs_modulus, shear_modulus),
        }
    }
}

/// ν = E/2G − 1: what Poisson's ratio would be, were the material isotropic.
pub fn isotropic_poisson_ratio(youngs_modulus: f64, shear_modulus: f64) -> f64 {
    youngs_modulus / (2.0 * shear_modulus) - 1.0
}

#[cfg(test)]
mod tests {
    use super::*;
    use approx::assert_relative_eq;

    #[test]
    fn the_two_ways_to_state_an_isotropic_material_agree() {
        let by_ratio = Material::isotropic("steel", 193e9, 0.29, 7930.0);
        let by_moduli = Material::with_moduli("steel", 193e9, by_ratio.shear_modulus, 7930.0);
        assert_relative_eq!(by_ratio.shear_modulus, 74.806201550e9, max_relative = 1e-9);
        assert_relative_eq!(by_moduli.poisson_ratio, 0.29, max_relative = 1e-12);
    }
}
