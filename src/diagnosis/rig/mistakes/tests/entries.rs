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

/// A weight that is heavier than it says, or a rod that jumps at a load, does so in every run.
#[test]
fn what_every_run_shows_of_a_load_was_not_typed_wrongly() {
    let file = rod(ROD_5);
    let clean = recorded(&file, Bench::Full, 7);
    let with = |trials: &[&str]| {
        let mut wrong = clean.clone();
        for row in wrong.rows.iter_mut().filter(|row| (row.direction.axis, row.load) == (Axis::Z, 15.0)) {
            if row.trial.as_deref().is_some_and(|trial| trials.contains(&trial)) {
                row.offset = row.offset.map(|y| y.map(|y| 1.4 * y));
            }
        }
        found(&wrong, Some(&file)).len()
    };
    assert_eq!([with(&["2"]), with(&["1", "2", "3"])], [1, 0]);
}

/// A display of ten micrometres that shows as good as nothing of a load corrects none.
#[test]
fn a_display_that_hardly_moves_knows_no_load() {
    let file = rod(ROD_5);
    let mut wrong = Vec::new();
    for seed in 0..40 {
        let mut readings = recorded(&file, Bench::Full, seed);
        let mut random = Random::seeded(seed, 1);
        for row in &mut readings.rows {
            row.load *= 0.1;
            for y in row.offset.iter_mut().flatten() {
                let shown = 0.1 * *y / UM + 5.6 * random.normal();
                *y = 10.0 * UM * (shown / 10.0).round();
            }
        }
        wrong.extend(found(&readings, Some(&file)).into_iter().map(|what| format!("{seed}: {what}")));
    }
    assert!(wrong.is_empty(), "{wrong:?}");
}

/// Two weights in the wrong order: each of the two rows makes the line follow it, so that the other
/// one may not be seen beside it.
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
