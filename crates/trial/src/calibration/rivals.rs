//! Every effect of the library wherever it may sit: what might be in the place of another one.

use nalgebra::{DVector, Matrix4, Vector3};

use super::arm;
use super::draw::{sensor_place, shift_place};
use super::effect::Effect;
use super::site::{Devices, Site, tip_jacobian};
use crate::effect_name::EffectName;
use crate::place::Place;
use rodcal_base::units::UM;

/// Size of what turns a joint, rad, and of what moves a fixture, m and rad.
const TURN: f64 = 1e-3;
const MOVE: f64 = 3e-3;
/// Of a drift over its whole course, m.
const DRIFT: f64 = 300.0 * UM;
/// Moves of tool and base are tried after every so many rows, but where such a move is concealed.
const COARSE: usize = 6;

/// An effect that might be in the place of another one.
pub struct Rival {
    pub name: EffectName,
    pub place: Place,
    /// What they do to every coordinate, m; to the oracle without what numbers take up, in noises.
    pub columns: Vec<DVector<f64>>,
}

/// Collects rivals.
struct List<'a> {
    site: &'a Site,
    /// Torques and frames of every row, and the ball.
    loads: Vec<(Vec<f64>, Vec<Matrix4<f64>>)>,
    at: Vec<Vector3<f64>>,
    rivals: Vec<Rival>,
}

impl List<'_> {
    fn add(&mut self, name: EffectName, place: Place, columns: Vec<DVector<f64>>) {
        self.rivals.push(Rival { name, place, columns });
    }

    /// A displacement for every row, m.
    fn column(&self, displacement: impl Fn(usize) -> Vector3<f64>) -> DVector<f64> {
        self.site.each(|row, _| displacement(row))
    }

    /// The same along three axes.
    fn three(&self, displacement: impl Fn(usize, &Vector3<f64>) -> Vector3<f64>) -> Vec<DVector<f64>> {
        let axes = [Vector3::x(), Vector3::y(), Vector3::z()];
        axes.map(|axis| self.column(|row| displacement(row, &axis))).to_vec()
    }

    /// So many times what an effect does.
    fn changed(&self, effect: Effect, times: f64) -> DVector<f64> {
        self.site.added(&[effect], &[]) * times
    }

    fn tip_jacobian(&self, row: usize, joint: usize) -> Vector3<f64> {
        tip_jacobian(&self.loads[row].1[joint], &self.at[row])
    }

    fn flange(&self, row: usize) -> &Matrix4<f64> {
        &self.loads[row].1[self.site.nominal.len()]
    }
}

/// All of a site, beside `effects` that are concealed there.
pub fn rivals(site: &Site, effects: &[Effect]) -> Vec<Rival> {
    let rows = 0..site.rows.len();
    let loads = rows.clone().map(|row| site.loads(row)).collect();
    let at = rows.map(|row| site.ball(row, &site.rows[row].q, &[])).collect();
    let mut list = List { site, loads, at, rivals: Vec::new() };
    of_joints(&mut list);
    of_loads(&mut list);
    of_drift(&mut list);
    of_fixtures(&mut list);
    of_moves(&mut list, effects);
    list.rivals
}

