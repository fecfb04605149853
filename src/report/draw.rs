//! Lays out a figure: panels, titles, axes, legends. What is drawn inside the axes is in `marks`.

use super::axes::{has_bars, scales};
use super::chart::{Chart, Dash, Figure};
use super::frame::{Frame, NOTE};
use super::labels::{Area, LabelPlacer, text_width_px, wrap};
use super::legend::Legend;
use super::marks;
use super::plot::{Anchor, Canvas, Lettering, Rgb};
use super::prefix::relabelled;
use super::scale::Scale;

/// Width of every figure: the text column of the page.
const WIDTH_PX: f64 = 760.0;
const GAP_PX: f64 = 28.0;
const EDGE_PX: f64 = 8.0;
const TICK_PX: f64 = 4.0;

const LABEL: Lettering = Lettering { size_px: 12.5, ..NOTE };
const TITLE: Lettering = Lettering { size_px: 13.5, bold: true, anchor: Anchor::Left, upwards: false };
const TITLE_LINE_PX: f64 = 18.0;
/// Between title and axes, where half of the topmost tick label stands.
const TITLE_GAP_PX: f64 = 9.0;

impl Figure {
    /// The figure as an SVG document, 760 CSS pixels wide. It holds no ids, so many fit into one
    /// page; the caption becomes its description, for screen readers, and is not drawn.
    pub fn svg(&self) -> String {
        draw(self)
    }
}

fn draw(figure: &Figure) -> String {
    let columns = figure.columns.clamp(1, figure.panels.len().max(1));
    let width = (WIDTH_PX - 2.0 * EDGE_PX - GAP_PX * (columns - 1) as f64) / columns as f64;
    let mut plans = plan(figure, columns, width);
    let shared = figure
        .shared_legend
        .then(|| Legend::new(figure.panels.iter().flat_map(|c| &c.marks), WIDTH_PX - 2.0 * EDGE_PX));

    let mut top = EDGE_PX;
    for row in plans.chunks_mut(columns) {
        let title_lines = row.iter().map(|p| p.title.len()).max().unwrap_or(0);
        for (i, plan) in row.iter_mut().enumerate() {
            plan.move_by(top + title_lines as f64 * TITLE_LINE_PX, EDGE_PX + i as f64 * (width + GAP_PX));
        }
        top = row.iter().map(Plan::bottom).fold(top, f64::max) + EDGE_PX;
    }
    let height = top + shared.as_ref().map_or(0.0, |legend| legend.height_px + EDGE_PX);

    let mut canvas = Canvas::new(WIDTH_PX, height);
    canvas.fill(&Area { left: 0.0, top: 0.0, right: WIDTH_PX, bottom: height }.corners(), Rgb::WHITE);
    for plan in &plans {
        plan.draw(&mut canvas);
    }
    if let Some(legend) = shared {
        legend.draw(&mut canvas, [EDGE_PX, top]);
    }
    let titles: Vec<&str> = figure.panels.iter().map(|c| c.title.as_str()).collect();
    canvas.finish(&titles.join("; "), &figure.caption)
}

fn plan<'a>(figure: &'a Figure, columns: usize, width: f64) -> Vec<Plan<'a>> {
    let lettered = figure.panels.len() > 1;
    // Axes that stand below one another stand exactly below one another.
    let left = |column: usize| {
        figure.panels.iter().skip(column).step_by(columns).map(|c| left_margin(c, width)).fold(0.0, f64::max)
    };
    let all = |least_unit: f64| -> Vec<Plan<'a>> {
        let plan = |(i, chart): (usize, &'a Chart)| {
            let letter = char::from(b'a' + (i % 26) as u8);
            let lettered = lettered && !chart.title.is_empty();
            let title = if lettered { format!("({letter}) {}", chart.title) } else { chart.title.clone() };
            Plan::new(chart, &title, left(i % columns), width, least_unit, !figure.shared_legend)
        };
        figure.panels.iter().enumerate().map(plan).collect()
    };
    // Drawings of things in one figure are drawn to one scale, the smallest of theirs.
    let drawings = all(0.0);
    let units = drawings.iter().filter(|p| p.chart.equal_aspect).map(|p| p.frame.unit_per_px());
    match units.fold(0.0, f64::max) {
        0.0 => drawings,
        unit => all(unit),
    }
}

