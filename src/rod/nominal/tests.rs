use super::*;
use crate::rod::{BendFlexibility, Joint};
use crate::section::{Rectangle, Round};
use approx::assert_relative_eq;

fn material(name: &str) -> Material {
    Material::isotropic(name, 193e9, 0.29, 7930.0)
}

/// 150 and 525 mm, a bend of 50 mm in the tube of pipe 1, a box as pipe 2.
fn rod() -> Rod {
    let joint = |name: &str, station| Joint { name: name.into(), station, bending: 1e-6, torsion: 0.0 };
    let rod = Rod::new("r", 0.150, 0.525, Pipe::new(Round::tube(0.032, 0.030), material("steel")))
        .with_bend(0.050, BendFlexibility::Beam)
        .with_pipe2(Pipe::new(Rectangle::hollow(0.02, 0.03, 0.001), material("aluminium")))
        .with_tip_mass(0.06);
    let (end, tip) = (rod.bend_end(), rod.length());
    rod.with_joint(joint("at the bend", end))
        .with_joint(joint("sleeve", 0.4))
        .with_mass("ring", 0.4, 0.03)
        .with_mass("holder", tip, 0.01)
        .with_sleeve("collar", 0.6, tip, Pipe::new(Rectangle::solid(0.03, 0.04), material("brass")))
        .checked()
        .unwrap()
}

#[test]
fn every_number_that_is_not_exact_is_there_with_its_uncertainty() {
    let (rod, percent) = (rod(), 0.01);
    let found: Vec<(String, f64, f64)> = rod
        .nominal_numbers()
        .into_iter()
        .map(|n| (n.number.to_string(), n.value, n.standard_uncertainty))
        .collect();
    let g = 193e9 / 2.58;
    let mut expected = vec![
        ("l1".to_owned(), 0.150, 0.3e-3),
        ("l2".to_owned(), 0.525, 0.3e-3),
        ("bend radius".to_owned(), 0.050, 0.3e-3),
    ];
    for name in ["steel", "aluminium", "brass"] {
        expected.extend([
            (format!("E of {name}"), 193e9, 193e9 * percent),
            (format!("G of {name}"), g, g * 2.0 * percent),
            (format!("density of {name}"), 7930.0, 7930.0 * percent),
            (format!("shear coefficient of {name}"), 1.0, 3.0 * percent),
        ]);
    }
    for (name, value) in [
        ("outer diameter of pipe 1", 0.032),
        ("inner diameter of pipe 1", 0.030),
        ("width of pipe 2", 0.02),
        ("height of pipe 2", 0.03),
        ("wall of pipe 2", 0.001),
        ("width of sleeve 1", 0.03),
        ("height of sleeve 1", 0.04),
    ] {
        expected.push((name.to_owned(), value, 0.03e-3));
    }
    expected.push(("tip mass".to_owned(), 0.06, 0.5e-3));
    expected.push(("station of mass ring".to_owned(), 0.4, 0.3e-3));
    expected.push(("station of joint sleeve".to_owned(), 0.4, 0.3e-3));
    // its end is the tip's
    expected.push(("beginning of sleeve 1".to_owned(), 0.6, 0.3e-3));
    assert_eq!(found.len(), expected.len(), "{found:?}");
    for (found, expected) in found.iter().zip(&expected) {
        assert_eq!(found.0, expected.0);
        assert_relative_eq!(found.1, expected.1, max_relative = 1e-14);
        assert_relative_eq!(found.2, expected.2, max_relative = 1e-12);
    }
    let mut exact = rod;
    exact.standard_uncertainty.length = 0.0;
    exact.pipe2.material.standard_uncertainty.youngs_modulus = 0.0;
    let left: Vec<String> = exact.nominal_numbers().iter().map(|n| n.number.to_string()).collect();
    assert!(!left.iter().any(|name| name.contains("station") || name == "l1"), "{left:?}");
    assert!(left.contains(&"E of steel".into()) && !left.contains(&"E of aluminium".into()));
}

