//! What the axes of a chart span, and how high it is.

use super::chart::{Axis, Chart, Direction, Mark, Range};
use super::frame::NOTE;
use super::labels::text_width_px;
use super::marks;
use super::prefix::{micrometres, prefixed};
use super::scale::{Extent, Scale, drawable, extent};

/// Both scales and the height of the plotting area. A drawing of things shows at least `least_unit`
/// of its unit in each pixel.
pub(super) fn scales(chart: &Chart, width: f64, least_unit: f64) -> (Scale, Scale, f64) {
    let count = |length: f64, each: f64| ((length / each) as usize).clamp(3, 10);
    let (xs, ys) = marks::extents(chart, width);
    let default_height = match chart.y.names.len() {
        0 => (0.6 * width).clamp(180.0, 330.0),
        bars => 26.0 * bars as f64 + 10.0,
    };
    let height = chart.height_px.filter(|h| drawable(*h)).unwrap_or(default_height).clamp(60.0, 2000.0);
    if chart.equal_aspect {
        return equal_scales(chart, xs, ys, width, least_unit);
    }
    let snug = has_bars(chart);
    // numbers at the ends of bars are in the unit of their axis, which then stays
    let prefixed = |axis: &Axis, scale: Scale, direction: Direction| match has_numbers(chart, direction) {
        true => scale,
        false => micrometres(&scale, &axis.label).unwrap_or_else(|| prefixed(scale, &axis.label)),
    };
    let x = roomy(width, count(width, 62.0), |count| {
        prefixed(&chart.x, scale(&chart.x, xs, count, snug), Direction::Right)
    });
    let x = if chart.x.names.is_empty() || chart.x.names_upwards { x } else { thinned(x, width) };
    let y = prefixed(&chart.y, scale(&chart.y, ys, count(height, 36.0), snug), Direction::Up);
    (x, y, height)
}

/// The scale along x with at most about `count` ticks, and no more than there is room for their
/// labels.
fn roomy(width: f64, count: usize, scale: impl Fn(usize) -> Scale) -> Scale {
    (2..=count).rev().map(&scale).find(|x| has_room(&x.ticks, width)).unwrap_or_else(|| scale(1))
}

/// Whether the texts of ticks along x stand beside one another.
pub(super) fn has_room(ticks: &[(f64, String)], width: f64) -> bool {
    let widest = ticks.iter().map(|(_, label)| text_width_px(label, NOTE.size_px)).fold(0.0, f64::max);
    (widest + 10.0) * ticks.len().saturating_sub(1) as f64 <= width
}

/// Whether any bars stand on the chart.
pub(super) fn has_bars(chart: &Chart) -> bool {
    chart.marks.iter().any(|mark| matches!(mark, Mark::Bars { .. }))
}

/// The scale with every second of its names, or third …, so that all have room; zero keeps its
/// name.
fn thinned(scale: Scale, width: f64) -> Scale {
    let zero = scale.ticks.iter().position(|(at, _)| *at == 0.0).unwrap_or(0);
    let every = |step: usize| -> Vec<(f64, String)> {
        scale.ticks.iter().skip(zero % step).step_by(step).cloned().collect()
    };
    // the names of an axis do not begin and end where it does
    let share = |ticks: &[(f64, String)]| match ticks {
        [(first, _), .., (last, _)] => ((last - first) / (scale.to - scale.from)).abs().min(1.0),
        _ => 1.0,
    };
    let is_apart = |ticks: &Vec<(f64, String)>| has_room(ticks, width * share(ticks));
    let found = (1..=scale.ticks.len()).map(every).find(is_apart);
    Scale { ticks: found.unwrap_or_default(), ..scale }
}

/// Whether bars that grow this way have their numbers at their ends.
fn has_numbers(chart: &Chart, way: Direction) -> bool {
    chart.marks.iter().any(|mark| match mark {
        Mark::Bars { bars, direction, .. } => *direction == way && bars.iter().any(|b| !b.text.is_empty()),
        _ => false,
    })
}

