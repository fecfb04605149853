//! A campaign as files: what [`Campaign::read`] reads.

use std::fmt::Write as _;

use nalgebra::Vector3;

use super::{Campaign, Group, GroupName, Recording, Refit, Targets};
use crate::delimited::cell;
use crate::robot::{Motion, Robot};
use crate::toml_text::{comments, quoted};
use crate::units::{DEG, MM, UM};

/// Names of the files that a written campaign refers to.
#[derive(Debug, Clone)]
#[non_exhaustive]
pub struct FileNames {
    /// The robot's.
    pub robot: String,
    /// What stands beside a URDF, where there is something.
    pub effects: Option<String>,
    /// The rod's, where there is one.
    pub rod: Option<String>,
    /// That of the rod's readings, where there are any.
    pub rig: Option<String>,
    /// The measurements'.
    pub measurements: String,
    /// The validation's, where there is one.
    pub validation: Option<String>,
}

impl FileNames {
    /// Of a robot and its measurements; the other files are fields to be filled in.
    pub fn new(robot: impl Into<String>, measurements: impl Into<String>) -> FileNames {
        let (robot, measurements) = (robot.into(), measurements.into());
        FileNames { robot, effects: None, rod: None, rig: None, measurements, validation: None }
    }
}

impl Campaign {
    /// The campaign file, with comments above it.
    pub fn to_toml(&self, names: &FileNames, above: &[String]) -> String {
        let mut text: String = comments(above);
        let mut key = |key: &str, value: String| text += &format!("{key} = {value}\n");
        key("robot", quoted(&names.robot));
        names.effects.iter().for_each(|effects| key("effects", quoted(effects)));
        names.rod.iter().for_each(|rod| key("rod", quoted(rod)));
        names.rig.iter().for_each(|rig| key("rig", quoted(rig)));
        if let Some(force) = self.contact_force {
            key("contact_force_n", three(&force, 1.0));
        }
        key("measurements", quoted(&names.measurements));
        names.validation.iter().for_each(|name| key("validation", quoted(name)));
        self.base_link.iter().for_each(|link| key("base_link", quoted(link)));
        self.tip_link.iter().for_each(|link| key("tip_link", quoted(link)));
        let has_points = matches!(self.measurements.targets, Targets::Points(_));
        if has_points && self.refit == Refit::Nothing {
            key("validation_refit", quoted("none"));
        }
        if self.tool_is_given {
            text += &format!("\n[tool]\nxyz_mm = {}\n", three(&self.tool, MM));
        }
        if self.base_is_given {
            let [x, y, z, roll, pitch, yaw] = self.base;
            let (xyz, rpy) = (Vector3::new(x, y, z), Vector3::new(roll, pitch, yaw));
            text += &format!("\n[base]\nxyz_mm = {}\nrpy_deg = {}\n", three(&xyz, MM), three(&rpy, DEG));
        }
        text += &self.groups();
        let stated = [("position_um", self.noise), ("clamp_um", self.clamp_uncertainty)];
        let stated = stated.into_iter().filter_map(|(key, sd)| Some((key, sd?)));
        let lines: String = stated.map(|(key, sd)| format!("{key} = {}\n", number(sd / UM))).collect();
        if !lines.is_empty() {
            text += &format!("\n[noise]\n{lines}");
        }
        if let Some(limits) = self.accuracy {
            let stated = [("mean_um", limits.mean), ("max_um", limits.max)];
            let stated = stated.into_iter().filter_map(|(key, limit)| Some((key, limit?)));
            let lines: String =
                stated.map(|(key, limit)| format!("{key} = {}\n", number(limit / UM))).collect();
            text += &format!("\n[accuracy]\n{lines}");
        }
        text + &self.constraints()
    }

    /// Clamps or sockets.
    fn groups(&self) -> String {
        let clamp = |Group { name, device }: &Group| {
            let GroupName::Clamp(id) = name else { return String::new() };
            let [roll, pitch, yaw] = device.roll_pitch_yaw();
            let rpy = Vector3::new(roll, pitch, yaw);
            let (id, xyz, rpy) = (quoted(id), three(&device.origin, MM), three(&rpy, DEG));
            format!("\n[[clamp]]\nid = {id}\nxyz_mm = {xyz}\nrpy_deg = {rpy}\n")
        };
        match &self.measurements.targets {
            Targets::Points(_) => self.measurements.groups.iter().map(clamp).collect(),
            Targets::Sockets(distances) => match distances.first() {
                Some(known) => format!(
                    "\n[sockets]\ndistance_mm = {}\ndistance_sd_mm = {}\n",
                    number(known.value / MM),
                    number(known.sd / MM)
                ),
                // no placement has two sockets: whatever stands here is not used
                None => "\n[sockets]\ndistance_mm = 1\n".into(),
            },
        }
    }

