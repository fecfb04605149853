//! Mistakes in a campaign: named by `diagnose calibration` and `calibrate`, undone by `--apply`;
//! stations.

use serde_json::Value;

use super::Sandbox;
use super::words::assert_reads;

const MEASUREMENTS: &str = "campaigns/tx90-5/measurements.csv";
const CAMPAIGN: &str = "campaigns/tx90-5/campaign.toml";

/// The rows of a CSV file changed, cell by cell; its header and comments as they are.
fn rewritten(text: &str, change: impl Fn(usize, &[String], &mut Vec<String>)) -> String {
    let header: Vec<String> =
        text.lines().find(|line| !line.starts_with('#')).unwrap().split(',').map(str::to_owned).collect();
    let mut row = 0;
    let mut lines = Vec::new();
    for line in text.lines() {
        let mut cells: Vec<String> = line.split(',').map(str::to_owned).collect();
        if !line.starts_with('#') && cells != header {
            change(row, &header, &mut cells);
            row += 1;
        }
        lines.push(cells.join(","));
    }
    lines.join("\n") + "\n"
}

fn at(header: &[String], name: &str) -> usize {
    header.iter().position(|column| column == name).unwrap()
}

/// The campaign of the project with the sign of joint 4 turned round, in measurements and
/// validation.
fn flipped() -> Sandbox {
    let sandbox = Sandbox::new();
    for file in [MEASUREMENTS, "campaigns/tx90-5/validation.csv"] {
        let text = rewritten(&sandbox.read(file), |_, header, cells| {
            let joint = at(header, "q4_deg");
            cells[joint] = format!("{}", -cells[joint].parse::<f64>().unwrap());
        });
        sandbox.write(file, &text);
    }
    sandbox
}

#[test]
fn a_sign_is_named_with_its_correction_before_all_physics() {
    let sandbox = flipped();
    let answer = sandbox.run(&format!("diagnose calibration {CAMPAIGN} --json"));
    assert_eq!(answer.status, Some(1));
    let json = answer.json();
    let finding = &json["findings"][0];
    assert_eq!(finding["effect"], "sign_mistake");
    assert_eq!(finding["location"], "q4_deg");
    assert_eq!(finding["kind"], "mistake");
    assert_reads("diagnose-mistake", json["headline"].as_str().unwrap());
}

#[test]
fn calibrate_warns_of_a_fit_that_is_not_plausible_and_of_the_likely_mistake() {
    let sandbox = flipped();
    let answer = sandbox.run(&format!("calibrate {CAMPAIGN} --json"));
    assert_eq!(answer.status, Some(1));
    let json: Value = serde_json::from_str(&answer.stdout).unwrap();
    assert_eq!(json["plausible"], false);
    assert_reads("calibrate-mistake", answer.stderr.lines().next().unwrap());
    assert!(answer.stderr.contains("warning: THE FIT IS NOT PLAUSIBLE: "), "{}", answer.stderr);
    let clean = Sandbox::new().run(&format!("calibrate {CAMPAIGN} --json"));
    assert_eq!(clean.status, Some(0));
    let json = clean.json();
    assert_eq!(json["plausible"], true);
    assert_eq!(json["suspected_mistakes"], Value::Array(Vec::new()));
}

#[test]
fn apply_writes_the_campaign_that_was_meant() {
    let sandbox = flipped();
    let answer = sandbox.run(&format!("diagnose calibration {CAMPAIGN} --apply --out fixed --json"));
    let applied = &answer.json()["applied"];
    assert_eq!(applied["undone"][0], "Multiply q4_deg by −1");
    let again = sandbox.run("diagnose calibration fixed/campaign.toml --json");
    assert_eq!(again.status, Some(0), "{}", again.stdout);
    let validated = sandbox.run("calibrate fixed/campaign.toml --json").json();
    let right = Sandbox::new().run(&format!("calibrate {CAMPAIGN} --json")).json();
    for key in ["residual", "validation"] {
        let [fixed, right] = [&validated, &right].map(|json| json[key]["rms_um"].as_f64().unwrap());
        assert!((fixed - right).abs() < 1e-3 * right, "{key}: {fixed} {right}");
    }
}

