//! The legend below a chart: a sample of each mark and its label, in rows.

use super::chart::{Dash, Mark};
use super::frame::NOTE;
use super::labels::{Area, text_width_px, wrap};
use super::marks;
use super::plot::{Anchor, Canvas, Lettering, Px, Rgb};

const SAMPLE_PX: f64 = 34.0;
const GAP_PX: f64 = 20.0;
const LINE_PX: f64 = 16.0;

/// A legend, laid out.
pub(super) struct Legend<'a> {
    entries: Vec<Entry<'a>>,
    pub(super) height_px: f64,
}

struct Entry<'a> {
    samples: Vec<&'a Mark>,
    lines: Vec<String>,
    corner: Px,
}

impl<'a> Legend<'a> {
    /// The legend of these marks in rows of at most `width_px`. Marks of one label share an entry.
    pub(super) fn new(marks: impl IntoIterator<Item = &'a Mark>, width_px: f64) -> Self {
        let mut labelled: Vec<(&str, Vec<&Mark>)> = Vec::new();
        for mark in marks {
            let label = marks::label(mark);
            match labelled.iter_mut().find(|(seen, _)| *seen == label) {
                _ if label.is_empty() => {}
                // The same mark in another panel needs no second sample.
                Some((_, samples))
                    if samples.iter().any(|s| std::mem::discriminant(*s) == std::mem::discriminant(mark)) => {
                }
                Some((_, samples)) => samples.push(mark),
                None => labelled.push((label, vec![mark])),
            }
        }
        let (mut x, mut y, mut row_px) = (0.0, 0.0, 0.0_f64);
        let mut entries = Vec::new();
        for (label, samples) in labelled {
            let lines = wrap(label, NOTE.size_px, width_px - SAMPLE_PX);
            let text_px = lines.iter().map(|line| text_width_px(line, NOTE.size_px)).fold(0.0, f64::max);
            if x > 0.0 && x + SAMPLE_PX + text_px > width_px {
                (x, y, row_px) = (0.0, y + row_px, 0.0);
            }
            row_px = row_px.max(lines.len() as f64 * LINE_PX + 2.0);
            entries.push(Entry { samples, lines, corner: [x, y] });
            x += SAMPLE_PX + text_px + GAP_PX;
        }
        let height_px = if entries.is_empty() { 0.0 } else { y + row_px + 6.0 };
        Legend { entries, height_px }
    }

    pub(super) fn draw(&self, canvas: &mut Canvas, corner: Px) {
        let left = Lettering { anchor: Anchor::Left, ..NOTE };
        for entry in &self.entries {
            let (x, y) = (corner[0] + entry.corner[0], corner[1] + entry.corner[1] + 4.0 + 0.5 * LINE_PX);
            for mark in &entry.samples {
                sample(canvas, mark, [x, y]);
            }
            for (i, line) in entry.lines.iter().enumerate() {
                canvas.text([x + SAMPLE_PX, y + i as f64 * LINE_PX], line, left, Rgb::INK);
            }
        }
    }
}

/// One mark in small, from `[x, y]` to the right.
fn sample(canvas: &mut Canvas, mark: &Mark, [x, y]: Px) {
    let right = x + SAMPLE_PX - 7.0;
    let patch = Area { left: x, top: y - 5.0, right, bottom: y + 5.0 };
    match mark {
        Mark::Line { style, .. } => {
            canvas.line(&[[x, y], [right, y]], style.colour.into(), style.width_px, style.dash)
        }
        Mark::Arrow { style, .. } => marks::arrow(canvas, [x, y], [right, y], style),
        Mark::Points { style, points, .. } => {
            let middle = [(x + right) / 2.0, y];
            if points.iter().any(|p| p.error > 0.0) {
                marks::error_bar(canvas, middle[0], y - 7.0, y + 7.0, style);
            }
            marks::marker(canvas, middle, style, marks::marker_px(style, points.len()));
        }
        Mark::Bars { style, .. } => marks::bar(canvas, &patch, style),
        Mark::Band { style, .. } => {
            canvas.fill(&patch.corners(), Rgb::from(style.colour).tint(marks::BAND_TINT))
        }
        Mark::Area { style, .. } => {
            canvas.fill(&patch.corners(), Rgb::from(style.colour).tint(marks::fill_tint(style)));
            let [a, b, c, d] = patch.corners();
            canvas.line(&[a, b, c, d, a], style.colour.into(), style.width_px, Dash::Solid);
        }
        Mark::Horizontal { .. }
        | Mark::Vertical { .. }
        | Mark::Stretch { .. }
        | Mark::Event { .. }
        | Mark::Note { .. }
        | Mark::Text { .. } => {
            canvas.line(&[[x, y], [right, y]], Rgb::GREY, 1.0, Dash::Solid);
        }
    }
}
