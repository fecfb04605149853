//! How far a joint is from where it says it is, over its own angle.

use serde::Serialize;

use super::super::super::chart::{Chart, Colour, Dash, Figure, Mark, Marker, Point, Range, Style};
use super::super::super::scale::{drawable, extent};
use super::{CLOUD_PX, MANY, padded};

/// Rows of panels in one figure: it fits on a printed page.
const ROWS: usize = 4;
/// Height of a panel, px.
const HEIGHT: f64 = 150.0;

/// More poses are not drawn one by one.
const MOST_DOTS: usize = 300;
/// Bins of their angles, and so many at least from one turn of a curve to the next.
const BINS: usize = 60;
const PER_TURN: usize = 3;
/// Of fewer poses: how many a bin has on average, and how many bins there are.
const LEAST_IN_BIN: usize = 6;
const LEAST_BINS: usize = 5;
const MOST_BINS: usize = 16;

/// Error of one joint over its angle.
#[derive(Debug, Clone, Default, Serialize)]
pub struct AngleError {
    /// The joint's name.
    pub joint: String,
    /// Angle (°), error that a pose shows before and after (µrad). With a curve the former is
    /// without all else that was found, so that the curve goes through it.
    pub poses: Vec<[f64; 3]>,
    /// Angle (°), error as it was found, half of its 95 % interval (µrad); empty where none was.
    pub curve: Vec<[f64; 3]>,
}

/// For each joint two panels to one scale, before and after, or one where after is as before in all
/// of them. As many figures as that takes.
pub fn angle_errors(joints: &[AngleError]) -> Vec<Figure> {
    let is_changed = |joint: &AngleError| {
        !joint.curve.is_empty() || joint.poses.iter().any(|[_, before, after]| before != after)
    };
    let has_both = joints.iter().any(is_changed);
    let of_joint = |joint: &AngleError| match (has_both, joint.curve.is_empty()) {
        (false, _) => vec![panel(joint, 2, "")],
        (true, true) => vec![panel(joint, 1, ": before"), panel(joint, 2, ": after")],
        (true, false) => {
            vec![panel(joint, 1, ": before, without the other findings"), panel(joint, 2, ": after")]
        }
    };
    let figure = |joints: &[AngleError]| Figure {
        name: "angle-errors".into(),
        panels: joints.iter().flat_map(of_joint).collect(),
        columns: 2,
        shared_legend: true,
        ..Figure::default()
    };
    joints.chunks(if has_both { ROWS } else { 2 * ROWS }).map(figure).collect()
}

/// One number of the poses; before, with the curve.
fn panel(joint: &AngleError, which: usize, title: &str) -> Chart {
    let all = joint.poses.iter().flat_map(|pose| [pose[1], pose[2]]);
    let y = padded(extent(all.chain(joint.curve.iter().map(|c| c[1]))), 0.06);
    let x = padded(extent(joint.poses.iter().map(|pose| pose[0])), 0.03);
    let label = format!("angle of {} / °", joint.joint);
    let mut chart = Chart::new(format!("{}{title}", joint.joint), label, "angle error / µrad");
    (chart.x.range, chart.y.range) = (Range::Fixed(x.0, x.1), Range::Fixed(y.0, y.1));
    chart.height_px = Some(HEIGHT);
    let has_curve = which == 1 && !joint.curve.is_empty();
    if has_curve {
        chart.marks.push(Mark::Band {
            label: "95 % interval".into(),
            points: joint.curve.iter().map(|c| [c[0], c[1] - c[2], c[1] + c[2]]).collect(),
            style: Style::nth(0).colour(Colour::SkyBlue),
        });
    }
    chart.marks.push(Mark::Horizontal { at: 0.0, text: String::new() });
    chart.marks.push(poses(joint, which));
    chart.marks.extend(means(joint, which));
    if has_curve {
        chart.marks.push(Mark::Line {
            label: "finding".into(),
            points: joint.curve.iter().map(|c| [c[0], c[1]]).collect(),
            style: Style::nth(0).dash(Dash::Solid).width(1.8),
        });
    }
    chart
}

/// A dot for each pose. Of very many the mean and the scatter of neighbours; where the curve turns
/// so often that means would level it, one pose in several.
fn poses(joint: &AngleError, which: usize) -> Mark {
    let drawn = drawn(joint, which);
    let dot = |at: &[f64; 2]| Point { x: at[0], y: at[1], error: 0.0 };
    let style = Style::nth(0).colour(Colour::Grey).marker(Marker::Dot);
    if drawn.len() <= MOST_DOTS {
        let size = if joint.poses.len() > MANY { CLOUD_PX } else { 2.4 };
        let points = drawn.iter().map(dot).collect();
        return Mark::Points { label: "a pose".into(), points, style: style.size(size) };
    }
    if turns(&joint.curve) * PER_TURN > BINS {
        let step = drawn.len().div_ceil(MOST_DOTS);
        let points: Vec<Point> = drawn.iter().step_by(step).map(dot).collect();
        let label = format!("a pose, {} of {}", points.len(), drawn.len());
        return Mark::Points { label, points, style: style.size(CLOUD_PX) };
    }
    let label = "mean of neighbouring poses ± their standard deviation".into();
    Mark::Points { label, points: binned(&drawn, BINS, 0.0), style: style.size(2.0) }
}

