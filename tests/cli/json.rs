//! The promises of `--json`: keys, shapes and units, and the values of the library.

use std::f64::consts::PI;

use approx::assert_relative_eq;
use nalgebra::Matrix3;
use rodcal::beam::Physics;
use rodcal::compliance::{Compliance, closed_form, paper_contact_force};
use rodcal::rig::readings::Readings;
use rodcal::rig::{self, Options};
use rodcal::rod::Rod;
use serde_json::Value;

use super::Sandbox;

const UM: f64 = 1e-6;

/// A number, which null is not.
fn number(value: &Value) -> f64 {
    value.as_f64().unwrap_or_else(|| panic!("{value} is no number"))
}

/// Three rows of three numbers.
fn matrix(value: &Value) -> Matrix3<f64> {
    let rows =
        value.as_array().filter(|rows| rows.len() == 3).unwrap_or_else(|| panic!("{value} is not 3x3"));
    assert!(rows.iter().all(|row| row.as_array().is_some_and(|row| row.len() == 3)), "{value} is not 3x3");
    Matrix3::from_fn(|m, n| number(&value[m][n]))
}

fn assert_keys(value: &Value, keys: &[&str]) {
    for key in keys {
        assert!(value.get(key).is_some(), "`{key}` is missing in {value:#}");
    }
}

fn assert_compliance(json: &Value, expected: &Compliance) {
    assert_relative_eq!(matrix(&json["cf_um_per_n"]), expected.force / UM, max_relative = 1e-12);
    assert_relative_eq!(matrix(&json["cg_um_per_g"]), expected.gravity / UM, max_relative = 1e-12);
}

#[test]
fn compliance_in_every_mode_and_theory() {
    let sandbox = Sandbox::new();
    let rods: [(&str, &[&str]); 2] = [("2", &["fea"]), ("5", &["fea", "calc"])];
    for (name, modes) in rods {
        let file = format!("rods/{name}.toml");
        let rod = Rod::read(&sandbox.path().join(&file)).unwrap();
        for mode in modes {
            for (option, theory) in [
                ("", "timoshenko"),
                (" --theory timoshenko", "timoshenko"),
                (" --theory euler-bernoulli", "euler-bernoulli"),
                (" --elements 3", "timoshenko"),
                (" --contact-force 0", "timoshenko"),
            ] {
                let json = sandbox.run(&format!("compliance {file} --mode {mode}{option} --json")).json();
                let keys =
                    ["rod", "mode", "theory", "cf_um_per_n", "cg_um_per_g", "c_rod_um", "tip_mm", "mass_g"];
                assert_keys(&json, &keys);
                assert_eq!((&json["rod"], &json["mode"]), (&rod.name.as_str().into(), &(*mode).into()));
                let is_calc = *mode == "calc";
                assert_eq!(json["theory"], if is_calc { "euler-bernoulli" } else { theory });

                let physics = Physics::default().with_shear(theory == "timoshenko");
                let expected = match is_calc {
                    true => closed_form::compliance(&rod).unwrap(),
                    false => Compliance::of_model(&rod, &physics, 200).unwrap(),
                };
                // the number of elements is rounding only
                let (cf, cg) = (matrix(&json["cf_um_per_n"]), matrix(&json["cg_um_per_g"]));
                assert_relative_eq!(cf, expected.force / UM, epsilon = 1e-9);
                assert_relative_eq!(cg, expected.gravity / UM, epsilon = 1e-9);

                // c_rod = ΣΣ|C^g| + F·ΣΣ|C^F| with F = |(1.10, 1.25, 1.05)| N
                let force = if option.ends_with("force 0") { 0.0 } else { 1.10_f64.hypot(1.25).hypot(1.05) };
                let index = cg.abs().sum() + force * cf.abs().sum();
                assert_relative_eq!(number(&json["c_rod_um"]), index, max_relative = 1e-12);
                assert_eq!(json["tip_mm"].as_array().unwrap().len(), 3);
                for (axis, mm) in [525.0, 0.0, 150.0].into_iter().enumerate() {
                    assert_relative_eq!(number(&json["tip_mm"][axis]), mm, epsilon = 1e-9);
                }
            }
        }
    }
}

