//! Good campaigns: what is read from them, in SI units and in {W}, and what is warned about.

#![allow(clippy::unwrap_used)]

pub(crate) mod desk;

use std::f64::consts::FRAC_PI_2;
use std::path::Path;

use desk::Desk;
use nalgebra::Vector3;
use rodcal::calibration::Campaign;
use rodcal::calibration::campaign::{Distance, Recording, Refit, Targets, Warning};
use rodcal::robot::Parameter;

fn read(desk: &Desk) -> Campaign {
    desk.read().unwrap_or_else(|error| panic!("{error}"))
}

fn assert_near(a: &Vector3<f64>, b: [f64; 3]) {
    assert!((a - Vector3::from(b)).norm() < 1e-12, "{a} is not {b:?}");
}

fn points(recording: &Recording) -> &[Vector3<f64>] {
    match &recording.targets {
        Targets::Points(points) => points,
        _ => panic!("no points"),
    }
}

fn group_names(recording: &Recording) -> Vec<String> {
    recording.groups.iter().map(|group| group.name.to_string()).collect()
}

#[test]
fn a_campaign_with_clamps_is_read_in_si_and_in_w() {
    let campaign = read(&Desk::with_clamps());
    assert_eq!(campaign.file, "campaign.toml");
    assert_eq!((campaign.robot.name.as_str(), campaign.robot.joints.len()), ("SCARA", 3));
    assert_eq!(campaign.robot_file, "robot.toml");
    assert!(campaign.robot_text.contains("SCARA"));
    assert_eq!((campaign.base_link, campaign.tip_link), (None, None));
    assert_eq!(campaign.readings.unwrap().rows.len(), 2);
    assert_eq!(campaign.contact_force, Some(Vector3::new(1.1, 1.25, 1.05)));
    let tip = campaign.rod.unwrap().tip();
    assert_eq!(campaign.tool, tip);
    assert_near(&tip, [0.525, 0.0, 0.15]);
    assert_near(&Vector3::from_row_slice(&campaign.base[..3]), [0.01, 0.02, 0.03]);
    assert_near(&Vector3::from_row_slice(&campaign.base[3..]), [0.0, 0.0, FRAC_PI_2]);
    assert!(campaign.base_is_given);
    assert_eq!(campaign.refit, Refit::BaseTool);
    assert!((campaign.noise.unwrap() - 5e-6).abs() < 1e-18);
    assert_eq!(campaign.constraints.fixed, [Parameter::D(1), Parameter::Theta(0)]);
    assert_eq!(campaign.constraints.freed, [Parameter::Compliance(0)]);
    let [(parameter, value, sd)] = campaign.constraints.priors[..] else { panic!("one prior") };
    assert_eq!(parameter, Parameter::A(0));
    assert!((value - 0.2505).abs() < 1e-12 && (sd - 1e-4).abs() < 1e-12);
    assert_eq!(campaign.warnings, []);

    let measurements = campaign.measurements;
    assert_eq!((measurements.len(), measurements.joint_count), (3, 3));
    assert_eq!(group_names(&measurements), ["clamp 1", "clamp 2"]);
    assert_near(&Vector3::from_row_slice(measurements.joints(0)), [FRAC_PI_2 / 9.0, FRAC_PI_2 / 4.5, 0.03]);
    assert_near(&points(&measurements)[0], [0.4001, 0.0002, 0.1003]);
    // the second device's x is {W}'s y, and its y is {W}'s −x
    assert_near(&points(&measurements)[2], [-0.002, 0.401, 0.103]);
    let row = &measurements.rows[2];
    assert_eq!((row.pose.as_str(), row.line, row.group), ("1", 4, 1));
    assert_eq!((row.time, row.temperature), (Some(120.0), Some(21.0)));
    assert_eq!(measurements.rows[1].temperature, None);

    let validation = campaign.validation.unwrap();
    assert_eq!(group_names(&validation), [""]);
    assert_near(&points(&validation)[1], [0.3, 0.2, 0.18]);
}

