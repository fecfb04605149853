//! Estimates as dots on their confidence intervals, one row each: corrections of parameters, errors
//! of modes.

use serde::Serialize;

use super::super::super::chart::{Axis, Chart, Colour, Dash, Figure, Mark, Marker, Point, Range, Style};
use super::super::super::scale::{drawable, extent};

/// More rows than these would not fit onto a page.
const MOST_ROWS: usize = 60;
/// An axis goes on for this many times the largest estimate; what reaches further is cut.
const REACH: f64 = 2.0;

/// The correction of one parameter.
#[derive(Debug, Clone, Default, Serialize)]
pub struct ParameterCorrection {
    /// Name of the parameter.
    pub name: String,
    /// Estimate minus nominal value, in the unit of its panel.
    pub correction: f64,
    /// Ends of the 95 % interval in the same unit; `None` where the parameter is not identified.
    pub interval: Option<[f64; 2]>,
    /// Written beside a parameter that is not identified; empty says "not identified".
    pub note: String,
}

/// Corrections of lengths (mm) and of angles (µrad), one panel each. A parameter that is not
/// identified has an open marker, no interval and a note.
pub fn parameter_corrections(
    lengths_mm: &[ParameterCorrection],
    angles_urad: &[ParameterCorrection],
) -> Figure {
    let groups = [("lengths", "correction / mm", lengths_mm), ("angles", "correction / µrad", angles_urad)];
    let mut caption = String::from("Corrections of the nominal parameters with their 95 % intervals.");
    let row_px = row_px(lengths_mm.len().max(angles_urad.len()));
    let mut panels = Vec::new();
    for (title, label, parameters) in groups.into_iter().filter(|(_, _, parameters)| !parameters.is_empty()) {
        let row = |p: &ParameterCorrection| Row {
            name: p.name.clone(),
            value: p.correction,
            interval: p.interval,
            note: match p.interval {
                None if p.note.is_empty() => "not identified".into(),
                None => p.note.clone(),
                Some(_) => String::new(),
            },
        };
        let rows: Vec<Row> = parameters.iter().map(row).collect();
        panels.push(forest(title, label, "correction, 95 % interval", &rows, row_px, &mut caption));
    }
    let columns = panels.len().clamp(1, 2);
    Figure {
        name: "parameter-corrections".into(),
        caption,
        panels,
        columns,
        shared_legend: true,
        ..Figure::default()
    }
}

/// How one mode of calibration did on poses it had not seen.
#[derive(Debug, Clone, Default, Serialize)]
pub struct ModeComparison {
    /// Name of the mode.
    pub name: String,
    /// Mean validation error, mm.
    pub mean_mm: f64,
    /// Ends of its 95 % interval, mm.
    pub mean_interval_mm: Option<[f64; 2]>,
    /// Mean of the error at each pose minus that of the first mode at the same pose, mm; not read
    /// of the first.
    pub difference_mm: f64,
    /// Ends of the 95 % interval of the difference, mm.
    pub difference_interval_mm: Option<[f64; 2]>,
}

/// The mean validation error of each mode with its 95 % interval, and beside it the paired
/// difference to the first mode. Pairing takes out what is hard about a pose under every mode, so
/// an interval there that misses zero tells two modes apart even where those of the means overlap.
pub fn mode_comparison(modes: &[ModeComparison]) -> Figure {
    let mean = |m: &ModeComparison| Row {
        name: m.name.clone(),
        value: m.mean_mm,
        interval: m.mean_interval_mm,
        note: String::new(),
    };
    let difference = |(i, m): (usize, &ModeComparison)| match i {
        0 => Row { value: 0.0, note: "reference".into(), ..Row::default() },
        _ => Row { value: m.difference_mm, interval: m.difference_interval_mm, ..Row::default() },
    };
    let means: Vec<Row> = modes.iter().map(mean).collect();
    let differences: Vec<Row> = modes.iter().enumerate().map(difference).collect();
    let mut caption = String::from(
        "Mean validation error of each mode, and its difference to the first mode, pose by pose, with 95 % intervals.",
    );
    let row_px = row_px(modes.len());
    let legend = "mean, 95 % interval";
    let mut panels = vec![forest("validation", "mean error / mm", legend, &means, row_px, &mut caption)];
    if modes.len() > 1 {
        let first = format!("difference to {}", modes[0].name);
        panels.push(forest(&first, "difference / mm", legend, &differences, row_px, &mut caption));
    }
    let columns = panels.len();
    Figure {
        name: "mode-comparison".into(),
        caption,
        panels,
        columns,
        shared_legend: true,
        ..Figure::default()
    }
}