/// Rows are offsets, columns are loads; µm per newton, µm per g, grams, millimetres: one bare tube
/// by hand.
/// A gap that closes at 4 N: C^F is what it was up to there, and less beyond.
#[test]
fn compliance_with_a_law_says_at_which_load() {
    const LAW: &str = "\n[[law]]\nplace = \"rod\"\nvariable = \"load\"\nformula = \"-0.5*max(F - 4, 0)\"\nrange = [1, 12]\n";
    let sandbox = Sandbox::new();
    let text = std::fs::read_to_string(sandbox.path().join("rods/5.toml")).unwrap();
    std::fs::write(sandbox.path().join("law.toml"), text + LAW).unwrap();
    let plain = sandbox.run("compliance rods/5.toml --json").json();
    let json = sandbox.run("compliance law.toml --json").json();
    assert!(plain["laws"].is_null());
    assert_eq!(json["cf_um_per_n"], plain["cf_um_per_n"], "the contact force is below 4 N");
    let at = json["laws"]["at_loads"].as_array().unwrap();
    let loads: Vec<f64> = at.iter().map(|own| own["load_n"].as_f64().unwrap()).collect();
    assert!(loads.len() == 4 && loads[3] == 12.0, "{loads:?}");
    // (12 − 0.5·8)/12
    let expected = matrix(&plain["cf_um_per_n"]) * (2.0 / 3.0);
    assert_relative_eq!(matrix(&at[3]["cf_um_per_n"]), expected, max_relative = 1e-9);
    let beyond = sandbox.run("compliance law.toml --contact-force 20 --json").json();
    assert_relative_eq!(
        matrix(&beyond["cf_um_per_n"]),
        matrix(&plain["cf_um_per_n"]) * 0.6,
        max_relative = 1e-9
    );
    assert_eq!(beyond["laws"]["at_loads"][3]["beyond_what_was_recorded"], true);
    let words = sandbox.run("compliance law.toml").stdout;
    let words = words.split_whitespace().collect::<Vec<_>>().join(" ");
    assert!(words.contains("makes C^F depend on the load: these numbers are those at 1.97 N"), "{words}");
}

#[test]
fn compliance_is_in_its_units() {
    let sandbox = Sandbox::empty();
    let tube = "material = \"steel\"\nouter_diameter_mm = 16.0\ninner_diameter_mm = 12.0\n";
    sandbox.write(
        "rod.toml",
        &format!(
            "name = \"hand\"\n[geometry]\nl1_mm = 300.0\nl2_mm = 450.0\n[material.steel]\nyoungs_modulus_gpa = 193.0\n\
             poisson_ratio = 0.29\ndensity_kg_m3 = 7930.0\n[pipe1]\n{tube}[pipe2]\n{tube}"
        ),
    );
    let json = sandbox.run("compliance rod.toml --mode calc --json").json();
    let (l1, l2, e) = (0.3_f64, 0.45_f64, 193e9);
    let ei = e * PI / 64.0 * (0.016_f64.powi(4) - 0.012_f64.powi(4));
    let cf = matrix(&json["cf_um_per_n"]);
    // a force along x bends pipe I: along x by L1³/3EI, and tilts pipe II, so that the tip goes
    // down
    assert_relative_eq!(cf[(0, 0)], 1e6 * l1.powi(3) / (3.0 * ei), max_relative = 1e-12);
    assert_relative_eq!(cf[(2, 0)], -1e6 * l1.powi(2) * l2 / (2.0 * ei), max_relative = 1e-12);
    let mass = 1e3 * 7930.0 * PI / 4.0 * (0.016_f64.powi(2) - 0.012_f64.powi(2)) * (l1 + l2);
    assert_relative_eq!(number(&json["mass_g"]), mass, max_relative = 1e-12);
    assert_relative_eq!(number(&json["tip_mm"][0]), 450.0, max_relative = 1e-12);
    // weight q per length along z bends pipe II as a cantilever (q L2⁴/8EI) on the tilted end of
    // pipe I (q L2²/2 · L1/EI · L2)
    let q = 9.80665 * 1e-3 * mass / (l1 + l2);
    let sag = q * l2.powi(4) / (8.0 * ei) + q * l2.powi(3) * l1 / (2.0 * ei);
    let cg = matrix(&json["cg_um_per_g"]);
    assert_relative_eq!(cg[(2, 2)], 1e6 * sag, max_relative = 1e-12);
    // and moves the corner back along x; C^g is not symmetric, so this also tells rows from columns
    let back = q * l2.powi(2) * l1.powi(2) / (4.0 * ei);
    assert_relative_eq!(cg[(0, 2)], -1e6 * back, max_relative = 1e-12);
}

