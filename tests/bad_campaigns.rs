//! Campaigns that are wrong are refused with a message that names the place, whichever file is to
//! blame. No bytes at all make the reader panic.

use crate::campaigns::desk::Desk;
use proptest::prelude::*;
use rodcal::error::Error;

fn assert_refused(good: fn() -> Desk, file: &str, cases: &[(&str, &str, &str)]) {
    for &(piece, wrong, expected) in cases {
        assert_eq!(good().but(file, piece, wrong).refusal(), expected, "{wrong}");
    }
}

#[test]
fn every_bad_key_is_named_with_its_place() {
    let cases = [
        // keys
        (
            "rod =",
            "rodd =",
            "campaign.toml:2:1: unknown key `rodd`, expected one of robot, effects, rod, rig, contact_force_n, measurements, validation, base_link, tip_link, validation_refit, tool, base, clamp, sockets, noise, accuracy, parameters, prior -> did you mean rod?",
        ),
        (
            "[base]",
            "[bases]",
            "campaign.toml:7:2: unknown section [bases], expected one of robot, effects, rod, rig, contact_force_n, measurements, validation, base_link, tip_link, validation_refit, tool, base, clamp, sockets, noise, accuracy, parameters, prior -> did you mean [base]?",
        ),
        (
            "id = \"2\"",
            "ids = \"2\"",
            "campaign.toml:14:1: unknown key `ids`, expected one of id, xyz_mm, rpy_deg",
        ),
        (
            "robot = \"robot.toml\"\n",
            "",
            "campaign.toml: there is no `robot`, expected `robot = \"FILE\"` in the first lines: a URDF, a robot in TOML, or \"builtin:tx90\"",
        ),
        (
            "measurements = \"measurements.csv\"\n",
            "",
            "campaign.toml: there is no `measurements`, expected `measurements = \"FILE\"` in the first lines: the CSV file of the recorded poses",
        ),
        (
            "[noise]",
            "[noise]\nvalidation = \"b.csv\"",
            "campaign.toml:18:1: unknown key `validation`, expected one of position_um, clamp_um -> write validation above the first [section]",
        ),
        (
            "id = \"2\"\n",
            "",
            "campaign.toml:13:1: there is no id in [[clamp]], expected the clamp's name in quotes, as in the column clamp of the measurements",
        ),
        (
            "sd = 0.1",
            "",
            "campaign.toml:22:1: there is no sd in [[prior]], expected the standard deviation of that knowledge, in the unit that the parameter's name ends with",
        ),
        (
            "[[clamp]]\nid = \"1\"\nxyz_mm = [400, 0, 100]\n[[clamp]]",
            "[clamp]",
            "campaign.toml:10:1: [clamp], expected [[clamp]] in double brackets, there may be several",
        ),
        ("rod =", "rod =\nrot =", "campaign.toml:2:6: `rod` is blank, expected a value behind the ="),
        // values
        (
            "\"robot.toml\"",
            "robot.toml",
            "campaign.toml:1:9: `robot` is robot.toml, expected a number, or a text in quotes",
        ),
        (
            "[10, 20, 30]",
            "[10, 20]",
            "campaign.toml:8:10: `base.xyz_mm` is [10, 20], expected three numbers [x, y, z] in mm",
        ),
        (
            "[10, 20, 30]",
            "[10, nan, 30]",
            "campaign.toml:8:15: `base.xyz_mm` is nan, expected a finite number",
        ),
        (
            "[10, 20, 30]",
            "\"10, 20, 30\"",
            "campaign.toml:8:10: `base.xyz_mm` is \"10, 20, 30\", expected a list in brackets",
        ),
        (
            "[10, 20, 30]",
            "[10, \"20\", 30]",
            "campaign.toml:8:15: `base.xyz_mm` is \"20\", expected a number -> write 20.0",
        ),
        (
            "[0, 0, 90]",
            "[0, 0, 90, 0]",
            "campaign.toml:9:11: `base.rpy_deg` is [0, 0, 90, 0], expected three angles [roll, pitch, yaw] in degrees",
        ),
        (
            "[1.1, 1.25, 1.05]",
            "1.1",
            "campaign.toml:4:19: `contact_force_n` is 1.1, expected a list in brackets",
        ),
        (
            "[1.1, 1.25, 1.05]",
            "[]",
            "campaign.toml:4:19: `contact_force_n` is [], expected three numbers [x, y, z] in N, the force on the ball",
        ),
        ("id = \"2\"", "id = 2", "campaign.toml:14:6: `clamp.id` is 2, expected a text in quotes"),
        (
            "id = \"2\"",
            "id = \" \"",
            "campaign.toml:14:6: `clamp.id` is \" \", expected the clamp's name, as in the column clamp of the measurements",
        ),
        (
            "id = \"2\"",
            "id = \"1\"",
            "campaign.toml:14:6: a second clamp has the id \"1\", expected an id of its own for each clamp",
        ),
        (
            "position_um = 5",
            "position_um = 0",
            "campaign.toml:18:15: `noise.position_um` is 0, expected a number > 0",
        ),
        (
            "[noise]",
            "[sockets]\ndistance_mm = 50\n[noise]",
            "campaign.toml:11:6: the file has [[clamp]] and [sockets], expected clamps where positions were measured, or sockets where only distances are known",
        ),
        (
            "[base]",
            "validation_refit = \"base\"\n[base]",
            "campaign.toml:7:20: `validation_refit` is \"base\", expected \"base-tool\" or \"none\"",
        ),
        (
            "rod = \"rod.toml\"\n",
            "",
            "campaign.toml:2:7: `rig` is \"rig.csv\", expected a rod (`rod = \"FILE\"`) whose readings these are",
        ),
        // parameters
        (
            "\"d2\"",
            "\"d4\"",
            "campaign.toml:20:8: `parameters.fix` has \"d4\", expected a parameter such as \"a1_mm\" or \"tool_z_mm\" of a robot with 3 joints",
        ),
        (
            "\"d2\"",
            "\"d2_m\"",
            "campaign.toml:20:8: `parameters.fix` has \"d2_m\", expected a parameter such as \"a1_mm\" or \"tool_z_mm\" of a robot with 3 joints -> did you mean \"d2_mm\"?",
        ),
        (
            "\"d2\"",
            "\"gear\"",
            "campaign.toml:20:8: `parameters.fix` has \"gear\", expected a parameter such as \"a1_mm\" or \"tool_z_mm\" of a robot with 3 joints",
        ),
        (
            "\"d2\"",
            "\"theta1\"",
            "campaign.toml:20:18: \"theta1_deg\" stands in fix already, expected one constraint for each parameter",
        ),
        (
            "\"c1_urad_per_nm\"",
            "\"d2_mm\"",
            "campaign.toml:21:9: \"d2_mm\" stands in fix already, expected one constraint for each parameter",
        ),
        (
            "\"c1_urad_per_nm\"",
            "\"c1\", \"c1\"",
            "campaign.toml:21:15: \"c1\" stands in free already, expected one constraint for each parameter",
        ),
        (
            "\"a1_mm\"",
            "\"a1\"",
            "campaign.toml:23:13: `prior.parameter` is \"a1\", expected \"a1_mm\", with the unit of value and sd",
        ),
        (
            "\"a1_mm\"",
            "\"d2_mm\"",
            "campaign.toml:23:13: \"d2_mm\" stands in fix already, expected one constraint for each parameter",
        ),
        ("sd = 0.1", "sd = -0.1", "campaign.toml:25:6: `prior.sd` is -0.1, expected a number > 0"),
        (
            "value = 250.5",
            "value = inf",
            "campaign.toml:24:9: `prior.value` is inf, expected a finite number",
        ),
        (
            "sd = 0.1",
            "sd = 0.1\n[[prior]]\nparameter = \"a1_mm\"\nvalue = 1\nsd = 1",
            "campaign.toml:27:13: \"a1_mm\" stands in another [[prior]] already, expected one constraint for each parameter",
        ),
        // files
        (
            "\"robot.toml\"",
            "\"builtin:tx9\"",
            "campaign.toml:1:9: `robot` is \"builtin:tx9\", expected \"builtin:tx90\", or the path of a robot's file",
        ),
        ("\"robot.toml\"", "\"none.toml\"", "none.toml: no such file, expected one on the desk"),
        (
            "\"robot.toml\"",
            "\"measurements.csv\"",
            "measurements.csv:1:5: the line `pose,clamp,q1_deg,q2_deg,q3_mm,x_mm,y_mm …`, expected key = value, or a [section] -> is this a table of readings (CSV)?",
        ),
        (
            "\"rod.toml\"",
            "\"robot.toml\"",
            "robot.toml:5:1: unknown key `a_mm`, expected one of name, station_mm, bending_urad_per_nm, torsion_urad_per_nm",
        ),
        (
            "\"measurements.csv\"",
            "\"rig.csv\"",
            "rig.csv:1: there is no column pose, expected a name for each pose -> the columns are axis, load_n, dz_um",
        ),
    ];
    assert_refused(Desk::with_clamps, "campaign.toml", &cases);
}

