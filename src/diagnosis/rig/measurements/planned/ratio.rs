//! The least laborious measurement of r_rod: loads along y and z at the tip, and how often.
//!
//! Averages of R repeats at loads F have the variance σ²/R beside a zero that all of them share, so
//! that a line's slope s has Var s = σ²/(R·Σ(F − F̄)²). With r_rod = (s₂₂ + s₃₃)/(c₂₂ + c₃₃) of
//! slopes and modelled compliances, its 95 % interval is 2·t·√(Var s₂₂ + Var s₃₃)/(c₂₂ + c₃₃) wide,
//! t that of the rules by which a fit estimates its scatter.

use super::effort::minutes;
use super::rig_plan::{Bench, PlannedLoads, Ratio, RigPlan};
use crate::beam::{Physics, RodModel};
use crate::error::{Error, Result};
use crate::inference::LoadPlan;
use crate::rig::readings::{Axis, Direction};
use crate::rod::Rod;
use crate::units::{UM, significant};

/// Loads of a line, evenly up to the largest: enough to see that it is one, no more than anybody
/// hangs up.
const LOADS: std::ops::RangeInclusive<usize> = 4..=12;
/// Half of the 95 % interval that a fit gives, in standard deviations that noise alone makes: in
/// the mean of 4000 simulated recordings of [`LOADS`] (rows) and 1, 2, 3, 4 to 5, 6 and more
/// repeats. A fit of one repeat knows its scatter by two degrees of freedom a line less than it has
/// loads; one of two takes differences between its two zeros for what they may be.
const HALVES: [[f64; 5]; 9] = [
    [3.45, 3.44, 2.97, 2.91, 2.88],
    [2.64, 3.21, 2.64, 2.54, 2.50],
    [2.38, 3.21, 2.50, 2.43, 2.38],
    [2.25, 3.21, 2.42, 2.37, 2.32],
    [2.19, 3.19, 2.41, 2.33, 2.27],
    [2.15, 3.09, 2.37, 2.29, 2.25],
    [2.12, 3.09, 2.33, 2.26, 2.23],
    [2.09, 3.21, 2.35, 2.28, 2.21],
    [2.08, 3.31, 2.35, 2.25, 2.19],
];
/// More is no plan.
const MOST_REPEATS: usize = 1000;

/// The plan whose 95 % interval of r_rod is at most `width` wide (a share: 0.01 is 1 %), as far as
/// noise makes it.
///
/// ```
/// use rodcal::diagnosis::rig::planned::{Bench, plan_ratio};
/// use rodcal::prelude::*;
///
/// let rod = Rod::read("rods/5.toml".as_ref())?;
/// let bench = Bench { largest_load: 10.0, noise: 2e-6, is_at_tip: true };
/// let plan = plan_ratio(&rod, 0.01, &bench)?;
/// let ratio = plan.ratio.expect("that is what was asked for");
/// assert!(ratio.expected <= 0.01 && plan.measurements[0].loads.repeats == 3);
/// # Ok::<(), rodcal::Error>(())
/// ```
///
/// # Errors
/// [`Error::NotApplicable`] where that takes more than 1000 repeats; what the beam model refuses.
pub fn plan_ratio(rod: &Rod, width: f64, bench: &Bench) -> Result<RigPlan> {
    let [force, _] = RodModel::new(rod, &Physics::WHOLE, 1, &[])?.chain.tip_motion();
    let sum = force[(1, 1)] + force[(2, 2)];
    let expected = |loads: usize, repeats: usize| expected_width(sum, loads, repeats, bench);
    let mut best: Option<(f64, usize, usize)> = None;
    let mut needed = f64::INFINITY;
    for loads in LOADS {
        let of_many = (expected(loads, MOST_REPEATS) / width).powi(2) * MOST_REPEATS as f64;
        needed = needed.min(of_many);
        if of_many > MOST_REPEATS as f64 {
            continue;
        }
        // fewer repeats leave t larger, so that none below is enough
        let enough = (of_many as usize).max(1)..=MOST_REPEATS;
        let Some(repeats) = enough.into_iter().find(|&repeats| expected(loads, repeats) <= width) else {
            continue;
        };
        let labour = minutes(&line(Axis::Y, loads, repeats, bench));
        if best.is_none_or(|(least, ..)| labour < least) {
            best = Some((labour, loads, repeats));
        }
    }
    let Some((_, count, repeats)) = best else {
        return Err(Error::NotApplicable {
            what: format!("an interval of r_rod of {} %", significant(100.0 * width, 3)),
            why: format!(
                "with loads to {} N and noise of {} µm it takes about {} repeats, and {MOST_REPEATS} are the most that a plan has",
                significant(bench.largest_load, 3),
                significant(bench.noise / UM, 3),
                if needed < 1e6 { format!("{needed:.0}") } else { significant(needed, 3) }
            ),
            hint: "larger loads, a quieter sensor or a wider interval".into(),
        });
    };
    let along = |axis: Axis| {
        let loads = line(axis, count, repeats, bench);
        let list: Vec<String> = loads.loads.iter().map(|load| significant(*load, 3)).collect();
        PlannedLoads {
            description: format!(
                "Load the tip along {axis} with {} N, {}; read dx, dy and dz.",
                list.join(", "),
                match repeats {
                    1 => "once, from a new zero".to_owned(),
                    _ => format!("{repeats} times, each time from a new zero"),
                }
            ),
            minutes: minutes(&loads),
            loads,
        }
    };
    let measurements = vec![along(Axis::Y), along(Axis::Z)];
    Ok(RigPlan {
        minutes: measurements.iter().map(|one| one.minutes).sum(),
        measurements,
        // of its form: all numbers of loads were looked at, and more repeats never make the
        // interval wider
        is_least: true,
        wanted: f64::NAN,
        distinguished: Vec::new(),
        ratio: Some(Ratio { asked: width, expected: expected(count, repeats) }),
    })
}