/// Where everything of one chart stands.
struct Plan<'a> {
    chart: &'a Chart,
    title: Vec<String>,
    frame: Frame,
    left: f64,
    legend: Option<Legend<'a>>,
}

impl<'a> Plan<'a> {
    fn new(chart: &'a Chart, title: &str, left: f64, width: f64, least_unit: f64, with_legend: bool) -> Self {
        let plot_width = (width - left - right_margin(chart)).max(60.0);
        let (x, y, plot_height) = scales(chart, plot_width, least_unit);
        let area = Area { left, top: 0.0, right: left + plot_width, bottom: plot_height };
        Plan {
            chart,
            title: wrap(title, TITLE.size_px * 1.1, width),
            frame: Frame { area, x, y },
            left: 0.0,
            legend: with_legend.then(|| Legend::new(&chart.marks, plot_width)),
        }
    }

    /// Moves the chart, which so far stands at the origin, to its place.
    fn move_by(&mut self, by_y: f64, by_x: f64) {
        let area = &mut self.frame.area;
        (area.top, area.bottom) = (area.top + by_y + TITLE_GAP_PX, area.bottom + by_y + TITLE_GAP_PX);
        (area.left, area.right) = (area.left + by_x, area.right + by_x);
        self.left = by_x;
    }

    /// Of both axes, with the units of their ticks.
    fn labels(&self) -> [String; 2] {
        let Frame { x, y, .. } = &self.frame;
        [relabelled(&self.chart.x.label, x.power), relabelled(&self.chart.y.label, y.power)]
    }

    fn legend_top(&self) -> f64 {
        let bottom = self.frame.area.bottom;
        match (self.chart.frameless, self.chart.x.label.is_empty()) {
            (true, _) => bottom,
            (false, true) => bottom + TICK_PX + 18.0,
            (false, false) => bottom + TICK_PX + 38.0,
        }
    }

    fn bottom(&self) -> f64 {
        self.legend_top() + self.legend.as_ref().map_or(0.0, |legend| legend.height_px)
    }

    fn draw(&self, canvas: &mut Canvas) {
        let area = self.frame.area;
        for (i, line) in self.title.iter().rev().enumerate() {
            let y = area.top - TITLE_GAP_PX - (i as f64 + 0.5) * TITLE_LINE_PX;
            canvas.text([self.left, y], line, TITLE, Rgb::INK);
        }
        if self.chart.frameless && self.chart.marks.is_empty() {
            return;
        }
        if marks::extents(self.chart, area.width()) == (None, None) {
            canvas.text(area.centre(), "no data", NOTE, Rgb::GREY);
        } else if !self.chart.frameless {
            self.grid(canvas);
            let axis = |scale: &Scale, names: &[(f64, String)]| {
                let one = 10f64.powi(scale.power);
                names.is_empty().then_some((scale.from / one, scale.to / one, scale.log))
            };
            let (chart, [x_label, y_label]) = (self.chart, self.labels());
            canvas.panel(
                [[area.left, area.top], [area.right, area.bottom]],
                [
                    (axis(&self.frame.x, &chart.x.names), &x_label),
                    (axis(&self.frame.y, &chart.y.names), &y_label),
                ],
            );
        }
        let mut labels = LabelPlacer::new(area);
        marks::draw(canvas, &self.frame, &self.chart.marks, &mut labels);
        if !self.chart.frameless {
            self.axes(canvas);
        }
        if let Some(legend) = &self.legend {
            legend.draw(canvas, [area.left, self.legend_top()]);
        }
    }

