//! Misspelt names: which known one is near.

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
