//! Sections and materials.

use approx::assert_abs_diff_eq;
use approx::assert_relative_eq;
use rodcal::material::laminate::{Ply, wall};
use rodcal::section::Round;

/// Cowper (1966), Table I and Fig. 2 give three digits.
const THREE_DIGITS: f64 = 0.0006;

/// G. R. Cowper, J. Appl. Mech. 33 (1966) 335–340: solid circle, K = 6(1+ν)/(7+6ν).
#[test]
fn cowper_solid_circle() {
    let solid = Round { outer_diameter: 0.02, inner_diameter: 0.0 };
    for (nu, kappa) in [(0.0, 0.857), (0.3, 0.886), (0.5, 0.900)] {
        assert_abs_diff_eq!(solid.shear_coefficient(nu), kappa, epsilon = THREE_DIGITS);
    }
}

/// G. R. Cowper (1966): thin-walled round tube, K = 2(1+ν)/(4+3ν).
#[test]
fn cowper_thin_tube() {
    let thin = Round { outer_diameter: 1.0, inner_diameter: 0.9999 };
    for (nu, kappa) in [(0.0, 0.500), (0.3, 0.531), (0.5, 0.545)] {
        assert_abs_diff_eq!(thin.shear_coefficient(nu), kappa, epsilon = THREE_DIGITS);
    }
}

/// T300/5208 graphite–epoxy: S. W. Tsai, H. T. Hahn, *Introduction to Composite Materials* (1980), Table 1.7.
fn t300(angle_deg: f64) -> Ply {
    Ply { e1: 181e9, e2: 10.3e9, g12: 7.17e9, nu12: 0.28, thickness: 0.125e-3, angle: angle_deg.to_radians() }
}

/// A. K. Kaw, *Mechanics of Composite Materials*, 2nd ed. (2006), Example 2.6: Q̄ of a 60° ply, GPa, four digits.
#[test]
fn kaw_reduced_stiffness_of_a_60_degree_ply() {
    let q = t300(60.0).stiffness() / 1e9;
    let published = [
        ((0, 0), 23.65),
        ((0, 1), 32.46),
        ((1, 1), 109.4),
        ((0, 2), 20.05),
        ((1, 2), 54.19),
        ((2, 2), 36.74),
    ];
    for (entry, value) in published {
        assert_relative_eq!(q[entry], value, max_relative = 5e-4);
    }
}

/// Tsai & Hahn (1980), § 4.4: the quasi-isotropic [0/±45/90]s laminate, E 69.68 GPa, G 26.88 GPa, ν 0.296.
#[test]
fn tsai_hahn_quasi_isotropic_laminate() {
    let plies = [0.0, 45.0, -45.0, 90.0, 90.0, -45.0, 45.0, 0.0].map(t300);
    let wall = wall(&plies).unwrap();
    assert_relative_eq!(wall.youngs_modulus, 69.68e9, max_relative = 5e-4);
    assert_relative_eq!(wall.shear_modulus, 26.88e9, max_relative = 5e-4);
    assert_abs_diff_eq!(wall.poisson_ratio, 0.296, epsilon = 0.0006);
    assert_relative_eq!(wall.thickness, 1e-3, max_relative = 1e-12);
    assert!(wall.coupling < 1e-12);
}
