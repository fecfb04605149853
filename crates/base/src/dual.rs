//! Numbers with one derivative: a + b ε with ε² = 0. Formulas that are generic in [`Number`]
//! differentiate themselves.

use std::iter::Sum;
use std::ops::{Add, AddAssign, Div, DivAssign, Mul, MulAssign, Neg, Sub, SubAssign};

use nalgebra::{Matrix3, Rotation3, Scalar};
use num_traits::{One, Zero};

/// What a formula needs of its numbers. Comparisons are those of [`Number::value`].
pub trait Number:
    Scalar
    + Copy
    + From<f64>
    + Zero
    + One
    + Sum
    + Neg<Output = Self>
    + Sub<Output = Self>
    + Div<Output = Self>
    + Add<f64, Output = Self>
    + Mul<f64, Output = Self>
    + Div<f64, Output = Self>
    + AddAssign
    + SubAssign
    + MulAssign
    + DivAssign
{
    /// The number without its derivative.
    fn value(self) -> f64;
    /// The larger of two; the first where they are equal.
    fn larger(self, other: Self) -> Self {
        if other.value() > self.value() { other } else { self }
    }
    /// The smaller of two; the first where they are equal.
    fn smaller(self, other: Self) -> Self {
        if other.value() < self.value() { other } else { self }
    }
    /// |x|; at its kink, where x is 0, the derivative is the one as the variable grows.
    fn size(self) -> Self;
    /// Reciprocal 1/x.
    fn recip(self) -> Self {
        Self::one() / self
    }
    /// Square root √x.
    fn sqrt(self) -> Self;
    /// Exponential e^x.
    fn exp(self) -> Self;
    /// Natural logarithm ln x.
    fn ln(self) -> Self;
    /// Sine of an angle in rad.
    fn sin(self) -> Self;
    /// Cosine of an angle in rad.
    fn cos(self) -> Self;
    /// Tangent of an angle in rad.
    fn tan(self) -> Self;
    /// Hyperbolic tangent.
    fn tanh(self) -> Self;
    /// Arctangent, rad.
    fn atan(self) -> Self;
    /// Whole power x^n.
    fn powi(self, n: i32) -> Self;
    /// Power x^p of a positive number.
    fn powf(self, p: f64) -> Self;
}

/// A value with its derivative.
///
/// ```
/// use rodcal_base::dual::{Dual, Number};
///
/// // d(x² sin x)/dx = 2x sin x + x² cos x
/// let x = Dual::from(0.7).derivative();
/// let y = x * x * x.sin();
/// assert!((y.eps - (1.4 * 0.7f64.sin() + 0.49 * 0.7f64.cos())).abs() < 1e-15);
/// ```
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Dual {
    /// The value.
    pub re: f64,
    /// The derivative.
    pub eps: f64,
}

impl Dual {
    /// The number itself, where `self` is the variable.
    pub fn derivative(self) -> Dual {
        Dual { eps: 1.0, ..self }
    }

    /// f(self) from f and f′ at its value.
    fn chained(self, value: f64, slope: f64) -> Dual {
        Dual { re: value, eps: slope * self.eps }
    }
}

/// The rotation by `angle` (rad) about the y axis.
pub fn about_y<T: Number>(angle: T) -> Rotation3<T> {
    let (sin, cos, zero, one) = (angle.sin(), angle.cos(), T::zero(), T::one());
    Rotation3::from_matrix_unchecked(Matrix3::new(cos, zero, sin, zero, one, zero, -sin, zero, cos))
}

impl From<f64> for Dual {
    fn from(re: f64) -> Dual {
        Dual { re, eps: 0.0 }
    }
}

impl Zero for Dual {
    fn zero() -> Dual {
        Dual::from(0.0)
    }
    fn is_zero(&self) -> bool {
        self.re == 0.0 && self.eps == 0.0
    }
}

impl One for Dual {
    fn one() -> Dual {
        Dual::from(1.0)
    }
}

impl Sum for Dual {
    fn sum<I: Iterator<Item = Dual>>(all: I) -> Dual {
        all.fold(Dual::zero(), |sum, x| sum + x)
    }
}

impl Neg for Dual {
    type Output = Dual;
    fn neg(self) -> Dual {
        Dual { re: -self.re, eps: -self.eps }
    }
}

