//! What a diagnosis says of them, and what it writes.

use super::*;

#[test]
fn a_diagnosis_names_the_mistake_first_and_writes_the_corrected_file() {
    let file = rod(ROD_5);
    let clean = recorded(&file, Bench::Own, 3);
    let wrong = with_loads(&clean, 1.0 / G);
    let found = crate::diagnosis::rig::diagnose(&wrong, Some(&file)).unwrap();
    let first = &found.diagnosis.findings[0];
    assert_eq!((first.effect.name, first.kind()), ("unit_mistake", crate::inference::Kind::Mistake));
    assert_eq!(found.diagnosis.findings.len(), 1);
    assert!(first.parts.is_empty() && found.diagnosis.is_mismatch());
    let observed =
        "The loads are kilograms, not newtons: multiply load_n by 9.80665 (or name the column load_kg)";
    assert_eq!(first.description.observed, observed);
    let factor = first.quantity("factor").unwrap();
    assert_eq!((factor.value, factor.low), (G, G));
    assert_eq!(found.model.recorded().rows, wrong.rows);
    let correction = found.correction().unwrap().unwrap();
    assert_eq!(correction.undone, [observed]);
    let written = Readings::from_text("f", &correction.readings_csv).unwrap();
    assert!((written.rows[3].load - clean.rows[3].load).abs() < 1e-9);
    // without anything left to compare, the mistake is all there is
    let mut stuck = recorded(&file, Bench::OneLine, 3);
    stuck.rows.iter_mut().for_each(|row| row.offset[1] = Some(50.0 * UM));
    let found = crate::diagnosis::rig::diagnose(&stuck, Some(&file)).unwrap();
    assert_eq!(found.diagnosis.findings.len(), 1);
    assert_eq!(found.diagnosis.findings[0].effect.name, "stuck_sensor");
    assert!(found.diagnosis.discrepancy.is_none());
    let lines = suspected(&wrong, Some(&file)).unwrap();
    assert!(lines[0].description.starts_with("load_n looks like kilograms: the rod seems 9."), "{lines:?}");
}

/// A hanger that nobody counted in one trial is one number, not a zero of each sensor.
#[test]
fn loads_of_one_trial_that_were_larger_than_written_are_one_mistake() {
    let file = rod(ROD_5);
    let hung = |more: f64| {
        let mut rows = rows(Bench::Full);
        let of_trial = |row: &&mut Reading| row.trial.as_deref() == Some("2");
        rows.iter_mut().filter(of_trial).for_each(|row| row.load += more);
        let mut readings = read(&file, rows, 7);
        readings.rows.iter_mut().filter(of_trial).for_each(|row| row.load -= more);
        crate::diagnosis::rig::diagnose(&readings, Some(&file)).unwrap().diagnosis.findings
    };
    let found = hung(1.5);
    let names: Vec<String> =
        found.iter().map(|found| format!("{} {}", found.effect, found.location)).collect();
    assert_eq!(names, ["offset_mistake load_n, trial 2"]);
    let n = found[0].quantity("n").unwrap();
    assert!((n.low..n.high).contains(&1.5), "{n:?}");
    assert!(
        found[0].description.observed.ends_with("was not counted: add that"),
        "{:?}",
        found[0].description
    );
    assert!(hung(0.0).is_empty());
}

/// What the rod itself says of a unit says nothing of the rod: no other scale of a sensor follows
/// from it, no number of the file, and nothing is written.
#[test]
fn a_unit_that_nobody_knows_is_looked_up() {
    let file = rod(ROD_5);
    for channels in [&[Axis::Z][..], &Axis::ALL] {
        let mut wrong = all_scaled(&recorded(&file, Bench::Full, 5), 1.06);
        channels.iter().for_each(|&channel| scaled(&mut wrong, channel, 1.0 / 40.0));
        let found = crate::diagnosis::rig::diagnose(&wrong, Some(&file)).unwrap();
        let names: Vec<&str> = found.diagnosis.findings.iter().map(|found| found.effect.name).collect();
        assert_eq!(names, ["unit_mistake"], "{channels:?}");
        let factor = found.diagnosis.findings[0].quantity("factor").unwrap();
        assert!((factor.low..factor.high).contains(&40.0), "{factor:?}");
        assert!(found.diagnosis.discrepancy.is_none() && found.diagnosis.nominal.is_empty());
        assert!(found.unit_is_unknown() && found.correction().unwrap().is_none());
    }
}

