//! A chart as plain data: axes, marks on them, and how each mark looks. Nothing here draws.
//!
//! Data coordinates are whatever the axis labels say; the unit belongs into the label, for example
//! "load / N". Points that are not finite are skipped when the chart is drawn.

use serde::{Deserialize, Serialize};

/// One pair of axes with everything drawn on them.
#[derive(Debug, Clone, Default, Serialize, Deserialize)]
pub struct Chart {
    /// What the chart shows, in a few words; stands above it.
    pub title: String,
    /// The horizontal axis.
    pub x: Axis,
    /// The vertical axis.
    pub y: Axis,
    /// One unit is as long along x as along y: for drawings of things.
    pub equal_aspect: bool,
    /// Without grid, ticks and labels: what is drawn has its own.
    pub frameless: bool,
    /// Height of the plotting area in CSS pixels; `None` follows from the width.
    pub height_px: Option<f64>,
    /// Drawn in this order, bands and bars first.
    pub marks: Vec<Mark>,
}

impl Chart {
    /// An empty chart with automatic ranges. The labels name the quantity and its unit.
    pub fn new(title: impl Into<String>, x_label: impl Into<String>, y_label: impl Into<String>) -> Self {
        Chart { title: title.into(), x: Axis::new(x_label), y: Axis::new(y_label), ..Chart::default() }
    }

    /// The same chart with one more mark on it.
    pub fn with(mut self, mark: Mark) -> Self {
        self.marks.push(mark);
        self
    }
}

/// Several charts in one picture, or just one (`Figure::from(chart)`).
#[derive(Debug, Clone, Default, Serialize, Deserialize)]
#[non_exhaustive]
pub struct Figure {
    /// Short name for files, for example "load-deflection".
    pub name: String,
    /// What is seen, in sentences; also read aloud by screen readers.
    pub caption: String,
    /// The charts, row by row; lettered (a), (b), … where there are several.
    pub panels: Vec<Chart>,
    /// Panels side by side; 0 counts as 1.
    pub columns: usize,
    /// One legend below all panels in place of one below each.
    pub shared_legend: bool,
    /// Panels of one column belong together, and stay together where there is room for one column
    /// alone.
    pub by_column: bool,
}

impl Figure {
    /// Several charts in rows of so many, each with its own legend.
    pub fn new(panels: Vec<Chart>, columns: usize) -> Self {
        Figure { panels, columns, ..Figure::default() }
    }

    /// The same figure with one legend below all panels.
    pub fn with_shared_legend(mut self) -> Self {
        self.shared_legend = true;
        self
    }

    /// The same figure under a file name.
    pub fn named(mut self, name: impl Into<String>) -> Self {
        self.name = name.into();
        self
    }

    /// The same figure with a caption.
    pub fn captioned(mut self, caption: impl Into<String>) -> Self {
        self.caption = caption.into();
        self
    }
}

impl From<Chart> for Figure {
    fn from(chart: Chart) -> Self {
        Figure { panels: vec![chart], columns: 1, ..Figure::default() }
    }
}

/// One axis of a chart.
#[derive(Debug, Clone, Default, Serialize, Deserialize)]
pub struct Axis {
    /// Quantity and unit, for example "deflection / µm".
    pub label: String,
    /// The label is not written: the panel below, or the one to the left, has it on the same axis.
    pub is_label_hidden: bool,
    /// What the axis spans.
    pub range: Range,
    /// Distance between ticks, for example 90 for angles in degrees; `None` chooses a 1-2-5 number.
    pub step: Option<f64>,
    /// Logarithmic, with ticks at powers of ten. What is not above zero is left out.
    pub log: bool,
    /// Names at given values in place of numbers: for bars of categories.
    pub names: Vec<(f64, String)>,
    /// Names along x read upwards: many long ones stand side by side, and none is left out.
    pub names_upwards: bool,
}

impl Axis {
    /// An axis with numbers and an automatic range.
    pub fn new(label: impl Into<String>) -> Self {
        Axis { label: label.into(), ..Axis::default() }
    }

