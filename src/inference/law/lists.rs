//! Forms that have a meaning at a kind of place, or over a kind of variable.

use super::form::Form;

impl Form {
    /// All of them, in such an order that the next lists are beginnings of it.
    pub const ALL: [Form; 22] = [
        Form::Power,
        Form::PowerAfterGap,
        Form::Saturation,
        Form::Rounded,
        Form::Threshold,
        Form::CONTACT,
        Form::ROUGH,
        Form::Step,
        Form::Approach,
        Form::Logarithm,
        Form::Polynomial(1),
        Form::Polynomial(2),
        Form::Polynomial(3),
        Form::Decay,
        Form::Settling,
        Form::Harmonic,
        Form::CHIRP,
        Form::SWELL,
        Form::Pull,
        Form::Oscillation,
        Form::PullBelow,
        Form::PullAbove,
    ];

    /// Of what comes to rest or to a stop: to the logarithm.
    pub const TO_A_STOP: &[Form] = Form::ALL.split_at(10).0;

    /// What gives way from zero on: to the polynomials.
    pub const GIVING_WAY: &[Form] = Form::ALL.split_at(13).0;

    /// Of a load or what grows with it, from zero on: to the pull.
    pub const FROM_ZERO: &[Form] = Form::ALL.split_at(19).0;

    /// From a start on: time, order.
    pub const SINCE_A_START: &[Form] = &[
        Form::Threshold,
        Form::Step,
        Form::Approach,
        Form::Decay,
        Form::Logarithm,
        Form::Harmonic,
        Form::Polynomial(1),
        Form::Polynomial(2),
        Form::Polynomial(3),
    ];

    /// From anywhere on, or with two signs.
    pub const FROM_ANYWHERE: &[Form] =
        &[Form::Threshold, Form::Step, Form::Polynomial(1), Form::Polynomial(2), Form::Polynomial(3)];

    /// Of a position: something may pull at either end.
    pub const OF_A_POSITION: &[Form] = &[
        Form::Threshold,
        Form::Step,
        Form::PullBelow,
        Form::PullAbove,
        Form::Polynomial(1),
        Form::Polynomial(2),
        Form::Polynomial(3),
    ];
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn lists_end_where_they_say() {
        let last = [Form::TO_A_STOP, Form::GIVING_WAY, Form::FROM_ZERO].map(|list| list.last());
        let expected = [Form::Logarithm, Form::Polynomial(3), Form::Pull];
        assert_eq!(last, [0, 1, 2].map(|k| Some(&expected[k])));
    }
}
