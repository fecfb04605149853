//! Which effect, where, and how large at most. How much of that a case holds is drawn afterwards
//! (`calibration.rs`), on a logarithmic scale: three of ten single effects from a tenth of what
//! could just be detected up to that, the others from there on; of several effects in one case from
//! three times that.
//!
//! | effect | size | at most |
//! |---|---|---|
//! | `transmission_error` | amplitude of the strongest of one to four waves of 1 to 30 cycles/rev, some with a beat, µrad | 500 |
//! | `backlash` | play, µrad, by torque or by approach | 1000 |
//! | `joint_compliance` | turn at the largest torque, µrad, in a file without masses | 2000 |
//! | `joint_nonlinear_stiffness`, `joint_friction` | the same beyond what is linear; between both directions | 2000, 500 |
//! | `encoder_scale` | departure of the factor from 1 | 10⁻³ |
//! | `wrist_coupling`, `readback_lag` | share | 10⁻³ |
//! | `clamp_shift`, `socket_shift`, `tool_shift` | µm | 3000 |
//! | `clamp_pose`, `base_shift` | µm; turned by as many mrad per mm. A third of the bases: 300 mm and 0.1 rad | 3000 |
//! | `thermal_drift` | µm/K or µm/h of the base; µrad/K or µrad/h of a joint's zero | 300, 100 |
//! | `payload_mass`, `tip_mass` | kg, g | 5, 300 |
//! | `rod_stiffness` | departure of the factor from 1 | 60 % |
//! | `contact_spring`, `contact_force_variation` | N/mm, N | 0.3, 1 |
//! | `sensor_scale` | share of a displacement that a device shows too much, or along another axis | 0.2 |
//! | `thermal_drift` of the whole arm | µm/m per kelvin or per hour | 100 |
//! | `joint_shift` | µrad | 2000 |
//! | `gravity_direction`, `gravity_tilt` | degrees, µrad/(N·m) | 5, 5 |
//! | `outlier` | noises, one or two rows | 100 |
//!
//! The largest size is 0.5 to 1 times that. Physics that no library has: `beyond.rs`.

use nalgebra::Vector3;

use super::effect::Effect;
use super::setup::Needs;
use super::site::Site;
use crate::chance::{happens, log_uniform};
use crate::place::Place;
use rodcal_base::statistics::Random;
use rodcal_base::units::{DEG, GRAM, UM, URAD};

/// Effects that a library may have, by number for [`library`].
pub const LIBRARY: usize = 26;
/// Range of the largest size, of the end in the table.
const LARGEST: (f64, f64) = (0.5, 1.0);

/// What a recording must have to carry the effect of the library of this number.
pub fn needs(effect: usize) -> Needs {
    let none = Needs::default();
    match effect {
        3 => Needs { masses: Some(false), ..none },
        2 | 4 | 10 | 20 | 21 | 23 => Needs { masses: Some(true), ..none },
        7 => Needs { fixture: true, ..none },
        8 => Needs { device: Some(0), ..none },
        9 | 22 | 25 => Needs { clock: true, ..none },
        11 | 14 => Needs { rod: true, ..none },
        17 => Needs { points: true, ..none },
        18 | 19 => Needs { device: Some(0), rod: true, ..none },
        _ => none,
    }
}

/// Any direction, a unit vector.
pub fn direction(random: &mut Random) -> Vector3<f64> {
    let v = Vector3::from_fn(|_, _| random.normal());
    v / v.norm().max(1e-9)
}

pub fn either(random: &mut Random) -> f64 {
    if happens(random, 0.5) { -1.0 } else { 1.0 }
}

/// A joint whose gravity torque counts, and its largest size, N·m.
pub fn loaded(site: &Site, random: &mut Random) -> (usize, f64) {
    let mut largest = vec![0.0f64; site.nominal.len()];
    for row in 0..site.rows.len() {
        for (most, torque) in largest.iter_mut().zip(site.loads(row).0) {
            *most = most.max(torque.abs());
        }
    }
    let most = largest.iter().copied().fold(0.0, f64::max);
    let joints: Vec<usize> = (0..largest.len()).filter(|&j| largest[j] > 0.05 * most).collect();
    let joint = joints.get(random.index(joints.len())).copied().unwrap_or(1);
    (joint, largest[joint])
}

