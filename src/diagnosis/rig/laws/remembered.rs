//! What laws of files follow instead of their variable.

use crate::inference::law::{LoopShape, Memory, Site, Stops};
use crate::rod::LawMemory;

/// Least number of a memory, as a share of the largest value or in s: none has less than nothing.
const LEAST: f64 = 1e-6;

/// The variable of each datum of a site as a law with this memory sees it, SI; `own` are the
/// memory's constants by their names in files, in the unit of the variable.
pub fn remembered(memory: Option<LawMemory>, site: &Site, own: impl Fn(&str) -> f64) -> Vec<f64> {
    let width = || (own("r") * site.variable.si / site.largest()).max(LEAST);
    let stops = |narrower: &[(&str, &str)]| {
        let widest = own("r").max(f64::MIN_POSITIVE);
        let one = |(r, w): &(&str, &str)| (own(r) / widest, own(w));
        (Memory::Stops(Stops::new(&narrower.iter().map(one).collect::<Vec<_>>())), width())
    };
    let (memory, number) = match memory {
        None => (Memory::None, 0.0),
        Some(LawMemory::Stop) => (Memory::Stop, width()),
        Some(LawMemory::Play) => (Memory::Play, width()),
        Some(LawMemory::TwoStops) => stops(&[("r1", "w1")]),
        Some(LawMemory::ThreeStops) => stops(&[("r1", "w1"), ("r2", "w2")]),
        Some(LawMemory::BoucWen) => (Memory::BoucWen(LoopShape::within(own("n"), own("s"))), width()),
        Some(LawMemory::Lag) => (Memory::Lag, own("tau").max(LEAST)),
    };
    memory.remembered(site, number).0
}

/// How a file says what a law remembers, but for the sign of the last move, which formulas have.
pub fn in_file(memory: Memory) -> Option<LawMemory> {
    match memory {
        // of what a file has no variable for
        Memory::None | Memory::Side | Memory::Lagged => None,
        Memory::Stop => Some(LawMemory::Stop),
        Memory::Play => Some(LawMemory::Play),
        Memory::Stops(stops) if stops.count() == 2 => Some(LawMemory::TwoStops),
        Memory::Stops(_) => Some(LawMemory::ThreeStops),
        Memory::BoucWen(_) => Some(LawMemory::BoucWen),
        Memory::Lag => Some(LawMemory::Lag),
    }
}
