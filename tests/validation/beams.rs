//! Beams: closed forms and the benchmarks by which finite-element programs are judged.

use std::f64::consts::{FRAC_PI_2, PI};

use approx::assert_relative_eq;
use nalgebra::{Rotation3, Vector3};
use rodcal::beam::{Chain, Load, Physics, Profile, RodModel};
use rodcal::compliance::Compliance;
use rodcal::rod::Rod;
use rodcal::section::Round;

/// The reference has eight or nine digits.
const PRINTED_DIGITS: f64 = 3e-8;
/// Straight elements are exact; what is left is rounding.
const EXACT: f64 = 1e-9;
/// The same at 20 000 elements.
const EXACT_AT_20_000: f64 = 1e-7;

const UM_PER_N: f64 = 1e-6;

/// The rod of the project's reference: L1 300, L2 450, tube 16 × 12, E 193 GPa, ν 0.29, ρ 7930,
/// Timoshenko, Cowper.
fn reference_rod(geometry: &str) -> Rod {
    let text = format!(
        r#"
        name = "reference"
        [geometry]
        l1_mm = 300.0
        l2_mm = 450.0
        {geometry}
        [material.steel]
        youngs_modulus_gpa = 193.0
        poisson_ratio = 0.29
        density_kg_m3 = 7930.0
        [pipe1]
        material = "steel"
        outer_diameter_mm = 16.0
        inner_diameter_mm = 12.0
        [pipe2]
        material = "steel"
        outer_diameter_mm = 16.0
        inner_diameter_mm = 12.0
        "#
    );
    Rod::from_toml("reference.toml", &text).unwrap()
}

fn compliance(geometry: &str, elements: usize) -> Compliance {
    Compliance::of_model(&reference_rod(geometry), &Physics::default(), elements).unwrap()
}

/// Castigliano's theorem with axial and shear terms, evaluated independently (see
/// tests/references).
#[test]
fn castigliano_sharp_corner_at_2_to_2000_elements() {
    let published = [((0, 0), 21.314804), ((0, 2), -47.711141), ((1, 1), 277.622146), ((2, 2), 214.842826)];
    let exact = compliance("", 2);
    for (entry, value) in published {
        assert_relative_eq!(exact.force[entry] / UM_PER_N, value, max_relative = PRINTED_DIGITS);
    }
    for elements in [2, 20, 200, 2000, 20_000] {
        let tolerance = if elements > 2000 { EXACT_AT_20_000 } else { EXACT };
        let fine = compliance("", elements);
        assert!((fine.force - exact.force).amax() <= tolerance * exact.force.amax(), "{elements} elements");
        assert!(
            (fine.gravity - exact.gravity).amax() <= tolerance * exact.gravity.amax(),
            "{elements} elements"
        );
    }
}

/// Castigliano along a quarter circle of radius 40 mm between the pipes.
#[test]
fn castigliano_arc_of_radius_40() {
    for elements in [3, 20, 200] {
        let c = compliance("bend_radius_mm = 40.0", elements);
        assert_relative_eq!(c.force[(2, 2)] / UM_PER_N, 206.412067, max_relative = PRINTED_DIGITS);
        assert_relative_eq!(c.force[(1, 1)] / UM_PER_N, 267.730628, max_relative = PRINTED_DIGITS);
    }
}

/// Castigliano for an inside angle of 120°.
#[test]
fn castigliano_inside_angle_120() {
    let c = compliance("gamma_deg = 120.0", 20);
    assert_relative_eq!(c.force[(0, 0)] / UM_PER_N, 122.725607, max_relative = PRINTED_DIGITS);
    assert_relative_eq!(c.force[(2, 2)] / UM_PER_N, 161.143164, max_relative = PRINTED_DIGITS);
}

/// S. Timoshenko, *Strength of Materials* I, 3rd ed., § 21 and 39: a cantilever of length L under
/// its own weight q, δ = qL⁴/8EI + qL²/2κGA, θ = qL³/6EI, and along its axis qL²/2EA.
#[test]
fn a_cantilever_under_its_own_weight() {
    let profile = Profile {
        axial: 2e-7,
        shear: [5e-6; 2],
        bending: [2e-3; 2],
        torsion: 4e-3,
        mass_per_length: 0.7,
        rotary_inertia: [0.0; 2],
    };
    let (length, q) = (0.8f64, 0.7);
    for count in [1, 7, 200] {
        let mut chain = Chain::clamped_at(Vector3::zeros(), Rotation3::identity());
        chain.straight(&profile, length, count);
        let tip = *chain.solve(&[Load::SelfWeight]).unwrap().motion(chain.end(), 0);
        let bending = q * length.powi(4) / 8.0 * 2e-3;
        let shear = q * length.powi(2) / 2.0 * 5e-6;
        assert_relative_eq!(tip.translation[(0, 0)], bending + shear, max_relative = EXACT);
        assert_relative_eq!(tip.rotation[(1, 0)], q * length.powi(3) / 6.0 * 2e-3, max_relative = EXACT);
        assert_relative_eq!(tip.translation[(2, 2)], q * length.powi(2) / 2.0 * 2e-7, max_relative = EXACT);
    }
}

