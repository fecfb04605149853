//! Which columns the CSV files of a campaign have, and what to say where they have others.

use super::Warning;
use super::layout::{Role, Seen};
use crate::delimited::{Row, Table, meant_to_be, nearest_name, renamed};
use crate::error::Result;
use crate::robot::{Robot, joint_value};

pub(super) const POSITION: [&str; 3] = ["x_mm", "y_mm", "z_mm"];
/// Where tracker or base stood.
pub(super) const STATION: &str = "station";
const OPTIONAL: [&str; 3] = ["time_s", "temperature_c", STATION];

/// The columns of one file.
pub(super) struct Columns {
    joints: Vec<JointColumn>,
    /// `pose`, and the columns that name where the ball was held.
    names: &'static [&'static str],
    has_positions: bool,
}

/// `q1_deg` with a degree in rad, or `q3_mm` with a millimetre in m.
struct JointColumn {
    name: String,
    unit: f64,
}

impl Columns {
    pub(super) fn new(robot: &Robot, seen: Seen<'_>) -> Columns {
        let joints = robot.joints.iter().zip(1..).map(|(joint, number)| {
            let (name, unit) = joint.column(number);
            JointColumn { name, unit }
        });
        let names: &[&str] = match seen {
            Seen::World => &["pose"],
            Seen::Clamps(_) => &["pose", "clamp"],
            Seen::Sockets(_) => &["pose", "placement", "socket"],
        };
        Columns { joints: joints.collect(), names, has_positions: !matches!(seen, Seen::Sockets(_)) }
    }

    /// The joint values of a row, rad or m.
    pub(super) fn joint_values(&self, row: Row<'_>) -> impl Iterator<Item = Result<f64>> {
        let value = move |name: &str| required(row, name).and_then(|_| joint_value(row, name));
        self.joints.iter().map(move |joint| Ok(value(&joint.name)? * joint.unit))
    }

    /// Whether the cells of a column are numbers.
    pub(super) fn holds_numbers(&self, column: &str) -> bool {
        self.known().any(|known| known.eq_ignore_ascii_case(column))
            && !self.names.iter().any(|name| name.eq_ignore_ascii_case(column))
            && !column.eq_ignore_ascii_case(STATION)
    }

    /// Refuses a table in which a column is missing, or that is about another robot or other
    /// clamps.
    pub(super) fn check(&self, table: &Table, role: Role) -> Result<()> {
        for &name in self.names {
            if !table.has(name) {
                return self.missing(table, &[name], meaning(name).to_owned());
            }
        }
        // validation positions are in {W} even where the clamps are not needed
        let has_clamps = self.names.contains(&"clamp") || role == Role::Validation;
        if table.has("clamp") && !has_clamps {
            let expected = "no such column, for the campaign has no [[clamp]]";
            let hint = "add a [[clamp]] with id, xyz_mm and rpy_deg for each, or delete the column";
            let found = "there is a column clamp".to_owned();
            return Err(table.header_error("clamp", found, expected.to_owned(), Some(hint.to_owned())));
        }
        self.check_joints(table)?;
        let missing: Vec<&str> = POSITION.into_iter().filter(|column| !table.has(column)).collect();
        if self.has_positions && !missing.is_empty() {
            let frame = match self.names.contains(&"clamp") {
                true => "the device frame of the clamp",
                false => "{W}",
            };
            return self.missing(table, &missing, format!("the ball's position in {frame}, in mm"));
        }
        Ok(())
    }

    /// A warning for each column that is not read.
    pub(super) fn unused(&self, file: &str, table: &Table) -> Vec<Warning> {
        let known: Vec<&str> = self.known().collect();
        let is_unused = |column: &&str| !known.iter().any(|known| known.eq_ignore_ascii_case(column));
        let warning = |column: &str| Warning::UnusedColumn {
            file: file.to_owned(),
            column: column.to_owned(),
            // a column that is there already is not what this one was meant to be
            nearest: nearest_name(column, &known).filter(|near| !table.has(near)).map(str::to_owned),
        };
        table.columns().filter(is_unused).map(warning).collect()
    }

    fn known(&self) -> impl Iterator<Item = &str> {
        let positions: &[&str] = if self.has_positions { &POSITION } else { &[] };
        let joints = self.joints.iter().map(|joint| joint.name.as_str());
        self.names.iter().copied().chain(joints).chain(positions.iter().copied()).chain(OPTIONAL)
    }

