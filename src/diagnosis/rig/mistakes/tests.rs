//! Every mistake on recordings as labs make them, and none on what only physics did.

use super::*;
use crate::diagnosis::rig::model::RigModel;
use crate::diagnosis::rig::wanted::Wanted;
use crate::inference::{ForwardModel, Term};
use crate::rig::readings::{Axis, Direction, Phase, Reading};
use crate::section::Round;
use crate::statistics::Random;
use crate::units::UM;

const ROD_5: &str = include_str!("../../../../rods/5.toml");
const ROD_2: &str = include_str!("../../../../rods/2.toml");

fn rod(text: &str) -> Rod {
    Rod::from_toml("rod", text).unwrap()
}

/// What a lab records.
#[derive(Clone, Copy, PartialEq, Debug)]
enum Bench {
    /// All channels under loads along all axes, up and down.
    Full,
    /// The channel along the load only, as the paper has it.
    Own,
    /// Loads along z, all channels.
    OneAxis,
    /// One channel under loads along its axis, either way.
    OneLine,
}

/// The rows of a bench, nothing read yet.
fn rows(bench: Bench) -> Vec<Reading> {
    let axes: &[Axis] = match bench {
        Bench::Full | Bench::Own => &Axis::ALL,
        Bench::OneAxis => &[Axis::Z],
        Bench::OneLine => &[Axis::Y],
    };
    let mut rows = Vec::new();
    let mut time = 0.0;
    for &axis in axes {
        for trial in 1..=3 {
            for (load, phase) in [(5.0, 1), (10.0, 1), (15.0, 1), (20.0, 1), (10.0, 0), (5.0, 0)] {
                let against = bench == Bench::OneLine && trial == 2;
                let direction = if against { Direction::against(axis) } else { Direction::along(axis) };
                let mut row = Reading::new(direction, load).with_trial(trial.to_string());
                for channel in Axis::ALL {
                    if matches!(bench, Bench::Full | Bench::OneAxis) || channel == axis {
                        row = row.with_offset(channel, 0.0);
                    }
                }
                time += 40.0;
                row.time = Some(time);
                row.temperature = Some(20.0 + 0.5 * (time / 900.0_f64).sin());
                row.phase =
                    (bench != Bench::Own).then_some(if phase == 1 { Phase::Load } else { Phase::Unload });
                rows.push(row);
            }
        }
    }
    rows
}

/// Read on `file`'s rod, whose numbers are 1 % off: to 2 µm, in steps of 0.1 µm, a zero for each run.
fn recorded(file: &Rod, bench: Bench, seed: u64) -> Readings {
    let mut random = Random::seeded(seed, 0);
    let mut actual = file.clone();
    let (e, g) = (1.0 + 0.01 * random.normal(), 1.0 + 0.02 * random.normal());
    for pipe in [&mut actual.pipe1, &mut actual.bend, &mut actual.pipe2] {
        pipe.material.youngs_modulus *= e;
        pipe.material.shear_modulus *= g;
    }
    actual.l2 += 0.3e-3 * random.normal();
    let readings = Readings::from_rows(rows(bench)).unwrap();
    let model = RigModel::with_effects(&readings, Some(&actual), &Wanted::Like(&[])).unwrap().0;
    let mut readings = readings;
    let zeros: Vec<f64> = (0..100).map(|_| UM * random.normal()).collect();
    for datum in model.data() {
        let noise = 2.0 * UM * random.normal() + zeros[datum.run * 3 + datum.channel.index()];
        let value = ((datum.predicted + noise) / (0.1 * UM)).round() * 0.1 * UM;
        readings.rows[datum.row - 1].offset[datum.channel.index()] = Some(value);
    }
    readings
}

fn names(mended: &Mended) -> Vec<String> {
    mended.found.iter().map(|finding| format!("{} {}", finding.effect, finding.location)).collect()
}

fn found(readings: &Readings, rod: Option<&Rod>) -> Vec<String> {
    names(&mended(readings, rod, &[]).unwrap())
}

fn scaled(readings: &mut Readings, channel: Axis, factor: f64) {
    for row in &mut readings.rows {
        if let Some(offset) = &mut row.offset[channel.index()] {
            *offset *= factor;
        }
    }
}

const BENCHES: [Bench; 4] = [Bench::Full, Bench::Own, Bench::OneAxis, Bench::OneLine];
const G: f64 = 9.80665;
const POUND: f64 = 4.4482216;

/// All cases of a test, so that one run shows all that fail.
#[derive(Default)]
struct Cases(Vec<String>);

