//! Residuals before and after, along a number, with what happened there.

use serde::Serialize;

use super::super::super::chart::{Chart, Colour, Dash, Figure, Mark, Marker, Point, Range, Style};
use super::super::super::scale::{drawable, extent};
use super::{CLOUD_PX, MANY, padded};
use crate::statistics::median;

/// So many times the usual distance of points is a gap.
const GAP: f64 = 3.0;
/// Mean square of a series' steps over its variance (von Neumann 1941) from which on none is drawn
/// as a line, but as points: it is 2 where neighbours have nothing in common, and a line through
/// many of them would be ink.
const JAGGED: f64 = 1.0;
/// Heights of the plot of one panel, and of one among several below one another, px.
const HEIGHT: f64 = 190.0;
const ROW_HEIGHT: f64 = 120.0;
/// Room above the data for the name of an event, px, and for so many of them at most.
const LANE: f64 = 16.0;
const LANES: usize = 6;

/// What a model leaves of the readings, before and after something was taken into account, along a
/// number.
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
    /// Every series in panels of its own, for clouds that would hide one another.
    pub is_apart: bool,
    /// What happened, and where along the number.
    pub events: Vec<Event>,
}

/// Something that happened.
#[derive(Debug, Clone, Default, PartialEq, Serialize)]
pub struct Event {
    /// Where along the number.
    pub at: f64,
    /// What, in a few words.
    pub text: String,
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

/// What one panel shows: its title, the residual, what is said of it, and the name of that.
type Shown = (&'static str, fn(&ResidualPoint) -> f64, fn(&ResidualPoint) -> f64, &'static str);

/// Two panels to the same scale, or one where nothing was found. Lines show what the findings say,
/// and what no effect explains; bands are twice the noise. Where a number repeats, series stand
/// beside one another.
pub fn before_after(data: &BeforeAfter) -> Figure {
    let found = |p: &ResidualPoint| p.before_um - p.after_um;
    let (found_says, unexplained) = ("explained by the findings", "unexplained");
    let mut points = data.series.iter().flat_map(|series| &series.points);
    let shown: Vec<Shown> = match points.all(|p| found(p) == 0.0) {
        true => vec![("residuals of the model", |p| p.after_um, |p| p.unexplained_um, unexplained)],
        false => vec![
            ("before: the model as it is", |p| p.before_um, found, found_says),
            ("after: with the findings", |p| p.after_um, |p| p.unexplained_um, unexplained),
        ],
    };
    let layout = Layout::of(data);
    let mut panels: Vec<Chart> = Vec::new();
    for row in layout.rows() {
        for shown in &shown {
            panels.push(layout.panel(row, shown));
        }
    }
    // the events are named once, above all panels of the first row
    let lanes = data.events.len().min(LANES) as f64 * LANE;
    for (k, panel) in panels.iter_mut().enumerate() {
        if k < shown.len() && lanes > 0.0 {
            let height = panel.height_px.unwrap_or(HEIGHT);
            let Range::Fixed(low, high) = panel.y.range else { continue };
            panel.y.range = Range::Fixed(low, high + (high - low) * lanes / height);
            panel.height_px = Some(height + lanes);
        }
        panel.marks.extend(data.events.iter().map(|event| {
            let text = if k == 0 { event.text.clone() } else { String::new() };
            Mark::Event { at: event.at, text }
        }));
    }
    let name = "before-after".into();
    Figure { name, panels, columns: 2, shared_legend: true, ..Figure::default() }
}

/// What all panels have in common.
struct Layout<'a> {
    data: &'a BeforeAfter,
    noise: f64,
    x: (f64, f64),
    y: (f64, f64),
    /// Values of the number repeat.
    repeats: bool,
    /// How far series stand beside one another.
    beside: f64,
}

impl<'a> Layout<'a> {
    fn of(data: &'a BeforeAfter) -> Self {
        let all = || data.series.iter().flat_map(|series| &series.points);
        let x = padded(extent(all().map(|p| p.x)), 0.06);
        let noise = Some(2.0 * data.noise_um).filter(|noise| drawable(*noise)).unwrap_or_default();
        let y = padded(extent(all().flat_map(|p| [p.before_um, p.after_um]).chain([-noise, noise])), 0.06);
        let mut told_apart = data.series.iter().filter(|series| !series.is_context);
        let repeats = told_apart.any(|s| 2 * averages(&s.points, |_| 0.0).len() <= s.points.len());
        let beside = if repeats && !data.is_apart { 0.014 * (x.1 - x.0) } else { 0.0 };
        Layout { data, noise, x, y, repeats, beside }
    }

