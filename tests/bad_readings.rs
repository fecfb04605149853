//! Readings that are wrong are refused with a message that names the place; readings that are odd
//! are warned about. No bytes at all make the reader panic.

use proptest::prelude::*;
use rodcal::error::Error;
use rodcal::files::text_of_bytes;
use rodcal::rig::readings::{Reading, Readings};

/// The message, and the hint after an arrow.
fn refusal(text: &str) -> String {
    let bytes = text.as_bytes().to_vec();
    let error = text_of_bytes("rig.csv", bytes).and_then(|text| Readings::from_text("rig.csv", &text));
    let error = error.expect_err(text);
    match error.hint() {
        Some(hint) => format!("{error} -> {hint}"),
        None => error.to_string(),
    }
}

fn warnings(text: &str) -> Vec<String> {
    Readings::from_text("rig.csv", text).expect(text).warnings.iter().map(ToString::to_string).collect()
}

/// A good file of three rows, in which a case replaces one piece of text.
const GOOD: &str = "\
axis,load_n,dz_um,phase,time_s,temperature_c,load_station_mm
z,0,0,load,0,20,525
z,5,12.5,load,10,20,525
z,10,25.1,unload,20,20,525
";

#[test]
fn every_bad_cell_or_column_is_named_with_its_place() {
    let cases = [
        // numbers
        (
            "z,5,",
            "z,5 N,",
            "rig.csv:3:3: load_n is \"5 N\", expected a number -> write the number alone; its unit stands in the name of the column",
        ),
        (
            "z,5,",
            "z,NaN,",
            "rig.csv:3:3: load_n is \"NaN\", expected a number -> leave the cell blank where nothing was measured",
        ),
        (
            "z,5,",
            "z,0x5,",
            "rig.csv:3:3: load_n is \"0x5\", expected a number -> write the number in decimal",
        ),
        (
            "z,5,",
            "z,\"5,5\",",
            "rig.csv:3:3: load_n is \"5,5\", expected a number -> decimal commas are read where `;` separates the cells",
        ),
        ("z,5,", "z,,", "rig.csv:3:3: load_n is blank, expected a number"),
        ("12.5", "1e999", "rig.csv:3:5: dz_um is \"1e999\", expected a number of at most 1e30 in size"),
        (
            "12.5",
            "1.234.567",
            "rig.csv:3:5: dz_um is \"1.234.567\", expected a number -> write nothing between thousands",
        ),
        (
            "12.5",
            "lots of text that goes on and on and on and on",
            "rig.csv:3:5: dz_um is \"lots of text that goes on and on and on …\", expected a number",
        ),
        // meanings
        (
            "z,5,",
            "z,-5,",
            "rig.csv:3:3: load_n is \"-5\", expected a magnitude ≥ 0 -> write the direction into the column axis: -z and 5",
        ),
        (
            "z,5,",
            "-z,-5.5,",
            "rig.csv:3:4: load_n is \"-5.5\", expected a magnitude ≥ 0 -> write the direction into the column axis: z and 5.5",
        ),
        (
            "z,5,",
            "w,5,",
            "rig.csv:3:1: axis is \"w\", expected x, y, z, -x, -y or -z -> it is the direction of the load in {T}",
        ),
        (
            "z,5,",
            ",5,",
            "rig.csv:3:1: axis is blank, expected x, y, z, -x, -y or -z -> it is the direction of the load in {T}",
        ),
        (
            "12.5",
            "",
            "rig.csv:3: the row has a load but no offset, expected a number in dx_um, dy_um or dz_um -> delete the row, or put a # before it",
        ),
        ("unload", "down", "rig.csv:4:11: phase is \"down\", expected load, unload or a blank"),
        ("10,20,525", "10,-300,525", "rig.csv:3:18: temperature_c is \"-300\", expected a number ≥ -273.15"),
        ("10,20,525", "10,20,-1", "rig.csv:3:21: load_station_mm is \"-1\", expected a number ≥ 0"),
        // columns
        (
            "phase",
            "load_kg",
            "rig.csv:1:19: the load is given twice, in load_n and in load_kg, expected one of the two -> delete the column that was computed from the other",
        ),
        (
            "load_n",
            "load",
            "rig.csv:1: there is no load, expected a column load_n (newtons) or load_kg (kilograms) -> is the column load meant to be load_n?",
        ),
        (
            "load_n",
            "weight",
            "rig.csv:1: there is no load, expected a column load_n (newtons) or load_kg (kilograms) -> the columns are axis, weight, dz_um, phase, time_s, temperature_c, load_station_mm",
        ),
        (
            "dz_um",
            "dz_µm",
            "rig.csv:1: there is no offset, expected a column dx_um, dy_um or dz_um (micrometres) -> is the column dz_µm meant to be dz_um?",
        ),
        (
            "dz_um",
            "dz_mm",
            "rig.csv:1: there is no offset, expected a column dx_um, dy_um or dz_um (micrometres) -> dz_mm would be in mm: multiply by 1000, into dz_um",
        ),
        (
            "load_n",
            "load_g",
            "rig.csv:1: there is no load, expected a column load_n (newtons) or load_kg (kilograms) -> load_g would be in g: multiply by 0.00980665, into load_n",
        ),
        (
            "axis",
            "Achse",
            "rig.csv:1: there is no column axis, expected the direction of each load, such as x or -z -> rename \"Achse\" to axis",
        ),
        (
            "axis",
            "direction",
            "rig.csv:1: there is no column axis, expected the direction of each load, such as x or -z -> rename \"direction\" to axis",
        ),
        (
            "phase",
            "DZ_um",
            "rig.csv:1:19: column \"DZ_um\" stands there twice, expected every column once -> delete or rename one of the two",
        ),
        (
            "phase",
            "",
            "rig.csv:1:19: column 4 has no name, expected a name in every cell of the header -> name the column or delete it",
        ),
        (
            "axis,load_n,dz_um,phase,time_s,temperature_c,load_station_mm\n",
            "",
            "rig.csv:1:3: the first line holds the number \"0\", expected the names of the columns -> put a header line above the numbers",
        ),
        // rows
        (
            "z,5,",
            "5,",
            "rig.csv:3: the row has 6 cells, expected 7 as in the header -> leave cells blank, but write every `,`",
        ),
        (
            "12.5",
            "12,5",
            "rig.csv:3: the row has 8 cells, expected 7 as in the header -> numbers with decimal commas need `;` between the cells, also in the header",
        ),
        (
            "12.5",
            "\"12.5",
            "rig.csv:3:5: a stray quote or line break, expected cells without quotes, or quotes directly around the whole cell -> close every quote on its line, and write a quote inside of quotes twice",
        ),
        (
            "z,5,",
            "z,\u{0}5,",
            "rig.csv:3:3: a NUL character; this is an Excel workbook or other binary file, expected CSV text -> export it as CSV (in Excel: \"CSV UTF-8\")",
        ),
    ];
    for (piece, wrong, expected) in cases {
        assert_eq!(refusal(&GOOD.replacen(piece, wrong, 1)), expected);
    }
}

