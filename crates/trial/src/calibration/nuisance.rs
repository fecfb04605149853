//! All that a calibration can take up: geometry, base, tool, drives where masses are known, places
//! of sockets, and the numbers of the files.

use nalgebra::{DMatrix, DVector};

use super::numbers::{drives, numbers};
use super::site::{Devices, Row, Site};
use rodcal_base::units::UM;

/// Standard deviation of the stated distance between two sockets, m.
pub const DISTANCE_SD: f64 = 10.0 * UM;
/// Of the place of a socket, m.
const ANYWHERE: f64 = 0.1;

/// What a standard uncertainty of each number does to every coordinate, in noises that know nothing
/// of each other, and to the distances between sockets behind them; and by how many of them the
/// file is off.
pub fn columns(site: &Site) -> (DMatrix<f64>, Vec<f64>) {
    let numbers = numbers(site, &drives(site));
    let mut off: Vec<f64> = numbers.iter().map(|number| number.off).collect();
    let mut columns: Vec<Vec<f64>> =
        numbers.iter().map(|number| site.whitened(&number.column).as_slice().to_vec()).collect();
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
                let mut column = site.whitened(&column).as_slice().to_vec();
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
