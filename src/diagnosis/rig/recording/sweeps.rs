//! A displacement that moves on evenly, read with noise.
//!
//! From one sharp turn to the next a cubic spline says where the slide was (C. de Boor, *A
//! Practical Guide to Splines*, Springer 2001), and how well that is known:
//!
//! ```text
//! û = B·c,   c = (BᵀB)⁻¹·Bᵀ·u,   cov û = s²·B·(BᵀB)⁻¹·Bᵀ = E·Eᵀ,   E = s·B·R⁻¹,   BᵀB = RᵀR
//! ```
//!
//! Its knots lie as far apart as what it leaves of the readings allows, and by half of that, so
//! that it leaves out nothing that the readings are too few to show.

use std::ops::Range;

use nalgebra::{Cholesky, DMatrix, DVector, Dyn};

use super::estimate::{Estimate, most_errors};
use super::turns::Ways;

/// Readings of a sweep from which on it is one, and of each of its ways.
const FEWEST: usize = 30;
const OF_WAY: usize = 8;
/// Readings from knot to knot.
const SPACINGS: [usize; 5] = [96, 48, 24, 12, 6];
/// Readings scatter by less than this share of the largest displacement.
const WITHIN: f64 = 0.01;
/// More knots are better where they take more than as many standard deviations off χ².
const BETTER: f64 = 3.0;
const ORDER: usize = 4;

/// Where a slide was that moved on evenly.
pub struct Sweep {
    /// Of each reading.
    pub estimate: Estimate,
    splines: Vec<Spline>,
}

/// One way.
struct Spline {
    basis: DMatrix<f64>,
    normal: Cholesky<f64, Dyn>,
}

/// Of displacements that were read one after the other at these places of their course, which
/// increase; nothing where they are no sweep.
pub fn swept(u: &[f64], at: &[f64]) -> Option<Sweep> {
    let ways = Ways::of(u)?.ways;
    if u.len() < FEWEST || ways.iter().any(|way| way.len() < OF_WAY) {
        return None;
    }
    let coefficients = |spacing| ways.iter().map(|way| coefficients(way.len(), spacing)).sum::<usize>();
    let with = |spacing: usize| -> Option<Fit> {
        let own = |way: &Range<usize>| Spline::new(&at[way.clone()], spacing);
        Some(Fit::of(ways.iter().map(own).collect::<Option<_>>()?, u))
    };
    let few = |spacing: &usize| coefficients(*spacing) <= most_errors(u.len()).min(u.len() / 2);
    let fits: Vec<Fit> = SPACINGS.into_iter().filter(few).filter_map(with).collect();
    // the coarsest that no finer one is better than, and the next finer one of it
    let coarsest = (0..fits.len()).find(|&k| fits[k + 1..].iter().all(|finer| !finer.is_better(&fits[k])))?;
    let fit = fits.into_iter().nth(coarsest + 1)?;
    let largest = u.iter().fold(0.0, |most: f64, u| most.max(u.abs()));
    let sd = fit.variance().sqrt();
    (sd <= WITHIN * largest).then(|| {
        let errors = fit.errors() * sd;
        Sweep { estimate: Estimate { values: fit.values, errors }, splines: fit.splines }
    })
}

impl Sweep {
    /// What the same splines make of values that were read with the displacements.
    pub fn smooth(&self, values: &[f64]) -> Vec<f64> {
        smooth(&self.splines, values)
    }
}

fn smooth(splines: &[Spline], values: &[f64]) -> Vec<f64> {
    let mut rest = values;
    let mut all = Vec::with_capacity(values.len());
    for spline in splines {
        let (own, after) = rest.split_at(spline.basis.nrows());
        let right = spline.basis.tr_mul(&DVector::from_row_slice(own));
        all.extend((&spline.basis * spline.normal.solve(&right)).iter());
        rest = after;
    }
    all
}

/// Splines of all ways with the same distance of knots.
struct Fit {
    splines: Vec<Spline>,
    coefficients: usize,
    values: Vec<f64>,
    /// Sum of the squares that they leave.
    square: f64,
}

impl Fit {
    fn of(splines: Vec<Spline>, u: &[f64]) -> Fit {
        let values = smooth(&splines, u);
        let square = u.iter().zip(&values).map(|(u, value)| (u - value).powi(2)).sum();
        Fit { coefficients: splines.iter().map(|own| own.basis.ncols()).sum(), splines, values, square }
    }

    fn variance(&self) -> f64 {
        self.square / (self.values.len() - self.coefficients) as f64
    }

