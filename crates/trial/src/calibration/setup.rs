//! A laboratory that calibrates an arm: which arm, how the ball is measured, where and when.

use nalgebra::{Matrix4, Vector3};

use super::arm::{self, Known};
use super::effect::Effect;
use super::noise::Scatter;
use super::rod::Rod;
use super::site::{Devices, Row, Site};
use crate::chance::{happens, log_uniform};
use rodcal_base::statistics::Random;
use rodcal_base::units::{DEG, MM, STANDARD_GRAVITY, UM};

/// What a recording must have to carry an effect.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq)]
pub struct Needs {
    /// Clamps, a tracker, sockets.
    pub device: Option<usize>,
    /// A fixture that something can happen to.
    pub fixture: bool,
    /// Points that are measured: no sockets.
    pub points: bool,
    /// Masses in the robot's file, or none.
    pub masses: Option<bool>,
    pub rod: bool,
    pub clock: bool,
}

impl Needs {
    /// What both need; `None` where they exclude each other.
    pub fn and(self, other: Needs) -> Option<Needs> {
        let one = |a: Option<usize>, b: Option<usize>| match (a, b) {
            (Some(a), Some(b)) if a != b => None,
            _ => Some(a.or(b)),
        };
        let masses = one(self.masses.map(usize::from), other.masses.map(usize::from))?.map(|m| m == 1);
        let device = one(self.device, other.device)?;
        let fixture = self.fixture || other.fixture;
        let points = self.points || other.points;
        let is_possible = (!fixture || device != Some(1)) && (!points || device != Some(2));
        is_possible.then_some(Needs {
            device,
            fixture,
            points,
            masses,
            rod: self.rod || other.rod,
            clock: self.clock || other.clock,
        })
    }
}

/// Tries for a pose before the fixture is given up.
const TRIES: usize = 400;
/// Largest angle of a joint, rad.
pub const LARGEST: f64 = 175.0 * DEG;

/// How often the numbers of the files are off by twice what they state.
const TWICE: f64 = 0.15;
/// How far from level a robot stands that was set up with one, rad; how far a rod's tip is from
/// where it belongs, m.
const LEVEL: f64 = 0.05 * DEG;
const MOUNTED: f64 = 0.5 * MM;
/// Places of clamps that are stated to be uncertain, m, and how well they are known where nothing
/// is stated.
const CLAMPS: ([f64; 2], f64) = ([10.0 * UM, 60.0 * UM], UM);

