//! `simulate`, `calibrate` and `compare` as they are typed: promised keys, files, refusals, the
//! same bytes.

use serde_json::Value;

use super::{Answer, Sandbox};

/// A small campaign in `sim/`: 8 poses on each clamp, 20 of validation.
fn sandbox() -> Sandbox {
    let sandbox = Sandbox::new();
    sandbox
        .run("simulate sim --rod rods/5.toml --robot robots/tx90.toml --poses 8 --validation 20 --seed 3")
        .succeeded();
    sandbox
}

fn number(value: &Value) -> f64 {
    value.as_f64().unwrap_or_else(|| panic!("{value} is no number"))
}

/// What the interface promises of one calibration.
fn assert_calibration(json: &Value, mode: &str) {
    assert_eq!(json["mode"], mode);
    let parameters = json["parameters"].as_array().unwrap();
    assert_eq!(parameters.len(), 32, "the paper's ρ");
    for parameter in parameters {
        assert!(parameter["name"].is_string() && parameter["unit"].is_string(), "{parameter}");
        assert!(parameter["identifiable"].is_boolean(), "{parameter}");
        assert!(number(&parameter["value"]).is_finite());
        assert!(parameter["std_error"].is_null() || number(&parameter["std_error"]) > 0.0, "{parameter}");
    }
    for key in ["rms_um", "mean_um", "max_um"] {
        assert!(number(&json["residual"][key]) > 0.0, "residual {key}");
    }
    for key in ["mean_um", "max_um", "median_um", "sd_um"] {
        assert!(number(&json["validation"][key]) > 0.0, "validation {key}");
    }
}

#[test]
fn calibrate_gives_the_promised_json_in_every_mode() {
    let sandbox = sandbox();
    for mode in ["none", "calc", "fea", "meas"] {
        let json = sandbox.run(&format!("calibrate sim/campaign.toml --mode {mode} --json")).json();
        assert_calibration(&json, mode);
        assert_eq!(json["converged"], true);
    }
    // with rig readings the default is what they say
    assert_calibration(&sandbox.run("calibrate sim/campaign.toml --json").json(), "meas");
    let campaign = sandbox.read("sim/campaign.toml");
    let without = |keys: &[&str]| -> String {
        let kept = |line: &&str| !keys.iter().any(|key| line.starts_with(key));
        campaign.lines().filter(kept).map(|line| format!("{line}\n")).collect()
    };
    sandbox.write("sim/norig.toml", &without(&["rig"]));
    assert_calibration(&sandbox.run("calibrate sim/norig.toml --json").json(), "fea");
    sandbox.write("sim/norod.toml", &without(&["rig", "rod =", "contact_force_n", "validation"]));
    let json = sandbox.run("calibrate sim/norod.toml --json").json();
    assert_eq!((&json["mode"], &json["validation"]), (&"none".into(), &Value::Null));
}

#[test]
fn a_calibration_gets_near_the_truth_and_writes_the_robot() {
    let sandbox = sandbox();
    let truth = sandbox
        .run("simulate again --rod rods/5.toml --robot robots/tx90.toml --poses 8 --validation 20 --seed 3 --json")
        .json();
    assert_eq!(sandbox.read("sim/measurements.csv"), sandbox.read("again/measurements.csv"));
    let json = sandbox.run("calibrate sim/campaign.toml --folds 4 --out out --json").json();
    let mut within = 0;
    for parameter in json["parameters"].as_array().unwrap() {
        let name = &parameter["name"];
        let exact = truth["truth"].as_array().unwrap().iter().find(|p| p["name"] == *name).unwrap();
        let off = (number(&parameter["value"]) - number(&exact["value"])).abs();
        within += usize::from(off < 4.0 * number(&parameter["std_error"]));
    }
    // turns of the base are told from the first guess, as the truth is
    assert!(within >= 31, "{within} of 32 within four standard errors");
    // what is held out is predicted a little worse than what is fitted, not much
    let (residual, held_out) = (&json["residual"]["rms_um"], &json["cross_validation"]["rms_um"]);
    let ratio = number(held_out) / number(residual);
    assert!((1.0..4.0).contains(&ratio), "held out over fitted: {ratio}");

    // the robot that was written is the robot that was found, and a campaign may begin with it
    assert!(sandbox.read("out/calibrated.toml").starts_with("# TX90, calibrated by rodcal"));
    let campaign = sandbox.read("sim/campaign.toml").replace("robot.toml", "../out/calibrated.toml");
    sandbox.write("sim/second.toml", &campaign);
    let second = sandbox.run("calibrate sim/second.toml --json").json();
    for parameter in second["parameters"].as_array().unwrap() {
        let name = parameter["name"].as_str().unwrap();
        if !name.starts_with("base") && !name.starts_with("tool") {
            let moved = number(&parameter["correction"]).abs();
            // the robot as found is the drawing now, which draws a little
            assert!(moved < 0.1 * number(&parameter["std_error"]), "{name} moves by {moved}");
        }
    }
    for file in ["out/index.html", "out/table-3-parameters.csv", "out/figure-1-error-distribution.svg"] {
        assert!(!sandbox.read(file).is_empty());
    }
}

