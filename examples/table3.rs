//! The paper's Table 3 by simulation: six rods, every mode of compensation, validation errors
//! beside the published ones.
//!
//! `cargo run --release --example regenerate -- table3` prints the tables of `docs/simulation.md`;
//! a number after `--` changes how many seeds are taken for each rod.
//!
//! Published (Improved MultiCal, *Sensors* 23 (2023) 5717, Tables 1 to 3, § 5): the robot's model,
//! r_rod, noise of sensors (3 µm), robot (30 µm) and scanner (43 µm), contact force, five clamps,
//! 30 poses, 100 validation poses, and the figures of Table 3. Ours: the rods' sections (`rods/`),
//! the places of the clamps, the robot's own errors. Nothing is fitted to Table 3.

#![allow(clippy::unwrap_used, clippy::print_stdout)]

use std::cell::Cell;
use std::path::Path;

use nalgebra::{DMatrix, DVector, Matrix3, Vector3};
use rodcal::beam::Physics;
use rodcal::calibration::campaign::{Recording, Refit, Targets};
use rodcal::calibration::simulate::{Plan, Simulation, campaign_files, simulate};
use rodcal::calibration::{Campaign, Mode, Options, Summary, calibrate, modes, validate};
use rodcal::compliance::{Compliance, DEFAULT_ELEMENTS, PAPER_CONTACT_FORCE, paper_contact_force};
use rodcal::parallel::in_parallel;
use rodcal::robot::{Body, Kinematics, Loads, Parameter, Robot, Setup, minimal_parameters};
use rodcal::rod::Rod;
use rodcal::statistics::{Random, mean, standard_deviation};
use rodcal::units::{MM, STANDARD_GRAVITY, UM};

/// A rod of Table 2 with its rows of Table 3.
struct Published {
    oi: f64,
    c_rod: f64,
    r_rod: f64,
    /// Mean and maximum in mm: None, Calc, FEA, Meas.
    errors: [Option<(f64, f64)>; 4],
}

const fn published(
    [oi, c_rod, r_rod]: [f64; 3],
    none: (f64, f64),
    calc: Option<(f64, f64)>,
    fea: (f64, f64),
    meas: (f64, f64),
) -> Published {
    Published { oi, c_rod, r_rod, errors: [Some(none), calc, Some(fea), Some(meas)] }
}

const PUBLISHED: [Published; 6] = [
    published([1.832, 57.9, 1.226], (0.302, 0.893), None, (0.276, 0.808), (0.274, 0.838)),
    published([1.721, 63.1, 1.364], (0.312, 0.866), None, (0.290, 0.841), (0.286, 0.845)),
    published([1.943, 237.3, 2.302], (0.414, 1.038), None, (0.364, 0.904), (0.362, 0.901)),
    published([1.832, 513.4, 1.051], (0.475, 1.346), Some((0.467, 1.344)), (0.450, 1.298), (0.451, 1.296)),
    published([1.721, 403.7, 1.013], (0.392, 0.923), Some((0.404, 0.996)), (0.372, 0.907), (0.371, 0.901)),
    published([1.943, 1306.2, 1.036], (0.601, 2.012), Some((0.522, 2.120)), (0.505, 1.874), (0.507, 1.867)),
];

/// Cycles per revolution of an angle error that the robot's model cannot describe, and its rms,
/// rad: the middle of what was seen on real arms (UR5 60 to 110 µrad, UR10 220 to 400 µrad, 10 to
/// 30 cycles).
const CYCLES: f64 = 17.0;
const ANGLE_ERRORS: [f64; 2] = [85e-6, 310e-6];

const VARIANTS: [&str; 9] = [
    "as published",
    "no noise at all",
    "clamps misplaced by 43 µm rms",
    "no contact force",
    "6 poses on each clamp, 30 in all",
    "joint angles err by 85 µrad rms",
    "joint angles err by 310 µrad rms",
    "every pose scatters by c_rod rms",
    "6 poses on each clamp, and every pose scatters by c_rod rms",
];

