//! The reader of what was recorded: measurements and validation, one pose per row of a CSV file.

use std::collections::BTreeMap;

use nalgebra::Vector3;

use super::columns::{Columns, POSITION, STATION, listed, required};
use super::layout::{Clamp, Role, Seen, Sockets};
use super::{Distance, Group, GroupName, Recording, Row, Station, Targets, Warning, checks};
use crate::delimited::{Row as Cells, Table, comments_above};
use crate::error::{Error, Place, Result};
use crate::limits;
use crate::robot::Robot;
use crate::spatial::Pose;
use crate::units::{ABSOLUTE_ZERO_C, MM};

/// Fewest poses that place a station.
const LEAST_AT_STATION: usize = 3;

/// Reads `text`, the contents of `file`.
///
/// # Errors
/// [`Error::Input`] with line and column: what [`Table::parse`] refuses; columns that are missing
/// or belong to another robot; cells that are not what their column holds; a clamp that the
/// campaign does not know; a pose that is there twice; no rows.
pub(super) fn read(
    file: &str,
    text: &str,
    robot: &Robot,
    seen: Seen<'_>,
    role: Role,
) -> Result<(Recording, Vec<Warning>)> {
    let columns = Columns::new(robot, seen);
    let table = Table::parse(file, text, |column| columns.holds_numbers(column))?;
    columns.check(&table, role)?;
    let mut reader = Reader {
        file,
        columns: &columns,
        seen,
        has_stations: table.has(STATION),
        groups: Vec::new(),
        stations: Vec::new(),
        lines: BTreeMap::new(),
    };
    let (mut rows, mut joint_values, mut points) = (Vec::new(), Vec::new(), Vec::new());
    for cells in table.rows() {
        let row = reader.row(cells)?;
        for value in reader.columns.joint_values(cells) {
            joint_values.push(value?);
        }
        if !matches!(seen, Seen::Sockets(_)) {
            points.push(reader.groups[row.group].device.point(&position(cells)?));
        }
        rows.push(row);
    }
    if rows.is_empty() {
        let expected = "at least one pose, and many more to calibrate with".to_owned();
        let found = "there are no rows under the header".to_owned();
        return Err(Error::Input { at: Place::whole_file(file), found, expected, hint: None });
    }
    reader.enough_rows(file, &rows)?;
    let targets = match seen {
        Seen::Sockets(sockets) => Targets::Sockets(distances(&reader.groups, sockets)),
        _ => Targets::Points(points),
    };
    let recording = Recording {
        source: comments_above(text),
        file: file.to_owned(),
        joint_count: robot.joints.len(),
        joint_values,
        joints_read: None,
        rows,
        groups: reader.groups,
        stations: reader.stations.iter().map(|name| Station::first(name)).collect(),
        targets,
    };
    let mut warnings = checks::about_dialect(file, &table);
    warnings.extend(columns.unused(file, &table));
    warnings.extend(checks::about_joints(&recording, robot, role));
    Ok((recording, warnings))
}

struct Reader<'a> {
    file: &'a str,
    columns: &'a Columns,
    seen: Seen<'a>,
    has_stations: bool,
    /// In order of appearance.
    groups: Vec<Group>,
    /// Names of where tracker or base stood, in order of appearance; one of name "" without the
    /// column.
    stations: Vec<String>,
    /// Line of each group's poses.
    lines: BTreeMap<(usize, String), usize>,
}

