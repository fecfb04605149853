//! The chain of nodes and elements, built piece by piece from the clamped end.

use nalgebra::{Rotation3, Vector3};

use super::element::{Profile, Shape};

/// A cantilever in space: node 0 is clamped, each further node hangs on the one before by one
/// element.
///
/// It is built like a turtle drawing, from a current point and a current frame whose z axis points
/// ahead.
///
/// ```
/// use nalgebra::{Rotation3, Vector3};
/// use rodcal::beam::{Chain, Load, Profile};
///
/// // a cantilever of 1 m: EI = 1000 N·m², no shear; its tip under 1 N goes L³/3EI, turned by L²/2EI
/// let bending = [1e-3; 2];
/// let profile = Profile { axial: 0.0, shear: [0.0; 2], bending, torsion: 1e-3, mass_per_length: 0.0, rotary_inertia: [0.0; 2] };
/// let mut chain = Chain::clamped_at(Vector3::zeros(), Rotation3::identity());
/// chain.straight(&profile, 1.0, 3);
/// let tip = chain.end();
/// let response = chain.solve(&[Load::Force { node: tip }])?;
/// let motion = response.motion(tip, 0);
/// assert!((motion.translation[(0, 0)] - 1.0 / 3000.0).abs() < 1e-15);
/// assert!((motion.rotation[(1, 0)] - 1.0 / 2000.0).abs() < 1e-15);
/// # Ok::<(), rodcal::Error>(())
/// ```
#[derive(Debug, Clone)]
pub struct Chain {
    pub(super) nodes: Vec<Node>,
    pub(super) elements: Vec<Element>,
    pub(super) shapes: Vec<Shape>,
    /// Of each shape what it is made of; none of a spring.
    pub(super) pieces: Vec<Option<Piece>>,
    frame: Rotation3<f64>,
}

/// A point of the chain.
#[derive(Debug, Clone, Copy)]
pub(super) struct Node {
    pub position: Vector3<f64>,
    /// Arc length from node 0, m.
    pub station: f64,
    /// Mass lumped here, kg.
    pub mass: f64,
}

/// What an element is made of: a straight beam between its nodes.
#[derive(Debug, Clone, Copy)]
pub(super) struct Piece {
    pub profile: Profile,
    /// From node to node, m.
    pub length: f64,
    /// Local axes, z from node to node.
    pub frame: Rotation3<f64>,
}

/// The element between node k and node k + 1, k its index.
#[derive(Debug, Clone, Copy)]
pub(super) struct Element {
    /// Reference point c in space, m.
    pub reference: Vector3<f64>,
    /// Index of its shape: congruent elements share one.
    pub shape: usize,
}

impl Chain {
    /// A chain clamped at `position` (m), heading along the z axis of `frame`.
    pub fn clamped_at(position: Vector3<f64>, frame: Rotation3<f64>) -> Self {
        let root = Node { position, station: 0.0, mass: 0.0 };
        Chain { nodes: vec![root], elements: Vec::new(), shapes: Vec::new(), pieces: Vec::new(), frame }
    }

    /// Begins anew at the origin, heading along z, and keeps the room that it has.
    pub(super) fn restart(&mut self) {
        self.nodes.clear();
        self.nodes.push(Node { position: Vector3::zeros(), station: 0.0, mass: 0.0 });
        self.elements.clear();
        self.shapes.clear();
        self.pieces.clear();
        self.frame = Rotation3::identity();
    }

    /// Reserves room for `elements` more elements.
    pub fn reserve(&mut self, elements: usize) {
        self.nodes.reserve(elements);
        self.elements.reserve(elements);
    }

    /// Goes straight ahead for `length` (m) in `count` equal elements (at least one).
    pub fn straight(&mut self, profile: &Profile, length: f64, count: usize) {
        let (Node { position, station, .. }, count) = (self.last(), count.max(1));
        let step = length / count as f64;
        let piece = Piece { profile: *profile, length: step, frame: self.frame };
        let shape = self.share(Shape::straight(profile, step).turned(&self.frame), Some(piece));
        let ahead = self.frame * Vector3::z();
        for k in 0..count {
            // products, not running sums: node k is as accurate as node 1
            let at = |steps: f64| position + ahead * (steps * step);
            let (reference, end) = (at(k as f64 + 0.5), at((k + 1) as f64));
            self.append(Element { reference, shape }, end, station + (k + 1) as f64 * step);
        }
    }

