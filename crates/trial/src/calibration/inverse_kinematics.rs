//! Joint angles that bring the ball to a point.

use nalgebra::{Matrix3, Vector3};

use super::arm;
use super::effect::Effect;
use super::site::{Site, tip_jacobian};

impl Site {
    /// Turns the joints of a row, as little as may be, until the ball is at a point; `None` where
    /// it does not get there.
    pub fn joints_at(
        &self,
        row: usize,
        q: &[f64],
        target: &Vector3<f64>,
        effects: &[Effect],
    ) -> Option<Vec<f64>> {
        let mut q = q.to_vec();
        for _ in 0..40 {
            let at = self.ball(row, &q, effects);
            let off = target - at;
            if off.norm() < 1e-10 {
                return Some(q);
            }
            // what joints do by their loads and gears is too little to lead astray
            let frames = arm::frames(&self.real, &self.base, &q);
            let jacobian: Vec<Vector3<f64>> =
                frames[..q.len()].iter().map(|joint| tip_jacobian(joint, &at)).collect();
            let square: Matrix3<f64> = jacobian.iter().map(|column| column * column.transpose()).sum();
            let stride = off * (0.4 / off.norm()).min(1.0);
            let solved = (square + Matrix3::identity() * 1e-9).cholesky()?.solve(&stride);
            for (q, column) in q.iter_mut().zip(&jacobian) {
                *q += column.dot(&solved).clamp(-0.5, 0.5);
            }
        }
        None
    }
}
