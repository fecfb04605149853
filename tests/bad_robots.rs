//! Robot files that are wrong are refused with a message that names the place, what stood there and
//! what is right. No text at all makes the reader, the kinematics or the writers panic.

mod any_text;
mod tables;
mod urdfs;

use rodcal::error::Error;
use rodcal::robot::Robot;

/// Good files, in which a case replaces one piece of text.
const TABLE: &str = include_str!("bad_robots/good.toml");
const URDF: &str = include_str!("bad_robots/good.urdf");

/// The message, and the hint after an arrow.
fn in_words(error: &Error) -> String {
    match error.hint() {
        Some(hint) => format!("{error} -> {hint}"),
        None => error.to_string(),
    }
}

/// Every case: the piece of the good text, what stands there instead, and the message that it
/// gives.
fn check(good: &str, cases: &[(&str, &str, &str)]) {
    let mut wrong = Vec::new();
    for (piece, other, expected) in cases {
        assert!(good.contains(piece), "{piece} is not in the good file");
        let text = good.replacen(piece, other, 1);
        let found = match Robot::from_text("robot", &text, None, None) {
            Ok(_) => "it is read".to_owned(),
            Err(error) => in_words(&error),
        };
        if found != *expected {
            wrong.push(format!("{other}\n     found: {found}\n  expected: {expected}"));
        }
    }
    assert!(wrong.is_empty(), "{}", wrong.join("\n"));
}
