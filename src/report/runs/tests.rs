//! What stands side by side.

use super::compared::labels;
use super::picture::{MOST_SHOWN, difference_picture};
use super::*;

#[test]
fn the_most_changed_parameters_are_shown_and_what_has_no_error_is_not() {
    let change = |k: usize| Change {
        name: format!("p{k}"),
        unit: "mm".into(),
        values: [None, None],
        difference: Some(-(k as f64)),
        std_error: (k != 3).then_some(2.0),
        is_significant: None,
        precedence: Precedence::Other,
    };
    let all: Vec<Change> = (1..=20).map(change).collect();
    let figure = difference_picture(&all).expect("there are ratios");
    let names: Vec<&str> = figure.panels[0].y.names.iter().map(|(_, name)| name.as_str()).collect();
    assert_eq!((names.len(), names[0], names[15]), (MOST_SHOWN, "p20", "p5"));
    assert!(figure.svg().contains("−10") && figure.caption.contains("16 largest of 19"));
    assert!(difference_picture(&all[2..3]).is_none());
}

#[test]
fn runs_are_called_by_what_distinguishes_their_folders() {
    assert_eq!(labels(&["/tmp/x/fit", "/tmp/x/huber/"]), ["fit", "huber"]);
    assert_eq!(labels(&["a/rig", "b/rig", "/c/b/cal"]), ["a/rig", "b/rig", "b/cal"]);
    assert_eq!(labels(&["run", "./run"]), ["run", "./run"]);
}
