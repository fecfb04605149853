//! What is loose, or runs out: shapes of a few numbers, which curves of many columns pay too much
//! for, so that whatever resembles them would be named.
//!
//! ```text
//! a tool that is loose        a·e·sign(e·g)       e a direction in {T}, scanned: it rests on the side to
//!                                                 which gravity g presses it
//! a bearing that runs out     a·sin(nθ) + b·cos(nθ), n = 1 and 2, of all beyond a joint
//!                             along its axis, or, n = 2, across it, or about lines across it
//! ```
//!
//! Once per turn across its axis is a link of another length, once per turn about lines across it
//! another direction of the axis: calibrations find these.

use nalgebra::Vector3;

use super::curve::curve;
use super::{SIDES, SIZE, TURN};
use crate::diagnosis::calibration::configuration::Configuration;
use crate::diagnosis::calibration::context::Context;
use crate::diagnosis::calibration::entry::{Column, Entry, linear};
use crate::inference::Parameter;
use crate::units::{UM, URAD};

/// All of them; those of each kind have the prior of one curve together.
pub(super) fn all(context: &Context) -> Vec<Entry> {
    let mut tools: Vec<Entry> = SIDES.iter().map(|side| tool(context, side)).collect();
    let joints = context.revolute();
    let mut bearings: Vec<Entry> = joints.into_iter().flat_map(|joint| bearing(context, joint)).collect();
    for of_kind in [&mut tools, &mut bearings] {
        let share = 1.0 / of_kind.len().max(1) as f64;
        of_kind.iter_mut().for_each(|entry| entry.candidate.weight = share);
    }
    tools.extend(bearings);
    tools
}

fn tool(context: &Context, side: &[f64; 3]) -> Entry {
    let direction = Vector3::from(*side).normalize();
    let column = context.column(|_, there| {
        let held = there.flange.rotation * direction;
        let pressed = held.dot(&there.gravity);
        if pressed == 0.0 { Vector3::zeros() } else { held * pressed.signum() }
    });
    let along = named(side);
    let follows = format!("follows to which side gravity presses the tool, along {along} of {{T}}");
    let parameter = (linear("clearance_um", UM, SIZE), column);
    curve(format!("orientation, loose along {along} of the tool"), follows, None, vec![parameter])
}

/// `x`, `x + y`, `x − z`.
fn named(side: &[f64; 3]) -> String {
    let mut name = String::new();
    for (number, letter) in side.iter().zip(["x", "y", "z"]).filter(|(number, _)| **number != 0.0) {
        match (name.is_empty(), *number > 0.0) {
            (true, true) => {}
            (true, false) => name.push('−'),
            (false, true) => name.push_str(" + "),
            (false, false) => name.push_str(" − "),
        }
        name.push_str(letter);
    }
    name
}

/// Shapes that come back with each turn of a joint.
fn bearing(context: &Context, joint: usize) -> Vec<Entry> {
    let waves =
        |name: &str, unit: f64, size: f64, n: usize, moved: &dyn Fn(&Configuration) -> Vector3<f64>| {
            let angle = move |there: &Configuration| n as f64 * there.joints[joint];
            let wave = |label: &str, of: &dyn Fn(f64) -> f64| -> (Parameter, Column) {
                let column = context.column(|_, there| moved(there) * of(angle(there)));
                (linear(format!("{name}_{label}_{n}"), unit, size), column)
            };
            [wave("sin", &f64::sin), wave("cos", &f64::cos)]
        };
    let across = |axis: usize| {
        move |there: &Configuration| -> Vector3<f64> { there.link[joint].rotation.column(axis).into() }
    };
    let about = |axis: usize| {
        move |there: &Configuration| -> Vector3<f64> {
            across(axis)(there).cross(&(there.tip - there.origin[joint]))
        }
    };
    let shape = |n: usize, where_to: &str, parameters: Vec<(Parameter, Column)>| {
        let (number, times) = (joint + 1, if n == 1 { "once" } else { "twice" });
        let label = format!("joint {number}, {times} per turn {where_to} its axis");
        let follows = format!("comes back {times} per turn of joint {number}, {where_to} its axis");
        curve(label, follows, Some(super::angle_of(joint)), parameters)
    };
    let along = |n: usize| waves("along_um", UM, SIZE, n, &|there| there.axis[joint]).into();
    let of_both =
        |name: [&str; 2], unit: f64, size: f64, moved: [&dyn Fn(&Configuration) -> Vector3<f64>; 2]| {
            let [x, y] = [0, 1].map(|k| waves(name[k], unit, size, 2, moved[k]));
            x.into_iter().chain(y).collect()
        };
    let shifted = of_both(["x_um", "y_um"], UM, SIZE, [&across(0), &across(1)]);
    let tilted = of_both(["about_x_urad", "about_y_urad"], URAD, TURN, [&about(0), &about(1)]);
    vec![
        shape(1, "along", along(1)),
        shape(2, "along", along(2)),
        shape(2, "across", shifted),
        shape(2, "about lines across", tilted),
    ]
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn directions_are_said_by_their_axes() {
        let names: Vec<String> =
            [[1.0, 0.0, 0.0], [1.0, 0.0, -1.0], [-1.0, 1.0, 1.0]].iter().map(named).collect();
        assert_eq!(names, ["x", "x − z", "−x + y + z"]);
    }
}