/// Validation by mode.
struct Judged {
    errors: [Option<Summary>; 4],
    /// False where a calibration says that it did not converge.
    came_to_rest: bool,
}

/// One seed of one rod.
struct Run {
    /// Validation before calibration.
    before: Summary,
    /// Validation by variant.
    judged: Vec<Judged>,
    condition: f64,
    o1: f64,
    field: Field,
}

/// Root mean squares over the poses, m.
#[derive(Clone, Copy)]
struct Field {
    gravity: f64,
    force: f64,
    both: f64,
    /// What base and tool leave of both.
    after_base_and_tool: f64,
    /// What all parameters leave.
    after_all: f64,
}

pub fn main(arguments: &[String]) {
    let seeds: usize = arguments.first().map_or(40, |count| count.parse().unwrap());
    let (_, text) = Robot::builtin("tx90").unwrap();
    let robot = Robot::from_text("tx90.toml", text, None, None).unwrap();
    let project = Path::new(env!("CARGO_MANIFEST_DIR"));
    let rods: Vec<(String, Rod, Compliance)> = (1..=6)
        .map(|number| {
            let text = rodcal::files::read_text(&project.join(format!("rods/{number}.toml"))).unwrap();
            let rod = Rod::from_toml("rod.toml", &text).unwrap();
            let model = Compliance::of_model(&rod, &Physics::default(), DEFAULT_ELEMENTS).unwrap();
            (text, rod, model)
        })
        .collect();
    let runs = in_parallel(rods.len() * seeds, |index| {
        let (text, rod, model) = &rods[index / seeds];
        run(&robot, text, rod, model, PUBLISHED[index / seeds].r_rod, 1 + (index % seeds) as u64)
    });
    let of_rod: Vec<&[Run]> = runs.chunks(seeds).collect();

    println!("{seeds} seeds for each rod. Mean ± standard error over the seeds.\n");
    let before: Vec<f64> = runs.iter().map(|run| run.before.mean / MM).collect();
    let worst: Vec<f64> = runs.iter().map(|run| run.before.max / MM).collect();
    println!("Before calibration: {:.2} ({:.2}) mm\n", mean(&before).unwrap(), mean(&worst).unwrap());

    println!("## Validation error, mean (max), mm\n");
    println!("| rod | | None | Calc | FEA | Meas | None − Meas |\n|---|---|---|---|---|---|---|");
    for ((rod, runs), paper) in (1..).zip(&of_rod).zip(&PUBLISHED) {
        let cells = simulated(runs, 0);
        println!("| {rod}# | simulated | {} |", cells.join(" | "));
        let printed: Vec<String> = paper
            .errors
            .iter()
            .map(|e| e.map_or("–".into(), |(mean, max)| format!("{mean:.3} ({max:.3})")))
            .collect();
        let gain = paper.errors[0].unwrap().0 - paper.errors[3].unwrap().0;
        println!("| | published | {} | {gain:.3} |", printed.join(" | "));
    }

    println!("\n## Rods and poses\n");
    println!("| rod | c_rod, µm | published | condition | O1 | published OI |\n|---|---|---|---|---|---|");
    for (number, (runs, paper)) in of_rod.iter().zip(&PUBLISHED).enumerate() {
        let true_index = rods[number].2.index(paper_contact_force()) * paper.r_rod;
        println!(
            "| {}# | {:.1} | {:.1} | {} | {} | {:.3} |",
            number + 1,
            true_index / UM,
            paper.c_rod,
            mean_and_error(runs.iter().map(|run| run.condition), 1),
            mean_and_error(runs.iter().map(|run| run.o1), 3),
            paper.oi
        );
    }

    println!("\n## The deflection over the poses, rms in µm\n");
    println!("| rod | gravity | contact force | both | left by base and tool | left by all parameters |");
    println!("|---|---|---|---|---|---|");
    for (rod, runs) in (1..).zip(&of_rod) {
        let cell = |number: fn(&Field) -> f64, digits| {
            mean_and_error(runs.iter().map(|run| number(&run.field) / UM), digits)
        };
        println!(
            "| {rod}# | {} | {} | {} | {} | {} |",
            cell(|f| f.gravity, 1),
            cell(|f| f.force, 1),
            cell(|f| f.both, 1),
            cell(|f| f.after_base_and_tool, 1),
            cell(|f| f.after_all, 1)
        );
    }

    for (variant, name) in VARIANTS.iter().enumerate().skip(1) {
        println!("\n## {name}: validation error, mean (max), mm\n");
        println!("| rod | None | Calc | FEA | Meas | None − Meas |\n|---|---|---|---|---|---|");
        for (rod, runs) in (1..).zip(&of_rod) {
            println!("| {rod}# | {} |", simulated(runs, variant).join(" | "));
        }
    }
    println!();
    for (variant, name) in VARIANTS.iter().enumerate() {
        let restless = runs.iter().filter(|run| !run.judged[variant].came_to_rest).count();
        println!("{name}: {restless} of {} campaigns have a mode that did not converge", runs.len());
    }
}

