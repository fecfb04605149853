//! The plan as a picture: the arm as sticks, and where each joint goes.

use nalgebra::Vector3;

use crate::design::PoseStudy;
use crate::report::chart::{Axis, Chart, Colour, Dash, Figure, Mark, Marker, Point, Range, Style};
use crate::robot::{Kinematics, Motion};
use crate::units::{DEG, MM};

/// Arms that are drawn: of more none can be followed.
const ARMS: usize = 4;

/// An arm that is drawn, joint by joint to the flange, and its rod, in {W}.
struct Arm {
    label: String,
    joints: Vec<Vector3<f64>>,
    rod: Vec<Vector3<f64>>,
}

/// The arm in some of the poses, all flanges, and the places, from above and from the side.
pub fn plan(study: &PoseStudy) -> Figure {
    let mut kinematics = Kinematics::new(&study.setup);
    let rod: Vec<Vector3<f64>> = match &study.campaign.rod {
        Some(rod) => {
            [0.0, rod.bend_start(), rod.bend_end(), rod.length()].map(|station| rod.point(station)).to_vec()
        }
        // where {T} is at the ball the arm ends there
        None if study.setup.tool.norm() < MM => Vec::new(),
        None => vec![Vector3::zeros(), study.setup.tool],
    };
    let is_tracked = study.places.iter().all(|place| place.name.is_tracked());
    let drawn = representative(study);
    let (mut arms, mut flanges) = (Vec::new(), Vec::new());
    for (k, (place, q)) in study.chosen.iter().enumerate() {
        kinematics.update(q, &[]);
        flanges.push(kinematics.flange.origin);
        if drawn.contains(&k) {
            let own = kinematics.joints.iter().map(|joint| joint.origin);
            arms.push(Arm {
                label: match is_tracked {
                    true => format!("arm, pose {}", k + 1),
                    false => format!("arm, pose {} at {}", k + 1, study.places[*place].name),
                },
                joints: own.chain([kinematics.flange.origin]).collect(),
                rod: rod.iter().map(|point| kinematics.flange.point(point)).collect(),
            });
        }
    }
    let views = [("from above", "y / mm", 1), ("from the side", "z / mm", 2)];
    let panel = |(title, label, axis): (&str, &str, usize)| {
        let at = |p: &Vector3<f64>| [p.x / MM, p[axis] / MM];
        let dots = |points: &[Vector3<f64>]| -> Vec<Point> {
            points.iter().map(|p| Point { x: p.x / MM, y: p[axis] / MM, error: 0.0 }).collect()
        };
        let mut chart = Chart::new(title, "x / mm", label);
        chart.equal_aspect = true;
        chart.marks.push(Mark::Points {
            label: "flange, all poses".into(),
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
            chart.marks.push(line("rod", &arm.rod, style.dash(Dash::Solid).colour(Colour::Black).width(0.8)));
            chart.marks.push(Mark::Points {
                label: String::new(),
                points: dots(&arm.joints),
                style: style.marker(Marker::Circle).size(2.0),
            });
        }
        if !is_tracked {
            let places: Vec<Vector3<f64>> = study.places.iter().map(|place| place.device.origin).collect();
            chart.marks.push(Mark::Points {
                label: "places of the ball".into(),
                points: dots(&places),
                style: Style::nth(1).marker(Marker::Diamond).size(5.0),
            });
        }
        chart
    };
    Figure {
        name: "pose-plan".into(),
        caption: "The planned poses in {W}: the arm in some of them as sticks from joint to joint, \
                  with the rod, and the flange of every pose."
            .into(),
        panels: views.map(panel).into(),
        columns: 2,
        shared_legend: true,
        ..Figure::default()
    }
}

/// Numbers of the poses whose arms are drawn: evenly from the first place to the last, at each the
/// one in the middle.
fn representative(study: &PoseStudy) -> Vec<usize> {
    let count = study.chosen.len();
    let of_place =
        |place: usize| -> Vec<usize> { (0..count).filter(|&k| study.chosen[k].0 == place).collect() };
    let places: Vec<Vec<usize>> =
        (0..study.places.len()).map(of_place).filter(|own| !own.is_empty()).collect();
    let evenly = |all: usize| (0..ARMS.min(all)).map(move |k| (2 * k + 1) * all / (2 * ARMS.min(all)));
    match places.len() {
        0 | 1 => evenly(count).collect(),
        several => evenly(several).map(|place| places[place][places[place].len() / 2]).collect(),
    }
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
