use super::*;
use crate::statistics::Random;

const FREE: (f64, f64) = (f64::NEG_INFINITY, f64::INFINITY);

fn noise(n: usize, seed: u64) -> DVector<f64> {
    let mut random = Random::seeded(seed, 0);
    DVector::from_fn(n, |_, _| random.normal())
}

fn score(r: &DVector<f64>, columns: &DMatrix<f64>) -> Score {
    Moments::new(r, columns, vec![FREE; columns.ncols()], Vec::new(), r.len(), 0.0).score()
}

#[test]
fn the_noise_is_where_the_evidence_is_largest() {
    let (r, c) = (noise(30, 2), noise(30, 3));
    let r = r + &c * 0.8;
    let columns = DMatrix::from_columns(&[c.clone(), noise(30, 5) * 40.0]);
    let moments = Moments::new(&r, &columns, vec![FREE; 2], Vec::new(), 30, 0.0);
    let best = moments.score();
    let evidence = |s: f64| {
        let solved = Ridge::new(&moments.gram, &moments.product, |_| s);
        let quadratic = moments.square - moments.product.dot(&solved.solution);
        -0.5 * (30.0 * s.ln() + solved.ln_determinant - 2.0 * s.ln() + quadratic / s)
    };
    assert!((evidence(best.sigma.powi(2)) - best.log_evidence).abs() < 1e-9);
    for factor in [0.9, 0.99, 1.01, 1.1] {
        assert!(evidence(best.sigma.powi(2) * factor) < best.log_evidence, "{factor}");
    }
}

#[test]
fn an_effect_is_as_large_as_it_is_and_screening_says_so_too() {
    let (r, c) = (noise(80, 2), noise(80, 3));
    for size in [0.2, 1.0, 5.0, 50.0] {
        // the true factor, in sizes, is 3/size
        let recorded = &r + &c * 3.0;
        let columns = DMatrix::from_columns(&[&c * size]);
        let wide = Moments::new(&recorded, &columns, vec![FREE], vec![1], 80, 0.0).score();
        let narrow = score(&recorded, &columns);
        assert!(wide.log_evidence >= narrow.log_evidence - 1.2, "size {size}");
        let fitted = c.dot(&recorded) / c.norm_squared();
        assert!((wide.estimate[0] * size / fitted - 1.0).abs() < 0.05, "size {size}: {}", wide.estimate[0]);
        let none = Moments::new(&recorded, &DMatrix::zeros(80, 0), vec![], vec![], 80, 0.0);
        let (gram, product) = (columns.tr_mul(&columns), columns.tr_mul(&recorded));
        let none_of_them = DMatrix::zeros(0, 1);
        let (cross, solved) = (none_of_them.as_view(), none_of_them.as_view());
        let more = ColumnBlock { gram: &gram, cross, solved, product: product.as_view(), bounds: vec![FREE] };
        let before = none.score();
        let about = none.about(&before, &more);
        let exact = none.beyond(&before, &more).score().log_evidence - before.log_evidence;
        assert!((about - exact).abs() < 0.1 * exact.abs() + 0.5, "size {size}: {about} for {exact}");
    }
}

#[test]
fn what_is_out_of_bounds_is_no_explanation() {
    let (r, c) = (noise(60, 4), noise(60, 5));
    let r = r - &c * 2.0;
    let columns = DMatrix::from_columns(&[c]);
    let of_bounds =
        |bounds| Moments::new(&r, &columns, vec![bounds], Vec::new(), 60, 0.0).score().log_evidence;
    let without = score(&r, &DMatrix::zeros(60, 0)).log_evidence;
    assert!(of_bounds(FREE) > without + 20.0);
    assert!(of_bounds((0.0, f64::INFINITY)) < without);
    // the other half of the prior is twice as dense
    assert!((of_bounds((f64::NEG_INFINITY, 0.0)) - of_bounds(FREE) - std::f64::consts::LN_2).abs() < 1e-6);
}

