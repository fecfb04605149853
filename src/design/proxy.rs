//! Whether c_rod ranks rods as the accuracy of a robot does that is calibrated with them.
//!
//! How one order follows another is Spearman's coefficient, the correlation r of the ranks, with
//! the interval tanh(artanh r ± 1.96·√(1.06/(n − 3))) (E. C. Fieller, H. O. Hartley, E. S.
//! Pearson, *Biometrika* 44 (1957) 470–481).

use super::forecast::Forecast;
use crate::calibration::Mode;
use crate::statistics::HALF_95;

/// Fewer rods have no order to speak of.
const FEWEST: usize = 5;
/// c_rod that differ by less than this share are equal.
const SAME: f64 = 1e-9;

/// How the error follows c_rod in one mode.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Proxy {
    /// The mode.
    pub mode: Mode,
    /// Spearman's coefficient.
    pub r: f64,
    /// Its 95 % interval.
    pub interval: [f64; 2],
    /// Least and largest root mean square error, m: what there is to gain.
    pub rms: [f64; 2],
}

/// In each mode that all of these rods have: c_rod (m) and what is to be expected of each. None of
/// fewer than five. Errors that the draws of the forecasts do not distinguish share a rank.
///
/// ```
/// use rodcal::design::proxies;
///
/// assert!(proxies(&[(400e-6, &[]), (300e-6, &[])]).is_empty()); // two rods have no order to speak of
/// ```
pub fn proxies(rods: &[(f64, &[Forecast])]) -> Vec<Proxy> {
    let of_mode = |mode: Mode| {
        let one = |&(c_rod, modes): &(f64, &'_ [Forecast])| {
            let forecast = modes.iter().position(|forecast| forecast.mode == mode)?;
            Some((c_rod, forecast))
        };
        let known: Vec<(f64, usize)> = rods.iter().map(one).collect::<Option<_>>()?;
        let c_rod: Vec<f64> = known.iter().map(|(c_rod, _)| *c_rod).collect();
        let errors: Vec<&Forecast> =
            rods.iter().zip(&known).map(|((_, modes), (_, place))| &modes[*place]).collect();
        proxy(mode, &c_rod, &errors)
    };
    Mode::ALL.into_iter().filter_map(of_mode).collect()
}

fn proxy(mode: Mode, c_rod: &[f64], errors: &[&Forecast]) -> Option<Proxy> {
    if errors.len() < FEWEST {
        return None;
    }
    let x = ranks(c_rod.len(), |a, b| {
        let is_same = (c_rod[a] - c_rod[b]).abs() <= SAME * c_rod[a].abs().max(c_rod[b].abs());
        (!is_same).then_some(c_rod[a] < c_rod[b])
    });
    let y = ranks(errors.len(), |a, b| {
        (!errors[a].is_as_good_as(errors[b])).then_some(errors[a].rms < errors[b].rms)
    });
    let ends = errors.iter().fold([f64::INFINITY, 0.0f64], |[a, b], x| [a.min(x.rms), b.max(x.rms)]);
    let (r, interval) = spearman(&x, &y);
    Some(Proxy { mode, r, interval, rms: ends })
}

/// The coefficient of two orders of at least four, and its 95 % interval.
fn spearman(x: &[f64], y: &[f64]) -> (f64, [f64; 2]) {
    let middle = (x.len() - 1) as f64 / 2.0;
    let product =
        |a: &[f64], b: &[f64]| -> f64 { a.iter().zip(b).map(|(a, b)| (a - middle) * (b - middle)).sum() };
    let scale = (product(x, x) * product(y, y)).sqrt();
    let r = if scale > 0.0 { product(x, y) / scale } else { 0.0 };
    let half = HALF_95 * (1.06 / (x.len() - 3) as f64).sqrt();
    // a perfect order has no end of its interval inside
    let z = r.clamp(-1.0 + 1e-12, 1.0 - 1e-12).atanh();
    (r, [(z - half).tanh(), (z + half).tanh()])
}

/// Ranks from 0; `None` says that two are equal: they share the mean of their ranks.
fn ranks(count: usize, is_less: impl Fn(usize, usize) -> Option<bool>) -> Vec<f64> {
    let rank = |own: usize| {
        let others = || (0..count).filter(move |&other| other != own);
        let below = others().filter(|&other| is_less(other, own) == Some(true)).count();
        let equal = others().filter(|&other| is_less(other, own).is_none()).count();
        below as f64 + equal as f64 / 2.0
    };
    (0..count).map(rank).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    fn ranks_of(values: &[f64]) -> Vec<f64> {
        ranks(values.len(), |a, b| (values[a] != values[b]).then_some(values[a] < values[b]))
    }

    #[test]
    fn orders_are_compared_by_their_ranks() {
        assert_eq!(ranks_of(&[3.0, 1.0, 3.0, 9.0]), [1.5, 0.0, 1.5, 3.0]);
        let value_at = |y: [f64; 6]| spearman(&[0.0, 1.0, 2.0, 3.0, 4.0, 5.0], &ranks_of(&y));
        assert!((value_at([1.0, 4.0, 9.0, 16.0, 25.0, 36.0]).0 - 1.0).abs() < 1e-12);
        // 1 − 6·Σd²/(n(n² − 1)) with d = 1, 1, 1, 1, 1, 1
        let (swapped, interval) = value_at([2.0, 1.0, 4.0, 3.0, 6.0, 5.0]);
        assert!((swapped - (1.0 - 36.0 / 210.0)).abs() < 1e-12);
        let half = HALF_95 * (1.06f64 / 3.0).sqrt();
        assert!((interval[0] - (swapped.atanh() - half).tanh()).abs() < 1e-12);
        assert_eq!(value_at([5.0; 6]).0, 0.0);
    }

    #[test]
    fn errors_that_the_draws_do_not_distinguish_are_ties() {
        // mean squares of draws that have their chance in common: what differs is 1 ± 10 %
        let of_rod = |rms: f64, chance: f64| {
            let squares = (0..100).map(|k| rms * rms * (1.0 + chance * f64::from(k % 7 - 3)));
            Forecast { rms, squares: squares.collect(), ..Forecast::nothing(Mode::Fea) }
        };
        let (one, more) = (of_rod(1.0, 0.1), of_rod(1.001, 0.1));
        assert!(!one.is_as_good_as(&more)); // the same chance: the difference is sure
        assert!(one.is_as_good_as(&of_rod(1.001, -0.1)));
        let all: Vec<Vec<Forecast>> = [1.0, 1.001, 1.0, 1.5, 2.0].map(|rms| vec![of_rod(rms, 0.1)]).to_vec();
        let rods: Vec<(f64, &[Forecast])> = (1..).map(f64::from).zip(all.iter().map(Vec::as_slice)).collect();
        assert_eq!(proxies(&rods)[0].rms, [1.0, 2.0]);
        // ranks 0.5, 2, 0.5, 3, 4 of 0, 1, 2, 3, 4
        assert!((proxies(&rods)[0].r - 8.0 / (10.0f64 * 9.5).sqrt()).abs() < 1e-12);
        assert!(proxies(&rods[..4]).is_empty());
    }
}
