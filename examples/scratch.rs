#![allow(missing_docs, clippy::unwrap_used)]
use rodcal::beam::Physics;
use rodcal::calibration::campaign::*;
use rodcal::calibration::simulate::*;
use rodcal::calibration::*;
use rodcal::compliance::Compliance;
use rodcal::robot::Robot;
use rodcal::rod::Rod;
use std::path::Path;
use std::time::Instant;
fn main() {
    let text = std::fs::read_to_string("robots/tx90.toml").unwrap();
    let robot = Robot::from_text("tx90", &text, None, None).unwrap();
    for (n, f) in [(1, 1.226), (2, 1.364), (3, 2.302), (4, 1.051), (5, 1.013), (6, 1.036)] {
        let rod = Rod::read(Path::new(&format!("rods/{n}.toml"))).unwrap();
        let model = Compliance::of_model(&rod, &Physics::default(), 200).unwrap();
        let t = Instant::now();
        let plan = Plan { rod_factor: f, ..Plan::default() };
        let sim = simulate(&robot, &rod, &model, &plan).unwrap();
        println!("rod {n} simulate {:?}", t.elapsed());
        let files = campaign_files(&sim, "builtin:tx90", "rod.toml");
        let readings = rodcal::rig::readings::Readings::from_text("readings.csv", &files[3].1).unwrap();
        let campaign = Campaign {
            file: "c".into(),
            robot: robot.clone(),
            robot_file: "".into(),
            robot_text: "".into(),
            rod: Some(rod.clone()),
            readings: Some(readings),
            contact_force: Some(nalgebra::Vector3::new(1.1, 1.25, 1.05)),
            tool: rod.tip(),
            base: [-0.62, 0.03, -0.16, 0.0, 0.0, 0.0],
            base_is_given: true,
            measurements: sim.measurements.clone(),
            validation: Some(sim.validation.clone()),
            refit: Refit::BaseTool,
            noise: None,
            wishes: Wishes::default(),
            warnings: vec![],
        };
        for mode in modes(&campaign) {
            let t = Instant::now();
            let c = calibrate(&campaign, mode, &Options::default()).unwrap();
            let el = t.elapsed();
            let v = c.validation.as_ref().unwrap();
            println!(
                "{:5} {:?} n={} conv {} {} passes {} it {} rms {:.1} noise {:.1} cond {:.1} O1 {:.3} held {} out {:?} | val mean {:.1} max {:.1} med {:.1} sd {:.1} um",
                mode.name(),
                el,
                c.parameters.len(),
                c.is_converged,
                c.fit.reason,
                c.passes.len(),
                c.fit.iterations,
                c.passes.last().unwrap().rms * 1e6,
                c.noise.pooled * 1e6,
                c.observability.condition,
                c.observability.indices[0],
                c.held.len(),
                c.outliers,
                v.summary.mean * 1e6,
                v.summary.max * 1e6,
                v.summary.median * 1e6,
                v.summary.sd * 1e6
            );
            if n == 5 && mode == Mode::Fea {
                for p in &c.parameters {
                    let truth = sim.truth.get(p.parameter);
                    println!(
                        "   {} {} value {:.5} truth {:.5} se {:?} z {:.2}",
                        p.parameter.key(),
                        p.identifiable,
                        p.value / p.parameter.unit().si,
                        truth / p.parameter.unit().si,
                        p.std_error.map(|s| s / p.parameter.unit().si),
                        (p.value - truth) / p.std_error.unwrap_or(f64::NAN)
                    );
                }
                for p in &c.passes {
                    println!("   {:?}", p);
                }
            }
        }
    }
}
