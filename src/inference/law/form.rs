//! Forms of a law: functions of a scaled variable, with one number at most that is not linear, or
//! two: where it begins, and its exponent or width there; a period, and how the wave changes.

use std::f64::consts::TAU;

/// What a law looks like over its variable. ξ = x/X; functions of a variable with two signs are
/// odd.
#[derive(Debug, Clone, Copy, PartialEq)]
#[non_exhaustive]
pub enum Form {
    /// a·ξᵖ.
    Power,
    /// a·ξᵖ + g where ξ > 0: a contact with a gap before it.
    PowerAfterGap,
    /// a·min(ξ/ξ₀, 1): it grows up to ξ₀ and no further.
    Saturation,
    /// a·tanh(ξ/ξ₀): it grows up to a level, bending little by little.
    Rounded,
    /// a·max(ξ − ξ₀, 0): it grows from ξ₀ on.
    Threshold,
    /// a·(max(ξ − ξ₀, 0)/(1 − ξ₀))ᵖ of this p: a contact that begins at ξ₀.
    PowerBeyond(f64),
    /// k·v·(ln(1 + e^((ξ − ξ₀)/v)) − ln(1 + e^(−ξ₀/v))) of this v: a threshold that bends little by
    /// little, as rough surfaces do that meet (J. A. Greenwood, J. B. P. Williamson 1966).
    Rough(f64),
    /// a where ξ > ξ₀.
    Step,
    /// a·(1 − e^(−ξ/ξ₀)).
    Approach,
    /// a·e^(−ξ/ξ₀).
    Decay,
    /// a·e^(−ξ/ξ₀) + b: of what has a sign of its own, so that b is no zero.
    Settling,
    /// a·ln(1 + ξ/ξ₀).
    Logarithm,
    /// a·(cos(2πf·ξ) − 1) + b·sin(2πf·ξ): readings are offsets from what was read at zero.
    Harmonic,
    /// a·(cos φ − 1) + b·sin φ, φ = 2πf·ξ·(1 + q·(ξ − 1)) of this q: a wave whose frequency goes
    /// evenly from f·(1 − q) at zero to f·(1 + q) at X.
    Chirp(f64),
    /// a·((1 + g·|ξ|)·cos(2πf·ξ) − 1) + b·(1 + g·|ξ|)·sin(2πf·ξ) of this g: a wave that grows.
    Swell(f64),
    /// a·cos(2πf·ξ) + b·sin(2πf·ξ) + c: of time, for nobody knows when the zero was taken.
    Oscillation,
    /// k·(1/(ξ₀ − ξ)² − 1/ξ₀²): a pull, from zero on, by what is at ξ₀ beyond all data.
    Pull,
    /// k/(ξ − ξ₀)²: the same of a place, ξ₀ below all data.
    PullBelow,
    /// The same, ξ₀ above all data.
    PullAbove,
    /// a₁·ξ + … of this degree, 1 to 3.
    Polynomial(u8),
}

/// The number of a form that is not linear, in the form's own scale.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum FormConstant {
    /// p.
    Exponent,
    /// ξ₀ of a saturation, a threshold, a power beyond one or a step: a value of the variable.
    Corner,
    /// ξ₀ of an approach, a decay or a logarithm: a length along the variable.
    Scale,
    /// ξ₀ of a pull: a value of the variable beyond the data.
    Pole,
    /// Period of a wave, 1/f, of the variable; the mean one from zero to X where it changes.
    Period,
    /// Half the width of a play, of the variable.
    Play,
    /// Where a loop yields, of the variable.
    Yield,
    /// Time of a lag, s.
    Lag,
}

/// Least square of a distance, as a share of X².
const NEAREST: f64 = 1e-6;
impl Form {
    /// A power beyond a threshold, of the exponent of a Hertzian contact over its approach.
    pub const CONTACT: Form = Form::PowerBeyond(1.5);

    /// A rounded threshold of some width.
    pub const ROUGH: Form = Form::Rough(0.1);

    /// A wave whose frequency changes by something.
    pub const CHIRP: Form = Form::Chirp(0.1);

