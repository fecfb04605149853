//! What may be written down wrongly of a calibration: signs, orders, units, zeros, rows, frames,
//! files.

mod draw;

use std::f64::consts::{FRAC_PI_2, PI};

use nalgebra::Matrix4;

pub use self::draw::draw;

use super::arm::frame;
use super::site::{Devices, Row, Site};
use super::text::{Written, place};
use crate::effect_name::EffectName;
use crate::place::Place;
use crate::rig::drawing::Drawing;
use rodcal_base::units::DEG;

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

impl Mistake {
    /// What is written by whoever makes it.
    pub fn applied_to(&self, right: &Written) -> Written {
        let mut wrong = right.clone();
        let site = &mut wrong.site;
        let joints = |site: &mut Site, change: &dyn Fn(&mut [f64])| {
            site.rows.iter_mut().for_each(|row| change(&mut row.q));
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
                let all = whole.applied_to(right);
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
    pub fn name(&self) -> EffectName {
        match self {
            Mistake::JointSign(_) | Mistake::AxisSign(_) => EffectName::SignMistake,
            Mistake::JointOrder(_) | Mistake::AxisOrder(_) | Mistake::Groups(_) => EffectName::SwapMistake,
            Mistake::Zero { .. } => EffectName::OffsetMistake,
            Mistake::Radians | Mistake::Positions(_) | Mistake::ClampsInMetres | Mistake::BaseInMetres => {
                EffectName::UnitMistake
            }
            Mistake::Rows { .. } => EffectName::RowMistake,
            Mistake::BaseInverse | Mistake::BaseOrder | Mistake::ToolOrder(_) => EffectName::FrameMistake,
            Mistake::Rod(_) => EffectName::RodMistake,
            Mistake::Stuck(_) => EffectName::StuckSensor,
            Mistake::Distance(factor) if is_unit(*factor) => EffectName::UnitMistake,
            Mistake::Distance(_) => EffectName::DistanceMistake,
            Mistake::Typed { .. } => EffectName::TypingMistake,
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
            Mistake::Typed { row, joint: typed, .. } => format!("{} of pose {}", joint(*typed), row + 1),
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
        Row { group, ..rows[at].clone() }
    };
    wrong.site.rows = kept.iter().map(row).collect();
}

#[cfg(test)]
pub(super) mod tests {
    use super::*;
    use crate::calibration::setup::{self, Needs};
    use rodcal_base::statistics::Random;

    pub(super) fn right(device: usize, seed: u64) -> Written {
        let random = &mut Random::seeded(seed, 0);
        let needs = Needs { device: Some(device), ..Needs::default() };
        let mut site = setup::draw(needs, &[], random);
        let noise = site.errors(0, random);
        let read = setup::measured(&mut site, &[], 0, &noise);
        let guess = crate::calibration::text::guess(&site, random);
        Written { site, guess, read, others: Vec::new() }
    }

    #[test]
    fn what_some_rows_hold_leaves_the_others_alone() {
        let right = right(0, 3);
        let part = Mistake::Part(Box::new(Mistake::JointSign(Some(2))), [4, 9]);
        let wrong = part.applied_to(&right);
        for (row, (own, other)) in wrong.site.rows.iter().zip(&right.site.rows).enumerate() {
            assert_eq!(own.q[2] == other.q[2], !(4..9).contains(&row), "row {row}");
        }
        assert_eq!((part.name(), part.place(&right.site)), (EffectName::SignMistake, Place::key("q3_deg")));
    }

    #[test]
    fn rows_that_are_displaced_lose_the_ends() {
        let right = right(1, 2);
        let wrong = Mistake::Rows { by: 2, with_clamps: false }.applied_to(&right);
        assert_eq!((wrong.read.len(), wrong.site.rows.len()), (right.read.len() - 2, right.read.len() - 2));
        // what stands in a row was measured two rows above
        assert_eq!((wrong.read[0], &wrong.site.rows[0].q), (right.read[0], &right.site.rows[2].q));
    }
}