#[test]
fn a_tracker_needs_a_robot_and_positions_only() {
    let campaign = read(&Desk::with_tracker());
    assert_eq!((campaign.tool, campaign.base), (Vector3::zeros(), [0.0; 6]));
    assert!(!campaign.base_is_given);
    assert!(campaign.rod.is_none() && campaign.validation.is_none() && campaign.noise.is_none());
    assert_eq!(group_names(&campaign.measurements), [""]);
    assert_near(&points(&campaign.measurements)[0], [0.4, 0.1, 0.2]);
    assert_eq!(campaign.warnings, []);
}

#[test]
fn sockets_have_known_distances_where_both_are_there() {
    let campaign = read(&Desk::with_sockets());
    let measurements = &campaign.measurements;
    assert_eq!(group_names(measurements), ["front/0", "front/1", "left/1", "left/0", "back/0"]);
    let Targets::Sockets(distances) = &measurements.targets else { panic!("points") };
    assert_eq!(distances.iter().map(|d| d.between).collect::<Vec<_>>(), [[0, 1], [3, 2]]);
    let Distance { value, sd, .. } = distances[0];
    assert!((value - 0.05).abs() < 1e-15 && (sd - 1e-4).abs() < 1e-15);
    assert_eq!((campaign.refit, campaign.base_is_given), (Refit::Nothing, false));
    assert_eq!(campaign.warnings, []);

    let precise = Desk::with_sockets().but("campaign.toml", "= 50", "= 50\ndistance_sd_mm = 0.01");
    let Targets::Sockets(distances) = read(&precise).measurements.targets else { panic!("points") };
    assert!((distances[1].sd - 1e-5).abs() < 1e-15);
}

#[test]
fn what_is_stated_replaces_the_default() {
    let stated = Desk::with_clamps()
        .but("campaign.toml", "[base]", "validation_refit = \"none\"\n[tool]\nxyz_mm = [1, 2, 3]\n[base]")
        .but("campaign.toml", "xyz_mm = [10, 20, 30]\n", "");
    let campaign = read(&stated);
    assert_near(&campaign.tool, [0.001, 0.002, 0.003]);
    assert_eq!((campaign.refit, campaign.base[0], campaign.base_is_given), (Refit::Nothing, 0.0, true));
}

#[test]
fn columns_stand_in_any_order_and_case_with_any_separator() {
    let mut desk = Desk::with_tracker();
    *desk.text("measurements.csv") =
        "# tracker\nZ_mm;y_mm;X_MM;Q3_mm;q2_deg;Q1_deg;Pose\n200;100,5;400;35;25;15;a\n".into();
    let campaign = read(&desk);
    assert_near(&points(&campaign.measurements)[0], [0.4, 0.1005, 0.2]);
    assert_eq!(desk.warnings(), ["measurements.csv: read with `;` separators and decimal commas"]);
}