/// A rectangle b (along local x) by h (along local y): A, I, Roark's torsion constant and Cowper's
/// κ.
fn rectangle(b: f64, h: f64, e: f64, nu: f64) -> Profile {
    let (area, g) = (b * h, e / (2.0 * (1.0 + nu)));
    // Roark's Formulas, 7th ed., Table 10.1, case 4
    let (long, short) = (b.max(h) / 2.0, b.min(h) / 2.0);
    let ratio = short / long;
    let j = long * short.powi(3) * (16.0 / 3.0 - 3.36 * ratio * (1.0 - ratio.powi(4) / 12.0));
    // Cowper (1966), rectangle
    let kappa = 10.0 * (1.0 + nu) / (12.0 + 11.0 * nu);
    Profile {
        axial: 1.0 / (e * area),
        shear: [1.0 / (kappa * g * area); 2],
        bending: [12.0 / (e * b * h.powi(3)), 12.0 / (e * h * b.powi(3))],
        torsion: 1.0 / (g * j),
        mass_per_length: 0.0,
        rotary_inertia: [0.0; 2],
    }
}

fn tip_of(chain: &Chain) -> nalgebra::Matrix3<f64> {
    let node = chain.end();
    chain.solve(&[Load::Force { node }]).unwrap().motion(node, 0).translation
}

/// R. H. MacNeal, R. L. Harder, "A proposed standard set of problems to test finite element
/// accuracy", Finite Elements in Analysis and Design 1 (1985) 3–20, Table 3: straight cantilever 6
/// × 0.2 × 0.1, E 1e7, ν 0.30, unit end loads. Their theory is beam theory with shear: four printed
/// digits.
#[test]
fn macneal_harder_straight_beam() {
    let mut chain = Chain::clamped_at(Vector3::zeros(), Rotation3::identity());
    chain.straight(&rectangle(0.2, 0.1, 1e7, 0.3), 6.0, 6);
    let c = tip_of(&chain);
    assert_relative_eq!(c[(2, 2)], 3.0e-5, max_relative = 1e-6);
    assert_relative_eq!(c[(0, 0)], 0.1081, max_relative = 5e-4);
    assert_relative_eq!(c[(1, 1)], 0.4321, max_relative = 5e-4);
}

/// MacNeal & Harder (1985), Table 5: quarter circle, radii 4.12 and 4.32, thickness 0.1, E 1e7, ν
/// 0.25, unit end loads: 0.08734 in the plane, 0.5022 out of it. Their in-plane value is not that
/// of beam theory (a slender curved beam gives πPR³/4EI = 0.0885), so one and a half per cent is as
/// near as a beam comes.
#[test]
fn macneal_harder_curved_beam() {
    let mut chain = Chain::clamped_at(Vector3::zeros(), Rotation3::identity());
    chain.arc(&rectangle(0.2, 0.1, 1e7, 0.25), 4.22, FRAC_PI_2, 6);
    let c = tip_of(&chain);
    // the free end points along x; its in-plane transverse direction is z
    assert_relative_eq!(c[(2, 2)], 0.08734, max_relative = 0.015);
    assert_relative_eq!(c[(1, 1)], 0.5022, max_relative = 0.005);
}

/// MacNeal & Harder (1985), Table 6: length 12, width 1.1, depth 0.32, twisted by 90°, E 29e6, ν
/// 0.22, unit end loads: 0.005424 in the plane of the tip's width, 0.001754 across it. Twelve
/// pieces, each at its mean angle, stand for the continuous twist.
#[test]
fn macneal_harder_twisted_beam() {
    const PIECES: usize = 48;
    let profile = rectangle(1.1, 0.32, 29e6, 0.22);
    let step = Rotation3::from_axis_angle(&Vector3::z_axis(), FRAC_PI_2 / PIECES as f64);
    let half = Rotation3::from_axis_angle(&Vector3::z_axis(), FRAC_PI_2 / PIECES as f64 / 2.0);
    let mut chain = Chain::clamped_at(Vector3::zeros(), Rotation3::identity());
    for _ in 0..PIECES {
        chain.turn(&half);
        chain.straight(&profile, 12.0 / PIECES as f64, 1);
        chain.turn(&(half.inverse() * step));
    }
    let c = tip_of(&chain);
    let (soft, stiff) = (c[(0, 0)].max(c[(1, 1)]), c[(0, 0)].min(c[(1, 1)]));
    assert_relative_eq!(soft, 0.005424, max_relative = 0.005);
    assert_relative_eq!(stiff, 0.001754, max_relative = 0.005);
}

