//! The plan as a picture: the arm as sticks, and where each joint goes.

use crate::design::PoseStudy;
use crate::report::arms::{ArmPose, arms};
use crate::report::chart::{Axis, Chart, Colour, Dash, Figure, Mark, Marker, Point, Range, Style};
use crate::robot::Motion;
use crate::units::{DEG, MM};

/// The arm in some of the poses, all flanges, and the places, from above and from the side.
pub fn plan(study: &PoseStudy) -> Figure {
    let is_tracked = study.places.iter().all(|place| place.name.is_tracked());
    let poses: Vec<ArmPose> = (study.chosen.iter().zip(1..))
        .map(|((place, joints), number)| ArmPose { place: *place, joints, name: format!("pose {number}") })
        .collect();
    let named = study.places.iter().map(|place| (place.name.to_string(), Some(place.device.origin)));
    let places: Vec<_> = if is_tracked { Vec::new() } else { named.collect() };
    let figure = arms(&study.setup, study.campaign.rod.as_ref(), &poses, &places);
    figure.named("pose-plan").captioned(
        "The planned poses in {W}: the arm in some of them as sticks from joint to joint, with the rod, and the \
         flange of every pose.",
    )
}

/// Where each joint goes within its limits.
pub fn joints(study: &PoseStudy) -> Figure {
    let robot = study.setup.robot;
    let has_slides = robot.joints.iter().any(|joint| joint.motion == Motion::Prismatic);
    let label = if has_slides { "joint value / ° or mm" } else { "joint value / °" };
    let mut chart = Chart::new("", label, "");
    let row = |j: usize| -(j as f64);
    chart.y = Axis {
        names: (0..robot.joints.len()).map(|j| (row(j), format!("joint {}", j + 1))).collect(),
        range: Range::Fixed(row(robot.joints.len()) + 0.4, 0.6),
        ..Axis::default()
    };
    chart.height_px = Some(34.0 * robot.joints.len() as f64 + 30.0);
    for (j, joint) in robot.joints.iter().enumerate() {
        let unit = if joint.motion == Motion::Revolute { DEG } else { MM };
        if let Some(limits) = joint.limits {
            chart.marks.push(Mark::Line {
                label: "limits".into(),
                points: limits.map(|limit| [limit / unit, row(j)]).to_vec(),
                style: Style::nth(0).colour(Colour::Grey).dash(Dash::Solid).width(5.0),
            });
        }
        chart.marks.push(Mark::Points {
            label: "poses".into(),
            points: study
                .chosen
                .iter()
                .map(|(_, q)| Point { x: q[j] / unit, y: row(j), error: 0.0 })
                .collect(),
            style: Style::nth(2).marker(Marker::Plus).size(4.0),
        });
    }
    Figure::from(chart)
        .named("joint-coverage")
        .captioned("What the planned poses use of the range of each joint.")
}