    fn check_joints(&self, table: &Table) -> Result<()> {
        let names: Vec<&str> = self.joints.iter().map(|joint| joint.name.as_str()).collect();
        let count = names.len();
        let expected = match count {
            1 => format!("{}, for the robot has 1 joint", names[0]),
            _ => format!("{}, for the robot has {count} joints", listed(&names)),
        };
        let missing: Vec<&str> = names.iter().copied().filter(|name| !table.has(name)).collect();
        if !missing.is_empty() {
            return self.missing(table, &missing, expected);
        }
        let surplus =
            table.columns().find(|column| joint_number(column).is_some_and(|n| n == 0 || n > count));
        match surplus {
            Some(column) => {
                let found = format!("there is a column {column}");
                let hint = "is this the recording of another robot?".to_owned();
                Err(table.header_error(column, found, expected, Some(hint)))
            }
            None => Ok(()),
        }
    }

    fn missing(&self, table: &Table, missing: &[&str], expected: String) -> Result<()> {
        let found = match missing {
            [one] => format!("there is no column {one}"),
            more => format!("there are no columns {}", listed(more)),
        };
        let known: Vec<&str> = self.known().collect();
        let hint = renamed(table.columns(), &known, missing).or_else(|| self.meant(table, missing));
        let hint = hint.or_else(|| Some(table.columns_found()));
        Err(table.header_error("", found, expected, hint))
    }

    /// Which column of the table was most likely meant to be one of the `missing` ones.
    fn meant(&self, table: &Table, missing: &[&str]) -> Option<String> {
        if missing.contains(&"x_mm") && table.has("placement") && table.has("socket") {
            return Some("a ball in sockets needs a section [sockets] in the campaign".to_owned());
        }
        let is_joint = missing.iter().any(|name| joint_number(name).is_some());
        if is_joint && (table.has("q0_deg") || table.has("q0_mm")) {
            return Some("joints count from 1: q1_deg is the one next to the base".to_owned());
        }
        let stray = || table.columns().filter(|c| !self.known().any(|known| known.eq_ignore_ascii_case(c)));
        let stem = |name: &str| name.split('_').next().unwrap_or_default().to_ascii_lowercase();
        let same_stem = stray().find_map(|column| {
            let is_meant = |name: &&&str| {
                joint_number(column).is_some_and(|n| joint_number(name) == Some(n))
                    || stem(name) == column.to_ascii_lowercase()
            };
            Some((column, *missing.iter().find(is_meant)?))
        });
        let near = || stray().find_map(|column| Some((column, nearest_name(column, missing)?)));
        let (column, name) = same_stem.or_else(near)?;
        Some(match column.to_ascii_lowercase().rsplit_once('_') {
            Some((_, "rad")) => format!("{column} would be in radians: convert it to degrees, into {name}"),
            Some((_, "deg")) if name.ends_with("_mm") => {
                format!("the joint slides: {name} instead of {column}")
            }
            Some((_, "mm")) if name.ends_with("_deg") => {
                format!("the joint turns: {name} instead of {column}")
            }
            _ => meant_to_be(column, name),
        })
    }
}

/// The number in a cell that must have one.
pub(super) fn required(row: Row<'_>, column: &str) -> Result<f64> {
    // what a blank or a "NaN" of an optional column stands for is not possible here
    if row.text(column).is_none_or(|text| !text.contains(|c: char| c.is_ascii_digit())) {
        let hint = "delete the row, or put a # before it".to_owned();
        return Err(row.error(column, "a number".to_owned(), Some(hint)));
    }
    row.required_number(column)
}

/// 3 for `q3_deg`, and also for what may be meant as that.
fn joint_number(column: &str) -> Option<usize> {
    let column = column.to_ascii_lowercase();
    let digits = column.strip_prefix('q')?;
    let end = digits.find(|c: char| !c.is_ascii_digit()).unwrap_or(digits.len());
    let (number, suffix) = digits.split_at(end);
    ["", "_deg", "_mm", "_rad", "_m"].contains(&suffix).then(|| number.parse().ok())?
}

fn meaning(column: &str) -> &'static str {
    match column {
        "clamp" => "the id of the clamp that held the ball, for the campaign has [[clamp]]",
        "placement" => "a name for where the tool with the sockets stood, for the campaign has [sockets]",
        "socket" => "the number of the socket that held the ball, 0 or 1, for the campaign has [sockets]",
        _ => "a name for each pose",
    }
}

/// Names in a row, the middle of a long one left out.
pub(super) fn listed(names: &[&str]) -> String {
    match names {
        [first, second, _, _, _, _, _, _, .., last] => format!("{first}, {second}, …, {last}"),
        few => few.join(", "),
    }
}
