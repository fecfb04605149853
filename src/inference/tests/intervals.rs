//! What else may be there makes an interval wider.

use super::*;

/// A line that another law, whose factor has the same name, draws as well.
fn widened(form: &str, law: impl Fn(f64) -> f64) -> ((f64, f64, f64), (f64, f64, f64)) {
    let mut model = Columns::new(COUNT);
    model.add("law", "linear", column(|x| x), false);
    let alone = diagnose(&model, &evidence(3, |x| 6.0 * x));
    model.add("law", form, column(law), false);
    model.candidates.iter_mut().for_each(|candidate| candidate.is_alternative = true);
    if form == "other names" {
        model.candidates[1].parameters[0].name = "other".into();
    }
    let of_forms = diagnose(&model, &evidence(3, |x| 6.0 * x));
    (the_line(&alone), the_line(&of_forms))
}

/// The interval of the one finding, which is the line's.
fn the_line(found: &Diagnosis) -> (f64, f64, f64) {
    let [finding] = &found.findings[..] else { panic!("{:?}", found.findings) };
    assert_eq!(finding.parts[0].term.candidate, 0);
    let own = &finding.parts[0].estimates[0];
    (own.value, own.low, own.high)
}

#[test]
fn an_interval_holds_what_another_form_of_the_law_says() {
    let half = |interval: (f64, f64, f64)| 0.5 * (interval.2 - interval.1);
    // the same line with half the factor, hardly bent
    let (alone, forms) = widened("bent", |x| 2.0 * x + 0.02 * x * x);
    assert_eq!((forms.0, forms.2), (alone.0, alone.2), "the higher end is the line's own");
    assert!(forms.1 < 0.5 * alone.0 - 0.4 * half(alone), "{forms:?} {alone:?}");
    // neither one with another parameter nor one that leaves much more says anything of this factor
    assert_eq!(widened("other names", |x| 2.0 * x + 0.02 * x * x).1, alone);
    assert_eq!(widened("square", |x| 2.0 * x * x * x).1, alone);
}

/// A form with one parameter more, that is the line where it is neutral, knows the line's factor
/// less well: the interval holds that too. One that is another line there says nothing of it.
#[test]
fn an_interval_holds_what_a_wider_form_of_the_law_says() {
    let half = |wider: Option<f64>| {
        let mut model = Columns::new(COUNT);
        model.add("law", "linear", column(|x| x), false);
        if let Some(factor) = wider {
            let columns = DMatrix::from_fn(COUNT, 2, |row, k| [factor * x(row), x(row).powi(2)][k]);
            model.add("law", "wider", columns, false);
            model.candidates[1].parameters[1].name = "more".into();
        }
        for candidate in &mut model.candidates {
            candidate.is_alternative = true;
            // no place along anything, of which neighbours count as well
            candidate.location = Location::Part(Part::Rod);
        }
        let (_, low, high) = the_line(&diagnose(&model, &evidence(3, |x| 6.0 * x)));
        0.5 * (high - low)
    };
    assert!(half(Some(1.0)) > 2.0 * half(None), "{} {}", half(Some(1.0)), half(None));
    assert_eq!(half(Some(2.0)), half(None));
}

/// A second effect that may be there as well makes the first one less sure, as much as it is
/// likely.
#[test]
fn an_interval_holds_what_else_may_be_there() {
    let half = |with: bool| {
        let mut model = Columns::new(COUNT);
        model.add("law", "", column(|x| x), false);
        if with {
            model.add("other", "", column(|x| x + 0.3 * x * x), false);
        }
        let (_, low, high) = the_line(&diagnose(&model, &evidence(3, |x| 6.0 * x)));
        0.5 * (high - low)
    };
    assert!(half(true) > 1.2 * half(false), "{} {}", half(true), half(false));
}