    /// A wave whose amplitude changes by something.
    pub const SWELL: Form = Form::Swell(1.0);

    /// For people and JSON.
    pub fn name(self) -> &'static str {
        match self {
            Form::Power => "power",
            Form::PowerAfterGap => "power after a gap",
            Form::Saturation => "saturation",
            Form::Rounded => "rounded saturation",
            Form::Threshold => "threshold with slope",
            Form::PowerBeyond(_) => "power beyond a threshold",
            Form::Rough(_) => "rounded threshold with slope",
            Form::Step => "step",
            Form::Approach => "exponential approach",
            Form::Decay => "exponential decay",
            Form::Settling => "exponential decay to a level",
            Form::Logarithm => "logarithm",
            Form::Harmonic | Form::Oscillation => "harmonic",
            Form::Chirp(_) => "harmonic of a changing period",
            Form::Swell(_) => "harmonic of a changing amplitude",
            Form::Pull | Form::PullBelow | Form::PullAbove => "inverse square of a distance",
            Form::Polynomial(1) => "straight line",
            Form::Polynomial(2) => "polynomial of the second degree",
            Form::Polynomial(_) => "polynomial of the third degree",
        }
    }

    /// True for the same, whatever its exponent or width.
    pub fn is(self, other: Form) -> bool {
        match (self, other) {
            (Form::PowerBeyond(_), Form::PowerBeyond(_))
            | (Form::Rough(_), Form::Rough(_))
            | (Form::Chirp(_), Form::Chirp(_))
            | (Form::Swell(_), Form::Swell(_)) => true,
            _ => self == other,
        }
    }

    /// True where one of two forms is the other for some of its numbers: what both are known by is
    /// one number then, as the exponent of a power is with a gap before it and without.
    pub fn is_kin(self, other: Form) -> bool {
        let holds = |wider: Form, form: Form| match (wider, form) {
            (Form::PowerAfterGap | Form::PowerBeyond(_), Form::Power)
            | (Form::PowerBeyond(_) | Form::Rough(_), Form::Threshold)
            | (Form::Settling, Form::Decay) => true,
            (wider, Form::Harmonic) => wider.is_wave(),
            (wider, form) => wider.is(form),
        };
        holds(self, other) || holds(other, self)
    }

    /// True for one that has neither a corner nor waves: two of them are no two laws.
    pub fn is_gradual(self) -> bool {
        let has_corner =
            matches!(self, Form::Saturation | Form::Threshold | Form::PowerBeyond(_) | Form::Step);
        !has_corner && !self.is_wave()
    }

    /// True for one with a period.
    pub fn is_wave(self) -> bool {
        matches!(self, Form::Harmonic | Form::Chirp(_) | Form::Swell(_) | Form::Oscillation)
    }

    /// How many times as large as at zero a wave is at ξ.
    fn swell(self, xi: f64) -> f64 {
        if let Form::Swell(g) = self { 1.0 + g * xi.abs() } else { 1.0 }
    }

    /// How many functions it has.
    pub fn count(self) -> usize {
        match self {
            Form::PowerAfterGap | Form::Harmonic | Form::Chirp(_) | Form::Swell(_) | Form::Settling => 2,
            Form::Oscillation => 3,
            Form::Polynomial(degree) => degree as usize,
            _ => 1,
        }
    }

    /// Its number that is not linear.
    pub fn constant(self) -> Option<FormConstant> {
        match self {
            Form::Power | Form::PowerAfterGap => Some(FormConstant::Exponent),
            Form::Saturation | Form::Threshold | Form::PowerBeyond(_) | Form::Rough(_) | Form::Step => {
                Some(FormConstant::Corner)
            }
            Form::Approach | Form::Decay | Form::Settling | Form::Logarithm | Form::Rounded => {
                Some(FormConstant::Scale)
            }
            Form::Pull | Form::PullBelow | Form::PullAbove => Some(FormConstant::Pole),
            Form::Harmonic | Form::Chirp(_) | Form::Swell(_) | Form::Oscillation => {
                Some(FormConstant::Period)
            }
            Form::Polynomial(_) => None,
        }
    }

    /// Its functions at ξ, those that there are.
    pub fn functions(self, xi: f64, s: f64) -> [f64; 3] {
        let odd = |half: &dyn Fn(f64) -> f64| if xi < 0.0 { -half(-xi) } else { half(xi) };
        let one = |value: f64| [value, 0.0, 0.0];
        match self {
            Form::Power => one(odd(&|xi| if xi == 0.0 { 0.0 } else { xi.powf(s) })),
            Form::PowerAfterGap if xi == 0.0 => [0.0; 3],
            Form::PowerAfterGap => [odd(&|xi| xi.powf(s)), odd(&|_| 1.0), 0.0],
            Form::Saturation => one(odd(&|xi| (xi / s).min(1.0))),
            Form::Rounded => one((xi / s).tanh()),
            Form::Threshold => one((xi - s).max(0.0)),
            Form::Rough(v) => one(v * (soft((xi - s) / v) - soft(-s / v))),
            Form::PowerBeyond(p) => one(((xi - s).max(0.0) / (1.0 - s)).powf(p)),
            Form::Step => one(if xi > s { 1.0 } else { 0.0 }),
            Form::Approach => one(odd(&|xi| -(-xi / s).exp_m1())),
            Form::Decay => one(odd(&|xi| (-xi / s).exp())),
            Form::Settling => [odd(&|xi| (-xi / s).exp()), odd(&|_| 1.0), 0.0],
            Form::Logarithm => one(odd(&|xi| (xi / s).ln_1p())),
            Form::Harmonic | Form::Chirp(_) | Form::Swell(_) => {
                let faster = if let Form::Chirp(q) = self { 1.0 + q * (xi - 1.0) } else { 1.0 };
                let (sin, cos) = (TAU * s * xi * faster).sin_cos();
                let size = self.swell(xi);
                [size * cos - 1.0, size * sin, 0.0]
            }
            Form::Oscillation => {
                let (sin, cos) = (TAU * s * xi).sin_cos();
                [cos, sin, 1.0]
            }
            Form::Pull => one(odd(&|xi| inverse_square(s - xi) - inverse_square(s))),
            Form::PullBelow | Form::PullAbove => one(inverse_square(xi - s)),
            Form::Polynomial(_) => [xi, xi * xi, xi * xi * xi],
        }
    }

    /// The coordinate in which the prior of s is even, and back: a logarithm where s is a scale.
    pub fn coordinate(self, s: f64) -> f64 {
        if self.is_log() { s.ln() } else { s }
    }

    /// See [`Form::coordinate`].
    pub fn at_coordinate(self, u: f64) -> f64 {
        if self.is_log() { u.exp() } else { u }
    }

    fn is_log(self) -> bool {
        match self {
            Form::Power
            | Form::PowerAfterGap
            | Form::Approach
            | Form::Decay
            | Form::Settling
            | Form::Logarithm
            | Form::Rounded
            | Form::Harmonic
            | Form::Chirp(_)
            | Form::Swell(_)
            | Form::Oscillation => true,
            Form::Saturation
            | Form::Threshold
            | Form::PowerBeyond(_)
            | Form::Rough(_)
            | Form::Step
            | Form::Pull
            | Form::PullBelow
            | Form::PullAbove
            | Form::Polynomial(_) => false,
        }
    }
}