    /// The same axis, logarithmic.
    pub fn log(self) -> Self {
        Axis { log: true, ..self }
    }
}

/// What an axis spans.
#[derive(Debug, Clone, Copy, Default, PartialEq, Serialize, Deserialize)]
pub enum Range {
    /// All data, rounded outwards to whole ticks.
    #[default]
    Auto,
    /// All data and zero, rounded outwards to whole ticks.
    AutoWithZero,
    /// From, to. Data outside is cut off.
    Fixed(f64, f64),
}

/// Something drawn on a chart. A mark with an empty label is left out of the legend;
/// marks that share a label share its entry.
#[derive(Debug, Clone, Serialize, Deserialize)]
#[non_exhaustive]
pub enum Mark {
    /// Points joined by straight lines.
    Line {
        /// Name in the legend.
        label: String,
        /// x, y.
        points: Vec<[f64; 2]>,
        /// Colour, dash and width (the marker is not drawn).
        style: Style,
    },
    /// Single points, with error bars where an error is given.
    Points {
        /// Name in the legend.
        label: String,
        /// The points.
        points: Vec<Point>,
        /// Colour and marker.
        style: Style,
    },
    /// Bars: a histogram, amounts by category, or steps from one amount to the next.
    Bars {
        /// Name in the legend.
        label: String,
        /// The bars.
        bars: Vec<Bar>,
        /// Which way the bars grow.
        direction: Direction,
        /// Colour; the dash chooses the hatching.
        style: Style,
    },
    /// The area between two curves.
    Band {
        /// Name in the legend.
        label: String,
        /// x, low y, high y.
        points: Vec<[f64; 3]>,
        /// Colour.
        style: Style,
    },
    /// The area inside a closed line.
    Area {
        /// Name in the legend.
        label: String,
        /// x, y of its corners.
        corners: Vec<[f64; 2]>,
        /// Colour; solid is filled more darkly than any dash.
        style: Style,
    },
    /// A thin line across the whole chart at one y.
    Horizontal {
        /// Where, in y.
        at: f64,
        /// Written beside the line; may be empty.
        text: String,
    },
    /// A thin line across the whole chart at one x.
    Vertical {
        /// Where, in x.
        at: f64,
        /// Written beside the line; may be empty.
        text: String,
    },
    /// A stretch along x, between thin lines, with its name at the top of the chart. A name that
    /// finds no room beside the one before it is left out.
    Stretch {
        /// Where it begins, in x.
        from: f64,
        /// Where it ends, in x.
        to: f64,
        /// Its name; may be empty.
        text: String,
    },
    /// Something that happened at one x: a dashed line with its name at the top, below those names
    /// that it would cover. A name that finds no room is left out.
    Event {
        /// Where, in x.
        at: f64,
        /// Its name; may be empty.
        text: String,
    },
    /// A note, placed beside its point where it covers least.
    Note {
        /// x, y of what the note is about.
        at: [f64; 2],
        /// The note, one line.
        text: String,
    },
    /// A text beside its point, whatever else is there.
    Text {
        /// x, y.
        at: [f64; 2],
        /// The text, one line.
        text: String,
        /// Where the text is, seen from its point.
        align: Align,
        /// How far it stands from there, to the right and down, CSS pixels.
        shift_px: [f64; 2],
        /// It is a number on an axis: on a page it changes with the unit of x.
        is_number: bool,
    },
    /// An arrow, for example a force, with a note at its tail.
    Arrow {
        /// x, y of the tail.
        from: [f64; 2],
        /// x, y of the tip.
        to: [f64; 2],
        /// The note; may be empty.
        text: String,
        /// Colour and width.
        style: Style,
    },
}

/// Where a text is, seen from its point.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
pub enum Align {
    /// It ends there.
    Left,
    /// It has its middle there.
    Middle,
    /// It begins there.
    Right,
}

/// One point with an optional error bar.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub struct Point {
    /// x.
    pub x: f64,
    /// y.
    pub y: f64,
    /// Half length of the error bar in y; 0 draws none.
    pub error: f64,
}

