//! Links and joints of a URDF as one tree, and the path through it from base to tip.

use std::collections::HashMap;

use nalgebra::Vector3;
use roxmltree::{Document, Node, NodeId};

use super::xml::{Source, child, cut, tag};
use crate::delimited::nearest_name;
use crate::error::{Error, Place, Result};
use crate::robot::{Body, Motion};
use crate::spatial::Pose;

/// A URDF as read and checked: every link but the roots hangs on one joint, and no joints lead in a
/// circle.
pub(super) struct Tree<'t> {
    source: Source<'t>,
    /// Of the `<robot>` element.
    pub name: Option<String>,
    pub links: Vec<Link>,
    pub joints: Vec<Joint>,
}

pub(super) struct Link {
    pub name: String,
    /// In the link's frame.
    pub body: Option<Body>,
    /// The joint that it hangs on.
    pub above: Option<usize>,
    /// The joints that hang on it, as the file has them.
    pub below: Vec<usize>,
    offset: usize,
}

pub(super) struct Joint {
    pub name: String,
    pub kind: Kind,
    pub parent: usize,
    pub child: usize,
    /// Its child's frame in its parent's, while it is at zero.
    pub origin: Pose,
    /// Range, rad or m, where the file states one.
    pub limits: Option<[f64; 2]>,
    /// Whose motion it copies.
    pub mimics: Option<String>,
    /// Its element, which may get a new `<origin>`.
    pub node: NodeId,
    offset: usize,
}

#[derive(Debug, Clone, PartialEq)]
pub(super) enum Kind {
    Fixed,
    /// Along or about a unit vector in the child's frame.
    Moving(Motion, Vector3<f64>),
    /// `floating` or `planar`: more than one number would say where it is.
    Free(&'static str),
}

impl<'t> Tree<'t> {
    pub fn read(source: Source<'t>, document: &Document<'t>) -> Result<Tree<'t>> {
        let root = document.root_element();
        if !root.has_tag_name("robot") {
            let found = format!("the outermost element is {}", tag(root));
            return Err(source
                .wrong(root.range().start, found, "<robot>, as in a URDF")
                .with_hint((root.tag_name().name() == "sdf").then(|| "an SDF is no URDF".to_owned())));
        }
        let is_macro = |node: &Node| node.tag_name().namespace().is_some_and(|uri| uri.contains("xacro"));
        if let Some(found) = root.descendants().find(is_macro) {
            return Err(source
                .wrong(found.range().start, "a macro of xacro".to_owned(), "a URDF without macros")
                .with_hint(Some("expand them first: xacro robot.urdf.xacro > robot.urdf".to_owned())));
        }
        let mut tree =
            Tree { source, name: root.attribute("name").map(str::to_owned), links: vec![], joints: vec![] };
        let elements = |name: &'static str| root.children().filter(move |node| node.has_tag_name(name));
        let mut by_name = HashMap::new();
        for node in elements("link") {
            let link = tree.link(node)?;
            if by_name.insert(link.name.clone(), tree.links.len()).is_some() {
                return Err(source.is(node, "name", "a name of its own for each link"));
            }
            tree.links.push(link);
        }
        let mut joint_names = HashMap::new();
        for node in elements("joint") {
            let joint = tree.joint(node, &by_name)?;
            if joint_names.insert(joint.name.clone(), ()).is_some() {
                return Err(source.is(node, "name", "a name of its own for each joint"));
            }
            tree.hang(joint, node)?;
        }
        tree.no_circle()?;
        Ok(tree)
    }

