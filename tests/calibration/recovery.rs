//! Noise-free recordings of a laboratory give back its truth, and any other physics does not.

use nalgebra::{Isometry3, UnitQuaternion, Vector3};
use rodcal::calibration::{Calibration, Campaign, Mode, Options, calibrate};
use rodcal::robot::{Parameter, Robot};

use super::arms::{self, SEVEN, UR5};
use super::lab::{Dice, Lab, Laws, PHYSICS, isometry, millimetres, placed, read};
use super::rods;

/// Metres, radians, and radians at the largest torque: a thousand times the rounding of a chain of
/// a dozen frames. (The compensation may stop 1 nm from rest, but that shrinks a thousandfold with
/// every pass, and the last fit stands on it.)
pub const EXACT: f64 = 1e-11;
/// What a wrong sign does: hundreds of micrometres, of which parameters may take most but not all.
const WRONG: f64 = 1e-4;

/// Changes every parameter of a list by as much as robots as built are off.
pub fn spoil(lab: &mut Lab, parameters: &[Parameter], dice: &mut Dice) {
    for &parameter in parameters {
        let by = match parameter {
            Parameter::BasePosition(_) => 3e-3,
            Parameter::BaseRotation(_) | Parameter::Theta(_) => 5e-3,
            Parameter::Tool(_) | Parameter::D(_) | Parameter::A(_) => 1e-3,
            Parameter::Alpha(_) | Parameter::Beta(_) => 2e-3,
            // drives yield with their torque
            Parameter::Compliance(j) => {
                lab.change(parameter, [0.0, 3e-6, 8e-6, 2e-4, 2e-4, 3e-4, 3e-4][j]);
                continue;
            }
        };
        lab.change(parameter, by * dice.roll());
    }
}

/// The paper's 27 numbers without base, and its five compliances.
pub const RHO: &str = "a1 alpha1 theta2 d2 a2 alpha2 beta2 c2 theta3 a3 alpha3 c3 theta4 d4 a4 alpha4 c4 theta5 d5 a5 alpha5 \
                   c5 theta6 c6 tool_x tool_z";

pub fn named(names: &str, joints: usize) -> Vec<Parameter> {
    names.split_whitespace().map(|name| Parameter::from_key(name, joints).unwrap()).collect()
}

/// A TX90 with the soft rod in front of three clamps, which stand anyhow.
pub struct Clamped {
    pub lab: Lab,
    pub devices: Vec<Isometry3<f64>>,
    /// Clamp and joint values.
    pub poses: Vec<(usize, Vec<f64>)>,
    /// What the user takes the base for.
    pub guess: Isometry3<f64>,
    /// What the sensors add, m.
    pub noise: f64,
}

impl Clamped {
    pub fn new(laws: Laws) -> Clamped {
        let mut dice = Dice(17);
        let (_, robot) = arms::tx90();
        let guess = Isometry3::new(Vector3::new(-0.6, 0.1, -0.2), Vector3::new(0.02, -0.01, 0.3));
        let mut lab = Lab::new(robot, guess, rods::tip());
        let base: Vec<Parameter> =
            (0..3).map(Parameter::BasePosition).chain((0..3).map(Parameter::BaseRotation)).collect();
        spoil(&mut lab, &base, &mut dice);
        spoil(&mut lab, &named(RHO, 6), &mut dice);
        lab.rod = Some(rods::closed_form());
        lab.push = Vector3::new(1.10, 1.25, 1.05);
        lab.laws = laws;
        let devices = (0..3).map(|_| dice.motion(0.3, 1.5)).collect();
        let poses = (0..75).map(|row| (row % 3, lab.anywhere(&mut dice))).collect();
        Clamped { lab, devices, poses, guess, noise: 0.0 }
    }

    /// The whole world moved: nothing but {W} is another.
    pub fn moved(mut self, by: &Isometry3<f64>) -> Clamped {
        self.lab.base = by * self.lab.base;
        self.guess = by * self.guess;
        self.devices.iter_mut().for_each(|device| *device = by * *device);
        self
    }

