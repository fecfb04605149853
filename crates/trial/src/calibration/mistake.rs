//! What may be written down wrongly of a calibration: signs, orders, units, zeros, rows, frames,
//! files.
//!
//! A mistake is drawn only where it shows: where the robot as its file has it then misses a third
//! of the points by a thirtieth of its reach, by a tenth where only a first guess is wrong.

use std::f64::consts::{FRAC_PI_2, PI};
use std::ops::Range;

use nalgebra::{Matrix4, Vector3};

use super::arm::{frame, point};
use super::rod::Rod;
use super::site::{Devices, Site};
use super::text::{Written, place};
use crate::chance::happens;
use crate::place::Place;
use crate::rig::drawing::Drawing;
use rodcal_base::statistics::Random;
use rodcal_base::units::DEG;

/// Kinds of mistakes that are drawn alike often.
const KINDS: usize = 17;
/// Share of the mistakes of rows that only some rows hold, and how large a share of the rows.
const OF_SOME: f64 = 0.4;
const STRETCH: (f64, f64) = (0.15, 0.5);
/// Tries until one shows.
const TRIES: usize = 200;
/// Share of the points that are missed, and by how much of the reach; and by how much where only a
/// first guess is wrong.
const SHOWS: (f64, f64) = (0.33, 1.0 / 30.0);
const GUESS: f64 = 0.1;

/// Something that was written wrongly; joints, axes and clamps from 0.
#[derive(Debug, Clone, PartialEq)]
pub enum Mistake {
    /// A joint, or all, the wrong way round.
    JointSign(Option<usize>),
    /// Two columns of joints exchanged, or all from the flange to the base.
    JointOrder(Option<[usize; 2]>),
    /// A joint's zero: so many quarters of a turn must be added.
    Zero {
        joint: usize,
        quarters: i8,
    },
    /// Angles in radians.
    Radians,
    /// An axis of the device the wrong way round, or two exchanged.
    AxisSign(usize),
    AxisOrder([usize; 2]),
    /// Positions must be multiplied by so much.
    Positions(f64),
    /// The positions of row i stand in row i + k, with or without the column of the clamps.
    Rows {
        by: isize,
        with_clamps: bool,
    },
    /// The poses of two clamps or sockets exchanged.
    Groups([usize; 2]),
    /// Places of all clamps in metres.
    ClampsInMetres,
    /// The base as {W} in {0}, with yaw, pitch and roll, or in metres.
    BaseInverse,
    BaseOrder,
    BaseInMetres,
    /// The tip with two of its axes exchanged.
    ToolOrder([usize; 2]),
    /// The file of another rod; the right one stands beside it.
    Rod(Box<Drawing>),
    /// A position that was not recorded.
    Stuck(usize),
    /// The distance of the sockets must be multiplied by so much.
    Distance(f64),
    /// A joint of one row, typed ten or twenty degrees too large or too small, rad.
    Typed {
        row: usize,
        joint: usize,
        by: f64,
    },
    /// One of the above in some rows alone: the first, and the first that is right again.
    Part(Box<Mistake>, [usize; 2]),
}

