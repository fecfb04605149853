//! Loads that were typed wrongly in single rows, or hung in the wrong order.

use super::*;

#[test]
fn a_load_that_was_typed_wrongly_is_corrected() {
    let file = rod(ROD_5);
    let clean = recorded(&file, Bench::Full, 7);
    let z = clean.rows.iter().position(|row| row.direction.axis == Axis::Z && row.load == 15.0).unwrap();
    for typed in [51.0, 1.5, 150.0, 5.0] {
        let mut wrong = clean.clone();
        wrong.rows[z].load = typed;
        let mended = mended(&wrong, Some(&file), &[]).unwrap();
        assert_eq!(names(&mended), [format!("typing_mistake load_n, row {}", z + 1)], "{typed}");
        assert_eq!(mended.readings.rows[z].load, 15.0, "{typed}");
    }
    // one channel alone: as likely a misread value
    let mut misread = clean.clone();
    misread.rows[z].offset[2] = clean.rows[z].offset[2].map(|y| 3.0 * y);
    assert_eq!(found(&misread, Some(&file)), [""; 0]);
}

/// A magnet that holds the rod from ten newtons on does so in most runs: two sensors show eight.
#[test]
fn what_most_runs_show_of_a_load_was_not_typed_wrongly() {
    let with = |held: &[u32]| {
        let mut random = Random::seeded(3, 0);
        let mut text = "axis,load_n,trial,dy_um,dz_um\n".to_owned();
        for (trial, load) in
            (1..=3).flat_map(|trial| [2.0, 4.0, 6.0, 8.0, 10.0, 12.0, 14.0].map(|load| (trial, load)))
        {
            let shown = if load == 10.0 && held.contains(&trial) { 8.0 } else { load };
            let [y, z] = [20.0, 40.0].map(|slope| slope * shown + random.normal());
            text += &format!("z,{load},{trial},{y:.1},{z:.1}\n");
        }
        found(&Readings::from_text("f", &text).unwrap(), None).len()
    };
    assert_eq!([with(&[2]), with(&[1, 2])], [1, 0]);
}

/// Loads that the slide's friction keeps from the rod: both trials read nothing there.
#[test]
fn what_every_trial_reads_at_a_load_corrects_none() {
    for (seed, noise) in (0..20).flat_map(|seed| [(seed, 0.3), (seed, 2.0)]) {
        let mut random = Random::seeded(seed, 0);
        let mut text = "axis,load_n,trial,phase,dy_um,dz_um\n".to_owned();
        for (trial, axis) in (1..=2).flat_map(|trial| [(trial, "y"), (trial, "z")]) {
            for load in [1.0, 2.0, 5.0, 10.0, 20.0, 50.0] {
                let arrives = f64::max(load - 2.0, 0.0);
                let slopes = if axis == "y" { [40.0, 1.2] } else { [1.2, 24.0] };
                let [y, z] = slopes.map(|slope| slope * arrives + noise * random.normal());
                text += &format!("{axis},{load},{trial},load,{y:.1},{z:.1}\n");
            }
        }
        let named = found(&Readings::from_text("f", &text).unwrap(), None);
        assert!(!named.iter().any(|name| name.starts_with("typing_mistake")), "{seed}: {named:?}");
    }
}

/// A display of ten micrometres, and a rod that moves by as much from load to load: what differs by
/// one step corrects no load.
#[test]
fn one_step_of_a_display_is_no_other_load() {
    let file = rod(ROD_5);
    let mut readings = recorded(&file, Bench::Full, 7);
    for row in &mut readings.rows {
        let axis = row.direction.axis;
        row.offset = [0.0; 3].map(Some);
        row.offset[axis.index()] = Some(2.0 * row.load * UM);
    }
    let is_its = |row: &Reading| (row.direction.axis, row.trial.as_deref()) == (Axis::Z, Some("2"));
    let first = readings.rows.iter().position(is_its).unwrap();
    let (ten, fifteen) = (readings.rows[first + 1].offset, readings.rows[first + 2].offset);
    (readings.rows[first + 1].offset, readings.rows[first + 2].offset) = (fifteen, ten);
    let named = |readings: &Readings| {
        let mended = mended(readings, Some(&file), &[]).unwrap();
        mended.found.iter().filter(|found| found.effect.name == "typing_mistake").count()
    };
    assert_eq!(named(&readings), 0);
    // ten steps are one
    let finer = all_scaled(&readings, 10.0);
    assert_eq!(named(&finer), 2);
}

/// Two weights in the wrong order: two rows that show each other's loads, also where one channel
/// alone contradicts each.
#[test]
fn two_loads_that_were_hung_in_the_wrong_order_are_both_corrected() {
    let file = rod(ROD_5);
    let mut cases = Cases::default();
    for seed in 0..12 {
        let clean = recorded(&file, Bench::Full, seed);
        let of_load = |load: f64| {
            let is_it = |row: &Reading| {
                (row.direction.axis, row.trial.as_deref(), row.load) == (Axis::Z, Some("2"), load)
            };
            clean.rows.iter().position(is_it).unwrap()
        };
        let (a, b) = (of_load(10.0), of_load(20.0));
        let mut wrong = clean.clone();
        (wrong.rows[a].load, wrong.rows[b].load) = (20.0, 10.0);
        let [a, b] = [a, b].map(|row| format!("typing_mistake load_n, row {}", row + 1));
        cases.expect(&seed.to_string(), &wrong, &file, &[&a, &b]);
    }
    cases.check();
}

