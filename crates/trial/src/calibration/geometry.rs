//! What a slightly different robot does to every coordinate, in closed form.

use nalgebra::{DVector, Matrix4, Vector3};

use super::arm;
use super::site::{Site, tip_jacobian};

/// A row as the robot stands there: frames, torques N·m, and the ball.
struct Configuration {
    frames: Vec<Matrix4<f64>>,
    torques: Vec<f64>,
    at: Vector3<f64>,
}

impl Configuration {
    /// How the ball moves with a turn about an axis through the origin of a frame, m/rad.
    fn about(&self, axis: Vector3<f64>, frame: &Matrix4<f64>) -> Vector3<f64> {
        axis.cross(&(self.at - arm::column(frame, 3)))
    }
}

/// Of geometry, drives, base and tool: ∂coordinate/∂parameter, m per unit of SI. With z a joint's
/// axis through o, x and y the axes of the link behind it and p the ball: z × (p − o) of θ, z of d,
/// x of a, x × (p − o′) of α, y × (p − o′) of β. That torques change with the geometry is of second
/// order.
pub fn of_robot(site: &Site) -> Vec<DVector<f64>> {
    let n = site.real.len();
    let configuration = |row: usize| {
        let (torques, frames) = site.loads(row);
        Configuration { frames, torques, at: site.ball(row, &site.rows[row].q, &[]) }
    };
    let configurations: Vec<Configuration> = (0..site.rows.len()).map(configuration).collect();
    let column = |displacement: &dyn Fn(&Configuration) -> Vector3<f64>| {
        let each = configurations.iter().flat_map(|there| <[f64; 3]>::from(displacement(there)));
        DVector::from_iterator(3 * configurations.len(), each)
    };
    let mut columns = Vec::new();
    for j in 0..n {
        let beta = site.real[j].numbers[4];
        // before the link was turned by β
        let x =
            |behind: &Matrix4<f64>| arm::column(behind, 0) * beta.cos() + arm::column(behind, 2) * beta.sin();
        let behind = |there: &Configuration| there.frames[j + 1];
        columns.push(column(&|there| tip_jacobian(&there.frames[j], &there.at)));
        columns.push(column(&|there| arm::column(&there.frames[j], 2)));
        columns.push(column(&|there| x(&behind(there))));
        columns.push(column(&|there| there.about(x(&behind(there)), &behind(there))));
        columns.push(column(&|there| there.about(arm::column(&behind(there), 1), &behind(there))));
        if site.has_masses {
            columns.push(column(&|there| tip_jacobian(&there.frames[j], &there.at) * there.torques[j]));
        }
    }
    for axis in 0..3 {
        columns.push(column(&|_| Vector3::ith(axis, 1.0)));
        columns.push(column(&|there| there.about(arm::column(&there.frames[0], axis), &there.frames[0])));
        columns.push(column(&|there| arm::column(&there.frames[n], axis)));
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
