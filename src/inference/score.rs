//! How probable a recording is under a hypothesis: the evidence of a Gaussian linear model, in
//! closed form.
//!
//! With r the whitened and projected residual (ν degrees of freedom), the columns C of the
//! hypothesis's parameters, scaled so that their prior is the standard normal, G = CᵀC and b = Cᵀr:
//!
//! ln p(r) = −½·ν·ln σ² − ½·ln|1 + G/σ²| − (rᵀr − bᵀ(G + σ²·1)⁻¹b) / 2σ² + constant
//!
//! at the σ that makes it largest. The determinant is the price of parameters: one that the data
//! pin down a thousand times better than its prior costs ln 1000. A parameter with a bound has the
//! part of the normal prior within it; the evidence then gains ln(posterior mass within the bound /
//! prior mass within it), parameter by parameter: a friction that comes out negative has no mass
//! where friction is possible.
//!
//! Nobody knows beforehand how large an effect is within a factor of ten. The prior of each effect
//! is therefore κ times as wide as its usual size, where κ is what makes the evidence largest
//! (empirical Bayes, by expectation–maximisation), at the price of ½·(log₁₀ κ)².

pub(in crate::inference) mod fit;
pub(in crate::inference) mod moments;
pub(in crate::inference) mod priors;

#[cfg(test)]
mod tests;

use nalgebra::{DMatrix, DMatrixView, DVector, DVectorView};

use crate::linalg::{InverseRoot, transposed_product};
use crate::statistics::{HALF_95, ln_normal_mass, student_t_quantile};

/// Least noise variance relative to that of the residual.
const LEAST: f64 = 1e-12;

/// What a stated noise counts at least, in degrees of freedom: it is known to a tenth.
const STATED: f64 = 50.0;

/// Least and largest κ.
const SCALES: (f64, f64) = (1.0 / 30.0, 30.0);
/// Steps of expectation–maximisation to κ: one settles what the data determine well.
const SCALE_STEPS: usize = 6;
/// Most steps to σ², which comes on alone where κ stays.
const STEPS: usize = 60;
/// Relative steps at which σ² and κ have arrived, and at which they have for a first look. The
/// evidence is largest there: what is missing changes it by the square.
const SETTLED: (f64, f64) = (1e-6, 0.02);
const ROUGHLY: f64 = 0.05;
/// Size, relative to what a column was, of what rounding leaves of one that a hypothesis holds
/// already.
const ROUNDING: f64 = 1e-9;
/// Numbers of cross products below which they are few.
const FEW: usize = 96;
/// Columns from which on blocks are faster than one product after the other.
const SEVERAL: usize = 8;
/// Times that a diagonal is made ten times larger.
const TRIES: usize = 12;

/// What a hypothesis's evidence is computed from: inner products of whitened and projected vectors.
#[derive(Debug, Clone)]
pub struct Moments {
    /// rᵀr.
    pub square: f64,
    /// G.
    pub gram: DMatrix<f64>,
    /// b.
    pub product: DVector<f64>,
    /// Bounds of the scaled parameters.
    pub bounds: Vec<(f64, f64)>,
    /// How many parameters each effect has; those before the first effect keep their size.
    pub effects: Vec<usize>,
    /// ν.
    pub degrees_of_freedom: usize,
    /// Least noise: what rounding alone makes.
    pub floor: f64,
    /// σ₀, where somebody stated it: it counts as [`STATED`] data, or as many as there are.
    pub stated: Option<f64>,
}

/// Columns that may be added to those of a hypothesis.
#[derive(Debug, Clone)]
pub struct ColumnBlock<'a> {
    /// Their inner products with each other.
    pub gram: &'a DMatrix<f64>,
    /// Those of the hypothesis's columns (rows) with them (columns), X.
    pub cross: DMatrixView<'a, f64>,
    /// What [`Score::solved`] makes of X.
    pub solved: DMatrixView<'a, f64>,
    /// Those with r.
    pub product: DVectorView<'a, f64>,
    /// Bounds of the scaled parameters.
    pub bounds: Vec<(f64, f64)>,
}

/// Parameters of an effect that the data leave open, from which on their prior's size counts for an
/// interval.
const UNDETERMINED: f64 = 0.05;

