//! `diagnose rig`: what it promises to scripts, and that it finds what is known to be there.

use approx::assert_relative_eq;
use serde_json::Value;

use super::Sandbox;

const ROD: &str = "diagnose rig rods/5.toml stiffness_data/5.csv";
const LOAD_CELL: &str = "diagnose rig linear stiffness_data/nist-load-cell.csv";

fn effects(json: &Value) -> Vec<&str> {
    json["findings"].as_array().unwrap().iter().map(|finding| finding["effect"].as_str().unwrap()).collect()
}

#[test]
fn the_json_has_its_keys() {
    let sandbox = Sandbox::new();
    for line in [ROD, LOAD_CELL] {
        let answer = sandbox.run(&format!("{line} --json"));
        assert_eq!(answer.status, Some(1), "{line}");
        let json = answer.json();
        assert_eq!(json["verdict"], "mismatch");
        for key in [
            "noise_um",
            "rms_before_um",
            "rms_after_um",
            "heldout_before_um",
            "heldout_after_um",
            "heldout_gain",
        ] {
            assert!(json[key].is_number(), "{line}: {key}");
        }
        for key in ["heldout_gain_95", "locate", "ranking", "not_testable", "warnings"] {
            assert!(json[key].is_array(), "{line}: {key}");
        }
        for key in ["unexplained", "law"] {
            assert!(json.as_object().unwrap().contains_key(key), "{line}: {key}");
        }
        for finding in json["findings"].as_array().unwrap() {
            for key in ["effect", "location"] {
                assert!(finding[key].is_string(), "{line}: {key}");
            }
            for key in ["p_value", "heldout_gain", "explains_rms_um"] {
                assert!(finding[key].is_number(), "{line}: {key}");
            }
            for key in ["indistinguishable_from", "rivals", "places"] {
                assert!(finding[key].is_array(), "{line}: {key}");
            }
            assert!(finding.as_object().unwrap().contains_key("next_measurement"));
            for parameter in finding["parameters"].as_array().unwrap() {
                let [low, value, high] = ["lo", "value", "hi"].map(|key| parameter[key].as_f64().unwrap());
                assert!(low <= value && value <= high && parameter["name"].is_string(), "{parameter}");
            }
        }
    }
}

/// An effect of one's own competes with the library's: friction of the same recording keeps its
/// name. A fault in the file has its place.
#[test]
fn effects_of_ones_own_are_read_and_refused() {
    let sandbox = Sandbox::new();
    let text = "[[effect]]\nname = \"foot\"\nwords = \"a foot\"\nplace = \"clamp\"\nvariable = \"load\"\n\
                law = \"a*tanh(F/3)\"\nparameter = [{ name = \"a\", size = 20 }]\n";
    std::fs::write(sandbox.path().join("mine.toml"), text).unwrap();
    let json = sandbox.run(&format!("{ROD} --effects mine.toml --json")).json();
    assert_eq!(effects(&json)[0], "friction");
    assert!(json["ranking"].as_array().unwrap().iter().any(|ranked| ranked["effect"] == "foot"));
    std::fs::write(sandbox.path().join("mine.toml"), text.replace("tanh(", "tang(")).unwrap();
    let answer = sandbox.run(&format!("{ROD} --effects mine.toml"));
    assert_eq!(answer.status, Some(2));
    assert!(answer.stderr.contains("mine.toml:6:10: \"tang\" in the formula"), "{}", answer.stderr);
}

/// Friction by itself cannot be told from a tare, for nothing was read while unloading.
#[test]
fn friction_of_the_paper_rig_is_found_with_its_rival() {
    let json = Sandbox::new().run(&format!("{ROD} --json")).json();
    let friction = &json["findings"][0];
    assert_eq!(friction["effect"], "friction");
    assert_eq!(friction["indistinguishable_from"], serde_json::json!(["load_offset"]));
    let force = &friction["parameters"][0];
    assert_eq!(force["name"], "force_n");
    // made with 0.09 kg
    let [low, high] = ["lo", "hi"].map(|key| force[key].as_f64().unwrap());
    assert!(low < 0.8826 && 0.8826 < high, "{force}");
}

/// Certified residual standard deviation of the quadratic: NIST StRD, Pontius.
#[test]
fn the_load_cell_is_nonlinear_and_nothing_else() {
    const CERTIFIED_UM: f64 = 0.205177424076185E-03 * 25_400.0;
    let json = Sandbox::new().run(&format!("{LOAD_CELL} --json")).json();
    assert_eq!(effects(&json), ["nonlinear_stiffness"]);
    assert_eq!(json["findings"][0]["indistinguishable_from"], serde_json::json!([]));
    assert_eq!(json["unexplained"], Value::Null);
    assert_relative_eq!(json["noise_um"].as_f64().unwrap(), CERTIFIED_UM, max_relative = 1e-3);
}

