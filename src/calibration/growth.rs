//! What keeps a robot from shrinking where nothing but its angles is recorded.
//!
//! In a socket the ball is where it is but for some scatter, and angles are what is recorded. A
//! smaller robot with the same angles scatters less, so that the least squares lie at too small a
//! one, by the more of its standard uncertainty the more poses there are. The density of the angles
//! has the volume that they span besides,
//!
//! ```text
//! p(q | ρ) = Πᵢ p(tip(ρ, qᵢ) − s)·√|JᵢJᵢᵀ|      J = ∂tip/∂q
//! ```
//!
//! whose slope ∂(Σ ½·ln|JᵢJᵢᵀ|)/∂ρ holds against it.

use nalgebra::{Matrix3, Vector3};

use crate::robot::{Kinematics, Parameter, ParameterGroup, Setup};

/// Of a length, to differentiate by it, m.
const STEP: f64 = 1e-5;

/// ∂(Σ ½·ln|JᵢJᵢᵀ|)/∂ρ of the free parameters, 1/m, over poses of so many joints each, one after
/// the other; of what makes a robot larger, its lengths and its tip, and nothing for the others.
pub(crate) fn growth(setup: &Setup, free: &[Parameter], joints: &[f64], count: usize) -> Vec<f64> {
    let once = vec![1.0; count];
    let volume = |setup: &Setup| log_volume(setup, joints, &once);
    let slope = |parameter: Parameter| {
        let (mut more, mut less) = (setup.clone(), setup.clone());
        more.set(parameter, setup.get(parameter) + STEP);
        less.set(parameter, setup.get(parameter) - STEP);
        (volume(&more) - volume(&less)) / (2.0 * STEP)
    };
    let of_parameter = |&parameter: &Parameter| match parameter.group() {
        ParameterGroup::LinkLength | ParameterGroup::Tool => slope(parameter),
        ParameterGroup::BasePosition
        | ParameterGroup::BaseRotation
        | ParameterGroup::LinkTwist
        | ParameterGroup::JointZero
        | ParameterGroup::Compliance => 0.0,
    };
    free.iter().map(of_parameter).collect()
}

/// Σ ½·ln|JᵢJᵢᵀ| over poses, J of the angles as they were recorded: what each joint turns by is
/// `factor` times that.
pub(crate) fn log_volume(setup: &Setup, joints: &[f64], factor: &[f64]) -> f64 {
    let torque = vec![0.0; factor.len()];
    let mut kinematics = Kinematics::new(setup);
    let of_pose = |joints: &[f64]| {
        kinematics.update(joints, &torque);
        let columns =
            factor.iter().enumerate().map(|(j, by)| kinematics.column(Parameter::Theta(j), &torque) * *by);
        let add = |sum: Matrix3<f64>, own: Vector3<f64>| sum + own * own.transpose();
        let square = columns.fold(Matrix3::zeros(), add);
        0.5 * square.determinant().max(f64::MIN_POSITIVE).ln()
    };
    joints.chunks_exact(factor.len().max(1)).map(of_pose).sum()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::robot::Robot;
    use crate::spatial::Pose;

    /// An arm that is larger by a factor spans a volume that is larger by its cube.
    #[test]
    fn all_lengths_together_grow_by_three_per_pose() {
        let robot =
            Robot::from_text("tx90.toml", include_str!("../../robots/tx90.toml"), None, None).unwrap();
        let setup = Setup::new(&robot, Pose::IDENTITY, Vector3::new(0.02, -0.01, 0.3));
        let free: Vec<Parameter> = (0..6)
            .flat_map(|j| [Parameter::D(j), Parameter::A(j)])
            .chain((0..3).map(Parameter::Tool))
            .collect();
        let joints: Vec<f64> = (0..42).map(|k| (f64::from(k) * 1.7).sin()).collect();
        let slopes = growth(&setup, &free, &joints, 6);
        let together: f64 = slopes.iter().zip(&free).map(|(slope, &p)| slope * setup.get(p)).sum();
        assert!((together - 3.0 * 7.0).abs() < 1e-4, "{together}");
    }

    /// Angles of half the size span an eighth of the volume.
    #[test]
    fn a_factor_of_all_joints_counts_three_times() {
        let robot =
            Robot::from_text("tx90.toml", include_str!("../../robots/tx90.toml"), None, None).unwrap();
        let setup = Setup::new(&robot, Pose::IDENTITY, Vector3::new(0.02, -0.01, 0.3));
        let joints: Vec<f64> = (0..42).map(|k| (f64::from(k) * 1.7).sin()).collect();
        let [whole, half] = [1.0, 0.5].map(|factor| log_volume(&setup, &joints, &[factor; 6]));
        assert!((whole - half - 21.0 * 2f64.ln()).abs() < 1e-9, "{whole} {half}");
    }
}