    /// The joints from link `base` down to link `tip`, with at least one that moves; every one of
    /// them can be read.
    pub fn path(&self, base: &str, tip: &str) -> Result<Vec<usize>> {
        let (base, tip) = (self.find("base_link", base)?, self.find("tip_link", tip)?);
        let mut path = self.joints_above(tip, base);
        path.reverse();
        let reached = path.first().map_or(tip, |&joint| self.joints[joint].parent);
        let (base_name, tip_name) = (cut(&self.links[base].name), cut(&self.links[tip].name));
        if reached != base {
            let found = format!("link `{tip_name}` does not hang on `{base_name}`");
            let up = self.joints_above(base, tip).last().map(|&joint| self.joints[joint].parent) == Some(tip);
            let hint = up.then(|| "it is the other way round: exchange base_link and tip_link".to_owned());
            let above = self.joints_above(tip, base).into_iter().map(|joint| self.joints[joint].parent);
            let above = self.listed(above);
            let expected = match above.as_str() {
                "" => "a tip_link that hangs on other links".to_owned(),
                above => format!("a base_link that it hangs on: {above}"),
            };
            return Err(self.source.wrong(self.links[tip].offset, found, expected).with_hint(hint));
        }
        for &joint in &path {
            let Joint { name, kind, mimics, offset, .. } = &self.joints[joint];
            if let Kind::Free(kind) = kind {
                let found = format!("joint `{}` between base_link and tip_link is {kind}", cut(name));
                let expected = "revolute, continuous, prismatic or fixed joints there";
                return Err(self.source.wrong(*offset, found, expected));
            }
            if let Some(other) = mimics {
                let found = format!("joint `{}` mimics `{}`", cut(name), cut(other));
                let expected = "joints that move by themselves between base_link and tip_link";
                return Err(self.source.wrong(*offset, found, expected));
            }
        }
        if !path.iter().any(|&joint| matches!(self.joints[joint].kind, Kind::Moving(..))) {
            let found = format!("no joint moves `{tip_name}` against `{base_name}`");
            let expected = "a revolute, continuous or prismatic joint between base_link and tip_link";
            return Err(self.source.wrong(self.links[tip].offset, found, expected));
        }
        Ok(path)
    }

    fn link(&self, node: Node<'_, 't>) -> Result<Link> {
        let name = self.source.required(node, "name", "a name for each link")?.to_owned();
        let body = match child(node, "inertial") {
            Some(inertial) => Some(self.body(inertial)?),
            None => None,
        };
        Ok(Link { name, body, above: None, below: vec![], offset: node.range().start })
    }

    fn body(&self, inertial: Node<'_, 't>) -> Result<Body> {
        let Some(mass) = child(inertial, "mass") else {
            let found = "<inertial> has no <mass>".to_owned();
            return Err(self.source.wrong(inertial.range().start, found, "<mass value=\"…\"/> in kg"));
        };
        match self.source.numbers(mass, "value")? {
            Some([kg]) if kg >= 0.0 => Ok(Body { mass: kg, centre: self.source.origin(inertial)?.origin }),
            _ => Err(self.source.is(mass, "value", "a mass >= 0 in kg")),
        }
    }

    fn joint(&self, node: Node<'_, 't>, links: &HashMap<String, usize>) -> Result<Joint> {
        let source = &self.source;
        let name = source.required(node, "name", "a name for each joint")?.to_owned();
        const KINDS: &str = "revolute, continuous, prismatic, fixed, floating or planar";
        let (kind, limits) = match source.required(node, "type", KINDS)? {
            "fixed" => (Kind::Fixed, None),
            "continuous" => (Kind::Moving(Motion::Revolute, self.axis(node)?), None),
            "revolute" => (Kind::Moving(Motion::Revolute, self.axis(node)?), self.limits(node)?),
            "prismatic" => (Kind::Moving(Motion::Prismatic, self.axis(node)?), self.limits(node)?),
            "floating" => (Kind::Free("floating"), None),
            "planar" => (Kind::Free("planar"), None),
            _ => return Err(source.is(node, "type", KINDS)),
        };
        Ok(Joint {
            kind,
            limits,
            parent: self.end(node, "parent", links)?,
            child: self.end(node, "child", links)?,
            origin: source.origin(node)?,
            mimics: child(node, "mimic").map(|m| m.attribute("joint").unwrap_or_default().to_owned()),
            node: node.id(),
            offset: node.range().start,
            name,
        })
    }

    /// A unit vector; x where the file states none, as URDF has it.
    fn axis(&self, joint: Node<'_, 't>) -> Result<Vector3<f64>> {
        let Some(node) = child(joint, "axis") else { return Ok(Vector3::x()) };
        let axis = Vector3::from(self.source.numbers(node, "xyz")?.unwrap_or([1.0, 0.0, 0.0]));
        match axis.amax() {
            0.0 => Err(self.source.is(node, "xyz", "a direction")),
            // first to a size whose square is a number
            largest => Ok((axis / largest).normalize()),
        }
    }

    fn limits(&self, joint: Node<'_, 't>) -> Result<Option<[f64; 2]>> {
        let Some(node) = child(joint, "limit") else { return Ok(None) };
        let [lower] = self.source.numbers(node, "lower")?.unwrap_or_default();
        let [upper] = self.source.numbers(node, "upper")?.unwrap_or_default();
        if lower > upper {
            let name = if node.has_attribute("lower") { "lower" } else { "upper" };
            let expected = format!("lower <= upper; these are {lower} and {upper}");
            return Err(self.source.is(node, name, &expected));
        }
        // both are 0 where nobody cared to state them
        Ok((lower < upper).then_some([lower, upper]))
    }

