//! Draws the marks of a chart inside its axes, and finds what the axes have to span.

use super::chart::{Align, Bar, Chart, Dash, Direction, Mark, Marker, Point, Style};
use super::event_labels;
use super::frame::{Frame, NOTE};
use super::labels::{Area, LabelPlacer, text_width_px};
use super::plot::{Anchor, Canvas, Lettering, Px, Rgb};
use super::scale::{Extent, drawable, extent};

/// How much of its colour a band keeps.
pub(super) const BAND_TINT: f64 = 0.22;
const NOTE_LINE_PX: f64 = 14.0;

/// The label a mark has in the legend; empty where it has none.
pub(super) fn label(mark: &Mark) -> &str {
    match mark {
        Mark::Line { label, .. }
        | Mark::Points { label, .. }
        | Mark::Bars { label, .. }
        | Mark::Band { label, .. }
        | Mark::Area { label, .. } => label,
        Mark::Horizontal { .. }
        | Mark::Vertical { .. }
        | Mark::Stretch { .. }
        | Mark::Event { .. }
        | Mark::Note { .. }
        | Mark::Text { .. }
        | Mark::Arrow { .. } => "",
    }
}

/// What x and y have to span so that all marks are seen. `width_px` of the plot tells how much room
/// the texts at the ends of bars need.
pub(super) fn extents(chart: &Chart, width_px: f64) -> (Extent, Extent) {
    let (mut xs, mut ys) = (Vec::new(), Vec::new());
    for mark in &chart.marks {
        match mark {
            Mark::Line { points, .. } => points.iter().filter(|p| is_drawable(p)).for_each(|[x, y]| {
                xs.push(*x);
                ys.push(*y);
            }),
            Mark::Points { points, .. } => points.iter().filter(|p| is_drawable(&[p.x, p.y])).for_each(|p| {
                xs.push(p.x);
                ys.extend([p.y, p.y - p.error, p.y + p.error]);
            }),
            Mark::Band { points, .. } => {
                points.iter().filter(|p| is_drawable(p)).for_each(|[x, low, high]| {
                    xs.push(*x);
                    ys.extend([*low, *high]);
                })
            }
            Mark::Bars { bars, direction: Direction::Up, .. } => {
                xs.extend(foot_extent(bars));
                ys.extend(bar_extent(bars.iter(), 0.06));
            }
            Mark::Bars { bars, direction: Direction::Right, .. } => ys.extend(foot_extent(bars)),
            Mark::Horizontal { at, .. } => ys.push(*at),
            Mark::Vertical { at, .. } | Mark::Event { at, .. } => xs.push(*at),
            Mark::Stretch { from, to, .. } => xs.extend([*from, *to]),
            Mark::Area { corners, .. } => corners.iter().filter(|p| is_drawable(p)).for_each(|[x, y]| {
                xs.push(*x);
                ys.push(*y);
            }),
            Mark::Note { at: [x, y], .. } | Mark::Text { at: [x, y], .. } => {
                xs.push(*x);
                ys.push(*y);
            }
            Mark::Arrow { from, to, .. } => {
                xs.extend([from[0], to[0]]);
                ys.extend([from[1], to[1]]);
            }
        }
    }
    // the numbers of one kind of bar need room beyond those of another
    let to_the_right = || {
        chart.marks.iter().flat_map(|mark| match mark {
            Mark::Bars { bars, direction: Direction::Right, .. } => bars.as_slice(),
            _ => &[],
        })
    };
    if to_the_right().next().is_some() {
        let text_px = to_the_right().map(|b| text_width_px(&b.text, NOTE.size_px)).fold(0.0, f64::max);
        xs.extend(bar_extent(to_the_right(), (text_px + 8.0) / (width_px - 2.0 * text_px).max(40.0)));
    }
    let seen = |log: bool| move |v: &f64| !log || *v > 0.0;
    (extent(xs.into_iter().filter(seen(chart.x.log))), extent(ys.into_iter().filter(seen(chart.y.log))))
}