/// What a fit of a hypothesis comes to.
#[derive(Debug, Clone)]
pub struct Score {
    /// ln p(r), less a constant that is the same for all hypotheses of one evidence and whitening.
    pub log_evidence: f64,
    /// Noise of a datum.
    pub sigma: f64,
    /// Estimates of the scaled parameters: posterior means without regard to bounds.
    pub estimate: DVector<f64>,
    /// Their posterior covariance.
    pub covariance: DMatrix<f64>,
    /// How many parameters the data determine, Σλ/(λ + σ²).
    pub determined: f64,
    /// κ of every effect.
    pub scales: Vec<f64>,
}

impl Score {
    /// (G + σ²)⁻¹X of cross products X, by the posterior covariance over σ².
    pub fn solved(&self, cross: &DMatrix<f64>) -> DMatrix<f64> {
        let per_square = self.sigma.powi(2).recip();
        if cross.len() >= FEW {
            return transposed_product(&self.covariance, cross) * per_square;
        }
        // so few columns are sooner multiplied one by one
        let mut solved = DMatrix::zeros(cross.nrows(), cross.ncols());
        for (mut solved, cross) in solved.column_iter_mut().zip(cross.column_iter()) {
            for (covariance, cross) in self.covariance.column_iter().zip(cross.iter()) {
                solved.axpy(cross * per_square, &covariance, 1.0);
            }
        }
        solved
    }
}

impl Moments {
    /// Of the residual `r` and `columns`, with bounds of their factors and the sizes of the
    /// effects, the last of the columns.
    #[cfg(test)]
    pub fn new(
        r: &DVector<f64>,
        columns: &DMatrix<f64>,
        bounds: Vec<(f64, f64)>,
        effects: Vec<usize>,
        degrees_of_freedom: usize,
        floor: f64,
    ) -> Self {
        let (gram, product) = (transposed_product(columns, columns), columns.tr_mul(r));
        let square = r.norm_squared();
        Moments { square, gram, product, bounds, effects, degrees_of_freedom, floor, stated: None }
    }

    /// The score: σ² and κ are found together, by MacKay's fixed point and
    /// expectation–maximisation.
    ///
    /// σ² comes from above, from what the residual has without any hypothesis, and goes no further
    /// down than the floor. Far below what is left, columns that are nearly the same would explain
    /// their own rounding.
    ///
    /// σ² = |r − C·x|² / (ν − γ), where γ parameters are determined by the data (D. J. C. MacKay,
    /// Neural Computation 4 (1992) 415–447, §4)
    pub fn score(&self) -> Score {
        let (p, nu) = (self.gram.ncols(), (self.degrees_of_freedom as f64).max(1.0));
        let (count, believed) = self.believed();
        let all = (self.square + believed) / (nu + count);
        // G itself is rounded
        let rounding = p as f64 * f64::EPSILON * self.gram.diagonal().iter().fold(0.0, |a: f64, &b| a.max(b));
        let lowest = self.floor.powi(2).max(LEAST * all).max(rounding).max(f64::MIN_POSITIVE.sqrt());
        let highest = all.max(lowest);
        let (mut s, mut scales) = (highest, vec![1.0; self.effects.len()]);
        let mut sizes = self.sizes(&scales);
        let mut solved = Ridge::new(&self.gram, &self.product, |k| s / sizes[k].powi(2));
        for step in 0..STEPS {
            let next = ((self.left(&solved.solution) + believed)
                / (nu + count - solved.determined(&sizes, s)).max(1e-3 * nu))
            .clamp(lowest, 2.0 * highest);
            let mut moved = (next / s).ln().abs() * SETTLED.1 / SETTLED.0;
            if step < SCALE_STEPS {
                let rescaled = self.rescaled(&scales, &solved, s);
                let ratio = |(new, old): (&f64, &f64)| (new / old).ln().abs();
                moved = rescaled.iter().zip(&scales).map(ratio).fold(moved, f64::max);
                scales = rescaled;
            }
            s = next;
            sizes = self.sizes(&scales);
            solved = Ridge::new(&self.gram, &self.product, |k| s / sizes[k].powi(2));
            if moved < SETTLED.1 {
                break;
            }
        }
        let room: f64 = (0..p)
            .map(|k| {
                let (low, high) = self.bounds[k];
                let sd = (s * solved.variance[k]).sqrt() / sizes[k];
                room((low / sizes[k], high / sizes[k]), solved.solution[k] / sizes[k], sd)
            })
            .sum();
        let price: f64 = scales.iter().map(|scale| 0.5 * scale.log10().powi(2)).sum();
        let quadratic = (self.square - self.product.dot(&solved.solution)).max(0.0);
        let determinant =
            solved.ln_determinant + sizes.iter().map(|size| (size.powi(2) / s).ln()).sum::<f64>();
        let counted = self.degrees_of_freedom as f64 + count;
        let fit = counted * s.ln() + determinant + (quadratic + believed) / s;
        Score {
            log_evidence: -0.5 * fit + room - price,
            sigma: s.sqrt(),
            determined: solved.determined(&sizes, s),
            covariance: solved.inverse() * s,
            estimate: solved.solution,
            scales,
        }
    }

