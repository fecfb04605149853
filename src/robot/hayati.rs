//! From axes in space to the five numbers of a Hayati link.
//!
//! Given are the frame J of a joint, with its z along the joint's axis, and the next joint's axis:
//! a point p and a unit vector w, both in the frame that J is given in. Wanted are θ, d, a, α, β of
//! `J′ = J·Rz(θ)·Tz(d)·Tx(a)·Rx(α)·Ry(β)` such that the z axis of J′ lies along the next axis. That
//! is four conditions on five numbers, so one of them is 0 by convention:
//!
//! - Axes that are not nearly parallel have a common normal, n = z × w. Then β = 0 (Denavit,
//!   Hartenberg 1955), `d = (n×w)·(p−o) / (n×w)·z` reaches its foot on the joint's axis,
//!   `a = n·(p−o)/|n|` is its length, and α = ∠(z, w) about n.
//! - Of nearly parallel axes, |sin α| < sin 10°, the common normal runs away with the smallest
//!   tilt. Then d = 0 (Hayati 1983): J′ has its origin where the next axis passes the x–y plane of
//!   J. a is how far off that is, θ in which direction; and from
//!   `w = Rx(α)·Ry(β)·e_z = (sin β, −sin α cos β, cos α cos β)` in the turned frame,
//!   `β = asin w_x`, `α = atan2(−w_y, w_z)`. Axes that coincide keep the x of J: θ = 0.
//!
//! Either way there are two solutions, θ and θ + 180°. That one is taken that has θ within ±90°.

use nalgebra::Vector3;

use super::Hayati;
use crate::spatial::{Pose, turned_about_z};

/// sin 10°: below that axes count as nearly parallel.
const NEARLY_PARALLEL: f64 = 0.17364817766693033;

/// Axes that are closer than this coincide, m: no machine is as exact, and rounding is.
const COINCIDENT: f64 = 1e-13;

/// The link from `joint`, whose z is its axis, to a frame whose z lies along `axis` (a unit vector)
/// through `point`.
pub(super) fn link_to(joint: &Pose, point: &Vector3<f64>, axis: &Vector3<f64>) -> Hayati {
    // the next axis in the frame of the joint, where z is (0, 0, 1)
    let inverse = joint.inverse();
    let (p, w) = (inverse.point(point), inverse.rotation * axis);
    let normal = Vector3::z().cross(&w);
    match normal.norm() < NEARLY_PARALLEL {
        true => parallel(&p, &w),
        false => skew(&p, &w, &normal),
    }
}

fn skew(p: &Vector3<f64>, w: &Vector3<f64>, normal: &Vector3<f64>) -> Hayati {
    let x = forwards(normal.normalize());
    let across = x.cross(w);
    Hayati {
        theta: x.y.atan2(x.x),
        d: across.dot(p) / across.z,
        a: x.dot(p),
        alpha: Vector3::z().cross(w).dot(&x).atan2(w.z),
        beta: 0.0,
    }
}

fn parallel(p: &Vector3<f64>, w: &Vector3<f64>) -> Hayati {
    let foot = p - w * (p.z / w.z);
    let distance = foot.x.hypot(foot.y);
    let x = match distance > COINCIDENT {
        true => forwards(Vector3::new(foot.x / distance, foot.y / distance, 0.0)),
        false => Vector3::x(),
    };
    let theta = x.y.atan2(x.x);
    let turned = turned_about_z(&nalgebra::Matrix3::identity(), theta.sin_cos()).transpose() * w;
    Hayati {
        theta,
        d: 0.0,
        a: x.dot(&foot),
        alpha: (-turned.y).atan2(turned.z),
        beta: turned.x.clamp(-1.0, 1.0).asin(),
    }
}

/// Whichever of x and −x lies within ±90° of (1, 0, 0); at ±90°, where rounding decides, +90°.
fn forwards(x: Vector3<f64>) -> Vector3<f64> {
    const TIE: f64 = 1e-9;
    if x.x < -TIE || (x.x < TIE && x.y < 0.0) { -x } else { x }
}
