//! Constraints of single parameters: fixed, freed, known beforehand.

use nalgebra::{Isometry3, Vector3};
use rodcal::calibration::{Calibration, Campaign, Estimated, Mode, Options, calibrate};
use rodcal::robot::Parameter;

use super::arms::{self, UR5};
use super::lab::{Dice, Lab, millimetres, read};

const NOISE: f64 = 20e-6;
/// By how much a₂ is longer than drawn, m.
const LONGER: f64 = 0.5e-3;

/// A UR5 that is as drawn but for a₂.
fn campaign(poses: usize, sections: &str) -> Campaign {
    let mut dice = Dice(83);
    let mut lab = Lab::new(arms::robot(UR5), Isometry3::identity(), Vector3::new(0.08, 0.03, 0.15));
    lab.change(Parameter::A(1), LONGER);
    let mut csv = format!("pose{},x_mm,y_mm,z_mm\n", lab.header());
    for pose in 0..poses {
        let q = lab.anywhere(&mut dice);
        let noise = Vector3::from_fn(|_, _| NOISE * dice.normal());
        csv += &format!("{pose}{},{}\n", lab.cells(&q), millimetres(&(lab.rigid_tip(&q) + noise)));
    }
    let text =
        format!("robot = \"ur5.toml\"\nmeasurements = \"m.csv\"\n[tool]\nxyz_mm = [80, 30, 150]\n{sections}");
    read(&[("campaign.toml", &text), ("ur5.toml", UR5), ("m.csv", &csv)])
}

fn calibrated(campaign: &Campaign) -> Calibration<'_> {
    let found =
        calibrate(campaign, Mode::None, &Options::default()).unwrap_or_else(|error| panic!("{error}"));
    assert!(found.is_converged, "{} {:?}", found.fit.reason, found.passes);
    found
}

fn a2(found: &Calibration) -> Estimated {
    *found.parameters.iter().find(|p| p.parameter == Parameter::A(1)).unwrap()
}

#[test]
fn what_is_fixed_stays_as_drawn() {
    let campaign = campaign(40, "[parameters]\nfix = [\"a2_mm\", \"tool_x_mm\", \"theta3\"]\n");
    let found = calibrated(&campaign);
    assert!(found.parameters.iter().all(|p| p.parameter != Parameter::A(1)));
    assert_eq!(found.parameters.len(), 27 - 3);
    assert_eq!(found.setup.get(Parameter::A(1)), campaign.robot.joints[1].link.a);
    assert_eq!(found.setup.get(Parameter::Tool(0)), campaign.tool[0]);
    assert_eq!(found.setup.get(Parameter::Theta(2)), campaign.robot.joints[2].link.theta);
    // half a millimetre has nowhere to go
    assert!(found.noise.pooled > 2.0 * NOISE, "{}", found.noise.pooled);
}

#[test]
fn what_is_freed_is_estimated() {
    let sections = "[parameters]\nfix = [\"d2\"]\nfree = [\"d3\"]\n";
    let (plain, freed) = (campaign(40, ""), campaign(40, sections));
    let (plain, freed) = (calibrated(&plain), calibrated(&freed));
    assert!(plain.parameters.iter().all(|p| p.parameter != Parameter::D(2)));
    let d3 = freed.parameters.iter().find(|p| p.parameter == Parameter::D(2)).unwrap();
    assert!(d3.identifiable);
    // one redundant parameter in place of another: the same robot
    assert!((plain.noise.pooled / freed.noise.pooled - 1.0).abs() < 1e-6);
}

/// A prior and the data meet between, where their precisions have them.
#[test]
fn a_prior_pulls_as_it_is_sure() {
    let plain = campaign(40, "");
    let plain = a2(&calibrated(&plain));
    let data_sd = plain.std_error.unwrap();
    assert!((plain.value - plain.nominal - LONGER).abs() < 4.0 * data_sd);
    for ratio in [0.1, 1.0, 10.0] {
        let sd = ratio * data_sd;
        let prior = plain.value + 5.0 * sd;
        let sections =
            format!("[[prior]]\nparameter = \"a2_mm\"\nvalue = {:?}\nsd = {:?}\n", prior * 1e3, sd * 1e3);
        let campaign = campaign(40, &sections);
        let found = a2(&calibrated(&campaign));
        let weight = sd.powi(-2) / (sd.powi(-2) + data_sd.powi(-2));
        let expected = plain.value + weight * (prior - plain.value);
        // the noise that the prior's pull adds to the residuals changes the weight a little
        assert!(
            (found.value - expected).abs() < 0.3 * (prior - plain.value).abs().min(data_sd),
            "{ratio}: {} {expected}",
            found.value
        );
        assert!(found.value > plain.value && found.value < prior);
        let expected = (sd.powi(-2) + data_sd.powi(-2)).powf(-0.5);
        assert!(
            (found.std_error.unwrap() / expected - 1.0).abs() < 0.15,
            "{ratio}: {:?} {expected}",
            found.std_error
        );
    }
}

/// What the poses do not tell, a prior may: it identifies what would be held otherwise.
#[test]
fn a_prior_identifies_a_redundant_parameter() {
    let sections =
        "[parameters]\nfree = [\"d3\"]\n[[prior]]\nparameter = \"d3_mm\"\nvalue = 0.2\nsd = 0.05\n";
    let campaign = campaign(40, sections);
    let found = calibrated(&campaign);
    assert!(found.held.is_empty());
    let d3 = found.parameters.iter().find(|p| p.parameter == Parameter::D(2)).unwrap();
    assert!(d3.identifiable);
    // the drawing, which knows the other offset to some tenths of a millimetre, says a little too
    let sd = d3.std_error.unwrap();
    assert!((d3.value - 0.2e-3).abs() < 0.05e-3, "{}", d3.value);
    assert!(sd < 0.0501e-3 && sd > 0.04e-3, "{sd}");
}
