//! The pictures of a diagnosis: residuals before and after, how likely each effect is, errors of held-out readings.

use serde::Serialize;

use super::super::chart::{
    Axis, Bar, Chart, Colour, Dash, Direction, Figure, Mark, Marker, Point, Range, Style,
};
use super::super::scale::{drawable, extent, typeset};
use crate::units::significant;

/// More points of one series are drawn small.
const MANY: usize = 60;

/// What a model leaves of the readings, before and after something was taken into account, along a number.
#[derive(Debug, Clone, Default, Serialize)]
pub struct BeforeAfter {
    /// The number with its unit, for example "load / N".
    pub along: String,
    /// Names of its values, where they are no amounts.
    pub names: Vec<(f64, String)>,
    /// For example one series for each direction of the load.
    pub series: Vec<Residual>,
    /// Noise of a reading, µm.
    pub noise_um: f64,
}

/// A series of residuals.
#[derive(Debug, Clone, Default, Serialize)]
pub struct Residual {
    /// Its name.
    pub label: String,
    /// For each reading the number, and the residual before and after, µm.
    pub points: Vec<[f64; 3]>,
}

/// Two panels to the same scale. In the first, lines show what the fit says; bands are twice the noise.
pub fn before_after(data: &BeforeAfter) -> Figure {
    let all = || data.series.iter().flat_map(|series| &series.points);
    let (low, high) = padded(extent(all().map(|p| p[0])), 0.04);
    let noise = Some(2.0 * data.noise_um).filter(|noise| drawable(*noise)).unwrap_or_default();
    let ys = all().flat_map(|p| [p[1], p[2]]).chain([-noise, noise]);
    let (bottom, top) = padded(extent(ys), 0.06);
    let panel = |title: &str, k: usize| {
        let mut chart = Chart::new(title, &data.along, "measured − modelled / µm");
        chart.x.names = data.names.clone();
        (chart.x.range, chart.y.range) = (Range::Fixed(low, high), Range::Fixed(bottom, top));
        chart.marks.push(Mark::Band {
            label: "± 2 × noise".into(),
            points: [low, high].map(|x| [x, -noise, noise]).to_vec(),
            style: Style::nth(0).colour(Colour::SkyBlue),
        });
        chart.marks.push(Mark::Line {
            label: String::new(),
            points: vec![[low, 0.0], [high, 0.0]],
            style: Style::nth(0).colour(Colour::Grey).width(1.0).dash(Dash::Solid),
        });
        for (i, series) in data.series.iter().enumerate() {
            let points = series.points.iter().map(|p| Point { x: p[0], y: p[k], error: 0.0 }).collect();
            let style = Style::nth(i);
            let style = if series.points.len() > MANY { style.size(2.0) } else { style };
            chart.marks.push(Mark::Points { label: series.label.clone(), points, style });
            if k == 1 {
                let label = "what was found says".into();
                chart.marks.push(Mark::Line {
                    label,
                    points: said(&series.points),
                    style: style.dash(Dash::Solid).width(1.2),
                });
            }
        }
        chart
    };
    Figure {
        name: "before-after".into(),
        panels: vec![panel("before: the model as it is", 1), panel("after: with what was found", 2)],
        columns: 2,
        shared_legend: true,
        ..Figure::default()
    }
}

/// What was taken into account, averaged where the number is the same.
fn said(points: &[[f64; 3]]) -> Vec<[f64; 2]> {
    let mut sorted: Vec<[f64; 2]> = points.iter().map(|[x, before, after]| [*x, before - after]).collect();
    sorted.sort_by(|a, b| a[0].total_cmp(&b[0]));
    let same = sorted.chunk_by(|a, b| a[0] == b[0]);
    same.map(|group| [group[0][0], group.iter().map(|p| p[1]).sum::<f64>() / group.len() as f64]).collect()
}

fn padded(range: Option<(f64, f64)>, share: f64) -> (f64, f64) {
    let (low, high) = range.unwrap_or((0.0, 1.0));
    let air = if high > low { share * (high - low) } else { 0.5 };
    (low - air, high + air)
}

/// How likely a candidate is.
#[derive(Debug, Clone, Default, Serialize)]
pub struct Candidate {
    /// Its name.
    pub name: String,
    /// log10 of its odds against chance.
    pub log10_odds: f64,
    /// What became of it.
    pub class: Class,
}

/// What became of a candidate.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq, Serialize)]
pub enum Class {
    /// It is part of the diagnosis.
    Adopted,
    /// These readings cannot tell it from one that was adopted.
    Rival,
    /// It is neither.
    #[default]
    Rejected,
}

