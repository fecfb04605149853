//! How wide a text is, and where a note can stand without covering anything.

use super::plot::Px;

/// Width of a text in CSS pixels, estimated for the widest of the common sans-serif fonts
/// (DejaVu Sans), since the reader's browser chooses the font.
pub(super) fn text_width_px(text: &str, size_px: f64) -> f64 {
    let em = |c| match c {
        'i' | 'j' | 'l' | 'I' | 'J' | '\'' | '|' | '\u{2009}' => 0.29,
        '.' | ',' | ':' | ';' | ' ' | '\u{a0}' | '·' | '/' | '!' => 0.33,
        't' | 'f' | 'r' | '(' | ')' | '[' | ']' | '-' | '⁻' | '¹' | '²' | '³' | '⁴'..='⁹' | '⁰' => {
            0.41
        }
        's' | 'c' | 'z' | '°' | 'k' => 0.56,
        'm' | 'w' | 'M' | 'W' | '@' | '%' => 0.95,
        '−' | '=' | '+' | '±' | '×' | '≈' | '≤' | '≥' | '<' | '>' | '→' => 0.84,
        'A'..='Z' => 0.72,
        _ => 0.635,
    };
    text.chars().map(em).sum::<f64>() * size_px
}

/// Breaks a text into lines of at most `width_px`, where its spaces allow; no-break spaces do not.
pub(super) fn wrap(text: &str, size_px: f64, width_px: f64) -> Vec<String> {
    let mut lines: Vec<String> = Vec::new();
    for word in text.split(' ').filter(|word| !word.is_empty()) {
        match lines.last_mut() {
            Some(line) if text_width_px(&format!("{line} {word}"), size_px) <= width_px => {
                line.push(' ');
                line.push_str(word);
            }
            _ => lines.push(word.to_owned()),
        }
    }
    lines
}

/// An upright rectangle in CSS pixels, y down.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Area {
    pub(super) left: f64,
    pub(super) top: f64,
    pub(super) right: f64,
    pub(super) bottom: f64,
}

impl Area {
    pub(super) fn width(&self) -> f64 {
        self.right - self.left
    }

    pub(super) fn height(&self) -> f64 {
        self.bottom - self.top
    }

    pub(super) fn centre(&self) -> Px {
        [(self.left + self.right) / 2.0, (self.top + self.bottom) / 2.0]
    }

    pub(super) fn corners(&self) -> [Px; 4] {
        [[self.left, self.top], [self.right, self.top], [self.right, self.bottom], [self.left, self.bottom]]
    }

    fn holds(&self, point: Px) -> bool {
        (self.left..=self.right).contains(&point[0]) && (self.top..=self.bottom).contains(&point[1])
    }

    pub(super) fn touches(&self, other: &Area) -> bool {
        self.left < other.right
            && other.left < self.right
            && self.top < other.bottom
            && other.top < self.bottom
    }

    fn encloses(&self, other: &Area) -> bool {
        self.holds([other.left, other.top]) && self.holds([other.right, other.bottom])
    }

    /// The part of the line from `a` to `b` inside this area (Liang and Barsky 1984).
    pub(super) fn clip(&self, a: Px, b: Px) -> Option<(Px, Px)> {
        let (dx, dy) = (b[0] - a[0], b[1] - a[1]);
        let sides = [
            (-dx, a[0] - self.left),
            (dx, self.right - a[0]),
            (-dy, a[1] - self.top),
            (dy, self.bottom - a[1]),
        ];
        let (mut enter, mut leave) = (0.0_f64, 1.0_f64);
        for (p, q) in sides {
            if p == 0.0 && q < 0.0 {
                return None;
            } else if p < 0.0 {
                enter = enter.max(q / p);
            } else if p > 0.0 {
                leave = leave.min(q / p);
            }
        }
        let at = |t: f64| [a[0] + t * dx, a[1] + t * dy];
        (enter <= leave).then(|| (at(enter), at(leave)))
    }
}

/// Finds places for labels: it knows what is already on a chart, so that notes keep clear of it.
#[derive(Debug)]
pub(super) struct LabelPlacer {
    within: Area,
    points: Vec<Px>,
    texts: Vec<Area>,
}

impl LabelPlacer {
    pub(super) fn new(within: Area) -> Self {
        LabelPlacer { within, points: Vec::new(), texts: Vec::new() }
    }

