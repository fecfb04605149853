//! The pictures of a diagnosis: residuals before and after, how likely each effect is, errors of held-out readings.

mod angle;

pub use angle::{AngleError, angle_errors};

use serde::Serialize;

use super::super::chart::{Axis, Bar, Chart, Colour, Dash, Direction, Figure, Mark, Point, Range, Style};
use super::super::scale::{drawable, extent, typeset};
use crate::statistics::median;
use crate::units::significant;

/// More points of one series are drawn small.
const MANY: usize = 60;
/// Half the size of a point in a cloud, px.
const CLOUD_PX: f64 = 1.1;
/// So many times the usual distance of points is a gap.
const GAP: f64 = 3.0;

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
    /// The readings.
    pub points: Vec<ResidualPoint>,
    /// Drawn grey, to compare with.
    pub is_context: bool,
}

/// What is left of one reading.
#[derive(Debug, Clone, Copy, Default, PartialEq, Serialize)]
pub struct ResidualPoint {
    /// The number along which it is drawn.
    pub x: f64,
    /// Left by the model as it is, µm.
    pub before_um: f64,
    /// Left with what was found, µm.
    pub after_um: f64,
    /// What of that is structured and unexplained, µm.
    pub unexplained_um: f64,
}

/// Two panels to the same scale, or one where nothing was found. Lines show what the findings say, and what no effect
/// explains; bands are twice the noise. Where a number repeats, series stand beside one another.
pub fn before_after(data: &BeforeAfter) -> Figure {
    let all = || data.series.iter().flat_map(|series| &series.points);
    let (low, high) = padded(extent(all().map(|p| p.x)), 0.06);
    let noise = Some(2.0 * data.noise_um).filter(|noise| drawable(*noise)).unwrap_or_default();
    let y_range = padded(extent(all().flat_map(|p| [p.before_um, p.after_um]).chain([-noise, noise])), 0.06);
    let told_apart = data.series.iter().filter(|series| !series.is_context);
    let repeats = told_apart.clone().any(|s| 2 * averages(&s.points, |_| 0.0).len() <= s.points.len());
    let beside = if repeats { 0.014 * (high - low) } else { 0.0 };
    let middle = (data.series.len() as f64 - 1.0) / 2.0;
    let panel =
        |title: &str, residual: fn(&ResidualPoint) -> f64, said: fn(&ResidualPoint) -> f64, words: &str| {
            let mut chart = Chart::new(title, &data.along, "measured − modelled / µm");
            chart.x.names = data.names.clone();
            (chart.x.range, chart.y.range) = (Range::Fixed(low, high), Range::Fixed(y_range.0, y_range.1));
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
            let mut lines = Vec::new();
            for (i, series) in data.series.iter().enumerate() {
                let shift = (i as f64 - middle) * beside;
                let style = match series.is_context {
                    true => Style::nth(0).colour(Colour::Grey),
                    false => Style::nth(i),
                };
                let look = style.size(if series.points.len() > MANY { 2.0 } else { 3.0 });
                let point = |p: &ResidualPoint| Point { x: p.x + shift, y: residual(p), error: 0.0 };
                let points = series.points.iter().map(point).collect();
                chart.marks.push(Mark::Points { label: series.label.clone(), points, style: look });
                let mut points = averages(&series.points, said);
                points.iter_mut().for_each(|point| point[0] += shift);
                if !series.is_context && points.iter().any(|point| point[1] != 0.0) {
                    let style = style.dash(Dash::Solid).width(1.2);
                    let stretches = if repeats { vec![points] } else { unbroken(points) };
                    lines.extend(stretches.into_iter().map(|points| Mark::Line {
                        label: words.into(),
                        points,
                        style,
                    }));
                }
            }
            chart.marks.extend(lines);
            chart
        };
    let found = |p: &ResidualPoint| p.before_um - p.after_um;
    let (found_says, unexplained) = ("what was found says", "what no effect explains");
    let panels = match all().all(|p| found(p) == 0.0) {
        true => vec![panel("what the model leaves", |p| p.after_um, |p| p.unexplained_um, unexplained)],
        false => vec![
            panel("before: the model as it is", |p| p.before_um, found, found_says),
            panel("after: with what was found", |p| p.after_um, |p| p.unexplained_um, unexplained),
        ],
    };
    let name = "before-after".into();
    Figure { name, panels, columns: 2, shared_legend: true, ..Figure::default() }
}

