//! Rivals for physics that nobody has named: smooth displacements of the tip along whatever a row
//! may depend on.
//!
//! ```text
//! along one number      Σ_k a_k·cos(π k x)        a_k a vector in {W} or in {T}, x from 0 to 1,
//!                       a_k ~ s/(1 + k)
//! over the workspace    products of such cosines along x, y, z of {W}
//! by its orientation    first and second order in the direction that an axis of {W} has in {T}, a
//!                       vector in {T}; the same in the direction in {T} of a line that is fixed in
//!                       the clamp, along that line, scanned; first and second order in the whole
//!                       orientation of {T} to the clamp, a vector in the clamp's frame
//! of a joint's reversal it turns by Σ a_k·cos(π k x) one way, by as much the other way when it
//!                       came from there, or is loaded the other way; or by as much as it is
//!                       loaded, k > 0: a drive that gives way more at some angles than at others
//! of two joints         both turn by Σ a_kl·cos(π k x)·cos(π l y): what neither does as a function
//!                       of its own angle; or any other joint does
//! of a link             all beyond a joint turns about any axis of its link by products of two
//!                       joints' angles
//! of each clamp         a vector in {W}, or in {T}
//! of a clamp's sensors  `device.rs`
//! of a loaded drive      `loaded.rs`
//! of a loose tool, of a bearing that runs out   `loose.rs`
//! of order, time or temperature: a base that turns, a joint's zero   `clocks.rs`
//! of a torque or a scale, times a clock         `changing.rs`
//! of the last moves     `moves.rs`
//! of much finer detail  `waves.rs`
//! ```
//!
//! for every shape is more likely to be smooth than not.

mod changing;
mod clocks;
mod curve;
mod device;
mod loaded;
mod loose;
mod moves;
mod waves;

use nalgebra::{Matrix3, Vector3};

pub(super) use self::curve::SIDES;
use self::curve::{AXES, LEAST_TORQUE, SIZE, TURN, along, angle_of, cosine, curve, scaled, vectors};
use super::model::Context;
use super::model::entry::{Entry, linear};
use super::model::law::Frame;

/// The same where a joint turns back: a tooth is worn over a part of a turn.
const MOST_OF_REVERSAL: usize = 12;
/// Highest order of a product of cosines over the workspace, along each of two joints, and in a
/// link.
const ORDER: (usize, usize, usize) = (3, 3, 1);
/// What is said of what depends on the orientation.
const BY_ORIENTATION: &str = "follows how the tool is held";

/// All of them for this recording.
pub(super) fn all(context: &Context) -> Vec<Entry> {
    let mut entries = clocks::all(context);
    for j in 0..context.joint_count() {
        let values: Vec<f64> = context.configurations.iter().map(|there| there.joints[j]).collect();
        let label = format!("joint {}", j + 1);
        let angle = format!("the angle of {label}");
        for frame in [Frame::World, Frame::Tool] {
            entries.extend(along(context, angle_of(j), &label, &angle, &values, frame));
        }
    }
    entries.extend(waves::all(context));
    entries.extend(workspace(context));
    entries.extend((0..3).map(|axis| by_orientation(context, axis)));
    entries.extend(SIDES.iter().map(|side| from_a_side(context, side)));
    entries.push(by_whole_orientation(context));
    for j in context.revolute() {
        let came_from = |row: usize| context.configurations[row].approach[j];
        entries.extend(reversal(context, j, Way::Approach, &came_from));
        entries.extend(loose::windows(context, j, "its direction of approach", &came_from));
        let is_known = context.has_masses && context.largest(|there| there.torque[j]) > LEAST_TORQUE;
        let loaded = |row: usize| context.configurations[row].torque[j].signum();
        if is_known {
            entries.extend(reversal(context, j, Way::Load, &loaded));
            let most = context.largest(|there| there.torque[j]);
            let share = |row: usize| context.configurations[row].torque[j] / most;
            entries.extend(reversal(context, j, Way::Torque, &share));
            entries.extend(loose::windows(context, j, "the sign of its torque", &loaded));
        }
    }
    entries.extend(pairs(context));
    entries.extend(links(context));
    entries.extend(clamps(context));
    entries.extend(device::all(context));
    entries.extend(loaded::all(context));
    entries.extend(loose::all(context));
    entries.extend(changing::all(context));
    entries.extend(moves::all(context));
    entries
}

