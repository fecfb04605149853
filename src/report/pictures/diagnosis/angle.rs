//! How far a joint is from where it says it is, over its own angle.

use serde::Serialize;

use super::super::super::chart::{Chart, Colour, Dash, Figure, Mark, Marker, Point, Range, Style};
use super::super::super::scale::{drawable, extent};
use super::{MANY, padded};

/// Error of one joint over its angle.
#[derive(Debug, Clone, Default, Serialize)]
pub struct AngleError {
    /// The joint's name.
    pub joint: String,
    /// Angle (°), error that a pose shows before and after (µrad).
    pub poses: Vec<[f64; 3]>,
    /// Angle (°), error as it was found, half of its 95 % interval (µrad).
    pub curve: Vec<[f64; 3]>,
}

/// For each joint two panels to one scale: what the poses show with the curve that was found, and what is left.
pub fn angle_errors(joints: &[AngleError]) -> Figure {
    let panels = joints.iter().flat_map(|joint| {
        let all = joint.poses.iter().flat_map(|pose| [pose[1], pose[2]]);
        let y = padded(extent(all.chain(joint.curve.iter().map(|c| c[1]))), 0.06);
        let x = padded(extent(joint.poses.iter().map(|pose| pose[0])), 0.03);
        [(1, "shown by the poses"), (2, "left of it")].map(|(which, title)| {
            let label = format!("angle of {} / °", joint.joint);
            let mut chart =
                Chart::new(format!("{}: {title}", joint.joint), label, "true − told angle / µrad");
            (chart.x.range, chart.y.range) = (Range::Fixed(x.0, x.1), Range::Fixed(y.0, y.1));
            if which == 1 {
                chart.marks.push(Mark::Band {
                    label: "95 % interval".into(),
                    points: joint.curve.iter().map(|c| [c[0], c[1] - c[2], c[1] + c[2]]).collect(),
                    style: Style::nth(0).colour(Colour::SkyBlue),
                });
            }
            chart.marks.push(Mark::Horizontal { at: 0.0, text: String::new() });
            let points = joint.poses.iter().filter(|pose| drawable(pose[which]));
            let size = if joint.poses.len() > MANY { 1.1 } else { 2.4 };
            chart.marks.push(Mark::Points {
                label: "a pose".into(),
                points: points.map(|pose| Point { x: pose[0], y: pose[which], error: 0.0 }).collect(),
                style: Style::nth(0).colour(Colour::Grey).marker(Marker::Dot).size(size),
            });
            if which == 1 {
                chart.marks.push(Mark::Line {
                    label: "what was found".into(),
                    points: joint.curve.iter().map(|c| [c[0], c[1]]).collect(),
                    style: Style::nth(0).dash(Dash::Solid).width(1.8),
                });
            }
            chart
        })
    });
    Figure {
        name: "angle-errors".into(),
        panels: panels.collect(),
        columns: 2,
        shared_legend: true,
        ..Figure::default()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_joint_has_two_panels_to_one_scale() {
        let curve = vec![[0.0, -50.0, 5.0], [90.0, 50.0, 5.0]];
        let poses = vec![[10.0, -40.0, 4.0], [80.0, 45.0, f64::NAN]];
        let figure = angle_errors(&[AngleError { joint: "joint 2".into(), poses, curve }]);
        assert_eq!(figure.panels.len(), 2);
        assert_eq!(figure.panels[0].y.range, figure.panels[1].y.range);
        assert!(!figure.svg().contains("NaN"));
        angle_errors(&[]).svg();
        angle_errors(&[AngleError::default()]).svg();
    }
}
