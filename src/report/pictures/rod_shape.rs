//! The rod from the side and from above, to scale, at rest and bent, with what is mounted on it.

mod outline;
#[cfg(test)]
mod tests;

use serde::Serialize;

use super::super::chart::{Chart, Colour, Dash, Figure, Mark, Marker, Point, Range, Style};
use super::super::scale::{drawable, extent, one_two_five_below, typeset};
use crate::units::{MM, UM, significant};
use outline::Outline;

/// A rod and how it bends. Coordinates are X, Y, Z of the flange frame, its origin at the flange.
#[derive(Debug, Clone, Default, Serialize)]
pub struct RodShape {
    /// Which rod.
    pub title: String,
    /// Points of the undeformed centreline, from the flange to the tip, mm.
    pub centreline_mm: Vec<[f64; 3]>,
    /// The tubes around the centreline; without any it is drawn as a line.
    pub tubes: Vec<Tube>,
    /// The load cases to draw.
    pub cases: Vec<ShapeCase>,
    /// Places to mark.
    pub stations: Vec<Station>,
    /// Stretches of the rod to mark, for example where a joint may be.
    pub stretches: Vec<Stretch>,
    /// How much deflections are exaggerated; `None` chooses a 1-2-5 number.
    pub exaggeration: Option<f64>,
}

/// The deflections under one load case.
#[derive(Debug, Clone, Default, Serialize)]
pub struct ShapeCase {
    /// The load, for example "gravity along −Z" or "1 N along Y at the tip".
    pub label: String,
    /// Deflection of each point of the centreline, µm.
    pub deflection_um: Vec<[f64; 3]>,
}

/// A part of the rod, cut open along its length. Sizes are in the rod's plane and across it.
#[derive(Debug, Clone, Default, Serialize)]
pub struct Tube {
    /// Written beside it, for example "pipe I, Ø 32 × 1 mm".
    pub label: String,
    /// Where it begins, mm along the centreline.
    pub from_mm: f64,
    /// Where it ends, mm along the centreline.
    pub to_mm: f64,
    /// Outer sizes, mm.
    pub outer_mm: [f64; 2],
    /// Inner sizes, mm; 0 for what is solid.
    pub inner_mm: [f64; 2],
    /// True of a sleeve: what is inside it is drawn by itself.
    pub is_sleeve: bool,
}

/// A stretch of the rod that is marked.
#[derive(Debug, Clone, Default, Serialize)]
pub struct Stretch {
    /// Name in the legend.
    pub label: String,
    /// Points of the centreline along it, mm.
    pub points_mm: Vec<[f64; 3]>,
}

/// A place on the rod that is marked.
#[derive(Debug, Clone, Serialize)]
pub struct Station {
    /// Written beside it in the side view; may be empty.
    pub label: String,
    /// Where, mm.
    pub at_mm: [f64; 3],
    /// What is there.
    pub kind: StationKind,
}

/// What a marked station is.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize)]
pub enum StationKind {
    /// A mass that is not part of the tube, for example a tip.
    Mass,
    /// A joint or sleeve.
    Joint,
    /// Where the rig pulls.
    Load,
    /// Where the gauge reads.
    Reading,
    /// Where a mismatch was located; ringed in both views.
    Located,
}

/// What ends this close to the tip ends there, mm.
const END_MM: f64 = 1e-3;
/// What the drawing's sizes are worth.
const TO_SCALE: &str = "Tubes and walls are to scale, cut open along the centreline. Masses, joints, tip and clamp are \
     symbols at their places, because the rod file gives no sizes of them.";

/// Side view (X–Z) and top view (X–Y), the latter seen against Z, to the same scale. A case is
/// drawn only in the views in which it moves anything; deflections are exaggerated as the title
/// says.
pub fn rod_shape(rod: &RodShape) -> Figure {
    let factor = rod.exaggeration.filter(|f| drawable(*f)).unwrap_or_else(|| exaggeration(rod));
    let views = [("side view", "Z", 2), ("view from above", "Y", 1)];
    let mut panels: Vec<Chart> = views.map(|(view, name, axis)| chart(rod, factor, view, name, axis)).into();
    // Both views span the same X, so that they stand below one another point by point.
    let range = extent(panels.iter().flat_map(|c| &c.marks).flat_map(|mark| match mark {
        Mark::Line { points, .. } | Mark::Area { corners: points, .. } => {
            points.iter().map(|p| p[0]).collect()
        }
        _ => Vec::new(),
    }));
    if let Some((low, high)) = range {
        panels.iter_mut().for_each(|c| c.x.range = Range::Fixed(low, high));
    }
    // An upright rod leaves room beside it.
    let upright = extent_mm(rod, 2) > extent_mm(rod, 0);
    let columns = if upright { 2 } else { 1 };
    let caption = if rod.tubes.is_empty() { String::new() } else { TO_SCALE.into() };
    Figure { name: "rod-shape".into(), caption, panels, columns, shared_legend: true, ..Figure::default() }
}

