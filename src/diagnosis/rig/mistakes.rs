//! Mistakes before physics: units, signs, names, zeros, sensors, files.
//!
//! They are discrete, few and of enormous evidence, so they are undone before there is a model.
//! Three steps:
//!
//! 1. readings that no load could give: channels that are stuck or cut off, runs whose sign is the
//!    other way (`sensors.rs`, `groups.rs`); a line of readings shows these by itself;
//! 2. the slopes of all lines against the rod (`lines.rs`, `physics.rs`): where what is left is
//!    more than ordinary physics leaves, some hundred hypotheses (`moves.rs`, `rods.rs`), each a
//!    [`change::Change`] of readings and rod, compete with each other and with all that physics may
//!    add (`search.rs`);
//! 3. zeros that were not taken, on the corrected lines (`groups.rs`).
//!
//! A mistake is named where what it acts on is more than 22 % (rms) off without it and plausible
//! with it, at odds of 1000 against everything else. Physics may stand beside: a unit counts where
//! what remains is a factor of 0.8 to 1.25.

mod change;
mod copies;
mod displaced;
mod entries;
mod groups;
mod increments;
mod lines;
mod lookalikes;
mod moves;
mod part;
mod physics;
mod rods;
mod search;
mod sensors;
#[cfg(test)]
mod tests;
mod trials;

use self::change::Move;
use self::lines::{Line, lines};
pub(super) use self::lookalikes::{is_one_factor, lookalikes};
use self::moves::Labels;
use self::part::Part;
use self::physics::Physics;
use self::rods::Body;
pub(super) use self::rods::OtherRod;
use self::search::{Found, Search, Trial};
pub(super) use self::search::{ODDS, RARE};
use self::sensors::Expected;
use super::datum;
use super::effects::mistakes::{OFFSET_MISTAKE, ROD_MISTAKE, UNIT_MISTAKE};
use super::structure::check_stations;
use crate::error::Result;
use crate::inference::{Description, Effect, Estimate, Finding, Location, Rival};
use crate::rig::readings::Readings;
use crate::rod::Rod;
use crate::units::significant;

/// So many lines are enough.
const MOST_LINES: usize = 45;

/// Readings and a rod without the mistakes that were found in them.
#[derive(Debug, Clone)]
pub(super) struct Mended {
    /// The mistakes, complete in themselves.
    pub found: Vec<Finding>,
    pub readings: Readings,
    pub rod: Option<Rod>,
    /// For each of them one line: what it looks like.
    pub suspicions: Vec<String>,
    /// Rods that may have been meant, the likeliest first; none where that was decided.
    pub others: Vec<OtherRod>,
    /// False where nothing that could be compared is left of the readings.
    pub has_data: bool,
    /// The zeros that were taken off.
    zeros: Vec<Zero>,
}

/// A zero that was taken off.
#[derive(Debug, Clone)]
struct Zero {
    location: Location,
    /// Row, channel and what stood there, m.
    before: Vec<(usize, usize, Option<f64>)>,
}

/// One line for each mistake that `readings` seem to hold, for those who do not ask for a
/// diagnosis: `load_n looks like kilograms: the rod seems 9.8 times softer than its file; rodcal
/// diagnose rig says more`.
///
/// # Errors
/// What the beam model refuses of the rod.
pub fn suspected(readings: &Readings, rod: Option<&Rod>) -> Result<Vec<String>> {
    Ok(mended(readings, rod, &[])?.suspicions)
}

/// Readings and rod without mistakes; `others` are rods that may have been meant, by their files.
pub(super) fn mended(readings: &Readings, rod: Option<&Rod>, others: &[(String, Rod)]) -> Result<Mended> {
    let mut mended = Mended {
        found: Vec::new(),
        readings: readings.clone(),
        rod: rod.cloned(),
        suspicions: Vec::new(),
        others: Vec::new(),
        has_data: true,
        zeros: Vec::new(),
    };
    mended.copies();
    mended.increments()?;
    mended.displaced();
    mended.trials()?;
    mended.entries();
    mended.sensors()?;
    if mended.has_data {
        mended.labels(others)?;
        mended.zeros();
    }
    mended.has_data = mended.has_data && has_slope(&mended.readings);
    mended.found.sort_by(|a, b| b.explains.total_cmp(&a.explains));
    Ok(mended)
}

