//! Misspelt names: which known one is near.

use crate::units::{STANDARD_GRAVITY, Unit, significant};

/// The candidate that a misspelt `name` was most likely meant to be, if any is similar.
pub fn nearest_name<'c>(name: &str, candidates: &[&'c str]) -> Option<&'c str> {
    let name = name.trim().to_lowercase().replace(['µ', 'μ'], "u").replace([' ', '-'], "_");
    let distance = |candidate: &str| {
        let begins = name.len() >= 2 && (candidate.starts_with(&name) || name.starts_with(candidate));
        match edit_distance(&name, candidate) {
            // a name without its unit is as near as one slip of the finger
            slips if begins => slips.min(1),
            slips => slips,
        }
    };
    let nearest = candidates.iter().map(|&c| (distance(c), c)).min_by_key(|&(distance, _)| distance);
    nearest.filter(|&(distance, c)| distance <= 2 && distance * 2 < c.len()).map(|(_, c)| c)
}

/// Asks whether a column was meant to be the known one, or says what to do with its numbers as
/// [`converted`] does.
pub fn meant_to_be(column: &str, known: &str) -> String {
    converted(column, known).unwrap_or_else(|| format!("is the column {column} meant to be {known}?"))
}

/// What to do with the numbers of a column whose unit is another one of the same kind.
///
/// ```
/// use rodcal_base::delimited::converted;
///
/// let said = converted("dy_mm", "dy_um").unwrap();
/// assert_eq!(said, "dy_mm would be in mm: multiply by 1000, into dy_um");
/// let said = converted("load_g", "load_n").unwrap();
/// assert_eq!(said, "load_g would be in g: multiply by 0.00980665, into load_n");
/// assert_eq!(converted("dz", "dz_um"), None);
/// ```
pub fn converted(column: &str, known: &str) -> Option<String> {
    let (own, other) = (Unit::of_key(&column.trim().to_lowercase()), Unit::of_key(known));
    let factor = match (own.suffix, other.suffix) {
        (own, other) if own == other => None,
        ("um" | "mm" | "m", "um" | "mm" | "m") | ("g" | "kg", "kg") => Some(own.si / other.si),
        ("g" | "kg", "n") => Some(own.si * STANDARD_GRAVITY),
        _ => None,
    }?;
    let digits = significant(factor, 6);
    let factor = match digits.contains('.') {
        true => digits.trim_end_matches('0').trim_end_matches('.'),
        false => &digits,
    };
    Some(format!("{column} would be in {}: multiply by {factor}, into {known}", own.symbol))
}

/// Levenshtein's distance: how many characters to insert, delete or replace.
fn edit_distance(a: &str, b: &str) -> usize {
    let b: Vec<char> = b.chars().collect();
    let mut row: Vec<usize> = (0..=b.len()).collect();
    for (i, x) in a.chars().enumerate() {
        let mut diagonal = std::mem::replace(&mut row[0], i + 1);
        for (j, &y) in b.iter().enumerate() {
            let replaced = diagonal + usize::from(x != y);
            diagonal = row[j + 1];
            row[j + 1] = replaced.min(diagonal + 1).min(row[j] + 1);
        }
    }
    row[b.len()]
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn misspelt_names_find_their_neighbour() {
        let known = ["axis", "load_n", "load_kg", "dx_um", "dy_um", "temperature_c"];
        for (name, nearest) in [
            ("dy_µm", Some("dy_um")),
            ("Load", Some("load_n")),
            ("temperature", Some("temperature_c")),
            ("axes", Some("axis")),
            ("operator", None),
            ("", None),
        ] {
            assert_eq!(nearest_name(name, &known), nearest, "{name}");
        }
    }
}
