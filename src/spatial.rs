//! Vectors, rotations and frames in space: the few operations that nalgebra has no short name for.

use nalgebra::{Matrix3, Rotation3, Vector3};

/// A frame: rotation matrix and origin. Columns of the rotation are its axes in the frame it is given in.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Pose {
    /// Axes of the frame, as columns.
    pub rotation: Matrix3<f64>,
    /// Origin, m.
    pub origin: Vector3<f64>,
}

impl Pose {
    /// The frame itself.
    pub const IDENTITY: Pose = Pose {
        rotation: Matrix3::new(1.0, 0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 1.0),
        origin: Vector3::new(0.0, 0.0, 0.0),
    };

    /// From position (m) and `[roll, pitch, yaw]` (rad): Rz(yaw)·Ry(pitch)·Rx(roll), the URDF convention.
    pub fn from_xyz_rpy(xyz: [f64; 3], rpy: [f64; 3]) -> Self {
        let [r, p, y] = rpy;
        let yawed = turned_about_z(&Matrix3::identity(), y.sin_cos());
        let rotation = turned_about_x(&turned_about_y(&yawed, p.sin_cos()), r.sin_cos());
        Pose { rotation, origin: Vector3::from(xyz) }
    }

    /// `[roll, pitch, yaw]` with R = Rz(yaw)·Ry(pitch)·Rx(roll), rad, pitch within ±π/2.
    pub fn roll_pitch_yaw(&self) -> [f64; 3] {
        let r = &self.rotation;
        let pitch = (-r[(2, 0)]).atan2(r[(2, 1)].hypot(r[(2, 2)]));
        [r[(2, 1)].atan2(r[(2, 2)]), pitch, r[(1, 0)].atan2(r[(0, 0)])]
    }

    /// This frame followed by `next`, which is given in it.
    pub fn then(&self, next: &Pose) -> Pose {
        Pose { rotation: self.rotation * next.rotation, origin: self.point(&next.origin) }
    }

    /// A point given in this frame, in the frame that this one is given in.
    pub fn point(&self, p: &Vector3<f64>) -> Vector3<f64> {
        self.rotation * p + self.origin
    }

    /// The frame that this one is given in, in this one.
    pub fn inverse(&self) -> Pose {
        let rotation = self.rotation.transpose();
        Pose { rotation, origin: -(rotation * self.origin) }
    }
}

/// `exp([v]×)`: the rotation about `v` by its length (Rodrigues).
pub fn exponential(v: &Vector3<f64>) -> Matrix3<f64> {
    Rotation3::new(*v).into_inner()
}

/// Jₗ with `exp([v + δ]×) = exp([Jₗ·δ]×)·exp([v]×)` for small δ:
///
/// `Jₗ = (sin φ/φ)·1 + ((1 − cos φ)/φ²)·[v]× + ((φ − sin φ)/φ³)·v·vᵀ, φ = |v|`
/// (T. Barfoot, *State Estimation for Robotics*, Eq 7.77).
pub fn left_jacobian(v: &Vector3<f64>) -> Matrix3<f64> {
    let phi = v.norm();
    let square = phi * phi;
    let (a, b, c) = if phi < 1e-3 {
        (1.0 - square / 6.0, 0.5 - square / 24.0, 1.0 / 6.0 - square / 120.0)
    } else {
        (phi.sin() / phi, (1.0 - phi.cos()) / square, (phi - phi.sin()) / (square * phi))
    };
    Matrix3::identity() * a + skew(v) * b + v * v.transpose() * c
}

/// R·Rz(angle), the angle given by its sine and cosine.
pub fn turned_about_z(r: &Matrix3<f64>, (s, c): (f64, f64)) -> Matrix3<f64> {
    let (x, y) = (r.column(0), r.column(1));
    Matrix3::from_columns(&[x * c + y * s, y * c - x * s, r.column(2).into()])
}

/// R·Rx(angle), the angle given by its sine and cosine.
pub fn turned_about_x(r: &Matrix3<f64>, (s, c): (f64, f64)) -> Matrix3<f64> {
    let (y, z) = (r.column(1), r.column(2));
    Matrix3::from_columns(&[r.column(0).into(), y * c + z * s, z * c - y * s])
}

/// R·Ry(angle), the angle given by its sine and cosine.
pub fn turned_about_y(r: &Matrix3<f64>, (s, c): (f64, f64)) -> Matrix3<f64> {
    let (z, x) = (r.column(2), r.column(0));
    Matrix3::from_columns(&[x * c - z * s, r.column(1).into(), z * c + x * s])
}

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
