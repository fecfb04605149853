//! The Pareto front of rods, as a designer asks for them.

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
    let table = sandbox.read("o/designs.csv");
    assert_eq!(table.lines().count(), front.len() + 1);
    // each has its intervals there, as in the JSON
    let cell = |line: &str, name: &str| {
        let at = table.lines().next().unwrap().split(',').position(|head| head == name).expect("a column");
        line.split(',').nth(at).unwrap().parse::<f64>().unwrap()
    };
    for (line, design) in table.lines().skip(1).zip(front) {
        let [low, high] = [0, 1].map(|end| design["intervals"]["c_rod_um"][end].as_f64().unwrap());
        assert!((cell(line, "c_rod_um_half_95") / (0.5 * (high - low)) - 1.0).abs() < 1e-2, "{line}");
    }
    // in words, and not by the keys of a file
    let page = sandbox.read("o/index.html");
    assert!(page.contains("mass, at most 900.0 g") && !page.contains("max_mass_g ="));
    for card in ["Keep all limits", "On the front", "c_rod, smallest", "reach, largest", "Rod 5#"] {
        assert!(page.contains(&format!("<span class=\"label\">{card}")), "{card}");
    }
}

/// 30 mm that became 30 µm: a beam of this size is none.
#[test]
fn a_rod_that_bends_beyond_belief_is_remarked() {
    let sandbox = sandbox();
    let soft = TUBES.replace("32,28", "3,2.5");
    sandbox.write("tubes.csv", &soft);
    sandbox.write("design.toml", &DESIGN.replace("min_first_frequency_hz = 20\n", ""));
    let said = |sandbox: &Sandbox| sandbox.run("design rod design.toml").succeeded().stderr;
    assert!(!said(&sandbox).contains("linear model"));
    sandbox.write(
        "tubes.csv",
        &soft.replace("thin,steel,32,30,12\n", "").replace("light,aluminium,40,36,14\n", ""),
    );
    assert!(said(&sandbox).contains("by more than 10 % of the length"), "{}", said(&sandbox));
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
        modes.iter().find(|row| row["mode"] == mode).unwrap()["rms"].as_f64().unwrap()
    };
    assert!(ranked.windows(2).all(|two| rms(&two[0], "fea") <= rms(&two[1], "fea")));
    // what is compensated is as good as a rigid rod; what is not is worse
    assert!(ranked.iter().all(|one| rms(one, "fea") <= rms(one, "none")));
    let said = sandbox.run(line).succeeded().stdout.split_whitespace().collect::<Vec<_>>().join(" ");
    assert!(said.contains("For this robot"));
    // the answer comes first
    let least = rodcal::units::significant(rms(&ranked[0], "fea"), 3);
    let name = ranked[0]["rod"].as_str().unwrap();
    let words = format!("{name} leaves this robot the smallest error in mode fea: {least} µm rms");
    let at = said.find(&words).expect("it is said");
    assert!(at < said.find("The front").unwrap());
    // with too few poses no rod can be measured: as `design poses` has it
    let few = sandbox.run(&line.replace("--count 15", "--count 2"));
    assert!(few.status == Some(2) && few.stdout.is_empty(), "{}", few.stderr);
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
    let answer = sandbox.run("design rod design.toml");
    assert_eq!(answer.status, Some(1), "{}", answer.stderr);
    assert!(
        answer.stdout.starts_with("None of 162 rods keeps all limits. One would do: relax max_mass_g to 3"),
        "{}",
        answer.stdout
    );
    let json = sandbox.run("design rod design.toml --json").json();
    assert_eq!((&json["feasible"], &json["relax"][0]["constraint"]), (&0.into(), &"max_mass_g".into()));
    assert_eq!(json["nearest"]["constraints"][0]["constraint"], "max_mass_g");

    // two at once, each by name with what it would have to be
    let two = DESIGN.replace("= 900", "= 10").replace("min_first_frequency_hz = 20", "min_reach_mm = 5000");
    sandbox.write("design.toml", &two);
    let in_one_line = |text: &str| text.split_whitespace().collect::<Vec<_>>().join(" ");
    let said = in_one_line(&sandbox.run("design rod design.toml").stdout);
    assert!(said.contains("The nearest needs several at once: relax max_mass_g to"), "{said}");
    assert!(said.contains("and min_reach_mm to"), "{said}");
    let json = sandbox.run("design rod design.toml --json").json();
    assert_eq!(json["relax"].as_array().unwrap().len(), 0);
    let needed = json["nearest"]["constraints"].as_array().unwrap();
    assert!(needed.len() == 2 && needed.iter().all(|one| one["needed"].is_number()), "{needed:?}");
    assert!(json["nearest"]["rod"]["geometry"]["l1_mm"].is_number());

    // no combination is a rod
    sandbox.write("design.toml", &DESIGN.replace("gamma_deg", "bend_radius_mm = 700\ngamma_deg"));
    let answer = sandbox.run("design rod design.toml");
    assert_eq!(answer.status, Some(1));
    assert!(
        in_one_line(&answer.stdout).contains("can be built: the bend does not fit between the pipes"),
        "{}",
        answer.stdout
    );
}

