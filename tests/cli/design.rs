//! Rods that none betters, as a designer asks for them.

use super::Sandbox;

const DESIGN: &str = "\
[geometry]
l1_mm = [100, 150, 200]
l2_mm = { from = 400, to = 600, step = 25 }
gamma_deg = [90, 120]
[catalogue]
file = \"tubes.csv\"
[tip]
mass_g = 60
[constraints]
max_mass_g = 900
min_first_frequency_hz = 20
[objectives]
minimise = [\"c_rod_um\"]
maximise = [\"reach_mm\"]
";
const TUBES: &str = "\
name,material,outer_diameter_mm,inner_diameter_mm,price_per_m
thin,steel,32,30,12
thick,steel,32,28,15
light,aluminium,40,36,14
";

fn sandbox() -> Sandbox {
    let sandbox = Sandbox::new();
    sandbox.write("design.toml", DESIGN);
    sandbox.write("tubes.csv", TUBES);
    sandbox
}

#[test]
fn the_front_has_the_promised_keys_and_its_rods_are_rods() {
    let sandbox = sandbox();
    let json = sandbox.run("design rod design.toml --base rods/5.toml --out o --json").json();
    assert_eq!(json["evaluated"], 3 * 9 * 2 * 3);
    let front = json["front"].as_array().unwrap();
    assert!(front.len() > 5 && json["feasible"].as_u64().unwrap() >= front.len() as u64);
    let number = |design: &serde_json::Value, key: &str| design[key].as_f64().unwrap();
    for two in front.windows(2) {
        // sorted by the first goal; what reaches farther is softer
        assert!(number(&two[0], "c_rod_um") <= number(&two[1], "c_rod_um"));
        assert!(number(&two[0], "reach_mm") <= number(&two[1], "reach_mm"));
    }
    for key in ["cf_max_um_per_n", "cg_max_um_per_g", "first_frequency_hz", "reach_mm"] {
        assert!(number(&front[0], key) > 0.0, "{key}");
    }
    assert!(front[0]["rod"]["geometry"]["l1_mm"].is_number(), "{}", front[0]["rod"]);
    assert!(json["infeasible_because"]["max_mass_g"].is_u64() && json["base"]["bettered_by"].is_u64());
    // the file of a design says of its rod what the design says
    let rod = sandbox.run("compliance o/design-001.toml --json").json();
    let close = |a: f64, b: f64| (a / b - 1.0).abs() < 1e-9;
    assert!(close(number(&rod, "c_rod_um"), number(&front[0], "c_rod_um")), "{rod}");
    assert!(close(number(&rod, "mass_g"), number(&front[0], "mass_g")));
    assert_eq!(sandbox.read("o/designs.csv").lines().count(), front.len() + 1);
}

#[test]
fn designs_are_ranked_by_the_accuracy_that_a_robot_will_have() {
    let sandbox = sandbox();
    sandbox
        .write("design.toml", &DESIGN.replace("[100, 150, 200]", "150").replace("step = 25", "step = 100"));
    let line = "design rod design.toml --base rods/5.toml --campaign campaigns/tx90-5/campaign.toml --objective forecast \
                --count 15";
    let json = sandbox.run(&format!("{line} --json")).json();
    let ranked = json["for_robot"]["ranked"].as_array().unwrap();
    assert!(ranked.len() > 3 && ranked.iter().any(|one| one["rod"] == "5#"), "{ranked:?}");
    let rms = |one: &serde_json::Value, mode: &str| {
        let modes = one["modes"].as_array().unwrap();
        modes.iter().find(|of| of["mode"] == mode).unwrap()["rms"].as_f64().unwrap()
    };
    assert!(ranked.windows(2).all(|two| rms(&two[0], "fea") <= rms(&two[1], "fea")));
    // what is compensated is as good as a rigid rod; what is not is worse
    assert!(ranked.iter().all(|one| rms(one, "fea") <= rms(one, "none")));
    assert!(sandbox.run(line).succeeded().stdout.contains("For this robot"));
    let half = sandbox.run("design rod design.toml --campaign campaigns/tx90-5/campaign.toml");
    assert!(half.status == Some(2) && half.stderr.contains("--objective"), "{}", half.stderr);
}

#[test]
fn the_front_does_not_depend_on_the_number_of_threads() {
    let sandbox = sandbox();
    let [one, four] = ["1", "4"].map(|threads| {
        let mut command = sandbox.command(&["design", "rod", "design.toml", "--json"]);
        command.env("RAYON_NUM_THREADS", threads).output().unwrap().stdout
    });
    assert_eq!(one, four);
}

#[test]
fn where_nothing_fits_it_says_what_would() {
    let sandbox = sandbox();
    sandbox.write("design.toml", &DESIGN.replace("= 900", "= 250"));
    let answer = sandbox.run("design rod design.toml").succeeded();
    assert!(
        answer.stdout.starts_with("None of 162 rods keeps all limits. One would do: relax max_mass_g to 3"),
        "{}",
        answer.stdout
    );
    let json = sandbox.run("design rod design.toml --json").json();
    assert_eq!((&json["feasible"], &json["relax"][0]["constraint"]), (&0.into(), &"max_mass_g".into()));
}

#[test]
fn a_wish_that_cannot_be_granted_is_refused_and_nothing_is_written() {
    let sandbox = sandbox();
    let refused = |design: &str, line: &str, expected: &str| {
        sandbox.write("design.toml", design);
        let answer = sandbox.run(line);
        assert_eq!((answer.status, answer.stdout.as_str()), (Some(2), ""), "{line}");
        assert!(answer.stderr.contains(expected), "{}", answer.stderr);
        assert!(!sandbox.path().join("o").exists());
    };
    let run = "design rod design.toml --out o";
    refused(&DESIGN.replace("to = 600", "to = 300"), run, "design.toml:3:9: `geometry.l2_mm` is");
    refused(&DESIGN.replace("tubes.csv", "pipes.csv"), run, "pipes.csv");
    let huge = DESIGN
        .replace("step = 25", "step = 0.01")
        .replace("[100, 150, 200]", "{ from = 100, to = 900, step = 0.01 }");
    refused(&huge, run, "hours of computing");
    refused(DESIGN, "design rod design.toml --samples 0 --out o", "at least one rod to look at");
    sandbox.write("design.toml", &huge);
    let sampled = sandbox.run("design rod design.toml --samples 500").succeeded();
    assert!(sampled.stderr.contains("better rods may be among the others"), "{}", sampled.stderr);
}
