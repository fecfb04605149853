//! Text as a file or a message has it.

use std::borrow::Cow;

/// The text of the comment lines that a file begins with.
pub fn comments_above(text: &str) -> Option<String> {
    let comments = text.lines().map_while(|line| line.trim().strip_prefix('#'));
    let words = comments.map(str::trim).filter(|line| !line.is_empty()).collect::<Vec<_>>().join(" ");
    (!words.is_empty()).then_some(words)
}

/// `text` as a cell of a table that is written: between quotes where it would be taken for more
/// than one cell, and behind a `'` where a spreadsheet would take it for a formula, which begins
/// with `=`, `+`, `-` or `@` and is no number. Control characters are escaped.
pub fn cell(text: &str) -> String {
    let text = guarded(text);
    match text.contains([',', ';', '"', '#']) || text.trim() != text {
        true => format!("\"{}\"", text.replace('"', "\"\"")),
        false => text.into_owned(),
    }
}

/// What a parser says, as one printable line of a length that fits a message: it may repeat what
/// the file holds.
pub fn message(text: &str) -> String {
    const LONGEST: usize = 200;
    let short: String = text.chars().take(LONGEST).collect();
    let more = if text.chars().nth(LONGEST).is_some() { " …" } else { "" };
    format!("{}{more}", visible(&short.replace('\n', ", ")))
}

/// `text` with control characters escaped, and behind a `'` where a spreadsheet would take it for a
/// formula; the reader of tables takes that away again.
pub fn guarded(text: &str) -> Cow<'_, str> {
    let shown = visible(text);
    match is_formula(text) {
        true => Cow::Owned(format!("'{shown}")),
        false => shown,
    }
}

/// Begins with `=`, `+`, `-` or `@` and is no number, none with a unit or an interval, and no
/// direction (`-x`).
pub(super) fn is_formula(text: &str) -> bool {
    let is_number = |word: &str| word.trim_end_matches(['%', ',']).parse::<f64>().is_ok();
    let is_word = |word: &str| word == "±" || word == "…" || word.chars().all(char::is_alphabetic);
    // a sign alone calculates nothing
    if matches!(text, "-" | "+") {
        return false;
    }
    let mut words = text.split_whitespace();
    let begins = words.next().is_some_and(|first| match first {
        "-x" | "-y" | "-z" | "+x" | "+y" | "+z" => false,
        first => first.starts_with(['=', '+', '-', '@']) && !is_number(first),
    });
    let begins_as_number = text.trim_start().starts_with(['+', '-']);
    begins || (begins_as_number && !words.all(|word| is_number(word) || is_word(word)))
}

/// `text` between quotes, shortened and with control characters made visible, for a message.
pub fn quoted(text: &str) -> String {
    format!("\"{}\"", short(text))
}

/// The same without quotes.
pub(super) fn short(text: &str) -> String {
    const LONGEST: usize = 40;
    let short: String = text.chars().take(LONGEST).collect();
    let more = if text.chars().nth(LONGEST).is_some() { "…" } else { "" };
    format!("{}{more}", visible(&short))
}

/// `text` with everything escaped that a terminal would obey instead of showing it: control
/// characters (`\x1b`), marks that turn the direction of writing, line and paragraph separators,
/// letters of no width (`\u{202e}`).
pub fn visible(text: &str) -> Cow<'_, str> {
    visible_but(text, &[])
}

/// The same for text of several lines.
pub fn visible_lines(text: &str) -> Cow<'_, str> {
    visible_but(text, &['\n', '\t'])
}

fn visible_but<'t>(text: &'t str, kept: &[char]) -> Cow<'t, str> {
    let is_shown = |c: char| !is_obeyed(c) || kept.contains(&c);
    if text.chars().all(is_shown) {
        return Cow::Borrowed(text);
    }
    let mut shown = String::with_capacity(text.len() + 8);
    for c in text.chars() {
        match u32::from(c) {
            _ if is_shown(c) => shown.push(c),
            0x09 => shown += "\\t",
            0x0A => shown += "\\n",
            0x0D => shown += "\\r",
            code @ 0..0x100 => shown += &format!("\\x{code:02x}"),
            code => shown += &format!("\\u{{{code:x}}}"),
        }
    }
    Cow::Owned(shown)
}

/// Whether a terminal, or a browser, does something else than show this letter.
pub fn is_obeyed(c: char) -> bool {
    // of no width, or a blank that is none: names that look alike could differ
    const UNSEEN: [char; 6] = ['\u{ad}', '\u{115f}', '\u{1160}', '\u{180e}', '\u{3164}', '\u{ffa0}'];
    c.is_control()
        || UNSEEN.contains(&c)
        || matches!(c, '\u{61c}' | '\u{200b}'..='\u{200f}' | '\u{2028}'..='\u{202e}' | '\u{2060}'..='\u{206f}'
            | '\u{feff}' | '\u{fff9}'..='\u{fffb}' | '\u{e0000}'..='\u{e007f}')
}

#[cfg(test)]
mod tests {
    use super::super::Table;
    use super::*;

    #[test]
    fn what_a_terminal_would_obey_is_shown() {
        assert_eq!(visible("a\u{1b}[31m\0\n\u{9b}\u{202e}µ"), "a\\x1b[31m\\x00\\n\\x9b\\u{202e}µ");
        assert_eq!(visible_lines("a\tb\nc\r\u{7f}"), "a\tb\nc\\r\\x7f");
        assert!(matches!(visible("plain – µm²"), Cow::Borrowed(_)));
        assert_eq!(quoted("\u{1b}"), "\"\\x1b\"");
        assert_eq!(visible("a\u{ad}b\u{3164}\u{fffa}"), "a\\xadb\\u{3164}\\u{fffa}");
        assert_eq!(message("a\nb\u{1b}"), "a, b\\x1b");
        assert_eq!(message(&"9".repeat(5000)).chars().count(), 202);
    }

    #[test]
    fn a_cell_is_no_formula() {
        for text in [
            "=1+1",
            "+cmd|' /C calc'!A0",
            "-1+1",
            "@SUM(1)",
            "=HYPERLINK(\"x\")",
            " =1",
            "-2 +A1(3)",
            "+ axial",
        ] {
            assert!(cell(text).trim_start_matches('"').starts_with('\''), "{text}: {}", cell(text));
            let table = Table::parse("f", &format!("a\n{}\n", cell(text)), |_| false).unwrap();
            assert_eq!(table.rows().next().unwrap().text("a"), Some(text.trim()));
        }
        for text in ["-1.5", "+2e-3", "-", "x=1", "", "\u{2212}3", "-0", "-x", "-1.5 ± 0.2 mm", "-3 to 4"] {
            assert_eq!(cell(text), text);
        }
        assert_eq!(cell("a,b"), "\"a,b\"");
    }
}