#[test]
fn what_a_station_does_is_in_its_units() {
    let sandbox = Sandbox::new();
    let json = sandbox.run("compliance rods/5.toml --load-station 400 --json").json();
    let stations = &json["stations"];
    assert_eq!((number(&stations["load_station_mm"]), number(&stations["read_station_mm"])), (400.0, 675.0));
    let away = matrix(&stations["displacement_um_per_n"]);
    let rod = Rod::read(&sandbox.path().join("rods/5.toml")).unwrap();
    // Maxwell: the tip under a force at the station is the station under a force at the tip,
    // transposed
    let back = sandbox.run("compliance rods/5.toml --read-station 400 --json").json();
    let back = matrix(&back["stations"]["displacement_um_per_n"]);
    assert_relative_eq!(away, back.transpose(), epsilon = 1e-9);
    let both = sandbox.run(&format!("compliance rods/5.toml --load-station {} --json", rod.length() * 1e3));
    let both = both.json();
    assert_relative_eq!(
        matrix(&both["stations"]["displacement_um_per_n"]),
        matrix(&both["cf_um_per_n"]),
        epsilon = 1e-9
    );
    matrix(&both["stations"]["rotation_urad_per_n"]);
}

/// Lines made by hand: 46 µm/N along y, of which friction takes 1.5 N, and 40 µm/N along z; noise
/// ±1 µm in balance.
fn readings() -> String {
    let mut text = "axis,load_kg,trial,dy_um,dz_um\n".to_owned();
    for trial in [1, 2] {
        for load in [1.0, 2.0, 3.0, 4.0] {
            let (noise, force) = (if trial == 1 { 1.0 } else { -1.0 }, 9.80665 * load);
            text += &format!("y,{load},{trial},{},\n", 46.0 * (force - 1.5) + noise);
            text += &format!("z,{load},{trial},,{}\n", 40.0 * force + noise);
        }
    }
    text
}

