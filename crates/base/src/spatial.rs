//! Vectors, rotations and frames in space: the few operations that nalgebra has no short name for.

use std::fmt;

use nalgebra::{DMatrix, Matrix3, Rotation3, Vector3};

use crate::dual::Number;
use crate::error::Result;
use crate::linalg::thin_svd;

/// An axis of a frame.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, PartialOrd, Ord)]
#[allow(missing_docs, reason = "a frame has these three")]
pub enum Axis {
    X,
    Y,
    Z,
}

/// Along or against an axis.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub struct Direction {
    /// The axis.
    pub axis: Axis,
    /// +1 along, −1 against it.
    pub sign: i8,
}

/// A frame: rotation matrix and origin. Columns of the rotation are its axes in the frame it is
/// given in.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Pose {
    /// Axes of the frame, as columns.
    pub rotation: Matrix3<f64>,
    /// Origin, m.
    pub origin: Vector3<f64>,
}

impl Axis {
    /// X, Y, Z: by [`Axis::index`].
    pub const ALL: [Axis; 3] = [Axis::X, Axis::Y, Axis::Z];

    /// 0 for X, 1 for Y, 2 for Z.
    pub fn index(self) -> usize {
        self as usize
    }
}

impl Direction {
    /// Along the positive axis.
    pub fn along(axis: Axis) -> Direction {
        Direction { axis, sign: 1 }
    }

    /// Against it.
    pub fn against(axis: Axis) -> Direction {
        Direction { axis, sign: -1 }
    }

    /// `x`, `+y`, `-Z`; a Unicode minus is one too.
    pub fn from_name(name: &str) -> Option<Direction> {
        let (sign, axis) = match name.strip_prefix(['-', '\u{2212}']) {
            Some(axis) => (-1, axis),
            None => (1, name.strip_prefix('+').unwrap_or(name)),
        };
        let axis = Axis::ALL.into_iter().find(|known| known.to_string().eq_ignore_ascii_case(axis.trim()))?;
        Some(Direction { axis, sign })
    }
}

impl fmt::Display for Axis {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(["x", "y", "z"][self.index()])
    }
}

impl fmt::Display for Direction {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{}{}", if self.sign < 0 { "-" } else { "" }, self.axis)
    }
}

impl Pose {
    /// The frame itself.
    pub const IDENTITY: Pose = Pose {
        rotation: Matrix3::new(1.0, 0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 1.0),
        origin: Vector3::new(0.0, 0.0, 0.0),
    };

    /// From position (m) and `[roll, pitch, yaw]` (rad): Rz(yaw)·Ry(pitch)·Rx(roll), the URDF
    /// convention.
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
    #[inline]
    pub fn then(&self, next: &Pose) -> Pose {
        let columns = next.rotation.data.0.map(|column| times(&self.rotation, &column.into()));
        Pose { rotation: Matrix3::from_columns(&columns), origin: self.point(&next.origin) }
    }

    /// A point given in this frame, in the frame that this one is given in.
    #[inline]
    pub fn point(&self, p: &Vector3<f64>) -> Vector3<f64> {
        times(&self.rotation, p) + self.origin
    }

    /// The frame that this one is given in, in this one.
    pub fn inverse(&self) -> Pose {
        let rotation = self.rotation.transpose();
        Pose { rotation, origin: -(rotation * self.origin) }
    }
}