    /// Something is drawn at this point.
    pub(super) fn add_point(&mut self, point: Px) {
        self.points.push(point);
    }

    /// A line is drawn from here to there.
    pub(super) fn add_line(&mut self, from: Px, to: Px) {
        let Some((from, to)) = self.within.clip(from, to) else { return };
        let steps = (f64::hypot(to[0] - from[0], to[1] - from[1]) / 3.0).ceil().max(1.0);
        for i in 0..=steps as usize {
            let t = i as f64 / steps;
            self.points.push([from[0] + t * (to[0] - from[0]), from[1] + t * (to[1] - from[1])]);
        }
    }

    /// A text stands here.
    pub(super) fn add_text(&mut self, area: Area) {
        self.texts.push(area);
    }

    /// Whether a text here would cover no other.
    pub(super) fn is_free(&self, area: &Area) -> bool {
        !self.texts.iter().any(|text| text.touches(area))
    }

    /// The place beside `at` for a text of the given size that covers least; it is then taken.
    pub(super) fn place(&mut self, at: Px, width_px: f64, height_px: f64) -> Area {
        const DIRECTIONS: usize = 16;
        let mut best: Option<(f64, Area)> = None;
        for distance in [7.0, 14.0, 24.0, 38.0, 56.0, 80.0] {
            for i in 0..DIRECTIONS {
                // Begins at the upper right, where a reader looks first.
                let angle = (i as f64 + 2.0) * std::f64::consts::TAU / DIRECTIONS as f64;
                let (away_x, away_y) = (angle.cos(), -angle.sin());
                let centre = [
                    at[0] + away_x * (distance + width_px / 2.0),
                    at[1] + away_y * (distance + height_px / 2.0),
                ];
                // Pushed back in where it would stick out.
                let into = |v: f64, low: f64, high: f64| v.min(high).max(low);
                let left = into(centre[0] - width_px / 2.0, self.within.left, self.within.right - width_px);
                let top = into(centre[1] - height_px / 2.0, self.within.top, self.within.bottom - height_px);
                let area = Area { left, top, right: left + width_px, bottom: top + height_px };
                let cost = self.cost(&area) + distance + 0.1 * i as f64;
                if best.is_none_or(|(least, _)| cost < least) {
                    best = Some((cost, area));
                }
            }
        }
        let area =
            best.map_or(Area { left: at[0], right: at[0], top: at[1], bottom: at[1] }, |(_, area)| area);
        self.add_text(area);
        area
    }

    /// Across lines a text is read, across another text neither is.
    fn cost(&self, area: &Area) -> f64 {
        let outside = if self.within.encloses(area) { 0.0 } else { 500.0 };
        let texts = self.texts.iter().filter(|text| text.touches(area)).count();
        let points = self.points.iter().filter(|point| area.holds(**point)).count();
        outside + 3000.0 * texts as f64 + 12.0 * points as f64
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const BOX: Area = Area { left: 0.0, top: 0.0, right: 100.0, bottom: 100.0 };

    #[test]
    fn a_line_is_cut_at_the_frame() {
        assert_eq!(BOX.clip([-50.0, 50.0], [150.0, 50.0]), Some(([0.0, 50.0], [100.0, 50.0])));
        assert_eq!(BOX.clip([-50.0, 50.0], [-10.0, 50.0]), None);
        assert_eq!(BOX.clip([-10.0, 0.0], [-10.0, 50.0]), None);
    }

    #[test]
    fn notes_keep_clear_of_each_other_of_lines_and_of_the_edge() {
        let mut labels = LabelPlacer::new(BOX);
        labels.add_line([0.0, 50.0], [100.0, 50.0]);
        let first = labels.place([90.0, 50.0], 30.0, 10.0);
        let second = labels.place([90.0, 50.0], 30.0, 10.0);
        assert!(!first.touches(&second) && BOX.encloses(&first) && BOX.encloses(&second));
        for area in [first, second] {
            assert!(area.bottom < 50.0 || area.top > 50.0, "{area:?}");
        }
    }

    #[test]
    fn long_titles_are_broken_at_spaces() {
        assert_eq!(wrap("one two three", 10.0, 60.0), ["one two", "three"]);
        assert_eq!(wrap("about 33.0\u{a0}µm/N", 10.0, 60.0), ["about", "33.0\u{a0}µm/N"]);
        assert_eq!(wrap("unbreakable", 10.0, 1.0), ["unbreakable"]);
    }
}