impl Reader<'_> {
    /// All of a row but its joint values and its point.
    fn row(&mut self, cells: Cells<'_>) -> Result<Row> {
        let pose = name(cells, "pose", "a name for the pose")?.to_owned();
        let station = self.station(cells)?;
        let group = self.group(cells, station)?;
        if let Some(line) = self.lines.insert((group, pose.clone()), cells.line()) {
            let whose = match &self.groups[group].name {
                GroupName::Tracked => String::new(),
                name => format!(" of {name}"),
            };
            let expected = format!("a pose{whose} that is not in line {line} already");
            let hint = "give a pose that was measured again a name of its own, such as 7b";
            return Err(cells.error("pose", expected, Some(hint.to_owned())));
        }
        let temperature = match cells.number("temperature_c")? {
            Some(value) if value < ABSOLUTE_ZERO_C => {
                return Err(cells.error("temperature_c", format!("a number ≥ {ABSOLUTE_ZERO_C}"), None));
            }
            value => value,
        };
        Ok(Row { pose, line: cells.line(), group, station, time: cells.number("time_s")?, temperature })
    }

    fn station(&mut self, cells: Cells<'_>) -> Result<usize> {
        let name = match self.has_stations {
            true => name(cells, STATION, "a name for where the tracker or the base stood")?,
            false => "",
        };
        if let Some(index) = self.stations.iter().position(|known| known == name) {
            return Ok(index);
        }
        self.stations.push(name.to_owned());
        limits::check(self.file, self.stations.len(), limits::STATIONS, "stations or more")?;
        Ok(self.stations.len() - 1)
    }

    /// A frame takes three points.
    fn enough_rows(&self, file: &str, rows: &[Row]) -> Result<()> {
        let is_measured = !matches!(self.seen, Seen::Sockets(_)) && self.stations.len() > 1;
        for (station, name) in self.stations.iter().enumerate().filter(|_| is_measured) {
            let count = rows.iter().filter(|row| row.station == station).count();
            if count < LEAST_AT_STATION {
                let at = Place::whole_file(file);
                let found = format!("{count} poses at station {name}");
                let expected =
                    format!("at least {LEAST_AT_STATION}: each station has a frame of its own, six numbers");
                let hint = Some("the column station tells where the tracker or the base stood".into());
                return Err(Error::Input { at, found, expected, hint });
            }
        }
        Ok(())
    }

    fn group(&mut self, cells: Cells<'_>, station: usize) -> Result<usize> {
        let group = match self.seen {
            Seen::World => Group::tracked(),
            Seen::Clamps(clamps) => known_clamp(cells, clamps)?.group(),
            Seen::Sockets(_) => {
                let placement = name(cells, "placement", "a name for where the sockets stood")?;
                let socket = name(cells, "socket", "the number of the socket")?;
                // seen from another place, sockets that do not move are others
                let placement = match station {
                    0 => placement.to_owned(),
                    _ => format!("{placement}, station {}", self.stations[station]),
                };
                Group::new(GroupName::socket(placement, socket), Pose::IDENTITY)
            }
        };
        if let Some(index) = self.groups.iter().position(|known| known.name == group.name) {
            return Ok(index);
        }
        self.groups.push(group);
        limits::check(self.file, self.groups.len(), limits::CLAMPS, "clamps or sockets, or more")?;
        Ok(self.groups.len() - 1)
    }
}

fn known_clamp<'c>(cells: Cells<'_>, clamps: &'c [Clamp]) -> Result<&'c Clamp> {
    let id = cells.text("clamp");
    clamps.iter().find(|clamp| Some(clamp.id.as_str()) == id).ok_or_else(|| {
        let ids: Vec<&str> = clamps.iter().map(|clamp| clamp.id.as_str()).collect();
        let expected = match ids.as_slice() {
            [one] => format!("{one}, the campaign's only clamp"),
            more => format!("one of the campaign's clamps: {}", listed(more)),
        };
        cells.error("clamp", expected, None)
    })
}

fn name<'t>(cells: Cells<'t>, column: &str, expected: &str) -> Result<&'t str> {
    cells.text(column).ok_or_else(|| cells.error(column, expected.to_owned(), None))
}

fn position(cells: Cells<'_>) -> Result<Vector3<f64>> {
    let [x, y, z] = POSITION.map(|column| required(cells, column));
    Ok(Vector3::new(x?, y?, z?) * MM)
}

/// Between the sockets 0 and 1 of each placement that has both.
fn distances(groups: &[Group], Sockets { distance, sd }: Sockets) -> Vec<Distance> {
    let other_of = |name: &GroupName| match name {
        GroupName::Socket { placement, socket } if socket == "0" => {
            let other = GroupName::socket(placement, "1");
            groups.iter().position(|group| group.name == other)
        }
        _ => None,
    };
    let pairs = groups.iter().enumerate().filter_map(|(first, own)| Some([first, other_of(&own.name)?]));
    pairs.map(|between| Distance { between, value: distance, sd }).collect()
}
