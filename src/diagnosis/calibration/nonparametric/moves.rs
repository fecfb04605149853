//! Rivals for what an arm remembers of the way that it came.
//!
//! Lag and play follow the last move alone. What follows moves before it (a belt that creeps, a
//! seal that was dragged along, a controller that integrates) looks like both, because a move that
//! begins where the one before ended runs against that on average. With Δₖ the k-th move before a
//! pose, of joint j
//!
//! ```text
//! all joints alike    Σⱼ Jⱼ·Σ_k f_k·Δₖⱼ               k from 1, the last move, on
//! each joint          Jⱼ·Σ_k f_k·Δₖⱼ
//! by their direction  Jⱼ·Σ_k h_k·sign Δₖⱼ
//! fading              Jⱼ·(f·x + g·x³/x_max²)       x = Σ_k ρ^(k−1)·Δₖⱼ over all moves, which may saturate
//! ```

use super::super::model::Context;
use super::super::model::configuration::STANDSTILL;
use super::super::model::entry::{Entry, linear};
use super::curve::curve;
use crate::inference::Variable;

/// Moves that may be remembered.
const MOVES: usize = 3;
/// Size of a share of a move, and of a turn by its direction, rad.
const SHARE: f64 = 3e-4;
/// What is left of a move after the next one, ρ.
const FADING: [f64; 4] = [0.4, 0.6, 0.75, 0.9];
const TURN: f64 = 100e-6;

/// All of them.
pub(super) fn all(context: &Context) -> Vec<Entry> {
    let mut entries = vec![all_joints(context)];
    for j in context.revolute() {
        let joint = format!("joint {}", j + 1);
        entries.push(of_joint(context, j, format!("{joint}, its last moves"), SHARE, &|step| step));
        let direction = |step: f64| if step.abs() > STANDSTILL { step.signum() } else { 0.0 };
        entries.push(of_joint(
            context,
            j,
            format!("{joint}, the directions of its last moves"),
            TURN,
            &direction,
        ));
        entries.extend(FADING.iter().filter_map(|left| fading(context, j, *left)));
    }
    entries
}

/// The k-th move before a row, zero where there was none.
fn step(context: &Context, row: usize, k: usize, joint: usize) -> f64 {
    row.checked_sub(k - 1).map_or(0.0, |row| context.configurations[row].step[joint])
}

fn all_joints(context: &Context) -> Entry {
    let parameters = (1..=MOVES).map(|k| {
        let column = context.column(|row, there| {
            let moved = there.tip_jacobian.iter().enumerate();
            moved.map(|(j, jacobian)| jacobian * step(context, row, k, j)).sum()
        });
        (linear(format!("share_of_move_{k}"), SHARE), column)
    });
    let follows = "follows the moves before, not the last one alone";
    curve("order, the last moves of all joints", follows, Some(Variable::Order), parameters.collect())
}

fn of_joint(context: &Context, j: usize, label: String, size: f64, lag: &dyn Fn(f64) -> f64) -> Entry {
    let parameters = (1..=MOVES).map(|k| {
        let column = context.turn(j, |row, _| lag(step(context, row, k, j)));
        (linear(format!("move_{k}_urad"), size), column)
    });
    let follows = format!("follows the moves of joint {} before, not the last one alone", j + 1);
    curve(label, follows, Some(Variable::Order), parameters.collect())
}

/// What fades from move to move; `None` where the joint stands still.
fn fading(context: &Context, j: usize, left: f64) -> Option<Entry> {
    let kept: Vec<f64> = (context.configurations.iter())
        .scan(0.0, |kept, there| {
            *kept = left * *kept + there.step[j];
            Some(*kept)
        })
        .collect();
    let most = kept.iter().fold(0.0, |most: f64, kept| most.max(kept.abs()));
    let column = |share: &dyn Fn(f64) -> f64| context.turn(j, |row, _| share(kept[row]));
    let parameters = vec![
        (linear("share", SHARE), column(&|x| x)),
        (linear("share_of_cube", SHARE), column(&|x| x.powi(3) / most.powi(2))),
    ];
    let label = format!("joint {}, its moves, of which {left} is left after the next", j + 1);
    let follows = format!("follows the moves of joint {} before, not the last one alone", j + 1);
    (most > STANDSTILL).then(|| curve(label, follows, Some(Variable::Order), parameters))
}
