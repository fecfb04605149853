//! Vectors in space: the few operations that nalgebra has no short name for.

use nalgebra::{Matrix3, Rotation3, Vector3};

/// The cross-product matrix of `v`: `skew(v) * w = v × w`.
pub fn skew(v: &Vector3<f64>) -> Matrix3<f64> {
    Matrix3::new(0.0, -v.z, v.y, v.z, 0.0, -v.x, -v.y, v.x, 0.0)
}

/// `v × m`, column by column: `skew(v) * m` without the products with its zeros.
pub fn cross(v: &Vector3<f64>, m: &Matrix3<f64>) -> Matrix3<f64> {
    Matrix3::from_columns(&[v.cross(&m.column(0)), v.cross(&m.column(1)), v.cross(&m.column(2))])
}

/// A tensor given in a rotated frame, expressed in the frame it was rotated from: `R·T·Rᵀ`.
pub fn rotated(tensor: &Matrix3<f64>, rotation: &Rotation3<f64>) -> Matrix3<f64> {
    rotation.matrix() * tensor * rotation.matrix().transpose()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn skew_is_the_cross_product() {
        let (v, w) = (Vector3::new(1.0, -2.0, 3.0), Vector3::new(0.5, 4.0, -1.0));
        assert_eq!(skew(&v) * w, v.cross(&w));
        let m = Matrix3::new(0.5, 4.0, -1.0, 2.0, 0.25, 8.0, -3.0, 1.0, 5.0);
        assert_eq!(skew(&v) * m, cross(&v, &m));
    }

    #[test]
    fn a_rotated_axis_tensor_follows_its_axis() {
        let turn = Rotation3::from_axis_angle(&Vector3::y_axis(), 0.5);
        let along_z = Matrix3::from_diagonal(&Vector3::new(0.0, 0.0, 1.0));
        let axis = turn * Vector3::z();
        assert!((rotated(&along_z, &turn) - axis * axis.transpose()).norm() < 1e-15);
    }
}
