//! Laws that no library has, concealed in a robot: proposed, said, written into its file, and read
//! again. The truth is the nominal robot with other numbers at each pose, so that nothing of the
//! program's laws is in it.

use std::f64::consts::TAU;
use std::sync::LazyLock;

use nalgebra::Vector3;
use rodcal::calibration::campaign::Refit;
use rodcal::calibration::{Calibration, Campaign, Mode, Options, calibrate};
use rodcal::diagnosis::calibration::{
    Applied, CalibrationDiagnosis, apply, diagnose_as_recorded, diagnose_calibrated,
};
use rodcal::inference::law::Form;
use rodcal::prelude::*;
use rodcal::report::{self, Block};
use rodcal::robot::{JointLawVariable, LawPlace};
use serde_json::Value;

use super::applied::{names, written};
use super::lab::Dice;

const NOISE: f64 = 20e-6;
const TOOL: Vector3<f64> = Vector3::new(0.08, 0.0, 0.25);
/// Poses that are seen, and others of the validation: fewer where nothing is said of intervals.
const MANY: (usize, usize) = (150, 60);
const FEW: (usize, usize) = (100, 40);

/// Where the tip is at the joint values, being pose number so many.
type Truth<'a> = &'a dyn Fn(&Robot, &[f64], usize) -> Vector3<f64>;

fn robot() -> Robot {
    let (file, text) = Robot::builtin("tx90").unwrap();
    Robot::from_text(file, text, None, None).unwrap()
}

/// Seen by a tracker at so many poses, validated at others.
fn tracked(seed: u64, (seen, unseen): (usize, usize), truth: Truth) -> Campaign {
    let nominal = robot();
    let mut built = nominal.clone();
    built.joints[1].link.a += 0.4e-3;
    built.joints[2].link.theta += 0.3e-3;
    let mut dice = Dice(seed);
    let mut recordings = [Recording::new(6), Recording::new(6)];
    for k in 0..seen + unseen {
        let q: Vec<f64> = (0..6).map(|_| 1.8 * dice.roll()).collect();
        let noise = Vector3::from_fn(|_, _| NOISE * dice.normal());
        recordings[usize::from(k >= seen)].add(&q, truth(&built, &q, k) + noise).unwrap();
    }
    let [measured, validation] = recordings;
    let mut campaign = Campaign::new(nominal, measured).unwrap().with_tool(TOOL);
    campaign.validation = Some(validation);
    campaign.refit = Refit::Nothing;
    campaign
}

fn diagnosed(campaign: &Campaign) -> CalibrationDiagnosis<'_> {
    diagnose_as_recorded(campaign, Mode::None, &Options::default()).unwrap()
}

fn applied(found: &CalibrationDiagnosis) -> Applied {
    apply(found, &names("builtin:tx90", Some("validation.csv")), &[]).unwrap().unwrap()
}

fn validated(calibration: &Calibration) -> f64 {
    calibration.validation.as_ref().unwrap().summary.rms
}

/// The law, and the campaign that was written, diagnosed again: nothing is left, and the poses that
/// nobody has seen are as near as the noise lets them be.
fn assert_settled(
    found: &CalibrationDiagnosis,
    place: LawPlace,
    per: Option<usize>,
    variable: JointLawVariable,
) {
    let before = &found.model.calibration;
    let applied = applied(found);
    assert!(applied.removed.is_empty() && applied.left_out.is_empty(), "{applied:?}");
    let again = written(&applied, "");
    let [law] = &again.robot.laws[..] else { panic!("{:?}", again.robot.laws) };
    assert_eq!((law.place, law.per_joint, law.variable), (place, per, variable), "{}", law.description());
    let after = calibrate(&again, Mode::None, &Options::default()).unwrap();
    let noise = 3.0f64.sqrt() * NOISE;
    assert!(validated(&after) < 1.15 * noise, "{} for {noise}", validated(&after));
    assert!(validated(&after) < 0.6 * validated(before), "{} {}", validated(&after), validated(before));
    let second = diagnose_calibrated(&again, after).unwrap();
    assert!(second.diagnosis.findings.is_empty(), "{:?}", second.diagnosis.findings);
    assert!(second.law.is_none() && second.diagnosis.discrepancy.is_none());
    // the calibrated robot is for `predict`
    let text = &applied.files.iter().find(|(name, _)| name == "calibrated.toml").unwrap().1;
    assert_eq!(Robot::from_text("calibrated.toml", text, None, None).unwrap().laws, again.robot.laws);
}

