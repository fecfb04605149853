//! Mistakes of whole columns and of the rod file: the lines of the readings against the rod.

use super::labels::{self, Labels};
use super::lines::{Line, lines};
use super::mended::Mended;
use super::physics::Physics;
use super::possible::PossibleMistake;
use super::rods::{self, Body};
use super::search::{self, LinesOnRod, MistakeSearch};
use super::sensors::Expected;
use crate::diagnosis::rig::mechanics::structure::check_stations;
use crate::diagnosis::rig::numbering::numbered;
use crate::diagnosis::rig::recording::datum;
use crate::error::Result;
use crate::rod::Rod;

/// So many lines are enough.
const MOST_LINES: usize = 45;
/// So many times softer than its pipes a rod may be beside a unit's factor, where nothing but some
/// factor explains the readings: what joins its parts yields too.
const SOFTER: f64 = 1.5;

impl Mended {
    /// The slope of each line by the rod, in the scale that most lines have.
    pub(super) fn expected(&self, lines: &[Line]) -> Result<Option<Expected>> {
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
    pub(super) fn labels(&mut self, others: &[(String, Rod)]) -> Result<()> {
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
        let on_rod = LinesOnRod { lines: &all, pair: &pair, pairs: &pairs, base: &base, length, is_possible };
        if all.is_empty() {
            return Ok(());
        }
        let verdict = |rod: &Rod| {
            let body = Body { rod: rod.clone(), stations: [1.0; 2] };
            search::physics(&[body], on_rod.pairs).pop()?.map(|physics| on_rod.verdict_of(&physics))
        };
        self.others = rods::likely(&rod, others, verdict);
        if !on_rod.is_implausible() {
            return Ok(());
        }
        let has = |k: usize| pairs.iter().any(|pair| pair[k].is_some());
        let (bodies, of_rod): (Vec<Body>, Vec<PossibleMistake>) =
            rods::all(&rod, others, [has(0), has(1)]).into_iter().unzip();
        let names = Labels::of(&all, self.readings.load_column);
        let mut possible = labels::all(&names);
        possible.extend(of_rod);
        let unknown = match is_possible {
            true => labels::unknown_units(&names, |channels| on_rod.log_scale_of(channels)),
            false => Vec::new(),
        };
        let known = possible.len();
        possible.extend(unknown.into_iter().filter(|unknown| !on_rod.may_be_loose(unknown)));
        // where no physics is a rival, the likelier one of a unit's factor and any other counts
        let softer = if possible.len() > known { SOFTER } else { 1.0 };
        let physics = search::physics(&bodies, on_rod.pairs);
        let search = MistakeSearch { lines: on_rod, possible: &possible, bodies: &physics, softer };
        let Some((best, found)) = search.found() else { return Ok(()) };
        for one in found {
            self.add_mistake(&possible, &one);
            for channel in possible[one.number].channels_of_unknown_unit() {
                self.readings.header.has_unknown_scale[best.relabelling.channel[channel]] = true;
            }
        }
        if best.relabelling.body > 0 {
            self.others.clear();
            let body = &bodies[best.relabelling.body - 1];
            for row in &mut self.readings.rows {
                row.load_station = row.load_station.map(|s| s * body.stations[0]);
                row.read_station = row.read_station.map(|s| s * body.stations[1]);
            }
            self.rod = Some(body.rod.clone());
        }
        best.relabelling.undo(&mut self.readings);
        Ok(())
    }
}

/// The pairs of stations of lines, and for each line its own.
fn pairs(lines: &[Line]) -> (Vec<[Option<f64>; 2]>, Vec<usize>) {
    let pair = numbered(lines.iter().map(|line| line.stations.map(|station| station.map(f64::to_bits))));
    let mut pairs = Vec::new();
    for (line, &number) in lines.iter().zip(&pair) {
        if number == pairs.len() {
            pairs.push(line.stations);
        }
    }
    (pairs, pair)
}
