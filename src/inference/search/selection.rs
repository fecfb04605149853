//! Which hypothesis a recording supports: effects are added, exchanged and taken away while that
//! makes it more probable.

use crate::inference::score::priors::{NAMED, PRIOR};
use crate::inference::search::Search;
use crate::inference::{Effect, ForwardModel, Hypothesis, Kind, Term};
use crate::parallel::in_parallel_outside_of_jobs;

/// A hypothesis of known effects explains as well as one that leaves something unknown within these
/// odds, if it leaves at most so much more, as a factor, per degree of freedom.
const AS_WELL: (f64, f64) = (20.0, 1.01);
/// Share of what names explain that a curve may draw better.
pub const LITTLE: f64 = 0.1;
/// Standard deviations of what more degrees of freedom take by chance that count as chance.
const CHANCE: f64 = 3.0;
/// Most effects in one hypothesis.
const MOST: usize = 10;
/// Most effects that are exchanged on the way to one hypothesis.
const MOST_EXCHANGES: usize = 2 * MOST;
/// Of how many candidates, the likeliest by their columns at neutral values, the values are fitted.
const REFITTED: usize = 6;
/// And how many of them may be of one effect, of the forms of a law with as many parameters.
const OF_ONE_EFFECT: usize = 2;
/// Ln of the odds within which a first look at their values decides nothing.
const NEAR: f64 = 1.0;
/// Ln of the odds that an exchange has to gain: less is where the values were looked for from.
const NO_GAIN: f64 = 1e-3;

/// Odds against chance that make an effect, or a second one beside it, worth a try.
const HOPELESS: f64 = 1.0 / 400.0;

/// So many names may be those of fewer effects that were not found, and so many other effects are
/// tried as the first of them.
const MANY: usize = 3;
const OTHER_STARTS: usize = 2;

/// By how much the odds of a name may be shared among effects that explain the same.
const MOST_SHARED: f64 = 10.0;

/// Whether pairs of effects are screened.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Pairs {
    /// All pairs of candidates are screened.
    Screened,
    /// Not where all data supported a single effect at most: a part of them supports no more.
    LeftOut,
}

/// What a hypothesis leaves that no effect of the library explains.
#[derive(Debug, Clone)]
pub enum DiscrepancyModel {
    /// A smooth curve, the last of this hypothesis.
    Curve(Hypothesis),
    /// No curve, but the repeats agree on it.
    Replicates,
}

impl DiscrepancyModel {
    /// The hypothesis with the curve beside it, where a curve describes what is left.
    pub fn curve(&self) -> Option<&Hypothesis> {
        match self {
            DiscrepancyModel::Curve(longer) => Some(longer),
            DiscrepancyModel::Replicates => None,
        }
    }
}

/// Where adding effects one by one has led.
struct Way {
    /// The best hypothesis on it.
    hypothesis: Hypothesis,
    /// What that leaves.
    left_over: Option<DiscrepancyModel>,
    /// Ln of the probability of both.
    log_probability: f64,
    /// All hypotheses on it.
    visited: Vec<Visited>,
}

/// A hypothesis that was come by: its candidates, sorted, and its ln of a probability.
struct Visited(Vec<usize>, f64);

impl Visited {
    fn new(hypothesis: &Hypothesis) -> Visited {
        let mut candidates: Vec<usize> = hypothesis.terms.iter().map(|term| term.candidate).collect();
        candidates.sort_unstable();
        Visited(candidates, hypothesis.log_probability)
    }

    /// The same, but for how near its values are to the best ones?
    fn is_same(&self, hypothesis: &Hypothesis) -> bool {
        let other = Visited::new(hypothesis);
        self.0 == other.0 && (self.1 - other.1).abs() < NO_GAIN
    }
}

