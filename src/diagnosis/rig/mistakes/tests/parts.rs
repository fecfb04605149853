//! Mistakes in a part of a recording, which the rest shows.

use super::*;
use crate::rig::readings::LoadColumn;

/// The rows of a trial.
fn of_trial<'a>(readings: &'a mut Readings, trial: &'a str) -> impl Iterator<Item = &'a mut Reading> {
    readings.rows.iter_mut().filter(move |row| row.trial.as_deref() == Some(trial))
}

#[test]
fn what_one_trial_is_written_in_the_others_show() {
    let mut cases = Cases::default();
    recordings(&[Bench::Full, Bench::Own], 1, |what, file, clean| {
        let all = "dx_um, dy_um, dz_um";
        let mut kilograms = clean.clone();
        of_trial(&mut kilograms, "3").for_each(|row| row.load /= G);
        cases.expect(&format!("{what} kg"), &kilograms, file, &["unit_mistake load_n, trial 3"]);
        let mut millimetres = clean.clone();
        of_trial(&mut millimetres, "1")
            .flat_map(|row| row.offset.iter_mut().flatten())
            .for_each(|y| *y *= 1e-3);
        let expected = format!("unit_mistake {all}, trial 1");
        cases.expect(&format!("{what} mm"), &millimetres, file, &[&expected]);
        let mut range = clean.clone();
        for row in of_trial(&mut range, "2") {
            row.offset[1].iter_mut().for_each(|y| *y *= 10.0);
        }
        // along one axis, loads that were divided by g are 2 % from that: more than the lines of
        // 5# are uncertain
        if what.contains("5#") {
            cases.expect(&format!("{what} range"), &range, file, &["unit_mistake dy_um, trial 2"]);
        }
        // without a rod, by the other trials alone
        for (readings, expected) in [(&kilograms, "unit_mistake load_n, trial 3"), (&millimetres, &expected)]
        {
            assert_eq!(found(readings, None), [expected], "{what}");
        }
    });
    recordings(&[Bench::Full], 1, |what, file, clean| {
        let mut swapped = clean.clone();
        of_trial(&mut swapped, "2").for_each(|row| row.offset.swap(0, 1));
        cases.expect(&format!("{what} columns"), &swapped, file, &["swap_mistake dx_um and dy_um, trial 2"]);
        let mut against = clean.clone();
        of_trial(&mut against, "2").flat_map(|row| row.offset.iter_mut().flatten()).for_each(|y| *y *= -1.0);
        let expected = ["sign_mistake dx_um, dy_um, dz_um, trial 2"];
        cases.expect(&format!("{what} signs"), &against, file, &expected);
        let corrected = mended(&against, Some(file), &[]).unwrap().readings;
        assert!(corrected.rows == clean.rows, "{what}");
    });
    cases.check();
}

/// A load that was typed wrongly in a trial that is in another unit throughout.
#[test]
fn a_single_load_of_a_trial_in_another_unit_is_corrected_too() {
    let mut cases = Cases::default();
    recordings(&[Bench::Full, Bench::Own], 2, |what, file, clean| {
        let is_it = |row: &Reading| {
            (row.direction.axis, row.trial.as_deref(), row.load) == (Axis::Z, Some("3"), 15.0)
        };
        let row = clean.rows.iter().position(is_it).unwrap();
        let mut wrong = clean.clone();
        wrong.rows[row].load = 150.0;
        of_trial(&mut wrong, "3").for_each(|row| row.load /= G);
        let typed = format!("typing_mistake load_n, row {}", row + 1);
        cases.expect(&what, &wrong, file, &[&typed, "unit_mistake load_n, trial 3"]);
    });
    cases.check();
}

