//! How fast a rod swings, and in which shapes.

use nalgebra::Vector3;

use super::pictures::{RodShape, ShapeCase, rod_shape};
use super::rod_drawing::drawing;
use super::table::{Column, Table};
use super::{Block, Section};
use crate::beam::{NaturalMode, Physics, RodModel, settling_time};
use crate::rod::Rod;
use crate::units::{MM, UM, significant};

/// What a swing dies down to in the settling time.
pub const SHARE: f64 = 0.02;

/// How fast the rod swings, and in which shapes; nothing of a rod without mass.
pub fn section(
    rod: &Rod,
    centreline: &[Vector3<f64>],
    modes: &[NaturalMode],
    damping: Option<f64>,
) -> Option<Section> {
    /// Damping ratios of bare tubes, and with bonded or threaded joints.
    const DAMPING: [f64; 2] = [0.002, 0.01];
    let damping = damping.map_or(DAMPING.to_vec(), |ratio| vec![ratio]);
    if modes.is_empty() {
        return None;
    }
    let mut columns = vec![Column::text("mode"), Column::text("swings"), Column::number("frequency", "Hz")];
    columns.extend(
        damping
            .iter()
            .map(|ratio| Column::number(format!("to 2 % at {} % damping", (1e5 * ratio).round() / 1e3), "s")),
    );
    let caption = format!("Rod {}: slowest natural modes, clamped at the flange.", rod.name);
    let mut table = Table::new("natural-frequencies", caption, columns);
    let direction = |mode: &NaturalMode| {
        let sum = |axis: usize| mode.shape.iter().map(|[u, _]| u[axis].powi(2)).sum::<f64>();
        let (across, within) = (sum(1), sum(0) + sum(2));
        match across / (across + within) {
            share if share > 0.99 => "out of the rod's plane",
            share if share < 0.01 => "in the rod's plane",
            _ => "both ways",
        }
    };
    for (k, mode) in modes.iter().enumerate() {
        let mut cells = vec![(k + 1).to_string(), direction(mode).to_owned(), significant(mode.frequency, 4)];
        cells
            .extend(damping.iter().map(|ratio| significant(settling_time(mode.frequency, *ratio, SHARE), 2)));
        table.row(cells);
    }
    // a tip that swings by 1 mm
    let shapes = |mode: &NaturalMode| mode.shape.iter().map(|[u, _]| u * MM).collect::<Vec<_>>();
    let all: Vec<Vec<Vector3<f64>>> = modes.iter().map(shapes).collect();
    let cases = modes.iter().zip(&all).map(|(mode, shape)| ShapeCase {
        label: format!("{} Hz", significant(mode.frequency, 4)),
        deflection_um: shape.iter().map(|u| (u / UM).into()).collect(),
    });
    let mut drawn = drawing(rod);
    // the shapes need the room; what the tubes are stands elsewhere
    drawn.tubes.iter_mut().for_each(|tube| tube.label.clear());
    let figure = rod_shape(&RodShape {
        centreline_mm: centreline.iter().map(|p| (p / MM).into()).collect(),
        cases: cases.collect(),
        ..drawn
    });
    let words = "Exact flexibilities, consistent mass of Timoshenko beams with rotary inertia; the robot is assumed rigid. \
         Readings within the settling time of a move are readings of a swing.";
    let shown = format!("Shapes of the slowest natural modes. {}", figure.caption);
    Some(Section::new(
        format!("How rod {} swings", rod.name),
        vec![
            Block::Paragraph(words.into()),
            Block::Table(table),
            Block::Figure(figure.named("natural-modes").captioned(shown.trim())),
        ],
    ))
}

/// The same of a rod that nobody has looked at yet; nothing where its model has no modes.
pub fn of_rod(rod: &Rod) -> Option<Section> {
    /// Enough for a smooth curve.
    const POINTS: usize = 60;
    const MODES: usize = 3;
    let chain = RodModel::new(rod, &Physics::WHOLE, POINTS, &[]).ok()?.chain;
    let centreline: Vec<_> = (0..=chain.end()).map(|node| chain.position(node)).collect();
    section(rod, &centreline, &chain.natural_modes(MODES).ok()?, None)
}