/// So many loads along one axis at the tip, evenly up to the largest.
fn line(axis: Axis, count: usize, repeats: usize, bench: &Bench) -> LoadPlan {
    LoadPlan {
        direction: Direction::along(axis),
        loads: loads(count, bench),
        unloading: false,
        load_station: None,
        read_station: None,
        waits: vec![0.0],
        repeats,
        channels: Axis::ALL.to_vec(),
    }
}

fn loads(count: usize, bench: &Bench) -> Vec<f64> {
    (1..=count).map(|k| bench.largest_load * k as f64 / count as f64).collect()
}

/// Width of the 95 % interval of r_rod, a share, with `sum` the modelled compliance along y and z.
fn expected_width(sum: f64, count: usize, repeats: usize, bench: &Bench) -> f64 {
    let loads = loads(count, bench);
    let mean = loads.iter().sum::<f64>() / count as f64;
    let spread: f64 = loads.iter().map(|load| (load - mean).powi(2)).sum();
    let column = [1, 2, 3, 5].iter().filter(|&&most| repeats > most).count();
    let half = HALVES[count - LOADS.start()][column];
    let slope = bench.noise * bench.noise / (repeats as f64 * spread);
    2.0 * half * (2.0 * slope).sqrt() / sum
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::rig::readings::{Reading, Readings};
    use crate::rig::{self, Options};
    use crate::statistics::{Random, student_t_quantile};

    /// Beside what a fit then says: the mean width of 60 simulated recordings, of one repeat, of
    /// two and of more.
    #[test]
    fn the_interval_is_as_wide_as_a_fit_then_says() {
        let rod = Rod::read("rods/5.toml".as_ref()).unwrap();
        let bench = Bench { largest_load: 10.0, noise: 2e-6, is_at_tip: true };
        let [force, _] = RodModel::new(&rod, &Physics::WHOLE, 1, &[]).unwrap().chain.tip_motion();
        let mut random = Random::seeded(4, 15);
        for (asked, repeats) in [(0.03, 1), (0.018, 1), (0.013, 3), (0.005, 9)] {
            let plan = plan_ratio(&rod, asked, &bench).unwrap();
            assert_eq!(plan.measurements[0].loads.repeats, repeats);
            let mut widths = Vec::new();
            for _ in 0..60 {
                let mut rows = Vec::new();
                for one in &plan.measurements {
                    let axis = one.loads.direction.axis;
                    for trial in 0..repeats {
                        for &load in &one.loads.loads {
                            let slope = force[(axis.index(), axis.index())];
                            let offset = slope * load + bench.noise * random.normal();
                            let row = Reading::new(one.loads.direction, load).with_offset(axis, offset);
                            rows.push(Reading { trial: Some(trial.to_string()), ..row });
                        }
                    }
                }
                let readings = Readings::from_rows(rows).unwrap();
                let fit = rig::fit(&readings, Some(&rod), &Options::default()).unwrap();
                let ratio = fit.measured.unwrap().rod_ratio;
                let t = student_t_quantile(0.975, ratio.dof as f64).unwrap();
                widths.push(2.0 * t * ratio.std_error.unwrap());
            }
            let mean = widths.iter().sum::<f64>() / widths.len() as f64;
            let expected = plan.ratio.unwrap().expected;
            assert!((0.9..1.1).contains(&(mean / expected)), "{repeats}: {mean} {expected}");
        }
    }

    /// Beside every number of loads and of repeats.
    #[test]
    fn no_other_plan_of_lines_takes_less_time() {
        let rod = Rod::read("rods/5.toml".as_ref()).unwrap();
        let bench = Bench { largest_load: 10.0, noise: 2e-6, is_at_tip: true };
        let [force, _] = RodModel::new(&rod, &Physics::WHOLE, 1, &[]).unwrap().chain.tip_motion();
        let sum = force[(1, 1)] + force[(2, 2)];
        for width in [0.1, 0.03, 0.02, 0.014, 0.013, 0.01, 0.007, 0.005, 0.004] {
            let all = LOADS.flat_map(|loads| (1..100).map(move |repeats| (loads, repeats)));
            let enough = all.filter(|&(loads, repeats)| expected_width(sum, loads, repeats, &bench) <= width);
            let labour = enough.map(|(loads, repeats)| 2.0 * minutes(&line(Axis::Y, loads, repeats, &bench)));
            let plan = plan_ratio(&rod, width, &bench).unwrap();
            assert_eq!(plan.minutes, labour.fold(f64::INFINITY, f64::min), "{width}");
            assert!(plan.ratio.unwrap().expected <= width);
        }
    }

    #[test]
    fn what_takes_too_many_repeats_says_how_many() {
        let rod = Rod::read("rods/5.toml".as_ref()).unwrap();
        let bench = Bench { largest_load: 1.0, noise: 2e-6, is_at_tip: true };
        let error = plan_ratio(&rod, 0.001, &bench).unwrap_err().to_string();
        assert!(error.contains("repeats"), "{error}");
        // many are laborious, and possible
        let plan = plan_ratio(&rod, 0.014, &bench).unwrap();
        assert!(plan.measurements[0].loads.repeats > 100, "{}", plan.measurements[0].loads.repeats);
    }
}
