//! The arm as sticks in representative poses, from above and from the side.

use nalgebra::Vector3;

use super::chart::{Chart, Colour, Dash, Figure, Mark, Marker, Point, Style};
use crate::robot::{Kinematics, Setup};
use crate::rod::Rod;
use crate::units::MM;

/// Arms that are drawn: of more none can be followed.
const ARMS: usize = 4;
/// Flanges that are drawn, evenly from the first to the last.
const FLANGES: usize = 400;

/// A pose of the arm.
pub(super) struct ArmPose<'a> {
    /// Which of the places the ball is in.
    pub(super) place: usize,
    /// Joint values, rad or m.
    pub(super) joints: &'a [f64],
    /// What it is called: `pose 7`.
    pub(super) name: String,
}

/// An arm that is drawn, joint by joint to the flange, and its rod, in {W}.
struct Arm {
    label: String,
    joints: Vec<Vector3<f64>>,
    rod: Vec<Vector3<f64>>,
}

/// The arm in some of `poses` with its rod (without one, its tool), the flanges of all, and the
/// places: their names, and where they are in {W}, m; none where the tip may be anywhere.
pub(super) fn arms(
    setup: &Setup,
    rod: Option<&Rod>,
    poses: &[ArmPose],
    places: &[(String, Option<Vector3<f64>>)],
) -> Figure {
    let mut kinematics = Kinematics::new(setup);
    let end_name = if rod.is_some() { "rod" } else { "tool" };
    let rod: Vec<Vector3<f64>> = match rod {
        Some(rod) => {
            [0.0, rod.bend_start(), rod.bend_end(), rod.length()].map(|station| rod.point(station)).to_vec()
        }
        // where {T} is at the ball the arm ends there
        None if setup.tool.norm() < MM => Vec::new(),
        None => vec![Vector3::zeros(), setup.tool],
    };
    let drawn = representative(poses);
    let (mut arms, mut flanges) = (Vec::new(), Vec::new());
    let every = poses.len().div_ceil(FLANGES).max(1);
    for (k, pose) in poses.iter().enumerate() {
        let is_drawn = drawn.contains(&k);
        if !is_drawn && k % every > 0 {
            continue;
        }
        kinematics.update(pose.joints, &[]);
        flanges.push(kinematics.flange.origin);
        if is_drawn {
            let own = kinematics.joints.iter().map(|joint| joint.origin);
            let place = places.get(pose.place).map_or(String::new(), |(place, _)| format!(" at {place}"));
            arms.push(Arm {
                label: format!("arm, {}{place}", pose.name),
                joints: own.chain([kinematics.flange.origin]).collect(),
                rod: rod.iter().map(|point| kinematics.flange.point(point)).collect(),
            });
        }
    }
    let places: Vec<Vector3<f64>> = places.iter().filter_map(|(_, at)| *at).collect();
    let flanges_label = if every > 1 { "flange, some poses" } else { "flange, all poses" };
    let views = [("from above", "y / mm", 1), ("from the side", "z / mm", 2)];
    let panel = |(title, label, axis): (&str, &str, usize)| {
        let at = |p: &Vector3<f64>| [p.x / MM, p[axis] / MM];
        let dots = |points: &[Vector3<f64>]| -> Vec<Point> {
            points.iter().map(|p| Point { x: p.x / MM, y: p[axis] / MM, error: 0.0 }).collect()
        };
        let mut chart = Chart::new(title, "x / mm", label);
        chart.equal_aspect = true;
        chart.marks.push(Mark::Points {
            label: flanges_label.into(),
            points: dots(&flanges),
            style: Style::nth(0).colour(Colour::SkyBlue).marker(Marker::Dot).size(3.0),
        });
        for (k, arm) in arms.iter().enumerate() {
            let line = |label: &str, points: &[Vector3<f64>], style| Mark::Line {
                label: label.into(),
                points: points.iter().map(at).collect(),
                style,
            };
            let style = Style::nth(k);
            chart.marks.push(line(&arm.label, &arm.joints, style.width(2.2)));
            chart.marks.push(line(
                end_name,
                &arm.rod,
                style.dash(Dash::Solid).colour(Colour::Black).width(0.8),
            ));
            chart.marks.push(Mark::Points {
                label: String::new(),
                points: dots(&arm.joints),
                style: style.marker(Marker::Circle).size(2.0),
            });
        }
        if !places.is_empty() {
            chart.marks.push(Mark::Points {
                label: "places of the ball".into(),
                points: dots(&places),
                style: Style::nth(1).marker(Marker::Diamond).size(5.0),
            });
        }
        chart
    };
    Figure {
        name: "arms".into(),
        panels: views.map(panel).into(),
        columns: 2,
        shared_legend: true,
        ..Figure::default()
    }
}

/// Numbers of the poses whose arms are drawn: evenly from the first place to the last, at each the
/// one in the middle; at a single place evenly from the first pose to the last.
fn representative(poses: &[ArmPose]) -> Vec<usize> {
    let mut places: Vec<Vec<usize>> = Vec::new();
    for (k, pose) in poses.iter().enumerate() {
        if places.len() <= pose.place {
            places.resize(pose.place + 1, Vec::new());
        }
        places[pose.place].push(k);
    }
    places.retain(|own| !own.is_empty());
    let evenly = |all: usize| (0..ARMS.min(all)).map(move |k| (2 * k + 1) * all / (2 * ARMS.min(all)));
    match places.len() {
        0 | 1 => evenly(poses.len()).collect(),
        several => evenly(several).map(|place| places[place][places[place].len() / 2]).collect(),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn arms_are_drawn_from_all_places_or_from_all_along() {
        let poses = |places: &[usize]| -> Vec<usize> {
            let pose = |&place: &usize| ArmPose { place, joints: &[], name: String::new() };
            representative(&places.iter().map(pose).collect::<Vec<_>>())
        };
        assert!(poses(&[]).is_empty());
        assert_eq!(poses(&[0; 8]), [1, 3, 5, 7]);
        assert_eq!(poses(&[0, 0, 0, 2, 2, 2, 2, 5]), [1, 5, 7]);
        assert_eq!(poses(&[0, 1, 2, 3, 4, 5, 6, 7]), [1, 3, 5, 7]);
    }
}
