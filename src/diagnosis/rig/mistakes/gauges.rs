//! One of several sensors along the rod that is not what the file says: turned round, in another
//! unit, or at the other one's station.
//!
//! Its lines are wrong and those of all others are right. Other physics of one station (a point
//! beside the one that was stated) never turns a slope round, and never changes it as much as a
//! unit does.

use super::lines::{Line, lines};
use super::mended::Mended;
use super::part::Part;
use super::sensors::Expected;
use crate::diagnosis::rig::effects::mistakes::{SIGN_MISTAKE, SWAP_MISTAKE, UNIT_MISTAKE};
use crate::diagnosis::rig::mistakes::labels::{ReadIn, of_readings};
use crate::diagnosis::rig::mistakes::possible::exact;
use crate::diagnosis::rig::recording::columns::{columns, number_in_file};
use crate::diagnosis::rig::recording::datum;
use crate::error::Result;
use crate::inference::Key;
use crate::spatial::Axis;
use crate::units::MM;

/// A line is right that is off by less than this share of the rod's; two whose stations are
/// exchanged are so by less than this, each of the other's.
const RIGHT: f64 = 0.3;
const EXCHANGED: f64 = 0.15;
/// What the rod expects of a line, as a share of the largest deflection, and how well the line is
/// known, as a share of that: others say nothing.
const EXPECTED: f64 = 0.02;
const KNOWN: f64 = 0.1;
/// Stations from which on the others say which one is wrong.
const FEWEST: usize = 3;

/// What is wrong with one sensor, and what undoes it.
enum Wrong {
    /// True over recorded.
    Factor(f64),
    /// It stands at the station of the other one.
    Exchanged(f64),
}

impl Mended {
    /// Sensors along the rod.
    pub(super) fn gauges(&mut self) -> Result<()> {
        let data = datum::all(&self.readings.rows);
        let mut all = lines(&data, |_| true);
        all.retain(|line| line.fit.error.is_finite());
        let Some(expected) = self.expected(&all)? else { return Ok(()) };
        for (station, wrong, part) in gauges(&all, &expected) {
            for &i in &part.data {
                let (row, channel) = (data[i].row - 1, data[i].channel.index());
                if let (Wrong::Factor(factor), Some(offset)) =
                    (&wrong, &mut self.readings.rows[row].offset[channel])
                {
                    *offset *= factor;
                }
            }
            if let Wrong::Exchanged(other) = wrong {
                for row in &mut self.readings.rows {
                    row.read_station = row.read_station.map(|own| match own {
                        own if own == station => other,
                        own if own == other => station,
                        own => own,
                    });
                }
            }
            self.add_part(part);
        }
        Ok(())
    }
}

/// Each such sensor by its station, m; `expected` are the slopes of the lines by the rod.
fn gauges(lines: &[Line], expected: &Expected) -> Vec<(f64, Wrong, Part)> {
    let gauges = Gauges { lines, expected: &expected.slopes };
    let mut stations: Vec<f64> = gauges.known().filter_map(|k| lines[k].stations[1]).collect();
    stations.sort_by(f64::total_cmp);
    stations.dedup();
    let is_scale_right = (expected.scale - 1.0).abs() < RIGHT;
    // what is read at the tip is right as well
    let is_tip_right = gauges.known().all(|k| gauges.is_right(k) || lines[k].stations[1].is_some());
    if stations.len() < FEWEST || !is_scale_right || !is_tip_right {
        return Vec::new();
    }
    let is_wrong = |own: &f64| !gauges.at(*own).all(|k| gauges.is_right(k));
    let wrong: Vec<f64> = stations.iter().copied().filter(is_wrong).collect();
    if let [one, other] = wrong[..]
        && let Some(part) = gauges.exchanged(one, other)
    {
        return vec![(one, Wrong::Exchanged(other), part)];
    }
    if 2 * wrong.len() > stations.len() {
        return Vec::new();
    }
    // what is wrong in another way is no mistake of one sensor
    let of_one =
        |&station: &f64| gauges.of_one(station).map(|(factor, part)| (station, Wrong::Factor(factor), part));
    wrong.iter().map(of_one).collect::<Option<Vec<_>>>().unwrap_or_default()
}

/// Lines of several sensors with their slopes by the rod, m/N.
struct Gauges<'a> {
    lines: &'a [Line],
    expected: &'a [f64],
}

