//! `rig fit` against readings made here, by formulas of their own, from known slopes, friction and
//! noise; against NIST's certified values; and against the figures that the paper published.

#![allow(clippy::unwrap_used)]

mod coverage;
mod made;
mod published;

use approx::assert_relative_eq;
use made::{Rig, Truth, fit, readings, rod, with_rod};
use rodcal::beam::Physics;
use rodcal::least_squares::{Robust, RobustScale};
use rodcal::rig::line::Line;
use rodcal::rig::readings::Axis;
use rodcal::rig::{Fit, Options, Warning};
use rodcal::units::{STANDARD_GRAVITY, UM};

const HUBER: Robust = Robust::Huber { k: 1.345, scale: RobustScale::Mad };
const TUKEY: Robust = Robust::Tukey { c: 4.685, scale: RobustScale::Mad };

fn line<'a>(fit: &'a Fit, label: &str) -> &'a Line {
    let found = fit.lines.iter().find(|line| line.key.label() == label);
    found.unwrap_or_else(|| panic!("no line {label}"))
}

/// |found − true| in standard errors.
fn distance(found: rodcal::statistics::Estimate, truth: f64) -> f64 {
    (found.value - truth).abs() / found.std_error.unwrap()
}

#[test]
fn slope_intercept_and_load_offset_of_perfect_readings_are_exact() {
    // up and down, towards + and −, in N and in kg; friction takes 0.8 N off, the zero is off by 4
    // µm
    for (axis, sign) in [("z", 1.0), ("-z", -1.0)] {
        for (unit, newtons) in [("load_n", 1.0), ("load_kg", STANDARD_GRAVITY)] {
            let text = format!("axis,{unit},dz_um\n")
                + &[0.5, 1.0, 1.5, 2.5]
                    .map(|load| {
                        let offset = sign * (12.5 * (load * newtons - 0.8) + 4.0);
                        format!("{axis},{load},{offset}\n")
                    })
                    .concat();
            let fit = fit(&text);
            let line = &fit.lines[0];
            assert_relative_eq!(line.slope.value / UM, 12.5, max_relative = 1e-12);
            assert_relative_eq!(line.intercept.value / UM, sign * -6.0, max_relative = 1e-10);
            assert_relative_eq!(line.load_offset.unwrap().value, 0.48, max_relative = 1e-10);
        }
    }
}

#[test]
fn perfect_readings_through_the_origin_raise_no_warning() {
    for (slope, repeats) in [(12.5, 1), (7.3, 1), (0.1, 3), (33.021, 2)] {
        let mut text = "axis,load_n,dz_um\n".to_owned();
        for _ in 0..repeats {
            for load in [0.1, 0.7, 1.3, 1.9, 2.9] {
                text += &format!("z,{load},{}\n", slope * load);
            }
        }
        assert_eq!(fit(&text).warnings, [], "{slope}");
    }
}

#[test]
fn friction_splits_loading_from_unloading_and_leaves_the_slope_alone() {
    for axis in ["y", "-y"] {
        let rig = Rig { friction: 1.1, unload: true, trials: 20, ..Rig::default() };
        let truth = Truth { axis, slope: 20.0, offset: 5.0 };
        let fit = fit(&readings(&rig, &[truth], 7));
        let line = &fit.lines[0];
        assert!(distance(line.slope, 20.0 * UM) < 3.0, "{:?}", line.slope);
        assert!(distance(line.friction.unwrap(), 1.1) < 3.0, "{:?}", line.friction);
        // the zero error of 5 µm is 0.25 N more of an offset, on the same side for both directions
        // of the offset
        let sign = if axis == "y" { 1.0 } else { -1.0 };
        assert!(distance(line.load_offset.unwrap(), 1.1 - sign * 0.25) < 3.0, "{:?}", line.load_offset);
        assert!(distance(line.intercept, (-sign * 22.0 + 5.0) * UM) < 3.0);
        assert!(distance(line.unload_intercept.unwrap(), (sign * 22.0 + 5.0) * UM) < 3.0);
        assert_eq!(line.lack_of_fit.unwrap().dof_fit, 5);
    }
}