impl Cases {
    fn expect(&mut self, what: &str, readings: &Readings, rod: &Rod, expected: &[&str]) {
        let mut found = found(readings, Some(rod));
        found.sort();
        if found != expected {
            self.0.push(format!("{what}: {found:?} instead of {expected:?}"));
        }
    }

    fn check(self) {
        assert!(self.0.is_empty(), "{:#?}", self.0);
    }
}

/// Both rods under several benches, with some seeds.
fn recordings(benches: &[Bench], seeds: u64, mut with: impl FnMut(String, &Rod, Readings)) {
    for (name, text) in [("5#", ROD_5), ("2#", ROD_2)] {
        let file = rod(text);
        for &bench in benches {
            for seed in 0..seeds {
                with(format!("{name} {bench:?} {seed}"), &file, recorded(&file, bench, 300 + seed));
            }
        }
    }
}

fn all_scaled(readings: &Readings, factor: f64) -> Readings {
    let mut readings = readings.clone();
    Axis::ALL.into_iter().for_each(|channel| scaled(&mut readings, channel, factor));
    readings
}

fn with_loads(readings: &Readings, factor: f64) -> Readings {
    let mut readings = readings.clone();
    readings.rows.iter_mut().for_each(|row| row.load *= factor);
    readings
}

#[test]
fn units_of_loads_are_named() {
    let mut cases = Cases::default();
    recordings(&[Bench::Full, Bench::Own], 4, |what, file, clean| {
        for factor in [G, POUND, 1e-3 * G, POUND / 16.0, 1.0 / G] {
            let expected = ["unit_mistake load_n"];
            cases.expect(&format!("{what} × {factor}"), &with_loads(&clean, 1.0 / factor), file, &expected);
        }
        let mut in_kilograms = with_loads(&clean, G);
        in_kilograms.load_column = crate::rig::readings::LoadColumn::Kilograms;
        cases.expect(&format!("{what} N in load_kg"), &in_kilograms, file, &["unit_mistake load_kg"]);
        let mut one_axis = clean.clone();
        let of_axis = one_axis.rows.iter_mut().filter(|row| row.direction.axis == Axis::Z);
        of_axis.for_each(|row| row.load /= G);
        cases.expect(&format!("{what} z in kg"), &one_axis, file, &["unit_mistake load_n, axis z"]);
    });
    recordings(&[Bench::OneAxis, Bench::OneLine], 4, |what, file, clean| {
        cases.expect(&format!("{what} kg"), &with_loads(&clean, 1.0 / G), file, &["unit_mistake load_n"]);
    });
    cases.check();
}

#[test]
fn a_unit_is_named_beside_a_modulus_that_is_off() {
    let mut cases = Cases::default();
    recordings(&[Bench::Full, Bench::Own], 2, |what, file, clean| {
        for softer in [0.92, 1.12] {
            for factor in [G, POUND] {
                // sensors along the loads only: a pound must be one to 5 %
                if factor == POUND && what.contains("Own") {
                    continue;
                }
                let both = all_scaled(&with_loads(&clean, 1.0 / factor), softer);
                cases.expect(&format!("{what} {factor} {softer}"), &both, file, &["unit_mistake load_n"]);
            }
        }
    });
    cases.check();
}

#[test]
fn units_of_readings_are_named_in_one_channel_and_in_all() {
    let mut cases = Cases::default();
    recordings(&[Bench::Full, Bench::Own], 3, |what, file, clean| {
        for factor in [1e3, 25.4e3, 25.4, 1e-3, 1e6] {
            let all = all_scaled(&clean, 1.0 / factor);
            cases.expect(&format!("{what} {factor}"), &all, file, &["unit_mistake dx_um, dy_um, dz_um"]);
            for (channel, expected) in [(Axis::Y, "unit_mistake dy_um"), (Axis::Z, "unit_mistake dz_um")] {
                let mut one = clean.clone();
                scaled(&mut one, channel, 1.0 / factor);
                cases.expect(&format!("{what} {channel} {factor}"), &one, file, &[expected]);
            }
        }
    });
    cases.check();
}

