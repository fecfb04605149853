//! What the candidates show of the parameters at all.
//!
//! At one clamp no pose tells a turn of the base about the ball from one of the joints, at two none
//! about the line between them. Such a combination has no information whatever is chosen, and an
//! index of all of them would be that of rounding: it is left out.

use nalgebra::DMatrix;

use crate::optimal_design::Measurements;

/// Information (of columns of norm 1) below which a combination is left out: a millionth of a
/// singular value.
const UNSEEN: f64 = 1e-12;

/// Combinations of the unknowns that the measurements show, orthonormal, as columns; none where
/// they show all of them.
pub(super) fn seen(all: &Measurements) -> Option<DMatrix<f64>> {
    let columns = all.columns();
    let everything: Vec<usize> = (0..all.len()).collect();
    let norms = all.column_norms();
    let mut information = all.information(&everything, &DMatrix::zeros(columns, columns));
    for ((i, k), entry) in
        (0..columns).flat_map(|k| (0..columns).map(move |i| (i, k))).zip(information.iter_mut())
    {
        *entry /= norms[i] * norms[k];
    }
    let eigen = information.symmetric_eigen();
    let unseen: Vec<usize> = (0..columns).filter(|&k| eigen.eigenvalues[k] < UNSEEN).collect();
    if unseen.is_empty() {
        return None;
    }
    // in the units of the unknowns
    let unseen =
        DMatrix::from_fn(columns, unseen.len(), |i, k| eigen.eigenvectors[(i, unseen[k])] / norms[i]);
    let unseen = unseen.qr().q();
    let others = (DMatrix::identity(columns, columns) - &unseen * unseen.transpose()).symmetric_eigen();
    let seen: Vec<usize> = (0..columns).filter(|&k| others.eigenvalues[k] > 0.5).collect();
    Some(others.eigenvectors.select_columns(&seen))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::statistics::Random;
    use nalgebra::Matrix3xX;

    /// Only the sum of the first two unknowns shows.
    #[test]
    fn what_no_measurement_shows_is_left_out() {
        let mut random = Random::seeded(2, 0);
        let [mut all, mut whole] = [Measurements::new(4), Measurements::new(4)];
        for _ in 0..20 {
            let any = Matrix3xX::from_fn(4, |_, k| if k == 3 { 1e5 } else { 1.0 } * random.normal());
            whole.push(0, &any);
            let mut rows = any.clone();
            let first = rows.column(0).into_owned();
            rows.set_column(1, &(first * 2.0));
            all.push(0, &rows);
        }
        assert_eq!(seen(&whole), None);
        let seen = seen(&all).unwrap();
        assert_eq!(seen.shape(), (4, 3));
        assert!((seen.transpose() * &seen - DMatrix::identity(3, 3)).amax() < 1e-12);
        let unseen = DMatrix::from_column_slice(4, 1, &[2.0, -1.0, 0.0, 0.0]);
        assert!((seen.transpose() * unseen).amax() < 1e-9);
    }
}