/// One that shows in what was written rightly.
pub fn draw(right: &Written, random: &mut Random) -> Mistake {
    let n = right.site.nominal.len();
    let two = |count: usize, random: &mut Random| {
        let first = random.index(count);
        let second = (first + 1 + random.index(count.max(2) - 1)) % count.max(1);
        [first.min(second), first.max(second)]
    };
    let rows = right.site.rows.len();
    for _ in 0..TRIES {
        let kind = random.index(KINDS);
        let mistake = match kind {
            0 => Mistake::JointSign(happens(random, 0.8).then(|| random.index(n))),
            1 => Mistake::JointOrder(happens(random, 0.8).then(|| two(n, random))),
            2 => {
                let quarters = [1, -1, 2][random.index(3)];
                Mistake::Zero { joint: random.index(n), quarters }
            }
            3 => Mistake::Radians,
            4 => Mistake::AxisSign(random.index(3)),
            5 => Mistake::AxisOrder(two(3, random)),
            6 => Mistake::Positions([1000.0, 25.4][random.index(2)]),
            7 => {
                let by = [1, -1, 1, 2, -3][random.index(5)];
                Mistake::Rows { by, with_clamps: happens(random, 0.5) }
            }
            8 => Mistake::Groups(two(right.site.groups(), random)),
            9 => Mistake::ClampsInMetres,
            10 => Mistake::BaseInverse,
            11 => Mistake::BaseOrder,
            12 => Mistake::BaseInMetres,
            13 => Mistake::ToolOrder(two(3, random)),
            14 => Mistake::Distance([10.0, 1000.0, 25.4, 1.1, 0.9][random.index(5)]),
            15 => {
                let by = [10.0, -10.0, 20.0, -20.0][random.index(4)] * DEG;
                Mistake::Typed { row: random.index(rows), joint: random.index(n), by }
            }
            16 if right.site.rod.is_some() => Mistake::Rod(Box::new(Rod::drawing(random))),
            _ => Mistake::Stuck(random.index(3)),
        };
        let mistake = match mistake.is_of_rows() && happens(random, OF_SOME) {
            true => {
                let count = ((rows as f64 * random.uniform(STRETCH.0, STRETCH.1)) as usize).max(3);
                let first = random.index(rows.saturating_sub(count).max(1));
                Mistake::Part(Box::new(mistake), [first, (first + count).min(rows)])
            }
            false => mistake,
        };
        let least = if mistake.is_guess() { GUESS } else { SHOWS.1 };
        let is_shown = || match mistake {
            // what no pose shows by itself
            Mistake::Distance(_) => true,
            _ => shows(&mistake.made(right), right, mistake.rows(rows), least),
        };
        if mistake.is_possible(&right.site) && is_shown() {
            return mistake;
        }
    }
    Mistake::JointSign(Some(1))
}

impl Mistake {
    /// False where the files have no such thing, or where sockets hide it altogether.
    fn is_possible(&self, site: &Site) -> bool {
        let n = site.nominal.len();
        let has_clamps = matches!(site.devices, Devices::Clamps(_));
        match self {
            Mistake::Zero { joint, .. } if site.has_sockets() => (1..n - 1).contains(joint),
            Mistake::AxisSign(_)
            | Mistake::AxisOrder(_)
            | Mistake::Positions(_)
            | Mistake::Stuck(_)
            | Mistake::BaseInverse
            | Mistake::BaseOrder
            | Mistake::BaseInMetres => !site.has_sockets(),
            Mistake::Rows { with_clamps, .. } => !site.has_sockets() && (has_clamps || !with_clamps),
            Mistake::Groups(_) | Mistake::ClampsInMetres => has_clamps,
            Mistake::ToolOrder(_) => site.rod.is_none() && !site.has_sockets(),
            Mistake::Distance(_) => site.has_sockets(),
            // a last joint that turns the tip about itself, or a first one, may be anywhere
            Mistake::Typed { joint, .. } => (1..n - 1).contains(joint),
            Mistake::Part(whole, _) => whole.is_possible(site),
            _ => true,
        }
    }

    /// True for what acts on rows one by one.
    fn is_of_rows(&self) -> bool {
        matches!(
            self,
            Mistake::JointSign(_)
                | Mistake::JointOrder(_)
                | Mistake::Zero { .. }
                | Mistake::Radians
                | Mistake::AxisSign(_)
                | Mistake::AxisOrder(_)
                | Mistake::Positions(_)
        )
    }

    /// The rows that hold it, of so many.
    fn rows(&self, count: usize) -> Range<usize> {
        match self {
            Mistake::Typed { row, .. } => *row..row + 1,
            Mistake::Part(_, [first, end]) => *first..*end,
            _ => 0..count,
        }
    }

    /// True where nothing is wrong but a first guess, which a calibration corrects.
    fn is_guess(&self) -> bool {
        matches!(
            self,
            Mistake::BaseInverse | Mistake::BaseOrder | Mistake::BaseInMetres | Mistake::ToolOrder(_)
        )
    }

