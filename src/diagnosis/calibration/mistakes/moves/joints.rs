//! What may be wrong with the columns of the joints: signs, zeros, orders, units.

use std::f64::consts::{FRAC_PI_2, PI};

use super::super::super::effects::mistakes::{
    FRAME_MISTAKE, OFFSET_MISTAKE, SIGN_MISTAKE, SWAP_MISTAKE, UNIT_MISTAKE,
};
use super::super::draft::DraftChange;
use super::conventions::TURN_IN_RADIANS;
use super::{List, RARE, UNUSUAL, exact};
use crate::inference::Key;
use crate::robot::Motion;
use crate::units::DEG;

/// Degrees of a gon.
const GON: f64 = 0.9;
/// Axes are parallel within this sine, some three degrees.
const PARALLEL: f64 = 0.05;
/// Parts of a degree that angles are shown in.
const PARTS: [(f64, &str); 3] = [(0.1, "tenths"), (0.01, "hundredths"), (0.001, "thousandths")];

impl List<'_> {
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
            let change = DraftChange::factors(&[j], count, -1.0);
            self.add(
                &SIGN_MISTAKE,
                Key::new(&name),
                change,
                &format!("Multiply {name} by −1"),
                "its sign is wrong",
            );
        }
        if count > 1 {
            let change = DraftChange::factors(&all, count, -1.0);
            self.add(
                &SIGN_MISTAKE,
                Key::new(&every),
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
                let operation = if degrees > 0.0 {
                    format!("Add {degrees}° to")
                } else {
                    format!("Subtract {}° from", -degrees)
                };
                let change = DraftChange::offset(j, count, 1.0, FRAC_PI_2 * quarter);
                let why = format!("the joint's zero is off by {}°", degrees.abs());
                self.add(&OFFSET_MISTAKE, Key::new(&name), change, &format!("{operation} {name}"), &why)
                    .estimates = exact("deg", degrees);
                let change = DraftChange::offset(j, count, -1.0, FRAC_PI_2 * quarter);
                let cure = format!("Replace {name} by {degrees}° − {name}");
                let mirrored = self.add(
                    &OFFSET_MISTAKE,
                    Key::new(&name),
                    change,
                    &cure,
                    "its sign and its zero are wrong",
                );
                mirrored.estimates = exact("deg", degrees);
                mirrored.log_prior = RARE;
            }
        }
        self.orders(count);
        self.angle_units(&turns, &every);
        self.against_the_foot();
    }

    /// Zeros that are off by any angle, rad, in all rows.
    pub(super) fn zeros(&mut self, zeros: &[(usize, f64)]) {
        let count = self.draft.joint_count;
        for &(j, by) in zeros {
            let name = self.column(j);
            let degrees = by / DEG;
            let operation = match degrees > 0.0 {
                true => format!("Add {degrees:.1}° to {name}"),
                false => format!("Subtract {:.1}° from {name}", -degrees),
            };
            let why = format!("the joint's zero is off by {:.1}°", degrees.abs());
            let change = DraftChange::offset(j, count, 1.0, by);
            let zero = self.add(&OFFSET_MISTAKE, Key::new(&name), change, &operation, &why);
            zero.estimates = exact("deg", degrees);
            zero.log_prior = RARE;
        }
    }

    /// A joint that is shown against the foot, as arms do whose motors of parallel axes stand
    /// beside each other: its angle holds that of the joint before.
    fn against_the_foot(&mut self) {
        let joints = &self.campaign.robot.joints;
        let is_parallel = |j: usize| {
            let pair = [&joints[j], &joints[j + 1]];
            pair.iter().all(|joint| joint.motion == Motion::Revolute)
                && pair[0].link.alpha.sin().abs().max(pair[0].link.beta.sin().abs()) < PARALLEL
        };
        let parallel: Vec<usize> = (0..joints.len().saturating_sub(1)).filter(|&j| is_parallel(j)).collect();
        for to in parallel {
            let (name, other) = (self.column(to + 1), self.column(to));
            for (sign, cure) in
                [(1.0, format!("Subtract {other} from {name}")), (-1.0, format!("Add {other} to {name}"))]
            {
                let change = DraftChange::Relative { joint: to + 1, to, sign };
                let why = "it is counted from the foot, not from the link before";
                self.add(&FRAME_MISTAKE, Key::new(&name), change, &cure, why).log_prior = UNUSUAL;
            }
        }
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
            self.add(
                &SWAP_MISTAKE,
                Key::new(place),
                DraftChange::order(order),
                &cure,
                "each holds the other joint",
            );
        }
        if count < 3
            || (1..count)
                .any(|j| self.campaign.robot.joints[j].motion != self.campaign.robot.joints[0].motion)
        {
            return;
        }
        let every = format!("{} … {}", self.column(0), self.column(count - 1));
        let mut add = |order: Vec<usize>, cure: &str, why: &str| {
            self.add(&SWAP_MISTAKE, Key::new(&every), DraftChange::order(order), cure, why).log_prior =
                UNUSUAL;
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
                let change = DraftChange::factors(&joints, count, 180.0 / PI);
                let why = format!("{it} in radians, not in degrees");
                let radians = self.add(
                    &UNIT_MISTAKE,
                    Key::new(&name),
                    change,
                    &format!("Multiply {name} by 180/π"),
                    &why,
                );
                radians.estimates = exact("factor", 180.0 / PI);
                radians.log_prior = log_prior;
            }
            if are_huge(&joints) {
                let change = DraftChange::factors(&joints, count, PI / 180.0);
                let why = format!("{it} degrees that were converted to degrees once more");
                let twice = self.add(
                    &UNIT_MISTAKE,
                    Key::new(&name),
                    change,
                    &format!("Multiply {name} by π/180"),
                    &why,
                );
                twice.estimates = exact("factor", PI / 180.0);
                twice.log_prior = log_prior + UNUSUAL;
                for (factor, part) in PARTS {
                    let change = DraftChange::factors(&joints, count, factor);
                    let why = format!("{it} in {part} of a degree");
                    let cure = format!("Multiply {name} by {factor}");
                    let shown = self.add(&UNIT_MISTAKE, Key::new(&name), change, &cure, &why);
                    shown.estimates = exact("factor", factor);
                    shown.log_prior = log_prior;
                }
            }
            let change = DraftChange::factors(&joints, count, GON);
            let why = format!("{it} in gon, 400 to the turn, not in degrees");
            let gon =
                self.add(&UNIT_MISTAKE, Key::new(&name), change, &format!("Multiply {name} by {GON}"), &why);
            gon.estimates = exact("factor", GON);
            gon.log_prior = log_prior + UNUSUAL;
        }
    }
}