/// A recording without its noise. With sockets the angles are those of a robot without effects:
/// [`measured`] turns them.
pub fn draw(needs: Needs, residuals: &[f64], random: &mut Random) -> Site {
    let (nominal, arm_name) = arm::draw(random);
    let known = Known::draw(random);
    let times = if happens(random, TWICE) { 2.0 } else { 1.0 };
    let real = arm::built(&nominal, &known, times, random);
    let device = needs.device.unwrap_or_else(|| match (random.index(10), needs.fixture, needs.points) {
        (0..6, ..) | (_, true, true) => 0,
        (_, true, false) | (9, _, false) => 2,
        _ => 1,
    });
    let has_masses = needs.masses.unwrap_or_else(|| happens(random, 0.7));
    let has_rod = needs.rod || happens(random, 0.5);
    let rod = has_rod.then(|| Rod::drawn(times, random));
    let drawn_tool = rod.as_ref().map_or_else(|| tool(random), Rod::tip);
    let tool = drawn_tool + normal(random, MOUNTED);
    let base = arm::frame(&normal(random, 0.3), &normal(random, 0.01));
    let contact = match device {
        0 if has_rod => Vector3::from_fn(|_, _| (random.uniform(0.6, 2.0) * 100.0).round() / 100.0),
        _ => Vector3::zeros(),
    };
    let has_time = happens(random, 0.5);
    let off_level = arm::frame(&Vector3::zeros(), &normal(random, LEVEL));
    let gravity = -arm::column(&(base * off_level), 2) * STANDARD_GRAVITY;
    let mut site = Site {
        nominal,
        real,
        arm_name,
        base,
        drawn_tool,
        tool,
        has_masses,
        rod,
        devices: Devices::Tracker(Vector3::new(3.0, 1.0, 0.5)),
        contact,
        rows: Vec::new(),
        has_time: has_time || needs.clock,
        has_temperature: needs.clock && !has_time || happens(random, 0.25),
        known,
        times,
        gravity,
        clamp_sd: None,
        clamps_off: Vec::new(),
        scatter: Scatter::draw(0, residuals, random),
    };
    site.devices = match device {
        0 => {
            let count = 3 + random.index(3);
            let clamp = |random: &mut Random| {
                let at = place(&site, random);
                let turn = Vector3::from_fn(|_, _| (random.uniform(-90.0, 90.0) * 10.0).round() / 10.0 * DEG);
                arm::frame(&at, &turn)
            };
            Devices::Clamps((0..count).map(|_| clamp(random)).collect())
        }
        1 => Devices::Tracker(arm::point(
            &site.base,
            &Vector3::new(random.uniform(2.0, 4.0), random.uniform(-1.0, 1.0), 0.8),
        )),
        _ => {
            let (placements, each) = (3 + random.index(2), 2 + random.index(2));
            let distance = (random.uniform(40.0, 120.0) * 10.0).round() / 10.0 * MM;
            let mut sockets = Vec::new();
            for placement in 0..placements {
                let at = place(&site, random);
                let plate = arm::frame(&at, &Vector3::from_fn(|_, _| random.uniform(-0.5, 0.5)));
                for socket in 0..each {
                    let inside = [[0.0, 0.0], [1.0, 0.0], [0.4, 0.9]][socket];
                    let inside = Vector3::new(inside[0], inside[1], 0.0) * distance;
                    sockets.push((placement, socket, arm::point(&plate, &inside)));
                }
            }
            Devices::Sockets(sockets, distance)
        }
    };
    let groups = site.groups();
    site.scatter = Scatter::draw(groups, residuals, random);
    if device == 0 {
        let [low, high] = CLAMPS.0;
        let sd = (log_uniform(random, low, high) / UM).round() * UM;
        site.clamp_sd = happens(random, 0.5).then_some(sd);
        let size = site.clamp_sd.map_or(CLAMPS.1, |sd| times * sd);
        site.clamps_off = (0..groups).map(|_| normal(random, size)).collect();
    }
    rows(&mut site, random);
    site
}

fn normal(random: &mut Random, size: f64) -> Vector3<f64> {
    Vector3::from_fn(|_, _| size * random.normal())
}

/// Where a fixture stands: somewhere in reach.
fn place(site: &Site, random: &mut Random) -> Vector3<f64> {
    let reach: f64 = site.nominal.iter().map(|link| link.numbers[2].abs()).sum::<f64>() + 0.2;
    let (angle, radius) = (random.uniform(-2.6, 2.6), reach * random.uniform(0.45, 0.85));
    let inside = Vector3::new(radius * angle.cos(), radius * angle.sin(), random.uniform(-0.1, 0.5));
    arm::point(&site.base, &inside).map(|v| (v / MM * 10.0).round() / 10.0 * MM)
}

fn tool(random: &mut Random) -> Vector3<f64> {
    let one = |low: f64, high: f64, random: &mut Random| random.uniform(low, high).round() * MM;
    Vector3::new(one(20.0, 80.0, random), one(-30.0, 30.0, random), one(60.0, 180.0, random))
}

