//! What the readings say of the rod before anything is fitted.

use crate::diagnosis::rig::recording::datum::Datum;

/// A rod up to so many times softer or stiffer than its file is none that is far off.
const NEAR: f64 = 2.0;
/// Readings below this share of the largest predicted one say little.
const SMALL: f64 = 0.2;

/// [`ratio`], and 1 where that is from ½ to 2.
///
/// Columns of nominal numbers and their priors are shares of the rod's deflection. Of a rod that is
/// 100 times stiffer than its file one percent of the file's deflection is all there is to read, so
/// that the numbers of the file, each known to a percent, would explain everything.
pub fn stiffness(data: &[Datum]) -> f64 {
    match ratio(data) {
        ratio if ratio > NEAR || ratio < NEAR.recip() => ratio,
        _ => 1.0,
    }
}

/// How many times as stiff as predicted the rod is at first sight: the median of predicted over
/// measured offsets along the loads; 1 where that is no positive number.
pub fn ratio(data: &[Datum]) -> f64 {
    let is_along = |d: &&Datum| d.channel == d.direction.axis && d.predicted != 0.0;
    let largest = data.iter().filter(is_along).fold(0.0, |most: f64, d| most.max(d.predicted.abs()));
    let of_datum = |d: &Datum| {
        let ratio = d.predicted / d.measured;
        // of an imposed displacement the load is read
        if d.imposed.is_some() { ratio.recip() } else { ratio }
    };
    let large = data.iter().filter(is_along).filter(|d| d.predicted.abs() > SMALL * largest);
    let mut ratios: Vec<f64> = large.map(of_datum).filter(|ratio| ratio.is_finite()).collect();
    ratios.sort_by(f64::total_cmp);
    ratios.get(ratios.len() / 2).copied().filter(|ratio| *ratio > 0.0).unwrap_or(1.0)
}
