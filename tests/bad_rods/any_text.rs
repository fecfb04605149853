//! Whatever the text: it is read or refused, and what is read is solved or refused.

use proptest::prelude::*;
use rodcal::beam::Physics;
use rodcal::compliance::Compliance;
use rodcal::error::Error;
use rodcal::files::text_of_bytes;
use rodcal::rod::Rod;

use super::{GOOD, changed, read};

/// Numbers on the edge of what the reader takes may be too much for the beam model, which then says
/// so itself.
#[test]
fn extreme_numbers_end_in_a_finite_compliance_or_an_error() {
    for (piece, extreme, is_solved) in [
        ("l1_mm = 150.0", "l1_mm = 1e30", false),
        ("l1_mm = 150.0", "l1_mm = 1e-290", true),
        ("youngs_modulus_gpa = 193.0", "youngs_modulus_gpa = 1e30", true),
        ("youngs_modulus_gpa = 193.0", "youngs_modulus_gpa = 1e-290", true),
        ("outer_diameter_mm = 16.0", "outer_diameter_mm = 1e30", true),
        ("inner_diameter_mm = 12.0", "inner_diameter_mm = 15.999999999999998", true),
        ("mass_g = 55.0", "mass_g = 1e30", true),
        ("density_kg_m3 = 7930.0", "density_kg_m3 = 1e30", true),
        ("gamma_deg = 90.0", "gamma_deg = 1e-290", true),
        ("gamma_deg = 90.0", "gamma_deg = 179.99999999999997\nbend_radius_mm = 1e15", true),
        ("station_mm = 300.0", "station_mm = 300.0\nbending_urad_per_nm = 1e30", true),
        ("gamma_deg = 90.0", "bend_radius_mm = 40\nbend_flexibility = 1e30", true),
        ("gamma_deg = 90.0", "bend_radius_mm = 1e-30\nbend_flexibility = \"asme-b31.3\"", true),
    ] {
        let rod = read(&changed(&[(piece, extreme)])).expect(extreme);
        match Compliance::of_model(&rod, &Physics::default(), 20) {
            Ok(compliance) => assert!(is_solved && is_finite(&compliance), "{extreme}: {compliance:?}"),
            Err(error) => {
                let says_so = matches!(error, Error::SelfCheck { .. } | Error::Numerical { .. });
                assert!(!is_solved && says_so, "{extreme}: {error}")
            }
        }
    }
}

/// Found by the last test below: finite under 1 m/s², but not under one g.
#[test]
fn a_compliance_that_overflows_only_per_g_is_an_error() {
    let changes =
        [("l1_mm = 150.0", "l1_mm = 1e12"), ("youngs_modulus_gpa = 193.0", "youngs_modulus_gpa = 3.3e-274")];
    let rod = read(&changed(&changes)).expect("a rod");
    let error = Compliance::of_model(&rod, &Physics::default(), 8).expect_err("an overflow");
    assert_eq!(
        error.to_string(),
        "compliance under gravity: it is beyond double precision; is there a number of the rod in another unit?"
    );
}

fn is_finite(compliance: &Compliance) -> bool {
    compliance.force.iter().chain(compliance.gravity.iter()).all(|c| c.is_finite())
}

/// Reads bytes as a user's file is read and solves the rod; whatever they are, what is said about
/// them lies within the file.
fn read_and_solve(bytes: Vec<u8>) -> Result<(), TestCaseError> {
    let line_count = bytes.iter().filter(|&&b| b == b'\n').count() + 1;
    match text_of_bytes("f", bytes).and_then(|text| Rod::from_toml("f", &text)) {
        Ok(rod) => match Compliance::of_model(&rod, &Physics::default(), 8) {
            Ok(compliance) => prop_assert!(is_finite(&compliance), "{compliance:?}"),
            Err(Error::SelfCheck { .. } | Error::Numerical { .. }) => {}
            Err(other) => prop_assert!(false, "{other}"),
        },
        Err(Error::Input { at, found, expected, .. }) => {
            prop_assert!(at.line <= line_count, "{at}");
            prop_assert!(!found.is_empty() && !expected.is_empty(), "{at}: {found}, {expected}");
            let is_printable = |text: &str| !text.contains(|c: char| c.is_control());
            prop_assert!(is_printable(&found) && is_printable(&expected), "{found:?}, {expected:?}");
        }
        Err(Error::Syntax { at, message }) => prop_assert!(at.line <= line_count, "{at}: {message}"),
        Err(other) => prop_assert!(false, "{other}"),
    }
    Ok(())
}

/// What a slip of the hand or of a script does to a file of lines.
#[derive(Debug, Clone)]
enum Edit {
    Delete(usize),
    Duplicate(usize, usize),
    Swap(usize, usize),
    Insert(usize, String),
    Value(usize, String),
    Characters(usize, usize, String),
}

