//! Fits whose answers are published or can be derived by hand.

use approx::assert_relative_eq;
use nalgebra::{DMatrix, DVector, dmatrix, dvector};

use super::*;

mod blocks;

/// A problem from two closures.
struct Closures<R, J> {
    n: usize,
    m: usize,
    r: R,
    j: J,
}

impl<R, J> Problem for Closures<R, J>
where
    R: Fn(&DVector<f64>) -> DVector<f64>,
    J: Fn(&DVector<f64>) -> DMatrix<f64>,
{
    fn parameter_count(&self) -> usize {
        self.n
    }
    fn residual_count(&self) -> usize {
        self.m
    }
    fn residuals(&self, p: &DVector<f64>) -> DVector<f64> {
        (self.r)(p)
    }
    fn jacobian(&self, p: &DVector<f64>) -> DMatrix<f64> {
        (self.j)(p)
    }
}

fn default_fit(problem: &dyn Problem, start: DVector<f64>) -> Fit {
    fit(problem, &start, &Options::default()).unwrap()
}

/// 1, x per row.
fn line(x: &[f64]) -> DMatrix<f64> {
    DMatrix::from_fn(x.len(), 2, |i, j| if j == 0 { 1.0 } else { x[i] })
}

/// Operation of a plant oxidising ammonia: Brownlee, *Statistical Theory and Methodology in Science
/// and Engineering*, 2nd ed., 1965, p. 454. Intercept, air flow, water temperature, acid
/// concentration; stack loss.
fn stack_loss() -> (DMatrix<f64>, DVector<f64>) {
    let air = [80, 80, 75, 62, 62, 62, 62, 62, 58, 58, 58, 58, 58, 58, 50, 50, 50, 50, 50, 56, 70];
    let water = [27, 27, 25, 24, 22, 23, 24, 24, 23, 18, 18, 17, 18, 19, 18, 18, 19, 19, 20, 20, 20];
    let acid = [89, 88, 90, 87, 87, 87, 93, 93, 87, 80, 89, 88, 82, 93, 89, 86, 72, 79, 80, 82, 91];
    let loss = [42, 37, 37, 28, 18, 18, 19, 20, 15, 14, 14, 13, 11, 12, 8, 7, 8, 8, 9, 15, 15];
    let design = DMatrix::from_fn(21, 4, |i, j| f64::from([1, air[i], water[i], acid[i]][j]));
    (design, DVector::from_iterator(21, loss.map(f64::from)))
}

#[test]
fn a_straight_line_with_its_standard_errors() {
    // by hand: β = (3.5, 1.4), S = 4.2, s² = 2.1, Sxx = 5, x̄ = 2.5
    let y = dvector![6.0, 5.0, 7.0, 10.0];
    let fit = linear(&line(&[1.0, 2.0, 3.0, 4.0]), &y, None, &Options::default()).unwrap();
    assert!(fit.is_converged() && fit.degrees_of_freedom == 2);
    assert_relative_eq!(fit.parameters, dvector![3.5, 1.4], max_relative = 1e-14);
    assert_relative_eq!(fit.sum_of_squares, 4.2, max_relative = 1e-14);
    let errors = fit.standard_errors();
    assert_relative_eq!(errors[0].unwrap(), (2.1f64 * (0.25 + 6.25 / 5.0)).sqrt(), max_relative = 1e-14);
    assert_relative_eq!(errors[1].unwrap(), (2.1f64 / 5.0).sqrt(), max_relative = 1e-14);
    // corr = −x̄/√(x̄² + Sxx/n)
    let expected = -2.5 / (6.25f64 + 5.0 / 4.0).sqrt();
    assert_relative_eq!(fit.covariance.correlation()[(0, 1)], expected, max_relative = 1e-13);
}

#[test]
fn a_weight_of_two_is_the_observation_twice() {
    let once = dvector![6.0, 5.0, 7.0, 10.0];
    let twice = dvector![6.0, 5.0, 7.0, 10.0, 10.0];
    let weights = dvector![1.0, 1.0, 1.0, 2.0];
    let options = Options { noise: Noise::Known(1.0), ..Options::default() };
    let a = linear(&line(&[1.0, 2.0, 3.0, 4.0]), &once, Some(&weights), &options).unwrap();
    let b = linear(&line(&[1.0, 2.0, 3.0, 4.0, 4.0]), &twice, None, &options).unwrap();
    assert_relative_eq!(a.parameters, b.parameters, max_relative = 1e-13);
    assert_relative_eq!(a.covariance.matrix, b.covariance.matrix, max_relative = 1e-13);
}

