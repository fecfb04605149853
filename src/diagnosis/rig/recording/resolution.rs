//! The step of a display.

use super::datum::Datum;
use super::multiples::step_of;

/// The step that all offsets are multiples of, m: 10, 5, 2, 1, 0.5 µm and so on; 0 where they show
/// none.
pub fn resolution<'a>(data: impl IntoIterator<Item = &'a Datum>) -> f64 {
    step_of(&data.into_iter().map(|datum| datum.measured).collect::<Vec<_>>())
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::diagnosis::rig::recording::datum;
    use crate::rig::readings::Readings;
    use crate::units::UM;

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