#[test]
fn every_bad_file_is_named() {
    let cases = [
        ("", "rig.csv: the file is empty, expected a header line with the names of the columns, then rows"),
        (
            "\n # nothing\n",
            "rig.csv: the file has only comments, expected a header line with the names of the columns, then rows",
        ),
        (
            "PK\u{3}\u{4}x",
            "rig.csv: this is an Excel workbook, expected CSV text -> export it as CSV (in Excel: \"CSV UTF-8\")",
        ),
        (
            "axis,load_n,dz_um\n",
            "rig.csv: there are no readings under the header, expected at least two different loads along an axis: a line needs two points",
        ),
        (
            "axis,load_n,dz_um\nz,5,1\n",
            "rig.csv:2: there is one reading only, expected at least two different loads along an axis: a line needs two points",
        ),
        (
            "axis,load_n,dz_um\nz,5,1\nz,5,2\n",
            "rig.csv:2: every load is 5 N along z, expected at least two different loads along an axis: a line needs two points",
        ),
        (
            "axis,load_n,dx_um,dz_um\nz,5,1,\nz,6,,2\n",
            "rig.csv:2: no offset was read under two different loads along one axis, expected at least two different loads along an axis: a line needs two points",
        ),
        (
            "axis;load_n;dz_um\nz;5;1,5\nz;6.5;2\n",
            "rig.csv:3:3: load_n is \"6.5\", expected `,` as decimal mark, as in \"1,5\" in line 2 -> use one decimal mark in the whole file, and nothing between thousands",
        ),
        (
            "axis;load_n;dz_um\nz;500;1\nz;1,000;2\n",
            "rig.csv:3:3: load_n is \"1,000\", with a decimal comma or a comma between thousands, expected numbers that can be read in one way only -> write 1000 without a comma, and 1.000 with a decimal point",
        ),
        (
            "axis;load_n;dz_um\nz;5;1,5\nz;6;1.234,5\n",
            "rig.csv:3:5: dz_um is \"1.234,5\", expected a number -> write nothing between thousands",
        ),
        (
            "axis\tload_n\tdz_um\nz\t5\n",
            "rig.csv:2: the row has 2 cells, expected 3 as in the header -> leave cells blank, but write every tab",
        ),
    ];
    for (text, expected) in cases {
        assert_eq!(refusal(text), expected);
    }
}