/// The 1-2-5 factor with which the largest deflection becomes at most a fifth of the rod's size.
fn exaggeration(rod: &RodShape) -> f64 {
    let all = rod.cases.iter().flat_map(|c| c.deflection_um.iter().flatten());
    let largest_um = extent(all.map(|d| d.abs())).map_or(0.0, |(_, high)| high);
    one_two_five_below(0.2 * size_mm(rod) * MM / (largest_um * UM))
}

/// The largest of the rod's extents along X, Y and Z, mm.
fn size_mm(rod: &RodShape) -> f64 {
    extent_mm(rod, 0).max(extent_mm(rod, 1)).max(extent_mm(rod, 2))
}

/// How far the rod reaches along one axis, mm.
fn extent_mm(rod: &RodShape, axis: usize) -> f64 {
    extent(rod.centreline_mm.iter().map(|p| p[axis])).map_or(0.0, |(low, high)| high - low)
}

fn chart(rod: &RodShape, factor: f64, view: &str, name: &str, axis: usize) -> Chart {
    let scale = if rod.cases.is_empty() {
        String::new()
    } else {
        format!(", deflection ×\u{a0}{}", typeset(&significant(factor, 1)))
    };
    let title =
        [rod.title.as_str(), view].into_iter().filter(|t| !t.is_empty()).collect::<Vec<_>>().join(", ");
    let mut chart = Chart::new(format!("{title}{scale}"), "X / mm", format!("{name} / mm"));
    chart.equal_aspect = true;
    let seen = |p: &[f64; 3]| [p[0], p[axis]];
    let stations = lengths(&rod.centreline_mm);
    let undeformed = Outline::new(rod.centreline_mm.iter().map(seen).collect(), &stations);
    match rod.tubes.is_empty() {
        true => chart.marks.push(Mark::Line {
            label: "undeformed".into(),
            points: rod.centreline_mm.iter().map(seen).collect(),
            style: Style::nth(0).colour(Colour::Grey).dash(Dash::Solid).width(4.0),
        }),
        false => {
            rod.tubes.iter().for_each(|tube| chart.marks.extend(cut_open(tube, &undeformed, axis)));
        }
    }
    for stretch in &rod.stretches {
        chart.marks.push(Mark::Line {
            label: stretch.label.clone(),
            points: stretch.points_mm.iter().map(seen).collect(),
            style: Style::nth(0).colour(Colour::Vermilion).dash(Dash::Solid).width(9.0),
        });
    }
    for (i, case) in rod.cases.iter().enumerate() {
        let bent = |(p, d): (&[f64; 3], &[f64; 3])| {
            let shown = |i: usize| p[i] + factor * d[i] * UM / MM;
            [shown(0), shown(axis)]
        };
        let points = rod.centreline_mm.iter().zip(&case.deflection_um).map(bent);
        // Without points it still stands in the legend, so that the legend keeps the order of the
        // cases.
        let points: Vec<_> = if moves(rod, case, axis) { points.collect() } else { Vec::new() };
        let deformed = undeformed.moved(points.clone());
        for tube in rod.tubes.iter().filter(|_| !points.is_empty()) {
            if undeformed.end_on(tube.from_mm, tube.to_mm).is_some() {
                continue;
            }
            let [right, mut left] =
                deformed.edges(tube.from_mm, tube.to_mm, -half(tube, axis), half(tube, axis));
            // the tip closes the last tube
            if stations.last().is_some_and(|end| *end <= tube.to_mm + END_MM) {
                left.extend(right.last().copied());
            }
            for points in [left, right] {
                let style = Style::nth(i).dash(Dash::Solid).width(0.7);
                chart.marks.push(Mark::Line { label: String::new(), points, style });
            }
        }
        chart.marks.push(Mark::Line { label: case.label.clone(), points, style: Style::nth(i) });
    }
    if axis == 2 && !rod.centreline_mm.is_empty() {
        let half_mm = rod.tubes.first().map_or(0.03 * size_mm(rod), |tube| 1.2 * half(tube, axis));
        chart.marks.extend(clamp(half_mm));
        chart.marks.push(Mark::Note { at: [half_mm, 0.0], text: "clamped at the flange".into() });
        for tube in rod.tubes.iter().filter(|tube| !tube.label.is_empty()) {
            let middle = 0.5 * (tube.from_mm + tube.to_mm);
            // below a horizontal pipe
            let [right, _] = undeformed.edges(tube.from_mm, middle, -half(tube, axis), 0.0);
            if let Some(at) = right.last() {
                chart.marks.push(Mark::Note { at: *at, text: tube.label.clone() });
            }
        }
    }
    for station in &rod.stations {
        let (label, style) = look(station.kind);
        let [x, y] = seen(&station.at_mm);
        match collar(rod, station, &undeformed, &stations, axis) {
            Some(points) => chart.marks.push(Mark::Line { label: label.into(), points, style }),
            None => chart.marks.push(Mark::Points {
                label: label.into(),
                points: vec![Point { x, y, error: 0.0 }],
                style,
            }),
        }
        // From above, stations on the upright part hide each other: the side view names them.
        if axis == 2 || station.kind == StationKind::Located {
            chart.marks.push(Mark::Note { at: [x, y], text: station.label.clone() });
        }
    }
    chart
}

