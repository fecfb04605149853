//! Materials of pipes: isotropic ones, and laminates reduced to the two moduli a beam needs.

pub mod laminate;

use std::sync::Arc;

use self::laminate::Ply;

use crate::dual::Number;

/// The linear elastic constants a straight or curved pipe needs.
#[derive(Debug, Clone, PartialEq)]
#[non_exhaustive]
pub struct Material<T = f64> {
    /// Name in the rod file.
    pub name: String,
    /// Young's modulus along the pipe E, Pa.
    pub youngs_modulus: T,
    /// Shear modulus of the wall G, Pa.
    pub shear_modulus: T,
    /// Density ρ, kg/m³.
    pub density: T,
    /// Poisson's ratio ν, contraction across the pipe per extension along it, dimensionless. Only
    /// the shear coefficient depends on it.
    pub poisson_ratio: T,
    /// True where G was stated by E and ν, and changes with them.
    pub is_shear_modulus_derived: bool,
    /// Stress up to which it springs back, Pa, where it is stated.
    pub yield_strength: Option<T>,
    /// What the section's shear coefficient is multiplied with, dimensionless; 1 unless stated.
    pub shear_coefficient_factor: T,
    /// How well these numbers are known.
    pub standard_uncertainty: MaterialUncertainty,
    /// The plies that E, G and ν were made of, where the file has a laminate.
    pub plies: Option<Arc<[Ply]>>,
}

/// Relative standard uncertainties of a material's numbers: 1 σ over the value, dimensionless;
/// 0 is exact (GUM, JCGM 100:2008, 4.3, type B).
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct MaterialUncertainty {
    /// Of Young's modulus E.
    pub youngs_modulus: f64,
    /// Of the shear modulus G.
    pub shear_modulus: f64,
    /// Of the density ρ.
    pub density: f64,
    /// Of the shear coefficient κ.
    pub shear_coefficient: f64,
}

impl MaterialUncertainty {
    /// What a metal from a catalogue is known to: E 1 %, G 2 %, ρ 1 %, κ 3 %.
    pub const ISOTROPIC: MaterialUncertainty = MaterialUncertainty {
        youngs_modulus: 0.01,
        shear_modulus: 0.02,
        density: 0.01,
        shear_coefficient: 0.03,
    };

    /// What a laminate or another anisotropic wall is known to: E 5 %, G 10 %, ρ 1 %, κ 15 %.
    pub const ANISOTROPIC: MaterialUncertainty = MaterialUncertainty {
        youngs_modulus: 0.05,
        shear_modulus: 0.10,
        density: 0.01,
        shear_coefficient: 0.15,
    };
}

/// Poisson's ratio of an anisotropic wall whose own is not known.
pub const TYPICAL_POISSON_RATIO: f64 = 0.3;

/// E/G may leave 2(1+ν) by this share before a material counts as anisotropic.
const ISOTROPY: f64 = 0.05;

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
        let shear_modulus = youngs_modulus / (2.0 * (1.0 + poisson_ratio));
        let material = Material::anisotropic(name, youngs_modulus, shear_modulus, poisson_ratio, density);
        Material { is_shear_modulus_derived: true, ..material }
    }

    /// The material with Young's and shear moduli (Pa) and density (kg/m³).
    ///
    /// Where 0 ≤ E/2G − 1 ≤ ½ it is taken as isotropic, with that Poisson's ratio. Elsewhere (a
    /// carbon tube) it is anisotropic, E/2G − 1 is no Poisson's ratio, and ν is
    /// [`TYPICAL_POISSON_RATIO`].
    ///
    /// ```
    /// use rodcal::material::Material;
    ///
    /// let steel = Material::with_moduli("steel", 193e9, 74.806e9, 7930.0);
    /// assert!((steel.poisson_ratio - 0.29).abs() < 1e-5 && !steel.is_anisotropic());
    /// let carbon = Material::with_moduli("carbon", 118e9, 9.5e9, 1600.0); // E/2G − 1 = 5.2
    /// assert!(carbon.poisson_ratio == 0.3 && carbon.is_anisotropic());
    /// ```
    pub fn with_moduli(name: &str, youngs_modulus: f64, shear_modulus: f64, density: f64) -> Self {
        let ratio = isotropic_poisson_ratio(youngs_modulus, shear_modulus);
        let is_isotropic = (0.0..=0.5).contains(&ratio);
        let ratio = if is_isotropic { ratio } else { TYPICAL_POISSON_RATIO };
        Material::anisotropic(name, youngs_modulus, shear_modulus, ratio, density)
    }

    /// The material with Young's and shear moduli (Pa), Poisson's ratio and density (kg/m³), each
    /// known by itself. Its standard uncertainties are those of an anisotropic one where
    /// [`Material::is_anisotropic`].
    pub fn anisotropic(
        name: &str,
        youngs_modulus: f64,
        shear_modulus: f64,
        poisson_ratio: f64,
        density: f64,
    ) -> Self {
        let material = Material {
            name: name.to_owned(),
            youngs_modulus,
            shear_modulus,
            density,
            poisson_ratio,
            is_shear_modulus_derived: false,
            yield_strength: None,
            shear_coefficient_factor: 1.0,
            standard_uncertainty: MaterialUncertainty::ISOTROPIC,
            plies: None,
        };
        match material.is_anisotropic() {
            true => Material { standard_uncertainty: MaterialUncertainty::ANISOTROPIC, ..material },
            false => material,
        }
    }

    /// True where E/G differs from the 2(1+ν) of an isotropic material by more than 5 %.
    pub fn is_anisotropic(&self) -> bool {
        let isotropic = 2.0 * (1.0 + self.poisson_ratio);
        (self.modulus_ratio() / isotropic - 1.0).abs() > ISOTROPY
    }
}

impl<T: Number> Material<T> {
    /// e = E/G, dimensionless.
    pub fn modulus_ratio(&self) -> T {
        self.youngs_modulus / self.shear_modulus
    }
}

/// ν = E/2G − 1: what Poisson's ratio would be, were the material isotropic.
pub fn isotropic_poisson_ratio(youngs_modulus: f64, shear_modulus: f64) -> f64 {
    youngs_modulus / (2.0 * shear_modulus) - 1.0
}

/// Names that a file gave to its materials, as many and as long as a message takes: "a", "b" …
pub(crate) fn listed(names: &[&str]) -> String {
    const MOST: usize = 12;
    const LONGEST: usize = 40;
    let short = |name: &&str| match name.char_indices().nth(LONGEST) {
        Some((end, _)) => format!("\"{}…\"", &name[..end]),
        None => format!("\"{name}\""),
    };
    let listed = names.iter().take(MOST).map(short).collect::<Vec<_>>().join(", ");
    if names.len() > MOST { format!("{listed} …") } else { listed }
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
    #[test]
    fn the_ratio_of_the_moduli_of_an_anisotropic_material_is_no_poisson_ratio() {
        for (e, g) in [(118e9, 9.5e9), (20e9, 30e9)] {
            let tube = Material::with_moduli("tube", e, g, 1600.0);
            assert_eq!(tube.poisson_ratio, 0.3);
            assert_eq!(tube.standard_uncertainty, MaterialUncertainty::ANISOTROPIC);
        }
        let known = Material::anisotropic("tube", 118e9, 9.5e9, 0.35, 1600.0);
        assert_eq!((known.poisson_ratio, known.is_anisotropic()), (0.35, true));
        let steel = Material::isotropic("steel", 193e9, 0.29, 7930.0);
        assert_eq!(steel.standard_uncertainty, MaterialUncertainty::ISOTROPIC);
    }
}
