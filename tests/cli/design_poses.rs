//! Poses to measure and what to expect of them, as a lab asks for them.

use std::collections::BTreeSet;

use serde_json::Value;

use super::Sandbox;

const TX90: &str = "campaigns/tx90-5/campaign.toml";

fn number(json: &Value) -> f64 {
    json.as_f64().unwrap_or_else(|| panic!("{json} is no number"))
}

/// The joint values of each pose with its clamp.
fn poses(json: &Value) -> Vec<(String, Vec<f64>)> {
    let of_pose = |pose: &Value| {
        let q = (1..=6).map(|joint| number(&pose[format!("q{joint}_deg")])).collect();
        (pose["clamp"].as_str().unwrap().to_owned(), q)
    };
    json["poses"].as_array().unwrap().iter().map(of_pose).collect()
}

#[test]
fn the_poses_are_distinct_as_many_as_asked_and_better_than_random_ones() {
    let sandbox = Sandbox::new();
    let line = format!("design poses {TX90} --count 33 --generate 400");
    let json = sandbox.run(&format!("{line} --out o --json")).json();
    let chosen = poses(&json);
    let distinct: BTreeSet<String> = chosen.iter().map(|(_, q)| format!("{q:?}")).collect();
    assert_eq!((chosen.len(), distinct.len()), (33, 33));
    let on = |clamp: &str| chosen.iter().filter(|(own, _)| own == clamp).count();
    assert_eq!(["1", "2", "3", "4", "5"].map(on), [7, 7, 7, 6, 6]);
    // as far apart as asked for, at each clamp
    for (k, (clamp, q)) in chosen.iter().enumerate() {
        for (_, other) in chosen[..k].iter().filter(|(other, _)| other == clamp) {
            assert!(q.iter().zip(other).any(|(a, b)| (a - b).abs() > 4.999), "{q:?} {other:?}");
        }
    }
    assert_eq!(json["criterion"], "o1");
    assert!(number(&json["value"]) > 1.05 * number(&json["value_random_median"]));
    assert!((number(&json["value"]) / number(&json["observability"]["o1"]) - 1.0).abs() < 1e-6);
    assert!(number(&json["worth_random_poses"]) > 1.1);
    let forecast = &json["forecast_um"];
    let squares: f64 = forecast["parts"].as_object().unwrap().values().map(|part| number(part).powi(2)).sum();
    assert!((number(&forecast["rms"]) - squares.sqrt()).abs() < 1e-9 * squares);
    assert!(number(&forecast["mean"]) < number(&forecast["rms"]));
    assert!(number(&forecast["rms"]) < number(&forecast["p95"]));
    // a lab takes them as they are, and so does a simulation
    let simulated = sandbox.run("simulate s --rod rods/5.toml --planned o/poses.csv --json").json();
    assert_eq!(simulated["poses"], 33);
    sandbox.run("calibrate s/campaign.toml").succeeded();
    let other = sandbox.run("simulate t --rod rods/4.toml --planned o/poses.csv");
    assert!(other.stderr.contains("mm away from clamp 1"), "{}", other.stderr);
    // what is written is what a recording has, and can be chosen from again
    let table = sandbox.read("o/poses.csv");
    assert_eq!(table.lines().nth(1), Some("pose,clamp,q1_deg,q2_deg,q3_deg,q4_deg,q5_deg,q6_deg"));
    let again = format!("design poses {TX90} --count 33 --candidates o/poses.csv --criterion d --json");
    let again = sandbox.run(&again).json();
    assert_eq!(poses(&again).into_iter().map(|(_, q)| format!("{q:?}")).collect::<BTreeSet<_>>(), distinct);
}

#[test]
fn every_criterion_is_best_in_its_own_value_and_threads_change_nothing() {
    let sandbox = Sandbox::new();
    let line = |criterion: &str| {
        format!("design poses {TX90} --count 20 --generate 150 --criterion {criterion} --json")
    };
    let of_criterion = |criterion: &str| sandbox.run(&line(criterion)).json();
    let (o1, o4, forecast) = (of_criterion("o1"), of_criterion("o4"), of_criterion("forecast"));
    assert!(number(&o1["observability"]["o1"]) > number(&o4["observability"]["o1"]));
    assert!(number(&o4["observability"]["o4"]) > number(&o1["observability"]["o4"]));
    let noise = |json: &Value| number(&json["forecast_um"]["parts"]["noise_um"]);
    assert!(noise(&forecast) < noise(&o1) && noise(&forecast) < noise(&o4));
    let [one, four] = ["1", "4"].map(|threads| {
        let words = line("a");
        let mut command = sandbox.command(&words.split_whitespace().collect::<Vec<_>>());
        command.env("RAYON_NUM_THREADS", threads).output().unwrap().stdout
    });
    assert!(!one.is_empty() && one == four);
}