/// Trials at different stations have no line in common: the rod file says what one of them is
/// written in, also where nothing else was read at its station.
#[test]
fn what_a_trial_at_another_station_is_written_in_the_rod_file_shows() {
    let mut cases = Cases::default();
    recordings(&[Bench::Own], 3, |what, file, clean| {
        let station = 0.6 * file.length();
        let tip = file.length();
        // what a sensor shows nearer the root, by the rod
        let pairs = [[None, None], [None, Some(station)]];
        let physics = super::super::physics::Physics::new(file, &pairs).unwrap();
        let share = |axis: usize| physics.compliance(1)[(axis, axis)] / physics.compliance(0)[(axis, axis)];
        assert!(station < tip);
        let read_at = |trials: &[&str]| {
            let mut readings = clean.clone();
            for trial in trials {
                for row in of_trial(&mut readings, trial) {
                    row.read_station = Some(station);
                    let share = share(row.direction.axis.index());
                    row.offset.iter_mut().flatten().for_each(|y| *y *= share);
                }
            }
            readings
        };
        for trials in [&["1"][..], &["1", "3"]] {
            let right = read_at(trials);
            let what = format!("{what} {trials:?}");
            cases.expect(&what, &right, file, &[]);
            let mut newtons = right.clone();
            of_trial(&mut newtons, "1").for_each(|row| row.load /= G);
            let expected = ["unit_mistake load_n, trial 1"];
            cases.expect(&format!("{what} kg"), &newtons, file, &expected);
            let mut flipped = right.clone();
            of_trial(&mut flipped, "1")
                .filter(|row| row.direction.axis.index() == 1)
                .for_each(|row| row.offset[1].iter_mut().for_each(|y| *y *= -1.0));
            if trials.len() == 1 {
                cases.expect(&format!("{what} sign"), &flipped, file, &["sign_mistake dy_um, trial 1"]);
            }
        }
    });
    cases.check();
}

/// The only trial at another station belongs to those that the rod file confirms as it does it, and
/// not to one with which it has no line in common either, whose columns are exchanged.
#[test]
fn columns_of_one_trial_are_exchanged_where_another_one_has_a_station_of_its_own() {
    let mut cases = Cases::default();
    recordings(&[Bench::Full], 3, |what, file, clean| {
        let near = 0.25 * file.length();
        let pairs = [[None, None], [None, Some(near)]];
        let physics = super::super::physics::Physics::new(file, &pairs).unwrap();
        let mut readings = clean.clone();
        for row in of_trial(&mut readings, "2") {
            row.read_station = Some(near);
            let k = row.direction.axis.index();
            let [tip, own] = [0, 1].map(|at| physics.compliance(at));
            let change = (own.column(k) - tip.column(k)) * (f64::from(row.direction.sign) * row.load);
            row.offset.iter_mut().zip(change.iter()).for_each(|(offset, change)| {
                offset.iter_mut().for_each(|offset| *offset += change);
            });
        }
        cases.expect(&what, &readings, file, &[]);
        of_trial(&mut readings, "1").for_each(|row| row.offset.swap(1, 2));
        let expected = ["swap_mistake dy_um and dz_um, trial 1"];
        cases.expect(&format!("{what} swapped"), &readings, file, &expected);
    });
    cases.check();
}

/// A sensor that shows the same number under all loads of a trial, to the micrometre, scatters all
/// the same: by a thousandth of that it would in millimetres, which grams are as well.
#[test]
fn grams_in_two_trials_are_no_millimetres_of_a_coarse_display() {
    let file = rod(ROD_5);
    let mut readings = recorded(&file, Bench::Full, 3);
    readings.load_column = LoadColumn::Kilograms;
    for offset in readings.rows.iter_mut().flat_map(|row| row.offset.iter_mut().flatten()) {
        *offset = (*offset / UM).round() * UM;
    }
    for row in of_trial(&mut readings, "2") {
        row.load *= 1e3;
        for k in (0..3).filter(|k| *k != row.direction.axis.index()) {
            row.offset[k] = row.offset[k].map(|_| UM);
        }
    }
    assert_eq!(found(&readings, Some(&file)), ["unit_mistake load_kg, trial 2"]);
}

