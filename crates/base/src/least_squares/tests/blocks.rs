//! Jacobians that arrive in blocks of rows.

use approx::assert_relative_eq;
use nalgebra::{DMatrix, DVector};

use crate::error::Error;
use crate::least_squares::*;

/// rᵢ = p₁·exp(−p₂·tᵢ) + p₃·tᵢ + p₄·sin tᵢ + p₅ − yᵢ, its Jacobian in blocks only.
struct Blocks {
    m: usize,
    block: usize,
    /// Columns three and four are the same: no residual tells p₃ from p₄.
    twins: bool,
    /// A row where the derivatives are not finite.
    broken: Option<usize>,
}

const TRUTH: [f64; 5] = [3.0, 0.7, -0.2, 0.5, 1.0];

impl Blocks {
    fn new(m: usize, block: usize) -> Self {
        Blocks { m, block, twins: false, broken: None }
    }

    fn t(&self, i: usize) -> f64 {
        5.0 * i as f64 / self.m as f64
    }

    fn value(&self, p: &[f64], i: usize) -> f64 {
        let t = self.t(i);
        let fourth = if self.twins { t } else { t.sin() };
        p[0] * (-p[1] * t).exp() + p[2] * t + p[3] * fourth + p[4]
    }

    fn row(&self, p: &DVector<f64>, i: usize) -> [f64; 5] {
        let t = self.t(i);
        if self.broken == Some(i) {
            return [f64::NAN; 5];
        }
        let decay = (-p[1] * t).exp();
        [decay, -p[0] * t * decay, t, if self.twins { t } else { t.sin() }, 1.0]
    }
}

impl Problem for Blocks {
    fn parameter_count(&self) -> usize {
        5
    }

    fn residual_count(&self) -> usize {
        self.m
    }

    fn residuals(&self, p: &DVector<f64>) -> DVector<f64> {
        let noise = |i: usize| 0.01 * ((7 * i % 11) as f64 - 5.0);
        DVector::from_fn(self.m, |i, _| self.value(p.as_slice(), i) - self.value(&TRUTH, i) - noise(i))
    }

    fn jacobian(&self, _: &DVector<f64>) -> DMatrix<f64> {
        unreachable!("the whole Jacobian is never needed")
    }

    fn jacobian_blocks(&self, p: &DVector<f64>, visit: &mut dyn FnMut(usize, &DMatrix<f64>)) {
        for first in (0..self.m).step_by(self.block) {
            let rows = self.block.min(self.m - first);
            visit(first, &DMatrix::from_fn(rows, 5, |i, j| self.row(p, first + i)[j]));
        }
    }
}

/// The same problem with its Jacobian in one piece.
struct Whole(Blocks);

impl Problem for Whole {
    fn parameter_count(&self) -> usize {
        5
    }

    fn residual_count(&self) -> usize {
        self.0.m
    }

    fn residuals(&self, p: &DVector<f64>) -> DVector<f64> {
        self.0.residuals(p)
    }

    fn jacobian(&self, p: &DVector<f64>) -> DMatrix<f64> {
        assembled(&self.0, p)
    }
}

fn start() -> DVector<f64> {
    DVector::from_column_slice(&[2.0, 1.0, 0.0, 0.0, 0.0])
}

#[test]
fn blocks_of_every_size_give_the_fit_of_the_whole() {
    let priors = vec![Prior { parameter: 1, value: 0.6, sd: 0.05 }];
    let with_prior = Options { priors, noise: Noise::Known(0.03), ..Options::default() };
    let robust = Robust::Huber { k: 1.345, scale: RobustScale::Mad };
    let robust = Options { robust, ..Options::default() };
    for options in [Options::default(), with_prior, robust] {
        let whole = fit(&Whole(Blocks::new(2000, 2000)), &start(), &options).unwrap();
        assert!(whole.is_converged(), "{}", whole.reason);
        for block in [1, 3, 256, 1999] {
            let blocks = fit(&Blocks::new(2000, block), &start(), &options).unwrap();
            assert_eq!((blocks.reason, blocks.iterations), (whole.reason, whole.iterations));
            assert_relative_eq!(blocks.parameters, whole.parameters, max_relative = 1e-11);
            assert_relative_eq!(
                blocks.covariance.matrix,
                whole.covariance.matrix,
                max_relative = 1e-9,
                epsilon = 1e-15
            );
        }
    }
}

#[test]
fn a_tall_problem_is_never_held_whole() {
    let fit = fit(&Blocks::new(20_000, 256), &start(), &Options::default()).unwrap();
    assert_eq!(fit.reason, TerminationReason::GradientAndStep);
    for (j, error) in fit.standard_errors().into_iter().enumerate() {
        assert!((fit.parameters[j] - TRUTH[j]).abs() < 4.0 * error.unwrap(), "{j}");
    }
}

#[test]
fn what_no_block_tells_apart_is_not_identified() {
    let twins = Blocks { twins: true, ..Blocks::new(20_000, 256) };
    let fit = fit(&twins, &start(), &Options::default()).unwrap();
    assert!(fit.is_converged(), "{}", fit.reason);
    use Standing::{Estimated, NotIdentified};
    let standing = [Estimated, Estimated, NotIdentified, NotIdentified, Estimated];
    assert_eq!((fit.covariance.standing, fit.covariance.rank), (standing.to_vec(), 4));
    // of all solutions the one nearest to the start, and that has p₃ = p₄
    assert_relative_eq!(fit.parameters[2], fit.parameters[3], max_relative = 1e-6);
}

#[test]
fn a_derivative_that_is_no_number_is_reported_from_any_block() {
    let broken = Blocks { broken: Some(2 * 256 + 5), ..Blocks::new(2000, 256) };
    let fit = fit(&broken, &start(), &Options::default()).unwrap();
    assert_eq!(fit.reason, TerminationReason::NonFiniteJacobian);
}

#[test]
fn blocks_that_do_not_fit_together_are_refused() {
    struct Gap(Blocks);
    impl Problem for Gap {
        fn parameter_count(&self) -> usize {
            5
        }
        fn residual_count(&self) -> usize {
            self.0.m
        }
        fn residuals(&self, p: &DVector<f64>) -> DVector<f64> {
            self.0.residuals(p)
        }
        fn jacobian(&self, p: &DVector<f64>) -> DMatrix<f64> {
            self.0.jacobian(p)
        }
        fn jacobian_blocks(&self, p: &DVector<f64>, visit: &mut dyn FnMut(usize, &DMatrix<f64>)) {
            self.0.jacobian_blocks(p, &mut |first, block| {
                if first != 10 {
                    visit(first, block);
                }
            });
        }
    }
    let refused = |m| match fit(&Gap(Blocks::new(m, 10)), &start(), &Options::default()) {
        Err(Error::Argument { found, .. }) => found,
        other => format!("{other:?}"),
    };
    assert_eq!(refused(40), "a Jacobian of a block of 10 x 5 at row 20, after 10 rows");
    assert_eq!(refused(20), "a Jacobian of 10 rows");
}
