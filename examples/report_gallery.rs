//! Writes a report with one of every picture into a directory, to look at while working on them:
//! `cargo run --example regenerate -- gallery <directory> <poses>`. The numbers are invented but of
//! the right size.

use rand::{RngExt, SeedableRng};
use rand_chacha::ChaCha8Rng;
use rodcal::files::{Existing, write_together};
use rodcal::report::chart::{Bar, Chart, Direction, Figure, Mark, Point, Range, Style};
use rodcal::report::pictures::calibration::{
    Convergence, MethodErrors, ModeComparison, ModeResiduals, ParameterCorrection, PoseError, PoseResidual,
    PoseVector, ResidualGroup, convergence, cumulative_errors, error_distribution, error_over_workspace,
    mode_comparison, parameter_corrections, residual_vectors, residuals_by_group,
};
use rodcal::report::pictures::{
    LoadDeflection, LoadLine, LoadUnit, MeanReading, Residuals, RodShape, Rung, ShapeCase, Station,
    StationKind, Waterfall, load_deflection, residuals, rod_shape, waterfall,
};
use rodcal::report::table::{Column, Table};
use rodcal::report::{Block, Report, Section};

pub fn main(arguments: &[String]) -> rodcal::Result<()> {
    let directory = arguments.first().cloned().unwrap_or_else(|| "reports/gallery".into());
    let poses = arguments.get(1).and_then(|n| n.parse().ok()).unwrap_or(150);
    let files = report(poses).files()?;
    write_together(std::path::Path::new(&directory), &files, Existing::Keep)
}

fn report(poses: usize) -> Report {
    let mut report = Report::new(
        "Stiffness of rods 5# and 2#",
        "Rod 5# bends 33.0 ± 0.2 µm/N along Y at its tip, 1.2 % more than the finite-element model says.",
    );
    report.warnings =
        vec!["Rod 2#: only one reading per load; standard errors are taken from rod 5#.".into()];
    report.sections = vec![
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
            Section::new(
                "Calibration",
                calibration(poses).into_iter().map(|f| Block::Figure(f.clone().captioned(format!("{} Invented.", f.caption)))).collect(),
            ),
            Section::new("Later results", vec![Block::Figure(joint_angles()), Block::Figure(histogram())]),
        ];
    report.provenance = vec![
        ("Readings".into(), "stiffness_data/rod5.csv, 36 readings, sha256 0c1d9f6b2f…".into()),
        ("Rod".into(), "rods/rod5.toml".into()),
        ("Options".into(), "robust = false, confidence = 95 %".into()),
    ];
    report
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
    LoadLine { label: label.into(), slope_um_per_n, intercept_um, is_fit, band: Vec::new() }
}

