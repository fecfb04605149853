//! Poor readings: what they cannot say is said, and nothing breaks.

use rodcal::diagnosis::Limitation;
use rodcal::rig::readings::{Axis, Readings};
use rodcal::units::UM;
use rodcal_trial::rig::{CaseSpec, Columns, Effect};
use serde_json::Value;

use super::{Answer, interval};

const ROD: &str = include_str!("../../rods/5.toml");
const LOAD_CELL: &str = include_str!("../../stiffness_data/nist-load-cell.csv");

const BARE: Columns =
    Columns { trial: false, phase: false, time: false, temperature: false, kilograms: false };

fn reason<'a>(answer: &'a Answer, effect: &str) -> &'a str {
    let reason = answer.found.not_testable.iter().find(|not| not.effect.name == effect);
    &reason.unwrap_or_else(|| panic!("{effect} is testable: {:?}", answer.found.not_testable)).reason
}

/// A diagnosis of anything: numbers that must be there are finite, and findings are whole.
fn assert_whole(answer: &Answer, what: &str) {
    for key in ["noise_um", "rms_before_um", "rms_after_um", "noise_shared_ratio", "residual_sd_um"] {
        // JSON has no NaN: it would be null
        assert!(answer.json[key].is_number(), "{what}: {key} is {}", answer.json[key]);
    }
    for finding in answer.findings() {
        assert!(
            finding["explains_rms_um"].is_number() && finding["p_value"].is_number(),
            "{what}: {finding}"
        );
        for parameter in finding["parameters"].as_array().unwrap() {
            for key in ["lo", "value", "hi"] {
                assert!(parameter[key].is_number(), "{what}: {finding}");
            }
        }
    }
    for ranked in answer.json["ranking"].as_array().unwrap() {
        assert!(ranked["log_odds"].is_number(), "{what}: {ranked}");
    }
}

#[test]
fn one_axis_is_said_to_tell_little() {
    let spec = CaseSpec { axes: vec![1], ..CaseSpec::default() };
    let answer = Answer::simulated(&spec, &[], 3);
    assert!(answer.found.limits.contains(&Limitation::OneAxis(Axis::Y)), "{:?}", answer.found.limits);
}

/// A clamp that takes up load beyond 9 N, at four loads: a parabola fits them all, and predicts
/// none that it has not seen.
#[test]
fn what_only_describes_is_confirmed_only_in_part() {
    let mut readings = "trial,axis,load_n,dz_um\n".to_owned();
    for (trial, at_least) in [(1, "20"), (2, "21")] {
        readings += &format!("{trial},z,3.75,{at_least}\n{trial},z,7.5,40\n");
        readings += &format!("{trial},z,11.25,{}\n{trial},z,15,70\n", 59 - trial);
    }
    let answer = Answer::of(Some(include_str!("../../rods/2.toml")), &readings);
    assert_eq!(answer.effects(), ["nonlinear_stiffness"]);
    let number = |key: &str| answer.json[key].as_f64().unwrap();
    assert!(number("heldout_after_um") > 2.0 * number("rms_after_um"));
    let said = answer.json["headline"].as_str().unwrap();
    assert!(said.contains("times the residual of the fit") && said.contains("confirm it only in part"));
    // what other readings confirm is said without
    let clear = Answer::simulated(&CaseSpec::default(), &[Effect::StiffnessScale(0.9)], 3);
    assert!(!clear.json["headline"].as_str().unwrap().contains("in part"));
}

#[test]
fn without_repeats_every_claim_is_weaker() {
    let spec = CaseSpec { trials: 1, ..CaseSpec::default() };
    let answer = Answer::simulated(&spec, &[Effect::StiffnessScale(0.9)], 3);
    assert!(answer.found.limits.contains(&Limitation::NoRepeats), "{:?}", answer.found.limits);
    assert_eq!(answer.effects(), ["stiffness_scale"]);
    assert!(answer.json["lack_of_fit_before"].is_null());
}

#[test]
fn what_has_no_column_is_not_testable() {
    let spec = CaseSpec { unloading: false, columns: BARE, ..CaseSpec::default() };
    let answer = Answer::simulated(&spec, &[], 3);
    assert!(reason(&answer, "creep").contains("time_s"));
    assert!(reason(&answer, "hysteresis").contains("phase"));
    assert!(reason(&answer, "thermal_drift").contains("temperature_c"));
    assert!(reason(&answer, "bend_flexibility").contains("sharp"));
    // the NIST load cell is no rod
    assert!(reason(&Answer::of(None, LOAD_CELL), "shear_modulus").contains("needs a rod file"));
}