/// Two trials of three in kilograms: the rod file knows that it is these.
#[test]
fn the_rod_file_says_which_trials_are_right() {
    let file = rod(ROD_5);
    let mut readings = recorded(&file, Bench::Full, 3);
    for trial in ["2", "3"] {
        of_trial(&mut readings, trial).for_each(|row| row.load /= G);
    }
    assert_eq!(found(&readings, Some(&file)), ["unit_mistake load_n, trials 2 and 3"]);
    // by the larger number alone the first would be the wrong one
    assert_eq!(found(&readings, None).len(), 1);
    assert!(found(&readings, None)[0].ends_with("trial 1"));
}

/// Nothing that has a name is said of it, and of a multiple that another rod would do as well.
#[test]
fn a_trial_of_a_softer_rod_is_no_unit() {
    recordings(&[Bench::Full, Bench::Own], 1, |what, file, clean| {
        for factor in [0.5, 0.8, 1.4, 2.0, 6.0] {
            let mut softer = clean.clone();
            of_trial(&mut softer, "2")
                .flat_map(|row| row.offset.iter_mut().flatten())
                .for_each(|y| *y *= factor);
            let mended = mended(&softer, Some(file), &[]).unwrap();
            let is_any_multiple = |own: &Finding| {
                let may_be_a_rod = own.rivals.iter().any(|rival| rival.effect.name == "rod_mistake");
                own.estimates[0].low < own.estimates[0].high && may_be_a_rod
            };
            assert!(mended.found.iter().all(is_any_multiple), "{what} {factor}: {:?}", names(&mended));
        }
    });
}

/// Readings of the rows from `from` on a row too low, the last one lost.
fn pushed_down(clean: &Readings, from: usize) -> Readings {
    let mut pushed = clean.clone();
    for i in from..clean.rows.len() {
        pushed.rows[i].offset = clean.rows[i - 1].offset;
    }
    pushed
}

/// A display that begins anew at 600 µm reads in every run the same under the same load: no row is
/// displaced.
#[test]
fn a_display_that_begins_anew_displaces_no_rows() {
    for (seed, loads) in (0..6).flat_map(|seed| [6, 8, 10].map(|loads| (seed, loads))) {
        let mut random = Random::seeded(seed, 0);
        let mut text = "axis,load_n,trial,dy_um,dz_um\n".to_owned();
        for (trial, axis) in (1..=3).flat_map(|trial| [(trial, "y"), (trial, "z")]) {
            for k in 1..=loads {
                let along = 800.0 * f64::from(k) / f64::from(loads);
                let shown = if along > 600.0 { along - 600.0 } else { along } + random.normal();
                let across = 0.05 * along + random.normal();
                let [y, z] = if axis == "y" { [shown, across] } else { [across, shown] };
                text += &format!("{axis},{},{trial},{y:.1},{z:.1}\n", 2 * k);
            }
        }
        let named = found(&Readings::from_text("f", &text).unwrap(), None);
        assert!(named.iter().all(|name| !name.contains("row_mistake")), "{seed} {loads}: {named:?}");
    }
}

#[test]
fn rows_that_were_displaced_are_found() {
    let mut cases = Cases::default();
    recordings(&[Bench::Full], 1, |what, file, clean| {
        // rod 2# hardly moves under loads along x: where it began cannot be seen there
        if what.contains("2#") {
            return;
        }
        let last = clean.rows.len();
        for from in [10, 33] {
            let expected = format!("row_mistake dx_um, dy_um, dz_um, rows {} to {last}", from + 1);
            cases.expect(&format!("{what} {from}"), &pushed_down(&clean, from), file, &[&expected]);
        }
        let mut loads = clean.clone();
        (1..last).for_each(|i| loads.rows[i].load = clean.rows[i - 1].load);
        let expected = format!("row_mistake load_n, rows 2 to {last}");
        cases.expect(&format!("{what} loads"), &loads, file, &[&expected]);
        let mut upwards = clean.clone();
        for i in 1..last {
            let is_way_down = |i: usize| clean.rows[i].phase == Some(Phase::Unload);
            if is_way_down(i - 1) && is_way_down(i) {
                (upwards.rows[i - 1].load, upwards.rows[i].load) =
                    (clean.rows[i].load, clean.rows[i - 1].load);
            }
        }
        cases.expect(&format!("{what} way down"), &upwards, file, &["row_mistake load_n, way down"]);
    });
    cases.check();
}

