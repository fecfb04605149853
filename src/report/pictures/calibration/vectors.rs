//! Residuals over the workspace: arrows in space with their shadows.

use std::collections::BTreeMap;

use serde::Serialize;

use super::super::super::chart::{Chart, Colour, Dash, Figure, Mark, Marker, Point, Style};
use super::super::super::scale::{drawable, extent, one_two_five_below, typeset};
use super::isometric::{IsometricBox, Plane, extents};
use super::round_amount;
use crate::units::{MM, UM, significant};

/// More arrows than these hide each other.
const MOST_ARROWS: usize = 400;
/// Up to so many poses stand on a thread to the floor.
const MOST_THREADS: usize = 80;
/// How far below the box the key to the arrows is, as a part of its size.
const KEY: f64 = 0.12;

/// What is left at one pose, as a vector.
#[derive(Debug, Clone, Copy, Default, PartialEq, Serialize)]
pub struct PoseVector {
    /// The measured position, mm.
    pub at_mm: [f64; 3],
    /// Measured minus calculated position, µm.
    pub residual_um: [f64; 3],
}

/// The residuals as arrows from the measured positions, exaggerated by the factor in the title, in
/// an isometric view of the workspace; their shadows are what is seen from above and from two
/// sides.
pub fn residual_vectors(poses: &[PoseVector]) -> Figure {
    residual_vectors_of(&[("", poses.to_vec())])
}

/// The same for several sets of residuals, each with its name, to one scale.
pub fn residual_vectors_of(sets: &[(&str, Vec<PoseVector>)]) -> Figure {
    let known = |p: &&PoseVector| p.at_mm.iter().chain(&p.residual_um).all(|v| drawable(*v));
    let sets: Vec<(&str, Vec<PoseVector>)> =
        sets.iter().map(|(name, poses)| (*name, poses.iter().filter(known).copied().collect())).collect();
    let count = sets.iter().map(|(_, poses)| poses.len()).max().unwrap_or(0);
    let size = IsometricBox::around(extents(sets.iter().flat_map(|(_, p)| p).map(|p| p.at_mm))).size();
    let mut caption = String::from(
        "Residuals as arrows from the measured positions, exaggerated as the title says, in an isometric view. Grey: \
         their shadows on the floor and on both walls.",
    );
    let cell_mm = (count > MOST_ARROWS).then(|| cell_mm(&sets, size));
    let drawn: Vec<Vec<PoseVector>> = match cell_mm {
        Some(cell_mm) => {
            caption += &format!(
                " Each arrow is the mean over the poses in a cube of {}; there are {} in all.",
                round_amount(cell_mm, cell_mm, "mm"),
                typeset(&count.to_string())
            );
            sets.iter().map(|(_, poses)| means_of_cells(poses, cell_mm)).collect()
        }
        None => sets.iter().map(|(_, poses)| poses.clone()).collect(),
    };
    let usual_mm = cell_mm.map_or(0.2 * size, |cell_mm| 0.7 * cell_mm);
    let factor = exaggeration(drawn.iter().flatten(), usual_mm, 0.5 * size);
    let tip = |p: &PoseVector| [0, 1, 2].map(|i| p.at_mm[i] + factor * p.residual_um[i] * UM / MM);
    let ends: Vec<[f64; 3]> = drawn.iter().flatten().flat_map(|p| [p.at_mm, tip(p)]).collect();
    let room = IsometricBox::around(extents(ends.iter().copied()));
    let panel = |((name, _), drawn): (&(&str, Vec<PoseVector>), &Vec<PoseVector>)| {
        let name = if name.is_empty() { String::new() } else { format!("{name}, ") };
        let mut chart = room.chart(format!("{name}residuals ×\u{a0}{}", typeset(&significant(factor, 1))));
        shadows(&mut chart, &room, drawn, tip);
        for p in drawn {
            let (from, to) = (room.seen(p.at_mm), room.seen(tip(p)));
            chart.marks.push(arrow(from, to, String::new()));
        }
        chart.marks.push(Mark::Points {
            label: "measured position".into(),
            points: drawn.iter().map(|p| point(room.seen(p.at_mm))).collect(),
            style: Style::nth(0).size(1.5),
        });
        chart.marks.extend(key(&room, drawn, factor));
        chart
    };
    Figure {
        name: "residual-vectors".into(),
        caption,
        panels: sets.iter().zip(&drawn).map(panel).collect(),
        columns: sets.len().clamp(1, 2),
        shared_legend: true,
        ..Figure::default()
    }
}