#[test]
fn odd_files_are_read_with_a_warning() {
    let rows = |row: &dyn Fn(usize) -> String| (0..12).map(row).collect::<String>();
    let header = "pose,q1_deg,q2_deg,q3_mm,x_mm,y_mm,z_mm\n";
    let tracker = |text: String| {
        let mut desk = Desk::with_tracker();
        *desk.text("measurements.csv") = format!("{header}{text}");
        desk.warnings()
    };
    assert_eq!(
        tracker(rows(&|i| format!("{i},{},{},{},1,2,3\n", 0.3 * i as f64 - 1.0, 0.5 * i as f64, 10 * i))),
        [
            "measurements.csv: no angle is larger than 5.50: the angles look like radians, and are read as degrees"
        ]
    );
    // few poses near zero are no proof
    assert_eq!(tracker("1,1,2,3,1,2,3\n2,3,1,5,1,2,3\n".into()), [""; 0]);
    assert_eq!(
        tracker(rows(&|i| format!("{i},{},12.3{},{},{i}00,2,3\n", 13 * i, i % 2, 20 + i % 3))),
        [
            "measurements.csv: joint 1 is beyond its limits -130° to 130° in 1 row, first in pose 11 (line 13, 143°): is it the same robot?",
            "measurements.csv: joint 2 moves by 0.01° in all: theta2 and c2 can hardly be distinguished from their neighbours; add poses in which it moves",
        ]
    );
    assert_eq!(
        tracker("1,10,20,-11,1,2,3\n2,20,30,-11.5,90,50,3\n".into()),
        [
            "measurements.csv: joint 3 is beyond its limits -10 mm to 150 mm in 2 rows, first in pose 1 (line 2, -11 mm): is it the same robot?",
            "measurements.csv: joint 3 moves by 0.5 mm in all: d3 can hardly be distinguished from their neighbours; add poses in which it moves",
        ]
    );
    assert_eq!(
        tracker("1,10,20,30,0.4,0.1,0.2\n2,100,25,60,0,0.4,0.2\n".into()),
        [
            "measurements.csv: the positions spread over 0.250 mm, those of the nominal robot over 318.407 mm: are they in millimetres?"
        ]
    );
    for (desk, file, piece, other, expected) in [
        (
            Desk::with_clamps(),
            "campaign.toml",
            "contact_force_n = [1.1, 1.25, 1.05]\n",
            "",
            "there is a rod and there are clamps, but no contact_force_n: the rod bends under gravity only",
        ),
        (
            Desk::with_clamps(),
            "campaign.toml",
            "rod = \"rod.toml\"\nrig = \"rig.csv\"\n",
            "",
            "there is a contact_force_n, but no rod for it to bend",
        ),
        (
            Desk::with_clamps(),
            "campaign.toml",
            "[noise]",
            "[[clamp]]\nid = \"3\"\nxyz_mm = [0, 0, 0]\n[noise]",
            "no row was measured in clamp 3",
        ),
        (
            Desk::with_clamps(),
            "campaign.toml",
            "[base]",
            "tip_link = \"ball\"\n[base]",
            "base_link and tip_link are for a URDF: they have no effect with this robot's file",
        ),
        (
            Desk::with_clamps(),
            "validation.csv",
            "b,25,45,55",
            "b,20,40,50",
            "1 of 2 validation poses are measurement poses too (pose b first): the validation is not independent",
        ),
        (
            Desk::with_clamps(),
            "measurements.csv",
            "time_s",
            "tine_s",
            "measurements.csv: the column \"tine_s\" is not read; did you mean time_s?",
        ),
        (
            Desk::with_tracker(),
            "campaign.toml",
            "robot =",
            "rod = \"rod.toml\"\ncontact_force_n = [0, 0, 1]\nrobot =",
            "there is a contact_force_n, but no clamp: its components are read as along {W}",
        ),
        (
            Desk::with_sockets(),
            "campaign.toml",
            "[sockets]",
            "validation_refit = \"base-tool\"\n[sockets]",
            "validation_refit = \"base-tool\" has no effect with sockets: only their points are fitted again",
        ),
    ] {
        let desk = desk.but(file, piece, other).beside("rod.toml");
        assert_eq!(desk.warnings(), [expected]);
    }
    let mut named = Desk::with_sockets();
    *named.text("measurements.csv") = named.text("measurements.csv").replace(",0,", ",left,");
    assert_eq!(
        named.warnings(),
        [
            "measurements.csv: no placement has a socket 0 and a socket 1, and so distance_mm is not used: nothing fixes the scale of the robot"
        ]
    );
    let mut foreign = Desk::with_clamps().but("validation.csv", "pose,", "clamp,pose,");
    *foreign.text("validation.csv") =
        foreign.text("validation.csv").replace("a,15", ",a,15").replace("b,25", ",b,25");
    assert_eq!(foreign.warnings(), ["validation.csv: the column \"clamp\" is not read"]);
}

