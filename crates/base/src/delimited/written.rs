//! Text as a file or a message has it.

/// The text of the comment lines that a file begins with.
pub fn comments_above(text: &str) -> Option<String> {
    let comments = text.lines().map_while(|line| line.trim().strip_prefix('#'));
    let words = comments.map(str::trim).filter(|line| !line.is_empty()).collect::<Vec<_>>().join(" ");
    (!words.is_empty()).then_some(words)
}

/// `text` as a cell of a table that is written: between quotes where it would be taken for more
/// than one cell.
pub fn cell(text: &str) -> String {
    match text.contains([',', ';', '"', '\n', '\r', '\t', '#']) || text.trim() != text {
        true => format!("\"{}\"", text.replace('"', "\"\"")),
        false => text.to_owned(),
    }
}

/// `text` between quotes, shortened and with control characters made visible, for a message.
pub fn quoted(text: &str) -> String {
    const LONGEST: usize = 40;
    let visible = |c: char| if c.is_control() { '\u{fffd}' } else { c };
    let short: String = text.chars().take(LONGEST).map(visible).collect();
    if text.chars().nth(LONGEST).is_some() { format!("\"{short}…\"") } else { format!("\"{short}\"") }
}