    /// Does it leave less than a coarser one, by more than chance?
    fn is_better(&self, coarser: &Fit) -> bool {
        let more = self.coefficients.saturating_sub(coarser.coefficients) as f64;
        let taken = (coarser.square - self.square) / self.variance();
        taken > more + BETTER * (2.0 * more).sqrt()
    }

    /// E/s.
    fn errors(&self) -> DMatrix<f64> {
        let mut errors = DMatrix::zeros(self.values.len(), self.coefficients);
        let (mut row, mut column) = (0, 0);
        for Spline { basis, normal } in &self.splines {
            let mut own = basis.transpose();
            normal.l_dirty().solve_lower_triangular_mut(&mut own);
            errors.view_mut((row, column), basis.shape()).copy_from(&own.transpose());
            row += basis.nrows();
            column += basis.ncols();
        }
        errors
    }
}

impl Spline {
    /// Of readings at these places, about as many from knot to knot; nothing where they do not
    /// determine it.
    fn new(at: &[f64], spacing: usize) -> Option<Spline> {
        let columns = coefficients(at.len(), spacing);
        let pieces = (columns + 1 - ORDER) as f64;
        let (first, last) = (*at.first()?, *at.last()?);
        let width = (last - first) / pieces;
        let mut basis = DMatrix::zeros(at.len(), columns);
        for (row, at) in at.iter().enumerate() {
            let place = (at - first) / width;
            let piece = place.floor().clamp(0.0, pieces - 1.0);
            for (k, value) in cubic(place - piece).into_iter().enumerate() {
                basis[(row, piece as usize + k)] = value;
            }
        }
        let normal = Cholesky::new(basis.tr_mul(&basis))?;
        Some(Spline { basis, normal })
    }
}

/// How many coefficients a way of so many readings has.
fn coefficients(readings: usize, spacing: usize) -> usize {
    (readings as f64 / spacing as f64).round().max(1.0) as usize + ORDER - 1
}

/// The four uniform cubic B-splines that are not zero at x from a knot on, 0 ≤ x ≤ 1.
fn cubic(x: f64) -> [f64; ORDER] {
    let y = 1.0 - x;
    [
        y.powi(3) / 6.0,
        (3.0 * x.powi(3) - 6.0 * x * x + 4.0) / 6.0,
        (3.0 * y.powi(3) - 6.0 * y * y + 4.0) / 6.0,
        x.powi(3) / 6.0,
    ]
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::statistics::Random;

    /// To and fro smoothly, by 400, in 250 readings, with noise.
    fn read(noise: f64) -> (Vec<f64>, Vec<f64>) {
        let mut random = Random::seeded(7, 0);
        let exact: Vec<f64> =
            (0..1000).map(|k| 400.0 * (f64::from(k) * std::f64::consts::TAU / 250.0).sin()).collect();
        let read = exact.iter().map(|u| u + noise * random.normal()).collect();
        (exact, read)
    }

    #[test]
    fn a_sweep_is_known_as_well_as_it_says() {
        let at: Vec<f64> = (0..1000).map(f64::from).collect();
        let (exact, read) = read(1.0);
        let found = swept(&read, &at).unwrap().estimate;
        let off: Vec<f64> = found.values.iter().zip(&exact).map(|(a, b)| a - b).collect();
        let square = |own: &[f64]| own.iter().map(|e| e * e).sum::<f64>();
        assert!(square(&off) < 0.2 * 1000.0);
        let said = found.errors.norm_squared();
        assert!((square(&off) / said - 1.0).abs() < 0.4, "{} {said}", square(&off));
    }

    #[test]
    fn a_sharp_turn_is_none_of_a_curve() {
        let mut random = Random::seeded(8, 0);
        let exact: Vec<f64> = (0..400).map(|k: i32| 5.0 * f64::from((k % 200 - 100).abs())).collect();
        let read: Vec<f64> = exact.iter().map(|u| u + 0.5 * random.normal()).collect();
        let at: Vec<f64> = (0..400).map(f64::from).collect();
        let found = swept(&read, &at).unwrap().estimate;
        let most = found.values.iter().zip(&exact).fold(0.0, |most: f64, (a, b)| most.max((a - b).abs()));
        assert!(most < 1.2, "{most}");
        // in no order there is no sweep
        let chance: Vec<f64> = (0..400).map(|_| 300.0 * random.normal()).collect();
        assert!(swept(&chance, &at).is_none());
    }
}
