//! Sections and materials.

use approx::assert_abs_diff_eq;
use approx::assert_relative_eq;
use rodcal::beam::Physics;
use rodcal::compliance::{Compliance, closed_form};
use rodcal::material::Material;
use rodcal::material::laminate::{Ply, wall};
use rodcal::rod::{BendFlexibility, Pipe, Rod};
use rodcal::section::{General, Rectangle, Round, Section};

/// Cowper (1966), Table I and Fig. 2 give three digits.
const THREE_DIGITS: f64 = 0.0006;

/// G. R. Cowper, J. Appl. Mech. 33 (1966) 335–340: solid circle, K = 6(1+ν)/(7+6ν).
#[test]
fn cowper_solid_circle() {
    let solid = Round { outer_diameter: 0.02, inner_diameter: 0.0 };
    for (nu, kappa) in [(0.0, 0.857), (0.3, 0.886), (0.5, 0.900)] {
        assert_abs_diff_eq!(solid.shear_coefficient(2.0 * (1.0 + nu), nu), kappa, epsilon = THREE_DIGITS);
    }
}

/// G. R. Cowper (1966): thin-walled round tube, K = 2(1+ν)/(4+3ν).
#[test]
fn cowper_thin_tube() {
    let thin = Round { outer_diameter: 1.0, inner_diameter: 0.9999 };
    for (nu, kappa) in [(0.0, 0.500), (0.3, 0.531), (0.5, 0.545)] {
        assert_abs_diff_eq!(thin.shear_coefficient(2.0 * (1.0 + nu), nu), kappa, epsilon = THREE_DIGITS);
    }
}

/// The formula for any E/G is Cowper's where the material is isotropic.
#[test]
fn cowper_is_the_isotropic_case() {
    for m in [0.0, 0.3, 0.75, 0.96] {
        for nu in [-0.2, 0.0, 0.29, 0.5] {
            let ring = (1.0 + m * m) * (1.0 + m * m);
            let cowper = 6.0 * (1.0 + nu) * ring / ((7.0 + 6.0 * nu) * ring + (20.0 + 12.0 * nu) * m * m);
            let ours = Round::tube(1.0, m).shear_coefficient(2.0 * (1.0 + nu), nu);
            assert_relative_eq!(ours, cowper, max_relative = 1e-14);
        }
    }
}

/// G. R. Cowper (1966): rectangle, K = 10(1+ν)/(12+11ν).
#[test]
fn cowper_rectangle() {
    for nu in [0.0, 0.3, 0.5] {
        let [kappa, other] = Rectangle::solid(0.01, 0.02).shear_coefficients(2.0 * (1.0 + nu), nu);
        assert_relative_eq!(kappa, 10.0 * (1.0 + nu) / (12.0 + 11.0 * nu), max_relative = 1e-14);
        assert_eq!(kappa, other);
    }
}

const E: f64 = 200e9;
const NU: f64 = 0.25;
const G: f64 = 80e9;

/// An L of 300 and 400 mm.
fn rod_of(section: impl Into<Section>) -> Rod {
    let steel = Material::isotropic("steel", E, NU, 7850.0);
    Rod::new("bar", 0.3, 0.4, Pipe::new(section, steel)).checked().unwrap()
}

fn compliance(rod: &Rod) -> Compliance {
    Compliance::of_model(rod, &Physics::default(), 10).unwrap()
}

