//! A campaign as bare numbers, so that it can be read in another way than its files say.

mod displaced;

use nalgebra::{Matrix3, Vector3};

use crate::calibration::campaign::{Campaign, Distance, Recording, Station, Targets};
use crate::spatial::Pose;

/// What was recorded, row by row, with all that a mistake may have changed.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct Draft {
    pub joint_count: usize,
    /// Joint values, rad or m, one row after the other.
    pub joints: Vec<f64>,
    /// Where the ball was, in the frame of its clamp, or in {W} of its station, m; empty with
    /// sockets.
    pub seen: Vec<Vector3<f64>>,
    /// Clamp or socket of each row.
    pub group: Vec<usize>,
    /// Frame of each clamp in {W}.
    pub devices: Vec<Pose>,
    /// Station of each row.
    pub station: Vec<usize>,
    pub stations: usize,
    /// Rows of the recording that the rows are.
    pub rows: Vec<usize>,
    /// First guess of the base, where the file states one.
    pub base: Option<Pose>,
    /// First guess of the tip, where file or rod state one, m.
    pub tool: Option<Vector3<f64>>,
    /// Which of the bodies: robot and rod.
    pub body: usize,
    /// Clamps whose place is free.
    pub loose: Vec<usize>,
    /// Stations that are nearly one.
    pub tether: Option<Tether>,
    /// Changes of the angles, in their order: the validation has them too.
    pub joint_changes: Vec<DraftChange>,
    /// What all positions are multiplied by.
    pub positions_changed: Matrix3<f64>,
}

/// The second station stands where the first one did, but for a move of this size, m and rad.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Tether {
    pub stations: [usize; 2],
    pub way: f64,
    pub turn: f64,
}

/// What undoes a mistake.
#[derive(Debug, Clone, PartialEq)]
pub(super) enum DraftChange {
    /// true joint j = factor[j]·recorded[order[j]] + offset[j].
    Joints { order: Vec<usize>, factor: Vec<f64>, offset: Vec<f64> },
    /// true joint = recorded − sign·recorded `to`: it was counted from what `to` does not turn.
    Relative { joint: usize, to: usize, sign: f64 },
    /// true position = M·recorded.
    Seen(Matrix3<f64>),
    /// The positions of row i are those that stand in row i + k; with the clamps or without.
    Rows { by: isize, with_clamps: bool },
    /// The positions stand in reverse order; with the clamps or without.
    Reversed { with_clamps: bool },
    /// Two clamps or sockets exchanged.
    Groups(usize, usize),
    /// Other frames of clamps.
    Devices(Vec<(usize, Pose)>),
    /// Another first guess of the base.
    Base(Pose),
    /// Another first guess of the tip.
    Tool(Vector3<f64>),
    /// Another robot or rod.
    Body(usize, Option<Vector3<f64>>),
    /// From this row on tracker or base stood elsewhere.
    Moved(usize),
    /// A clamp stands somewhere else, and turned.
    Apart(usize),
    /// The place of a clamp is the one that its poses say.
    Placed(usize),
    /// Another change, of some rows alone.
    Within(Rows, Box<DraftChange>),
    /// true joint = recorded + by, an angle (or a length) that the poses must say.
    Zero { joint: usize, by: f64 },
    /// The number of row i is the one that stands in row i + k.
    Column { cell: Cell, by: isize },
    /// Another number in one row of the recording, rad or m.
    Number { row: usize, cell: Cell, value: f64 },
    /// Rows of the recording that are left out.
    Without(Vec<usize>),
}

/// Some rows, by their numbers in the recording.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Rows {
    /// From one to another, both included.
    Between(usize, usize),
    /// Those of a clamp.
    OfClamp(usize),
}

impl Rows {
    pub fn contain(&self, row: usize, group: usize) -> bool {
        match *self {
            Rows::Between(first, last) => (first..=last).contains(&row),
            Rows::OfClamp(clamp) => clamp == group,
        }
    }
}

/// A number of a row.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Cell {
    Joint(usize),
    /// Along an axis of the device.
    Axis(usize),
}

impl DraftChange {
    /// True where only a first guess is another one, which no fit depends on.
    pub fn is_guess(&self) -> bool {
        matches!(self, DraftChange::Base(_) | DraftChange::Tool(_))
    }

    /// True where some rows get a frame of their own.
    pub fn adds_station(&self) -> bool {
        matches!(self, DraftChange::Moved(_) | DraftChange::Apart(_))
    }

    /// A factor on some joints.
    pub fn factors(joints: &[usize], count: usize, factor: f64) -> DraftChange {
        let factor = (0..count).map(|j| if joints.contains(&j) { factor } else { 1.0 }).collect();
        DraftChange::Joints { order: (0..count).collect(), factor, offset: vec![0.0; count] }
    }

    /// True for an offset of joint 1 and nothing else.
    pub fn is_zero_of_first(&self) -> bool {
        self.joint_of_zero() == Some(0)
    }

