//! What cannot be done ends with status 2 and one clear error, and leaves no trace.

use super::{Answer, Sandbox};

/// What is typed, how the error begins, and a word that tells what would be right.
const CASES: [(&str, &str, &str); 32] = [
    // arguments
    ("frobnicate", "unrecognized subcommand 'frobnicate'", "--help"),
    ("complianze rods/5.toml", "unrecognized subcommand 'complianze'", "'compliance'"),
    ("fit rods/5.toml", "unrecognized subcommand 'fit'", "'rig fit'"),
    ("compliance", "the following required arguments were not provided", "<ROD>"),
    ("rig fit linear", "the following required arguments were not provided", "<READINGS>"),
    ("compliance rods/5.toml --wrong", "unexpected argument '--wrong'", "--help"),
    ("compliance rods/5.toml rods/2.toml", "unexpected argument 'rods/2.toml'", "Usage"),
    ("compliance rods/5.toml --mode meas", "invalid value 'meas' for '--mode <MODE>'", "calc, fea"),
    ("compliance rods/5.toml --theory reissner", "invalid value 'reissner'", "euler-bernoulli, timoshenko"),
    ("compliance rods/5.toml --elements 0", "invalid value '0' for '--elements", "from 1 to 1000000"),
    ("compliance rods/5.toml --elements 1000001", "invalid value '1000001'", "from 1 to 1000000"),
    ("compliance rods/5.toml --elements -3", "unexpected argument '-3'", "--help"),
    ("rig fit rods/5.toml stiffness_data/5.csv --elements 0", "invalid value '0'", "from 1 to 1000000"),
    ("compliance rods/5.toml --contact-force nan", "invalid value 'nan'", "a force in N, 0 or more"),
    ("compliance rods/5.toml --contact-force inf", "invalid value 'inf'", "a force in N, 0 or more"),
    ("compliance rods/5.toml --contact-force -1", "invalid value '-1'", "a force in N, 0 or more"),
    (
        "compliance rods/5.toml --damping-percent 0",
        "invalid value '0'",
        "a damping in %, above 0 and below 100",
    ),
    ("compliance rods/5.toml --load-station -1", "`station` is -1.000 mm", "0 to 675.000 mm"),
    ("compliance rods/5.toml --read-station nan", "`station` is NaN mm", "0 to 675.000 mm"),
    ("rig fit linear stiffness_data/5.csv --robust cauchy", "invalid value 'cauchy'", "huber, tukey"),
    ("completions tcsh", "invalid value 'tcsh'", "fish"),
    // files
    ("compliance nowhere.toml", "cannot read nowhere.toml: ", "No such file"),
    ("compliance rods", "cannot read rods: ", "name the file that is meant"),
    ("rig fit rods/5.toml nowhere.csv", "cannot read nowhere.csv: ", "No such file"),
    ("compliance bad.toml", "bad.toml:3:9: `geometry.l1_mm` is -150", "> 0"),
    ("compliance stiffness_data/5.csv", "stiffness_data/5.csv:", "="),
    ("rig fit linear bad.csv", "bad.csv:3:5: dz_um is \"12,5.0\"", "a number"),
    ("rig fit linear rods/5.toml", "rods/5.toml:7:1: the first line is", "TOML"),
    ("diagnose rig rods/5.toml nowhere.csv", "cannot read nowhere.csv: ", "No such file"),
    ("diagnose rig bad.toml stiffness_data/5.csv", "bad.toml:3:9: `geometry.l1_mm` is -150", "> 0"),
    ("diagnose rig linear bad.csv", "bad.csv:3:5: dz_um is \"12,5.0\"", "a number"),
    // models
    ("compliance rods/2.toml --mode calc", "Calc mode for rod \"2#\" is not possible", "--mode fea"),
];

/// Where nothing can be written: a file in the place of the directory or of one above it.
const PLACES: [(&str, &str); 2] = [
    ("rods/5.toml", "`--out` is rods/5.toml, which is a file, expected a directory"),
    ("rods/5.toml/report", "cannot create rods/5.toml/report: "),
];

fn sandbox() -> Sandbox {
    let sandbox = Sandbox::new();
    let rod = sandbox.read("rods/5.toml");
    let bad = format!("name = \"bad\"\n[geometry]\nl1_mm = -150\n{}", &rod[rod.find("l2_mm").unwrap()..]);
    sandbox.write("bad.toml", &bad);
    sandbox.write("bad.csv", "axis,load_n,dz_um\nz,5,12.5\nz,6,\"12,5.0\"\n");
    sandbox
}