fn has_slope(readings: &Readings) -> bool {
    lines(&datum::all(&readings.rows), |_| true).iter().any(|line| line.has_slope)
}

impl Mended {
    /// Trials that are copies.
    fn copies(&mut self) {
        let data = datum::all(&self.readings.rows);
        for part in copies::found(&data) {
            self.leave_out(&data, &part);
            self.add_part(part);
        }
    }

    /// Readings that are increments.
    fn increments(&mut self) -> Result<()> {
        let data = datum::all(&self.readings.rows);
        let all = lines(&data, |_| true);
        let Some(rod) = self.expected(&all)? else { return Ok(()) };
        let by_rod: Vec<f64> = rod.slopes.iter().map(|slope| slope / rod.scale).collect();
        if let Some(found) = increments::found(&data, &all, &by_rod) {
            for (datum, offset) in data.iter().zip(&found.offsets) {
                self.readings.rows[datum.row - 1].offset[datum.channel.index()] = Some(*offset);
            }
            self.add_part(found.part);
        }
        Ok(())
    }

    fn leave_out(&mut self, data: &[datum::Datum], part: &Part) {
        for &i in &part.data {
            self.readings.rows[data[i].row - 1].offset[data[i].channel.index()] = None;
        }
    }

    /// Loads that were typed wrongly.
    fn entries(&mut self) {
        let data = datum::all(&self.readings.rows);
        for entry in entries::found(&data, &lines(&data, |_| true), self.readings.load_column) {
            match entry.load {
                Some(load) => entry.rows.iter().for_each(|&row| self.readings.rows[row].load = load),
                None => self.leave_out(&data, &entry.part),
            }
            self.add_part(entry.part);
        }
    }

    /// Readings and loads in other rows than those where they belong.
    fn displaced(&mut self) {
        if let Some(found) = displaced::found(&self.readings.rows, self.readings.load_column) {
            self.readings.rows = found.rows;
            self.add_part(found.part);
        }
    }

    /// Units, signs and names of some trials.
    fn trials(&mut self) -> Result<()> {
        let data = datum::all(&self.readings.rows);
        let all = lines(&data, |_| true);
        let trials = trials::Table::of(&data, &all);
        if trials.is_alike() {
            return Ok(());
        }
        let by_rod = self.expected(&all)?;
        let by_rod: Option<Vec<f64>> =
            by_rod.map(|rod| rod.slopes.iter().map(|slope| slope / rod.scale).collect());
        let moves = moves::in_trials(&Labels::of(&all, self.readings.load_column));
        for found in trials.found(&moves, by_rod.as_deref()) {
            let mut rows: Vec<usize> = found.part.data.iter().map(|&i| data[i].row - 1).collect();
            rows.sort_unstable();
            rows.dedup();
            rows.into_iter().for_each(|row| found.change.undo_in(&mut self.readings.rows[row]));
            self.add_part(found.part);
        }
        Ok(())
    }

    /// Sensors that are stuck or cut off, and signs of single runs.
    fn sensors(&mut self) -> Result<()> {
        // a limit first: what stays at it looks frozen, and what is frozen for long looks stuck
        for kind in 0..3 {
            let data = datum::all(&self.readings.rows);
            let all = lines(&data, |_| true);
            let parts = match kind {
                0 => sensors::saturated(&data, &all, self.expected(&all)?.as_ref()),
                1 => sensors::frozen(&data),
                _ => sensors::stuck(&data, &all, self.expected(&all)?.as_ref()),
            };
            for part in parts {
                self.leave_out(&data, &part);
                self.add_part(part);
            }
        }
        if !has_slope(&self.readings) {
            self.has_data = false;
            return Ok(());
        }
        let data = datum::all(&self.readings.rows);
        let all = lines(&data, |_| true);
        let expected = self.expected(&all)?;
        for part in groups::flipped(&data, &all, expected.as_ref().map(|of| &of.slopes[..])) {
            for &i in &part.data {
                let offset = &mut self.readings.rows[data[i].row - 1].offset[data[i].channel.index()];
                *offset = offset.map(|offset| -offset);
            }
            self.add_part(part);
        }
        Ok(())
    }