    /// The joint of which nothing but the zero is another one.
    pub fn joint_of_zero(&self) -> Option<usize> {
        match self {
            DraftChange::Zero { joint, .. } => Some(*joint),
            DraftChange::Joints { order, factor, offset } => {
                let is_plain = order.iter().enumerate().all(|(joint, from)| joint == *from)
                    && factor.iter().all(|factor| *factor == 1.0);
                let mut off = (0..offset.len()).filter(|joint| offset[*joint] != 0.0);
                off.next().filter(|_| is_plain && off.next().is_none())
            }
            _ => None,
        }
    }

    /// A constant on one joint, rad, after a factor.
    pub fn offset(joint: usize, count: usize, factor: f64, angle: f64) -> DraftChange {
        let only =
            |value: f64, other: f64| (0..count).map(|j| if j == joint { value } else { other }).collect();
        DraftChange::Joints {
            order: (0..count).collect(),
            factor: only(factor, 1.0),
            offset: only(angle, 0.0),
        }
    }

    /// Other names.
    pub fn order(order: Vec<usize>) -> DraftChange {
        let count = order.len();
        DraftChange::Joints { order, factor: vec![1.0; count], offset: vec![0.0; count] }
    }
}

impl Draft {
    pub fn of(campaign: &Campaign) -> Draft {
        let recording = &campaign.measurements;
        let [x, y, z, roll, pitch, yaw] = campaign.base;
        let has_tool = campaign.tool_is_given || campaign.rod.is_some();
        let seen = match &recording.targets {
            Targets::Sockets(_) => Vec::new(),
            Targets::Points(points) => {
                let of_row =
                    |(row, point): (usize, &Vector3<f64>)| recording.device(row).inverse().point(point);
                points.iter().enumerate().map(of_row).collect()
            }
        };
        Draft {
            joint_count: recording.joint_count,
            joints: recording.joint_values.clone(),
            seen,
            group: recording.rows.iter().map(|row| row.group).collect(),
            devices: recording.groups.iter().map(|group| group.device).collect(),
            station: recording.rows.iter().map(|row| row.station).collect(),
            stations: recording.stations.len(),
            rows: (0..recording.len()).collect(),
            base: campaign.base_is_given.then(|| Pose::from_xyz_rpy([x, y, z], [roll, pitch, yaw])),
            tool: has_tool.then_some(campaign.tool),
            body: 0,
            loose: Vec::new(),
            tether: None,
            joint_changes: Vec::new(),
            positions_changed: Matrix3::identity(),
        }
    }

    pub fn len(&self) -> usize {
        self.rows.len()
    }

    pub fn has_sockets(&self) -> bool {
        self.seen.is_empty()
    }

    pub fn joints(&self, row: usize) -> &[f64] {
        &self.joints[row * self.joint_count..][..self.joint_count]
    }

    /// True where the place of a clamp or socket is not known.
    pub fn is_loose(&self, group: usize) -> bool {
        self.has_sockets() || self.loose.contains(&group)
    }

    /// Where the ball was, in {W} of its station, m.
    pub fn point(&self, row: usize) -> Vector3<f64> {
        self.devices[self.group[row]].point(&self.seen[row])
    }

    /// The draft with a mistake undone.
    pub fn with(&self, change: &DraftChange) -> Draft {
        let mut draft = self.clone();
        draft.apply(change);
        draft
    }

    pub(super) fn apply(&mut self, change: &DraftChange) {
        match change {
            DraftChange::Joints { .. } | DraftChange::Relative { .. } => {
                for row in self.joints.chunks_mut(self.joint_count) {
                    change_joints(change, row);
                }
                self.joint_changes.push(change.clone());
            }
            DraftChange::Seen(matrix) => {
                self.seen.iter_mut().for_each(|seen| *seen = matrix * *seen);
                self.positions_changed = matrix * self.positions_changed;
            }
            DraftChange::Rows { by, with_clamps } => self.displace(*by, *with_clamps),
            DraftChange::Reversed { with_clamps } => self.reverse(*with_clamps),
            DraftChange::Groups(a, b) => {
                for group in &mut self.group {
                    *group = if *group == *a {
                        *b
                    } else if *group == *b {
                        *a
                    } else {
                        *group
                    };
                }
            }
            DraftChange::Devices(frames) => {
                frames.iter().for_each(|&(group, frame)| self.devices[group] = frame)
            }
            DraftChange::Base(base) => self.base = Some(*base),
            DraftChange::Tool(tool) => self.tool = Some(*tool),
            DraftChange::Body(body, tool) => {
                self.body = *body;
                self.tool = tool.or(self.tool);
            }
            DraftChange::Moved(first) => {
                let (old, new) = (self.station_at(*first), self.stations);
                for (row, station) in self.rows.iter().zip(&mut self.station) {
                    if row >= first && *station == old {
                        *station = new;
                    }
                }
                self.stations += 1;
            }
            DraftChange::Apart(group) => {
                for (own, station) in self.group.iter().zip(&mut self.station) {
                    if own == group {
                        *station = self.stations;
                    }
                }
                self.stations += 1;
            }
            DraftChange::Placed(clamp) => self.loose.push(*clamp),
            DraftChange::Within(rows, change) => self.apply_within(*rows, change),
            DraftChange::Zero { joint, by } => {
                self.joints.iter_mut().skip(*joint).step_by(self.joint_count).for_each(|q| *q += by);
            }
            DraftChange::Column { cell, by } => {
                let all: Vec<usize> = (0..self.len()).collect();
                self.displace_column(&all, *cell, *by);
            }
            DraftChange::Number { row, cell, value } => {
                let Some(at) = self.rows.iter().position(|known| known == row) else { return };
                *self.number_mut(at, *cell) = *value;
            }
            DraftChange::Without(rows) => {
                let kept: Vec<usize> = (0..self.len()).filter(|&at| !rows.contains(&self.rows[at])).collect();
                *self = self.part(&kept);
            }
        }
    }