/// A slide whose friction is as large as a step of the loads keeps the readings off like a row that
/// is displaced, but for the first reading of each run.
#[test]
fn friction_of_a_step_of_the_loads_displaces_nothing() {
    recordings(&[Bench::Full], 1, |what, file, clean| {
        let mut rubbing = clean.clone();
        for row in &mut rubbing.rows {
            let lost = if row.phase == Some(Phase::Unload) { -5.0 } else { 5.0 };
            let share = 1.0 - lost / row.load;
            row.offset.iter_mut().flatten().for_each(|y| *y *= share);
        }
        let named = found(&rubbing, Some(file));
        assert!(named.iter().all(|name| !name.contains("row_mistake")), "{what}: {named:?}");
    });
}

/// The same where the slide, after a reversal, first holds the rod where it is, under more loads:
/// no zero of a way stands for that. Rows that are displaced are found among these loads as well.
#[test]
fn friction_that_holds_the_rod_after_a_reversal_displaces_nothing() {
    let step = 12.0 / 7.0;
    let mut rows = Vec::new();
    for (axis, trial) in Axis::ALL.into_iter().flat_map(|axis| (1..=3).map(move |trial| (axis, trial))) {
        for k in (1..=7).chain((1..7).rev()) {
            let row = Reading::new(Direction::along(axis), step * f64::from(k)).with_trial(trial.to_string());
            rows.push(Axis::ALL.into_iter().fold(row, |row, channel| row.with_offset(channel, 0.0)));
        }
    }
    let file = rod(ROD_5);
    let clean = read(&file, rows, 4);
    for friction in [1.0, 1.2] {
        let (mut rubbing, mut run, mut seen) = (clean.clone(), None, 0.0);
        for row in &mut rubbing.rows {
            let own = (row.direction.axis, row.trial.clone());
            if run.replace(own.clone()) != Some(own) {
                seen = 0.0;
            }
            seen = f64::clamp(seen, row.load - friction * step, row.load + friction * step);
            row.offset.iter_mut().flatten().for_each(|y| *y *= seen / row.load);
        }
        let named = found(&rubbing, Some(&file));
        assert!(named.iter().all(|name| !name.contains("row_mistake")), "{friction}: {named:?}");
    }
    let expected = format!("row_mistake dx_um, dy_um, dz_um, rows 46 to {}", clean.rows.len());
    assert_eq!(found(&pushed_down(&clean, 45), Some(&file)), [expected]);
}

#[test]
fn a_trial_that_repeats_another_one_is_a_copy() {
    let mut cases = Cases::default();
    recordings(&[Bench::Full, Bench::Own], 1, |what, file, clean| {
        let first: Vec<Reading> =
            clean.rows.iter().filter(|row| row.trial.as_deref() == Some("1")).cloned().collect();
        let mut copied = clean.clone();
        for (row, original) in of_trial(&mut copied, "3").zip(&first) {
            row.offset = original.offset;
        }
        cases.expect(&what, &copied, file, &["copy_mistake trial 3"]);
        // without noise every trial is like every other
        let mut exact = copied.clone();
        for (row, original) in of_trial(&mut exact, "2").zip(&first) {
            row.offset = original.offset;
        }
        assert!(found(&exact, Some(file)).is_empty(), "{what}");
    });
    cases.check();
}