    /// The slope of each line by the rod, in the scale that most lines have.
    fn expected(&self, lines: &[Line]) -> Result<Option<Expected>> {
        let Some(rod) = &self.rod else { return Ok(None) };
        let (pairs, pair) = pairs(lines);
        let physics = Physics::new(rod, &pairs)?;
        let of_line = |(line, &pair): (&Line, &usize)| {
            physics.compliance(pair)[(line.channel.index(), line.axis.index())]
        };
        let expected: Vec<f64> = lines.iter().zip(&pair).map(of_line).collect();
        let most = lines.iter().zip(&expected).map(|(l, e)| e.abs() * l.largest_load).fold(0.0, f64::max);
        let mut scales: Vec<f64> = Vec::new();
        for (line, expected) in lines.iter().zip(&expected) {
            let is_shown = line.fit.slope.abs() > 10.0 * line.fit.error;
            if is_shown && expected.abs() * line.largest_load > 0.05 * most {
                scales.push((line.fit.slope / expected).abs());
            }
        }
        let scale = crate::statistics::median(&scales).unwrap_or(1.0);
        Ok(Some(Expected { slopes: expected.into_iter().map(|slope| slope * scale).collect(), scale }))
    }

    /// Units, signs and names of columns and keys, and other rods.
    fn labels(&mut self, others: &[(String, Rod)]) -> Result<()> {
        let Some(rod) = self.rod.clone() else { return Ok(()) };
        let data = datum::all(&self.readings.rows);
        let mut all = lines(&data, |_| true);
        all.retain(|line| line.fit.error.is_finite());
        if all.len() > MOST_LINES {
            let shown = |line: &Line| line.fit.slope.abs() * line.largest_load;
            all.sort_by(|a, b| shown(b).total_cmp(&shown(a)));
            all.truncate(MOST_LINES);
        }
        let (pairs, pair) = pairs(&all);
        let base = Physics::new(&rod, &pairs)?;
        let is_possible = check_stations(&self.readings, &rod).is_ok();
        let length = rod.length();
        let search = Search { lines: &all, pair: &pair, pairs: &pairs, base: &base, length, is_possible };
        if all.is_empty() {
            return Ok(());
        }
        let verdict = |rod: &Rod| {
            let body = Body { rod: rod.clone(), stations: [1.0; 2] };
            search::physics(&[body], search.pairs).pop()?.map(|physics| search.verdict_of(&physics))
        };
        self.others = rods::likely(&rod, others, verdict);
        if !search.is_implausible() {
            return Ok(());
        }
        let has = |k: usize| pairs.iter().any(|pair| pair[k].is_some());
        let (bodies, keys): (Vec<Body>, Vec<Move>) =
            rods::all(&rod, others, [has(0), has(1)]).into_iter().unzip();
        let mut moves = moves::all(&Labels::of(&all, self.readings.load_column));
        moves.extend(keys);
        let physics = search::physics(&bodies, search.pairs);
        let trial = Trial { search, moves: &moves, bodies: &physics };
        let Some((state, found)) = trial.found() else { return Ok(()) };
        for one in found {
            self.add_move(&moves, &one);
        }
        if state.change.body > 0 {
            self.others.clear();
            let body = &bodies[state.change.body - 1];
            for row in &mut self.readings.rows {
                row.load_station = row.load_station.map(|s| s * body.stations[0]);
                row.read_station = row.read_station.map(|s| s * body.stations[1]);
            }
            self.rod = Some(body.rod.clone());
        }
        state.change.undo(&mut self.readings);
        Ok(())
    }

