//! What the engine knows about a rig's recording besides the residual: what repeats, what belongs
//! together, what to hold out, and along which numbers a mismatch may be structured.

use std::collections::BTreeMap;

use nalgebra::{DMatrix, DVector};

use super::datum::Datum;
use super::resolution::resolution;
use super::spread;
use crate::diagnosis::rig::numbering::numbered;
use crate::inference::{Covariate, Evidence, Variable};
use crate::rig::readings::RigHeader;
use crate::spatial::Axis;

/// Folds of a cross-validation: fewer cost less to run, more keep more to learn from.
const MOST_FOLDS: usize = 5;
const FEWEST_FOLDS: usize = 3;
/// Error of a sensor's zero that all runs have in common, as a share of its full scale: the zero
/// balance of good load cells and displacement sensors is stated as 0.05 to 1 %.
const ZERO: f64 = 5e-4;
/// Scatter that a rig may have, as a share of its largest reading: displacement sensors repeat to
/// 0.1 % of their range or better, and a range is not used to less than a tenth.
const SCATTER: f64 = 0.03;
/// And in steps of the display.
const STEPS_OF_DISPLAY: f64 = 2.0;

/// The evidence of `data`, whose predictions are made.
pub fn of_data(
    data: &[Datum],
    header: &RigHeader,
    nuisance: DMatrix<f64>,
    large: Option<DVector<f64>>,
    errors: &DMatrix<f64>,
) -> Evidence {
    let spread = spread::spread(data, header);
    let (sensor, noise_range) = spread::sensors(data);
    let residual = DVector::from_iterator(data.len(), data.iter().map(|d| d.measured - d.predicted));
    let (offsets, least_offset) = zeros(data);
    Evidence {
        nuisance,
        background: background(data, large, errors),
        offsets,
        least_offset,
        is_robust: true,
        most_scatter: most_scatter(data),
        replicate_group: numbered(data.iter().enumerate().map(|(i, d)| {
            let sign = d.imposed.map_or(d.direction.sign, |_| 0);
            let set = (d.drive().abs().to_bits(), d.drive() < 0.0);
            (d.session_number, d.line_key(), sign, set, d.phase, (!d.is_at_setting()).then_some(i))
        })),
        // the zero of a run is that of one sensor at one place
        shared: numbered(data.iter().map(|d| (d.run, d.sensor()))),
        series: numbered(data.iter().map(Datum::line_key)),
        instant: numbered(data.iter().map(|d| d.row)),
        session: sessions(data),
        fold: folds(data),
        weight: spread.iter().map(|own| own.powi(-2)).collect(),
        is_spread_stated: header.noise.is_some() && header.load_noise.is_some(),
        sensor,
        noise_range,
        spread,
        resolution: resolution(data),
        covariates: covariates(data),
        ..Evidence::new(residual)
    }
}

/// The largest scatter that a rig may have, m: a share of its largest reading, and some steps of
/// the display. What is larger is no noise, whether or not anything was repeated.
fn most_scatter(data: &[Datum]) -> Option<f64> {
    let largest = data.iter().fold(0.0, |most: f64, datum| most.max(datum.measured.abs()));
    Some((SCATTER * largest).max(STEPS_OF_DISPLAY * resolution(data)))
}

/// What large deflections add (`large`), which the linear model leaves out, whether or not the
/// readings show it; and what displacements that were imposed are off by (`errors` of each row,
/// [`Settings::errors`](super::settings::Settings)), which moves their loads.
fn background(data: &[Datum], large: Option<DVector<f64>>, errors: &DMatrix<f64>) -> DMatrix<f64> {
    // u² and u·c·F of each line
    let mut sums: BTreeMap<_, [f64; 2]> = BTreeMap::new();
    for (d, imposed) in data.iter().filter_map(|d| Some((d, d.imposed?))) {
        let sum = sums.entry(d.line_key()).or_default();
        sum[0] += imposed.displacement.powi(2);
        sum[1] += imposed.displacement * d.measured;
    }
    // c/C
    let per_metre = |d: &Datum| match sums.get(&d.line_key()) {
        Some([square, product]) if d.imposed.is_some() && *square > 0.0 => product / square,
        _ => 0.0,
    };
    let first = usize::from(large.is_some());
    let mut columns = DMatrix::zeros(data.len(), first + errors.ncols());
    if let Some(large) = large {
        columns.set_column(0, &large);
    }
    for (i, d) in data.iter().enumerate() {
        let own = errors.row(d.row - 1) * per_metre(d);
        columns.view_mut((i, first), (1, errors.ncols())).copy_from(&own);
    }
    columns
}

