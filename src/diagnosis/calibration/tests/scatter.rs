//! By what poses scatter.

use super::*;
use nalgebra::Matrix3;

use crate::robot::Motion;
use crate::spatial::Axis;
use crate::units::DEG;

/// Poses of a tracker that stands 3 m away, whose angles differ from those that are recorded, and
/// whose ball is seen beside its place; noise of 20 µm along every axis.
pub(super) fn seen(
    angles: &dyn Fn(&mut [f64], &mut Random),
    place: &dyn Fn(&Vector3<f64>, &mut Random) -> Vector3<f64>,
    seed: u64,
) -> Campaign {
    let robot = Robot::from_text("tx90.toml", ROBOT, None, None).unwrap();
    let (tool, stands) = (Vector3::new(0.06, 0.01, 0.12), Vector3::new(2.6, -0.9, 1.2));
    let mut random = Random::seeded(seed, 0);
    let mut recording = Recording::new(6);
    for _ in 0..120 {
        let q: Vec<f64> = (0..6).map(|_| random.uniform(-1.7, 1.7)).collect();
        let tip = robot.flange_at(&q).point(&tool) - stands;
        let noise = Vector3::from_fn(|_, _| 20.0 * UM * random.normal());
        let mut written = q.clone();
        angles(&mut written, &mut random);
        let point = tip + noise + place(&tip, &mut random);
        recording.add(&written, point).unwrap();
    }
    let campaign = Campaign::new(robot, recording).unwrap().with_tool(tool);
    campaign.with_base((-stands).into(), [0.0; 3])
}

/// What is said of it; nothing else may be found.
fn sources(campaign: &Campaign) -> Option<ScatterSources> {
    let found = diagnose_as_recorded(campaign, Mode::None, &Options::default()).unwrap();
    assert!(!found.diagnosis.is_mismatch(), "{:?}", found.diagnosis.findings);
    found.model.scatter
}

/// The only source, by how much it scatters, and what every axis does.
fn only(campaign: &Campaign) -> (Source, f64, f64) {
    let found = sources(campaign).expect("no source");
    let [own] = found.sources[..] else { panic!("{found:?}") };
    (own.source, own.size, found.own)
}

pub(super) fn as_it_is(_: &mut [f64], _: &mut Random) {}

fn in_place(_: &Vector3<f64>, _: &mut Random) -> Vector3<f64> {
    Vector3::zeros()
}

#[test]
fn a_joint_that_scatters_is_no_wave_of_its_gear() {
    for (seed, joint, sd) in [(1, 1, 80e-6), (2, 2, 90e-6)] {
        let scatters = |q: &mut [f64], random: &mut Random| q[joint] += sd * random.normal();
        let (source, size, own) = only(&seen(&scatters, &in_place, seed));
        assert_eq!(source, Source::Angle(joint));
        assert!((size / sd - 1.0).abs() < 0.25 && (own / (20.0 * UM) - 1.0).abs() < 0.25, "{size} {own}");
    }
    let all = |q: &mut [f64], random: &mut Random| q.iter_mut().for_each(|q| *q += 60e-6 * random.normal());
    let (source, size, _) = only(&seen(&all, &in_place, 3));
    assert!(source == Source::Joints && (size / 60e-6 - 1.0).abs() < 0.2, "{source:?} {size}");
}

#[test]
fn what_is_rounded_scatters_by_its_steps() {
    let rounded = |step: f64| move |q: &mut f64| *q = (*q / step).round() * step;
    let all = |q: &mut [f64], _: &mut Random| q.iter_mut().for_each(rounded(0.01 * DEG));
    let (source, size, own) = only(&seen(&all, &in_place, 4));
    assert!(source == Source::Written && (size - 0.01 * DEG).abs() < 1e-9, "{source:?} {size}");
    assert!((own / (20.0 * UM) - 1.0).abs() < 0.3, "{own}");
    // one joint of six, in radians
    let one = |q: &mut [f64], _: &mut Random| rounded(1e-3)(&mut q[1]);
    let (source, size, _) = only(&seen(&one, &in_place, 5));
    assert!(source == Source::Written && (size - 1e-3).abs() < 1e-9, "{source:?} {size}");
}

#[test]
fn a_device_may_see_one_direction_worse() {
    let depth = |_: &Vector3<f64>, random: &mut Random| Vector3::z() * (90.0 * UM * random.normal());
    let (source, size, _) = only(&seen(&as_it_is, &depth, 6));
    assert!(source == Source::Device(Axis::Z) && (size / (90.0 * UM) - 1.0).abs() < 0.2, "{source:?} {size}");
    let range = |tip: &Vector3<f64>, random: &mut Random| tip.normalize() * (90.0 * UM * random.normal());
    let (source, size, _) = only(&seen(&as_it_is, &range, 7));
    assert!(source == Source::Distance && (size / (90.0 * UM) - 1.0).abs() < 0.2, "{source:?} {size}");
    let sight = |tip: &Vector3<f64>, random: &mut Random| {
        tip.cross(&Vector3::from_fn(|_, _| 30e-6 * random.normal()))
    };
    let (source, size, _) = only(&seen(&as_it_is, &sight, 8));
    assert!(source == Source::Direction && (size / 30e-6 - 1.0).abs() < 0.2, "{source:?} {size}");
}