/// Grey lines on floor and walls, and threads from the poses to the floor where they are few.
fn shadows(
    chart: &mut Chart,
    room: &IsometricBox,
    poses: &[PoseVector],
    tip: impl Fn(&PoseVector) -> [f64; 3],
) {
    let grey = Style::nth(0).colour(Colour::Grey).dash(Dash::Solid);
    let mut line = |label: &str, points: Vec<[f64; 2]>, style: Style| {
        chart.marks.push(Mark::Line { label: label.into(), points, style });
    };
    for p in poses {
        for plane in Plane::ALL {
            let points = vec![room.shadow(plane, p.at_mm), room.shadow(plane, tip(p))];
            line("shadow", points, grey.width(1.1));
        }
        if poses.len() <= MOST_THREADS {
            line("", vec![room.seen(p.at_mm), room.shadow(Plane::Floor, p.at_mm)], grey.width(0.3));
        }
    }
    let at = |plane: Plane| poses.iter().map(move |p| point(room.shadow(plane, p.at_mm)));
    chart.marks.push(Mark::Points {
        label: String::new(),
        points: Plane::ALL.into_iter().flat_map(at).collect(),
        style: grey.marker(Marker::Dot).size(1.3),
    });
}

fn point([x, y]: [f64; 2]) -> Point {
    Point { x, y, error: 0.0 }
}

fn arrow(from: [f64; 2], to: [f64; 2], text: String) -> Mark {
    Mark::Arrow { from, to, text, style: Style::nth(1).width(1.3) }
}

/// An arrow of a round length with its value, below the box.
fn key(room: &IsometricBox, poses: &[PoseVector], factor: f64) -> Option<Mark> {
    let components = poses.iter().flat_map(|p| p.residual_um).map(f64::abs);
    let (_, largest_um) = extent(components).filter(|(_, high)| *high > 0.0)?;
    let length_um = one_two_five_below(largest_um.min(0.3 * room.size() * MM / (factor * UM)));
    let [left, bottom] = room.key_place();
    let from = [left, bottom - KEY * room.size()];
    let to = [from[0] + factor * length_um * UM / MM, from[1]];
    Some(arrow(from, to, round_amount(length_um, length_um, "µm")))
}

/// The 1-2-5 factor with which nine of ten residuals become at most `usual_mm` long, and the
/// longest at most `longest_mm`.
fn exaggeration<'a>(poses: impl Iterator<Item = &'a PoseVector>, usual_mm: f64, longest_mm: f64) -> f64 {
    let length_um = |p: &PoseVector| p.residual_um.iter().fold(0.0, |sum, r| f64::hypot(sum, *r));
    let mut lengths: Vec<f64> = poses.map(length_um).filter(|l| *l > 0.0).collect();
    lengths.sort_by(f64::total_cmp);
    let Some(longest) = lengths.last() else { return 1.0 };
    let usual = lengths[(9 * lengths.len() / 10).min(lengths.len() - 1)];
    one_two_five_below((usual_mm / usual).min(longest_mm / longest) * MM / UM)
}

/// The edge of cubes so large that each set has poses in at most [`MOST_ARROWS`] of them, mm.
fn cell_mm(sets: &[(&str, Vec<PoseVector>)], size_mm: f64) -> f64 {
    let fits = |cell_mm: &f64| sets.iter().all(|(_, poses)| cells(poses, *cell_mm).len() <= MOST_ARROWS);
    let edges = [0.05, 0.1, 0.2, 0.4].map(|part| one_two_five_below(part * size_mm));
    edges.into_iter().find(fits).unwrap_or(size_mm)
}

