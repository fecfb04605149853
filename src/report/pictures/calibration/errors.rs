//! How far off the robot is after each method: histograms below one another, and the same as
//! cumulative curves.

use serde::Serialize;

use super::super::super::chart::{Bar, Chart, Colour, Dash, Direction, Figure, Mark, Range, Style};
use super::super::super::scale::{drawable, one_two_five_below, typeset};
use super::amount;

/// From this ratio of the largest error to the smallest median on, a linear axis would show the
/// best method as a single bar.
const WIDE: f64 = 20.0;
/// Bars in each factor of ten of a logarithmic axis.
const BARS_PER_DECADE: f64 = 10.0;
/// Steps of a cumulative curve; with more poses it goes through so many quantiles.
const MOST_STEPS: usize = 400;
const HEIGHT_PX: f64 = 84.0;
const UM_PER_MM: f64 = 1e3;

/// The positioning errors under one method.
#[derive(Debug, Clone, Default, Serialize)]
pub struct MethodErrors {
    /// Name of the method.
    pub label: String,
    /// Length of the positioning error at every pose, mm.
    pub errors_mm: Vec<f64>,
}

/// A histogram of the errors for each method, below one another over the same bins and on the same
/// axes, with mean and maximum marked. The axis is logarithmic where the methods differ too much.
pub fn error_distribution(methods: &[MethodErrors]) -> Figure {
    let mut sorted: Vec<Vec<f64>> = methods.iter().map(sorted).collect();
    let unit = unit(&mut sorted);
    let bins = Bins::new(&sorted);
    let counts: Vec<Vec<usize>> = sorted.iter().map(|errors| bins.count(errors)).collect();
    let highest = counts.iter().flatten().copied().max().unwrap_or(0).max(1) as f64;
    let panel = |i: usize| {
        let errors = &sorted[i];
        let label = format!("positioning error / {unit}");
        let mut chart = Chart::new(title(&methods[i], errors.len()), label, "poses");
        chart.x.is_label_hidden = i + 1 < methods.len();
        chart.height_px = Some(HEIGHT_PX);
        chart.x.log = bins.log;
        chart.x.range = Range::Fixed(bins.edge(0), bins.edge(bins.number));
        chart.y.range = Range::Fixed(0.0, 1.2 * highest);
        chart.y.step = (highest <= 3.0).then_some(1.0);
        let (Some(max), mean) = (errors.last(), mean(errors)) else { return chart };
        let bar = |(k, count): (usize, &usize)| Bar {
            from: bins.edge(k),
            to: bins.edge(k + 1),
            value: *count as f64,
            ..Bar::default()
        };
        let bars = counts[i].iter().enumerate().filter(|(_, count)| **count > 0).map(bar).collect();
        chart = chart.with(Mark::Bars {
            label: String::new(),
            bars,
            direction: Direction::Up,
            style: Style::nth(0).colour(Colour::SkyBlue).dash(Dash::Solid),
        });
        let line = |at: f64, what: &str| Mark::Vertical { at, text: what.into() };
        match errors.first() == Some(max) {
            true => chart.with(line(*max, "mean, max")),
            false => chart.with(line(mean, "mean")).with(line(*max, "max")),
        }
    };
    let mut caption = String::from(
        "Number of poses by positioning error, one panel per method on common axes; mean and maximum are marked.",
    );
    if bins.log {
        caption += " The axis of the errors is logarithmic; the first bar also counts any error below it.";
    }
    Figure {
        name: "error-distribution".into(),
        caption,
        panels: (0..methods.len()).map(panel).collect(),
        columns: 1,
        ..Figure::default()
    }
}

