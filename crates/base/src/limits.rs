//! How much a file may hold. What is beyond is refused with one error, before memory is taken for
//! it: no input ends in an abort, and reading needs no more than 2 GB.
//!
//! `docs/limits.md` lists these for users, and a test compares the two.

use crate::error::{Error, Place, Result};

/// Bytes of any file.
pub const FILE_BYTES: usize = 256_000_000;
/// Bytes of a table (CSV).
pub const TABLE_BYTES: usize = 128_000_000;
/// Rows of a table: readings, poses, tubes.
pub const TABLE_ROWS: usize = 1_000_000;
/// Columns of a table.
pub const TABLE_COLUMNS: usize = 1_000;
/// Cells of a table.
pub const TABLE_CELLS: usize = 10_000_000;
/// Readings of one rod.
pub const READINGS: usize = 100_000;
/// Lines that readings are sorted into: channel, direction and station of the load, station of the
/// sensor.
pub const RIG_LINES: usize = 2_000;
/// Sessions in which a rod was mounted again: each has a root of its own.
pub const SESSIONS: usize = 500;
/// Different loads of a line that was measured in more than 50 trials.
pub const REPEATED_LOADS: usize = 2_000;
/// Bytes of a TOML file: rod, robot, campaign, design.
pub const TOML_BYTES: usize = 8_000_000;
/// Bytes of a URDF.
pub const URDF_BYTES: usize = 16_000_000;
/// Attributes of one element of a URDF: each is compared with all others.
pub const URDF_ATTRIBUTES: usize = 1_000;
/// `xmlns` in a URDF: every element inherits all above it.
pub const URDF_NAMESPACES: usize = 100;
/// Elements, texts and comments of a URDF.
pub const URDF_NODES: usize = 1_000_000;
/// Joints of a robot that move.
pub const ROBOT_JOINTS: usize = 64;
/// Size of a joint's value in a table, degrees or mm: the sine of what is larger says nothing.
pub const JOINT_VALUE: usize = 1_000_000_000;
/// Places where a tracker or the base stood: each is six unknowns of a dense system.
pub const STATIONS: usize = 100;
/// Clamps of a campaign, or sockets of its placements: each may be three unknowns of it.
pub const CLAMPS: usize = 500;
/// Values of one key of a design file.
pub const DESIGN_VALUES: usize = 100_000;
/// Effects of a robot file.
pub const ROBOT_EFFECTS: usize = 1_000;
/// Laws of a robot file.
pub const ROBOT_LAWS: usize = 100;
/// Constants of a law.
pub const LAW_CONSTANTS: usize = 12;
/// Effects of a lab's own file.
pub const OWN_EFFECTS: usize = 100;
/// Parameters of one of them.
pub const OWN_PARAMETERS: usize = 8;
/// Bytes of its name.
pub const NAME_BYTES: usize = 60;
/// Bytes of its words.
pub const WORDS_BYTES: usize = 200;
/// Masses, joints, sleeves and laws of a rod, of each: what sits along it is nodes of its beam, and
/// numbers whose part in the uncertainty is found by a beam of its own.
pub const ROD_PARTS: usize = 100;
/// Sleeves of a design file that a rod may have or not: each doubles the combinations.
pub const OPTIONAL_SLEEVES: usize = 10;
/// Bytes of a result (result.json) that is read again.
pub const RESULT_BYTES: usize = 64_000_000;
/// Cases of a trial.
pub const TRIAL_CASES: usize = 9_999;

/// Refuses more than `most` of something in `file`.
///
/// # Errors
/// [`Error::Input`].
pub fn check(file: &str, found: usize, most: usize, what: &str) -> Result<()> {
    if found <= most {
        return Ok(());
    }
    Err(Error::Input {
        at: Place::whole_file(file),
        found: format!("it has {found} {what}"),
        expected: format!("at most {most}"),
        hint: Some("docs/limits.md lists how much a file may hold".into()),
    })
}
