//! What stands for what a robot file leaves out.

use nalgebra::Vector3;

use crate::units::STANDARD_GRAVITY;

/// Gravity where a file does not state it, m/s²: straight down in a base frame whose z points up.
pub(super) const DOWN: Vector3<f64> = Vector3::new(0.0, 0.0, -STANDARD_GRAVITY);

/// `robots/tx90.toml` → `tx90`.
pub(super) fn file_stem(file: &str) -> String {
    let path = std::path::Path::new(file);
    path.file_stem().map_or_else(|| file.to_owned(), |stem| stem.to_string_lossy().into_owned())
}

/// What a joint is called that has no name.
pub(super) fn default_name(index: usize) -> String {
    format!("joint {}", index + 1)
}