    fn constraints(&self) -> String {
        let constraints = &self.constraints;
        let mut text = String::new();
        let list = |parameters: &[crate::robot::Parameter]| {
            let keys: Vec<String> = parameters.iter().map(|parameter| quoted(&parameter.key())).collect();
            format!("[{}]", keys.join(", "))
        };
        if !constraints.fixed.is_empty() || !constraints.freed.is_empty() {
            let (fix, free) = (list(&constraints.fixed), list(&constraints.freed));
            text += &format!("\n[parameters]\nfix = {fix}\nfree = {free}\n");
        }
        for (parameter, value, sd) in &constraints.priors {
            let unit = parameter.unit().si;
            text += &format!(
                "\n[[prior]]\nparameter = {}\nvalue = {}\nsd = {}\n",
                quoted(&parameter.key()),
                number(value / unit),
                number(sd / unit)
            );
        }
        text
    }
}

impl Recording {
    /// The CSV file of a recording with `robot`, with comments above it: each position in its
    /// clamp's frame and at its own station, as it was measured.
    pub fn to_csv(&self, robot: &Robot, above: &[String]) -> String {
        let mut text = comments(above);
        let has_clamps = self.groups.iter().any(|group| !group.name.is_tracked());
        let has_points = matches!(self.targets, Targets::Points(_));
        let has_stations = self.stations.iter().any(|station| !station.name.is_empty());
        let has_time = self.rows.iter().any(|row| row.time.is_some());
        let has_temperature = self.rows.iter().any(|row| row.temperature.is_some());
        let mut columns = vec!["pose".to_owned()];
        let groups: &[&str] = match (has_points, has_clamps) {
            (true, true) => &["clamp"],
            (true, false) => &[],
            (false, _) => &["placement", "socket"],
        };
        columns.extend(groups.iter().map(|name| (*name).to_owned()));
        columns.extend((1..).zip(&robot.joints).map(|(number, joint)| joint.column(number).0));
        if has_points {
            columns.extend(["x_mm", "y_mm", "z_mm"].map(str::to_owned));
        }
        for (name, is_there) in
            [("station", has_stations), ("time_s", has_time), ("temperature_c", has_temperature)]
        {
            if is_there {
                columns.push(name.to_owned());
            }
        }
        text += &(columns.join(",") + "\n");
        for (row, entry) in self.rows.iter().enumerate() {
            let mut cells = vec![entry.pose.clone()];
            match &self.groups[entry.group].name {
                GroupName::Tracked if has_clamps => cells.push(String::new()),
                GroupName::Tracked => {}
                GroupName::Clamp(id) => cells.push(id.clone()),
                GroupName::Socket { placement, socket } => cells.extend([placement.clone(), socket.clone()]),
            }
            cells.extend(
                self.read_joints(row)
                    .iter()
                    .zip(&robot.joints)
                    .map(|(q, joint)| number(q / if joint.motion == Motion::Revolute { DEG } else { MM })),
            );
            if let Targets::Points(points) = &self.targets {
                let seen = self.device(row).inverse().point(&points[row]) / MM;
                cells.extend(seen.iter().map(|x| number(*x)));
            }
            if has_stations {
                cells.push(self.stations[entry.station].name.clone());
            }
            let optional = |value: Option<f64>| value.map_or_else(String::new, number);
            if has_time {
                cells.push(optional(entry.time));
            }
            if has_temperature {
                cells.push(optional(entry.temperature));
            }
            let cells: Vec<String> = cells.iter().map(|text| cell(text)).collect();
            let _ = writeln!(text, "{}", cells.join(","));
        }
        text
    }
}

/// A number to 1e-7 of its unit: below any device's last digit, above the rounding of arithmetic.
fn number(value: f64) -> String {
    let rounded = (value * 1e7).round() / 1e7;
    // "-0" is 0
    format!("{}", if rounded == 0.0 { 0.0 } else { rounded })
}

fn three(vector: &Vector3<f64>, unit: f64) -> String {
    let [x, y, z] = [vector.x, vector.y, vector.z].map(|x| number(x / unit));
    format!("[{x}, {y}, {z}]")
}
