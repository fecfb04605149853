//! Tables of text cells that know where they stand: a header line, then rows, separated by `,`, `;`
//! or tabs.
//!
//! `#` comment lines, blank lines, quoted cells, spaces around cells, CRLF and a byte-order mark
//! are understood. One record is one line: no measurement has a line break in a cell, and so an
//! unclosed quote is found on its own line instead of swallowing the rest of the file.

mod decimal_mark;
mod foreign;
mod names;
mod numbers;
mod split;
mod table;
mod written;

pub use foreign::renamed;
pub use names::{converted, meant_to_be, nearest_name};
pub use numbers::Dialect;
pub use table::{Row, Table};
pub use written::{cell, comments_above, guarded, is_obeyed, message, quoted, visible, visible_lines};

#[cfg(test)]
mod tests {
    use super::*;
    use crate::error::Result;

    fn parse(text: &str) -> Result<Table> {
        Table::parse("f.csv", text, |name| name.ends_with("_mm"))
    }

    fn numbers(text: &str) -> Vec<Option<f64>> {
        parse(text).unwrap().rows().map(|row| row.number("x_mm").unwrap()).collect()
    }

    fn message(text: &str) -> String {
        parse(text)
            .and_then(|t| t.rows().try_for_each(|r| r.number("x_mm").map(drop)))
            .unwrap_err()
            .to_string()
    }

    #[test]
    fn comments_blanks_quotes_spaces_and_line_ends_are_understood() {
        let text = "\u{feff}# rig\r\n\r\n id , x_mm\r\n  # first\r\n\"a, \"\"b\"\"\", 1.5\r\n,,\r\nb,\r\n";
        let table = parse(text).unwrap();
        let rows: Vec<_> = table.rows().collect();
        assert_eq!(rows.len(), 2);
        assert_eq!((rows[0].line(), rows[0].text("ID")), (5, Some("a, \"b\"")));
        assert_eq!(rows[0].number("x_mm").unwrap(), Some(1.5));
        assert_eq!((rows[1].line(), rows[1].number("x_mm").unwrap()), (7, None));
    }

    #[test]
    fn stray_quotes_are_found_where_they_stand() {
        for (text, place) in [
            ("a,x_mm\nb,\"1\n2,3\n", "f.csv:2:3"),
            ("a,x_mm\n\"b\"c,1\n", "f.csv:2:1"),
            ("a,x_mm\nb, \"1\"\n", "f.csv:2:4"),
        ] {
            assert!(message(text).starts_with(&format!("{place}: a stray quote")), "{}", message(text));
        }
    }

    #[test]
    fn decimal_commas_are_read_where_all_numbers_have_them() {
        assert_eq!(numbers("id;x_mm\n1.5;1,5\na;\u{2212}2\n"), [Some(1.5), Some(-2.0)]);
        assert_eq!(numbers("id\tx_mm\n\t1,5e-3\n"), [Some(1.5e-3)]);
        assert_eq!(numbers("id;x_mm\na;1.5\n"), [Some(1.5)]);
        let note = parse("id;x_mm\na;1,5\n").unwrap().dialect().to_string();
        assert_eq!(note, "read with `;` separators and decimal commas");
    }

    #[test]
    fn a_comma_that_may_group_thousands_needs_a_proof() {
        assert_eq!(numbers("x_mm;y\n1,234;\n2,468;\n"), [Some(1.234), Some(2.468)]);
        assert_eq!(numbers("x_mm;y\n1,234;\n500;\n0,500;\n"), [Some(1.234), Some(500.0), Some(0.5)]);
        let error = message("x_mm;y\n500;\n1,000;\n");
        assert!(
            error.starts_with("f.csv:3:1: x_mm is \"1,000\", with a decimal comma or a comma"),
            "{error}"
        );
        assert_eq!(message("x_mm;y\n1,5;\n1.234,5;\n"), "f.csv:3:1: x_mm is \"1.234,5\", expected a number");
    }

    #[test]
    fn only_finite_decimal_numbers_are_numbers() {
        for bad in ["NaN", "inf", "-infinity", "0x1F", "5 N", "1e", ".", "--1", "1.2.3", "1_000", "٣"] {
            let expected = format!("f.csv:2:4: x_mm is \"{bad}\", expected a number");
            assert_eq!(message(&format!("id,x_mm\nµ, {bad}\n")), expected);
        }
        let error = message("x_mm\n1e999\n");
        assert_eq!(error, "f.csv:2:1: x_mm is \"1e999\", expected a number of at most 1e30 in size");
        assert_eq!(numbers("x_mm\n+1.\n.5\n-1E3\n"), [Some(1.0), Some(0.5), Some(-1000.0)]);
    }
}
