//! From one amount to the next, step by step.

use serde::Serialize;

use super::super::chart::{Axis, Bar, Chart, Colour, Dash, Direction, Figure, Mark, Range, Style};
use super::super::scale::{drawable, extent, typeset};
use crate::units::significant;

/// One quantity on its way from model to measurement.
#[derive(Debug, Clone, Default, Serialize)]
pub struct Waterfall {
    /// The quantity, for example "C^F 22".
    pub title: String,
    /// Unit of the values, for example "µm/N"; empty where they are over FEA's.
    pub unit: String,
    /// Amounts and what leads from each to the next, top to bottom.
    pub rungs: Vec<Rung>,
}

/// A row of a waterfall.
#[derive(Debug, Clone, Serialize)]
pub enum Rung {
    /// An amount by itself.
    Total {
        /// Whose, for example "FEA".
        name: String,
        /// How much.
        value: f64,
        /// Half width of its 95 % interval, where it is known.
        half_width: Option<f64>,
    },
    /// What a term of the model adds to the amount above.
    Term {
        /// Its name, for example "shear".
        name: String,
        /// How much; below zero where it takes away.
        added: f64,
    },
    /// What no term accounts for.
    Remainder {
        /// Its name, for example "not in the model".
        name: String,
        /// How much; below zero where it takes away.
        added: f64,
    },
}

/// Steps that span less than this share of the amount are looked at closely: their axis does not
/// begin at 0.
const CLOSE: f64 = 0.5;
/// Half the height of a row's bar.
const HALF: f64 = 0.33;

/// Every quantity in a panel of its own: amounts as strokes with their 95 % intervals, steps as
/// bars from one amount to the next, all with their numbers.
pub fn waterfall(quantities: &[Waterfall]) -> Figure {
    Figure {
        name: "waterfall".into(),
        caption: "From top to bottom, each bar begins where the one above it ended. Bars to the right make the rod \
             softer."
            .into(),
        panels: quantities.iter().map(panel).collect(),
        columns: quantities.len().clamp(1, 2),
        shared_legend: true,
        ..Figure::default()
    }
}

fn panel(quantity: &Waterfall) -> Chart {
    let row = |i: usize| -(i as f64);
    let ends = ends(&quantity.rungs);
    let range = range(&quantity.rungs, &ends);
    let label = match quantity.unit.as_str() {
        "" => "compliance, FEA = 1".into(),
        unit if unit.contains('/') => format!("compliance / ({unit})"),
        unit => format!("compliance / {unit}"),
    };
    let cut = if range.0 > 0.0 { ", not from 0" } else { "" };
    let mut chart = Chart::new(&quantity.title, format!("{label}{cut}"), "");
    let names = quantity.rungs.iter().enumerate().map(|(i, rung)| (row(i), name(rung).to_owned()));
    chart.y = Axis { names: names.collect(), ..Axis::default() };
    chart.x.range = Range::Fixed(range.0, range.1);
    let bar = |i: usize, base: f64, value: f64, text: String| Bar {
        from: row(i) - HALF,
        to: row(i) + HALF,
        base,
        value,
        text,
    };
    let looks = Style::nth(0).width(3.0).dash(Dash::Solid);
    let (mut terms, mut remainders, mut intervals, mut marks) =
        (Vec::new(), Vec::new(), Vec::new(), Vec::new());
    for (i, (rung, [from, to])) in quantity.rungs.iter().zip(&ends).enumerate() {
        // the text stands to the right of the bar, whichever way it grows
        let (low, high) = (from.min(*to), from.max(*to));
        match rung {
            Rung::Total { value, half_width, .. } => {
                let half = half_width.filter(|w| drawable(*w)).unwrap_or(0.0);
                let text = match half > 0.0 {
                    true => with_interval(*value, half),
                    false => number(*value, 4),
                };
                intervals.push(bar(i, value - half, value + half, text));
                marks.push(Mark::Line {
                    label: "compliance".into(),
                    points: vec![[*value, row(i) - HALF], [*value, row(i) + HALF]],
                    style: looks,
                });
            }
            Rung::Term { added, .. } => terms.push(bar(i, low, high, signed(*added))),
            Rung::Remainder { added, .. } => remainders.push(bar(i, low, high, signed(*added))),
        }
        // a thin line leads down to the next row
        if i + 1 < ends.len() {
            marks.push(Mark::Line {
                label: String::new(),
                points: vec![[*to, row(i) - HALF], [*to, row(i + 1) + HALF]],
                style: Style::nth(0).colour(Colour::Grey).width(0.8),
            });
        }
    }
    let kinds = [
        ("95 % interval of the readings", intervals, Style::nth(0).colour(Colour::Grey).dash(Dash::DashDot)),
        ("term of the model", terms, Style::nth(0).colour(Colour::Blue).dash(Dash::Solid)),
        ("not in the model", remainders, Style::nth(0).colour(Colour::Vermilion).dash(Dash::Dashed)),
    ];
    for (label, bars, style) in kinds {
        // amounts without an interval are not explained by one
        let is_seen = bars.iter().any(|b: &Bar| b.base != b.value);
        let label = if is_seen { label.to_owned() } else { String::new() };
        if !bars.is_empty() {
            chart.marks.push(Mark::Bars { label, bars, direction: Direction::Right, style });
        }
    }
    chart.marks.extend(marks);
    chart
}

