//! Writes a report with one of every picture into a directory, to look at while working on them:
//! `cargo run --example report_gallery -- <directory>`. The numbers are invented but of the right size.

use rodcal::report::chart::{Bar, Chart, Direction, Figure, Mark, Point, Range, Style};
use rodcal::report::pictures::{
    Contributions, LoadDeflection, LoadLine, LoadUnit, MeanReading, Residuals, RodShape, ShapeCase, Station,
    StationKind, contributions, load_deflection, residuals, rod_shape,
};
use rodcal::report::table::{Column, Table};
use rodcal::report::{Block, Report, Section};

fn main() -> rodcal::Result<()> {
    let directory = std::env::args().nth(1).unwrap_or_else(|| "reports/gallery".into());
    let files = report().files(true)?;
    rodcal::files::write_together(std::path::Path::new(&directory), &files)
}

fn report() -> Report {
    Report {
        title: "Stiffness of rods 5# and 2#".into(),
        headline: "Rod 5# bends 33.0 ± 0.2 µm/N along Y at its tip, 1.2 % more than the finite-element model says."
            .into(),
        warnings: vec!["Rod 2#: only one reading per load; standard errors are taken from rod 5#.".into()],
        sections: vec![
            Section::new(
                "Compliance",
                vec![
                    Block::Paragraph("Straight lines fitted through all readings of each direction.".into()),
                    Block::Table(compliance_table()),
                    Block::Figure(load_deflection(&[steel(), carbon()], LoadUnit::Newton).captioned(
                        "Deflection over load. Where the fitted line meets the load axis, the rig's friction is overcome.",
                    )),
                    Block::Figure(
                        load_deflection(&[steel()], LoadUnit::Kilogram).captioned("The same for one rod, in kilograms."),
                    ),
                    Block::Figure(residual_picture()),
                ],
            ),
            Section::new("Shape", vec![Block::Figure(shape().captioned(
                "Rod 5# at rest and bent. Deflections are exaggerated as the titles say.",
            ))]),
            Section::new(
                "What the models left out",
                vec![
                    Block::List(vec!["Joints are worth most.".into(), "Shear can be left out.".into()]),
                    Block::Figure(contribution_picture()),
                ],
            ),
            Section::new("Later results", vec![Block::Figure(joint_angles()), Block::Figure(histogram())]),
        ],
        provenance: vec![
            ("Readings".into(), "stiffness_data/rod5.csv, 36 readings, sha256 0c1d9f6b2f…".into()),
            ("Rod".into(), "rods/rod5.toml".into()),
            ("Options".into(), "robust = false, confidence = 95 %".into()),
        ],
    }
}

fn compliance_table() -> Table {
    let number = Column::number;
    let columns = vec![
        Column::text("rod"),
        Column::text("direction"),
        number("Calc", "µm/N"),
        number("FEA", "µm/N"),
        number("Meas", "µm/N"),
        number("standard error", "µm/N"),
        number("Meas − FEA", "%"),
    ];
    let mut table = Table::new("compliance", "Compliance at the tip.", columns);
    table.row(["5# steel", "x", "1.92", "2.05", "2.11", "0.04", "2.9"]);
    table.row(["5# steel", "y", "30.0", "32.6", "33.0", "0.2", "1.2"]);
    table.row(["5# steel", "z", "25.1", "26.9", "26.2", "0.2", "-2.6"]);
    table.row(["2# carbon", "y", "5.0", "5.7", "7.8", "0.09", "36.8"]);
    table.notes.push("Calc: Euler–Bernoulli without joints. FEA: solid elements.".into());
    table
}

fn line(label: &str, slope_um_per_n: f64, intercept_um: f64, is_fit: bool) -> LoadLine {
    LoadLine { label: label.into(), slope_um_per_n, intercept_um, is_fit }
}

fn readings(slope: f64, friction: f64, error: f64) -> Vec<MeanReading> {
    let reading = |(load_n, wobble): &(f64, f64)| MeanReading {
        load_n: *load_n,
        mean_um: slope * (load_n - friction) + wobble * error,
        standard_error_um: error,
    };
    [(4.9, 0.7), (9.8, -1.0), (14.7, -0.2), (19.6, 0.5)].iter().map(reading).collect()
}

fn steel() -> LoadDeflection {
    LoadDeflection {
        title: "5# steel, along Y".into(),
        lines: vec![
            line("Calc", 30.0, 0.0, false),
            line("FEA", 32.6, 0.0, false),
            line("Meas", 33.0, -29.7, true),
        ],
        readings: readings(33.0, 0.9, 6.0),
        ..LoadDeflection::default()
    }
}

fn carbon() -> LoadDeflection {
    LoadDeflection {
        title: "2# carbon, along Y".into(),
        lines: vec![
            line("Calc", 5.0, 0.0, false),
            line("FEA", 5.7, 0.0, false),
            line("Meas", 7.8, -7.6, true),
        ],
        readings: readings(7.8, 0.98, 1.5),
        ..LoadDeflection::default()
    }
}