/// No arm repeats its poses so badly, and no device sees one axis so much worse.
#[test]
fn what_is_too_much_for_scatter_is_none() {
    let scatter = |campaign: Campaign| {
        diagnose_as_recorded(&campaign, Mode::None, &Options::default()).unwrap().model.scatter
    };
    let joint = |q: &mut [f64], random: &mut Random| q[1] += 300e-6 * random.normal();
    assert_eq!(scatter(seen(&joint, &in_place, 1)), None);
    let depth = |_: &Vector3<f64>, random: &mut Random| Vector3::z() * (500.0 * UM * random.normal());
    assert_eq!(scatter(seen(&as_it_is, &depth, 6)), None);
}

#[test]
fn what_scatters_alike_along_every_axis_has_no_source() {
    for seed in 10..14 {
        assert_eq!(sources(&seen(&as_it_is, &in_place, seed)), None, "{seed}");
    }
}

/// A wave that follows an angle is an effect, although it moves the ball along one joint's way.
#[test]
fn what_follows_an_angle_is_no_scatter() {
    let wave = |q: &mut [f64], _: &mut Random| q[1] += 150e-6 * (9.0 * q[1]).sin();
    let found = seen(&wave, &in_place, 15);
    let found = diagnose_as_recorded(&found, Mode::None, &Options::default()).unwrap();
    let [finding] = &found.diagnosis.findings[..] else { panic!("{:?}", found.diagnosis.findings) };
    assert_eq!((finding.effect.name, finding.location.to_string()), ("transmission_error", "joint 2".into()));
    assert_eq!(found.model.scatter, None);
}

/// Nor is what follows two joints together, which no curve of the library describes to its end.
#[test]
fn what_predicts_held_out_poses_is_no_scatter() {
    let surface = |q: &mut [f64], _: &mut Random| q[1] += 1.5e-4 * (3.0 * q[1]).sin() * (4.0 * q[2]).sin();
    for seed in [17, 19, 21] {
        let campaign = seen(&surface, &in_place, seed);
        let found = diagnose_as_recorded(&campaign, Mode::None, &Options::default()).unwrap();
        assert!(found.diagnosis.is_mismatch() && found.model.scatter.is_none(), "{seed}");
    }
}

/// Whitened columns and residuals are those of displacements: what the model says of a row in {W}
/// is the same with and without.
#[test]
fn whitening_changes_no_displacement() {
    let campaign = seen(&|q, random| q[1] += 80e-6 * random.normal(), &in_place, 16);
    let found = diagnose_as_recorded(&campaign, Mode::None, &Options::default()).unwrap();
    let whitened = &found.model;
    assert!(whitened.scatter.is_some() && whitened.weight(0) != Matrix3::identity());
    let (plain, evidence) = modelled(&campaign, Mode::None);
    for (effect, location) in [
        ("encoder_scale", "joint 2"),
        ("joint_shift", "joint 1, after pose 59"),
        ("base_shift", "after pose 59"),
        ("tool_shift", "tool, after pose 59"),
        ("thermal_drift", "base, with order"),
    ] {
        let moved = |model: &CalibrationModel| {
            let index = find(model, effect, location);
            let mut term = model.candidates()[index].neutral(index);
            term.values[0] = 1e-4;
            model.by_row(&model.response(&[term]))
        };
        for (own, other) in moved(whitened).iter().zip(moved(&plain)) {
            assert!((own - other).norm() < 1e-9 * other.norm().max(1e-6), "{effect}: {own} {other}");
        }
    }
    for (own, other) in whitened.by_row(&found.evidence.residual).iter().zip(plain.by_row(&evidence.residual))
    {
        assert!((own - other).norm() < 1e-12, "{own} {other}");
    }
}

#[test]
fn a_step_is_seen_in_the_angles_of_joints_that_move() {
    let mut recording = Recording::new(3);
    for row in 0..9 {
        let k = f64::from(row);
        recording.add(&[0.05 * k * DEG, 10.0 * DEG, 0.1 * k], Vector3::zeros()).unwrap();
    }
    let motions = [Motion::Revolute, Motion::Revolute, Motion::Prismatic];
    let steps = model::written_angles::written_steps(&recording, &motions);
    assert!((steps[0] / (0.05 * DEG) - 1.0).abs() < 1e-9, "{steps:?}");
    // a joint that does not move is off by the same everywhere, and a prismatic one has no angle
    assert_eq!(steps[1..], [0.0, 0.0]);
}
