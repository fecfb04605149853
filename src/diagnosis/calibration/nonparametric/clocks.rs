//! What goes its own way while the poses are recorded: a robot or a tool that moves, a base that
//! turns, the zero of a joint.

use nalgebra::Vector3;

use super::super::effects::clamp_drift::shares;
use super::super::model::entry::{Entry, linear};
use super::super::model::law::Frame;
use super::super::model::{Configuration, Context};
use super::curve::{MOST, SIZE, along, cosine, curve, scaled, vectors};
use crate::inference::Variable;

/// How a base turns.
#[derive(Debug, Clone, Copy)]
enum Base {
    /// About the vertical, and moves across it.
    StaysLevel,
    /// About any axis.
    Tilts,
}

/// Over the order of the poses, over times and temperatures that are known. Where sockets are
/// nobody has measured: what turns the base, or joint 1, are plates that moved.
pub(super) fn all(context: &Context) -> Vec<Entry> {
    let mut entries = Vec::new();
    let rows = &context.recording.rows;
    let known =
        |number: &dyn Fn(usize) -> Option<f64>| (0..rows.len()).map(number).collect::<Option<Vec<f64>>>();
    let clocks = [
        (Variable::Order, "the order of the poses", known(&|row| Some(row as f64))),
        (Variable::Time, "the time", known(&|row| rows[row].time)),
        (Variable::Temperature, "the temperature", context.recording.temperatures()),
    ];
    for (variable, name, values) in clocks {
        let label = variable.to_string();
        let Some(values) = values else { continue };
        for frame in [Frame::World, Frame::Tool] {
            entries.extend(along(context, variable, &label, name, &values, frame));
        }
        if !context.has_sockets() {
            entries.extend(turning(context, variable, &label, name, &values, Base::StaysLevel));
            entries.extend(turning(context, variable, &label, name, &values, Base::Tilts));
        }
    }
    entries.extend(shares(context).into_iter().map(|(group, shares)| clamp(context, group, &shares)));
    // the last joint turns as the tool moves
    let first = if context.has_sockets() { 1 } else { 0 };
    let inner = first..context.joint_count().saturating_sub(1);
    let turns = context.revolute().into_iter().filter(|j| inner.contains(j));
    entries.extend(turns.filter_map(|j| zero(context, j)));
    entries
}

/// A base that turns by itself, or the tracker that sees it: what several slips of the base
/// describe roughly.
///
/// Σ_k (a_k + b_k × (ball − base))·cos(π k x)        b_k along the vertical and a_k level, where
///                                                   the base stays so
fn turning(
    context: &Context,
    variable: Variable,
    label: &str,
    name: &str,
    values: &[f64],
    base: Base,
) -> Option<Entry> {
    let x = scaled(values)?;
    let lever = context.largest(|there| (there.tip - there.origin[0]).norm());
    let down = context.configurations.first()?.gravity.try_normalize(0.0);
    let up = down.map_or(Vector3::z(), |down| -down);
    let across = up.cross(&Vector3::ith(up.iamin(), 1.0)).normalize();
    let axes = [across, up.cross(&across), up];
    let parameters = (1..=MOST).flat_map(|k| {
        let size = SIZE / (1 + k) as f64;
        let moved = |axis: usize| {
            let column = context.column(|row, _| axes[axis] * cosine(k, x[row]));
            (linear(format!("{axis}_cosine_{k}_um"), size), column)
        };
        let turned = |axis: usize| {
            let about = |there: &Configuration| axes[axis].cross(&(there.tip - there.origin[0]));
            let column = context.column(|row, there| about(there) * cosine(k, x[row]));
            (linear(format!("about_{axis}_cosine_{k}_urad"), size / lever), column)
        };
        let (moves, turns) = match base {
            Base::StaysLevel => (0..2, 2..3),
            Base::Tilts => (0..3, 0..3),
        };
        moves.map(moved).chain(turns.map(turned)).collect::<Vec<_>>()
    });
    let how = match base {
        Base::StaysLevel => "turns about the vertical",
        Base::Tilts => "turns",
    };
    let label = format!("{label}, a curve of the base that {how}");
    let follows = format!("follows {name}, as a base that {how}");
    (lever > 0.0).then(|| curve(label, follows, Some(variable), parameters.collect()))
}

/// A clamp that goes its own way over its poses, which two or three knocks describe
/// roughly.
///
/// Σ_k a_k·cos(π k x)        a_k a vector in {W}, x the share of its poses that are over
fn clamp(context: &Context, group: usize, shares: &[f64]) -> Entry {
    let name = &context.recording.groups[group].name;
    let parameters = (1..=MOST).flat_map(|k| {
        let course = |row: usize| if shares[row].is_nan() { 0.0 } else { cosine(k, shares[row]) };
        vectors(context, &format!("cosine_{k}"), SIZE / (1 + k) as f64, Frame::World, &course)
    });
    let follows = format!("follows the order of the poses at {name}, along fixed directions");
    curve(
        format!("order at {name}, a curve in the world"),
        follows,
        Some(Variable::Order),
        parameters.collect(),
    )
}

/// A joint whose zero goes its own way while the poses are recorded: a drive that warms up by its
/// own moves, which two slips of the joint describe roughly.
///
/// Σ_k a_k·cos(π k x)·Jⱼ        x the order of the poses, from 0 to 1
fn zero(context: &Context, joint: usize) -> Option<Entry> {
    let order: Vec<f64> = (0..context.configurations.len()).map(|row| row as f64).collect();
    let x = scaled(&order)?;
    let lever = context.largest(|there| there.tip_jacobian[joint].norm());
    let of_order = |k: usize| {
        let column = context.column(|row, there| there.tip_jacobian[joint] * cosine(k, x[row]));
        (linear(format!("cosine_{k}_urad"), SIZE / ((1 + k) as f64 * lever)), column)
    };
    let label = format!("order, a curve of the zero of joint {}", joint + 1);
    let follows = format!("follows the order of the poses, as the zero of joint {}", joint + 1);
    let parameters = (1..=MOST).map(of_order).collect();
    (lever > 0.0).then(|| curve(label, follows, Some(Variable::Order), parameters))
}
