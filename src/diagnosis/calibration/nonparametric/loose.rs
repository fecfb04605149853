//! What is loose, or runs out: shapes of a few numbers, which curves of many columns pay too much
//! for, so that whatever resembles them would be named.
//!
//! ```text
//! a tool that is loose        a·e·sign(e·g)       e a direction in {T}, scanned: it rests on the side to
//!                                                 which gravity g presses it
//! one that sticks             a·s                 a a vector in {T}; s the side to which e·g has last
//!                                                 exceeded a share of g, which is scanned
//! a bearing that runs out     a·sin(nθ) + b·cos(nθ), n = 1 and 2, of all beyond a joint
//!                             along its axis, or, n = 2, across it, or about lines across it
//! a worn tooth                a·s·½·(1 + cos(π·(θ − θ₀)/w)) within w of θ₀, which are scanned; s is the
//!                             direction of approach of a joint, or the sign of its torque
//! ```
//!
//! Once per turn across its axis is a link of another length, once per turn about lines across it
//! another direction of the axis: calibrations find these.

use std::f64::consts::PI;

use nalgebra::Vector3;

use super::super::model::entry::{Column, Entry, linear};
use super::super::model::law::Frame;
use super::super::model::{Configuration, Context};
use super::curve::{SIDES, SIZE, TURN, angle_of, curve, vectors};
use crate::inference::Parameter;
use crate::units::DEG;

/// Shares of its weight by which a tool is pressed before it slips.
const STUCK: [f64; 3] = [0.25, 0.5, 0.75];
/// The largest coordinate of a point that says along which line a tool is loose.
const FINE: i32 = 2;
/// Half of the range over which a tooth may be worn, rad.
const WIDTHS: [f64; 3] = [20.0 * DEG, 35.0 * DEG, 60.0 * DEG];

/// All that is no joint's reversal; those of each kind have the prior of one curve together.
pub(super) fn all(context: &Context) -> Vec<Entry> {
    let mut tools: Vec<Entry> = lines().iter().map(|side| tool(context, side)).collect();
    let mut sticking: Vec<Entry> = (STUCK.iter())
        .flat_map(|&share| SIDES.iter().map(move |side| (share, side)))
        .map(|(share, side)| stuck(context, share, side))
        .collect();
    let joints = context.revolute();
    let mut bearings: Vec<Entry> = joints.into_iter().flat_map(|joint| bearing(context, joint)).collect();
    for of_kind in [&mut tools, &mut sticking, &mut bearings] {
        let share = 1.0 / of_kind.len().max(1) as f64;
        of_kind.iter_mut().for_each(|entry| entry.candidate.weight = share);
    }
    tools.extend(sticking);
    tools.extend(bearings);
    tools
}

/// Lines through the middle of a cube of five points along each edge. None is farther than 18° from
/// any other line: a looseness along one that lies between them is none of the library's effects.
fn lines() -> Vec<[f64; 3]> {
    let numbers = || (-FINE..=FINE).map(f64::from);
    let all = numbers().flat_map(|x| numbers().flat_map(move |y| numbers().map(move |z| [x, y, z])));
    // one of two opposite points, the nearest along each line
    let leads = |line: &[f64; 3]| line.iter().find(|x| **x != 0.0).is_some_and(|x| *x > 0.0);
    let is_nearest = |line: &[f64; 3]| line.iter().any(|x| x.abs() == 1.0);
    all.filter(|line| leads(line) && is_nearest(line)).collect()
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
    let parameter = (linear("clearance_um", SIZE), column);
    curve(format!("orientation, loose along {along} of the tool"), follows, None, vec![parameter])
}

/// A tool that friction holds until gravity presses it to the other side by a share of its weight.
fn stuck(context: &Context, share: f64, side: &[f64; 3]) -> Entry {
    let direction = Vector3::from(*side).normalize();
    let mut last = 0.0;
    let sides: Vec<f64> = (context.configurations.iter())
        .map(|there| {
            let down = there.gravity.try_normalize(0.0).unwrap_or_default();
            let pressed = (there.flange.rotation * direction).dot(&down);
            if pressed.abs() > share {
                last = pressed.signum();
            }
            last
        })
        .collect();
    let along = named(side);
    let follows = format!(
        "follows to which side gravity last pressed the tool, along {along} of {{T}}, by more than {share} of its weight"
    );
    let label = format!("orientation, stuck along {along} of the tool, beyond {share} of its weight");
    curve(label, follows, None, vectors(context, "stuck", SIZE, Frame::Tool, &|row| sides[row]))
}