/// Half of what a tube measures in a view, mm.
fn half(tube: &Tube, axis: usize) -> f64 {
    0.5 * tube.outer_mm[usize::from(axis == 1)]
}

/// Arc length at each point of a line, mm.
fn lengths(points: &[[f64; 3]]) -> Vec<f64> {
    let mut at = 0.0;
    let step = |pair: &[[f64; 3]]| {
        at += (0..3).map(|i| (pair[1][i] - pair[0][i]).powi(2)).sum::<f64>().sqrt();
        at
    };
    let first = (!points.is_empty()).then_some(0.0);
    first.into_iter().chain(points.windows(2).map(step)).collect()
}

/// Walls and bore of a tube; seen end on, its section.
fn cut_open(tube: &Tube, line: &Outline, axis: usize) -> Vec<Mark> {
    let wall = Style::nth(0).colour(Colour::Grey).dash(Dash::Solid).width(0.6);
    let bore = Style::nth(0).colour(Colour::Grey).dash(Dash::Dashed).width(0.4);
    let (outer, inner) = (half(tube, axis), 0.5 * tube.inner_mm[usize::from(axis == 1)]);
    let area =
        |label: &str, corners: Vec<[f64; 2]>, style| Mark::Area { label: label.into(), corners, style };
    if let Some(centre) = line.end_on(tube.from_mm, tube.to_mm) {
        let halves = |sizes: [f64; 2]| sizes.map(|size| 0.5 * size);
        let mut marks = vec![area("wall", ring(centre, halves(tube.outer_mm)), wall)];
        if inner > 0.0 && !tube.is_sleeve {
            marks.push(area("", ring(centre, halves(tube.inner_mm)), bore));
        }
        return marks;
    }
    let strip = |right: f64, left: f64| line.strip(tube.from_mm, tube.to_mm, right, left);
    if inner <= 0.0 {
        return vec![area("wall", strip(-outer, outer), wall)];
    }
    let bore = (!tube.is_sleeve).then(|| area("bore", strip(-inner, inner), bore));
    let walls = [area("wall", strip(inner, outer), wall), area("wall", strip(-outer, -inner), wall)];
    bore.into_iter().chain(walls).collect()
}

/// Points around a centre, at these half axes.
fn ring(centre: [f64; 2], half: [f64; 2]) -> Vec<[f64; 2]> {
    const POINTS: usize = 48;
    let at = |k: usize| {
        let (sin, cos) = (k as f64 / POINTS as f64 * std::f64::consts::TAU).sin_cos();
        [centre[0] + half[0] * cos, centre[1] + half[1] * sin]
    };
    (0..POINTS).map(at).collect()
}