/// One bar from `base` to `value`.
#[derive(Debug, Clone, PartialEq, Default, Serialize, Deserialize)]
pub struct Bar {
    /// Where the bar begins on the axis it stands on.
    pub from: f64,
    /// Where the bar ends on the axis it stands on.
    pub to: f64,
    /// Where it begins; 0 for a bar that stands on its axis.
    pub base: f64,
    /// How far the bar reaches.
    pub value: f64,
    /// Written at its end, so that a bar too short to see still shows its number; may be empty.
    pub text: String,
}

/// Which way bars grow.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
pub enum Direction {
    /// Along y, standing on the x axis.
    Up,
    /// Along x, standing on the y axis.
    Right,
}

/// How a mark looks. Marks that are to be distinguished differ in colour *and* in dash or marker,
/// so that they still differ for a colour-blind reader and on a grey print.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub struct Style {
    /// Colour.
    pub colour: Colour,
    /// Dash of lines, hatching of bars.
    pub dash: Dash,
    /// Shape of points.
    pub marker: Marker,
    /// Line width in CSS pixels.
    pub width_px: f64,
    /// Half the size of markers in CSS pixels; `None` draws many points smaller than few.
    pub size_px: Option<f64>,
}

impl Style {
    /// The `n`th of a series of looks that differ in colour, dash and marker (42 in all, then
    /// again).
    pub fn nth(n: usize) -> Self {
        const COLOURS: [Colour; 7] = [
            Colour::Black,
            Colour::Vermilion,
            Colour::Blue,
            Colour::Green,
            Colour::Purple,
            Colour::SkyBlue,
            Colour::Orange,
        ];
        const DASHES: [Dash; 6] =
            [Dash::Solid, Dash::Dashed, Dash::DashDot, Dash::Dotted, Dash::LongDash, Dash::DashDotDot];
        const MARKERS: [Marker; 6] =
            [Marker::Circle, Marker::Square, Marker::Triangle, Marker::Diamond, Marker::Cross, Marker::Plus];
        Style {
            colour: COLOURS[n % 7],
            dash: DASHES[n % 6],
            marker: MARKERS[n % 6],
            width_px: 1.6,
            size_px: None,
        }
    }

    /// The same look in another line width, CSS pixels.
    pub fn width(self, width_px: f64) -> Self {
        Style { width_px, ..self }
    }

    /// The same look with markers of another half size, CSS pixels.
    pub fn size(self, size_px: f64) -> Self {
        Style { size_px: Some(size_px), ..self }
    }

    /// The same look with another dash.
    pub fn dash(self, dash: Dash) -> Self {
        Style { dash, ..self }
    }

    /// The same look with another marker.
    pub fn marker(self, marker: Marker) -> Self {
        Style { marker, ..self }
    }

    /// The same look in another colour.
    pub fn colour(self, colour: Colour) -> Self {
        Style { colour, ..self }
    }
}

/// The colours of Okabe and Ito (2008), which colour-blind readers can tell apart, without their
/// yellow (too pale on white), and a grey for what is only there to compare with.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
#[allow(missing_docs, reason = "their names say how they look")]
pub enum Colour {
    Black,
    Vermilion,
    Blue,
    Green,
    Purple,
    SkyBlue,
    Orange,
    Grey,
}

/// Dash pattern of a line; hatching of a bar.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
#[allow(missing_docs, reason = "their names say how they look")]
pub enum Dash {
    Solid,
    Dashed,
    DashDot,
    Dotted,
    LongDash,
    DashDotDot,
}

/// Shape of a point.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
#[allow(missing_docs, reason = "their names say how they look")]
pub enum Marker {
    Circle,
    Square,
    Triangle,
    Diamond,
    Cross,
    Plus,
    /// A wide open ring, to mark a place without hiding what is there.
    Ring,
    /// A disc without an edge, below all lines: one of a cloud through which a curve is seen.
    Dot,
}
