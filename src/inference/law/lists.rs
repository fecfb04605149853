//! Forms that have a meaning at a kind of place, or over a kind of variable.

use super::form::Form;

impl Form {
    /// All of them.
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
        Form::Decay,
        Form::Settling,
        Form::Logarithm,
        Form::Harmonic,
        Form::CHIRP,
        Form::SWELL,
        Form::Oscillation,
        Form::Pull,
        Form::PullBelow,
        Form::PullAbove,
        Form::Polynomial(1),
        Form::Polynomial(2),
        Form::Polynomial(3),
    ];

    /// Of a load or what grows with it, from zero on.
    pub const FROM_ZERO: &[Form] = &[
        Form::Power,
        Form::PowerAfterGap,
        Form::Saturation,
        Form::Rounded,
        Form::Threshold,
        Form::CONTACT,
        Form::ROUGH,
        Form::Step,
        Form::Approach,
        Form::Decay,
        Form::Settling,
        Form::Logarithm,
        Form::Harmonic,
        Form::CHIRP,
        Form::SWELL,
        Form::Pull,
        Form::Polynomial(1),
        Form::Polynomial(2),
        Form::Polynomial(3),
    ];

    /// What gives way from zero on.
    pub const GIVING_WAY: &[Form] = &[
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
    ];

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