/// What depends on where the ball is. A socket's place is free, and takes all of that; where the
/// ball is beside it is the scatter itself, which follows itself.
fn workspace(context: &Context) -> Option<Entry> {
    if context.has_sockets() {
        return None;
    }
    let of_axis = |axis: usize| {
        scaled(
            &context.configurations.iter().map(|configuration| configuration.tip[axis]).collect::<Vec<_>>(),
        )
    };
    let x = [of_axis(0)?, of_axis(1)?, of_axis(2)?];
    let orders = (0..=ORDER.0).flat_map(|i| (0..=ORDER.0 - i).map(move |j| (i, j)));
    let products = orders.flat_map(|(i, j)| (0..=ORDER.0 - i - j).map(move |k| [i, j, k]));
    let parameters = products.skip(1).flat_map(|[i, j, k]| {
        let size = SIZE / (1 + i + j + k) as f64;
        vectors(context, &format!("cosines_{i}{j}{k}"), size, Frame::World, &|row| {
            cosine(i, x[0][row]) * cosine(j, x[1][row]) * cosine(k, x[2][row])
        })
    });
    let follows = "follows the place in the workspace";
    Some(curve("over the workspace", follows, None, parameters.collect()))
}

/// Products of first and second order of a direction's three numbers, with their sizes; of the
/// squares, which add up to one, two.
fn orders() -> impl Iterator<Item = (Vec<usize>, f64)> {
    let second = [[0, 0], [1, 1], [0, 1], [0, 2], [1, 2]].map(|pair| (pair.to_vec(), SIZE / 3.0));
    (0..3).map(|k| (vec![k], SIZE / 2.0)).chain(second)
}

fn name_of(factors: &[usize]) -> String {
    factors.iter().map(|&k| AXES[k]).collect()
}

/// What depends on how the tool is held.
fn by_orientation(context: &Context, axis: usize) -> Entry {
    let direction = |row: usize, k: usize| context.configurations[row].flange.rotation[(axis, k)];
    let parameters = orders().flat_map(|(factors, size)| {
        let weight = |row: usize| factors.iter().map(|&k| direction(row, k)).product::<f64>();
        vectors(context, &name_of(&factors), size, Frame::Tool, &weight)
    });
    let label = format!("orientation, the world's {} in the tool", AXES[axis]);
    curve(label, BY_ORIENTATION, None, parameters.collect())
}

/// A ball that is not round and is touched from one side, a prism that is read from there.
fn from_a_side(context: &Context, side: &[f64; 3]) -> Entry {
    let side = Vector3::from(*side).normalize();
    let groups = &context.recording.groups;
    let line = |row: usize| groups[context.recording.rows[row].group].device.rotation * side;
    let parameters = orders().map(|(factors, size)| {
        let column = context.column(|row, configuration| {
            let held = configuration.flange.rotation.tr_mul(&line(row));
            line(row) * factors.iter().map(|&k| held[k]).product::<f64>()
        });
        (linear(format!("{}_um", name_of(&factors)), size), column)
    });
    let [x, y, z] = side.into();
    let label = format!("orientation, from the side ({x:.1} {y:.1} {z:.1})");
    curve(label, BY_ORIENTATION, None, parameters.collect())
}