/// The motion that brings points `from` closest to as many points `to`, in the sense of least
/// squares: with the singular value decomposition U·S·Vᵀ of Σ (y − ȳ)(x − x̄)ᵀ its rotation is
/// U·diag(1, 1, ±1)·Vᵀ (W. Kabsch, *Acta Cryst.* A32 (1976) 922–923).
///
/// # Errors
/// As [`thin_svd`]: for points that are not finite.
pub fn best_motion(from: &[Vector3<f64>], to: &[Vector3<f64>]) -> Result<Pose> {
    let mean = |points: &[Vector3<f64>]| points.iter().sum::<Vector3<f64>>() / points.len().max(1) as f64;
    let (centre, goal) = (mean(from), mean(to));
    let spread: Matrix3<f64> = from.iter().zip(to).map(|(x, y)| (y - goal) * (x - centre).transpose()).sum();
    let svd = thin_svd(&DMatrix::from_column_slice(3, 3, spread.as_slice()))?;
    let (u, v) = (svd.u.fixed_view::<3, 3>(0, 0), svd.v.fixed_view::<3, 3>(0, 0));
    let handed = (u.determinant() * v.determinant()).signum();
    let rotation = u * Matrix3::from_diagonal(&Vector3::new(1.0, 1.0, handed)) * v.transpose();
    Ok(Pose { rotation, origin: goal - rotation * centre })
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

/// m·v in plain numbers: the general product of matrices takes ten times as long for three columns.
#[inline]
pub fn times(m: &Matrix3<f64>, v: &Vector3<f64>) -> Vector3<f64> {
    let [x, y, z] = m.data.0;
    Vector3::new(
        x[0] * v.x + y[0] * v.y + z[0] * v.z,
        x[1] * v.x + y[1] * v.y + z[1] * v.z,
        x[2] * v.x + y[2] * v.y + z[2] * v.z,
    )
}

/// R·Rz(angle), the angle given by its sine and cosine.
#[inline]
pub fn turned_about_z(r: &Matrix3<f64>, turn: (f64, f64)) -> Matrix3<f64> {
    with_turned_columns::<0, 1>(r, turn)
}

/// R·Rx(angle), the angle given by its sine and cosine.
#[inline]
pub fn turned_about_x(r: &Matrix3<f64>, turn: (f64, f64)) -> Matrix3<f64> {
    with_turned_columns::<1, 2>(r, turn)
}

/// R·Ry(angle), the angle given by its sine and cosine.
#[inline]
pub fn turned_about_y(r: &Matrix3<f64>, turn: (f64, f64)) -> Matrix3<f64> {
    with_turned_columns::<2, 0>(r, turn)
}

/// Column a·c + b·s in the place of a, and b·c − a·s in that of b: in plain numbers, for kinematics
/// do little else.
#[inline]
fn with_turned_columns<const A: usize, const B: usize>(r: &Matrix3<f64>, (s, c): (f64, f64)) -> Matrix3<f64> {
    let mut turned = *r;
    let (a, b) = (r.data.0[A], r.data.0[B]);
    for k in 0..3 {
        turned.data.0[A][k] = a[k] * c + b[k] * s;
        turned.data.0[B][k] = b[k] * c - a[k] * s;
    }
    turned
}

/// The cross-product matrix of `v`: `skew(v) * w = v × w`.
pub fn skew<T: Number>(v: &Vector3<T>) -> Matrix3<T> {
    let zero = T::zero();
    Matrix3::new(zero, -v.z, v.y, v.z, zero, -v.x, -v.y, v.x, zero)
}

/// `v × m`, column by column: `skew(v) * m` without the products with its zeros.
pub fn cross<T: Number>(v: &Vector3<T>, m: &Matrix3<T>) -> Matrix3<T> {
    Matrix3::from_columns(&[v.cross(&m.column(0)), v.cross(&m.column(1)), v.cross(&m.column(2))])
}

/// A tensor given in a rotated frame, expressed in the frame it was rotated from: `R·T·Rᵀ`.
pub fn rotated<T: Number>(tensor: &Matrix3<T>, rotation: &Rotation3<T>) -> Matrix3<T> {
    product(&product(rotation.matrix(), tensor), &rotation.matrix().transpose())
}

/// `a·b` written out: in loops over very many small matrices that is five times as fast, and the
/// same to the last bit.
#[inline]
pub fn product<T: Number>(a: &Matrix3<T>, b: &Matrix3<T>) -> Matrix3<T> {
    let column = |j: usize| {
        let (x, y, z) = (b[(0, j)], b[(1, j)], b[(2, j)]);
        Vector3::new(
            a[(0, 0)] * x + a[(0, 1)] * y + a[(0, 2)] * z,
            a[(1, 0)] * x + a[(1, 1)] * y + a[(1, 2)] * z,
            a[(2, 0)] * x + a[(2, 1)] * y + a[(2, 2)] * z,
        )
    };
    Matrix3::from_columns(&[column(0), column(1), column(2)])
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
        let other = Matrix3::new(1.5, -0.1, 0.3, 2.7, 0.9, 1.0, -1.1, 0.7, 0.2);
        assert_eq!(product(&m, &other), m * other);
    }

    #[test]
    fn points_are_brought_back_to_where_they_were() {
        let turn = Pose::from_xyz_rpy([0.3, -0.2, 1.0], [2.5, -0.4, 1.2]);
        // in one plane, where a reflection would do as well
        let points = [[0.0, 0.0], [1.0, 0.2], [-0.4, 0.7], [0.3, -1.0]].map(|[x, y]| Vector3::new(x, y, 0.5));
        let moved = points.map(|p| turn.point(&p));
        let motion = best_motion(&points, &moved).unwrap();
        assert!(
            (motion.rotation - turn.rotation).norm() < 1e-14 && (motion.origin - turn.origin).norm() < 1e-14
        );
        assert!(best_motion(&[Vector3::repeat(f64::NAN); 3], &points[..3]).is_err());
    }

    #[test]
    fn a_rotated_axis_tensor_follows_its_axis() {
        let turn = Rotation3::from_axis_angle(&Vector3::y_axis(), 0.5);
        let along_z = Matrix3::from_diagonal(&Vector3::new(0.0, 0.0, 1.0));
        let axis = turn * Vector3::z();
        assert!((rotated(&along_z, &turn) - axis * axis.transpose()).norm() < 1e-15);
    }
}
