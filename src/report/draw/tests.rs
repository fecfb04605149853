//! What is drawn where.

use roxmltree::Document;

use super::super::chart::{Align, Bar, Direction, Mark, Marker, Point, Range, Style};
use super::*;

fn every_mark(values: [f64; 3]) -> Chart {
    let [a, b, c] = values;
    let label = || "<&>\u{1}".to_owned();
    let style = Style::nth(3);
    let bars = |direction| Mark::Bars {
        label: label(),
        bars: vec![Bar { from: a, to: b, base: b, value: c, text: label() }],
        direction,
        style,
    };
    Chart::new(label(), "x / mm", "y / µm")
        .with(Mark::Line { label: label(), points: vec![[a, b], [b, c], [c, a]], style })
        .with(Mark::Points { label: label(), points: vec![Point { x: a, y: b, error: c }], style })
        .with(bars(Direction::Up))
        .with(bars(Direction::Right))
        .with(Mark::Band { label: label(), points: vec![[a, b, c], [b, c, a]], style })
        .with(Mark::Horizontal { at: a, text: label() })
        .with(Mark::Vertical { at: b, text: label() })
        .with(Mark::Stretch { from: b, to: c, text: label() })
        .with(Mark::Event { at: c, text: label() })
        .with(Mark::Area { label: label(), corners: vec![[a, b], [b, c], [c, a]], style })
        .with(Mark::Text {
            at: [b, a],
            text: label(),
            align: Align::Left,
            shift_px: [0.0; 2],
            is_number: true,
        })
        .with(Mark::Note { at: [a, c], text: label() })
        .with(Mark::Arrow { from: [a, b], to: [b, c], text: label(), style })
}

#[test]
fn whatever_the_data_the_picture_is_well_formed() {
    let odd = [0.0, -0.0, 1.0, -7.0, f64::NAN, f64::INFINITY, f64::NEG_INFINITY, 1e300, -1e199, 1e-300];
    for (i, a) in odd.into_iter().enumerate() {
        for b in odd {
            let mut chart = every_mark([a, b, odd[(i + 1) % odd.len()]]);
            chart.x.log = i % 2 == 1;
            chart.y.log = i % 3 == 1;
            for equal_aspect in [false, true] {
                chart.equal_aspect = equal_aspect;
                let svg = Figure::from(chart.clone()).svg();
                assert!(Document::parse(&svg).is_ok() && !svg.contains("NaN"), "{a} {b}\n{svg}");
            }
            chart.x.range = Range::Fixed(a, b);
            chart.y.step = Some(a);
            chart.height_px = Some(b);
            chart.y.names = vec![(a, "name".into()), (b, "other".into())];
            chart.frameless = i % 2 == 0;
            let svg = Figure::from(chart).svg();
            assert!(Document::parse(&svg).is_ok() && !svg.contains("NaN"), "{a} {b}\n{svg}");
        }
    }
    Figure::default().svg();
    Figure { columns: 3, shared_legend: true, ..Figure::default() }.svg();
}

#[test]
fn a_curve_is_seen_through_its_cloud_and_single_points_lie_on_theirs() {
    let is_above = |marker| {
        let points = vec![Point { x: 1.0, y: 1.0, error: 0.0 }; 3];
        let svg = Figure::from(
            Chart::new("", "", "")
                .with(Mark::Line {
                    label: String::new(),
                    points: vec![[0.0, 0.0], [2.0, 2.0]],
                    style: Style::nth(1),
                })
                .with(Mark::Points { label: String::new(), points, style: Style::nth(0).marker(marker) }),
        )
        .svg();
        svg.rfind("<circle").expect("points") > svg.find("#D55E00").expect("the curve")
    };
    assert!(!is_above(Marker::Dot) && is_above(Marker::Circle));
}

#[test]
fn the_view_box_is_the_size_ten_times_and_there_are_no_ids() {
    let panels = vec![every_mark([1.0, 2.0, 3.0]); 3];
    let svg = Figure { panels, columns: 2, caption: "Caption".into(), ..Figure::default() }.svg();
    let document = Document::parse(&svg).expect("is XML");
    let root = document.root_element();
    let number = |name| root.attribute(name).and_then(|v| v.parse::<f64>().ok()).expect("is a number");
    let view_box = format!("0 0 {} {}", 10.0 * number("width"), 10.0 * number("height"));
    assert_eq!(root.attribute("viewBox"), Some(view_box.as_str()));
    assert!(document.descendants().all(|node| node.attribute("id").is_none()));
    assert!(svg.contains("<desc>Caption</desc>") && svg.contains("(c) "), "{svg}");
}

#[test]
fn names_along_x_read_upwards_and_none_is_left_out() {
    let names: Vec<(f64, String)> =
        (1..=14).map(|k| (f64::from(k), format!("a very long name {k}"))).collect();
    let with = |names_upwards: bool| {
        let points = (1..=14).map(|k| Point { x: f64::from(k), y: 1.0, error: 0.0 }).collect();
        let mark = Mark::Points { label: String::new(), points, style: Style::nth(0) };
        let mut chart = Chart::new("", "answer", "truth").with(mark);
        chart.x.names = names.clone();
        chart.x.names_upwards = names_upwards;
        Figure::from(chart).captioned("Answers. And more.").svg()
    };
    assert!(with(false).matches("a very long name").count() < 14);
    assert_eq!(with(true).matches("a very long name").count(), 14);
    assert!(
        with(true).contains("<title>Answers</title>"),
        "a picture without a title is called by its caption"
    );
}
