use nalgebra::{Matrix6, Rotation3};

use super::*;
use crate::beam::Profile;

const EI: f64 = 900.0;
const MASS: f64 = 0.8;

/// Bends in two planes alike, and nothing else.
const SLENDER: Profile = Profile {
    axial: 0.0,
    shear: [0.0; 2],
    bending: [1.0 / EI; 2],
    torsion: 1e-3,
    mass_per_length: MASS,
    rotary_inertia: [0.0; 2],
};

fn cantilever(profile: &Profile, length: f64, elements: usize) -> Chain {
    let mut chain = Chain::clamped_at(Vector3::zeros(), Rotation3::identity());
    chain.straight(profile, length, elements);
    chain
}

fn frequencies(chain: &Chain, count: usize) -> Vec<f64> {
    chain.natural_modes(count).unwrap().iter().map(|mode| mode.frequency).collect()
}

/// Where `f` changes its sign between `low` and `high`.
fn root(f: impl Fn(f64) -> f64, mut low: f64, mut high: f64) -> f64 {
    assert!(f(low) * f(high) < 0.0);
    for _ in 0..200 {
        let middle = 0.5 * (low + high);
        if f(low) * f(middle) <= 0.0 { high = middle } else { low = middle }
    }
    0.5 * (low + high)
}

/// f = (βL)²/(2πL²)·√(EI/μ).
fn of_beta(beta_l: f64, length: f64) -> f64 {
    beta_l.powi(2) / (std::f64::consts::TAU * length.powi(2)) * (EI / MASS).sqrt()
}

/// R. D. Blevins, *Formulas for Natural Frequency and Mode Shape*, 1979, Table 8-1, case 3.
#[test]
fn a_cantilever_swings_as_the_handbook_says() {
    let found = frequencies(&cantilever(&SLENDER, 0.7, 40), 4);
    for (found, beta_l) in found.iter().zip([1.87510407, 1.87510407, 4.69409113, 4.69409113]) {
        assert!((found / of_beta(beta_l, 0.7) - 1.0).abs() < 1e-6, "{found}");
    }
}

/// With η = tip mass/beam mass: 1 + cos βL cosh βL + η βL (cos βL sinh βL − sin βL cosh βL) = 0
/// (Blevins, Table 8-8, case 3).
#[test]
fn a_mass_at_the_tip_slows_a_cantilever() {
    for eta in [0.1, 1.0, 10.0] {
        let mut chain = cantilever(&SLENDER, 0.7, 40);
        chain.mass(eta * MASS * 0.7);
        let zero = |b: f64| 1.0 + b.cos() * b.cosh() + eta * b * (b.cos() * b.sinh() - b.sin() * b.cosh());
        let exact = of_beta(root(zero, 0.3, 1.8751), 0.7);
        assert!((frequencies(&chain, 1)[0] / exact - 1.0).abs() < 1e-7, "{eta}");
    }
}

/// T. C. Huang, *J. Appl. Mech.* 28 (1961) 579–584, clamped–free: short enough that shear and
/// rotary inertia take 13 % off.
#[test]
fn a_stubby_cantilever_swings_as_timoshenko_says() {
    let (length, radius2, shear) = (0.7f64, 0.003f64, 3e-6f64);
    let profile = Profile { shear: [shear; 2], rotary_inertia: [MASS * radius2; 2], ..SLENDER };
    let (r2, s2) = (radius2 / length.powi(2), EI * shear / length.powi(2));
    let zero = |b: f64| {
        let root = ((r2 - s2).powi(2) + 4.0 / (b * b)).sqrt();
        let (alpha, beta) = (((root - r2 - s2) / 2.0).sqrt(), ((root + r2 + s2) / 2.0).sqrt());
        2.0 + (b * b * (r2 - s2).powi(2) + 2.0) * (b * alpha).cosh() * (b * beta).cos()
            - b * (r2 + s2) / (1.0 - b * b * r2 * s2).sqrt() * (b * alpha).sinh() * (b * beta).sin()
    };
    let b = root(zero, 2.5, 3.516);
    let exact = b / (std::f64::consts::TAU * length.powi(2)) * (EI / MASS).sqrt();
    assert!((exact / of_beta(1.87510407, length) - 1.0).abs() > 0.01);
    let found = frequencies(&cantilever(&profile, length, 60), 1)[0];
    assert!((found / exact - 1.0).abs() < 2e-6, "{found} {exact}");
}

/// Waves of torsion and of extension: f = c/4L (Blevins, Tables 8-16 and 8-19).
#[test]
fn waves_run_up_and_down_a_rod() {
    let stiff = Profile { bending: [1e-12; 2], ..SLENDER };
    let twisting = Profile { rotary_inertia: [2e-4; 2], ..stiff };
    let exact = (1.0 / (1e-3 * 4e-4f64)).sqrt() / (4.0 * 0.7);
    let found = frequencies(&cantilever(&twisting, 0.7, 60), 1)[0];
    assert!((found / exact - 1.0).abs() < 1e-4, "{found} {exact}");
    let stretching = Profile { axial: 1e-6, ..stiff };
    let exact = (1.0 / (1e-6 * MASS)).sqrt() / (4.0 * 0.7);
    let found = frequencies(&cantilever(&stretching, 0.7, 60), 1)[0];
    assert!((found / exact - 1.0).abs() < 1e-4, "{found} {exact}");
}