/// Zero and all values, with room for the texts beyond them as a part of the span.
fn bar_extent<'a>(bars: impl Iterator<Item = &'a Bar>, text_part: f64) -> [f64; 2] {
    let (low, high) = extent(bars.flat_map(|b| [b.base, b.value])).unwrap_or((0.0, 0.0));
    let (low, high) = (low.min(0.0), high.max(0.0));
    let room = text_part * (high - low);
    [if low < 0.0 { low - room } else { 0.0 }, if high > 0.0 { high + room } else { 0.0 }]
}

/// Where bars stand, with a little air on both sides.
fn foot_extent(bars: &[Bar]) -> Vec<f64> {
    let range = extent(bars.iter().flat_map(|b| [b.from, b.to]));
    range.map_or(Vec::new(), |(low, high)| vec![low - 0.03 * (high - low), high + 0.03 * (high - low)])
}

/// Draws all marks: areas, then clouds, then lines, then points, then words, so that nothing hides
/// what is finer.
pub(super) fn draw(canvas: &mut Canvas, frame: &Frame, marks: &[Mark], labels: &mut LabelPlacer) {
    for layer in 0..4 {
        for mark in marks {
            match (layer, mark) {
                (0, Mark::Band { points, style, .. }) => band(canvas, frame, points, style),
                (0, Mark::Area { corners, style, .. }) => filled(canvas, frame, corners, style, labels),
                (0, Mark::Bars { bars, direction, style, .. }) => {
                    bars.iter().for_each(|b| whole_bar(canvas, frame, b, *direction, style, labels));
                }
                (2, Mark::Horizontal { at, .. }) => reference(canvas, frame, [f64::NAN, *at], labels),
                (2, Mark::Vertical { at, .. }) => reference(canvas, frame, [*at, f64::NAN], labels),
                (2, Mark::Stretch { from, to, text }) => stretch(canvas, frame, [*from, *to], text, labels),
                (2, Mark::Line { points, style, .. }) => line(canvas, frame, points, style, labels),
                (2, Mark::Arrow { from, to, style, .. }) if frame.places(*from) && frame.places(*to) => {
                    let (from, to) = (frame.px(*from), frame.px(*to));
                    labels.add_line(from, to);
                    arrow(canvas, from, to, style);
                }
                (1 | 3, Mark::Points { points, style, .. })
                    if (layer == 1) == (style.marker == Marker::Dot) =>
                {
                    let size_px = marker_px(style, points.len());
                    points.iter().for_each(|p| point(canvas, frame, p, style, size_px, labels));
                }
                _ => {}
            }
        }
    }
    event_labels::draw(canvas, frame, marks, labels);
    for mark in marks {
        if let Mark::Text { at, text, align, shift_px, .. } = mark {
            labels.add_text(text_area(text_px(frame, *at, *shift_px), text, *align));
        }
    }
    for mark in marks {
        match mark {
            Mark::Bars { bars, direction, .. } => {
                bars.iter().for_each(|b| bar_number(canvas, frame, b, *direction));
            }
            Mark::Text { at, text, align, shift_px, is_number } if frame.places(*at) => {
                let anchor = match align {
                    Align::Left => Anchor::Right,
                    Align::Middle => Anchor::Middle,
                    Align::Right => Anchor::Left,
                };
                let unit = if *is_number { &frame.units[0] } else { "" };
                canvas.number(text_px(frame, *at, *shift_px), text, unit, Lettering { anchor, ..NOTE });
            }
            Mark::Note { at, text } => note(canvas, frame, *at, text, labels),
            Mark::Arrow { from, text, .. } => note(canvas, frame, *from, text, labels),
            Mark::Horizontal { at, text } => note(canvas, frame, [frame.x.to, *at], text, labels),
            Mark::Vertical { at, text } => note(canvas, frame, [*at, frame.y.to], text, labels),
            _ => {}
        }
    }
}