#[test]
fn a_campaign_that_is_not_recorded_yet_can_be_planned_and_not_calibrated() {
    let sandbox = Sandbox::new();
    let text = sandbox.read(TX90).replace("rig = \"readings.csv\"\n", "");
    let planned = text.replace("measurements = \"measurements.csv\"\nvalidation = \"validation.csv\"\n", "");
    assert!(planned.len() < text.len());
    sandbox.write("campaigns/tx90-5/plan.toml", &planned);
    let json = sandbox.run("design poses campaigns/tx90-5/plan.toml --count 20 --generate 100 --json").json();
    assert_eq!((poses(&json).len(), &json["forecast_um"]["mode"]), (20, &"fea".into()));
    let refused = sandbox.run("calibrate campaigns/tx90-5/plan.toml");
    assert!(refused.status == Some(2) && refused.stderr.contains("measurements"), "{}", refused.stderr);
    // which rod with which mode, before anybody records
    let line =
        "compare campaigns/tx90-5/plan.toml --forecast --rods rods/4.toml rods/6.toml --count 20 --json";
    let json = sandbox.run(line).json();
    let of_rod = |rod: usize, mode: &str, part: &str| {
        let modes = json["forecasts"][rod]["modes"].as_array().unwrap();
        number(&modes.iter().find(|one| one["mode"] == mode).unwrap()["parts"][part])
    };
    // 6# bends 2.5 times as much as 4#; most of that base, tool and links take up
    assert!(of_rod(1, "none", "rod_bias_um") > 1.5 * of_rod(0, "none", "rod_bias_um"));
    assert!(of_rod(0, "none", "rod_bias_um") > 5.0 * of_rod(0, "fea", "rod_uncertainty_um"));
    assert_eq!(of_rod(1, "fea", "rod_bias_um"), 0.0);
    assert!(of_rod(1, "fea", "rod_uncertainty_um") > 2.0 * of_rod(1, "meas", "rod_uncertainty_um"));
    // two rods have no order to speak of, five have
    assert_eq!(json["c_rod_as_proxy"], serde_json::json!([]));
    let five = line.replace("rods/4.toml", "rods/2.toml rods/3.toml rods/4.toml rods/5.toml");
    let json = sandbox.run(&five).json();
    let none = &json["c_rod_as_proxy"][0];
    assert_eq!(none["mode"], "none");
    assert!(number(&none["spearman"]) > 0.7, "{none}");
    assert!((number(&json["forecasts"][3]["c_rod_um"]) - 401.985851).abs() < 1e-6);
    let said = sandbox.run(&five.replace(" --json", "")).succeeded().stdout;
    assert!(said.contains("Would c_rod have ranked these rods"), "{said}");
}

#[test]
fn what_cannot_be_planned_is_refused_with_its_reason_and_nothing_is_written() {
    let sandbox = Sandbox::new();
    let refused = |line: &str, expected: &str| {
        let answer = sandbox.run(&format!("{line} --out o"));
        assert_eq!((answer.status, answer.stdout.as_str()), (Some(2), ""), "{line}");
        assert!(answer.stderr.contains(expected), "{line}: {}", answer.stderr);
        assert!(!sandbox.path().join("o").exists());
    };
    refused(&format!("design poses {TX90} --count 9"), "at least 11 poses, for 32 unknown numbers");
    refused(
        &format!("design poses {TX90} --count 60 --generate 100 --change-deg 120"),
        "candidates for 12 poses",
    );
    refused(
        &format!("design poses {TX90} --count 20 --cone-deg 0.5 --generate 20"),
        "stands outside the cone of 0.500° (nearest: ",
    );
    // 2 m away, of which the arm and the rod make most: the ball misses by the rest
    let far = sandbox.read(TX90).replace("[100.0000, -200.0000, 50.0000]", "[2000.0, -200.0, 50.0]");
    sandbox.write("campaigns/tx90-5/far.toml", &far);
    refused(
        "design poses campaigns/tx90-5/far.toml --count 20",
        "clamp 5 cannot be reached: the ball comes no nearer than ",
    );
    // an obstacle of every kind says by how much
    refused(
        &format!("design poses {TX90} --count 20 --table-mm 900 --generate 20"),
        "the arm is near or below the table (by ",
    );
    refused(
        &format!("design poses {TX90} --count 20 --clear-mm 700 --generate 20"),
        "arm or rod is within the block about a clamp (700 mm; by ",
    );
    sandbox.write("p.csv", "pose,q1_deg\n1,3\n");
    refused(&format!("design poses {TX90} --count 20 --candidates p.csv"), "p.csv:1");
    let joints = "q1_deg,q2_deg,q3_deg,q4_deg,q5_deg,q6_deg";
    sandbox.write("p.csv", &format!("pose,clamp,{joints}\n1,7,0,0,0,0,0,0\n"));
    refused(&format!("design poses {TX90} --count 20 --candidates p.csv"), "p.csv:2:3: clamp is \"7\"");
    sandbox.write("p.csv", &format!("pose,{joints}\n1,0,0,0,0,0,0\n"));
    refused(&format!("design poses {TX90} --count 20 --candidates p.csv"), "of 1 poses none can be measured");
    refused(&format!("compare {TX90} --noise-um 3"), "--forecast");
}
