//! One number of several forms.

use super::*;

/// The interval of an exponent is that of all forms that the data do not distinguish, whose
/// exponent is the same number: of a power with a gap before it as likely as one without it
/// holds both.
#[test]
fn the_interval_of_an_exponent_is_that_of_its_kin() {
    let mut met = 0;
    for seed in 0..40 {
        let (_, found) = proposed(100 + seed, |f| 60.0 * (f / 12.0f64).powf(2.0 / 3.0));
        let Some(Ok(law)) = found.map(|found| found.law) else { continue };
        let Some((FormConstant::Exponent, own)) = &law.constant else { continue };
        let kin = law.rivals.iter().filter(|rival| rival.form.is_kin(law.form) && rival.odds < 4.0);
        for (_, other) in kin.filter_map(|rival| rival.constant.as_ref()) {
            met += 1;
            // a fifth of its probability at least: more than half of each half of its interval
            let inner = |end: f64| other.value + 0.5 * (end - other.value);
            assert!(own.low <= inner(other.low) && inner(other.high) <= own.high, "{own:?} {other:?}");
        }
    }
    assert!(met >= 3, "{met}");
}
