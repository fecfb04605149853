//! Once more at the robot: poses that somebody proposes are measured with the same arm, the same
//! effects and the same instruments, after everything that was done before.

use nalgebra::Vector3;
use serde::Deserialize;

use super::arm;
use super::effect::Effect;
use super::site::{Devices, Row, Site};
use super::text::Written;
use super::{Drawn, FOLLOW_UP, drawn, setup, text};
use crate::Source;
use rodcal_base::statistics::Random;
use rodcal_base::units::{DEG, MM};

/// Poses that are proposed, in the words of a diagnosis' JSON.
#[derive(Debug, Clone, PartialEq, Deserialize)]
pub struct Proposed {
    /// The poses, in the order in which they are measured.
    pub poses: Vec<ProposedPose>,
    /// A clamp to be set up for some of them.
    pub new_fixture: Option<NewClamp>,
}

/// One of them.
#[derive(Debug, Clone, PartialEq, Deserialize)]
pub struct ProposedPose {
    /// Joint angles, degrees.
    pub joints: Vec<f64>,
    /// `clamp 2`, `p1/0`, or none.
    pub group: Option<String>,
}

/// Where the clamp is to stand, in the world.
#[derive(Debug, Clone, PartialEq, Deserialize)]
#[allow(missing_docs, reason = "the names are those of the JSON, with units")]
pub struct NewClamp {
    pub name: String,
    pub xyz_mm: [f64; 3],
    pub rpy_deg: [f64; 3],
}

/// The files of a campaign, as they were sealed and with what was measured next.
#[derive(Debug, Clone, PartialEq)]
pub struct FollowUp {
    /// Name and text of each.
    pub before: Vec<(String, String)>,
    /// The same with the new rows below.
    pub after: Vec<(String, String)>,
}

/// Poses that nobody would measure.
const MOST_POSES: usize = 500;
/// How far from its clamp or socket a ball may be so that it can be brought there, m.
const NEAR: f64 = 10.0 * MM;
/// Time to the first pose, and from one to the next, s.
const REST: f64 = 600.0;
const PACE: f64 = 30.0;

/// Case `number` of a trial with what is `proposed`. Refuses, with the reason, what this robot
/// cannot do.
pub fn follow_up(source: &Source, number: usize, proposed: &Proposed) -> Result<FollowUp, &'static str> {
    let Drawn { mut site, effects, right, mistake, .. } = drawn(source, number);
    if mistake.is_some() {
        return Err("files with a mistake");
    }
    let before = text::files(&right);
    let known = site.rows.len();
    append(&mut site, &effects, proposed)?;
    let noise = site.errors(known, &mut Random::of_seed(source.seed.0, FOLLOW_UP + number as u64));
    let more = setup::measured(&mut site, &effects, known, &noise);
    let read: Vec<Vector3<f64>> = right.read.iter().copied().chain(more).collect();
    Ok(FollowUp { before, after: text::files(&Written { site, read, ..right }) })
}

