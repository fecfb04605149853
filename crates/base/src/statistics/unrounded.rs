//! What a display rounds, between its steps.
//!
//! A thermometer that shows tenths of a kelvin says of a slow change only when it passes from one
//! step to the next. What varies as smoothly as its rounding allows is nearer to it than what is
//! shown:
//!
//! ```text
//! x = argmin Σ (xᵢ − vᵢ)² + λ ∫ x″² dt,    λ so that √(Σ (xᵢ − vᵢ)²/n) = δ/√12
//! ```
//!
//! vᵢ the values shown, δ their step. (E. T. Whittaker, Proc. Edinburgh Math. Soc. 41, 1923,
//! 63–75; λ by the discrepancy principle of V. A. Morozov, 1966.)

/// Coarsest step that is a display's: whole numbers may have been set.
const COARSEST: f64 = 0.5;
/// Finest decimal place that is looked at.
const FINEST: i32 = -6;
/// Decimals are not exact in binary.
const INEXACT: f64 = 1e-6;
/// Powers of ten that λ may have, in the cube of the usual distance of two values.
const POWERS: (f64, f64) = (-6.0, 10.0);
/// Halvings of that range.
const HALVINGS: usize = 40;

/// The `values` that were shown at `at`, as smooth as their rounding lets them be and nowhere
/// farther than half a step from what was shown. Values that are all alike, or show no step, are
/// what they are.
///
/// ```
/// use rodcal_base::statistics::unrounded;
///
/// let at: Vec<f64> = (0..200).map(f64::from).collect();
/// let warmed = |t: &f64| 20.0 + 0.8 * (1.0 - (-t / 90.0).exp());
/// let shown: Vec<f64> = at.iter().map(|t| (warmed(t) * 10.0).round() / 10.0).collect();
/// let off = |own: &[f64]| -> f64 {
///     let square: f64 = own.iter().zip(&at).map(|(own, t)| (own - warmed(t)).powi(2)).sum();
///     (square / 200.0).sqrt()
/// };
/// assert!(off(&unrounded(&shown, &at)) < 0.3 * off(&shown));
/// ```
///
/// # Panics
/// Where there are more or fewer values than places.
pub fn unrounded(values: &[f64], at: &[f64]) -> Vec<f64> {
    assert_eq!(values.len(), at.len());
    let step = step(values);
    let mut order: Vec<usize> = (0..values.len()).collect();
    order.sort_by(|&a, &b| at[a].total_cmp(&at[b]));
    // values at one place are one with their weight
    let mut places: Vec<Place> = Vec::new();
    for &index in &order {
        match places.last_mut().filter(|last| last.at >= at[index]) {
            Some(last) => {
                last.weight += 1.0;
                last.value += (values[index] - last.value) / last.weight;
            }
            None => places.push(Place { at: at[index], value: values[index], weight: 1.0 }),
        }
    }
    let is_alike = values.iter().all(|value| *value == values[0]);
    if step == 0.0 || is_alike || places.len() < 4 || !at.iter().all(|t| t.is_finite()) {
        return values.to_vec();
    }
    let smooth = smoothest(&places, step / 12.0f64.sqrt());
    let near = |index: usize| {
        let k = places.partition_point(|place| place.at < at[index]).min(places.len() - 1);
        smooth[k].clamp(values[index] - 0.5 * step, values[index] + 0.5 * step)
    };
    (0..values.len()).map(near).collect()
}

/// Where values of a recording lie, in the order of their `places` in it: at their times, or at
/// those places where a time is missing or the clock starts anew on the way.
///
/// ```
/// use rodcal_base::statistics::one_clock;
///
/// let places = [0.0, 1.0, 2.0];
/// assert_eq!(one_clock(&[Some(5.0), Some(9.0), Some(20.0)], &places), [5.0, 9.0, 20.0]);
/// assert_eq!(one_clock(&[Some(5.0), Some(9.0), Some(0.0)], &places), places);
/// assert_eq!(one_clock(&[Some(5.0), None, Some(20.0)], &places), places);
/// ```
pub fn one_clock(times: &[Option<f64>], places: &[f64]) -> Vec<f64> {
    let known = times.iter().copied().collect::<Option<Vec<f64>>>();
    let goes_on = |times: &Vec<f64>| {
        let mut by_place: Vec<(f64, f64)> = places.iter().copied().zip(times.iter().copied()).collect();
        by_place.sort_by(|a, b| a.0.total_cmp(&b.0));
        by_place.is_sorted_by(|a, b| a.1 <= b.1)
    };
    known.filter(goes_on).unwrap_or_else(|| places.to_vec())
}

struct Place {
    at: f64,
    value: f64,
    weight: f64,
}