/// A bar, filled so that different dashes also differ on a grey print.
pub(super) fn bar(canvas: &mut Canvas, area: &Area, style: &Style) {
    let colour = Rgb::from(style.colour);
    // nothing of what lies below shows between the strokes
    canvas.fill(&area.corners(), Rgb::WHITE);
    let mut hatch = |gap_px: f64, rising: bool| {
        let height = area.height();
        let mut x = area.left - height;
        while x < area.right && gap_px > 0.0 {
            let (bottom, top) = if rising { (x, x + height) } else { (x + height, x) };
            if let Some((a, b)) = area.clip([bottom, area.bottom], [top, area.top]) {
                canvas.line(&[a, b], colour, 1.2, Dash::Solid);
            }
            x += gap_px;
        }
    };
    match style.dash {
        Dash::Solid => canvas.fill(&area.corners(), colour.tint(0.85)),
        Dash::Dashed => hatch(5.0, true),
        Dash::DashDot => canvas.fill(&area.corners(), colour.tint(0.3)),
        Dash::Dotted => hatch(5.0, false),
        Dash::LongDash => {
            hatch(6.0, true);
            hatch(6.0, false);
        }
        Dash::DashDotDot => hatch(2.5, true),
    }
    let [a, b, c, d] = area.corners();
    canvas.line(&[a, b, c, d, a], colour, 1.0, Dash::Solid);
}

/// A vertical error bar with caps.
pub(super) fn error_bar(canvas: &mut Canvas, x: f64, top: f64, bottom: f64, style: &Style) {
    let colour = style.colour.into();
    canvas.line(&[[x, top], [x, bottom]], colour, 1.2, Dash::Solid);
    for y in [top, bottom] {
        canvas.line(&[[x - 3.5, y], [x + 3.5, y]], colour, 1.2, Dash::Solid);
    }
}

/// Half the size of each of `count` markers: many are drawn smaller.
pub(super) fn marker_px(style: &Style, count: usize) -> f64 {
    let by_count = match count {
        0..=40 => 4.2,
        41..=400 => 2.8,
        _ => 2.0,
    };
    style.size_px.filter(|size| drawable(*size)).map_or(by_count, |size| size.clamp(0.5, 50.0))
}

/// One marker of half size `size_px`, edged in white so that it stands out from a line below it.
pub(super) fn marker(canvas: &mut Canvas, [x, y]: Px, style: &Style, size_px: f64) {
    let colour = Rgb::from(style.colour);
    let polygon = |r: f64, corners: &[[f64; 2]]| -> Vec<Px> {
        corners.iter().map(|c| [x + r * c[0], y + r * c[1]]).collect()
    };
    let mut filled = |corners: &[[f64; 2]]| {
        canvas.fill(&polygon(size_px + 1.5, corners), Rgb::WHITE);
        canvas.fill(&polygon(size_px, corners), colour);
    };
    match style.marker {
        Marker::Circle => {
            canvas.disc([x, y], size_px + 1.0, Rgb::WHITE);
            canvas.disc([x, y], size_px, colour);
        }
        Marker::Dot => canvas.disc([x, y], size_px, colour),
        Marker::Square => filled(&[[-0.9, -0.9], [0.9, -0.9], [0.9, 0.9], [-0.9, 0.9]]),
        Marker::Triangle => filled(&[[0.0, -1.2], [1.1, 0.8], [-1.1, 0.8]]),
        Marker::Diamond => filled(&[[0.0, -1.3], [1.0, 0.0], [0.0, 1.3], [-1.0, 0.0]]),
        Marker::Cross | Marker::Plus => {
            let turn = if style.marker == Marker::Plus {
                [[1.2, 0.0], [0.0, 1.2]]
            } else {
                [[0.9, 0.9], [0.9, -0.9]]
            };
            for [dx, dy] in turn {
                canvas.line(&polygon(size_px, &[[-dx, -dy], [dx, dy]]), colour, 2.0, Dash::Solid);
            }
        }
        Marker::Ring => canvas.ring([x, y], 2.2 * size_px, colour, 2.0),
    }
}

