//! How large the errors are where in the workspace: seen from above and from the side.

use std::collections::BTreeMap;

use serde::Serialize;

use super::super::super::chart::{Chart, Colour, Dash, Figure, Mark, Marker, Point, Range, Style};
use super::super::super::scale::{drawable, extent, one_two_five_below, typeset};
use super::{MOST_POINTS, round_amount};

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
    over_workspace(poses, "error")
}

/// The same for standard deviations that are expected, not errors that were measured.
pub fn uncertainty_over_workspace(poses: &[PoseError]) -> Figure {
    over_workspace(poses, "uncertainty")
}

/// `what` is "error", "uncertainty", …
fn over_workspace(poses: &[PoseError], what: &str) -> Figure {
    let known =
        |p: &&PoseError| p.at_mm.iter().chain([&p.error_mm]).all(|v| drawable(*v)) && p.error_mm >= 0.0;
    let poses: Vec<PoseError> = poses.iter().filter(known).copied().collect();
    let room = Room::around(poses.iter().map(|p| p.at_mm));
    let cell_mm = one_two_five_below(room.size_mm() / 16.0);
    let mut caption = format!("The poses in the workspace; the larger a disc, the larger the {what} there.");
    if poses.len() > MOST_POINTS {
        caption += &format!(
            " Of {} poses the one with the largest {what} in each square of {} is drawn.",
            typeset(&poses.len().to_string()),
            round_amount(cell_mm, cell_mm, "mm")
        );
    }
    let classes = Classes::new(&poses);
    let panel = |(view, label, axis): (&str, &str, usize)| {
        let mut chart = room.chart(format!("{what}, {view}"), label, axis);
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
    room.figure(&format!("{what}-over-workspace"), caption, VIEWS.map(panel).into())
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
        Figure { name: name.into(), caption, panels, columns, shared_legend: true, ..Figure::default() }
    }

    /// An empty view.
    fn chart(&self, title: String, y_label: &str, axis: usize) -> Chart {
        let mut chart = Chart::new(title, "x / mm", y_label);
        chart.equal_aspect = true;
        chart.x.range = Range::Fixed(self.low[0], self.high[0]);
        chart.y.range = Range::Fixed(self.low[axis], self.high[axis]);
        chart
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

    /// So many steps: in µm where all of them are below a millimetre.
    fn size(&self, steps: f64) -> String {
        match self.number as f64 * self.step_mm < 1.0 {
            true => round_amount(steps * self.step_mm * 1e3, self.step_mm * 1e3, "µm"),
            false => round_amount(steps * self.step_mm, self.step_mm, "mm"),
        }
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
            label: format!("up to {}", self.size((class + 1) as f64)),
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

#[cfg(test)]
pub(super) mod tests {
    use super::*;

    /// A spiral of `count` poses.
    pub fn places(count: usize) -> Vec<[f64; 3]> {
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

    fn dots(chart: &Chart) -> usize {
        let count = |mark: &Mark| if let Mark::Points { points, .. } = mark { points.len() } else { 0 };
        chart.marks.iter().map(count).sum()
    }

    #[test]
    fn every_pose_is_a_disc_in_both_views_and_sizes_have_a_key() {
        let mut poses = errors(150);
        poses.push(PoseError { error_mm: f64::NAN, ..poses[0] });
        let figure = error_over_workspace(&poses);
        assert_eq!(figure.panels.iter().map(dots).collect::<Vec<_>>(), [150, 150]);
        let svg = figure.svg();
        for text in ["x / mm", "y / mm", "z / mm", "up to 20\u{a0}µm", "up to 100\u{a0}µm"] {
            assert!(svg.contains(text), "{text}\n{svg}");
        }
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
                    assert!(!error_over_workspace(&errors).svg().contains("NaN"));
                }
            }
        }
        error_over_workspace(&[]).svg();
    }
}
