//! What a rod file's reader wants its user to know; `Display` gives the advice.

use std::fmt;

use crate::material::TYPICAL_POISSON_RATIO;
use crate::units::{MM, significant};

/// Something in a rod file that is allowed but worth a second look.
#[derive(Debug, Clone, PartialEq)]
#[non_exhaustive]
pub enum Warning {
    /// A number that no measuring rod has: most likely it is in another unit.
    Unusual {
        /// Key in the file.
        key: String,
        /// Its value, in `unit`.
        value: f64,
        /// The unit that the key asks for.
        unit: &'static str,
        /// Smallest usual value, in `unit`.
        least: f64,
        /// Largest usual value, in `unit`.
        most: f64,
    },
    /// The bend is tighter than the tube itself.
    TightBend {
        /// Radius of the bend, m.
        radius: f64,
        /// Outer radius of the bend's tube, m.
        tube_radius: f64,
    },
    /// A bend radius was given but the rod is straight.
    NoBend,
    /// The plies do not add up to the wall of the tube that uses them.
    LaminateThickness {
        /// Name of the material.
        material: String,
        /// Sum of the plies, m.
        plies: f64,
        /// The pipe in question.
        pipe: &'static str,
        /// Wall of the tube, m.
        wall: f64,
    },
    /// The laminate is not balanced: pulling the tube twists it, which E and G do not describe.
    LaminateCoupling {
        /// Name of the material.
        material: String,
        /// |a16| / √(a11 a66).
        coupling: f64,
    },
    /// Poisson's ratio and the moduli contradict each other, were the material isotropic.
    PoissonRatio {
        /// Name of the material.
        material: String,
        /// As stated.
        stated: f64,
        /// E/2G − 1.
        ratio: f64,
    },
    /// A law that is not the rod's alone, or that follows what went before.
    LawOfRig {
        /// The law in words.
        law: String,
        /// True where the load that hangs now is all it takes.
        is_static: bool,
    },
    /// A sleeve that is nowhere near another wall.
    LooseSleeve {
        /// Its name.
        sleeve: String,
        /// To the nearest wall, on the radius, m.
        gap: f64,
    },
    /// Young's and shear modulus leave the isotropic range and Poisson's ratio is not stated: it is
    /// taken as [`crate::material::TYPICAL_POISSON_RATIO`].
    Anisotropic {
        /// Name of the material.
        material: String,
        /// E/2G − 1.
        ratio: f64,
    },
}

impl fmt::Display for Warning {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Warning::Unusual { key, value, unit, least, most } => write!(
                f,
                "`{key}` is {} {unit}, where {least} to {most} {unit} is usual: is it given in {unit}?",
                significant(*value, 4)
            ),
            Warning::TightBend { radius, tube_radius } => write!(
                f,
                "the bend radius ({:.1} mm) is smaller than the tube's own radius ({:.1} mm): beam theory does not hold there",
                radius / MM,
                tube_radius / MM
            ),
            Warning::NoBend => write!(f, "bend_radius_mm has no effect on a straight rod (gamma_deg = 180)"),
            Warning::LaminateThickness { material, plies, pipe, wall } => write!(
                f,
                "the plies of material `{material}` are {:.3} mm thick together but the wall of {pipe} is {:.3} mm: the laminate's moduli are used for the whole wall",
                plies / MM,
                wall / MM
            ),
            Warning::LaminateCoupling { material, coupling } => write!(
                f,
                "the laminate of material `{material}` is not balanced (extension–shear coupling {coupling:.2}): a beam with E and G alone leaves its bending–twisting out; pair every +θ ply with a −θ ply"
            ),
            Warning::PoissonRatio { material, stated, ratio } => write!(
                f,
                "material `{material}` states Poisson's ratio {stated}, and E/2G − 1 = {ratio:.2} were it isotropic: it is taken as anisotropic, with standard uncertainties of 5 % for E and 10 % for G"
            ),
            Warning::LawOfRig { law, is_static: true } => write!(
                f,
                "the law {law} is the rig's and not the rod's: `rig fit` and `diagnose rig` take it out of readings, \
                 nothing else uses it"
            ),
            Warning::LawOfRig { law, is_static: false } => write!(
                f,
                "the law {law} follows what went before: `diagnose rig` uses it, and nothing else does"
            ),
            Warning::LooseSleeve { sleeve, gap } => write!(
                f,
                "sleeve \"{sleeve}\" is {:.1} mm away from the nearest wall: it is taken as bonded to the rod all along, \
                 which no adhesive is at that thickness; check its diameters",
                gap / MM
            ),
            Warning::Anisotropic { material, ratio } => write!(
                f,
                "material `{material}` has E/2G − 1 = {ratio:.2}, more than an isotropic material can have: it is taken as anisotropic, with Poisson's ratio {TYPICAL_POISSON_RATIO} in its shear coefficient; state poisson_ratio if you know it"
            ),
        }
    }
}