#[test]
fn another_rod_of_the_same_folder_is_named() {
    let sandbox = Sandbox::new();
    let text = sandbox.read(CAMPAIGN).replace("rods/5.toml", "rods/3.toml");
    sandbox.write(CAMPAIGN, &text.replace("rig = \"readings.csv\"\n", ""));
    let answer = sandbox.run(&format!("diagnose calibration {CAMPAIGN} --apply --out fixed --json"));
    let finding = &answer.json()["findings"][0];
    assert_eq!(finding["effect"], "rod_mistake");
    assert_eq!(finding["location"], "../../rods/5.toml");
    assert!(sandbox.read("fixed/campaign.toml").contains("rod = \"5.toml\""));
    assert_eq!(sandbox.run("calibrate fixed/campaign.toml").status, Some(0));
}

/// A tracker's campaign: 100 poses of a simulated robot, 60 of them from another place.
fn from_two_places(column: bool) -> Sandbox {
    let sandbox = Sandbox::new();
    sandbox.run("simulate sim --rod rods/5.toml --poses 2 --validation 100 --seed 4");
    let text = rewritten(&sandbox.read("sim/validation.csv"), |row, header, cells| {
        let axes = ["x_mm", "y_mm", "z_mm"].map(|name| at(header, name));
        let [x, y, z] = axes.map(|axis| cells[axis].parse::<f64>().unwrap());
        let moved = if row < 40 { [x, y, z] } else { [800.0 - y, x - 300.0, z + 250.0] };
        for (axis, value) in axes.into_iter().zip(moved) {
            cells[axis] = format!("{value:.4}");
        }
        if column {
            cells.push(if row < 40 { "door" } else { "window" }.to_owned());
        }
    });
    let text = if column { text.replacen("z_mm\n", "z_mm,station\n", 1) } else { text };
    sandbox.write("sim/tracked.csv", &text);
    let tracker = "robot = \"builtin:tx90\"\nmeasurements = \"tracked.csv\"\n[tool]\nxyz_mm = [0, 0, 120]\n";
    sandbox.write("sim/tracked.toml", tracker);
    sandbox
}

#[test]
fn stations_have_frames_of_their_own() {
    let answer = from_two_places(true).run("calibrate sim/tracked.toml --json");
    assert_eq!(answer.status, Some(0), "{}", answer.stderr);
    let json = answer.json();
    // scanner and repeatability, less the 38 numbers that are fitted to 300
    let rms = json["residual"]["rms_um"].as_f64().unwrap();
    assert!((rms - 30f64.hypot(43.0)).abs() < 12.0, "{rms}");
    let station = &json["stations"][1];
    assert_eq!(station["name"], "window");
    // {W} of the second place in that of the first: x = y′ + 300, y = 800 − x′, z = z′ − 250
    for (found, right) in station["xyz_mm"].as_array().unwrap().iter().zip([300.0, 800.0, -250.0]) {
        assert!((found.as_f64().unwrap() - right).abs() < 1.0, "{station}");
    }
    assert!((station["rpy_deg"][2].as_f64().unwrap() + 90.0).abs() < 0.1, "{station}");
}

#[test]
fn a_tracker_that_moved_is_found_and_gets_its_column() {
    let sandbox = from_two_places(false);
    assert_eq!(sandbox.run("calibrate sim/tracked.toml").status, Some(1));
    let answer = sandbox.run("diagnose calibration sim/tracked.toml --apply --out fixed --json");
    assert_eq!(answer.status, Some(1));
    let finding = &answer.json()["findings"][0];
    assert_eq!(finding["effect"], "base_shift");
    assert_eq!(finding["location"], "after pose 40");
    assert_eq!(finding["kind"], "event");
    let fixed = sandbox.run("calibrate fixed/campaign.toml --json");
    assert_eq!(fixed.status, Some(0), "{}", fixed.stderr);
    assert!(sandbox.read("fixed/measurements.csv").contains(",station\n"));
    assert_eq!(fixed.json()["stations"].as_array().unwrap().len(), 2);
}

