//! Readings and rod without their mistakes, and what is said of these.

use super::lines::lines;
use super::needed::NamedMistake;
use super::part::Part;
use super::possible::PossibleMistake;
use super::rods::OtherRod;
use crate::diagnosis::Suspicion;
use crate::diagnosis::rig::effects::mistakes::{OFFSET_MISTAKE, ROD_MISTAKE, UNIT_MISTAKE};
use crate::diagnosis::rig::recording::datum::{self, Datum};
use crate::inference::{Description, Effect, Estimate, Finding, Key, Location, Rival};
use crate::rig::readings::Readings;
use crate::rod::Rod;
use crate::units::significant;

/// Readings and a rod without the mistakes that were found in them.
#[derive(Debug, Clone)]
pub(in crate::diagnosis::rig) struct Mended {
    /// The mistakes, complete in themselves.
    pub found: Vec<Finding>,
    pub readings: Readings,
    pub rod: Option<Rod>,
    /// For each of them one line: what it looks like.
    pub suspicions: Vec<Suspicion>,
    /// Rods that may have been meant, the likeliest first; none where that was decided.
    pub others: Vec<OtherRod>,
    /// False where nothing that could be compared is left of the readings.
    pub has_data: bool,
    /// The zeros that were taken off.
    pub(super) zeros: Vec<Zero>,
}

/// A zero that was taken off.
#[derive(Debug, Clone)]
pub(super) struct Zero {
    pub location: Location,
    /// Row, channel and what stood there, m.
    pub before: Vec<(usize, usize, Option<f64>)>,
}

impl Mended {
    /// Nothing is undone yet.
    pub(super) fn new(readings: &Readings, rod: Option<&Rod>) -> Mended {
        Mended {
            found: Vec::new(),
            readings: readings.clone(),
            rod: rod.cloned(),
            suspicions: Vec::new(),
            others: Vec::new(),
            has_data: true,
            zeros: Vec::new(),
        }
    }

    /// True where some line shows more than one load.
    pub(super) fn has_slope(&self) -> bool {
        lines(&datum::all(&self.readings.rows), |_| true).iter().any(|line| line.has_slope)
    }

    /// Leaves readings out.
    pub(super) fn leave_out(&mut self, data: &[Datum], part: &Part) {
        for &i in &part.data {
            self.readings.rows[data[i].row - 1].offset[data[i].channel.index()] = None;
        }
    }

    /// Takes the zeros back that `findings` of the corrected readings undo: they were none. True
    /// where there were such.
    pub fn take_zeros_back(&mut self, findings: &[Finding]) -> bool {
        let is_zero_at = |found: &Finding, location: &Location| {
            *found.effect == OFFSET_MISTAKE && found.location == *location
        };
        let is_undone = |zero: &Zero| findings.iter().any(|found| is_zero_at(found, &zero.location));
        let (undone, kept): (Vec<Zero>, Vec<Zero>) = self.zeros.drain(..).partition(is_undone);
        self.zeros = kept;
        for zero in &undone {
            for &(row, channel, before) in &zero.before {
                self.readings.rows[row].offset[channel] = before;
            }
            self.found.retain(|found| !is_zero_at(found, &zero.location));
        }
        !undone.is_empty()
    }

    /// Takes another rod for the one that was meant: its predictions differ by `explains` (m, rms)
    /// from those before.
    pub fn take(&mut self, meant: OtherRod, log_odds: f64, explains: f64, rivals: Vec<Rival>) {
        let OtherRod { rod, effect, location, observed, .. } = meant;
        self.rod = Some(rod);
        self.others.clear();
        self.found.push(Finding {
            explains,
            p_value: (-log_odds).exp(),
            ..finding(effect, location, Vec::new(), observed, rivals)
        });
    }

    /// That the readings are of another file's rod, where that was found.
    pub fn other_rod(&self) -> Option<&Finding> {
        self.found.iter().find(|found| *found.effect == ROD_MISTAKE)
    }

    /// Names a mistake of some of the readings.
    pub(super) fn add_part(&mut self, part: Part) {
        self.suspicions.push(Suspicion::new(part.looks_like));
        let rivals = part
            .rivals
            .into_iter()
            .map(|(effect, key)| Rival::without_term(effect, key.into(), 1.0))
            .collect();
        self.found.push(Finding {
            explains: part.explains,
            ..finding(part.effect, part.location, part.estimates, part.observed, rivals)
        });
    }

    /// Names one of the `possible` ones.
    pub(super) fn add_mistake(&mut self, possible: &[PossibleMistake], found: &NamedMistake) {
        let own = &possible[found.number];
        let times = found.log_scale_before.abs().exp();
        let softer = if found.log_scale_before > 0.0 { "softer" } else { "stiffer" };
        let why = match times > 2.0 && own.effect == &UNIT_MISTAKE {
            true => format!(": the rod seems {} times {softer} than its file", significant(times, 2)),
            false => String::new(),
        };
        self.suspicions.push(Suspicion::new(format!("{}{why}", own.looks_like)));
        let mut rivals: Vec<Rival> = Vec::new();
        for &(number, odds) in &found.rivals {
            let other = &possible[number];
            let location = Location::from(other.location.clone());
            let is_known =
                rivals.iter().any(|known| known.effect == other.effect && known.location == location);
            if !is_known && (other.effect, &other.location) != (own.effect, &own.location) {
                rivals.push(Rival::without_term(other.effect, location, odds.max(1.0)));
            }
        }
        let (estimates, observed) = (own.estimates.clone(), own.observed_in_all_rows());
        self.found.push(Finding {
            explains: found.explains,
            p_value: (-found.log_odds).exp(),
            ..finding(own.effect, own.location.clone(), estimates, observed, rivals)
        });
    }
}

/// A mistake with what checks it: nothing of it is left in the model.
fn finding(
    effect: &'static Effect,
    location: Key,
    estimates: Vec<Estimate>,
    observed: String,
    rivals: Vec<Rival>,
) -> Finding {
    // the correction says what it is
    let description = Description { observed, cause: String::new() };
    let mut finding = Finding::without_terms(effect, location.into(), estimates, description);
    finding.next = finding.direct_check(&rivals.iter().collect::<Vec<_>>());
    Finding { rivals, ..finding }
}