    /// What is written by whoever makes it.
    pub fn made(&self, right: &Written) -> Written {
        let mut wrong = right.clone();
        let site = &mut wrong.site;
        let joints = |site: &mut Site, of: &dyn Fn(&mut [f64])| {
            site.rows.iter_mut().for_each(|row| of(&mut row.q));
        };
        match self {
            Mistake::JointSign(Some(joint)) => joints(site, &|q| q[*joint] = -q[*joint]),
            Mistake::JointSign(None) => joints(site, &|q| q.iter_mut().for_each(|q| *q = -*q)),
            Mistake::JointOrder(Some([a, b])) => joints(site, &|q| q.swap(*a, *b)),
            Mistake::JointOrder(None) => joints(site, &|q| q.reverse()),
            Mistake::Zero { joint, quarters } => {
                joints(site, &|q| q[*joint] -= f64::from(*quarters) * FRAC_PI_2);
            }
            Mistake::Radians => joints(site, &|q| q.iter_mut().for_each(|q| *q *= DEG)),
            Mistake::AxisSign(axis) => wrong.read.iter_mut().for_each(|read| read[*axis] *= -1.0),
            Mistake::AxisOrder([a, b]) => wrong.read.iter_mut().for_each(|read| read.swap_rows(*a, *b)),
            Mistake::Positions(factor) => wrong.read.iter_mut().for_each(|read| *read /= *factor),
            Mistake::Rows { by, with_clamps } => displace(&mut wrong, *by, *with_clamps),
            Mistake::Groups([a, b]) => {
                for row in &mut site.rows {
                    row.group = match row.group {
                        group if group == *a => *b,
                        group if group == *b => *a,
                        group => group,
                    };
                }
            }
            Mistake::ClampsInMetres => {
                if let Devices::Clamps(clamps) = &mut site.devices {
                    clamps.iter_mut().for_each(|clamp| scale(clamp, 1e-3));
                }
            }
            Mistake::BaseInverse => {
                let [xyz, rpy] = &right.guess;
                wrong.guess = place(&frame(xyz, rpy).try_inverse().unwrap_or_else(Matrix4::identity));
            }
            Mistake::BaseOrder => wrong.guess[1].swap_rows(0, 2),
            Mistake::BaseInMetres => wrong.guess[0] *= 1e-3,
            Mistake::ToolOrder([a, b]) => site.drawn_tool.swap_rows(*a, *b),
            Mistake::Rod(other) => {
                if let Some(rod) = &mut site.rod {
                    wrong.others.insert(0, ("rod-2.toml".into(), rod.drawing.clone()));
                    rod.drawing = (**other).clone();
                    site.drawn_tool = rod.tip();
                }
            }
            Mistake::Distance(factor) => {
                if let Devices::Sockets(_, distance) = &mut site.devices {
                    *distance /= factor;
                }
            }
            Mistake::Typed { row, joint, by } => site.rows[*row].q[*joint] += by,
            Mistake::Part(whole, [first, end]) => {
                let all = whole.made(right);
                for row in *first..*end {
                    site.rows[row] = all.site.rows[row].clone();
                    wrong.read[row] = all.read[row];
                }
            }
            Mistake::Stuck(axis) => {
                let first = right.read.first().map_or(0.0, |read| read[*axis]);
                wrong.read.iter_mut().for_each(|read| read[*axis] = first);
            }
        }
        wrong
    }

