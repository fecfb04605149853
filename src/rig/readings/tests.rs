//! What is read, and what is refused.

use super::*;

#[test]
fn rows_that_cannot_be_are_refused() {
    let row = |load: f64| Reading::new(Direction::along(Axis::X), load).with_offset(Axis::X, load);
    assert!(Readings::from_rows(vec![row(1.0), row(2.0)]).is_ok());
    assert!(Readings::from_rows(vec![row(1.0), row(1.0)]).is_err());
    assert!(Readings::from_rows(vec![]).is_err());
    for wrong in [
        row(-1.0),
        row(f64::NAN),
        Reading::new(Direction::against(Axis::X), 1.0),
        Reading { time: Some(f64::INFINITY), ..row(1.0) },
        Reading { load_station: Some(-0.1), ..row(1.0) },
        Reading { time: Some(5.0), loaded_at: Some(6.0), ..row(1.0) },
        Reading { loaded_at: Some(f64::NAN), ..row(1.0) },
    ] {
        let error = Readings::from_rows(vec![row(3.0), wrong]).unwrap_err();
        assert!(error.to_string().contains("row 2"), "{error}");
    }
}

#[test]
fn every_column_is_read_in_si() {
    let text = "\
# a rig
LOADED_AT_S, Session, READ_STATION_MM, load_station_mm, Temperature_C, time_s, phase, trial, dz_um, dy_um, dx_um, load_n, axis
-63.5, day 2, 210, 525, 20.5, -3, Unload, 2b, -12, , 1.5, 5, -Z
,,,,,,,,3,,,0,+z
";
    let readings = Readings::from_text("rig.csv", text).unwrap();
    let first = Reading {
        direction: Direction { axis: Axis::Z, sign: -1 },
        load: 5.0,
        offset: [Some(1.5 * UM), None, Some(-12.0 * UM)],
        trial: Some("2b".into()),
        phase: Some(Phase::Unload),
        time: Some(-3.0),
        temperature: Some(20.5),
        load_station: Some(525.0 * MM),
        read_station: Some(210.0 * MM),
        session: Some("day 2".into()),
        loaded_at: Some(-63.5),
        line: 3,
    };
    assert_eq!(readings.rows[0], first);
    assert_eq!(readings.rows[0].signed_load(), -5.0);
    assert_eq!(readings.rows[1].direction.to_string(), "z");
    assert_eq!(readings.rows[1].load_station, None);
}

#[test]
fn a_kilogram_weighs_as_much_as_standard_gravity_makes_it() {
    let readings = Readings::from_text("f", "axis,load_kg,dx_um\n\u{2212}x,1,2\nx,2,4\n").unwrap();
    assert_eq!(readings.rows[0].signed_load(), -9.80665);
    assert_eq!(readings.warnings, []);
}

#[test]
fn loads_in_both_directions_are_two_loads() {
    assert!(Readings::from_text("f", "axis,load_n,dx_um\nx,5,2\n-x,5,-2\n").is_ok());
    assert!(Readings::from_text("f", "axis,load_n,dx_um\nx,5,2\ny,5,-2\n").is_err());
}

#[test]
fn a_load_is_not_read_before_it_hangs() {
    let text = "axis,load_n,dx_um,time_s,loaded_at_s\nx,5,2,60,0\nx,7,3,60,61\n";
    let error = Readings::from_text("f", text).unwrap_err();
    assert_eq!(
        error.to_string(),
        "f:3:10: loaded_at_s is \"61\", expected at most time_s, 60: the load hangs when it is read"
    );
}

#[test]
fn a_workbook_is_named_as_such() {
    let directory = tempfile::tempdir().unwrap();
    let path = directory.path().join("rig.xlsx");
    std::fs::write(&path, b"PK\x03\x04\xFF").unwrap();
    let error = Readings::read(&path).unwrap_err();
    assert!(error.to_string().ends_with("rig.xlsx: this is an Excel workbook, expected CSV text"), "{error}");
    let missing = Readings::read(&directory.path().join("none.xlsx")).unwrap_err();
    assert!(matches!(missing, Error::File { .. }));
}