    /// Where the ball was, in the device's frame, with noise that is fixed to the device.
    fn seen(&self) -> Vec<Vector3<f64>> {
        let mut dice = Dice(23);
        let poses = self.poses.iter();
        poses
            .map(|(clamp, q)| {
                let device = &self.devices[*clamp];
                let tip = self.lab.tip(q, &device.rotation);
                let noise = Vector3::from_fn(|_, _| self.noise * dice.normal());
                device.inverse_transform_point(&tip.into()).coords + noise
            })
            .collect()
    }

    pub fn measurements(&self) -> Vec<String> {
        let rows = self.poses.iter().zip(self.seen()).enumerate();
        rows.map(|(row, ((clamp, q), seen))| {
            format!("{row},{clamp}{},{}\n", self.lab.cells(q), millimetres(&seen))
        })
        .collect()
    }

    pub fn campaign_with(&self, rows: &[String], sections: &str) -> Campaign {
        let [fx, fy, fz] = self.lab.push.into();
        let clamps: String = (0..)
            .zip(&self.devices)
            .map(|(id, device)| format!("[[clamp]]\nid = \"{id}\"\n{}", placed(device)))
            .collect();
        let campaign = format!(
            "robot = \"builtin:tx90\"\nrod = \"rod.toml\"\ncontact_force_n = [{fx:?}, {fy:?}, {fz:?}]\n\
             measurements = \"measurements.csv\"\n[base]\n{}{clamps}{sections}",
            placed(&self.guess)
        );
        let header = format!("pose,clamp{},x_mm,y_mm,z_mm\n", self.lab.header());
        let measurements = header + &rows.concat();
        read(&[("campaign.toml", &campaign), ("rod.toml", rods::SOFT), ("measurements.csv", &measurements)])
    }

    pub fn campaign(&self) -> Campaign {
        self.campaign_with(&self.measurements(), "")
    }
}

/// Largest error of link, compliance and tool parameters, and of the base's frame; m, rad, rad at a
/// joint's full torque.
pub fn worst_error(lab: &Lab, found: &Calibration) -> (f64, String) {
    let mut truth = found.setup.clone();
    for (j, joint) in lab.robot.joints.iter().enumerate() {
        truth.links[j] = joint.link;
        truth.compliance[j] = joint.compliance;
    }
    truth.tool = lab.tool;
    let full = [1.0, 200.0, 45.0, 3.0, 3.0, 2.0, 1.0];
    let mut worst = (0.0, String::new());
    let mut note = |error: f64, name: String| {
        if error > worst.0 {
            worst = (error, name);
        }
    };
    for p in Parameter::all(lab.robot.joints.len()) {
        let scale = if let Parameter::Compliance(j) = p { full[j] } else { 1.0 };
        note((found.setup.get(p) - truth.get(p)).abs() * scale, p.to_string());
    }
    let apart = isometry(&found.setup.base()).inverse() * lab.base;
    note(apart.translation.vector.norm(), "base position".into());
    note(apart.rotation.angle(), "base rotation".into());
    worst
}

fn calibrated(campaign: &Campaign, mode: Mode) -> Calibration<'_> {
    calibrate(campaign, mode, &Options::default()).unwrap_or_else(|error| panic!("{error}"))
}

#[test]
fn clamps_give_the_truth_back() {
    let made = Clamped::new(PHYSICS);
    let campaign = made.campaign();
    let found = calibrated(&campaign, Mode::Calc);
    let mut free: Vec<String> = found.parameters.iter().map(|p| p.parameter.to_string()).collect();
    free.retain(|name| !name.starts_with("base"));
    let mut rho: Vec<String> = named(RHO, 6).iter().map(ToString::to_string).collect();
    free.sort();
    rho.sort();
    assert_eq!(free, rho);
    let (error, name) = worst_error(&made.lab, &found);
    assert!(error < EXACT, "{name} is off by {error:e}");
    assert!(found.is_converged, "{:?}", found.passes);
    assert!(found.held.is_empty());
}

