//! A rod that is mounted anew in each session.

use super::*;
use crate::statistics::Random;

/// Two trials along y and z in each session, whose root gives way by so much in bending,
/// rad/(N·m); noise 1 µm.
fn mounted(roots: &[f64], seed: u64) -> RigDiagnosis {
    let mut random = Random::seeded(seed, 0);
    let mut text = "session,trial,axis,load_n,dy_um,dz_um\n".to_owned();
    for (session, root) in (1..).zip(roots) {
        let urad = root / 1e-6;
        let joint = format!(
            "\n[[joint]]\nname = \"flange\"\nstation_mm = 0.0\nbending_urad_per_nm = {urad}\n\
             torsion_urad_per_nm = 0.0\n"
        );
        let c = compliance(&rod(&joint));
        for (trial, axis) in (1..=2).flat_map(|trial| [Axis::Y, Axis::Z].map(|axis| (trial, axis))) {
            for load in [4.0, 8.0, 12.0, 16.0, 20.0] {
                let [y, z] = [1, 2].map(|k| c[(k, axis.index())] * load / UM + random.normal());
                text += &format!("{session},{trial},{axis},{load},{y:.1},{z:.1}\n");
            }
        }
    }
    diagnose(&readings(&text), Some(&rod(""))).unwrap()
}

/// What screws and flange do otherwise each time changes the deflection by half a percent, and is
/// none of the rod's.
#[test]
fn a_root_of_its_own_in_each_session_is_no_mismatch() {
    let whole = compliance(&rod(""))[(2, 2)];
    let softer = rod("\n[[joint]]\nname = \"flange\"\nstation_mm = 0.0\nbending_urad_per_nm = 1.0\n");
    let per_radian = (compliance(&softer)[(2, 2)] - whole) / 1e-6;
    let usual = 0.005 * whole / per_radian;
    for seed in 1..5 {
        let mut random = Random::seeded(seed, 1);
        let roots: Vec<f64> = (0..4).map(|_| usual * (2.0 + random.normal()).max(0.0)).collect();
        let found = mounted(&roots, seed);
        assert!(!found.diagnosis.is_mismatch(), "{seed}: {:?}", found.diagnosis.discrepancy);
    }
    // one that is ten times as far off as the others are is loose
    let found = mounted(&[usual, 1.5 * usual, 11.0 * usual, 0.5 * usual], 5);
    let [loose] = &found.diagnosis.findings[..] else { panic!("{:?}", found.diagnosis.findings) };
    assert_eq!(
        (loose.effect.name, loose.location.to_string()),
        ("root_compliance", "root, session 3".into())
    );
    let more = loose.quantity("bending_urad_per_nm").unwrap();
    let more = more.map(|urad| urad * 1e-6 / usual);
    assert!(more.low < 10.0 && 10.0 < more.high, "{more:?}");
}
