//! What a recording cannot tell is said, held where the drawing has it, and harms nothing else.

use nalgebra::{Isometry3, Vector3};
use rodcal::calibration::{Calibration, Campaign, Mode, Options, Warning, calibrate, plausible_range};
use rodcal::robot::Parameter;

use super::arms::{self, UR5};
use super::lab::{Dice, Lab, PHYSICS, millimetres, read};
use super::rank::{NOTHING, jacobian};
use super::recovery::{Clamped, spoil};

const NOISE: f64 = 20e-6;

/// A UR5 before a tracker.
struct Tracked {
    lab: Lab,
    dice: Dice,
    still: Option<usize>,
}

impl Tracked {
    fn new() -> Tracked {
        let mut dice = Dice(61);
        let mut lab = Lab::new(arms::robot(UR5), Isometry3::identity(), Vector3::new(0.08, 0.03, 0.15));
        let links = Parameter::all(6).into_iter();
        let links: Vec<Parameter> =
            links.filter(|p| matches!(p, Parameter::A(_) | Parameter::Theta(1..5))).collect();
        spoil(&mut lab, &links, &mut dice);
        Tracked { lab, dice, still: None }
    }

    fn rows(&mut self, poses: std::ops::Range<usize>) -> String {
        let mut csv = String::new();
        for pose in poses {
            let mut q = self.lab.anywhere(&mut self.dice);
            if let Some(joint) = self.still {
                q[joint] = 0.7;
            }
            csv += &self.row(pose, &q);
        }
        csv
    }

    fn row(&mut self, pose: usize, q: &[f64]) -> String {
        let noise = Vector3::from_fn(|_, _| NOISE * self.dice.normal());
        format!("{pose}{},{}\n", self.lab.cells(q), millimetres(&(self.lab.rigid_tip(q) + noise)))
    }

    fn campaign(&self, rows: &str, sections: &str) -> Campaign {
        let csv = format!("pose{},x_mm,y_mm,z_mm\n{rows}", self.lab.header());
        let text = format!(
            "robot = \"ur5.toml\"\nmeasurements = \"m.csv\"\n[tool]\nxyz_mm = [80, 30, 150]\n{sections}"
        );
        read(&[("campaign.toml", &text), ("ur5.toml", UR5), ("m.csv", &csv)])
    }
}

fn calibrated(campaign: &Campaign) -> Calibration<'_> {
    let found =
        calibrate(campaign, Mode::None, &Options::default()).unwrap_or_else(|error| panic!("{error}"));
    assert!(found.is_converged, "{} {:?}", found.fit.reason, found.passes);
    found
}

/// Parameters that the calibration says it does not know.
fn unknown(found: &Calibration) -> Vec<String> {
    found.parameters.iter().filter(|p| !p.identifiable).map(|p| p.parameter.to_string()).collect()
}

fn takes_part(found: &Calibration, name: &str) -> bool {
    let index = found.parameters.iter().position(|p| p.parameter.to_string() == name).unwrap();
    found.held.iter().any(|held| held.direction[index].abs() > 0.1)
}

/// Joint 5 stands still: what comes after it is one rigid piece with what comes before.
#[test]
fn a_joint_that_never_moves_hides_its_neighbours() {
    let mut made = Tracked::new();
    let rows = made.rows(0..60);
    let campaign = made.campaign(&rows, "");
    let moving = calibrated(&campaign);
    assert_eq!(unknown(&moving), Vec::<String>::new());
    assert!(moving.held.is_empty());
    made.still = Some(4);
    let rows = made.rows(0..60);
    let campaign = made.campaign(&rows, "");
    let still = calibrated(&campaign);
    // what moves no tip, by differences of the laboratory's own: four directions, for a joint that
    // stands still makes one link of two
    let parameters: Vec<Parameter> = still.parameters.iter().map(|p| p.parameter).collect();
    let poses: Vec<Vec<f64>> = (0..60).map(|row| campaign.measurements.joints(row).to_vec()).collect();
    let ranges = parameters.iter().map(|&p| plausible_range(p, &[]));
    let mut jacobian = jacobian(&made.lab, &parameters, &poses);
    jacobian.column_iter_mut().zip(ranges).for_each(|(mut column, range)| column.scale_mut(range));
    let svd = jacobian.svd(false, true);
    let v_t = svd.v_t.unwrap();
    let null: Vec<usize> = (0..parameters.len())
        .filter(|&k| svd.singular_values[k] < NOTHING * svd.singular_values.max())
        .collect();
    assert_eq!(null.len(), 4);
    assert_eq!(still.held.len(), 4);
    let share = |k: usize| null.iter().map(|&row| v_t[(row, k)].powi(2)).sum::<f64>().sqrt();
    for (k, p) in still.parameters.iter().enumerate() {
        assert_eq!(p.identifiable, share(k) < 0.1, "{}: {}", p.parameter, share(k));
    }
    assert!(unknown(&still).contains(&"theta6".to_owned()) && takes_part(&still, "theta6"));
    for held in &still.held {
        assert!(held.relative_error > 1.0);
        let share: f64 = held.direction.iter().map(|v| v * v).sum();
        assert!((share - 1.0).abs() < 1e-9);
        // where the drawing has it
        let numbers = still.parameters.iter().zip(&held.direction).zip(&held.ranges);
        let offset: f64 = numbers.map(|((p, v), range)| v * (p.value - p.nominal) / range).sum();
        assert!(offset.abs() < 1e-6, "{offset}");
    }
    for (p, reference) in still.parameters.iter().zip(&moving.parameters) {
        let name = p.parameter.to_string();
        assert_eq!(p.identifiable, p.std_error.is_some(), "{name}");
        // nothing explodes: what robots as built are off, and the range that they may be off
        let (off, range) = ((reference.value - reference.nominal).abs(), plausible_range(p.parameter, &[]));
        assert!((p.value - p.nominal).abs() < off + range, "{name}: {} {}", p.value, p.nominal);
        // what is known is known well, for all that a joint less moves
        if let (Some(now), Some(before)) = (p.std_error, reference.std_error) {
            assert!(now < 10.0 * before, "{name}: {now} after {before}");
        }
    }
    // it is said, and which
    let said = |warning: &Warning| match warning {
        Warning::NotIdentified { combination, .. } => {
            combination.iter().any(|(p, _)| p.to_string() == "theta6")
        }
        // several combinations are summed up in one warning
        Warning::ManyNotIdentified { parameters, .. } => parameters.iter().any(|p| p.to_string() == "theta6"),
        _ => false,
    };
    assert!(still.warnings.iter().any(said), "{:?}", still.warnings);
    let residual = still.noise.pooled / NOISE;
    assert!((0.8..1.2).contains(&residual), "{residual}");
}

