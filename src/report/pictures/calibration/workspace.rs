//! Where in the workspace the errors are, and where to they point: seen from above and from the
//! side.

use std::collections::BTreeMap;

use serde::Serialize;

use super::super::super::chart::{Chart, Colour, Dash, Figure, Mark, Marker, Point, Range, Style};
use super::super::super::scale::{drawable, extent, one_two_five_below, typeset};
use super::{MOST_POINTS, round_amount};
use crate::units::{MM, UM, significant};

/// More arrows than these hide each other.
const MOST_ARROWS: usize = 400;
/// How far below the poses the key to the arrows is, as a part of their extent.
const KEY: f64 = 0.06;
/// A view: name, label of the vertical axis and which coordinate it is.
type View = (&'static str, &'static str, usize);
/// From above and from the side.
const VIEWS: [View; 2] = [("from above", "y / mm", 1), ("from the side", "z / mm", 2)];

/// The positioning error at one pose.
#[derive(Debug, Clone, Copy, Default, PartialEq, Serialize)]
pub struct PoseError {
    /// Where, mm.
    pub at_mm: [f64; 3],
    /// Length of the error, mm.
    pub error_mm: f64,
}

/// The poses in x–y and in x–z, as discs whose diameter is in proportion to the error, in steps
/// that the legend shows.
pub fn error_over_workspace(poses: &[PoseError]) -> Figure {
    let known =
        |p: &&PoseError| p.at_mm.iter().chain([&p.error_mm]).all(|v| drawable(*v)) && p.error_mm >= 0.0;
    let poses: Vec<PoseError> = poses.iter().filter(known).copied().collect();
    let room = Room::around(poses.iter().map(|p| p.at_mm));
    let cell_mm = one_two_five_below(room.size_mm() / 16.0);
    let mut caption =
        String::from("The poses in the workspace; the larger a disc, the larger the error there.");
    if poses.len() > MOST_POINTS {
        caption += &format!(
            " Of {} poses the one with the largest error in each square of {} is drawn.",
            typeset(&poses.len().to_string()),
            round_amount(cell_mm, cell_mm, "mm")
        );
    }
    let classes = Classes::new(&poses);
    let panel = |(view, label, axis): (&str, &str, usize)| {
        let mut chart = room.chart(format!("error, {view}"), label, axis, 0.0);
        // First for the legend, from small to large; then to be drawn, the small on top of the
        // large.
        for class in 0..classes.number {
            chart.marks.push(classes.mark(class, Vec::new()));
        }
        let drawn =
            if poses.len() > MOST_POINTS { worst_of_cells(&poses, cell_mm, axis) } else { poses.clone() };
        for class in (0..classes.number).rev() {
            let within = drawn.iter().filter(|p| classes.class(p.error_mm) == class);
            let points = within.map(|p| Point { x: p.at_mm[0], y: p.at_mm[axis], error: 0.0 }).collect();
            chart.marks.push(classes.mark(class, points));
        }
        chart
    };
    room.figure("error-over-workspace", caption, VIEWS.map(panel).into())
}

/// What is left at one pose, as a vector.
#[derive(Debug, Clone, Copy, Default, PartialEq, Serialize)]
pub struct PoseVector {
    /// The measured position, mm.
    pub at_mm: [f64; 3],
    /// Measured minus calculated position, µm.
    pub residual_um: [f64; 3],
}

/// The residuals in x–y and in x–z as arrows from the measured positions, exaggerated by the factor
/// in the titles.
pub fn residual_vectors(poses: &[PoseVector]) -> Figure {
    residual_vectors_of(&[("", poses.to_vec())])
}

