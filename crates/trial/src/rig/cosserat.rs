//! A rod in space that bends, twists, shears and stretches as far as it likes: Cosserat's rod under
//! one dead load.
//!
//! With p the centreline, R the frame of its section (third axis along it), F the load at the
//! station s_L, p_L = p(s_L),
//!
//! ```text
//! p' = R·(e₃ + diag(s, s, a)·Rᵀn)     n = F below the load, 0 above it
//! R' = R·[κ₀ + diag(b, b, t)·Rᵀm]×    m = (p_L − p) × n
//! ```
//!
//! (S. S. Antman, *Nonlinear Problems of Elasticity*, ch. 8; b, t, s, a of [`Flexibility`]). A
//! joint turns the frame at once by diag(β, β, τ)·Rᵀm. Nothing is unknown but where the load ends
//! up: p_L is put in, the rod is integrated from the flange by Runge and Kutta's fourth order, and
//! p_L is what came out, until it converges. Deflections are differences of two runs of the same
//! integrator, so that its error cancels to first order.

use nalgebra::{Quaternion, UnitQuaternion, Vector3};

use super::tube::Flexibility;

/// Movement of the loaded point from one iteration to the next at which it has converged, m.
const CONVERGED: f64 = 1e-12;
/// Iterations after which a rod is taken as it is: a buckling one does not come to rest.
const MOST_ITERATIONS: usize = 200;
/// Steps of a piece between two stations, and largest turn of the undeformed frame in a step, rad.
const FEWEST_STEPS: usize = 4;
const LARGEST_TURN: f64 = 0.1;

/// A length of rod with one section and one curvature.
#[derive(Debug, Clone, PartialEq)]
pub struct Piece {
    /// Length, m.
    pub length: f64,
    /// Turn about the section's second axis that precedes the piece, rad: a sharp corner.
    pub corner: f64,
    /// Undeformed curvature about the section's second axis, 1/m.
    pub curvature: f64,
    /// What the section gives way.
    pub flexibility: Flexibility,
}

/// A joint: the frame turns by moment times compliance.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Hinge {
    /// Where, m from the flange.
    pub station: f64,
    /// About either transverse axis, rad/(N·m).
    pub bending: f64,
    /// About the centreline, rad/(N·m).
    pub torsion: f64,
}

/// A rod from the flange (origin, along +Z) to its tip.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Body {
    /// From the flange on.
    pub pieces: Vec<Piece>,
    /// In any order.
    pub hinges: Vec<Hinge>,
}

/// Stations closer than this are one, m.
const SAME: f64 = 1e-12;

/// Where the integration stands.
#[derive(Clone, Copy)]
struct Section {
    point: Vector3<f64>,
    frame: Quaternion<f64>,
}

impl Body {
    /// How far the point at `read` moves under `force` at `load` (stations, m; force N in {T}), m.
    pub fn deflection(&self, force: &Vector3<f64>, load: f64, read: f64) -> Vector3<f64> {
        let stops = self.stops(load, read);
        let [rest, read_at_rest] = self.integrate(&stops, &Vector3::zeros(), &Vector3::zeros(), load, read);
        let (mut loaded, mut deflection) = (rest, Vector3::zeros());
        for _ in 0..MOST_ITERATIONS {
            let [next, point] = self.integrate(&stops, force, &loaded, load, read);
            let moved = (next - loaded).norm();
            (loaded, deflection) = (next, point - read_at_rest);
            if moved < CONVERGED {
                break;
            }
        }
        deflection
    }

    /// Everywhere something begins, ends, is loaded or read, from the flange on, each once.
    fn stops(&self, load: f64, read: f64) -> Vec<f64> {
        let mut stops: Vec<f64> = self.hinges.iter().map(|hinge| hinge.station).collect();
        stops.extend([0.0, load, read]);
        stops.extend(self.pieces.iter().scan(0.0, |end, piece| {
            *end += piece.length;
            Some(*end)
        }));
        stops.sort_by(f64::total_cmp);
        stops.dedup_by(|a, b| (*a - *b).abs() < SAME);
        stops
    }