/// Readings that the model itself predicts, with a scatter of ±1 µm.
#[test]
fn readings_of_the_model_are_consistent_and_end_with_status_0() {
    let sandbox = Sandbox::new();
    let compliance = sandbox.run("compliance rods/5.toml --json").json();
    let mut text = "axis,load_n,trial,dy_um,dz_um\n".to_owned();
    let mut seed = 7_u32;
    let mut scatter = || {
        let draw = |seed: &mut u32| {
            *seed = seed.wrapping_mul(1_664_525).wrapping_add(1_013_904_223);
            f64::from(*seed >> 8) / f64::from(1_u32 << 24) - 0.5
        };
        (0..4).map(|_| draw(&mut seed)).sum::<f64>()
    };
    for trial in 1..=4 {
        for (axis, k) in [("y", 1), ("z", 2)] {
            for load in [5.0, 10.0, 15.0, 20.0] {
                let mut cell =
                    |m: usize| compliance["cf_um_per_n"][m][k].as_f64().unwrap() * load + 1.7 * scatter();
                text += &format!("{axis},{load},{trial},{:.1},{:.1}\n", cell(1), cell(2));
            }
        }
    }
    sandbox.write("clean.csv", &text);
    let answer = sandbox.run("diagnose rig rods/5.toml clean.csv");
    assert_eq!(answer.status, Some(0), "{}", answer.stdout);
    assert!(
        answer.stdout.starts_with("The readings agree with the model: the residual, "),
        "{}",
        answer.stdout
    );
    let json = sandbox.run("diagnose rig rods/5.toml clean.csv --json").json();
    assert_eq!(json["verdict"], "consistent");
    assert_eq!(effects(&json), [""; 0]);
    let lone = sandbox.run("diagnose rig rods/5.toml clean.csv --apply");
    assert!(lone.warnings().iter().any(|warning| warning.contains("nothing was found")));
}

#[test]
fn apply_writes_the_rod_and_the_readings() {
    let sandbox = Sandbox::new();
    let json = sandbox.run(&format!("{ROD} --apply --json")).json();
    assert_eq!(json["applied"], serde_json::json!(["5-diagnosed.toml", "5-diagnosed.csv"]));
    let files = sandbox.listing();
    for name in ["5-diagnosed.toml", "5-diagnosed.csv", "index.html"] {
        assert!(files.contains_key(&format!("reports/diagnosed/{name}")), "{name}");
    }
    sandbox.run(&format!("{ROD} --apply --out elsewhere")).succeeded();
    assert!(sandbox.listing().contains_key("elsewhere/5-diagnosed.toml"));
    let none = sandbox.run(&format!("{LOAD_CELL} --apply"));
    assert!(none.warnings().iter().any(|warning| warning.contains("without a rod file")));
}

/// What `--apply` writes is read by all commands that take a rod or readings, and is what the
/// readings say.
#[test]
fn what_apply_writes_is_a_rod_and_readings_like_others() {
    let sandbox = Sandbox::new();
    // 30 % softer than its file says, and 1 N of friction
    let compliance = sandbox.run("compliance rods/5.toml --json").json();
    let mut text = "axis,load_n,trial,phase,dy_um,dz_um\n".to_owned();
    for trial in 1..=3 {
        for (axis, k) in [("y", 1), ("z", 2)] {
            let up = [5.0, 10.0, 15.0].map(|load| (load, "load", -1.0));
            let down = [10.0, 5.0].map(|load| (load, "unload", 1.0));
            for (row, (load, phase, sign)) in up.into_iter().chain(down).enumerate() {
                let cell = |m: usize| {
                    let scatter =
                        [0.9, -1.3, 0.2, 1.4, -0.6, -0.4, 1.1][(5 * trial + 3 * row + 2 * k + m) % 7];
                    1.3 * compliance["cf_um_per_n"][m][k].as_f64().unwrap() * (load + sign) + scatter
                };
                text += &format!("{axis},{load},{trial},{phase},{:.1},{:.1}\n", cell(1), cell(2));
            }
        }
    }
    sandbox.write("soft.csv", &text);
    let json = sandbox.run("diagnose rig rods/5.toml soft.csv --apply --out out --json").json();
    let mut found = effects(&json);
    found.sort_unstable();
    assert_eq!(found, ["friction", "stiffness_scale"], "{}", json["headline"]);
    let before = compliance["cf_um_per_n"][1][1].as_f64().unwrap();
    let corrected = sandbox.run("compliance out/5-diagnosed.toml --json").json();
    assert_relative_eq!(corrected["cf_um_per_n"][1][1].as_f64().unwrap(), 1.3 * before, max_relative = 0.01);
    // friction is gone, and the model is right
    let fit = sandbox.run("rig fit out/5-diagnosed.toml out/soft-diagnosed.csv --json").json();
    assert_relative_eq!(fit["r_rod"].as_f64().unwrap(), 1.0, epsilon = 0.01);
    let again = sandbox.run("diagnose rig out/5-diagnosed.toml out/soft-diagnosed.csv");
    assert_eq!(again.status, Some(0), "{}", again.stdout);
    // a campaign with the files that were written
    let campaign = sandbox.read("campaigns/tx90-5/campaign.toml");
    let whole = campaign
        .replace("../../rods/5.toml", "../../out/5-diagnosed.toml")
        .replace("\"readings.csv\"", "\"../../out/soft-diagnosed.csv\"");
    assert!(whole.contains("5-diagnosed.toml") && whole.contains("soft-diagnosed.csv"), "{whole}");
    sandbox.write("campaigns/tx90-5/applied.toml", &whole);
    for mode in ["fea", "meas"] {
        let json =
            sandbox.run(&format!("calibrate campaigns/tx90-5/applied.toml --mode {mode} --json")).json();
        assert_eq!((&json["mode"], &json["converged"]), (&mode.into(), &true.into()));
    }
    let json = sandbox.run("compare campaigns/tx90-5/applied.toml --draws 50 --json").json();
    assert_eq!(json["modes"].as_array().unwrap().len(), 4);
}

#[test]
fn the_bytes_do_not_depend_on_the_number_of_threads() {
    let sandbox = Sandbox::new();
    let with_threads = |threads: &str| {
        let words = ["diagnose", "rig", "rods/5.toml", "stiffness_data/5.csv", "--json"];
        sandbox.command(&words).env("RAYON_NUM_THREADS", threads).output().unwrap().stdout
    };
    let one = with_threads("1");
    assert!(!one.is_empty());
    assert!(one == with_threads("2"), "one and two threads differ");
}
