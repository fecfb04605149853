//! A law over its variable: data, a smooth curve, the law, and the law where nothing was recorded.

use serde::Serialize;

use super::super::super::chart::{Chart, Colour, Dash, Figure, Mark, Marker, Point, Style};

/// One direction of a law; coordinates in the units of the labels.
#[derive(Debug, Clone, Default, Serialize)]
pub struct LawPanel {
    /// Its name; nothing where there is one only.
    pub title: String,
    /// Label of the variable, with its unit.
    pub x: String,
    /// Label of the result, with its unit.
    pub y: String,
    /// What the data say.
    pub data: Vec<[f64; 2]>,
    /// A smooth curve through them.
    pub curve: Vec<[f64; 2]>,
    /// The law.
    pub law: Vec<[f64; 2]>,
    /// The law beyond the data.
    pub extrapolated: Vec<[f64; 2]>,
}

/// Most panels side by side.
const COLUMNS: usize = 2;

/// All directions of a law; `noun` is what the data are called.
pub fn law_picture(panels: &[LawPanel], name: &str, noun: &str) -> Figure {
    let chart = |panel: &LawPanel| {
        let line = |label: &str, points: &[[f64; 2]], dash: Dash, colour: Colour| Mark::Line {
            label: label.into(),
            points: points.to_vec(),
            style: Style::nth(0).dash(dash).colour(colour),
        };
        let points = panel.data.iter().map(|&[x, y]| Point { x, y, error: 0.0 }).collect();
        let style = Style::nth(0).colour(Colour::Grey).marker(Marker::Dot);
        let mut chart = Chart::new(panel.title.clone(), panel.x.clone(), panel.y.clone());
        chart = chart.with(Mark::Points { label: noun.into(), points, style });
        if !panel.curve.is_empty() {
            chart = chart.with(line("smooth curve", &panel.curve, Dash::Dashed, Colour::Blue));
        }
        chart.with(line("law", &panel.law, Dash::Solid, Colour::Vermilion)).with(line(
            "law, extrapolated",
            &panel.extrapolated,
            Dash::Dotted,
            Colour::Vermilion,
        ))
    };
    let figure = Figure {
        panels: panels.iter().map(chart).collect(),
        columns: panels.len().min(COLUMNS),
        shared_legend: panels.len() > 1,
        ..Figure::default()
    };
    figure.named(name)
}
