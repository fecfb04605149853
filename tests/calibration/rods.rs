//! A rod, its file, and the paper's equations for it written out once more.

use nalgebra::{Matrix3, Vector3};

use super::lab::TrueRod;

const E: f64 = 193e9;
const G: f64 = 74.8e9;
const DENSITY: f64 = 7930.0;
const L1: f64 = 0.150;
const L2: f64 = 0.525;
const OUTER: f64 = 0.016;
const INNER: f64 = 0.012;
const TIP_MASS: f64 = 0.060;

/// A rod softer than the paper's: it sags by millimetres.
pub const SOFT: &str = r#"
name = "soft"
[geometry]
l1_mm = 150
l2_mm = 525
[material.steel]
youngs_modulus_gpa = 193
shear_modulus_gpa = 74.8
density_kg_m3 = 7930
[pipe1]
material = "steel"
outer_diameter_mm = 16
inner_diameter_mm = 12
[pipe2]
material = "steel"
outer_diameter_mm = 16
inner_diameter_mm = 12
[tip]
mass_g = 60
"#;

/// Tip of the soft rod as drawn, in {T}, m.
pub fn tip() -> Vector3<f64> {
    Vector3::new(L2, 0.0, L1)
}

/// The soft rod by Eqs 15 and 17, which know no tip mass; on the flange it weighs all the same.
pub fn closed_form() -> TrueRod {
    let fourth = OUTER.powi(4) - INNER.powi(4);
    let (ei, gj) = (E * std::f64::consts::PI * fourth / 64.0, G * std::f64::consts::PI * fourth / 32.0);
    let per_length = DENSITY * std::f64::consts::PI * (OUTER * OUTER - INNER * INNER) / 4.0;
    let q = per_length * 9.80665;
    let f13 = -L1 * L1 * L2 / (2.0 * ei);
    let f22 = (L1.powi(3) + L2.powi(3)) / (3.0 * ei) + L1 * L2 * L2 / gj;
    let f33 = L2.powi(3) / (3.0 * ei) + L1 * L2 * L2 / ei;
    let g11 = L1.powi(3) * L2 / (3.0 * ei) + L1.powi(4) / (8.0 * ei);
    let g13 = -L1 * L1 * L2 * L2 / (4.0 * ei);
    let g31 = -(L1.powi(3) * L2 / (6.0 * ei) + L1 * L1 * L2 * L2 / (2.0 * ei));
    let g33 = L2.powi(4) / (8.0 * ei) + L1 * L2.powi(3) / (2.0 * ei);
    let bending = L2.powi(4) / (8.0 * ei) + L1.powi(3) * L2 / (3.0 * ei) + L1.powi(4) / (8.0 * ei);
    let g22 = bending + L1 * L2.powi(3) / (2.0 * gj);
    let (m1, m2) = (per_length * L1, per_length * L2);
    let mass = m1 + m2 + TIP_MASS;
    let moment =
        Vector3::new(0.0, 0.0, L1 / 2.0) * m1 + Vector3::new(L2 / 2.0, 0.0, L1) * m2 + tip() * TIP_MASS;
    TrueRod {
        mass,
        centre: moment / mass,
        force: Matrix3::new(L1.powi(3) / (3.0 * ei), 0.0, f13, 0.0, f22, 0.0, f13, 0.0, f33),
        gravity: q * Matrix3::new(g11, 0.0, g13, 0.0, g22, 0.0, g31, 0.0, g33),
    }
}
