//! Shear coefficients and torsion constants against finite-element solutions of the section.
//!
//! Saint-Venant's flexure of a transversely isotropic bar (axis z, force along x; docs/beam.md has
//! the derivation): with curvature growing by 1 per length, W is the warping with
//! ∬ (∇W + p)·∇v = −e ∬ x v for every v, p = ν((x² − y²)/2, xy), e = E/G. Cowper's coefficient is
//! κ = −e I / (ν(∬x² − ∬y²)/2 + (A/I) ∬ x W), I = ∬x².
//!
//! Torsion: ∬ (∇φ + (−y, x))·∇v = 0, J = ∬ (x² + y² + x φ_y − y φ_x).

use approx::{assert_abs_diff_eq, assert_relative_eq};
use nalgebra::{DMatrix, DVector, Vector2};
use rodcal::section::{Rectangle, Round, Section};

/// A quarter of a doubly symmetric section, x ≥ 0 and y ≥ 0, in quadrilaterals of nine nodes.
struct Quarter {
    points: Vec<Vector2<f64>>,
    elements: Vec<[usize; 9]>,
}

impl Quarter {
    /// Elements between the lines `us` and `vs` of a grid that `at` maps onto the section, without
    /// those whose middle lies in the `hole`.
    fn new(
        us: &[f64],
        vs: &[f64],
        at: impl Fn(f64, f64) -> (f64, f64),
        hole: impl Fn(f64, f64) -> bool,
    ) -> Self {
        let halves = |lines: &[f64]| -> Vec<f64> {
            let between = lines.windows(2).flat_map(|ends| [ends[0], (ends[0] + ends[1]) / 2.0]);
            between.chain(lines.last().copied()).collect()
        };
        let (u, v) = (halves(us), halves(vs));
        let mut number = vec![None; u.len() * v.len()];
        let mut quarter = Quarter { points: Vec::new(), elements: Vec::new() };
        for i in 0..us.len() - 1 {
            for j in 0..vs.len() - 1 {
                if hole(u[2 * i + 1], v[2 * j + 1]) {
                    continue;
                }
                quarter.elements.push(std::array::from_fn(|k| {
                    let (row, column) = (2 * i + k / 3, 2 * j + k % 3);
                    *number[row * v.len() + column].get_or_insert_with(|| {
                        let (x, y) = at(u[row], v[column]);
                        quarter.points.push(Vector2::new(x, y));
                        quarter.points.len() - 1
                    })
                }));
            }
        }
        quarter
    }

    fn annulus(m: f64) -> Quarter {
        let (radial, angular) = (even(m, 1.0, 6), even(0.0, std::f64::consts::FRAC_PI_2, 10));
        Quarter::new(&radial, &angular, |r, a| (r * a.cos(), r * a.sin()), |_, _| false)
    }

    /// `along` the force, `across` it.
    fn rectangle(along: f64, across: f64) -> Quarter {
        let (x, y) = (even(0.0, along / 2.0, 8), even(0.0, across / 2.0, 8));
        Quarter::new(&x, &y, |x, y| (x, y), |_, _| false)
    }

    fn hollow(along: f64, across: f64, wall: f64) -> Quarter {
        let lines = |side: f64| {
            let mut lines = even(0.0, side / 2.0 - wall, 7);
            lines.pop();
            lines.extend(even(side / 2.0 - wall, side / 2.0, 3));
            lines
        };
        let is_hole = |x: f64, y: f64| x < along / 2.0 - wall && y < across / 2.0 - wall;
        Quarter::new(&lines(along), &lines(across), |x, y| (x, y), is_hole)
    }

