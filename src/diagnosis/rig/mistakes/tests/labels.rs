//! Units, signs and names of columns and keys, and other rods.

use super::*;

#[test]
fn units_of_loads_are_named() {
    let mut cases = Cases::default();
    recordings(&[Bench::Full, Bench::Own], 2, |what, file, clean| {
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
    recordings(&[Bench::OneAxis, Bench::OneLine], 2, |what, file, clean| {
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
    recordings(&[Bench::Full, Bench::Own], 1, |what, file, clean| {
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

/// An amplifier in another range, counts of a converter: no list holds the factor.
#[test]
fn a_factor_that_is_no_units_is_named_in_one_channel_and_in_all() {
    let mut cases = Cases::default();
    recordings(&[Bench::Full, Bench::Own], 1, |what, file, clean| {
        for factor in [60.0, 1.0 / 40.0, 1.0 / 170.0] {
            let all = all_scaled(&clean, factor);
            cases.expect(&format!("{what} {factor}"), &all, file, &["unit_mistake dx_um, dy_um, dz_um"]);
            // one of three lines is too little, and out of its plane a bent rod may be loose
            let is_enough = what.contains("Full");
            if is_enough && factor < 1.0 {
                let mut one = clean.clone();
                scaled(&mut one, Axis::Y, factor);
                cases.expect(&format!("{what} dy {factor}"), &one, file, &["unit_mistake dy_um"]);
            }
            if is_enough {
                let mut one = clean.clone();
                scaled(&mut one, Axis::Z, factor);
                cases.expect(&format!("{what} dz {factor}"), &one, file, &["unit_mistake dz_um"]);
            }
        }
    });
    cases.check();
}

#[test]
fn signs_are_named_where_they_can_be_seen() {
    let mut cases = Cases::default();
    recordings(&[Bench::Full, Bench::Own, Bench::OneLine], 2, |what, file, clean| {
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
    recordings(&[Bench::Full], 2, |what, file, clean| {
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
fn sides_of_a_section_that_were_exchanged_are_found() {
    let sides = |width: f64, height: f64| {
        let pipe = |rod: &mut Rod| {
            let section: crate::section::Section = crate::section::Rectangle::solid(width, height).into();
            rod.pipes_mut().for_each(|pipe| pipe.section = section);
        };
        let mut rod = rod(ROD_5);
        pipe(&mut rod);
        rod
    };
    let mut cases = Cases::default();
    for bench in [Bench::Full, Bench::Own] {
        let clean = recorded(&sides(12e-3, 20e-3), bench, 4);
        let what = format!("{bench:?}");
        cases.expect(&what, &clean, &sides(12e-3, 20e-3), &[]);
        let expected = ["swap_mistake width_mm and height_mm"];
        cases.expect(&what, &clean, &sides(20e-3, 12e-3), &expected);
    }
    cases.check();
}

#[test]
fn names_that_were_exchanged_are_found() {
    let mut cases = Cases::default();
    recordings(&[Bench::Full, Bench::Own], 1, |what, file, clean| {
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

/// A file's angle that is off by ten degrees was turned loads and turned sensors, or exchanged
/// pipes.
#[test]
fn another_angle_between_the_pipes_is_a_mistake() {
    for (file, degrees, seed) in [(ROD_2, 100.0, 1), (ROD_5, 100.0, 2), (ROD_5, 120.0, 3), (ROD_2, 90.0, 4)] {
        let file = rod(file);
        let bent = Rod { gamma: f64::to_radians(degrees), ..file.clone() };
        let readings = recorded(&bent, Bench::Full, 700 + seed);
        let found = crate::diagnosis::rig::diagnose_among(&readings, Some(&file), &[]).unwrap();
        let names = found.diagnosis.findings.iter().map(|own| format!("{} {}", own.effect, own.location));
        let expected: &[&str] = if degrees == 90.0 { &[] } else { &["angle_mistake gamma_deg"] };
        assert_eq!(names.collect::<Vec<_>>(), expected, "{degrees}");
        let said = found.diagnosis.findings.first().map(|own| own.description.observed.clone());
        assert!(said.is_none_or(|said| said.contains(&format!(" is {degrees}°, not 90°"))), "{degrees}");
    }
}

/// A rod that is turned about y in its mount reads nearly as one of another angle: it is not called
/// that alone.
#[test]
fn a_rod_that_is_turned_in_its_mount_is_not_of_another_angle_alone() {
    for (file, degrees, seed) in [(ROD_2, 8.0, 1), (ROD_5, 8.0, 2), (ROD_5, -12.0, 3)] {
        let file = rod(file);
        let mut readings = recorded(&file, Bench::Full, 800 + seed);
        let (model, _) = RigModel::new(&readings, Some(&file)).unwrap();
        let frames = [Part::LoadFrame, Part::Sensors].map(|part| {
            let is_it = |own: &Candidate| own.location == Location::Part(part) && own.parameters.len() == 3;
            let index = model.candidates.iter().position(is_it).unwrap();
            let mut term = model.candidates[index].neutral(index);
            term.values[1] = f64::to_radians(degrees);
            term
        });
        let turned = model.response(&frames);
        for (datum, by) in model.data().iter().zip(turned.iter()) {
            let offset = &mut readings.rows[datum.row - 1].offset[datum.channel.index()];
            *offset = offset.map(|read| read + by);
        }
        let found = crate::diagnosis::rig::diagnose_among(&readings, Some(&file), &[]).unwrap();
        let findings = &found.diagnosis.findings;
        let rivals = |own: &Finding| own.rivals.iter().map(|rival| rival.effect.name).collect::<Vec<_>>();
        let named: Vec<_> = findings.iter().map(|own| (own.effect.name, rivals(own))).collect();
        const TURNED: [&str; 2] = ["load_misalignment", "sensor_misalignment"];
        let is_said = named
            .iter()
            .all(|(name, rivals)| TURNED.contains(name) || TURNED.iter().all(|own| rivals.contains(own)));
        assert!(!named.is_empty() && is_said, "{degrees}: {named:?}");
    }
}

/// A clamp that lifts off under half of the loads bends the lines until their slopes are those of
/// another rod, which leaves a third of what it explains: neither rod is the right one.
#[test]
fn another_rod_that_leaves_as_much_is_not_named() {
    let file = rod(ROD_2);
    let others: Vec<(String, Rod)> = (1..=6)
        .map(|k| (format!("{k}.toml"), Rod::read(format!("rods/{k}.toml").as_ref()).unwrap()))
        .collect();
    let mut text = "axis,load_n,phase,dx_um,dy_um,dz_um\n".to_owned();
    let lines = [
        ("x", [-1.0, 1.0, 3.0, 5.0, 7.0, 5.0, 3.0, -0.0, 0.0], ",,"),
        ("y", [23.0, 48.0, 87.0, 146.0, 204.0, 146.0, 87.0, 46.0, 23.0], ","),
        ("z", [22.0, 44.0, 80.0, 135.0, 190.0, 136.0, 80.0, 43.0, 21.0], ""),
    ];
    for (axis, read, after) in lines {
        let before = &",,"[after.len()..];
        for (k, (load, read)) in [4, 8, 12, 16, 20, 16, 12, 8, 4].into_iter().zip(read).enumerate() {
            let phase = if k < 5 { "load" } else { "unload" };
            text += &format!("{axis},{load},{phase},{before}{read}{after}\n");
        }
    }
    let readings = Readings::from_text("readings", &text).unwrap();
    let by_slopes = mended(&readings, Some(&file), &others).unwrap();
    assert!(by_slopes.other_rod().is_some(), "the slopes are those of another rod");
    let found = crate::diagnosis::rig::diagnose_among(&readings, Some(&file), &others).unwrap();
    let findings: Vec<&str> = found.diagnosis.findings.iter().map(|finding| finding.effect.name).collect();
    assert!(!findings.contains(&"rod_mistake"), "{findings:?}");
    assert!(found.diagnosis.discrepancy.is_some(), "{findings:?}");
}

#[test]
fn radii_are_named_on_a_straight_rod_that_is_read_along_one_line() {
    let right = straight();
    let text = ROD_5.replacen("gamma_deg = 90", "gamma_deg = 180", 1);
    let wrong = rod(&text
        .replace("meter_mm = 32.0", "meter_mm = 16.0")
        .replace("meter_mm = 30.0", "meter_mm = 15.0"));
    let mut cases = Cases::default();
    for seed in 0..3 {
        let readings = recorded(&right, Bench::OneLine, 500 + seed);
        let keys = "pipe1.outer_diameter_mm, pipe1.inner_diameter_mm, pipe2.outer_diameter_mm, pipe2.inner_diameter_mm";
        cases.expect(&format!("{seed}"), &readings, &wrong, &[&format!("unit_mistake {keys}")]);
        // nor is a rod that is three times stiffer than its file a mistake
        cases.expect(&format!("{seed}"), &all_scaled(&readings, 0.33), &right, &[]);
    }
    cases.check();
}
