//! Whatever the text: it is read or refused, and what is read can be moved and written.

use nalgebra::Vector3;
use proptest::prelude::*;
use rodcal::error::Error;
use rodcal::files::text_of_bytes;
use rodcal::robot::Robot;

use super::{TABLE, URDF};

/// Reads bytes as a user's file is read; what is said about them lies within the file. A robot that
/// is read moves and is written back, and what is written can be read.
fn read_and_write(bytes: Vec<u8>) -> Result<(), TestCaseError> {
    let line_count = bytes.iter().filter(|&&b| b == b'\n').count() + 1;
    let text = text_of_bytes("f", bytes);
    match text.and_then(|text| Ok((Robot::from_text("f", &text, None, None)?, text))) {
        Ok((robot, text)) => {
            let q = vec![0.5; robot.joints.len()];
            let flange = robot.flange_at(&q);
            let is_finite = flange.origin.iter().chain(flange.rotation.iter()).all(|x| x.is_finite());
            prop_assert!(is_finite, "{flange:?}");
            match rodcal::robot::is_urdf(&text) {
                true => {
                    let tool = Some(Vector3::new(0.0, 0.0, 0.1));
                    let comments = [text.clone()];
                    let written = robot.to_urdf("f", &text, None, None, tool, &comments);
                    let written = written.map_err(|error| TestCaseError::fail(error.to_string()))?.text;
                    let again = Robot::from_text("f", &written, None, None);
                    prop_assert!(again.is_ok(), "{again:?}\n{written}");
                }
                false => {
                    let written = robot.to_toml(std::slice::from_ref(&text));
                    let written = written.map_err(|error| TestCaseError::fail(error.to_string()))?;
                    let again = Robot::from_text("f", &written, None, None);
                    prop_assert!(again.is_ok(), "{again:?}\n{written}");
                }
            }
        }
        Err(Error::Input { at, found, expected, hint }) => {
            prop_assert!(at.line <= line_count, "{at}");
            prop_assert!(!found.is_empty() && !expected.is_empty(), "{at}: {found}, {expected}");
            let is_printable = |text: &str| !text.contains(|c: char| c.is_control());
            prop_assert!(is_printable(&found) && is_printable(&expected), "{found:?}, {expected:?}");
            prop_assert!(hint.is_none_or(|hint| is_printable(&hint)));
        }
        Err(Error::Syntax { at, message }) => prop_assert!(at.line <= line_count, "{at}: {message}"),
        Err(other) => prop_assert!(false, "{other}"),
    }
    Ok(())
}

/// What a slip of the hand or of a script does to a text: pieces, cut at these characters, go, come
/// twice, change places or become something else.
#[derive(Debug, Clone)]
enum Edit {
    Delete(usize),
    Swap(usize, usize),
    Copy(usize, usize),
    Replace(usize, String),
    Insert(usize, String),
}

fn edited(text: &str, edits: &[Edit]) -> String {
    let mut pieces: Vec<String> =
        text.split_inclusive(&['\n', '"', ' ', '>', '=', ','][..]).map(str::to_owned).collect();
    for edit in edits {
        let count = pieces.len().max(1);
        match edit {
            _ if pieces.is_empty() => {}
            Edit::Delete(at) => drop(pieces.remove(at % count)),
            Edit::Swap(a, b) => pieces.swap(a % count, b % count),
            Edit::Copy(from, to) => pieces.insert(to % count, pieces[from % count].clone()),
            Edit::Insert(at, new) => pieces.insert(at % count, new.clone()),
            Edit::Replace(at, new) => {
                let piece = &mut pieces[at % count];
                // what ended the piece still does
                let end = piece.pop().map(String::from).unwrap_or_default();
                *piece = format!("{new}{end}");
            }
        }
    }
    pieces.concat()
}