impl Search<'_> {
    /// The most probable hypothesis of known effects, and what it leaves, if that is more than
    /// chance.
    ///
    /// Known effects are named only as far as they are likelier than a shorter hypothesis that
    /// leaves something unknown: several of them together can draw the shape of something that is
    /// none of them. Effects are added one by one from nothing, and from the best pair: two that
    /// hide each other are found by no single step.
    pub fn best(&self, pairs: Pairs) -> (Hypothesis, Option<DiscrepancyModel>) {
        let none = self.fit(&[]);
        let additions = self.additions(&none);
        let (hypothesis, left_over) = self.by_names(none, &additions, pairs);
        match left_over {
            Some(DiscrepancyModel::Curve(longer)) => {
                let (hypothesis, longer) = self.beside(hypothesis, longer);
                let (hypothesis, longer) = match self.by_curves_alone(&hypothesis, &longer) {
                    Some(unnamed) => unnamed,
                    None => (hypothesis, longer),
                };
                (hypothesis, Some(DiscrepancyModel::Curve(longer)))
            }
            other => (hypothesis, other),
        }
    }

    /// A hypothesis without laws, and the first curve of it, where curves in the place of its laws
    /// explain about as much as the laws and the one curve of `longer` do: a law that leaves a
    /// curve may be a part of the same unknown law, and needs its odds against that.
    fn by_curves_alone(
        &self,
        hypothesis: &Hypothesis,
        longer: &Hypothesis,
    ) -> Option<(Hypothesis, Hypothesis)> {
        let is_law = |term: &&Term| self.model.candidates()[term.candidate].effect.kind == Kind::Physics;
        let laws = hypothesis.terms.iter().filter(is_law).count();
        if laws == 0 {
            return None;
        }
        let others: Vec<Term> = hypothesis.terms.iter().filter(|term| !is_law(term)).cloned().collect();
        let unnamed = self.fit(&others);
        let first = self.longer(&unnamed, &self.additions(&unnamed), true)?;
        let mut curves = first.clone();
        for _ in 0..laws {
            match self.longer(&curves, &self.additions(&curves), true) {
                Some(more) if more.log_probability > curves.log_probability => curves = more,
                _ => break,
            }
        }
        (curves.log_probability + NAMED.ln() > longer.log_probability).then_some((unnamed, first))
    }

    /// The same, where nothing is named once a curve is in.
    fn by_names(
        &self,
        none: Hypothesis,
        additions: &[f64],
        pairs: Pairs,
    ) -> (Hypothesis, Option<DiscrepancyModel>) {
        let by_steps = self.along(vec![none.clone()]);
        let pair = match pairs {
            Pairs::Screened => self.best_pair(&none, additions),
            Pairs::LeftOut => None,
        };
        // a pair that the steps have come by leads where they have led
        let is_new = |pair: &Hypothesis| {
            let is_likelier = by_steps.hypothesis.log_probability + 1e-6 < pair.log_probability;
            (is_likelier || by_steps.left_over.is_some())
                && !by_steps.visited.iter().any(|visited| visited.is_same(pair))
        };
        let pair = pair.filter(is_new);
        let likelier = |way: Way, other: Way| {
            if other.log_probability > way.log_probability + 1e-6 { other } else { way }
        };
        let mut best = by_steps;
        if let Some(pair) = pair {
            best = likelier(best, self.along(vec![none.clone(), pair]));
        }
        let is_doubtful = best.left_over.is_some() || best.hypothesis.terms.len() >= MANY;
        if pairs == Pairs::Screened && is_doubtful {
            for pair in self.other_starts(&best, additions) {
                best = likelier(best, self.along(vec![none.clone(), pair]));
            }
        }
        (best.hypothesis, best.left_over)
    }

    /// Pairs that are likelier than those that the way has gone by, each of another effect, the
    /// best by itself, and the best beside it: one that was taken for all of what two together do
    /// is not exchanged for both.
    fn other_starts(&self, way: &Way, additions: &[f64]) -> Vec<Hypothesis> {
        let effect = |candidate: usize| self.model.candidates()[candidate].effect;
        let short = || way.visited.iter().filter(|own| own.0.len() <= 2);
        let least = short().fold(f64::NEG_INFINITY, |most: f64, own| most.max(own.1));
        let mut known: Vec<&Effect> = Vec::new();
        known.extend(short().filter(|own| own.0.len() == 1).map(|own| effect(own.0[0])));
        let (mut tried, mut pairs) = (0, Vec::new());
        for index in self.likeliest(additions, false) {
            if tried == OTHER_STARTS || additions[index] < NAMED.ln() {
                break;
            }
            if !known.contains(&effect(index)) {
                known.push(effect(index));
                tried += 1;
                let start = self.fit(&[self.model.candidates()[index].neutral(index)]);
                let pair = self.longer(&start, &self.additions(&start), false);
                pairs.extend(pair.filter(|pair| pair.log_probability > least + NO_GAIN));
            }
        }
        pairs
    }

    /// Effects that are named beside a curve, the last of `longer`: what is hidden by something
    /// unknown is seen once that is described. The curve may be another one then.
    fn beside(&self, mut hypothesis: Hypothesis, mut longer: Hypothesis) -> (Hypothesis, Hypothesis) {
        while longer.terms.len() <= MOST {
            let additions = self.additions(&longer);
            let Some(more) = self.longer(&longer, &additions, false) else { break };
            let shared = self.shared(&additions, &more, &longer);
            // a second place of what is named already is that law, not quite right
            let effect = |term: &Term| self.model.candidates()[term.candidate].effect;
            let is_known = |new: &Term| hypothesis.terms.iter().any(|known| effect(known) == effect(new));
            if more.terms.last().is_none_or(is_known)
                || more.log_probability < longer.log_probability + NAMED.ln() - shared
            {
                break;
            }
            let mut terms = more.terms;
            let curve = terms.len() - 2;
            let last = terms.len() - 1;
            terms.swap(curve, last);
            let own = self.fit(&terms);
            hypothesis = self.fit(&terms[..last]);
            longer = match self.longer(&hypothesis, &self.additions(&hypothesis), true) {
                Some(other) if other.log_probability > own.log_probability => other,
                _ => own,
            };
        }
        (hypothesis, longer)
    }

    /// The best hypothesis on the way on from the last of `path`.
    fn along(&self, mut path: Vec<Hypothesis>) -> Way {
        let mut remainders: Vec<Option<(f64, DiscrepancyModel)>> = Vec::new();
        for hypothesis in &path[..path.len() - 1] {
            remainders.push(self.remainder(hypothesis, &self.additions(hypothesis)));
        }
        loop {
            let hypothesis = &path[path.len() - 1];
            let additions = self.additions(hypothesis);
            remainders.push(self.remainder(hypothesis, &additions));
            if hypothesis.terms.len() >= MOST {
                break;
            }
            let Some(longer) = self.longer(hypothesis, &additions, false) else { break };
            let shared = self.shared(&additions, &longer, hypothesis);
            match self.accepted(hypothesis, longer, shared) {
                Some(longer) => path.push(longer),
                None => break,
            }
        }
        let visited = path.iter().map(Visited::new).collect();
        // one of the names may be that of something unknown, which the others hid on the way
        for rest in self.with_one_name_less(&path[path.len() - 1]) {
            let last = path.len() - 1;
            remainders.insert(last, self.remainder(&rest, &self.additions(&rest)));
            path.insert(last, rest);
        }
        let whole = |(hypothesis, remainder): (&Hypothesis, &Option<(f64, DiscrepancyModel)>)| {
            remainder.as_ref().map_or(hypothesis.log_probability, |(log_probability, _)| *log_probability)
        };
        let wholes: Vec<f64> = path.iter().zip(&remainders).map(whole).collect();
        let most = wholes.iter().copied().fold(f64::NEG_INFINITY, f64::max);
        let named = wholes.iter().position(|whole| *whole >= most).unwrap_or_default();
        // what the library explains as well needs nothing unknown
        let last = path.len() - 1;
        if let Some((_, DiscrepancyModel::Curve(longer))) = &remainders[named]
            && path[last].log_probability + AS_WELL.0.ln() > most
            && self.leaves_as_little(&path[last], &path[named], longer)
        {
            let hypothesis = path.swap_remove(last);
            return Way { hypothesis, left_over: None, log_probability: most, visited };
        }
        // beside something unknown a name needs its odds like any other, unless the names explain
        // by themselves what the unknown would in their place
        let explains_as_well = |k: usize| match &remainders[k] {
            Some((whole, DiscrepancyModel::Curve(longer))) => {
                path[named].log_probability + AS_WELL.0.ln() > *whole
                    && self.leaves_as_little(&path[named], &path[k], longer)
            }
            _ => false,
        };
        let has_less = |&k: &usize| {
            remainders[named].is_some()
                && remainders[k].is_some()
                && wholes[k] + NAMED.ln() > most
                && path[k].terms.len() < path[named].terms.len()
                && !explains_as_well(k)
        };
        let named = (0..path.len()).filter(has_less).min_by_key(|&k| path[k].terms.len()).unwrap_or(named);
        let left_over = remainders.swap_remove(named).map(|(_, remainder)| remainder);
        Way { hypothesis: path.swap_remove(named), left_over, log_probability: most, visited }
    }

    /// A hypothesis of several effects without each of those that are physics, or something that
    /// happened to more than a few data.
    fn with_one_name_less(&self, hypothesis: &Hypothesis) -> Vec<Hypothesis> {
        let is_name = |term: &Term| match self.model.candidates()[term.candidate].effect.kind {
            Kind::Physics => true,
            Kind::Event => !self.is_event(term),
            Kind::Mistake => false,
        };
        let count = hypothesis.terms.len();
        let named = (0..count).filter(|&k| count > 1 && is_name(&hypothesis.terms[k]));
        named.map(|position| self.without(hypothesis, position)).collect()
    }

    /// Does a hypothesis leave as little, per degree of freedom, as a curve beside the `shorter`
    /// one does, which has more of them? By chance that leaves less by √(2·more)/2ν, one standard
    /// deviation. Or is what the curve draws better little beside what the names explain: a law
    /// that is not quite the right one?
    fn leaves_as_little(&self, hypothesis: &Hypothesis, shorter: &Hypothesis, longer: &Hypothesis) -> bool {
        let all = self.degrees_of_freedom().max(1) as f64;
        let [left, with_curve, without] = [hypothesis, longer, shorter].map(|own| self.left_rms(own));
        let square = |more: f64, less: f64| more.powi(2) - less.powi(2);
        if square(left, with_curve) < LITTLE.powi(2) * square(without, left) {
            return true;
        }
        let per_freedom =
            |own: &Hypothesis| self.left_rms(own) / (1.0 - own.determined / all).max(f64::EPSILON).sqrt();
        let more = (longer.determined - hypothesis.determined).max(1.0);
        let by_chance = 1.0 + CHANCE * (2.0 * more).sqrt() / (2.0 * all);
        per_freedom(hypothesis) < AS_WELL.1.max(by_chance) * per_freedom(longer)
    }

    /// Ln of how much likelier it is that any effect is there than the likeliest one: several that
    /// explain the same share its odds.
    fn shared(&self, additions: &[f64], longer: &Hypothesis, hypothesis: &Hypothesis) -> f64 {
        let best = longer.log_probability - hypothesis.log_probability;
        let Some(added) = longer.terms.last() else { return 0.0 };
        let others: f64 = (0..additions.len())
            .filter(|&index| index != added.candidate)
            .filter(|&index| !self.model.candidates()[index].is_nonparametric)
            .map(|index| (additions[index].min(best) - best).exp())
            .sum();
        (1.0 + others).ln().min(MOST_SHARED.ln())
    }

    /// Two effects at once, refitted, that are worth more than the price of two names and more than
    /// each of them alone; see [`crate::inference::search::pairs`].
    fn best_pair(&self, none: &Hypothesis, additions: &[f64]) -> Option<Hypothesis> {
        let screened = self.pairs(none, additions);
        let refitted = in_parallel_outside_of_jobs(screened.len(), |k| {
            let (first, second) = screened[k];
            self.fit(&[first, second].map(|index| self.model.candidates()[index].neutral(index)))
        });
        let best = refitted
            .into_iter()
            .reduce(|best, other| if other.log_probability > best.log_probability { other } else { best })?;
        if best.log_probability < none.log_probability + 2.0 * NAMED.ln() {
            return None;
        }
        let best = self.exchanged(best);
        let is_needed = |position: usize| {
            self.without(&best, position).log_probability + NAMED.ln() < best.log_probability
        };
        (best.terms.len() > 1 && (0..best.terms.len()).all(is_needed)).then_some(best)
    }

    /// The longer hypothesis with its effects exchanged for better ones, if each of them is
    /// likelier, by the odds of a name, than chance. Where one alone is not, another one may be
    /// needed with it: two outliers hide each other in the noise that they make.
    fn accepted(&self, hypothesis: &Hypothesis, longer: Hypothesis, shared: f64) -> Option<Hypothesis> {
        let mut longer = longer;
        let mut least = hypothesis.log_probability + NAMED.ln() - shared;
        if longer.log_probability < least
            && longer.log_probability > hypothesis.log_probability + HOPELESS.ln()
        {
            longer = self.longer(&longer, &self.additions(&longer), false)?;
            least += NAMED.ln();
        }
        if longer.log_probability < least {
            return None;
        }
        let longer = self.exchanged(longer);
        // what another one has made superfluous goes
        let rests = (0..longer.terms.len()).map(|position| self.without(&longer, position));
        let likelier = |a: &Hypothesis, b: &Hypothesis| a.log_probability.total_cmp(&b.log_probability);
        let rest = rests.max_by(likelier)?;
        match rest.log_probability + NAMED.ln() - shared < longer.log_probability {
            true => Some(longer),
            false => (rest.log_probability > hypothesis.log_probability + NAMED.ln()).then_some(rest),
        }
    }

    /// What a hypothesis leaves, if that is more than chance.
    pub fn remains(&self, hypothesis: &Hypothesis) -> Option<DiscrepancyModel> {
        self.remainder(hypothesis, &self.additions(hypothesis)).map(|(_, remainder)| remainder)
    }

    /// What a hypothesis leaves, with the ln of the probability of both, if that is more than
    /// chance.
    fn remainder(&self, hypothesis: &Hypothesis, additions: &[f64]) -> Option<(f64, DiscrepancyModel)> {
        let least = hypothesis.log_probability + NAMED.ln();
        let curve = self.longer(hypothesis, additions, true).filter(|longer| longer.log_probability > least);
        let predicted = self.predicted(hypothesis, self.evidence, &self.model.response(&hypothesis.terms));
        let replicates = self.lack_of_fit(hypothesis, &predicted).map_or(f64::NEG_INFINITY, |test| {
            let odds = self.evidence.information * test.log_odds();
            hypothesis.log_probability + odds + (PRIOR.2 / PRIOR.0).ln()
        });
        match curve {
            Some(longer) => Some((longer.log_probability.max(replicates), DiscrepancyModel::Curve(longer))),
            None => (replicates > least).then_some((replicates, DiscrepancyModel::Replicates)),
        }
    }

    /// The hypothesis with one candidate more, the likeliest of those that are unknown or of those
    /// that are not.
    fn longer(&self, hypothesis: &Hypothesis, additions: &[f64], unknown: bool) -> Option<Hypothesis> {
        self.longer_than(f64::NEG_INFINITY, hypothesis, additions, unknown)
    }

    /// The same; none that is clearly less probable than `least`, the ln of a probability.
    fn longer_than(
        &self,
        least: f64,
        hypothesis: &Hypothesis,
        additions: &[f64],
        unknown: bool,
    ) -> Option<Hypothesis> {
        // a scan over places must not crowd out what is at one place only
        let mut tried: Vec<usize> = Vec::new();
        for index in self.likeliest(additions, unknown) {
            // the likeliest may be hopeless too, but nothing behind it needs a fit
            if !tried.is_empty() && additions[index] < HOPELESS.ln() {
                break;
            }
            // nor a form of a law with fewer numbers one with more
            let effect = |candidate: usize| {
                let candidate = &self.model.candidates()[candidate];
                (candidate.effect, if candidate.is_alternative { candidate.parameters.len() } else { 0 })
            };
            let same = tried.iter().filter(|&&other| effect(other) == effect(index)).count();
            if unknown || same < OF_ONE_EFFECT {
                tried.push(index);
            }
            if tried.len() >= REFITTED {
                break;
            }
        }
        let rough = in_parallel_outside_of_jobs(tried.len(), |k| {
            let mut terms = hypothesis.terms.clone();
            terms.push(self.model.candidates()[tried[k]].neutral(tried[k]));
            self.fit_roughly(&terms)
        });
        let best = rough.iter().fold(least, |best, other| best.max(other.log_probability));
        let near: Vec<Hypothesis> =
            rough.into_iter().filter(|other| other.log_probability > best - NEAR).collect();
        let refitted =
            in_parallel_outside_of_jobs(near.len(), |k| match self.model.is_linear_in(&near[k].terms) {
                true => near[k].clone(),
                false => self.fit(&near[k].terms),
            });
        refitted
            .into_iter()
            .reduce(|best, other| if other.log_probability > best.log_probability { other } else { best })
    }

    /// Single effects exchanged for others and taken away while the hypothesis gets more probable:
    /// one after the other, until none of them in turn is better exchanged.
    fn exchanged(&self, mut hypothesis: Hypothesis) -> Hypothesis {
        let (mut position, mut kept, mut exchanges) = (0, 0, 0);
        // a single effect is the best there is
        while hypothesis.terms.len() > 1 && kept < hypothesis.terms.len() && exchanges < MOST_EXCHANGES {
            position %= hypothesis.terms.len();
            let least = hypothesis.log_probability + NO_GAIN;
            let rest = self.without(&hypothesis, position);
            let other = self.longer_than(least, &rest, &self.additions(&rest), false);
            let likelier = |a: &Hypothesis, b: &Hypothesis| a.log_probability.total_cmp(&b.log_probability);
            let best = [Some(rest), other].into_iter().flatten().max_by(likelier);
            match best.filter(|best| best.log_probability > least) {
                Some(better) => {
                    // what is new is the last, and the best there is beside the others
                    kept = usize::from(better.terms.len() == hypothesis.terms.len());
                    (hypothesis, exchanges) = (better, exchanges + 1);
                }
                None => (position, kept) = (position + 1, kept + 1),
            }
        }
        hypothesis
    }
}
