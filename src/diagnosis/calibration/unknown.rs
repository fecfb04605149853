//! Rivals for physics that nobody has named: smooth displacements of the tip along whatever a row may depend on.
//!
//! ```text
//! along one number     Σ_k a_k·cos(π k x)        a_k a vector in {W} or in {T}, x from 0 to 1, a_k ~ s/(1 + k)
//! over the workspace   products of such cosines along x, y, z of {W}
//! of two joints        both turn by Σ a_kl·cos(π k x)·cos(π l y): what neither does as a function of its own angle
//! of each clamp        a vector in {W}
//! ```
//!
//! for every shape is more likely to be smooth than not.

use std::f64::consts::PI;

use nalgebra::Vector3;

use super::scene::{Column, Entry, Scene, entry, linear};
use crate::diagnosis::EffectParameter;
use crate::units::UM;

/// Size of a displacement, m: what calibrated arms of 1 m reach miss by.
const SIZE: f64 = 100.0 * UM;
/// Size of a turn, rad: as large at 1 m.
const TURN: f64 = 100e-6;
const URAD: f64 = 1e-6;
/// Cosines along one number, beside the constant.
const MOST: usize = 6;
/// Highest order of a product of cosines over the workspace, and along each of two joints.
const ORDER: (usize, usize) = (3, 3);
const AXES: [&str; 3] = ["x", "y", "z"];

/// All of them for this recording.
pub(super) fn all(scene: &Scene) -> Vec<Entry> {
    let mut entries = Vec::new();
    let rows = &scene.recording.rows;
    let known = |of: &dyn Fn(usize) -> Option<f64>| (0..rows.len()).map(of).collect::<Option<Vec<f64>>>();
    let clocks = [
        ("order", known(&|row| Some(row as f64))),
        ("time", known(&|row| rows[row].time)),
        ("temperature", known(&|row| rows[row].temperature)),
    ];
    for (name, values) in clocks {
        entries.extend(values.and_then(|values| along(scene, name, &values, false)));
    }
    for j in 0..scene.joint_count() {
        let values: Vec<f64> = scene.postures.iter().map(|posture| posture.joints[j]).collect();
        let name = format!("joint {}", j + 1);
        entries.extend(along(scene, &name, &values, false));
        entries.extend(along(scene, &name, &values, true));
    }
    entries.extend(workspace(scene));
    entries.extend(pairs(scene));
    entries.extend(clamps(scene));
    for entry in &mut entries {
        entry.candidate.is_unknown = true;
    }
    entries
}

/// From 0 to 1; `None` where the values do not differ.
fn scaled(values: &[f64]) -> Option<Vec<f64>> {
    let (low, high) =
        values.iter().fold((f64::INFINITY, f64::NEG_INFINITY), |(a, b), &v| (a.min(v), b.max(v)));
    (high > low).then(|| values.iter().map(|v| (v - low) / (high - low)).collect())
}

fn cosine(k: usize, x: f64) -> f64 {
    (PI * k as f64 * x).cos()
}

/// A vector in {W} or in {T} times a weight for each row.
fn vectors(
    scene: &Scene,
    name: &str,
    size: f64,
    in_tool: bool,
    weight: &dyn Fn(usize) -> f64,
) -> Vec<(EffectParameter, Column)> {
    let along = |(axis, letter): (usize, &&str)| {
        let column = scene.column(|row, posture| {
            let unit = match in_tool {
                true => posture.flange.rotation.column(axis).into(),
                false => Vector3::ith(axis, 1.0),
            };
            unit * weight(row)
        });
        (linear(format!("{letter}_{name}_um"), UM, size), column)
    };
    AXES.iter().enumerate().map(along).collect()
}

fn along(scene: &Scene, name: &str, values: &[f64], in_tool: bool) -> Option<Entry> {
    let x = scaled(values)?;
    let parameters = (1..=MOST).flat_map(|k| {
        let size = SIZE / (1 + k) as f64;
        vectors(scene, &format!("cosine_{k}"), size, in_tool, &|row| cosine(k, x[row]))
    });
    let frame = if in_tool { "the tool" } else { "the world" };
    Some(entry("unknown", format!("{name}, a curve in {frame}"), parameters.collect()))
}

fn workspace(scene: &Scene) -> Option<Entry> {
    let of_axis =
        |axis: usize| scaled(&scene.postures.iter().map(|posture| posture.tip[axis]).collect::<Vec<_>>());
    let x = [of_axis(0)?, of_axis(1)?, of_axis(2)?];
    let orders = (0..=ORDER.0).flat_map(|i| (0..=ORDER.0 - i).map(move |j| (i, j)));
    let products = orders.flat_map(|(i, j)| (0..=ORDER.0 - i - j).map(move |k| [i, j, k]));
    let parameters = products.skip(1).flat_map(|[i, j, k]| {
        let size = SIZE / (1 + i + j + k) as f64;
        vectors(scene, &format!("cosines_{i}{j}{k}"), size, false, &|row| {
            cosine(i, x[0][row]) * cosine(j, x[1][row]) * cosine(k, x[2][row])
        })
    });
    Some(entry("unknown", "over the workspace", parameters.collect()))
}

/// Both joints of a pair, turned by what depends on both angles.
fn pairs(scene: &Scene) -> Vec<Entry> {
    let joints = scene.revolute();
    let x: Vec<Option<Vec<f64>>> = (0..scene.joint_count())
        .map(|j| scaled(&scene.postures.iter().map(|posture| posture.joints[j]).collect::<Vec<_>>()))
        .collect();
    let mut entries = Vec::new();
    for (at, &i) in joints.iter().enumerate() {
        for &j in &joints[at + 1..] {
            let (Some(x), Some(y)) = (&x[i], &x[j]) else { continue };
            let parameters = [i, j].into_iter().flat_map(|turned| {
                let orders = (0..=ORDER.1).flat_map(|k| (0..=ORDER.1).map(move |l| (k, l))).skip(1);
                orders.map(move |(k, l)| {
                    let column = scene.column(|row, posture| {
                        posture.lever[turned] * (cosine(k, x[row]) * cosine(l, y[row]))
                    });
                    let name = format!("joint_{}_cosines_{k}{l}_urad", turned + 1);
                    (linear(name, URAD, TURN / (1 + k + l) as f64), column)
                })
            });
            let location = format!("joint {} and joint {}, a surface", i + 1, j + 1);
            entries.push(entry("unknown", location, parameters.collect()));
        }
    }
    entries
}

fn clamps(scene: &Scene) -> Option<Entry> {
    let groups = &scene.recording.groups;
    (groups.len() > 1 && !scene.has_sockets()).then_some(())?;
    let parameters = (0..groups.len()).flat_map(|k| {
        let is_there = |row: usize| if scene.recording.rows[row].group == k { 1.0 } else { 0.0 };
        vectors(scene, &format!("group_{k}"), SIZE, false, &is_there)
    });
    Some(entry("unknown", "each clamp by itself", parameters.collect()))
}
