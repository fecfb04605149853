//! TOML files whose every error names file, line and column, what stood there and what would be
//! right.

mod text;
mod wording;
mod write;

pub use text::{Number, Required, TomlText};
pub use write::{comments, in_unit, quoted};
