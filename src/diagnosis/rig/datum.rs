//! The data of a recording: one for each offset that was measured, with the run through the loads that it belongs to.

use std::collections::HashMap;
use std::hash::Hash;

use crate::inference::RunName;
use crate::rig::readings::{Axis, Direction, Phase, Reading};

/// One measured offset.
#[derive(Debug, Clone, PartialEq)]
pub struct Datum {
    /// Row in the file, from 1: rows of readings only, without the header, comments and blank lines.
    pub row: usize,
    /// Line in the file, from 1.
    pub line: usize,
    /// Direction of the load in {T}.
    pub direction: Direction,
    /// Axis of the offset in {T}.
    pub channel: Axis,
    /// Nominal magnitude of the load, N.
    pub load: f64,
    /// Whether the load was reached by loading or by unloading.
    pub phase: Option<Phase>,
    /// Name of the trial, where the file has one.
    pub trial: Option<String>,
    /// Number of the trial, from 0, across axes: the runs of one name, else the k-th run of each axis.
    pub trial_number: usize,
    /// Number of the run, from 0: one trial along one axis, from one zeroing to the next.
    pub run: usize,
    /// Time of the reading, s.
    pub time: Option<f64>,
    /// Temperature, °C.
    pub temperature: Option<f64>,
    /// Arc length from the flange to the load, m; `None`: the tip.
    pub load_station: Option<f64>,
    /// Arc length from the flange to the sensor, m; `None`: the tip.
    pub read_station: Option<f64>,
    /// The offset that was read, m.
    pub measured: f64,
    /// The offset that the base model predicts, m; 0 without a rod.
    pub predicted: f64,
}

impl Datum {
    /// The nominal load along the positive axis, N.
    pub fn signed_load(&self) -> f64 {
        f64::from(self.direction.sign) * self.load
    }

    /// `row 17 dy`.
    pub fn name(&self) -> String {
        format!("row {} d{}", self.row, self.channel)
    }

    /// What names its run among those of its axis; nothing where the file has no names.
    pub(super) fn run_name(&self) -> Option<RunName> {
        self.trial.clone().map(RunName::Trial)
    }

    /// A phase that is not stated counts as loading.
    pub(super) fn is_unloading(&self) -> bool {
        self.phase == Some(Phase::Unload)
    }

    /// Where the load hangs and the sensor stands; NaN is the tip.
    pub(super) fn stations(&self) -> [u64; 2] {
        [self.load_station, self.read_station].map(|station| station.unwrap_or(f64::NAN).to_bits())
    }

    /// What is one straight line of an ideal rod: axis, channel and places.
    pub(super) fn line_key(&self) -> (Axis, Axis, [u64; 2]) {
        (self.direction.axis, self.channel, self.stations())
    }
}

/// One datum for each offset of the rows, in their order; nothing predicted yet.
pub(super) fn all(rows: &[Reading]) -> Vec<Datum> {
    let runs = runs(rows);
    let of_row = |(index, row): (usize, &Reading)| {
        let (run, trial_number) = runs[index];
        let row = row.clone();
        Axis::ALL.into_iter().filter_map(move |channel| {
            Some(Datum {
                row: index + 1,
                line: row.line,
                direction: row.direction,
                channel,
                load: row.load,
                phase: row.phase,
                trial: row.trial.clone(),
                trial_number,
                run,
                time: row.time,
                temperature: row.temperature,
                load_station: row.load_station,
                read_station: row.read_station,
                measured: row.offset[channel.index()]?,
                predicted: 0.0,
            })
        })
    };
    rows.iter().enumerate().flat_map(of_row).collect()
}

/// Number of each value among the different ones, in order of appearance.
pub(super) fn numbered<K: Eq + Hash>(keys: impl IntoIterator<Item = K>) -> Vec<usize> {
    let mut known: HashMap<K, usize> = HashMap::new();
    let number = |key: K| {
        let next = known.len();
        *known.entry(key).or_insert(next)
    };
    keys.into_iter().map(number).collect()
}