/// An effect of the library at a site that can carry it, as large as it may be.
pub fn library(effect: usize, site: &Site, random: &mut Random) -> Effect {
    let large = |random: &mut Random, most: f64| most * random.uniform(LARGEST.0, LARGEST.1);
    let n = site.nominal.len();
    let any = random.index(n);
    match effect {
        0 | 15 => transmission(any, large(random, 500.0) * URAD, random),
        1 => Effect::Backlash { joint: any, play: large(random, 1000.0) * URAD, by_approach: true },
        2 => {
            let (joint, _) = loaded(site, random);
            Effect::Backlash { joint, play: large(random, 1000.0) * URAD, by_approach: false }
        }
        3 => {
            let (joint, largest) = loaded(site, random);
            Effect::Compliance { joint, compliance: large(random, 2000.0) * URAD / largest }
        }
        4 => {
            let (joint, largest) = loaded(site, random);
            let (cubic, by) = (happens(random, 0.6), large(random, 2000.0) * URAD);
            Effect::Nonlinear { joint, cubic, per: by / largest.powi(if cubic { 3 } else { 2 }) }
        }
        5 => Effect::EncoderScale { joint: any, more: either(random) * large(random, 1e-3) },
        6 => {
            let from = n - 3 + random.index(2);
            let (from, to) = if happens(random, 0.5) { (from, from + 1) } else { (from + 1, from) };
            Effect::Coupling { from, to, share: either(random) * large(random, 1e-3) }
        }
        7 => {
            let group = random.index(site.groups());
            let rows: Vec<usize> =
                (0..site.rows.len()).filter(|&row| site.rows[row].group == group).collect();
            let inner = rows.len().saturating_sub(4).max(1);
            let from = rows.get(2 + random.index(inner)).copied().unwrap_or(0);
            Effect::Shift { group, from, by: direction(random) * large(random, 3000.0) * UM }
        }
        8 => clamp_pose(site, random),
        9 => {
            let by = direction(random) * large(random, 300.0) * UM;
            match site.has_temperature {
                true => Effect::Drift { by, by_time: false },
                false => Effect::Drift { by: by / 3600.0, by_time: true },
            }
        }
        10 => Effect::Payload(large(random, 5.0)),
        11 => Effect::TipMass(large(random, 300.0) * GRAM),
        12 => {
            let joint = happens(random, 0.4).then_some(any);
            Effect::Lag { joint, share: large(random, 1e-3) }
        }
        14 => {
            let departure = large(random, 0.6);
            Effect::Rod(if happens(random, 0.75) { departure } else { -departure })
        }
        16 => {
            let from = within(site, random);
            Effect::ToolShift { from, by: direction(random) * large(random, 3000.0) * UM }
        }
        17 => {
            let most = if happens(random, 0.33) { 100.0 } else { 1.0 };
            let size = large(random, 3000.0) * most;
            let (by, turn) = (direction(random) * size * UM, direction(random) * size * URAD);
            Effect::BaseShift { from: within(site, random), by, turn: turn / most.sqrt() }
        }
        // springs and sensors of a device
        18 => match happens(random, 0.5) {
            true => spring(site, large(random, 300.0), random),
            false => sensor(site, large(random, 0.2), random),
        },
        19 => Effect::Force { group: one_clamp(site, random), by: direction(random) * large(random, 1.0) },
        20 => {
            let (way, size) = (random.uniform(0.0, std::f64::consts::TAU), large(random, 5.0) * DEG);
            Effect::Level([size * way.cos(), size * way.sin()])
        }
        21 => Effect::BaseTilt(large(random, 5.0) * URAD),
        22 => {
            let per = either(random) * large(random, 100.0) * URAD;
            let by_time = !site.has_temperature;
            Effect::ZeroDrift { joint: any, per: if by_time { per / 3600.0 } else { per }, by_time }
        }
        23 => {
            let (joint, largest) = loaded(site, random);
            Effect::Friction { joint, per: large(random, 500.0) * URAD / largest }
        }
        24 => {
            let by = either(random) * large(random, 2000.0) * URAD;
            Effect::JointShift { joint: any, from: within(site, random), by }
        }
        25 => {
            let (per, by_time) = (either(random) * large(random, 100.0) * UM, !site.has_temperature);
            Effect::Growth { per: if by_time { per / 3600.0 } else { per }, by_time }
        }
        _ => {
            let count = if happens(random, 0.7) { 1 } else { 2 };
            let first = random.index(site.rows.len());
            let second = (first + 1 + random.index(site.rows.len() - 1)) % site.rows.len();
            let mut by = || direction(random) * (large(random, 100.0) * site.scatter.sd);
            let rows = [(first, by()), (second, by())];
            Effect::Outlier(rows[..count].to_vec())
        }
    }
}

/// A row with some before it and after it.
fn within(site: &Site, random: &mut Random) -> usize {
    3 + random.index(site.rows.len().saturating_sub(6).max(1))
}

/// One clamp, or all of them.
fn one_clamp(site: &Site, random: &mut Random) -> Option<usize> {
    happens(random, 0.4).then(|| random.index(site.groups()))
}

/// A spring of so many N/m at the most.
pub fn spring(site: &Site, rate: f64, random: &mut Random) -> Effect {
    Effect::Spring { group: one_clamp(site, random), rate: either(random) * rate }
}

/// Sensors that are off by such a share, half of them by cross-talk.
pub fn sensor(site: &Site, share: f64, random: &mut Random) -> Effect {
    let shown = random.index(3);
    let along = if happens(random, 0.5) { shown } else { (shown + 1 + random.index(2)) % 3 };
    // cross-talk is that of a device that goes from clamp to clamp
    let group = one_clamp(site, random).filter(|_| shown == along);
    Effect::Sensor { group, shown, along, more: either(random) * share }
}