/// A recording without noise is no special case: with a stated noise the drawing draws by less than
/// a hundredth of what that noise leaves uncertain.
#[test]
fn clamps_give_the_truth_back_where_the_noise_is_stated() {
    let made = Clamped::new(PHYSICS);
    let campaign = made.campaign_with(&made.measurements(), "[noise]\nposition_um = 20\n");
    let found = calibrated(&campaign, Mode::Calc);
    let (error, name) = worst_error(&made.lab, &found);
    let own = found.parameters.iter().find(|p| p.parameter.to_string() == name);
    let sd = own.and_then(|p| p.std_error).unwrap();
    assert!(error < 0.01 * sd, "{name} is off by {error:e} of {sd:e}");
    assert!(found.is_converged, "{:?}", found.passes);
    assert!(found.noise.is_stated && (found.noise.pooled - 20e-6).abs() < 1e-12);
}

/// What the recovery rests on: every sign and unit of the physics, one after the other made wrong,
/// is noticed.
#[test]
fn no_other_physics_gives_the_truth_back() {
    let laws: [(&str, Laws); 8] = [
        ("the rod rises", Laws { sag: -1.0, ..PHYSICS }),
        ("the force pulls", Laws { push: -1.0, ..PHYSICS }),
        ("joints resist", Laws { yielding: -1.0, ..PHYSICS }),
        ("links are light", Laws { links_weigh: 0.0, ..PHYSICS }),
        ("the rod does not weigh on the joints", Laws { rod_weighs: 0.0, ..PHYSICS }),
        ("the force pulls the joints", Laws { push_turns: -1.0, ..PHYSICS }),
        ("C^g counts per m/s²", Laws { gravity_unit: 1.0, ..PHYSICS }),
        ("the force is in {W}", Laws { push_is_in_the_device: false, ..PHYSICS }),
    ];
    for (name, law) in laws {
        let made = Clamped::new(law);
        let campaign = made.campaign();
        let found = calibrated(&campaign, Mode::Calc);
        let (error, which) = worst_error(&made.lab, &found);
        assert!(error > WRONG, "{name}: {which} is off by {error:e} only");
    }
}

/// A table or URDF whose every number is a little wrong, redundant ones too: the calibrated robot
/// puts the tip where the true one has it, whatever it makes of the numbers.
#[test]
fn a_tracker_finds_a_robot_that_moves_as_the_true_one() {
    for (name, text) in [("UR5", UR5.to_owned()), ("seven joints", arms::weightless(SEVEN))] {
        let mut dice = Dice(5);
        let nominal: Robot = arms::robot(&text);
        let tool = Vector3::new(0.08, 0.03, 0.15);
        let base = Isometry3::new(Vector3::new(1.0, -2.0, 0.3), Vector3::new(2.5, 0.4, -1.0));
        let mut lab = Lab::new(nominal, base, tool);
        let every: Vec<Parameter> = Parameter::all(lab.robot.joints.len())
            .into_iter()
            .filter(|p| !matches!(p, Parameter::Compliance(_)))
            .collect();
        spoil(&mut lab, &every, &mut dice);
        let tip = |q: &[f64]| lab.tip(q, &UnitQuaternion::identity());
        let mut csv = format!("pose{},x_mm,y_mm,z_mm\n", lab.header());
        for pose in 0..60 {
            let q = lab.anywhere(&mut dice);
            csv += &format!("{pose}{},{}\n", lab.cells(&q), millimetres(&tip(&q)));
        }
        // no word about the base, and a poor one about the tool
        let campaign = "robot = \"robot.file\"\nmeasurements = \"m.csv\"\n[tool]\nxyz_mm = [80, 30, 150]\n";
        let campaign = read(&[("campaign.toml", campaign), ("robot.file", &text), ("m.csv", &csv)]);
        let found = calibrated(&campaign, Mode::None);
        let mut kinematics = rodcal::robot::Kinematics::new(&found.setup);
        let mut worst = 0.0f64;
        for _ in 0..100 {
            let q = lab.anywhere(&mut dice);
            kinematics.update(&q, &[]);
            worst = worst.max((kinematics.tip - tip(&q)).norm());
        }
        assert!(worst < EXACT, "{name}: {worst:e} m at poses never seen");
        assert!(found.is_converged, "{name}: {:?}", found.passes);
    }
}