#[test]
fn every_bad_column_or_cell_is_named_with_its_place() {
    let cases = [
        // columns
        (
            "pose,",
            "poses,",
            "measurements.csv:1: there is no column pose, expected a name for each pose -> is the column poses meant to be pose?",
        ),
        (
            "clamp",
            "klamp",
            "measurements.csv:1: there is no column clamp, expected the id of the clamp that held the ball, for the campaign has [[clamp]] -> is the column klamp meant to be clamp?",
        ),
        (
            "clamp",
            "device",
            "measurements.csv:1: there is no column clamp, expected the id of the clamp that held the ball, for the campaign has [[clamp]] -> the columns are pose, device, q1_deg, q2_deg, q3_mm, x_mm, y_mm, z_mm, time_s, temperature_c",
        ),
        (
            "q1_deg,q2_deg",
            "Achse 1 [°],Gelenk2_rad",
            "measurements.csv:1: there are no columns q1_deg, q2_deg, expected q1_deg, q2_deg, q3_mm, for the robot has 3 joints -> rename \"Achse 1 [°]\" to q1_deg, \"Gelenk2_rad\" to q2_deg (converted from rad)",
        ),
        (
            "q2_deg",
            "q2",
            "measurements.csv:1: there is no column q2_deg, expected q1_deg, q2_deg, q3_mm, for the robot has 3 joints -> is the column q2 meant to be q2_deg?",
        ),
        (
            "q2_deg",
            "q2_rad",
            "measurements.csv:1: there is no column q2_deg, expected q1_deg, q2_deg, q3_mm, for the robot has 3 joints -> q2_rad would be in radians: convert it to degrees, into q2_deg",
        ),
        (
            "q2_deg",
            "joint2",
            "measurements.csv:1: there is no column q2_deg, expected q1_deg, q2_deg, q3_mm, for the robot has 3 joints -> rename \"joint2\" to q2_deg",
        ),
        (
            "q3_mm",
            "q3_deg",
            "measurements.csv:1: there is no column q3_mm, expected q1_deg, q2_deg, q3_mm, for the robot has 3 joints -> the joint slides: q3_mm instead of q3_deg",
        ),
        (
            "q3_mm",
            "q3_m",
            "measurements.csv:1: there is no column q3_mm, expected q1_deg, q2_deg, q3_mm, for the robot has 3 joints -> q3_m would be in m: multiply by 1000, into q3_mm",
        ),
        (
            "q1_deg,q2_deg,q3_mm",
            "a,b,c",
            "measurements.csv:1: there are no columns q1_deg, q2_deg, q3_mm, expected q1_deg, q2_deg, q3_mm, for the robot has 3 joints -> the columns are pose, clamp, a, b, c, x_mm, y_mm, z_mm, time_s, temperature_c",
        ),
        (
            "q1_deg,q2_deg,q3_mm",
            "q0_deg,q1_deg,q2_mm",
            "measurements.csv:1: there are no columns q2_deg, q3_mm, expected q1_deg, q2_deg, q3_mm, for the robot has 3 joints -> joints count from 1: q1_deg is the one next to the base",
        ),
        (
            "time_s",
            "q4_deg",
            "measurements.csv:1:47: there is a column q4_deg, expected q1_deg, q2_deg, q3_mm, for the robot has 3 joints -> is this the recording of another robot?",
        ),
        (
            "x_mm",
            "x_m",
            "measurements.csv:1: there is no column x_mm, expected the ball's position in the device frame of the clamp, in mm -> x_m would be in m: multiply by 1000, into x_mm",
        ),
        (
            "x_mm,y_mm,z_mm",
            "x,y,z",
            "measurements.csv:1: there are no columns x_mm, y_mm, z_mm, expected the ball's position in the device frame of the clamp, in mm -> rename \"x\" to x_mm, \"y\" to y_mm, \"z\" to z_mm",
        ),
        (
            "time_s",
            "pose",
            "measurements.csv:1:47: column \"pose\" stands there twice, expected every column once -> delete or rename one of the two",
        ),
        // cells
        (
            "1,1,10,",
            "1,1,,",
            "measurements.csv:2:5: q1_deg is blank, expected a number -> delete the row, or put a # before it",
        ),
        (
            "1,1,10,",
            "1,1,NaN,",
            "measurements.csv:2:5: q1_deg is \"NaN\", expected a number -> delete the row, or put a # before it",
        ),
        (
            "1,1,10,",
            "1,1,10°,",
            "measurements.csv:2:5: q1_deg is \"10°\", expected a number -> write the number alone; its unit stands in the name of the column",
        ),
        (
            "1,1,10,",
            "1,1,1e31,",
            "measurements.csv:2:5: q1_deg is \"1e31\", expected a number of at most 1e30 in size",
        ),
        (
            "0.2,0.1,0.3,60",
            "0.2,-,0.3,60",
            "measurements.csv:3:18: y_mm is \"-\", expected a number -> delete the row, or put a # before it",
        ),
        ("1,1,10,", ",1,10,", "measurements.csv:2:1: pose is blank, expected a name for the pose"),
        (
            "1,2,-30",
            "1,3,-30",
            "measurements.csv:4:3: clamp is \"3\", expected one of the campaign's clamps: 1, 2",
        ),
        (
            "1,2,-30",
            "1,,-30",
            "measurements.csv:4:3: clamp is blank, expected one of the campaign's clamps: 1, 2",
        ),
        (
            "2,1,20",
            "1,1,20",
            "measurements.csv:3:1: pose is \"1\", expected a pose of clamp 1 that is not in line 2 already -> give a pose that was measured again a name of its own, such as 7b",
        ),
        (
            "120,21",
            "120,-300",
            "measurements.csv:4:26: temperature_c is \"-300\", expected a number ≥ -273.15",
        ),
        ("120,21", "noon,21", "measurements.csv:4:22: time_s is \"noon\", expected a number"),
        (
            "0.1,0.2,0.3",
            "0,1,0.2,0.3",
            "measurements.csv:2: the row has 11 cells, expected 10 as in the header -> numbers with decimal commas need `;` between the cells, also in the header",
        ),
    ];
    assert_refused(Desk::with_clamps, "measurements.csv", &cases);
    let cases = [
        (
            "a,15",
            "b,15",
            "measurements.csv:3:1: pose is \"b\", expected a pose that is not in line 2 already -> give a pose that was measured again a name of its own, such as 7b",
        ),
        (
            "x_mm,y_mm,z_mm",
            "placement,socket,z_mm",
            "measurements.csv:1: there are no columns x_mm, y_mm, expected the ball's position in {W}, in mm -> a ball in sockets needs a section [sockets] in the campaign",
        ),
        (
            "q3_mm",
            "q3_mm,",
            "measurements.csv:1:26: column 5 has no name, expected a name in every cell of the header -> name the column or delete it",
        ),
    ];
    assert_refused(Desk::with_tracker, "measurements.csv", &cases);
    let cases = [
        (
            "placement",
            "place",
            "measurements.csv:1: there is no column placement, expected a name for where the tool with the sockets stood, for the campaign has [sockets] -> is the column place meant to be placement?",
        ),
        (
            "socket,",
            "x_mm,",
            "measurements.csv:1: there is no column socket, expected the number of the socket that held the ball, 0 or 1, for the campaign has [sockets] -> the columns are pose, placement, x_mm, q1_deg, q2_deg, q3_mm",
        ),
        (
            "3,front,1",
            "3,,1",
            "measurements.csv:4:3: placement is blank, expected a name for where the sockets stood",
        ),
        ("3,front,1", "3,front,", "measurements.csv:4:9: socket is blank, expected the number of the socket"),
        (
            "2,front,0",
            "1,front,0",
            "measurements.csv:3:1: pose is \"1\", expected a pose of front/0 that is not in line 2 already -> give a pose that was measured again a name of its own, such as 7b",
        ),
    ];
    assert_refused(Desk::with_sockets, "measurements.csv", &cases);
    let sockets = [
        (
            "distance_mm = 50",
            "distance_mm = 0",
            "campaign.toml:4:15: `sockets.distance_mm` is 0, expected a number > 0",
        ),
        (
            "distance_mm = 50",
            "",
            "campaign.toml:3:1: there is no distance_mm in [sockets], expected the distance between the sockets 0 and 1 of a placement in mm",
        ),
        (
            "distance_mm = 50",
            "distance_mm = 50\ndistance_sd_mm = 0",
            "campaign.toml:5:18: `sockets.distance_sd_mm` is 0, expected a number > 0",
        ),
    ];
    assert_refused(Desk::with_sockets, "campaign.toml", &sockets);
    let robot = [("SCARA", "SCARA\"\"", "robot.toml:2:15: unexpected key or value, expected newline, `#`")];
    assert_refused(Desk::with_tracker, "robot.toml", &robot);
    let validation = [
        (
            "x_mm",
            "u_mm",
            "validation.csv:1: there is no column x_mm, expected the ball's position in {W}, in mm -> is the column u_mm meant to be x_mm?",
        ),
        (
            "q1_deg",
            "q_deg",
            "validation.csv:1: there is no column q1_deg, expected q1_deg, q2_deg, q3_mm, for the robot has 3 joints -> is the column q_deg meant to be q1_deg?",
        ),
    ];
    assert_refused(Desk::with_clamps, "validation.csv", &validation);
}

