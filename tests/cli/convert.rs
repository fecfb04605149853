//! examples/convert.py: what common instruments export becomes measurements. Skipped, with a word,
//! where there is no Python.

use std::path::Path;
use std::process::Command;

use super::Sandbox;

/// Runs the converter in the sandbox; `None` where there is no Python.
#[allow(clippy::print_stderr)]
fn convert(sandbox: &Sandbox, line: &str) -> Option<Result<String, String>> {
    let script = Path::new(env!("CARGO_MANIFEST_DIR")).join("examples/convert.py");
    let run = Command::new("python3").arg(script).args(line.split(' ')).current_dir(sandbox.path()).output();
    let Ok(output) = run else {
        eprintln!("skipped: no python3 to run examples/convert.py");
        return None;
    };
    let text = |bytes| String::from_utf8(bytes).unwrap();
    Some(if output.status.success() { Ok(text(output.stdout)) } else { Err(text(output.stderr)) })
}

/// Numbers of a row, from the column `from` on.
fn numbers(row: &str, from: usize) -> Vec<f64> {
    row.split(',').skip(from).map(|cell| cell.parse().unwrap()).collect()
}

/// The poses of a recording in radians, their points in metres and another order: the same
/// recording comes back, and is one that a robot is calibrated with.
#[test]
fn points_of_a_tracker_and_joint_values_are_a_recording() {
    let sandbox = Sandbox::new();
    let recorded = sandbox.read("campaigns/tx90-5/validation.csv");
    let rows: Vec<&str> = recorded.lines().skip(2).collect();
    let mut joints = "name,q1,q2,q3,q4,q5,q6\n".to_owned();
    let mut points = vec!["// exported, metres".to_owned()];
    for row in &rows {
        let values = numbers(row, 1);
        let radians: Vec<String> = values[..6].iter().map(|q| format!("{:.9}", q.to_radians())).collect();
        let metres: Vec<String> = values[6..].iter().map(|x| format!("{:.9}", x / 1000.0)).collect();
        let name = row.split(',').next().unwrap();
        joints += &format!("P{name},{}\n", radians.join(","));
        points.insert(1, format!("P{name}\t{}", metres.join("\t")));
    }
    sandbox.write("joints.csv", &joints);
    sandbox.write("points.txt", &points.join("\n"));
    let Some(said) =
        convert(&sandbox, "tracker joints.csv points.txt measurements.csv --angle rad --length m")
    else {
        return;
    };
    assert_eq!(said.unwrap(), "measurements.csv: 30 rows\n");
    let converted = sandbox.read("measurements.csv");
    for (row, again) in rows.iter().zip(converted.lines().skip(1)) {
        for (before, after) in numbers(row, 1).iter().zip(numbers(again, 1)) {
            assert!((before - after).abs() < 2e-6, "{row}\n{again}");
        }
    }
    sandbox.write(
        "campaign.toml",
        "robot = \"builtin:tx90\"\nmeasurements = \"measurements.csv\"\n[base]\nxyz_mm = [-620, 30, -160]\n",
    );
    let rms = &sandbox.run("calibrate campaign.toml --json").json()["residual"]["rms_um"];
    assert!(rms.as_f64().unwrap() < 100.0, "{rms}");

    let fewer = format!("{}\n", points[..points.len() - 1].join("\n"));
    sandbox.write("points.txt", &fewer);
    let refused = convert(&sandbox, "tracker joints.csv points.txt m.csv --angle rad --length m").unwrap();
    let expected = "convert.py: points.txt: other names than those of the joint values, or a name twice\n";
    assert_eq!(refused.unwrap_err(), expected);
    assert!(!sandbox.path().join("m.csv").exists());
}

