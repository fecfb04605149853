//! Where the joints and the flange are for given joint values.

use super::{Hayati, Motion, Robot};
use crate::spatial::{Pose, turned_about_x, turned_about_y, turned_about_z};

impl Hayati {
    /// `frame` after Rz(θ)·Tz(d)·Tx(a)·Rx(α)·Ry(β).
    pub fn beyond(&self, frame: &Pose) -> Pose {
        let turned = turned_about_z(&frame.rotation, self.theta);
        let origin = frame.origin + turned.column(2) * self.d + turned.column(0) * self.a;
        Pose { rotation: turned_about_y(&turned_about_x(&turned, self.alpha), self.beta), origin }
    }

    /// With joint value `q` (rad or m) added where the joint moves.
    pub fn moved(&self, motion: Motion, q: f64) -> Hayati {
        match motion {
            Motion::Revolute => Hayati { theta: self.theta + q, ..*self },
            Motion::Prismatic => Hayati { d: self.d + q, ..*self },
        }
    }
}

impl Robot {
    /// {T} in {0} at the joint values `q` (rad or m, one per joint), with no torque on the joints.
    pub fn flange_at(&self, q: &[f64]) -> Pose {
        let moved = self.joints.iter().zip(q).map(|(joint, &q)| joint.link.moved(joint.motion, q));
        moved.fold(self.root, |frame, link| link.beyond(&frame)).then(&self.flange)
    }
}
