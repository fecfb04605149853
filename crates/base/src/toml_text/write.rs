//! How numbers and texts are written into TOML, such that reading them gives the same.

use crate::delimited::is_obeyed;

/// The number of fewest digits that times `si` is `value`, or the nearest there is.
pub fn in_unit(value: f64, si: f64) -> f64 {
    let quotient = value / si;
    let rounded = (14..17).filter_map(|digits| format!("{quotient:.digits$e}").parse::<f64>().ok());
    let candidates = rounded.chain([quotient, quotient.next_up(), quotient.next_down()]);
    candidates.into_iter().find(|candidate| candidate * si == value).unwrap_or(quotient)
}

/// A text in quotes; what a terminal would obey instead of showing it is escaped.
pub fn quoted(text: &str) -> String {
    if !text.contains(|c| is_obeyed(c) && c != '\n') {
        return toml::Value::from(text).to_string();
    }
    let mut written = String::from("\"");
    for c in text.chars() {
        match c {
            '"' | '\\' => written.extend(['\\', c]),
            c if is_obeyed(c) => written += &format!("\\U{:08X}", u32::from(c)),
            c => written.push(c),
        }
    }
    written + "\""
}

/// Lines of comments, each under a `#`.
pub fn comments(lines: &[String]) -> String {
    let mut text = String::new();
    for line in lines.iter().flat_map(|comment| comment.lines()) {
        let plain: String = line.chars().map(|c| if is_obeyed(c) { ' ' } else { c }).collect();
        text += format!("# {plain}").trim_end();
        text.push('\n');
    }
    text
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_is_written_is_read_again_and_shows_all_that_it_holds() {
        for text in ["5# \"steel\"", "a\nb", "\u{1b}[31m\u{202e}\u{9b}2J\u{e0001}\"\\µ\t\r\n", "\u{7f}"] {
            let written = quoted(text);
            assert!(!written.contains(|c| is_obeyed(c) && c != '\n'), "{written:?}");
            let table: toml::Table = format!("a = {written}").parse().unwrap();
            assert_eq!(table["a"].as_str(), Some(text));
        }
        assert_eq!(comments(&["a\u{202e}b\u{1b}\nc".into()]), "# a b\n# c\n");
    }
}