#[test]
fn rig_fit_with_a_rod() {
    let sandbox = Sandbox::new();
    sandbox.write("readings.csv", &readings());
    let json = sandbox.run("rig fit rods/5.toml readings.csv --json").json();
    assert_keys(&json, &["slopes", "r", "r_rod", "cf_um_per_n", "cg_um_per_g"]);
    let slopes = json["slopes"].as_array().unwrap();
    assert_eq!(slopes.len(), 2);
    for (slope, (axis, channel, um_per_n, offset)) in
        slopes.iter().zip([("y", "dy", 46.0, 1.5), ("z", "dz", 40.0, 0.0)])
    {
        let keys = ["axis", "channel", "um_per_n", "std_error", "intercept_um", "load_offset_n", "n"];
        assert_keys(slope, &keys);
        assert_eq!((&slope["axis"], &slope["channel"]), (&axis.into(), &channel.into()));
        assert_relative_eq!(number(&slope["um_per_n"]), um_per_n, max_relative = 1e-10);
        assert_relative_eq!(number(&slope["load_offset_n"]), offset, epsilon = 1e-9);
        assert_relative_eq!(number(&slope["intercept_um"]), -um_per_n * offset, epsilon = 1e-7);
        assert_eq!(slope["n"], 8);
        assert!(number(&slope["std_error"]) > 0.0 && number(&slope["std_error"]) < 0.1, "{slope}");
    }

    // Eqs 20 to 22 by hand from what `compliance` says
    let model = sandbox.run("compliance rods/5.toml --json").json();
    let (cf, cg) = (matrix(&model["cf_um_per_n"]), matrix(&model["cg_um_per_g"]));
    assert_relative_eq!(number(&json["r"]["22"]), 46.0 / cf[(1, 1)], max_relative = 1e-9);
    assert_relative_eq!(number(&json["r"]["33"]), 40.0 / cf[(2, 2)], max_relative = 1e-9);
    let r_rod = number(&json["r_rod"]);
    assert_relative_eq!(r_rod, 86.0 / (cf[(1, 1)] + cf[(2, 2)]), max_relative = 1e-9);
    assert_relative_eq!(matrix(&json["cg_um_per_g"]), cg * r_rod, max_relative = 1e-9);
    let mut meas = cf * r_rod;
    (meas[(1, 1)], meas[(2, 2)]) = (46.0, 40.0);
    assert_relative_eq!(matrix(&json["cf_um_per_n"]), meas, max_relative = 1e-9);
}

#[test]
fn rig_fit_says_what_the_library_says() {
    let sandbox = Sandbox::new();
    for name in ["2", "5"] {
        let (rod, csv) = (format!("rods/{name}.toml"), format!("stiffness_data/{name}.csv"));
        let json = sandbox.run(&format!("rig fit {rod} {csv} --json")).json();
        let readings = Readings::read(&sandbox.path().join(csv)).unwrap();
        let rod = Rod::read(&sandbox.path().join(rod)).unwrap();
        let fit = rig::fit(&readings, Some(&rod), &Options::default()).unwrap();
        let measured = fit.measured.unwrap();
        assert_eq!(json["rod"], rod.name);
        assert_relative_eq!(number(&json["r_rod"]), measured.rod_ratio.value, max_relative = 1e-12);
        assert_compliance(&json, &measured.compliance);
        let index = measured.compliance.index(paper_contact_force()) / UM;
        assert_relative_eq!(number(&json["c_rod_um"]), index, max_relative = 1e-12);
        for (slope, line) in json["slopes"].as_array().unwrap().iter().zip(&fit.lines) {
            assert_relative_eq!(number(&slope["um_per_n"]), line.slope.value / UM, max_relative = 1e-12);
            let error = line.slope.std_error.unwrap() / UM;
            assert_relative_eq!(number(&slope["std_error"]), error, max_relative = 1e-12);
        }
    }
}

#[test]
fn rig_fit_options_reach_the_fit() {
    let sandbox = Sandbox::new();
    // one reading of rod 5# goes wrong by a millimetre
    sandbox.write("readings.csv", &readings().replace("z,4,1,,", "z,4,1,,1"));
    let slope = |option: &str| {
        let json = sandbox.run(&format!("rig fit rods/5.toml readings.csv --json{option}")).json();
        number(&json["slopes"][1]["um_per_n"])
    };
    let beside = |option: &str| (slope(option) - 40.0).abs();
    let (none, huber, tukey) = (beside(""), beside(" --robust huber"), beside(" --robust tukey"));
    assert_eq!(none, beside(" --robust none"));
    assert!(none > huber && huber > tukey, "{none} {huber} {tukey}");

    let r = |option: &str| {
        number(&sandbox.run(&format!("rig fit rods/5.toml readings.csv --json{option}")).json()["r_rod"])
    };
    assert_eq!(r(""), r(" --theory timoshenko"));
    assert!(r(" --theory euler-bernoulli") > r(""), "a model without shear is stiffer");
}