#[test]
fn without_columns_it_is_the_likelihood_of_the_best_noise() {
    let r = noise(200, 1) * 3.0;
    let score = score(&r, &DMatrix::zeros(200, 0));
    let s = r.norm_squared() / 200.0;
    assert!((score.sigma - s.sqrt()).abs() < 1e-5 * s.sqrt());
    assert!((score.log_evidence + 0.5 * 200.0 * (s.ln() + 1.0)).abs() < 1e-8);
}

#[test]
fn it_is_the_gaussian_integral_over_the_parameters() {
    // one column: ln ∫ N(r; c·x, σ²)·N(x; 0, 1) dx, by the trapezoidal rule, against none
    let (r, c) = (noise(30, 2), noise(30, 3));
    let r = r + &c * 0.8;
    let scored = score(&r, &DMatrix::from_columns(std::slice::from_ref(&c)));
    let s = scored.sigma.powi(2);
    let density = |x: f64| {
        (-0.5 * ((&r - &c * x).norm_squared() / s + x * x)).exp() / (2.0 * std::f64::consts::PI).sqrt()
    };
    let step = 1e-3;
    let integral: f64 = (-6000..6000).map(|i| density(f64::from(i) * step) * step).sum();
    let expected = integral.ln() - 0.5 * 30.0 * s.ln();
    assert!((scored.log_evidence - expected).abs() < 1e-9, "{} {expected}", scored.log_evidence);
}

#[test]
fn a_column_that_explains_nothing_costs() {
    let mut favours = 0;
    for seed in 0..200 {
        let (r, c) = (noise(100, 2 * seed + 10), noise(100, 2 * seed + 11));
        let without = score(&r, &DMatrix::zeros(100, 0));
        let with = score(&r, &DMatrix::from_columns(&[c * 10.0]));
        favours += usize::from(with.log_evidence > without.log_evidence + 3.0);
    }
    assert!(favours <= 1, "{favours} of 200 clean recordings favour it by 20 to 1");
}

/// What adding `own` to a hypothesis of `columns` is worth, about and exactly.
fn worth(r: &DVector<f64>, columns: &DMatrix<f64>, own: &DMatrix<f64>) -> (f64, f64) {
    let (bounds, effects) = (vec![FREE; columns.ncols()], vec![columns.ncols()]);
    let hypothesis = Moments::new(r, columns, bounds, effects, r.len(), 0.0);
    let score = hypothesis.score();
    let gram = own.tr_mul(own);
    let cross = columns.tr_mul(own);
    let (solved, product) = (score.solved(&cross), own.tr_mul(r));
    let more = ColumnBlock {
        gram: &gram,
        solved: solved.as_view(),
        cross: cross.as_view(),
        product: product.as_view(),
        bounds: vec![FREE; own.ncols()],
    };
    let exact =
        hypothesis.beyond(&score, &more).score().log_evidence - hypothesis.rest(&score).score().log_evidence;
    (hypothesis.about(&score, &more), exact)
}

#[test]
fn what_a_story_holds_already_adds_nothing() {
    // a factor of 20 in favour would be a name
    const HARDLY: f64 = 1.0;
    // far below the columns, rounding of their products is more than the noise
    for (size, sd) in [(1.0, 1.0), (1e3, 1.0), (1e6, 1.0), (1e6, 1e-3), (1.0, 1e-6), (1e3, 1e-9)] {
        for seed in 0..20 {
            let (c, d) = (noise(80, 3 * seed + 11), noise(80, 3 * seed + 12));
            let r = noise(80, 3 * seed + 10) * sd + &c * 3.0 - &d;
            let columns = DMatrix::from_columns(&[&c * size, &d * size]);
            let mixed = DMatrix::from_columns(&[(&c + &d) * size, (&c - &d * 0.3) * size]);
            let near = DMatrix::from_columns(&[(&c + noise(80, 3 * seed + 500) * 1e-9) * size]);
            for own in [columns.columns(0, 1).into_owned(), columns.clone(), mixed, near] {
                let (about, exact) = worth(&r, &columns, &own);
                assert!(about < HARDLY && exact < HARDLY, "{size} {sd}, seed {seed}: {about} {exact}");
            }
            // and a column that it lacks adds as much at any size
            let other = noise(80, 3 * seed + 1000);
            let own = DMatrix::from_columns(&[&other * size]);
            let (about, exact) = worth(&(&r + &other * 2.0), &columns, &own);
            assert!(about > 20.0 && exact > 20.0, "{size} {sd}, seed {seed}: {about} {exact}");
        }
    }
}

