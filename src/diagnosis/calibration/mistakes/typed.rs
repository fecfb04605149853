//! What a number may have been that was typed wrongly.

/// A number as it may have been meant.
#[derive(Debug, Clone, PartialEq)]
pub struct Meant {
    /// As it would stand in the file.
    pub text: String,
    /// What happened to it.
    pub why: &'static str,
    /// Ln of how usual that is.
    pub log_prior: f64,
}

impl Meant {
    pub fn value(&self) -> f64 {
        self.text.parse().unwrap_or(f64::NAN)
    }
}

/// Ln of how much rarer a digit is that is another one, one that is missing or too many, and one
/// that was counted too far, with what is carried.
const WRONG_DIGIT: f64 = -1.0;
const LENGTH: f64 = -2.0;
const CARRIED: f64 = -2.0;
/// Farthest that a digit is counted too far.
const COUNTED: i32 = 2;
/// Farthest that a decimal point is displaced.
const FARTHEST: i32 = 3;
/// More decimals are not looked for in a column.
const MOST_DECIMALS: usize = 9;

/// How many decimals a column has at most.
pub fn decimals(values: impl Iterator<Item = f64>) -> usize {
    let needed = |value: f64| {
        let is_whole = |places: &usize| {
            let scaled = value.abs() * 10f64.powi(*places as i32);
            (scaled - scaled.round()).abs() < 1e-3 || scaled > 1e12
        };
        (0..MOST_DECIMALS).find(is_whole).unwrap_or(MOST_DECIMALS)
    };
    values.map(needed).max().unwrap_or(0)
}

/// All that `value`, written with so many decimals, may have been meant to be.
pub fn meant(value: f64, decimals: usize) -> Vec<Meant> {
    let recorded = format!("{value:.decimals$}");
    let (sign, digits) = match recorded.strip_prefix('-') {
        Some(digits) => ("-", digits.to_owned()),
        None => ("", recorded.clone()),
    };
    let mut all: Vec<Meant> = Vec::new();
    let mut add = |text: String, why: &'static str, log_prior: f64| {
        let meant = Meant { text, why, log_prior };
        let is_new = |known: &Meant| known.value() != meant.value();
        let leads =
            |text: &str| text.starts_with('0') && text.as_bytes().get(1).is_some_and(u8::is_ascii_digit);
        let is_written = !leads(meant.text.trim_start_matches('-'));
        if is_written && meant.value().is_finite() && meant.value() != value && all.iter().all(is_new) {
            all.push(meant);
        }
    };
    let other = if sign.is_empty() { "-" } else { "" };
    add(format!("{other}{digits}"), "its sign is wrong", 0.0);
    for power in (-FARTHEST..=FARTHEST).filter(|power| *power != 0) {
        let places = (decimals as i32 - power).max(0) as usize;
        let moved = value * 10f64.powi(power);
        let text = format!("{moved:.places$}");
        let kept = text.find('.').map_or(text.len(), |point| point + 1 + decimals);
        let zeros = text.len() - text.trim_end_matches('0').len();
        let text = text[..text.len() - zeros.min(text.len().saturating_sub(kept))].to_owned();
        add(text, "its decimal point is in the wrong place", 0.0);
    }
    let letters: Vec<char> = digits.chars().collect();
    let places: Vec<usize> = (0..letters.len()).filter(|&k| letters[k].is_ascii_digit()).collect();
    let joined = |letters: Vec<char>| format!("{sign}{}", letters.into_iter().collect::<String>());
    for pair in places.windows(2) {
        let mut swapped = letters.clone();
        swapped.swap(pair[0], pair[1]);
        add(joined(swapped), "two of its digits are exchanged", 0.0);
    }
    for &place in &places {
        for digit in '0'..='9' {
            let mut wrong = letters.clone();
            wrong[place] = digit;
            add(joined(wrong), "one of its digits is wrong", WRONG_DIGIT);
        }
    }
    // 109 for 99: the tens were counted one too far
    for place in 0..places.len() {
        let unit = 10f64.powi((places.len() - 1 - place) as i32 - decimals as i32);
        for count in (-COUNTED..=COUNTED).filter(|count| *count != 0) {
            let counted = value + f64::from(count) * unit;
            add(format!("{counted:.decimals$}"), "one of its digits was counted too far", CARRIED);
        }
    }
    let point = letters.iter().position(|letter| *letter == '.').unwrap_or(letters.len());
    for place in 0..point {
        let mut shorter = letters.clone();
        shorter.remove(place);
        add(joined(shorter), "it has a digit too many", LENGTH);
    }
    for place in 0..=point {
        for digit in '0'..='9' {
            let mut longer = letters.clone();
            longer.insert(place, digit);
            add(joined(longer), "it lacks a digit", LENGTH);
        }
    }
    all
}

/// A number of the file without what converting it to rad or m and back has left.
pub(super) fn tidy(value: f64) -> f64 {
    format!("{value:.12e}").parse().unwrap_or(value)
}

#[cfg(test)]
mod tests {
    use super::{decimals, meant};

    #[test]
    fn what_a_number_may_have_been() {
        let all = meant(-45.32, 2);
        let why = |text: &str| all.iter().find(|meant| meant.text == text).map(|meant| meant.why);
        assert_eq!(why("45.32"), Some("its sign is wrong"));
        assert_eq!(why("-54.32"), Some("two of its digits are exchanged"));
        assert_eq!(why("-43.52"), Some("two of its digits are exchanged"));
        assert_eq!(why("-453.2"), Some("its decimal point is in the wrong place"));
        assert_eq!(why("-0.4532"), Some("its decimal point is in the wrong place"));
        assert_eq!(why("-45.37"), Some("one of its digits is wrong"));
        assert_eq!(why("-145.32"), Some("it lacks a digit"));
        assert_eq!(why("-5.32"), Some("it has a digit too many"));
        assert_eq!(why("-45.32"), None);
        // with what is carried; else it is a wrong digit
        assert_eq!(why("-65.32"), Some("one of its digits is wrong"));
        let all = meant(-109.05, 2);
        let why = |text: &str| all.iter().find(|meant| meant.text == text).map(|meant| meant.why);
        assert_eq!(why("-99.05"), Some("one of its digits was counted too far"));
        assert_eq!(why("-89.05"), Some("one of its digits was counted too far"));
        assert_eq!(why("-79.05"), None);
    }

    #[test]
    fn decimals_of_a_column() {
        assert_eq!(decimals([12.5, 3.25, 7.0].into_iter()), 2);
        assert_eq!(decimals([0.1 + 0.2].into_iter()), 1);
        assert_eq!(decimals(std::iter::empty()), 0);
    }
}