/// Pounds for kilograms are what a rod 2.2 times as stiff would read: named before it, with it as
/// their rival.
#[test]
fn a_unit_that_looks_like_physics_has_it_as_its_rival() {
    let file = rod(ROD_5);
    let clean = recorded(&file, Bench::Full, 5);
    let mut in_pounds = with_loads(&clean, 1.0 / 0.453_592_37);
    in_pounds.load_column = crate::rig::readings::LoadColumn::Kilograms;
    let found = crate::diagnosis::rig::diagnose(&in_pounds, Some(&file)).unwrap();
    let first = &found.diagnosis.findings[0];
    assert_eq!(first.effect.name, "unit_mistake");
    assert!(first.description.observed.starts_with("The loads are pounds (lb), not kilograms"));
    let others: Vec<&str> = first.others().iter().map(|(effect, _)| effect.name).collect();
    assert_eq!((others, found.diagnosis.findings.len()), (vec!["stiffness_scale"], 1));
    // radii of one pipe are no stiffer rod
    let mut radii = file.clone();
    let round = *radii.pipe2.section.as_round().unwrap();
    radii.pipe2.section = Round::tube(round.outer_diameter / 2.0, round.inner_diameter / 2.0).into();
    let found = crate::diagnosis::rig::diagnose(&clean, Some(&radii)).unwrap();
    let first = &found.diagnosis.findings[0];
    assert_eq!((first.effect.name, first.others().len()), ("unit_mistake", 0), "{:?}", first.others());
    // a rod that is as much stiffer as no unit is
    let stiffer = all_scaled(&clean, 0.7);
    let found = crate::diagnosis::rig::diagnose(&stiffer, Some(&file)).unwrap();
    let others: Vec<_> = found.diagnosis.findings.iter().flat_map(Finding::others).collect();
    assert!(!found.diagnosis.findings.is_empty());
    assert!(others.iter().all(|(effect, _)| effect.kind != crate::inference::Kind::Mistake), "{others:?}");
}

/// One number is all that a straight rod shows across itself: kilograms for newtons are a root that
/// is soft, or the other way round.
#[test]
fn kilograms_on_a_straight_rod_are_a_rival_of_its_root() {
    let straight = Rod::from_toml(
        "rod",
        "name = \"straight\"\n[geometry]\nl1_mm = 375\nl2_mm = 301\ngamma_deg = 180\n[material.steel]\n\
         youngs_modulus_gpa = 193\nshear_modulus_gpa = 75\ndensity_kg_m3 = 7930\n[pipe1]\n\
         material = \"steel\"\nouter_diameter_mm = 36\ninner_diameter_mm = 32\n[pipe2]\n\
         material = \"steel\"\nouter_diameter_mm = 14\ninner_diameter_mm = 11\n",
    )
    .unwrap();
    let in_kilograms = with_loads(&recorded(&straight, Bench::Full, 6), 1.0 / G);
    let found = crate::diagnosis::rig::diagnose(&in_kilograms, Some(&straight)).unwrap();
    let first = &found.diagnosis.findings[0];
    let is_it = |place: &Location| place.to_string().contains("kilograms") || place.to_string() == "load_n";
    let named = is_it(&first.location) || first.others().iter().any(|(_, place)| is_it(place));
    assert!(named, "{} {:?}", first.location, first.others());
}

/// A rod that is 1 % softer than its file is within what the file knows: consistent, and --apply
/// writes the better modulus.
#[test]
fn a_nominal_number_that_moved_is_written() {
    let file = rod(ROD_5);
    let readings = Readings::from_rows(rows(Bench::Full)).unwrap();
    let mut actual = file.clone();
    for pipe in [&mut actual.pipe1, &mut actual.bend, &mut actual.pipe2] {
        pipe.material.youngs_modulus *= 0.99;
    }
    let model = RigModel::with_effects(&readings, Some(&actual), &Wanted::Like(&[])).unwrap().0;
    let mut random = Random::seeded(8, 0);
    let mut readings = readings;
    for datum in model.data() {
        let value = datum.predicted + UM * random.normal();
        readings.rows[datum.row - 1].offset[datum.channel.index()] = Some(value);
    }
    let found = crate::diagnosis::rig::diagnose(&readings, Some(&file)).unwrap();
    assert!(!found.diagnosis.is_mismatch() && !found.diagnosis.nominal.is_empty());
    let correction = found.correction().unwrap().unwrap();
    let first = &correction.entered[0];
    assert!(matches!(first, crate::diagnosis::rig::WrittenItem::Number(_)), "{:?}", correction.entered);
    // as soft as the readings say, along the axes that bend the rod by more than the noise
    let soft =
        crate::compliance::Compliance::of_model(&actual, &crate::beam::Physics::default(), 20).unwrap();
    for axis in [1, 2] {
        let [before, after, truth] =
            [&correction.before, &correction.after, &soft].map(|c| c.force[(axis, axis)]);
        assert!((after / truth - 1.0).abs() < 0.3 * (before / truth - 1.0).abs(), "{before} {after} {truth}");
    }
}

#[test]
fn every_record_of_a_mistake_is_complete() {
    use crate::diagnosis::rig::effects::registry;
    for effect in registry::MISTAKES {
        for text in [effect.name, effect.summary, effect.formula, effect.needs, effect.cause] {
            assert!(!text.is_empty(), "{effect}");
        }
        assert_eq!(effect.kind, crate::inference::Kind::Mistake);
    }
}