    fn grid(&self, canvas: &mut Canvas) {
        let (frame, area) = (&self.frame, self.frame.area);
        // Zero matters to a quantity; on a drawing it would only be one more line.
        let zero = !self.chart.equal_aspect;
        let strength = |value: f64| if zero && value == 0.0 { Rgb::GREY.tint(0.7) } else { Rgb::FAINT };
        if self.chart.x.names.is_empty() {
            for (value, _) in &frame.x.ticks {
                let x = frame.px([*value, 0.0])[0];
                canvas.line(&[[x, area.top], [x, area.bottom]], strength(*value), 0.8, Dash::Solid);
            }
        }
        // Bars lead the eye to their names by themselves, points do not.
        if self.chart.y.names.is_empty() || !has_bars(self.chart) {
            for (value, _) in &frame.y.ticks {
                let y = frame.px([0.0, *value])[1];
                canvas.line(&[[area.left, y], [area.right, y]], strength(*value), 0.8, Dash::Solid);
            }
        }
    }

    fn axes(&self, canvas: &mut Canvas) {
        let (frame, area) = (&self.frame, self.frame.area);
        canvas.line(
            &[[area.left, area.top], [area.left, area.bottom], [area.right, area.bottom]],
            Rgb::INK,
            1.0,
            Dash::Solid,
        );
        for (value, label) in &frame.x.ticks {
            let x = frame.px([*value, 0.0])[0];
            if self.chart.x.names.is_empty() {
                canvas.line(&[[x, area.bottom], [x, area.bottom + TICK_PX]], Rgb::INK, 1.0, Dash::Solid);
            }
            canvas.text([x, area.bottom + TICK_PX + 9.0], label, NOTE, Rgb::INK);
        }
        let at_right = Lettering { anchor: Anchor::Right, ..NOTE };
        for (value, label) in &frame.y.ticks {
            let y = frame.px([0.0, *value])[1];
            if self.chart.y.names.is_empty() {
                canvas.line(&[[area.left - TICK_PX, y], [area.left, y]], Rgb::INK, 1.0, Dash::Solid);
            }
            canvas.text([area.left - TICK_PX - 4.0, y], label, at_right, Rgb::INK);
        }
        let [middle_x, middle_y] = area.centre();
        let [x_label, y_label] = self.labels();
        canvas.text([middle_x, area.bottom + TICK_PX + 28.0], &x_label, LABEL, Rgb::INK);
        let upwards = Lettering { upwards: true, ..LABEL };
        canvas.text([self.left + 8.0, middle_y], &y_label, upwards, Rgb::INK);
    }
}

/// Room left of the plotting area: axis label and tick labels.
fn left_margin(chart: &Chart, width: f64) -> f64 {
    if chart.frameless {
        return 0.0;
    }
    let (_, y, _) = scales(chart, 0.8 * width, 0.0);
    let widest = y.ticks.iter().map(|(_, label)| text_width_px(label, NOTE.size_px)).fold(0.0, f64::max);
    let label = if chart.y.label.is_empty() { 0.0 } else { 22.0 };
    label + widest.min(0.5 * width) + TICK_PX + 6.0
}

/// Room right of the plotting area: half of the last tick label.
fn right_margin(chart: &Chart) -> f64 {
    let (x, _, _) = scales(chart, 300.0, 0.0);
    x.ticks.last().map_or(0.0, |(_, label)| 0.5 * text_width_px(label, NOTE.size_px)).clamp(6.0, 40.0)
}

#[cfg(test)]
mod tests {
    use roxmltree::Document;

    use super::super::chart::{Align, Bar, Direction, Mark, Marker, Point, Range, Style};
    use super::*;