#[test]
fn odd_files_are_read_with_a_warning() {
    assert_eq!(warnings(GOOD), [""; 0]);
    assert_eq!(
        warnings(&GOOD.replace("phase", "dy_µm")),
        [
            "the column \"dy_µm\" is not read; did you mean dy_um? known columns: axis, load_n, load_kg, dx_um, dy_um, dz_um, \
          trial, phase, time_s, temperature_c, load_station_mm, read_station_mm, session, loaded_at_s"
        ]
    );
    assert_eq!(
        warnings("axis;load_n;dz_um;by\nx;5;1,5;Ann\nx;6;2,5;Ann\n-y;7;1;\n"),
        [
            "read with `;` separators and decimal commas",
            "the column \"by\" is not read; known columns: axis, load_n, load_kg, dx_um, dy_um, dz_um, \
             trial, phase, time_s, temperature_c, load_station_mm, read_station_mm, session, loaded_at_s",
            "dz_um has only the load -7 N along y: there is no slope without a second load",
        ]
    );
    assert_eq!(
        warnings("axis,load_n,dz_um\nz,5,0.00012\nz,6,-0.00021\n"),
        [
            "the largest offset is 0.00021 µm: the offsets look like metres or millimetres, and are read as micrometres"
        ]
    );
    assert_eq!(
        warnings("axis,load_n,dz_um\nz,5,0\nz,6,0\n"),
        ["every offset is zero: was the sensor connected?"]
    );
}

/// Reads bytes as a user's file is read; whatever they are, what is said about them lies within the
/// file.
fn read_any(bytes: Vec<u8>) -> Result<Result<Readings, Error>, TestCaseError> {
    let line_count = bytes.iter().filter(|&&b| b == b'\n').count() + 1;
    let result = text_of_bytes("f", bytes).and_then(|text| Readings::from_text("f", &text));
    match &result {
        Ok(readings) => prop_assert!(readings.rows.iter().all(|row| row.line <= line_count)),
        Err(Error::Input { at, .. }) => prop_assert!(at.line <= line_count, "{at}"),
        Err(other) => prop_assert!(false, "{other}"),
    }
    Ok(result)
}

/// One row in micrometres, newtons and so on, as a file has it.
#[derive(Debug, Clone)]
struct Written {
    axis: &'static str,
    load: f64,
    offset: [Option<f64>; 3],
    trial: Option<u8>,
    time: Option<f64>,
}

fn written_row() -> impl Strategy<Value = Written> {
    let axis = prop::sample::select(vec!["x", "Y", "-z", "+x", "\u{2212}y"]);
    let offset = (-1e5..1e5f64, prop::option::of(-1e-3..1e-3f64), prop::option::of(Just(-4.0)));
    (axis, 0.0..1e4f64, offset, prop::option::of(0..9u8), prop::option::of(0.0..1e6f64)).prop_map(
        |(axis, load, (dx, dy, dz), trial, time)| Written {
            axis,
            load,
            offset: [Some(dx), dy, dz],
            trial,
            time,
        },
    )
}

fn written(rows: &[Written], separator: &str, decimal_mark: &str) -> String {
    let number =
        |value: Option<f64>| value.map_or(String::new(), |v| v.to_string().replace('.', decimal_mark));
    let mut lines = vec![["axis", "load_n", "dx_um", "dy_um", "dz_um", "trial", "time_s"].join(separator)];
    for row in rows {
        let [dx, dy, dz] = row.offset.map(number);
        let trial = row.trial.map_or(String::new(), |t| format!("{t}.a"));
        let cells = [row.axis.into(), number(Some(row.load)), dx, dy, dz, trial, number(row.time)];
        lines.push(cells.join(separator));
    }
    lines.join("\r\n")
}

proptest! {
    #[test]
    fn arbitrary_bytes_are_read_or_refused(bytes in prop::collection::vec(any::<u8>(), 0..400)) {
        let _ = read_any(bytes)?;
    }

    #[test]
    fn arbitrary_tables_are_read_or_refused(text in "(axis|load_n|dz_um|[-,;\t\"'#\r\n .0-9eExyz\u{feff}µ]){0,80}") {
        let _ = read_any(text.into_bytes())?;
    }

    #[test]
    fn mutations_of_a_good_file_are_read_or_refused(
        edits in prop::collection::vec((0..GOOD.len(), 0..4usize, "[-,;\t\"#\r\n .0-9eExyz\u{0}\u{feff}µ\u{2028}]{0,3}"), 1..8)
    ) {
        let mut bytes = GOOD.as_bytes().to_vec();
        for (start, length, new) in edits {
            let start = start.min(bytes.len());
            let end = (start + length).min(bytes.len());
            bytes.splice(start..end, new.bytes());
        }
        let _ = read_any(bytes)?;
    }

    #[test]
    fn separators_and_decimal_marks_do_not_change_the_readings(
        rows in prop::collection::vec(written_row(), 10..30)
    ) {
        let points = read_any(written(&rows, ",", ".").into_bytes())?.unwrap();
        for (separator, mark) in [(";", ","), ("\t", ","), (";", "."), (" \t ", ".")] {
            let other = read_any(written(&rows, separator, mark).into_bytes())?.unwrap();
            prop_assert_eq!(&points.rows, &other.rows);
        }
        for (row, reading) in rows.iter().zip(&points.rows) {
            let Reading { load, offset, time, .. } = reading;
            prop_assert_eq!((*load, *time), (row.load, row.time));
            prop_assert_eq!(*offset, row.offset.map(|o| o.map(|um| um * 1e-6)));
        }
    }
}
