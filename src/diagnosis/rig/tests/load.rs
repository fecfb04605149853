//! Effects on the load, against a computation by hand.

use approx::assert_relative_eq;

use super::*;
use crate::inference::law::Form;
use crate::statistics::Random;
use crate::units::{DEG, UM};

#[test]
fn effects_on_the_load_have_the_sign_and_size_of_a_hand_computation() {
    let rod = rod("");
    let model = model(UP_AND_DOWN, &rod);
    let c = compliance(&rod);
    let y = c[(1, 1)];
    // along −y the offsets are negative: less load is a positive change
    assert_all(&one(&model, "friction", "slide", 1.0, Axis::Y), &[y, y, -y, -y]);
    assert_all(&one(&model, "friction", "slide", 7.0, Axis::Y), &[5.0 * y, 7.0 * y, -7.0 * y, -7.0 * y]);
    // 20 − 9 N are felt at the turn, and 5 N below there no more
    assert_all(&one(&model, "friction", "slide", 9.0, Axis::Y), &[5.0 * y, 9.0 * y, -6.0 * y, -9.0 * y]);
    // the top read once more before it is taken off: nothing has moved
    let again = UP_AND_DOWN.replace("-y,5,unload", "-y,20,unload,0,0,0\n-y,19,unload,0,0,0\n-y,5,unload");
    let read_again = RigModel::new(&readings(&again), Some(&rod)).unwrap().0;
    let held = one(&read_again, "friction", "slide", 1.0, Axis::Y);
    assert_all(&held, &[y, y, y, 0.0, -y, -y]);
    // a pulley that takes a tenth, a half, or four fifths of each load
    let pulley = |share| one(&model, "pulley_friction", "pulley", share, Axis::Y);
    assert_all(&pulley(0.1), &[0.5 * y, 2.0 * y, -0.5 * y, 0.0]);
    assert_all(&pulley(0.5), &[2.5 * y, 10.0 * y, -2.5 * y, 0.0]);
    // 4 N are felt at the turn, less than what remains of 5 N
    assert_all(&pulley(0.8), &[4.0 * y, 16.0 * y, y, 0.0]);
    assert_all(&one(&model, "load_offset", "hanger", 2.0, Axis::Y), &[-2.0 * y, -2.0 * y, -2.0 * y, 0.0]);
    let (sin, cos) = (2.0 * DEG).sin_cos();
    let turned = |load: f64| -load * sin * c[(2, 2)];
    let z = one(&model, "load_misalignment", "y towards z", 2.0 * DEG, Axis::Z);
    assert_all(&z, &[turned(5.0), turned(20.0), turned(5.0), 0.0]);
    let along = one(&model, "load_misalignment", "y towards z", 2.0 * DEG, Axis::Y);
    assert_relative_eq!(along[1], -20.0 * y * (cos - 1.0), max_relative = 1e-9);
}

/// Three runs up and down along y and z of the file's rod, which feels so much of each load, N.
fn up_and_down(seed: u64, felt: &dyn Fn(Axis, f64, bool) -> f64) -> Readings {
    let (c, mut random) = (compliance(&rod("")), Random::seeded(seed, 0));
    let mut text = "trial,axis,load_n,phase,dx_um,dy_um,dz_um\n".to_owned();
    for (trial, axis) in (1..=3).flat_map(|trial| [Axis::Y, Axis::Z].map(|axis| (trial, axis))) {
        for (k, load) in [3.0, 6.0, 9.0, 12.0, 15.0, 12.0, 9.0, 6.0, 3.0].into_iter().enumerate() {
            let phase = if k < 5 { "load" } else { "unload" };
            let bent = c.column(axis.index()) * felt(axis, load, k >= 5) / UM;
            let [x, y, z] = [0, 1, 2].map(|channel| bent[channel] + random.normal());
            text += &format!("{trial},{axis},{load},{phase},{x:.1},{y:.1},{z:.1}\n");
        }
    }
    readings(&text)
}

