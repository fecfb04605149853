//! What could have been known at best of a calibration: every coordinate without its noise, less what the calibration can
//! take up.
//!
//! The measure is the rig's (`trial/rig/oracle.rs`): with δ what an effect adds and C what a rival can add, both in noises
//! and both without what geometry, base, tool, drives and socket points can take up (their numerical derivatives),
//! log BF = ½·d² − (p/2)·ln(1 + d²), d² = min over β of |δ − Cβ|² + |β|². A rival's columns are first order, of a size at the
//! upper end of its range. An effect within the library is a rival wherever it may sit.

use std::collections::BTreeMap;

use nalgebra::{DMatrix, DVector, Vector3};

use super::draw::{place, shift_place};
use super::effect::Effect;
use super::site::{Devices, Site, gravity, lever};
use super::taken_up;
use crate::place::Place;
use crate::truth::Detectability;
use rodcal_base::linalg::thin_svd;
use rodcal_base::units::UM;

/// Effects of other names closer than this cannot be distinguished; places of one effect closer
/// than that.
const SAME_EFFECT: f64 = 5.0;
const SAME_PLACE: f64 = 3.0;
/// Size of what turns a joint, rad, and of what moves a fixture, m and rad.
const TURN: f64 = 1e-3;
const MOVE: f64 = 3e-3;
/// Singular values below this share of the largest are none; columns are scaled before.
const RANK: f64 = 1e-9;

struct Rival {
    name: &'static str,
    place: Place,
    columns: Vec<DVector<f64>>,
}

/// Knows a site.
pub struct Oracle<'a> {
    site: &'a Site,
    /// Orthonormal, in noises.
    taken_up: DMatrix<f64>,
    /// Rows behind the coordinates.
    more: usize,
    rivals: Vec<Rival>,
}

impl<'a> Oracle<'a> {
    pub fn new(site: &'a Site) -> Self {
        let mut columns = taken_up::columns(site);
        let more = columns.nrows() - 3 * site.rows.len();
        for mut column in columns.column_iter_mut() {
            let norm = column.norm();
            if norm > 0.0 {
                column /= norm;
            }
        }
        let taken_up = thin_svd(&columns).map_or_else(
            |_| DMatrix::zeros(columns.nrows(), 0),
            |svd| svd.u.columns(0, svd.rank(RANK)).into_owned(),
        );
        let mut oracle = Oracle { site, taken_up, more, rivals: Vec::new() };
        oracle.rivals = oracle.all_rivals();
        oracle
    }

    /// In noises, without what the calibration takes up.
    fn left(&self, coordinates: DVector<f64>) -> DVector<f64> {
        let rows = coordinates.len() + self.more;
        let whole = coordinates.resize_vertically(rows, 0.0) / self.site.noise;
        let taken = self.taken_up.tr_mul(&whole);
        whole - &self.taken_up * taken
    }

    /// Squared noises that effects leave after the calibration, per coordinate.
    pub fn share_left(&self, effects: &[Effect]) -> f64 {
        self.left(self.site.added(effects, &[])).norm_squared() / (3 * self.site.rows.len()) as f64
    }

    /// What of `effects` can be known of number `which`, given all others.
    pub fn detectability(&self, effects: &[Effect], which: usize) -> Detectability {
        let others: Vec<Effect> =
            effects.iter().enumerate().filter(|(k, _)| *k != which).map(|(_, e)| e.clone()).collect();
        let delta = self.left(self.site.added(effects, &others));
        // the size of the others is not known either
        let given: Vec<DVector<f64>> =
            others.iter().map(|e| self.left(self.site.added(std::slice::from_ref(e), &[]))).collect();
        let effect = &effects[which];
        let separation = |columns: &[DVector<f64>]| {
            let square = remainder(&delta, &given, columns);
            0.5 * square - 0.5 * effect.freedom() * square.ln_1p()
        };
        let own = effect.name(self.site.has_sockets());
        let mut best: BTreeMap<&str, f64> = BTreeMap::new();
        let mut places = vec![place(effect, self.site)];
        for rival in &self.rivals {
            let apart = separation(&rival.columns);
            if rival.name != own {
                let least = best.entry(rival.name).or_insert(f64::INFINITY);
                *least = least.min(apart);
            } else if apart < SAME_PLACE && !places.contains(&rival.place) {
                places.push(rival.place.clone());
            }
        }
        let nearest = best.iter().min_by(|a, b| a.1.total_cmp(b.1));
        Detectability {
            against_none: separation(&[]),
            against_rival: nearest.map_or(f64::MAX, |(_, apart)| *apart),
            against_pair: None,
            best_rival: nearest.map_or_else(String::new, |(name, _)| (*name).to_owned()),
            class: best.iter().filter(|(_, a)| **a < SAME_EFFECT).map(|(n, _)| (*n).to_owned()).collect(),
            places,
            stations_mm: None,
        }
    }

