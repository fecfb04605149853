//! Sensors and zeros.

use super::*;

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

/// It stops while the loads go along y, which does not move it, and misses all loads along z.
#[test]
fn a_sensor_that_stopped_before_all_loads_that_move_it_is_found_with_the_rod() {
    let mut cases = Cases::default();
    recordings(&[Bench::Full], 2, |what, file, clean| {
        // rod 2# hardly moves along x
        if what.contains("2#") {
            return;
        }
        let mut readings = clean.clone();
        // along x, y and z one after another
        readings.rows.sort_by_key(|row| row.direction.axis.index());
        let along = |axis: Axis| readings.rows.iter().position(|row| row.direction.axis == axis).unwrap();
        let from = (along(Axis::Y) + along(Axis::Z)) / 2;
        let value = readings.rows[from].offset[0];
        let at = format!("stuck_sensor dx_um, rows {} to {}", from + 1, readings.rows.len());
        readings.rows[from..].iter_mut().for_each(|row| row.offset[0] = value);
        cases.expect(&what, &readings, file, &[&at]);
        // what hardly trembles may well show the same
        let mut clean = clean.clone();
        clean.rows.iter_mut().for_each(|row| {
            row.offset[0].iter_mut().for_each(|x| *x = (*x / (20.0 * UM)).round() * 20.0 * UM)
        });
        cases.expect(&format!("{what} coarse"), &clean, file, &[]);
    });
    cases.check();
}

/// The rod goes on by less than a step of the displays along z: they show the same there.
#[test]
fn a_sensor_is_not_stuck_where_its_display_cannot_show_what_the_rod_does() {
    let file = rod(&ROD_5.replace("gamma_deg = 90.0", "gamma_deg = 140.0"));
    let mut readings = recorded(&file, Bench::Own, 2);
    let largest = |readings: &Readings, channel: usize| {
        let all = readings.rows.iter().filter_map(|row| row.offset[channel]);
        all.fold(0.0, |most: f64, y| most.max(y.abs()))
    };
    let step = 10.0 * UM;
    let smaller = 0.95 * step / largest(&readings, 2);
    readings = with_loads(&all_scaled(&readings, smaller), smaller);
    assert!(largest(&readings, 1) < 20.0 * step, "z would be no part of what is looked at");
    for row in &mut readings.rows {
        row.offset.iter_mut().flatten().for_each(|y| *y = (*y / step).ceil() * step);
    }
    let named = found(&readings, Some(&file));
    assert!(named.iter().all(|name| !name.contains("stuck")), "{named:?}");
}

#[test]
fn a_sensor_that_was_cut_off_from_the_second_load_on_is_found_with_the_rod() {
    let file = rod(ROD_5);
    let mut readings = recorded(&file, Bench::Own, 41);
    // one trial, up only: one reading of x is left below the limit
    readings.rows.retain(|row| row.trial.as_deref() == Some("1") && row.phase != Some(Phase::Unload));
    readings.rows.dedup_by(|next, row| next.direction == row.direction && next.load <= row.load);
    let limit = 1.3 * readings.rows[0].offset[0].map_or(0.0, f64::abs);
    readings.rows.iter_mut().for_each(|row| row.offset[0] = row.offset[0].map(|x| x.clamp(-limit, limit)));
    assert_eq!(found(&readings, Some(&file)), ["saturated_sensor dx_um"]);
    assert!(found(&readings, None).is_empty());
}

#[test]
fn along_an_axis_on_which_the_rod_hardly_moves_a_zero_is_off_by_a_share_of_what_it_moves_else() {
    // the load along z presses on the end of a straight rod
    let file = straight();
    let clean = recorded(&file, Bench::Own, 42);
    let most = clean.rows.iter().filter_map(|row| row.offset[1]).fold(0.0, |most: f64, y| most.max(y.abs()));
    let with = |share: f64| {
        let mut readings = clean.clone();
        let of_run = |row: &&mut Reading| row.trial.as_deref() == Some("2");
        for row in readings.rows.iter_mut().filter(of_run) {
            row.offset[2] = row.offset[2].map(|z| z + share * most);
        }
        found(&readings, Some(&file))
    };
    assert!(with(0.03).is_empty(), "{:?}", with(0.03));
    assert_eq!(with(0.6), ["offset_mistake dz_um, axis z, trial 2"]);
}

#[test]
fn a_display_with_a_digit_to_show_is_not_stuck() {
    let file = straight();
    // three readings that rise by a digit each, and two trials that do not
    let read = |digit: f64| {
        let mut readings = recorded(&file, Bench::Own, 43);
        for row in readings.rows.iter_mut().filter(|row| row.direction.axis == Axis::Z) {
            let is_first = row.trial.as_deref() == Some("1");
            let rises = (is_first && row.load < 17.0 && row.phase.is_none()).then_some(row.load / 5.0);
            row.offset[2] = if is_first { rises.map(|steps| steps * digit) } else { Some(2.0 * digit) };
        }
        found(&readings, Some(&file))
    };
    assert!(read(2.0 * UM).is_empty(), "{:?}", read(2.0 * UM));
}

/// Loads of 5 to 20 N that bend by 1 µm/N, read to 0.1 µm in noise of 4 µm.
#[test]
fn readings_that_all_end_at_one_value_are_cut_off_wherever_the_line_goes() {
    let text = |shown: &dyn Fn(f64, f64) -> f64| {
        let mut random = crate::statistics::Random::seeded(7, 0);
        let mut text = "axis,load_n,trial,dy_um,dz_um\n".to_owned();
        for trial in 1..=12 {
            for load in [5.0, 10.0, 15.0, 20.0] {
                let (y, z) = (load + 4.0 * random.normal(), 0.1 * load + 4.0 * random.normal());
                text += &format!("y,{load},{trial},{:.1},{z:.1}\n", shown(y, load));
            }
        }
        Readings::from_text("f", &text).unwrap()
    };
    // the line reaches the limit, and goes no farther
    assert_eq!(found(&text(&|y, _| y.min(18.0)), None), ["saturated_sensor dy_um"]);
    assert!(found(&text(&|y, _| y), None).is_empty());
    // displacements that were set are the same wherever they are
    assert!(found(&text(&|y, _| (y / 7.0).round() * 7.0), None).is_empty());
    // so may repeats of the largest load be
    assert!(found(&text(&|y, load| if load == 20.0 { 35.0 } else { y }), None).is_empty());
    // a display with steps of a quarter of the noise ends so by chance
    assert!(found(&text(&|y, _| y.round()), None).is_empty());
}

/// Of 2 N a quarter of a newton is an eighth: lines are bent by friction, flipped or not.
#[test]
fn a_sign_in_one_run_is_found_beside_friction() {
    let mut text = "trial,axis,load_n,phase,dy_um\n".to_owned();
    for trial in 1..=4 {
        for (load, phase, held) in
            [(2, "load", -1.0), (4, "load", -1.0), (6, "load", -1.0), (8, "load", -1.0)].into_iter().chain([
                (6, "unload", 1.0),
                (4, "unload", 1.0),
                (2, "unload", 1.0),
            ])
        {
            let sign = if trial == 3 { -1.0 } else { 1.0 };
            let noise = f64::from((5 * trial + 3 * load) % 7 - 3) / 5.0;
            let read = sign * (45.6 * (f64::from(load) + 0.25 * held) + noise);
            text += &format!("{trial},y,{load},{phase},{read:.1}\n");
        }
    }
    let readings = Readings::from_text("f", &text).unwrap();
    assert_eq!(found(&readings, Some(&rod(ROD_5))), ["sign_mistake dy_um, axis y, trial 3"]);
}