    /// The series of each row of panels.
    fn rows(&self) -> Vec<&'a [Residual]> {
        match self.data.is_apart {
            true => self.data.series.chunks(1).collect(),
            false => vec![&self.data.series],
        }
    }

    fn panel(&self, row: &[Residual], shown: &Shown) -> Chart {
        let (low, high) = self.x;
        let title = match row {
            [series] if self.data.is_apart => format!("{}, {}", series.label, shown.0),
            _ => shown.0.to_owned(),
        };
        let mut chart = Chart::new(title, &self.data.along, "measured − modelled / µm");
        chart.x.names = self.data.names.clone();
        (chart.x.range, chart.y.range) = (Range::Fixed(low, high), Range::Fixed(self.y.0, self.y.1));
        if self.data.is_apart && self.data.series.len() > 1 {
            chart.height_px = Some(ROW_HEIGHT);
            chart.y.label = "residual / µm".into();
        }
        chart.marks.push(Mark::Band {
            label: "± 2 σ of the scatter".into(),
            points: [low, high].map(|x| [x, -self.noise, self.noise]).to_vec(),
            style: Style::nth(0).colour(Colour::SkyBlue),
        });
        chart.marks.push(Mark::Line {
            label: String::new(),
            points: vec![[low, 0.0], [high, 0.0]],
            style: Style::nth(0).colour(Colour::Grey).width(1.0).dash(Dash::Solid),
        });
        let mut lines = Vec::new();
        let middle = (row.len() as f64 - 1.0) / 2.0;
        for (i, series) in row.iter().enumerate() {
            let shift = (i as f64 - middle) * self.beside;
            let (points, said) = match self.data.is_apart {
                true => cloud(series, shown, self.is_jagged(shown)),
                false => self.series(i, series, shift, shown),
            };
            chart.marks.push(points);
            lines.extend(said);
        }
        chart.marks.extend(lines);
        chart
    }

    /// Whether what is said of any series jumps at every point.
    fn is_jagged(&self, (_, _, said, _): &Shown) -> bool {
        self.data.series.iter().any(|series| is_jagged(&averages(&series.points, said)))
    }

    /// Points and lines of one series among others.
    fn series(
        &self,
        i: usize,
        series: &Residual,
        shift: f64,
        (_, residual, said, words): &Shown,
    ) -> (Mark, Vec<Mark>) {
        let style = match series.is_context {
            true => Style::nth(0).colour(Colour::Grey),
            false => Style::nth(i),
        };
        let look = style.size(if series.points.len() > MANY { 2.0 } else { 3.0 });
        let point = |p: &ResidualPoint| Point { x: p.x + shift, y: residual(p), error: 0.0 };
        let points = series.points.iter().map(point).collect();
        let points = Mark::Points { label: series.label.clone(), points, style: look };
        let mut line = averages(&series.points, said);
        line.iter_mut().for_each(|point| point[0] += shift);
        if series.is_context || line.iter().all(|point| point[1] == 0.0) {
            return (points, Vec::new());
        }
        let style = style.dash(Dash::Solid).width(1.2);
        let stretches = if self.repeats { vec![line] } else { unbroken(line) };
        let of_stretch = |points| Mark::Line { label: (*words).into(), points, style };
        (points, stretches.into_iter().map(of_stretch).collect())
    }
}

/// A dense series by itself: a grey cloud, and what is said of it in black.
fn cloud(series: &Residual, (_, residual, said, words): &Shown, is_jagged: bool) -> (Mark, Vec<Mark>) {
    let dots = |label: &str, points: Vec<[f64; 2]>, colour: Colour| Mark::Points {
        label: label.into(),
        points: points.into_iter().map(|[x, y]| Point { x, y, error: 0.0 }).collect(),
        style: Style::nth(0).colour(colour).marker(Marker::Dot).size(CLOUD_PX),
    };
    let left = series.points.iter().map(|p| [p.x, residual(p)]).collect();
    let line = averages(&series.points, said);
    let said = if line.iter().all(|point| point[1] == 0.0) {
        Vec::new()
    } else if is_jagged {
        vec![dots(words, line, Colour::Black)]
    } else {
        let style = Style::nth(0).dash(Dash::Solid).width(1.6);
        let of_stretch = |points| Mark::Line { label: (*words).into(), points, style };
        unbroken(line).into_iter().map(of_stretch).collect()
    };
    (dots("measured", left, Colour::Grey), said)
}

