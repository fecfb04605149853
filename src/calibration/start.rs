//! The rough start: base and tool from linear equations, with the nominal robot.
//!
//! xᵢ = R_b·(Rᵢ·t + oᵢ) + p_b with the nominal flange frames (Rᵢ, oᵢ) in {0}. For a given tool t
//! the best base is Kabsch's rotation between two clouds of points; for a given base the tool is a
//! linear least-squares problem. Both in turn, from the user's guess and from a few others, find
//! the base from anywhere.

use nalgebra::Vector3;

use super::campaign::{Campaign, Recording, Targets};
use crate::error::Result;
use crate::robot::Robot;
use crate::spatial::{Pose, best_motion};

/// Most turns of alternation.
const TURNS: usize = 50;
/// Gain of a turn, relative to the misfit, below which more are not worth their while: the fit that
/// follows is better at it.
const GAIN: f64 = 0.05;
/// Misfit of a pose below which the start is good, m: a robot as built, not a wrong turn.
const GOOD: f64 = 0.01;
/// Poses that take part: a few hundred fix nine numbers.
const MOST_POSES: usize = 300;

/// Base and tool that fit the recording best, starting from those given; as they are for sockets,
/// which know no {W}.
///
/// # Errors
/// As [`thin_svd`]; none in practice.
pub(super) fn rough_start(
    robot: &Robot,
    recording: &Recording,
    base: Pose,
    tool: Vector3<f64>,
) -> Result<(Pose, Vector3<f64>)> {
    let Targets::Points(points) = &recording.targets else { return Ok((base, tool)) };
    let step = recording.len().div_ceil(MOST_POSES).max(1);
    let rows: Vec<usize> = (0..recording.len()).step_by(step).collect();
    let flanges: Vec<Pose> = rows.iter().map(|&row| robot.flange_at(recording.joints(row))).collect();
    let points: Vec<Vector3<f64>> = rows.iter().map(|&row| points[row]).collect();
    let size = Vector3::repeat(0.1);
    let guesses =
        [tool, Vector3::zeros(), size.component_mul(&Vector3::x()), size.component_mul(&Vector3::z())];
    let mut best = (base, tool);
    let mut least = misfit(&flanges, &points, &base, &tool);
    let good = GOOD * GOOD * points.len() as f64;
    for guess in guesses {
        if least < good {
            break;
        }
        let mut tool = guess;
        let mut before = f64::INFINITY;
        for _ in 0..TURNS {
            let tips: Vec<Vector3<f64>> = flanges.iter().map(|flange| flange.point(&tool)).collect();
            let base = best_motion(&tips, &points)?;
            tool = best_tool(&flanges, &points, &base, &tool);
            let misfit = misfit(&flanges, &points, &base, &tool);
            if misfit < least {
                (best, least) = ((base, tool), misfit);
            }
            if misfit > (1.0 - GAIN) * before {
                break;
            }
            before = misfit;
        }
    }
    Ok(best)
}

/// First guess of base and tool of a campaign.
pub(super) fn first_guess(campaign: &Campaign) -> (Pose, Vector3<f64>) {
    let [x, y, z, roll, pitch, yaw] = campaign.base;
    (Pose::from_xyz_rpy([x, y, z], [roll, pitch, yaw]), campaign.tool)
}

fn misfit(flanges: &[Pose], points: &[Vector3<f64>], base: &Pose, tool: &Vector3<f64>) -> f64 {
    let pairs = flanges.iter().zip(points);
    pairs.map(|(flange, x)| (base.point(&flange.point(tool)) - x).norm_squared()).sum()
}

/// Σ (R_b·Rᵢ)ᵀ(xᵢ − p_b − R_b·oᵢ)/n: the normal equations of the tool have the identity as their
/// matrix.
fn best_tool(flanges: &[Pose], points: &[Vector3<f64>], base: &Pose, tool: &Vector3<f64>) -> Vector3<f64> {
    let pairs = flanges.iter().zip(points);
    let sum: Vector3<f64> = pairs
        .map(|(flange, x)| {
            let frame = base.then(flange);
            frame.rotation.tr_mul(&(x - frame.point(tool)))
        })
        .sum();
    tool + sum / flanges.len().max(1) as f64
}
