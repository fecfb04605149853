//! How far each parameter moved, drawn.

use super::Change;
use crate::report::chart::{Bar, Chart, Colour, Direction, Figure, Mark, Style};
use crate::report::scale::typeset;
use crate::units::significant;

/// Most parameters that a picture shows, the most changed ones.
pub(super) const MOST_SHOWN: usize = 16;

/// How far each parameter moved, in its own standard errors; nothing where none has any.
pub(super) fn difference_picture(parameters: &[Change]) -> Option<Figure> {
    let mut moved: Vec<(&str, f64)> =
        parameters.iter().filter_map(|change| Some((change.name.as_str(), change.ratio()?))).collect();
    let all = moved.len();
    moved.sort_by(|a, b| b.1.abs().total_cmp(&a.1.abs()));
    moved.truncate(MOST_SHOWN);
    if moved.is_empty() {
        return None;
    }
    let row = |k: usize| -(k as f64);
    let mut chart = Chart::new("", "difference over its standard error", "");
    chart.y.names = moved.iter().enumerate().map(|(k, (name, _))| (row(k), (*name).to_owned())).collect();
    chart.height_px = Some(22.0 * moved.len() as f64 + 10.0);
    let bar = |(k, (_, ratio)): (usize, &(&str, f64))| Bar {
        from: row(k) - 0.33,
        to: row(k) + 0.33,
        value: *ratio,
        text: typeset(&two_digits(*ratio)),
        ..Bar::default()
    };
    let chart = chart.with(Mark::Bars {
        label: String::new(),
        bars: moved.iter().enumerate().map(bar).collect(),
        direction: Direction::Right,
        style: Style::nth(0).colour(Colour::Blue),
    });
    let rest =
        if all > moved.len() { format!(" The {} largest of {all}.", moved.len()) } else { String::new() };
    let caption = format!(
        "How far each parameter moved, in standard errors of the difference as of two recordings that have nothing in \
         common.{rest}"
    );
    Some(Figure::from(chart).named("parameter-differences").captioned(caption))
}

/// "+12", "−0.064": two digits and a sign.
pub(super) fn two_digits(ratio: f64) -> String {
    let text = significant(ratio, 2);
    if ratio > 0.0 { format!("+{text}") } else { text }
}
