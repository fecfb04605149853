//! Two stations that are nearly one: what pulls the second towards the first.
//!
//! ```text
//! ½·(|o_b − o_a|²/s² + |ln(R_b·R_aᵀ)|²/t²)       o origin, R rotation of a station's base in {W}
//! ```

use nalgebra::{DMatrix, DVector, Rotation3, Vector3};

use super::super::draft::Draft;
use super::residuals::FitState;

/// Of the stations that a draft holds together: the first of their columns, their sizes (six) and
/// by how many of them the second is off.
fn stretched(draft: &Draft, state: &FitState) -> Option<([usize; 2], [f64; 6], [f64; 6])> {
    let tether = draft.tether?;
    let [a, b] = tether.stations;
    let (from, to) = (state.bases.get(a)?, state.bases.get(b)?);
    let way = to.origin - from.origin;
    let turn = Rotation3::from_matrix_unchecked(to.rotation * from.rotation.transpose()).scaled_axis();
    let six = |way: Vector3<f64>, turn: Vector3<f64>| [way.x, way.y, way.z, turn.x, turn.y, turn.z];
    let sizes = six(Vector3::repeat(tether.way), Vector3::repeat(tether.turn));
    Some((tether.stations, sizes, six(way, turn)))
}

/// What that costs, ln.
pub(super) fn pulled(draft: &Draft, state: &FitState) -> f64 {
    stretched(draft, state).map_or(0.0, |(_, sizes, six)| {
        0.5 * six.iter().zip(sizes).map(|(off, size)| (off / size).powi(2)).sum::<f64>()
    })
}

/// The same in the normal equations of a step, in which the bases stand behind `free` columns.
pub(super) fn pull(
    draft: &Draft,
    state: &FitState,
    free: usize,
    normal: &mut DMatrix<f64>,
    gradient: &mut DVector<f64>,
) {
    let Some((stations, sizes, six)) = stretched(draft, state) else { return };
    for k in 0..6 {
        let precision = sizes[k].powi(-2);
        let [a, b] = stations.map(|station| free + 6 * station + k);
        normal[(a, a)] += precision;
        normal[(b, b)] += precision;
        normal[(a, b)] -= precision;
        normal[(b, a)] -= precision;
        gradient[a] -= precision * six[k];
        gradient[b] += precision * six[k];
    }
}
