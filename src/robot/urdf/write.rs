//! Writes a calibrated robot back into its URDF, which stays as it is but for origins.
//!
//! A child's frame ℓⱼ is rigidly attached behind its joint's motion: ℓⱼ = Jⱼ·Rz(qⱼ)·Mⱼ, where Jⱼ is
//! the joint's frame in the chain and the constant Mⱼ is what it is in the file, so that meshes,
//! inertials and side branches stay where they were on their link. Mⱼ turns the URDF's axis into z
//! and has its origin on it, so the axis stays as written. With Jⱼ₊₁ = Jⱼ·Rz(qⱼ)·Hⱼ, Hⱼ the
//! calibrated link at zero, one child's frame in the one before must be
//!
//! ```text
//! base_link → ℓ₁:  root·M₁     ℓⱼ → ℓⱼ₊₁:  Mⱼ⁻¹·Hⱼ·Mⱼ₊₁     ℓₙ → tip_link:  Mₙ⁻¹·Hₙ·flange·tool
//! ```
//!
//! Of the origins in between, fixed joints keep theirs; that of the joint that moves takes up the
//! rest. At the end it is that of the last fixed joint. Calibrated offsets of the joints' zeros are
//! thereby in the origins, too.

use nalgebra::{Matrix3, Vector3};

use super::tree::{Kind, Tree};
use super::xml::{Source, child};
use super::{BASE_LINK, TIP_LINK, Zero};
use crate::delimited::is_obeyed;
use crate::error::{Error, Result};
use crate::robot::Robot;
use crate::spatial::{Pose, turned_about_z};
use crate::toml_text::in_unit;
use crate::units::URAD_PER_NM;

/// A robot in its URDF.
#[derive(Debug, Clone, PartialEq)]
#[non_exhaustive]
pub struct Written {
    /// The whole file.
    pub text: String,
    /// True where the end of the chain is in the file: the link of the last joint, flange and tool.
    /// It is not where `tip_link` is what the last joint moves, for then no fixed joint is there to
    /// take it up.
    pub has_tool: bool,
}

impl Robot {
    /// This robot, calibrated, in the text of the URDF that it was read from.
    ///
    /// Only the `<origin>`s of joints between `base_link` and `tip_link` are replaced, and only
    /// where they change; everything else stays byte by byte. Any program that reads it then has
    /// this robot's kinematics, to rounding. `tool` is the tip in {T}, m: `tip_link` has its origin
    /// there afterwards, its orientation unchanged. `comments` are written in front of the robot,
    /// with a line about what a URDF has no words for.
    ///
    /// # Errors
    /// Those of [`Robot::from_text`]; [`Error::Argument`] where the text has another number of
    /// joints, or where a number of the robot is not finite.
    pub fn to_urdf(
        &self,
        file: &str,
        text: &str,
        base_link: Option<&str>,
        tip_link: Option<&str>,
        tool: Option<Vector3<f64>>,
        comments: &[String],
    ) -> Result<Written> {
        let source = Source { file, text };
        let document = source.parse()?;
        let tree = Tree::read(source, &document)?;
        let path = tree.path(base_link.unwrap_or(BASE_LINK), tip_link.unwrap_or(TIP_LINK))?;
        let (origins, has_tool) = self.origins(&tree, &path, tool.unwrap_or_default())?;

        let mut edits = Vec::new();
        for (&joint, origin) in path.iter().zip(&origins) {
            if !is_same(origin, &tree.joints[joint].origin) {
                let node = document.get_node(tree.joints[joint].node);
                edits.extend(node.map(|node| edit(text, node, origin)));
            }
        }
        let notes = self.notes(comments, tool.is_some() && !has_tool);
        if !notes.is_empty() {
            let start = document.root_element().range().start;
            edits.push((start..start, comment(&notes)));
        }
        // from the back, so that the places in front stay what they are
        edits.sort_by_key(|(range, _)| std::cmp::Reverse(range.start));
        let mut text = text.to_owned();
        for (range, new) in edits {
            text.replace_range(range, &new);
        }
        Ok(Written { text, has_tool })
    }