/// Mean ± standard error.
fn mean_and_error(values: impl Iterator<Item = f64>, digits: usize) -> String {
    let values: Vec<f64> = values.collect();
    let error = standard_deviation(&values).unwrap_or(0.0) / (values.len() as f64).sqrt();
    format!("{:.digits$} ± {error:.digits$}", mean(&values).unwrap())
}

/// One cell for each mode, then what Meas gains on None, seed by seed.
fn simulated(runs: &[Run], variant: usize) -> Vec<String> {
    let mut cells: Vec<String> = (0..4)
        .map(|mode| {
            let all: Option<Vec<Summary>> = runs.iter().map(|run| run.judged[variant].errors[mode]).collect();
            let Some(all) = all else { return "–".into() };
            let worst: Vec<f64> = all.iter().map(|s| s.max / MM).collect();
            format!("{} ({:.3})", mean_and_error(all.iter().map(|s| s.mean / MM), 4), mean(&worst).unwrap())
        })
        .collect();
    let of_run = |run: &Run, mode: usize| run.judged[variant].errors[mode].unwrap().mean / MM;
    cells.push(mean_and_error(runs.iter().map(|run| of_run(run, 0) - of_run(run, 3)), 4));
    cells
}

fn run(robot: &Robot, text: &str, rod: &Rod, model: &Compliance, r_rod: f64, seed: u64) -> Run {
    let plan = Plan::default().with_seed(seed).with_rod_factor(r_rod);
    let simulation = simulate(robot, rod, model, &plan).unwrap();
    let campaign = campaign(&simulation, text);
    let world = World { truth: &simulation.truth, rod: Some((rod, simulation.compliance)), force: true };
    let mut random = Random::seeded(seed, 100);

    let tips = world.tips(&simulation.measurements);
    let mut all = vec![judged(&campaign)];
    let mut quiet = campaign.clone();
    quiet.measurements.targets = Targets::Points(tips.clone());
    let mut short = simulation.truth.clone();
    short.tool = Vector3::new(0.0, 0.0, 0.12);
    let bare = World { truth: &short, rod: None, force: false };
    quiet.validation.as_mut().unwrap().targets = Targets::Points(bare.tips(&simulation.validation));
    all.push(judged(&quiet));

    let misplaced = plan.clone().with_clamp_error(43.0 * UM);
    all.push(judged(&self::campaign(&simulate(robot, rod, model, &misplaced).unwrap(), text)));

    let mut untouched = campaign.clone();
    let without = World { force: false, ..world }.tips(&simulation.measurements);
    moved(&mut untouched.measurements, |row| without[row] - tips[row]);
    untouched.contact_force = None;
    all.push(judged(&untouched));

    let few = Plan::of_poses(6, plan.validation_poses).with_seed(seed).with_rod_factor(r_rod);
    let mut few = self::campaign(&simulate(robot, rod, model, &few).unwrap(), text);
    all.push(judged(&few));

    for rms in ANGLE_ERRORS {
        let mut wavy = campaign.clone();
        let waves: Vec<(f64, f64)> =
            robot.joints.iter().map(|_| (rms * 2.0f64.sqrt(), random.uniform(0.0, 6.3))).collect();
        let erring = |setup: &Setup, recording: &mut Recording| {
            let of_rows = offsets(setup, recording, &waves);
            moved(recording, |row| of_rows[row]);
        };
        erring(&simulation.truth, &mut wavy.measurements);
        erring(&short, wavy.validation.as_mut().unwrap());
        all.push(judged(&wavy));
    }

    let scatter = simulation.compliance.index(paper_contact_force()) / 3.0f64.sqrt();
    let mut loose = campaign.clone();
    for recording in [&mut loose.measurements, &mut few.measurements] {
        moved(recording, |_| Vector3::from_fn(|_, _| random.normal()) * scatter);
    }
    all.extend([judged(&loose), judged(&few)]);

    let nominal = Setup::new(robot, simulation.base_guess, rod.tip());
    let before = validate(&nominal, campaign.validation.as_ref().unwrap(), Refit::BaseTool).unwrap().summary;
    let fit = calibrate(&campaign, Mode::Fea, &Options::default()).unwrap();
    Run {
        before,
        judged: all,
        condition: fit.observability.condition,
        o1: fit.observability.indices[0],
        field: world.field(robot, rod, &simulation),
    }
}

