//! Data that show the same, and what they show: evaluated once for all of them.

use super::datum::Datum;
use super::numbering::numbered;

/// Data that differ in nothing but their place in the history of loads: load, phase, place and
/// channel are the same.
#[derive(Debug, Clone)]
pub(super) struct Cases {
    pub of_datum: Vec<usize>,
    /// The first datum of each.
    pub first: Vec<usize>,
}

impl Cases {
    pub(super) fn of(data: &[Datum], place: &[usize]) -> Cases {
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
pub(super) struct Shown {
    /// m/N.
    pub slope: f64,
    /// N, but for what is remembered.
    pub load: f64,
    /// m.
    pub play: f64,
}

impl Shown {
    /// Under a load that is felt.
    pub(super) fn reading(&self, load: f64) -> f64 {
        self.slope * load + self.play
    }
}
