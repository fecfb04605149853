//! `diagnose calibration` and `predict`: what they promise to scripts, and that what was put in is
//! found.

use serde_json::Value;

use super::Sandbox;

const CAMPAIGN: &str = "campaigns/tx90-5/campaign.toml";

/// The campaign with one pose 1.5 mm off.
fn disturbed() -> Sandbox {
    let sandbox = Sandbox::new();
    let file = "campaigns/tx90-5/measurements.csv";
    let text = sandbox.read(file);
    let header = text.lines().find(|line| !line.starts_with('#')).unwrap();
    let x = header.split(',').position(|name| name.trim() == "x_mm").unwrap();
    let first = text.lines().position(|line| line == header).unwrap() + 1;
    let moved = |(at, line): (usize, &str)| {
        let mut cells: Vec<String> = line.split(',').map(str::to_owned).collect();
        if at == first + 20 {
            cells[x] = format!("{}", cells[x].trim().parse::<f64>().unwrap() + 1.5);
        }
        cells.join(",")
    };
    let lines: Vec<String> = text.lines().enumerate().map(moved).collect();
    sandbox.write(file, &(lines.join("\n") + "\n"));
    sandbox
}

fn assert_keys(json: &Value) {
    for key in ["noise_um", "rms_before_um", "rms_after_um", "heldout_before_um", "heldout_after_um"] {
        assert!(json[key].is_number(), "{key}");
    }
    for key in ["findings", "locate", "ranking", "absorbed", "hidden", "not_testable", "warnings"] {
        assert!(json[key].is_array(), "{key}");
    }
    assert!(json.as_object().unwrap().contains_key("unexplained"));
    for finding in json["findings"].as_array().unwrap() {
        for key in ["effect", "location", "words"] {
            assert!(finding[key].is_string(), "{key}");
        }
        for key in ["p_value", "heldout_gain", "explains_rms_um"] {
            assert!(finding[key].is_number(), "{key}");
        }
        for key in ["indistinguishable_from", "places", "parts"] {
            assert!(finding[key].is_array(), "{key}");
        }
        for parameter in finding["parameters"].as_array().unwrap() {
            let [low, value, high] = ["lo", "value", "hi"].map(|key| parameter[key].as_f64().unwrap());
            assert!(low <= value && value <= high && parameter["name"].is_string(), "{parameter}");
        }
    }
}

#[test]
fn a_clean_campaign_is_consistent_and_ends_with_status_0() {
    let sandbox = Sandbox::new();
    let answer = sandbox.run(&format!("diagnose calibration {CAMPAIGN}"));
    assert_eq!(answer.status, Some(0), "{}", answer.stdout);
    assert!(answer.stdout.starts_with("The calibrated robot explains the poses: "), "{}", answer.stdout);
    let json = sandbox.run(&format!("diagnose calibration {CAMPAIGN} --json")).json();
    assert_eq!((&json["verdict"], &json["unexplained"]), (&"consistent".into(), &Value::Null));
    assert_eq!(json["findings"], serde_json::json!([]));
    assert_keys(&json);
}

#[test]
fn a_pose_that_was_misread_is_found_by_its_name_and_ends_with_status_1() {
    let sandbox = disturbed();
    let answer = sandbox.run(&format!("diagnose calibration {CAMPAIGN} --json --apply --out report"));
    assert_eq!(answer.status, Some(1), "{}", answer.stderr);
    let json = answer.json();
    // nothing of it belongs to the robot; the measured point is corrected
    assert_eq!(json["applied"]["entered"], serde_json::json!([]));
    assert!(json["applied"]["removed"][0].as_str().unwrap().contains("misreading"), "{}", json["applied"]);
    assert_eq!(json["findings"][0]["written_to"], "measurements");
    for file in ["campaign.toml", "measurements.csv", "5.toml", "calibrated.toml"] {
        assert!(sandbox.listing().contains_key(&format!("report/{file}")), "{file}");
    }
    assert_keys(&json);
    assert_eq!(json["verdict"], "mismatch");
    let finding = &json["findings"][0];
    assert_eq!(finding["effect"], "outlier");
    assert!(finding["location"].as_str().unwrap().starts_with("pose "), "{finding}");
    let dx = &finding["parameters"][0];
    assert_eq!(dx["name"], "dx_um");
    assert!(sandbox.listing().contains_key("report/index.html"));
}

#[test]
fn a_bad_campaign_cannot_be_diagnosed() {
    let sandbox = Sandbox::new();
    let answer = sandbox.run("diagnose calibration nowhere.toml");
    assert_eq!((answer.status, answer.stdout.as_str()), (Some(2), ""));
    assert!(answer.stderr.contains("nowhere.toml"), "{}", answer.stderr);
}