#[test]
fn one_reading_on_the_way_down_does_not_tilt_the_line() {
    // without a line of its own, it would lie 2 · 1.1 N · 20 µm/N above the others
    let rig = Rig { friction: 1.1, noise: 0.0, resolution: 0.0, trials: 1, ..Rig::default() };
    let truth = Truth { axis: "y", slope: 20.0, offset: 0.0 };
    let text = readings(&rig, &[truth], 1) + "y,5,1,unload,,122,\n";
    let fit = fit(&text);
    assert_relative_eq!(fit.lines[0].slope.value / UM, 20.0, max_relative = 1e-9);
    assert_relative_eq!(fit.lines[0].friction.unwrap().value, 1.1, max_relative = 1e-9);
}

#[test]
fn blank_cells_leave_the_other_channel_alone() {
    let text = "axis,load_n,dx_um,dz_um\nz,5,,50\nz,10,3,101\nz,15,,149\nz,20,6,200\n";
    let fit = fit(text);
    assert_eq!((line(&fit, "dx under load z").count, line(&fit, "dz under load z").count), (2, 4));
    assert_relative_eq!(line(&fit, "dx under load z").slope.value / UM, 0.3, max_relative = 1e-12);
    // Σ(F − F̄)(d − d̄)/Σ(F − F̄)² = 1245/125
    assert_relative_eq!(line(&fit, "dz under load z").slope.value / UM, 9.96, max_relative = 1e-12);
}

#[test]
fn averages_weigh_as_much_as_they_have_readings() {
    // averages 10, 20, 33 of 1, 4 and 1 readings at 1, 2, 3 N: Σn(F − 2)(d − d̄)/Σn(F − 2)² = 23/2
    let text = "axis,load_n,dz_um\nz,1,10\nz,2,19\nz,2,21\nz,2,18\nz,2,22\nz,3,33\n";
    let fit = fit(text);
    let line = &fit.lines[0];
    assert_relative_eq!(line.slope.value / UM, 11.5, max_relative = 1e-12);
    // d̄ = 123/6 = 20.5; residuals of the averages 1, −½, 1; F = (1 + 4/4 + 1)/1 over (1 + 1 + 4 +
    // 4)/3
    let test = line.lack_of_fit.unwrap();
    assert_relative_eq!(test.f, 3.0 / (10.0 / 3.0), max_relative = 1e-9);
    assert_eq!((test.dof_fit, test.dof_repeats), (1, 3));
    // p = 0.42: both variances together, (3 + 10)/4, over Σn(F − 2)² = 2
    assert_relative_eq!(line.slope.std_error.unwrap() / UM, (13.0f64 / 8.0).sqrt(), max_relative = 1e-9);
    assert_eq!(line.slope.dof, 4);
}

#[test]
fn a_crooked_line_is_known_as_badly_as_it_is_crooked() {
    let text = "axis,load_n,dz_um\nz,1,10\nz,1,10.2\nz,2,21\nz,2,21.2\nz,3,30\nz,3,30.2\n";
    let fit = fit(text);
    // averages 10.1, 21.1, 30.1: residuals ∓⅓, ⅔; s_f² = 2·(1/9 + 4/9 + 1/9) = 4/3, Σn(F − 2)² = 4
    assert_relative_eq!(
        fit.lines[0].slope.std_error.unwrap() / UM,
        (1.0f64 / 3.0).sqrt(),
        max_relative = 1e-9
    );
    assert_eq!(fit.lines[0].slope.dof, 1);
    assert!(fit.warnings.iter().any(|w| matches!(w, Warning::NotStraight { .. })), "{:?}", fit.warnings);
}

