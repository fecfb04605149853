//! Names of rods, robots, clamps, poses and files that would do something if anybody obeyed them.

use super::{Answer, Sandbox};

/// A tag, an attribute's end, a formula, a colour of the terminal and a turn of the writing.
const NAME: &str = "=cmd()<script>alert(1)</script>\"><img src=x onerror=1>\u{1b}[31m\u{202e}\u{9b}2J";

/// As a TOML text.
const WRITTEN: &str = r#""=cmd()<script>alert(1)</script>\"><img src=x onerror=1>\u001B[31m\u202E\u009B2J""#;

fn is_obeyed(c: char) -> bool {
    rodcal::delimited::is_obeyed(c) && c != '\n' && c != '\t'
}

fn assert_shown(answer: &Answer) {
    for text in [&answer.stdout, &answer.stderr] {
        assert!(!text.contains(is_obeyed), "{}: {text:?}", answer.line);
    }
}

/// What a spreadsheet would calculate begins with `=`, `+`, `-` or `@` and is no number, no
/// interval and no direction.
fn assert_no_formula(name: &str, text: &str) {
    let mut rows = csv::ReaderBuilder::new()
        .has_headers(false)
        .flexible(true)
        .comment(Some(b'#'))
        .from_reader(text.as_bytes());
    for row in rows.records() {
        for cell in row.unwrap_or_else(|error| panic!("{name}: {error}")).iter() {
            let first = cell.split_whitespace().next().unwrap_or_default();
            let is_number = first.trim_end_matches(['%', ',']).parse::<f64>().is_ok();
            let is_harmless = is_number || cell == "-" || cell == "+" || ["-x", "-y", "-z"].contains(&first);
            assert!(!cell.starts_with(['=', '+', '-', '@']) || is_harmless, "{name}: {cell}");
        }
    }
}

