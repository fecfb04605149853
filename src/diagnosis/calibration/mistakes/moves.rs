//! Every mistake that a campaign's files may hold, as a list of what undoes each.

pub(super) mod bodies;
mod conventions;
pub(super) mod of_rows;

use std::f64::consts::{FRAC_PI_2, PI};

use nalgebra::{Matrix3, Vector3};

pub(super) use self::conventions::turn;
use self::conventions::{SAME, Said, TURN_IN_RADIANS, is_same, readings};
use super::super::effects::mistakes::{
    FRAME_MISTAKE, OFFSET_MISTAKE, ROW_MISTAKE, SIGN_MISTAKE, SWAP_MISTAKE, UNIT_MISTAKE,
};
use super::draft::{Change, Draft};
use super::names::{AXES, column};
use crate::calibration::campaign::Campaign;
use crate::inference::{Effect, Estimate};
use crate::robot::Motion;
use crate::spatial::Pose;
use crate::statistics::median;
use crate::units::{DEG, MM, significant};

/// Farthest displacement of rows that is tried.
const FARTHEST_ROW: isize = 3;
/// Clamps are exchanged one by one where there are no more; with more there are too many pairs.
const MOST_CLAMPS: usize = 12;
/// A ball in a clamp is displaced by less, m: by larger numbers it may be that they are in a
/// smaller unit.
const DISPLACEMENT: f64 = 10.0 * MM;
/// Ln of how much rarer some mistakes are.
const UNUSUAL: f64 = -1.0;
const RARE: f64 = -2.0;

/// A mistake that may have been made, with what is said of it.
#[derive(Clone)]
pub(super) struct Move {
    pub effect: &'static Effect,
    /// As in the file.
    pub location: String,
    pub change: Change,
    pub log_prior: f64,
    pub estimates: Vec<Estimate>,
    /// What to do: `Multiply q4_deg by −1`.
    pub cure: String,
    /// Why: `its sign is wrong`.
    pub why: String,
}

impl Move {
    /// What explains poses as well, at such odds.
    pub fn with_odds(&self, odds: f64) -> (&'static Effect, String, f64) {
        (self.effect, self.location.clone(), odds)
    }
}

/// A robot or rod of another file.
pub(super) struct Other {
    pub file: String,
    pub name: String,
    pub is_rod: bool,
    /// The tip of a rod.
    pub tip: Option<Vector3<f64>>,
    /// Its number among the bodies.
    pub body: usize,
}

/// All that these files could show.
pub(super) fn all(
    campaign: &Campaign,
    draft: &Draft,
    others: &[Other],
    forces: &[(usize, f64)],
) -> Vec<Move> {
    let mut list = List { campaign, draft, moves: Vec::new(), is_of_rows: false };
    list.joints();
    list.positions();
    list.rows();
    list.clamps();
    list.base();
    list.tool();
    list.files(others);
    list.contact_forces(forces);
    list.moves
}

struct List<'a> {
    campaign: &'a Campaign,
    draft: &'a Draft,
    moves: Vec<Move>,
    /// True for what some rows hold and others do not.
    is_of_rows: bool,
}

/// An exact number.
fn exact(name: &str, value: f64) -> Vec<Estimate> {
    vec![Estimate { name: name.into(), unit: 1.0, value, low: value, high: value }]
}

