//! How well the numbers of a rod are known: standard uncertainties (1 σ).

use crate::units::{GRAM, MM};

/// Standard uncertainties of a rod's dimensions, one standard deviation each; 0 is exact.
///
/// Those of moduli, density and shear coefficient belong to each material:
/// [`crate::material::MaterialUncertainty`]. They are type B evaluations (GUM, JCGM 100:2008, 4.3):
/// what drawing, catalogue and caliper are good for, not what a rig has measured.
#[derive(Debug, Clone, Copy, PartialEq)]
#[non_exhaustive]
pub struct StandardUncertainty {
    /// Of each diameter, and of a rectangle's width, height and wall, m.
    pub diameter: f64,
    /// Of L1, L2, the bend's radius and every station, m.
    pub length: f64,
    /// Of the tip mass, kg.
    pub tip_mass: f64,
    /// Of each constant of a general section, relative, dimensionless.
    pub section: f64,
}

impl Default for StandardUncertainty {
    /// 0.03 mm on diameters, 0.3 mm on lengths, 0.5 g at the tip, 1 % on a section's constants.
    fn default() -> Self {
        StandardUncertainty { diameter: 0.03 * MM, length: 0.3 * MM, tip_mass: 0.5 * GRAM, section: 0.01 }
    }
}