#[test]
fn trials_that_differ_are_counted_as_trials() {
    // three trials with slopes 10, 11, 12.5 and a little of their own
    let slopes = [10.0, 11.0, 12.5];
    let mut text = "axis,load_n,trial,dz_um\n".to_owned();
    for (trial, slope) in slopes.iter().enumerate() {
        for (load, wobble) in [(1.0, 0.01), (2.0, -0.01), (3.0, -0.01), (4.0, 0.01)] {
            text += &format!("z,{load},{trial},{}\n", slope * load + wobble);
        }
    }
    let fit = fit(&text);
    let line = &fit.lines[0];
    assert!(line.trials_differ);
    // standard error of the mean of the three: √(Σ(c − c̄)²/(2·3))
    let mean = 33.5 / 3.0;
    let variance = slopes.iter().map(|c| (c - mean) * (c - mean)).sum::<f64>() / 6.0;
    assert_relative_eq!(line.slope.value / UM, mean, max_relative = 1e-9);
    assert_relative_eq!(line.slope.std_error.unwrap() / UM, variance.sqrt(), max_relative = 1e-6);
    assert_eq!((line.slope.dof, line.lack_of_fit.unwrap().dof_repeats), (2, 4));
    // without names for the trials nothing tells: the scatter of readings has to do
    let nameless = made::fit(&text.replace("trial", "note"));
    assert!(!nameless.lines[0].trials_differ);
    assert_eq!(nameless.lines[0].slope.dof, 10);
}

#[test]
fn a_rod_softer_by_a_factor_has_that_r_and_its_model_times_it() {
    for factor in [1.0, 1.25, 0.9] {
        let tube = made::Tube { e_gpa: 200.0 / factor, g_gpa: 80.0 / factor, ..made::STEEL };
        let rig = Rig { noise: 0.0, resolution: 0.0, friction: 0.5, ..Rig::default() };
        let truths = [tube.truth("y"), tube.truth("z"), tube.truth("-z")];
        let fit = with_rod(&readings(&rig, &truths, 1), &rod(&made::STEEL), Robust::None);
        let measured = fit.measured.unwrap();
        assert_relative_eq!(measured.rod_ratio.value, factor, max_relative = 1e-9);
        let names: Vec<String> = measured.ratios.iter().map(|r| r.name()).collect();
        assert_eq!(names, ["22", "33"]);
        for ratio in &measured.ratios {
            assert_relative_eq!(ratio.value.value, factor, max_relative = 1e-9);
        }
        assert_relative_eq!(measured.compliance.force[(1, 1)] / UM, tube.c22(), max_relative = 1e-9);
        assert_relative_eq!(measured.compliance.force[(2, 2)] / UM, tube.c33(), max_relative = 1e-9);
        let derived = measured.model.gravity * measured.rod_ratio.value;
        assert_eq!(measured.compliance.gravity, derived);
        assert_eq!(
            measured.compliance.force[(0, 0)],
            measured.model.force[(0, 0)] * measured.rod_ratio.value
        );
        assert!(!measured.is_measured[(0, 0)] && measured.is_measured[(2, 2)]);
    }
}

