//! Where a form's number that is not linear is looked for at first.

use super::form::Form;

/// Exponents that a law may have: roots to fourth powers.
const EXPONENTS: (f64, f64) = (0.2, 4.0);
/// Scale of an approach or a decay, as a share of X: below it is a step, above a straight line.
const APPROACH: (f64, f64) = (0.03, 2.0);
/// That of a logarithm.
const LOGARITHM: (f64, f64) = (1e-3, 1.0);
/// Where a saturation may begin.
const SATURATION: (f64, f64) = (0.05, 0.98);
/// Where something pulls, from the end of the data on, as a share of their range.
const AWAY: (f64, f64) = (0.05, 3.0);
/// Points of a first look at a number that is not linear.
const POINTS: usize = 21;
/// Cycles over the range of the variable: fewer are a bend, more than so many nobody looks for.
const CYCLES: (f64, f64) = (1.0, 60.0);
/// The same of a wave that changes: over fewer than two it is a curve of any shape, and over more
/// than so many the first look at its change is too coarse.
const CYCLES_OF_A_CHANGE: (f64, f64) = (2.0, 20.0);
/// Distance of two frequencies in cycles over the range: a wave of one is still half in step with
/// that of the other.
pub(super) const APART: f64 = 0.15;
/// Waves that differ by more cycles over X are others, or go uphill to others.
pub(super) const OTHER: f64 = 0.4;
/// Levels of the variable from which on waves are looked for.
const LEVELS_OF_A_WAVE: usize = 6;
/// The same of a wave that changes, as many for each of two periods.
const LEVELS_OF_A_CHANGE: usize = 12;

impl Form {
    /// Coordinates of a first look at s over a variable from `low` to `high` (shares of X) with so
    /// many levels; nothing where these levels do not determine the form.
    pub fn grid(self, (low, high): (f64, f64), levels: usize) -> Vec<f64> {
        let between = |(a, b): (f64, f64), count: usize| -> Vec<f64> {
            (0..count).map(|k| a + (b - a) * k as f64 / (count - 1) as f64).collect()
        };
        let logs = |(a, b): (f64, f64)| between((a.ln(), b.ln()), POINTS);
        let away = || {
            let (first, last) = (AWAY.0.ln(), AWAY.1.ln());
            (0..POINTS).map(move |k| (first + (last - first) * k as f64 / (POINTS - 1) as f64).exp())
        };
        let constants = self.count() + usize::from(self.constant().is_some()) + self.shape().len();
        if levels <= constants {
            return Vec::new();
        }
        match self {
            Form::Power | Form::PowerAfterGap => logs(EXPONENTS),
            Form::Approach | Form::Decay | Form::Settling | Form::Rounded => logs(APPROACH),
            Form::Pull if low < 0.0 => Vec::new(),
            Form::Pull | Form::PullAbove => away().map(|distance| high + distance * (high - low)).collect(),
            Form::PullBelow => away().rev().map(|distance| low - distance * (high - low)).collect(),
            Form::Logarithm => logs(LOGARITHM),
            Form::Saturation => between(SATURATION, POINTS),
            Form::Threshold | Form::PowerBeyond(_) | Form::Rough(_) | Form::Step => {
                let inset = 0.5 / levels.min(POINTS) as f64 * (high - low);
                between((low + inset, high - inset), POINTS)
            }
            Form::Harmonic | Form::Chirp(_) | Form::Swell(_) | Form::Oscillation => {
                let (cycles, least) = match self.shape().is_empty() {
                    true => (CYCLES, LEVELS_OF_A_WAVE),
                    false => (CYCLES_OF_A_CHANGE, LEVELS_OF_A_CHANGE),
                };
                // levels at even distances show one wave as well as another: all of them compete
                let count = ((cycles.1 - cycles.0) / APART) as usize;
                let frequency = |k: usize| (cycles.0 + APART * k as f64) / (high - low);
                match levels >= least {
                    true => (0..=count).map(|k| frequency(k).ln()).collect(),
                    false => Vec::new(),
                }
            }
            Form::Polynomial(_) => vec![0.0],
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_form_needs_more_levels_than_it_has_constants() {
        let is_tried = |form: Form, levels: usize| !form.grid((0.0, 1.0), levels).is_empty();
        assert!(!is_tried(Form::Power, 2) && is_tried(Form::Power, 3));
        assert!(!is_tried(Form::Polynomial(3), 3) && is_tried(Form::Polynomial(3), 4));
        assert!(!is_tried(Form::Harmonic, 3) && is_tried(Form::Harmonic, 12));
        assert!(!is_tried(Form::CHIRP, 11) && is_tried(Form::CHIRP, 12) && !is_tried(Form::SWELL, 11));
    }
}
