//! What a rotation or a frame may mean that was given in another convention.

use nalgebra::{Matrix3, Vector3};

use crate::spatial::{Pose, exponential};
use crate::units::DEG;

/// Angles in radians are no larger than a turn and some play, in what should be degrees.
pub(super) const TURN_IN_RADIANS: f64 = 6.6;
/// Two frames that differ by less, rad and m, are one.
pub(super) const SAME: (f64, f64) = (1.0 * DEG, 1e-3);

/// How a rotation was given instead of as roll, pitch and yaw.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Convention {
    cure: &'static str,
    pub why: &'static str,
}

impl Convention {
    pub fn cure(&self, key: &str) -> String {
        self.cure.replace("{}", key)
    }
}

/// What three angles (rad) mean in other conventions, as far as that is another rotation.
pub(super) fn readings(angles: [f64; 3], as_read: &Matrix3<f64>) -> Vec<(Matrix3<f64>, Convention)> {
    let [a, b, c] = angles;
    let rpy = |r: f64, p: f64, y: f64| Pose::from_xyz_rpy([0.0; 3], [r, p, y]).rotation;
    let mut all = vec![
        (
            rpy(c, b, a),
            Convention { cure: "Turn the order of {} round", why: "it is given as yaw, pitch, roll" },
        ),
        (
            rpy(-a, -b, -c).transpose(),
            Convention {
                cure: "Convert {} to Rz(yaw)·Ry(pitch)·Rx(roll)",
                why: "its angles turn about x, y and z in the other order, Rx·Ry·Rz",
            },
        ),
        (
            as_read.transpose(),
            Convention { cure: "Invert the rotation of {}", why: "it is given the other way round" },
        ),
        (
            exponential(&Vector3::new(a, b, c)),
            Convention { cure: "Convert {} from a rotation vector", why: "it holds a rotation vector" },
        ),
    ];
    if angles.iter().all(|angle| angle.abs() / DEG < TURN_IN_RADIANS) {
        let [a, b, c] = angles.map(|angle| angle / DEG);
        let why = "it is in radians, not in degrees";
        all.push((rpy(a, b, c), Convention { cure: "Multiply {} by 180/π", why }));
    }
    let mut others: Vec<(Matrix3<f64>, Convention)> = Vec::new();
    for (rotation, convention) in all {
        let differs = |known: &Matrix3<f64>| turn(known, &rotation) > SAME.0;
        if differs(as_read) && others.iter().all(|(known, _)| differs(known)) {
            others.push((rotation, convention));
        }
    }
    others
}

/// Angle between two rotations, rad.
pub fn turn(a: &Matrix3<f64>, b: &Matrix3<f64>) -> f64 {
    // accurate for small angles too: |A − B| = 2√2·sin(φ/2)
    2.0 * ((a - b).norm() / 8.0f64.sqrt()).clamp(0.0, 1.0).asin()
}

pub(super) fn is_same(a: &Pose, b: &Pose) -> bool {
    turn(&a.rotation, &b.rotation) < SAME.0 && (a.origin - b.origin).norm() < SAME.1
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn turns_about_moved_axes_are_the_other_order() {
        let [a, b, c] = [0.3, -0.4, 1.1];
        let x = Pose::from_xyz_rpy([0.0; 3], [a, 0.0, 0.0]).rotation;
        let y = Pose::from_xyz_rpy([0.0; 3], [0.0, b, 0.0]).rotation;
        let z = Pose::from_xyz_rpy([0.0; 3], [0.0, 0.0, c]).rotation;
        let as_read = z * y * x;
        let all = readings([a, b, c], &as_read);
        assert!(all.iter().any(|(rotation, _)| (rotation - x * y * z).norm() < 1e-12));
        assert!(all.iter().any(|(rotation, _)| (rotation - as_read.transpose()).norm() < 1e-12));
    }

    #[test]
    fn the_angle_between_rotations_is_that_of_the_turn_between_them() {
        for angle in [1e-6, 0.3, 3.0] {
            let turned = exponential(&(Vector3::new(1.0, 2.0, -2.0) / 3.0 * angle));
            assert!((turn(&Matrix3::identity(), &turned) - angle).abs() < 1e-9, "{angle}");
        }
    }
}