/// The session of each datum, where there are several.
fn sessions(data: &[Datum]) -> Vec<usize> {
    match data.iter().any(|d| d.session_number > 0) {
        true => data.iter().map(|d| d.session_number).collect(),
        false => vec![Evidence::NONE; data.len()],
    }
}

/// The zero of each channel at each place where it reads, in each session, with its least size.
fn zeros(data: &[Datum]) -> (DMatrix<f64>, Vec<f64>) {
    let sensors = numbered(data.iter().map(|d| (d.session_number, d.sensor())));
    let count = count(&sensors);
    let offsets = DMatrix::from_fn(data.len(), count, |i, k| f64::from(u8::from(sensors[i] == k)));
    let mut largest = vec![0.0f64; count];
    for (datum, &sensor) in data.iter().zip(&sensors) {
        largest[sensor] = largest[sensor].max(datum.measured.abs());
    }
    (offsets, largest.into_iter().map(|largest| ZERO * largest).collect())
}

/// One column for each straight line through the origin: the load or the imposed displacement. For
/// readings without a rod.
pub fn slopes(data: &[Datum], line: &[usize]) -> DMatrix<f64> {
    let count = line.iter().max().map_or(0, |last| last + 1);
    DMatrix::from_fn(data.len(), count, |i, j| if line[i] == j { data[i].drive_as_read() } else { 0.0 })
}

/// Three to five folds of whole trials. Of one or two trials whole cycles are held out where the
/// load goes up and down again and again; else whole loads, so that repeats stay together; of one
/// or two loads every third datum of a line.
fn folds(data: &[Datum]) -> Vec<usize> {
    let trials: Vec<usize> = numbered(data.iter().map(|d| d.trial_number));
    if count(&trials) >= FEWEST_FOLDS {
        return trials.iter().map(|trial| trial % MOST_FOLDS).collect();
    }
    let cycles = numbered(data.iter().map(|d| (d.run, d.motion.map(|motion| motion.cycle))));
    if data.iter().any(|d| d.motion.is_some_and(|motion| motion.cycle > 0)) {
        return cycles.iter().map(|cycle| cycle % MOST_FOLDS).collect();
    }
    let levels = levels(data);
    if count(&levels) >= FEWEST_FOLDS {
        return levels.iter().map(|level| level % MOST_FOLDS).collect();
    }
    let lines = numbered(data.iter().map(Datum::line_key));
    let mut met = vec![0; count(&lines)];
    let place_in_line = |&line: &usize| {
        met[line] += 1;
        (met[line] - 1) % FEWEST_FOLDS
    };
    lines.iter().map(place_in_line).collect()
}

fn count(numbers: &[usize]) -> usize {
    numbers.iter().max().map_or(0, |last| last + 1)
}

/// For each datum how many smaller loads there are along its axis.
fn levels(data: &[Datum]) -> Vec<usize> {
    let loads = Axis::ALL.map(|axis| {
        let along = data.iter().filter(|d| d.direction.axis == axis);
        let mut loads: Vec<f64> = along.map(|d| d.load).collect();
        loads.sort_by(f64::total_cmp);
        loads.dedup();
        loads
    });
    let level = |d: &Datum| loads[d.direction.axis.index()].partition_point(|&load| load < d.load);
    data.iter().map(level).collect()
}

/// What a datum has of a covariate.
type Value<'a> = &'a dyn Fn(&Datum) -> Option<f64>;