/// Whether neighbours have little in common.
fn is_jagged(line: &[[f64; 2]]) -> bool {
    let mean = line.iter().map(|point| point[1]).sum::<f64>() / line.len().max(1) as f64;
    let variance: f64 = line.iter().map(|point| (point[1] - mean).powi(2)).sum();
    let steps: f64 = line.windows(2).map(|pair| (pair[1][1] - pair[0][1]).powi(2)).sum();
    steps > JAGGED * variance
}

/// Points that follow one another, without the gaps between runs.
fn unbroken(points: Vec<[f64; 2]>) -> Vec<Vec<[f64; 2]>> {
    let gaps: Vec<f64> = points.windows(2).map(|pair| pair[1][0] - pair[0][0]).collect();
    let usual = median(&gaps).unwrap_or_default();
    points.chunk_by(|a, b| b[0] - a[0] <= GAP * usual).map(<[_]>::to_vec).collect()
}

/// A number of the points, averaged where they stand at the same place.
fn averages(points: &[ResidualPoint], value: impl Fn(&ResidualPoint) -> f64) -> Vec<[f64; 2]> {
    let mut sorted: Vec<[f64; 2]> = points.iter().map(|point| [point.x, value(point)]).collect();
    sorted.sort_by(|a, b| a[0].total_cmp(&b[0]));
    let same = sorted.chunk_by(|a, b| a[0] == b[0]);
    same.map(|group| [group[0][0], group.iter().map(|p| p[1]).sum::<f64>() / group.len() as f64]).collect()
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

    /// Three series of many poses with events.
    fn apart(events: Vec<Event>) -> BeforeAfter {
        let points: Vec<ResidualPoint> =
            (0..100).map(|k| point(f64::from(k), if k < 50 { 1.0 } else { 90.0 }, 1.0)).collect();
        let of_label =
            |label: &str| Residual { label: label.into(), points: points.clone(), is_context: false };
        let series = ["x", "y", "z"].map(of_label).to_vec();
        BeforeAfter { series, noise_um: 1.0, is_apart: true, events, ..BeforeAfter::default() }
    }

    #[test]
    fn dense_series_stand_apart_with_their_lines_above_them() {
        let figure = before_after(&apart(Vec::new()));
        assert_eq!((figure.panels.len(), figure.columns), (6, 2));
        let has_line = |chart: &Chart| {
            chart.marks.iter().any(|mark| matches!(mark, Mark::Line { label, .. } if !label.is_empty()))
        };
        assert!(has_line(&figure.panels[0]) && !has_line(&figure.panels[1]));
    }

    #[test]
    fn what_jumps_at_every_pose_is_no_line() {
        assert!(is_jagged(&[0.0, 1.0, 0.0, 1.0, 0.0].map(|y| [0.0, y])));
        assert!(!is_jagged(&[0.0, 0.1, 1.0, 0.9, 1.0].map(|y| [0.0, y])));
    }

    #[test]
    fn events_are_marked_in_every_panel_and_named_once_above_the_data() {
        let event = |at: f64| Event { at, text: format!("clamp {at} moved") };
        let (without, figure) =
            (before_after(&apart(Vec::new())), before_after(&apart(vec![event(49.5), event(52.5)])));
        for panel in &figure.panels {
            let at = panel.marks.iter().filter_map(|mark| match mark {
                Mark::Event { at, .. } => Some(*at),
                _ => None,
            });
            assert_eq!(at.collect::<Vec<_>>(), [49.5, 52.5]);
        }
        let svg = figure.svg();
        assert_eq!(svg.matches("clamp 49.5 moved").count(), 1);
        assert_eq!(svg.matches("clamp 52.5 moved").count(), 1);
        let top = |figure: &Figure| match figure.panels[0].y.range {
            Range::Fixed(_, top) => top,
            _ => f64::NAN,
        };
        assert!(top(&figure) > 1.2 * top(&without), "names lie over the data");
        assert_eq!(figure.panels[0].y.range, figure.panels[1].y.range);
    }

    #[test]
    fn nothing_to_show_is_shown_as_nothing() {
        before_after(&BeforeAfter::default()).svg();
        before_after(&BeforeAfter { is_apart: true, ..BeforeAfter::default() }).svg();
    }
}