/// Recordings that nobody here made; they lie beside the project and not in it.
#[test]
#[allow(clippy::print_stderr)]
fn real_campaigns_are_read() {
    let real = Path::new(env!("CARGO_MANIFEST_DIR")).join("../shared/real");
    let mut read_count = 0;
    for (file, joints, poses, validation) in [
        ("mukca/kuka_14/campaign.toml", 7, 180, None),
        ("mukca/kuka_14/holdout-front.toml", 7, 118, Some(62)),
        ("mukca/kuka_14/holdout-left_back.toml", 7, 118, Some(62)),
        ("mukca/kuka_14/holdout-raised_left.toml", 7, 124, Some(56)),
        ("mukca/panda_1/campaign.toml", 7, 182, None),
        ("mukca/panda_1/holdout-back-high.toml", 7, 122, Some(60)),
        ("mukca/panda_1/holdout-front.toml", 7, 120, Some(62)),
        ("mukca/panda_1/holdout-right.toml", 7, 122, Some(60)),
        ("mukca/panda_2_clean/campaign.toml", 7, 497, None),
        ("ur5/campaign.toml", 6, 1000, None),
    ] {
        let path = real.join(file);
        if !path.exists() {
            eprintln!("skipped: there is no {}", path.display());
            continue;
        }
        let campaign = Campaign::read(&path).unwrap_or_else(|error| panic!("{error}"));
        assert_eq!(campaign.robot.joints.len(), joints, "{file}");
        assert_eq!(campaign.measurements.len(), poses, "{file}");
        assert_eq!(campaign.validation.as_ref().map(Recording::len), validation, "{file}");
        if let Targets::Sockets(distances) = &campaign.measurements.targets {
            assert_eq!(distances.len() * 2, campaign.measurements.groups.len(), "{file}");
        }
        for warning in &campaign.warnings {
            // the joints' limits are the files' own affair
            assert!(matches!(warning, Warning::OutsideLimits { .. }), "{file}: {warning}");
        }
        read_count += 1;
    }
    eprintln!("{read_count} real campaigns read");
}

#[test]
fn paths_are_relative_to_the_campaign_file() {
    let directory = tempfile::tempdir().unwrap();
    let folder = directory.path().join("lab");
    std::fs::create_dir(&folder).unwrap();
    let mut desk = Desk::with_tracker().but("campaign.toml", "\"robot.toml\"", "\"../robot.toml\"");
    for (file, place) in [
        ("campaign.toml", folder.join("campaign.toml")),
        ("robot.toml", directory.path().join("robot.toml")),
        ("measurements.csv", folder.join("measurements.csv")),
    ] {
        std::fs::write(place, desk.text(file).as_str()).unwrap();
    }
    let campaign = Campaign::read(&folder.join("campaign.toml")).unwrap();
    assert_eq!(campaign.robot_file, "../robot.toml");
    assert!(campaign.measurements.file.ends_with("measurements.csv"));

    std::fs::remove_file(directory.path().join("robot.toml")).unwrap();
    let error = Campaign::read(&folder.join("campaign.toml")).unwrap_err();
    let message = error.to_string();
    assert!(message.contains("campaign.toml:1:9: `robot` is \"../robot.toml\": "), "{message}");
    assert!(message.ends_with(", expected a file that can be read"), "{message}");
    assert_eq!(error.hint(), Some("a path is relative to the directory of the campaign file"));
}

/// The TOML examples of `docs/campaign-file.md`, each followed by its measurements.
#[test]
fn the_examples_of_the_documentation_are_read() {
    let page = include_str!("../docs/campaign-file.md");
    let blocks: Vec<&str> = page.split("```").skip(1).step_by(2).collect();
    assert_eq!(blocks.len(), 6);
    for pair in blocks.chunks(2) {
        let [campaign, measurements] = [pair[0].trim_start_matches("toml"), pair[1].trim_start()];
        let joints = measurements.matches("_deg").count();
        let joint = "[[joint]]\nd_mm = 100\na_mm = 100\nalpha_deg = 90\n";
        let open = |name: &str| {
            Ok(match name {
                "robot.toml" => joint.repeat(joints),
                // which format it is shows in the text
                "robot.urdf" => joint.repeat(joints),
                "rod.toml" => Desk::with_clamps().text("rod.toml").clone(),
                "readings.csv" => Desk::with_clamps().text("rig.csv").clone(),
                "measurements.csv" => measurements.to_owned(),
                // the positions stand in the place of any others
                "validation.csv" => measurements.replace("pose,clamp", "pose,id").replace("\n1,2", "\n3,2"),
                other => panic!("{other} is not in the examples"),
            })
        };
        let campaign = Campaign::from_texts("campaign.toml", campaign, &open);
        let campaign = campaign.unwrap_or_else(|error| panic!("{error}"));
        assert_eq!(campaign.robot.joints.len(), joints);
    }
}
