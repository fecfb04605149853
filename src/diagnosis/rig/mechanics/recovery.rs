//! What is left, in a run, of the loads of the runs before: a rod that crept recovers while the
//! next run's zero is taken and its loads are read.
//!
//! Every change ΔF of a load, in whatever run, creeps on by itself (Boltzmann's superposition;
//! W. N. Findley, J. S. Lai, K. Onaran, *Creep and Relaxation of Nonlinear Viscoelastic Materials*,
//! 1976, ch. 5). Off the zero of its own run, taken at the time z, a reading at t shows of other
//! runs
//!
//! ```text
//! D = Σ c·ΔF·[g(t − s) − g(z − s)],   g(t) = log₁₀(1 + t/t₀)      s ≤ z the time of the change
//! ```
//!
//! for a growth of 1 per decade, c (m/N) what the channel shows per newton of such a load.

use std::collections::{BTreeMap, HashMap};

use super::load_history::{Changed, dwell, moments, runs, shortest};
use crate::diagnosis::rig::numbering::numbered;
use crate::diagnosis::rig::recording::datum::Datum;
use crate::spatial::Axis;

/// Of more instants than that nothing is added up, since every one meets all changes before.
const MOST_INSTANTS: usize = 1000;

/// A load that ΔF (N, along the positive axis) was added to.
struct Change {
    time: f64,
    force: f64,
    /// Number of its axis and station.
    place: usize,
    session: usize,
}

/// D of each datum, m; nothing where the times of the runs are not those of one clock, where
/// nothing was loaded before, or of imposed displacements. `stiffness`: how many times as stiff as
/// its file the rod is at first sight.
pub fn recovery(data: &[Datum], when: Changed, t0: f64, stiffness: f64) -> Option<Vec<f64>> {
    let times: Vec<f64> = data.iter().map(|d| d.time).collect::<Option<_>>()?;
    if data.iter().any(|d| d.imposed.is_some()) {
        return None;
    }
    let (dwell, shortest, runs) = (dwell(data, &times), shortest(data, &times), runs(data));
    let places = numbered(data.iter().map(|d| (d.direction.axis, d.load_station.map(f64::to_bits))));
    let shown = Shown::of(data, &places, stiffness);
    let grown = |now: f64, since: f64| (1.0 + (now - since).max(0.0) / t0).log10();
    let mut changes: Vec<Change> = Vec::new();
    let (mut left, mut instants) = (vec![0.0; data.len()], 0);
    let mut end = f64::NEG_INFINITY;
    for run in &runs {
        let (session, place) = (data[run[0]].session_number, places[run[0]]);
        let own = moments(data, run, &times);
        let hung = own.iter().find(|moment| moment.load != 0.0).map(|first| first.hung);
        let zero = hung.filter(|hung| !hung.is_nan()).unwrap_or(times[run[0]] - dwell);
        // a clock that starts anew says nothing of what was before
        if changes.last().is_some_and(|last| last.session == session) && zero < end - dwell {
            return None;
        }
        instants += own.len();
        if instants > MOST_INSTANTS {
            return None;
        }
        let before: Vec<&Change> = changes.iter().filter(|change| change.session == session).collect();
        for moment in &own {
            // in the order of the places: a sum must not depend on that of a hash
            let mut felt: BTreeMap<usize, f64> = BTreeMap::new();
            for change in &before {
                let since = grown(moment.time, change.time) - grown(zero, change.time);
                *felt.entry(change.place).or_default() += change.force * since;
            }
            for &i in &moment.data {
                left[i] = felt.iter().map(|(place, force)| shown.per_newton(&data[i], *place) * force).sum();
            }
        }
        let (mut load, mut changed) = (0.0, zero);
        for moment in &own {
            let since =
                if moment.hung.is_nan() { when.between(changed, moment.time, shortest) } else { moment.hung };
            changes.push(Change { time: since, force: moment.load - load, place, session });
            (load, changed) = (moment.load, moment.time);
        }
        changes.push(Change { time: changed, force: -load, place, session });
        end = changed;
    }
    left.iter().any(|left| *left != 0.0).then_some(left)
}

/// What each channel shows per newton, by the rod.
struct Shown(HashMap<(usize, Axis, Option<u64>), f64>);

impl Shown {
    fn of(data: &[Datum], places: &[usize], stiffness: f64) -> Shown {
        let mut known = HashMap::new();
        for (datum, &place) in data.iter().zip(places).filter(|(datum, _)| datum.signed_load() != 0.0) {
            let key = (place, datum.channel, datum.read_station.map(f64::to_bits));
            known.entry(key).or_insert(datum.predicted / datum.signed_load() / stiffness);
        }
        Shown(known)
    }

    /// m/N, of a load at a place; 0 where nothing was read there under such a load.
    fn per_newton(&self, datum: &Datum, place: usize) -> f64 {
        let key = (place, datum.channel, datum.read_station.map(f64::to_bits));
        self.0.get(&key).copied().unwrap_or(0.0)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::diagnosis::rig::recording::datum;
    use crate::rig::readings::Readings;

    /// 1 µm/N along the load, 0.1 across.
    fn data(text: &str) -> Vec<Datum> {
        let mut data = datum::all(&Readings::from_text("f", text).unwrap().rows);
        for datum in &mut data {
            let per_newton = if datum.channel == datum.direction.axis { 1e-6 } else { 1e-7 };
            datum.predicted = per_newton * datum.signed_load();
        }
        data
    }

    /// A run along y, one along z, and another along y.
    const TEXT: &str = "axis,load_n,trial,time_s,dy_um,dz_um
y,10,1,100,0,0
y,20,1,200,0,0
z,10,1,1000,0,0
z,20,1,1100,0,0
y,10,2,2000,0,0
";

    #[test]
    fn what_hung_before_goes_on_recovering_from_its_zero_on() {
        let data = data(TEXT);
        let left = recovery(&data, Changed::Early, 10.0, 1.0).unwrap();
        // the first run has nothing before it
        assert!(left[..4].iter().all(|left| *left == 0.0));
        // the second: 10 N from the start, 10 N more from 100 s, all taken off at 200 s; dz of the
        // y loads is a tenth of dy
        let grown = |t: f64| (1.0 + t / 10.0).log10();
        let crept = |t: f64| 10.0 * grown(t) + 10.0 * grown(t - 100.0) - 20.0 * grown(t - 200.0);
        for (i, t) in [(4, 1000.0), (6, 1100.0)] {
            let expected = (crept(t) - crept(900.0)) * 1e-6;
            assert!((left[i] - expected).abs() < 1e-15, "{} {expected}", left[i]);
            assert!((left[i + 1] - 0.1 * expected).abs() < 1e-15);
        }
        // and the third recovers from both
        assert!(left[8] != 0.0 && left[9].abs() > 0.0);
        // a rod twice as soft as its file by what was read recovers by twice as much
        let soft = recovery(&data, Changed::Early, 10.0, 0.5).unwrap();
        assert!((soft[4] - 2.0 * left[4]).abs() < 1e-18);
    }

    #[test]
    fn clocks_that_start_anew_say_nothing_of_the_runs_before() {
        assert!(recovery(&data(&TEXT.replace(",1000,", ",5,")), Changed::Early, 10.0, 1.0).is_none());
        assert!(
            recovery(&data("axis,load_n,time_s,dy_um\ny,1,1,0\ny,2,2,0\n"), Changed::Early, 10.0, 1.0)
                .is_none()
        );
        assert!(recovery(&data("axis,load_n,dy_um\ny,1,0\ny,2,0\n"), Changed::Early, 10.0, 1.0).is_none());
    }
}