impl Add for Dual {
    type Output = Dual;
    fn add(self, b: Dual) -> Dual {
        Dual { re: self.re + b.re, eps: self.eps + b.eps }
    }
}

impl Sub for Dual {
    type Output = Dual;
    fn sub(self, b: Dual) -> Dual {
        self + -b
    }
}

impl Mul for Dual {
    type Output = Dual;
    fn mul(self, b: Dual) -> Dual {
        Dual { re: self.re * b.re, eps: self.re * b.eps + self.eps * b.re }
    }
}

impl Div for Dual {
    type Output = Dual;
    fn div(self, b: Dual) -> Dual {
        Dual { re: self.re / b.re, eps: (self.eps * b.re - self.re * b.eps) / (b.re * b.re) }
    }
}

impl Add<f64> for Dual {
    type Output = Dual;
    fn add(self, b: f64) -> Dual {
        Dual { re: self.re + b, ..self }
    }
}

impl Mul<f64> for Dual {
    type Output = Dual;
    fn mul(self, b: f64) -> Dual {
        Dual { re: self.re * b, eps: self.eps * b }
    }
}

impl Div<f64> for Dual {
    type Output = Dual;
    fn div(self, b: f64) -> Dual {
        Dual { re: self.re / b, eps: self.eps / b }
    }
}

impl<T> AddAssign<T> for Dual
where
    Dual: Add<T, Output = Dual>,
{
    fn add_assign(&mut self, b: T) {
        *self = *self + b;
    }
}

impl<T> SubAssign<T> for Dual
where
    Dual: Sub<T, Output = Dual>,
{
    fn sub_assign(&mut self, b: T) {
        *self = *self - b;
    }
}

impl<T> MulAssign<T> for Dual
where
    Dual: Mul<T, Output = Dual>,
{
    fn mul_assign(&mut self, b: T) {
        *self = *self * b;
    }
}

impl<T> DivAssign<T> for Dual
where
    Dual: Div<T, Output = Dual>,
{
    fn div_assign(&mut self, b: T) {
        *self = *self / b;
    }
}

impl Number for Dual {
    fn value(self) -> f64 {
        self.re
    }
    fn size(self) -> Dual {
        let eps = if self.re == 0.0 { self.eps.abs() } else { self.eps * self.re.signum() };
        Dual { re: self.re.abs(), eps }
    }
    fn sqrt(self) -> Dual {
        self.chained(self.re.sqrt(), 0.5 / self.re.sqrt())
    }
    fn exp(self) -> Dual {
        self.chained(self.re.exp(), self.re.exp())
    }
    fn ln(self) -> Dual {
        self.chained(self.re.ln(), 1.0 / self.re)
    }
    fn sin(self) -> Dual {
        self.chained(self.re.sin(), self.re.cos())
    }
    fn cos(self) -> Dual {
        self.chained(self.re.cos(), -self.re.sin())
    }
    fn tan(self) -> Dual {
        self.chained(self.re.tan(), 1.0 + self.re.tan().powi(2))
    }
    fn tanh(self) -> Dual {
        self.chained(self.re.tanh(), 1.0 - self.re.tanh().powi(2))
    }
    fn atan(self) -> Dual {
        self.chained(self.re.atan(), 1.0 / (1.0 + self.re * self.re))
    }
    fn powi(self, n: i32) -> Dual {
        self.chained(self.re.powi(n), f64::from(n) * self.re.powi(n - 1))
    }
    fn powf(self, p: f64) -> Dual {
        self.chained(self.re.powf(p), p * self.re.powf(p - 1.0))
    }
}

impl Number for f64 {
    fn value(self) -> f64 {
        self
    }
    fn size(self) -> f64 {
        self.abs()
    }
    fn sqrt(self) -> f64 {
        self.sqrt()
    }
    fn exp(self) -> f64 {
        self.exp()
    }
    fn ln(self) -> f64 {
        self.ln()
    }
    fn sin(self) -> f64 {
        self.sin()
    }
    fn cos(self) -> f64 {
        self.cos()
    }
    fn tan(self) -> f64 {
        self.tan()
    }
    fn tanh(self) -> f64 {
        self.tanh()
    }
    fn atan(self) -> f64 {
        self.atan()
    }
    fn powi(self, n: i32) -> f64 {
        self.powi(n)
    }
    fn powf(self, p: f64) -> f64 {
        self.powf(p)
    }
}