/// Points that follow one another, without the gaps between runs.
fn unbroken(points: Vec<[f64; 2]>) -> Vec<Vec<[f64; 2]>> {
    let gaps: Vec<f64> = points.windows(2).map(|pair| pair[1][0] - pair[0][0]).collect();
    let usual = median(&gaps).unwrap_or_default();
    points.chunk_by(|a, b| b[0] - a[0] <= GAP * usual).map(<[_]>::to_vec).collect()
}

/// A number of the points, averaged where they stand at the same place.
fn averages(points: &[ResidualPoint], of: impl Fn(&ResidualPoint) -> f64) -> Vec<[f64; 2]> {
    let mut sorted: Vec<[f64; 2]> = points.iter().map(|point| [point.x, of(point)]).collect();
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
        (Class::Rejected, "rejected", Style::nth(0).colour(Colour::Grey).dash(Dash::Dotted)),
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

/// Two bars, the interval on the second, and the noise below which no model comes. `noun` says what was held out.
pub fn held_out(noun: &str, data: &HeldOut) -> Figure {
    let mut chart = Chart::new(format!("error of held-out {noun}"), "root mean square / µm", "");
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
        let ends = [low, high].map(|x| vec![[x, -1.46], [x, -1.3]]);
        for points in [vec![[low, -1.38], [high, -1.38]]].into_iter().chain(ends) {
            chart.marks.push(Mark::Line { label: "95 % interval".into(), points, style });
        }
    }
    if drawable(data.noise_um) {
        let text = format!("noise {}\u{a0}µm", typeset(&significant(data.noise_um, 2)));
        chart.marks.push(Mark::Vertical { at: data.noise_um, text });
    }
    Figure::from(chart).named("held-out")
}

#[cfg(test)]
mod tests {
    use super::*;

    fn point(x: f64, before_um: f64, after_um: f64) -> ResidualPoint {
        ResidualPoint { x, before_um, after_um, unexplained_um: 0.0 }
    }

    #[test]
    fn lines_have_one_point_per_value() {
        let points = [point(2.0, 9.0, 1.0), point(1.0, 3.0, -1.0), point(2.0, 7.0, 1.0)];
        assert_eq!(averages(&points, |p| p.before_um - p.after_um), [[1.0, 4.0], [2.0, 7.0]]);
    }

    #[test]
    fn lines_do_not_bridge_the_gaps_between_runs() {
        let points = [1.0, 2.0, 3.0, 30.0, 31.0].map(|x| [x, 0.0]).to_vec();
        let lengths: Vec<usize> = unbroken(points).iter().map(Vec::len).collect();
        assert_eq!(lengths, [3, 2]);
    }

    #[test]
    fn both_panels_have_one_scale_and_one_is_enough_where_nothing_was_found() {
        let figure = |after| {
            let points = vec![point(5.0, 40.0, after), point(10.0, 40.0, 40.0)];
            let series = vec![Residual { label: "dz".into(), points, is_context: false }];
            before_after(&BeforeAfter { series, noise_um: 1.0, ..BeforeAfter::default() })
        };
        let both = figure(1.0);
        assert_eq!(both.panels[0].y.range, both.panels[1].y.range);
        assert_eq!(figure(40.0).panels.len(), 1);
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
        held_out("readings", &HeldOut { before_um: f64::NAN, ..HeldOut::default() }).svg();
    }
}
