//! Weights and priors turned into plain least squares: rows scaled by √w, and one row per prior.

use nalgebra::DVector;

use super::options::{Noise, Options, Prior};
use super::problem::Problem;
use super::reduced::Reduced;
use crate::error::{Error, Result};
use crate::linalg::RowReduction;

/// The residual vector whose square is S(p): √wᵢ·rᵢ, then σ·(pⱼ − mⱼ)/sⱼ.
pub(super) struct Stacked<'a> {
    problem: &'a dyn Problem,
    root_weights: DVector<f64>,
    priors: &'a [Prior],
    /// σ, which brings a prior to the unit of the residuals.
    sigma: f64,
}

impl<'a> Stacked<'a> {
    pub fn new(problem: &'a dyn Problem, weights: DVector<f64>, options: &'a Options) -> Self {
        let sigma = match options.noise {
            Noise::Known(sigma) => sigma,
            Noise::Estimated => 1.0,
        };
        Stacked { problem, root_weights: weights.map(f64::sqrt), priors: &options.priors, sigma }
    }

    /// m residuals, then the priors.
    pub fn residuals(&self, p: &DVector<f64>) -> DVector<f64> {
        self.stacked(p, &self.problem.residuals(p))
    }

    /// The same where the residuals rᵢ of the problem are known.
    pub fn stacked(&self, p: &DVector<f64>, r: &DVector<f64>) -> DVector<f64> {
        let m = self.root_weights.len();
        DVector::from_fn(m + self.priors.len(), |i, _| match i.checked_sub(m) {
            None => self.root_weights[i] * r[i],
            Some(k) => {
                let prior = &self.priors[k];
                self.sigma * (p[prior.parameter] - prior.value) / prior.sd
            }
        })
    }

    /// A store for [`Stacked::linearise`], to be used again and again.
    pub fn store(&self) -> RowReduction {
        RowReduction::new(self.problem.parameter_count() + 1, self.root_weights.len() + self.priors.len())
    }

    /// The linearisation at `p`, whose residuals are `r`; `None` where a derivative is not finite.
    ///
    /// Block by block [√W·J √W·r] is reduced to its triangle; J is never held whole.
    pub fn linearise(
        &self,
        p: &DVector<f64>,
        r: &DVector<f64>,
        store: &mut RowReduction,
    ) -> Result<Option<Reduced>> {
        let (m, n) = (self.root_weights.len(), p.len());
        store.clear();
        let mut next = 0;
        let mut finite = true;
        let mut misfit = None;
        self.problem.jacobian_blocks(p, &mut |first, block| {
            let rows = block.nrows();
            if first != next || block.ncols() != n || rows > m - next {
                misfit.get_or_insert_with(|| {
                    format!("a block of {rows} x {} at row {first}, after {next} rows", block.ncols())
                });
                return;
            }
            next += rows;
            finite = finite && block.iter().all(|x| x.is_finite());
            if misfit.is_some() || !finite {
                return;
            }
            store.push(rows, |range, column, entries| {
                let of_all = first + range.start..first + range.end;
                if column == n {
                    entries.copy_from_slice(&r.as_slice()[of_all]);
                    return;
                }
                let weights = &self.root_weights.as_slice()[of_all];
                let derivatives = &block.as_slice()[column * rows..][range];
                for ((entry, w), d) in entries.iter_mut().zip(weights).zip(derivatives) {
                    *entry = w * d;
                }
            });
        });
        if misfit.is_some() || next != m {
            let found = misfit.unwrap_or_else(|| format!("{next} rows"));
            return Err(Error::Argument {
                name: "problem",
                found: format!("a Jacobian of {found}"),
                expected: format!("{m} x {n}, as it says, in consecutive blocks"),
            });
        }
        if !finite {
            return Ok(None);
        }
        store.push(self.priors.len(), |range, column, entries| {
            for (entry, k) in entries.iter_mut().zip(range) {
                let prior = &self.priors[k];
                *entry = match column {
                    _ if column == n => r[m + k],
                    _ if column == prior.parameter => self.sigma / prior.sd,
                    _ => 0.0,
                };
            }
        });
        let triangle = store.triangle();
        Ok(triangle.iter().all(|x| x.is_finite()).then(|| Reduced::new(&triangle)))
    }

    /// Length of the rounding error of the residual vector, as the problem states it.
    pub fn rounding(&self) -> f64 {
        self.problem.residual_rounding() * (self.root_weights.len() as f64).sqrt()
    }
}