/// One row of a forest plot.
#[derive(Debug, Clone, Default)]
struct Row {
    name: String,
    value: f64,
    interval: Option<[f64; 2]>,
    /// Written beside the dot, which it opens; may be empty.
    note: String,
}

impl Row {
    /// The ends of the interval in their order, if both are known.
    fn ends(&self) -> Option<[f64; 2]> {
        let ends = self.interval.filter(|ends| ends.iter().all(|end| drawable(*end)));
        ends.map(|[a, b]| [a.min(b), a.max(b)])
    }
}

/// Height of a row: many stand closer.
fn row_px(rows: usize) -> f64 {
    if rows > 15 { 17.0 } else { 26.0 }
}

/// Dots on intervals, row below row, over a line at zero. Adds to the caption what is not seen.
fn forest(
    title: &str,
    x_label: &str,
    legend: &str,
    rows: &[Row],
    row_px: f64,
    caption: &mut String,
) -> Chart {
    let shown = &rows[..rows.len().min(MOST_ROWS)];
    if rows.len() > shown.len() {
        *caption += &format!(" Only the first {MOST_ROWS} of {} {title} are shown.", rows.len());
    }
    let mut chart = Chart::new(title, x_label, "");
    // Below zero, for zero would be drawn as the axis of a quantity.
    let y = |i: usize| -1.0 - i as f64;
    let names = shown.iter().enumerate().map(|(i, row)| (y(i), row.name.clone())).collect();
    chart.y = Axis { names, ..Axis::default() };
    chart.height_px = Some(row_px * shown.len() as f64 + 10.0);

    let (low, high) = reach(shown);
    chart.x.range = Range::Fixed(low, high);
    let beyond = |v: f64| v < low || v > high;
    if shown.iter().filter_map(Row::ends).flatten().any(beyond) {
        *caption += &format!(" Intervals that reach an edge of \u{201c}{title}\u{201d} go on beyond it.");
    }
    // Not a number between two intervals: nothing joins them.
    let interval = |(i, row): (usize, &Row)| {
        row.ends().map_or(Vec::new(), |[a, b]| vec![[a, y(i)], [b, y(i)], [f64::NAN, f64::NAN]])
    };
    let dots = |open: bool| -> Vec<Point> {
        let rows = shown.iter().enumerate().filter(|(_, row)| row.note.is_empty() != open);
        let drawn = rows.filter(|(_, row)| drawable(row.value));
        drawn.map(|(i, row)| Point { x: row.value.clamp(low, high), y: y(i), error: 0.0 }).collect()
    };
    let style = Style::nth(0).colour(Colour::Blue).dash(Dash::Solid).width(2.4);
    if !shown.is_empty() {
        chart.marks.push(Mark::Vertical { at: 0.0, text: String::new() });
    }
    chart.marks.push(Mark::Line {
        label: legend.into(),
        points: shown.iter().enumerate().flat_map(interval).collect(),
        style,
    });
    let filled = style.marker(Marker::Circle).size(3.0);
    chart.marks.push(Mark::Points { label: legend.into(), points: dots(false), style: filled });
    let open = style.marker(Marker::Ring).size(1.6);
    chart.marks.push(Mark::Points { label: String::new(), points: dots(true), style: open });
    for (i, row) in shown.iter().enumerate().filter(|(_, row)| !row.note.is_empty()) {
        let x = if drawable(row.value) { row.value.clamp(low, high) } else { 0.0 };
        chart.marks.push(Mark::Note { at: [x, y(i)], text: row.note.clone() });
    }
    chart
}