/// Poses in the order in which they were recorded.
fn rows(site: &mut Site, random: &mut Random) {
    let groups = site.groups();
    let count = 40 + random.index(111);
    let count = count.max(8 * groups);
    let is_mixed = happens(random, 0.3);
    let mut order: Vec<usize> =
        (0..count).map(|k| if is_mixed { k % groups } else { k * groups / count }).collect();
    if is_mixed {
        (1..count).rev().for_each(|k| order.swap(k, random.index(k + 1)));
    }
    let (mut time, room) =
        (0.0, [random.uniform(-2.0, 2.0), random.uniform(0.0, 0.5), random.uniform(1500.0, 7200.0)]);
    let n = site.nominal.len();
    for group in order {
        time += random.uniform(15.0, 45.0);
        let warm = 20.0 + room[0] * time / 3600.0 + room[1] * (std::f64::consts::TAU * time / room[2]).sin();
        let temperature = (warm * 100.0).round() / 100.0;
        let (at, aside) = ((time * 10.0).round() / 10.0, Vector3::zeros());
        site.rows.push(Row { q: vec![0.0; n], group, aside, time: at, temperature });
        let row = site.rows.len() - 1;
        if let Devices::Clamps(_) = site.devices {
            site.rows[row].aside = Vector3::from_fn(|_, _| random.uniform(-0.8, 0.8) * MM);
        }
        site.rows[row].q = pose(site, row, random);
    }
}

fn any(n: usize, random: &mut Random) -> Vec<f64> {
    (0..n)
        .map(|j| if j == 1 || j == 2 { random.uniform(-2.2, 2.2) } else { random.uniform(-2.9, 2.9) })
        .collect()
}

/// Joint angles with which the ball is where a row has it, rad; any above the floor where that is
/// free.
pub fn pose(site: &Site, row: usize, random: &mut Random) -> Vec<f64> {
    let n = site.nominal.len();
    let mut last = any(n, random);
    for _ in 0..TRIES {
        let start = any(n, random);
        let found = match &site.devices {
            Devices::Tracker(_) => {
                // above the floor
                let at = site.ball(row, &start, &[]);
                (at.z > site.base[(2, 3)] - 0.3).then_some(start)
            }
            Devices::Clamps(clamps) => {
                let target = arm::point(&clamps[site.rows[row].group], &site.rows[row].aside);
                site.joints_at(row, &start, &target, &[])
            }
            Devices::Sockets(sockets, _) => {
                site.joints_at(row, &start, &sockets[site.rows[row].group].2, &[])
            }
        };
        if let Some(q) = found {
            let is_within = q.iter().all(|q| q.abs() < LARGEST);
            last = q;
            if is_within {
                break;
            }
        }
    }
    as_shown(&last)
}

/// Angles as a readout shows them.
fn as_shown(q: &[f64]) -> Vec<f64> {
    q.iter().map(|q| (q.to_degrees() * 1e7).round() / 1e7 * DEG).collect()
}

/// What was read from row `first` on with these errors: positions in the devices' frames, m. The
/// joints are turned until the ball is where it was to be in its clamp, whatever is wrong; with
/// sockets until it is in its socket, off by the noise, and nothing is read.
pub fn measured(
    site: &mut Site,
    effects: &[Effect],
    first: usize,
    noise: &[Vector3<f64>],
) -> Vec<Vector3<f64>> {
    if let Devices::Sockets(sockets, _) = site.devices.clone() {
        for (row, noise) in (first..).zip(noise) {
            let target = sockets[site.rows[row].group].2 + noise;
            let start = site.rows[row].q.clone();
            if let Some(q) = site.joints_at(row, &start, &target, effects) {
                site.rows[row].q = q;
            }
        }
        return noise.to_vec();
    }
    if let Devices::Clamps(clamps) = site.devices.clone() {
        // what is misread is misread afterwards
        let still: Vec<Effect> =
            effects.iter().filter(|effect| !matches!(effect, Effect::Outlier(_))).cloned().collect();
        for row in first..first + noise.len() {
            let at = &site.rows[row];
            let target = arm::point(&clamps[at.group], &at.aside);
            let start = at.q.clone();
            if let Some(q) = site.joints_at(row, &start, &target, &still) {
                site.rows[row].q = as_shown(&q);
            }
        }
    }
    let read = |(row, noise): (usize, &Vector3<f64>)| {
        let at = site.ball(row, &site.rows[row].q, effects) + noise;
        let device: Matrix4<f64> = site.device(site.rows[row].group);
        let inside = device.fixed_view::<3, 3>(0, 0).transpose() * (at - device.column(3).xyz());
        inside.map(|value| site.scatter.shown(value))
    };
    (first..).zip(noise).map(read).collect()
}