/// The same where the fixture sees it: with Q = R_Tᵀ·R_clamp its nine numbers, and tr(E_m·Q·E_n·Qᵀ)
/// with the five symmetric matrices E without a trace, which are all functions of first and second
/// order of a rotation.
fn by_whole_orientation(context: &Context) -> Entry {
    let half = 0.5f64.sqrt();
    let traceless = [
        Matrix3::new(0.0, half, 0.0, half, 0.0, 0.0, 0.0, 0.0, 0.0),
        Matrix3::new(0.0, 0.0, half, 0.0, 0.0, 0.0, half, 0.0, 0.0),
        Matrix3::new(0.0, 0.0, 0.0, 0.0, 0.0, half, 0.0, half, 0.0),
        Matrix3::from_diagonal(&Vector3::new(half, -half, 0.0)),
        Matrix3::from_diagonal(&Vector3::new(1.0, 1.0, -2.0)) / 6.0f64.sqrt(),
    ];
    let groups = &context.recording.groups;
    let device = |row: usize| &groups[context.recording.rows[row].group].device.rotation;
    let held: Vec<Matrix3<f64>> = context
        .configurations
        .iter()
        .enumerate()
        .map(|(row, p)| p.flange.rotation.tr_mul(device(row)))
        .collect();
    let mut parameters = Vec::new();
    let mut add = |name: String, size: f64, weight: &dyn Fn(&Matrix3<f64>) -> f64| {
        for (axis, letter) in AXES.iter().enumerate() {
            let column = context.column(|row, _| device(row).column(axis) * weight(&held[row]));
            parameters.push((linear(format!("{letter}_{name}_um"), size), column));
        }
    };
    for (i, j) in (0..9).map(|k| (k / 3, k % 3)) {
        add(format!("{}{}", AXES[i], AXES[j]), SIZE / 2.0, &|q| q[(i, j)]);
    }
    for (m, n) in (0..25).map(|k| (k / 5, k % 5)) {
        add(format!("second_{m}{n}"), SIZE / 3.0, &|q| {
            (traceless[m] * q * traceless[n] * q.transpose()).trace()
        });
    }
    curve("orientation, as the fixture sees it", BY_ORIENTATION, None, parameters)
}

/// What tells one way of a joint from the other.
#[derive(Clone, Copy)]
enum Way {
    Approach,
    Load,
    /// The more the larger its load; what is the same at all angles is its compliance.
    Torque,
}

/// What a joint does one way and not the other, by its angle: `sign` is 1 or −1, 0 where nobody
/// knows, or how far it is loaded.
fn reversal(context: &Context, j: usize, way: Way, sign: &dyn Fn(usize) -> f64) -> Option<Entry> {
    let x = angles(context, j)?;
    let first = match way {
        Way::Approach | Way::Load => 0,
        Way::Torque => 1,
    };
    let parameters = (first..=MOST_OF_REVERSAL).map(|k| {
        let column = context.turn(j, |row, _| sign(row) * cosine(k, x[row]));
        let name = format!("reversed_cosine_{k}_urad");
        (linear(name, TURN / (1 + k) as f64), column)
    });
    let joint = format!("joint {}", j + 1);
    let (form, how) = match way {
        Way::Approach => {
            ("a curve for each direction of approach", "another curve for each direction of approach")
        }
        Way::Load => ("a curve for each sign of the torque", "another curve for each sign of its torque"),
        Way::Torque => ("a curve times its torque", "the more the larger its torque"),
    };
    let follows = format!("follows the angle of {joint}, {how}");
    let label = format!("{joint}, {form}");
    Some(curve(label, follows, Some(angle_of(j)), parameters.collect()))
}

/// Angles of a joint from 0 to 1, by row.
fn angles(context: &Context, joint: usize) -> Option<Vec<f64>> {
    let angles = context.configurations.iter().map(|there| there.joints[joint]);
    scaled(&angles.collect::<Vec<_>>())
}

