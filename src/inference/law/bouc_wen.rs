//! The loop of Bouc and Wen: hysteresis that grows smoothly into its limit (R. Bouc 1967; Y.-K.
//! Wen, J. Eng. Mech. Div. ASCE 102 (1976) 249–263), without its redundant parameters (F. Ma, H.
//! Zhang, A. Bockstedte, G. C. Foliente, P. Paevere, J. Appl. Mech. 71 (2004) 345–349).
//!
//! ```text
//! ż = A·ẋ − β·|ẋ|·|z|^(n−1)·z − γ·ẋ·|z|^n,   A = 1,   β + γ = r^−n,   σ = β/(β + γ)
//!
//! dζ/dy = 1 − (σ·sgn(ζ·dy) + 1 − σ)·|ζ|^n,    z = r·ζ,   x = r·y
//! ```
//!
//! It knows no rate. Along a move in the direction of ζ it follows G, against it H until it is
//! zero, both from zero on:
//!
//! ```text
//! G' = 1 − G^n        H' = 1 + (2σ − 1)·H^n
//! ```
//!
//! Dissipation is never negative for σ ≥ ½ (S. Erlicher, N. Point, C. R. Mécanique 332 (2004)
//! 51–57). With σ = ½ it returns along a straight line; for n → ∞ that is a stop operator.
//!
//! It stands among the memories of a law because it is one of the shapes that what is left may
//! have, as a stop operator and a lag are: x is any variable of a recording, z any change, and what
//! slips or where is not known here.

/// What a loop looks like besides how wide it is.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct LoopShape {
    /// n, how sharply it bends into its limit.
    pub sharpness: f64,
    /// σ, the share of β: ½ returns straight.
    pub balance: f64,
}

impl LoopShape {
    /// n from that of an exponential approach to what is nearly a stop, even in ln n.
    pub const SHARPNESS: (f64, f64) = (1.0, 8.0);
    /// σ: dissipative, and softening whichever way it goes.
    pub const BALANCE: (f64, f64) = (0.5, 1.0);

    /// Of these numbers as far as they are possible.
    pub fn within(sharpness: f64, balance: f64) -> LoopShape {
        let bounded = |value: f64, (low, high): (f64, f64)| value.clamp(low, high);
        LoopShape {
            sharpness: bounded(sharpness, LoopShape::SHARPNESS),
            balance: bounded(balance, LoopShape::BALANCE),
        }
    }

    /// The middle of what is possible.
    pub const MIDDLE: LoopShape = LoopShape { sharpness: 2.0, balance: 0.75 };
}

/// The loop of a shape, as its two curves.
pub(super) struct Loop {
    growing: Curve,
    returning: Curve,
}

impl Loop {
    pub fn new(shape: LoopShape) -> Loop {
        let (n, back) = (shape.sharpness, 2.0 * shape.balance - 1.0);
        Loop { growing: Curve::new(n, -1.0), returning: Curve::new(n, back) }
    }

    /// ζ once y has gone on by `more` from where it is `zeta`.
    pub fn after(&self, zeta: f64, more: f64) -> f64 {
        if more == 0.0 || !more.is_finite() {
            return zeta;
        }
        let (side, mut more, mut along) = (more.signum(), more.abs(), zeta * more.signum());
        if along < 0.0 {
            let whole = self.returning.place(-along);
            if more <= whole {
                return -side * self.returning.at(whole - more);
            }
            (more, along) = (more - whole, 0.0);
        }
        side * self.growing.at(self.growing.place(along) + more)
    }
}

/// Steps of a curve per unit of y and n.
const FINE: f64 = 8.0;
/// What is so near to the limit is there.
const REACHED: f64 = 1e-7;
/// Steps of Newton's method on one stretch.
const ROUNDS: usize = 3;

/// ζ(y) with ζ' = 1 + c·ζ^n from ζ(0) = 0 up to 1: values and slopes at even steps, cubics between
/// them.
struct Curve {
    step: f64,
    knots: Vec<(f64, f64)>,
}

impl Curve {
    /// By the classical method of Runge and Kutta.
    fn new(n: f64, c: f64) -> Curve {
        let slope = |zeta: f64| 1.0 + c * zeta.clamp(0.0, 1.0).powf(n);
        let step = 1.0 / (FINE * n);
        let mut knots = vec![(0.0, 1.0)];
        let mut zeta = 0.0;
        while zeta < 1.0 - REACHED {
            let first = slope(zeta);
            let second = slope(zeta + 0.5 * step * first);
            let third = slope(zeta + 0.5 * step * second);
            let fourth = slope(zeta + step * third);
            zeta += step / 6.0 * (first + 2.0 * (second + third) + fourth);
            knots.push((zeta, slope(zeta)));
        }
        Curve { step, knots }
    }

