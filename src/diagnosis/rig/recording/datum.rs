//! The data of a recording: one for each offset that was measured, with the run through the loads
//! that it belongs to.
//!
//! Data stand in the order in which they were recorded, those of one instant by station and
//! channel, so that rows in another order, one row per station and one row per channel are the same
//! recording: see [`chronicle`](super::chronicle).

use std::collections::{HashMap, HashSet};

use super::chronicle::{Chronicle, Motion};
use super::place::Known;
use super::rezeroed::{Shown, is_zeroed_by_direction};
use super::settings::{Setting, settings};
use crate::diagnosis::rig::numbering::numbered;
use crate::inference::RunName;
use crate::rig::readings::{Axis, Direction, Driven, Phase, Reading, Readings};
use crate::statistics::{one_clock, unrounded};

/// One measured offset.
#[derive(Debug, Clone, PartialEq)]
pub struct Datum {
    /// Row in the file, from 1: rows of readings only, without the header, comments and blank
    /// lines.
    pub row: usize,
    /// Line in the file, from 1.
    pub line: usize,
    /// Direction of the load in {T}.
    pub direction: Direction,
    /// Axis of the offset in {T}.
    pub channel: Axis,
    /// Nominal magnitude of the load, N.
    pub load: f64,
    /// Whether the load was reached by loading or by unloading; where no row says so and the loads
    /// go up and down, by the direction of motion.
    pub phase: Option<Phase>,
    /// The largest load that hung before in its run, the same way, N, of a load that was reached by
    /// unloading from there; infinity of all others.
    pub(in crate::diagnosis::rig) peak: f64,
    /// Which way the load or the displacement went, where that is known without a phase.
    pub(in crate::diagnosis::rig) motion: Option<Motion>,
    /// Name of the session, where the file has one.
    pub session: Option<String>,
    /// Number of the session, from 0.
    pub session_number: usize,
    /// Name of the trial, where the file has one.
    pub trial: Option<String>,
    /// Number of the trial, from 0, across axes: the runs of one name, else the k-th run of each
    /// axis.
    pub trial_number: usize,
    /// Number of the run, from 0: one trial of a session along one axis, from one zeroing to the
    /// next.
    pub run: usize,
    /// True where that is one direction of the axis only: the readings show that the other has a
    /// zero of its own.
    pub(in crate::diagnosis::rig) has_other_direction: bool,
    /// Number of the instant in the recording, from 0: data of one instant share it.
    pub order: usize,
    /// Time of the reading, s.
    pub time: Option<f64>,
    /// When this load was hung, s, on the clock of `time`.
    pub loaded_at: Option<f64>,
    /// Temperature, °C; between the steps of its display.
    pub temperature: Option<f64>,
    /// Arc length from the flange to the load, m; `None`: the tip.
    pub load_station: Option<f64>,
    /// Arc length from the flange to the sensor, m; `None`: the tip.
    pub read_station: Option<f64>,
    /// What is compared with the model, m: the offset that was read, or, of a load that was
    /// measured under an imposed displacement, the load times `Imposed::per_newton`.
    pub measured: f64,
    /// The same as the base model predicts it, m; 0 without a rod.
    pub predicted: f64,
    /// The displacement that was imposed, where the load is what was measured.
    pub imposed: Option<Imposed>,
}

/// A displacement that was imposed along the axis of the load.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Imposed {
    /// Along the positive axis, m: the setting that was read, see [`settings`](super::settings).
    pub displacement: f64,
    /// The same for all readings of one setting, their mean.
    pub set: f64,
    /// Where it is known from.
    pub known: Known,
    /// What a newton of the measured load counts, m/N: one number for all loads of a recording, its
    /// largest displacement over its largest load.
    pub per_newton: f64,
}

impl Datum {
    /// The nominal load along the positive axis, N.
    pub fn signed_load(&self) -> f64 {
        f64::from(self.direction.sign) * self.load
    }

    /// What was set: the load along the positive axis (N), or the displacement that was imposed
    /// (m).
    pub fn drive(&self) -> f64 {
        self.imposed.map_or(self.signed_load(), |imposed| imposed.set)
    }

    /// True where what was set can be set again. Displacements that scatter are no setting: those
    /// that are read alike are off by the same, and their loads too.
    pub(in crate::diagnosis::rig) fn is_at_setting(&self) -> bool {
        self.imposed.is_none_or(|imposed| imposed.known.recurs())
    }

    /// The same as the load meets it: with the drift of its zero.
    pub(in crate::diagnosis::rig) fn drive_as_read(&self) -> f64 {
        self.imposed.map_or(self.signed_load(), |imposed| imposed.displacement)
    }