#[test]
fn what_does_not_vary_tells_nothing() {
    let mut text = "axis,load_n,trial,phase,time_s,temperature_c,dy_um\n".to_owned();
    for trial in 1..=3 {
        for (k, load) in [5.0, 10.0, 15.0].into_iter().enumerate() {
            let scatter = [0.3, -0.4, 0.2, 0.1, -0.3][(3 * trial + k) % 5];
            text += &format!("y,{load},{trial},load,100,20,{:.1}\n", 101.7 * load + scatter);
        }
    }
    let answer = Answer::of(Some(ROD), &text);
    assert_whole(&answer, "constant");
    assert!(reason(&answer, "creep").contains("do not differ"));
    assert!(reason(&answer, "thermal_drift").contains("do not differ"));
    let named: Vec<&Value> =
        answer.json["locate"].as_array().unwrap().iter().map(|l| &l["covariate"]).collect();
    assert!(
        !named.iter().any(|name| *name == "time" || *name == "temperature" || *name == "phase"),
        "{named:?}"
    );
}

#[test]
fn certified_figures_of_the_nist_load_cell() {
    let answer = Answer::of(None, LOAD_CELL);
    assert_eq!(answer.effects(), ["nonlinear_stiffness"]);
    assert_eq!(answer.class(0), ["nonlinear_stiffness"]);
    assert!(answer.json["unexplained"].is_null());
    // certified: residual standard deviation of the quadratic, inches
    let certified = 0.205177424076185E-03 * 25_400.0;
    let noise = answer.json["noise_um"].as_f64().unwrap();
    assert!((noise / certified - 1.0).abs() < 1e-3, "{noise} instead of {certified}");
    // certified: B2/B1 per lbf
    let per_n = -0.316081871345029E-14 / 0.732059160401003E-06 / 4.448_221_615_260_5;
    let [low, value, high] = interval(&answer.findings()[0], "per_n");
    assert!(
        (value / per_n - 1.0).abs() < 0.02 && low < per_n && per_n < high,
        "{low} … {value} … {high}, {per_n}"
    );
}

/// Any line with friction and unloading, without a rod.
#[test]
fn friction_of_a_line() {
    let friction = Effect::Friction { axis: None, force: 1.0, presliding: 0.5 * UM, scatter: 0.0 };
    let spec = CaseSpec { axes: vec![1], all_channels: false, ..CaseSpec::default() };
    let case = spec.simulated(&[friction], 9);
    let answer = Answer::of(None, &case.readings);
    assert_eq!(answer.effects(), ["friction"], "{}", answer.json["headline"]);
    let [_, force, _] = interval(&answer.findings()[0], "force_n");
    assert!((force - 1.0).abs() < 0.03, "{force}");
}

#[test]
fn hardly_any_readings_are_no_reason_to_break() {
    let header = "axis,load_n,dy_um\n";
    let same = "y,5,500\n".repeat(12);
    let exact: String = (1..=12).map(|k| format!("y,{k},{}\n", 124.0 * f64::from(k))).collect();
    let files = [
        ("one reading", "y,5,500\n".to_owned()),
        ("one reading of nothing", "y,5,0\n".to_owned()),
        ("no load at all", "y,0,1\ny,0,2\ny,0,-1\n".to_owned()),
        ("two readings", "y,5,500\ny,10,1300\n".to_owned()),
        ("two readings of one load", "y,5,500\ny,5,501\n".to_owned()),
        ("two axes, one reading each", "y,5,500\nx,5,3\n".to_owned()),
        ("three readings", "y,5,500\ny,10,1300\ny,15,1800\n".to_owned()),
        ("all zero", "y,5,0\ny,10,0\ny,15,0\ny,5,0\ny,10,0\ny,15,0\n".to_owned()),
        ("all the same", same),
        ("no noise", exact),
        ("huge", "y,5,1e12\ny,10,2e12\ny,15,3e12\ny,5,1e12\ny,10,2.1e12\n".to_owned()),
        ("huge loads", "y,5e9,10\ny,1e10,20\ny,1.5e10,30\ny,5e9,11\n".to_owned()),
        ("tiny", "y,5,1e-9\ny,10,2e-9\ny,15,3e-9\ny,5,1e-9\n".to_owned()),
        ("tiny loads", "y,1e-9,10\ny,2e-9,20\ny,3e-9,30\ny,1e-9,11\n".to_owned()),
        ("far apart", "y,1e-6,1e-6\ny,1e6,1e9\ny,5,600\ny,10,1200\n".to_owned()),
        ("wrong sign", "y,5,-500\ny,10,-1000\ny,15,-1500\ny,5,-501\n".to_owned()),
    ];
    for (what, rows) in files {
        let text = format!("{header}{rows}");
        // what the reader of readings refuses has an error of its own
        if Readings::from_text("readings.csv", &text).is_ok() {
            for rod in [Some(ROD), None] {
                assert_whole(&Answer::of(rod, &text), what);
            }
        }
    }
}

#[test]
fn fewer_readings_than_folds_need_are_said_to_be_few() {
    let answer = Answer::of(Some(ROD), "axis,load_n,dy_um\ny,5,620\ny,10,1240\n");
    let limits = &answer.found.limits;
    assert!(limits.contains(&Limitation::NoRepeats), "{limits:?}");
    assert!(limits.contains(&Limitation::FewReadings(2)), "{limits:?}");
}