/// For each method the share of poses whose error is at most x. The axis is logarithmic where the
/// methods differ too much.
pub fn cumulative_errors(methods: &[MethodErrors]) -> Figure {
    let mut sorted: Vec<Vec<f64>> = methods.iter().map(sorted).collect();
    let unit = unit(&mut sorted);
    let bins = Bins::new(&sorted);
    let (first, last) = (bins.edge(0), bins.edge(bins.number));
    let mut chart = Chart::new("", format!("positioning error / {unit}"), "share of poses / %");
    chart.x.log = bins.log;
    chart.x.range = Range::Fixed(first, last);
    chart.y.range = Range::Fixed(0.0, 104.0);
    for (i, (method, errors)) in methods.iter().zip(&sorted).enumerate() {
        if errors.is_empty() {
            continue;
        }
        let mut points = vec![[first, 0.0]];
        let mut share = 0.0;
        let steps = errors.len().min(MOST_STEPS);
        for step in 1..=steps {
            // The last pose of each step: the curve never promises more than there is.
            let rank = step * errors.len() / steps;
            let error = errors[rank - 1].max(first);
            points.push([error, share]);
            share = 100.0 * rank as f64 / errors.len() as f64;
            points.push([error, share]);
        }
        points.push([last, share]);
        chart.marks.push(Mark::Line { label: method.label.clone(), points, style: Style::nth(i) });
    }
    let mut caption = String::from("Share of the poses whose positioning error is at most x.");
    if sorted.iter().any(|errors| errors.len() > MOST_STEPS) {
        caption += &format!(" Curves of more poses than that go through {MOST_STEPS} of them.");
    }
    Figure::from(chart).named("cumulative-errors").captioned(caption)
}

/// Micrometres while all errors have at most four digits in them: then errors from millimetres on
/// are multiplied. On a linear axis only below 1 mm.
fn unit(sorted_mm: &mut [Vec<f64>]) -> &'static str {
    let largest_mm = sorted_mm.iter().filter_map(|errors| errors.last()).copied().fold(0.0, f64::max);
    let limit_mm = if Bins::new(sorted_mm).log { 10.0 } else { 1.0 };
    if largest_mm > limit_mm {
        return "mm";
    }
    sorted_mm.iter_mut().flatten().for_each(|error| *error *= UM_PER_MM);
    "µm"
}

/// "rigid rod, 150 poses: mean 86 µm, max 210 µm"
fn title(method: &MethodErrors, count: usize) -> String {
    let errors = sorted(method);
    let poses = if count == 1 { "pose" } else { "poses" };
    let (label, count) = (&method.label, typeset(&count.to_string()));
    let length = |mm: f64| if mm < 1.0 { amount(mm * UM_PER_MM, "µm") } else { amount(mm, "mm") };
    match errors.last() {
        Some(max) => {
            format!("{label}, {count} {poses}: mean {}, max {}", length(mean(&errors)), length(*max))
        }
        None => format!("{label}, no poses"),
    }
}

/// The errors that can be drawn, ascending.
fn sorted(method: &MethodErrors) -> Vec<f64> {
    let mut errors: Vec<f64> =
        method.errors_mm.iter().copied().filter(|e| drawable(*e) && *e >= 0.0).collect();
    errors.sort_by(f64::total_cmp);
    errors
}

fn mean(values: &[f64]) -> f64 {
    values.iter().sum::<f64>() / values.len().max(1) as f64
}

/// Bins that all methods share: the k-th from `edge(k)` to `edge(k + 1)`.
struct Bins {
    first: f64,
    /// Width of a bin; on a logarithmic axis the logarithm of the ratio of its ends.
    width: f64,
    number: usize,
    log: bool,
}

impl Bins {
    /// Bins for errors that are sorted.
    fn new(methods: &[Vec<f64>]) -> Self {
        let high = methods.iter().filter_map(|errors| errors.last()).copied().fold(0.0, f64::max);
        let medians = methods.iter().filter_map(|errors| errors.get(errors.len() / 2));
        let smallest_median = medians.copied().filter(|m| *m > 0.0).fold(f64::INFINITY, f64::min);
        let smallest = methods.iter().flatten().copied().filter(|e| *e > 0.0).fold(f64::INFINITY, f64::min);
        if high > WIDE * smallest_median {
            // A single pose that happens to be exact must not stretch the axis.
            let exponent = (0.1 * smallest_median).max(smallest).log10();
            let first = (exponent * BARS_PER_DECADE).floor() / BARS_PER_DECADE;
            let number = ((high.log10() - first) * BARS_PER_DECADE).floor().clamp(0.0, 1000.0) as usize + 1;
            return Bins { first, width: 1.0 / BARS_PER_DECADE, number, log: true };
        }
        // Between 15 and 38 bins.
        let width = one_two_five_below(high / 15.0);
        Bins { first: 0.0, width, number: (high / width).floor() as usize + 1, log: false }
    }

