//! Residuals, component by component, against whatever they may depend on.

use serde::Serialize;

use super::super::super::chart::{Chart, Figure, Mark, Marker, Point, Range, Style};
use super::super::super::scale::{drawable, extent};
use super::MOST_POINTS;

/// Panels side by side.
const COLUMNS: usize = 3;
const HEIGHT_PX: f64 = 120.0;
/// Poses of which a mean is drawn: fewer of them scatter too much.
const LEAST_IN_BIN: usize = 6;
const MOST_BINS: usize = 10;
const AXES: [&str; 3] = ["x", "y", "z"];

/// Something that the residuals may depend on.
#[derive(Debug, Clone, Default, Serialize)]
pub struct Abscissa {
    /// What it is, with its unit: "reach / mm".
    pub label: String,
    /// Its value at each pose.
    pub values: Vec<f64>,
}

/// The residuals of all poses (µm, along the axes of the world) against each abscissa, with means
/// over poses that follow one another. All panels have one vertical axis.
pub fn residuals_against(residuals_um: &[[f64; 3]], along: &[Abscissa]) -> Figure {
    let all = residuals_um.iter().flatten().copied();
    let largest = extent(all.map(f64::abs)).map_or(1.0, |(_, high)| high);
    let panel = |(k, abscissa): (usize, &Abscissa)| {
        let mut chart = Chart::new("", &abscissa.label, "residual / µm");
        chart.y.is_label_hidden = k % COLUMNS != 0;
        chart.height_px = Some(HEIGHT_PX);
        chart.y.range = Range::Fixed(-1.08 * largest, 1.08 * largest);
        let (low, high) = extent(abscissa.values.iter().copied()).unwrap_or((0.0, 1.0));
        let air = if high > low { 0.03 * (high - low) } else { 0.5 };
        chart.x.range = Range::Fixed(low - air, high + air);
        chart.marks.push(Mark::Horizontal { at: 0.0, text: String::new() });
        for (axis, name) in AXES.into_iter().enumerate() {
            let style = Style::nth(axis).width(1.4);
            let pairs = pairs(abscissa, residuals_um, axis);
            let means = means(&pairs);
            // of very many poses every n-th
            let every = pairs.len().div_ceil(MOST_POINTS).max(1);
            let points = pairs.iter().step_by(every).map(|[x, y]| Point { x: *x, y: *y, error: 0.0 });
            // below the means, which are to be seen
            let size = if pairs.len() > 200 { 0.8 } else { 1.4 };
            let small = style.marker(Marker::Dot).size(size);
            chart.marks.push(Mark::Points { label: name.into(), points: points.collect(), style: small });
            if means.len() > 1 {
                chart.marks.push(Mark::Line { label: name.into(), points: means, style });
            }
        }
        chart
    };
    let mut caption = String::from(
        "Residuals along the axes of the world, one point for a pose. Lines: means over neighbouring poses; where all is \
         in the model they stay near zero.",
    );
    if residuals_um.len() > MOST_POINTS {
        caption += " Of very many poses some are drawn; the means are over all.";
    }
    Figure {
        name: "residuals-against".into(),
        caption,
        panels: along.iter().enumerate().map(panel).collect(),
        columns: COLUMNS.min(along.len()),
        shared_legend: true,
        ..Figure::default()
    }
}

/// Abscissa and residual of every pose that has both, ascending.
fn pairs(abscissa: &Abscissa, residuals_um: &[[f64; 3]], axis: usize) -> Vec<[f64; 2]> {
    let both = abscissa.values.iter().zip(residuals_um).map(|(x, residual)| [*x, residual[axis]]);
    let mut pairs: Vec<[f64; 2]> = both.filter(|pair| pair.iter().all(|v| drawable(*v))).collect();
    pairs.sort_by(|a, b| a[0].total_cmp(&b[0]));
    pairs
}

/// Means over equally many neighbours.
fn means(pairs: &[[f64; 2]]) -> Vec<[f64; 2]> {
    let bins = (pairs.len() / LEAST_IN_BIN).min(MOST_BINS);
    let mean =
        |bin: &[[f64; 2]]| [0, 1].map(|i| bin.iter().map(|pair| pair[i]).sum::<f64>() / bin.len() as f64);
    let edge = |k: usize| k * pairs.len() / bins.max(1);
    (0..bins).map(|k| mean(&pairs[edge(k)..edge(k + 1)])).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_slope_is_seen_in_the_means() {
        let values: Vec<f64> = (0..60).map(|i| f64::from((i * 37) % 60)).collect();
        let residuals: Vec<[f64; 3]> = values.iter().map(|v| [2.0 * v, 0.0, -v]).collect();
        let along = [Abscissa { label: "q1 / °".into(), values }];
        let figure = residuals_against(&residuals, &along);
        let lines = figure.panels[0].marks.iter().filter_map(|mark| match mark {
            Mark::Line { label, points, .. } => Some((label.as_str(), points.clone())),
            _ => None,
        });
        let lines: Vec<_> = lines.collect();
        // ten means of six poses each: of 0 to 5 first
        assert_eq!((lines.len(), lines[0].0, lines[0].1[0]), (3, "x", [2.5, 5.0]));
        assert_eq!(lines[2].1[9], [56.5, -56.5]);
    }

    #[test]
    fn few_poses_have_no_means_and_none_draw() {
        assert!(means(&[[0.0, 1.0]; 5]).is_empty());
        let odd = Abscissa { label: "t / s".into(), values: vec![f64::NAN, 1e199, 3.0] };
        assert!(!residuals_against(&[[f64::NAN, 1.0, -1e199]; 3], &[odd]).svg().contains("NaN"));
        residuals_against(&[], &[]).svg();
    }
}