/// Half of a run of four loads is wrong then.
#[test]
fn two_of_four_loads_that_were_hung_in_the_wrong_order_are_both_corrected() {
    let file = rod(ROD_5);
    let mut rows = Vec::new();
    for (trial, axis) in (1..=4).flat_map(|trial| Axis::ALL.map(|axis| (trial, axis))) {
        for load in [5.0, 10.0, 15.0, 20.0] {
            let row = Reading::new(Direction::along(axis), load).with_trial(trial.to_string());
            rows.push(Axis::ALL.into_iter().fold(row, |row, channel| row.with_offset(channel, 0.0)));
        }
    }
    let mut wrong = read(&file, rows, 3);
    // the second and the third load along z of the second trial
    (wrong.rows[21].load, wrong.rows[22].load) = (15.0, 10.0);
    let mut named = found(&wrong, Some(&file));
    named.sort();
    assert_eq!(named, ["typing_mistake load_n, row 22", "typing_mistake load_n, row 23"]);
}

/// Where a single channel is read, a load that no other row has was typed wrongly if it shows one
/// that others have; one that others have is as likely a misread value.
#[test]
fn one_channel_alone_corrects_a_load_that_nobody_hung() {
    let file = rod(ROD_5);
    let clean = recorded(&file, Bench::Own, 7);
    let z = clean.rows.iter().position(|row| row.direction.axis == Axis::Z && row.load == 15.0).unwrap();
    for (typed, is_named) in [(150.0, true), (51.0, true), (5.0, false)] {
        let mut wrong = clean.clone();
        wrong.rows[z].load = typed;
        let named = found(&wrong, Some(&file));
        let expected =
            if is_named { vec![format!("typing_mistake load_n, row {}", z + 1)] } else { Vec::new() };
        assert_eq!(named, expected, "{typed}");
    }
}

/// In readings that scatter the nearest load of all is not the likeliest: one that another row has
/// and whose digits were written is, a few scatters away as well.
#[test]
fn what_was_meant_has_the_digits_that_were_written() {
    let levels = [0.1, 0.21, 0.34, 0.41, 0.52, 1.6, 2.49];
    let with = |row: usize, written: f64, off: f64| {
        let mut random = Random::seeded(5, 0);
        let mut text = "axis,load_kg,trial,dz_um\n".to_owned();
        for (k, load) in (0..4).flat_map(|_| levels).enumerate() {
            let noise = 2.0 * if k + 1 == row { off } else { random.normal() };
            let load_kg = if k + 1 == row { written } else { load };
            text += &format!("z,{load_kg},{},{:.1}\n", k / levels.len() + 1, 80.0 * load + noise);
        }
        let mended = mended(&Readings::from_text("f", &text).unwrap(), None, &[]).unwrap();
        let load = (mended.readings.rows[row - 1].load / G * 1e4).round() / 1e4;
        (names(&mended), load)
    };
    for (row, written, off, meant) in [
        (14, 24.9, 3.0, 2.49),
        (10, 0.034, 2.0, 0.34),
        (10, 0.034, -2.5, 0.34),
        (11, 0.14, 1.5, 0.41),
        (20, 0.16, 3.5, 1.6),
    ] {
        let (names, load) = with(row, written, off);
        assert_eq!(names, [format!("typing_mistake load_kg, row {row}")], "{written}");
        assert_eq!(load, meant, "{written}, {off} scatters off");
    }
}

/// Of two channels neither shows loads well enough, both together do.
#[test]
fn two_coarse_channels_correct_a_load_together() {
    const SEEDS: u64 = 20;
    let is_found = |seed: &u64| {
        let mut random = Random::seeded(*seed, 0);
        let mut text = "axis,load_n,trial,dx_um,dz_um\n".to_owned();
        let rows = |trial| [2.5, 5.0, 7.5, 10.0, 12.5, 15.0].map(|load| (trial, load));
        for (trial, load) in (1..=4).flat_map(rows) {
            // 15 N are 13 scatters of each
            let [x, z] = [4.0, -8.0].map(|slope: f64| slope * (load + 1.15 * random.normal()));
            let typed = if (trial, load) == (3, 12.5) { 1.25 } else { load };
            text += &format!("x,{typed},{trial},{x:.1},{z:.1}\n");
        }
        let named = found(&Readings::from_text("f", &text).unwrap(), None);
        assert!(named.is_empty() || named == ["typing_mistake load_n, row 17"], "{seed}: {named:?}");
        !named.is_empty()
    };
    let found = (0..SEEDS).filter(is_found).count();
    assert!(found > 9, "{found} of {SEEDS}");
}

/// A trial in pounds of which two coarse channels show one row: it is the trial, and no row.
#[test]
fn coarse_channels_correct_no_row_of_a_trial_in_another_unit() {
    for seed in 0..10 {
        let mut random = Random::seeded(seed, 0);
        let mut text = "axis,load_n,trial,dx_um,dz_um\n".to_owned();
        let rows = |trial| [1.0, 2.0, 3.0, 4.0, 5.0, 15.0].map(|load| (trial, load));
        for (trial, load) in (1..=4).flat_map(rows) {
            let [x, z] = [4.0, -8.0].map(|slope: f64| slope * (load + 0.9 * random.normal()));
            let typed = if trial == 3 { load / POUND } else { load };
            text += &format!("x,{typed},{trial},{x:.1},{z:.1}\n");
        }
        let named = found(&Readings::from_text("f", &text).unwrap(), None);
        assert!(named.iter().all(|name| !name.starts_with("typing_mistake")), "{seed}: {named:?}");
    }
}