fn residual_picture() -> Figure {
    let points = |seed: f64| -> Vec<[f64; 2]> {
        let wobble = |i: usize| 2.0 * (f64::sin(seed + 2.3 * i as f64) + f64::cos(1.7 * seed * i as f64));
        (0..12).map(|i| [4.9 * (1 + i / 3) as f64, wobble(i)]).collect()
    };
    residuals(&Residuals {
        title: "Residuals of the fitted lines, 5# steel".into(),
        series: vec![
            ("along X".into(), points(1.0)),
            ("along Y".into(), points(2.0)),
            ("along Z".into(), points(3.0)),
        ],
        noise_um: 2.9,
        noise_label: "± 2 standard deviations of repeated readings".into(),
    })
    .captioned("What the fitted lines leave.")
}

fn shape() -> Figure {
    let (l1, l2) = (150.0, 525.0);
    let upright = (0..=10).map(|i| [0.0, 0.0, l1 * f64::from(i) / 10.0]);
    let centreline_mm: Vec<[f64; 3]> =
        upright.chain((1..=30).map(|i| [l2 * f64::from(i) / 30.0, 0.0, l1])).collect();
    let case = |label: &str, size_um: f64, direction: [f64; 3]| {
        let bend = |p: &[f64; 3]| {
            let t = (p[2] + p[0]) / (l1 + l2);
            direction.map(|d| d * size_um * t * t * (3.0 - t) / 2.0)
        };
        ShapeCase { label: label.into(), deflection_um: centreline_mm.iter().map(bend).collect() }
    };
    let cases = vec![
        case("gravity along −Z", 27.0, [0.0, 0.0, -1.0]),
        case("gravity along −Y", 31.0, [0.0, -1.0, 0.0]),
        case("gravity along −X", 9.0, [-0.6, 0.0, -1.0]),
        case("1 N along Y at the tip", 33.0, [0.0, 1.0, 0.0]),
    ];
    let station = |label: &str, at_mm, kind| Station { label: label.into(), at_mm, kind };
    let stations = vec![
        station("sleeve", [0.0, 0.0, 30.0], StationKind::Joint),
        station("elbow, 48 g", [0.0, 0.0, 150.0], StationKind::Mass),
        station("glued joint", [25.0, 0.0, 150.0], StationKind::Joint),
        station("tip, 35 g", [525.0, 0.0, 150.0], StationKind::Mass),
        station("load", [515.0, 0.0, 150.0], StationKind::Load),
        station("gauge", [500.0, 0.0, 150.0], StationKind::Reading),
        station("stiffness differs here", [25.0, 0.0, 150.0], StationKind::Located),
    ];
    rod_shape(&RodShape { title: "5# steel".into(), centreline_mm, cases, stations, exaggeration: None })
}

fn contribution_picture() -> Figure {
    let group = |title: &str, unit: &str, values: [f64; 6]| {
        let names = ["axial", "shear", "tip mass", "bend", "joints", "sleeves"];
        let terms = names.iter().zip(values).map(|(name, value)| (name.to_string(), value)).collect();
        Contributions { title: title.into(), unit: unit.into(), terms }
    };
    contributions(&[
        group("C11", "µm/N", [0.0021, 0.011, 0.0, 0.05, 0.13, -0.02]),
        group("C22", "µm/N", [0.0, 0.043, 0.0, 0.92, 2.41, -0.38]),
        group("C33", "µm/N", [0.0013, 0.038, 0.0, 0.71, 1.36, -0.29]),
        group("Cg33", "%", [0.004, 0.12, 18.3, 2.1, 6.9, -1.4]),
    ])
    .captioned("What each left-out term would add.")
}

fn joint_angles() -> Figure {
    let panel = |joint: usize| {
        let points = (0..80).map(|i| {
            let x = -170.0 + 340.0 * f64::from(i) / 79.0;
            let y = 40.0 * f64::sin(joint as f64 + x / 50.0) + 30.0 * f64::sin(12.9 * f64::from(i * i));
            Point { x, y, error: 0.0 }
        });
        let mut chart = Chart::new(format!("joint {joint}"), "angle / °", "residual / µm")
            .with(Mark::Points { label: String::new(), points: points.collect(), style: Style::nth(joint) })
            .with(Mark::Vertical { at: 90.0, text: "stop".into() });
        chart.x.range = Range::Fixed(-180.0, 180.0);
        chart.x.step = Some(90.0);
        chart
    };
    let panels = (0..3).map(panel).collect();
    Figure {
        name: "residual-angle".into(),
        caption: "Residuals over angles.".into(),
        panels,
        columns: 3,
        shared_legend: true,
    }
}

fn histogram() -> Figure {
    let bars = |seed: f64, shift: f64| {
        let bar = |i: i32| {
            let x = f64::from(i) * 10.0 - 100.0 + shift;
            let value = 40.0 * f64::exp(-(x / seed).powi(2)).max(0.004);
            Bar { from: x, to: x + 4.5, value: value.round(), text: String::new() }
        };
        (0..20).map(bar).collect()
    };
    let chart = Chart::new("Position errors before and after", "error / µm", "poses")
        .with(Mark::Bars {
            label: "nominal".into(),
            bars: bars(60.0, 0.0),
            direction: Direction::Up,
            style: Style::nth(1),
        })
        .with(Mark::Bars {
            label: "calibrated".into(),
            bars: bars(25.0, 4.7),
            direction: Direction::Up,
            style: Style::nth(2),
        })
        .with(Mark::Horizontal { at: 35.0, text: "expected".into() });
    Figure::from(chart).named("histogram").captioned("Invented.")
}