    fn every_mark(values: [f64; 3]) -> Chart {
        let [a, b, c] = values;
        let label = || "<&>\u{1}".to_owned();
        let style = Style::nth(3);
        let bars = |direction| Mark::Bars {
            label: label(),
            bars: vec![Bar { from: a, to: b, base: b, value: c, text: label() }],
            direction,
            style,
        };
        Chart::new(label(), "x / mm", "y / µm")
            .with(Mark::Line { label: label(), points: vec![[a, b], [b, c], [c, a]], style })
            .with(Mark::Points { label: label(), points: vec![Point { x: a, y: b, error: c }], style })
            .with(bars(Direction::Up))
            .with(bars(Direction::Right))
            .with(Mark::Band { label: label(), points: vec![[a, b, c], [b, c, a]], style })
            .with(Mark::Horizontal { at: a, text: label() })
            .with(Mark::Vertical { at: b, text: label() })
            .with(Mark::Stretch { from: b, to: c, text: label() })
            .with(Mark::Event { at: c, text: label() })
            .with(Mark::Area { label: label(), corners: vec![[a, b], [b, c], [c, a]], style })
            .with(Mark::Text { at: [b, a], text: label(), align: Align::Left })
            .with(Mark::Note { at: [a, c], text: label() })
            .with(Mark::Arrow { from: [a, b], to: [b, c], text: label(), style })
    }

    #[test]
    fn whatever_the_data_the_picture_is_well_formed() {
        let odd = [0.0, -0.0, 1.0, -7.0, f64::NAN, f64::INFINITY, f64::NEG_INFINITY, 1e300, -1e199, 1e-300];
        for (i, a) in odd.into_iter().enumerate() {
            for b in odd {
                let mut chart = every_mark([a, b, odd[(i + 1) % odd.len()]]);
                chart.x.log = i % 2 == 1;
                chart.y.log = i % 3 == 1;
                for equal_aspect in [false, true] {
                    chart.equal_aspect = equal_aspect;
                    let svg = Figure::from(chart.clone()).svg();
                    assert!(Document::parse(&svg).is_ok() && !svg.contains("NaN"), "{a} {b}\n{svg}");
                }
                chart.x.range = Range::Fixed(a, b);
                chart.y.step = Some(a);
                chart.height_px = Some(b);
                chart.y.names = vec![(a, "name".into()), (b, "other".into())];
                chart.frameless = i % 2 == 0;
                let svg = Figure::from(chart).svg();
                assert!(Document::parse(&svg).is_ok() && !svg.contains("NaN"), "{a} {b}\n{svg}");
            }
        }
        Figure::default().svg();
        Figure { columns: 3, shared_legend: true, ..Figure::default() }.svg();
    }

    #[test]
    fn a_curve_is_seen_through_its_cloud_and_single_points_lie_on_theirs() {
        let is_above = |marker| {
            let points = vec![Point { x: 1.0, y: 1.0, error: 0.0 }; 3];
            let svg = Figure::from(
                Chart::new("", "", "")
                    .with(Mark::Line {
                        label: String::new(),
                        points: vec![[0.0, 0.0], [2.0, 2.0]],
                        style: Style::nth(1),
                    })
                    .with(Mark::Points { label: String::new(), points, style: Style::nth(0).marker(marker) }),
            )
            .svg();
            svg.rfind("<circle").expect("points") > svg.find("#D55E00").expect("the curve")
        };
        assert!(!is_above(Marker::Dot) && is_above(Marker::Circle));
    }

    #[test]
    fn the_view_box_is_the_size_ten_times_and_there_are_no_ids() {
        let panels = vec![every_mark([1.0, 2.0, 3.0]); 3];
        let svg = Figure { panels, columns: 2, caption: "Caption".into(), ..Figure::default() }.svg();
        let document = Document::parse(&svg).expect("is XML");
        let root = document.root_element();
        let number = |name| root.attribute(name).and_then(|v| v.parse::<f64>().ok()).expect("is a number");
        let view_box = format!("0 0 {} {}", 10.0 * number("width"), 10.0 * number("height"));
        assert_eq!(root.attribute("viewBox"), Some(view_box.as_str()));
        assert!(document.descendants().all(|node| node.attribute("id").is_none()));
        assert!(svg.contains("<desc>Caption</desc>") && svg.contains("(c) "), "{svg}");
    }
}
