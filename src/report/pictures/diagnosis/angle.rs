//! How far a joint is from where it says it is, over its own angle.

use serde::Serialize;

use super::super::super::chart::{Chart, Colour, Dash, Figure, Mark, Marker, Point, Range, Style};
use super::super::super::scale::{drawable, extent};
use super::{CLOUD_PX, MANY, padded};

/// Rows of panels in one figure: it fits on a printed page.
const ROWS: usize = 4;
/// Height of a panel, px.
const HEIGHT: f64 = 150.0;

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
    let points = joint.poses.iter().filter(|pose| drawable(pose[which]));
    let size = if joint.poses.len() > MANY { CLOUD_PX } else { 2.4 };
    chart.marks.push(Mark::Points {
        label: "a pose".into(),
        points: points.map(|pose| Point { x: pose[0], y: pose[which], error: 0.0 }).collect(),
        style: Style::nth(0).colour(Colour::Grey).marker(Marker::Dot).size(size),
    });
    if has_curve {
        chart.marks.push(Mark::Line {
            label: "finding".into(),
            points: joint.curve.iter().map(|c| [c[0], c[1]]).collect(),
            style: Style::nth(0).dash(Dash::Solid).width(1.8),
        });
    }
    chart
}

#[cfg(test)]
mod tests {
    use super::*;

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