/// A display that hides what single readings scatter by: others share a half of them, not all.
#[test]
fn a_copy_under_a_coarse_display_is_a_copy() {
    let mut cases = Cases::default();
    let file = rod(ROD_5);
    for (seed, step) in [(0, 5.0 * UM), (1, 10.0 * UM), (2, 5.0 * UM), (3, 10.0 * UM)] {
        let mut clean = recorded(&file, Bench::Full, seed);
        for y in clean.rows.iter_mut().flat_map(|row| row.offset.iter_mut().flatten()) {
            *y = (*y / step).round() * step;
        }
        let first: Vec<Reading> =
            clean.rows.iter().filter(|row| row.trial.as_deref() == Some("1")).cloned().collect();
        let mut copied = clean.clone();
        for (row, original) in of_trial(&mut copied, "3").zip(&first) {
            row.offset = original.offset;
        }
        cases.expect(&format!("{seed}"), &clean, &file, &[]);
        cases.expect(&format!("{seed} copied"), &copied, &file, &["copy_mistake trial 3"]);
    }
    cases.check();
}

/// The other trials were read elsewhere: the readings themselves show that they scatter, or the
/// others do.
#[test]
fn a_copy_beside_a_trial_at_another_station_is_a_copy() {
    let mut cases = Cases::default();
    let file = rod(ROD_5);
    for (seed, loads, trials) in [(0, 15, 3), (1, 15, 3), (2, 8, 3), (3, 8, 3), (4, 4, 4), (5, 4, 4)] {
        let mut rows = Vec::new();
        for (trial, axis) in (1..=trials).flat_map(|trial| [Axis::Y, Axis::Z].map(|axis| (trial, axis))) {
            for k in 1..=loads {
                let mut row = Reading::new(Direction::along(axis), f64::from(k));
                row.trial = Some(trial.to_string());
                row.read_station = (trial % 2 == 0).then(|| 0.6 * file.length());
                row.offset = [Some(0.0); 3];
                rows.push(row);
            }
        }
        let clean = read(&file, rows, seed);
        let mut copied = clean.clone();
        let count = clean.rows.len() / trials;
        (0..count).for_each(|k| copied.rows[2 * count + k].offset = clean.rows[k].offset);
        cases.expect(&format!("{seed}"), &clean, &file, &[]);
        cases.expect(&format!("{seed} copied"), &copied, &file, &["copy_mistake trial 3"]);
    }
    cases.check();
}

/// Where trials have no names a run ends where a load comes again, which kilograms do not.
#[test]
fn trials_without_names_begin_where_an_axis_comes_back() {
    let file = rod(ROD_5);
    let mut readings = recorded(&file, Bench::Full, 9);
    // trial by trial, each along all axes
    readings.rows.sort_by_key(|row| row.trial.clone());
    let last = readings.rows.len();
    for row in &mut readings.rows {
        if row.trial.as_deref() == Some("3") {
            row.load /= G;
        }
        (row.trial, row.time) = (None, None);
    }
    let expected = format!("unit_mistake load_n, rows {} to {last}", last * 2 / 3 + 1);
    assert_eq!(found(&readings, Some(&file)), [expected]);
}

#[test]
fn increments_are_added_up() {
    let file = rod(ROD_5);
    let clean = recorded(&file, Bench::Full, 11);
    let mut increments = clean.clone();
    for (i, row) in increments.rows.iter_mut().enumerate().skip(1) {
        let before = &clean.rows[i - 1];
        if before.trial == row.trial && before.direction == row.direction {
            for (own, before) in row.offset.iter_mut().zip(before.offset) {
                *own = own.zip(before).map(|(own, before)| own - before);
            }
        }
    }
    let mended = mended(&increments, Some(&file), &[]).unwrap();
    assert_eq!(names(&mended), ["increment_mistake dx_um, dy_um, dz_um"]);
    for (row, clean) in mended.readings.rows.iter().zip(&clean.rows) {
        for (own, right) in row.offset.iter().flatten().zip(clean.offset.iter().flatten()) {
            assert!((own - right).abs() < 1e-12);
        }
    }
    // without the rod's file they are a zero as well
    assert_eq!(found(&increments, None), [""; 0]);
}