fn name(rung: &Rung) -> &str {
    match rung {
        Rung::Total { name, .. } | Rung::Term { name, .. } | Rung::Remainder { name, .. } => name,
    }
}

/// As many decimals as the interval has with two digits.
fn with_interval(value: f64, half: f64) -> String {
    let decimals = (1.0 - half.log10().floor()).clamp(0.0, 9.0) as usize;
    format!("{} ± {half:.decimals$}", typeset(&format!("{value:.decimals$}")))
}

/// What is not known has no number.
fn number(value: f64, digits: usize) -> String {
    if drawable(value) { typeset(&significant(value, digits)) } else { "unknown".into() }
}

fn signed(value: f64) -> String {
    let sign = if value > 0.0 { "+" } else { "" };
    format!("{sign}{}", number(value, 2))
}

/// Where each row begins and ends.
fn ends(rungs: &[Rung]) -> Vec<[f64; 2]> {
    let mut at = 0.0;
    let step = |rung: &Rung| {
        let from = at;
        at = match rung {
            Rung::Total { value, .. } => *value,
            Rung::Term { added, .. } | Rung::Remainder { added, .. } => from + added,
        };
        match rung {
            Rung::Total { .. } => [at, at],
            _ => [from, at],
        }
    };
    rungs.iter().map(step).collect()
}

/// What the axis spans: from 0, or close around the steps where they would be too short to see.
fn range(rungs: &[Rung], ends: &[[f64; 2]]) -> (f64, f64) {
    let intervals = rungs.iter().flat_map(|rung| match rung {
        Rung::Total { value, half_width: Some(half), .. } => vec![value - half, value + half],
        _ => Vec::new(),
    });
    let (low, high) = extent(ends.iter().flatten().copied().chain(intervals)).unwrap_or((0.0, 1.0));
    // Room for the numbers to the right.
    const ROOM: f64 = 0.6;
    let span = high - low;
    if low > 0.0 && span > 0.0 && span < CLOSE * high {
        return ((low - 0.15 * span).max(0.0), high + ROOM * span);
    }
    let (low, high) = (low.min(0.0), high.max(0.0));
    let span = if high > low { high - low } else { 1.0 };
    (low, high + ROOM * span)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn total(name: &str, value: f64, half_width: Option<f64>) -> Rung {
        Rung::Total { name: name.into(), value, half_width }
    }

    fn steps(remainder: f64) -> Waterfall {
        let rungs = vec![
            total("Calc", 5.5, None),
            Rung::Term { name: "shear".into(), added: 0.3 },
            Rung::Term { name: "sleeves".into(), added: -0.1 },
            total("FEA", 5.7, None),
            Rung::Remainder { name: "rest".into(), added: remainder },
            total("Meas", 5.7 + remainder, Some(0.2)),
        ];
        Waterfall { title: "C^F 22".into(), unit: "µm/N".into(), rungs }
    }

    #[test]
    fn each_step_begins_where_the_one_before_it_ended() {
        let ends = ends(&steps(2.0).rungs);
        let [calc, shear, sleeves, fea, rest, meas] = ends[..] else { panic!("six rows") };
        assert_eq!((calc, shear, sleeves), ([5.5, 5.5], [5.5, 5.8], [5.8, 5.8 - 0.1]));
        assert!((sleeves[1] - fea[0]).abs() < 1e-12 && (rest[1] - meas[1]).abs() < 1e-12);
    }

    #[test]
    fn an_axis_that_does_not_begin_at_0_says_so() {
        let label = |remainder| panel(&steps(remainder)).x.label;
        assert_eq!(label(0.4), "compliance / (µm/N), not from 0");
        assert_eq!(label(30.0), "compliance / (µm/N)");
        let svg = waterfall(&[steps(0.4), steps(30.0)]).svg();
        for text in ["+0.30", "−0.10", "5.700", "6.10 ± 0.20", "not in the model"] {
            assert!(svg.contains(text), "{text}\n{svg}");
        }
    }

    #[test]
    fn amounts_that_are_none_draw() {
        for value in [f64::NAN, 0.0, f64::INFINITY, -1e199] {
            assert!(!waterfall(&[steps(value)]).svg().contains("NaN"));
        }
        waterfall(&[Waterfall::default()]).svg();
    }
}