/// A line with a head at its end.
pub(super) fn arrow(canvas: &mut Canvas, from: Px, to: Px, style: &Style) {
    let length = f64::hypot(to[0] - from[0], to[1] - from[1]);
    if length < 1.0 {
        return;
    }
    let [ux, uy] = [(to[0] - from[0]) / length, (to[1] - from[1]) / length];
    let head = (4.0 + 2.5 * style.width_px).min(length);
    let neck = [to[0] - head * ux, to[1] - head * uy];
    let half = 0.4 * head;
    canvas.line(&[from, neck], style.colour.into(), style.width_px, Dash::Solid);
    canvas.fill(
        &[to, [neck[0] - half * uy, neck[1] + half * ux], [neck[0] + half * uy, neck[1] - half * ux]],
        style.colour.into(),
    );
}

fn is_drawable<const N: usize>(point: &[f64; N]) -> bool {
    point.iter().all(|v| drawable(*v))
}

fn line(canvas: &mut Canvas, frame: &Frame, points: &[[f64; 2]], style: &Style, labels: &mut LabelPlacer) {
    // A point that is not finite interrupts the line: nothing is known about the way past it.
    for run in points.split(|p| !frame.places(*p)) {
        let mut piece: Vec<Px> = Vec::new();
        for pair in run.windows(2) {
            let (from, to) = (frame.px(pair[0]), frame.px(pair[1]));
            let Some((a, b)) = frame.area.clip(from, to) else { continue };
            labels.add_line(a, b);
            if piece.last() != Some(&a) {
                canvas.line(&piece, style.colour.into(), style.width_px, style.dash);
                piece = vec![a];
            }
            piece.push(b);
        }
        canvas.line(&piece, style.colour.into(), style.width_px, style.dash);
    }
}

fn band(canvas: &mut Canvas, frame: &Frame, points: &[[f64; 3]], style: &Style) {
    let area = frame.area;
    let inside = |point: [f64; 2]| {
        let [x, y] = frame.px(point);
        [x.clamp(area.left, area.right), y.clamp(area.top, area.bottom)]
    };
    for run in points
        .split(|[x, low, high]| !frame.places([*x, *low]) || !frame.places([*x, *high]))
        .filter(|run| run.len() > 1)
    {
        let low = run.iter().map(|[x, low, _]| inside([*x, *low]));
        let high = run.iter().rev().map(|[x, _, high]| inside([*x, *high]));
        let corners: Vec<Px> = low.chain(high).collect();
        canvas.fill(&corners, Rgb::from(style.colour).tint(BAND_TINT));
    }
}

/// How much of its colour the inside of a closed line keeps.
pub(super) fn fill_tint(style: &Style) -> f64 {
    if style.dash == Dash::Solid { 0.6 } else { BAND_TINT }
}

/// A closed line and its inside.
fn filled(canvas: &mut Canvas, frame: &Frame, corners: &[[f64; 2]], style: &Style, labels: &mut LabelPlacer) {
    if corners.len() < 3 || !corners.iter().all(|corner| frame.places(*corner)) {
        return;
    }
    // what is beyond the frame ends at it
    let area = frame.area;
    let inside = |[x, y]: Px| [x.clamp(area.left, area.right), y.clamp(area.top, area.bottom)];
    let mut outline: Vec<Px> = corners.iter().map(|corner| inside(frame.px(*corner))).collect();
    canvas.fill(&outline, Rgb::from(style.colour).tint(fill_tint(style)));
    outline.extend(outline.first().copied());
    for pair in outline.windows(2) {
        if let Some((a, b)) = frame.area.clip(pair[0], pair[1]) {
            labels.add_line(a, b);
        }
    }
    canvas.line(&outline, style.colour.into(), style.width_px, Dash::Solid);
}

