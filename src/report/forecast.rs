//! What a forecast says: its parts as JSON, as a table and stacked.

use serde_json::{Map, Value, json};

use super::chart::{Axis, Bar, Chart, Colour, Dash, Direction, Figure, Mark, Range, Style};
use super::table::{Column, Table};
use crate::design::{Forecast, Part};
use crate::units::{UM, significant};

/// `mean`, `p95`, `rms`, the interval of the mean and the parts.
pub fn json(forecast: &Forecast) -> Value {
    let parts: Map<String, Value> = Part::ALL
        .into_iter()
        .map(|part| (part.key().to_owned(), json!(forecast.parts[part as usize] / UM)))
        .collect();
    json!({
        "mode": forecast.mode.name(),
        "mean": forecast.mean / UM,
        "p95": forecast.p95 / UM,
        "rms": forecast.rms / UM,
        "mean_interval": forecast.interval.map(|bound| bound / UM),
        "parts": parts,
    })
}

/// The parts that any of these forecasts has.
fn parts(all: &[(String, &Forecast)]) -> Vec<Part> {
    let has = |part: &Part| all.iter().any(|(_, forecast)| forecast.parts[*part as usize] > 1e-9);
    Part::ALL.into_iter().filter(has).collect()
}

/// Forecasts with their names, one per row.
pub fn table(name: &str, first: &str, all: &[(String, &Forecast)]) -> Table {
    let mut columns = vec![Column::text(first)];
    columns.extend(["mean", "95 %", "rms"].map(|name| Column::number(name, "µm")));
    columns.extend(parts(all).into_iter().map(|part| Column::number(part.words(), "µm")));
    let caption = "Error of the tip at unseen poses. Mean: in brackets the interval that the mean of one campaign lies in with \
                   95 %. 95 %: all but one pose in twenty are better. Then the root mean square, and that of each part alone: \
                   their squares add up.";
    let mut table = Table::new(name, caption, columns);
    for (name, forecast) in all {
        let um = |size: f64| significant(size / UM, 3);
        let [low, high] = forecast.interval;
        let mut cells = vec![
            name.clone(),
            format!("{} ({} to {})", um(forecast.mean), um(low), um(high)),
            um(forecast.p95),
            um(forecast.rms),
        ];
        cells.extend(parts(all).into_iter().map(|part| um(forecast.parts[part as usize])));
        table.row(cells);
    }
    table
}

/// The root mean square of each forecast, divided by what its parts have of the mean square.
pub fn stacked(all: &[(String, &Forecast)]) -> Figure {
    const COLOURS: [(Colour, Dash); 7] = [
        (Colour::Blue, Dash::Solid),
        (Colour::SkyBlue, Dash::Dashed),
        (Colour::Green, Dash::DashDot),
        (Colour::Vermilion, Dash::Solid),
        (Colour::Orange, Dash::Dashed),
        (Colour::Grey, Dash::Solid),
        (Colour::Purple, Dash::Dotted),
    ];
    let mut chart = Chart::new("", "", "root mean square error / µm");
    let at = |k: usize| k as f64;
    chart.x = Axis {
        names: all.iter().enumerate().map(|(k, (name, _))| (at(k), name.clone())).collect(),
        range: Range::Fixed(-0.6, all.len() as f64 - 0.4),
        ..Axis::default()
    };
    chart.y.range = Range::AutoWithZero;
    let shown = parts(all);
    // from the top down: what is drawn later stands in front
    for (place, part) in shown.iter().enumerate().rev() {
        let bar = |(k, (_, forecast)): (usize, &(String, &Forecast))| {
            let below: f64 = shown[..=place].iter().map(|part| forecast.parts[*part as usize].powi(2)).sum();
            let is_whole = place + 1 == shown.len();
            Bar {
                from: at(k) - 0.3,
                to: at(k) + 0.3,
                value: if forecast.rms > 0.0 { below / forecast.rms / UM } else { 0.0 },
                text: if is_whole { significant(forecast.rms / UM, 3) } else { String::new() },
            }
        };
        let (colour, dash) = COLOURS[*part as usize];
        chart.marks.push(Mark::Bars {
            label: part.words().into(),
            bars: all.iter().enumerate().map(bar).collect(),
            direction: Direction::Up,
            style: Style::nth(0).colour(colour).dash(dash),
        });
    }
    Figure::from(chart).named("error-budget").captioned(
        "Root mean square of the tip's error at unseen poses. Each part is as high as its share of the mean square.",
    )
}
