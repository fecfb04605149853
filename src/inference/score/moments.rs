//! What a hypothesis's evidence is computed from: inner products of its columns, the background
//! before them.

use nalgebra::{DMatrix, DVector};

use crate::inference::columns::gram_cache::GramCache;
use crate::inference::columns::table::{Table, stacked};
use crate::inference::score::Moments;
use crate::inference::search::Search;
use crate::inference::{ForwardModel, Hypothesis, Term};
use crate::linalg::transposed_product;
use crate::parallel::checkpoint;

/// For some candidates, the inner products of their columns with those of a hypothesis (rows), and
/// with a residual.
pub type CrossProducts<'a> = dyn Fn(&[usize]) -> (DMatrix<f64>, DVector<f64>) + Sync + 'a;

impl Search<'_> {
    /// Residual and columns of a hypothesis, background first, whitened; the residual without what
    /// its values explain.
    pub fn linear_part(&self, terms: &[Term]) -> (DVector<f64>, DMatrix<f64>) {
        let (r, own) = self.linear(terms);
        let background = self.background.0.ncols();
        let mut all = self.background.0.clone().resize_horizontally(background + own.ncols(), 0.0);
        all.columns_mut(background, own.ncols()).copy_from(&own);
        (r, all)
    }

    /// Ln of the probability of a hypothesis, of this [`Search::linear_part`], with `more` columns
    /// beside its own, each an effect of no prior by itself; and what it leaves, whitened.
    pub fn with_columns(
        &self,
        hypothesis: &Hypothesis,
        linear: &(DVector<f64>, DMatrix<f64>),
        more: &DMatrix<f64>,
    ) -> (f64, DVector<f64>) {
        let (log_probability, estimate) = self.extended(hypothesis, linear, more, &vec![1; more.ncols()]);
        let (r, columns) = linear;
        let own = columns.ncols();
        let left = r - columns * estimate.rows(0, own) - more * estimate.rows_range(own..);
        (log_probability, left)
    }

    /// The same with columns that are one effect; and the factor of each of them.
    pub fn with_effect(
        &self,
        hypothesis: &Hypothesis,
        linear: &(DVector<f64>, DMatrix<f64>),
        more: &DMatrix<f64>,
    ) -> (f64, DVector<f64>) {
        let (log_probability, estimate) = self.extended(hypothesis, linear, more, &[more.ncols()]);
        (log_probability, estimate.rows_range(linear.1.ncols()..).into_owned())
    }

    fn extended(
        &self,
        hypothesis: &Hypothesis,
        (r, columns): &(DVector<f64>, DMatrix<f64>),
        more: &DMatrix<f64>,
        effects: &[usize],
    ) -> (f64, DVector<f64>) {
        let first = self.background.0.ncols();
        let own = columns.columns(first, columns.ncols() - first);
        let mut all = own.clone_owned().resize_horizontally(own.ncols() + more.ncols(), 0.0);
        all.columns_mut(own.ncols(), more.ncols()).copy_from(more);
        let mut moments = self.moments_of(r, &all, &hypothesis.terms);
        moments.bounds.resize(first + all.ncols(), (f64::NEG_INFINITY, f64::INFINITY));
        moments.effects.extend(effects);
        let scored = moments.score();
        let prior: f64 = hypothesis.terms.iter().map(|term| self.prior[term.candidate]).sum();
        (scored.log_evidence + prior, scored.estimate)
    }

    /// Residual and columns of the effects of a hypothesis at their values, linear about the
    /// neutral ones and whitened. Estimates are in sizes from the neutral values.
    fn linear(&self, terms: &[Term]) -> (DVector<f64>, DMatrix<f64>) {
        checkpoint();
        let own: Vec<DMatrix<f64>> =
            (0..terms.len()).map(|position| self.model.columns(terms, position)).collect();
        let count: usize = own.iter().map(DMatrix::ncols).sum();
        let mut columns = DMatrix::zeros(self.evidence.residual.len(), count);
        let mut next = 0;
        for own in own {
            columns.columns_mut(next, own.ncols()).copy_from(&own);
            next += own.ncols();
        }
        // recorded less predicted, plus what the columns make of it
        let left = &self.evidence.residual - self.model.response(terms) + &columns * self.offsets(terms);
        (self.whitening.apply(&left), self.whitening.apply_columns(&columns))
    }

    /// The moments of a hypothesis, and the inner products of each candidate's columns with the
    /// hypothesis's and with the residual that it is fitted to.
    pub fn crossed(&self, terms: &[Term]) -> (Moments, Box<CrossProducts<'_>>) {
        let Some(kept) = &self.kept else {
            let (r, own) = self.linear(terms);
            let moments = self.moments_of(&r, &own, terms);
            let count = own.ncols();
            let mut with_residual = own.resize_horizontally(count + 1, 0.0);
            with_residual.set_column(count, &r);
            let products = self.model.products(self.whitening.transposed(&with_residual));
            let products_with = move |candidates: &[usize]| {
                let background: Vec<&Table> = self.beside_background.iter().collect();
                let mut cross = stacked(&background, candidates);
                let (first, all) = (cross.nrows(), candidates.iter().map(|&k| self.grams[k].ncols()).sum());
                cross = cross.resize(first + count, all, 0.0);
                let mut product = DVector::zeros(all);
                let mut next = 0;
                for block in candidates.iter().map(|&candidate| products.of(candidate)) {
                    cross.view_mut((first, next), (count, block.ncols())).copy_from(&block.rows(0, count));
                    product.rows_mut(next, block.ncols()).tr_copy_from(&block.row(count));
                    next += block.ncols();
                }
                (cross, product)
            };
            return (moments, Box::new(products_with));
        };
        let effects: Vec<usize> = terms.iter().map(|c| c.candidate).collect();
        let cross = kept.hypothesis(&effects, &|effect| self.beside_effect(effect));
        let moments = self.kept_moments(kept, terms);
        let of_residual = |candidates: &[usize]| kept.residual(candidates).row(0).transpose();
        (moments, Box::new(move |candidates| (cross(candidates), of_residual(candidates))))
    }

    /// Inner products of an effect's columns (rows) with those of all candidates.
    fn beside_effect(&self, effect: usize) -> Table {
        if let Some(training) = &self.training {
            return training.between(effect);
        }
        let own = self.whitening.apply_columns(&self.model.neutral(effect));
        self.model.table(&self.whitening.transposed(&own))
    }

    pub fn moments(&self, terms: &[Term]) -> Moments {
        if let Some(kept) = &self.kept {
            return self.kept_moments(kept, terms);
        }
        let (r, own) = self.linear(terms);
        self.moments_of(&r, &own, terms)
    }

    /// Of a linear model. Of the last effect, which is often only tried, no products with all
    /// candidates are needed.
    fn kept_moments(&self, kept: &GramCache, terms: &[Term]) -> Moments {
        let effects: Vec<usize> = terms.iter().map(|c| c.candidate).collect();
        let leading = &effects[..effects.len().saturating_sub(1)];
        let cross = kept.hypothesis(leading, &|effect| self.beside_effect(effect));
        let first = self.background.0.ncols();
        let counts: Vec<usize> = effects.iter().map(|&effect| self.grams[effect].ncols()).collect();
        let count = first + counts.iter().sum::<usize>();
        let (mut gram, mut product) = (DMatrix::zeros(count, count), DVector::zeros(count));
        gram.view_mut((0, 0), (first, first)).copy_from(&self.background.1);
        product.rows_mut(0, first).copy_from(&self.background.0.tr_mul(&self.residual));
        let mut next = first;
        for (&effect, &own) in effects.iter().zip(&counts) {
            let block = cross(&[effect]);
            // symmetric to the last bit
            let above = next.min(block.nrows());
            gram.view_mut((0, next), (above, own)).copy_from(&block.rows(0, above));
            gram.view_mut((next, 0), (own, above)).copy_from(&block.rows(0, above).transpose());
            gram.view_mut((next, next), (own, own)).copy_from(&self.grams[effect]);
            product.rows_mut(next, own).tr_copy_from(&kept.residual(&[effect]));
            next += own;
        }
        Moments {
            square: self.residual.norm_squared(),
            gram,
            product,
            bounds: self.bounds(terms),
            effects: counts,
            degrees_of_freedom: self.informative(),
            floor: self.evidence.rounding(),
            stated: self.evidence.stated_noise,
        }
    }

    /// Of a residual and the columns of the effects, the background before them.
    fn moments_of(&self, r: &DVector<f64>, own: &DMatrix<f64>, terms: &[Term]) -> Moments {
        checkpoint();
        let (background, of_background) = &self.background;
        let (first, count) = (background.ncols(), own.ncols());
        let cross = transposed_product(background, own);
        let mut gram = of_background.clone().resize(first + count, first + count, 0.0);
        gram.view_mut((0, first), (first, count)).copy_from(&cross);
        gram.view_mut((first, 0), (count, first)).copy_from(&cross.transpose());
        gram.view_mut((first, first), (count, count)).copy_from(&transposed_product(own, own));
        let mut product = DVector::zeros(first + count);
        product.rows_mut(0, first).copy_from(&background.tr_mul(r));
        product.rows_mut(first, count).copy_from(&own.tr_mul(r));
        Moments {
            square: r.norm_squared(),
            gram,
            product,
            bounds: self.bounds(terms),
            effects: terms.iter().map(|c| c.values.len()).collect(),
            degrees_of_freedom: self.informative(),
            floor: self.evidence.rounding(),
            stated: self.evidence.stated_noise,
        }
    }

    /// Bounds of a hypothesis's parameters, background first.
    fn bounds(&self, terms: &[Term]) -> Vec<(f64, f64)> {
        let mut bounds = vec![(f64::NEG_INFINITY, f64::INFINITY); self.background.0.ncols()];
        for c in terms {
            bounds.extend(self.model.candidates()[c.candidate].scaled_bounds());
        }
        bounds
    }
}
