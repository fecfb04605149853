//! Lays out a figure: panels, titles, axes, legends. What is drawn inside the axes is in `marks`.

#[cfg(test)]
mod tests;

use super::axes::{has_bars, has_room, scales};
use super::chart::{Axis, Chart, Dash, Figure};
use super::frame::{Frame, NOTE};
use super::labels::{Area, LabelPlacer, text_width_px, wrap};
use super::legend::Legend;
use super::marks;
use super::plot::{Anchor, Canvas, Lettering, PanelAxis, Rgb};
use super::scale::Scale;
use super::switch::{self, Ticks};

/// Width of a figure: the text column of a page.
const WIDTH_PX: f64 = 760.0;
/// Width of a figure on a telephone.
const NARROW_PX: f64 = 340.0;
const GAP_PX: f64 = 28.0;
const EDGE_PX: f64 = 8.0;
const TICK_PX: f64 = 4.0;

const LABEL: Lettering = Lettering { size_px: 12.5, ..NOTE };
const TITLE: Lettering = Lettering { size_px: 13.5, bold: true, anchor: Anchor::Left, upwards: false };
const TITLE_LINE_PX: f64 = 18.0;
/// Of names that need several lines.
const NAME_LINE_PX: f64 = 13.0;
/// Between title and axes, where half of the topmost tick label stands.
const TITLE_GAP_PX: f64 = 9.0;

impl Figure {
    /// The figure as an SVG document, 760 CSS pixels wide. It holds no ids, so many fit into one
    /// page; the caption becomes its description, for screen readers, and is not drawn.
    pub fn svg(&self) -> String {
        draw(self, Medium::File).svg
    }
}

/// Where a figure is looked at.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Medium {
    /// By itself.
    File,
    /// On a page whose script switches units: the axes in all of them, the first of which is seen.
    Page,
    /// The same on a telephone, panels below one another.
    Telephone,
}

impl Medium {
    fn width_px(self) -> f64 {
        if self == Medium::Telephone { NARROW_PX } else { WIDTH_PX }
    }
}

/// A figure as it is drawn.
pub(super) struct Drawing {
    /// The SVG document.
    pub svg: String,
    /// Higher than wide: on paper it has a sheet to itself.
    pub is_high: bool,
}

/// The figure as an SVG document for a medium.
pub(super) fn draw(figure: &Figure, medium: Medium) -> Drawing {
    let columns = match medium {
        Medium::Telephone => 1,
        Medium::File | Medium::Page => figure.columns.clamp(1, figure.panels.len().max(1)),
    };
    let full_width = medium.width_px();
    let width = (full_width - 2.0 * EDGE_PX - GAP_PX * (columns - 1) as f64) / columns as f64;
    let mut plans = plan(figure, columns, width, medium);
    let shared = figure
        .shared_legend
        .then(|| Legend::new(figure.panels.iter().flat_map(|c| &c.marks), full_width - 2.0 * EDGE_PX));

    let mut top = EDGE_PX;
    for row in plans.chunks_mut(columns) {
        let title_lines = row.iter().map(|p| p.title.len()).max().unwrap_or(0);
        for (i, plan) in row.iter_mut().enumerate() {
            plan.move_by(top + title_lines as f64 * TITLE_LINE_PX, EDGE_PX + i as f64 * (width + GAP_PX));
        }
        top = row.iter().map(Plan::bottom).fold(top, f64::max) + EDGE_PX;
    }
    let height = top + shared.as_ref().map_or(0.0, |legend| legend.height_px + EDGE_PX);

    let mut canvas = Canvas::new(full_width, height);
    canvas.fill(&Area { left: 0.0, top: 0.0, right: full_width, bottom: height }.corners(), Rgb::WHITE);
    for plan in &plans {
        plan.draw(&mut canvas);
    }
    if let Some(legend) = shared {
        legend.draw(&mut canvas, [EDGE_PX, top]);
    }
    Drawing { svg: canvas.finish(&spoken_title(figure), &figure.caption), is_high: height > full_width }
}