/// Sixty recordings of one pose are one.
#[test]
fn poses_all_alike_identify_three_numbers() {
    let mut made = Tracked::new();
    let q = made.lab.anywhere(&mut made.dice);
    let rows: String = (0..60).map(|pose| made.row(pose, &q)).collect();
    let campaign = made.campaign(&rows, "");
    let found = calibrated(&campaign);
    let count = found.parameters.len();
    assert_eq!(found.held.len(), count - 3, "{:?}", unknown(&found));
    for p in &found.parameters {
        assert!((p.value - p.nominal).abs() < 2.0, "{}: {}", p.parameter, p.value);
        assert!(p.value.is_finite());
    }
}

#[test]
fn too_few_poses_are_refused_with_the_number_it_takes() {
    let mut made = Tracked::new();
    let rows = made.rows(0..9);
    let campaign = made.campaign(&rows, "");
    let error = calibrate(&campaign, Mode::None, &Options::default()).unwrap_err();
    let words = error.to_string();
    // 27 numbers are nine poses, and one more for the noise
    assert!(words.contains("9 poses") && words.contains("27 unknown"), "{words}");
    assert!(words.contains("at least 10"), "{words}");
    let rows = made.rows(0..10);
    let campaign = made.campaign(&rows, "");
    assert!(calibrate(&campaign, Mode::None, &Options::default()).is_ok());
}

/// All balls at one point of one clamp: nothing measures a distance.
#[test]
fn one_point_hides_where_the_robot_stands_and_how_large_it_is() {
    let mut made = Clamped::new(PHYSICS);
    made.noise = NOISE;
    // all balls at the same place, so that nothing but orientation varies
    let mut dice = Dice(71);
    let target = Vector3::new(0.1, 0.05, 0.3);
    let mut poses = Vec::new();
    made.devices = vec![Isometry3::new(target, Vector3::zeros())];
    while poses.len() < 60 {
        let start = made.lab.anywhere(&mut dice);
        poses.extend(made.lab.reach(&target, &start).map(|q| (0, q)));
    }
    made.poses = poses;
    let campaign = made.campaign();
    let found = calibrate(&campaign, Mode::Calc, &Options::default()).unwrap();
    assert!(found.is_converged, "{} {:?}", found.fit.reason, found.passes);
    // round the ball the robot may stand anyhow, and how large it is only the rod's weight shows: 3
    // and 1
    assert_eq!(found.held.len(), 4, "{:?}", unknown(&found));
    let hidden =
        ["base_x", "base_y", "base_z", "base_rx", "base_ry", "base_rz", "a2", "d4", "tool_x", "tool_z"];
    assert_eq!(unknown(&found), hidden);
    let mut truth = found.setup.clone();
    truth.links = made.lab.robot.joints.iter().map(|joint| joint.link).collect();
    truth.compliance = made.lab.robot.joints.iter().map(|joint| joint.compliance).collect();
    for p in found.parameters.iter().filter(|p| p.identifiable) {
        let (off, error) = (p.value - truth.get(p.parameter), p.std_error.unwrap());
        assert!(off.abs() < 5.0 * error, "{}: {off} ± {error}", p.parameter);
    }
}

/// d₂ and d₃ lie along parallel axes: only their sum is real.
#[test]
fn a_redundant_parameter_that_is_freed_is_not_identified() {
    let mut made = Tracked::new();
    let rows = made.rows(0..60);
    let campaign = made.campaign(&rows, "[parameters]\nfree = [\"d3_mm\"]\n");
    let found = calibrated(&campaign);
    assert_eq!(found.held.len(), 1);
    let unknown = unknown(&found);
    assert!(unknown.contains(&"d2".to_owned()) && unknown.contains(&"d3".to_owned()), "{unknown:?}");
    let index = |name: &str| found.parameters.iter().position(|p| p.parameter.to_string() == name).unwrap();
    let direction = &found.held[0].direction;
    // one takes what the other gives
    assert!((direction[index("d2")] + direction[index("d3")]).abs() < 1e-3, "{direction:?}");
    assert!(direction[index("d2")] * direction[index("d3")] < 0.0);
    assert!(found.held[0].relative_error > 1e3);
}
