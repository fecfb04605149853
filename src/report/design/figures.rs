//! The front as a picture, and its rods to scale.

use crate::design::{Figure as Number, Goal, Study};
use crate::report::chart::{Chart, Colour, Dash, Figure, Mark, Marker, Point, Range, Style};
use crate::rod::Rod;
use crate::units::MM;

/// Rods drawn beside one another.
const DRAWN: usize = 6;
/// Points of an arc.
const POINTS: usize = 24;

fn label(goal: Number) -> String {
    match goal.name_and_unit() {
        (name, "") => name.to_owned(),
        (name, unit) => format!("{name} / {unit}"),
    }
}

/// The first goal against each other one, a panel for each; none where there is only one.
pub fn front(study: &Study) -> Option<Figure> {
    let (first, others) = study.space.goals.split_first()?;
    let panels: Vec<Chart> = others.iter().map(|second| pair(study, *first, *second)).collect();
    let others = others.iter().map(|goal| goal.figure.name_and_unit().0).collect::<Vec<_>>().join(" and ");
    let (name, more) = match panels.len() {
        0 => return None,
        1 => (others, ""),
        _ => (others, " A design that looks worse in one panel is better in another goal."),
    };
    Some(Figure {
        name: "front".into(),
        caption: format!(
            "Pareto front: {} against {name}. Bars: 95 % intervals from the standard uncertainties of the rod's \
             numbers.{more}",
            first.figure.name_and_unit().0
        ),
        columns: panels.len().min(2),
        shared_legend: panels.len() > 1,
        panels,
        ..Figure::default()
    })
}

fn pair(study: &Study, first: Goal, second: Goal) -> Chart {
    let mut chart = Chart::new("", label(first.figure), label(second.figure));
    let spans_much = |goal: Goal| {
        let values = || study.found.front.iter().filter_map(|design| design.figures.get(goal.figure));
        let (low, high) = values().fold((f64::INFINITY, 0.0f64), |(a, b), v| (a.min(v), b.max(v)));
        low > 0.0 && high > 20.0 * low
    };
    chart.x.log = spans_much(first);
    chart.y.log = spans_much(second);
    let at = |goal: Goal, design: &crate::design::Design| design.figures.get(goal.figure).unwrap_or(f64::NAN);
    let all: Vec<[f64; 2]> =
        study.found.front.iter().map(|design| [at(first, design), at(second, design)]).collect();
    let points = all.iter().map(|&[x, y]| Point { x, y, error: 0.0 }).collect();
    chart = chart.with(Mark::Points {
        label: "front".into(),
        points,
        style: Style::nth(0).colour(Colour::Grey).marker(Marker::Dot),
    });
    let shown = study.shown.iter().map(|shown| Point {
        x: at(first, &shown.design),
        y: at(second, &shown.design),
        error: shown.intervals.half.get(second.figure).unwrap_or(0.0),
    });
    chart = chart.with(Mark::Points {
        label: "with 95 % interval".into(),
        points: shown.collect(),
        style: Style::nth(2).size(3.0),
    });
    // the first goal is uncertain too
    for shown in &study.shown {
        let (x, y) = (at(first, &shown.design), at(second, &shown.design));
        let half = shown.intervals.half.get(first.figure).filter(|_| first.figure != Number::Price);
        let Some(half) = half.filter(|half| *half > 0.0) else { continue };
        chart = chart.with(Mark::Line {
            label: String::new(),
            points: vec![[x - half, y], [x + half, y]],
            style: Style::nth(2).dash(Dash::Solid).width(1.2),
        });
    }
    if let Some(base) = &study.base {
        let [x, y] = [first, second].map(|goal| base.figures.get(goal.figure).unwrap_or(f64::NAN));
        chart = chart.with(Mark::Points {
            label: format!("rod {}", base.rod.name),
            points: vec![Point { x, y, error: 0.0 }],
            style: Style::nth(1).marker(Marker::Diamond).size(6.0),
        });
    }
    chart
}