fn cells(poses: &[PoseVector], cell_mm: f64) -> BTreeMap<[i64; 3], Vec<&PoseVector>> {
    let mut cells: BTreeMap<[i64; 3], Vec<&PoseVector>> = BTreeMap::new();
    for pose in poses {
        cells.entry(pose.at_mm.map(|x| (x / cell_mm).floor() as i64)).or_default().push(pose);
    }
    cells
}

fn means_of_cells(poses: &[PoseVector], cell_mm: f64) -> Vec<PoseVector> {
    let mean = |poses: &Vec<&PoseVector>| {
        let mean_of = |part: fn(&PoseVector) -> [f64; 3]| {
            [0, 1, 2].map(|i| poses.iter().map(|p| part(p)[i] / poses.len() as f64).sum())
        };
        PoseVector { at_mm: mean_of(|p| p.at_mm), residual_um: mean_of(|p| p.residual_um) }
    };
    cells(poses, cell_mm).values().map(mean).collect()
}

#[cfg(test)]
mod tests {
    use super::super::workspace::tests::places;
    use super::*;

    fn vectors(count: usize) -> Vec<PoseVector> {
        places(count).into_iter().map(|at_mm| PoseVector { at_mm, residual_um: [30.0, -40.0, 0.0] }).collect()
    }

    fn arrows(chart: &Chart) -> Vec<([f64; 2], [f64; 2])> {
        let arrow = |mark: &Mark| match mark {
            Mark::Arrow { from, to, .. } => Some((*from, *to)),
            _ => None,
        };
        chart.marks.iter().filter_map(arrow).collect()
    }

    #[test]
    fn arrows_start_at_the_measured_positions_and_have_a_key_and_three_shadows() {
        let poses = vectors(30);
        let figure = residual_vectors(&poses);
        let chart = &figure.panels[0];
        assert_eq!(chart.title, "residuals ×\u{a0}2000");
        let arrows = arrows(chart);
        assert_eq!(arrows.len(), 31);
        // 30 and −40 µm, 2000 times: 60 and −80 mm along x and y
        let (from, to) = arrows[0];
        approx::assert_relative_eq!(to[0] - from[0], 0.75f64.sqrt() * (60.0 - 80.0), max_relative = 1e-9);
        approx::assert_relative_eq!(to[1] - from[1], 0.5 * (-80.0 - 60.0), max_relative = 1e-9);
        let is_shadow = |mark: &&Mark| matches!(mark, Mark::Line { label, .. } if label == "shadow");
        assert_eq!(chart.marks.iter().filter(is_shadow).count(), 90);
        let svg = figure.svg();
        for text in ["20\u{a0}µm", "x / mm", "y / mm", "z / mm"] {
            assert!(svg.contains(text), "{text}\n{svg}");
        }
    }

    #[test]
    fn many_poses_are_gathered_and_the_caption_says_so() {
        let figure = residual_vectors(&vectors(20_000));
        let count = arrows(&figure.panels[0]).len();
        assert!((50..=MOST_ARROWS + 1).contains(&count), "{count}");
        assert!(figure.caption.contains("mean over the poses in a cube of"), "{}", figure.caption);
    }

    #[test]
    fn degenerate_workspaces_draw() {
        let odd = [0.0, 7.0, f64::NAN, f64::INFINITY, 1e190, -1e190, 1e-190];
        for a in odd {
            for b in odd {
                for count in [1, 2, 500] {
                    let at = |i: usize| [if i == 0 { a } else { b }, b, 0.0];
                    let poses: Vec<_> =
                        (0..count).map(|i| PoseVector { at_mm: at(i), residual_um: [a, b, 0.0] }).collect();
                    assert!(!residual_vectors(&poses).svg().contains("NaN"), "{a} {b} {count}");
                }
            }
        }
        residual_vectors(&[]).svg();
    }
}
