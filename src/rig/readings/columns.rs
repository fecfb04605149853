//! Names of the columns.

/// The columns that are read. `axis`, one of the loads and one of the offsets must be there.
pub const KNOWN_COLUMNS: [&str; 14] = [
    "axis",
    "load_n",
    "load_kg",
    "dx_um",
    "dy_um",
    "dz_um",
    "trial",
    "phase",
    "time_s",
    "temperature_c",
    "load_station_mm",
    "read_station_mm",
    "session",
    "loaded_at_s",
];
pub(super) const TEXT_COLUMNS: [&str; 4] = ["axis", "trial", "phase", "session"];

/// Which of the two columns held the loads.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub enum LoadColumn {
    /// `load_n`.
    #[default]
    Newtons,
    /// `load_kg`.
    Kilograms,
}

pub(super) const LOAD_COLUMNS: [&str; 2] = ["load_n", "load_kg"];
/// By channel: the offset along X, Y and Z.
pub(super) const OFFSET_COLUMNS: [&str; 3] = ["dx_um", "dy_um", "dz_um"];

pub(super) fn is_one_of(column: &str, names: &[&str]) -> bool {
    names.iter().any(|name| name.eq_ignore_ascii_case(column))
}
