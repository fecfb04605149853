//! A box in space, seen at equal angles to its three axes: a millimetre is as long along x as along
//! y and z. What is inside throws a shadow on the floor and on both walls behind it.

use super::super::super::chart::{Align, Chart, Colour, Dash, Mark, Style};
use super::super::super::scale::{Extent, Scale, extent};

/// Ticks on the longest edge.
const TICKS: usize = 5;
/// Distance of tick labels and of axis labels from their edge, as a part of the box's size.
const TICK_AWAY: f64 = 0.05;
const LABEL_AWAY: f64 = 0.2;
/// And beyond that, down and to the side, CSS pixels: letters are as high in a small box.
const TICK_PX: [f64; 2] = [2.0, 6.0];
const LABEL_PX: [f64; 2] = [6.0, 10.0];
/// The name of the upright axis stands above its highest tick.
const UP_PX: f64 = 13.0;

/// Across the lower left edge: −½, −½√3.
const LEFT_DOWN: [f64; 2] = [-0.5, -0.866_025_403_784_438_6];

/// A box with whole ticks at its ends, mm.
pub(super) struct IsometricBox {
    low: [f64; 3],
    high: [f64; 3],
    ticks: [Vec<(f64, String)>; 3],
}

/// The plane that a shadow falls on.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) enum Plane {
    /// z = lowest: what is seen from above.
    Floor,
    /// x = lowest.
    LeftWall,
    /// y = highest: what is seen from the side.
    RightWall,
}

impl Plane {
    pub(super) const ALL: [Plane; 3] = [Plane::Floor, Plane::LeftWall, Plane::RightWall];
}

impl IsometricBox {
    /// Around these extents.
    pub(super) fn around(extents: [Extent; 3]) -> Self {
        let extents = extents.map(|e| e.unwrap_or((0.0, 0.0)));
        let size = extents.iter().map(|(low, high)| high - low).fold(0.0, f64::max);
        // around a single point something to draw in
        let size = if size > 0.0 { size } else { 100.0 };
        let scales = extents.map(|(low, high)| {
            // an edge is no shorter than a fifth of the longest
            let air = 0.5 * (0.2 * size - (high - low)).max(0.0);
            let count = ((TICKS as f64 * (high - low + 2.0 * air) / size).round() as usize).max(1);
            Scale::rounded(low - air, high + air, count)
        });
        IsometricBox {
            low: [0, 1, 2].map(|i| scales[i].from),
            high: [0, 1, 2].map(|i| scales[i].to),
            ticks: scales.map(|scale| scale.ticks),
        }
    }

    /// Where a point of space is seen: x to the right and down, y to the right and up, z up.
    pub(super) fn seen(&self, [x, y, z]: [f64; 3]) -> [f64; 2] {
        // (x + y) cos 30°, z + (y − x) sin 30°
        [0.75f64.sqrt() * (x + y), z + 0.5 * (y - x)]
    }

    /// Where the shadow of a point is seen.
    pub(super) fn shadow(&self, plane: Plane, [x, y, z]: [f64; 3]) -> [f64; 2] {
        self.seen(match plane {
            Plane::Floor => [x, y, self.low[2]],
            Plane::LeftWall => [self.low[0], y, z],
            Plane::RightWall => [x, self.high[1], z],
        })
    }

    /// The largest of the edges, mm.
    pub(super) fn size(&self) -> f64 {
        [0, 1, 2].map(|i| self.high[i] - self.low[i]).into_iter().fold(0.0, f64::max)
    }

    /// The lowest place of the drawing below the left corner, where a key has room.
    pub(super) fn key_place(&self) -> [f64; 2] {
        let [left, _] = self.seen([self.low[0], self.low[1], self.low[2]]);
        let [_, bottom] = self.seen([self.high[0], self.low[1], self.low[2]]);
        [left, bottom.min(self.name_of_x()[1])]
    }

    /// Below the middle of the lower left edge.
    fn name_of_x(&self) -> [f64; 2] {
        let middle = 0.5 * self.low[0] + 0.5 * self.high[0];
        let [u, v] = self.seen([middle, self.low[1], self.low[2]]);
        let away = LABEL_AWAY * self.size();
        [u + away * LEFT_DOWN[0], v + away * LEFT_DOWN[1]]
    }