fn reference(canvas: &mut Canvas, frame: &Frame, [x, y]: [f64; 2], labels: &mut LabelPlacer) {
    let ends = if frame.x.places(x) {
        [frame.px([x, frame.y.from]), frame.px([x, frame.y.to])]
    } else if frame.y.places(y) {
        [frame.px([frame.x.from, y]), frame.px([frame.x.to, y])]
    } else {
        return;
    };
    if let Some((a, b)) = frame.area.clip(ends[0], ends[1]) {
        labels.add_line(a, b);
        canvas.line(&[a, b], Rgb::GREY, 1.2, Dash::Solid);
    }
}

/// Lines at both ends, below the strip along the top in which the names stand.
fn stretch(canvas: &mut Canvas, frame: &Frame, ends: [f64; 2], text: &str, labels: &mut LabelPlacer) {
    if !ends.iter().all(|x| frame.x.places(*x)) {
        return;
    }
    let area = frame.area;
    let xs = ends.map(|x| frame.px([x, f64::NAN])[0]);
    for x in xs {
        if let Some((a, b)) = area.clip([x, area.top + NOTE_LINE_PX + 2.0], [x, area.bottom]) {
            canvas.line(&[a, b], Rgb::GREY.tint(0.6), 0.8, Dash::Solid);
        }
    }
    let half = 0.5 * text_width_px(text, NOTE.size_px) + 3.0;
    // Pushed back in where it would stick out.
    let middle = (0.5 * xs[0] + 0.5 * xs[1]).min(area.right - half).max(area.left + half);
    let name =
        Area { left: middle - half, right: middle + half, top: area.top, bottom: area.top + NOTE_LINE_PX };
    if !text.is_empty() && labels.is_free(&name) {
        canvas.text(name.centre(), text, NOTE, Rgb::INK);
        labels.add_text(name);
    }
}

fn point(
    canvas: &mut Canvas,
    frame: &Frame,
    point: &Point,
    style: &Style,
    size_px: f64,
    labels: &mut LabelPlacer,
) {
    let [x, y] = frame.px([point.x, point.y]);
    if !frame.places([point.x, point.y]) || frame.area.clip([x, y], [x, y]).is_none() {
        return;
    }
    if point.error > 0.0 && drawable(point.error) {
        let end = |sign: f64| {
            frame.px([point.x, point.y + sign * point.error])[1].clamp(frame.area.top, frame.area.bottom)
        };
        error_bar(canvas, x, end(1.0), end(-1.0), style);
        labels.add_line([x, end(1.0)], [x, end(-1.0)]);
    }
    marker(canvas, [x, y], style, size_px);
    let radius = if style.marker == Marker::Ring { 2.2 * size_px } else { size_px };
    for [dx, dy] in [[0.0, 0.0], [1.0, 0.0], [0.0, 1.0], [-1.0, 0.0], [0.0, -1.0]] {
        labels.add_point([x + dx * radius, y + dy * radius]);
    }
}

fn whole_bar(
    canvas: &mut Canvas,
    frame: &Frame,
    b: &Bar,
    direction: Direction,
    style: &Style,
    labels: &mut LabelPlacer,
) {
    let Some(area) = bar_area(frame, b, direction) else { return };
    bar(canvas, &area, style);
    labels.add_text(area);
    if !b.text.is_empty() {
        labels.add_text(number_area(frame, b, &area, direction).2);
    }
}

/// Where a bar stands.
fn bar_area(frame: &Frame, b: &Bar, direction: Direction) -> Option<Area> {
    if !is_drawable(&[b.from, b.to, b.base]) {
        return None;
    }
    // A value that is not finite has no bar, but its text still says so at the foot.
    let value = if drawable(b.value) { b.value } else { b.base };
    let (one, other) = match direction {
        Direction::Up => (frame.px([b.from, b.base]), frame.px([b.to, value])),
        Direction::Right => (frame.px([b.base, b.from]), frame.px([value, b.to])),
    };
    let within = |v: f64, low: f64, high: f64| v.clamp(low, high);
    let a = frame.area;
    Some(Area {
        left: within(one[0].min(other[0]), a.left, a.right),
        right: within(one[0].max(other[0]), a.left, a.right),
        top: within(one[1].min(other[1]), a.top, a.bottom),
        bottom: within(one[1].max(other[1]), a.top, a.bottom),
    })
}

