//! What all parts of a picture share: the frame of its axes, and the lettering of its notes.

use super::labels::Area;
use super::plot::{Anchor, Lettering, Px};
use super::scale::Scale;

/// Numbers, notes and legends.
pub(super) const NOTE: Lettering =
    Lettering { size_px: 11.5, bold: false, anchor: Anchor::Middle, upwards: false };

/// The axes: from data to pixels.
pub(super) struct Frame {
    pub(super) area: Area,
    pub(super) x: Scale,
    pub(super) y: Scale,
    /// Units of x and y that a reader may switch; empty where there are none.
    pub(super) units: [String; 2],
}

impl Frame {
    /// Where a data point lies on the picture.
    pub(super) fn px(&self, point: [f64; 2]) -> Px {
        [
            self.area.left + self.x.fraction(point[0]) * self.area.width(),
            self.area.bottom - self.y.fraction(point[1]) * self.area.height(),
        ]
    }

    /// How much of x a pixel is.
    pub(super) fn unit_per_px(&self) -> f64 {
        (self.x.to - self.x.from) / self.area.width()
    }

    /// Whether a data point has a place on the picture, be it beyond the frame.
    pub(super) fn places(&self, point: [f64; 2]) -> bool {
        self.x.places(point[0]) && self.y.places(point[1])
    }
}