    /// What the base model predicts of what was set, m: without that drift.
    pub(in crate::diagnosis::rig) fn predicted_as_set(&self) -> f64 {
        match self.imposed {
            Some(Imposed { displacement, set, .. }) if displacement != 0.0 => {
                self.predicted * set / displacement
            }
            _ => self.predicted,
        }
    }

    /// What a linear rod of this compliance (m/N) shows: the offset C·F, or the load u/C as
    /// [`Datum::measured`] counts it.
    pub(in crate::diagnosis::rig) fn elastic(&self, compliance: f64) -> f64 {
        match self.imposed {
            None => compliance * self.signed_load(),
            Some(imposed) if compliance != 0.0 => imposed.per_newton * imposed.displacement / compliance,
            Some(_) => 0.0,
        }
    }

    /// `row 17 dy`.
    pub fn name(&self) -> String {
        format!("row {} d{}", self.row, self.channel)
    }

    /// What names its run among those of its axis; nothing where the file has no names.
    pub(in crate::diagnosis::rig) fn run_name(&self) -> Option<RunName> {
        let session = self.session.as_ref().map(|session| format!("session {session}"));
        let name = match (self.trial.clone(), session) {
            (Some(trial), Some(session)) => Some(format!("{trial}, {session}")),
            (trial, session) => trial.or(session),
        };
        name.map(RunName::Trial)
    }

    /// A phase that is not stated counts as loading.
    pub(in crate::diagnosis::rig) fn is_unloading(&self) -> bool {
        self.phase == Some(Phase::Unload)
    }

    /// Where the load hangs and the sensor stands; NaN is the tip.
    pub(in crate::diagnosis::rig) fn stations(&self) -> [u64; 2] {
        [self.load_station, self.read_station].map(|station| station.unwrap_or(f64::NAN).to_bits())
    }

    /// The sensor: its channel and its place.
    pub(in crate::diagnosis::rig) fn sensor(&self) -> (Axis, u64) {
        (self.channel, self.stations()[1])
    }

    /// What is one straight line of an ideal rod: axis, channel and places.
    pub(in crate::diagnosis::rig) fn line_key(&self) -> (Axis, Axis, [u64; 2]) {
        (self.direction.axis, self.channel, self.stations())
    }
}

/// One datum for each offset of the rows of weights that were hung, in the order of recording;
/// nothing predicted yet.
pub fn all(rows: &[Reading]) -> Vec<Datum> {
    of_rows(rows, Driven::Load)
}

/// The data of a recording, in the order of recording; nothing predicted yet.
pub fn recorded(readings: &Readings) -> Vec<Datum> {
    let mut data = of_rows(&readings.rows, readings.header.driven);
    if readings.header.driven == Driven::Displacement {
        impose(&mut data, &settings(&readings.rows, readings.header.driven).rows);
    }
    data
}

/// Makes the load what was measured of all data along their loads, and the offset what was imposed;
/// `settings` of the rows of the file.
fn impose(data: &mut [Datum], settings: &[Option<Setting>]) {
    let is_along = |datum: &Datum| datum.channel == datum.direction.axis;
    let largest = |value: &dyn Fn(&Datum) -> f64| {
        data.iter().filter(|d| is_along(d)).fold(0.0, |most: f64, datum| most.max(value(datum)))
    };
    let (load, displacement) = (largest(&|d| d.load), largest(&|d| d.measured.abs()));
    if load == 0.0 || displacement == 0.0 {
        return;
    }
    let per_newton = displacement / load;
    for datum in data.iter_mut().filter(|datum| is_along(datum)) {
        let set = settings[datum.row - 1].unwrap_or(Setting::as_read(datum.measured));
        datum.imposed = Some(Imposed { displacement: set.value, set: set.set, known: set.known, per_newton });
        datum.measured = per_newton * datum.signed_load();
        if datum.motion.is_none() {
            let away = if datum.is_unloading() { -1.0 } else { 1.0 };
            let direction = away * if datum.drive() == 0.0 { 0.0 } else { datum.drive().signum() };
            let phase = datum.phase.unwrap_or(Phase::Load);
            datum.motion = Some(Motion { direction, cycle: 0, phase });
        }
    }
}

/// Of each row, °C: between the steps of its display where all rows have one.
fn temperatures(rows: &[Reading], chronicle: &Chronicle) -> Vec<Option<f64>> {
    let shown: Vec<Option<f64>> = rows.iter().map(|row| row.temperature).collect();
    let Some(values) = shown.iter().copied().collect::<Option<Vec<f64>>>() else { return shown };
    let times: Vec<Option<f64>> = rows.iter().map(|row| row.time).collect();
    let places: Vec<f64> = chronicle.rows.iter().map(|own| own.place as f64).collect();
    unrounded(&values, &one_clock(&times, &places)).into_iter().map(Some).collect()
}

