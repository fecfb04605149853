//! Where loads pull to and sensors look: axes that are turned.

use nalgebra::{Rotation3, Unit, Vector3};

use super::effect::Effect;
use super::protocol::Loading;

/// Where a load pulls to.
pub fn direction(effects: &[Effect], loading: &Loading) -> Vector3<f64> {
    let mut direction = Vector3::ith(loading.axis, loading.sign);
    for effect in effects {
        match *effect {
            Effect::LoadMisalignment { axis, towards, angle, frame } if frame || axis == loading.axis => {
                direction = turn(axis, towards, angle) * direction;
            }
            Effect::LoadFrame(turn) => direction = rotation(turn) * direction,
            _ => {}
        }
    }
    direction
}

/// About a vector by its length, rad.
pub fn rotation(turn: [f64; 3]) -> Rotation3<f64> {
    Rotation3::from_scaled_axis(Vector3::from(turn))
}

/// By `angle` from one axis towards another one.
pub fn turn(from: usize, towards: usize, angle: f64) -> Rotation3<f64> {
    let about = Vector3::ith(from, 1.0).cross(&Vector3::ith(towards, 1.0));
    Rotation3::from_axis_angle(&Unit::new_normalize(about), angle)
}