/// ROS sorts joints by name; the robot does not. Two standstills, a move between them.
#[test]
fn joint_states_become_poses_in_the_order_of_the_robot() {
    let sandbox = Sandbox::empty();
    let mut states = "%time,field.name0,field.name1,field.position0,field.position1\n".to_owned();
    for step in 0..50_u64 {
        let (elbow, shoulder) = match step {
            0..20 => (0.5, 1.0),
            20..30 => (0.5 + 0.01 * (step - 19) as f64, 1.0),
            _ => (0.6, -1.0),
        };
        states += &format!("{},elbow,shoulder,{elbow},{shoulder}\n", 1_700_000_000 + step * 100_000_000);
    }
    sandbox.write("states.csv", &states);
    sandbox.write("points.txt", "1 2 3\n4 5 6\n");
    let line = "bag states.csv points.txt m.csv --angle rad --length mm --time ns --joints shoulder,elbow";
    let Some(said) = convert(&sandbox, line) else { return };
    said.unwrap();
    assert_eq!(
        sandbox.read("m.csv"),
        "pose,q1_deg,q2_deg,x_mm,y_mm,z_mm,time_s\n\
         1,57.295780,28.647890,1.00000,2.00000,3.00000,1.900\n\
         2,-57.295780,34.377468,4.00000,5.00000,6.00000,4.900\n"
    );
    sandbox.write("points.txt", "1 2 3\n");
    let kept = convert(&sandbox, line).unwrap().unwrap_err();
    assert_eq!(kept, "convert.py: m.csv is there already: give another name, or --force\n");
    let line = &format!("{line} --force");
    let refused = convert(&sandbox, line).unwrap().unwrap_err();
    assert_eq!(refused, "convert.py: 2 rows of joint values, 1 points: expected as many\n");
    let unknown = convert(&sandbox, &line.replace("shoulder,elbow", "shoulder,wrist")).unwrap().unwrap_err();
    assert_eq!(unknown, "convert.py: states.csv:1: 0 columns for the joint wrist, expected one\n");
}

/// A folder for a placement, a file for a socket: one table, and a campaign that leaves out each
/// placement.
#[test]
fn folders_of_placements_become_campaigns() {
    let sandbox = Sandbox::empty();
    for (place, first) in [("front", 10.0), ("left", 20.0)] {
        std::fs::create_dir_all(sandbox.path().join("recordings").join(place)).unwrap();
        for socket in [0, 1] {
            let file = format!("recordings/{place}/hole_{socket}.csv");
            sandbox.write(&file, &format!("joint1,joint2\n{first},{socket}\n"));
        }
    }
    let line = "sockets recordings made --angle deg --urdf arm.urdf --base-link base --tip-link ball";
    let Some(said) = convert(&sandbox, line) else { return };
    said.unwrap();
    assert_eq!(
        sandbox.read("made/all.csv"),
        "pose,placement,socket,q1_deg,q2_deg\n\
         1,front,0,10.000000,0.000000\n2,front,1,10.000000,1.000000\n\
         3,left,0,20.000000,0.000000\n4,left,1,20.000000,1.000000\n"
    );
    assert_eq!(
        sandbox.read("made/holdout-left.toml"),
        "robot = \"../arm.urdf\"\nbase_link = \"base\"\ntip_link = \"ball\"\n\
         measurements = \"without-left.csv\"\nvalidation = \"only-left.csv\"\n\n[sockets]\ndistance_mm = 50.0\n"
    );
    assert_eq!(sandbox.read("made/without-left.csv").lines().count(), 3);
}

/// A real recording, taken apart into such folders, comes back byte for byte, and a placement that
/// was left out is predicted as well. Skipped where the recordings are not beside the project.
#[test]
#[allow(clippy::print_stderr)]
fn a_recording_in_sockets_comes_back() {
    let real = Path::new(env!("CARGO_MANIFEST_DIR")).join("../shared/real/mukca/kuka_14");
    let Ok(all) = std::fs::read_to_string(real.join("all.csv")) else {
        eprintln!("skipped: there is no ../shared/real/mukca/kuka_14");
        return;
    };
    let sandbox = Sandbox::empty();
    std::fs::copy(real.join("robot.urdf"), sandbox.path().join("robot.urdf")).unwrap();
    let mut files = std::collections::BTreeMap::<String, String>::new();
    for row in all.lines().skip(1) {
        let [_, placement, socket, joints] = row.splitn(4, ',').collect::<Vec<_>>()[..] else {
            panic!("{row}")
        };
        let file = files.entry(format!("recordings/{placement}/hole_{socket}.csv"));
        *file.or_insert_with(|| "q1,q2,q3,q4,q5,q6,q7\n".into()) += &format!("{joints}\n");
    }
    for (file, text) in &files {
        std::fs::create_dir_all(sandbox.path().join(file).parent().unwrap()).unwrap();
        sandbox.write(file, text);
    }
    let line =
        "sockets recordings made --angle deg --urdf robot.urdf --base-link base_link --tip-link ball_link";
    let Some(said) = convert(&sandbox, line) else { return };
    said.unwrap();
    assert_eq!(sandbox.read("made/all.csv"), all);
    let errors = |campaign: &str| {
        let json = sandbox.run(&format!("calibrate {campaign} --json")).json();
        json["validation"].clone()
    };
    let original = errors(&real.join("holdout-front.toml").display().to_string());
    assert!(original["rms_um"].is_number() && errors("made/holdout-front.toml") == original, "{original}");
}