/// A clamp that stands elsewhere.
pub fn clamp_pose(site: &Site, random: &mut Random) -> Effect {
    let size = 3000.0 * random.uniform(LARGEST.0, LARGEST.1);
    let turn = direction(random) * (size * random.uniform(0.2, 2.0) * URAD);
    Effect::ClampPose { group: random.index(site.groups()), by: direction(random) * (size * UM), turn }
}

fn transmission(joint: usize, largest: f64, random: &mut Random) -> Effect {
    let count = if happens(random, 0.4) { 1 } else { 2 + random.index(3) };
    let base = log_uniform(random, 1.0, 30.0);
    let waves = (0..count)
        .map(|k| {
            // multiples of one another, nearly
            let cycles = if k == 0 { base } else { base * (k + 1) as f64 * random.uniform(0.97, 1.03) };
            let share = if k == 0 { 1.0 } else { random.uniform(0.1, 0.7) };
            [cycles.min(38.0), share * largest, random.uniform(0.0, std::f64::consts::TAU)]
        })
        .collect();
    let beat =
        (count > 1 && happens(random, 0.3)).then(|| [random.uniform(0.2, 0.6), random.uniform(0.5, 2.0)]);
    Effect::Transmission { joint, waves, beat }
}

/// Where an effect is.
pub fn place(effect: &Effect, site: &Site) -> Place {
    match effect {
        Effect::Transmission { joint, .. }
        | Effect::Backlash { joint, .. }
        | Effect::Compliance { joint, .. }
        | Effect::Nonlinear { joint, .. }
        | Effect::EncoderScale { joint, .. }
        | Effect::Lag { joint: Some(joint), .. }
        | Effect::ZeroDrift { joint, .. }
        | Effect::Friction { joint, .. }
        | Effect::Runout { joint, .. }
        | Effect::Wear { joint, .. } => Place::joint(*joint),
        Effect::Coupling { from, to, .. } => Place { driven_by: Some(from + 1), ..Place::joint(*to) },
        Effect::ClampPose { group, .. } => Place::named(&site.group_name(*group)),
        Effect::Shift { group, from, .. } => shift_place(site, *group, *from),
        Effect::Drift { .. } | Effect::Level(_) | Effect::BaseTilt(_) => Place::part("base"),
        Effect::JointShift { joint, from, .. } => Place { after_row: Some(*from), ..Place::joint(*joint) },
        Effect::Growth { .. } => Place::part("arm"),
        Effect::ToolShift { from, .. } => Place { after_row: Some(*from), ..Place::named("tool") },
        Effect::BaseShift { from, .. } => Place { after_row: Some(*from), ..Place::default() },
        Effect::Spring { group, .. } | Effect::Force { group, .. } => match group {
            Some(group) => Place::named(&site.group_name(*group)),
            None => Place::named("all clamps"),
        },
        Effect::Sensor { group, shown, along, .. } => sensor_place(site, *group, Some((*shown, *along))),
        Effect::Payload(_) => Place::part("flange"),
        Effect::TipMass(_) => Place::part("tip"),
        Effect::Lag { .. } | Effect::MoveHistory(_) => Place::all_joints(),
        Effect::Rod(_) => Place::part("rod"),
        Effect::Outlier(rows) => {
            let of_row = |(row, _): &(usize, _)| Place { row: Some(row + 1), ..Place::default() };
            Place { all: rows.iter().map(of_row).collect(), ..Place::default() }
        }
        Effect::LinkTorsion { link, joints: [a, b], .. } => {
            Place::part(&format!("link {}, joints {} and {}", link + 1, a + 1, b + 1))
        }
        Effect::Ball(_) => Place::part("ball"),
        Effect::Disturbance { .. } => Place::part("world"),
        Effect::Refraction(_) => Place::part("tracker"),
        Effect::LooseMount(_) => Place::part("tool"),
    }
}

/// The sensor of one axis in a clamp or in all of them, what it shows of a displacement along
/// another one, or all sensors there.
pub fn sensor_place(site: &Site, group: Option<usize>, shown_of: Option<(usize, usize)>) -> Place {
    const AXES: [&str; 3] = ["x", "y", "z"];
    let clamp = group.map_or("all clamps".to_owned(), |group| site.group_name(group));
    let closer = match shown_of {
        None => String::new(),
        Some((shown, along)) if shown == along => format!(", axis {}", AXES[shown]),
        Some((shown, along)) => format!(", {} into {}", AXES[along], AXES[shown]),
    };
    Place::named(&(clamp + &closer))
}

/// After the last row of the fixture before it moved.
pub fn shift_place(site: &Site, group: usize, from: usize) -> Place {
    let last = (0..from).rev().find(|&row| site.rows[row].group == group).unwrap_or(0);
    Place { after_row: Some(last + 1), ..Place::named(&site.group_name(group)) }
}