/// An L that bends in its plane only, from the equations of its two beams: the second cannot
/// move along the first and rides on it as a mass (H. Bang, *J. Guidance* 19 (1996) 248–250).
#[test]
fn an_l_swings_in_its_plane_as_its_two_beams_together() {
    let (l1, l2) = (0.3, 0.5);
    let determinant = |beta: f64| {
        let (a, b) = (beta * l1, beta * l2);
        // w₁ = A (cosh − cos) + B (sinh − sin), w₂ = C cos + D sin + E cosh + F sinh
        Matrix6::new(
            // w₂ = 0 and w₂' = w₁', w₂'' = w₁'' at the corner
            0.0,
            0.0,
            1.0,
            0.0,
            1.0,
            0.0,
            a.sinh() + a.sin(),
            a.cosh() - a.cos(),
            0.0,
            -1.0,
            0.0,
            -1.0,
            a.cosh() + a.cos(),
            a.sinh() + a.sin(),
            1.0,
            0.0,
            -1.0,
            0.0,
            // EI w₁''' = −μ l₂ ω² w₁
            a.sinh() - a.sin() + b * (a.cosh() - a.cos()),
            a.cosh() + a.cos() + b * (a.sinh() - a.sin()),
            0.0,
            0.0,
            0.0,
            0.0,
            // the free end
            0.0,
            0.0,
            -b.cos(),
            -b.sin(),
            b.cosh(),
            b.sinh(),
            0.0,
            0.0,
            b.sin(),
            -b.cos(),
            b.sinh(),
            b.cosh(),
        )
        .determinant()
    };
    // out of the plane it is stiff
    let flat = Profile { bending: [1e-14, 1.0 / EI], torsion: 1e-14, ..SLENDER };
    let mut chain = cantilever(&flat, l1, 30);
    chain.turn(&Rotation3::from_axis_angle(&Vector3::y_axis(), std::f64::consts::FRAC_PI_2));
    chain.straight(&flat, l2, 30);
    let found = frequencies(&chain, 2);
    let betas = [(1.0, 3.0), (3.0, 6.5)].map(|(low, high)| root(determinant, low, high));
    for (found, beta) in found.iter().zip(betas) {
        assert!((found / of_beta(beta, 1.0) - 1.0).abs() < 1e-6, "{found} {}", of_beta(beta, 1.0));
    }
}

#[test]
fn finer_meshes_agree_on_a_rod_with_everything_on_it() {
    let rod = Rod::read("rods/2.toml".as_ref()).unwrap();
    let rod = rod.with_bend(0.05, crate::rod::BendFlexibility::VonKarman);
    let of_elements = |elements| RodModel::new(&rod, &Physics::WHOLE, elements, &[]).unwrap().chain;
    let (coarse, fine) = (frequencies(&of_elements(ELEMENTS), 4), frequencies(&of_elements(400), 4));
    for (coarse, fine) in coarse.iter().zip(&fine) {
        assert!((coarse / fine - 1.0).abs() < 2e-5, "{coarse} {fine}");
    }
    assert!((coarse[0] / fine[0] - 1.0).abs() < 1e-6, "{} {}", coarse[0], fine[0]);
    let first = rod.first_frequency().unwrap().unwrap();
    assert!((first / fine[0] - 1.0).abs() < 1e-5, "{first} {}", fine[0]);
}

/// A wire of 32 µm is no reason not to answer: c₂₂ = 1/k and the tip's mass alone.
#[test]
fn a_wire_with_a_heavy_tip_settles() {
    let wire = Profile { bending: [1.0 / (EI * 1e-11); 2], mass_per_length: MASS * 1e-6, ..SLENDER };
    let mut chain = cantilever(&wire, 0.5, FEW);
    chain.mass(0.06);
    let exact = (3.0 * EI * 1e-11 / (0.06 * 0.125f64)).sqrt() / std::f64::consts::TAU;
    let found = chain.modes(1, FEW_GUARD, ROUGHLY).unwrap()[0].frequency;
    assert!((found / exact - 1.0).abs() < 1e-4, "{found} {exact}");
}

#[test]
fn a_spring_alone_carries_a_mass() {
    // a rigid bar of 0.5 m on a joint: ω² = 1/(c m L²)
    let rigid = Profile { bending: [1e-15; 2], torsion: 1e-15, mass_per_length: 0.0, ..SLENDER };
    let mut chain = Chain::clamped_at(Vector3::zeros(), Rotation3::identity());
    chain.spring(2e-4, 1e-15);
    chain.straight(&rigid, 0.5, 3);
    chain.mass(0.3);
    let exact = (1.0f64 / (2e-4 * 0.3 * 0.25)).sqrt() / std::f64::consts::TAU;
    let modes = chain.natural_modes(9).unwrap();
    assert!((modes[0].frequency / exact - 1.0).abs() < 1e-9 && modes.len() <= 3, "{}", modes.len());
    assert!((modes[0].shape[4][0].norm() - 1.0).abs() < 1e-12);
}