/// A link that twists with the product of two angles, 600 µrad/rad².
fn twisted(built: &Robot, q: &[f64], _: usize) -> Vector3<f64> {
    let mut there = built.clone();
    there.joints[2].link.alpha += 600e-6 * q[0] * q[4];
    there.flange_at(q).point(&TOOL)
}

static TWISTED: LazyLock<Campaign> = LazyLock::new(|| tracked(7, MANY, &twisted));
static FOUND_TWISTED: LazyLock<CalibrationDiagnosis> = LazyLock::new(|| diagnosed(&TWISTED));

#[test]
fn a_link_that_twists_is_written_and_read() {
    assert_settled(&FOUND_TWISTED, LawPlace::Link(2), Some(0), JointLawVariable::Angle(4));
}

/// A hose that turns joint 4 from one configuration of two others on.
#[test]
fn a_hose_that_gets_taut_is_written_and_read() {
    let taut = |built: &Robot, q: &[f64], _: usize| {
        let mut there = q.to_vec();
        there[3] += 1500e-6 * (q[1] + q[2] - 0.2).max(0.0);
        built.flange_at(&there).point(&TOOL)
    };
    let campaign = tracked(8, FEW, &taut);
    assert_settled(&diagnosed(&campaign), LawPlace::Joint(3), None, JointLawVariable::Sum(1));
}

/// A tool that lies on the side of its mount to which gravity pulls it, 200 µm apart.
#[test]
fn a_loose_tool_is_written_and_read() {
    let loose = |built: &Robot, q: &[f64], _: usize| {
        let flange = built.flange_at(q);
        flange.point(&(TOOL + Vector3::x() * (100e-6 * -flange.rotation.column(0).z.signum())))
    };
    let campaign = tracked(9, MANY, &loose);
    assert_settled(&diagnosed(&campaign), LawPlace::Tool, None, JointLawVariable::Weight(0));
}

/// What comes and goes as time goes on is this recording's: no robot gets it.
#[test]
fn a_wave_in_time_leaves_the_measurements_alone() {
    let wave = |built: &Robot, q: &[f64], k: usize| {
        let by = Vector3::new(0.1e-3, 0.15e-3, 0.0) * (TAU * k as f64 / 13.0).sin();
        built.flange_at(q).point(&TOOL) + by
    };
    let mut campaign = tracked(10, FEW, &wave);
    // the wave of the validation's poses is theirs
    campaign.validation = None;
    let found = diagnosed(&campaign);
    let law = found.law.as_ref().unwrap().law.as_ref().unwrap();
    assert_eq!(law.form, Form::Harmonic);
    let json = report::diagnosis::calibration::json(&found);
    assert_eq!(json["law"]["written_to"], "measurements");
    let section = section(&found);
    assert!(
        section.contains("no file gets it: its number of poses before is known in this recording only"),
        "{section}"
    );
    let applied = apply(&found, &names("builtin:tx90", None), &[]).unwrap().unwrap();
    assert!(applied.entered.is_empty() && applied.left_out.is_empty(), "{applied:?}");
    assert_eq!(
        applied.removed,
        [
            "law of the displacement of the base over the number of poses before, which this recording alone has"
        ]
    );
    let again = written(&applied, "");
    assert!(again.robot.laws.is_empty());
    let second = diagnosed(&again);
    assert!(second.diagnosis.discrepancy.is_none() && second.diagnosis.findings.is_empty());
}

/// The section of the law as a reader has it, lines as long as they are.
fn section(found: &CalibrationDiagnosis) -> String {
    let report = report::diagnosis::calibration::report(found);
    let section = report.sections.into_iter().find(|section| section.heading == "A law for it").unwrap();
    let words = |block: &Block| match block {
        Block::List(points) => points.join("\n"),
        Block::Paragraph(words) => words.clone(),
        Block::Table(table) => table.rows.iter().map(|row| row.join(" | ")).collect::<Vec<_>>().join("\n"),
        Block::Figure(figure) => figure.caption.clone(),
        other => unreachable!("{other:?}"),
    };
    section.blocks.iter().map(words).collect::<Vec<_>>().join("\n\n")
}