#[test]
fn the_stack_loss_regression_is_the_published_one() {
    let (design, y) = stack_loss();
    let fit = linear(&design, &y, None, &Options::default()).unwrap();
    // Draper & Smith, Applied Regression Analysis, ch. 6, and every statistics package since
    let published = dvector![-39.9197, 0.7156, 1.2953, -0.1521];
    assert_relative_eq!(fit.parameters, published, epsilon = 6e-5);
    assert_relative_eq!(fit.residual_sd.unwrap(), 3.243, epsilon = 5e-4);
    for (error, published) in fit.standard_errors().iter().zip([11.8960, 0.1349, 0.3680, 0.1563]) {
        assert_relative_eq!(error.unwrap(), published, epsilon = 6e-5);
    }
}

#[test]
fn the_robust_stack_loss_regression_is_that_of_statsmodels() {
    let (design, y) = stack_loss();
    let robust = Robust::Huber { k: 1.345, scale: RobustScale::Mad };
    let fit = linear(&design, &y, None, &Options { robust, ..Options::default() }).unwrap();
    assert!(fit.is_converged(), "{}", fit.reason);
    // statsmodels, RLM with HuberT and covariance H1: the example of its documentation
    let published = dvector![-41.02649835, 0.82938433, 0.92606597, -0.12784672];
    assert_relative_eq!(fit.parameters, published, max_relative = 1e-4);
    for (error, published) in
        fit.standard_errors().iter().zip([9.79189854, 0.11100521, 0.30293016, 0.12864961])
    {
        assert_relative_eq!(error.unwrap(), published, max_relative = 1e-4);
    }
}

#[test]
fn tukey_forgets_a_gross_outlier_altogether() {
    let x: Vec<f64> = (0..20).map(f64::from).collect();
    let wiggle = |i: usize| 0.01 * ((7 * i % 11) as f64 - 5.0);
    let mut y = DVector::from_fn(20, |i, _| 2.0 + 3.0 * x[i] + wiggle(i));
    let clean: Vec<usize> = (0..20).filter(|&i| i != 13).collect();
    y[13] += 1000.0;
    // c so large that the others keep practically all of their weight
    let robust = Robust::Tukey { c: 1e4, scale: RobustScale::Given(0.03) };
    let with = linear(&line(&x), &y, None, &Options { robust, ..Options::default() }).unwrap();
    let x_clean: Vec<f64> = clean.iter().map(|&i| x[i]).collect();
    let y_clean = DVector::from_fn(19, |k, _| y[clean[k]]);
    let without = linear(&line(&x_clean), &y_clean, None, &Options::default()).unwrap();
    assert!(with.is_converged() && with.weights[13] == 0.0);
    assert_relative_eq!(with.parameters, without.parameters, max_relative = 1e-6);
}

#[test]
fn rosenbrock_from_the_classical_start() {
    // Moré, Garbow & Hillstrom, ACM TOMS 7 (1981) 17–41, problem 1: r = (10(p₂ − p₁²), 1 − p₁),
    // minimum 0 at (1, 1)
    let problem = Closures {
        n: 2,
        m: 2,
        r: |p: &DVector<f64>| dvector![10.0 * (p[1] - p[0] * p[0]), 1.0 - p[0]],
        j: |p: &DVector<f64>| dmatrix![-20.0 * p[0], 10.0; -1.0, 0.0],
    };
    let fit = default_fit(&problem, dvector![-1.2, 1.0]);
    assert!(fit.is_converged(), "{}", fit.reason);
    assert_relative_eq!(fit.parameters, dvector![1.0, 1.0], epsilon = 1e-14);
    // as many parameters as residuals: the noise cannot be estimated
    assert_eq!((fit.residual_sd, fit.standard_errors()), (None, vec![None, None]));
}

/// Jennrich & Sampson's function: rᵢ = 2 + 2i − (exp(i·p₁) + exp(i·p₂)), i = 1 … 10.
fn jennrich_sampson() -> impl Problem {
    let i = |k: usize| (k + 1) as f64;
    Closures {
        n: 2,
        m: 10,
        r: move |p: &DVector<f64>| {
            DVector::from_fn(10, |k, _| 2.0 + 2.0 * i(k) - (i(k) * p[0]).exp() - (i(k) * p[1]).exp())
        },
        j: move |p: &DVector<f64>| DMatrix::from_fn(10, 2, |k, j| -i(k) * (i(k) * p[j]).exp()),
    }
}

#[test]
fn where_two_columns_become_one_the_search_arrives_but_does_not_vouch_for_it() {
    // Moré, Garbow & Hillstrom, problem 6: S = 124.362 at p₁ = p₂ = 0.2578. The tangent plane loses
    // a direction just there, so the residuals are never seen to be orthogonal to it.
    let fit = default_fit(&jennrich_sampson(), dvector![0.3, 0.4]);
    assert_relative_eq!(fit.sum_of_squares, 124.362, epsilon = 5e-4);
    assert_relative_eq!(fit.parameters, dvector![0.2578, 0.2578], epsilon = 5e-5);
    assert_eq!(fit.reason, TerminationReason::NoProgress);
}