#[test]
fn stations_are_compared_with_the_model_at_those_stations() {
    let tube = made::Tube { e_gpa: 160.0, g_gpa: 64.0, ..made::STEEL };
    let s: f64 = 0.2;
    let ei = tube.ei();
    // a force at the tip bends pipe I by a force and, in y, nothing else that moves its centreline
    // sideways
    let at_s_by_tip = s * s * (3.0 * tube.l1 - s) / (6.0 * ei) / UM;
    let at_s_by_s = s.powi(3) / (3.0 * ei) / UM;
    for (columns, slope) in [("200,", at_s_by_tip), (",200", at_s_by_tip), ("200,200", at_s_by_s)] {
        let mut text = "axis,load_n,dy_um,load_station_mm,read_station_mm\n".to_owned();
        for load in [5.0, 10.0, 20.0] {
            text += &format!("y,{load},{},{columns}\n", slope * load);
        }
        let fit = with_rod(&text, &rod(&made::STEEL), Robust::None);
        let measured = fit.measured.unwrap();
        assert_relative_eq!(fit.lines[0].slope.value / UM, slope, max_relative = 1e-9);
        assert_relative_eq!(measured.rod_ratio.value, 1.25, max_relative = 1e-9);
        // the tip's entry follows through the model
        assert_relative_eq!(measured.compliance.force[(1, 1)] / UM, tube.c22(), max_relative = 1e-9);
        assert!(fit.warnings.iter().any(|w| matches!(w, Warning::OneDirection { axis: Axis::Y })));
    }
    // 600 mm is on the rod (750 mm), 800 mm is not
    let text =
        "axis,load_n,dy_um,read_station_mm\ny,5,50,600\ny,10,100,600\ny,5,60,800\ny,10,120,800\n".to_owned();
    let error = made::try_with_rod(&text, &rod(&made::STEEL)).unwrap_err().to_string();
    assert_eq!(
        error,
        "rig.csv:4: read_station_mm is 800, expected a station on rod \"made\", 0 to 750.000 mm (the tip)"
    );
}

/// Loads along all axes, every channel read; entries in µm/N, `[channel][load]`.
fn all_channels(entries: [[f64; 3]; 3], noise: [f64; 3], seed: u64) -> String {
    let mut random = made::random(seed);
    let mut text = "axis,load_n,dx_um,dy_um,dz_um\n".to_owned();
    for (n, axis) in ["x", "y", "z"].iter().enumerate() {
        for load in [5.0, 10.0, 15.0, 20.0].repeat(4) {
            let cells =
                [0, 1, 2].map(|m| (entries[m][n] * load + noise[n] * made::normal(&mut random)).to_string());
            text += &format!("{axis},{load},{}\n", cells.join(","));
        }
    }
    text
}

#[test]
fn cross_channels_are_two_measurements_of_one_number() {
    let steel = &made::STEEL;
    let (c11, c13) = (steel.c11(), steel.c13());
    // dz under load x says 1.3 times the model, dx under load z 1.1 times, with a quarter of the
    // weight
    let entries =
        [[1.2 * c11, 0.0, 1.1 * c13], [0.0, 1.2 * steel.c22(), 0.0], [1.3 * c13, 0.0, 1.2 * steel.c33()]];
    let fit = with_rod(&all_channels(entries, [0.5, 0.5, 1.0], 3), &rod(steel), Robust::None);
    let measured = fit.measured.unwrap();
    let names: Vec<String> = measured.ratios.iter().map(|r| r.name()).collect();
    assert_eq!(names, ["11", "31", "22", "13", "33"]);
    let of_name = |name: &str| measured.ratios.iter().find(|r| r.name() == name).unwrap().value;
    assert!(
        distance(of_name("31"), 1.3) < 3.0
            && distance(of_name("13"), 1.1) < 3.0
            && distance(of_name("11"), 1.2) < 3.0
    );
    let weight = |name: &str| of_name(name).std_error.unwrap().powi(-2);
    let pooled = (weight("13") * of_name("13").value + weight("31") * of_name("31").value)
        / (weight("13") + weight("31"));
    assert!(weight("31") > 2.0 * weight("13"));
    let cf = measured.compliance.force;
    assert_relative_eq!(cf[(0, 2)], pooled * measured.model.force[(0, 2)], max_relative = 1e-12);
    assert_relative_eq!(cf, cf.transpose(), max_relative = 1e-14);
    // what the rod's symmetry makes zero stays zero, and its noise is no cross talk
    let zero = measured.model.force.amax() * 1e-12;
    assert!([cf[(0, 1)], cf[(1, 2)]].iter().all(|c| c.abs() < zero));
    assert!(!measured.is_measured[(0, 1)] && measured.is_measured[(0, 2)] && measured.is_measured[(2, 0)]);
    assert!(fit.warnings.iter().all(|w| !matches!(w, Warning::CrossTalk { .. })), "{:?}", fit.warnings);
    // the load offset of a slope that may be zero is anything
    assert_eq!(fit.lines.iter().find(|l| l.key.label() == "dx under load y").unwrap().load_offset, None);
}