fn assert_refused(answer: &Answer, begins: &str, tells: &str) {
    let Answer { line, status, stdout, stderr } = answer;
    let say = format!("rodcal {line}\nstatus {status:?}\n{stdout}\n{stderr}");
    assert_eq!(*status, Some(2), "{say}");
    assert_eq!(stdout, "", "{say}");
    assert!(stderr.starts_with(&format!("error: {begins}")), "expected: {begins}\n{say}");
    assert!(stderr.contains(tells), "expected: {tells}\n{say}");
    assert_eq!(stderr.matches("error:").count(), 1, "{say}");
    assert!(!stderr.contains("warning:") && !stderr.contains("panicked"), "{say}");
    // clap adds usage and tips to errors of arguments; ours are the error and at most a hint
    if !stderr.contains("--help") && !stderr.contains("Usage") {
        let others: Vec<&str> = stderr.lines().skip(1).collect();
        assert!(matches!(others[..], [] | [_]), "{say}");
        assert!(others.iter().all(|line| line.starts_with("hint: ")), "{say}");
    }
}

#[test]
fn what_cannot_be_done_is_one_error_and_leaves_no_trace() {
    let sandbox = sandbox();
    let before = sandbox.listing();
    for (line, begins, tells) in CASES {
        let all = format!(" --json{} --out new/report", super::PNG);
        for more in ["", " --json", " --out new/report", &all] {
            assert_refused(&sandbox.run(&format!("{line}{more}")), begins, tells);
        }
    }
    assert!(before == sandbox.listing(), "something was written");
}

#[test]
fn where_nothing_can_be_written_nothing_is_said_or_done() {
    let sandbox = sandbox();
    let before = sandbox.listing();
    let [(file, at_once), (below_a_file, when_written)] = PLACES;
    for (number, command) in super::REPORTS.into_iter().enumerate() {
        let forms = ["", " --json"];
        for more in forms {
            assert_refused(&sandbox.run(&format!("{command} --out {file}{more}")), at_once, "");
        }
        // this one is only met after everything is calculated
        let more = forms[number % 2];
        let answer = sandbox.run(&format!("{command} --out {below_a_file}{more}"));
        assert_refused(&answer, when_written, "");
    }
    assert!(before == sandbox.listing(), "something was written");
}

#[test]
fn a_demo_that_cannot_write_its_report_says_so() {
    let sandbox = Sandbox::empty();
    sandbox.write("reports", "a file");
    assert_refused(&sandbox.run("demo"), "cannot create reports/demo: ", "");
    assert_eq!(sandbox.listing().len(), 1);
}

#[test]
fn errors_read_well() {
    let sandbox = sandbox();
    let lines = [
        "compliance rods/2.toml --mode calc",
        "compliance bad.toml",
        "rig fit linear bad.csv",
        "compliance rods/5.toml --contact-force nan",
        "compliance rods/5.toml --out rods/2.toml",
    ];
    let told = lines.map(|line| format!("$ rodcal {line}\n{}", sandbox.run(line).stderr));
    super::words::assert_reads("errors", &told.join("\n"));
}

/// A modulus in MPa where GPa is asked for: the first words say so, on stderr and on stdout.
#[test]
fn a_rod_that_bends_too_far_is_said_first() {
    let sandbox = Sandbox::new();
    let rod = sandbox.read("rods/5.toml");
    sandbox.write("rods/soft.toml", &rod.replace("l2_mm = 525.0", "l2_mm = 525000.0"));
    let answer = sandbox.run("compliance rods/soft.toml").succeeded();
    let says = "Rod 5# is beyond this model: under its own weight its tip would move by";
    assert!(answer.stdout.starts_with(says), "{}", answer.stdout);
    assert!(answer.stderr.starts_with(&format!("warning: {says}")), "{}", answer.stderr);
    assert!(!sandbox.run("compliance rods/5.toml").succeeded().stdout.contains("beyond this model"));
}

/// What a rod does not bear is said before how much it bends: its material where that states a
/// strength, its wall where it is a foil.
#[test]
fn a_rod_that_breaks_is_said_first() {
    let sandbox = Sandbox::new();
    let text = sandbox.read("rods/5.toml");
    let density = "density_kg_m3 =";
    let rods = [
        (
            text.replace(density, &format!("yield_strength_mpa = 5\n{density}")),
            "Rod 5# would stay bent: under",
        ),
        (
            text.replace("inner_diameter_mm = 30.0", "inner_diameter_mm = 31.984"),
            "The wall of rod 5# would buckle: under",
        ),
    ];
    for (rod, says) in rods {
        assert_ne!(rod, text);
        sandbox.write("rod.toml", &rod);
        let answer = sandbox.run("compliance rod.toml --contact-force 10").succeeded();
        assert!(answer.stdout.starts_with(says), "{}", answer.stdout);
        assert!(answer.stderr.starts_with(&format!("warning: {says}")), "{}", answer.stderr);
        assert!(answer.stdout.contains("at station 0 mm"));
    }
    sandbox.write("rod.toml", &text.replace(density, &format!("yield_strength_mpa = 205\n{density}")));
    assert!(!sandbox.run("compliance rod.toml").succeeded().stdout.contains("MPa"));
    sandbox.write("rod.toml", &text.replace(density, &format!("yield_strength_mpa = -1\n{density}")));
    assert!(sandbox.run("compliance rod.toml").stderr.contains("yield_strength_mpa"));
}
