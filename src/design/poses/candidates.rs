//! Poses to choose from: generated, or from any table with joint columns.

use std::collections::BTreeMap;

use super::limits::{Broken, Obstacle, Surroundings};
use crate::calibration::NEAR;
use crate::calibration::campaign::GroupName;
use crate::delimited::Table;
use crate::error::{Error, Place, Result};
use crate::parallel::in_parallel;
use crate::robot::Kinematics;
use crate::robot::configurations::{anywhere, bring_to};
use crate::statistics::Random;
use crate::units::{DEG, MM, significant};

/// Where candidates come from.
#[derive(Debug, Clone, PartialEq)]
pub enum Source {
    /// Random configurations that bring the ball to the places, so many in all.
    Generated(usize),
    /// A table (CSV) with joint columns: name and text.
    File(String, String),
}

/// Poses that keep all limits.
#[derive(Debug, Clone)]
#[non_exhaustive]
pub struct Candidates {
    /// Index of the place and joint values (rad or m), place after place.
    pub poses: Vec<(usize, Vec<f64>)>,
    /// How many were looked at.
    pub tried: usize,
    /// For each place how many broke what first, in the order of [`Obstacle::ALL`].
    pub refused: Vec<[usize; 5]>,
    /// Poses too like another one of the same place.
    pub alike: usize,
}

/// Random starts for one pose, first where nothing is known of the place, then where it is reached.
const FIRST_TRIALS: usize = 60;
const MOST_TRIALS: usize = 400;
/// Poses by which a place counts as reached or not.
const PROBES: usize = 24;

/// What was met on the way to poses of one place.
#[derive(Debug, Clone, Copy)]
struct Tally {
    tried: usize,
    refused: [usize; 5],
    /// For each obstacle that which was broken least, in the order of [`Obstacle::ALL`].
    least: [Option<Broken>; 5],
}

impl Tally {
    const NOTHING: Tally = Tally { tried: 0, refused: [0; 5], least: [None; 5] };

    fn and(mut self, other: &Tally) -> Tally {
        self.tried += other.tried;
        self.refused.iter_mut().zip(other.refused).for_each(|(a, b)| *a += b);
        other.least.iter().flatten().for_each(|broken| self.keep_least(*broken));
        self
    }

    fn refuse(&mut self, broken: Broken) {
        self.refused[broken.obstacle as usize] += 1;
        self.keep_least(broken);
    }

    fn keep_least(&mut self, broken: Broken) {
        let known = &mut self.least[broken.obstacle as usize];
        if known.is_none_or(|known| broken.by < known.by) {
            *known = Some(broken);
        }
    }
}

impl Candidates {
    /// From a source, without those that break a limit or are like another one.
    ///
    /// # Errors
    /// [`Error::NotApplicable`] for places that no configuration reaches; [`Error::Input`] for a
    /// table without the robot's joint columns, with a clamp that the campaign does not know, or
    /// without a pose that keeps the limits.
    pub(super) fn new(
        around: &Surroundings,
        source: &Source,
        seed: u64,
        progress: &(dyn Fn(u64) + Sync),
    ) -> Result<Candidates> {
        let mut candidates = match source {
            Source::Generated(count) => generated(around, *count, seed, progress)?,
            Source::File(file, text) => from_table(around, file, text)?,
        };
        candidates.thin(around.limits.change);
        Ok(candidates)
    }

    /// Leaves out what is nearer than `change` in every joint to a pose of the same place that
    /// stays.
    fn thin(&mut self, change: f64) {
        // equal poses are one pose, whatever change is asked for
        let change = change.max(1e-9);
        let before = self.poses.len();
        let mut kept: Vec<(usize, Vec<f64>)> = Vec::with_capacity(before);
        // of each place by its first joint: what is alike stands in the same cell or beside it
        let mut cells: BTreeMap<(usize, i64), Vec<usize>> = BTreeMap::new();
        for (place, q) in std::mem::take(&mut self.poses) {
            let cell = (q.first().copied().unwrap_or(0.0) / change).floor() as i64;
            let differs = |&other: &usize| q.iter().zip(&kept[other].1).any(|(a, b)| (a - b).abs() >= change);
            let beside = (cell - 1..=cell + 1).filter_map(|cell| cells.get(&(place, cell))).flatten();
            if beside.into_iter().all(differs) {
                cells.entry((place, cell)).or_default().push(kept.len());
                kept.push((place, q));
            }
        }
        self.alike = before - kept.len();
        self.poses = kept;
    }
}

