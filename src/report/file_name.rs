//! Names of the files of a report's pictures and tables.

/// "figure-1-rod-shape": the number makes it unique, the rest is safe on every file system.
pub(super) fn file_name(kind: &str, number: usize, name: &str) -> String {
    let safe: String =
        name.to_lowercase().chars().map(|c| if c.is_ascii_alphanumeric() { c } else { '-' }).collect();
    let words: Vec<&str> = safe.split('-').filter(|word| !word.is_empty()).collect();
    let number = number.to_string();
    [kind, &number].into_iter().chain(words).collect::<Vec<_>>().join("-")
}
