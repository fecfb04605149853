//! Files of all kinds: what they lack, and what is odd about them.

use nalgebra::DVector;

use super::*;
use crate::diagnosis::rig::diagnose::MOST_ROWS;
use crate::units::UM;

#[test]
fn too_many_rows_are_refused_with_a_reason() {
    let mut many = readings(UP_AND_DOWN);
    let row = many.rows[1].clone();
    many.rows.resize(MOST_ROWS + 1, row);
    let refusal = diagnose(&many, Some(&rod(""))).unwrap_err().to_string();
    assert!(refusal.contains("100001 rows of readings") && refusal.contains("at most 100000"), "{refusal}");
}

#[test]
fn what_was_not_recorded_is_no_candidate() {
    let text = "axis,load_n,dy_um\ny,5,230\ny,10,460\ny,15,690\n";
    let has = |model: &RigModel, effect: &str| model.candidates().iter().any(|c| c.effect.name == effect);
    let plain = model(text, &rod(""));
    for effect in ["creep", "hysteresis", "thermal_drift", "slip", "load_misalignment", "sensor_misalignment"]
    {
        assert!(!has(&plain, effect), "{effect}");
    }
    // with time but without temperature the drift is one per hour
    let timed = "axis,load_n,time_s,dy_um\ny,5,0,230\ny,10,1800,460\ny,15,3600,690\n";
    let timed = model(timed, &rod(""));
    assert_eq!(timed.candidates()[find(&timed, "thermal_drift", "dy")].parameters[0].name, "um_per_h");
    let per_hour = one(&timed, "thermal_drift", "dy", 10.0 * UM / 3600.0, Axis::Y);
    assert_all(&per_hour, &[0.0, 5.0 * UM, 10.0 * UM]);
}

#[test]
fn without_a_rod_slopes_are_fitted_with_the_effects() {
    // y = 20 µm/N · (F − 1) for loading
    let text = "axis,load_n,dz_um\n-z,5,-80\n-z,10,-180\n-z,15,-280\n-z,20,-380\nz,5,80\n";
    let (model, evidence) = RigModel::new(&readings(text), None).unwrap();
    for effect in ["stiffness_scale", "joint_compliance", "sensor_scale", "load_misalignment"] {
        assert!(model.candidates().iter().all(|c| c.effect.name != effect), "{effect}");
    }
    assert_eq!(evidence.nuisance.column(0).as_slice(), [-5.0, -10.0, -15.0, -20.0, 5.0]);
    assert_eq!(evidence.residual[0], -80.0 * UM);
    let terms = [term(&model, "friction", "slide", &[1.0])];
    // 20 µm/N · (−4 + 5) and so on
    let expected = [20.0, 20.0, 20.0, 20.0, -20.0].map(|um| um * UM);
    assert_all(&response(&model, &terms, Axis::Z), &expected);
}

#[test]
fn weird_files_are_models_too() {
    let base = rod("");
    let two = "axis,load_n,dy_um\ny,5,230\n-y,5,-230\n";
    let stations = "axis,load_n,load_station_mm,read_station_mm,dx_um,dz_um
-z,5,675,205,1,-8
-z,9,675.0005,205,,-14
-z,9,300,0,,0
x,0,,,0,0
x,9,0,,1,
";
    let huge = "axis,load_n,dz_um\nz,1e30,1e30\nz,1e-30,1e-30\nz,0,0\n";
    for text in [two, stations, huge, UP_AND_DOWN, &full(1), &full(7)] {
        for rod in [Some(&base), None] {
            let (model, evidence) = RigModel::new(&readings(text), rod).unwrap();
            let n = model.data().len();
            assert_eq!(
                (evidence.residual.len(), evidence.replicate_group.len(), evidence.fold.len()),
                (n, n, n)
            );
            assert!(evidence.covariates.iter().all(|c| c.values.len() == n));
            assert_eq!(model.response(&[]), DVector::zeros(n));
            assert_eq!(model.response(&[Term { candidate: 99999, values: vec![1.0] }]), DVector::zeros(n));
        }
    }
    let off = readings("axis,load_n,load_station_mm,dy_um\ny,5,700,1\ny,6,700,1\n");
    let error = RigModel::new(&off, Some(&base)).unwrap_err().to_string();
    assert_eq!(
        error,
        "f:2: load_station_mm is 700, expected a station on rod \"5#\", 0 to 675.000 mm (the tip)"
    );
}

#[test]
fn other_stations_have_the_compliance_of_their_place() {
    let rod = rod("");
    let text = "axis,load_n,load_station_mm,read_station_mm,dz_um\nz,5,300,,0\nz,10,300,,0\nz,10,,205,0\n";
    let model = model(text, &rod);
    let c = |load: f64, read: f64| {
        let model = RodModel::new(&rod, &Physics::default(), 1, &[load, read]).unwrap();
        model.force_response(load, read).unwrap().translation[(2, 2)]
    };
    let tip = rod.length();
    let found = one(&model, "load_offset", "hanger", 1.0, Axis::Z);
    assert_all(&found, &[c(0.3, tip), c(0.3, tip), c(tip, 0.205)]);
}