/// ln(1 + e^x).
fn soft(x: f64) -> f64 {
    x.max(0.0) + (-x.abs()).exp().ln_1p()
}

/// 1/d², of no distance that is nothing.
fn inverse_square(distance: f64) -> f64 {
    distance.powi(2).max(NEAREST).recip()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_form_is_what_its_formula_says() {
        let at = |form: Form, xi: f64, s: f64| form.functions(xi, s)[0];
        assert_eq!(at(Form::Power, 0.25, 0.5), 0.5);
        assert_eq!(at(Form::Power, -0.25, 0.5), -0.5);
        assert_eq!(at(Form::Power, 0.0, 0.5), 0.0);
        assert_eq!(Form::PowerAfterGap.functions(-0.25, 0.5), [-0.5, -1.0, 0.0]);
        assert_eq!(Form::PowerAfterGap.functions(0.0, 0.5), [0.0; 3]);
        assert_eq!((at(Form::Saturation, 0.2, 0.4), at(Form::Saturation, 0.9, 0.4)), (0.5, 1.0));
        assert_eq!((at(Form::Threshold, 0.2, 0.5), at(Form::Threshold, 0.75, 0.5)), (0.0, 0.25));
        assert_eq!((at(Form::Step, 0.5, 0.5), at(Form::Step, 0.6, 0.5)), (0.0, 1.0));
        let rough = |xi: f64| at(Form::Rough(0.1), xi, 0.5);
        assert!(
            rough(0.0) == 0.0 && (rough(0.5) - 0.1 * (2.0f64.ln() - (-5.0f64).exp().ln_1p())).abs() < 1e-15
        );
        assert!((rough(90.0) - rough(89.0) - 1.0).abs() < 1e-12);
        let beyond = |xi: f64| at(Form::PowerBeyond(1.5), xi, 0.2);
        assert!(beyond(0.2) == 0.0 && (beyond(0.4) - 0.125).abs() < 1e-15 && beyond(1.0) == 1.0);
        assert!((at(Form::Approach, 1.0, 1.0) - (1.0 - (-1.0f64).exp())).abs() < 1e-15);
        assert!((at(Form::Logarithm, 1.0, 0.5) - 3.0f64.ln()).abs() < 1e-15);
        assert!((at(Form::Decay, 1.0, 0.5) - (-2.0f64).exp()).abs() < 1e-15);
        assert_eq!(Form::Settling.functions(0.0, 0.5), [1.0, 1.0, 0.0]);
        assert_eq!(Form::Settling.functions(-0.5, 0.5), [-(-1.0f64).exp(), -1.0, 0.0]);
        assert_eq!(Form::Pull.functions(1.0, 2.0)[0], 1.0 - 0.25);
        assert_eq!((at(Form::PullBelow, 1.0, -1.0), at(Form::PullAbove, 1.0, 1.5)), (0.25, 4.0));
        assert_eq!(at(Form::Rounded, -0.5, 0.5), -(1.0f64).tanh());
        // a quarter of a period on, the cosine is gone and the sine whole
        let [cos, sin, _] = Form::Harmonic.functions(0.25, 1.0);
        assert!((cos + 1.0).abs() < 1e-15 && (sin - 1.0).abs() < 1e-15);
        // four waves of 1 per ξ at zero are five at X: f = 4.5, q = 1/9
        let chirp = |xi: f64| Form::Chirp(1.0 / 9.0).functions(xi, 4.5);
        let turns = |xi: f64| TAU * (4.0 * xi + 0.5 * xi * xi);
        assert!((chirp(0.7)[0] - (turns(0.7).cos() - 1.0)).abs() < 1e-12 && chirp(0.0) == [0.0; 3]);
        assert!((chirp(1.3)[1] - turns(1.3).sin()).abs() < 1e-12);
        // half of a period on, the wave has grown by half
        let [cos, sin, _] = Form::Swell(1.0).functions(0.5, 1.0);
        assert!((cos + 2.5).abs() < 1e-15 && sin.abs() < 1e-15);
        assert_eq!(Form::Polynomial(3).functions(2.0, 0.0), [2.0, 4.0, 8.0]);
    }

    #[test]
    fn a_form_is_kin_of_what_it_holds() {
        assert!(Form::Power.is_kin(Form::CONTACT) && Form::PowerAfterGap.is_kin(Form::Power));
        assert!(Form::CHIRP.is_kin(Form::Harmonic) && Form::Rough(0.1).is_kin(Form::Rough(0.2)));
        // what both call a scale is not one number
        assert!(!Form::Approach.is_kin(Form::Logarithm) && !Form::Power.is_kin(Form::Logarithm));
    }

    #[test]
    fn corners_and_waves_are_laws_beside_others() {
        let gradual = Form::ALL.into_iter().filter(|form| form.is_gradual()).count();
        assert_eq!(gradual, Form::ALL.len() - 8);
        assert!(Form::Power.is_gradual() && !Form::Threshold.is_gradual() && !Form::Harmonic.is_gradual());
    }
}