/// The step that all values are multiples of: 0.5, 0.2, 0.1, 0.05 and so on; 0 where they show
/// none.
fn step(values: &[f64]) -> f64 {
    let steps = (FINEST..0).rev().flat_map(|decade| [5.0, 2.0, 1.0].map(|m| m * 10f64.powi(decade)));
    let is_multiple = |value: &f64, step: f64| {
        let steps = value / step;
        (steps - steps.round()).abs() <= INEXACT
    };
    let is_whole = values.iter().all(|value| is_multiple(value, 1.0));
    let mut steps = steps.filter(|&step| step <= COARSEST && values.iter().all(|v| is_multiple(v, step)));
    if is_whole { 0.0 } else { steps.next().unwrap_or_default() }
}

/// The smoothest values that are `misfit` (rms) from those of the places.
fn smoothest(places: &[Place], misfit: f64) -> Vec<f64> {
    let span = places[places.len() - 1].at - places[0].at;
    let usual = (span / (places.len() - 1) as f64).powi(3);
    let all: f64 = places.iter().map(|place| place.weight).sum();
    let off = |smooth: &[f64]| {
        let square = |(place, x): (&Place, &f64)| place.weight * (place.value - x).powi(2);
        (places.iter().zip(smooth).map(square).sum::<f64>() / all).sqrt()
    };
    let (mut least, mut most) = POWERS;
    let at_power = |power: f64| smoothed(places, usual * 10f64.powf(power));
    let straightest = at_power(most);
    if off(&straightest) <= misfit {
        return straightest;
    }
    // the misfit grows with λ
    for _ in 0..HALVINGS {
        let middle = 0.5 * (least + most);
        match off(&at_power(middle)) <= misfit {
            true => least = middle,
            false => most = middle,
        }
    }
    at_power(least)
}

/// (W + λ·DᵀD)·x = W·v by Cholesky's factors, of which each row has three numbers.
fn smoothed(places: &[Place], lambda: f64) -> Vec<f64> {
    let count = places.len();
    // the diagonal and the two beside it
    let mut band: Vec<[f64; 3]> = places.iter().map(|place| [place.weight, 0.0, 0.0]).collect();
    for k in 0..count - 2 {
        let (before, behind) = (places[k + 1].at - places[k].at, places[k + 2].at - places[k + 1].at);
        // √∫ of x″ = 2·((x₂ − x₁)/h₂ − (x₁ − x₀)/h₁)/(h₁ + h₂), over half of h₁ + h₂
        let scale = (2.0 / (before + behind)).sqrt();
        let row = [scale / before, -scale * (1.0 / before + 1.0 / behind), scale / behind];
        for (i, a) in row.iter().enumerate() {
            for (j, b) in row.iter().enumerate().skip(i) {
                band[k + i][j - i] += lambda * a * b;
            }
        }
    }
    let mut x: Vec<f64> = places.iter().map(|place| place.weight * place.value).collect();
    for k in 0..count {
        let [pivot, beside, beyond] = band[k];
        for (j, factor) in [(1, beside / pivot), (2, beyond / pivot)] {
            if k + j < count {
                band[k + j][0] -= factor * band[k][j];
                x[k + j] -= factor * x[k];
            }
        }
        if k + 1 < count {
            band[k + 1][1] -= beside / pivot * beyond;
        }
    }
    for k in (0..count).rev() {
        let known = |j: usize| if k + j < count { band[k][j] * x[k + j] } else { 0.0 };
        x[k] = (x[k] - known(1) - known(2)) / band[k][0];
    }
    x
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_shows_no_step_and_what_does_not_change_is_what_it_is() {
        let at = [0.0, 1.0, 2.0, 3.0, 4.0];
        for values in [[20.0, 21.0, 22.0, 23.0, 25.0], [20.1; 5], [20.1234567, 20.2, 20.1, 20.3, 20.7]] {
            assert_eq!(unrounded(&values, &at), values);
        }
        assert_eq!(unrounded(&[20.1, 20.2], &[0.0, 1.0]), [20.1, 20.2]);
    }

    /// A line is its own smoothest: what is a line within its rounding becomes the line.
    #[test]
    fn a_line_comes_back_whatever_the_order_and_the_distances() {
        let at: Vec<f64> = (0..60).map(|k| f64::from((k * 37) % 60).powf(1.3)).collect();
        let line = |t: f64| 20.03 + 0.004 * t;
        let shown: Vec<f64> = at.iter().map(|t| (line(*t) * 10.0).round() / 10.0).collect();
        let own = unrounded(&shown, &at);
        for (own, t) in own.iter().zip(&at) {
            assert!((own - line(*t)).abs() < 0.02, "{t}: {own}");
        }
    }

    /// What jumps by many steps is hardly changed.
    #[test]
    fn nothing_is_farther_than_half_a_step() {
        let at: Vec<f64> = (0..80).map(f64::from).collect();
        let shown: Vec<f64> = (0..80).map(|k| f64::from((k * k * 7) % 31) / 10.0).collect();
        let own = unrounded(&shown, &at);
        assert!(own.iter().zip(&shown).all(|(own, shown)| (own - shown).abs() < 0.05 + 1e-12));
    }
}