/// Three repeats of one load that stop at one value, where noise is two steps of the display.
#[test]
fn readings_at_one_load_that_are_the_same_are_cut_off() {
    let file = rod(ROD_5);
    let mut readings = recorded(&file, Bench::Full, 13);
    for offset in readings.rows.iter_mut().filter_map(|row| row.offset[2].as_mut()) {
        *offset = ((*offset / UM).round() * UM).min(640.0 * UM);
    }
    let mended = mended(&readings, Some(&file), &[]).unwrap();
    assert_eq!(names(&mended), ["saturated_sensor dz_um"]);
}

/// Trials without names that repeat one list of loads: where one of them has another zero, those
/// before it do not stand two rows too low.
#[test]
fn a_zero_of_an_unnamed_trial_moves_no_rows() {
    let file = rod(ROD_5);
    // about what the rod yields along y and z, m/N
    let (c, mut random) = (42.0 * UM, Random::seeded(2, 0));
    let mut rows = Vec::new();
    for trial in 0..6 {
        for axis in [Axis::Y, Axis::Z] {
            for load in [4.0, 8.0, 12.0, 16.0, 20.0] {
                let zero = if trial == 5 && axis == Axis::Z { -0.5 * 20.0 * c } else { 0.0 };
                let offset = c * load + zero + UM * random.normal();
                rows.push(Reading::new(Direction::along(axis), load).with_offset(axis, offset));
            }
        }
    }
    let mended = mended(&Readings::from_rows(rows).unwrap(), Some(&file), &[]).unwrap();
    assert!(names(&mended).iter().all(|name| !name.starts_with("row_mistake")), "{:?}", names(&mended));
}

/// Own channels only, up only, a display that ends at half of the largest reading: the readings at
/// its end are no readings of the rows above.
#[test]
fn a_display_at_its_end_displaces_no_rows() {
    let mut cases = Cases::default();
    let file = rod(ROD_5);
    for seed in 0..3 {
        let mut rows = Vec::new();
        for (trial, axis) in (1..=6).flat_map(|trial| Axis::ALL.map(|axis| (trial, axis))) {
            for k in 1..=7 {
                let mut row = Reading::new(Direction::along(axis), 2.2 * f64::from(k));
                row.trial = Some(trial.to_string());
                row.offset[axis.index()] = Some(0.0);
                rows.push(row);
            }
        }
        let mut readings = read(&file, rows, seed);
        let most = readings.rows.iter().filter_map(|row| row.offset[1]).fold(0.0, f64::max);
        for row in &mut readings.rows {
            row.offset[1].iter_mut().for_each(|y| *y = y.min((5.3e6 * most / 8.0).round() / 1e6));
        }
        cases.expect(&format!("{seed}"), &readings, &file, &["saturated_sensor dy_um"]);
    }
    cases.check();
}

/// Each channel is read under loads along its own axis only, and one of them badly: where its
/// readings stood two rows higher, they would be read under the other axis too.
#[test]
fn readings_of_a_bad_sensor_are_read_under_no_other_axis() {
    let file = rod(ROD_5);
    let mut moved = Vec::new();
    for seed in 0..60 {
        let mut random = Random::seeded(seed, 0);
        let mut rows = Vec::new();
        for (_, axis) in (0..5).flat_map(|trial| [Axis::Y, Axis::Z].map(|axis| (trial, axis))) {
            for load in [9.5, 19.0, 28.5] {
                let (c, noise) = if axis == Axis::Y { (21.0, 3.0) } else { (7.0, 20.0) };
                let offset = (c * load + noise * random.normal()) * UM;
                rows.push(Reading::new(Direction::along(axis), load).with_offset(axis, offset));
            }
        }
        let mended = mended(&Readings::from_rows(rows).unwrap(), Some(&file), &[]).unwrap();
        moved.extend(names(&mended).into_iter().filter(|name| name.starts_with("row_mistake")));
    }
    assert!(moved.is_empty(), "{moved:?}");
}