/// The campaign as it would be read from its files.
fn campaign(simulation: &Simulation, rod: &str) -> Campaign {
    let files = campaign_files(simulation, "builtin:tx90", "rod.toml");
    let find = |wanted: &str| match wanted {
        "rod.toml" => rod.to_owned(),
        _ => files.iter().find(|(name, _)| name == wanted).unwrap().1.clone(),
    };
    Campaign::from_texts("campaign.toml", &find("campaign.toml"), &|name| Ok(find(name))).unwrap()
}

/// Validation of every mode that the rod allows.
fn judged(campaign: &Campaign) -> Judged {
    let (possible, rest) = (modes(campaign), Cell::new(true));
    let errors = Mode::ALL.map(|mode| {
        possible.contains(&mode).then(|| {
            let fit = calibrate(campaign, mode, &Options::default()).unwrap();
            rest.set(rest.get() && fit.is_converged);
            fit.validation.unwrap().summary
        })
    });
    Judged { errors, came_to_rest: rest.get() }
}

fn moved(recording: &mut Recording, by: impl FnMut(usize) -> Vector3<f64>) {
    let Targets::Points(points) = &mut recording.targets else { panic!("no points") };
    let offsets: Vec<Vector3<f64>> = (0..points.len()).map(by).collect();
    points.iter_mut().zip(offsets).for_each(|(point, offset)| *point += offset);
}

/// By how much the tip misses where every joint errs by a wave of its own angle: amplitude (rad)
/// and phase.
fn offsets(setup: &Setup, recording: &Recording, waves: &[(f64, f64)]) -> Vec<Vector3<f64>> {
    let mut kinematics = Kinematics::new(setup);
    (0..recording.len())
        .map(|row| {
            let q = recording.joints(row);
            kinematics.update(q, &[]);
            let of_joint = |(j, &(size, phase)): (usize, &(f64, f64))| {
                kinematics.joint_jacobian(j) * size * (CYCLES * q[j] + phase).sin()
            };
            waves.iter().enumerate().map(of_joint).sum()
        })
        .collect()
}

/// The true robot with what hangs on it.
#[derive(Clone, Copy)]
struct World<'a> {
    truth: &'a Setup<'a>,
    rod: Option<(&'a Rod, Compliance)>,
    force: bool,
}