fn covariates(data: &[Datum]) -> Vec<Covariate> {
    let mut first_of_run: Vec<Option<f64>> = Vec::new();
    for datum in data {
        first_of_run.resize(first_of_run.len().max(datum.run + 1), None);
        first_of_run[datum.run] = first_of_run[datum.run].or(datum.time);
    }
    let since = |d: &Datum| Some(d.time? - first_of_run[d.run]?);
    let number = |axis: Axis| axis.index() as f64;
    let phase = |d: &Datum| Some(if d.is_unloading() { 1.0 } else { -1.0 }).filter(|_| d.phase.is_some());
    let all: [(Variable, Value<'_>); 10] = [
        (Variable::Load, &|d| Some(d.load)),
        (Variable::SignedLoad, &|d| Some(d.signed_load())),
        (Variable::Phase, &phase),
        (Variable::Order, &|d| Some(d.order as f64)),
        (Variable::Time, &|d| d.time),
        (Variable::TimeInRun, &since),
        (Variable::Temperature, &|d| d.temperature),
        (Variable::Trial, &|d| Some(d.trial_number as f64)),
        (Variable::Channel, &|d| Some(number(d.channel))),
        (Variable::LoadAxis, &|d| Some(number(d.direction.axis))),
    ];
    let covariates = all.into_iter().map(|(variable, value)| Covariate {
        variable,
        values: data.iter().map(|d| value(d).unwrap_or(f64::NAN)).collect(),
    });
    covariates.filter(Covariate::varies).collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::diagnosis::rig::recording::datum;
    use crate::rig::readings::Readings;

    fn evidence(text: &str) -> Evidence {
        let data = datum::all(&Readings::from_text("f", text).unwrap().rows);
        let none = DMatrix::zeros(data.len(), 0);
        of_data(&data, &RigHeader::default(), none.clone(), None, &none)
    }

    fn trials(count: usize) -> String {
        let mut text = "axis,load_n,trial,dy_um,dz_um\n".to_owned();
        for axis in ["y", "-y", "z"] {
            for trial in 0..count {
                for load in [5, 10, 15, 20] {
                    text += &format!("{axis},{load},{trial},{load},1.5\n");
                }
            }
        }
        text
    }

    #[test]
    fn repeats_are_cells_and_a_run_shares_its_zero() {
        let evidence = evidence(&trials(3));
        // 3 directions × 4 loads × 2 channels; y and -y of one trial are one run
        assert_eq!(count(&evidence.replicate_group), 24);
        assert_eq!(count(&evidence.shared), 12);
        assert_eq!(evidence.replicate_group[0], evidence.replicate_group[8]);
        assert_eq!(evidence.shared[0], evidence.shared[2]);
        assert_ne!(evidence.shared[0], evidence.shared[1]);
    }

    #[test]
    fn there_are_three_to_five_folds_of_trials_loads_or_rows() {
        for (trials_in_file, folds) in [(1, 4), (2, 4), (3, 3), (5, 5), (12, 5)] {
            assert_eq!(count(&evidence(&trials(trials_in_file)).fold), folds);
        }
        let of_loads = evidence(&trials(2));
        assert_eq!(of_loads.fold[0], of_loads.fold[8]);
        let two_loads = evidence("axis,load_n,dy_um\ny,1,1\ny,2,2\ny,1,1\ny,2,2\n");
        assert_eq!(two_loads.fold, [0, 1, 2, 0]);
    }

    #[test]
    fn covariates_are_what_varies() {
        let text =
            "axis,load_n,phase,time_s,temperature_c,dy_um\ny,1,load,7,20,1\n-y,2,,9,20,1\ny,1,unload,,20,1\n";
        let evidence = evidence(text);
        let names: Vec<String> = evidence.covariates.iter().map(|c| c.variable.to_string()).collect();
        assert_eq!(names, ["load", "signed load", "phase", "order", "time", "time in the run"]);
        let phase = &evidence.covariates[2].values;
        assert_eq!((phase[0], phase[2]), (-1.0, 1.0));
        assert!(phase[1].is_nan());
    }

    #[test]
    fn displacements_that_are_read_alike_by_chance_are_no_repeats() {
        const ROWS: &str = "axis,load_n,dy_um\ny,1,10.1\ny,2,20.3\ny,1,10.1\n";
        // no setting recurs here
        let text = format!("# driven = displacement\n{ROWS}");
        let data = datum::recorded(&Readings::from_text("f", &text).unwrap());
        let none = DMatrix::zeros(data.len(), 0);
        let read = of_data(&data, &RigHeader::default(), none.clone(), None, &none);
        assert_eq!(read.replicate_group, [0, 1, 2]);
        let hung = evidence(ROWS);
        assert_eq!(hung.replicate_group, [0, 1, 0]);
    }
}