    /// The points at `load` and at `read` while `force` acts at the point `loaded`.
    fn integrate(
        &self,
        stops: &[f64],
        force: &Vector3<f64>,
        loaded: &Vector3<f64>,
        load: f64,
        read: f64,
    ) -> [Vector3<f64>; 2] {
        let is_at = |a: f64, b: f64| (a - b).abs() < SAME;
        let carried = |from: f64| if from < load - SAME { *force } else { Vector3::zeros() };
        let mut section = Section { point: Vector3::zeros(), frame: Quaternion::identity() };
        let mut found = [Vector3::zeros(); 2];
        let (mut here, mut number, mut start) = (0.0, 0, 0.0);
        for &stop in stops {
            if let Some(piece) = self.pieces.get(number)
                && stop > here
            {
                section = piece.advance(section, stop - here, &carried(here), loaded);
            }
            here = stop;
            for (found, station) in found.iter_mut().zip([load, read]) {
                if is_at(stop, station) {
                    *found = section.point;
                }
            }
            // a joint at a corner has the axis of the piece before
            for hinge in self.hinges.iter().filter(|hinge| is_at(hinge.station, stop)) {
                let moment = (loaded - section.point).cross(&carried(stop));
                section.turn_by(
                    |m| Vector3::new(hinge.bending * m.x, hinge.bending * m.y, hinge.torsion * m.z),
                    &moment,
                );
            }
            if let Some(piece) = self.pieces.get(number)
                && is_at(stop, start + piece.length)
            {
                start += piece.length;
                number += 1;
                if let Some(next) = self.pieces.get(number) {
                    section.turn_by(|_| Vector3::y() * next.corner, &Vector3::zeros());
                }
            }
        }
        found
    }
}

impl Section {
    /// Turns the frame by a vector that is a function of the moment, both in the frame.
    fn turn_by(&mut self, turn: impl Fn(Vector3<f64>) -> Vector3<f64>, moment: &Vector3<f64>) {
        let frame = UnitQuaternion::new_normalize(self.frame);
        let turn = turn(frame.inverse_transform_vector(moment));
        self.frame = *(frame * UnitQuaternion::from_scaled_axis(turn));
    }
}

impl Piece {
    /// Along a part of this piece, by Runge–Kutta's fourth order.
    fn advance(&self, from: Section, length: f64, force: &Vector3<f64>, loaded: &Vector3<f64>) -> Section {
        let steps = FEWEST_STEPS.max((self.curvature.abs() * length / LARGEST_TURN).ceil() as usize);
        let h = length / steps as f64;
        let slope = |at: &Section| self.slope(at, force, loaded);
        let shifted = |at: &Section, by: &Section, h: f64| Section {
            point: at.point + by.point * h,
            frame: at.frame + by.frame * h,
        };
        let mut at = from;
        for _ in 0..steps {
            let k1 = slope(&at);
            let k2 = slope(&shifted(&at, &k1, h / 2.0));
            let k3 = slope(&shifted(&at, &k2, h / 2.0));
            let k4 = slope(&shifted(&at, &k3, h));
            let mean = Section {
                point: (k1.point + (k2.point + k3.point) * 2.0 + k4.point) / 6.0,
                frame: (k1.frame + (k2.frame + k3.frame) * 2.0 + k4.frame) / 6.0,
            };
            at = shifted(&at, &mean, h);
            at.frame = at.frame.normalize();
        }
        at
    }

    /// p' and the quaternion of R' = R·[κ]×, which is ½·q∘(0, κ). Number by number: a trial spends
    /// most of its time here.
    fn slope(&self, at: &Section, force: &Vector3<f64>, loaded: &Vector3<f64>) -> Section {
        let q = &at.frame;
        let (w, i, j, k) = (q.w, q.i, q.j, q.k);
        let s = 2.0 / (w * w + i * i + j * j + k * k);
        let third = Vector3::new(s * (i * k + w * j), s * (j * k - w * i), 1.0 - s * (i * i + j * j));
        let (mut point, mut curvature) = (third, Vector3::new(0.0, self.curvature, 0.0));
        if *force != Vector3::zeros() {
            let first = Vector3::new(1.0 - s * (j * j + k * k), s * (i * j + w * k), s * (i * k - w * j));
            let second = Vector3::new(s * (i * j - w * k), 1.0 - s * (i * i + k * k), s * (j * k + w * i));
            let moment = (loaded - at.point).cross(force);
            let Flexibility { axial, shear, bending, torsion } = self.flexibility;
            point += (first * first.dot(force) + second * second.dot(force)) * shear
                + third * (axial * third.dot(force));
            curvature += Vector3::new(bending * first.dot(&moment), bending * second.dot(&moment), 0.0);
            curvature.z = torsion * third.dot(&moment);
        }
        let [x, y, z] = <[f64; 3]>::from(curvature * 0.5);
        let frame = Quaternion::new(
            -i * x - j * y - k * z,
            w * x + j * z - k * y,
            w * y + k * x - i * z,
            w * z + i * y - j * x,
        );
        Section { point, frame }
    }
}

