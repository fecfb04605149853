//! The step of a display.

use super::datum::Datum;
use crate::units::UM;

/// The step that all offsets are multiples of, m: 10, 5, 2, 1, 0.5 µm and so on; 0 where they show
/// none.
pub fn resolution<'a>(data: impl IntoIterator<Item = &'a Datum>) -> f64 {
    const COARSEST: i32 = 1;
    const FINEST: i32 = -6;
    /// The file's decimals are not exact in binary, and the more steps the less so.
    const INEXACT: f64 = 1e-6;
    let is_multiple = |datum: &Datum, step: f64| {
        let steps = datum.measured / UM / step;
        (steps - steps.round()).abs() <= INEXACT
    };
    let steps = (FINEST..=COARSEST).rev().flat_map(|decade| {
        let mantissas: &[f64] = if decade == COARSEST { &[1.0] } else { &[5.0, 2.0, 1.0] };
        mantissas.iter().map(move |mantissa| mantissa * 10f64.powi(decade))
    });
    let data: Vec<&Datum> = data.into_iter().collect();
    let mut steps = steps.filter(|&step| data.iter().all(|d| is_multiple(d, step)));
    steps.next().map_or(0.0, |step| step * UM)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::diagnosis::rig::recording::datum;
    use crate::rig::readings::Readings;

    #[test]
    fn the_resolution_is_the_step_of_the_display() {
        let step_of = |a: &str, b: &str| {
            let text = format!("axis,load_n,dy_um\ny,1,{a}\ny,2,{b}\n");
            resolution(&datum::all(&Readings::from_text("f", &text).unwrap().rows)) / UM
        };
        for (a, b, step) in [
            ("50", "-110", 10.0),
            ("50", "105", 5.0),
            ("50", "-102", 2.0),
            ("50", "101", 1.0),
            ("0.5", "101", 0.5),
            ("38709.346", "0.2", 0.002),
            ("0", "0", 10.0),
            ("3.14159265358979", "1", 0.0),
        ] {
            assert!((step_of(a, b) - step).abs() < 1e-12, "{a} {b}");
        }
    }
}