impl Gauges<'_> {
    fn deflection(&self, k: usize) -> f64 {
        self.expected[k].abs() * self.lines[k].largest_load
    }

    /// The lines that say something.
    fn known(&self) -> impl Iterator<Item = usize> {
        let most = (0..self.lines.len()).map(|k| self.deflection(k)).fold(0.0, f64::max);
        (0..self.lines.len()).filter(move |&k| {
            let line = &self.lines[k];
            line.has_slope
                && self.deflection(k) > EXPECTED * most
                && line.fit.error < KNOWN * self.expected[k].abs()
        })
    }

    /// Those of them at one station.
    fn at(&self, station: f64) -> impl Iterator<Item = usize> {
        self.known().filter(move |&k| self.lines[k].stations[1] == Some(station))
    }

    fn ratio(&self, k: usize) -> f64 {
        self.lines[k].fit.slope / self.expected[k]
    }

    fn is_right(&self, k: usize) -> bool {
        (self.ratio(k) - 1.0).abs() < RIGHT
    }

    /// How far the largest reading is off, m.
    fn explained(&self, own: &[usize]) -> f64 {
        let off =
            |&k: &usize| (self.lines[k].fit.slope - self.expected[k]).abs() * self.lines[k].largest_load;
        own.iter().map(off).fold(0.0, f64::max)
    }

    /// True where a line is that of the sensor at another station.
    fn shows(&self, k: usize, there: f64) -> bool {
        let key = |k: usize| (self.lines[k].axis, self.lines[k].channel, self.lines[k].stations[0]);
        let own = self.at(there).find(|&other| key(other) == key(k));
        own.is_some_and(|other| (self.lines[k].fit.slope / self.expected[other] - 1.0).abs() < EXCHANGED)
    }

    /// Two stations whose sensors each show what the rod does at the other one's.
    fn exchanged(&self, one: f64, other: f64) -> Option<Part> {
        let is_it = self.at(one).all(|k| self.shows(k, other)) && self.at(other).all(|k| self.shows(k, one));
        is_it.then_some(())?;
        let [a, b] = [one, other].map(|station| number_in_file(station / MM));
        let own: Vec<usize> = self.at(one).chain(self.at(other)).collect();
        Some(Part {
            effect: &SWAP_MISTAKE,
            location: Key::new("read_station_mm").rows(format!("{a} and {b}")),
            estimates: Vec::new(),
            observed: format!(
                "The stations {a} and {b} mm are swapped: write {b} for {a}, and {a} for {b}, in the column \
                 read_station_mm"
            ),
            looks_like: format!("the stations {a} and {b} mm of read_station_mm look swapped"),
            explains: self.explained(&own),
            data: own.iter().flat_map(|&k| self.lines[k].data.iter().copied()).collect(),
            rivals: Vec::new(),
        })
    }

    /// A sensor, or some channels of it, that is turned round or in another unit; with what undoes
    /// it.
    fn of_one(&self, station: f64) -> Option<(f64, Part)> {
        let own: Vec<usize> = self.at(station).filter(|&k| !self.is_right(k)).collect();
        let mut channels: Vec<Axis> = own.iter().map(|&k| self.lines[k].channel).collect();
        channels.sort_unstable();
        channels.dedup();
        let is_of_channels = |k: usize| channels.contains(&self.lines[k].channel);
        if self.at(station).any(|k| self.is_right(k) && is_of_channels(k)) {
            return None;
        }
        let location =
            Key::new(columns(&channels)).rows(format!("read_station_mm {}", number_in_file(station / MM)));
        let is_by = |factor: f64| own.iter().all(|&k| (self.ratio(k) * factor - 1.0).abs() < RIGHT);
        let part = |effect, observed, looks_like: &str, estimates| Part {
            effect,
            observed,
            looks_like: format!("{location} {looks_like}"),
            location: location.clone(),
            estimates,
            explains: self.explained(&own),
            // what it hardly shows is of the same sensor
            data: (0..self.lines.len())
                .filter(|&k| self.lines[k].stations[1] == Some(station) && is_of_channels(k))
                .flat_map(|k| self.lines[k].data.iter().copied())
                .collect(),
            rivals: Vec::new(),
        };
        if is_by(-1.0) {
            let observed =
                format!("The sign is wrong at one station ({location}): multiply these readings by −1");
            return Some((
                -1.0,
                part(&SIGN_MISTAKE, observed, "has the wrong sign, as it looks", Vec::new()),
            ));
        }
        let unit = of_readings().into_iter().find(|unit| is_by(unit.factor))?;
        let ReadIn { name, factor, cure } = unit;
        let observed =
            format!("Readings of one station ({location}) are in {name}, not in micrometres: {cure}");
        Some((
            factor,
            part(&UNIT_MISTAKE, observed, &format!("looks like {name}"), vec![exact("factor", factor)]),
        ))
    }
}