impl World<'_> {
    /// Visits every row with the robot at rest under its loads: kinematics, torques, gravity and
    /// contact force in {W}.
    fn visit(
        &self,
        recording: &Recording,
        mut see: impl FnMut(&Kinematics, &[f64], Vector3<f64>, Vector3<f64>),
    ) {
        let gravity = self.truth.base().rotation * self.truth.robot.gravity;
        let payload = self.rod.map(|(rod, _)| Body { mass: rod.mass(), centre: rod.centre_of_mass() });
        let mut kinematics = Kinematics::new(self.truth);
        for row in 0..recording.len() {
            let device = recording.groups[recording.rows[row].group].device.rotation;
            let tip_force =
                if self.force { device * Vector3::from(PAPER_CONTACT_FORCE) } else { Vector3::zeros() };
            let mut torque = vec![0.0; recording.joint_count];
            for _ in 0..5 {
                kinematics.update(recording.joints(row), &torque);
                kinematics.torques(&Loads::new(gravity, payload, tip_force), &mut torque);
            }
            kinematics.update(recording.joints(row), &torque);
            see(&kinematics, &torque, gravity, tip_force);
        }
    }

    /// Deflection under gravity and under the contact force in {W}, m.
    fn deflections(&self, k: &Kinematics, gravity: Vector3<f64>, force: Vector3<f64>) -> [Vector3<f64>; 2] {
        let Some((_, compliance)) = self.rod else { return [Vector3::zeros(); 2] };
        let turned = |c: Matrix3<f64>, load| k.flange.rotation * (c * k.flange.rotation.tr_mul(&load));
        [turned(compliance.gravity, gravity / STANDARD_GRAVITY), turned(compliance.force, force)]
    }

    /// The deflected tip of every row, without noise, in {W}, m.
    fn tips(&self, recording: &Recording) -> Vec<Vector3<f64>> {
        let mut tips = Vec::new();
        self.visit(recording, |k, _, gravity, force| {
            let [sag, push] = self.deflections(k, gravity, force);
            tips.push(k.tip + sag + push);
        });
        tips
    }

    /// How large the deflection is, and what a fit of the robot would leave of it.
    fn field(&self, robot: &Robot, rod: &Rod, simulation: &Simulation) -> Field {
        let payload = Body { mass: rod.mass(), centre: rod.centre_of_mass() };
        let all = minimal_parameters(robot, self.truth.tool, rod.tip(), Some(payload));
        let placement: Vec<Parameter> = Parameter::all(robot.joints.len())
            .into_iter()
            .filter(|p| {
                matches!(p, Parameter::BasePosition(_) | Parameter::BaseRotation(_) | Parameter::Tool(_))
            })
            .collect();
        let rows = simulation.measurements.len();
        let (mut sag, mut push) = (DVector::zeros(3 * rows), DVector::zeros(3 * rows));
        let mut columns = [&placement, &all].map(|set| DMatrix::zeros(3 * rows, set.len()));
        let mut at = 0;
        self.visit(&simulation.measurements, |k, torque, gravity, force| {
            let [by_gravity, by_force] = self.deflections(k, gravity, force);
            sag.fixed_rows_mut::<3>(at).copy_from(&by_gravity);
            push.fixed_rows_mut::<3>(at).copy_from(&by_force);
            for (matrix, set) in columns.iter_mut().zip([&placement, &all]) {
                for (column, &parameter) in set.iter().enumerate() {
                    matrix.fixed_view_mut::<3, 1>(at, column).copy_from(&k.column(parameter, torque));
                }
            }
            at += 3;
        });
        let both = &sag + &push;
        let rms = |field: &DVector<f64>| field.norm() / (rows as f64).sqrt();
        let [after_base_and_tool, after_all] = columns.map(|matrix| {
            let q = matrix.qr().q();
            rms(&(&both - &q * q.tr_mul(&both)))
        });
        Field { gravity: rms(&sag), force: rms(&push), both: rms(&both), after_base_and_tool, after_all }
    }
}
