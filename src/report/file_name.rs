//! Names of the files of a report's pictures and tables.

/// "figure-1-rod-shape": the number makes it unique, the rest is safe on every file system.
pub(super) fn file_name(page: &str, kind: &str, number: usize, name: &str) -> String {
    let safe: String =
        name.to_lowercase().chars().map(|c| if c.is_ascii_alphanumeric() { c } else { '-' }).collect();
    let words: Vec<&str> = safe.split('-').filter(|word| !word.is_empty()).collect();
    let number = number.to_string();
    [page, kind, &number]
        .into_iter()
        .filter(|part| !part.is_empty())
        .chain(words)
        .collect::<Vec<_>>()
        .join("-")
}

/// "index.html", or that of a page of its own name.
pub(super) fn page_name(page: &str) -> String {
    format!("{}.html", if page.is_empty() { "index" } else { page })
}