fn generated(
    around: &Surroundings,
    count: usize,
    seed: u64,
    progress: &(dyn Fn(u64) + Sync),
) -> Result<Candidates> {
    let places = around.places.len();
    let quota = count.div_ceil(places);
    let of_place = |place: usize, from: usize, to: usize, trials: usize| {
        let found = in_parallel(to - from, |k| {
            let found = configuration(around, place, seed, from + k, trials);
            progress(1);
            found
        });
        let tally = found.iter().fold(Tally::NOTHING, |all, (_, tally)| all.and(tally));
        (found.into_iter().filter_map(|(q, _)| q).collect::<Vec<_>>(), tally)
    };
    let probes = quota.clamp(1, PROBES);
    let first: Vec<_> = (0..places).map(|place| of_place(place, 0, probes, FIRST_TRIALS)).collect();
    let unreached: Vec<String> = (0..places)
        .filter(|&place| first[place].0.is_empty())
        .map(|place| why_not(around, place, &first[place].1))
        .collect();
    if !unreached.is_empty() {
        return Err(Error::NotApplicable {
            what: format!("choosing poses for {}", around.setup.robot.name),
            why: unreached.join("; "),
            hint: "move the clamp or the base, take another rod, or widen --cone-deg or --clear-mm".into(),
        });
    }
    let mut candidates = Candidates { poses: Vec::new(), tried: 0, refused: Vec::new(), alike: 0 };
    for (place, (mut poses, tally)) in first.into_iter().enumerate() {
        let (more, rest) = of_place(place, probes, quota.max(probes), MOST_TRIALS);
        poses.extend(more);
        let tally = tally.and(&rest);
        candidates.tried += tally.tried;
        candidates.refused.push(tally.refused);
        candidates.poses.extend(poses.into_iter().map(|q| (place, q)));
    }
    Ok(candidates)
}

/// A random configuration that brings the ball to a place and keeps all limits, if one is found.
fn configuration(
    around: &Surroundings,
    place: usize,
    seed: u64,
    number: usize,
    trials: usize,
) -> (Option<Vec<f64>>, Tally) {
    let stream = ((place as u64 + 1) << 32) + number as u64;
    let mut random = Random::seeded(seed, stream);
    let mut kinematics = Kinematics::new(around.setup);
    let mut tally = Tally::NOTHING;
    for _ in 0..trials {
        let mut q = anywhere(around.setup.robot, &mut random);
        let left = match around.are_fixed {
            true => bring_to(&mut kinematics, &mut q, &around.places[place].device.origin),
            false => {
                kinematics.update(&q, &[]);
                0.0
            }
        };
        tally.tried += 1;
        match around.obstacle(&kinematics, &q, place, left, None) {
            None => return (Some(q), tally),
            Some(broken) => tally.refuse(broken),
        }
    }
    (None, tally)
}