/// The rod ends here: the ground's hatching below a thick line, half as wide as `half_mm`.
fn clamp(half_mm: f64) -> Vec<Mark> {
    const STROKES: usize = 7;
    let line = |points: Vec<[f64; 2]>, width: f64| Mark::Line {
        label: String::new(),
        points,
        style: Style::nth(0).width(width),
    };
    let step = 2.0 * half_mm / STROKES as f64;
    let stroke = |k: usize| {
        let x = -half_mm + (k as f64 + 1.0) * step;
        line(vec![[x, 0.0], [x - step, -1.5 * step]], 0.9)
    };
    std::iter::once(line(vec![[-half_mm, 0.0], [half_mm, 0.0]], 2.5))
        .chain((0..STROKES).map(stroke))
        .collect()
}

/// A sleeve or a joint as a collar around the tube that is there; `None` for what is not drawn as
/// one.
fn collar(
    rod: &RodShape,
    station: &Station,
    line: &Outline,
    stations: &[f64],
    axis: usize,
) -> Option<Vec<[f64; 2]>> {
    let (long, thick) = match station.kind {
        StationKind::Mass => (0.5, 1.35),
        StationKind::Joint => (0.25, 1.2),
        _ => return None,
    };
    let far = |p: &[f64; 3]| (0..3).map(|i| (p[i] - station.at_mm[i]).powi(2)).sum::<f64>();
    let nearest = (0..rod.centreline_mm.len())
        .min_by(|&a, &b| far(&rod.centreline_mm[a]).total_cmp(&far(&rod.centreline_mm[b])))?;
    let (at, end) = (*stations.get(nearest)?, *stations.last()?);
    let tube = rod.tubes.iter().find(|tube| tube.from_mm <= at && at <= tube.to_mm)?;
    let half = half(tube, axis);
    // the ball at the tip is none
    if end - at < half {
        return None;
    }
    let (from, to) = ((at - long * half).max(0.0), (at + long * half).min(end));
    let mut outline = match line.turns(from, to) {
        // around a sharp corner it would cross itself
        Some(corner) => ring(corner, [thick * half; 2]),
        None => line.strip(from, to, -thick * half, thick * half),
    };
    outline.extend(outline.first().copied());
    (!outline.is_empty()).then_some(outline)
}

/// Whether a case moves the rod across itself in the view whose second axis is `axis`. Motion along
/// the rod, or of a part that is seen end on, would only draw one line onto another.
fn moves(rod: &RodShape, case: &ShapeCase, axis: usize) -> bool {
    let finite_max = |values: &mut dyn Iterator<Item = f64>| extent(values).map_or(0.0, |(_, high)| high);
    let line = &rod.centreline_mm;
    let seen_mm = |i: usize| [line[i][0] - line[i - 1][0], line[i][axis] - line[i - 1][axis]];
    let points = line.len().min(case.deflection_um.len());
    let end_on = (1..points).all(|i| f64::hypot(seen_mm(i)[0], seen_mm(i)[1]) < 1e-6);
    let across = |i: usize| {
        let ([tx, ty], d) = (seen_mm(i), case.deflection_um[i]);
        let length = f64::hypot(tx, ty);
        match (end_on, length > 1e-6) {
            (true, _) => f64::hypot(d[0], d[axis]),
            (false, true) => (tx * d[axis] - ty * d[0]).abs() / length,
            (false, false) => 0.0,
        }
    };
    let all = finite_max(&mut case.deflection_um.iter().flatten().map(|d| d.abs()));
    finite_max(&mut (1..points).map(across)) > 0.02 * all
}

fn look(kind: StationKind) -> (&'static str, Style) {
    let style = Style::nth(0);
    match kind {
        StationKind::Mass => ("mass", style.marker(Marker::Circle).dash(Dash::Solid).width(1.4)),
        StationKind::Joint => {
            ("joint", style.marker(Marker::Square).colour(Colour::Orange).dash(Dash::Dashed).width(2.0))
        }
        // larger than the gauge that may stand at the same place
        StationKind::Load => ("load", style.marker(Marker::Triangle).colour(Colour::Blue).size(8.0)),
        StationKind::Reading => ("gauge", style.marker(Marker::Diamond).colour(Colour::Green)),
        StationKind::Located => ("located mismatch", style.marker(Marker::Ring).colour(Colour::Vermilion)),
    }
}