/// All beyond joint i turns about the axes that it moves along, by what depends on the angles of
/// two joints.
fn links(context: &Context) -> Vec<Entry> {
    let joints = context.revolute();
    let x: Vec<Option<Vec<f64>>> = (0..context.joint_count()).map(|j| angles(context, j)).collect();
    let mut entries = Vec::new();
    for &link in &joints {
        for (at, &i) in joints.iter().enumerate() {
            for &j in &joints[at + 1..] {
                let (Some(x), Some(y)) = (&x[i], &x[j]) else { continue };
                let orders = (0..=ORDER.2).flat_map(|k| (0..=ORDER.2).map(move |l| (k, l))).skip(1);
                let parameters = orders.flat_map(|(k, l)| {
                    (0..3).map(move |axis| {
                        let pattern = &context.patterns.link[link][axis];
                        let column = context.along(pattern, |row, _| cosine(k, x[row]) * cosine(l, y[row]));
                        let name = format!("about_{}_cosines_{k}{l}_urad", AXES[axis]);
                        (linear(name, TURN / (1 + k + l) as f64), column)
                    })
                });
                let link = format!("link {}", link + 1);
                let joints = format!("joint {} and joint {}", i + 1, j + 1);
                let label = format!("{link}, turned by {joints}");
                let follows = format!("bends {link} with {joints}");
                entries.push(curve(label, follows, None, parameters.collect()));
            }
        }
    }
    entries
}

/// Both joints of a pair, or any other one, turned by what depends on both angles.
fn pairs(context: &Context) -> Vec<Entry> {
    let joints = context.revolute();
    let x: Vec<Option<Vec<f64>>> = (0..context.joint_count()).map(|j| angles(context, j)).collect();
    let mut entries = Vec::new();
    for (at, &i) in joints.iter().enumerate() {
        for &j in &joints[at + 1..] {
            let (Some(x), Some(y)) = (&x[i], &x[j]) else { continue };
            let turned = |turned: usize| {
                let orders = (0..=ORDER.1).flat_map(|k| (0..=ORDER.1).map(move |l| (k, l))).skip(1);
                orders.map(move |(k, l)| {
                    let column = context.turn(turned, |row, _| cosine(k, x[row]) * cosine(l, y[row]));
                    let name = format!("joint_{}_cosines_{k}{l}_urad", turned + 1);
                    (linear(name, TURN / (1 + k + l) as f64), column)
                })
            };
            let names = format!("joint {} and joint {}", i + 1, j + 1);
            let (label, follows) = (format!("{names}, a surface"), format!("depends on {names} together"));
            entries.push(curve(label, follows, None, turned(i).chain(turned(j)).collect()));
            for &other in joints.iter().filter(|&&other| other != i && other != j) {
                let label = format!("joint {}, turned by {names}", other + 1);
                let follows = format!("turns joint {} with {names}", other + 1);
                entries.push(curve(label, follows, None, turned(other).collect()));
            }
        }
    }
    entries
}

/// In fixed directions (of sockets nobody knows the places), and in such that turn with the tool:
/// what an arm does otherwise in another region, where each clamp or placement is one, looks like a
/// tool that slipped between them.
fn clamps(context: &Context) -> Vec<Entry> {
    let groups = &context.recording.groups;
    if groups.len() < 2 {
        return Vec::new();
    }
    let by_itself = |frame: Frame, label: &str, follows: &str| {
        let parameters = (0..groups.len()).flat_map(|k| {
            let is_there = |row: usize| if context.recording.rows[row].group == k { 1.0 } else { 0.0 };
            vectors(context, &format!("group_{k}"), SIZE, frame, &is_there)
        });
        curve(label, follows, None, parameters.collect())
    };
    let in_world = (Frame::World, "each clamp by itself", "shifts whole clamps against one another");
    let in_tool = (
        Frame::Tool,
        "each clamp by itself, in the tool",
        "differs from clamp to clamp in directions that turn with the tool",
    );
    let both = [(!context.has_sockets()).then_some(in_world), Some(in_tool)];
    both.into_iter().flatten().map(|(frame, label, follows)| by_itself(frame, label, follows)).collect()
}