fn of_joints(list: &mut List<'_>) {
    let (site, rows, n) = (list.site, list.site.rows.len(), list.site.nominal.len());
    let angle = |row: usize, j: usize| site.rows[row].q[j];
    let step = |row: usize, j: usize| angle(row, j) - angle(row.saturating_sub(1), j);
    for j in 0..n {
        let joint = Place::joint(j);
        let turn = |list: &List<'_>, j: usize, weight: &dyn Fn(usize) -> f64| {
            list.column(|row| list.tip_jacobian(row, j) * (TURN * weight(row)))
        };
        let mut slow = Vec::new();
        for k in 1..=76 {
            let cycles = 0.5 * f64::from(k);
            let sine = turn(list, j, &|row| (cycles * angle(row, j)).sin());
            let columns = vec![sine, turn(list, j, &|row| (cycles * angle(row, j)).cos())];
            if k % 2 == 0 && k <= 10 {
                slow.extend(columns.clone());
            }
            list.add(EffectName::TransmissionError, joint.clone(), columns);
        }
        list.add(EffectName::TransmissionError, joint.clone(), slow);
        let torques: Vec<f64> = (0..rows).map(|row| list.loads[row].0[j]).collect();
        let largest = torques.iter().fold(0.0, |most: f64, torque| most.max(torque.abs()));
        let mut one = |name: EffectName, weight: &dyn Fn(usize) -> f64| {
            let column = turn(list, j, weight);
            list.add(name, joint.clone(), vec![column]);
        };
        one(EffectName::EncoderScale, &|row| angle(row, j));
        one(EffectName::ReadbackLag, &|row| step(row, j));
        one(EffectName::Backlash, &|row| site.approach(row, j));
        if largest > 0.1 {
            let share = |row: usize| torques[row] / largest;
            one(EffectName::JointCompliance, &share);
            if site.has_masses {
                one(EffectName::Backlash, &|row| share(row).signum());
                one(EffectName::JointNonlinearStiffness, &|row| share(row) * share(row).abs());
                one(EffectName::JointNonlinearStiffness, &|row| share(row).powi(3));
                one(EffectName::JointFriction, &|row| share(row).abs() * site.approach(row, j));
            }
        }
        for to in [j.wrapping_sub(1), j + 1] {
            if j.min(to) >= n - 3 && to < n {
                let place = Place { driven_by: Some(j + 1), ..Place::joint(to) };
                let column = turn(list, to, &|row| angle(row, j));
                list.add(EffectName::WristCoupling, place, vec![column]);
            }
        }
    }
    let all = list.column(|row| (0..n).map(|j| list.tip_jacobian(row, j) * (TURN * step(row, j))).sum());
    list.add(EffectName::ReadbackLag, Place::all_joints(), vec![all]);
}

fn of_loads(list: &mut List<'_>) {
    let site = list.site;
    if site.has_masses {
        let payload = list.changed(Effect::Payload(0.1), 50.0);
        list.add(EffectName::PayloadMass, Place::part("flange"), vec![payload]);
        let tilt = list.changed(Effect::BaseTilt(1e-8), 1000.0);
        list.add(EffectName::GravityTilt, Place::part("base"), vec![tilt]);
    }
    if site.has_masses || site.rod.is_some() {
        let mass = list.changed(Effect::TipMass(0.01), 30.0);
        list.add(EffectName::TipMass, Place::part("tip"), vec![mass]);
        let level = [[1e-3, 0.0], [0.0, 1e-3]].map(|turn| list.changed(Effect::Level(turn), 100.0));
        list.add(EffectName::GravityDirection, Place::part("base"), level.to_vec());
    }
    if let Some(rod) = &site.rod {
        let softer = list.changed(Effect::Rod(0.01), 60.0);
        list.add(EffectName::RodStiffness, Place::part("rod"), vec![softer]);
        let own = list.column(|row| {
            let flange = list.flange(row).fixed_view::<3, 3>(0, 0).into_owned();
            flange * rod.per_gravity * flange.transpose() * site.gravity * 0.6
        });
        list.add(EffectName::RodMass, Place::part("rod"), vec![own]);
    }
}

fn of_drift(list: &mut List<'_>) {
    let (site, rows) = (list.site, list.site.rows.len());
    let courses: [&dyn Fn(usize) -> f64; 3] = [
        &|row| site.rows[row].temperature - site.rows[0].temperature,
        &|row| site.rows[row].time / 3600.0,
        &|row| (-(row as f64) / (0.2 * rows as f64)).exp(),
    ];
    for (k, course) in courses.into_iter().enumerate() {
        if k == 0 && !site.has_temperature {
            continue;
        }
        let world = list.three(|row, axis| axis * (DRIFT * course(row)));
        list.add(EffectName::ThermalDrift, Place::part("base"), world);
        let own = list.three(|row, axis| arm::turned(list.flange(row), axis) * (DRIFT * course(row)));
        list.add(EffectName::ThermalDrift, Place::part("tool"), own);
        let base = arm::column(&site.base, 3);
        let longer = |row: usize| arm::column(list.flange(row), 3) - base;
        let growth = list.column(|row| longer(row) * (DRIFT * course(row)));
        list.add(EffectName::ThermalDrift, Place::part("arm"), vec![growth]);
        for j in 0..site.nominal.len() {
            let zero = list.column(|row| list.tip_jacobian(row, j) * (TURN * course(row)));
            list.add(EffectName::ThermalDrift, Place::joint(j), vec![zero]);
        }
    }
}

