//! Numbers of a memory besides its width: of its shape.

use super::bouc_wen::LoopShape;
use super::memory::Memory;
use super::stops::Stops;

/// Shapes of a first look at a loop.
const SHARPNESSES: [f64; 3] = [1.0, 2.0, 5.0];
const BALANCES: [f64; 2] = [0.55, 0.9];

/// A number of a shape, for people.
pub(super) struct OfShape {
    pub symbol: String,
    pub name: String,
    pub value: f64,
    /// From where to where it may be; nothing where that depends on the others.
    pub range: Option<(f64, f64)>,
    /// True where it has the unit of the variable.
    pub is_width: bool,
}

impl Memory {
    /// True for one with a shape.
    pub fn has_shape(self) -> bool {
        match self {
            Memory::BoucWen(_) | Memory::Stops(_) => true,
            Memory::None | Memory::Side | Memory::Stop | Memory::Play | Memory::Lag | Memory::Lagged => false,
        }
    }

    /// What its prior is beside that of another one: that one part more slips at a load of its own
    /// is half as likely each time.
    pub(super) fn share(self) -> f64 {
        match self {
            Memory::Stops(stops) => 0.5f64.powi(stops.count() as i32 - 1),
            _ => 1.0,
        }
    }

    /// Its numbers, each where its prior is even.
    pub(super) fn shape(self) -> Vec<f64> {
        match self {
            Memory::BoucWen(LoopShape { sharpness, balance }) => vec![sharpness.ln(), balance],
            Memory::Stops(stops) => stops.numbers(),
            _ => Vec::new(),
        }
    }

    /// The same with other numbers.
    pub(super) fn shaped(self, numbers: &[f64]) -> Memory {
        match (self, numbers) {
            (Memory::BoucWen(_), &[sharp, balance]) => {
                Memory::BoucWen(LoopShape { sharpness: sharp.exp(), balance })
            }
            (Memory::Stops(_), _) => Memory::Stops(Stops::of_numbers(numbers)),
            _ => self,
        }
    }

    /// From where to where they may be.
    pub(super) fn shape_ranges(self) -> Vec<(f64, f64)> {
        match self {
            Memory::BoucWen(_) => {
                let (low, high) = LoopShape::SHARPNESS;
                vec![(low.ln(), high.ln()), LoopShape::BALANCE]
            }
            Memory::Stops(stops) => stops.ranges(),
            _ => Vec::new(),
        }
    }

    /// Those of a first look.
    pub(super) fn first_shapes(self) -> Vec<Memory> {
        let of_sharpness = |sharpness: f64| BALANCES.map(|balance| LoopShape { sharpness, balance });
        match self {
            Memory::BoucWen(_) => {
                SHARPNESSES.into_iter().flat_map(of_sharpness).map(Memory::BoucWen).collect()
            }
            Memory::Stops(stops) => stops.first().into_iter().map(Memory::Stops).collect(),
            _ => Vec::new(),
        }
    }

    /// For people; `width` is its own number.
    pub(super) fn of_shape(self, width: f64) -> Vec<OfShape> {
        let plain = |symbol: &str, name: &str, value: f64, range: Option<(f64, f64)>| OfShape {
            symbol: symbol.into(),
            name: name.into(),
            value,
            range,
            is_width: false,
        };
        match self {
            Memory::BoucWen(shape) => {
                vec![
                    plain("n", "sharpness", shape.sharpness, Some(LoopShape::SHARPNESS)),
                    plain("s", "share of β", shape.balance, Some(LoopShape::BALANCE)),
                ]
            }
            Memory::Stops(stops) => {
                let of_stop = |(k, (own, share)): (usize, (f64, f64))| {
                    let number = k + 1;
                    let (half, slope) =
                        (format!("half width {number}"), format!("share {number} of the slope"));
                    let half = plain(&format!("r{number}"), &half, own * width, None);
                    let slope = plain(&format!("w{number}"), &slope, share, None);
                    [OfShape { is_width: true, ..half }, slope]
                };
                stops.narrower().enumerate().flat_map(of_stop).collect()
            }
            _ => Vec::new(),
        }
    }
}