    /// Every Gauss point: element, shape functions, their gradients, place, weight.
    fn integrate(&self, mut add: impl FnMut(&[usize; 9], &[f64; 9], &[Vector2<f64>; 9], Vector2<f64>, f64)) {
        let gauss = [(-0.6f64.sqrt(), 5.0 / 9.0), (0.0, 8.0 / 9.0), (0.6f64.sqrt(), 5.0 / 9.0)];
        let line = |t: f64| [t * (t - 1.0) / 2.0, 1.0 - t * t, t * (t + 1.0) / 2.0];
        let slope = |t: f64| [t - 0.5, -2.0 * t, t + 0.5];
        for element in &self.elements {
            for (a, wa) in gauss {
                for (b, wb) in gauss {
                    let n: [f64; 9] = std::array::from_fn(|k| line(a)[k / 3] * line(b)[k % 3]);
                    let d: [Vector2<f64>; 9] = std::array::from_fn(|k| {
                        Vector2::new(slope(a)[k / 3] * line(b)[k % 3], line(a)[k / 3] * slope(b)[k % 3])
                    });
                    let point = |k: usize| self.points[element[k]];
                    let place = (0..9).map(|k| point(k) * n[k]).sum();
                    let jacobian: nalgebra::Matrix2<f64> = (0..9).map(|k| d[k] * point(k).transpose()).sum();
                    let inverse = jacobian.try_inverse().unwrap();
                    let gradient = d.map(|d| inverse * d);
                    add(element, &n, &gradient, place, wa * wb * jacobian.determinant().abs());
                }
            }
        }
    }

    /// The function that is 0 where `is_held` and solves ∬ ∇f·∇v = load(v).
    fn solve(
        &self,
        is_held: impl Fn(&Vector2<f64>) -> bool,
        load: impl Fn(f64, Vector2<f64>, Vector2<f64>) -> f64,
    ) -> Vec<f64> {
        let free: Vec<usize> = (0..self.points.len()).filter(|&k| !is_held(&self.points[k])).collect();
        let mut place = vec![usize::MAX; self.points.len()];
        free.iter().enumerate().for_each(|(row, &k)| place[k] = row);
        let (mut matrix, mut right) = (DMatrix::zeros(free.len(), free.len()), DVector::zeros(free.len()));
        self.integrate(|element, n, gradient, at, weight| {
            for i in 0..9 {
                let row = place[element[i]];
                if row == usize::MAX {
                    continue;
                }
                right[row] += weight * load(n[i], gradient[i], at);
                for j in 0..9 {
                    let column = place[element[j]];
                    if column != usize::MAX {
                        matrix[(row, column)] += weight * gradient[i].dot(&gradient[j]);
                    }
                }
            }
        });
        let solved = matrix.cholesky().unwrap().solve(&right);
        place.iter().map(|&row| if row == usize::MAX { 0.0 } else { solved[row] }).collect()
    }

    /// Cowper's κ for a force along x.
    fn kappa(&self, e: f64, nu: f64) -> f64 {
        let p = |at: Vector2<f64>| Vector2::new((at.x * at.x - at.y * at.y) / 2.0, at.x * at.y) * nu;
        // W is odd in x
        let warping = self.solve(|at| at.x.abs() < 1e-12, |v, slope, at| -e * at.x * v - p(at).dot(&slope));
        let (mut area, mut ixx, mut iyy, mut xw) = (0.0, 0.0, 0.0, 0.0);
        self.integrate(|element, n, _, at, weight| {
            area += weight;
            ixx += weight * at.x * at.x;
            iyy += weight * at.y * at.y;
            xw += weight * at.x * (0..9).map(|k| n[k] * warping[element[k]]).sum::<f64>();
        });
        -e * ixx / (nu * (ixx - iyy) / 2.0 + area / ixx * xw)
    }

    /// J of the whole section.
    fn torsion_constant(&self) -> f64 {
        // φ is odd in x and in y
        let is_held = |at: &Vector2<f64>| at.x.abs() < 1e-12 || at.y.abs() < 1e-12;
        let warping = self.solve(is_held, |_, slope, at| at.y * slope.x - at.x * slope.y);
        let mut j = 0.0;
        self.integrate(|element, _, gradient, at, weight| {
            let slope: Vector2<f64> = (0..9).map(|k| gradient[k] * warping[element[k]]).sum();
            j += weight * (at.norm_squared() + at.x * slope.y - at.y * slope.x);
        });
        4.0 * j
    }
}

fn even(from: f64, to: f64, count: usize) -> Vec<f64> {
    (0..=count).map(|k| from + (to - from) * k as f64 / count as f64).collect()
}