/// Keys, units and what a reader reads of a robot's law.
#[test]
fn a_law_of_a_robot_is_said_with_its_units() {
    let found = &*FOUND_TWISTED;
    let law = &report::diagnosis::calibration::json(found)["law"];
    for (key, value) in [
        ("proposed", Value::from(true)),
        ("location", "link 3".into()),
        ("form", "straight line".into()),
        ("memory", "none".into()),
        ("written_to", "robot".into()),
    ] {
        assert_eq!(law[key], value, "{key}: {law}");
    }
    let quantity = |key: &str| ["symbol", "name", "unit"].map(|part| law[key][part].as_str().unwrap());
    assert_eq!(quantity("changes"), ["Δφ/q'", "turn of link 3 per radian of joint 1", "µrad/rad"]);
    assert_eq!(quantity("variable"), ["q", "angle of joint 5", "°"]);
    assert_eq!(law["expression"]["text"], "Δφ/q' = c1·q");
    assert_eq!(law["expression"]["latex"], r"\Delta \varphi/q^{\prime} = c_1 q");
    // about the link's x alone: 600 µrad/rad² are 10.5 µrad/rad for each degree
    let constants = law["constants"].as_array().unwrap();
    let symbols: Vec<&str> = constants.iter().map(|own| own["symbol"].as_str().unwrap()).collect();
    assert_eq!(symbols, ["c1_x", "c1_y", "c1_z"]);
    for (own, truth) in constants.iter().zip([600.0f64.to_radians(), 0.0, 0.0]) {
        let [low, value, high] = ["lo", "value", "hi"].map(|key| own[key].as_f64().unwrap());
        assert_eq!(own["unit"], "µrad/rad/°");
        assert!(low < truth && truth < high && high - low < 2.0 && low <= value && value <= high, "{own}");
    }
    let number = |key: &str| law[key].as_f64().unwrap_or_else(|| panic!("{key}: {law}"));
    let range = law["range"].as_array().unwrap();
    assert!(range[0].as_f64().unwrap() < -95.0 && range[1].as_f64().unwrap() > 95.0, "{law}");
    assert!(number("heldout_with_um") < 1.2 * NOISE / 1e-6, "{law}");
    assert!(number("heldout_without_um") > 1.5 * number("heldout_with_um"), "{law}");
    assert!(
        number("log_odds") > 10.0 && number("log_odds_over_curve") > 0.0 && number("explains_rms_um") > 20.0
    );
    // a straight line goes on as it is, and nothing else would do
    assert!(law["rivals"].as_array().unwrap().is_empty() && law["beyond"].is_null(), "{law}");
    assert!(law["refused"].is_null() && law["place"]["key"] == "link 3", "{law}");
    insta::with_settings!({ snapshot_path => "../snapshots", prepend_module_to_snapshot => false, omit_expression => true }, {
        insta::assert_snapshot!("law-of-a-robot", section(found));
    });
}

/// Both a link that twists and a loose tool: both are proposed together, and written together.
#[test]
fn two_laws_are_proposed_together() {
    let both = |built: &Robot, q: &[f64], k: usize| {
        let flange = built.flange_at(q);
        let loose = flange.rotation * Vector3::x() * (100e-6 * -flange.rotation.column(0).z.signum());
        twisted(built, q, k) + loose
    };
    let campaign = tracked(11, FEW, &both);
    let found = diagnosed(&campaign);
    let law = found.law.as_ref().unwrap().law.as_ref().unwrap();
    let second = law.second.as_ref().unwrap();
    assert!(law.more.is_none() && second.held_out.1 < 0.95 * second.held_out.0, "{:?}", second.held_out);
    assert!(section(&found).contains("Beside it a second law is proposed: "), "{}", section(&found));
    let json = report::diagnosis::calibration::json(&found);
    assert!(json["law"]["second"]["expression"]["text"].is_string(), "{}", json["law"]);
    let last = written(&applied(&found), "");
    let mut laws: Vec<(LawPlace, JointLawVariable)> =
        last.robot.laws.iter().map(|law| (law.place, law.variable)).collect();
    laws.sort_by_key(|(place, _)| *place == LawPlace::Tool);
    let truth =
        [(LawPlace::Link(2), JointLawVariable::Angle(4)), (LawPlace::Tool, JointLawVariable::Weight(0))];
    assert_eq!(laws, truth);
    // what is written carries how well it is known, and predict says so
    let q = vec![0.4; last.robot.joints.len()];
    let predicted = last.robot.predicted_at(Vector3::zeros(), &q);
    let of_laws = &predicted.law_slopes * last.robot.law_covariance() * predicted.law_slopes.transpose();
    let sd = of_laws.diagonal().sum().sqrt();
    assert!(1e-8 < sd && sd < 50e-6, "{sd}");
    assert!(diagnosed(&last).diagnosis.discrepancy.is_none());
}