/// The rows that are proposed, after the others.
fn append(site: &mut Site, effects: &[Effect], proposed: &Proposed) -> Result<(), &'static str> {
    if !(1..=MOST_POSES).contains(&proposed.poses.len()) {
        return Err("no poses, or too many");
    }
    let mut names: Vec<String> = (0..site.groups()).map(|group| site.group_name(group)).collect();
    if let Some(clamp) = &proposed.new_fixture {
        let Devices::Clamps(clamps) = &mut site.devices else { return Err("there are no clamps") };
        if !clamp.xyz_mm.iter().chain(&clamp.rpy_deg).all(|value| value.is_finite()) {
            return Err("not a place for a clamp");
        }
        site.clamps_off.push(Vector3::zeros());
        site.scatter.of_group.push(1.0);
        clamps.push(arm::frame(
            &(Vector3::from(clamp.xyz_mm) * MM),
            &Vector3::from(clamp.rpy_deg.map(|angle| angle * DEG)),
        ));
        names.push(clamp.name.clone());
    }
    let last = site.rows.last().cloned().ok_or("nothing was recorded")?;
    for (k, pose) in proposed.poses.iter().enumerate() {
        let q: Vec<f64> = pose.joints.iter().map(|angle| (angle * 1e7).round() / 1e7 * DEG).collect();
        if q.len() != site.nominal.len() || !q.iter().all(|q| q.abs() <= setup::LARGEST) {
            return Err("joints beyond their range");
        }
        let name = pose.group.as_deref().unwrap_or_default();
        let group = names.iter().position(|known| known == name).ok_or("no such clamp or socket")?;
        let time = ((last.time + REST + PACE * k as f64) * 10.0).round() / 10.0;
        let aside = Vector3::zeros();
        site.rows.push(Row { q, group, aside, time, temperature: last.temperature });
        let row = site.rows.len() - 1;
        let at = site.ball(row, &site.rows[row].q, effects);
        let goal = match &site.devices {
            Devices::Tracker(_) => at,
            Devices::Clamps(clamps) => clamps[group].column(3).xyz(),
            Devices::Sockets(sockets, _) => sockets[group].2,
        };
        if (at - goal).norm() > NEAR {
            return Err("the ball would not be at its clamp or socket");
        }
        if let Devices::Clamps(clamps) = &site.devices {
            site.rows[row].aside = arm::turned(&clamps[group].transpose(), &(at - goal));
        }
    }
    Ok(())
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::calibration::case;

    fn source(seed: u64) -> Source {
        Source { seed: crate::Seed(seed.into()), suite: crate::Suite::Calibration, residuals: Vec::new() }
    }

    fn has_clamps(drawn: &Drawn) -> bool {
        matches!(drawn.site.devices, Devices::Clamps(_)) && drawn.mistake.is_none()
    }

    /// The first recorded pose once more, and then the last.
    fn proposed(seed: u64, number: usize) -> Proposed {
        let drawn = drawn(&source(seed), number);
        let pose = |row: &Row| ProposedPose {
            joints: row.q.iter().map(|q| q / DEG).collect(),
            group: Some(drawn.site.group_name(row.group)).filter(|name| !name.is_empty()),
        };
        let rows = &drawn.site.rows;
        Proposed { poses: vec![pose(&rows[0]), pose(&rows[rows.len() - 1])], new_fixture: None }
    }

    #[test]
    fn the_files_are_the_sealed_ones_and_the_new_rows_are_below() {
        for number in (1..7).filter(|&number| drawn(&source(5), number).mistake.is_none()) {
            let proposed = proposed(5, number);
            let measured = follow_up(&source(5), number, &proposed).unwrap();
            let sealed = case(&source(5), number).files;
            assert!(measured.before.iter().all(|file| sealed.contains(file)));
            let rows = |files: &[(String, String)]| files[2].1.clone();
            let (before, after) = (rows(&measured.before), rows(&measured.after));
            assert_eq!(after.lines().count(), before.lines().count() + 2);
            assert!(after.starts_with(&before), "{after}");
            assert_eq!(measured, super::follow_up(&source(5), number, &proposed).unwrap());
        }
    }

    #[test]
    fn what_no_robot_can_do_is_refused_with_the_reason() {
        let number = (1..50).find(|&k| has_clamps(&drawn(&source(5), k))).unwrap();
        let good = proposed(5, number);
        let refused = |change: &dyn Fn(&mut Proposed)| {
            let mut other = good.clone();
            change(&mut other);
            follow_up(&source(5), number, &other).unwrap_err()
        };
        assert_eq!(refused(&|p| p.poses.clear()), "no poses, or too many");
        assert_eq!(refused(&|p| p.poses[0].joints[2] = 200.0), "joints beyond their range");
        assert_eq!(refused(&|p| p.poses[0].joints[2] = f64::NAN), "joints beyond their range");
        assert_eq!(refused(&|p| p.poses[1].joints.truncate(3)), "joints beyond their range");
        assert_eq!(refused(&|p| p.poses[1].group = Some("clamp 9".into())), "no such clamp or socket");
        assert_eq!(
            refused(&|p| p.poses[1].joints[0] += if p.poses[1].joints[0] > 0.0 { -9.0 } else { 9.0 }),
            "the ball would not be at its clamp or socket"
        );
    }

    #[test]
    fn a_clamp_is_set_up_where_it_is_proposed() {
        let number = (1..50).find(|&k| has_clamps(&drawn(&source(5), k))).unwrap();
        let drawn = drawn(&source(5), number);
        let mut proposed = proposed(5, number);
        let at = drawn.site.ball(0, &drawn.site.rows[0].q, &drawn.effects) / MM;
        let name = "new clamp".to_owned();
        proposed.poses[0].group = Some(name.clone());
        proposed.new_fixture = Some(NewClamp { name, xyz_mm: at.into(), rpy_deg: [10.0, 20.0, 30.0] });
        let measured = follow_up(&source(5), number, &proposed).unwrap();
        let clamps = |files: &[(String, String)]| files[0].1.matches("[[clamp]]").count();
        assert_eq!(clamps(&measured.after), clamps(&measured.before) + 1);
    }
}
