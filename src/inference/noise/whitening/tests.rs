use super::*;
use crate::statistics::Random;

/// 6 trials of 8 replicates.
fn evidence(shared_sd: f64) -> Evidence {
    let mut random = Random::seeded(3, 0);
    let (mut residual, mut replicate_group, mut shared) = (Vec::new(), Vec::new(), Vec::new());
    for trial in 0..60 {
        let zero = shared_sd * random.normal();
        for load in 0..8 {
            residual.push(3.0 * load as f64 + zero + random.normal());
            replicate_group.push(load);
            shared.push(trial);
        }
    }
    Evidence { replicate_group, fold: shared.clone(), shared, ..Evidence::new(DVector::from_vec(residual)) }
}

#[test]
fn the_shared_error_is_found_in_the_repeats() {
    for (sd, ratio) in [(0.0, 0.0), (1.0, 1.0), (3.0, 9.0)] {
        let evidence = evidence(sd);
        let found = Whitening::new(&evidence, &evidence.residual).ratio;
        assert!((found - ratio).abs() < 0.15 + 0.35 * ratio, "{found} instead of {ratio}");
    }
}

#[test]
fn whitening_is_the_inverse_root_of_the_covariance() {
    let evidence = Evidence { shared: vec![7; 480], ..evidence(1.0) };
    let whitening = Whitening::new(&evidence, &evidence.residual);
    let (rho, n) = (whitening.ratio, 480.0);
    // W·(1 + ρJ)·Wᵀ = 1: checked on two vectors
    let covariance = |v: &DVector<f64>| v + DVector::from_element(480, rho * v.sum());
    let e = DVector::from_fn(480, |i, _| f64::from(u8::from(i == 5)));
    let whitened = whitening.whitened(&covariance(&whitening.whitened(&e)));
    assert!((whitened - &e).norm() < 1e-9 * n);
}

#[test]
fn steps_are_as_long_as_their_whitened_columns() {
    let weight = (0..480).map(|i| 0.2 + 0.8 * (0.3 * i as f64).sin().powi(2)).collect();
    let evidence = Evidence { weight, ..evidence(1.0) };
    let whitening = Whitening::new(&evidence, &evidence.residual);
    let all: Vec<Option<usize>> = (0..480).map(Some).collect();
    // every third one, the first hundred of them left out
    let some: Vec<Option<usize>> = (0..160).map(|k| (k >= 100).then_some(3 * k)).collect();
    let squares = whitening.squares_of_steps(&[all.clone(), some.clone()]);
    for (sequence, squares) in [all, some].iter().zip(squares) {
        for from in [0, 1, 7, 8, 101, 159] {
            let mut step = DVector::zeros(480);
            sequence[from..].iter().flatten().for_each(|&row| step[row] = 1.0);
            let expected = whitening.whitened(&step).norm_squared();
            assert!((squares[from] - expected).abs() < 1e-10 * (1.0 + expected), "{from}");
        }
    }
}

#[test]
fn steps_among_neighbours_that_resemble_each_other_are_too() {
    let weight = (0..480).map(|i| 0.2 + 0.8 * (0.3 * i as f64).sin().powi(2)).collect();
    let evidence = Evidence { weight, correlation: Some(0.4), ..evidence(1.0) };
    let whitening = Whitening::new(&evidence, &evidence.residual);
    // of a run, and of all from the middle of one on
    let (run, rest) = ((8..16).map(Some).collect::<Vec<_>>(), (100..480).map(Some).collect());
    let squares = whitening.squares_of_steps(&[run.clone(), rest]);
    for (first, from, squares) in [(8, 0, &squares[0]), (8, 3, &squares[0]), (100, 77, &squares[1])] {
        let last = if first == 8 { 16 } else { 480 };
        let step = DVector::from_fn(480, |i, _| f64::from(u8::from((first + from..last).contains(&i))));
        let expected = whitening.whitened(&step).norm_squared();
        assert!((squares[from] - expected).abs() < 1e-10 * (1.0 + expected), "{first} {from}");
    }
}

#[test]
fn whitening_is_the_inverse_root_of_an_autoregression_too() {
    let evidence = Evidence { correlation: Some(0.4), ..evidence(1.0) };
    let whitening = Whitening::new(&evidence, &evidence.residual);
    // W·(R + ρJ)·Wᵀ = 1 in each run of 8
    let covariance = DMatrix::from_fn(480, 480, |i, j| {
        let of_run = if i / 8 == j / 8 { 1.0 } else { 0.0 };
        of_run * (0.4f64.powi(i.abs_diff(j) as i32) + whitening.ratio)
    });
    let e = DVector::from_fn(480, |i, _| f64::from(u8::from(i == 5)));
    let back = whitening.whitened(&(covariance * whitening.transposed_vector(&e)));
    assert!((back - e).amax() < 1e-10);
}

#[test]
fn the_transposed_moves_whitening_to_the_other_side_of_a_product() {
    let weight = (0..480).map(|i| 0.2 + 0.8 * (0.3 * i as f64).sin().powi(2)).collect();
    let evidence = Evidence { weight, correlation: Some(0.4), ..evidence(1.0) };
    let whitening = Whitening::new(&evidence, &evidence.residual);
    let (a, b) = (DVector::from_fn(480, |i, _| (0.1 * i as f64).cos()), &evidence.residual);
    let (left, right) = (whitening.whitened(&a).dot(b), a.dot(&whitening.transposed_vector(b)));
    assert!((left - right).abs() < 1e-10 * left.abs());
}

#[test]
fn nuisance_columns_vanish() {
    let mut evidence = evidence(1.0);
    evidence.nuisance = DMatrix::from_fn(480, 3, |i, k| if k == 2 { 2.0 } else { (i as f64).powi(k as i32) });
    let whitening = Whitening::new(&evidence, &evidence.residual);
    assert_eq!(whitening.degrees_of_freedom, 478, "the third column is the first");
    let gone = whitening.apply(&evidence.nuisance.column(1).into_owned());
    assert!(gone.norm() < 1e-9 * evidence.nuisance.column(1).norm());
}
