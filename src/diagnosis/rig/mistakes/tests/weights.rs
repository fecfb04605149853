//! A weight that is another one, and what is none.

use super::*;

const LOADS: [f64; 8] = [2.0, 4.0, 6.0, 8.0, 10.0, 12.0, 14.0, 16.0];

/// Three trials up through eight loads along each axis, so many times as large, where the one said
/// to be `said` is `is`.
fn hung(bench: Bench, times: f64, (said, is): (f64, f64), file: &Rod, seed: u64) -> Readings {
    let axes: &[Axis] = if bench == Bench::OneLine { &[Axis::Y] } else { &Axis::ALL };
    let mut hung = Vec::new();
    for (trial, &axis) in (1..=3).flat_map(|trial| axes.iter().map(move |axis| (trial, axis))) {
        for load in LOADS {
            let load = times * if load == said { is } else { load };
            let mut row = Reading::new(Direction::along(axis), load).with_trial(trial.to_string());
            for channel in Axis::ALL {
                if bench == Bench::Full || channel == axis {
                    row = row.with_offset(channel, 0.0);
                }
            }
            hung.push(row);
        }
    }
    let mut readings = read(file, hung, seed);
    readings.rows.iter_mut().filter(|row| row.load == times * is).for_each(|row| row.load = times * said);
    readings
}

#[test]
fn a_weight_that_is_another_one_is_named_and_left_out() {
    let mut cases = Cases::default();
    // the second rod is eight times as stiff
    for (name, text, times) in [("5#", ROD_5, 1.0), ("2#", ROD_2, 8.0)] {
        let file = rod(text);
        for (bench, seed) in [(Bench::Full, 1), (Bench::Own, 2), (Bench::OneLine, 3), (Bench::Full, 4)] {
            for (said, is) in [(8.0, 8.5), (12.0, 9.0)] {
                let wrong = hung(bench, times, (said, is), &file, seed);
                let (said, is) = (times * said, times * is);
                let what = format!("{name} {bench:?} {said}");
                cases.expect(
                    &what,
                    &wrong,
                    &file,
                    &[&format!("weight_mistake load_n, all rows of {said} N")],
                );
                let mended = mended(&wrong, Some(&file), &[]).unwrap();
                let Some(own) = mended.found.first().map(|found| &found.estimates[0]) else { continue };
                assert!(own.low < is && is < own.high, "{what}: {own:?}");
                let is_read = |row: &Reading| row.offset.iter().any(Option::is_some);
                assert!(mended.readings.rows.iter().all(|row| is_read(row) == (row.load != said)), "{what}");
            }
            cases.expect(
                &format!("{name} {bench:?}"),
                &hung(bench, times, (8.0, 8.0), &file, seed),
                &file,
                &[],
            );
        }
    }
    cases.check();
}

/// How much of a load arrives at the rod in a trial, N.
type Arrives<'a> = &'a dyn Fn(f64, u32) -> f64;

/// What a line of slope 40 µm/N reads where each load and trial arrives as `arrives` says.
fn named(arrives: Arrives, seed: u64) -> Vec<String> {
    let mut random = Random::seeded(seed, 0);
    let mut text = "axis,load_n,trial,dy_um,dz_um\n".to_owned();
    for (trial, load) in (1..=3).flat_map(|trial| LOADS.map(|load| (trial, load))) {
        let arrives = arrives(load, trial);
        let [y, z] = [40.0, 25.0].map(|slope| slope * arrives + random.normal());
        text += &format!("y,{load},{trial},{y:.1},{z:.1}\n");
    }
    found(&Readings::from_text("f", &text).unwrap(), None)
}

#[test]
fn curves_steps_ends_and_single_runs_are_no_weights() {
    let none: [(&str, Arrives); 8] = [
        ("a stop", &|load, _| load + 0.2 * f64::max(load - 9.0, 0.0)),
        ("a gap", &|load, _| load + f64::min(load, 5.0) * 0.1),
        ("a step", &|load, _| if load > 9.0 { load - 0.5 } else { load }),
        ("a curve", &|load, _| load - 0.01 * load * load),
        ("a wave", &|load, _| load + 0.2 * (1.3 * load).sin()),
        ("the largest", &|load, _| if load == 16.0 { 15.0 } else { load }),
        ("the least", &|load, _| if load == 2.0 { 3.0 } else { load }),
        ("two of three runs", &|load, trial| if load == 8.0 && trial < 3 { 8.5 } else { load }),
    ];
    for ((what, arrives), seed) in none.into_iter().flat_map(|one| [1, 2, 3].map(|seed| (one, seed))) {
        let named = named(arrives, seed);
        assert!(!named.iter().any(|name| name.starts_with("weight")), "{what} {seed}: {named:?}");
    }
    let two = |load: f64, _| if load == 6.0 || load == 12.0 { load + 0.5 } else { load };
    assert_eq!(named(&two, 1), [""; 0]);
    let one = |load: f64, _| if load == 6.0 { load + 0.5 } else { load };
    assert_eq!(named(&one, 1), ["weight_mistake load_n, all rows of 6 N"]);
}
