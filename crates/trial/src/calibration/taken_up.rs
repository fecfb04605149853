//! All that a calibration can take up: geometry, base, tool, drives where masses are known, places of sockets.

use nalgebra::{DMatrix, DVector, Vector3};

use super::arm;
use super::site::{Devices, Row, Site};
use rodcal_base::units::UM;

/// Standard deviation of the stated distance between two sockets, m.
pub const DISTANCE_SD: f64 = 10.0 * UM;
/// Step of a numerical derivative: of a length m, an angle rad, a compliance rad/(N·m).
const STEP: f64 = 1e-6;

/// As columns of every coordinate (and of the distances between sockets, behind them), in noises.
pub fn columns(site: &Site) -> DMatrix<f64> {
    let mut columns: Vec<Vec<f64>> =
        of_robot(site).into_iter().map(|column| column.as_slice().to_vec()).collect();
    if let Devices::Sockets(sockets, _) = &site.devices {
        let pairs: Vec<[usize; 2]> = (0..sockets.len())
            .filter(|&k| sockets[k].1 == 0 && k + 1 < sockets.len())
            .map(|k| [k, k + 1])
            .collect();
        columns.iter_mut().for_each(|column| column.extend(vec![0.0; pairs.len()]));
        for k in 0..sockets.len() {
            for axis in 0..3 {
                let of_row =
                    |row: &Row| [0, 1, 2].map(|a| if row.group == k && a == axis { 1.0 } else { 0.0 });
                let mut column: Vec<f64> = site.rows.iter().flat_map(of_row).collect();
                column.extend(pairs.iter().map(|&[a, b]| {
                    let along = (sockets[b].2 - sockets[a].2).normalize();
                    // the socket itself is on the other side of the equation
                    let side = f64::from(u8::from(k == a)) - f64::from(u8::from(k == b));
                    side * along[axis] * site.noise / DISTANCE_SD
                }));
                columns.push(column);
            }
        }
    }
    let rows = columns.first().map_or(0, Vec::len);
    DMatrix::from_fn(rows, columns.len(), |i, j| columns[j][i]) / site.noise
}

/// What of it turns and shifts the robot: ∂coordinate/∂parameter, m per unit of SI.
pub fn of_robot(site: &Site) -> Vec<DVector<f64>> {
    let rest = |site: &Site| site.each(|row, q| site.ball(row, q, &[]));
    let at_rest = rest(site);
    let column = |change: &dyn Fn(&mut Site)| {
        let mut moved = site.clone();
        change(&mut moved);
        (rest(&moved) - &at_rest) / STEP
    };
    let mut columns = Vec::new();
    for joint in 0..site.real.len() {
        for number in 0..5 {
            columns.push(column(&|site| site.real[joint].numbers[number] += STEP));
        }
        if site.has_masses {
            columns.push(column(&|site| site.real[joint].compliance += STEP));
        }
    }
    for axis in 0..3 {
        columns.push(column(&|site| site.base[(axis, 3)] += STEP));
        columns.push(column(&|site| site.base *= arm::frame(&Vector3::zeros(), &Vector3::ith(axis, STEP))));
        columns.push(column(&|site| site.tool[axis] += STEP));
    }
    columns
}
