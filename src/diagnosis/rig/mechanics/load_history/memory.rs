//! What a history of loads comes to for each datum, and the runs and instants that it is read from.

use crate::diagnosis::rig::recording::datum::Datum;

/// How the history of loads acts on each datum.
#[derive(Debug, Clone, PartialEq)]
pub struct Memory {
    /// w: the displacement is multiplied by 1 + v·w.
    pub relative: Vec<f64>,
    /// W, N: the load v·W is felt besides the one that acts.
    pub lingering: Vec<f64>,
    /// D, m: readings show v·D/(1 + v·w̄) besides, of loads of other runs; nothing where none
    /// counts. D is of a rod as soft as it was read, which is 1 + v·w̄ times as soft as at once.
    pub recovery: Vec<f64>,
    /// w̄: w of the usual reading.
    pub usual: f64,
}

impl Memory {
    /// v/(1 + v·w̄), by which the recovery is multiplied.
    pub fn recovered(&self, value: f64) -> f64 {
        value / (1.0 + value * self.usual)
    }

    /// Its derivative.
    pub fn recovered_derivative(&self, value: f64) -> f64 {
        (1.0 + value * self.usual).powi(-2)
    }
}

/// An instant of a run: its load along the positive axis (N), its time and when that load was hung
/// (s).
pub struct Moment {
    pub load: f64,
    pub time: f64,
    /// NaN where the file does not say.
    pub hung: f64,
    pub data: Vec<usize>,
}

pub fn moments(data: &[Datum], run: &[usize], times: &[f64]) -> Vec<Moment> {
    let of_instant = |instant: Vec<usize>| {
        // of an imposed displacement the one that is largest counts, as the load that it would need
        let load = |i: &usize| data[*i].imposed.map_or(data[*i].signed_load(), |u| u.set / u.per_newton);
        let is_imposed = |i: &&usize| data[**i].imposed.is_some();
        let imposed = instant.iter().filter(is_imposed).map(load).max_by(|a, b| a.abs().total_cmp(&b.abs()));
        let (first, time) = (instant[0], times[instant[0]]);
        let hung = data[first].loaded_at.unwrap_or(f64::NAN);
        Moment { load: imposed.unwrap_or_else(|| load(&first)), time, hung, data: instant }
    };
    instants(data, run).into_iter().map(of_instant).collect()
}

/// Nothing is remembered.
pub(super) fn none(data: &[Datum]) -> Memory {
    let zeros = || vec![0.0; data.len()];
    Memory { relative: zeros(), lingering: zeros(), recovery: Vec::new(), usual: 0.0 }
}

/// Indices of the data of each run, in the order of recording.
pub fn runs(data: &[Datum]) -> Vec<Vec<usize>> {
    let count = data.iter().map(|d| d.run + 1).max().unwrap_or_default();
    let mut runs = vec![Vec::new(); count];
    for (index, datum) in data.iter().enumerate() {
        runs[datum.run].push(index);
    }
    runs.retain(|run| !run.is_empty());
    runs
}

/// Data of a run by instant.
pub fn instants(data: &[Datum], run: &[usize]) -> Vec<Vec<usize>> {
    run.chunk_by(|&a, &b| data[a].order == data[b].order).map(<[usize]>::to_vec).collect()
}

/// Usual time between two readings of a run, s: the median; 0 where no run has two times.
pub fn dwell(data: &[Datum], times: &[f64]) -> f64 {
    let steps = steps(data, times);
    steps.get(steps.len() / 2).copied().unwrap_or_default()
}

/// Shortest time between two readings of a run, s; 0 where no run has two times.
pub fn shortest(data: &[Datum], times: &[f64]) -> f64 {
    steps(data, times).first().copied().unwrap_or_default()
}

/// Times between two readings of a run, s, in ascending order.
fn steps(data: &[Datum], times: &[f64]) -> Vec<f64> {
    let steps = runs(data)
        .into_iter()
        .flat_map(|run| run.windows(2).map(|pair| times[pair[1]] - times[pair[0]]).collect::<Vec<_>>());
    let mut steps: Vec<f64> = steps.filter(|step| *step > 0.0).collect();
    steps.sort_by(f64::total_cmp);
    steps
}
