//! The Improved MultiCal paper (Sensors 2023, 23(12), 5717): its equations and its Table 2.

use approx::assert_relative_eq;
use rodcal::beam::Physics;
use rodcal::compliance::{Compliance, DEFAULT_ELEMENTS, closed_form, paper_contact_force, steps};
use rodcal::rod::Rod;

fn paper_rod(number: usize) -> Rod {
    let path = format!("{}/rods/{number}.toml", env!("CARGO_MANIFEST_DIR"));
    Rod::read(path.as_ref()).unwrap()
}

fn index_um(compliance: &Compliance) -> f64 {
    compliance.index(paper_contact_force()) * 1e6
}

/// Eqs 15 and 17 are the beam model with bending and torsion only: two derivations, one result.
#[test]
fn the_closed_form_is_the_beam_model_without_what_it_leaves_out() {
    for number in 4..=6 {
        let rod = paper_rod(number);
        let (calc, beam) = (
            closed_form::compliance(&rod).unwrap(),
            Compliance::of_model(&rod, &Physics::BENDING_AND_TORSION, 20).unwrap(),
        );
        assert!((calc.force - beam.force).amax() < 1e-12 * calc.force.amax(), "{calc:?} {beam:?}");
        assert!((calc.gravity - beam.gravity).amax() < 1e-12 * calc.gravity.amax(), "{calc:?} {beam:?}");
    }
}

/// Table 2, steel: c_rod of all three from one common section, within 1.5 %.
#[test]
fn table_2_steel_rods() {
    for (number, published) in [(4, 513.4), (5, 403.7), (6, 1306.2)] {
        for shear in [true, false] {
            let physics = Physics::default().with_shear(shear);
            let c = Compliance::of_model(&paper_rod(number), &physics, DEFAULT_ELEMENTS).unwrap();
            assert_relative_eq!(index_um(&c), published, max_relative = 0.015);
        }
    }
}

/// Table 2, carbon: the reconstructed model stands for the paper's FEA, c_rod / r_rod, within 4 %.
#[test]
fn table_2_carbon_rods() {
    for (number, published, factor) in [(1, 57.9, 1.226), (2, 63.1, 1.364), (3, 237.3, 2.302)] {
        let c = Compliance::of_model(&paper_rod(number), &Physics::default(), DEFAULT_ELEMENTS).unwrap();
        assert_relative_eq!(index_um(&c), published / factor, max_relative = 0.04);
    }
}

/// What the left-out terms add up to is the difference between Calc and FEA, exactly.
#[test]
fn the_steps_from_calc_to_fea_add_up() {
    for number in 1..=6 {
        let rod = paper_rod(number);
        let steps = steps(&rod, &Physics::default(), 50).unwrap();
        let whole = Compliance::of_model(&rod, &Physics::default(), 50).unwrap();
        let sum: nalgebra::Matrix3<f64> = steps.iter().map(|step| step.added.gravity).sum();
        assert!((sum - whole.gravity).amax() < 1e-12 * whole.gravity.amax());
    }
}

/// Calc refuses what its equations do not describe, and says why.
#[test]
fn calc_refuses_two_different_pipes() {
    let error = closed_form::compliance(&paper_rod(2)).unwrap_err();
    assert!(error.to_string().contains("pipe1 and pipe2 differ"), "{error}");
    assert_eq!(error.hint(), Some("use the finite-element model: --mode fea"));
}