fn of_rows(rows: &[Reading], driven: Driven) -> Vec<Datum> {
    let chronicle = Chronicle::of(rows, driven);
    let temperature = temperatures(rows, &chronicle);
    let of_row = |(index, row): (usize, &Reading)| {
        let (row, own) = (row.clone(), chronicle.rows[index]);
        let temperature = temperature[index];
        Axis::ALL.into_iter().filter_map(move |channel| {
            Some(Datum {
                row: index + 1,
                line: row.line,
                direction: row.direction,
                channel,
                load: row.load,
                phase: row.phase.or(own.motion.map(|motion| motion.phase)),
                peak: f64::INFINITY,
                motion: own.motion,
                session: row.session.clone(),
                session_number: own.session,
                trial: row.trial.clone(),
                trial_number: own.trial,
                run: own.run,
                has_other_direction: false,
                order: own.place,
                time: row.time,
                loaded_at: row.loaded_at,
                temperature,
                load_station: row.load_station,
                read_station: row.read_station,
                measured: row.offset[channel.index()]?,
                predicted: 0.0,
                imposed: None,
            })
        })
    };
    let mut data: Vec<Datum> = rows.iter().enumerate().flat_map(of_row).collect();
    let along = |station: Option<f64>| station.map_or(u64::MAX, f64::to_bits);
    data.sort_by_key(|datum| {
        let stations = (along(datum.load_station), along(datum.read_station));
        (datum.order, datum.run, stations, datum.channel.index(), datum.row)
    });
    let runs = numbered(data.iter().map(|datum| datum.run));
    let orders = numbered(data.iter().map(|datum| datum.order));
    for ((datum, run), order) in data.iter_mut().zip(runs).zip(orders) {
        (datum.run, datum.order) = (run, order);
    }
    if driven == Driven::Load {
        split_directions(&mut data);
    }
    find_peaks(&mut data);
    data
}

/// Makes a run of each direction of a run, where each has a zero of its own.
fn split_directions(data: &mut [Datum]) {
    let shown = |datum: &Datum| Shown {
        line: (datum.direction.axis, datum.sensor()),
        run: datum.run,
        is_against: datum.direction.sign < 0,
        order: datum.order,
        load: datum.drive(),
        measured: datum.measured,
    };
    if !is_zeroed_by_direction(data.iter().map(shown)) {
        return;
    }
    let known: HashSet<(usize, i8)> = data.iter().map(|d| (d.run, d.direction.sign)).collect();
    let runs = numbered(data.iter().map(|datum| (datum.run, datum.direction)));
    for (datum, run) in data.iter_mut().zip(runs) {
        datum.has_other_direction = known.contains(&(datum.run, -datum.direction.sign));
        datum.run = run;
    }
}

/// Fills in from which load each one was reached by unloading. The largest load that is read once
/// more before it is taken off is where the unloading begins: nothing has moved.
fn find_peaks(data: &mut [Datum]) {
    // the largest load, and the largest while loading
    let mut peaks: HashMap<(usize, Direction), (f64, f64)> = HashMap::new();
    for datum in data {
        let (peak, loaded) = peaks.entry((datum.run, datum.direction)).or_default();
        if datum.is_unloading() {
            if datum.load < *peak || datum.load == *loaded {
                datum.peak = *peak;
            }
        } else {
            *loaded = loaded.max(datum.load);
        }
        *peak = peak.max(datum.load);
    }
}

#[cfg(test)]
mod tests {
    use super::*;

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
    fn a_load_on_the_way_down_knows_from_where() {
        let text =
            "axis,load_n,trial,phase,dy_um\ny,5,a,load,0\ny,9,a,load,0\ny,5,a,unload,0\ny,9,b,unload,0\n";
        let data = all(&Readings::from_text("f", text).unwrap().rows);
        let peaks: Vec<f64> = data.iter().map(|d| d.peak).collect();
        assert_eq!(peaks, [f64::INFINITY, f64::INFINITY, 9.0, f64::INFINITY]);
        // the top read once more
        let text = "axis,load_n,trial,phase,dy_um\ny,5,a,load,0\ny,9,a,load,0\ny,9,a,unload,0\n\
                    y,5,a,unload,0\ny,9,b,unload,0\ny,9,b,unload,0\n";
        let data = all(&Readings::from_text("f", text).unwrap().rows);
        let peaks: Vec<f64> = data.iter().map(|d| d.peak).collect();
        let none = f64::INFINITY;
        assert_eq!(peaks, [none, none, 9.0, 9.0, none, none]);
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