#[test]
fn compare_has_every_mode_and_a_verdict() {
    let sandbox = sandbox();
    let json = sandbox.run("compare sim/campaign.toml --draws 50 --json").json();
    let modes = json["modes"].as_array().unwrap();
    assert_eq!(modes.len(), 4);
    for (mode, name) in modes.iter().zip(["none", "calc", "fea", "meas"]) {
        assert_calibration(mode, name);
        let interval = &mode["mean_error_interval_um"];
        let mean = number(&mode["mean_error_um"]);
        assert!(number(&interval[0]) <= mean && mean <= number(&interval[1]), "{mode}");
    }
    assert_eq!(json["differences"].as_array().unwrap().len(), 6);
    assert!(json["verdict"].as_str().unwrap().contains("none"));
}

#[test]
fn the_bytes_do_not_depend_on_the_number_of_threads() {
    let sandbox = sandbox();
    let with_threads = |threads: &str| {
        let words = ["compare", "sim/campaign.toml", "--draws", "50", "--json"];
        sandbox.command(&words).env("RAYON_NUM_THREADS", threads).output().unwrap().stdout
    };
    let one = with_threads("1");
    assert!(!one.is_empty());
    assert!(one == with_threads("2"), "one and two threads differ");
}

/// What is typed, how the error begins, and a word that tells what would be right.
const REFUSED: [(&str, &str, &str); 9] = [
    ("calibrate nowhere.toml", "cannot read nowhere.toml: ", "No such file"),
    ("calibrate sim/campaign.toml --mode wild", "invalid value 'wild'", "none, calc, fea, meas"),
    ("calibrate sim/campaign.toml --folds 1", "invalid value '1'", "2..=1000"),
    ("compare sim/campaign.toml --draws 3", "invalid value '3'", "from 50 to 100000"),
    ("calibrate sim/norig.toml --mode meas", "mode meas for sim/norig.toml is not possible", "rig = "),
    ("calibrate sim/few.toml", "sim/few.csv: 3 poses for 32 unknown numbers", "at least 11"),
    ("calibrate sim/radio.toml", "sim/radio.toml:", "unknown key"),
    ("simulate new --rod nowhere.toml", "cannot read nowhere.toml", "No such file"),
    ("simulate new --rod rods/5.toml --robot builtin:puma", "`--robot` is builtin:puma", "builtin:tx90"),
];

#[test]
fn what_cannot_be_done_is_one_error_and_leaves_no_trace() {
    let sandbox = sandbox();
    let campaign = sandbox.read("sim/campaign.toml");
    let measurements = sandbox.read("sim/measurements.csv");
    sandbox.write("sim/norig.toml", &campaign.replace("rig = ", "# rig = "));
    let few: Vec<&str> = measurements.lines().take(5).collect();
    sandbox.write("sim/few.csv", &few.join("\n"));
    sandbox.write("sim/few.toml", &campaign.replace("measurements.csv", "few.csv"));
    sandbox.write("sim/radio.toml", &campaign.replace("measurements =", "wave = 1\nmeasurements ="));
    let before = sandbox.listing();
    for (line, begins, tells) in REFUSED {
        for more in ["", " --json"] {
            let Answer { status, stdout, stderr, .. } = sandbox.run(&format!("{line}{more}"));
            assert_eq!(status, Some(2), "{line}\n{stderr}");
            assert_eq!(stdout, "", "{line}");
            let error = stderr.lines().find(|said| said.starts_with("error: ")).unwrap_or_default();
            assert!(error.starts_with(&format!("error: {begins}")), "{line}\n{stderr}");
            assert!(stderr.contains(tells), "{line}\n{stderr}");
        }
    }
    assert!(before == sandbox.listing(), "something was written");
}