#[cfg(test)]
mod tests {
    use std::f64::consts::FRAC_PI_2;

    use super::*;

    fn flexibility(bending: f64) -> Flexibility {
        Flexibility { axial: 0.0, shear: 0.0, bending, torsion: 0.0 }
    }

    fn straight(length: f64, flexibility: Flexibility) -> Piece {
        Piece { length, corner: 0.0, curvature: 0.0, flexibility }
    }

    #[test]
    fn a_small_load_bends_a_cantilever_as_the_closed_form_says() {
        let all = Flexibility { axial: 1e-8, shear: 3e-7, bending: 1e-3, torsion: 2e-3 };
        let body = Body { pieces: vec![straight(0.4, all)], hinges: Vec::new() };
        let (f, l) = (1e-3, 0.4f64);
        let w = body.deflection(&Vector3::new(0.0, f, 0.0), l, l).y;
        assert!((w / (f * (l.powi(3) / 3.0 * 1e-3 + l * 3e-7)) - 1.0).abs() < 1e-8);
        let u = body.deflection(&Vector3::new(0.0, 0.0, 1.0), l, l).z;
        assert!((u / (l * 1e-8) - 1.0).abs() < 1e-6);
        // loaded at a, read at the tip: F·a²(3l − a)/6EI
        let w = body.deflection(&Vector3::new(f, 0.0, 0.0), 0.1, l).x;
        let shear = 0.1 * 3e-7;
        assert!((w / (f * (0.01 * (3.0 * l - 0.1) / 6.0 * 1e-3 + shear)) - 1.0).abs() < 1e-8);
    }

    #[test]
    fn a_large_load_bends_it_into_the_elastica() {
        // PL²/EI = 1: K. Mattiasson, Int. J. Numer. Meth. Eng. 17 (1981) 145, Table I
        let body = Body { pieces: vec![straight(0.125, flexibility(1.0)); 8], hinges: Vec::new() };
        let moved = body.deflection(&Vector3::new(1.0, 0.0, 0.0), 1.0, 1.0);
        assert!((moved.x - 0.30172).abs() < 1e-5 && (moved.z + 0.05643).abs() < 1e-5, "{moved}");
    }

    #[test]
    fn a_corner_twists_the_pipe_before_it_and_a_joint_turns_what_is_beyond() {
        let twisting = Flexibility { torsion: 1e-3, ..flexibility(0.0) };
        let corner = Piece { corner: FRAC_PI_2, ..straight(0.5, flexibility(0.0)) };
        let mut body = Body { pieces: vec![straight(0.2, twisting), corner], hinges: Vec::new() };
        // F along y at the end of the arm: torque F·0.5 on pipe I
        let force = Vector3::new(0.0, 1e-2, 0.0);
        let w = body.deflection(&force, 0.7, 0.7).y;
        assert!((w / (1e-2 * 0.25 * 0.2 * 1e-3) - 1.0).abs() < 1e-6, "{w}");
        body.pieces[0].flexibility = flexibility(0.0);
        body.hinges.push(Hinge { station: 0.2, bending: 0.0, torsion: 1e-3 });
        let at_corner = body.deflection(&force, 0.7, 0.7).y;
        assert!((at_corner / (1e-2 * 0.25 * 1e-3) - 1.0).abs() < 1e-6, "{at_corner}");
    }

    #[test]
    fn an_arc_is_as_long_as_it_should_and_ends_where_it_should() {
        let arc = Piece { curvature: FRAC_PI_2 / 0.1, ..straight(0.1, flexibility(0.0)) };
        let body =
            Body { pieces: vec![arc], hinges: vec![Hinge { station: 0.0, bending: 1e-6, torsion: 0.0 }] };
        // the root turns about −x under a load along y: the tip is at R·(1, 0, 1)
        let radius = 0.1 / FRAC_PI_2;
        let moved = body.deflection(&Vector3::new(0.0, 1.0, 0.0), 0.1, 0.1);
        assert!((moved.y / (1e-6 * radius * radius) - 1.0).abs() < 1e-4, "{moved}");
    }
}
