//! Drawing on an SVG. The only file that names plotters.
//!
//! Plotters' SVG rounds to whole pixels, so everything is drawn ten times as large and scaled back
//! by the view box. Lengths here are CSS pixels of the finished picture, x to the right, y down.

use plotters::backend::{DrawingBackend, SVGBackend};
use plotters::style::text_anchor::{HPos, Pos, VPos};
use plotters::style::{FontFamily, FontStyle, FontTransform, IntoFont, RGBColor, ShapeStyle, TextStyle};

use super::chart::{Colour, Dash};

/// x, y in CSS pixels.
pub(super) type Px = [f64; 2];

/// Units of the SVG per CSS pixel.
const FINE: f64 = 10.0;
/// Far outside of any picture, yet far from overflow.
const FAR_PX: f64 = 1e5;
/// Plotters divides font sizes by this number on their way into the SVG.
const PLOTTERS_FONT_FACTOR: f64 = 1.24;

/// What a cursor reads on an axis.
pub(super) struct PanelAxis {
    /// Where it begins and ends, and whether it is logarithmic; `None` where it has names and no
    /// numbers.
    pub(super) ends: Option<(f64, f64, bool)>,
    pub(super) label: String,
    /// Its unit where a reader may switch it; else empty.
    pub(super) unit: String,
}

/// An SVG in the making.
pub(super) struct Canvas {
    width_px: f64,
    height_px: f64,
    body: String,
    /// The axes of the panels, as JSON, for a cursor on the page.
    panels: Vec<serde_json::Value>,
}

/// Where a text lies relative to its point.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) enum Anchor {
    Left,
    Middle,
    Right,
}

/// How a text looks.
#[derive(Debug, Clone, Copy)]
pub(super) struct Lettering {
    pub(super) size_px: f64,
    pub(super) bold: bool,
    pub(super) anchor: Anchor,
    /// Reads upwards in place of rightwards.
    pub(super) upwards: bool,
}

impl Canvas {
    pub(super) fn new(width_px: f64, height_px: f64) -> Self {
        Canvas { width_px, height_px, body: String::new(), panels: Vec::new() }
    }

    /// A line through points, with this dash.
    pub(super) fn line(&mut self, points: &[Px], colour: Rgb, width_px: f64, dash: Dash) {
        let style = shape(colour, width_px, false);
        match pattern(dash) {
            [] if points.len() > 1 => {
                self.with(|b| b.draw_path(points.iter().map(fine), &style));
            }
            [] => {}
            pattern => {
                // Plotters has no stroke-dasharray, so each dash is a line of its own.
                for piece in dashes(points, pattern, width_px.max(1.0)) {
                    self.with(|b| b.draw_path(piece.iter().map(fine), &style));
                }
            }
        }
    }

    /// A filled area.
    pub(super) fn fill(&mut self, corners: &[Px], colour: Rgb) {
        let style = shape(colour, 0.0, true);
        self.with(|b| b.fill_polygon(corners.iter().map(fine), &style));
    }

    /// A disc.
    pub(super) fn disc(&mut self, centre: Px, radius_px: f64, colour: Rgb) {
        let style = shape(colour, 0.0, true);
        self.with(|b| b.draw_circle(fine(&centre), (radius_px * FINE) as u32, &style, true));
    }

    /// An open circle.
    pub(super) fn ring(&mut self, centre: Px, radius_px: f64, colour: Rgb, width_px: f64) {
        let style = shape(colour, width_px, false);
        self.with(|b| b.draw_circle(fine(&centre), (radius_px * FINE) as u32, &style, false));
    }

    /// One line of text, centred on the height of its point.
    pub(super) fn text(&mut self, at: Px, text: &str, lettering: Lettering, colour: Rgb) {
        if text.is_empty() {
            return;
        }
        let transform = if lettering.upwards { FontTransform::Rotate270 } else { FontTransform::None };
        let style = if lettering.bold { FontStyle::Bold } else { FontStyle::Normal };
        let anchor = match lettering.anchor {
            Anchor::Left => HPos::Left,
            Anchor::Middle => HPos::Center,
            Anchor::Right => HPos::Right,
        };
        let font =
            (FontFamily::SansSerif, lettering.size_px * FINE * PLOTTERS_FONT_FACTOR, style).into_font();
        let colour = RGBColor(colour.0, colour.1, colour.2);
        let look =
            TextStyle::from(font.transform(transform)).color(&colour).pos(Pos::new(anchor, VPos::Center));
        self.with(|b| b.draw_text(&printable(text), &look, fine(&at)));
    }