/// The verdict stands on poses that the calibration has not seen, and says so where there are none.
#[test]
fn accuracy_is_judged_where_the_campaign_states_limits() {
    let sandbox = sandbox();
    let campaign = sandbox.read("sim/campaign.toml");
    let judged = |limits: &str, text: &str| {
        sandbox.write("sim/limited.toml", &format!("{text}\n{limits}"));
        let json = sandbox.run("calibrate sim/limited.toml --mode fea --json").json();
        let accuracy = json["accuracy"].clone();
        (accuracy["verdict"].as_str().unwrap().to_owned(), accuracy)
    };
    assert_eq!(judged("", &campaign).0, "not_evaluated");
    let (verdict, accuracy) = judged("[accuracy]\nmean_um = 5000\nmax_um = 9000\n", &campaign);
    assert_eq!((&verdict[..], &accuracy["judged_by"]), ("pass", &"validation".into()));
    assert!(
        number(&accuracy["mean_um"]) < 5000.0 && number(&accuracy["limit_max_um"]) == 9000.0,
        "{accuracy}"
    );
    assert_eq!(judged("[accuracy]\nmax_um = 1\n", &campaign).0, "fail");
    // the terminal says so too
    let said = sandbox.run("calibrate sim/limited.toml --mode fea").stdout;
    let said = said.split_whitespace().collect::<Vec<_>>().join(" ");
    assert!(said.contains("Accuracy at the validation poses: FAIL, largest "), "{said}");
    assert!(said.contains(" µm, asked at most 1.00 µm."), "{said}");
    // never by the poses of the fit
    let unseen =
        campaign.lines().filter(|line| !line.starts_with("validation")).collect::<Vec<_>>().join("\n");
    let (verdict, accuracy) = judged("[accuracy]\nmean_um = 5000\n", &unseen);
    assert_eq!((&verdict[..], &accuracy["judged_by"]), ("not_evaluated", &Value::Null));
    sandbox.write("sim/limited.toml", &format!("{campaign}\n[accuracy]\nmean_um = -3\n"));
    let refused = sandbox.run("calibrate sim/limited.toml");
    assert_eq!(refused.status, Some(2));
    assert!(
        refused.stderr.contains("accuracy.mean_um") && refused.stderr.contains("-3"),
        "{}",
        refused.stderr
    );
}

/// A report says how it was made, so that it can be made again.
#[test]
fn a_report_names_its_command_and_the_content_of_its_files() {
    let sandbox = sandbox();
    sandbox.run("calibrate sim/campaign.toml --mode fea --out made").succeeded();
    let json: Value = serde_json::from_str(&sandbox.read("made/result.json")).unwrap();
    let provenance = &json["provenance"];
    assert_eq!(provenance["command"], "rodcal calibrate sim/campaign.toml --mode fea");
    let inputs = provenance["inputs"].as_array().unwrap();
    let named: Vec<&str> = inputs.iter().filter_map(|input| input["file"].as_str()).collect();
    assert!(named.contains(&"sim/campaign.toml") && named.contains(&"sim/measurements.csv"), "{named:?}");
    assert!(inputs.iter().all(|input| input["sha256"].as_str().unwrap().len() == 64), "{provenance}");
    let page = sandbox.read("made/index.html");
    assert!(page.contains("rodcal calibrate sim/campaign.toml --mode fea"));
    // a seed that nobody stated too
    sandbox.run("compare sim/campaign.toml --draws 50 --out drawn").succeeded();
    assert!(sandbox.read("drawn/index.html").contains("<dt>seed</dt><dd>1</dd>"));
    let json: Value = serde_json::from_str(&sandbox.read("drawn/result.json")).unwrap();
    assert_eq!((&json["provenance"]["seed"], &provenance["seed"]), (&1.into(), &Value::Null));
}