#[test]
fn signs_are_named_where_they_can_be_seen() {
    let mut cases = Cases::default();
    recordings(&[Bench::Full, Bench::Own, Bench::OneLine], 3, |what, file, clean| {
        for (channel, expected) in [(Axis::Y, "sign_mistake dy_um"), (Axis::Z, "sign_mistake dz_um")] {
            if clean.rows.iter().all(|row| row.offset[channel.index()].is_none()) {
                continue;
            }
            let mut one = clean.clone();
            scaled(&mut one, channel, -1.0);
            cases.expect(&format!("{what} {channel}"), &one, file, &[expected]);
            let soft = all_scaled(&one, 2.3);
            cases.expect(&format!("{what} {channel}, soft"), &soft, file, &[expected]);
        }
    });
    recordings(&[Bench::Full], 3, |what, file, clean| {
        let expected = ["sign_mistake dx_um, dy_um, dz_um"];
        cases.expect(&format!("{what} all"), &all_scaled(&clean, -1.0), file, &expected);
        let mut axis = clean.clone();
        axis.rows
            .iter_mut()
            .filter(|row| row.direction.axis == Axis::Y)
            .for_each(|row| row.direction.sign *= -1);
        // dy moves under loads along y only: the column and the axis are one
        let found = mended(&axis, Some(file), &[]).unwrap().found;
        let places: Vec<String> = found[0].others().iter().map(|(_, place)| place.to_string()).collect();
        assert!(found[0].effect.name == "sign_mistake", "{what}");
        assert!(
            found[0].location.to_string() == "axis y" || places.contains(&"axis y".into()),
            "{what} {places:?}"
        );
    });
    cases.check();
}

#[test]
fn names_that_were_exchanged_are_found() {
    let mut cases = Cases::default();
    recordings(&[Bench::Full, Bench::Own], 3, |what, file, clean| {
        for (a, b, channels, axes) in [
            (0, 1, "swap_mistake dx_um and dy_um", "swap_mistake axis x and y"),
            (1, 2, "swap_mistake dy_um and dz_um", "swap_mistake axis y and z"),
            (0, 2, "swap_mistake dx_um and dz_um", "swap_mistake axis x and z"),
        ] {
            let mut columns = clean.clone();
            columns.rows.iter_mut().for_each(|row| row.offset.swap(a, b));
            let mut loads = clean.clone();
            for row in &mut loads.rows {
                let k = row.direction.axis.index();
                row.direction.axis = Axis::ALL[if k == a {
                    b
                } else if k == b {
                    a
                } else {
                    k
                }];
            }
            for (case, readings, expected) in [("columns", &columns, channels), ("axes", &loads, axes)] {
                let found = mended(readings, Some(file), &[]).unwrap();
                let is_it = |name: &String| name == expected;
                let rivals = found.found.first().map(Finding::others).unwrap_or_default();
                let rivals: Vec<String> = rivals.iter().map(|(e, l)| format!("{e} {l}")).collect();
                // C22 and C33 of rod 2# are 7 % apart: columns and axes explain alike
                if names(&found).len() != 1 || !(names(&found).iter().any(is_it) || rivals.iter().any(is_it))
                {
                    cases.0.push(format!("{what} {case} {a} {b}: {:?}, {rivals:?}", names(&found)));
                }
            }
        }
        let swapped = Rod { l1: file.l2, l2: file.l1, ..file.clone() };
        cases.expect(&format!("{what} lengths"), &clean, &swapped, &["swap_mistake l1_mm and l2_mm"]);
    });
    cases.check();
}

#[test]
fn keys_of_the_rod_and_other_rods_are_found() {
    let mut cases = Cases::default();
    let others: Vec<(String, Rod)> = (1..=6)
        .map(|k| (format!("{k}.toml"), Rod::read(format!("rods/{k}.toml").as_ref()).unwrap()))
        .collect();
    recordings(&[Bench::Full, Bench::Own], 2, |what, file, clean| {
        let mut radius = file.clone();
        for pipe in [&mut radius.pipe1, &mut radius.bend, &mut radius.pipe2] {
            let round = *pipe.section.as_round().unwrap();
            pipe.section = Round::tube(round.outer_diameter / 2.0, round.inner_diameter / 2.0).into();
        }
        let keys = "unit_mistake pipe1.outer_diameter_mm, pipe1.inner_diameter_mm, pipe2.outer_diameter_mm, pipe2.inner_diameter_mm";
        cases.expect(&format!("{what} radii"), &clean, &radius, &[keys]);
        let metres = Rod { l2: file.l2 * 1e-3, joints: Vec::new(), ..file.clone() };
        let joints = Rod { joints: file.joints.clone(), ..metres.clone() };
        if file.joints.is_empty() {
            cases.expect(&format!("{what} l2 in m"), &clean, &joints, &["unit_mistake l2_mm"]);
        }
        // a steel rod against a carbon one, either way
        let (given, expected) = if file.name == "5#" { ("2", "5.toml") } else { ("5", "2.toml") };
        let given = Rod::read(format!("rods/{given}.toml").as_ref()).unwrap();
        let found = mended(&clean, Some(&given), &others).unwrap();
        let expected = [format!("rod_mistake {expected}")];
        if names(&found) != expected {
            cases.0.push(format!("{what} other rod: {:?}", names(&found)));
        }
        assert!(found.rod.is_some_and(|rod| rod.name == file.name), "{what}");
    });
    cases.check();
}