    /// Posterior covariance of the parameters of a score, κ uncertain as well; `alike` are, of each
    /// effect, how many numbers of one kind (lengths, angles) follow one another.
    ///
    /// In a direction that the data leave open a number is known by the size of the others of its
    /// kind alone, with what the data determine of each, dₖ = 1 − cov xₖ/κ²:
    ///
    /// ```text
    /// κ² = Σ dₖ·xₖ²/γ,   γ = Σ dₖ      and a Student's t distribution of γ degrees of freedom, by t/1.96 wider
    /// ```
    pub fn covariance(&self, score: &Score, alike: &[Vec<usize>]) -> DMatrix<f64> {
        let (square, before) = (score.sigma.powi(2), self.sizes(&score.scales));
        let mut sizes = before.clone();
        let mut first = self.gram.ncols() - self.effects.iter().sum::<usize>();
        for &count in alike.iter().flatten() {
            let own = first..first + count;
            first += count;
            let seen = |k: usize| (1.0 - score.covariance[(k, k)] / before[k].powi(2)).max(0.0);
            let known: f64 = own.clone().map(seen).sum();
            if count > 1 && known < count as f64 - UNDETERMINED {
                let squares: f64 = own.clone().map(|k| seen(k) * score.estimate[k].powi(2)).sum();
                let size = (squares / known.max(UNDETERMINED)).sqrt();
                let wider = student_t_quantile(0.975, known.max(1.0)).unwrap_or(HALF_95) / HALF_95;
                sizes[own].iter_mut().for_each(|own| *own = own.max(size) * wider);
            }
        }
        if sizes == before {
            return score.covariance.clone();
        }
        Ridge::new(&self.gram, &self.product, |k| square / sizes[k].powi(2)).inverse() * square
    }

    /// What the stated noise counts, and what it adds to the squares.
    fn believed(&self) -> (f64, f64) {
        let count = |sigma: f64| {
            let count = STATED.max(self.degrees_of_freedom as f64);
            (count, count * sigma * sigma)
        };
        self.stated.map_or((0.0, 0.0), count)
    }

    /// |r − C·x|² = rᵀr − 2bᵀx + xᵀGx.
    fn left(&self, x: &DVector<f64>) -> f64 {
        (self.square - 2.0 * self.product.dot(x) + x.dot(&(&self.gram * x))).max(0.0)
    }

    /// The next κ of every effect: root mean square of its parameters, in sizes, their uncertainty
    /// included.
    fn rescaled(&self, scales: &[f64], solved: &Ridge, s: f64) -> Vec<f64> {
        let mut first = self.gram.ncols() - self.effects.iter().sum::<usize>();
        let mut next = Vec::with_capacity(scales.len());
        for &count in &self.effects {
            let own = first..first + count;
            let square: f64 = own.map(|k| solved.solution[k].powi(2) + s * solved.variance[k]).sum();
            next.push((square / count as f64).sqrt().clamp(SCALES.0, SCALES.1));
            first += count;
        }
        next
    }

    /// κ of every parameter.
    fn sizes(&self, scales: &[f64]) -> Vec<f64> {
        let fixed = self.gram.ncols() - self.effects.iter().sum::<usize>();
        let of_effect = |(scale, &count): (&f64, &usize)| std::iter::repeat_n(*scale, count);
        std::iter::repeat_n(1.0, fixed).chain(scales.iter().zip(&self.effects).flat_map(of_effect)).collect()
    }