/// The same for several sets of residuals, each with its name, to one scale.
pub fn residual_vectors_of(sets: &[(&str, Vec<PoseVector>)]) -> Figure {
    let known = |p: &&PoseVector| p.at_mm.iter().chain(&p.residual_um).all(|v| drawable(*v));
    let sets: Vec<(&str, Vec<PoseVector>)> =
        sets.iter().map(|(name, poses)| (*name, poses.iter().filter(known).copied().collect())).collect();
    let count = sets.iter().map(|(_, poses)| poses.len()).max().unwrap_or(0);
    let positions = Room::around(sets.iter().flat_map(|(_, poses)| poses).map(|p| p.at_mm));
    let mut caption =
        String::from("Residuals as arrows from the measured positions, exaggerated as the titles say.");
    let cell_mm = one_two_five_below(positions.size_mm() / 10.0);
    let many = count > MOST_ARROWS;
    if many {
        caption += &format!(
            " Each arrow is the mean over the poses in a square of {}; there are {} in all.",
            round_amount(cell_mm, cell_mm, "mm"),
            typeset(&count.to_string())
        );
    }
    let drawn: Vec<Vec<PoseVector>> = sets
        .iter()
        .flat_map(|(_, poses)| {
            VIEWS.map(|(_, _, axis)| if many { means_of_cells(poses, cell_mm, axis) } else { poses.clone() })
        })
        .collect();
    let usual_mm = if many { 1.5 * cell_mm } else { 0.2 * positions.size_mm() };
    let factor = exaggeration(drawn.iter().flatten(), usual_mm, 0.5 * positions.size_mm());
    let tip = |p: &PoseVector| [0, 1, 2].map(|i| p.at_mm[i] + factor * p.residual_um[i] * UM / MM);
    let ends = drawn.iter().flatten().flat_map(|p| [p.at_mm, tip(p)]);
    let room = Room::around(ends.chain([positions.low, positions.high]));
    let views = sets.iter().flat_map(|(name, _)| VIEWS.map(|view| (*name, view)));
    let panel = |((name, (view, label, axis)), drawn): ((&str, View), &Vec<PoseVector>)| {
        let name = if name.is_empty() { String::new() } else { format!("{name}, ") };
        let title = format!("{name}{view}, residuals ×\u{a0}{}", typeset(&significant(factor, 1)));
        let mut chart = room.chart(title, label, axis, KEY);
        for p in drawn {
            let (from, to) = (p.at_mm, tip(p));
            chart.marks.push(arrow([from[0], from[axis]], [to[0], to[axis]], String::new()));
        }
        chart.marks.push(Mark::Points {
            label: "measured position".into(),
            points: drawn.iter().map(|p| Point { x: p.at_mm[0], y: p.at_mm[axis], error: 0.0 }).collect(),
            style: Style::nth(0).size(1.3),
        });
        chart.marks.extend(room.key(drawn, factor, axis));
        chart
    };
    room.figure("residual-vectors", caption, views.zip(&drawn).map(panel).collect())
}

