//! A robot that does not stand level, whose first joint then carries a load that no calibration has
//! seen.

use super::*;
use crate::units::DEG;

const NOISE: f64 = 10.0 * UM;
/// How the first joint's drive gives way, rad/(N·m): a drive of 200 N·m turns by 1.4 mrad.
const FIRST_DRIVE: f64 = 7e-6;

#[test]
fn a_base_that_is_not_level_loads_its_first_joint() {
    let campaign = clamps(30);
    let calibration = calibrate(&campaign, Mode::Fea, &Options::default()).unwrap();
    let context = Context::new(&campaign, &calibration).unwrap();
    let roll = Vector3::new(5.0, -4.0, 0.0) * DEG;
    let leaning = |row: usize| {
        let there = &context.configurations[row];
        let more = (there.base.rotation * roll).cross(&there.gravity);
        let torque = there.axis[0].dot(&there.first_moment[0].cross(&more));
        let by_weight = there.in_world(&context.weight_compliance) * more;
        by_weight + there.joint_deflection_by_weight(&more) + there.tip_jacobian[0] * (FIRST_DRIVE * torque)
    };
    let leaning = recorded(&campaign, &leaning, NOISE, 0);
    let found = diagnose_as_recorded(&leaning, Mode::Fea, &Options::default()).unwrap().diagnosis;
    let names: Vec<&str> = found.findings.iter().map(|finding| finding.effect.name).collect();
    assert_eq!(names, ["gravity_direction"]);
    assert!(found.discrepancy.is_none(), "{:?}", found.discrepancy);
    // roll and pitch, and no product of them with a compliance
    let estimates = &found.findings[0].estimates;
    assert_eq!(estimates.len(), 2);
    for (estimate, truth) in estimates.iter().zip([roll.x, roll.y]) {
        assert!(estimate.low < truth && truth < estimate.high, "{estimate:?} of {truth}");
    }
}