#[test]
fn one_number_changes_and_nothing_else() {
    let rod = rod();
    for Nominal { number, value, standard_uncertainty } in rod.nominal_numbers() {
        assert_eq!(rod.with(&number, value), rod, "{number}");
        let changed = rod.with(&number, value + standard_uncertainty);
        assert_ne!(changed, rod, "{number}");
        assert_eq!(changed.value_of(&number), Some(value + standard_uncertainty));
        assert!(changed.clone().checked().is_ok(), "{number}");
        for other in rod.nominal_numbers().into_iter().filter(|other| other.number != number) {
            assert_eq!(changed.value_of(&other.number), Some(other.value), "{number} {}", other.number);
        }
    }
    let unknown = NominalNumber::YoungsModulus("lead".into());
    assert_eq!((rod.with(&unknown, 1.0), rod.value_of(&unknown)), (rod.clone(), None));
}

#[test]
fn what_sits_at_an_end_goes_with_it_and_the_rest_stays() {
    let rod = rod();
    for (number, value) in [
        (NominalNumber::LengthL1, 0.149),
        (NominalNumber::LengthL2, 0.524),
        (NominalNumber::LengthL2, 0.526),
        (NominalNumber::BendRadius, 0.051),
    ] {
        let changed = rod.with(&number, value);
        assert_relative_eq!(changed.joints[0].station, changed.bend_end(), max_relative = 1e-14);
        assert_eq!((changed.joints[1].station, changed.masses[0].station), (0.4, 0.4));
        assert_relative_eq!(changed.masses[1].station, changed.length(), max_relative = 1e-14);
    }
    let ring = NominalNumber::Station(Feature::Mass("ring".into()));
    let moved = rod.with(&ring, 0.41);
    assert_eq!((moved.masses[0].station, moved.joints[1].station), (0.41, 0.4));
}

#[test]
fn a_bend_of_the_tube_of_pipe_1_goes_with_it_and_another_does_not() {
    let mut rod = rod();
    let outer = NominalNumber::OuterDiameter(Part::Pipe1);
    let changed = rod.with(&outer, 0.033);
    assert_eq!(changed.bend.section, changed.pipe1.section);
    rod.bend.section = Round::tube(0.033, 0.029).into();
    assert_eq!(rod.with(&outer, 0.034).bend, rod.bend);
    let names: Vec<String> = rod.nominal_numbers().iter().map(|n| n.number.to_string()).collect();
    assert!(names.contains(&"outer diameter of the bend".to_owned()), "{names:?}");
}

#[test]
fn pipes_that_were_corrected_apart_keep_their_ratio() {
    let mut rod = rod();
    rod.pipe2.material = Material { youngs_modulus: 0.8 * 193e9, ..material("steel") };
    let changed = rod.with(&NominalNumber::YoungsModulus("steel".into()), 1.01 * 193e9);
    assert_relative_eq!(changed.pipe1.material.youngs_modulus, 1.01 * 193e9, max_relative = 1e-14);
    assert_relative_eq!(changed.pipe2.material.youngs_modulus, 0.808 * 193e9, max_relative = 1e-14);
}

#[test]
fn names_and_units_are_those_of_the_file() {
    for (number, key, place, change, nominal, expected) in [
        (
            NominalNumber::YoungsModulus("steel".into()),
            "youngs_modulus_percent",
            "material.steel",
            2e9,
            200e9,
            1.0,
        ),
        (NominalNumber::InnerDiameter(Part::Bend), "inner_diameter_mm", "bend", 1e-4, 0.03, 0.1),
        (NominalNumber::LengthL1, "l1_mm", "geometry", -2e-4, 0.15, -0.2),
        (NominalNumber::TipMass, "mass_g", "tip", 1e-3, 0.06, 1.0),
        (NominalNumber::Section(Part::Pipe2, SectionConstant::Iz), "iz_percent", "pipe2", 1e-10, 2e-9, 5.0),
        (NominalNumber::Station(Feature::Joint("a".into())), "station_mm", "joint.a", 1e-3, 0.2, 1.0),
    ] {
        assert_eq!((number.key(), number.place().as_str()), (key, place));
        assert_relative_eq!(number.in_unit(change, nominal), expected, max_relative = 1e-12);
    }
}