/// `x`, `x + y`, `x − 2z`.
fn named(side: &[f64; 3]) -> String {
    let mut name = String::new();
    for (number, letter) in side.iter().zip(["x", "y", "z"]).filter(|(number, _)| **number != 0.0) {
        match (name.is_empty(), *number > 0.0) {
            (true, true) => {}
            (true, false) => name.push('−'),
            (false, true) => name.push_str(" + "),
            (false, false) => name.push_str(" − "),
        }
        if number.abs() != 1.0 {
            name += &number.abs().to_string();
        }
        name.push_str(letter);
    }
    name
}

/// Shapes that come back with each turn of a joint.
fn bearing(context: &Context, joint: usize) -> Vec<Entry> {
    let waves = |name: &str, size: f64, n: usize, moved: &dyn Fn(&Configuration) -> Vector3<f64>| {
        let angle = move |there: &Configuration| n as f64 * there.joints[joint];
        let wave = |label: &str, function: &dyn Fn(f64) -> f64| -> (Parameter, Column) {
            let column = context.column(|_, there| moved(there) * function(angle(there)));
            (linear(format!("{label}_{n}_{name}"), size), column)
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
        curve(label, follows, Some(angle_of(joint)), parameters)
    };
    let along = |n: usize| waves("along_um", SIZE, n, &|there| there.axis[joint]).into();
    let shifted = (0..2).flat_map(|k| waves(["x_um", "y_um"][k], SIZE, 2, &across(k))).collect();
    let names = ["about_x_urad", "about_y_urad"];
    let tilted = (0..2).flat_map(|k| waves(names[k], TURN, 2, &about(k))).collect();
    vec![
        shape(1, "along", along(1)),
        shape(2, "along", along(2)),
        shape(2, "across", shifted),
        shape(2, "about lines across", tilted),
    ]
}

/// What a joint does one way and not the other over a part of its range; `sign` is 1 or −1, 0 where
/// nobody knows.
pub(super) fn windows(
    context: &Context,
    joint: usize,
    with: &str,
    sign: &dyn Fn(usize) -> f64,
) -> Vec<Entry> {
    let (low, high) = context.range(joint);
    let of_width = |width: f64| {
        // neighbours overlap by half
        let count = ((high - low) / width).floor() as usize;
        let first = 0.5 * (low + high - width * count as f64);
        (0..=count).map(move |k| (first + width * k as f64, width))
    };
    let places: Vec<(f64, f64)> =
        WIDTHS.into_iter().filter(|width| high - low > 2.0 * width).flat_map(of_width).collect();
    let share = 1.0 / places.len().max(1) as f64;
    let around = |(middle, width): (f64, f64)| {
        let column = context.turn(joint, |row, there| {
            let away = (there.joints[joint] - middle).abs() / width;
            if away < 1.0 { sign(row) * 0.5 * (1.0 + (PI * away).cos()) } else { 0.0 }
        });
        let number = joint + 1;
        let (middle, width) = (middle / DEG, width / DEG);
        let label = format!("joint {number}, about {middle:.0}° ± {width:.0}°, with {with}");
        let follows = format!("appears near {middle:.0}° of joint {number}, and changes with {with}");
        let parameters = vec![(linear("reversed_urad", TURN), column)];
        let mut entry = curve(label, follows, Some(angle_of(joint)), parameters);
        entry.candidate.weight = share;
        entry
    };
    places.into_iter().map(around).collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::statistics::Random;

    #[test]
    fn directions_are_said_by_their_axes() {
        let names: Vec<String> =
            [[1.0, 0.0, 0.0], [1.0, 0.0, -2.0], [-1.0, 1.0, 1.0]].iter().map(named).collect();
        assert_eq!(names, ["x", "x − 2z", "−x + y + z"]);
    }

    #[test]
    fn every_line_is_within_18_degrees_of_one_that_is_tried() {
        let lines: Vec<Vector3<f64>> =
            lines().into_iter().map(|line| Vector3::from(line).normalize()).collect();
        assert_eq!(lines.len(), 49);
        let mut random = Random::seeded(1, 1);
        for _ in 0..2000 {
            let any = Vector3::from_fn(|_, _| random.normal()).normalize();
            let nearest = lines.iter().map(|line| line.dot(&any).abs()).fold(0.0, f64::max);
            assert!(nearest > (18.0 * DEG).cos(), "{any}");
        }
    }
}