#[test]
fn large_residuals_are_no_obstacle() {
    // Brown & Dennis: Moré, Garbow & Hillstrom, problem 16, S = 85822.2. With differences for a
    // Jacobian.
    let r = |p: &DVector<f64>| {
        DVector::from_fn(20, |i, _| {
            let t = (i + 1) as f64 / 5.0;
            (p[0] + t * p[1] - t.exp()).powi(2) + (p[2] + p[3] * t.sin() - t.cos()).powi(2)
        })
    };
    let j = |p: &DVector<f64>| central_differences(r, p, &dvector![1.0, 1.0, 1.0, 1.0]);
    // full steps overshoot here, and the sum of squares alone leads only so near
    let options = Options { gradient_tolerance: 1e-6, ..Options::default() };
    let fit = fit(&Closures { n: 4, m: 20, r, j }, &dvector![25.0, 5.0, -5.0, -1.0], &options).unwrap();
    assert!(fit.is_converged(), "{}", fit.reason);
    assert_relative_eq!(fit.sum_of_squares, 85822.2, epsilon = 0.05);
}

#[test]
fn an_unidentifiable_pair_is_named_and_the_rest_keeps_its_errors() {
    // only p₁ + 2p₂ and p₃ can be seen
    let design = dmatrix![1.0, 2.0, 0.0; 1.0, 2.0, 1.0; 1.0, 2.0, 2.0; 1.0, 2.0, 3.0];
    let fit = linear(&design, &dvector![6.0, 5.0, 7.0, 10.0], None, &Options::default()).unwrap();
    use Standing::{Estimated, NotIdentified};
    assert_eq!(fit.covariance.standing, [NotIdentified, NotIdentified, Estimated]);
    assert_eq!((fit.covariance.rank, fit.degrees_of_freedom), (2, 2));
    assert_relative_eq!(fit.standard_errors()[2].unwrap(), (2.1f64 / 5.0).sqrt(), max_relative = 1e-13);
    assert_eq!(fit.standard_errors()[..2], [None, None]);
    assert!(fit.covariance.matrix[(0, 0)].is_infinite());
    let null = &fit.covariance.null_space;
    assert_eq!(null.shape(), (3, 1));
    assert_relative_eq!(null[(0, 0)] / null[(1, 0)], -2.0, max_relative = 1e-13);
    assert!((design * null).norm() < 1e-14);
    assert!(fit.covariance.condition_number > 1e12);
}

#[test]
fn a_prior_is_one_more_measurement() {
    // 10 ± 1 measured, 12 ± 0.5 known: weights 1 and 4, so 11.6 ± 1/√5
    let design = dmatrix![1.0];
    let options = Options {
        priors: vec![Prior { parameter: 0, value: 12.0, sd: 0.5 }],
        noise: Noise::Known(1.0),
        ..Options::default()
    };
    let fit = linear(&design, &dvector![10.0], None, &options).unwrap();
    assert_relative_eq!(fit.parameters[0], 11.6, max_relative = 1e-14);
    assert_relative_eq!(fit.standard_errors()[0].unwrap(), 1.0 / 5f64.sqrt(), max_relative = 1e-14);
    let estimated = Options { noise: Noise::Estimated, ..options };
    let error = linear(&design, &dvector![10.0], None, &estimated).unwrap_err();
    assert!(error.to_string().starts_with("`noise` is estimated, expected known"));
}

#[test]
fn a_bound_is_kept_and_reported() {
    // without bounds (3.5, 1.4); with the slope at most 1 the intercept is ȳ − x̄ = 4.5
    let options =
        Options { bounds: vec![(f64::NEG_INFINITY, f64::INFINITY), (0.0, 1.0)], ..Options::default() };
    let y = dvector![6.0, 5.0, 7.0, 10.0];
    let fit = linear(&line(&[1.0, 2.0, 3.0, 4.0]), &y, None, &options).unwrap();
    assert!(fit.is_converged(), "{}", fit.reason);
    assert_relative_eq!(fit.parameters, dvector![4.5, 1.0], max_relative = 1e-14);
    assert_eq!(fit.covariance.standing, [Standing::Estimated, Standing::AtUpperBound]);
    assert_eq!(fit.standard_errors()[1], None);
    assert!(fit.standard_errors()[0].is_some());
    // a bound that does not bind changes nothing
    let loose = Options { bounds: vec![(0.0, 100.0), (-5.0, 5.0)], ..Options::default() };
    let fit = linear(&line(&[1.0, 2.0, 3.0, 4.0]), &y, None, &loose).unwrap();
    assert_relative_eq!(fit.parameters, dvector![3.5, 1.4], max_relative = 1e-14);
    assert_eq!(fit.covariance.standing, [Standing::Estimated; 2]);
}