    /// The new origins of the joints of `path`, and whether the end of the chain found a place.
    fn origins(&self, tree: &Tree, path: &[usize], tool: Vector3<f64>) -> Result<(Vec<Pose>, bool)> {
        let zero = Zero::new(tree, path);
        if zero.moving.len() != self.joints.len() {
            let found = format!("a robot with {} joints", self.joints.len());
            let expected = format!("the robot of this URDF, which has {}", zero.moving.len());
            return Err(Error::Argument { name: "robot", found, expected });
        }
        // Mⱼ: the child's frames in the joints' frames of the file's own chain
        let (root, links) = zero.chain();
        let mut frame = root;
        let mut attached = Vec::new();
        for (moving, link) in zero.moving.iter().zip(&links) {
            attached.push(frame.inverse().then(&moving.frame));
            frame = link.beyond(&frame);
        }
        let mut origins: Vec<Pose> = path.iter().map(|&joint| tree.joints[joint].origin).collect();
        let mut so_far = self.root; // in the last child's frame, first in base_link
        let mut first = 0;
        let mut count = 0;
        for (index, &joint) in path.iter().enumerate() {
            if matches!(tree.joints[joint].kind, Kind::Moving(..)) {
                let wanted = so_far.then(&attached[count]);
                origins[index] = rest(&origins[first..index], &wanted);
                so_far = attached[count].inverse().then(&self.joints[count].link.beyond(&Pose::IDENTITY));
                (first, count) = (index + 1, count + 1);
            }
        }
        let has_tool = first < path.len();
        if has_tool {
            let tool = Pose { rotation: Matrix3::identity(), origin: tool };
            let wanted = so_far.then(&self.flange).then(&tool);
            let last = path.len() - 1;
            origins[last] = rest(&origins[first..last], &wanted);
        }
        match origins.iter().flat_map(|o| o.origin.iter().chain(o.rotation.iter())).all(|x| x.is_finite()) {
            true => Ok((origins, has_tool)),
            false => Err(Error::Argument {
                name: "robot",
                found: "a robot with a number that is not finite".to_owned(),
                expected: "finite numbers".to_owned(),
            }),
        }
    }

    /// The comments, and what the file cannot say.
    fn notes(&self, comments: &[String], lacks_tool: bool) -> Vec<String> {
        let mut notes = comments.to_vec();
        let compliant = self.joints.iter().filter(|joint| joint.compliance != 0.0);
        let compliances: Vec<String> = compliant
            .map(|joint| format!("{} {:?} urad/(N m)", joint.name, in_unit(joint.compliance, URAD_PER_NM)))
            .collect();
        if !compliances.is_empty() {
            notes.push(format!(
                "Not in this file, a URDF has no joint compliance: {}.",
                compliances.join(", ")
            ));
        }
        if lacks_tool {
            notes.push(
                "Not in this file, no fixed joint is there for it: the tool on the last link.".to_owned(),
            );
        }
        notes
    }
}

/// What follows `fixed` origins to make the `wanted` one.
fn rest(fixed: &[Pose], wanted: &Pose) -> Pose {
    fixed.iter().fold(Pose::IDENTITY, |sum, origin| sum.then(origin)).inverse().then(wanted)
}

/// True where rounding alone makes the difference.
fn is_same(a: &Pose, b: &Pose) -> bool {
    const ROUNDING: f64 = 1e-14;
    (a.rotation - b.rotation).amax() < ROUNDING && (a.origin - b.origin).amax() < ROUNDING
}

/// Where a joint's `<origin>` stands, or has to stand, and what stands there then.
fn edit(text: &str, joint: roxmltree::Node, origin: &Pose) -> (std::ops::Range<usize>, String) {
    // + 0.0 makes 0.0 of -0.0
    let [x, y, z] = origin.origin.map(|number| number + 0.0).into();
    let [roll, pitch, yaw] = rpy(&origin.rotation).map(|angle| angle + 0.0);
    let new = format!("<origin xyz=\"{x:?} {y:?} {z:?}\" rpy=\"{roll:?} {pitch:?} {yaw:?}\"/>");
    if let Some(old) = child(joint, "origin") {
        return (old.range(), new);
    }
    // in front of the first element of the joint, which has at least its parent and child, and
    // indented like it
    let start = joint.first_element_child().map_or(joint.range().end, |first| first.range().start);
    let before = &text[..start];
    let indent = &before[before.trim_end().len()..];
    (start..start, format!("{new}{indent}"))
}

/// `[roll, pitch, yaw]` of R = Rz(yaw)·Ry(pitch)·Rx(roll), rad.
///
/// Yaw first, then the other two of what is left: where pitch is near ±90° and only roll ∓ yaw is
/// determined, any yaw is as good as another and roll makes up for it, so that R is met to rounding
/// everywhere.
fn rpy(r: &Matrix3<f64>) -> [f64; 3] {
    let yaw = r[(1, 0)].atan2(r[(0, 0)]);
    let left = turned_about_z(&Matrix3::identity(), yaw.sin_cos()).transpose() * r;
    [(-left[(1, 2)]).atan2(left[(1, 1)]), (-left[(2, 0)]).atan2(left[(0, 0)]), yaw]
}

/// An XML comment, in which two hyphens must not stand together.
fn comment(lines: &[String]) -> String {
    let lines: Vec<String> = lines
        .iter()
        .flat_map(|text| text.lines())
        .map(|line| {
            let plain: String = line
                .chars()
                .map(|c| if is_obeyed(c) || ('\u{fffe}'..='\u{ffff}').contains(&c) { ' ' } else { c })
                .collect();
            format!("  {}\n", plain.replace("--", "- -").replace("--", "- -"))
        })
        .collect();
    format!("<!--\n{}-->\n", lines.concat())
}