fn arrow(from: [f64; 2], to: [f64; 2], text: String) -> Mark {
    let style = Style::nth(1).width(1.3);
    Mark::Arrow { from, to, text, style }
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

/// What both views span.
struct Room {
    low: [f64; 3],
    high: [f64; 3],
}

impl Room {
    fn around(points: impl Iterator<Item = [f64; 3]> + Clone) -> Self {
        let extents = [0, 1, 2].map(|i| extent(points.clone().map(|p| p[i])).unwrap_or((0.0, 0.0)));
        let room = Room { low: extents.map(|e| e.0), high: extents.map(|e| e.1) };
        // Around a single pose something to draw in.
        if room.size_mm() > 0.0 {
            return room;
        }
        Room { low: room.low.map(|v| v - 50.0), high: room.high.map(|v| v + 50.0) }
    }

    /// The largest of the extents, mm.
    fn size_mm(&self) -> f64 {
        [0, 1, 2].map(|i| self.high[i] - self.low[i]).into_iter().fold(0.0, f64::max)
    }

    /// Both views: side by side, or one below the other where the workspace is long.
    fn figure(&self, name: &str, caption: String, panels: Vec<Chart>) -> Figure {
        let size = [0, 1, 2].map(|i| self.high[i] - self.low[i]);
        let columns = if size[0] > 1.5 * size[1].max(size[2]) { 1 } else { 2 };
        Figure { name: name.into(), caption, panels, columns, shared_legend: true }
    }

    /// An empty view; `below` is room for a key, as a part of the size.
    fn chart(&self, title: String, y_label: &str, axis: usize, below: f64) -> Chart {
        let mut chart = Chart::new(title, "x / mm", y_label);
        chart.equal_aspect = true;
        chart.x.range = Range::Fixed(self.low[0], self.high[0]);
        chart.y.range = Range::Fixed(self.low[axis] - below * self.size_mm(), self.high[axis]);
        chart
    }

    /// An arrow of a round length with its value, below everything else.
    fn key(&self, poses: &[PoseVector], factor: f64, axis: usize) -> Option<Mark> {
        let components = poses.iter().flat_map(|p| p.residual_um).map(f64::abs);
        let (_, largest_um) = extent(components).filter(|(_, high)| *high > 0.0)?;
        let length_um = one_two_five_below(largest_um.min(0.3 * self.size_mm() * MM / (factor * UM)));
        let y = self.low[axis] - KEY * self.size_mm();
        let from = [self.low[0], y];
        Some(arrow(
            from,
            [from[0] + factor * length_um * UM / MM, y],
            round_amount(length_um, length_um, "µm"),
        ))
    }
}

/// Errors in steps of equal size: as many sizes as a reader can tell apart.
struct Classes {
    step_mm: f64,
    number: usize,
    largest_px: f64,
}

impl Classes {
    fn new(poses: &[PoseError]) -> Self {
        let largest = extent(poses.iter().map(|p| p.error_mm)).map_or(0.0, |(_, high)| high);
        // Between 3 and 8 of them.
        let step_mm = one_two_five_below(largest / 3.0);
        let number = if poses.is_empty() { 0 } else { ((largest / step_mm - 1e-9).ceil() as usize).max(1) };
        let largest_px = match poses.len() {
            0..=60 => 11.0,
            61..=300 => 8.0,
            _ => 6.0,
        };
        Classes { step_mm, number, largest_px }
    }

    fn class(&self, error_mm: f64) -> usize {
        ((error_mm / self.step_mm - 1e-9).ceil() as usize).clamp(1, self.number.max(1)) - 1
    }

    fn mark(&self, class: usize, points: Vec<Point>) -> Mark {
        let part = (class + 1) as f64 / self.number as f64;
        // Darker too, so that the large ones are seen first on a grey print as well.
        let colour = match part {
            p if p > 0.67 => Colour::Black,
            p if p > 0.34 => Colour::Blue,
            _ => Colour::SkyBlue,
        };
        let style = Style::nth(0).colour(colour).dash(Dash::Solid).marker(Marker::Circle);
        Mark::Points {
            label: format!("up to {}", round_amount((class + 1) as f64 * self.step_mm, self.step_mm, "mm")),
            points,
            style: style.size((self.largest_px * part).max(1.2)),
        }
    }
}

/// In which square of a view a position lies.
fn cell(at_mm: &[f64; 3], cell_mm: f64, axis: usize) -> (i64, i64) {
    let index = |i: usize| (at_mm[i] / cell_mm).floor() as i64;
    (index(0), index(axis))
}

fn worst_of_cells(poses: &[PoseError], cell_mm: f64, axis: usize) -> Vec<PoseError> {
    let mut worst: BTreeMap<(i64, i64), PoseError> = BTreeMap::new();
    for pose in poses {
        let here = worst.entry(cell(&pose.at_mm, cell_mm, axis)).or_insert(*pose);
        if pose.error_mm > here.error_mm {
            *here = *pose;
        }
    }
    worst.into_values().collect()
}

fn means_of_cells(poses: &[PoseVector], cell_mm: f64, axis: usize) -> Vec<PoseVector> {
    let mut cells: BTreeMap<(i64, i64), Vec<&PoseVector>> = BTreeMap::new();
    for pose in poses {
        cells.entry(cell(&pose.at_mm, cell_mm, axis)).or_default().push(pose);
    }
    let mean = |poses: &Vec<&PoseVector>| {
        let mean_of = |part: fn(&PoseVector) -> [f64; 3]| {
            [0, 1, 2].map(|i| poses.iter().map(|p| part(p)[i] / poses.len() as f64).sum())
        };
        PoseVector { at_mm: mean_of(|p| p.at_mm), residual_um: mean_of(|p| p.residual_um) }
    };
    cells.values().map(mean).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A spiral of `count` poses.
    fn places(count: usize) -> Vec<[f64; 3]> {
        let place = |i: usize| {
            let t = i as f64;
            [800.0 + 300.0 * f64::sin(2.4 * t), 400.0 * f64::cos(1.7 * t), 500.0 + 200.0 * f64::sin(0.37 * t)]
        };
        (0..count).map(place).collect()
    }

    fn errors(count: usize) -> Vec<PoseError> {
        let pose = |(i, at_mm)| PoseError { at_mm, error_mm: 0.01 * (1 + i % 9) as f64 };
        places(count).into_iter().enumerate().map(pose).collect()
    }

    fn vectors(count: usize) -> Vec<PoseVector> {
        places(count).into_iter().map(|at_mm| PoseVector { at_mm, residual_um: [30.0, -40.0, 0.0] }).collect()
    }

    fn dots(chart: &Chart) -> usize {
        let count = |mark: &Mark| if let Mark::Points { points, .. } = mark { points.len() } else { 0 };
        chart.marks.iter().map(count).sum()
    }

    fn arrows(chart: &Chart) -> usize {
        chart.marks.iter().filter(|mark| matches!(mark, Mark::Arrow { .. })).count()
    }

    #[test]
    fn every_pose_is_a_disc_in_both_views_and_sizes_have_a_key() {
        let mut poses = errors(150);
        poses.push(PoseError { error_mm: f64::NAN, ..poses[0] });
        let figure = error_over_workspace(&poses);
        assert_eq!(figure.panels.iter().map(dots).collect::<Vec<_>>(), [150, 150]);
        let svg = figure.svg();
        for text in ["x / mm", "y / mm", "z / mm", "up to 0.02\u{a0}mm", "up to 0.10\u{a0}mm"] {
            assert!(svg.contains(text), "{text}\n{svg}");
        }
    }

    #[test]
    fn arrows_start_at_the_measured_positions_and_have_a_key() {
        let figure = residual_vectors(&vectors(30));
        assert_eq!(figure.panels.iter().map(arrows).collect::<Vec<_>>(), [31, 31]);
        assert_eq!(figure.panels[0].title, "from above, residuals ×\u{a0}2000");
        let Mark::Arrow { from, to, .. } = &figure.panels[0].marks[0] else { panic!("no arrow") };
        approx::assert_relative_eq!(to[0] - from[0], 60.0, max_relative = 1e-9);
        assert!(figure.svg().contains("20\u{a0}µm"));
    }

    #[test]
    fn many_poses_are_gathered_in_cells_and_the_caption_says_so() {
        let figure = error_over_workspace(&errors(100_000));
        assert!(
            figure.panels.iter().all(|c| (50..=2000).contains(&dots(c))),
            "{:?}",
            figure.panels.iter().map(dots).collect::<Vec<_>>()
        );
        assert!(figure.caption.contains("100\u{2009}000 poses") && figure.caption.contains("50\u{a0}mm"));
        let figure = residual_vectors(&vectors(100_000));
        assert!(
            figure.panels.iter().all(|c| (50..=700).contains(&arrows(c))),
            "{:?}",
            figure.panels.iter().map(arrows).collect::<Vec<_>>()
        );
        assert!(figure.caption.contains("mean over the poses"));
    }

    #[test]
    fn degenerate_workspaces_draw() {
        let odd = [0.0, 7.0, f64::NAN, f64::INFINITY, 1e190, -1e190, 1e-190];
        for a in odd {
            for b in odd {
                for count in [1, 2, 3000] {
                    let at = |i: usize| [if i == 0 { a } else { b }, b, 0.0];
                    let errors: Vec<_> = (0..count)
                        .map(|i| PoseError { at_mm: at(i), error_mm: if i == 0 { a } else { b } })
                        .collect();
                    let vectors: Vec<_> =
                        (0..count).map(|i| PoseVector { at_mm: at(i), residual_um: [a, b, 0.0] }).collect();
                    assert!(!error_over_workspace(&errors).svg().contains("NaN"));
                    assert!(!residual_vectors(&vectors).svg().contains("NaN"));
                }
            }
        }
        error_over_workspace(&[]).svg();
        residual_vectors(&[]).svg();
    }
}