    /// What follows, until [`end_group`](Self::end_group), belongs to an axis in `unit` and is seen
    /// while that is chosen; at first it is `is_seen`. `first` is the unit of the axis without a
    /// choice.
    pub(super) fn begin_unit(&mut self, first: &str, unit: &str, is_seen: bool) {
        let (first, unit) = (attribute(first), attribute(unit));
        let hidden = if is_seen { "" } else { " display=\"none\"" };
        self.body += &format!("<g data-of=\"{first}\" data-unit=\"{unit}\"{hidden}>");
    }

    /// A number in a unit, with which it changes; where that is empty, a text like any other.
    pub(super) fn number(&mut self, at: Px, text: &str, unit: &str, lettering: Lettering) {
        if unit.is_empty() || text.is_empty() {
            return self.text(at, text, lettering, Rgb::INK);
        }
        self.body += &format!("<g data-number=\"{}\">", attribute(unit));
        self.text(at, text, lettering, Rgb::INK);
        self.end_group();
    }

    /// Ends what was begun last.
    pub(super) fn end_group(&mut self) {
        self.body += "</g>";
    }

    /// Remembers where a panel's axes are: its corners in units of the SVG, and x and y.
    pub(super) fn panel(&mut self, corners: [Px; 2], [x, y]: [PanelAxis; 2]) {
        let [(left, top), (right, bottom)] = corners.map(|corner| fine(&corner));
        let mut panel = serde_json::json!({
            "box": [left, top, right, bottom], "x": x.ends, "y": y.ends, "xlabel": x.label, "ylabel": y.label,
        });
        for (name, unit) in [("xunit", x.unit), ("yunit", y.unit)] {
            if !unit.is_empty() {
                panel[name] = unit.into();
            }
        }
        self.panels.push(panel);
    }

    /// The whole document.
    pub(super) fn finish(self, title: &str, description: &str) -> String {
        let (width, height) = self.size();
        let escape =
            |text: &str| printable(text).replace('&', "&amp;").replace('<', "&lt;").replace('\'', "&#39;");
        let panels = match self.panels.is_empty() {
            true => String::new(),
            false => format!(
                " data-panels='{}'",
                escape(&serde_json::Value::from(self.panels.clone()).to_string())
            ),
        };
        let mut svg = format!(
            "<svg xmlns=\"http://www.w3.org/2000/svg\" viewBox=\"0 0 {width} {height}\" width=\"{}\" height=\"{}\" \
             role=\"img\" stroke-linejoin=\"round\"{panels}>\n<title>{}</title>\n",
            f64::from(width) / FINE,
            f64::from(height) / FINE,
            escape(title)
        );
        if !description.is_empty() {
            svg += &format!("<desc>{}</desc>\n", escape(description));
        }
        svg + &self.body + "</svg>\n"
    }

    /// Draws one element and keeps it without the document around it. Writing to a string cannot
    /// fail.
    fn with<E>(&mut self, draw: impl FnOnce(&mut SVGBackend) -> Result<(), E>) {
        let mut document = String::new();
        let _ = draw(&mut SVGBackend::with_string(&mut document, self.size()));
        let element = document.split_once('\n').map_or("", |(_, rest)| rest).trim_end();
        self.body += element.strip_suffix("</svg>").unwrap_or(element);
    }

    fn size(&self) -> (u32, u32) {
        ((self.width_px * FINE) as u32, (self.height_px * FINE) as u32)
    }
}

/// Red, green, blue.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Rgb(pub(super) u8, pub(super) u8, pub(super) u8);

impl Rgb {
    pub(super) const WHITE: Rgb = Rgb(255, 255, 255);
    /// Of texts and axes.
    pub(super) const INK: Rgb = Rgb(0x22, 0x22, 0x22);
    /// Of the grid.
    pub(super) const FAINT: Rgb = Rgb(0xE4, 0xE4, 0xE4);
    /// Of reference lines and leaders.
    pub(super) const GREY: Rgb = Rgb(0x77, 0x77, 0x77);

    /// The same colour, mixed with white: 0 is white, 1 the colour itself.
    pub(super) fn tint(self, strength: f64) -> Rgb {
        let mix = |c: u8| (255.0 - (255.0 - f64::from(c)) * strength).round() as u8;
        Rgb(mix(self.0), mix(self.1), mix(self.2))
    }
}

