//! The least laborious measurement of r_rod: loads along y and z at the tip, and how often.
//!
//! Averages of R repeats at loads F have the variance σ²/R beside a zero that all of them share, so
//! that a line's slope s has Var s = σ²/(R·Σ(F − F̄)²). With r_rod = (s₂₂ + s₃₃)/(c₂₂ + c₃₃) of
//! slopes and modelled compliances, its 95 % interval is 2·t·√(Var s₂₂ + Var s₃₃)/(c₂₂ + c₃₃) wide,
//! t of the degrees of freedom that two lines leave.

use super::effort::{FEWEST, minutes};
use super::rig_plan::{Bench, PlannedLoads, Ratio, RigPlan};
use crate::beam::{Physics, RodModel};
use crate::error::{Error, Result};
use crate::inference::LoadPlan;
use crate::rig::readings::{Axis, Direction};
use crate::rod::Rod;
use crate::statistics::student_t_quantile;
use crate::units::{UM, significant};

/// Loads of a line, evenly up to the largest.
const LOADS: usize = 6;
/// A fit takes the larger of its estimates of the scatter (about the line, between repeats), with
/// the degrees of freedom of that one: in the mean so many times the scatter, as the test below
/// finds it.
const LARGER: f64 = 1.1;
/// More is no plan.
const MOST_REPEATS: usize = 100;

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
/// assert!(ratio.expected <= 0.01 && plan.measurements[0].loads.repeats == 6);
/// # Ok::<(), rodcal::Error>(())
/// ```
///
/// # Errors
/// [`Error::NotApplicable`] where that takes more than 100 repeats; what the beam model refuses.
pub fn plan_ratio(rod: &Rod, width: f64, bench: &Bench) -> Result<RigPlan> {
    let [force, _] = RodModel::new(rod, &Physics::WHOLE, 1, &[])?.chain.tip_motion();
    let sum = force[(1, 1)] + force[(2, 2)];
    let loads: Vec<f64> = (1..=LOADS).map(|k| bench.largest_load * k as f64 / LOADS as f64).collect();
    let mean = loads.iter().sum::<f64>() / LOADS as f64;
    let spread: f64 = loads.iter().map(|load| (load - mean).powi(2)).sum();
    let of_repeats = |repeats: usize| -> Result<f64> {
        let t = LARGER * student_t_quantile(0.975, 2.0 * (LOADS - 2) as f64)?;
        let slope = bench.noise * bench.noise / (repeats as f64 * spread);
        Ok(2.0 * t * (2.0 * slope).sqrt() / sum)
    };
    let needed = (of_repeats(MOST_REPEATS)? / width).powi(2) * MOST_REPEATS as f64;
    if needed > MOST_REPEATS as f64 {
        return Err(Error::NotApplicable {
            what: format!("an interval of r_rod of {} %", significant(100.0 * width, 3)),
            why: format!(
                "with loads to {} N and noise of {} µm it takes about {needed:.0} repeats",
                significant(bench.largest_load, 3),
                significant(bench.noise / UM, 3)
            ),
            hint: "larger loads, a quieter sensor or a wider interval".into(),
        });
    }
    let mut repeats = FEWEST;
    while of_repeats(repeats)? > width && repeats < MOST_REPEATS {
        repeats += 1;
    }
    let list: Vec<String> = loads.iter().map(|load| significant(*load, 3)).collect();
    let along = |axis: Axis| {
        let loads = LoadPlan {
            direction: Direction::along(axis),
            loads: loads.clone(),
            unloading: false,
            load_station: None,
            read_station: None,
            waits: vec![0.0],
            repeats,
            channels: Axis::ALL.to_vec(),
        };
        PlannedLoads {
            description: format!(
                "Load the tip along {axis} with {} N, {repeats} times, each time from a new zero; read dx, dy and dz.",
                list.join(", ")
            ),
            minutes: minutes(&loads),
            loads,
        }
    };
    let measurements = vec![along(Axis::Y), along(Axis::Z)];
    Ok(RigPlan {
        minutes: measurements.iter().map(|one| one.minutes).sum(),
        measurements,
        // of its form: more repeats never make the interval wider
        is_least: true,
        wanted: f64::NAN,
        distinguished: Vec::new(),
        ratio: Some(Ratio { asked: width, expected: of_repeats(repeats)? }),
    })
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::rig::readings::{Reading, Readings};
    use crate::rig::{self, Options};
    use crate::statistics::Random;

    /// Beside what a fit then says: the mean width of 40 simulated recordings.
    #[test]
    fn the_interval_is_as_wide_as_a_fit_then_says() {
        let rod = Rod::read("rods/5.toml".as_ref()).unwrap();
        let bench = Bench { largest_load: 10.0, noise: 2e-6, is_at_tip: true };
        let plan = plan_ratio(&rod, 0.01, &bench).unwrap();
        let [force, _] = RodModel::new(&rod, &Physics::WHOLE, 1, &[]).unwrap().chain.tip_motion();
        let mut random = Random::seeded(4, 15);
        let mut widths = Vec::new();
        for _ in 0..40 {
            let mut rows = Vec::new();
            for one in &plan.measurements {
                let axis = one.loads.direction.axis;
                for trial in 0..one.loads.repeats {
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
        assert!((0.9..1.1).contains(&(mean / expected)), "{mean} {expected}");
    }

    #[test]
    fn what_takes_too_many_repeats_says_how_many() {
        let rod = Rod::read("rods/5.toml".as_ref()).unwrap();
        let bench = Bench { largest_load: 1.0, noise: 2e-6, is_at_tip: true };
        let error = plan_ratio(&rod, 0.001, &bench).unwrap_err().to_string();
        assert!(error.contains("repeats"), "{error}");
    }
}