#[test]
fn a_validation_from_another_place_is_told_from_a_bad_robot() {
    let sandbox = from_two_places(false);
    let text = sandbox.read("sim/validation.csv");
    let (comments, rows): (Vec<&str>, Vec<&str>) =
        text.lines().partition(|line| !line.starts_with(char::is_numeric));
    let file = |rows: &[&str]| [&comments[..], rows].concat().join("\n") + "\n";
    sandbox.write("sim/tracked.csv", &file(&rows[..70]));
    let moved = rewritten(&file(&rows[70..]), |_, header, cells| {
        let x = at(header, "x_mm");
        cells[x] = format!("{}", cells[x].parse::<f64>().unwrap() + 250.0);
    });
    sandbox.write("sim/elsewhere.csv", &moved);
    let validated = "validation = \"elsewhere.csv\"\nvalidation_refit = \"none\"\n";
    sandbox.write("sim/tracked.toml", &format!("{validated}{}", sandbox.read("sim/tracked.toml")));
    let answer = sandbox.run("calibrate sim/tracked.toml");
    assert!(answer.stderr.contains("tracker or base stood elsewhere"), "{}", answer.stderr);
}

/// Two thirds of a column that stood still cannot be undone, and nothing is promised of it.
#[test]
fn of_what_cannot_be_undone_no_residual_is_promised() {
    let sandbox = Sandbox::new();
    let text = rewritten(&sandbox.read(MEASUREMENTS), |row, header, cells| {
        if row >= 20 {
            cells[at(header, "z_mm")] = "0.1234".into();
        }
    });
    sandbox.write(MEASUREMENTS, &text);
    let answer = sandbox.run(&format!("diagnose calibration {CAMPAIGN} --apply --out fixed"));
    assert_eq!(answer.status, Some(1));
    assert!(answer.stderr.contains("--apply has no effect"), "{}", answer.stderr);
    assert_reads("diagnose-stuck", answer.stdout.split("Parameters with").next().unwrap());
    assert!(answer.stdout.contains("All that follows is of the recording as it is."), "{}", answer.stdout);
}

/// A rod that weighs a thousandth: its reader says so, and so does who calibrates with it.
#[test]
fn what_is_odd_about_a_rod_is_said_of_its_campaign_too() {
    let sandbox = Sandbox::new();
    let rod = "rods/5.toml";
    let text = sandbox.read(rod);
    let light = text.replace("density_kg_m3 = 7930.0", "density_kg_m3 = 7.93");
    assert_ne!(light, text);
    sandbox.write(rod, &light);
    for command in ["calibrate", "diagnose calibration", "compare"] {
        let answer = sandbox.run(&format!("{command} {CAMPAIGN}"));
        let expected = "5.toml: `material.steel.density_kg_m3` is 7.930 kg/m³";
        assert!(answer.stderr.contains(expected), "{command}: {}", answer.stderr);
        if command == "diagnose calibration" {
            // whatever it was taken for
            let headline = answer.stdout.split_whitespace().collect::<Vec<_>>().join(" ");
            assert!(headline.starts_with("`material.steel.density_kg_m3` of "), "{headline}");
            assert!(headline.contains("check that first"), "{headline}");
        }
    }
}

/// A rod whose second pipe is a tenth as long as the one that was mounted, and no other rod's file
/// beside it.
#[test]
fn a_tip_far_from_where_the_rods_file_has_it_is_said() {
    let sandbox = Sandbox::new();
    let rod = "rods/5.toml";
    let text = sandbox.read(rod);
    let short = text.replace("l2_mm = 525.0", "l2_mm = 52.5");
    assert_ne!(short, text);
    for other in ["1", "2", "3", "4", "6"] {
        std::fs::remove_file(sandbox.path().join(format!("rods/{other}.toml"))).unwrap();
    }
    for (rod_file, is_said) in [(text, false), (short, true)] {
        sandbox.write(rod, &rod_file);
        let calibrated = sandbox.run(&format!("calibrate {CAMPAIGN}"));
        let diagnosed = sandbox.run(&format!("diagnose calibration {CAMPAIGN}"));
        let expected = " mm from where the rod's file has it";
        for said in [&calibrated.stderr, &diagnosed.stderr, &diagnosed.stdout.replace('\n', " ")] {
            assert_eq!(said.contains(expected), is_said, "{said}");
        }
        // before what was made of it
        assert_eq!(diagnosed.stdout.starts_with("The tip is "), is_said, "{}", diagnosed.stdout);
    }
}