#[test]
fn tips_are_predicted_with_what_the_model_says_of_its_joints() {
    let sandbox = Sandbox::new();
    sandbox.write(
        "poses.csv",
        "pose,q1_deg,q2_deg,q3_deg,q4_deg,q5_deg,q6_deg\nhome,0,0,0,0,0,0\nout,90,30,45,0,60,0\n",
    );
    let nominal = sandbox.read("robots/tx90.toml");
    let extended = nominal.clone()
        + "\n[[effect]]\nname = \"transmission_error\"\njoint = 1\nangle_deg = [0, 90]\ncorrection_urad = [0, 1000]\n"
        + "\n[tip]\nxyz_mm = [0, 0, 0]\nsd_mm = 0.05\n";
    sandbox.write("extended.toml", &extended);
    let tips = |model: &str| {
        let json = sandbox.run(&format!("predict {model} poses.csv --json")).json();
        let poses = json["poses"].as_array().unwrap().clone();
        let tip = |pose: &Value| ["x_mm", "y_mm", "z_mm"].map(|key| pose[key].as_f64().unwrap());
        (poses.iter().map(tip).collect::<Vec<_>>(), poses[0]["sd_mm"].clone())
    };
    let ((before, none), (after, sd)) = (tips("robots/tx90.toml"), tips("extended.toml"));
    assert_eq!((none, sd), (Value::Null, serde_json::json!([0.05, 0.05, 0.05])));
    assert_eq!(before[0], after[0], "nothing is added at 0°");
    let [x, y, z] = before[1];
    // turned by 1 mrad about the vertical axis
    let turned = [x - 1e-3 * y, y + 1e-3 * x, z];
    for axis in 0..3 {
        assert!((after[1][axis] - turned[axis]).abs() < 1e-3, "{:?} instead of {turned:?}", after[1]);
    }
    let wrong = sandbox.run("predict robots/tx90.toml robots/tx90.toml");
    assert_eq!(wrong.status, Some(2));
}

/// What a user does in the end: diagnose, apply, calibrate and compare with the model that was
/// written, and predict with it.
#[test]
fn what_is_applied_makes_the_robot_as_accurate_as_promised() {
    const ERROR: &str = "\n[[effect]]\nname = \"transmission_error\"\njoint = 3\ncycles_per_rev = 11.4\nsin_urad = 250.0\ncos_urad = -120.0\n";
    let sandbox = Sandbox::new();
    let nominal = sandbox.read("robots/tx90.toml");
    sandbox.write("true.toml", &(nominal.clone() + ERROR));
    let made = sandbox.run("simulate made --rod rods/5.toml --robot true.toml --seed 3 --poses 16");
    assert_eq!(made.status, Some(0), "{}", made.stderr);
    sandbox.write("made/robot.toml", &nominal);
    let found = sandbox.run("diagnose calibration made/campaign.toml --apply --out out --json");
    assert_eq!(found.status, Some(1), "{}", found.stderr);
    let found = found.json();
    let finding = &found["findings"][0];
    assert_eq!((&finding["effect"], &finding["location"]), (&"transmission_error".into(), &"joint 3".into()));
    for (k, truth) in [(0, 11.4), (1, 250.0f64.hypot(120.0))] {
        let [low, high] = ["lo", "hi"].map(|key| finding["parameters"][k][key].as_f64().unwrap());
        assert!(low <= truth && truth <= high, "{truth} is not in {low} to {high}");
    }
    let errors = || {
        let json = sandbox.run("calibrate made/campaign.toml --json").json();
        ["residual", "validation"].map(|poses| json[poses]["mean_um"].as_f64().unwrap())
    };
    let before = errors();
    sandbox.write("made/robot.toml", &sandbox.read("out/calibrated.toml"));
    let after = errors();
    assert!(after[0] < 0.5 * before[0] && after[1] < 0.6 * before[1], "{before:?} {after:?}");
    let again = sandbox.run("diagnose calibration made/campaign.toml");
    assert_eq!(again.status, Some(0), "{}", again.stdout);
    assert_eq!(sandbox.run("compare made/campaign.toml --draws 50").status, Some(0));

    // near the poses that were measured the tip is as sure as they are, far away less
    let sds = |poses: &str| -> Vec<f64> {
        sandbox.write("poses.csv", &format!("pose,q1_deg,q2_deg,q3_deg,q4_deg,q5_deg,q6_deg\n{poses}"));
        let json = sandbox.run("predict out/calibrated.toml poses.csv --tool 0,0,250 --json").json();
        let of_pose =
            |pose: &Value| pose["sd_mm"].as_array().unwrap().iter().map(|sd| sd.as_f64().unwrap()).sum();
        json["poses"].as_array().unwrap().iter().map(of_pose).collect()
    };
    let text = sandbox.read("made/measurements.csv");
    let measured = text.lines().filter(|line| line.starts_with(char::is_numeric)).take(1);
    let near: String = measured
        .map(|l| {
            l.split(',')
                .enumerate()
                .filter(|(k, _)| *k != 1)
                .map(|(_, c)| c)
                .take(7)
                .collect::<Vec<_>>()
                .join(",")
        })
        .collect();
    let sds = sds(&format!("{near}\nfar,170,80,0,0,90,0\n"));
    let held_out = found["heldout_after_um"].as_f64().unwrap() / 1000.0;
    assert!(sds[0] >= 3.0 * held_out && sds[1] > 1.05 * sds[0], "{sds:?} {held_out}");
    assert_eq!(sandbox.run("predict out/calibrated.toml poses.csv --tool 0,250").status, Some(2));
}