#[test]
fn a_trial_step_into_nan_is_taken_back() {
    // r = ln p − ln 1e-3 does not exist where the first full step from 10 would go
    let problem = Closures {
        n: 1,
        m: 1,
        r: |p: &DVector<f64>| dvector![p[0].ln() - 1e-3f64.ln()],
        j: |p: &DVector<f64>| dmatrix![1.0 / p[0]],
    };
    let options = Options { first_radius: f64::INFINITY, ..Options::default() };
    let found = fit(&problem, &dvector![10.0], &options).unwrap();
    assert!(found.is_converged(), "{}", found.reason);
    assert_relative_eq!(found.parameters[0], 1e-3, max_relative = 1e-14);
    assert!(found.evaluations > found.iterations);
    let nowhere = default_fit(&problem, dvector![-1.0]);
    assert_eq!(nowhere.reason, TerminationReason::NonFiniteStart);
    assert_eq!(nowhere.standard_errors(), [None]);
}

#[test]
fn what_did_not_converge_says_so() {
    let few = Options { max_iterations: 3, ..Options::default() };
    let stopped = fit(&jennrich_sampson(), &dvector![0.3, 0.4], &few).unwrap();
    assert_eq!(stopped.reason, TerminationReason::MaxIterations);

    let wrong_sign = Closures {
        n: 1,
        m: 2,
        r: |p: &DVector<f64>| dvector![p[0].exp() - 2.0, 1.0 - p[0]],
        j: |p: &DVector<f64>| -dmatrix![p[0].exp(); -1.0],
    };
    assert_eq!(default_fit(&wrong_sign, dvector![3.0]).reason, TerminationReason::NoProgress);

    let indifferent = Closures {
        n: 1,
        m: 2,
        r: |_: &DVector<f64>| dvector![1.0, 2.0],
        j: |_: &DVector<f64>| dmatrix![0.0; 0.0],
    };
    assert_eq!(default_fit(&indifferent, dvector![3.0]).reason, TerminationReason::NoInfluence);

    // 1 − exp(−p) = 1.1 has its best p at infinity
    let endless = Closures {
        n: 1,
        m: 1,
        r: |p: &DVector<f64>| dvector![1.0 - (-p[0]).exp() - 1.1],
        j: |p: &DVector<f64>| dmatrix![(-p[0]).exp()],
    };
    let endless = default_fit(&endless, dvector![1.0]);
    assert!(!endless.is_converged(), "{} at {}", endless.reason, endless.parameters);
}

#[test]
fn questions_without_sense_are_refused() {
    let refused = |start: DVector<f64>, options: Options| {
        fit(&jennrich_sampson(), &start, &options).unwrap_err().to_string()
    };
    let defaults = Options::default;
    assert_eq!(refused(dvector![1.0], defaults()), "`start` is 1 values, expected 2, one per parameter");
    let outside = Options { bounds: vec![(0.0, 1.0), (0.0, 1.0)], ..defaults() };
    assert_eq!(
        refused(dvector![0.5, 2.0], outside),
        "`start` is 2, expected a value within its bounds [0, 1]"
    );
    let prior = Prior { parameter: 7, value: 0.0, sd: 1.0 };
    let options = Options { priors: vec![prior], ..defaults() };
    assert_eq!(refused(dvector![0.5, 2.0], options), "`priors` is parameter 7, expected an index below 2");
}

#[test]
fn a_search_knows_the_rank_that_its_fit_finds() {
    // the second column twice: three parameters, rank two
    let twice = DMatrix::from_fn(4, 3, |i, j| if j == 0 { 1.0 } else { i as f64 });
    for (design, rank) in [(line(&[1.0, 2.0, 3.0, 4.0]), 2), (twice, 2)] {
        let n = design.ncols();
        let y = dvector![6.0, 5.0, 7.0, 10.0];
        let (residuals, jacobian) = (|p: &DVector<f64>| &design * p - &y, |_: &DVector<f64>| design.clone());
        let problem = Closures { n, m: 4, r: residuals, j: jacobian };
        let options = Options::default();
        let start = DVector::zeros(n);
        let found = search(&problem, &start, &options).unwrap();
        let fit = fit(&problem, &start, &options).unwrap();
        assert_eq!((found.rank(), fit.covariance.rank, found.is_converged()), (rank, rank, true));
        assert_eq!((found.parameters(), &fit.residuals), (&fit.parameters, &residuals(&fit.parameters)));
        assert_eq!(found.judged().unwrap().sum_of_squares, fit.sum_of_squares);
    }
}