#[test]
fn every_bad_file_is_named() {
    let header = "pose,q1_deg,q2_deg,q3_mm,x_mm,y_mm,z_mm\n";
    for (file, text, expected) in [
        (
            "campaign.toml",
            "",
            "campaign.toml: the file is empty, expected `robot = \"FILE\"` in the first lines: a URDF, a robot in TOML, or \"builtin:tx90\"",
        ),
        (
            "campaign.toml",
            "pose,q1_deg\n1,2\n",
            "campaign.toml:1:5: the line `pose,q1_deg`, expected key = value, or a [section] -> is this a table of readings (CSV)?",
        ),
        (
            "robot.toml",
            "",
            "robot.toml: the file is empty, expected a section [[joint]] with d_mm, a_mm, alpha_deg for each joint, base to flange",
        ),
        (
            "measurements.csv",
            "",
            "measurements.csv: the file is empty, expected a header line with the names of the columns, then rows",
        ),
        (
            "measurements.csv",
            header,
            "measurements.csv: there are no rows under the header, expected at least one pose, and many more to calibrate with",
        ),
        (
            "measurements.csv",
            "clamp,pose,q1_deg,q2_deg,q3_mm,x_mm,y_mm,z_mm\n,1,2,3,4,5,6,7\n",
            "measurements.csv:1:1: there is a column clamp, expected no such column, for the campaign has no [[clamp]] -> add a [[clamp]] with id, xyz_mm and rpy_deg for each, or delete the column",
        ),
        (
            "measurements.csv",
            "PK\u{3}\u{4}",
            "measurements.csv: this is an Excel workbook, expected CSV text -> export it as CSV (in Excel: \"CSV UTF-8\")",
        ),
        (
            "measurements.csv",
            "pose;q1_deg;q2_deg;q3_mm;x_mm;y_mm;z_mm\n1;1,5;2.5;3;4;5;6\n",
            "measurements.csv:2:7: q2_deg is \"2.5\", expected `,` as decimal mark, as in \"1,5\" in line 2 -> use one decimal mark in the whole file, and nothing between thousands",
        ),
    ] {
        let mut desk = Desk::with_tracker();
        *desk.text(file) = text.to_owned();
        assert_eq!(desk.refusal(), expected, "{file}");
    }
}