    fn edge(&self, k: usize) -> f64 {
        let at = self.first + k as f64 * self.width;
        if self.log { 10f64.powf(at) } else { at }
    }

    fn count(&self, errors: &[f64]) -> Vec<usize> {
        let mut counts = vec![0; self.number];
        for error in errors {
            let at = if self.log { error.log10() } else { *error };
            let k = ((at - self.first) / self.width).floor().max(0.0) as usize;
            counts[k.min(self.number - 1)] += 1;
        }
        counts
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn method(label: &str, errors_mm: &[f64]) -> MethodErrors {
        MethodErrors { label: label.into(), errors_mm: errors_mm.to_vec() }
    }

    fn bars(chart: &Chart) -> Vec<f64> {
        let bars = chart.marks.iter().filter_map(|mark| match mark {
            Mark::Bars { bars, .. } => Some(bars),
            _ => None,
        });
        bars.flatten().map(|bar| bar.value).collect()
    }

    #[test]
    fn every_error_is_counted_over_the_same_bins() {
        let methods = [method("nominal", &[0.30, 0.1, f64::NAN, 0.11]), method("rigid", &[0.05])];
        let figure = error_distribution(&methods);
        assert_eq!(figure.panels.iter().map(bars).collect::<Vec<_>>(), [vec![2.0, 1.0], vec![1.0]]);
        assert_eq!(figure.panels[0].x.range, figure.panels[1].x.range);
        let svg = figure.svg();
        for text in
            ["nominal, 3 poses: mean 170\u{a0}µm, max 300\u{a0}µm", "rigid, 1 pose", ">\nmean\n", ">\nmax\n"]
        {
            assert!(svg.contains(text), "{text}\n{svg}");
        }
        assert_eq!(svg.matches(">\npositioning error / µm\n").count(), 1);
    }

    #[test]
    fn methods_that_differ_much_stand_on_a_logarithmic_axis() {
        let methods = [method("nominal", &[2.0, 3.0, 4.0]), method("rigid", &[0.0, 0.02, 0.03])];
        for figure in [error_distribution(&methods), cumulative_errors(&methods)] {
            assert!(figure.panels.iter().all(|chart| chart.x.log));
        }
        assert_eq!(bars(&error_distribution(&methods).panels[1]).iter().sum::<f64>(), 3.0);
    }

    #[test]
    fn a_cumulative_curve_steps_up_to_all_poses() {
        let figure = cumulative_errors(&[method("rigid", &[0.2, 0.1])]);
        let Mark::Line { points, .. } = &figure.panels[0].marks[0] else { panic!("no line") };
        assert_eq!(points[..4], [[0.0, 0.0], [100.0, 0.0], [100.0, 50.0], [200.0, 50.0]]);
        assert_eq!(points.last().map(|p| p[1]), Some(100.0));
        let errors: Vec<f64> = (1..=100_000).map(|i| f64::from(i) * 1e-6).collect();
        let figure = cumulative_errors(&[method("many", &errors)]);
        assert!(figure.caption.contains("400") && figure.svg().len() < 100_000);
    }

    #[test]
    fn degenerate_errors_draw() {
        for errors in
            [&[][..], &[0.1], &[0.0; 9], &[f64::NAN], &[0.1; 30], &[1e-12, 1e12], &[1e-190, 1e190], &[-1.0]]
        {
            for methods in [vec![method("a", errors)], vec![method("a", errors), method("b", &[0.1, 0.2])]] {
                error_distribution(&methods).svg();
                cumulative_errors(&methods).svg();
            }
        }
        error_distribution(&[]).svg();
        cumulative_errors(&[]).svg();
    }
}