    /// Goes along an arc of `radius` (m) through `angle` (rad, > 0) in `count` equal elements (at
    /// least one), bending from the current z axis towards the current x axis.
    pub fn arc(&mut self, profile: &Profile, radius: f64, angle: f64, count: usize) {
        let count = count.max(1);
        let step = angle / count as f64;
        self.bend(&Shape::arc(profile, radius, step), profile, radius, angle, count);
    }

    /// [`Chain::arc`] of elements of a known shape.
    pub(super) fn bend(&mut self, local: &Shape, profile: &Profile, radius: f64, angle: f64, count: usize) {
        let Node { position, station, .. } = self.last();
        let step = angle / count as f64;
        let frame = self.frame;
        // between its nodes the mass is that of the arc
        let length = 2.0 * radius * (step / 2.0).sin();
        let longer = radius * step / length;
        let profile = Profile {
            mass_per_length: profile.mass_per_length * longer,
            rotary_inertia: profile.rotary_inertia.map(|inertia| inertia * longer),
            ..*profile
        };
        // seen from the start of the arc: R (1 − cos α, 0, sin α)
        let at =
            |a: f64| position + frame * (Vector3::new(2.0 * (a / 2.0).sin().powi(2), 0.0, a.sin()) * radius);
        for k in 0..count {
            let (middle, end) = ((k as f64 + 0.5) * step, (k + 1) as f64 * step);
            let turn = frame * Rotation3::from_axis_angle(&Vector3::y_axis(), middle);
            let piece = Piece { profile, length, frame: turn };
            let shape = self.share(local.turned(&turn), Some(piece));
            self.append(Element { reference: at(middle), shape }, at(end), station + end * radius);
        }
        self.turn(&Rotation3::from_axis_angle(&Vector3::y_axis(), angle));
    }

    /// Turns the current frame about itself: a sharp corner, or a new direction of the section's
    /// axes.
    pub fn turn(&mut self, rotation: &Rotation3<f64>) {
        self.frame *= rotation;
    }

    /// A rotational spring here, about the current axes; `bending` and `torsion` in rad/(N·m).
    pub fn spring(&mut self, bending: f64, torsion: f64) {
        let Node { position, station, .. } = self.last();
        let shape = self.share(Shape::spring(bending, torsion).turned(&self.frame), None);
        self.append(Element { reference: position, shape }, position, station);
    }

    /// A mass (kg) here.
    pub fn mass(&mut self, mass: f64) {
        let last = self.nodes.len() - 1;
        self.nodes[last].mass += mass;
    }

    /// Index of the current, outermost node.
    pub fn end(&self) -> usize {
        self.nodes.len() - 1
    }

    /// Number of elements.
    pub fn element_count(&self) -> usize {
        self.elements.len()
    }

    /// Position of a node in space, m.
    pub fn position(&self, node: usize) -> Vector3<f64> {
        self.nodes[node].position
    }

    /// Arc length of a node from the clamped end, m.
    pub fn station(&self, node: usize) -> f64 {
        self.nodes[node].station
    }

    pub(super) fn shape(&self, element: &Element) -> &Shape {
        &self.shapes[element.shape]
    }

    fn last(&self) -> Node {
        self.nodes[self.nodes.len() - 1]
    }

    fn share(&mut self, shape: Shape, piece: Option<Piece>) -> usize {
        self.shapes.push(shape);
        self.pieces.push(piece);
        self.shapes.len() - 1
    }

    fn append(&mut self, element: Element, position: Vector3<f64>, station: f64) {
        self.elements.push(element);
        self.nodes.push(Node { position, station, mass: 0.0 });
    }
}