/// Horizontal bars, the likeliest on top, with the line from which on an effect is named.
pub fn ranking(candidates: &[Candidate], named_from: f64) -> Figure {
    let mut chart =
        Chart::new("how likely each effect is by itself", "log10 of the odds against noise alone", "");
    let row = |i: usize| -(i as f64);
    let names = candidates.iter().enumerate().map(|(i, c)| (row(i), c.name.clone())).collect();
    chart.y = Axis { names, ..Axis::default() };
    chart.height_px = Some(40.0 + 19.0 * candidates.len() as f64);
    let looks = [
        (Class::Adopted, "adopted", Style::nth(0).colour(Colour::Vermilion)),
        (Class::Rival, "cannot be told from it", Style::nth(0).colour(Colour::Orange).dash(Dash::Dashed)),
        (Class::Rejected, "rejected", Style::nth(0).colour(Colour::Grey)),
    ];
    for (class, label, style) in looks {
        let of_class =
            candidates.iter().enumerate().filter(|(_, c)| c.class == class && drawable(c.log10_odds));
        let bars: Vec<Bar> = of_class
            .map(|(i, c)| Bar {
                from: row(i) - 0.33,
                to: row(i) + 0.33,
                value: c.log10_odds,
                text: typeset(&significant(c.log10_odds, 2)),
            })
            .collect();
        if !bars.is_empty() {
            chart.marks.push(Mark::Bars { label: label.into(), bars, direction: Direction::Right, style });
        }
    }
    let text = format!("{} : 1", significant(named_from, 2));
    chart.marks.push(Mark::Vertical { at: named_from.log10(), text });
    Figure::from(chart).named("ranking")
}

/// Errors of readings that the model had not seen.
#[derive(Debug, Clone, Copy, Default, PartialEq, Serialize)]
pub struct HeldOut {
    /// Of the model as it is, µm.
    pub before_um: f64,
    /// With what was found, µm.
    pub after_um: f64,
    /// 95 % interval of the latter, µm.
    pub after_95_um: Option<(f64, f64)>,
    /// Noise of a reading, µm.
    pub noise_um: f64,
}

/// Two bars, the interval on the second, and the noise below which no model comes.
pub fn held_out(data: &HeldOut) -> Figure {
    let mut chart = Chart::new("error of held-out readings", "root mean square / µm", "");
    chart.y.names = vec![(0.0, "model as it is".into()), (-1.0, "with what was found".into())];
    chart.y.range = Range::Fixed(-1.6, 0.6);
    chart.height_px = Some(110.0);
    let bar = |row: f64, value: f64, label: &str, style: Style| Mark::Bars {
        label: label.into(),
        bars: vec![Bar { from: row - 0.3, to: row + 0.3, value, text: typeset(&significant(value, 3)) }],
        direction: Direction::Right,
        style,
    };
    chart.marks.push(bar(0.0, data.before_um, "", Style::nth(0).colour(Colour::Grey)));
    chart.marks.push(bar(-1.0, data.after_um, "", Style::nth(0).colour(Colour::Blue).dash(Dash::Dashed)));
    if let Some((low, high)) = data.after_95_um.filter(|(low, high)| drawable(*low) && drawable(*high)) {
        let style = Style::nth(0).dash(Dash::Solid).width(2.0);
        let line = |points| Mark::Line { label: "95 % interval".into(), points, style };
        chart.marks.push(line(vec![[low, -1.38], [high, -1.38]]));
        let ends = [low, high].map(|x| Point { x, y: -1.38, error: 0.0 }).to_vec();
        let style = style.marker(Marker::Plus);
        chart.marks.push(Mark::Points { label: String::new(), points: ends, style });
    }
    if drawable(data.noise_um) {
        let text = format!("noise {}", typeset(&significant(data.noise_um, 2)));
        chart.marks.push(Mark::Vertical { at: data.noise_um, text });
    }
    Figure::from(chart).named("held-out")
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_was_found_is_drawn_once_per_value() {
        let points = [[2.0, 9.0, 1.0], [1.0, 3.0, -1.0], [2.0, 7.0, 1.0]];
        assert_eq!(said(&points), [[1.0, 4.0], [2.0, 7.0]]);
    }

    #[test]
    fn both_panels_have_one_scale() {
        let series =
            vec![Residual { label: "dz".into(), points: vec![[5.0, 40.0, 1.0], [10.0, -30.0, -1.0]] }];
        let figure = before_after(&BeforeAfter { series, noise_um: 1.0, ..BeforeAfter::default() });
        assert_eq!(figure.panels[0].y.range, figure.panels[1].y.range);
    }

    #[test]
    fn a_candidate_without_odds_has_no_bar_but_a_name() {
        let candidate =
            Candidate { name: "creep".into(), log10_odds: f64::NEG_INFINITY, class: Class::Rejected };
        assert!(ranking(&[candidate], 20.0).svg().contains("creep"));
    }

    #[test]
    fn nothing_to_show_is_shown_as_nothing() {
        before_after(&BeforeAfter::default()).svg();
        ranking(&[], 20.0).svg();
        held_out(&HeldOut { before_um: f64::NAN, ..HeldOut::default() }).svg();
    }
}