    /// Zeros that were not taken.
    fn zeros(&mut self) {
        if self.rod.is_none() {
            return;
        }
        let data = datum::all(&self.readings.rows);
        for part in groups::offsets(&data, &lines(&data, |_| true)) {
            let zero = part.estimates.first().map_or(0.0, |estimate| estimate.value);
            let mut before = Vec::with_capacity(part.data.len());
            for &i in &part.data {
                let (row, channel) = (data[i].row - 1, data[i].channel.index());
                let offset = &mut self.readings.rows[row].offset[channel];
                before.push((row, channel, *offset));
                *offset = offset.map(|offset| offset - zero);
            }
            self.zeros.push(Zero { location: Location::key(part.location.clone()), before });
            self.add_part(part);
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

    /// Takes another rod for the one that was meant: what it says of the readings is `explains` (m,
    /// rms) from what was said before.
    pub fn take(&mut self, meant: OtherRod, log_odds: f64, explains: f64) {
        let OtherRod { rod, effect, location, words, .. } = meant;
        self.rod = Some(rod);
        self.others.clear();
        self.found.push(Finding {
            explains,
            p_value: (-log_odds).exp(),
            ..finding(effect, location, Vec::new(), words, Vec::new())
        });
    }

    /// That the readings are of another file's rod, where that was found.
    pub fn other_rod(&self) -> Option<&Finding> {
        self.found.iter().find(|found| *found.effect == ROD_MISTAKE)
    }

    fn add_part(&mut self, part: Part) {
        self.suspicions.push(format!("{}; `rodcal diagnose rig` says more.", part.looks_like));
        let rivals = part
            .rivals
            .into_iter()
            .map(|(effect, at)| Rival::without_term(effect, Location::key(at), 1.0))
            .collect();
        self.found.push(Finding {
            explains: part.explains,
            ..finding(part.effect, part.location, part.estimates, part.observed, rivals)
        });
    }

    fn add_move(&mut self, moves: &[Move], found: &Found) {
        let own = &moves[found.number];
        let times = found.log_scale_before.abs().exp();
        let softer = if found.log_scale_before > 0.0 { "softer" } else { "stiffer" };
        let why = match times > 2.0 && own.effect == &UNIT_MISTAKE {
            true => format!(": the rod seems {} times {softer} than its file", significant(times, 2)),
            false => String::new(),
        };
        self.suspicions.push(format!("{}{why}; `rodcal diagnose rig` says more.", own.looks_like));
        let mut rivals: Vec<Rival> = Vec::new();
        for &(number, odds) in &found.rivals {
            let other = &moves[number];
            let location = Location::key(other.location.clone());
            let is_known =
                rivals.iter().any(|known| known.effect == other.effect && known.location == location);
            if !is_known && (other.effect, &other.location) != (own.effect, &own.location) {
                rivals.push(Rival::without_term(other.effect, location, odds.max(1.0)));
            }
        }
        let (estimates, observed) = (own.estimates.clone(), own.observed.clone());
        self.found.push(Finding {
            explains: found.explains,
            p_value: (-found.log_odds).exp(),
            ..finding(own.effect, own.location.clone(), estimates, observed, rivals)
        });
    }
}

/// The pairs of stations of lines, and for each line its own.
fn pairs(lines: &[Line]) -> (Vec<[Option<f64>; 2]>, Vec<usize>) {
    let pair = super::numbering::numbered(
        lines.iter().map(|line| line.stations.map(|station| station.map(f64::to_bits))),
    );
    let mut pairs = Vec::new();
    for (line, &number) in lines.iter().zip(&pair) {
        if number == pairs.len() {
            pairs.push(line.stations);
        }
    }
    (pairs, pair)
}

/// A mistake with what checks it: nothing of it is left in the model.
fn finding(
    effect: &'static Effect,
    location: String,
    estimates: Vec<Estimate>,
    observed: String,
    rivals: Vec<Rival>,
) -> Finding {
    // the correction says what it is
    let description = Description { observed, cause: String::new() };
    let mut finding = Finding::without_terms(effect, Location::key(location), estimates, description);
    finding.next = finding.direct_check(&rivals.iter().collect::<Vec<_>>());
    Finding { rivals, ..finding }
}