/// Where a bar's number stands: its point, its anchor, what it covers.
fn number_area(frame: &Frame, b: &Bar, area: &Area, direction: Direction) -> (Px, Anchor, Area) {
    let value = if drawable(b.value) { b.value } else { b.base };
    let width = text_width_px(&b.text, NOTE.size_px);
    let [middle_x, middle_y] = area.centre();
    // what would stand on the names of the axis stands on the other side
    let has_room = area.left - 5.0 - width > frame.area.left;
    let (at, anchor) = match direction {
        Direction::Up if value < 0.0 => ([middle_x, area.bottom + 9.0], Anchor::Middle),
        Direction::Up => ([middle_x, area.top - 9.0], Anchor::Middle),
        Direction::Right if value < 0.0 && has_room => ([area.left - 5.0, middle_y], Anchor::Right),
        Direction::Right => ([area.right + 5.0, middle_y], Anchor::Left),
    };
    let left = match anchor {
        Anchor::Left => at[0],
        Anchor::Middle => at[0] - 0.5 * width,
        Anchor::Right => at[0] - width,
    };
    let (top, bottom) = (at[1] - 0.5 * NOTE_LINE_PX, at[1] + 0.5 * NOTE_LINE_PX);
    (at, anchor, Area { left, top, right: left + width, bottom })
}

/// A bar's number: on white, for a reference line may pass there.
fn bar_number(canvas: &mut Canvas, frame: &Frame, b: &Bar, direction: Direction) {
    const PLATE_PX: f64 = 2.0;
    let Some(area) = bar_area(frame, b, direction).filter(|_| !b.text.is_empty()) else { return };
    let (at, anchor, covered) = number_area(frame, b, &area, direction);
    let plate = Area { top: covered.top + PLATE_PX, bottom: covered.bottom - PLATE_PX, ..covered };
    canvas.fill(&plate.corners(), Rgb::WHITE);
    let unit = match direction {
        Direction::Up => &frame.units[1],
        Direction::Right => &frame.units[0],
    };
    canvas.number(at, &b.text, unit, Lettering { anchor, ..NOTE });
}

/// A note beside its point, with a thin leader where it had to move away from it.
/// Where a text beside its point is anchored.
fn text_px(frame: &Frame, at: [f64; 2], [right, down]: [f64; 2]) -> Px {
    let [x, y] = frame.px(at);
    [x + right, y + down]
}

/// What a text that is anchored there covers.
fn text_area([x, y]: Px, text: &str, align: Align) -> Area {
    let width = text_width_px(text, NOTE.size_px);
    let left = match align {
        Align::Left => x - width,
        Align::Middle => x - 0.5 * width,
        Align::Right => x,
    };
    let half = 0.5 * NOTE_LINE_PX;
    Area { left, top: y - half, right: left + width, bottom: y + half }
}

fn note(canvas: &mut Canvas, frame: &Frame, at: [f64; 2], text: &str, labels: &mut LabelPlacer) {
    if text.is_empty() || !frame.places(at) {
        return;
    }
    let at = frame.px(at);
    let area = labels.place(at, text_width_px(text, NOTE.size_px) + 4.0, NOTE_LINE_PX);
    let near = [at[0].clamp(area.left, area.right), at[1].clamp(area.top, area.bottom)];
    if f64::hypot(near[0] - at[0], near[1] - at[1]) > 18.0 {
        canvas.line(&[at, near], Rgb::GREY, 0.8, Dash::Solid);
        labels.add_line(at, near);
    }
    canvas.text(area.centre(), text, NOTE, Rgb::INK);
}