impl From<Colour> for Rgb {
    fn from(colour: Colour) -> Rgb {
        match colour {
            Colour::Black => Rgb(0, 0, 0),
            Colour::Vermilion => Rgb(0xD5, 0x5E, 0x00),
            Colour::Blue => Rgb(0x00, 0x72, 0xB2),
            Colour::Green => Rgb(0x00, 0x9E, 0x73),
            Colour::Purple => Rgb(0xCC, 0x79, 0xA7),
            Colour::SkyBlue => Rgb(0x56, 0xB4, 0xE9),
            Colour::Orange => Rgb(0xE6, 0x9F, 0x00),
            Colour::Grey => Rgb(0x99, 0x99, 0x99),
        }
    }
}

fn shape(colour: Rgb, width_px: f64, filled: bool) -> ShapeStyle {
    ShapeStyle {
        color: RGBColor(colour.0, colour.1, colour.2).into(),
        filled,
        stroke_width: (width_px * FINE).round() as u32,
    }
}

fn fine(px: &Px) -> (i32, i32) {
    let unit = |v: f64| (v.clamp(-FAR_PX, FAR_PX) * FINE).round() as i32;
    (unit(px[0]), unit(px[1]))
}

fn attribute(text: &str) -> String {
    printable(text).replace('&', "&amp;").replace('<', "&lt;").replace('"', "&quot;")
}

/// Control characters have no place in XML, not even escaped.
fn printable(text: &str) -> String {
    text.chars()
        .map(|c| if c.is_control() || matches!(c, '\u{FFFE}' | '\u{FFFF}') { ' ' } else { c })
        .collect()
}

/// Lengths of dash, gap, dash, gap, … in line widths.
fn pattern(dash: Dash) -> &'static [f64] {
    match dash {
        Dash::Solid => &[],
        Dash::Dashed => &[5.0, 3.0],
        Dash::DashDot => &[6.0, 2.5, 1.2, 2.5],
        Dash::Dotted => &[1.2, 2.2],
        Dash::LongDash => &[11.0, 3.5],
        Dash::DashDotDot => &[6.0, 2.2, 1.2, 2.2, 1.2, 2.2],
    }
}

/// The drawn pieces of a dashed line.
fn dashes(points: &[Px], pattern: &[f64], unit_px: f64) -> Vec<Vec<Px>> {
    let mut pieces = Vec::new();
    let (mut index, mut left) = (0, pattern[0] * unit_px);
    let mut piece: Vec<Px> = points.iter().take(1).copied().collect();
    for pair in points.windows(2) {
        let (mut here, end) = (pair[0], pair[1]);
        loop {
            let rest = f64::hypot(end[0] - here[0], end[1] - here[1]);
            // The line ends within this dash or gap; a line too long to dash is drawn through.
            if rest <= left || pieces.len() > 10_000 {
                left -= rest;
                piece.push(end);
                break;
            }
            let part = left / rest;
            here = [here[0] + part * (end[0] - here[0]), here[1] + part * (end[1] - here[1])];
            piece.push(here);
            if index % 2 == 0 {
                pieces.push(std::mem::take(&mut piece));
            }
            piece = vec![here];
            index = (index + 1) % pattern.len();
            left = pattern[index] * unit_px;
        }
    }
    if index % 2 == 0 && piece.len() > 1 {
        pieces.push(piece);
    }
    pieces
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn dashes_and_gaps_add_up_to_the_line() {
        let pieces = dashes(&[[0.0, 0.0], [10.0, 0.0], [10.0, 10.0]], &[5.0, 3.0], 1.0);
        assert_eq!(
            pieces,
            [
                vec![[0.0, 0.0], [5.0, 0.0]],
                vec![[8.0, 0.0], [10.0, 0.0], [10.0, 3.0]],
                vec![[10.0, 6.0], [10.0, 10.0]]
            ]
        );
    }

    #[test]
    fn a_tint_is_a_mix_with_white() {
        assert_eq!(Rgb(0, 100, 255).tint(0.0), Rgb::WHITE);
        assert_eq!(Rgb(0, 100, 255).tint(1.0), Rgb(0, 100, 255));
    }

    #[test]
    fn texts_are_escaped_and_the_view_box_is_ten_times_the_size() {
        let mut canvas = Canvas::new(20.0, 10.0);
        let plain = Lettering { size_px: 10.0, bold: false, anchor: Anchor::Left, upwards: false };
        canvas.text([1.0, 1.0], "a < b & \u{0}", plain, Rgb::INK);
        let svg = canvas.finish("<t>", "");
        assert!(svg.contains("viewBox=\"0 0 200 100\" width=\"20\" height=\"10\""), "{svg}");
        assert!(svg.contains("a &lt; b &amp;  ") && svg.contains("<title>&lt;t></title>"), "{svg}");
    }
}