#[test]
fn a_slope_that_symmetry_forbids_is_cross_talk_and_no_compliance() {
    let steel = &made::STEEL;
    let entries =
        [[steel.c11(), 0.0, steel.c13()], [2.0, steel.c22(), 0.0], [steel.c13(), -3.0, steel.c33()]];
    let fit = with_rod(&all_channels(entries, [0.5; 3], 4), &rod(steel), Robust::None);
    let lines: Vec<&String> = fit
        .warnings
        .iter()
        .filter_map(|w| if let Warning::CrossTalk { line, .. } = w { Some(line) } else { None })
        .collect();
    assert_eq!(lines, ["dy under load x", "dz under load y"]);
    let measured = fit.measured.unwrap();
    assert!(measured.compliance.force[(1, 0)].abs() < 1e-12 * measured.model.force.amax());
    assert!(measured.compliance.force[(2, 1)].abs() < 1e-12 * measured.model.force.amax());
}

#[test]
fn symmetry_is_judged_where_the_rod_was_loaded_and_read() {
    // a force along z on pipe I bends nothing: dx there is cross talk although C13 of the tip is
    // not zero
    let mut text = "axis,load_n,dx_um,dy_um,load_station_mm,read_station_mm\n".to_owned();
    for load in [5.0, 10.0, 15.0, 20.0] {
        text += &format!("y,{load},,{},,\nz,{load},{},,200,200\n", made::STEEL.c22() * load, 1.5 * load);
    }
    let fit = with_rod(&text, &rod(&made::STEEL), Robust::None);
    let is_cross =
        |w: &Warning| matches!(w, Warning::CrossTalk { line, .. } if line.starts_with("dx under load z"));
    assert!(fit.warnings.iter().any(is_cross), "{:?}", fit.warnings);
}

#[test]
fn r_rod_of_x_and_y_rests_on_y_and_says_so() {
    let (steel, rig) = (&made::STEEL, Rig { noise: 0.0, resolution: 0.0, ..Rig::default() });
    let softer = made::Tube { e_gpa: 100.0, g_gpa: 40.0, ..made::STEEL };
    let fit = with_rod(&readings(&rig, &[softer.truth("x"), steel.truth("y")], 1), &rod(steel), Robust::None);
    assert_relative_eq!(fit.measured.unwrap().rod_ratio.value, 1.0, max_relative = 1e-9);
    assert!(fit.warnings.iter().any(|w| matches!(w, Warning::OneDirection { axis: Axis::Y })));
    assert!(fit.warnings.iter().any(|w| matches!(w, Warning::UnequalRatios { .. })), "{:?}", fit.warnings);
}

#[test]
fn huber_and_tukey_resist_gross_outliers_that_ruin_least_squares() {
    let rig = Rig { trials: 5, ..Rig::default() };
    let truth = Truth { axis: "y", slope: 20.0, offset: 0.0 };
    let text = readings(&rig, &[truth], 11);
    // the second and the last reading, 200 µm off
    let mut rows: Vec<String> = text.lines().map(str::to_owned).collect();
    let last = rows.len() - 1;
    for (row, shift) in [(2, -200.0), (last, 200.0)] {
        let mut cells: Vec<String> = rows[row].split(',').map(str::to_owned).collect();
        cells[5] = (cells[5].parse::<f64>().unwrap() + shift).to_string();
        rows[row] = cells.join(",");
    }
    let text = rows.join("\n");
    let slope = |robust| {
        let options = Options::default().with_robust(robust);
        made::fit_with(&text, None, &options).lines.remove(0)
    };
    assert!((slope(Robust::None).slope.value / UM - 20.0).abs() > 0.8);
    for (robust, tolerance) in [(HUBER, 0.45), (TUKEY, 0.45)] {
        let line = slope(robust);
        assert!((line.slope.value / UM - 20.0).abs() < tolerance, "{robust:?} {:?}", line.slope);
        assert_eq!(line.downweighted, [3, last + 1], "{robust:?}");
    }
    // what Tukey sets aside leaves the standard error as if it had not been read
    let clean = made::fit(&readings(&rig, &[truth], 11)).lines.remove(0).slope.std_error.unwrap();
    let error = slope(TUKEY).slope.std_error.unwrap();
    assert!(error < 1.5 * clean && error > clean / 1.5, "{error} {clean}");
}