#[test]
fn sensors_and_single_runs_are_found_with_a_rod_and_without() {
    let mut cases = Cases::default();
    recordings(&[Bench::Full, Bench::Own, Bench::OneLine], 2, |what, file, clean| {
        let of_y = clean.rows.iter().filter_map(|row| row.offset[1]);
        let most = of_y.fold(0.0, |most: f64, y| most.max(y.abs()));
        let changed = |change: &dyn Fn(&mut f64, bool)| {
            let mut readings = clean.clone();
            for row in &mut readings.rows {
                let is_second = row.trial.as_deref() == Some("2");
                row.offset[1].iter_mut().for_each(|y| change(y, is_second));
            }
            readings
        };
        let stuck = changed(&|y, _| *y = 137.2 * UM);
        cases.expect(&format!("{what} stuck"), &stuck, file, &["stuck_sensor dy_um"]);
        let cut = changed(&|y, _| *y = y.clamp(-0.6 * most, 0.6 * most));
        cases.expect(&format!("{what} cut off"), &cut, file, &["saturated_sensor dy_um"]);
        let offset = changed(&|y, _| *y += 5.0 * most);
        cases.expect(&format!("{what} offset"), &offset, file, &["offset_mistake dy_um"]);
        let sign = changed(&|y, is_second| {
            if is_second {
                *y = -*y
            }
        });
        cases.expect(&format!("{what} sign"), &sign, file, &["sign_mistake dy_um, axis y, trial 2"]);
        if !what.contains("Full") {
            assert_eq!(found(&stuck, None), ["stuck_sensor dy_um"], "{what}");
            assert_eq!(found(&cut, None), ["saturated_sensor dy_um"], "{what}");
            assert_eq!(found(&sign, None), ["sign_mistake dy_um, axis y, trial 2"], "{what}");
        }
        if what.contains("Own") {
            let run = changed(&|y, is_second| {
                if is_second {
                    *y += 2.0 * most
                }
            });
            cases.expect(&format!("{what} run"), &run, file, &["offset_mistake dy_um, axis y, trial 2"]);
        }
    });
    cases.check();
}

#[test]
fn two_mistakes_are_found_together() {
    let mut cases = Cases::default();
    recordings(&[Bench::Full, Bench::Own, Bench::OneLine], 3, |what, file, clean| {
        let mut both = with_loads(&clean, 1.0 / G);
        scaled(&mut both, Axis::Y, -1.0);
        let expected = ["sign_mistake dy_um", "unit_mistake load_n"];
        cases.expect(&format!("{what} kg, sign"), &both, file, &expected);
        let found = mended(&both, Some(file), &[]).unwrap();
        for (row, clean) in found.readings.rows.iter().zip(&clean.rows) {
            assert!((row.load / clean.load - 1.0).abs() < 1e-12);
            assert_eq!(row.offset, clean.offset);
        }
    });
    cases.check();
}

#[test]
fn clean_recordings_have_no_mistakes() {
    let mut cases = Cases::default();
    recordings(&BENCHES, 25, |what, file, clean| {
        cases.expect(&what, &clean, file, &[]);
        assert!(found(&clean, None).is_empty(), "{what}");
        for factor in [1.0 / 0.3, 2.3, 0.6] {
            cases.expect(&format!("{what} × {factor}"), &all_scaled(&clean, factor), file, &[]);
        }
    });
    for (text, readings) in [(ROD_5, "5"), (ROD_2, "2")] {
        let readings = Readings::read(format!("stiffness_data/{readings}.csv").as_ref()).unwrap();
        cases.expect(&readings.file, &readings, &rod(text), &[]);
        assert!(found(&readings, None).is_empty());
    }
    let load_cell = Readings::read("stiffness_data/nist-load-cell.csv".as_ref()).unwrap();
    assert!(found(&load_cell, None).is_empty());
    cases.check();
}

