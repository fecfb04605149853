//! How compliant drives are, before anybody measures them.
//!
//! A gear turns by some 1.5 mrad under the torque that it is rated for, whatever its size:
//! strain-wave gears of industrial arms by 1.4 to 2 (catalogue stiffnesses of sizes 14 to 40, 3.4
//! to 100 kN·m/rad, at 5.4 to 137 N·m), cycloidal ones by 1. What a drive carries is the least that
//! it is rated for, and a drive nearer to the base is no weaker than those beyond it. So a
//! compliance is half-normal: never negative, and hardly more than three times
//!
//! ```text
//! 1.5 mrad / max(5 N·m, the largest torque of gravity on any joint from j on)
//! ```
//!
//! which is 900 µrad/(N·m) in a wrist: bearings, couplings and the links between give way as well.

use super::compensation::largest_torques;
use crate::least_squares::Prior;
use crate::robot::{Body, Parameter, Setup};

/// Angle by which a gear turns under the torque that it is rated for, rad.
const AT_RATED_TORQUE: f64 = 1.5e-3;
/// Torque that the smallest gears of industrial arms are rated for, N·m.
const LEAST_RATED: f64 = 5.0;

/// How many times more compliant than its gear a drive may be.
pub(crate) const SOFTEST: f64 = 3.0;

/// Standard deviation of the compliance of every joint, rad/(N·m); what is beyond is no drive.
pub(crate) fn plausible_compliances(setup: &Setup, payload: Option<Body>) -> Vec<f64> {
    let payload = payload.unwrap_or(Body { mass: 0.0, centre: setup.tool });
    let mut rated = LEAST_RATED;
    let mut plausible: Vec<f64> = largest_torques(setup.robot, setup, payload)
        .into_iter()
        .rev()
        .map(|torque| {
            rated = rated.max(torque);
            SOFTEST * AT_RATED_TORQUE / rated
        })
        .collect();
    plausible.reverse();
    plausible
}

/// What is known of the compliances among the free parameters, about the values of the robot file;
/// not of `stated` ones, for which there is a prior of the user's.
pub(super) fn priors(
    nominal: &Setup,
    free: &[Parameter],
    stated: &[Parameter],
    payload: Option<Body>,
) -> Vec<Prior> {
    let drives = free.iter().enumerate().filter_map(|(index, p)| Some((index, *p, p.compliant_joint()?)));
    let mut unstated = drives.filter(|(_, parameter, _)| !stated.contains(parameter)).peekable();
    if unstated.peek().is_none() {
        return Vec::new();
    }
    let plausible = plausible_compliances(nominal, payload);
    let prior = |(index, parameter, joint): (usize, Parameter, usize)| Prior {
        parameter: index,
        value: nominal.get(parameter),
        sd: plausible[joint],
    };
    unstated.map(prior).collect()
}

/// No drive turns against its load; what a file says already may stay.
pub(crate) fn least_value(setup: &Setup, parameter: Parameter) -> f64 {
    match parameter.compliant_joint() {
        Some(_) => setup.get(parameter).min(0.0),
        None => f64::NEG_INFINITY,
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::robot::Robot;
    use crate::spatial::Pose;
    use nalgebra::Vector3;

    #[test]
    fn a_drive_is_no_weaker_than_those_beyond_it() {
        let (file, text) = Robot::builtin("tx90").unwrap();
        let robot = Robot::from_text(file, text, None, None).unwrap();
        let setup = Setup::new(&robot, Pose::IDENTITY, Vector3::new(0.525, 0.0, 0.15));
        let plausible = plausible_compliances(&setup, Some(Body { mass: 1.0, centre: Vector3::z() * 0.2 }));
        assert!(plausible.windows(2).all(|pair| pair[0] <= pair[1]), "{plausible:?}");
        // 200 to 300 N·m on joint 2; a wrist carries less than its smallest gear is rated for
        assert!(plausible[1] > 12e-6 && plausible[1] < 24e-6, "{plausible:?}");
        assert!((plausible[5] - 900e-6).abs() < 1e-9, "{plausible:?}");
    }
}