#[test]
fn two_loads_without_repeats_have_no_standard_error_and_a_warning() {
    for robust in [Robust::None, HUBER, TUKEY] {
        let options = Options::default().with_robust(robust);
        let fit = made::fit_with("axis,load_n,dz_um\nz,5,50\nz,10,101\n", None, &options);
        assert_eq!(fit.lines[0].slope.std_error, None);
        assert_eq!(fit.lines[0].slope.half_width_95(), None);
        assert!(matches!(fit.warnings[..], [Warning::Untested { .. }]), "{:?}", fit.warnings);
    }
    // repeats give a standard error, but still nothing about straightness
    let fit = fit("axis,load_n,dz_um\nz,5,50\nz,10,101\nz,5,51\nz,10,102\n");
    assert_relative_eq!(fit.lines[0].slope.std_error.unwrap() / UM, 0.02f64.sqrt(), max_relative = 1e-9);
    assert_eq!((fit.lines[0].lack_of_fit, fit.lines[0].slope.dof), (None, 2));
    assert_eq!(fit.warnings.len(), 0, "{:?}", fit.warnings);
}

#[test]
fn rows_without_load_are_zeros_by_definition_unless_there_is_nothing_else() {
    // friction keeps the zero row off the line of the others
    let fit = fit("axis,load_n,dz_um\nz,0,0\nz,5,40\nz,10,90\nz,15,140\n");
    assert_relative_eq!(fit.lines[0].slope.value / UM, 10.0, max_relative = 1e-12);
    assert_relative_eq!(fit.lines[0].load_offset.unwrap().value, 1.0, max_relative = 1e-9);
    assert_eq!(fit.lines[0].count, 3);
    let fit = made::fit("axis,load_n,dz_um\nz,0,0\nz,5,40\n");
    assert_relative_eq!(fit.lines[0].slope.value / UM, 8.0, max_relative = 1e-12);
}

#[test]
fn loads_beyond_the_rods_linear_range_are_warned_about() {
    let text =
        made::rod_text(&made::STEEL).replace("name = \"made\"", "name = \"made\"\nlinear_range_n = 15.0");
    let rod = rodcal::rod::Rod::from_toml("made.toml", &text).unwrap();
    for (largest, is_beyond) in [(15.0, false), (20.0, true)] {
        let text = format!("axis,load_n,dy_um\ny,5,50\ny,10,100\ny,{largest},{}\n", 10.0 * largest);
        let fit = with_rod(&text, &rod, Robust::None);
        let has = fit.warnings.iter().any(|w| matches!(w, Warning::BeyondLinearRange { .. }));
        assert_eq!(has, is_beyond);
    }
}

