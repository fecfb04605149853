//! Readings that are asked for and not given: what would have been read had the rod been loaded or
//! read elsewhere.
//!
//! Another protocol in the place of the recorded one: every recorded axis with the load, or else
//! the sensors, at a station where they never were; then an axis along which nothing was pulled,
//! or, of three, one of them the other way. Which it is depends on the protocol alone, so that the
//! question says nothing of the effect.

use super::bench::Bench;
use super::drawing::rounded;
use super::effect::Effect;
use super::oracle::Oracle;
use super::protocol::{Columns, Protocol, Run, steps};
use crate::chance::happens;
use crate::ground_truth::PredictionQuery;
use rodcal_base::statistics::Random;
use rodcal_base::units::{MM, STANDARD_GRAVITY, UM};

/// Loads, of the largest that was recorded.
const SHARES: [f64; 3] = [0.4, 0.7, 1.0];
/// Deflection over the rod's length up to which a rod along an axis that nobody tried is loaded.
const DEFLECTION: f64 = 2.5e-3;
/// Where a load hangs or a sensor stands, of the rod's length.
const STATION: (f64, f64) = (0.35, 0.85);
/// Times from a load to its reading and from a run to the next, s.
const TIMES: (f64, f64) = (60.0, 600.0);
const ABOVE: &str = "# SIMULATED protocol of readings that are asked for: what would have been read, without noise, had this been done \
                     in the place of the recording? A 0 stands for each.";

/// The bench with the protocol that is asked for.
pub fn draw(bench: &Bench, random: &mut Random) -> Bench {
    let recorded = &bench.protocol;
    let tip = recorded.tip;
    let axes = recorded.axes();
    let elsewhere = rounded(random.uniform(STATION.0, STATION.1) * tip / MM, 0) * MM;
    let stations = if happens(random, 0.5) { [elsewhere, tip] } else { [tip, elsewhere] };
    let new: Vec<usize> = (0..3).filter(|axis| !axes.contains(axis)).collect();
    let last = match new.get(random.index(new.len())) {
        Some(&axis) => (axis, if happens(random, 0.5) { 1.0 } else { -1.0 }),
        None => axes.get(random.index(axes.len())).map_or((1, 1.0), |&axis| (axis, -sign(recorded, axis))),
    };
    let has_unloading = recorded.loadings.iter().any(|l| l.is_unloading);
    let compliance = bench.compliance();
    let mut protocol = Protocol {
        loadings: Vec::new(),
        channels: Vec::new(),
        quantum: 0.0,
        zeroed_once: false,
        is_shuffled: false,
        // a trial for each run, so that every run has a zero of its own
        columns: Columns { trial: true, phase: recorded.columns.phase || has_unloading, ..recorded.columns },
        ..recorded.clone()
    };
    let first = axes.iter().map(|&axis| (axis, sign(recorded, axis), stations));
    let mut time = 0.0;
    for (run, (axis, sign, stations)) in first.chain([(last.0, last.1, [tip; 2])]).enumerate() {
        let most = bench.full_scale.min(DEFLECTION * tip / compliance[axis]);
        let loads = SHARES.map(|share| load(share * most, recorded.columns.kilograms));
        let run = Run { axis, sign, trial: run, run, zeroed: time, stations };
        for step in steps(&loads, has_unloading) {
            let changed = time;
            time += TIMES.0;
            protocol.loadings.push(run.loading(step, changed, time));
            protocol.channels.push([0, 1, 2].map(|k| k == axis || recorded.read_channels().contains(&k)));
        }
        time += TIMES.1;
    }
    // how a slide happens to stick nobody can foresee
    let sticking = vec![0.0; protocol.loadings.len()];
    Bench { protocol, sticking, ..bench.clone() }
}

/// The file that asks.
pub fn csv(asked: &Bench) -> String {
    asked.protocol.table(ABOVE, &vec![0.0; asked.protocol.cells().len()])
}

/// What would be read, and what the oracle says: `oracle` knows the effects and where they are, and
/// finds their sizes out from `shown`.
pub fn truth(asked: &Bench, effects: &[Effect], oracle: &Oracle, shown: &[f64]) -> PredictionQuery {
    let happen_again: Vec<Effect> =
        effects.iter().filter(|effect| !effect.is_of_one_run()).cloned().collect();
    // as far as anybody reads them, m → µm
    let um = |readings: Vec<f64>| -> Vec<f64> { readings.into_iter().map(|m| rounded(m / UM, 5)).collect() };
    let is_known = !effects.is_empty()
        && happen_again.len() == effects.len()
        && effects.iter().all(|effect| !effect.sizes(asked).is_empty());
    PredictionQuery {
        true_um: um(asked.readings(&happen_again)),
        oracle_um: is_known.then(|| oracle.predicted(effects, shown, asked)).flatten().map(um),
        is_any_frame: false,
    }
}

/// The way in which the axis was loaded first.
fn sign(protocol: &Protocol, axis: usize) -> f64 {
    protocol.loadings.iter().find(|l| l.axis == axis).map_or(1.0, |l| l.sign)
}

/// A load as somebody would choose it, N.
fn load(force: f64, kilograms: bool) -> f64 {
    let (unit, decimals) = if kilograms { (STANDARD_GRAVITY, 3) } else { (1.0, 2) };
    rounded(force / unit, decimals).max(10f64.powi(-decimals)) * unit
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::rig::bench::tests::bench;
    use crate::rig::noise::Noise;
    use crate::rig::protocol::Loading;

    #[test]
    fn what_is_asked_was_not_recorded() {
        let bench = bench();
        let asked = draw(&bench, &mut Random::seeded(1, 0));
        let tip = asked.protocol.tip;
        let (moved, last): (Vec<&Loading>, Vec<&Loading>) =
            asked.protocol.loadings.iter().partition(|l| l.stations != [tip; 2]);
        assert_eq!((moved.len(), last.len()), (10, 5));
        assert!(last.iter().all(|l| l.axis == 0) && moved.iter().all(|l| l.axis != 0));
        assert!(csv(&asked).starts_with("# SIMULATED"));
        assert_eq!(asked.protocol.largest_load(), 6.0);
    }

    #[test]
    fn the_oracle_is_as_good_as_the_noise_lets_it_be() {
        let bench = bench();
        let noise = Noise::normal(1e-6);
        let oracle = Oracle::new(&bench, &noise);
        let effects = [Effect::Friction { axis: None, force: 0.5, presliding: 1e-6, scatter: 0.0 }];
        let asked = draw(&bench, &mut Random::seeded(1, 0));
        let exact = bench.readings(&effects);
        let rms = |shown: &[f64]| {
            let truth = truth(&asked, &effects, &oracle, shown);
            let oracle = truth.oracle_um.unwrap();
            let squares = truth.true_um.iter().zip(&oracle).map(|(a, b)| (a - b).powi(2));
            (squares.sum::<f64>() / oracle.len() as f64).sqrt()
        };
        let shown = noise.shown(&bench, &exact, &mut Random::seeded(2, 0));
        let (silent, noisy) = (rms(&exact), rms(&shown));
        assert!(silent < 0.05 && silent < noisy && noisy < 1.0, "{silent} {noisy}");
        let outlier = [Effect::Outlier(vec![(0, 1e-4)])];
        assert_eq!(truth(&asked, &outlier, &oracle, &exact).oracle_um, None);
        assert_eq!(truth(&asked, &outlier, &oracle, &exact), truth(&asked, &[], &oracle, &exact));
    }
}