#[test]
fn rig_fit_of_a_straight_line() {
    let sandbox = Sandbox::new();
    let json = sandbox.run("rig fit linear stiffness_data/nist-load-cell.csv --json").json();
    assert_keys(&json, &["slopes", "r", "r_rod", "cf_um_per_n", "cg_um_per_g"]);
    for key in ["rod", "r_rod", "cf_um_per_n", "cg_um_per_g"] {
        assert!(json[key].is_null(), "there is no rod: {key}");
    }
    assert_eq!(json["r"], serde_json::json!({}));
    let slopes = json["slopes"].as_array().unwrap();
    assert_eq!(slopes.len(), 1);
    assert_eq!(slopes[0]["n"], 40);
    assert_relative_eq!(number(&slopes[0]["lack_of_fit"]["f"]), 214.7, epsilon = 0.1);
}

#[test]
fn the_demo_as_json() {
    let sandbox = Sandbox::empty();
    let json = sandbox.run("--json").json();
    assert_eq!(json["report"], "reports/demo/index.html");
    assert_eq!(json["rods"].as_array().unwrap().len(), 2);
    for (i, name) in ["2#", "5#"].into_iter().enumerate() {
        let rod = &json["rods"][i];
        assert_eq!((&rod["compliance"]["rod"], &rod["rig"]["rod"]), (&name.into(), &name.into()));
        matrix(&rod["compliance"]["cf_um_per_n"]);
        matrix(&rod["rig"]["cg_um_per_g"]);
    }
    assert_keys(&json["load_cell"], &["slopes"]);
    assert_keys(&json["calibration"], &["mode", "parameters", "residual", "validation"]);
    assert_eq!(json["comparison"]["modes"].as_array().unwrap().len(), 4);
}

/// t = ln 50/(ζω)
#[test]
fn settling_times_are_those_of_the_damping_that_was_stated() {
    let sandbox = Sandbox::new();
    let json = sandbox.run("compliance rods/5.toml --damping-percent 0.5 --json").json();
    let list = |key: &str| -> Vec<f64> {
        json[key].as_array().unwrap().iter().map(|one| one.as_f64().unwrap()).collect()
    };
    for (time, frequency) in list("settling_times_s").iter().zip(list("natural_frequencies_hz")) {
        let expected = 50f64.ln() / (0.005 * std::f64::consts::TAU * frequency);
        assert!((time / expected - 1.0).abs() < 1e-12, "{time} {expected}");
    }
    let said = sandbox.run("compliance rods/5.toml --damping-percent 0.5").succeeded().stdout;
    assert!(said.contains("at 0.5 % damping"), "{said}");
    let unknown = sandbox.run("compliance rods/5.toml --json").json();
    assert!(unknown["settling_times_s"].is_null());
}

/// A page of a million rows is none, and their JSON would need two gigabytes if it were held.
#[test]
fn what_is_long_is_whole_in_its_files_and_short_elsewhere() {
    let sandbox = Sandbox::new();
    let mut poses = String::from("pose,q1_deg,q2_deg,q3_deg,q4_deg,q5_deg,q6_deg\n");
    for k in 0..1203 {
        poses += &format!("p{k},{},10,80,5,6,7\n", 0.1 * f64::from(k));
    }
    sandbox.write("poses.csv", &poses);
    let answer = sandbox.run("predict robots/tx90.toml poses.csv --out tips").succeeded();
    let note = "203 more rows";
    assert!(
        answer.stdout.contains(note) && answer.stdout.contains("p999 ") && !answer.stdout.contains("p1000 ")
    );
    let page = sandbox.read("tips/index.html");
    assert!(page.contains(note) && page.contains("p999<") && !page.contains("p1000<"));
    assert_eq!(sandbox.read("tips/table-1-prediction.csv").lines().count(), 1204);
    let result: Value = serde_json::from_str(&sandbox.read("tips/result.json")).unwrap();
    let printed = sandbox.run("predict robots/tx90.toml poses.csv --json").json();
    assert_eq!(result["poses"].as_array().unwrap().len(), 1203);
    assert_eq!(result["poses"], printed["poses"]);
    // in its place, not at the end
    assert!(printed.as_object().unwrap().keys().position(|key| key == "poses") < Some(5));
}