impl List<'_> {
    pub(super) fn add(
        &mut self,
        effect: &'static Effect,
        location: &str,
        change: Change,
        cure: &str,
        why: &str,
    ) -> &mut Move {
        self.moves.push(Move {
            effect,
            location: location.into(),
            change,
            log_prior: 0.0,
            estimates: Vec::new(),
            cure: cure.into(),
            why: why.into(),
        });
        let last = self.moves.len() - 1;
        &mut self.moves[last]
    }

    pub(super) fn column(&self, joint: usize) -> String {
        column(&self.campaign.robot, joint)
    }

    pub(super) fn joints(&mut self) {
        let count = self.draft.joint_count;
        let turns: Vec<usize> =
            (0..count).filter(|&j| self.campaign.robot.joints[j].motion == Motion::Revolute).collect();
        let all: Vec<usize> = (0..count).collect();
        let every = match count {
            1 => self.column(0),
            _ => format!("{} … {}", self.column(0), self.column(count - 1)),
        };
        for j in 0..count {
            let name = self.column(j);
            let change = Change::factors(&[j], count, -1.0);
            self.add(&SIGN_MISTAKE, &name, change, &format!("Multiply {name} by −1"), "its sign is wrong");
        }
        if count > 1 {
            let change = Change::factors(&all, count, -1.0);
            self.add(
                &SIGN_MISTAKE,
                &every,
                change,
                &format!("Multiply {every} by −1"),
                "their signs are wrong",
            )
            .log_prior = UNUSUAL;
        }
        for &j in &turns {
            let name = self.column(j);
            for quarter in [1.0, -1.0, 2.0] {
                let degrees = 90.0 * quarter;
                let said = if degrees > 0.0 {
                    format!("Add {degrees}° to")
                } else {
                    format!("Subtract {}° from", -degrees)
                };
                let change = Change::offset(j, count, 1.0, FRAC_PI_2 * quarter);
                let why = format!("the joint's zero is off by {}°", degrees.abs());
                self.add(&OFFSET_MISTAKE, &name, change, &format!("{said} {name}"), &why).estimates =
                    exact("deg", degrees);
                let change = Change::offset(j, count, -1.0, FRAC_PI_2 * quarter);
                let cure = format!("Replace {name} by {degrees}° − {name}");
                let mirrored =
                    self.add(&OFFSET_MISTAKE, &name, change, &cure, "its sign and its zero are wrong");
                mirrored.estimates = exact("deg", degrees);
                mirrored.log_prior = RARE;
            }
        }
        self.orders(count);
        self.angle_units(&turns, &every);
    }

    fn orders(&mut self, count: usize) {
        let same =
            |a: usize, b: usize| self.campaign.robot.joints[a].motion == self.campaign.robot.joints[b].motion;
        let pairs: Vec<(usize, usize)> = (0..count)
            .flat_map(|a| (a + 1..count).map(move |b| (a, b)))
            .filter(|&(a, b)| same(a, b))
            .collect();
        for (a, b) in pairs {
            let mut order: Vec<usize> = (0..count).collect();
            order.swap(a, b);
            let (first, second) = (self.column(a), self.column(b));
            let place = format!("{first} and {second}");
            let cure = format!("Exchange the columns {first} and {second}");
            self.add(&SWAP_MISTAKE, &place, Change::order(order), &cure, "each holds the other joint");
        }
        if count < 3
            || (1..count)
                .any(|j| self.campaign.robot.joints[j].motion != self.campaign.robot.joints[0].motion)
        {
            return;
        }
        let every = format!("{} … {}", self.column(0), self.column(count - 1));
        let mut add = |order: Vec<usize>, cure: &str, why: &str| {
            self.add(&SWAP_MISTAKE, &every, Change::order(order), cure, why).log_prior = UNUSUAL;
        };
        let cure = "Turn the order of the joint columns round";
        add((0..count).rev().collect(), cure, "they run from the flange to the base");
        let cure = "Name each joint column by the joint after it, and the last one by the first";
        add(
            (0..count).map(|j| (j + count - 1) % count).collect(),
            cure,
            "the columns are displaced by one joint",
        );
        let cure = "Name each joint column by the joint before it, and the first one by the last";
        add((0..count).map(|j| (j + 1) % count).collect(), cure, "the columns are displaced by one joint");
    }

    /// Radians are small, and degrees that were converted once more are huge: an arm that hardly
    /// moves would fit anything that does not move.
    fn angle_units(&mut self, turns: &[usize], every: &str) {
        let count = self.draft.joint_count;
        let largest = |j: usize| {
            let of_joint = self.draft.joints.iter().skip(j).step_by(count);
            of_joint.fold(0.0, |most: f64, q| most.max(q.abs())) / DEG
        };
        let largest: Vec<f64> = (0..count).map(largest).collect();
        let is_of_rows = self.is_of_rows;
        let are_small = |joints: &[usize]| is_of_rows || joints.iter().all(|&j| largest[j] < TURN_IN_RADIANS);
        let are_huge = |joints: &[usize]| is_of_rows || joints.iter().any(|&j| largest[j] > 720.0);
        let mut all = Vec::new();
        if turns.len() > 1 {
            all.push((turns.to_vec(), every.to_owned(), UNUSUAL + 1.0));
        }
        all.extend(turns.iter().map(|&j| (vec![j], self.column(j), UNUSUAL)));
        for (joints, name, log_prior) in all {
            let it = if joints.len() > 1 { "they are" } else { "it is" };
            if are_small(&joints) {
                let change = Change::factors(&joints, count, 180.0 / PI);
                let why = format!("{it} in radians, not in degrees");
                let radians =
                    self.add(&UNIT_MISTAKE, &name, change, &format!("Multiply {name} by 180/π"), &why);
                radians.estimates = exact("factor", 180.0 / PI);
                radians.log_prior = log_prior;
            }
            if are_huge(&joints) {
                let change = Change::factors(&joints, count, PI / 180.0);
                let why = format!("{it} degrees that were converted to degrees once more");
                let twice =
                    self.add(&UNIT_MISTAKE, &name, change, &format!("Multiply {name} by π/180"), &why);
                twice.estimates = exact("factor", PI / 180.0);
                twice.log_prior = log_prior + UNUSUAL;
            }
        }
    }

    pub(super) fn positions(&mut self) {
        if self.draft.has_sockets() {
            return;
        }
        const ALL: &str = "x_mm, y_mm, z_mm";
        // in clamps smaller numbers are nearer to any robot that was sent there
        let is_clamped = self.campaign.measurements.groups.iter().any(|group| !group.name.is_empty());
        let sizes: Vec<f64> = self.draft.seen.iter().map(|seen| seen.norm()).collect();
        let is_far = !is_clamped || median(&sizes).is_some_and(|size| size > DISPLACEMENT);
        for (factor, unit, log_prior) in [
            (1e3, "metres", 0.0),
            (25.4, "inches", 0.0),
            (10.0, "centimetres", UNUSUAL),
            (1e-3, "micrometres", UNUSUAL),
            (0.1, "tenths of a millimetre", RARE),
        ] {
            if factor < 1.0 && !is_far && !self.is_of_rows {
                continue;
            }
            let by = if factor < 1.0 {
                format!("Divide {ALL} by {}", 1.0 / factor)
            } else {
                format!("Multiply {ALL} by {factor}")
            };
            let change = Change::Seen(Matrix3::identity() * factor);
            let unit =
                self.add(&UNIT_MISTAKE, ALL, change, &by, &format!("they are in {unit}, not in millimetres"));
            (unit.estimates, unit.log_prior) = (exact("factor", factor), log_prior);
        }
        let names = AXES;
        for order in [[0, 1, 2], [1, 0, 2], [0, 2, 1], [2, 1, 0], [1, 2, 0], [2, 0, 1]] {
            for signs in 0..8u8 {
                let sign = [0, 1, 2].map(|axis| if signs >> axis & 1 == 1 { -1.0 } else { 1.0 });
                let flipped: Vec<&str> =
                    (0..3).filter(|&axis| sign[axis] < 0.0).map(|axis| names[axis]).collect();
                let mut matrix = Matrix3::zeros();
                (0..3).for_each(|axis| matrix[(axis, order[axis])] = sign[axis]);
                if matrix == Matrix3::identity() {
                    continue;
                }
                let moved: Vec<usize> = (0..3).filter(|&axis| order[axis] != axis).collect();
                let is_swap = moved.len() == 2;
                let (effect, place, cure, why, log_prior) = match (moved.len(), flipped.len()) {
                    (0, 1) => {
                        let name = flipped[0].to_owned();
                        let cure = format!("Multiply {name} by −1");
                        (&SIGN_MISTAKE, name, cure, "the axis of the device points the other way", 0.0)
                    }
                    (0, _) => {
                        let place = flipped.join(", ");
                        let cure = format!("Multiply {place} by −1");
                        (&SIGN_MISTAKE, place, cure, "axes of the device point the other way", UNUSUAL)
                    }
                    (_, 0) if is_swap => {
                        let place = format!("{} and {}", names[moved[0]], names[moved[1]]);
                        let cure = format!("Exchange {place}");
                        (&SWAP_MISTAKE, place, cure, "axes of the device are exchanged", 0.0)
                    }
                    _ => {
                        let term = |axis: usize| {
                            format!("{}{}", if sign[axis] < 0.0 { "−" } else { "" }, names[order[axis]])
                        };
                        let cure = format!("Replace {ALL} by {}, {}, {}", term(0), term(1), term(2));
                        (
                            &SWAP_MISTAKE,
                            ALL.to_owned(),
                            cure,
                            "the device is turned",
                            UNUSUAL + if is_swap { 0.0 } else { -0.5 },
                        )
                    }
                };
                self.add(effect, &place, Change::Seen(matrix), &cure, why).log_prior = log_prior;
            }
        }
    }

    pub(super) fn rows(&mut self) {
        if self.draft.has_sockets() {
            return;
        }
        let has_clamps = self.draft.devices.len() > 1;
        for by in (-FARTHEST_ROW..=FARTHEST_ROW).filter(|by| *by != 0) {
            for with_clamps in [false, true].into_iter().filter(|with| has_clamps || !with) {
                let (count, way) = (by.unsigned_abs(), if by > 0 { "up" } else { "down" });
                let rows = if count == 1 { "row" } else { "rows" };
                let what = if with_clamps { "clamp, x_mm, y_mm and z_mm" } else { "x_mm, y_mm and z_mm" };
                let cure = format!("Move {what} {count} {rows} {way}");
                let why = format!(
                    "each position belongs to the angles {count} {rows} {}",
                    if by > 0 { "above" } else { "below" }
                );
                let change = Change::Rows { by, with_clamps };
                let place = if with_clamps { "clamp, x_mm, y_mm, z_mm" } else { "x_mm, y_mm, z_mm" };
                let shift = self.add(&ROW_MISTAKE, place, change, &cure, &why);
                shift.estimates = exact("rows", by as f64);
                shift.log_prior =
                    if count == 1 { 0.0 } else { UNUSUAL } + if with_clamps { UNUSUAL } else { 0.0 };
            }
        }
    }

    /// Clamps or sockets that were named the other way round.
    pub(super) fn exchanged(&mut self) {
        let names: Vec<String> =
            self.campaign.measurements.groups.iter().map(|group| group.name.clone()).collect();
        let count = names.len();
        if count > 1 && count <= MOST_CLAMPS {
            for (a, b) in (0..count).flat_map(|a| (a + 1..count).map(move |b| (a, b))) {
                // in the order of the campaign, whichever is met first
                let (a, b) = if names[a] > names[b] { (b, a) } else { (a, b) };
                let place = match (names[a].strip_prefix("clamp "), names[b].strip_prefix("clamp ")) {
                    (Some(a), Some(b)) => format!("clamps {a} and {b}"),
                    _ => format!("sockets {} and {}", names[a], names[b]),
                };
                let cure = format!("Exchange {place}");
                self.add(
                    &SWAP_MISTAKE,
                    &place,
                    Change::Groups(a, b),
                    &cure,
                    "each holds the poses of the other",
                );
            }
        }
    }

    fn clamps(&mut self) {
        self.exchanged();
        let names: Vec<String> =
            self.campaign.measurements.groups.iter().map(|group| group.name.clone()).collect();
        let count = names.len();
        if self.draft.has_sockets() || names.iter().any(String::is_empty) {
            return;
        }
        let devices = self.draft.devices.clone();
        let readings: Vec<Vec<(Matrix3<f64>, Said)>> =
            devices.iter().map(|device| readings(device.roll_pitch_yaw(), &device.rotation)).collect();
        let of_clamp = |k: usize, rotation: Matrix3<f64>| (k, Pose { rotation, ..devices[k] });
        for k in 0..count {
            for (rotation, said) in &readings[k] {
                let change = Change::Devices(vec![of_clamp(k, *rotation)]);
                let place = format!("{} rpy_deg", names[k]);
                self.add(&FRAME_MISTAKE, &place, change, &said.cure(&place), said.why).log_prior = UNUSUAL;
            }
        }
        if count > 1 {
            let kinds: Vec<Said> = readings.iter().flatten().map(|(_, said)| *said).collect();
            for (_, said) in kinds.iter().enumerate().filter(|(k, said)| !kinds[..*k].contains(said)) {
                let entry = |k: usize| {
                    let rotation =
                        readings[k].iter().find(|(_, own)| own == said).map(|(rotation, _)| *rotation);
                    rotation.map(|rotation| of_clamp(k, rotation))
                };
                let change = Change::Devices((0..count).filter_map(entry).collect());
                let place = "clamp rpy_deg (all)";
                self.add(&FRAME_MISTAKE, place, change, &said.cure("rpy_deg of all clamps"), said.why)
                    .log_prior = UNUSUAL;
            }
        }
        for (factor, unit) in [(1e3, "metres"), (25.4, "inches"), (1e-3, "micrometres")] {
            let scaled =
                |(k, device): (usize, &Pose)| (k, Pose { origin: device.origin * factor, ..*device });
            let change = Change::Devices(devices.iter().enumerate().map(scaled).collect());
            let cure = format!("Multiply xyz_mm of all clamps by {factor}");
            let why = format!("they are in {unit}, not in millimetres");
            let unit = self.add(&UNIT_MISTAKE, "clamp xyz_mm (all)", change, &cure, &why);
            (unit.estimates, unit.log_prior) = (exact("factor", factor), UNUSUAL);
        }
    }

    fn base(&mut self) {
        let Some(base) = self.draft.base else { return };
        let [_, _, _, roll, pitch, yaw] = self.campaign.base;
        let is_other = |pose: &Pose| !is_same(pose, &base);
        let inverse = base.inverse();
        if is_other(&inverse) {
            let cure = "Replace [base] by its inverse";
            self.add(&FRAME_MISTAKE, "base", Change::Base(inverse), cure, "it is {W} in {0}, not {0} in {W}");
        }
        for (rotation, said) in readings([roll, pitch, yaw], &base.rotation) {
            let turned = Pose { rotation, ..base };
            if is_other(&turned) {
                let cure = said.cure("base.rpy_deg");
                self.add(&FRAME_MISTAKE, "base.rpy_deg", Change::Base(turned), &cure, said.why);
            }
        }
        for (factor, unit) in [(1e3, "metres"), (25.4, "inches"), (1e-3, "micrometres")] {
            let scaled = Pose { origin: base.origin * factor, ..base };
            if is_other(&scaled) {
                let cure = format!("Multiply base.xyz_mm by {}", significant(factor, 4));
                let why = format!("it is in {unit}, not in millimetres");
                self.add(&UNIT_MISTAKE, "base.xyz_mm", Change::Base(scaled), &cure, &why).estimates =
                    exact("factor", factor);
            }
        }
    }

    fn tool(&mut self) {
        let Some(tool) = self.draft.tool.filter(|tool| tool.norm() > SAME.1) else { return };
        let is_given = self.campaign.tool_is_given;
        let key = if is_given { "tool.xyz_mm" } else { "rod" };
        let mut known: Vec<Vector3<f64>> = vec![tool];
        let mut add = |tip: Vector3<f64>,
                       effect: &'static Effect,
                       cure: String,
                       why: &str,
                       estimates: Vec<Estimate>| {
            if known.iter().any(|known| (known - tip).norm() < SAME.1) {
                return;
            }
            known.push(tip);
            self.add(effect, key, Change::Tool(tip), &cure, why).estimates = estimates;
        };
        let letters = ["x", "y", "z"];
        for order in [[0, 1, 2], [1, 0, 2], [0, 2, 1], [2, 1, 0], [1, 2, 0], [2, 0, 1]] {
            for signs in 0..8u8 {
                let sign = [0, 1, 2].map(|axis| if signs >> axis & 1 == 1 { -1.0 } else { 1.0 });
                let tip = Vector3::from_fn(|axis, _| sign[axis] * tool[order[axis]]);
                let term = |axis: usize| {
                    format!("{}{}", if sign[axis] < 0.0 { "−" } else { "" }, letters[order[axis]])
                };
                let axes = [0, 1, 2].map(term).join(", ");
                let cure = match is_given {
                    true => format!("Replace tool.xyz_mm = [x, y, z] by [{axes}]"),
                    false => format!(
                        "Give the tip as [{axes}] of the rod's, with a [tool]: the rod is turned on the flange"
                    ),
                };
                add(tip, &FRAME_MISTAKE, cure, "it is given in another frame than {T}", Vec::new());
            }
        }
        for (factor, unit) in
            [(1e3, "it is in metres, not in millimetres"), (25.4, "it is in inches, not in millimetres")]
        {
            if is_given {
                let cure = format!("Multiply tool.xyz_mm by {factor}");
                add(tool * factor, &UNIT_MISTAKE, cure, unit, exact("factor", factor));
            }
        }
    }
}