    fn all_rivals(&self) -> Vec<Rival> {
        let site = self.site;
        let rows = site.rows.len();
        let n = site.nominal.len();
        let loads: Vec<_> = (0..rows).map(|row| site.loads(row)).collect();
        let tips: Vec<Vector3<f64>> = (0..rows).map(|row| site.ball(row, &site.rows[row].q, &[])).collect();
        let levers: Vec<Vec<Vector3<f64>>> =
            (0..rows).map(|row| (0..n).map(|j| lever(&loads[row].1[j], &tips[row])).collect()).collect();
        let torque = |row: usize, j: usize| loads[row].0[j];
        let angle = |row: usize, j: usize| site.rows[row].q[j];
        let step = |row: usize, j: usize| angle(row, j) - angle(row.saturating_sub(1), j);
        let column = |of: &dyn Fn(usize) -> Vector3<f64>| self.left(site.each(|row, _| of(row)));
        let turn = |j: usize, of: &dyn Fn(usize) -> f64| column(&|row| levers[row][j] * (TURN * of(row)));
        let mut rivals: Vec<Rival> = Vec::new();
        let mut add = |name: &'static str, place: Place, columns: Vec<DVector<f64>>| {
            let columns: Vec<_> = columns.into_iter().filter(|c| c.norm() > 1e-3).collect();
            if !columns.is_empty() {
                rivals.push(Rival { name, place, columns });
            }
        };
        for j in 0..n {
            let joint = Place::joint(j);
            let wave = |cycles: f64| {
                [
                    turn(j, &|row| (cycles * angle(row, j)).sin()),
                    turn(j, &|row| (cycles * angle(row, j)).cos()),
                ]
            };
            (1..=76)
                .for_each(|k| add("transmission_error", joint.clone(), wave(0.5 * f64::from(k)).to_vec()));
            add("transmission_error", joint.clone(), (1..=5).flat_map(|k| wave(f64::from(k))).collect());
            add("encoder_scale", joint.clone(), vec![turn(j, &|row| angle(row, j))]);
            add("readback_lag", joint.clone(), vec![turn(j, &|row| step(row, j))]);
            add("backlash", joint.clone(), vec![turn(j, &|row| site.approach(row, j))]);
            let largest = (0..rows).map(|row| torque(row, j).abs()).fold(0.0, f64::max);
            if largest > 0.1 {
                let of = |f: fn(f64) -> f64| vec![turn(j, &|row| f(torque(row, j) / largest))];
                add("joint_compliance", joint.clone(), of(|t| t));
                if site.has_masses {
                    add("backlash", joint.clone(), of(f64::signum));
                    add("joint_nonlinear_stiffness", joint.clone(), of(|t| t * t.abs()));
                    add("joint_nonlinear_stiffness", joint.clone(), of(|t| t.powi(3)));
                }
            }
            for to in [j.wrapping_sub(1), j + 1] {
                if j.min(to) >= n - 3 && to < n {
                    add(
                        "wrist_coupling",
                        Place { driven_by: Some(j + 1), ..Place::joint(to) },
                        vec![turn(to, &|row| angle(row, j))],
                    );
                }
            }
        }
        let all = column(&|row| (0..n).map(|j| levers[row][j] * (TURN * step(row, j))).sum());
        add("readback_lag", Place { joint: Some("all".into()), ..Place::default() }, vec![all]);
        let changed = |effect: Effect, times: f64| self.left(self.site.added(&[effect], &[])) * times;
        if site.has_masses {
            add("payload_mass", Place::part("flange"), vec![changed(Effect::Payload(0.1), 50.0)]);
        }
        if site.has_masses || site.rod.is_some() {
            add("tip_mass", Place::part("tip"), vec![changed(Effect::TipMass(0.01), 30.0)]);
        }
        if site.rod.is_some() {
            add("rod_stiffness", Place::part("rod"), vec![changed(Effect::Rod(1.01), 60.0)]);
            let own = |row: usize| {
                let flange = loads[row].1[n].fixed_view::<3, 3>(0, 0).into_owned();
                site.rod.as_ref().map_or_else(Vector3::zeros, |rod| {
                    flange * rod.per_gravity * flange.transpose() * gravity()
                })
            };
            add("rod_stiffness", Place::part("rod"), vec![column(&|row| own(row) * 0.6)]);
        }
        let courses: [(&dyn Fn(usize) -> f64, f64); 3] = [
            (&|row| site.rows[row].temperature - site.rows[0].temperature, 300.0 * UM),
            (&|row| site.rows[row].time / 3600.0, 300.0 * UM),
            (&|row| (-(row as f64) / (0.2 * rows as f64)).exp(), 300.0 * UM),
        ];
        for (k, (course, size)) in courses.into_iter().enumerate() {
            if k > 0 || site.has_temperature {
                let along = |axis: usize| column(&|row| Vector3::ith(axis, size * course(row)));
                add("thermal_drift", Place::part("base"), (0..3).map(along).collect());
                let own = |axis: usize| {
                    column(&|row| loads[row].1[n].fixed_view::<3, 1>(0, axis) * (size * course(row)))
                };
                add("thermal_drift", Place::part("tool"), (0..3).map(own).collect());
            }
        }
        if !matches!(site.devices, Devices::Tracker(_)) {
            let shift = if site.has_sockets() { "socket_shift" } else { "clamp_shift" };
            for group in 0..site.groups() {
                let own: Vec<usize> = (0..rows).filter(|&row| site.rows[row].group == group).collect();
                for &from in own.iter().skip(2).take(own.len().saturating_sub(3)) {
                    let is_after = |row: usize| row >= from && site.rows[row].group == group;
                    let along = |axis: usize| {
                        column(&|row| if is_after(row) { Vector3::ith(axis, MOVE) } else { Vector3::zeros() })
                    };
                    add(shift, shift_place(site, group, from), (0..3).map(along).collect());
                }
                if !site.has_sockets() {
                    let at = |of: &dyn Fn(usize) -> Vector3<f64>| {
                        column(&|row| if site.rows[row].group == group { of(row) } else { Vector3::zeros() })
                    };
                    let six = (0..3).flat_map(|axis| {
                        let turned = |row: usize| {
                            Vector3::ith(axis, MOVE).cross(&(tips[row] - site.device(group).column(3).xyz()))
                        };
                        [at(&|_| Vector3::ith(axis, MOVE)), at(&turned)]
                    });
                    add("clamp_pose", Place::named(&site.group_name(group)), six.collect());
                }
            }
        }
        for row in 0..rows {
            let along = |axis: usize| {
                column(&|r| Vector3::ith(axis, if r == row { 100.0 * site.noise } else { 0.0 }))
            };
            let at = Place { row: Some(row + 1), ..Place::default() };
            add("outlier", at, (0..3).map(along).collect());
        }
        rivals
    }
}

/// min over α, β of |δ − Gα − Cβ|² + |α|² + |β|².
fn remainder(delta: &DVector<f64>, given: &[DVector<f64>], columns: &[DVector<f64>]) -> f64 {
    let all: Vec<&DVector<f64>> = given.iter().chain(columns).collect();
    let k = all.len();
    let mut normal = DMatrix::from_fn(k, k, |i, j| all[i].dot(all[j]));
    let right = DVector::from_fn(k, |i, _| all[i].dot(delta));
    (0..k).for_each(|i| normal[(i, i)] += 1.0);
    let explained = normal.cholesky().map_or(0.0, |cholesky| right.dot(&cholesky.solve(&right)));
    (delta.norm_squared() - explained).max(0.0)
}
