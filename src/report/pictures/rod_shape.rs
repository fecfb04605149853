//! The rod from the side and from above, at rest and bent, with what is mounted on it.

use serde::Serialize;

use super::super::chart::{Chart, Colour, Dash, Figure, Mark, Marker, Point, Range, Style};
use super::super::scale::{drawable, extent, one_two_five_below, typeset};
use crate::units::{MM, UM, significant};

/// A rod and how it bends. Coordinates are X, Y, Z of the flange frame, its origin at the flange.
#[derive(Debug, Clone, Default, Serialize)]
pub struct RodShape {
    /// Which rod.
    pub title: String,
    /// Points of the undeformed centreline, from the flange to the tip, mm.
    pub centreline_mm: Vec<[f64; 3]>,
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

/// Side view (X–Z) and top view (X–Y), the latter seen against Z, to the same scale. A case is
/// drawn only in the views in which it moves anything; deflections are exaggerated as the title
/// says.
pub fn rod_shape(rod: &RodShape) -> Figure {
    let factor = rod.exaggeration.filter(|f| drawable(*f)).unwrap_or_else(|| exaggeration(rod));
    let views = [("side view", "Z", 2), ("view from above", "Y", 1)];
    let mut panels: Vec<Chart> = views.map(|(view, name, axis)| chart(rod, factor, view, name, axis)).into();
    // Both views span the same X, so that they stand below one another point by point.
    let range = extent(panels.iter().flat_map(|c| &c.marks).flat_map(|mark| match mark {
        Mark::Line { points, .. } => points.iter().map(|p| p[0]).collect(),
        _ => Vec::new(),
    }));
    if let Some((low, high)) = range {
        panels.iter_mut().for_each(|c| c.x.range = Range::Fixed(low, high));
    }
    // An upright rod leaves room beside it.
    let upright = extent_mm(rod, 2) > extent_mm(rod, 0);
    let columns = if upright { 2 } else { 1 };
    Figure { name: "rod-shape".into(), panels, columns, shared_legend: true, ..Figure::default() }
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
    chart.marks.push(Mark::Line {
        label: "undeformed".into(),
        points: rod.centreline_mm.iter().map(seen).collect(),
        style: Style::nth(0).colour(Colour::Grey).dash(Dash::Solid).width(4.0),
    });
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
        let points = if moves(rod, case, axis) { points.collect() } else { Vec::new() };
        chart.marks.push(Mark::Line { label: case.label.clone(), points, style: Style::nth(i) });
    }
    if axis == 2 && !rod.centreline_mm.is_empty() {
        let half_mm = 0.03 * size_mm(rod);
        chart.marks.push(Mark::Line {
            label: String::new(),
            points: vec![[-half_mm, 0.0], [half_mm, 0.0]],
            style: Style::nth(0).width(5.0),
        });
        chart.marks.push(Mark::Note { at: [half_mm, 0.0], text: "flange".into() });
    }
    for station in &rod.stations {
        let (label, style) = look(station.kind);
        let [x, y] = seen(&station.at_mm);
        chart.marks.push(Mark::Points {
            label: label.into(),
            points: vec![Point { x, y, error: 0.0 }],
            style,
        });
        // From above, stations on the upright part hide each other: the side view names them.
        if axis == 2 || station.kind == StationKind::Located {
            chart.marks.push(Mark::Note { at: [x, y], text: station.label.clone() });
        }
    }
    chart
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
        StationKind::Mass => ("mass", style.marker(Marker::Circle)),
        StationKind::Joint => ("joint or sleeve", style.marker(Marker::Square)),
        StationKind::Load => ("load", style.marker(Marker::Triangle).colour(Colour::Blue)),
        StationKind::Reading => ("gauge", style.marker(Marker::Diamond).colour(Colour::Green)),
        StationKind::Located => ("located mismatch", style.marker(Marker::Ring).colour(Colour::Vermilion)),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn bent_rod() -> RodShape {
        RodShape {
            centreline_mm: vec![[0.0; 3], [0.0, 0.0, 150.0], [525.0, 0.0, 150.0]],
            cases: vec![ShapeCase {
                label: "1 N along Y".into(),
                deflection_um: vec![[0.0; 3], [0.0, 1.0, 0.0], [0.0, 33.0, 0.0]],
            }],
            ..RodShape::default()
        }
    }

    #[test]
    fn the_scale_is_in_the_title_and_a_case_only_where_it_moves_something() {
        let figure = rod_shape(&bent_rod());
        assert_eq!(figure.panels[1].title, "view from above, deflection ×\u{a0}2000");
        let drawn = |panel: &Chart| {
            panel
                .marks
                .iter()
                .filter(|m| matches!(m, Mark::Line { points, .. } if !points.is_empty()))
                .count()
        };
        assert_eq!(figure.panels.iter().map(drawn).collect::<Vec<_>>(), [2, 2]);
    }

    #[test]
    fn a_located_mismatch_is_named_in_both_views() {
        let mut rod = bent_rod();
        let at_mm = [0.0, 0.0, 150.0];
        rod.stations.push(Station { label: "bend".into(), at_mm, kind: StationKind::Located });
        assert_eq!(rod_shape(&rod).svg().matches(">\nbend\n").count(), 2);
    }

    #[test]
    fn a_rod_of_nothing_draws() {
        rod_shape(&RodShape::default()).svg();
        let centreline_mm = vec![[f64::NAN; 3], [0.0; 3]];
        rod_shape(&RodShape { centreline_mm, exaggeration: Some(f64::INFINITY), ..bent_rod() }).svg();
    }
}