fn edit() -> impl Strategy<Value = Edit> {
    let at = || 0..400usize;
    let fixed = [
        "0",
        "-0.0",
        "1e30",
        "-1e30",
        "1e31",
        "nan",
        "inf",
        "1e-320",
        "5e-324",
        "3.141592653589793",
        "base_link",
        "tip_link",
        "upper_arm",
        "camera",
        "fixed",
        "prismatic",
        "continuous",
        "floating",
        "revolute",
        "<link name=\"",
        "</joint>",
        "<mimic/>",
        "<origin/>",
        "<axis/>",
        "<!--",
        "-->",
        "<![CDATA[",
        "&amp;",
        "&x;",
        "\u{0}",
        "µ",
        "\u{feff}",
        "[[joint]]\n",
        "mass_kg",
        "[",
        "]",
        "'",
        "\"",
        "1 2 3",
        "1,2,3",
        "xyz=\"1 2 3\" ",
        "\t\r\n",
        "<inertial><mass value=\"1e30\"/></inertial>",
    ];
    let new = || {
        prop_oneof![
            4 => prop::sample::select(fixed.to_vec()).prop_map(str::to_owned),
            1 => any::<f64>().prop_map(|x| format!("{x:e}")),
            1 => "\\PC{0,6}",
        ]
    };
    prop_oneof![
        1 => at().prop_map(Edit::Delete),
        1 => (at(), at()).prop_map(|(a, b)| Edit::Swap(a, b)),
        1 => (at(), at()).prop_map(|(from, to)| Edit::Copy(from, to)),
        4 => (at(), new()).prop_map(|(at, new)| Edit::Replace(at, new)),
        1 => (at(), new()).prop_map(|(at, new)| Edit::Insert(at, new)),
    ]
}

proptest! {
    #![proptest_config(ProptestConfig { failure_persistence: None, cases: 512, ..ProptestConfig::default() })]

    #[test]
    fn arbitrary_bytes_are_read_or_refused(bytes in prop::collection::vec(any::<u8>(), 0..400)) {
        read_and_write(bytes)?;
    }

    #[test]
    fn arbitrary_xml_is_read_or_refused(
        text in "<(robot|link|joint|/joint|/robot|name=|xyz=|[<>/=\"'& !?a-z0-9\r\n\tµ\u{0}-]){0,60}"
    ) {
        read_and_write(text.into_bytes())?;
    }

    #[test]
    fn mutations_of_a_table_are_read_or_refused(edits in prop::collection::vec(edit(), 1..5)) {
        read_and_write(edited(TABLE, &edits).into_bytes())?;
    }

    #[test]
    fn mutations_of_a_urdf_are_read_or_refused(edits in prop::collection::vec(edit(), 1..5)) {
        read_and_write(edited(URDF, &edits).into_bytes())?;
    }
}

/// Neither the depth of the elements nor the length of the chain is a matter of the stack.
#[test]
fn deep_and_long_files_are_read_or_refused() {
    let deep = format!("<robot>{}{}</robot>", "<a>".repeat(100_000), "</a>".repeat(100_000));
    assert!(Robot::from_text("f", &deep, None, None).is_err());
    let refused = Robot::from_text("f", &chain(3000), None, None).expect_err("an arm that is too long");
    assert_eq!(
        refused.to_string(),
        "f: it has 3000 moving joints from base_link to tip_link, expected at most 64"
    );
    let long = chain(64);
    let robot = Robot::from_text("f", &long, None, None).expect("a long arm");
    assert_eq!(robot.joints.len(), 64);
    let written = robot.to_urdf("f", &long, None, None, Some(Vector3::z()), &["x".to_owned()]);
    assert!(!written.expect("a URDF").has_tool);
}

/// Found by `fuzz::`: a parser repeats what a file holds, however long it is.
#[test]
fn a_message_is_short_whatever_the_file_repeats() {
    let text = format!("<robot><a{}></b></robot>", "9".repeat(10_000));
    let error = Robot::from_text("f", &text, None, None).expect_err("tags that do not match");
    assert!(error.to_string().len() < 300, "{error}");
}

/// So many joints, one on the other.
fn chain(count: usize) -> String {
    let mut long = String::from("<robot><link name=\"base_link\"/>");
    let mut parent = "base_link".to_owned();
    for i in 0..count {
        let child = if i + 1 == count { "tip_link".to_owned() } else { format!("l{i}") };
        long += &format!(
            "<link name=\"{child}\"/><joint name=\"j{i}\" type=\"continuous\"><parent link=\"{parent}\"/>\
             <child link=\"{child}\"/><origin xyz=\"0.1 0 0.1\" rpy=\"0.1 0.2 0.3\"/></joint>"
        );
        parent = child;
    }
    long + "</robot>"
}