/// The tube of the VPCS arcs, 20 × 16 mm, E 200 GPa, ν 0.3, without shear and extension as in the
/// guide's theory.
fn vpcs_tube() -> Profile {
    let tube = Round { outer_diameter: 0.020, inner_diameter: 0.016 };
    let (e, g) = (2e11, 2e11 / 2.6);
    Profile {
        axial: 0.0,
        shear: [0.0; 2],
        bending: [1.0 / (e * tube.second_moment()); 2],
        torsion: 1.0 / (g * tube.torsion_constant()),
        mass_per_length: 0.0,
        rotary_inertia: [0.0; 2],
    }
}

/// AFNOR/SFM, *Guide de validation des progiciels de calcul de structures* (VPCS, 1990), SSLL06:
/// quarter circle of R = 3 m clamped at one end; at the other F1 = 10 N across the tangent there,
/// F2 = 5 N along it, and Mz = 8 N·m in the plane: u = 0.3791 m along F1, v = 0.2417 m along F2,
/// θ = 0.1654 rad, all in the sense of the loads.
#[test]
fn vpcs_ssll06_arc_in_plane() {
    let mut chain = Chain::clamped_at(Vector3::zeros(), Rotation3::identity());
    chain.arc(&vpcs_tube(), 3.0, FRAC_PI_2, 4);
    let node = chain.end();
    let response = chain.solve(&[Load::Force { node }, Load::Couple { node }]).unwrap();
    // Clamped along z, the arc ends along x: across its end is z, and loads that open the bend act
    // along +z, −x and −y (a moment about +y closes it).
    let (force, couple) = (response.motion(node, 0), response.motion(node, 1));
    let load = Vector3::new(-5.0, 0.0, 10.0);
    let moment = Vector3::new(0.0, -8.0, 0.0);
    let translation = force.translation * load + couple.translation * moment;
    let rotation = force.rotation * load + couple.rotation * moment;
    assert_relative_eq!(translation.z, 0.3791, max_relative = 2e-4);
    assert_relative_eq!(-translation.x, 0.2417, max_relative = 2e-4);
    assert_relative_eq!(-rotation.y, 0.1654, max_relative = 5e-4);
}

/// VPCS SSLL07: quarter circle of R = 1 m, 100 N out of its plane at the free end: the end moves by
/// 0.13462 m, and at θ = 15° torsion is 74.1180 N·m and bending −96.5925 N·m.
#[test]
fn vpcs_ssll07_arc_out_of_plane() {
    let mut chain = Chain::clamped_at(Vector3::zeros(), Rotation3::identity());
    chain.arc(&vpcs_tube(), 1.0, FRAC_PI_2, 6);
    let node = chain.end();
    let load = Load::Force { node };
    let response = chain.solve(&[load]).unwrap();
    assert_relative_eq!(100.0 * response.motion(node, 0).translation[(1, 1)], 0.13462, max_relative = 1e-4);

    // node 1 of 6 is 15° from the clamp
    let angle = PI / 12.0;
    let moment = chain.resultant(load, 1).moment.column(1) * 100.0;
    let tangent = Vector3::new(angle.sin(), 0.0, angle.cos());
    let normal = Vector3::new(angle.cos(), 0.0, -angle.sin());
    assert_relative_eq!(moment.dot(&tangent).abs(), 74.1180, max_relative = 2e-6);
    assert_relative_eq!(moment.dot(&normal).abs(), 96.5925, max_relative = 2e-6);
}

/// A joint of bending compliance b at station s adds b·(lever)² to the tip's compliance across the
/// lever.
#[test]
fn a_joint_turns_everything_beyond_it() {
    let rod = reference_rod("");
    let with_joint = |station: f64, bending: f64, torsion: f64| {
        let mut rod = rod.clone();
        rod.joints.push(rodcal::rod::Joint::new("j", station, bending, torsion));
        Compliance::of_model(&rod, &Physics::default(), 10).unwrap().force
    };
    let plain = Compliance::of_model(&rod, &Physics::default(), 10).unwrap().force;
    // at 500 mm: 200 mm into pipe II, 250 mm before the tip
    let bent = with_joint(0.5, 4e-4, 0.0) - plain;
    assert_relative_eq!(bent[(2, 2)], 4e-4 * 0.25f64.powi(2), max_relative = 1e-9);
    assert_relative_eq!(bent[(1, 1)], 4e-4 * 0.25f64.powi(2), max_relative = 1e-9);
    // torsion at 100 mm, in pipe I: the tip swings about pipe I's axis by L2
    let twisted = with_joint(0.1, 0.0, 4e-4) - plain;
    assert_relative_eq!(twisted[(1, 1)], 4e-4 * 0.45f64.powi(2), max_relative = 1e-9);
    assert!(twisted[(2, 2)].abs() < 1e-15);
    // exactly at the sharp corner the joint's axis is pipe I's
    let corner = with_joint(0.3, 0.0, 4e-4) - plain;
    assert_relative_eq!(corner[(1, 1)], 4e-4 * 0.45f64.powi(2), max_relative = 1e-9);
}