#[test]
fn more_parameters_than_data_are_no_trouble() {
    // of the largest columns, to which σ² is next to nothing
    const ROUNDED: f64 = 0.05;
    for (n, p, size) in [(20, 50, 1.0), (20, 50, 1e6), (3, 40, 10.0), (1, 2, 1.0)] {
        let columns = DMatrix::from_fn(n, p, |i, k| size * noise(n, 100 + k as u64)[i]);
        for effects in [vec![], vec![p]] {
            let bounds = vec![(0.0, f64::INFINITY); p];
            let score = Moments::new(&noise(n, 7), &columns, bounds, effects, n, 0.0).score();
            assert!(score.log_evidence.is_finite() && score.sigma > 0.0, "{n} {p} {score:?}");
            assert!(score.estimate.iter().chain(&score.covariance).all(|x| x.is_finite()));
            assert!(
                (-ROUNDED..n as f64 + ROUNDED).contains(&score.determined),
                "{n} {p} {}",
                score.determined
            );
        }
    }
}

#[test]
fn what_is_not_a_number_explains_nothing() {
    let (r, c) = (noise(40, 1), noise(40, 2));
    let columns = DMatrix::from_columns(std::slice::from_ref(&c));
    let mut holed = c.clone();
    holed[7] = f64::NAN;
    let own = DMatrix::from_columns(&[holed.clone()]);
    // not a number is no favour either
    let is_favoured = |gain: f64| gain > 0.0;
    let with = score(&r, &DMatrix::from_columns(&[c, holed.clone()])).log_evidence;
    assert!(!is_favoured(with - score(&r, &columns).log_evidence));
    let (about, exact) = worth(&r, &columns, &own);
    assert!(!is_favoured(about) && !is_favoured(exact), "{about} {exact}");
    // a residual that is none is no reason to stop
    let (about, exact) = worth(&holed, &columns, &columns);
    assert!(!is_favoured(about) && !is_favoured(exact), "{about} {exact}");
    let infinite = r.map(|x| x * f64::INFINITY);
    let (about, exact) = worth(&infinite, &columns, &columns);
    assert!(!is_favoured(about) && !is_favoured(exact), "{about} {exact}");
}

/// Of an effect of four numbers, as large as each other, the data show two: an interval of the
/// others knows of their size by these two alone.
#[test]
fn intervals_of_what_the_data_leave_open_know_how_well_its_size_is_known() {
    const DRAWS: u64 = 400;
    let held = |is_wide: bool| {
        let of_draw = |seed: u64| {
            let mut random = Random::seeded(seed, 8);
            let truth: Vec<f64> = (0..4).map(|_| 3.0 * random.normal()).collect();
            let columns = DMatrix::from_columns(&[0, 1, 2, 3].map(|k| {
                let seen = if k < 2 { 1.0 } else { 1e-4 };
                noise(40, 900 + k) * seen
            }));
            let r = &columns * DVector::from_vec(truth.clone()) + noise(40, 10_000 + seed) * 0.1;
            let moments = Moments::new(&r, &columns, vec![FREE; 4], vec![4], 40, 0.0);
            let score = moments.score();
            let covariance =
                if is_wide { moments.covariance(&score, &[vec![4]]) } else { score.covariance.clone() };
            let is_held = |k: usize| (score.estimate[k] - truth[k]).abs() < 1.96 * covariance[(k, k)].sqrt();
            (2..4).filter(|&k| is_held(k)).count()
        };
        (0..DRAWS).map(of_draw).sum::<usize>() as f64 / (2 * DRAWS) as f64
    };
    let (plain, wide) = (held(false), held(true));
    assert!(plain < 0.85, "{plain}");
    assert!((0.92..0.98).contains(&wide), "{wide}");
}
