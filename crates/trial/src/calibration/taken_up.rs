//! All that a calibration can take up: geometry, base, tool, drives where masses are known, places of sockets, and the numbers
//! of the files.

use nalgebra::{DMatrix, DVector, Matrix4, Vector3};

use super::arm;
use super::numbers::{drives, numbers};
use super::site::{Devices, Row, Site, lever};
use rodcal_base::units::UM;

/// Standard deviation of the stated distance between two sockets, m.
pub const DISTANCE_SD: f64 = 10.0 * UM;
/// Of the place of a socket, m.
const ANYWHERE: f64 = 0.1;

/// What a standard uncertainty of each number does to every coordinate, in noises that know nothing of each other, and to the
/// distances between sockets behind them; and by how many of them the file is off.
pub fn columns(site: &Site) -> (DMatrix<f64>, Vec<f64>) {
    let numbers = numbers(site, &drives(site));
    let mut off: Vec<f64> = numbers.iter().map(|number| number.off).collect();
    let mut columns: Vec<Vec<f64>> = numbers
        .iter()
        .map(|number| site.scatter.whitened(site, &number.column).as_slice().to_vec())
        .collect();
    if let Devices::Sockets(sockets, _) = &site.devices {
        let pairs: Vec<[usize; 2]> = (0..sockets.len())
            .filter(|&k| sockets[k].1 == 0 && k + 1 < sockets.len())
            .map(|k| [k, k + 1])
            .collect();
        columns.iter_mut().for_each(|column| column.extend(vec![0.0; pairs.len()]));
        for k in 0..sockets.len() {
            for axis in 0..3 {
                let of_row =
                    |row: &Row| [0, 1, 2].map(|a| if row.group == k && a == axis { ANYWHERE } else { 0.0 });
                let column = DVector::from_vec(site.rows.iter().flat_map(of_row).collect());
                let mut column = site.scatter.whitened(site, &column).as_slice().to_vec();
                column.extend(pairs.iter().map(|&[a, b]| {
                    let along = (sockets[b].2 - sockets[a].2).normalize();
                    // the socket itself is on the other side of the equation
                    let side = f64::from(u8::from(k == a)) - f64::from(u8::from(k == b));
                    side * along[axis] * ANYWHERE / DISTANCE_SD
                }));
                columns.push(column);
                off.push(0.0);
            }
        }
    }
    let rows = columns.first().map_or(0, Vec::len);
    (DMatrix::from_fn(rows, columns.len(), |i, j| columns[j][i]), off)
}

/// What of it turns and shifts the robot: ∂coordinate/∂parameter, m per unit of SI. With z a joint's axis through o, x and y
/// the axes of the link behind it and p the ball: z × (p − o) of θ, z of d, x of a, x × (p − o′) of α, y × (p − o′) of β. That
/// torques change with the geometry is of second order.
pub fn of_robot(site: &Site) -> Vec<DVector<f64>> {
    let n = site.real.len();
    let of_rows: Vec<(Vec<Matrix4<f64>>, Vec<f64>, Vector3<f64>)> = (0..site.rows.len())
        .map(|row| {
            let (torques, frames) = site.loads(row);
            let at = site.ball(row, &site.rows[row].q, &[]);
            (frames, torques, at)
        })
        .collect();
    let column = |of: &dyn Fn(&[Matrix4<f64>], &[f64], &Vector3<f64>) -> Vector3<f64>| {
        let each = of_rows.iter().flat_map(|(frames, torques, at)| <[f64; 3]>::from(of(frames, torques, at)));
        DVector::from_iterator(3 * of_rows.len(), each)
    };
    let about = |axis: Vector3<f64>, frame: &Matrix4<f64>, at: &Vector3<f64>| {
        axis.cross(&(at - arm::column(frame, 3)))
    };
    let mut columns = Vec::new();
    for j in 0..n {
        let beta = site.real[j].numbers[4];
        // before the link was turned by β
        let x =
            |behind: &Matrix4<f64>| arm::column(behind, 0) * beta.cos() + arm::column(behind, 2) * beta.sin();
        columns.push(column(&|frames, _, at| lever(&frames[j], at)));
        columns.push(column(&|frames, _, _| arm::column(&frames[j], 2)));
        columns.push(column(&|frames, _, _| x(&frames[j + 1])));
        columns.push(column(&|frames, _, at| about(x(&frames[j + 1]), &frames[j + 1], at)));
        columns.push(column(&|frames, _, at| about(arm::column(&frames[j + 1], 1), &frames[j + 1], at)));
        if site.has_masses {
            columns.push(column(&|frames, torques, at| lever(&frames[j], at) * torques[j]));
        }
    }
    for axis in 0..3 {
        columns.push(column(&|_, _, _| Vector3::ith(axis, 1.0)));
        columns.push(column(&|frames, _, at| about(arm::column(&frames[0], axis), &frames[0], at)));
        columns.push(column(&|frames, _, _| arm::column(&frames[n], axis)));
    }
    columns
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::calibration::setup::{self, Needs};
    use rodcal_base::statistics::Random;

    const STEP: f64 = 1e-6;

    #[test]
    fn columns_are_what_a_slightly_different_robot_does() {
        let needs = Needs { masses: Some(true), rod: true, ..Needs::default() };
        let site = setup::draw(needs, &[], &mut Random::seeded(3, 0));
        let rest = |site: &Site| site.each(|row, q| site.ball(row, q, &[]));
        let at_rest = rest(&site);
        let columns = of_robot(&site);
        let near = |column: usize, change: &dyn Fn(&mut Site)| {
            let mut moved = site.clone();
            change(&mut moved);
            let numerical = (rest(&moved) - &at_rest) / STEP;
            // the rod bends a little otherwise, and so do the drives
            assert!((&columns[column] - &numerical).norm() < 0.01 * numerical.norm(), "{column}");
        };
        for joint in 0..6 {
            for number in 0..5 {
                near(6 * joint + number, &|site| site.real[joint].numbers[number] += STEP);
            }
            near(6 * joint + 5, &|site| site.real[joint].compliance += STEP);
        }
        for axis in 0..3 {
            let turn = Vector3::ith(axis, STEP);
            near(36 + 3 * axis, &|site| site.base[(axis, 3)] += STEP);
            near(37 + 3 * axis, &|site| site.base *= arm::frame(&Vector3::zeros(), &turn));
            near(38 + 3 * axis, &|site| site.tool[axis] += STEP);
        }
    }
}
