//! A URDF's kinematics as its definition has it: the product of all transforms from base to tip.
//! Nothing here is shared with the reader but the XML.

use nalgebra::{Isometry3, Translation3, Unit, UnitQuaternion, Vector3};
use rodcal::spatial::Pose;
use roxmltree::{Document, Node};

/// The tip in the base at joint values `q` (rad or m), one for each joint between them that moves.
pub fn product(text: &str, base: &str, tip: &str, q: &[f64]) -> Pose {
    let document = Document::parse(text).expect("XML");
    let joints: Vec<Node> = document.root_element().children().filter(|n| n.has_tag_name("joint")).collect();
    let mut path = Vec::new();
    let mut link = tip;
    while link != base {
        let joint = joints.iter().find(|joint| end(joint, "child") == link).expect("a joint above");
        path.push(*joint);
        link = end(joint, "parent");
    }
    let mut values = q.iter();
    let mut at = Isometry3::identity();
    for joint in path.iter().rev() {
        at *= origin(joint);
        let axis = three(joint, "axis", "xyz").unwrap_or_else(Vector3::x);
        let axis = || Unit::new_normalize(axis / axis.amax());
        at *= match joint.attribute("type") {
            Some("fixed") => Isometry3::identity(),
            Some("prismatic") => {
                Isometry3::from(Translation3::from(axis().into_inner() * *values.next().expect("a value")))
            }
            _ => Isometry3::from_parts(
                Translation3::identity(),
                UnitQuaternion::from_axis_angle(&axis(), *values.next().expect("a value")),
            ),
        };
    }
    assert!(values.next().is_none(), "as many values as joints");
    Pose { rotation: at.rotation.to_rotation_matrix().into_inner(), origin: at.translation.vector }
}

fn origin(joint: &Node) -> Isometry3<f64> {
    let xyz = three(joint, "origin", "xyz").unwrap_or_default();
    let rpy = three(joint, "origin", "rpy").unwrap_or_default();
    let about = |axis, angle| UnitQuaternion::from_axis_angle(&axis, angle);
    let turn =
        about(Vector3::z_axis(), rpy.z) * about(Vector3::y_axis(), rpy.y) * about(Vector3::x_axis(), rpy.x);
    Isometry3::from_parts(Translation3::from(xyz), turn)
}

fn three(joint: &Node, element: &str, attribute: &str) -> Option<Vector3<f64>> {
    let value = joint.children().find(|n| n.has_tag_name(element))?.attribute(attribute)?;
    let numbers: Vec<f64> = value.split_whitespace().map(|n| n.parse().expect("a number")).collect();
    (numbers.len() == 3).then(|| Vector3::from_vec(numbers))
}

fn end<'a>(joint: &Node<'a, '_>, which: &str) -> &'a str {
    let node = joint.children().find(|n| n.has_tag_name(which)).expect("an end");
    node.attribute("link").expect("a link")
}