/// A bar of 10 × 20 mm, upright in the rod's plane, by Castigliano's theorem: I_y = 10·20³/12,
/// I_z = 20·10³/12 mm⁴, J = 0.2287·20·10³ mm⁴ (Timoshenko & Goodier, art. 109: 0.229), κ = 50/59.
#[test]
fn a_rectangular_bar_bends_by_its_two_second_moments() {
    let (l1, l2) = (0.3f64, 0.4f64);
    let (area, iy, iz) = (2e-4, 10e-3 * 8e-6 / 12.0, 20e-3 * 1e-6 / 12.0);
    let kappa = 10.0 * (1.0 + NU) / (12.0 + 11.0 * NU);
    let bar = Rectangle::solid(0.010, 0.020);
    let j = bar.torsion_constant();
    assert_abs_diff_eq!(j / (20e-3 * 1e-6), 0.229, epsilon = 5e-4);
    let found = compliance(&rod_of(bar));
    let c11 = l1.powi(3) / (3.0 * E * iy) + l1 / (kappa * G * area) + l2 / (E * area);
    let c33 = (l2.powi(3) / 3.0 + l1 * l2.powi(2)) / (E * iy) + l2 / (kappa * G * area) + l1 / (E * area);
    let c13 = -l1.powi(2) * l2 / (2.0 * E * iy);
    let c22 = (l1.powi(3) + l2.powi(3)) / (3.0 * E * iz)
        + l1 * l2.powi(2) / (G * j)
        + (l1 + l2) / (kappa * G * area);
    for (entry, by_hand) in [((0, 0), c11), ((2, 2), c33), ((0, 2), c13), ((2, 0), c13), ((1, 1), c22)] {
        assert_relative_eq!(found.force[entry], by_hand, max_relative = 1e-12);
    }
    // by hand, bending alone: L2³/3EI_y + L1L2²/EI_y = 0.0693333/1333.33 m/N = 52.0 µm/N
    assert_abs_diff_eq!((found.force[(2, 2)] - l2 / (kappa * G * area)) * 1e6, 52.0, epsilon = 0.01);
}

/// In plane only I_y counts, out of it only I_z and J, in straight pipes and in an arc.
#[test]
fn each_second_moment_has_its_plane() {
    let general = General { area: 2e-4, iy: 6e-9, iz: 2e-9, torsion_constant: 4e-9, shear_coefficient: 0.85 };
    for radius in [0.0, 0.06] {
        let compliance_of = |general: General| {
            let rod = rod_of(general).with_bend(radius, BendFlexibility::Factor(1.3));
            compliance(&rod.checked().unwrap()).force
        };
        let (as_is, iy, iz) = (
            compliance_of(general),
            compliance_of(General { iy: 9e-9, ..general }),
            compliance_of(General { iz: 3e-9, ..general }),
        );
        for in_plane in [(0, 0), (0, 2), (2, 2)] {
            assert_relative_eq!(as_is[in_plane], iz[in_plane], max_relative = 1e-14);
            assert!((iy[in_plane] / as_is[in_plane]).abs() < 0.7, "{in_plane:?}");
        }
        assert_relative_eq!(as_is[(1, 1)], iy[(1, 1)], max_relative = 1e-14);
        assert!(iz[(1, 1)] < 0.9 * as_is[(1, 1)]);
    }
}

/// A section given by a round's constants is that round; Calc knows both planes.
#[test]
fn a_section_by_its_constants_is_the_same_section() {
    let round = Round::tube(0.016, 0.012);
    let general = General {
        area: round.area(),
        iy: round.second_moment(),
        iz: round.second_moment(),
        torsion_constant: round.torsion_constant(),
        shear_coefficient: round.shear_coefficient(2.5, NU),
    };
    let (a, b) = (compliance(&rod_of(round)), compliance(&rod_of(general)));
    assert_relative_eq!(a.force, b.force, max_relative = 1e-13);
    assert_relative_eq!(a.gravity, b.gravity, max_relative = 1e-13);
    let bar = rod_of(Rectangle::hollow(0.010, 0.020, 0.001));
    let calc = closed_form::compliance(&bar).unwrap();
    let beam = Compliance::of_model(&bar, &Physics::BENDING_AND_TORSION, 10).unwrap();
    assert!((calc.force - beam.force).amax() < 1e-12 * calc.force.amax());
    assert!((calc.gravity - beam.gravity).amax() < 1e-12 * calc.gravity.amax());
}

/// T300/5208 graphite–epoxy: S. W. Tsai, H. T. Hahn, *Introduction to Composite Materials* (1980),
/// Table 1.7.
fn t300(angle_deg: f64) -> Ply {
    Ply::new([181e9, 10.3e9, 7.17e9], 0.28, 0.125e-3).at_angle(angle_deg.to_radians())
}

/// A. K. Kaw, *Mechanics of Composite Materials*, 2nd ed. (2006), Example 2.6: Q̄ of a 60° ply,
/// GPa, four digits.
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

/// Tsai & Hahn (1980), § 4.4: the quasi-isotropic [0/±45/90]s laminate, E 69.68 GPa, G 26.88 GPa, ν
/// 0.296.
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