/// J. M. Gere, *Mechanics of Materials*, 6th ed., § 9.7, example 9-14: a cantilever of length L
/// with 2I over the half at its root and I over the other sinks by 3PL³/16EI at its end. Here the
/// second I is that of a sleeve.
#[test]
fn a_cantilever_that_is_twice_as_stiff_in_its_half_at_the_root() {
    let rod = reference_rod("gamma_deg = 180.0");
    let length = rod.length();
    let sleeve = rodcal::section::General {
        area: 1e-4,
        iy: rod.pipe1.section.second_moment(),
        iz: rod.pipe1.section.second_moment(),
        torsion_constant: 1e-9,
        shear_coefficient: 0.5,
    };
    let sleeve = rodcal::rod::Pipe::new(sleeve, rod.pipe1.material.clone());
    let rod = rod.with_sleeve("over the half", 0.0, length / 2.0, sleeve);
    let physics = Physics::BENDING_AND_TORSION.with_sleeves(true);
    let ei = 193e9 * rod.pipe1.section.second_moment();
    let found = Compliance::of_model(&rod, &physics, 7).unwrap().force;
    let expected = 3.0 * length.powi(3) / (16.0 * ei);
    assert_relative_eq!(found[(0, 0)], expected, max_relative = EXACT);
    assert_relative_eq!(found[(1, 1)], expected, max_relative = EXACT);
}

/// Displacement at mid-rod under a force at mid-rod is that of the shorter cantilever.
#[test]
fn a_station_between_flange_and_tip_can_be_loaded_and_read() {
    let rod = reference_rod("gamma_deg = 180.0");
    let model = RodModel::new(&rod, &Physics::default().with_shear(false), 7, &[0.2, 0.5]).unwrap();
    let ei = 193e9 * rod.pipe1.section.second_moment();
    // Roark's Formulas, 7th ed., Table 8.1, case 1a: force at a = 0.5 m read at x = 0.2 m: δ =
    // x²(3a − x)/6EI
    let motion = model.force_response(0.5, 0.2).unwrap();
    assert_relative_eq!(motion.translation[(0, 0)], 0.04 * (1.5 - 0.2) / (6.0 * ei), max_relative = 1e-9);
    // rotation there: θ = x(2a − x)/2EI about +y
    assert_relative_eq!(motion.rotation[(1, 0)], 0.2 * (1.0 - 0.2) / (2.0 * ei), max_relative = 1e-9);
}

/// Flexibility factors of a thin bend: tube 16 × 12, radius 40 mm, so h = tR/r² = 1.6327.
/// Reference: the unit-load integral with the arc's bending flexibility times k
/// (tests/references/README.md): von Kármán k = (10 + 12h²)/(1 + 12h²) = 1.272837, ASME B31.3 k =
/// 1.65/h = 1.010625. A solid model gives 212.80 and 270.63.
#[test]
fn flexibility_factors_of_the_bend() {
    let cases = [("\"von-karman\"", 214.0774, 271.5795), ("\"asme-b31.3\"", 206.7106, 267.8805)];
    for (name, c33, c22) in cases {
        let c = compliance(&format!("bend_radius_mm = 40.0\nbend_flexibility = {name}"), 20);
        assert_relative_eq!(c.force[(2, 2)] / UM_PER_N, c33, max_relative = 3e-7);
        assert_relative_eq!(c.force[(1, 1)] / UM_PER_N, c22, max_relative = 3e-7);
    }
    // the same factor given as a number
    let by_number = compliance("bend_radius_mm = 40.0\nbend_flexibility = 1.272837", 20);
    assert_relative_eq!(by_number.force[(2, 2)] / UM_PER_N, 214.0774, max_relative = 1e-6);
    // the solid lies between the beam and von Kármán's factor
    let beam = compliance("bend_radius_mm = 40.0", 20);
    assert!(beam.force[(2, 2)] / UM_PER_N < 212.80 && 212.80 < 214.0774);
}