    /// ζ at y ≥ 0.
    fn at(&self, y: f64) -> f64 {
        let k = (y / self.step) as usize;
        match self.knots.get(k..k + 2) {
            Some(ends) => self.between(ends, y / self.step - k as f64).0.min(1.0),
            None => 1.0,
        }
    }

    /// y where ζ is so much.
    fn place(&self, zeta: f64) -> f64 {
        let last = self.knots.len() - 2;
        let k = self.knots.partition_point(|knot| knot.0 <= zeta).saturating_sub(1).min(last);
        let ends = &self.knots[k..k + 2];
        let mut t = ((zeta - ends[0].0) / (ends[1].0 - ends[0].0)).clamp(0.0, 1.0);
        for _ in 0..ROUNDS {
            let (value, slope) = self.between(ends, t);
            t = (t - (value - zeta) / slope.max(f64::MIN_POSITIVE)).clamp(0.0, 1.0);
        }
        (k as f64 + t) * self.step
    }

    /// The cubic through two knots at 0 ≤ t ≤ 1, and its slope by t.
    fn between(&self, ends: &[(f64, f64)], t: f64) -> (f64, f64) {
        let ((a, from), (b, to)) = (ends[0], ends[1]);
        let (from, to) = (from * self.step, to * self.step);
        let (square, cubic) = (3.0 * (b - a) - 2.0 * from - to, 2.0 * (a - b) + from + to);
        let value = a + t * (from + t * (square + t * cubic));
        (value, from + t * (2.0 * square + t * 3.0 * cubic))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Of n = 1 and n = 2 the curves are known: 1 − e^(−y), tanh y; e^y − 1, tan y.
    #[test]
    fn a_curve_is_what_is_known_of_it() {
        for k in 0..60 {
            let y = 0.1 * f64::from(k);
            let [one, two] = [1.0, 2.0].map(|n| Curve::new(n, -1.0));
            assert!((one.at(y) + (-y).exp_m1()).abs() < 2e-6 && (two.at(y) - y.tanh()).abs() < 2e-6, "{y}");
            assert!(y > 4.0 || (one.place(one.at(y)) - y).abs() < 1e-6, "{y}");
            assert!(y > 4.0 || (two.place(two.at(y)) - y).abs() < 1e-4, "{y}");
        }
        let [one, two] = [1.0, 2.0].map(|n| Curve::new(n, 1.0));
        assert!((one.at(0.5) - 0.5f64.exp_m1()).abs() < 5e-6 && (two.at(0.5) - 0.5f64.tan()).abs() < 5e-6);
    }

    /// Reference: the equation in x itself, r = 2.5, n = 1.7, σ = 0.8, in steps of 1e-4 by the
    /// classical method of Runge and Kutta, in Python:
    ///
    /// ```text
    /// def f(z, s): return s*(1 - (.8*np.sign(s*z) + .2)*abs(z/2.5)**1.7)
    /// for x in (3, 7, 4, 4.5, 1, -2, 5):
    ///     s = np.sign(x - was); m = int(round(abs(x - was)/1e-4)); h = 1e-4
    ///     for _ in range(m): k1 = f(z,s); k2 = f(z+h*k1/2,s); k3 = f(z+h*k2/2,s); k4 = f(z+h*k3,s)
    ///         z += h*(k1+2*k2+2*k3+k4)/6
    /// ```
    #[test]
    fn a_loop_is_that_of_its_equation() {
        let (r, shape) = (2.5, LoopShape { sharpness: 1.7, balance: 0.8 });
        let of_shape = Loop::new(shape);
        let (mut x, mut zeta) = (0.0, 0.0);
        for (next, expected) in REFERENCE {
            zeta = of_shape.after(zeta, (next - x) / r);
            x = next;
            assert!((r * zeta - expected).abs() < 2e-5, "{x}: {} for {expected}", r * zeta);
        }
    }

    const REFERENCE: [(f64, f64); 7] = [
        (3.0, 2.012701),
        (7.0, 2.465688),
        (4.0, -0.872799),
        (4.5, -0.344853),
        (1.0, -2.217915),
        (-2.0, -2.462007),
        (5.0, 2.362355),
    ];

    /// Sharp and straight, it is a stop operator, but for the corner.
    #[test]
    fn a_sharp_loop_is_nearly_a_stop() {
        let sharp = Loop::new(LoopShape { sharpness: 60.0, balance: 0.5 });
        let (mut zeta, mut x) = (0.0, 0.0);
        for (next, stop) in [(1.0, 0.5), (4.0, 1.0), (3.0, 0.5), (0.0, -1.0), (0.8, -0.6)] {
            zeta = sharp.after(zeta, (next - x) / 2.0);
            x = next;
            assert!((zeta - stop).abs() < 0.02, "{x}: {zeta} for {stop}");
        }
    }
}