/// The findings of a recording, with the first number of the first.
fn found(recorded: &Readings) -> (Vec<(&'static str, String)>, [f64; 3]) {
    let found = diagnose(recorded, Some(&rod(""))).unwrap();
    let named = |own: &crate::inference::Finding| (own.effect.name, own.location.to_string());
    let number = found.diagnosis.findings.first().map(|own| &own.estimates[0]);
    let number = number.map_or([f64::NAN; 3], |own| [own.low, own.value, own.high]);
    (found.diagnosis.findings.iter().map(named).collect(), number)
}

/// Loads over a pulley lose a share of each, those that hang straight down none; a slide's friction
/// stays one.
#[test]
fn friction_of_a_pulley_is_a_share_of_each_load_and_that_of_a_slide_is_not() {
    let turned =
        |load: f64, share: f64, down: bool| if down { load * (1.0 + share) } else { load * (1.0 - share) };
    for seed in [1, 2] {
        let share = [0.02, 0.05][seed as usize % 2];
        let over_pulley = |axis, load: f64, down| {
            if axis == Axis::Y { turned(load, share, down).min(15.0 * (1.0 - share)) } else { load }
        };
        let (names, [low, value, high]) = found(&up_and_down(seed, &over_pulley));
        assert_eq!(names, [("pulley_friction", "pulley, loads along y".into())], "{seed}");
        assert!(low < share && share < high && (value - share).abs() < 0.003, "{seed}: {low} … {high}");
        let in_slide = |_, load: f64, down| if down { (load + 0.4).min(14.6) } else { load - 0.4 };
        let (names, [low, _, high]) = found(&up_and_down(seed, &in_slide));
        assert_eq!(names, [("friction", "slide".into())], "{seed}");
        assert!(low < 0.4 && 0.4 < high, "{seed}: {low} … {high}");
        assert_eq!(found(&up_and_down(seed, &|_, load, _| load)).0, [], "{seed}");
    }
}

/// Without a way down it would be the stiffness, and is not looked for.
#[test]
fn a_pulley_needs_loads_that_are_taken_off() {
    let model = model("axis,load_n,dy_um\ny,5,230\ny,10,460\n", &rod(""));
    assert!(model.candidates().iter().all(|own| own.effect.name != "pulley_friction"));
}

/// A load that pulls aside by the third power of its size: in runs through the same loads the time
/// comes round with the load.
#[test]
fn what_repeats_with_the_loads_follows_these_and_not_the_time() {
    let c = compliance(&rod(""));
    for seed in [1, 2] {
        for axes in [&[Axis::Z][..], &[Axis::Y, Axis::Z]] {
            let mut random = Random::seeded(seed, 0);
            let mut text = "trial,axis,load_n,time_s,dx_um,dy_um,dz_um\n".to_owned();
            let mut time = 0.0;
            for (trial, &axis) in (1..=4).flat_map(|trial| axes.iter().map(move |axis| (trial, axis))) {
                time += 300.0;
                for load in (1..=8).map(|k| 2.0 * f64::from(k)) {
                    time += 60.0 * random.uniform(0.8, 1.3);
                    let aside = 0.1 * load.powi(3) / 256.0 * c[(axis.index(), axis.index())] / UM;
                    let read = [0, 1, 2].map(|channel| {
                        let own = if channel == axis.index() { 0.0 } else { aside };
                        c[(channel, axis.index())] * load / UM + own + 2.0 * random.normal()
                    });
                    let [x, y, z] = read;
                    text += &format!("{trial},{axis},{load},{time:.0},{x:.1},{y:.1},{z:.1}\n");
                }
            }
            let found = diagnose(&readings(&text), Some(&rod(""))).unwrap();
            let curve = found.diagnosis.discrepancy.and_then(|left| left.location);
            let said = curve.map_or_else(String::new, |location| location.to_string());
            assert!(said.starts_with("load, all sensors under"), "{seed} {axes:?}: {said}");
        }
    }
}

/// A recording of three runs along each of these axes, of sensors that are off by `shape`, µm, in a
/// channel under a load, N along the axis.
fn off_by(seed: u64, axes: &[&str], loads: &[f64], shape: &dyn Fn(f64, Axis) -> f64) -> Readings {
    let (c, mut random) = (compliance(&rod("")), Random::seeded(seed, 0));
    let mut text = "trial,axis,load_n,time_s,dy_um,dz_um\n".to_owned();
    let mut time = 0.0;
    for (axis, trial) in axes.iter().flat_map(|axis| (1..=3).map(move |trial| (axis, trial))) {
        let along = if axis.ends_with('y') { Axis::Y } else { Axis::Z };
        let sign = if axis.starts_with('-') { -1.0 } else { 1.0 };
        let zeros = [0, 1].map(|_| random.normal());
        for load in loads {
            time += 60.0 * random.uniform(0.8, 1.3);
            let [y, z] = [Axis::Y, Axis::Z].map(|channel| {
                let rod = c[(channel.index(), along.index())] * sign * load / UM;
                rod + shape(sign * load, channel) + zeros[channel.index() - 1] + random.normal()
            });
            text += &format!("{trial},{axis},{load:.1},{time:.0},{y:.1},{z:.1}\n");
        }
    }
    readings(&text)
}

/// What every run repeats at the same loads is of these: no slips of all runs, no drift, no turned
/// sensor, and no wave over time or order, which come round with them.
#[test]
fn what_every_run_does_at_the_same_load_is_one_law_of_the_load() {
    // µm in a channel, at so many newtons
    type Shape = fn(f64, Axis) -> f64;
    const BOTH: &[&str] = &["y", "z"];
    const SIGNED: &[&str] = &["y", "-y", "z"];
    let cases: [(&[&str], Shape, Form); 6] = [
        (BOTH, |load, channel| if load > 6.0 && channel == Axis::Y { 8.0 } else { 0.0 }, Form::Step),
        (BOTH, |load, _| 8.0 * load.min(5.0) / 5.0, Form::Saturation),
        (BOTH, |load, _| 8.0 * (std::f64::consts::TAU * load / 2.0).sin(), Form::Harmonic),
        (BOTH, |load, channel| if load > 8.0 && channel == Axis::Z { -6.0 } else { 0.0 }, Form::Step),
        (SIGNED, |load, _| if load.abs() > 6.0 { 8.0 } else { 0.0 }, Form::Step),
        (BOTH, |load, channel| load * [0.0, 1.5, 0.6][channel.index()], Form::Polynomial(1)),
    ];
    let loads: Vec<f64> = (1..=30).map(|k| 0.4 * f64::from(k)).collect();
    for (seed, (axes, shape, form)) in (1..).zip(cases) {
        let found = diagnose(&off_by(seed, axes, &loads, &shape), Some(&rod(""))).unwrap();
        let names: Vec<&str> = found.diagnosis.findings.iter().map(|own| own.effect.name).collect();
        assert!(names.is_empty(), "{form:?}: {names:?}");
        // readings repeat to 1 µm, and their zeros too: what they repeat is no noise
        let noise = found.diagnosis.noise / UM;
        assert!((0.9..1.8).contains(&noise), "{form:?}: {noise}");
        let law = found.law.as_ref().and_then(|own| own.laws().next()).expect("a law");
        let said = (law.site.location.to_string(), law.site.variable.symbol, law.form.name());
        assert_eq!(said, ("sensors".to_owned(), "F", form.name()), "{seed}");
        let is_one_way = law.site.result.name.contains("whichever way");
        assert_eq!(is_one_way, axes.len() == SIGNED.len(), "{seed}");
    }
}

/// Three runs along y and z in even steps of time and load, up alone or down again, of sensors of
/// which each is moved by a share of the µm at so many newtons and seconds of a run.
fn evenly(shares: [f64; 3], seed: u64, is_down: bool, moved: &dyn Fn(f64, f64) -> f64) -> Readings {
    let (c, mut random) = (compliance(&rod("")), Random::seeded(seed, 0));
    let mut text = "trial,axis,load_n,phase,time_s,dx_um,dy_um,dz_um\n".to_owned();
    let mut time = 0.0;
    for (trial, axis) in (1..=3).flat_map(|trial| [Axis::Y, Axis::Z].map(|axis| (trial, axis))) {
        time += 60.0;
        let zeros = [0, 1, 2].map(|_| random.normal());
        for k in 1..=if is_down { 15 } else { 8 } {
            let (load, phase) = if k > 8 { (16 - k, "unload") } else { (k, "load") };
            let (load, since) = (1.5 * f64::from(load), 15.0 * f64::from(k));
            let [x, y, z] = [0, 1, 2].map(|channel| {
                let rod = c[(channel, axis.index())] * load / UM;
                rod + shares[channel] * moved(load, since) + zeros[channel] + random.normal()
            });
            let now = time + since;
            text += &format!("{trial},{axis},{load},{phase},{now},{x:.1},{y:.1},{z:.1}\n");
        }
        time += 15.0 * 15.0;
    }
    readings(&text)
}

/// A stand that gives way to the load and a drift are the same while loads rise as evenly as the
/// time passes, and are two as soon as they are taken off.
#[test]
fn a_drift_is_none_for_sure_while_loads_rise_as_evenly_as_the_time() {
    let stand = |load: f64, _| 1.6 * load;
    let drift = |_, since: f64| 0.16 * since;
    let named = |recorded: &Readings| {
        let found = diagnose(recorded, Some(&rod(""))).unwrap().diagnosis;
        let drift = found.findings.iter().find(|own| own.effect.name == "thermal_drift");
        drift.map(|own| (own.unnamed.as_ref().map(|rival| rival.location.to_string()), own.next.is_some()))
    };
    let all = [1.0, 0.6, -0.7];
    let in_proportion = Some("load, all sensors under all loads, in proportion".to_owned());
    assert_eq!(named(&evenly(all, 1, false, &stand)), Some((in_proportion.clone(), true)));
    assert_eq!(named(&evenly(all, 2, false, &drift)), Some((in_proportion.clone(), true)));
    // however clear it is that one sensor alone is moved
    assert_eq!(named(&evenly([0.0, 1.0, 0.0], 3, false, &stand)), Some((in_proportion, true)));
    assert_eq!(named(&evenly(all, 1, true, &stand)), None);
    assert!(matches!(named(&evenly(all, 2, true, &drift)), Some((None, _))));
}
