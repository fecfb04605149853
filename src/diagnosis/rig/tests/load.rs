//! Effects on the load, against a computation by hand.

use approx::assert_relative_eq;

use super::*;
use crate::units::DEG;

#[test]
fn effects_on_the_load_have_the_sign_and_size_of_a_hand_computation() {
    let rod = rod("");
    let model = model(UP_AND_DOWN, &rod);
    let c = compliance(&rod);
    let y = c[(1, 1)];
    // along −y the offsets are negative: less load is a positive change
    assert_all(&one(&model, "friction", "slide", 1.0, Axis::Y), &[y, y, -y, -y]);
    assert_all(&one(&model, "friction", "slide", 7.0, Axis::Y), &[5.0 * y, 7.0 * y, -7.0 * y, -7.0 * y]);
    // 20 − 9 N are felt at the turn, and 5 N below there no more
    assert_all(&one(&model, "friction", "slide", 9.0, Axis::Y), &[5.0 * y, 9.0 * y, -6.0 * y, -9.0 * y]);
    // the top read once more before it is taken off: nothing has moved
    let again = UP_AND_DOWN.replace("-y,5,unload", "-y,20,unload,0,0,0\n-y,19,unload,0,0,0\n-y,5,unload");
    let read_again = RigModel::new(&readings(&again), Some(&rod)).unwrap().0;
    let held = one(&read_again, "friction", "slide", 1.0, Axis::Y);
    assert_all(&held, &[y, y, y, 0.0, -y, -y]);
    assert_all(&one(&model, "load_offset", "hanger", 2.0, Axis::Y), &[-2.0 * y, -2.0 * y, -2.0 * y, 0.0]);
    let (sin, cos) = (2.0 * DEG).sin_cos();
    let turned = |load: f64| -load * sin * c[(2, 2)];
    let z = one(&model, "load_misalignment", "y towards z", 2.0 * DEG, Axis::Z);
    assert_all(&z, &[turned(5.0), turned(20.0), turned(5.0), 0.0]);
    let along = one(&model, "load_misalignment", "y towards z", 2.0 * DEG, Axis::Y);
    assert_relative_eq!(along[1], -20.0 * y * (cos - 1.0), max_relative = 1e-9);
}