    /// The link that the joint's `<parent>` or `<child>` names.
    fn end(&self, joint: Node<'_, 't>, which: &str, links: &HashMap<String, usize>) -> Result<usize> {
        let Some(node) = child(joint, which) else {
            let found = format!("{} has no <{which}>", tag(joint));
            let expected = format!("<{which} link=\"…\"/>");
            return Err(self.source.wrong(joint.range().start, found, expected));
        };
        let name = self.source.required(node, "link", "the name of a link")?;
        links.get(name).copied().ok_or_else(|| {
            let error = self.source.is(node, "link", &self.one_of_the_links());
            error.with_hint(self.near(name))
        })
    }

    fn hang(&mut self, joint: Joint, node: Node) -> Result<()> {
        let index = self.joints.len();
        if let Some(other) = self.links[joint.child].above {
            let link = cut(&self.links[joint.child].name);
            let other = cut(&self.joints[other].name);
            let found = format!("link `{link}` is the child of joint `{}` too", cut(&joint.name));
            let expected = format!("one joint for each link to hang on; it hangs on `{other}`");
            return Err(self.source.wrong(node.range().start, found, expected));
        }
        self.links[joint.child].above = Some(index);
        self.links[joint.parent].below.push(index);
        self.joints.push(joint);
        Ok(())
    }

    /// Refuses joints that lead from a link back to itself: nothing reaches them from a root.
    fn no_circle(&self) -> Result<()> {
        let mut is_reached = vec![false; self.links.len()];
        let mut open: Vec<usize> = (0..self.links.len()).filter(|&l| self.links[l].above.is_none()).collect();
        while let Some(link) = open.pop() {
            is_reached[link] = true;
            open.extend(self.links[link].below.iter().map(|&joint| self.joints[joint].child));
        }
        let Some(mut link) = is_reached.iter().position(|&reached| !reached) else { return Ok(()) };
        // upwards from there until a link comes twice: that one is on the circle
        while !std::mem::replace(&mut is_reached[link], true) {
            if let Some(joint) = self.links[link].above {
                link = self.joints[joint].parent;
            }
        }
        let Link { name, offset, .. } = &self.links[link];
        let found = format!("link `{}` hangs on itself by a circle of joints", cut(name));
        Err(self.source.wrong(*offset, found, "a tree of links"))
    }

    /// The joints from `link` upwards, until `end` or a root is reached.
    fn joints_above(&self, link: usize, end: usize) -> Vec<usize> {
        let mut joints = Vec::new();
        let mut at = link;
        while at != end
            && let Some(joint) = self.links[at].above
        {
            joints.push(joint);
            at = self.joints[joint].parent;
        }
        joints
    }

    fn find(&self, role: &str, name: &str) -> Result<usize> {
        self.links.iter().position(|link| link.name == name).ok_or_else(|| self.no_such_link(role, name))
    }

    fn no_such_link(&self, role: &str, name: &str) -> Error {
        let found = format!("there is no link `{}`", cut(name));
        let expected = format!("{role} to be {}", self.one_of_the_links());
        let at = Place::whole_file(self.source.file);
        Error::Input { at, found, expected, hint: self.near(name) }
    }

    fn one_of_the_links(&self) -> String {
        match self.links.len() {
            0 => "a link of the file; it has none".to_owned(),
            count => format!("one of the links {}", self.listed(0..count)),
        }
    }

    /// Names of links, as many as fit a message.
    fn listed(&self, links: impl Iterator<Item = usize>) -> String {
        const MOST: usize = 12;
        let mut names: Vec<String> = links.map(|link| cut(&self.links[link].name)).collect();
        if names.len() > MOST {
            // base and tip stand at the ends of most files
            let rest = names.split_off(MOST / 2);
            names.push("…".to_owned());
            names.extend(rest[rest.len() - MOST / 2..].iter().cloned());
        }
        names.join(", ")
    }

    fn near(&self, name: &str) -> Option<String> {
        let names: Vec<&str> = self.links.iter().map(|link| link.name.as_str()).collect();
        nearest_name(name, &names).map(|near| format!("did you mean {}?", cut(near)))
    }
}