/// What the axis spans: zero, all estimates, and their intervals unless one of them is so long that
/// it would flatten the rest.
fn reach(rows: &[Row]) -> (f64, f64) {
    let with_interval = || rows.iter().filter(|row| drawable(row.value) && row.ends().is_some());
    let mut halves: Vec<f64> =
        with_interval().filter_map(Row::ends).map(|[a, b]| 0.5 * b - 0.5 * a).collect();
    halves.sort_by(f64::total_cmp);
    let typical = halves.get(halves.len() / 2).copied().unwrap_or(0.0);
    let largest = with_interval().map(|row| row.value.abs()).fold(typical, f64::max);
    let limit = if largest > 0.0 { REACH * largest } else { f64::INFINITY };
    let values = rows.iter().map(|row| row.value).chain(rows.iter().filter_map(Row::ends).flatten());
    let within = values.filter(|v| drawable(*v)).map(|v| v.clamp(-limit, limit));
    let (low, high) = extent(within.chain([0.0])).unwrap_or((0.0, 0.0));
    if high <= low {
        return (-1.0, 1.0);
    }
    let air = 0.05 * (high - low);
    (if low < 0.0 { low - air } else { -air }, if high > 0.0 { high + air } else { air })
}

#[cfg(test)]
mod tests {
    use super::*;

    fn parameter(name: &str, correction: f64, half: f64) -> ParameterCorrection {
        let interval = half.is_finite().then_some([correction - half, correction + half]);
        ParameterCorrection { name: name.into(), correction, interval, note: String::new() }
    }

    fn dots(chart: &Chart) -> Vec<usize> {
        let count = |mark: &Mark| match mark {
            Mark::Points { points, .. } => Some(points.len()),
            _ => None,
        };
        chart.marks.iter().filter_map(count).collect()
    }

    #[test]
    fn a_parameter_that_is_not_identified_is_open_and_says_so() {
        let lengths = [parameter("a1", 0.12, 0.03), parameter("d2", -0.4, f64::NAN)];
        let figure = parameter_corrections(&lengths, &[parameter("α1", 0.2, 0.1)]);
        assert_eq!(figure.panels.iter().map(dots).collect::<Vec<_>>(), [[1, 1], [1, 0]]);
        let svg = figure.svg();
        for text in ["correction / µm", "correction / µrad", "not identified", "a1", "α1", "95 % interval"]
        {
            assert!(svg.contains(text), "{text}\n{svg}");
        }
    }

    #[test]
    fn one_endless_interval_does_not_flatten_the_rest() {
        let lengths = [parameter("a1", 0.1, 0.03), parameter("a2", 0.2, 0.03), parameter("a3", 0.1, 900.0)];
        let figure = parameter_corrections(&lengths, &[]);
        let Range::Fixed(low, high) = figure.panels[0].x.range else { panic!("not fixed") };
        assert!(high < 1.0 && low > -1.0 && figure.caption.contains("go on beyond"), "{low} {high}");
    }

    #[test]
    fn modes_are_compared_with_the_first() {
        let mode = |name: &str, mean_mm: f64, difference_mm: f64| ModeComparison {
            name: name.into(),
            mean_mm,
            mean_interval_mm: Some([mean_mm - 0.01, mean_mm + 0.01]),
            difference_mm,
            difference_interval_mm: Some([difference_mm - 0.002, difference_mm + 0.002]),
        };
        let figure = mode_comparison(&[mode("rigid", 0.12, f64::NAN), mode("FEA", 0.09, -0.03)]);
        assert_eq!(figure.panels.iter().map(dots).collect::<Vec<_>>(), [[2, 0], [1, 1]]);
        let svg = figure.svg();
        for text in ["mean error / µm", "difference / µm", "difference to rigid", "reference", "FEA"] {
            assert!(svg.contains(text), "{text}\n{svg}");
        }
    }

    #[test]
    fn degenerate_rows_draw() {
        for (value, half) in
            [(0.0, 0.0), (1.0, 0.0), (f64::NAN, 1.0), (1e190, 1.0), (1e-12, 1e12), (0.0, f64::NAN)]
        {
            let rows = vec![parameter("a", value, half), parameter("b", 1.0, 1.0)];
            for rows in [&rows[..1], &rows] {
                assert!(!parameter_corrections(rows, rows).svg().contains("NaN"));
            }
        }
        assert!(
            parameter_corrections(&vec![parameter("a", 1.0, 1.0); 1000], &[]).caption.contains("60 of 1000")
        );
        parameter_corrections(&[], &[]).svg();
        mode_comparison(&[]).svg();
        mode_comparison(&[ModeComparison { mean_mm: f64::NAN, ..ModeComparison::default() }]).svg();
    }
}
