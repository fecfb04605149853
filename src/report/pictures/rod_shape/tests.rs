//! What a drawing of a rod shows.

use super::*;

fn bent_rod() -> RodShape {
    RodShape {
        centreline_mm: vec![[0.0; 3], [0.0, 0.0, 150.0], [525.0, 0.0, 150.0]],
        cases: vec![ShapeCase {
            label: "1 N along Y".into(),
            deflection_um: vec![[0.0; 3], [0.0, 1.0, 0.0], [0.0, 33.0, 0.0]],
        }],
        ..RodShape::default()
    }
}

#[test]
fn the_scale_is_in_the_title_and_a_case_only_where_it_moves_something() {
    let figure = rod_shape(&bent_rod());
    assert_eq!(figure.panels[1].title, "view from above, deflection ×\u{a0}2000");
    let drawn = |panel: &Chart| {
        panel
            .marks
            .iter()
            .filter(
                |m| matches!(m, Mark::Line { points, label, .. } if !points.is_empty() && !label.is_empty()),
            )
            .count()
    };
    // from the side the rod alone, from above the case too
    assert_eq!(figure.panels.iter().map(drawn).collect::<Vec<_>>(), [1, 2]);
}

#[test]
fn tubes_are_to_scale_and_what_is_around_them_is_not() {
    let mut rod = bent_rod();
    let tube = |from_mm, to_mm| Tube {
        label: "Ø 32 × 1 mm".into(),
        from_mm,
        to_mm,
        outer_mm: [32.0; 2],
        inner_mm: [30.0; 2],
        is_sleeve: false,
    };
    rod.tubes = vec![tube(0.0, 150.0), tube(150.0, 675.0)];
    let at = |at_mm| Station { label: "ring".into(), at_mm, kind: StationKind::Mass };
    rod.stations = vec![at([200.0, 0.0, 150.0]), at([525.0, 0.0, 150.0])];
    let figure = rod_shape(&rod);
    let areas = |panel: usize, name: &str| -> Vec<Vec<[f64; 2]>> {
        let of_mark = |mark: &Mark| match mark {
            Mark::Area { label, corners, .. } if label == name => Some(corners.clone()),
            _ => None,
        };
        figure.panels[panel].marks.iter().filter_map(of_mark).collect()
    };
    // the wall of pipe I's left side: 1 mm thick, mitred at the corner
    assert_eq!(areas(0, "wall")[0], [[-16.0, 0.0], [-16.0, 166.0], [-15.0, 165.0], [-15.0, 0.0]]);
    // from above pipe I is its own section
    let section = &areas(1, "wall")[0];
    let widest = extent(section.iter().map(|p| p[0])).unwrap();
    assert!((widest.1 - widest.0 - 32.0).abs() < 1e-9, "{widest:?}");
    // the ring is a collar, the ball at the tip a point
    let drawn = |mark: &&Mark| matches!(mark, Mark::Line { label, .. } if label == "mass");
    assert_eq!(figure.panels[0].marks.iter().filter(drawn).count(), 1);
    assert!(figure.caption.contains("to scale"));
    // also without a load case all of it is in the frame
    rod.cases.clear();
    let Range::Fixed(low, high) = rod_shape(&rod).panels[0].x.range else { panic!("fixed") };
    assert!(low <= -16.0 && high >= 525.0, "{low} {high}");
    figure.svg();
}

#[test]
fn a_located_mismatch_is_named_in_both_views() {
    let mut rod = bent_rod();
    let at_mm = [0.0, 0.0, 150.0];
    rod.stations.push(Station { label: "bend".into(), at_mm, kind: StationKind::Located });
    assert_eq!(rod_shape(&rod).svg().matches(">\nbend\n").count(), 2);
}

#[test]
fn a_rod_of_nothing_draws() {
    rod_shape(&RodShape::default()).svg();
    let centreline_mm = vec![[f64::NAN; 3], [0.0; 3]];
    rod_shape(&RodShape { centreline_mm, exaggeration: Some(f64::INFINITY), ..bent_rod() }).svg();
}
