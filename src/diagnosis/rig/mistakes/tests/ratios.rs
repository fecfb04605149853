//! Trials that show a multiple of what the others show, and loads of one axis.

use super::*;
use crate::inference::Key;

const ALL_CHANNELS: &str = "dx_um, dy_um, dz_um";

fn scale_loads(readings: &mut Readings, factor: f64, is_its: impl Fn(&Reading) -> bool) {
    readings.rows.iter_mut().filter(|row| is_its(row)).for_each(|row| row.load *= factor);
}

fn is_in(trial: &'static str) -> impl Fn(&Reading) -> bool {
    move |row| row.trial.as_deref() == Some(trial)
}

/// Loads that hung twice, on a block, and readings of a display in another range.
#[test]
fn a_trial_that_shows_a_multiple_of_the_others_is_left_out() {
    recordings(&[Bench::Full, Bench::Own], 2, |what, file, clean| {
        for factor in [0.5, 2.2] {
            let mut wrong = clean.clone();
            scale_loads(&mut wrong, factor, is_in("2"));
            for rod in [Some(file), None] {
                let mended = mended(&wrong, rod, &[]).unwrap();
                let [found] = &mended.found[..] else { panic!("{what}: {:?}", names(&mended)) };
                assert_eq!(names(&mended), [format!("unit_mistake {ALL_CHANNELS}, trial 2")], "{what}");
                // the readings are to be multiplied by what the loads were
                let estimate = &found.estimates[0];
                assert!(estimate.low < factor && factor < estimate.high, "{what}: {estimate:?}");
                assert!(estimate.high - estimate.low < 0.25 * factor, "{what}: {estimate:?}");
                // the loads may be wrong as well, or the rod is another one
                let rivals: Vec<_> = found.rivals.iter().map(|rival| rival.location.to_string()).collect();
                assert_eq!(rivals, ["load_n, trial 2", "rod, trial 2"], "{what}");
                // nobody knows what they are
                let is_left_out = |row: &Reading| row.offset.iter().all(Option::is_none);
                let rows = &mended.readings.rows;
                assert!(rows.iter().all(|row| is_left_out(row) == is_in("2")(row)), "{what}");
                assert!(!is_unknown_unit(found), "{what}: the others say what the rod is");
            }
        }
    });
}

/// A clamp that is loose in one trial turns about one axis more than about another, and of one line
/// nothing is said however many trials show it.
#[test]
fn a_clamp_that_is_loose_in_some_trials_is_no_other_unit() {
    let loose = |clean: &Readings, trials: &[&str], turns: &dyn Fn(Axis) -> f64| {
        let mut wrong = clean.clone();
        let is_its = |row: &Reading| row.trial.as_deref().is_some_and(|trial| trials.contains(&trial));
        for row in wrong.rows.iter_mut().filter(|row| is_its(row)) {
            let turns = turns(row.direction.axis);
            row.offset.iter_mut().flatten().for_each(|y| *y *= turns);
        }
        wrong
    };
    let none_is_named = |what: &str, wrong: &Readings, file: &Rod| {
        let names = found(wrong, Some(file));
        assert!(names.iter().all(|name| !name.contains("unit")), "{what}: {names:?}");
    };
    recordings(&[Bench::Full], 2, |what, file, clean| {
        let turns = |axis: Axis| if axis == Axis::Y { 1.5 } else { 2.0 };
        none_is_named(&what, &loose(&clean, &["3"], &turns), file);
    });
    recordings(&[Bench::OneLine], 2, |what, file, clean| {
        none_is_named(&what, &loose(&clean, &["1", "3"], &|_| 1.7), file);
    });
}

/// Kilograms are within 2 % of a decimal point: of loads along one axis both are said.
#[test]
fn a_decimal_point_of_one_axis_is_said_beside_kilograms() {
    recordings(&[Bench::Full], 2, |what, file, clean| {
        // on 2# a root that turns under loads along y does as much
        if what.starts_with("2#") {
            return;
        }
        let along_y = |row: &Reading| row.direction.axis == Axis::Y;
        let check = |wrong: &Readings, rows: &[&str]| {
            let mended = mended(wrong, Some(file), &[]).unwrap();
            let readings = rows.iter().fold(Key::new(ALL_CHANNELS), |key, rows| key.rows(*rows));
            let [found] = &mended.found[..] else { panic!("{what}: {:?}", names(&mended)) };
            let rivals = found.rivals.iter().map(|rival| &rival.location);
            let places: Vec<&Location> = std::iter::once(&found.location).chain(rivals).collect();
            assert!(places.contains(&&Location::from(readings)), "{what}: {places:?}");
        };
        let mut of_axis = clean.clone();
        scale_loads(&mut of_axis, 0.1, along_y);
        check(&of_axis, &["axis y"]);
        let mut of_trial = clean.clone();
        scale_loads(&mut of_trial, 0.1, |row| along_y(row) && is_in("2")(row));
        check(&of_trial, &["axis y", "trial 2"]);
    });
}