#[test]
fn hostile_names_are_data_everywhere() {
    let sandbox = Sandbox::new();
    let rename = |file: &str, key: &str| {
        let text = sandbox.read(file);
        let is_key = |line: &str| line.split_once(" = ").is_some_and(|(name, _)| name == key);
        let lines = text.lines().map(|line| match is_key(line) {
            true => format!("{key} = {WRITTEN}\n"),
            false => format!("{line}\n"),
        });
        let renamed: String = lines.collect();
        assert!(renamed.contains("onerror"), "{file} has no {key}");
        sandbox.write(file, &renamed);
    };
    // the rod, its masses and materials by name; the robot and its joints; trials; clamps and poses
    rename("rods/5.toml", "name");
    rename("robots/tx90.toml", "name");
    let readings = sandbox.read("stiffness_data/5.csv");
    sandbox.write("stiffness_data/5.csv", &format!("# source = {NAME}\n{readings}"));
    let campaign = "campaigns/tx90-5/campaign.toml";
    let text = sandbox.read(campaign).replace("builtin:tx90", "../../robots/tx90.toml");
    sandbox.write(campaign, &text.replace("id = \"1\"", &format!("id = {WRITTEN}")));
    let quoted = format!("\"{}\"", NAME.replace('"', "\"\""));
    let measurements = sandbox.read("campaigns/tx90-5/measurements.csv");
    let renamed = measurements.lines().map(|line| match line.split_once(",1,") {
        Some(("1", rest)) => format!("{quoted},{quoted},{rest}\n"),
        Some((pose, rest)) if pose.parse::<u32>().is_ok() => format!("{pose},{quoted},{rest}\n"),
        _ => format!("{line}\n"),
    });
    let renamed: String = renamed.collect();
    assert!(renamed.matches("onerror").count() > 10);
    sandbox.write("campaigns/tx90-5/measurements.csv", &renamed);
    sandbox.write(
        "poses.csv",
        &format!("pose,q1_deg,q2_deg,q3_deg,q4_deg,q5_deg,q6_deg\n{quoted},0,10,80,5,6,7\n"),
    );
    // tubes, their material and what hangs on them
    sandbox.write(
        "tubes.csv",
        &format!(
            "name,material,outer_diameter_mm,inner_diameter_mm\n{quoted},{quoted},32,30\nb,steel,20,16\n"
        ),
    );
    // fewer rods: nothing here depends on how many there are
    let design = sandbox.read("examples/design.toml").replace("\"builtin\"", "\"tubes.csv\"");
    let design = design.replace("step = 20", "step = 100").replace("step = 25", "step = 125");
    sandbox.write(
        "design.toml",
        &format!(
            "{design}\n[material.{WRITTEN}]\nyoungs_modulus_gpa = 193\npoisson_ratio = 0.3\ndensity_kg_m3 = 7930\n\
             [[mass]]\nname = {WRITTEN}\nstation_mm = 100\nmass_g = 20\n"
        ),
    );
    for (k, line) in [
        "compliance rods/5.toml",
        "rig fit rods/5.toml stiffness_data/5.csv",
        "diagnose rig rods/5.toml stiffness_data/5.csv --apply",
        "calibrate campaigns/tx90-5/campaign.toml",
        "predict robots/tx90.toml poses.csv",
        "design rig rods/5.toml --r-rod-width-percent 1",
        "compare-runs out0 out1 --json",
        "compare-runs out1 out1",
        "compare campaigns/tx90-5/campaign.toml --draws 50",
        "diagnose calibration campaigns/tx90-5/campaign.toml --mode fea",
        "design rod design.toml --base rods/5.toml",
        "design poses campaigns/tx90-5/campaign.toml --count 20 --generate 200",
        "simulate out12 --rod rods/5.toml --robot robots/tx90.toml --poses 6 --validation 4",
    ]
    .into_iter()
    .enumerate()
    {
        let out = if line.starts_with("simulate") { String::new() } else { format!(" --out out{k}") };
        let answer = sandbox.run(&format!("{line}{out}"));
        assert_shown(&answer);
        if line.contains("out0") {
            // of different commands: an error that names both
            continue;
        }
        let answer = answer.succeeded();
        let is_long = ["compare campaigns", "diagnose calibration", "design poses", "simulate"];
        if !is_long.iter().any(|start| line.starts_with(start)) {
            let json = sandbox.run(&format!("{line} --json"));
            assert_shown(&json);
            json.json();
        }
        let prefix = format!("out{k}/");
        for (name, bytes) in sandbox.listing().iter().filter(|(name, _)| name.starts_with(&prefix)) {
            let text = String::from_utf8_lossy(bytes);
            assert!(!text.contains(is_obeyed), "{line}: {name}: {text}");
            if [".html", ".svg", ".md"].iter().any(|kind| name.ends_with(kind)) {
                assert!(!text.contains("<script>alert") && !text.contains("<img src=x"), "{name}");
            }
            if name.ends_with(".csv") {
                assert_no_formula(name, &text);
            }
        }
        assert!(k > 1 || answer.stdout.contains("onerror") || answer.stdout.len() > 100);
    }
}

/// A file's own name, in an error, in a warning and in what the arguments may be.
#[test]
fn names_of_files_are_shown() {
    let sandbox = Sandbox::new();
    let name = "\u{1b}[31mred\nerror: fake\u{202e}.toml";
    sandbox.write(name, "nonsense");
    for arguments in [
        &["compliance", name][..],
        &["compliance", "no\u{1b}such.toml"],
        &["rig", "fit", name, name, "--out", "\u{1b}"],
    ] {
        let output = sandbox.command(arguments).output().unwrap();
        let stderr = String::from_utf8(output.stderr).unwrap();
        assert_eq!(output.status.code(), Some(2), "{arguments:?}");
        assert!(stderr.contains("\\x1b") && !stderr.contains(is_obeyed), "{stderr:?}");
        assert!(!stderr.lines().any(|line| line.starts_with("error: fake")), "{stderr:?}");
    }
}
