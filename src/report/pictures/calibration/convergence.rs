//! How fast a loop settles, on a logarithmic axis.

use serde::Serialize;

use super::super::super::chart::{Chart, Figure, Mark, Point, Range, Style};
use super::super::super::scale::drawable;
use super::{MOST_POINTS, amount};

/// What changes from pass to pass of a loop.
#[derive(Debug, Clone, Default, Serialize)]
pub struct Convergence {
    /// Which loop.
    pub title: String,
    /// What is drawn, for example "change of the deflection".
    pub quantity: String,
    /// Its unit, for example "µm".
    pub unit: String,
    /// The loop ends below this; drawn as a line.
    pub tolerance: Option<f64>,
    /// Name of each curve and its value after pass 1, 2, ….
    pub curves: Vec<(String, Vec<f64>)>,
}

/// One panel per quantity over the passes, on a logarithmic axis. Values that are not above zero
/// have no place on it and are left out.
pub fn convergence(loops: &[Convergence]) -> Figure {
    let values = || loops.iter().flat_map(|l| &l.curves).flat_map(|(_, values)| values);
    let mut caption = String::from("What changes from pass to pass, on a logarithmic axis.");
    if values().any(|v| *v <= 0.0) {
        caption += " A pass that changed nothing has no point on it.";
    }
    if loops.iter().flat_map(|l| &l.curves).any(|(_, values)| values.len() > MOST_POINTS) {
        caption += &format!(" Of long loops only some {MOST_POINTS} passes are drawn.");
    }
    Figure {
        name: "convergence".into(),
        caption,
        panels: loops.iter().map(panel).collect(),
        columns: loops.len().clamp(1, 2),
        // Curves look by their position: one legend only where all panels have the same ones.
        shared_legend: loops.windows(2).all(|pair| names(&pair[0]).eq(names(&pair[1]))),
        ..Figure::default()
    }
}

fn names(data: &Convergence) -> impl Iterator<Item = &String> {
    data.curves.iter().map(|(label, _)| label)
}

fn panel(data: &Convergence) -> Chart {
    let mut chart = Chart::new(&data.title, "pass", format!("{} / {}", data.quantity, data.unit));
    let passes = data.curves.iter().map(|(_, values)| values.len()).max().unwrap_or(0);
    chart.x.range = Range::Fixed(0.5, passes.max(1) as f64 + 0.5);
    chart.x.step = (passes <= 12).then_some(1.0);
    chart.y.log = true;
    for (i, (label, values)) in data.curves.iter().enumerate() {
        let every = values.len().div_ceil(MOST_POINTS).max(1);
        let known = values.iter().enumerate().step_by(every).filter(|(_, v)| drawable(**v) && **v > 0.0);
        let points: Vec<[f64; 2]> = known.map(|(pass, v)| [(pass + 1) as f64, *v]).collect();
        let dots = points.iter().map(|[x, y]| Point { x: *x, y: *y, error: 0.0 }).collect();
        let style = Style::nth(i);
        chart.marks.push(Mark::Line { label: label.clone(), points, style });
        if passes <= 40 {
            chart.marks.push(Mark::Points { label: label.clone(), points: dots, style });
        }
    }
    if let Some(at) = data.tolerance.filter(|t| drawable(*t) && *t > 0.0) {
        chart.marks.push(Mark::Horizontal { at, text: format!("tolerance {}", amount(at, &data.unit)) });
    }
    chart
}

#[cfg(test)]
mod tests {
    use super::*;

    fn from_values(values: &[f64]) -> Convergence {
        Convergence {
            title: "compensation".into(),
            quantity: "change of the deflection".into(),
            unit: "µm".into(),
            tolerance: Some(0.001),
            curves: vec![("rod 5#".into(), values.to_vec())],
        }
    }

    #[test]
    fn passes_are_points_over_powers_of_ten() {
        let figure = convergence(&[from_values(&[120.0, 1.5, 0.02, 3e-4, 0.0])]);
        let Mark::Points { points, .. } = &figure.panels[0].marks[1] else { panic!("no points") };
        assert_eq!((points.len(), points[3].x), (4, 4.0));
        let svg = figure.svg();
        for text in [">\n100\n", ">\n10⁻³\n", "change of the deflection / µm", "tolerance 0.0010\u{a0}µm"]
        {
            assert!(svg.contains(text), "{text}\n{svg}");
        }
        assert!(figure.caption.contains("changed nothing"));
    }

    #[test]
    fn degenerate_loops_draw() {
        for values in [&[][..], &[1.0], &[0.0; 4], &[f64::NAN, 1.0], &[1e-190, 1e190], &[3.0; 100_000]] {
            convergence(&[from_values(values), from_values(values)]).svg();
        }
        convergence(&[]).svg();
        convergence(&[Convergence::default()]).svg();
    }
}