/// Why no configuration was found for a place, and how much is missing.
fn why_not(around: &Surroundings, place: usize, tally: &Tally) -> String {
    let name = match &around.places[place].name {
        GroupName::Tracked => "a pose".to_owned(),
        name => name.to_string(),
    };
    let reached = tally.tried - tally.refused[Obstacle::Far as usize];
    let in_unit = |value: f64, unit: f64| significant(value / unit, 3);
    if let (0, Some(gap)) = (reached, tally.least[Obstacle::Far as usize]) {
        let gap = in_unit(gap.by, MM);
        return format!("{name} cannot be reached: the ball comes no nearer than {gap} mm");
    }
    let joints = &around.setup.robot.joints;
    let broken = tally.least.iter().flatten().filter(|broken| broken.obstacle != Obstacle::Far);
    let broken = broken.map(|&Broken { obstacle, by, joint }| {
        let count = tally.refused[obstacle as usize];
        let least = match obstacle {
            Obstacle::Cone => format!(
                " of {}° (nearest: {}°)",
                in_unit(around.limits.cone, DEG),
                in_unit(around.limits.cone + by, DEG)
            ),
            Obstacle::Block => {
                format!(" ({} mm; by {} mm at least)", in_unit(around.limits.clear, MM), in_unit(by, MM))
            }
            Obstacle::JointLimit => {
                let (column, unit) = joints[joint].column(joint + 1);
                format!(" ({column} by {} at least)", in_unit(by, unit))
            }
            Obstacle::Table | Obstacle::Far => format!(" (by {} mm at least)", in_unit(by, MM)),
        };
        format!("in {count} {}{least}", obstacle.description())
    });
    let broken: Vec<String> = broken.collect();
    format!("{name} is reached in {reached} of {} configurations, but {}", tally.tried, broken.join(", "))
}

/// Poses of any table with the robot's joint columns. The column `clamp` names the place; without
/// it a pose belongs to the place that its tip is nearest to.
fn from_table(around: &Surroundings, file: &str, text: &str) -> Result<Candidates> {
    let robot = around.setup.robot;
    let queries = robot.poses_from_csv(file, text)?;
    let is_joint =
        |column: &str| robot.joints.iter().zip(1..).any(|(joint, number)| joint.column(number).0 == column);
    let table = Table::parse(file, text, is_joint)?;
    let mut kinematics = Kinematics::new(around.setup);
    let mut of_place: Vec<Vec<Vec<f64>>> = vec![Vec::new(); around.places.len()];
    let mut refused = vec![[0; 5]; around.places.len()];
    let mut nearest = f64::INFINITY;
    let tried = queries.len();
    for (cells, query) in table.rows().zip(queries) {
        let q = query.joints;
        kinematics.update(&q, &[]);
        let left = |place: usize| (around.places[place].device.origin - kinematics.tip).norm();
        let named =
            cells.text("clamp").filter(|_| around.are_fixed).map(|id| GroupName::Clamp(id.to_owned()));
        let place = match named {
            Some(name) => around.places.iter().position(|place| place.name == name).ok_or_else(|| {
                let names: Vec<String> = around.places.iter().map(|place| place.name.to_string()).collect();
                cells.error("clamp", format!("one of the campaign's places: {}", names.join(", ")), None)
            })?,
            None => (0..around.places.len()).min_by(|&a, &b| left(a).total_cmp(&left(b))).unwrap_or(0),
        };
        if around.are_fixed {
            nearest = nearest.min(left(place));
        }
        match around.obstacle(&kinematics, &q, place, left(place), Some(NEAR)) {
            None => of_place[place].push(q),
            Some(broken) => refused[place][broken.obstacle as usize] += 1,
        }
    }
    let poses: Vec<(usize, Vec<f64>)> = of_place
        .into_iter()
        .enumerate()
        .flat_map(|(place, all)| all.into_iter().map(move |q| (place, q)))
        .collect();
    if poses.is_empty() {
        let counts = Obstacle::ALL.into_iter().map(|obstacle| {
            (obstacle, refused.iter().map(|of_place| of_place[obstacle as usize]).sum::<usize>())
        });
        let counts: Vec<String> = counts
            .filter(|(_, count)| *count > 0)
            .map(|(obstacle, count)| format!("in {count} {}", obstacle.description()))
            .collect();
        let gap = significant(nearest / MM, 3);
        let gap =
            if nearest.is_finite() { format!("; nearest to its clamp: {gap} mm") } else { String::new() };
        return Err(Error::Input {
            at: Place::whole_file(file),
            found: format!("of {tried} poses none can be measured: {}{gap}", counts.join(", ")),
            expected: format!(
                "poses that bring this rod's ball within {} mm of a clamp, and keep the limits",
                NEAR / MM
            ),
            hint: Some("without --candidates poses are generated".into()),
        });
    }
    Ok(Candidates { poses, tried, refused, alike: 0 })
}