    /// About the log evidence that `more` columns add to a hypothesis of this score: the noise
    /// follows what they explain.
    ///
    /// With the hypothesis's columns out of them (G' = Gₘ − X(G + σ²)⁻¹Xᵀ, b' = bₘ − X(G + σ²)⁻¹b,
    /// X the cross products) they explain Δ = b'ᵀ(G' + σ²/κ²)⁻¹b' of the squares Q = rᵀr − bᵀx,
    /// priors of the hypothesis's own numbers included, which leaves s' = σ²·(1 − Δ/Q), and
    ///
    /// gain ≈ −½·ν·ln(1 − Δ/Q) − ½·ln|1 + κ²G'/s'| + ln(room)
    pub fn about(&self, score: &Score, more: &ColumnBlock) -> f64 {
        let (nu, s) = ((self.degrees_of_freedom as f64 + self.believed().0).max(1.0), score.sigma.powi(2));
        if more.gram.len() == 1 {
            return self.about_one(score, more, nu);
        }
        let (gram, product) = self.reduced(score, more);
        let squares = self.squares(score, nu);
        let k = gram.ncols();
        // what a hypothesis holds already leaves rounding: it is no smaller a prior
        let rounding = ROUNDING * more.gram.diagonal().amax();
        // |b|² is about κ²·tr(G²) + σ²·tr(G)
        let moment = (product.norm_squared() - s * gram.trace()) / gram.norm_squared().max(f64::MIN_POSITIVE);
        let (mut scale, mut left) = (moment.max(0.0).sqrt().clamp(SCALES.0, SCALES.1), s);
        let mut step = 0;
        loop {
            let ridge = left / scale.powi(2) + rounding;
            let solved = Ridge::new(&gram, &product, |_| ridge);
            let square = solved.solution.norm_squared() + left * solved.variance.sum();
            let next = (square / k as f64).sqrt().clamp(SCALES.0, SCALES.1);
            let explained = (product.dot(&solved.solution) / squares).clamp(0.0, 1.0 - 1e-12);
            let less = (s * (1.0 - explained)).max(self.floor.powi(2)).max(f64::MIN_POSITIVE.sqrt());
            if step == SCALE_STEPS || (is_about(next, scale) && is_about(less, left)) {
                let determinant = solved.ln_determinant - k as f64 * ridge.ln();
                let room: f64 = (0..k)
                    .map(|i| {
                        let (low, high) = more.bounds[i];
                        let sd = (left * solved.variance[i]).sqrt() / scale;
                        room((low / scale, high / scale), solved.solution[i] / scale, sd)
                    })
                    .sum();
                return -0.5 * (nu * (-explained).ln_1p() + determinant + scale.log10().powi(2)) + room;
            }
            (scale, left) = (next, less);
            step += 1;
        }
    }

    /// Q: what a hypothesis of this score leaves, what its own numbers cost besides.
    fn squares(&self, score: &Score, nu: f64) -> f64 {
        let quadratic = self.square - self.product.dot(&score.estimate) + self.believed().1;
        quadratic.max(nu * score.sigma.powi(2))
    }

    /// The same of one column, which a slip at any place is, in plain numbers.
    fn about_one(&self, score: &Score, more: &ColumnBlock, nu: f64) -> f64 {
        let s = score.sigma.powi(2);
        let squares = self.squares(score, nu);
        let gram = more.gram[0] - more.cross.dot(&more.solved);
        // (G + σ²)⁻¹b is the estimate
        let product = more.product[0] - more.cross.column(0).dot(&score.estimate);
        let rounding = ROUNDING * more.gram[0].abs();
        let moment = (product * product - s * gram) / (gram * gram).max(f64::MIN_POSITIVE);
        let (mut scale, mut left) = (moment.max(0.0).sqrt().clamp(SCALES.0, SCALES.1), s);
        let mut step = 0;
        loop {
            let ridge = left / scale.powi(2) + rounding;
            // rounding may leave less than nothing of the column
            let inverse = 1.0 / (gram.max(0.0) + ridge);
            let solution = inverse * product;
            let next = (solution * solution + left * inverse).sqrt().clamp(SCALES.0, SCALES.1);
            let explained = (product * solution / squares).clamp(0.0, 1.0 - 1e-12);
            let less = (s * (1.0 - explained)).max(self.floor.powi(2)).max(f64::MIN_POSITIVE.sqrt());
            if step == SCALE_STEPS || (is_about(next, scale) && is_about(less, left)) {
                let determinant = -(inverse * ridge).ln();
                let (low, high) = more.bounds[0];
                let bounds = (low / scale, high / scale);
                let room = room(bounds, solution / scale, (left * inverse).sqrt() / scale);
                return -0.5 * (nu * (-explained).ln_1p() + determinant + scale.log10().powi(2)) + room;
            }
            (scale, left) = (next, less);
            step += 1;
        }
    }