/// Some rods of the front beside each other, and the one to compare with.
pub fn to_scale(study: &Study) -> Figure {
    let count = study.shown.len();
    let mut picked: Vec<usize> = match count {
        0..=DRAWN => (0..count).collect(),
        _ => (0..DRAWN).map(|k| k * (count - 1) / (DRAWN - 1)).collect(),
    };
    picked.dedup();
    let mut rods: Vec<(String, &Rod)> = picked
        .iter()
        .map(|&k| {
            let shown = &study.shown[k];
            (format!("{}: {}", shown.rod.name, shown.tubes.join(" + ")), &shown.rod)
        })
        .collect();
    rods.extend(study.base.iter().map(|base| (format!("rod {}", base.rod.name), &base.rod)));
    let outlines: Vec<Vec<Vec<[f64; 2]>>> = rods.iter().map(|(_, rod)| outlines(rod)).collect();
    let all = || outlines.iter().flatten().flatten();
    let span = |axis: usize| {
        let (low, high) = all().fold((0.0f64, 0.0f64), |(a, b), p| (a.min(p[axis]), b.max(p[axis])));
        let margin = 0.04 * (high - low).max(1.0);
        Range::Fixed(low - margin, high + margin)
    };
    let panels = rods.iter().zip(&outlines).map(|((name, _), lines)| {
        let mut chart = Chart::new(name.clone(), "X / mm", "Z / mm");
        chart.equal_aspect = true;
        (chart.x.range, chart.y.range) = (span(0), span(1));
        for line in lines {
            chart = chart.with(Mark::Line {
                label: String::new(),
                points: line.clone(),
                style: Style::nth(0).dash(Dash::Solid).width(1.2),
            });
        }
        chart
    });
    Figure {
        name: "to-scale".into(),
        caption: "Rods of the front to one scale, seen from the side: the flange at the origin, the tip's ball as a ring of \
                  30 mm."
            .into(),
        panels: panels.collect(),
        columns: 3,
        ..Figure::default()
    }
}

/// Outlines of the tubes, and of a ball, X and Z in mm.
fn outlines(rod: &Rod) -> Vec<Vec<[f64; 2]>> {
    let (start, end, length) = (rod.bend_start(), rod.bend_end(), rod.length());
    let half = |pipe: &crate::rod::Pipe| pipe.section.height() / 2.0;
    // at a sharp corner the outlines meet on its bisector
    let mitre = if end > start { 0.0 } else { (rod.turn() / 2.0).tan().min(4.0) };
    let side = |from: f64, to: f64, off: f64, count: usize| -> Vec<[f64; 2]> {
        (0..=count)
            .map(|k| {
                let station = from + (to - from) * k as f64 / count as f64;
                // the normal of the centreline, from the middle of this piece where it ends at a
                // corner
                let inside =
                    (from + (to - from) * (k as f64).clamp(0.25, count as f64 - 0.25) / count as f64, 1e-4);
                let tangent = (rod.point(inside.0 + inside.1) - rod.point(inside.0 - inside.1)).normalize();
                let longer = match (count, k) {
                    (1, 1) if to < length => -off * mitre,
                    (1, 0) if from > 0.0 => off * mitre,
                    _ => 0.0,
                };
                let at = rod.point(station) + tangent * longer;
                [(at.x + tangent.z * off) / MM, (at.z - tangent.x * off) / MM]
            })
            .collect()
    };
    let mut lines = Vec::new();
    let pipes = [(0.0, start, &rod.pipe1, 1), (start, end, &rod.bend, POINTS), (end, length, &rod.pipe2, 1)];
    // in two pieces, so that no end is mitred
    let sleeves = rod.sleeves.iter().map(|sleeve| (sleeve.from, sleeve.to, &sleeve.pipe, 2));
    for (from, to, pipe, count) in pipes.into_iter().chain(sleeves) {
        if to - from > 1e-6 {
            let mut outline = side(from, to, half(pipe), count);
            let mut back = side(from, to, -half(pipe), count);
            back.reverse();
            outline.append(&mut back);
            outline.push(outline[0]);
            lines.push(outline);
        }
    }
    let tip = rod.tip();
    let ring = (0..=POINTS).map(|k| {
        let angle = std::f64::consts::TAU * k as f64 / POINTS as f64;
        [tip.x / MM + 15.0 * angle.cos(), tip.z / MM + 15.0 * angle.sin()]
    });
    lines.push(ring.collect());
    lines
}
