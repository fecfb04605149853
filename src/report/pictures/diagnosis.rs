//! The pictures of a diagnosis: residuals before and after, how likely each effect is, errors of
//! held-out readings.

mod angle;
mod law;
mod residual;

pub use angle::{AngleError, angle_errors};
pub use law::{LawPanel, law_picture};
pub use residual::{BeforeAfter, Event, Residual, ResidualPoint, before_after};

use serde::Serialize;

use super::super::chart::{Axis, Bar, Chart, Colour, Dash, Direction, Figure, Mark, Range, Style};
use super::super::scale::{drawable, superscript, typeset};
use crate::units::significant;

/// More points of one series are drawn small.
const MANY: usize = 60;
/// Half the size of a point in a cloud, px.
const CLOUD_PX: f64 = 1.6;

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
    let mut chart = Chart::new("how likely each effect is by itself", "odds against noise alone", "");
    let row = |i: usize| -(i as f64);
    let names = candidates.iter().enumerate().map(|(i, c)| (row(i), c.name.clone())).collect();
    // above the bars stands what their names are given from
    let range = Range::Fixed(row(candidates.len()) + 0.4, 1.4);
    chart.y = Axis { names, range, ..Axis::default() };
    chart.height_px = Some(40.0 + 19.0 * candidates.len() as f64);
    let looks = [
        (Class::Adopted, "adopted", Style::nth(0).colour(Colour::Vermilion)),
        (Class::Rival, "indistinguishable", Style::nth(0).colour(Colour::Orange).dash(Dash::Dashed)),
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
                text: to_one(c.log10_odds),
                ..Bar::default()
            })
            .collect();
        if !bars.is_empty() {
            chart.marks.push(Mark::Bars { label: label.into(), bars, direction: Direction::Right, style });
        }
    }
    chart.x.names = powers(candidates);
    let text = to_one(named_from.log10());
    chart.marks.push(Mark::Vertical { at: named_from.log10(), text });
    Figure::from(chart).named("ranking")
}

/// Odds by their power of ten: `20 : 1`, `1 : 160`, `10³¹ : 1`.
pub fn to_one(log10_odds: f64) -> String {
    let size = log10_odds.abs();
    let number = match size {
        0.0 => "1".to_owned(),
        _ if size < 4.0 => significant(10f64.powf(size), 2),
        _ => format!("10{}", superscript(size.round() as i32)),
    };
    if log10_odds >= 0.0 { format!("{number} : 1") } else { format!("1 : {number}") }
}

/// Ticks at whole powers of ten, about six of them.
fn powers(candidates: &[Candidate]) -> Vec<(f64, String)> {
    let drawn = candidates.iter().map(|candidate| candidate.log10_odds).filter(|odds| drawable(*odds));
    let (low, high) = drawn.fold((0.0f64, 2.0f64), |(low, high), odds| (low.min(odds), high.max(odds)));
    let step = ((high - low) / 6.0).ceil().max(1.0);
    // the axis ends at its outer ticks: beyond every bar and its number
    let room = if low < 0.0 { 0.15 * (high - low) } else { 0.0 };
    let ticks = ((low - room) / step).floor() as i64..=(1.1 * high / step).ceil() as i64;
    ticks.map(|k| (k as f64 * step, to_one(k as f64 * step))).collect()
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

/// Two bars, the interval on the second, and the noise below which no model comes. `noun` says what
/// was held out, `per` of what the root mean square is: nothing, or ` per coordinate`.
pub fn held_out((noun, per): (&str, &str), data: &HeldOut) -> Figure {
    let mut chart =
        Chart::new(format!("error of held-out {noun}"), format!("root mean square{per} / µm"), "");
    chart.y.names = vec![(0.0, "model as it is".into()), (-1.0, "with the findings".into())];
    chart.y.range = Range::Fixed(-1.6, 0.6);
    chart.height_px = Some(110.0);
    let bar = |row: f64, value: f64, label: &str, style: Style| Mark::Bars {
        label: label.into(),
        bars: vec![Bar {
            from: row - 0.3,
            to: row + 0.3,
            value,
            text: typeset(&significant(value, 3)),
            ..Bar::default()
        }],
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
        let text = format!("scatter {}\u{a0}µm", typeset(&significant(data.noise_um, 2)));
        chart.marks.push(Mark::Vertical { at: data.noise_um, text });
    }
    Figure::from(chart).named("held-out")
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::report::draw::{Medium, draw};

    #[test]
    fn a_candidate_without_odds_has_no_bar_but_a_name() {
        let candidate =
            Candidate { name: "creep".into(), log10_odds: f64::NEG_INFINITY, class: Class::Rejected };
        assert!(ranking(&[candidate], 20.0).svg().contains("creep"));
    }

    /// A bar that leaves no room on the left, where the names are, has its number on the right.
    #[test]
    fn a_number_never_stands_on_a_name() {
        let candidate = |log10_odds| Candidate { name: "creep".into(), log10_odds, class: Class::Rejected };
        let figure = ranking(&[candidate(-132.0), candidate(-40.0)], 20.0);
        // of two texts that say so one is the tick
        let anchors = |svg: &str, text: &str| -> Vec<Option<String>> {
            let document = roxmltree::Document::parse(svg).expect("is XML");
            let is_it =
                |node: &roxmltree::Node| node.is_element() && node.text().is_some_and(|t| t.trim() == text);
            let anchor = |node: roxmltree::Node| node.attribute("text-anchor").map(str::to_owned);
            document.descendants().filter(is_it).map(anchor).collect()
        };
        let end = Some("end".to_owned());
        // a wide axis goes on beyond the bar, a narrow one cannot
        let (wide, narrow) = (figure.svg(), draw(&figure, Medium::Telephone).svg);
        assert!(anchors(&wide, &to_one(-132.0)).contains(&end), "{:?}", anchors(&wide, &to_one(-132.0)));
        assert!(!anchors(&narrow, &to_one(-132.0)).contains(&end), "{:?}", anchors(&narrow, &to_one(-132.0)));
        assert_eq!(anchors(&wide, &to_one(-40.0)), [end]);
    }

    #[test]
    fn nothing_to_show_is_shown_as_nothing() {
        ranking(&[], 20.0).svg();
        held_out(("readings", ""), &HeldOut { before_um: f64::NAN, ..HeldOut::default() }).svg();
    }
}