impl Edit {
    fn apply(&self, lines: &mut Vec<String>) {
        let count = lines.len();
        if count == 0 {
            return;
        }
        match self {
            Edit::Delete(at) => drop(lines.remove(at % count)),
            Edit::Duplicate(from, to) => lines.insert(to % count, lines[from % count].clone()),
            Edit::Swap(a, b) => lines.swap(a % count, b % count),
            Edit::Insert(at, line) => lines.insert(at % count, line.clone()),
            Edit::Value(at, value) => {
                // the next line that has a value
                let line = lines[at % count..].iter_mut().find(|line| line.contains('='));
                if let Some(line) = line {
                    let key = line.split('=').next().unwrap_or_default().to_owned();
                    *line = format!("{key}= {value}");
                }
            }
            Edit::Characters(at, column, new) => {
                let line = &mut lines[at % count];
                let column = line.char_indices().map(|(i, _)| i).nth(*column).unwrap_or(line.len());
                line.insert_str(column, new);
            }
        }
    }
}

fn nasty_value() -> impl Strategy<Value = String> {
    let fixed = [
        "nan",
        "-inf",
        "1e308",
        "-1e308",
        "1e30",
        "1e29",
        "5e-324",
        "1e-300",
        "1e-30",
        "-0.0",
        "0",
        "-1",
        "1",
        "180",
        "90",
        "16.0",
        "9223372036854775807",
        "99999999999999999999",
        "0x10",
        "1_0",
        "1,5",
        "\"16\"",
        "\"steel\"",
        "\"von-karman\"",
        "[]",
        "[0, 90]",
        "{}",
        "true",
        "1979-05-27",
        "",
        "\"",
        "''' ",
        "\"\\u0000\"",
        "150.0 # mm",
        "µ",
    ];
    prop_oneof![
        prop::sample::select(fixed.to_vec()).prop_map(str::to_owned),
        any::<f64>().prop_map(|x| format!("{x:e}")),
        (-320..30i32).prop_map(|exponent| format!("1e{exponent}")),
    ]
}

fn edit() -> impl Strategy<Value = Edit> {
    let at = || 0..60usize;
    let line = prop_oneof![
        "\\PC{0,20}",
        "[a-z_]{1,8} = [0-9.e-]{1,8}",
        prop::sample::select(vec![
            "[bend]",
            "[[mass]]",
            "[[joint]]",
            "[[pipe1]]",
            "[material.a]",
            "[tip",
            "bend_radius_mm = 40",
            "'''",
            "]",
            "a.b.c = {",
        ])
        .prop_map(str::to_owned),
    ];
    prop_oneof![
        1 => at().prop_map(Edit::Delete),
        1 => (at(), at()).prop_map(|(from, to)| Edit::Duplicate(from, to)),
        1 => (at(), at()).prop_map(|(a, b)| Edit::Swap(a, b)),
        1 => (at(), line).prop_map(|(at, line)| Edit::Insert(at, line)),
        4 => (at(), nasty_value()).prop_map(|(at, value)| Edit::Value(at, value)),
        1 => (at(), 0..30usize, "[\\[\\]{}=\"'#,.0-9e\u{0}\u{1}\r\u{feff}µ\u{2028}-]{1,3}")
            .prop_map(|(at, column, new)| Edit::Characters(at, column, new)),
    ]
}

proptest! {
    #![proptest_config(ProptestConfig { failure_persistence: None, ..ProptestConfig::default() })]

    #[test]
    fn arbitrary_bytes_are_read_or_refused(bytes in prop::collection::vec(any::<u8>(), 0..400)) {
        read_and_solve(bytes)?;
    }

    #[test]
    fn arbitrary_text_is_read_or_refused(
        text in "(\\[geometry\\]|\\[\\[mass\\]\\]|tip|l1_mm|name|[\\[\\]{}=\"'#,._a-z0-9\r\n\tµ\u{0}\u{feff}-]){0,60}"
    ) {
        read_and_solve(text.into_bytes())?;
    }

    #[test]
    fn mutations_of_a_good_file_are_read_or_refused(edits in prop::collection::vec(edit(), 1..6)) {
        let mut lines: Vec<String> = GOOD.lines().map(str::to_owned).collect();
        edits.iter().for_each(|edit| edit.apply(&mut lines));
        read_and_solve(lines.join("\n").into_bytes())?;
    }

    /// Every number of the file at once at the edge: what the reader takes, the beam model solves
    /// or refuses.
    #[test]
    fn nasty_numbers_are_solved_or_refused(values in prop::collection::vec((0..60usize, nasty_value()), 1..12)) {
        let mut lines: Vec<String> = GOOD.lines().map(str::to_owned).collect();
        values.into_iter().for_each(|(at, value)| Edit::Value(at, value).apply(&mut lines));
        read_and_solve(lines.join("\n").into_bytes())?;
    }
}