    /// An empty chart with floor, walls, ticks and the names of the axes.
    pub(super) fn chart(&self, title: String) -> Chart {
        // the drawing has axes of its own; by these a page knows the unit of their numbers
        let mut chart = Chart::new(title, "x / mm", "z / mm");
        (chart.equal_aspect, chart.frameless) = (true, true);
        let ([xl, yl, zl], [xh, yh, zh]) = (self.low, self.high);
        let grid = Style::nth(0).colour(Colour::Grey).dash(Dash::Solid).width(0.4);
        let edge = Style::nth(0).colour(Colour::Black).dash(Dash::Solid).width(1.0);
        let mut line = |points: &[[f64; 3]], style: Style| {
            let points = points.iter().map(|p| self.seen(*p)).collect();
            chart.marks.push(Mark::Line { label: String::new(), points, style });
        };
        let [xs, ys, zs] = &self.ticks;
        for (x, _) in xs {
            line(&[[*x, yl, zl], [*x, yh, zl], [*x, yh, zh]], grid);
        }
        for (y, _) in ys {
            line(&[[xh, *y, zl], [xl, *y, zl], [xl, *y, zh]], grid);
        }
        for (z, _) in zs {
            line(&[[xl, yl, *z], [xl, yh, *z], [xh, yh, *z]], grid);
        }
        line(&[[xl, yl, zh], [xl, yl, zl], [xh, yl, zl], [xh, yh, zl]], edge);
        // away from the box, across each edge in the plane of the picture
        let away = |by: f64, [dx, dy]: [f64; 2], p: [f64; 3]| {
            let [u, v] = self.seen(p);
            [u + by * self.size() * dx, v + by * self.size() * dy]
        };
        let (left_down, right_down, left) = (LEFT_DOWN, [-LEFT_DOWN[0], LEFT_DOWN[1]], [-1.0, 0.0]);
        let mut number = |at: [f64; 2], label: &String, align: Align, [side, down]: [f64; 2]| {
            let shift_px = [if align == Align::Left { -side } else { side }, down];
            chart.marks.push(Mark::Text { at, text: label.clone(), align, shift_px, is_number: true });
        };
        for (x, label) in xs {
            number(away(TICK_AWAY, left_down, [*x, yl, zl]), label, Align::Left, TICK_PX);
        }
        for (y, label) in ys {
            number(away(TICK_AWAY, right_down, [xh, *y, zl]), label, Align::Right, TICK_PX);
        }
        for (z, label) in zs {
            number(away(0.3 * TICK_AWAY, left, [xl, yl, *z]), label, Align::Left, [TICK_PX[0], 0.0]);
        }
        let mut name = |at: [f64; 2], text: &str, align: Align, shift_px: [f64; 2]| {
            chart.marks.push(Mark::Text { at, text: text.into(), align, shift_px, is_number: false });
        };
        let middle = |a: f64, b: f64| 0.5 * a + 0.5 * b;
        let [side, down] = LABEL_PX;
        let of_y = away(LABEL_AWAY, right_down, [xh, middle(yl, yh), zl]);
        name(self.name_of_x(), "x / mm", Align::Middle, [-side, down]);
        name(of_y, "y / mm", Align::Middle, [side, down]);
        name(self.seen([xl, yl, zh]), "z / mm", Align::Middle, [0.0, -UP_PX]);
        chart
    }
}

/// The extents of some points along x, y and z.
pub(super) fn extents(points: impl Iterator<Item = [f64; 3]> + Clone) -> [Extent; 3] {
    [0, 1, 2].map(|i| extent(points.clone().map(|p| p[i])))
}

#[cfg(test)]
mod tests {
    use super::*;

    fn unit_box() -> IsometricBox {
        IsometricBox::around([Some((0.0, 100.0)), Some((0.0, 100.0)), Some((0.0, 100.0))])
    }

    #[test]
    fn a_millimetre_is_as_long_along_every_axis() {
        let room = unit_box();
        let [origin, x, y, z] =
            [[0.0; 3], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]].map(|p| room.seen(p));
        for axis in [x, y, z] {
            approx::assert_relative_eq!(f64::hypot(axis[0] - origin[0], axis[1] - origin[1]), 1.0);
        }
        // x to the right and down, y to the right and up
        assert!(x[0] > 0.0 && x[1] < 0.0 && y[0] > 0.0 && y[1] > 0.0);
    }

    #[test]
    fn shadows_fall_along_the_axes() {
        let (room, p) = (unit_box(), [40.0, 70.0, 20.0]);
        assert_eq!(room.shadow(Plane::Floor, p), room.seen([40.0, 70.0, 0.0]));
        assert_eq!(room.shadow(Plane::LeftWall, p), room.seen([0.0, 70.0, 20.0]));
        assert_eq!(room.shadow(Plane::RightWall, p)[0], room.seen([40.0, room.high[1], 20.0])[0]);
    }
}