    /// The station of a row of the recording, or of the next that is here.
    fn station_at(&self, row: usize) -> usize {
        let at = self.rows.iter().position(|&known| known >= row);
        at.map_or(0, |at| self.station[at])
    }

    /// Some of the rows.
    pub fn part(&self, rows: &[usize]) -> Draft {
        Draft {
            joints: rows.iter().flat_map(|&row| self.joints(row).iter().copied()).collect(),
            seen: if self.has_sockets() {
                Vec::new()
            } else {
                rows.iter().map(|&row| self.seen[row]).collect()
            },
            group: rows.iter().map(|&row| self.group[row]).collect(),
            station: rows.iter().map(|&row| self.station[row]).collect(),
            rows: rows.iter().map(|&row| self.rows[row]).collect(),
            devices: self.devices.clone(),
            loose: self.loose.clone(),
            joint_changes: self.joint_changes.clone(),
            ..*self
        }
    }

    /// At most `most` rows, evenly spread.
    pub fn thinned(&self, most: usize) -> Draft {
        if self.len() <= most {
            return self.clone();
        }
        let rows: Vec<usize> = (0..most).map(|k| k * self.len() / most).collect();
        self.part(&rows)
    }

    /// The recording that was meant.
    pub fn recording(&self, recorded: &Recording) -> Recording {
        let mut meant = recorded.subset(&self.rows);
        meant.groups = recorded.groups.clone();
        meant.joint_values = self.joints.clone();
        meant.joints_read = None;
        for (group, device) in meant.groups.iter_mut().zip(&self.devices) {
            group.device = *device;
        }
        for (k, row) in meant.rows.iter_mut().enumerate() {
            (row.group, row.station) = (self.group[k], self.station[k]);
        }
        let names: Vec<String> = recorded.stations.iter().map(|station| station.name.clone()).collect();
        meant.stations = named(names, self.stations).iter().map(|name| Station::first(name)).collect();
        match (&mut meant.targets, &recorded.targets) {
            (Targets::Points(points), _) => *points = (0..self.len()).map(|row| self.point(row)).collect(),
            (_, Targets::Points(_)) => {}
            (Targets::Sockets(distances), Targets::Sockets(all)) => {
                // of a socket all of whose rows were left out nothing is known
                let used: Vec<usize> =
                    (0..recorded.groups.len()).filter(|group| self.group.contains(group)).collect();
                let place = |group: usize| used.iter().position(|known| *known == group);
                let still = |own: &Distance| {
                    let [a, b] = own.between.map(place);
                    Some(Distance { between: [a?, b?], ..*own })
                };
                *distances = all.iter().filter_map(still).collect();
                meant.groups = used.iter().map(|&group| meant.groups[group].clone()).collect();
                meant.rows.iter_mut().for_each(|row| row.group = place(row.group).unwrap_or(0));
            }
        }
        meant
    }
}

/// Names of so many stations: those that there are, then numbers.
fn named(mut names: Vec<String>, count: usize) -> Vec<String> {
    if count > 1 && names.len() == 1 && names[0].is_empty() {
        names[0] = "1".into();
    }
    while names.len() < count {
        let is_free = |name: &String| !names.contains(name);
        let name = (names.len() + 1..).map(|number| number.to_string()).find(is_free);
        names.extend(name);
    }
    names
}

/// The joint values of one row as they are meant.
pub(super) fn change_joints(change: &DraftChange, row: &mut [f64]) {
    match change {
        DraftChange::Joints { order, factor, offset } => {
            let recorded = row.to_vec();
            for (j, value) in row.iter_mut().enumerate() {
                *value = factor[j] * recorded[order[j]] + offset[j];
            }
        }
        DraftChange::Relative { joint, to, sign } => row[*joint] -= sign * row[*to],
        _ => {}
    }
}
