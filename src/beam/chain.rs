//! The chain of nodes and elements, built piece by piece from the clamped end.

use nalgebra::{Rotation3, Vector3};

use super::element::{Profile, Shape, ahead};
use crate::dual::{Number, about_y};
use crate::parallel::checkpoint;

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
pub struct Chain<T = f64> {
    pub(super) nodes: Vec<Node<T>>,
    pub(super) elements: Vec<Element<T>>,
    pub(super) shapes: Vec<Shape<T>>,
    /// Of each shape what it is made of; none of a spring.
    pub(super) pieces: Vec<Option<Piece<T>>>,
    frame: Rotation3<T>,
}

/// A point of the chain.
#[derive(Debug, Clone, Copy)]
pub(super) struct Node<T = f64> {
    pub position: Vector3<T>,
    /// Arc length from node 0, m.
    pub station: T,
    /// Mass lumped here, kg.
    pub mass: T,
}

/// What an element is made of: a straight beam between its nodes.
#[derive(Debug, Clone, Copy)]
pub(super) struct Piece<T = f64> {
    pub profile: Profile<T>,
    /// From node to node, m.
    pub length: T,
    /// Local axes, z from node to node.
    pub frame: Rotation3<T>,
    /// From the middle between the nodes to the centre of mass, in space, m; none of a straight
    /// piece.
    pub bulge: Option<Vector3<T>>,
}

/// The element between node k and node k + 1, k its index.
#[derive(Debug, Clone, Copy)]
pub(super) struct Element<T = f64> {
    /// Reference point c in space, m.
    pub reference: Vector3<T>,
    /// Index of its shape: congruent elements share one.
    pub shape: usize,
}

impl<T: Number> Chain<T> {
    /// A chain clamped at `position` (m), heading along the z axis of `frame`.
    pub fn clamped_at(position: Vector3<T>, frame: Rotation3<T>) -> Self {
        let root = Node { position, station: T::zero(), mass: T::zero() };
        Chain { nodes: vec![root], elements: Vec::new(), shapes: Vec::new(), pieces: Vec::new(), frame }
    }

    /// Begins anew at the origin, heading along z, and keeps the room that it has.
    pub(super) fn restart(&mut self) {
        self.nodes.clear();
        self.nodes.push(Node { position: Vector3::zeros(), station: T::zero(), mass: T::zero() });
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
    pub fn straight(&mut self, profile: &Profile<T>, length: T, count: usize) {
        let (Node { position, station, .. }, count) = (self.last(), count.max(1));
        let step = length / count as f64;
        let piece = Piece { profile: *profile, length: step, frame: self.frame, bulge: None };
        let shape = self.share(Shape::straight(profile, step).turned(&self.frame), Some(piece));
        let ahead = self.frame * ahead();
        for k in 0..count {
            checkpoint();
            // products, not running sums: node k is as accurate as node 1
            let at = |steps: f64| position + ahead * (step * steps);
            let (reference, end) = (at(k as f64 + 0.5), at((k + 1) as f64));
            self.append(Element { reference, shape }, end, station + step * (k + 1) as f64);
        }
    }

    /// Goes along an arc of `radius` (m) through `angle` (rad, > 0) in `count` equal elements (at
    /// least one), bending from the current z axis towards the current x axis.
    pub fn arc(&mut self, profile: &Profile<T>, radius: T, angle: T, count: usize) {
        let count = count.max(1);
        let step = angle / count as f64;
        self.bend(&Shape::arc(profile, radius, step), profile, radius, angle, count);
    }

    /// [`Chain::arc`] of elements of a known shape.
    pub(super) fn bend(&mut self, local: &Shape<T>, profile: &Profile<T>, radius: T, angle: T, count: usize) {
        let Node { position, station, .. } = self.last();
        let step = angle / count as f64;
        let frame = self.frame;
        // between its nodes the mass is that of the arc
        let length = radius * 2.0 * (step / 2.0).sin();
        let longer = radius * step / length;
        let profile = Profile {
            mass_per_length: profile.mass_per_length * longer,
            rotary_inertia: profile.rotary_inertia.map(|inertia| inertia * longer),
            ..*profile
        };
        // the arc's middle is beyond the chord by R (1 − cos ½α)
        let rise = Vector3::new((step / 4.0).sin().powi(2) * radius * 2.0, T::zero(), T::zero());
        // seen from the start of the arc: R (1 − cos α, 0, sin α)
        let at = |a: T| {
            position + frame * (Vector3::new((a / 2.0).sin().powi(2) * 2.0, T::zero(), a.sin()) * radius)
        };
        for k in 0..count {
            checkpoint();
            let (middle, end) = (step * (k as f64 + 0.5), step * (k + 1) as f64);
            let turn = frame * about_y(middle);
            let bulge = Some(turn * (local.mass_centre - rise));
            let piece = Piece { profile, length, frame: turn, bulge };
            let shape = self.share(local.turned(&turn), Some(piece));
            self.append(Element { reference: at(middle), shape }, at(end), station + end * radius);
        }
        self.turn(&about_y(angle));
    }

    /// Turns the current frame about itself: a sharp corner, or a new direction of the section's
    /// axes.
    pub fn turn(&mut self, rotation: &Rotation3<T>) {
        self.frame *= rotation;
    }

    /// A rotational spring here, about the current axes; `bending` and `torsion` in rad/(N·m).
    pub fn spring(&mut self, bending: T, torsion: T) {
        let Node { position, station, .. } = self.last();
        let shape = self.share(Shape::spring(bending, torsion).turned(&self.frame), None);
        self.append(Element { reference: position, shape }, position, station);
    }

    /// A mass (kg) here.
    pub fn mass(&mut self, mass: T) {
        let last = self.nodes.len() - 1;
        self.nodes[last].mass += mass;
    }

    /// Index of the current, outermost node.
    pub fn end(&self) -> usize {
        self.nodes.len() - 1
    }

    /// Position of a node in space, m.
    pub fn position(&self, node: usize) -> Vector3<T> {
        self.nodes[node].position
    }

    /// Arc length of a node from the clamped end, m.
    pub fn station(&self, node: usize) -> T {
        self.nodes[node].station
    }

    pub(super) fn shape(&self, element: &Element<T>) -> &Shape<T> {
        &self.shapes[element.shape]
    }

    fn last(&self) -> Node<T> {
        self.nodes[self.nodes.len() - 1]
    }

    fn share(&mut self, shape: Shape<T>, piece: Option<Piece<T>>) -> usize {
        self.shapes.push(shape);
        self.pieces.push(piece);
        self.shapes.len() - 1
    }

    fn append(&mut self, element: Element<T>, position: Vector3<T>, station: T) {
        self.elements.push(element);
        self.nodes.push(Node { position, station, mass: T::zero() });
    }
}
