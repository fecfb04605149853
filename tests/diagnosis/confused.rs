//! What a recording cannot tell apart is said to be so, with a measurement that would tell.

use rodcal::units::UM;
use rodcal_trial::rig::{Effect, Order};

use super::Answer;

#[test]
fn without_unloading_friction_is_a_load_offset_as_well() {
    let order = Order { unloading: false, ..Order::default() };
    let friction = Effect::Friction { axis: None, force: 1.0, presliding: 0.1 * UM, scatter: 0.0 };
    let tare = Effect::LoadOffset { axis: None, force: -1.0 };
    for effect in [friction, tare] {
        let answer = Answer::made(&order, &[effect], 5);
        let class = answer.class(0);
        assert!(class.contains(&"friction") && class.contains(&"load_offset"), "{class:?}");
        let next = answer.findings()[0]["next_measurement"].as_str().unwrap();
        assert!(next.contains("unloading"), "{next}");
    }
}

#[test]
fn at_the_tip_along_one_axis_all_softness_is_alike() {
    let order = Order { axes: vec![1], all_channels: false, ..Order::default() };
    let rotation = order.rotation()[0];
    let effects = [
        Effect::StiffnessScale(0.85),
        Effect::SensorScale { channel: 1, factor: 1.1 },
        Effect::Root { bending: 0.2 * rotation, torsion: 0.0 },
    ];
    for effect in effects {
        let name = effect.name();
        let answer = Answer::made(&order, &[effect], 6);
        assert_eq!(answer.findings().len(), 1, "{name}: {}", answer.json["headline"]);
        let class = answer.class(0);
        for alike in ["stiffness_scale", "shear_modulus", "sensor_scale", "root_compliance"] {
            assert!(class.contains(&alike), "{name}: {alike} is not in {class:?}");
        }
    }
}