/// The interface's formula is the exact solution: agreement to what the mesh leaves, 2e-5.
#[test]
fn a_hollow_circle_of_an_anisotropic_material() {
    for m in [0.0, 0.5, 0.87, 0.94] {
        let section = Quarter::annulus(m);
        for (e, nu) in [(2.6, 0.3), (12.4, 0.3), (30.0, 0.3), (12.4, 0.0), (12.4, 0.5), (1.4, 0.6)] {
            let formula = Round::tube(1.0, m).shear_coefficient(e, nu);
            assert_relative_eq!(section.kappa(e, nu), formula, max_relative = 2e-5);
        }
    }
}

/// The function that the derivation finds, W = (C r³ − q(1 + m²) r − q m²/r) cos θ with
/// C = (e − 2ν)/8 and q = (3e − 2ν)/8, is the one that the elements find.
#[test]
fn the_warping_of_the_derivation_is_that_of_the_elements() {
    let (m, e, nu) = (0.5, 12.4, 0.3);
    let section = Quarter::annulus(m);
    let p = |at: Vector2<f64>| Vector2::new((at.x * at.x - at.y * at.y) / 2.0, at.x * at.y) * nu;
    let found = section.solve(|at| at.x.abs() < 1e-12, |v, slope, at| -e * at.x * v - p(at).dot(&slope));
    let (c, q) = ((e - 2.0 * nu) / 8.0, (3.0 * e - 2.0 * nu) / 8.0);
    for (at, warping) in section.points.iter().zip(found) {
        let r2 = at.norm_squared();
        let derived = at.x * (c * r2 - q * (1.0 + m * m) - q * m * m / r2);
        assert_abs_diff_eq!(warping, derived, epsilon = 2e-4);
    }
}

/// What the formula replaces: Cowper's with ν = E/2G − 1 is wrong by a quarter for a carbon tube.
#[test]
fn the_ratio_of_the_moduli_is_no_poisson_ratio() {
    let (e, m) = (118.0 / 9.5, 26.0 / 30.0);
    let exact = Quarter::annulus(m).kappa(e, 0.3);
    assert_abs_diff_eq!(exact, 0.510, epsilon = 5e-4);
    let as_if_isotropic = Round::tube(1.0, m).shear_coefficient(e, e / 2.0 - 1.0);
    assert_abs_diff_eq!(as_if_isotropic, 0.637, epsilon = 5e-4);
}

/// κ = 5e/(6e − ν), whatever the sides; the elements leave 1e-4.
#[test]
fn a_solid_rectangle() {
    for (along, across) in [(1.0, 1.0), (2.0, 1.0), (1.0, 3.0)] {
        let section = Quarter::rectangle(along, across);
        let rectangle = Rectangle::solid(across, along);
        for (e, nu) in [(2.6, 0.3), (12.4, 0.3), (30.0, 0.0)] {
            let [kappa, _] = rectangle.shear_coefficients(e, nu);
            assert_relative_eq!(section.kappa(e, nu), kappa, max_relative = 1e-4);
        }
        assert_relative_eq!(section.torsion_constant(), rectangle.torsion_constant(), max_relative = 2e-4);
    }
}

/// Formulas of thin walls: they leave 0.7 of wall over shorter side (1.75 and 3.5 % here), so that
/// the error goes with the wall.
#[test]
fn a_box() {
    for wall in [0.05, 0.025] {
        for (along, across) in [(1.0, 1.0), (2.0, 1.0), (1.0, 2.0)] {
            let section = Quarter::hollow(along, across, wall);
            let hollow = Section::from(Rectangle::hollow(across, along, wall));
            for (e, nu) in [(2.6, 0.3), (12.4, 0.3)] {
                let [kappa, _] = hollow.shear_coefficients(e, nu);
                assert_relative_eq!(section.kappa(e, nu), kappa, max_relative = 0.7 * wall);
            }
            let j = hollow.torsion_constant();
            assert_relative_eq!(section.torsion_constant(), j, max_relative = 0.7 * wall);
        }
    }
}