fn readings(slope: f64, friction: f64, error: f64) -> Vec<MeanReading> {
    let reading = |(load_n, wobble): &(f64, f64)| MeanReading {
        load_n: *load_n,
        mean_um: slope * (load_n - friction) + wobble * error,
        standard_error_um: error,
        residual_um: wobble * error,
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
    rod_shape(&RodShape { title: "5# steel".into(), centreline_mm, cases, stations, ..RodShape::default() })
}

fn contribution_picture() -> Figure {
    let quantity = |title: &str, calc: f64, values: [f64; 5], measured: f64| {
        let total = |name: &str, value, half_width| Rung::Total { name: name.into(), value, half_width };
        let names = ["axial", "shear", "bend", "joints", "sleeves"];
        let model = calc + values.iter().sum::<f64>();
        let mut rungs = vec![total("Calc", calc, None)];
        rungs.extend(
            names.iter().zip(values).map(|(name, added)| Rung::Term { name: name.to_string(), added }),
        );
        rungs.push(total("FEA", model, None));
        rungs.push(Rung::Remainder { name: "not in the model".into(), added: measured - model });
        rungs.push(total("Meas", measured, Some(0.4)));
        Waterfall { title: title.into(), unit: "µm/N".into(), rungs }
    };
    waterfall(&[
        quantity("C^F 22", 30.2, [0.0, 0.043, 0.92, 2.41, -0.38], 35.1),
        quantity("C^F 33", 25.1, [0.0013, 0.038, 0.71, 1.36, -0.29], 26.6),
    ])
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
    Figure::new(panels, 3).with_shared_legend().named("residual-angle").captioned("Residuals over angles.")
}

fn histogram() -> Figure {
    let bars = |seed: f64, shift: f64| {
        let bar = |i: i32| {
            let x = f64::from(i) * 10.0 - 100.0 + shift;
            let value = 40.0 * f64::exp(-(x / seed).powi(2)).max(0.004);
            Bar { from: x, to: x + 4.5, value: value.round(), ..Bar::default() }
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

/// The pictures of a calibration with this many poses.
fn calibration(poses: usize) -> Vec<Figure> {
    let mut random = ChaCha8Rng::seed_from_u64(5);
    let modes = [("rigid rod", 46.0), ("Calc", 31.0), ("FEA", 24.0), ("Meas", 20.0)];
    let lengths = |sigma_um: f64, random: &mut ChaCha8Rng| -> Vec<f64> {
        (0..poses).map(|_| sigma_um * (0..3).map(|_| normal(random).powi(2)).sum::<f64>().sqrt()).collect()
    };
    let residuals = modes.map(|(title, sigma_um)| {
        let lengths_um = lengths(sigma_um / 1.7, &mut random);
        by_group(title, &lengths_um)
    });
    let methods =
        [("nominal", 700.0), ("rigid rod", 95.0), ("FEA", 61.0), ("Meas", 54.0)].map(|(label, sigma_um)| {
            let errors_mm = lengths(sigma_um / 1.7, &mut random).into_iter().map(|l| l / 1000.0).collect();
            MethodErrors { label: label.into(), errors_mm }
        });
    let at_mm: Vec<[f64; 3]> = (0..poses).map(|_| place(&mut random)).collect();
    let errors: Vec<PoseError> = at_mm
        .iter()
        .map(|at| PoseError { at_mm: *at, error_mm: 8e-5 * at[0] * (0.7 + 0.3 * normal(&mut random).abs()) })
        .collect();
    let vectors: Vec<PoseVector> = at_mm
        .iter()
        .map(|at| {
            let bend = [0.0, -0.02 * at[2], -0.03 * at[0]];
            PoseVector { at_mm: *at, residual_um: bend.map(|b| b + 8.0 * normal(&mut random)) }
        })
        .collect();
    vec![
        residuals_by_group(&residuals),
        error_distribution(&methods),
        error_distribution(&methods[1..]),
        cumulative_errors(&methods),
        cumulative_errors(&methods[1..]),
        error_over_workspace(&errors),
        residual_vectors(&vectors),
        loops(),
        corrections(&mut random),
        compared(),
    ]
}

/// A standard normal number (Box and Muller 1958).
fn normal(random: &mut ChaCha8Rng) -> f64 {
    let (u, v): (f64, f64) = (1.0 - random.random::<f64>(), random.random());
    (-2.0 * u.ln()).sqrt() * (std::f64::consts::TAU * v).cos()
}

/// Somewhere in front of a robot, mm.
fn place(random: &mut ChaCha8Rng) -> [f64; 3] {
    let angle = 1.2 * (2.0 * random.random::<f64>() - 1.0);
    let reach = 450.0 + 500.0 * random.random::<f64>();
    [reach * angle.cos(), reach * angle.sin(), 150.0 + 600.0 * random.random::<f64>()]
}

/// Five clamps; every 37th pose went wrong, one of them badly.
fn by_group(title: &str, lengths_um: &[f64]) -> ModeResiduals {
    let rms_um = (lengths_um.iter().map(|l| l * l).sum::<f64>() / lengths_um.len().max(1) as f64).sqrt();
    let pose = |i: usize| {
        let outlier = i % 37 == 22;
        let factor = if i == 22 { 40.0 } else { 1.5 };
        let length_um = if outlier { factor * rms_um + lengths_um[i] } else { lengths_um[i] };
        PoseResidual { name: format!("P{:03}", i + 1), length_um, outlier }
    };
    let cut = |k: usize| k * lengths_um.len() / 5;
    let group = |k: usize| ResidualGroup {
        name: format!("clamp {}", k + 1),
        poses: (cut(k)..cut(k + 1)).map(pose).collect(),
    };
    ModeResiduals { title: title.into(), groups: (0..5).map(group).collect(), rms_um }
}

fn loops() -> Figure {
    let falling =
        |start: f64, factor: f64, floor: f64| (0..9).map(|i| start * f64::powi(factor, i) + floor).collect();
    let panel = |quantity: &str, tolerance, curves: [(&str, Vec<f64>); 3]| Convergence {
        title: "compensation of the rod".into(),
        quantity: quantity.into(),
        unit: "µm".into(),
        tolerance,
        curves: curves.map(|(label, values)| (label.to_owned(), values)).into(),
    };
    convergence(&[
        panel(
            "largest change of a deflection",
            Some(0.01),
            [
                ("Calc", falling(280.0, 0.05, 0.0)),
                ("FEA", falling(310.0, 0.07, 0.0)),
                ("Meas", falling(330.0, 0.09, 0.0)),
            ],
        ),
        panel(
            "rms residual",
            None,
            [
                ("Calc", falling(80.0, 0.2, 31.0)),
                ("FEA", falling(90.0, 0.2, 24.0)),
                ("Meas", falling(95.0, 0.2, 20.0)),
            ],
        ),
    ])
}

fn corrections(random: &mut ChaCha8Rng) -> Figure {
    let mut parameter = |name: String, size: f64, half: f64| {
        let (correction, half) = (size * normal(random), half * (0.6 + random.random::<f64>()));
        let interval = Some([correction - half, correction + half]);
        ParameterCorrection { name, correction, interval, note: String::new() }
    };
    let mut lengths: Vec<_> = ["a", "d"]
        .iter()
        .flat_map(|l| (1..=6).map(move |i| format!("{l}{i}")))
        .map(|n| parameter(n, 0.3, 0.05))
        .collect();
    lengths.extend(
        ["tool x", "tool y", "tool z", "base x", "base y", "base z"].map(|n| parameter(n.into(), 0.4, 0.08)),
    );
    let mut angles: Vec<_> = ["alpha", "theta"]
        .iter()
        .flat_map(|l| (1..=6).map(move |i| format!("{l}{i}")))
        .map(|n| parameter(n, 0.8, 0.1))
        .collect();
    angles.extend(["base A", "base B", "base C"].map(|n| parameter(n.into(), 0.5, 0.1)));
    let unknown = |p: &mut ParameterCorrection, note: &str| {
        (p.correction, p.interval, p.note) = (0.0, None, note.into())
    };
    unknown(&mut lengths[7], "");
    unknown(&mut lengths[8], "same as d2");
    unknown(&mut angles[11], "same as the tool");
    lengths[4].interval = Some([-9.0, 9.5]);
    parameter_corrections(&lengths, &angles)
}

fn compared() -> Figure {
    let mode = |(name, mean_mm, difference_mm): (&str, f64, f64)| ModeComparison {
        name: name.into(),
        mean_mm,
        mean_interval_mm: Some([mean_mm - 0.009, mean_mm + 0.010]),
        difference_mm,
        difference_interval_mm: Some([difference_mm - 0.003, difference_mm + 0.004]),
    };
    let rows = [
        ("rigid rod", 0.095, 0.0),
        ("Calc", 0.068, -0.027),
        ("FEA", 0.061, -0.034),
        ("Meas", 0.054, -0.041),
        ("Meas, joints", 0.0535, -0.0415),
    ];
    mode_comparison(&rows.map(mode))
}
