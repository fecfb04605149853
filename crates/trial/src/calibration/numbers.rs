//! The numbers of the files and what a calibration is free to change, each with its standard
//! uncertainty.
//!
//! Geometry, masses and centres by the robot's file, the rod's by its own, the places of clamps by
//! the campaign. Drives are hardly more compliant than three times what gears turn by, 1.5 mrad at
//! their rated torque. Of base, tip and the places of sockets next to nothing is known.

use nalgebra::{DVector, Vector3};

use super::geometry::of_robot;
use super::rod::Rod;
use super::site::{Devices, Site};

/// What nobody knows beforehand, m and rad.
const ANYWHERE: f64 = 0.1;
/// Angle of a drive at its rated torque, rad, how many times that it may be, and the least torque
/// that one is rated for, N·m.
const DRIVE: (f64, f64, f64) = (1.5e-3, 3.0, 5.0);

/// A number that is known to a standard uncertainty.
pub struct Number {
    /// What that does to every coordinate, m.
    pub column: DVector<f64>,
    /// By how many of them the file is off.
    pub off: f64,
}

/// All of a site whose drives may be so compliant.
pub fn numbers(site: &Site, drives: &[f64]) -> Vec<Number> {
    let mut numbers = of_geometry(site, drives);
    if site.has_masses {
        numbers.extend(of_links(site));
    }
    numbers.extend(site.rod.as_ref().into_iter().flat_map(|rod| of_rod(site, rod)));
    numbers.extend(site.clamp_sd.into_iter().flat_map(|sd| of_clamps(site, sd)));
    numbers
}

fn of_geometry(site: &Site, drives: &[f64]) -> Vec<Number> {
    let mut known: Vec<(f64, f64)> = Vec::new();
    for (joint, (nominal, real)) in site.nominal.iter().zip(&site.real).enumerate() {
        let numbers = nominal.numbers.iter().zip(&real.numbers).zip(site.known.numbers(nominal));
        known.extend(numbers.map(|((nominal, real), u)| (u, nominal - real)));
        if site.has_masses {
            known.push((drives[joint], -real.compliance));
        }
    }
    known.extend([(ANYWHERE, 0.0); 9]);
    let columns = of_robot(site).into_iter().zip(known);
    let of_column = |(column, (u, off)): (DVector<f64>, (f64, f64))| {
        (u > 0.0).then(|| Number { column: column * u, off: off / u })
    };
    columns.filter_map(of_column).collect()
}

/// How compliant the drives may be, rad/(N·m): none is rated for less than those beyond it.
pub fn drives(site: &Site) -> Vec<f64> {
    let (at_rated, times, mut rated) = DRIVE;
    let n = site.real.len();
    let mut largest = vec![0.0f64; n];
    for row in 0..site.rows.len() {
        let (torques, _) = site.loads(row);
        largest.iter_mut().zip(torques).for_each(|(most, torque)| *most = most.max(torque.abs()));
    }
    let mut drives = vec![0.0; n];
    for joint in (0..n).rev() {
        rated = rated.max(largest[joint]);
        drives[joint] = times * at_rated / rated;
    }
    drives
}

/// What another site's ball is elsewhere.
fn changed(at_rest: &DVector<f64>, other: &Site) -> DVector<f64> {
    ball(other) - at_rest
}

fn ball(site: &Site) -> DVector<f64> {
    site.each(|row, q| site.ball(row, q, &[]))
}

fn of_links(site: &Site) -> Vec<Number> {
    let at_rest = ball(site);
    let share = site.known.mass;
    let mut numbers = Vec::new();
    for (k, nominal) in site.nominal.iter().enumerate() {
        let mut heavier = site.clone();
        heavier.real[k].mass += share * nominal.mass;
        let off = (nominal.mass - site.real[k].mass) / (share * nominal.mass);
        numbers.push(Number { column: changed(&at_rest, &heavier), off });
        let u = site.known.centre(nominal);
        for axis in 0..3 {
            let mut moved = site.clone();
            moved.real[k].centre[axis] += u;
            let off = (nominal.centre[axis] - site.real[k].centre[axis]) / u;
            numbers.push(Number { column: changed(&at_rest, &moved), off });
        }
    }
    numbers
}

fn of_rod(site: &Site, rod: &Rod) -> Vec<Number> {
    let at_rest = ball(site);
    let number_moved = |which: usize| {
        let other = Rod::of(rod.drawing.clone(), rod.actual.moved(which, 1.0));
        // what is a rig's only concerns no rod
        let is_felt = other.per_force != rod.per_force;
        let other = Site { rod: Some(other), ..site.clone() };
        is_felt.then(|| Number { column: changed(&at_rest, &other), off: -rod.actual.error(which) })
    };
    (0..rod.actual.len()).filter_map(number_moved).collect()
}

fn of_clamps(site: &Site, sd: f64) -> Vec<Number> {
    let Devices::Clamps(clamps) = &site.devices else { return Vec::new() };
    let of_group = |(group, axis): (usize, usize)| {
        let column = site.each(|row, _| match site.rows[row].group == group {
            true => -Vector3::ith(axis, sd),
            false => Vector3::zeros(),
        });
        Number { column, off: -site.clamps_off[group][axis] / sd }
    };
    (0..clamps.len()).flat_map(|group| (0..3).map(move |axis| (group, axis))).map(of_group).collect()
}