#[test]
fn no_physics_is_a_mistake_however_large() {
    let mut wrong = Vec::new();
    recordings(&BENCHES, 1, |what, file, clean| {
        let model = RigModel::new(&clean, Some(file)).unwrap().0;
        for (index, candidate) in model.candidates().iter().enumerate() {
            let is_one_of_many = candidate.effect.name == "slip" && index % 9 > 0;
            let is_mistake = candidate.effect.kind == crate::inference::Kind::Mistake;
            if candidate.is_nonparametric || is_mistake || is_one_of_many {
                continue;
            }
            for times in [3.0f64, 10.0, -10.0] {
                let value = |p: &crate::inference::Parameter| {
                    // a joint that alone yields twice as much as the whole rod could not be told from pounds
                    let most = if candidate.effect.name == "joint_compliance" { 5.0 } else { 10.0 };
                    let value = p.neutral + times.min(most) * p.size;
                    let value = match (candidate.effect.name, p.name.as_str()) {
                        ("stiffness_scale", _) => value.clamp(0.3, 2.5),
                        (_, "angle_deg") => value.clamp(-0.1, 0.1),
                        _ => value,
                    };
                    value.clamp(p.bounds.0, p.bounds.1)
                };
                let values = candidate.parameters.iter().map(value).collect();
                let change = model.response(&[Term { candidate: index, values }]);
                let mut readings = clean.clone();
                for (datum, change) in model.data().iter().zip(change.iter()) {
                    let offset = &mut readings.rows[datum.row - 1].offset[datum.channel.index()];
                    *offset = offset.map(|offset| offset + change);
                }
                let case = format!("{what}: {} {} × {times}", candidate.effect, candidate.location);
                // what a slip before the last run does, a zero that was not taken there does too: both are said
                let is_said = |found: &Finding| {
                    let others = found.others();
                    candidate.effect.name == "slip" && others.iter().any(|(e, _)| *e == candidate.effect)
                };
                for rod in [Some(file), None] {
                    let mended = mended(&readings, rod, &[]).unwrap();
                    if !mended.found.iter().all(is_said) {
                        wrong.push(format!("{case}: {:?}", names(&mended)));
                    }
                }
            }
        }
    });
    assert!(wrong.is_empty(), "{} of them: {wrong:#?}", wrong.len());
}

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
    let said =
        "The loads are kilograms, not newtons: multiply load_n by 9.80665 (or name the column load_kg)";
    assert_eq!(first.description.observed, said);
    let factor = first.quantity("factor").unwrap();
    assert_eq!((factor.value, factor.low), (G, G));
    assert_eq!(found.model.recorded().rows, wrong.rows);
    let correction = found.correction().unwrap().unwrap();
    assert_eq!(correction.undone, [said]);
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
    assert!(lines[0].starts_with("load_n looks like kilograms: the rod seems 9."), "{lines:?}");
}

/// Pounds for kilograms, and pounds of force where sensors along the loads see one factor only, are
/// what a stiffer rod would read: named as a rival, and looked up before anything is measured.
#[test]
fn a_unit_that_looks_like_physics_is_its_rival() {
    let file = rod(ROD_5);
    let clean = recorded(&file, Bench::Full, 5);
    let mut in_pounds = with_loads(&clean, 1.0 / 0.453_592_37);
    in_pounds.load_column = crate::rig::readings::LoadColumn::Kilograms;
    let found = crate::diagnosis::rig::diagnose(&in_pounds, Some(&file)).unwrap();
    let first = &found.diagnosis.findings[0];
    assert_eq!(first.effect.name, "stiffness_scale");
    let location = Location::Key("load_kg in pounds (lb)".into());
    assert!(first.others().iter().any(|(_, place)| *place == location), "{:?}", first.others());
    let next = first.next.as_ref().unwrap();
    assert!(next.plan.is_none() && next.separates_from.iter().any(|(_, place)| *place == location));
    // a rod that is as much stiffer as no unit is
    let stiffer = all_scaled(&clean, 0.7);
    let found = crate::diagnosis::rig::diagnose(&stiffer, Some(&file)).unwrap();
    let others: Vec<_> = found.diagnosis.findings.iter().flat_map(Finding::others).collect();
    assert!(!found.diagnosis.findings.is_empty());
    assert!(others.iter().all(|(effect, _)| effect.kind != crate::inference::Kind::Mistake), "{others:?}");
}

/// A rod that is 1 % softer than its file is within what the file knows: consistent, and --apply writes the better modulus.
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
    assert!(correction.entered[0].ends_with("within its standard uncertainty"), "{:?}", correction.entered);
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