fn drawn(joint: &AngleError, which: usize) -> Vec<[f64; 2]> {
    let poses = joint.poses.iter().filter(|pose| drawable(pose[0]) && drawable(pose[which]));
    poses.map(|pose| [pose[0], pose[which]]).collect()
}

/// Beside dots, what several of them say together, where that levels no curve.
fn means(joint: &AngleError, which: usize) -> Option<Mark> {
    let drawn = drawn(joint, which);
    let bins = (drawn.len() / LEAST_IN_BIN).min(MOST_BINS);
    let is_worth_it = drawn.len() <= MOST_DOTS && bins >= LEAST_BINS.max(PER_TURN * turns(&joint.curve));
    is_worth_it.then(|| Mark::Points {
        label: "mean of neighbouring poses ± its standard error".into(),
        points: binned(&drawn, bins, 0.5),
        style: Style::nth(0).colour(Colour::Black).marker(Marker::Circle).size(2.6),
    })
}

/// How often a curve turns.
fn turns(curve: &[[f64; 3]]) -> usize {
    let steps: Vec<f64> = curve.windows(2).map(|pair| pair[1][1] - pair[0][1]).collect();
    steps.windows(2).filter(|pair| pair[0] * pair[1] < 0.0).count()
}

/// Means within so many bins of one width, and their standard deviations by the number of points to
/// a power: of a point with 0, of the mean with ½.
fn binned(points: &[[f64; 2]], bins: usize, power: f64) -> Vec<Point> {
    let (low, high) = extent(points.iter().map(|point| point[0])).unwrap_or((0.0, 1.0));
    let mut all: Vec<Vec<&[f64; 2]>> = vec![Vec::new(); bins];
    for point in points {
        let at = bins as f64 * (point[0] - low) / (high - low).max(f64::MIN_POSITIVE);
        all[(at as usize).min(bins - 1)].push(point);
    }
    let of_bin = |bin: &Vec<&[f64; 2]>| {
        let count = bin.len() as f64;
        let mean = |k: usize| bin.iter().map(|point| point[k]).sum::<f64>() / count;
        let (x, y) = (mean(0), mean(1));
        let square = bin.iter().map(|point| (point[1] - y).powi(2)).sum::<f64>();
        Point { x, y, error: (square / (count - 1.0).max(1.0)).sqrt() / count.powf(power) }
    };
    all.iter().filter(|bin| !bin.is_empty()).map(of_bin).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn very_many_poses_are_means_with_their_scatter_or_some_of_them() {
        let error = |q: usize| if q.is_multiple_of(2) { 10.0 } else { -10.0 };
        let many: Vec<[f64; 3]> = (0..1200).map(|q| [q as f64 / 10.0, error(q), 0.0]).collect();
        let curve = |waves: f64| {
            let at = |k: i32| [f64::from(k), (f64::from(k) * waves).sin(), 0.1];
            (0..120).map(at).collect::<Vec<_>>()
        };
        let drawn = |waves: f64| {
            let joint = AngleError { joint: "joint 1".into(), poses: many.clone(), curve: curve(waves) };
            let Mark::Points { label, points, .. } = poses(&joint, 1) else { panic!("no points") };
            (label, points)
        };
        let (label, points) = drawn(0.05);
        assert!(label.starts_with("mean of neighbouring poses"), "{label}");
        assert_eq!(points.len(), BINS);
        assert!(points.iter().all(|p| p.y.abs() < 1e-9 && (p.error - 10.0).abs() < 0.5));
        let (label, points) = drawn(1.0);
        assert_eq!((label.as_str(), points.len()), ("a pose, 300 of 1200", 300));
    }

    fn joint(after: f64, curve: Vec<[f64; 3]>) -> AngleError {
        AngleError {
            joint: "joint 2".into(),
            poses: vec![[10.0, -40.0, after], [80.0, -40.0, f64::NAN]],
            curve,
        }
    }

    #[test]
    fn a_joint_has_two_panels_to_one_scale() {
        let curve = vec![[0.0, -50.0, 5.0], [90.0, 50.0, 5.0]];
        let figures = angle_errors(&[joint(4.0, curve)]);
        let [figure] = figures.as_slice() else { panic!("{} figures", figures.len()) };
        assert_eq!(figure.panels.len(), 2);
        assert_eq!(figure.panels[0].y.range, figure.panels[1].y.range);
        assert!(!figure.svg().contains("NaN"));
        assert!(angle_errors(&[]).is_empty());
        angle_errors(&[AngleError::default()])[0].svg();
    }

    #[test]
    fn a_joint_without_a_curve_has_none_and_seven_joints_take_two_figures() {
        let figures = angle_errors(&vec![joint(4.0, vec![]); 7]);
        let panels: Vec<usize> = figures.iter().map(|figure| figure.panels.len()).collect();
        assert_eq!(panels, [8, 6]);
        let is_curve = |mark: &Mark| matches!(mark, Mark::Line { .. } | Mark::Band { .. });
        assert!(!figures[0].panels[0].marks.iter().any(is_curve));
    }

    #[test]
    fn one_panel_is_enough_where_nothing_changes() {
        let mut same = joint(-40.0, vec![]);
        same.poses.truncate(1);
        assert_eq!(angle_errors(&[same.clone(), same.clone()])[0].panels.len(), 2);
        assert_eq!(angle_errors(&[same, joint(4.0, vec![])])[0].panels.len(), 4);
    }
}
