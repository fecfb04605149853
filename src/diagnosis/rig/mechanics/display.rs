//! What a display shows of a displacement that came by another one: a stylus with play, a pointer
//! that sticks, a display or a rod that is read before it has settled.
//!
//! ```text
//! play  y ← min(max(y, u − p/2), u + p/2)      p the whole gap (play operator)
//! lag   y = u − λ·(u − u′)                      λ the share of the last change that is not shown yet
//! ```
//!
//! u is what the display should show of what was set, by the base model: which way it moved, and
//! how far it moves at all, is the same for a rod that is a little softer. A display was set to
//! zero without a load, in the middle of its play, or on that side of it where the run before has
//! left it.

use nalgebra::DVector;

use crate::diagnosis::rig::numbering::numbered;
use crate::diagnosis::rig::recording::datum::Datum;
use crate::inference::DERIVATIVE_STEP;

/// How a display follows.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Follows {
    /// After a play, m, in the middle of which each run begins.
    BehindPlay,
    /// After a play, m, that is on the side where the run before has left it.
    BehindPlayOfBefore,
    /// A share of the last change later. What is left of those before is a second order that
    /// friction of a slide which turns round little by little draws as well.
    Later,
}

/// What the displays of some sensors should show, in the order in which they were read.
#[derive(Debug, Clone)]
pub struct Display {
    follows: Follows,
    /// For each sensor and session its runs: data with what they should show, m.
    sensors: Vec<Vec<Vec<(usize, f64)>>>,
}

impl Display {
    /// Of the data that are its own.
    pub fn of(data: &[Datum], follows: Follows, is_its: impl Fn(&Datum) -> bool) -> Display {
        let own: Vec<usize> = (0..data.len()).filter(|&i| is_its(&data[i])).collect();
        let sensor = numbered(own.iter().map(|&i| (data[i].session_number, data[i].sensor())));
        let mut sensors: Vec<Vec<Vec<(usize, f64)>>> = Vec::new();
        let mut last: Vec<usize> = Vec::new();
        for (&i, &sensor) in own.iter().zip(&sensor) {
            if sensor == sensors.len() {
                sensors.push(Vec::new());
                last.push(usize::MAX);
            }
            if last[sensor] != data[i].run {
                sensors[sensor].push(Vec::new());
                last[sensor] = data[i].run;
            }
            if let Some(run) = sensors[sensor].last_mut() {
                run.push((i, data[i].predicted_as_set()));
            }
        }
        Display { follows, sensors }
    }

    /// How it follows.
    pub fn follows(&self) -> Follows {
        self.follows
    }

    /// What each of `count` readings changes by per `size` of the value, at `value`. At nothing it
    /// can only go one way, and what stays within its play is seen once that has a size.
    pub fn derivative(&self, count: usize, value: f64, size: f64) -> DVector<f64> {
        let h = DERIVATIVE_STEP * size;
        let (less, more) = match value > h {
            true => (value - h, value + h),
            false => (0.0, value.max(0.0) + 0.5 * size),
        };
        let [less_shown, more_shown] = [less, more].map(|value| {
            let mut added = DVector::zeros(count);
            self.add_to(added.as_mut_slice(), value);
            added
        });
        (more_shown - less_shown) * (size / (more - less))
    }

    /// Adds what a display shows too much at `value`, m or a share.
    pub fn add_to(&self, readings: &mut [f64], value: f64) {
        if value <= 0.0 {
            return;
        }
        let half = 0.5 * value;
        let next = |shown: f64, u: f64| shown.max(u - half).min(u + half);
        for runs in &self.sensors {
            let mut shown = 0.0;
            for run in runs {
                let zero = match self.follows {
                    Follows::BehindPlayOfBefore => next(shown, 0.0),
                    Follows::BehindPlay | Follows::Later => 0.0,
                };
                shown = zero;
                let mut before = 0.0;
                for &(i, u) in run {
                    shown = next(shown, u);
                    readings[i] += match self.follows {
                        Follows::BehindPlay | Follows::BehindPlayOfBefore => shown - zero - u,
                        Follows::Later => -value * (u - before),
                    };
                    before = u;
                }
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::diagnosis::rig::recording::datum;
    use crate::rig::readings::Readings;

    /// Two runs of 100, 200, 100 µm and a channel that moves by a hundredth of that; what is added.
    fn added(follows: Follows, value: f64) -> Vec<f64> {
        let run = |trial: &str| {
            let row = |(load, phase): (f64, &str)| format!("y,{load},{trial},{phase},0,0\n");
            [(10.0, "load"), (20.0, "load"), (10.0, "unload")].map(row).concat()
        };
        let text = "axis,load_n,trial,phase,dy_um,dz_um\n".to_owned() + &run("1") + &run("2");
        let mut data = datum::all(&Readings::from_text("f", &text).unwrap().rows);
        for datum in &mut data {
            let share = if datum.channel == crate::spatial::Axis::Y { 1.0 } else { 0.01 };
            datum.predicted = share * 10.0 * datum.load;
        }
        let mut readings = vec![0.0; data.len()];
        Display::of(&data, follows, |_| true).add_to(&mut readings, value);
        readings
    }

    fn channel(added: &[f64], first: usize) -> Vec<f64> {
        added.iter().skip(first).step_by(2).map(|a| (a * 1e6).round() / 1e6).collect()
    }

    #[test]
    fn a_display_is_behind_by_half_its_play_and_one_that_hardly_moves_not_at_all() {
        let of_middle = added(Follows::BehindPlay, 8.0);
        assert_eq!(channel(&of_middle, 0), [-4.0, -4.0, 4.0, -4.0, -4.0, 4.0]);
        // 1 and 2 µm within a play of 4 µm on either side: nothing is shown
        assert_eq!(channel(&of_middle, 1), [-1.0, -2.0, -1.0, -1.0, -2.0, -1.0]);
        let of_before = added(Follows::BehindPlayOfBefore, 8.0);
        assert_eq!(channel(&of_before, 0), [-4.0, -4.0, 4.0, -8.0, -8.0, 0.0]);
    }

    #[test]
    fn a_lag_lacks_a_share_of_each_change() {
        assert_eq!(channel(&added(Follows::Later, 0.1), 0)[..3], [-10.0, -10.0, 10.0]);
    }

    #[test]
    fn neither_adds_anything_where_it_is_nothing() {
        for follows in [Follows::BehindPlay, Follows::BehindPlayOfBefore, Follows::Later] {
            assert!(added(follows, 0.0).iter().all(|a| *a == 0.0));
        }
    }
}
