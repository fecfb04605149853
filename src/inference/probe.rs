use super::background;
use super::linearised::Linearised;
use super::pruning::{infer, settled};
use super::search::Search;
use super::selection::Pairs;
use super::{Evidence, ForwardModel, Term};
pub fn probe(model: &dyn ForwardModel, evidence: &Evidence, sets: &str) {
    let model = &Linearised::new(model);
    let folded = background::folded(evidence);
    let (settled, known) = settled(model, &folded.evidence);
    let model = &model.in_parts(&settled, &settled.fold);
    let (search, best, _) = infer(model, &settled, Pairs::Screened, known);
    println!("ratio {} corr {} best {:.2} sigma {:.3e}", search.shared_ratio(), 0, best.log_probability, best.sigma);
    let show = |search: &Search, h: &super::Hypothesis| {
        println!("  logp {:.2} sigma {:.4e} determined {:.1}", h.log_probability, h.sigma, h.determined);
        let mut at = 0;
        for t in &h.terms {
            let c = &search.model.candidates()[t.candidate];
            let v: Vec<String> = c.parameters.iter().zip(&t.values).enumerate().map(|(k, (p, v))| format!("{}={:.4}±{:.4}", p.name, v / p.unit, h.covariance[(at + k, at + k)].max(0.0).sqrt() / p.unit)).collect();
            at += t.values.len();
            println!("     {} | {} | {} prior {:.2}", c.effect.name, c.location, v.join(" "), search.prior_of(t.candidate));
        }
    };
    show(&search, &best);
    for set in sets.split(';') {
        let mut terms: Vec<Term> = Vec::new();
        for name in set.split('+') {
            if name.is_empty() { continue; }
            let (effect, place) = name.split_once('@').unwrap_or((name, ""));
            // best candidate of the effect matching
            let now = search.fit(&terms);
            let mut best: Option<(f64, Vec<Term>)> = None;
            for (k, c) in search.model.candidates().iter().enumerate() {
                if c.effect.name != effect || !c.location.to_string().contains(place) { continue; }
                if now.terms.iter().any(|t| t.candidate == k) { continue; }
                let h = search.with(&now, k);
                if best.as_ref().is_none_or(|b| h.log_probability > b.0) { best = Some((h.log_probability, h.terms.clone())); }
            }
            match best { Some((_, t)) => terms = t, None => println!("no candidate {name}") }
        }
        println!("{set}");
        show(&search, &search.fit(&terms));
    }
}