/// What the panels are called; where none has a title, what the picture is by its caption's first
/// sentence, or by its name.
fn spoken_title(figure: &Figure) -> String {
    let titles: Vec<&str> =
        figure.panels.iter().map(|c| c.title.as_str()).filter(|t| !t.is_empty()).collect();
    let first = figure.caption.split(". ").next().unwrap_or_default().trim_end_matches('.');
    match (titles.is_empty(), first.is_empty()) {
        (false, _) => titles.join("; "),
        (true, false) => first.to_owned(),
        (true, true) => figure.name.replace('-', " "),
    }
}

fn plan(figure: &Figure, columns: usize, width: f64, medium: Medium) -> Vec<Plan<'_>> {
    let lettered = figure.panels.len() > 1;
    let order = order(figure, columns);
    // Axes that stand below one another stand exactly below one another.
    let left = |column: usize| {
        let below = order.iter().skip(column).step_by(columns);
        let margin = |i: &usize| left_margin(&figure.panels[*i], width, medium, columns == 1);
        below.map(margin).fold(0.0, f64::max)
    };
    let all = |least_unit: f64| -> Vec<Plan<'_>> {
        let plan = |(place, i): (usize, &usize)| {
            let chart = &figure.panels[*i];
            let letter = char::from(b'a' + (i % 26) as u8);
            let lettered = lettered && !chart.title.is_empty();
            let title = if lettered { format!("({letter}) {}", chart.title) } else { chart.title.clone() };
            let room = Room { left: left(place % columns), width, least_unit, is_single: columns == 1 };
            Plan::new(chart, &title, &room, medium, !figure.shared_legend)
        };
        order.iter().enumerate().map(plan).collect()
    };
    // Drawings of things in one figure are drawn to one scale, the smallest of theirs.
    let drawings = all(0.0);
    let units = drawings.iter().filter(|p| p.chart.equal_aspect).map(|p| p.frame.unit_per_px());
    match units.fold(0.0, f64::max) {
        0.0 => drawings,
        unit => all(unit),
    }
}

/// The panels by their numbers, row by row. Where fewer stand side by side than were meant to, what
/// belongs together stays together, and a gap is none.
fn order(figure: &Figure, columns: usize) -> Vec<usize> {
    let all = 0..figure.panels.len();
    if columns >= figure.columns {
        return all.collect();
    }
    let is_gap = |i: &usize| figure.panels[*i].frameless && figure.panels[*i].marks.is_empty();
    let by_column = (0..figure.columns).flat_map(|column| all.clone().skip(column).step_by(figure.columns));
    let order: Vec<usize> = if figure.by_column { by_column.collect() } else { all.clone().collect() };
    order.into_iter().filter(|i| !is_gap(i)).collect()
}

/// Where a chart has to find its place.
struct Room {
    /// Of the axis, from the left edge.
    left: f64,
    width: f64,
    /// Of a drawing of things, least unit in each pixel.
    least_unit: f64,
    /// Whether nothing stands beside it.
    is_single: bool,
}

/// Where everything of one chart stands.
struct Plan<'a> {
    chart: &'a Chart,
    title: Vec<String>,
    frame: Frame,
    left: f64,
    /// The ticks of x and y, in every unit that can be asked for.
    ticks: [Vec<Ticks>; 2],
    /// Whether the labels of x and y are written.
    labelled: [bool; 2],
    legend: Option<Legend<'a>>,
}