#[test]
fn offsets_against_the_load_are_refused_unless_they_are_noise() {
    let steel = rod(&made::STEEL);
    let refused = |text: &str| made::try_with_rod(text, &steel).unwrap_err();
    let error = refused("axis,load_n,dz_um\nz,5,-50\nz,10,-101\nz,15,-149\n");
    assert_eq!(
        error.to_string(),
        "rig.csv:2: dz_um falls as the load along z grows: the rod would move against its load, \
         expected offsets in the direction of the load, both in the tool frame"
    );
    assert_eq!(
        error.hint().unwrap(),
        "turn the sign of dz_um, or write the axis of these loads the other way round (-z)"
    );
    // two points are all there is to go by
    refused("axis,load_n,dz_um\nz,5,-50\nz,10,-101\n");
    // along −z the same offsets are right
    made::try_with_rod("axis,load_n,dz_um\n-z,5,-50\n-z,10,-101\n-z,15,-149\n", &steel).unwrap();
    // stiff enough to move less than the sensor's noise
    let noise = "axis,load_n,dy_um,dz_um\ny,5,50,\ny,10,100,\nz,5,,1\nz,10,,-1\nz,15,,2\nz,20,,-2\n";
    let fit = with_rod(noise, &steel, Robust::None);
    assert!(fit.warnings.iter().any(|w| matches!(w, Warning::AgainstTheLoad { .. })), "{:?}", fit.warnings);
}

#[test]
fn without_a_channel_along_a_load_there_is_no_r_rod() {
    let error =
        made::try_with_rod("axis,load_n,dx_um\nz,5,-50\nz,10,-101\n", &rod(&made::STEEL)).unwrap_err();
    assert_eq!(
        error.to_string(),
        "rig.csv: no offset along a load was read, \
         expected for example dy_um under loads along y, or dz_um under loads along z"
    );
}

#[test]
fn r_rod_has_the_spread_that_its_standard_error_says() {
    let steel = rod(&made::STEEL);
    let rig = Rig { noise: 3.0, resolution: 0.0, ..Rig::default() };
    let truths = [made::STEEL.truth("y"), made::STEEL.truth("z")];
    let model = made::STEEL.c22() + made::STEEL.c33();
    let mut found = Vec::new();
    for seed in 0..400 {
        let fit = with_rod(&readings(&rig, &truths, seed), &steel, Robust::None);
        let r = fit.measured.unwrap().rod_ratio;
        // Eq 21 propagated: √(s22² + s33²)/(c'22 + c'33)
        let squares: f64 = fit.lines.iter().map(|l| (l.slope.std_error.unwrap() / UM).powi(2)).sum();
        assert_relative_eq!(r.std_error.unwrap(), squares.sqrt() / model, max_relative = 1e-9);
        found.push(r.value);
    }
    // slope of n readings per load: σ/√(n Σ(F − F̄)²), two lines
    let expected = (2.0 * 3.0f64.powi(2) / (rig.trials as f64 * rig.spread())).sqrt() / model;
    let spread = rodcal::statistics::standard_deviation(&found).unwrap();
    // 400 draws know a standard deviation to 3.5 %
    assert_relative_eq!(spread, expected, max_relative = 0.11);
    let mean = rodcal::statistics::mean(&found).unwrap();
    assert!((mean - 1.0).abs() < 3.0 * expected / 20.0, "{mean}");
}

#[test]
fn physics_left_out_of_the_model_goes_into_r() {
    // shear left out of the reference: its readings without shear are stiffer than the full model
    let rig = Rig { noise: 0.0, resolution: 0.0, ..Rig::default() };
    let text = readings(&rig, &[made::STEEL.truth("y"), made::STEEL.truth("z")], 1);
    let r = |physics| {
        let options = Options::default().with_physics(physics);
        made::fit_with(&text, Some(&rod(&made::STEEL)), &options).measured.unwrap().rod_ratio.value
    };
    assert_relative_eq!(r(made::EULER_BERNOULLI), 1.0, max_relative = 1e-9);
    let full = r(Physics::default());
    assert!(full < 0.9999 && full > 0.98, "{full}");
}

#[test]
fn one_load_each_way_is_no_line() {
    let readings =
        rodcal::rig::readings::Readings::from_text("rig.csv", "axis,load_n,dz_um\nz,5,200\n-z,5,-200\n")
            .unwrap();
    let error = rodcal::rig::fit(&readings, None, &Options::default()).unwrap_err();
    assert!(error.to_string().starts_with("rig.csv: no line has two different loads"), "{error}");
}
