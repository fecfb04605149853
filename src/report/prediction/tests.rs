//! What a prediction says.

use super::*;
use crate::robot::{
    CalibratedRange, Effect, Hayati, Joint, JointLawVariable, LawPlace, Parameter, RobotLaw, Tip, Uncertainty,
};

/// A joint of 0.5 m whose zero is known to 0.1 mrad, calibrated from −30° to 30°.
fn arm() -> Robot {
    let link = Hayati { a: 0.5, ..Hayati::default() };
    let joints = ["one", "two"].map(|name| Joint::new(name, Motion::Revolute, link));
    let mut arm = Robot::new("arm", joints.to_vec());
    arm.tip = Some(Tip { at: Vector3::zeros(), sd: Some(3e-5) });
    let (parameters, covariance) = (vec![Parameter::Theta(1)], DMatrix::from_element(1, 1, 1e-8));
    arm.uncertainty = Some(Uncertainty { parameters, covariance });
    arm.calibrated = Some(CalibratedRange { joints: vec![(-0.5, 0.5); 2], sd: 4e-5 });
    arm.effects = vec![Effect::EncoderScale { joint: 1, factor: 1.0004 }];
    arm
}

fn predicted(angles: &[[f64; 2]], is_aligned: bool) -> crate::Result<Prediction> {
    let query = |q: &[f64; 2]| PredictionQuery { pose: "1".into(), joints: q.to_vec() };
    Prediction::new(&arm(), Vector3::zeros(), angles.iter().map(query).collect(), is_aligned)
}

#[test]
fn what_is_beyond_the_calibration_is_said_and_less_certain() {
    let near = predicted(&[[0.1, 0.0]], false).unwrap();
    let far = predicted(&[[0.1, 1.2]], false).unwrap();
    // the second joint's zero moves the tip by 0.5 m · 0.1 mrad = 50 µm
    assert!((near.ratios.as_ref().unwrap()[0] - 1.25).abs() < 1e-9 && near.far() == 0);
    assert!(near.beyond.is_empty() && far.beyond == [(1, (1.2, 1.2), (-0.5, 0.5))]);
    let sd = |prediction: &Prediction| prediction.tips[0].2.unwrap().norm();
    let known = (3.0 * 3e-5f64.powi(2) + 5e-5f64.powi(2)).sqrt();
    assert!((sd(&near) - known).abs() < 1e-9);
    // beyond, its scale adds the rms of 0.4e-3·q over ±0.5 rad, 0.115 mrad
    let gear = 0.5 * 0.4e-3 * 0.5 / 3f64.sqrt();
    assert!((sd(&far) - known.hypot(gear)).abs() < 2e-7, "{} {}", sd(&far), known.hypot(gear));
    assert!(warnings(&arm(), &far)[0].contains("joint 2 goes from 68.8° to 68.8°"));
}

#[test]
fn a_law_beyond_what_was_recorded_is_said() {
    let (variable, range) = (JointLawVariable::Angle(1), (-30.0, 30.0));
    let formulas = vec!["3*q".to_owned()];
    let law = RobotLaw::new(LawPlace::Joint(0), None, variable, formulas, Vec::new(), range).unwrap();
    let robot = Robot { laws: vec![law], ..arm() };
    let asked = |angles: &[f64]| {
        let query = |q: &f64| PredictionQuery { pose: String::new(), joints: vec![0.0, q * DEG] };
        let poses = angles.iter().map(query).collect();
        Prediction::new(&robot, Vector3::new(0.1, 0.0, 0.0), poses, false).unwrap()
    };
    assert!(asked(&[-30.0, 12.0, 30.0]).laws_beyond.is_empty());
    let prediction = asked(&[10.0, 35.0, 40.0]);
    let said = warnings(&robot, &prediction).join("\n");
    assert!(said.contains("from -30.0 to 30.0 °; some poses are beyond, from 35.0 to 40.0 °"), "{said}");
    let beyond = &json(&robot, &prediction)["extrapolation"]["laws_beyond"][0];
    assert_eq!((&beyond["place"], &beyond["unit"]), (&"joint 1".into(), &"°".into()));
}

#[test]
fn the_page_says_in_short_how_well_tips_are_known_and_where() {
    let far = predicted(&[[0.1, 1.2]], false).unwrap();
    let report = report(&arm(), &far);
    let said: Vec<&str> = report.cards.iter().map(|card| card.detail.as_str()).collect();
    assert_eq!(said[2], "1 joint beyond its calibrated range");
    assert_eq!(report.figures().count(), 1);
    let mut silent = arm();
    silent.tip = None;
    let query = PredictionQuery { pose: "1".into(), joints: vec![0.1, 0.0] };
    let unknown = Prediction::new(&silent, Vector3::zeros(), vec![query], false).unwrap();
    let report = super::report(&silent, &unknown);
    assert_eq!((report.cards[1].value.as_str(), report.figures().count()), ("not stated", 0));
}

#[test]
fn an_alignment_takes_up_what_base_and_tool_can() {
    let poses: Vec<[f64; 2]> = (0..8).map(|k| [0.1 * f64::from(k), 0.3]).collect();
    // the second joint never moves: its zero is one of the tool
    let sd = |is_aligned| predicted(&poses, is_aligned).unwrap().tips[3].2.unwrap().norm();
    let held_out = 3f64.sqrt() * 3e-5;
    assert!(sd(false) > 1.2 * held_out && (sd(true) - held_out).abs() < 1e-9);
    assert!(predicted(&poses[..3], true).is_err());
}