    /// Inner products of `more` columns with each other and with r, the hypothesis's columns out of
    /// them.
    fn reduced(&self, score: &Score, more: &ColumnBlock) -> (DMatrix<f64>, DVector<f64>) {
        let shared = match more.cross.ncols() < SEVERAL {
            true => more.cross.tr_mul(&more.solved),
            // a curve's columns are sooner copied and multiplied in blocks
            false => transposed_product(&more.cross.clone_owned(), &more.solved.clone_owned()),
        };
        (more.gram - shared, more.product - more.cross.tr_mul(&score.estimate))
    }

    /// What a hypothesis of this score leaves, as a problem of its own: its columns are taken out
    /// with the uncertainty that they have now, and so are the degrees of freedom that they
    /// determine.
    pub fn rest(&self, score: &Score) -> Moments {
        Moments {
            square: (self.square - self.product.dot(&score.estimate)).max(0.0),
            gram: DMatrix::zeros(0, 0),
            product: DVector::zeros(0),
            bounds: Vec::new(),
            effects: Vec::new(),
            degrees_of_freedom: self.degrees_of_freedom.saturating_sub(score.determined.round() as usize),
            floor: self.floor,
            stated: self.stated,
        }
    }

    /// `more` columns in what a hypothesis leaves: a problem of theirs only, not of the
    /// hypothesis's besides.
    pub fn beyond(&self, score: &Score, more: &ColumnBlock) -> Moments {
        let (mut gram, product) = self.reduced(score, more);
        let rounding = ROUNDING * more.gram.diagonal().amax();
        for k in 0..gram.ncols() {
            gram[(k, k)] += rounding;
        }
        let (bounds, effects) = (more.bounds.clone(), vec![more.gram.ncols()]);
        Moments { gram, product, bounds, effects, ..self.rest(score) }
    }
}

/// The solution x = A⁻¹b of A = G + a diagonal.
struct Ridge {
    solution: DVector<f64>,
    /// The diagonal of A⁻¹.
    variance: DVector<f64>,
    ln_determinant: f64,
    root: Option<InverseRoot>,
}

impl Ridge {
    /// A diagonal that rounding has swallowed is made larger until A can be inverted.
    fn new(gram: &DMatrix<f64>, product: &DVector<f64>, diagonal: impl Fn(usize) -> f64) -> Self {
        let p = gram.ncols();
        let mut a = gram.clone();
        for k in 0..p {
            a[(k, k)] += diagonal(k);
        }
        let mut more = f64::EPSILON * a.diagonal().amax();
        for _ in 0..TRIES {
            if let Some(root) = InverseRoot::new(&a) {
                let (solution, variance) = (root.solve(product), root.diagonal_of_inverse());
                return Ridge { solution, variance, ln_determinant: root.ln_determinant, root: Some(root) };
            }
            for k in 0..p {
                a[(k, k)] += more;
            }
            more *= 10.0;
        }
        // nothing but numbers that are not finite
        let (solution, variance) = (DVector::zeros(p), DVector::zeros(p));
        Ridge { solution, variance, ln_determinant: f64::INFINITY, root: None }
    }

    /// A⁻¹.
    fn inverse(&self) -> DMatrix<f64> {
        let none = || DMatrix::zeros(self.variance.len(), self.variance.len());
        self.root.as_ref().map_or_else(none, InverseRoot::inverse)
    }

    /// γ = p − σ²·Σ(A⁻¹)ₖₖ/κₖ².
    fn determined(&self, sizes: &[f64], s: f64) -> f64 {
        let shares = sizes.iter().zip(&self.variance).map(|(size, own)| s * own / size.powi(2));
        sizes.len() as f64 - shares.sum::<f64>()
    }
}

/// True where a number is another one but for a step at which it has arrived for a first look.
fn is_about(new: f64, old: f64) -> bool {
    (new - old).abs() < ROUGHLY * old
}

/// Ln of the posterior mass within the bounds over the prior mass there.
fn room((low, high): (f64, f64), mean: f64, sd: f64) -> f64 {
    if low == f64::NEG_INFINITY && high == f64::INFINITY {
        return 0.0;
    }
    let sd = sd.max(f64::MIN_POSITIVE);
    ln_normal_mass((low - mean) / sd, (high - mean) / sd) - ln_normal_mass(low, high)
}