    /// Its name in a diagnosis.
    pub fn name(&self) -> &'static str {
        match self {
            Mistake::JointSign(_) | Mistake::AxisSign(_) => "sign_mistake",
            Mistake::JointOrder(_) | Mistake::AxisOrder(_) | Mistake::Groups(_) => "swap_mistake",
            Mistake::Zero { .. } => "offset_mistake",
            Mistake::Radians | Mistake::Positions(_) | Mistake::ClampsInMetres | Mistake::BaseInMetres => {
                "unit_mistake"
            }
            Mistake::Rows { .. } => "row_mistake",
            Mistake::BaseInverse | Mistake::BaseOrder | Mistake::ToolOrder(_) => "frame_mistake",
            Mistake::Rod(_) => "rod_mistake",
            Mistake::Stuck(_) => "stuck_sensor",
            Mistake::Distance(factor) if is_unit(*factor) => "unit_mistake",
            Mistake::Distance(_) => "distance_mistake",
            Mistake::Typed { .. } => "typing_mistake",
            Mistake::Part(whole, _) => whole.name(),
        }
    }

    /// The columns, ids or keys that it concerns.
    pub fn place(&self, site: &Site) -> Place {
        if let Mistake::Part(whole, _) = self {
            return whole.place(site);
        }
        const AXES: [&str; 3] = ["x_mm", "y_mm", "z_mm"];
        let n = site.nominal.len();
        let joint = |joint: usize| format!("q{}_deg", joint + 1);
        let all = || format!("{} … {}", joint(0), joint(n - 1));
        Place::key(&match self {
            Mistake::JointSign(Some(one)) | Mistake::Zero { joint: one, .. } => joint(*one),
            Mistake::JointOrder(Some([a, b])) => format!("{} and {}", joint(*a), joint(*b)),
            Mistake::JointSign(None) | Mistake::JointOrder(None) | Mistake::Radians => all(),
            Mistake::AxisSign(axis) | Mistake::Stuck(axis) => AXES[*axis].into(),
            Mistake::AxisOrder([a, b]) => format!("{} and {}", AXES[*a], AXES[*b]),
            Mistake::Rows { with_clamps: true, .. } => format!("clamp, {}", AXES.join(", ")),
            Mistake::Positions(_) | Mistake::Rows { .. } => AXES.join(", "),
            Mistake::Groups([a, b]) => format!("clamps {} and {}", a + 1, b + 1),
            Mistake::ClampsInMetres => "clamp xyz_mm (all)".into(),
            Mistake::BaseInverse => "base".into(),
            Mistake::BaseOrder => "base.rpy_deg".into(),
            Mistake::BaseInMetres => "base.xyz_mm".into(),
            Mistake::ToolOrder(_) => "tool.xyz_mm".into(),
            Mistake::Rod(_) => "rod-2.toml".into(),
            Mistake::Distance(_) => "sockets.distance_mm".into(),
            Mistake::Typed { row, joint: of, .. } => format!("{} of pose {}", joint(*of), row + 1),
            Mistake::Part(..) => String::new(),
        })
    }

    /// Its numbers.
    pub fn parameters(&self) -> Vec<(&'static str, f64)> {
        match self {
            Mistake::Radians => vec![("factor", 180.0 / PI)],
            Mistake::Positions(factor) => vec![("factor", *factor)],
            Mistake::ClampsInMetres | Mistake::BaseInMetres => vec![("factor", 1000.0)],
            Mistake::Zero { quarters, .. } => vec![("deg", 90.0 * f64::from(*quarters))],
            Mistake::Rows { by, .. } => vec![("rows", *by as f64)],
            Mistake::Distance(factor) if is_unit(*factor) => vec![("factor", *factor)],
            Mistake::Part(whole, _) => whole.parameters(),
            _ => Vec::new(),
        }
    }
}

/// True for a factor between two units.
fn is_unit(factor: f64) -> bool {
    factor > 2.0
}

fn scale(frame: &mut Matrix4<f64>, by: f64) {
    (0..3).for_each(|axis| frame[(axis, 3)] *= by);
}

/// Positions some rows further down, without the rows that then have no position or no angles.
fn displace(wrong: &mut Written, by: isize, with_clamps: bool) {
    let (rows, read) = (wrong.site.rows.clone(), wrong.read.clone());
    let from = |at: usize| at.checked_add_signed(-by).filter(|at| *at < rows.len());
    let kept: Vec<(usize, usize)> = (0..rows.len()).filter_map(|at| Some((at, from(at)?))).collect();
    wrong.read = kept.iter().map(|&(_, from)| read[from]).collect();
    let row = |&(at, from): &(usize, usize)| {
        let group = rows[if with_clamps { from } else { at }].group;
        super::site::Row { group, ..rows[at].clone() }
    };
    wrong.site.rows = kept.iter().map(row).collect();
}

