//! Data that show the same, and what they show: evaluated once for all of them.

use crate::diagnosis::rig::numbering::numbered;
use crate::diagnosis::rig::recording::datum::Datum;

/// Data that differ in nothing but their place in the history of loads: load, phase, place and
/// channel are the same.
#[derive(Debug, Clone)]
pub struct Cases {
    pub of_datum: Vec<usize>,
    /// The first datum of each.
    pub first: Vec<usize>,
}

impl Cases {
    pub fn of(data: &[Datum], place: &[usize]) -> Cases {
        let key = |(d, place): (&Datum, &usize)| {
            (
                (d.direction, d.load.to_bits(), d.is_unloading(), d.peak.to_bits()),
                (d.channel, *place, d.session_number),
            )
        };
        let of_datum = numbered(data.iter().zip(place).map(key));
        let first = firsts(&of_datum);
        Cases { of_datum, first }
    }
}

/// Where each number is met first.
fn firsts(numbers: &[usize]) -> Vec<usize> {
    let mut first = Vec::new();
    for (i, &number) in numbers.iter().enumerate() {
        if number == first.len() {
            first.push(i);
        }
    }
    first
}

/// What the data of a case show.
pub struct Shown {
    /// m/N.
    pub slope: f64,
    /// N, but for what is remembered.
    pub load: f64,
    /// m.
    pub play: f64,
}

impl Shown {
    /// Under a load that is felt.
    pub fn reading(&self, load: f64) -> f64 {
        self.slope * load + self.play
    }
}
