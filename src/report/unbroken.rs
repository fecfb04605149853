//! Words in which no line ends between a number and its unit.

/// What a unit begins with, up to a stroke, a dot or a power.
const UNITS: [&str; 24] = [
    "µm", "mm", "m", "mil", "µrad", "mrad", "rad", "°", "°C", "K", "N", "lbf", "kg", "g", "Pa", "MPa", "GPa",
    "Hz", "s", "min", "h", "%", "MB", "ns",
];
/// The space at which no line is broken.
pub(super) const JOINT: char = '\u{a0}';

/// The same with no break between a number and its unit, and none around "±".
pub(super) fn unbroken(words: &str) -> String {
    let mut unbroken = String::with_capacity(words.len());
    let mut last = "";
    for (k, word) in words.split(' ').enumerate() {
        if k > 0 {
            let is_joint = last == "±" || (is_number(last) && (word == "±" || is_unit(word)));
            unbroken.push(if is_joint { JOINT } else { ' ' });
        }
        unbroken.push_str(word);
        last = word;
    }
    unbroken
}

fn is_number(word: &str) -> bool {
    let word = word.trim_start_matches(['(', '−', '-', '+', '<', '>', '≈']);
    word.starts_with(|first: char| first.is_ascii_digit())
        && word.ends_with(|last: char| last.is_ascii_digit() || "⁰¹²³⁴⁵⁶⁷⁸⁹".contains(last))
}

fn is_unit(word: &str) -> bool {
    let end = word.find(['/', '·', '²', '³', '.', ',', ';', ':', ')']).unwrap_or(word.len());
    UNITS.contains(&&word[..end])
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_number_keeps_its_unit_and_its_uncertainty() {
        let shown = |words: &str| unbroken(words).replace(JOINT, "_");
        assert_eq!(shown("54 ± 5 % softer"), "54_±_5_% softer");
        assert_eq!(
            shown("falls from 102 to 70 µm (4.0 µrad/(N·m)), 3 N·m."),
            "falls from 102 to 70_µm (4.0_µrad/(N·m)), 3_N·m."
        );
        assert_eq!(shown("in 3 poses of clamp 2 moved by 10⁻³ mm"), "in 3 poses of clamp 2 moved by 10⁻³_mm");
        assert_eq!(shown("a  b\nrow 5 in"), "a  b\nrow 5 in");
    }
}