/// True where the robot of the files misses many of the points that these rows state: with sockets,
/// of those that it reached when nothing was written wrongly.
fn shows(wrong: &Written, right: &Written, rows: Range<usize>, least: f64) -> bool {
    let reach: f64 = right.site.nominal.iter().map(|l| l.numbers[1].abs() + l.numbers[2].abs()).sum();
    let stated = |written: &Written, row: usize| {
        let own = &written.site;
        let [xyz, rpy] = &written.guess;
        let frames = super::arm::frames(&own.nominal, &frame(xyz, rpy), &own.rows[row].q);
        let tip = point(&frames[own.nominal.len()], &own.drawn_tool);
        let seen = match own.has_sockets() {
            true => None,
            false => Some(point(&own.device(own.rows[row].group), &written.read[row])),
        };
        (tip, seen)
    };
    // where rows were displaced some are gone
    let rows = rows.start..rows.end.min(wrong.site.rows.len());
    let count = rows.len();
    let misses = |row: usize| {
        let (tip, seen) = stated(wrong, row);
        let goal: Vector3<f64> = seen.unwrap_or_else(|| stated(right, row).0);
        (tip - goal).norm() > least * reach
    };
    rows.filter(|&row| misses(row)).count() as f64 > SHOWS.0 * count as f64
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::calibration::setup::{self, Needs};

    fn right(device: usize, seed: u64) -> Written {
        let random = &mut Random::seeded(seed, 0);
        let needs = Needs { device: Some(device), ..Needs::default() };
        let mut site = setup::draw(needs, &[], random);
        let noise = site.errors(0, random);
        let read = setup::measured(&mut site, &[], 0, &noise);
        let guess = crate::calibration::text::guess(&site, random);
        Written { site, guess, read, others: Vec::new() }
    }

    #[test]
    fn what_is_right_shows_nothing_and_what_is_drawn_shows() {
        let mut names = std::collections::BTreeSet::new();
        for device in 0..3 {
            let right = right(device, 4);
            let rows = right.site.rows.len();
            assert!(!shows(&right, &right, 0..rows, SHOWS.1));
            let files = crate::calibration::text::files(&right);
            for seed in 0..30 {
                let mistake = draw(&right, &mut Random::seeded(seed, 1));
                let wrong = mistake.made(&right);
                let is_shown = shows(&wrong, &right, mistake.rows(rows), SHOWS.1);
                assert!(is_shown || matches!(mistake, Mistake::Distance(_)), "{mistake:?}");
                assert!(crate::calibration::text::files(&wrong) != files);
                names.insert(mistake.name());
            }
        }
        assert!(names.len() >= 6, "{names:?}");
    }

    #[test]
    fn what_some_rows_hold_leaves_the_others_alone() {
        let right = right(0, 3);
        let part = Mistake::Part(Box::new(Mistake::JointSign(Some(2))), [4, 9]);
        let wrong = part.made(&right);
        for (row, (own, other)) in wrong.site.rows.iter().zip(&right.site.rows).enumerate() {
            assert_eq!(own.q[2] == other.q[2], !(4..9).contains(&row), "row {row}");
        }
        assert_eq!((part.name(), part.place(&right.site)), ("sign_mistake", Place::key("q3_deg")));
    }

    #[test]
    fn rows_that_are_displaced_lose_the_ends() {
        let right = right(1, 2);
        let wrong = Mistake::Rows { by: 2, with_clamps: false }.made(&right);
        assert_eq!((wrong.read.len(), wrong.site.rows.len()), (right.read.len() - 2, right.read.len() - 2));
        // what stands in a row was measured two rows above
        assert_eq!((wrong.read[0], &wrong.site.rows[0].q), (right.read[0], &right.site.rows[2].q));
    }
}