impl<'a> Plan<'a> {
    fn new(chart: &'a Chart, title: &str, room: &Room, medium: Medium, with_legend: bool) -> Self {
        let plot_width = (room.width - room.left - right_margin(chart)).max(60.0);
        let (x, y, plot_height) = scales(chart, plot_width, room.least_unit);
        let area = Area { left: room.left, top: 0.0, right: room.left + plot_width, bottom: plot_height };
        let ticks =
            [all_ticks(&chart.x, &x, medium, Some(plot_width)), all_ticks(&chart.y, &y, medium, None)];
        let units = [&ticks[0], &ticks[1]].map(|sets| match medium {
            Medium::File => String::new(),
            Medium::Page | Medium::Telephone => sets.first().map_or_else(String::new, |set| set.unit.clone()),
        });
        // where panels moved, the label that they shared is below or beside none of the others
        let labelled = [!chart.x.is_label_hidden || !room.is_single, has_y_label(chart, room.is_single)];
        Plan {
            chart,
            title: wrap(title, TITLE.size_px * 1.1, room.width),
            frame: Frame { area, x, y, units },
            left: 0.0,
            ticks,
            labelled,
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

    /// Room below the ticks of x for their texts.
    fn names_px(&self) -> f64 {
        let widest = || self.chart.x.names.iter().map(|(_, name)| text_width_px(name, NOTE.size_px));
        if self.chart.x.names_upwards { widest().fold(10.0, f64::max) + 8.0 } else { 18.0 }
    }

    fn legend_top(&self) -> f64 {
        let bottom = self.frame.area.bottom;
        match (self.chart.frameless, self.chart.x.label.is_empty() || !self.labelled[0]) {
            (true, _) => bottom,
            (false, true) => bottom + TICK_PX + self.names_px(),
            (false, false) => bottom + TICK_PX + self.names_px() + 20.0,
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
            let axis = |scale: &Scale, names: &[(f64, String)], ticks: &[Ticks], unit: &String| {
                let one = 10f64.powi(scale.power);
                PanelAxis {
                    ends: names.is_empty().then_some((scale.from / one, scale.to / one, scale.log)),
                    label: ticks.first().map_or_else(String::new, |set| set.label.clone()),
                    unit: unit.clone(),
                }
            };
            let (chart, frame, [x, y]) = (self.chart, &self.frame, &self.ticks);
            canvas.panel(
                [[area.left, area.top], [area.right, area.bottom]],
                [
                    axis(&frame.x, &chart.x.names, x, &frame.units[0]),
                    axis(&frame.y, &chart.y.names, y, &frame.units[1]),
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

    /// Draws something for the ticks of an axis (0: x), once in every unit that can be asked for.
    fn in_each_unit(&self, canvas: &mut Canvas, axis: usize, draw: impl Fn(&mut Canvas, &Ticks)) {
        match &self.ticks[axis][..] {
            [only] => draw(canvas, only),
            sets => {
                for (k, set) in sets.iter().enumerate() {
                    canvas.begin_unit(&sets[0].unit, &set.unit, k == 0);
                    draw(canvas, set);
                    canvas.end_group();
                }
            }
        }
    }

    fn grid(&self, canvas: &mut Canvas) {
        let (frame, area) = (&self.frame, self.frame.area);
        // Zero matters to a quantity; on a drawing it would only be one more line.
        let zero = !self.chart.equal_aspect;
        let strength = |value: f64| if zero && value == 0.0 { Rgb::GREY.tint(0.7) } else { Rgb::FAINT };
        if self.chart.x.names.is_empty() {
            self.in_each_unit(canvas, 0, |canvas, set| {
                for (value, _) in &set.ticks {
                    let x = frame.px([*value, 0.0])[0];
                    canvas.line(&[[x, area.top], [x, area.bottom]], strength(*value), 0.8, Dash::Solid);
                }
            });
        }
        // Bars lead the eye to their names by themselves, points do not.
        if self.chart.y.names.is_empty() || !has_bars(self.chart) {
            self.in_each_unit(canvas, 1, |canvas, set| {
                for (value, _) in &set.ticks {
                    let y = frame.px([0.0, *value])[1];
                    canvas.line(&[[area.left, y], [area.right, y]], strength(*value), 0.8, Dash::Solid);
                }
            });
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
        let [middle_x, middle_y] = area.centre();
        self.in_each_unit(canvas, 0, |canvas, set| {
            for (value, label) in &set.ticks {
                let x = frame.px([*value, 0.0])[0];
                if self.chart.x.names.is_empty() {
                    canvas.line(&[[x, area.bottom], [x, area.bottom + TICK_PX]], Rgb::INK, 1.0, Dash::Solid);
                }
                let (below, lettering) = match self.chart.x.names_upwards {
                    true => (2.0, Lettering { anchor: Anchor::Right, upwards: true, ..NOTE }),
                    false => (9.0, NOTE),
                };
                canvas.text([x, area.bottom + TICK_PX + below], label, lettering, Rgb::INK);
            }
            if self.labelled[0] {
                canvas.text(
                    [middle_x, area.bottom + TICK_PX + self.names_px() + 10.0],
                    &set.label,
                    LABEL,
                    Rgb::INK,
                );
            }
        });
        let at_right = Lettering { anchor: Anchor::Right, ..NOTE };
        let upwards = Lettering { upwards: true, ..LABEL };
        self.in_each_unit(canvas, 1, |canvas, set| {
            for (value, label) in &set.ticks {
                let y = frame.px([0.0, *value])[1];
                if self.chart.y.names.is_empty() {
                    canvas.line(&[[area.left - TICK_PX, y], [area.left, y]], Rgb::INK, 1.0, Dash::Solid);
                }
                // a name that is too long for one line stands on several
                let lines = if self.chart.y.names.is_empty() {
                    vec![label.clone()]
                } else {
                    wrap(label, NOTE.size_px, area.left - self.left - TICK_PX - 4.0)
                };
                let first = y - 0.5 * NAME_LINE_PX * (lines.len() as f64 - 1.0);
                for (i, line) in lines.iter().enumerate() {
                    let at = [area.left - TICK_PX - 4.0, first + i as f64 * NAME_LINE_PX];
                    canvas.text(at, line, at_right, Rgb::INK);
                }
            }
            if self.labelled[1] {
                canvas.text([self.left + 8.0, middle_y], &set.label, upwards, Rgb::INK);
            }
        });
    }
}

/// The ticks of an axis in every unit that can be asked for in this medium: along x with room for
/// their texts in `width` pixels, along y one below the other.
fn all_ticks(axis: &Axis, scale: &Scale, medium: Medium, width: Option<f64>) -> Vec<Ticks> {
    let most = scale.ticks.len().saturating_sub(1).clamp(3, 10);
    let room = |ticks: &[(f64, String)]| width.is_none_or(|width| has_room(ticks, width));
    let mut all = switch::all_units(scale, &axis.label, (2..=most).rev(), room);
    // other units are for numbers, and for a script
    if medium == Medium::File || !axis.names.is_empty() {
        all.truncate(1);
    }
    all
}

/// Whether the label of y is written; one that the panel to the left has for both is, where nothing
/// stands there.
fn has_y_label(chart: &Chart, is_single: bool) -> bool {
    !chart.y.is_label_hidden || is_single
}

/// Room left of the plotting area: axis label and tick labels.
fn left_margin(chart: &Chart, width: f64, medium: Medium, is_single: bool) -> f64 {
    if chart.frameless {
        return 0.0;
    }
    let (_, y, _) = scales(chart, 0.8 * width, 0.0);
    let sets = all_ticks(&chart.y, &y, medium, None);
    let texts = sets.iter().flat_map(|set| &set.ticks);
    let widest = texts.map(|(_, label)| text_width_px(label, NOTE.size_px)).fold(0.0, f64::max);
    let label = if chart.y.label.is_empty() || !has_y_label(chart, is_single) { 0.0 } else { 22.0 };
    label + widest.min(0.5 * width) + TICK_PX + 6.0
}

/// Room right of the plotting area: half of the last tick label.
fn right_margin(chart: &Chart) -> f64 {
    if chart.x.names_upwards {
        return 6.0;
    }
    let (x, _, _) = scales(chart, 300.0, 0.0);
    x.ticks.last().map_or(0.0, |(_, label)| 0.5 * text_width_px(label, NOTE.size_px)).clamp(6.0, 40.0)
}
