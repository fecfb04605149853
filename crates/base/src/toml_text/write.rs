//! How numbers and texts are written into TOML, such that reading them gives the same.

/// The number of fewest digits that times `si` is `value`, or the nearest there is.
pub fn in_unit(value: f64, si: f64) -> f64 {
    let quotient = value / si;
    let rounded = (14..17).filter_map(|digits| format!("{quotient:.digits$e}").parse::<f64>().ok());
    let candidates = rounded.chain([quotient, quotient.next_up(), quotient.next_down()]);
    candidates.into_iter().find(|candidate| candidate * si == value).unwrap_or(quotient)
}

/// A text in quotes.
pub fn quoted(text: &str) -> String {
    toml::Value::from(text).to_string()
}

/// Lines of comments, each under a `#`.
pub fn comments(lines: &[String]) -> String {
    let mut text = String::new();
    for line in lines.iter().flat_map(|comment| comment.lines()) {
        let plain: String = line.chars().map(|c| if c.is_control() { ' ' } else { c }).collect();
        text += format!("# {plain}").trim_end();
        text.push('\n');
    }
    text
}