/// What distinguishes a load from others: direction, size, phase, places.
type Condition = (i8, u64, Option<Phase>, [Option<u64>; 2]);

/// What a run without a name has seen so far.
#[derive(Default)]
struct OpenRun {
    /// How many runs the axis had before this one.
    ordinal: usize,
    seen: Vec<(Condition, [bool; 3])>,
}

/// For each row the number of its run and of its trial.
///
/// A trial with a name is one run along each axis. Without names, a run along an axis goes on until something is read
/// again that it has read before; reading the display once more at the same load is no new run.
fn runs(rows: &[Reading]) -> Vec<(usize, usize)> {
    let names = numbered(rows.iter().filter_map(|row| row.trial.as_deref()));
    let count = names.iter().max().map_or(0, |last| last + 1);
    let (mut names, mut open) = (names.into_iter(), [const { None::<OpenRun> }; 3]);
    let mut trial_of = |row: &Reading| match row.trial {
        Some(_) => names.next().unwrap_or_default(),
        None => count + unnamed(&mut open[row.direction.axis.index()], row),
    };
    let trials: Vec<usize> = rows.iter().map(&mut trial_of).collect();
    let runs = numbered(rows.iter().zip(&trials).map(|(row, trial)| (row.direction.axis, *trial)));
    runs.into_iter().zip(trials).collect()
}

/// Number of the run that a row without a trial continues or begins.
fn unnamed(open: &mut Option<OpenRun>, row: &Reading) -> usize {
    let stations = [row.load_station, row.read_station].map(|s| s.map(f64::to_bits));
    let condition = (row.direction.sign, row.load.to_bits(), row.phase, stations);
    let channels = row.offset.map(|offset| offset.is_some());
    let overlaps = |other: &[bool; 3]| channels.iter().zip(other).any(|(a, b)| *a && *b);
    let run = open.get_or_insert_default();
    let is_same_load = run.seen.last().is_some_and(|(last, _)| *last == condition);
    let is_repeat = run.seen.iter().any(|(seen, read)| *seen == condition && overlaps(read));
    if is_repeat && !is_same_load {
        *run = OpenRun { ordinal: run.ordinal + 1, seen: Vec::new() };
    }
    run.seen.push((condition, channels));
    run.ordinal
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::rig::readings::Readings;

    fn runs_of(text: &str) -> Vec<(usize, usize)> {
        let data = all(&Readings::from_text("f", text).unwrap().rows);
        data.iter().map(|d| (d.run, d.trial_number)).collect()
    }

    #[test]
    fn a_datum_is_an_offset_and_blank_cells_are_none() {
        let text = "axis,load_n,dx_um,dz_um\n# a comment\ny,5,1,\nz,5,2,3\n\nz,6,,4\n";
        let data = all(&Readings::from_text("f", text).unwrap().rows);
        let names: Vec<String> = data.iter().map(Datum::name).collect();
        assert_eq!(names, ["row 1 dx", "row 2 dx", "row 2 dz", "row 3 dz"]);
        assert_eq!(data[3].line, 6);
    }

    #[test]
    fn a_named_trial_is_one_run_along_each_axis() {
        let text = "axis,load_n,trial,dy_um\ny,1,a,0\ny,2,a,0\nz,1,a,0\ny,1,b,0\nz,1,b,0\nz,2,b,0\n";
        assert_eq!(runs_of(text), [(0, 0), (0, 0), (1, 0), (2, 1), (3, 1), (3, 1)]);
    }

    #[test]
    fn without_names_a_run_ends_where_a_load_comes_again() {
        let text = "axis,load_n,phase,dy_um,dz_um
y,1,load,0,
y,1,load,0,
y,2,load,0,
y,1,unload,0,
z,1,load,0,
z,1,load,,0
y,1,load,0,
y,2,load,0,
z,2,load,0,
z,1,load,0,
";
        let expected = [(0, 0), (0, 0), (0, 0), (0, 0), (1, 0), (1, 0), (2, 1), (2, 1), (1, 0), (3, 1)];
        assert_eq!(runs_of(text), expected);
    }
}
