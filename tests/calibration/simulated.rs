//! Campaigns of the program's own simulation, with fewer poses than the paper's, to the last digit.

use rodcal::beam::Physics;
use rodcal::calibration::Campaign;
use rodcal::calibration::simulate::{Plan, Simulation, campaign_files, simulate};
use rodcal::compliance::Compliance;
use rodcal::robot::Robot;
use rodcal::rod::Rod;

use super::{arms, lab};

pub struct Simulator {
    robot: Robot,
    rod_text: String,
    rod: Rod,
    model: Compliance,
    plan: Plan,
}

impl Simulator {
    /// The paper's rod 5# with 5 × 14 poses and 10 of validation.
    pub fn new() -> Simulator {
        let plan = Plan::of_poses(14, 10);
        Simulator::of(include_str!("../../rods/5.toml"), plan)
    }

    pub fn of(rod_text: &str, plan: Plan) -> Simulator {
        let rod = Rod::from_toml("rod.toml", rod_text).unwrap();
        let model = Compliance::of_model(&rod, &Physics::default(), 20).unwrap();
        Simulator { robot: arms::tx90().1, rod_text: rod_text.to_owned(), rod, model, plan }
    }

    pub fn run(&self, seed: u64) -> (Simulation<'_>, Campaign) {
        let plan = self.plan.clone().with_seed(seed);
        let simulation = simulate(&self.robot, &self.rod, &self.model, &plan).unwrap();
        let files = campaign_files(&simulation, "builtin:tx90", "rod.toml");
        let mut files: Vec<(&str, &str)> = files.iter().map(|(n, t)| (n.as_str(), t.as_str())).collect();
        files.push(("rod.toml", &self.rod_text));
        let mut campaign = lab::read(&files);
        campaign.measurements.targets = simulation.measurements.targets.clone();
        campaign.measurements.joint_values = simulation.measurements.joint_values.clone();
        (simulation, campaign)
    }
}

/// On a rail: values of joints that slide are written in mm, and read back as what they were.
#[test]
fn a_robot_on_a_rail_is_simulated_and_read_back() {
    let rail = "[[joint]]\ntype = \"prismatic\"\ntheta_offset_deg = 0.0\nd_mm = 0.0\na_mm = 0.0\n\
        alpha_deg = 0.0\nbeta_deg = 0.0\nlimits_mm = [-100.0, 100.0]\n\n[[joint]]";
    let text = arms::tx90().0.replacen("[[joint]]", rail, 1);
    let simulator = Simulator::of(include_str!("../../rods/5.toml"), Plan::of_poses(4, 5));
    let robot = arms::robot(&text);
    let simulation = simulate(&robot, &simulator.rod, &simulator.model, &simulator.plan).unwrap();
    let files = campaign_files(&simulation, "robot.toml", "rod.toml");
    let mut files: Vec<(&str, &str)> = files.iter().map(|(n, t)| (n.as_str(), t.as_str())).collect();
    files.extend([("rod.toml", simulator.rod_text.as_str()), ("robot.toml", &text)]);
    let campaign = lab::read(&files);
    let pairs = [
        (&campaign.measurements, &simulation.measurements),
        (campaign.validation.as_ref().unwrap(), &simulation.validation),
    ];
    for (read, simulated) in pairs {
        assert_eq!(read.joint_values.len(), simulated.joint_values.len());
        let pairs = read.joint_values.iter().zip(&simulated.joint_values);
        let widest = pairs.map(|(a, b)| (a - b).abs()).fold(0.0, f64::max);
        assert!(widest < 1e-9, "{widest}");
        // the rail is used
        assert!((0..read.len()).any(|row| read.joints(row)[0].abs() > 0.01));
    }
}