/// The scale of one axis; `snug` does without rounding to whole ticks, which bars do not need.
fn scale(axis: &Axis, data: Extent, count: usize, snug: bool) -> Scale {
    let (low, high) = data.unwrap_or((0.0, 1.0));
    if let Some((first, last)) = extent(axis.names.iter().map(|(at, _)| *at)) {
        let named = axis.names.iter().filter(|(at, _)| drawable(*at)).cloned().collect();
        return Scale { ticks: named, ..Scale::fixed(first - 0.6, last + 0.6, count) };
    }
    match axis.range {
        Range::Auto | Range::AutoWithZero if axis.log => Scale::log_rounded(low, high, count),
        Range::Fixed(from, to) if axis.log => Scale::log(from, to, count),
        Range::Auto | Range::AutoWithZero if snug => Scale::fixed(low, high, count),
        Range::Auto => Scale::rounded(low, high, count),
        Range::AutoWithZero => Scale::rounded(low.min(0.0), high.max(0.0), count),
        Range::Fixed(from, to) => Scale::fixed(from, to, count),
    }
    .with_step(axis.step)
}

/// One unit of x as long as one unit of y: the height follows from the width, within reason.
fn equal_scales(chart: &Chart, xs: Extent, ys: Extent, width: f64, least_unit: f64) -> (Scale, Scale, f64) {
    let range = |axis: &Axis, data: Extent| match axis.range {
        Range::Fixed(from, to) if drawable(from) && drawable(to) => (from.min(to), from.max(to)),
        _ => data.unwrap_or((0.0, 1.0)),
    };
    let (x, y) = (range(&chart.x, xs), range(&chart.y, ys));
    // Air around the drawing, where its notes go; a drawing without extent still gets a unit of it.
    let largest = (x.1 - x.0).max(y.1 - y.0);
    // What has no frame has its notes inside.
    let share = if chart.frameless { 0.05 } else { 0.1 };
    let air = if largest > 0.0 { share * largest } else { 1.0 };
    let highest = if chart.frameless { 560.0 } else { 420.0 };
    let (span_x, span_y) = (x.1 - x.0 + 2.0 * air, y.1 - y.0 + 2.0 * air);
    let height_of = |unit_per_px: f64| (span_y / unit_per_px).clamp(0.3 * width, 1.5 * width).min(highest);
    let unit_per_px = (span_x / width).max(span_y / height_of(span_x / width)).max(least_unit);
    let height = height_of(unit_per_px);
    let around = |(low, high): (f64, f64), length: f64| {
        let (middle, half) = (0.5 * low + 0.5 * high, 0.5 * length * unit_per_px);
        (middle - half, middle + half)
    };
    let ((x0, x1), (y0, y1)) = (around(x, width), around(y, height));
    let x = roomy(width, ((width / 45.0) as usize).clamp(2, 10), |count| {
        prefixed(Scale::fixed(x0, x1, count), &chart.x.label)
    });
    // The same grid both ways, unless the drawing is too low for it.
    let step =
        x.ticks.windows(2).map(|pair| pair[1].0 - pair[0].0).next().filter(|step| y1 - y0 > 2.0 * step);
    let y = Scale::fixed(y0, y1, ((height / 50.0) as usize).max(2)).with_step(step);
    let y = prefixed(y, &chart.y.label);
    (x, y, height)
}

#[cfg(test)]
mod tests {
    use super::super::chart::Style;
    use super::*;

    #[test]
    fn a_drawing_is_as_long_per_unit_along_x_as_along_y() {
        let points = vec![[0.0, 0.0], [525.0, 150.0]];
        let mut chart = Chart::new("", "X / mm", "Z / mm");
        chart.marks.push(Mark::Line { label: String::new(), points, style: Style::nth(0) });
        chart.equal_aspect = true;
        for least_unit in [0.0, 3.0] {
            let (x, y, height) = scales(&chart, 600.0, least_unit);
            let unit = (x.to - x.from) / 600.0;
            approx::assert_relative_eq!(unit, (y.to - y.from) / height, max_relative = 1e-12);
            assert!(unit >= least_unit);
        }
    }
}