fn of_fixtures(list: &mut List<'_>) {
    let site = list.site;
    if matches!(site.devices, Devices::Tracker(_)) {
        return;
    }
    let shift = if site.has_sockets() { EffectName::SocketShift } else { EffectName::ClampShift };
    for group in 0..site.groups() {
        let own: Vec<usize> = (0..site.rows.len()).filter(|&row| site.rows[row].group == group).collect();
        let here = |is: bool, v: Vector3<f64>| if is { v * MOVE } else { Vector3::zeros() };
        for &from in own.iter().skip(2).take(own.len().saturating_sub(3)) {
            let columns = list.three(|row, axis| here(row >= from && site.rows[row].group == group, *axis));
            list.add(shift.clone(), shift_place(site, group, from), columns);
        }
        if let Devices::Clamps(clamps) = &site.devices {
            let from = arm::column(&clamps[group], 3);
            let is_here = |row: usize| site.rows[row].group == group;
            let mut six = list.three(|row, axis| here(is_here(row), *axis));
            six.extend(list.three(|row, axis| here(is_here(row), axis.cross(&(list.at[row] - from)))));
            list.add(EffectName::ClampPose, Place::named(&site.group_name(group)), six);
        }
    }
    if matches!(site.devices, Devices::Clamps(_)) {
        of_sensors(list);
    }
    if !matches!(site.devices, Devices::Clamps(_)) || !site.has_masses && site.rod.is_none() {
        return;
    }
    for group in std::iter::once(None).chain((0..site.groups()).map(Some)) {
        let place = Place::named(&group.map_or("all clamps".to_owned(), |group| site.group_name(group)));
        let spring = list.changed(Effect::Spring { group, rate: 10.0 }, 50.0);
        list.add(EffectName::ContactSpring, place.clone(), vec![spring]);
        let force =
            (0..3).map(|axis| list.changed(Effect::Force { group, by: Vector3::ith(axis, 0.01) }, 100.0));
        let force = force.collect();
        list.add(EffectName::ContactForceVariation, place, force);
    }
}

/// One sensor's scale, and all of a device together.
fn of_sensors(list: &mut List<'_>) {
    let site = list.site;
    for group in std::iter::once(None).chain((0..site.groups()).map(Some)) {
        let shows = |list: &List<'_>, shown: usize, along: usize| {
            list.changed(Effect::Sensor { group, shown, along, more: 1e-3 }, 100.0)
        };
        for axis in 0..3 {
            let column = shows(list, axis, axis);
            list.add(EffectName::SensorScale, sensor_place(site, group, Some((axis, axis))), vec![column]);
        }
        if group.is_none() {
            let all = (0..9).map(|k| shows(list, k / 3, k % 3)).collect();
            list.add(EffectName::SensorScale, sensor_place(site, None, None), all);
        }
    }
}

fn of_moves(list: &mut List<'_>, effects: &[Effect]) {
    let (site, rows) = (list.site, list.site.rows.len());
    let moves_tool = effects.iter().any(|effect| matches!(effect, Effect::ToolShift { .. }));
    let moves_base = effects.iter().any(|effect| matches!(effect, Effect::BaseShift { .. }));
    let slips = effects.iter().any(|effect| matches!(effect, Effect::JointShift { .. }));
    let is_tried = |from: usize, is_fine: bool| is_fine || from.is_multiple_of(COARSE);
    let base = arm::column(&site.base, 3);
    for from in 2..rows.saturating_sub(1) {
        let after = |name: Option<&str>| Place {
            after_row: Some(from),
            name: name.map(str::to_owned),
            ..Place::default()
        };
        let later = |row: usize, v: Vector3<f64>| if row >= from { v * MOVE } else { Vector3::zeros() };
        if is_tried(from, moves_tool) {
            let columns = list.three(|row, axis| later(row, arm::turned(list.flange(row), axis)));
            list.add(EffectName::ToolShift, after(Some("tool")), columns);
        }
        if is_tried(from, slips) {
            for j in 0..site.nominal.len() {
                let turned = list.column(|row| {
                    if row >= from { list.tip_jacobian(row, j) * TURN } else { Vector3::zeros() }
                });
                let place = Place { after_row: Some(from), ..Place::joint(j) };
                list.add(EffectName::JointShift, place, vec![turned]);
            }
        }
        if is_tried(from, moves_base) && !site.has_sockets() {
            let mut six = list.three(|row, axis| later(row, *axis));
            six.extend(list.three(|row, axis| later(row, axis.cross(&(list.at[row] - base)))));
            list.add(EffectName::BaseShift, after(None), six);
        }
    }
    for row in 0..rows {
        let size = 100.0 * site.scatter.sd;
        let columns = list.three(|r, axis| if r == row { axis * size } else { Vector3::zeros() });
        list.add(EffectName::Outlier, Place { row: Some(row + 1), ..Place::default() }, columns);
    }
}
