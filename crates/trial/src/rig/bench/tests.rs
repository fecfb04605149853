use super::*;
use crate::rig::drawing::tests::l_shape;
use crate::rig::protocol::Columns;
use rodcal_base::units::{DEG, UM};

/// Up and down twice along y, then −z, all channels read at the tip.
pub(in crate::rig) fn bench() -> Bench {
    let drawing = l_shape(0.0);
    let tip = drawing.length();
    let mut loadings = Vec::new();
    for (run, (axis, sign, trial)) in [(1, 1.0, 0), (1, 1.0, 1), (2, -1.0, 0)].into_iter().enumerate() {
        let zeroed = 1000.0 * run as f64;
        let loads = [(2.0, false), (4.0, false), (6.0, false), (4.0, true), (2.0, true), (0.0, true)];
        for (k, (load, is_unloading)) in loads.into_iter().enumerate() {
            let changed = zeroed + 60.0 * k as f64;
            let (time, stations) = (changed + 30.0, [tip; 2]);
            loadings.push(Loading {
                axis,
                sign,
                load,
                trial,
                run,
                is_unloading,
                changed,
                time,
                zeroed,
                stations,
            });
        }
    }
    let columns = Columns { trial: true, phase: true, time: true, temperature: true, kilograms: false };
    let channels = vec![[true; 3]; loadings.len()];
    let room = [20.0, 1e-3, 0.0, 3600.0];
    let sticking = vec![0.0; loadings.len()];
    let protocol = Protocol {
        loadings,
        channels,
        tip,
        room,
        quantum: 0.0,
        zeroed_once: false,
        is_shuffled: false,
        columns,
    };
    Bench { drawing, actual: Actual::default(), protocol, sticking, full_scale: 6.0 }
}

/// What an effect adds to a channel at the loadings of the first run: three up, two down, zero.
fn added(effect: Effect, channel: usize) -> Vec<f64> {
    let bench = bench();
    let (clean, with) = (bench.readings(&[]), bench.readings(&[effect]));
    (0..6).map(|k| with[3 * k + channel] - clean[3 * k + channel]).collect()
}

#[test]
fn friction_takes_on_the_way_up_and_holds_on_the_way_down() {
    let c = bench().compliance()[1];
    let change = added(Effect::Friction { axis: None, force: 0.5, presliding: 1.0 * UM, scatter: 0.0 }, 1);
    for (k, change) in change.iter().enumerate() {
        let expected = if k < 3 { -0.5 } else { 0.5 } * c;
        assert!((change / expected - 1.0).abs() < 0.01, "{k} {change} {expected}");
    }
}

#[test]
fn offsets_and_play_need_a_load() {
    let c = bench().compliance()[1];
    let offset = added(Effect::LoadOffset { axis: Some(1), force: -0.3 }, 1);
    let play = added(Effect::Backlash { axis: None, play: 7.0 * UM }, 1);
    assert!((offset[0] / (-0.3 * c) - 1.0).abs() < 0.01 && offset[5] == 0.0);
    assert!((play[2] / (7.0 * UM) - 1.0).abs() < 1e-9 && play[5] == 0.0);
    assert!(added(Effect::LoadOffset { axis: Some(2), force: 1.0 }, 1).iter().all(|change| *change == 0.0));
}

#[test]
fn softer_is_more() {
    for effect in [
        Effect::StiffnessScale(0.9),
        Effect::ShearModulus(0.9),
        Effect::Joint { name: None, station: 0.2, bending: 1e-5, torsion: 1e-5 },
        Effect::Root { bending: 1e-5, torsion: 0.0 },
        Effect::Creep { per_decade: 0.03, shortest: 1.0 },
        Effect::Cubic(1e-3),
        Effect::Quadratic(1e-3),
        Effect::SensorScale { channel: 1, factor: 1.05 },
        Effect::Seat(5.0 * UM),
        Effect::RunningIn { share: 0.1, loadings: 5.0 },
        Effect::Drift { channel: 1, rate: 1e-4, by_time: false },
        Effect::Slip { loading: 0, channel: 1, by: 3.0 * UM },
    ] {
        let change = added(effect.clone(), 1);
        assert!(change[..5].iter().all(|change| *change > 0.0), "{effect:?} {change:?}");
    }
    let gap = added(Effect::GapCloses { load: 3.0, share: 0.5 }, 1);
    assert!(gap[0] == 0.0 && gap[1] < 0.0 && gap[2] < gap[1]);
    assert!(added(Effect::LooseClamp(0.1), 1).iter().all(|change| *change == 0.0));
}

#[test]
fn friction_that_wears_holds_more_back_in_every_run() {
    let bench = bench();
    let c = bench.compliance()[1];
    let (clean, with) =
        (bench.readings(&[]), bench.readings(&[Effect::WearingFriction { first: 0.1, last: 0.3 }]));
    // the first load up and the last one down of the first two of three runs
    for (run, force) in [(0, 0.1), (6, 0.2)] {
        let change = |loading: usize| with[3 * loading + 1] - clean[3 * loading + 1];
        assert!((change(run) / (-force * c) - 1.0).abs() < 0.01, "{force}");
        assert!((change(run + 4) / (force * c) - 1.0).abs() < 0.01, "{force}");
    }
}

#[test]
fn a_rod_that_is_loaded_faster_gives_way_by_its_decade() {
    let change = added(Effect::SpeedOfLoading(0.1), 1);
    // 2 N in 60 s of 6 N at most: 5.56 times the speed that counts
    let share = 0.1 * (1.0 + 2.0 / 60.0 / 0.006f64).log10();
    let expected = share * 4.0 * bench().compliance()[1];
    assert!(change[0] == 0.0 && (change[1] / expected - 1.0).abs() < 0.02, "{change:?} {expected}");
}

#[test]
fn an_unloaded_rod_still_recovers_from_creep_and_hysteresis() {
    let creep = added(Effect::Creep { per_decade: 0.03, shortest: 1.0 }, 1);
    assert!(creep[5] > 0.0 && creep[5] < creep[2]);
    let loops = added(Effect::Hysteresis { fraction: 0.05, is_exercised: true }, 1);
    assert!(loops[4] > 0.0 && loops[0] < 0.0 && loops[2].abs() < 0.05 * loops[4], "{loops:?}");
}

#[test]
fn a_turned_load_and_a_turned_sensor_show_in_the_other_channel() {
    let bench = bench();
    let angle = 2.0 * DEG;
    let cross = bench.readings(&[Effect::LoadMisalignment { axis: 1, towards: 2, angle, frame: false }]);
    let c = bench.compliance()[2];
    assert!((cross[2] / (2.0 * angle.sin() * c) - 1.0).abs() < 0.02);
    let sensor = bench.readings(&[Effect::SensorMisalignment { channel: 2, towards: 1, angle }]);
    assert!((sensor[2] / (angle.sin() * sensor[1]) - 1.0).abs() < 0.02);
}

#[test]
fn a_slip_stays_to_the_end_of_its_run() {
    let (bench, by) = (bench(), 4.0 * UM);
    let clean = bench.readings(&[]);
    let with = bench.readings(&[Effect::Slip { loading: 8, channel: 1, by }]);
    for (k, (with, clean)) in with.iter().zip(&clean).enumerate() {
        let is_after = (8..12).contains(&(k / 3)) && k % 3 == 1;
        assert!((with - clean - if is_after { by } else { 0.0 }).abs() < 1e-15);
    }
}
