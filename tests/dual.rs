//! Numbers with one derivative: a + b ε with ε² = 0. Formulas that are generic in [`Number`] differentiate themselves.

use std::ops::{Add, AddAssign, Div, Mul, Neg, Sub};

/// What a formula needs of its numbers.
pub trait Number:
    Copy
    + From<f64>
    + Neg<Output = Self>
    + Add<Output = Self>
    + Sub<Output = Self>
    + Mul<Output = Self>
    + Div<Output = Self>
    + Add<f64, Output = Self>
    + Mul<f64, Output = Self>
    + Div<f64, Output = Self>
{
    fn one() -> Self {
        Self::from(1.0)
    }
    fn recip(self) -> Self {
        Self::one() / self
    }
    fn exp(self) -> Self;
    fn ln(self) -> Self;
    fn sin(self) -> Self;
    fn cos(self) -> Self;
    fn atan(self) -> Self;
    fn powi(self, n: i32) -> Self;
    fn powf(self, p: f64) -> Self;
}

/// A value with its derivative.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Dual {
    pub re: f64,
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

impl From<f64> for Dual {
    fn from(re: f64) -> Dual {
        Dual { re, eps: 0.0 }
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

impl Number for Dual {
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
