//! The reader of URDFs: the joints between two links become a chain of Hayati links.
//!
//! In a URDF a joint's frame is anywhere along its axis, turned anyhow; a fixed joint may stand
//! between two that move. All frames are taken at zero. The joint's frame in the chain has z along
//! its axis **as the URDF signs it**, so that joint values mean the same in both; [`super::hayati`]
//! finds θ, d, a, α, β from one axis to the next. The first joint's frame goes to [`Robot::root`].
//! The last joint's link is zero, and [`Robot::flange`] leads on to `tip_link`.
//!
//! A body is whatever moves with a joint and not with the next one: the joint's link, links fixed
//! to it and side branches, the joints of which are taken to stand at zero. What is fixed to
//! `base_link` has no torque on any joint.

mod tree;
mod write;
mod xml;

pub use write::Written;

use nalgebra::Vector3;

use self::tree::{Kind, Tree};
use self::xml::Source;
use super::defaults::{DOWN, file_stem};
use super::{Body, Hayati, Joint, Motion, Robot, StandardUncertainty, hayati};
use crate::error::Result;
use crate::limits;
use crate::spatial::Pose;

/// Links that are taken where no others are named.
const BASE_LINK: &str = "base_link";
const TIP_LINK: &str = "tip_link";

pub(super) fn read(file: &str, text: &str, base_link: Option<&str>, tip_link: Option<&str>) -> Result<Robot> {
    let source = Source { file, text };
    let document = source.parse()?;
    let tree = Tree::read(source, &document)?;
    let path = tree.path(base_link.unwrap_or(BASE_LINK), tip_link.unwrap_or(TIP_LINK))?;
    let moving = path.iter().filter(|&&joint| matches!(tree.joints[joint].kind, Kind::Moving(..))).count();
    limits::check(file, moving, limits::ROBOT_JOINTS, "moving joints from base_link to tip_link")?;
    let zero = Zero::new(&tree, &path);

    let (root, links) = zero.chain();
    let mut distal = root;
    let mut joints = Vec::new();
    for (index, (moving, link)) in zero.moving.iter().zip(links).enumerate() {
        distal = link.beyond(&distal);
        let next = zero.moving.get(index + 1).map(|next| next.joint);
        let joint = &tree.joints[moving.joint];
        joints.push(Joint {
            name: joint.name.clone(),
            motion: moving.motion,
            link,
            compliance: 0.0,
            body: body(&tree, moving, next, &distal),
            limits: joint.limits,
        });
    }
    Ok(Robot {
        name: tree.name.clone().filter(|name| !name.trim().is_empty()).unwrap_or_else(|| file_stem(file)),
        source: None,
        gravity: DOWN,
        root,
        joints,
        flange: distal.inverse().then(&zero.tip),
        effects: Vec::new(),
        laws: Vec::new(),
        tip: None,
        standard_uncertainty: StandardUncertainty::default(),
        uncertainty: None,
        calibrated: None,
    })
}

/// Where everything on the path is in `base_link`, all joints at zero.
struct Zero {
    moving: Vec<Moving>,
    tip: Pose,
}

/// A joint that moves.
struct Moving {
    /// Index in the tree.
    joint: usize,
    motion: Motion,
    /// Frame of its child.
    frame: Pose,
    /// Its axis in that frame.
    axis: Vector3<f64>,
}

impl Zero {
    fn new(tree: &Tree, path: &[usize]) -> Zero {
        let mut zero = Zero { moving: vec![], tip: Pose::IDENTITY };
        for &joint in path {
            zero.tip = zero.tip.then(&tree.joints[joint].origin);
            if let Kind::Moving(motion, axis) = tree.joints[joint].kind {
                zero.moving.push(Moving { joint, motion, frame: zero.tip, axis });
            }
        }
        zero
    }

    /// The first joint's frame and every joint's link.
    fn chain(&self) -> (Pose, Vec<Hayati>) {
        let root = self.moving.first().map_or(Pose::IDENTITY, Moving::along_axis);
        let mut links = Vec::new();
        let mut frame = root;
        for next in self.moving.iter().skip(1) {
            let link = hayati::link_to(&frame, &next.frame.origin, &(next.frame.rotation * next.axis));
            frame = link.beyond(&frame);
            links.push(link);
        }
        links.push(Hayati::default());
        (root, links)
    }
}

impl Moving {
    /// The child's frame, turned such that its z lies along the axis and its x stays near.
    fn along_axis(&self) -> Pose {
        let z = self.axis;
        // y takes the place of an x that is along the axis itself
        let near = if z.x.abs() > 0.9 { Vector3::y() } else { Vector3::x() };
        let x = (near - z * z.dot(&near)).normalize();
        let turn = nalgebra::Matrix3::from_columns(&[x, z.cross(&x), z]);
        Pose { rotation: self.frame.rotation * turn, origin: self.frame.origin }
    }
}

/// All that moves with a joint and not with the `next` one, in the joint's `distal` frame.
fn body(tree: &Tree, moving: &Moving, next: Option<usize>, distal: &Pose) -> Option<Body> {
    let inverse = distal.inverse();
    let (mut mass, mut moment) = (0.0, Vector3::zeros());
    let mut open = vec![(tree.joints[moving.joint].child, inverse.then(&moving.frame))];
    while let Some((link, frame)) = open.pop() {
        if let Some(body) = tree.links[link].body {
            mass += body.mass;
            moment += frame.point(&body.centre) * body.mass;
        }
        for &joint in tree.links[link].below.iter().filter(|&&joint| Some(joint) != next) {
            open.push((tree.joints[joint].child, frame.then(&tree.joints[joint].origin)));
        }
    }
    (mass > 0.0).then(|| Body { mass, centre: moment / mass })
}