#[test]
fn an_empty_design_space_is_refused_and_nothing_is_written() {
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
    refused(
        &DESIGN.replace("tubes.csv", "pipes.csv"),
        run,
        "design.toml:6:8: `catalogue.file` is \"pipes.csv\"",
    );
    refused(
        &DESIGN.replace("[90, 120]", "\"right\""),
        run,
        "design.toml:4:13: `geometry.gamma_deg` is \"right\"",
    );
    refused(DESIGN, "design rod design.toml --resume nowhere/kept --out o", "a folder that exists");
    assert!(!sandbox.path().join("nowhere").exists());
    refused(DESIGN, "design rod design.toml --refine 99 --out o", "designs of the front");
    let huge = DESIGN
        .replace("step = 25", "step = 0.01")
        .replace("[100, 150, 200]", "{ from = 100, to = 900, step = 0.01 }");
    refused(&huge, run, "hours of computing");
    refused(DESIGN, "design rod design.toml --samples 0 --out o", "at least one rod to look at");
    sandbox.write("design.toml", &huge);
    let sampled = sandbox.run("design rod design.toml --samples 500").succeeded();
    assert!(sampled.stderr.contains("better rods may be among the others"), "{}", sampled.stderr);
}

#[test]
fn a_search_that_was_killed_goes_on_and_says_the_same() {
    let sandbox = sandbox();
    let many = DESIGN
        .replace("step = 25", "step = 0.1")
        .replace("[100, 150, 200]", "{ from = 100, to = 200, step = 2 }")
        .replace("min_first_frequency_hz = 20", "min_reach_mm = 300")
        .replace("maximise = [\"reach_mm\"]\n", "");
    sandbox.write("design.toml", &many);
    let whole = sandbox.run("design rod design.toml --json").succeeded().stdout;
    let line = ["design", "rod", "design.toml", "--json", "--resume", "kept"];
    let mut running = sandbox.command(&line).spawn().unwrap();
    // kept first after a block of the search, of which there are three
    while running.try_wait().unwrap().is_none() && !sandbox.path().join("kept").exists() {
        std::thread::sleep(std::time::Duration::from_millis(5));
    }
    running.kill().unwrap();
    running.wait().unwrap();
    assert_eq!(sandbox.run(&line.join(" ")).succeeded().stdout, whole);
    // what is done is done, and another design space is another search
    assert_eq!(sandbox.run(&line.join(" ")).succeeded().stdout, whole);
    sandbox.write("design.toml", &many.replace("= 900", "= 800"));
    let refused = sandbox.run(&line.join(" "));
    assert!(
        refused.status == Some(2) && refused.stderr.contains("another design file"),
        "{}",
        refused.stderr
    );
}

#[test]
fn a_design_is_refined_and_its_rod_is_written() {
    let sandbox = sandbox();
    sandbox.write("design.toml", &DESIGN.replace("[100, 150, 200]", "{ from = 100, to = 200, step = 50 }"));
    let json = sandbox.run("design rod design.toml --refine 12 --out o --json").json();
    let (refined, front) = (&json["refined"], &json["front"]);
    assert_eq!(refined["from_design"], 12);
    let better = &refined["catalogue"];
    let number = |value: &serde_json::Value, key: &str| value[key].as_f64().unwrap();
    assert!(number(better, "gained_percent") > 0.0, "{refined}");
    assert!(number(better, "c_rod_um") < number(&front[11], "c_rod_um"));
    assert!(number(better, "reach_mm") >= number(&front[11], "reach_mm") - 1e-6);
    assert!(number(better, "mass_g") <= 900.0 && number(better, "first_frequency_hz") >= 20.0);
    let rod = sandbox.run("compliance o/refined.toml --json").json();
    assert!((number(&rod, "c_rod_um") / number(better, "c_rod_um") - 1.0).abs() < 1e-9);
    let beyond = sandbox.run("design rod design.toml --refine 999");
    assert!(beyond.status == Some(2) && beyond.stderr.contains("designs of the front"), "{}", beyond.stderr);
    // and what counts: 1 % more of E and G is 1 % less of C^F
    let counts = json["front"][0]["one_percent_more"].as_array().unwrap();
    let of_name = |name: &str| {
        let row = counts.iter().find(|row| row["number"].as_str().unwrap().starts_with(name)).unwrap();
        number(row, "cf_max_um_per_n_percent")
    };
    assert!((of_name("E of") + of_name("G of") + 1.0).abs() < 1e-9, "{counts:?}");
    assert!(sandbox.run("design rod design.toml").succeeded().stdout.contains("wall of both pipes"));
}