/// Whatever stands in the files: the campaign is read or refused, and then at a place that the file
/// has.
fn read_any(mut desk: Desk) -> Result<(), TestCaseError> {
    match desk.read() {
        Ok(campaign) => {
            let recordings = [Some(&campaign.measurements), campaign.validation.as_ref()];
            for recording in recordings.into_iter().flatten() {
                prop_assert_eq!(recording.joint_values.len(), recording.len() * recording.joint_count);
                prop_assert!(recording.joint_values.iter().all(|q| q.is_finite()));
                prop_assert!(recording.rows.iter().all(|row| row.group < recording.groups.len()));
            }
            prop_assert!(campaign.warnings.iter().all(|warning| !warning.to_string().is_empty()));
        }
        Err(Error::Input { at, .. } | Error::Syntax { at, .. }) => {
            let line_count = desk.try_text(&at.file).map_or(0, |text| text.matches('\n').count() + 1);
            prop_assert!(at.line <= line_count, "{}", at);
        }
        Err(other) => prop_assert!(false, "{other}"),
    }
    Ok(())
}

fn any_desk() -> impl Strategy<Value = Desk> {
    prop::sample::select(vec![Desk::with_clamps(), Desk::with_tracker(), Desk::with_sockets()])
}

proptest! {
    #[test]
    fn arbitrary_texts_are_read_or_refused(
        mut desk in any_desk(),
        which in 0..2usize,
        bytes in prop::collection::vec(any::<u8>(), 0..300)
    ) {
        *desk.text(["campaign.toml", "measurements.csv"][which]) = String::from_utf8_lossy(&bytes).into_owned();
        read_any(desk)?;
    }

    #[test]
    fn arbitrary_tables_are_read_or_refused(
        mut desk in any_desk(),
        text in "(pose|clamp|placement|socket|q[0-4]_(deg|mm|rad)|[xyz]_mm|[-,;\t\"'#\r\n .0-9eE\u{feff}µ]){0,80}"
    ) {
        *desk.text("measurements.csv") = text;
        read_any(desk)?;
    }

    #[test]
    fn mutations_of_good_files_are_read_or_refused(
        mut desk in any_desk(),
        which in 0..3usize,
        edits in prop::collection::vec((0..1000usize, 0..6usize, "[-=\\[\\],;\t\"#\r\n .0-9eExq_\u{0}\u{feff}µ]{0,4}"), 1..6)
    ) {
        let text = desk.text(["campaign.toml", "measurements.csv", "robot.toml"][which]);
        let mut characters: Vec<char> = text.chars().collect();
        for (start, length, new) in edits {
            let start = start % (characters.len() + 1);
            let end = (start + length).min(characters.len());
            characters.splice(start..end, new.chars());
        }
        *text = characters.into_iter().collect();
        read_any(desk)?;
    }
}
