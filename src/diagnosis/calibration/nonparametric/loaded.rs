//! Rivals for what a drive does by its torque beyond giving way.
//!
//! ```text
//! a loaded wave   Jⱼ·(a·sin(n·qⱼ) + b·cos(n·qⱼ))·τⱼ/τ_max     n cycles per revolution, scanned
//! hysteresis      Jⱼ·a·zⱼ/τ_max     zᵢ = max(τᵢ − w, min(τᵢ + w, zᵢ₋₁)), z₀ = 0
//! ```
//!
//! A drive that is stiffer at some angles than at others shows a wave that grows with its load, and
//! reverses with it: an error of its gear would not. What is left of earlier loads, the play
//! operator z of half width w (M. A. Krasnosel'skii, A. V. Pokrovskii, *Systems with Hysteresis*,
//! 1989, ch. 1), follows the last moves as lag and friction do, and steps as a joint that slips.

use std::f64::consts::TAU;

use super::super::model::Context;
use super::super::model::entry::{Entry, linear};
use super::curve::{LEAST_TORQUE, TURN, angle_of, curve};
use crate::inference::{JointVariable, Variable};

/// Last frequency of loaded waves, cycles per revolution, and their widest step.
const SCAN: (f64, f64) = (16.0, 0.5);
/// All loaded waves of a joint are as frequent as so many other rivals.
const WAVES: f64 = 2.0;
/// Half widths of hysteresis, as shares of the range of the torque.
const WIDTHS: [f64; 7] = [0.05, 0.1, 0.15, 0.2, 0.25, 0.3, 0.4];

/// All of them.
pub(super) fn all(context: &Context) -> Vec<Entry> {
    let joints = context.revolute().into_iter().filter(|&j| context.has_masses && most(context, j).is_some());
    joints.flat_map(|j| waves(context, j).into_iter().chain(hysteresis(context, j))).collect()
}

/// The largest torque of a joint that is loaded, N·m.
fn most(context: &Context, j: usize) -> Option<f64> {
    let most = context.largest(|there| there.torque[j]);
    (most > LEAST_TORQUE).then_some(most)
}

fn waves(context: &Context, j: usize) -> Vec<Entry> {
    let Some(most) = most(context, j) else { return Vec::new() };
    let (low, high) = context.range(j);
    // frequencies that differ by less than one cycle over the range are the same to these poses
    let per_cycle = (2.0 * (high - low) / TAU).ceil().max(1.0 / SCAN.1);
    let count = (SCAN.0 * per_cycle) as usize;
    let wave = |k: usize| {
        let cycles = k as f64 / per_cycle;
        let parameter = |name: &str, wave: fn(f64) -> f64| {
            let column = context.turn(j, |_, there| there.torque[j] / most * wave(cycles * there.joints[j]));
            (linear(format!("{name}_urad"), TURN), column)
        };
        let parameters = vec![parameter("loaded_sin", f64::sin), parameter("loaded_cos", f64::cos)];
        let joint = format!("joint {}", j + 1);
        let times = format!("{} times per revolution", (cycles * 100.0).round() / 100.0);
        let follows = format!("comes back {times} of {joint}, the more the larger its torque");
        let label = format!("{joint}, a wave {times}, times its torque");
        let mut entry = curve(label, follows, Some(angle_of(j)), parameters);
        entry.candidate.weight = WAVES / count as f64;
        entry
    };
    (1..=count).map(wave).collect()
}

fn hysteresis(context: &Context, j: usize) -> Vec<Entry> {
    let Some(most) = most(context, j) else { return Vec::new() };
    let torque: Vec<f64> = context.configurations.iter().map(|there| there.torque[j]).collect();
    let least = torque.iter().copied().fold(f64::INFINITY, f64::min);
    let range = torque.iter().copied().fold(f64::NEG_INFINITY, f64::max) - least;
    let of_width = |share: f64| {
        let left = play(&torque, share * range);
        let column = context.turn(j, |row, _| left[row] / most);
        let joint = format!("joint {}", j + 1);
        let label = format!("{joint}, what earlier torques have left");
        let follows = format!("follows the torques of {joint} in the poses before");
        let variable = Variable::Joint(j, JointVariable::Torque);
        let parameters = vec![(linear("remembered_urad", TURN), column)];
        let mut entry = curve(label, follows, Some(variable), parameters);
        entry.candidate.weight = 1.0 / WIDTHS.len() as f64;
        entry
    };
    WIDTHS.iter().map(|share| of_width(*share)).collect()
}

/// What is left of earlier values by the play operator of half width w.
fn play(values: &[f64], width: f64) -> Vec<f64> {
    let follow = |left: &mut f64, value: &f64| {
        *left = left.clamp(value - width, value + width);
        Some(*left)
    };
    values.iter().scan(0.0, follow).collect()
}

#[cfg(test)]
mod tests {
    use super::play;

    #[test]
    fn what_earlier_torques_have_left_follows_only_beyond_its_width() {
        assert_eq!(play(&[1.0, 3.0, 2.0, -1.0], 1.0), [0.0, 2.0, 2.0, 0.0]);
    }
}
