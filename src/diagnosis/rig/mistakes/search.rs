//! Which mistakes of labels, units and files turn readings that fit nothing into readings that fit.
//!
//! A beam search: one mistake, then a second beside each of the best, then a third. A combination
//! is kept where it is a thousand times more probable than the one that it grew from.

use super::lines::Line;
use super::physics::{Physics, Seen, Verdict, View};
use super::possible::PossibleMistake;
use super::relabelling::Relabelling;
use super::rods::Body;
use crate::spatial::Axis;

/// A mistake is named at these odds against all else, physics included: ln 1000.
pub(in crate::diagnosis::rig) const ODDS: f64 = 6.907_755;
/// Another mistake within these odds explains alike: ln 20.
pub(super) const ALIKE: f64 = 2.995_732;
/// A rod is never bent by more than this share of its length, and what it costs to say so: ln.
const BENT: f64 = 0.05;
const BENT_TOO_FAR: f64 = 15.0;
/// How rare any mistake is against none: ln.
pub(in crate::diagnosis::rig) const RARE: f64 = -0.5;
const MOST_MISTAKES: usize = 3;
const BEAM: usize = 6;
/// Share of the squares of the slopes that ordinary physics hardly leaves: 22 % rms.
pub(super) const IMPLAUSIBLE: f64 = 0.05;
/// A channel that shows less than this share of the largest deflection says nothing.
const SHOWN: f64 = 0.03;

/// Lines of readings against a rod and what else it may be.
pub(super) struct LinesOnRod<'a> {
    pub lines: &'a [Line],
    pub pair: &'a [usize],
    pub pairs: &'a [[Option<f64>; 2]],
    pub base: &'a Physics,
    /// Length of the rod, m.
    pub length: f64,
    /// False where the readings are not on the rod at all.
    pub is_possible: bool,
}

/// Mistakes together.
#[derive(Clone)]
pub(super) struct Combination {
    /// Their numbers among the possible ones.
    pub mistakes: Vec<usize>,
    /// What undoes them all.
    pub relabelling: Relabelling,
    pub log_scale: f64,
    /// Ln of its probability, less a constant.
    pub score: f64,
}

impl LinesOnRod<'_> {
    /// True where no ordinary physics would leave so much, so that mistakes are worth a try.
    pub fn is_implausible(&self) -> bool {
        let seen = self.seen(self.base, &Relabelling::default());
        let expected = seen.expected();
        let all: Vec<usize> = (0..self.lines.len()).collect();
        let most = all.iter().map(|&k| self.deflection(k, expected[k])).fold(0.0, f64::max);
        let is_off = |part: &[usize]| {
            let shown = part.iter().map(|&k| self.deflection(k, expected[k])).fold(0.0, f64::max);
            shown > SHOWN * most && self.left(part, &expected, 0.0) > IMPLAUSIBLE
        };
        let lines_where = |is_met: &dyn Fn(&Line) -> bool| -> Vec<usize> {
            all.iter().copied().filter(|&k| is_met(&self.lines[k])).collect()
        };
        !self.is_possible
            || seen.against_the_load() > 0
            || is_off(&all)
            || Axis::ALL.into_iter().any(|axis| {
                is_off(&lines_where(&|line| line.channel == axis))
                    || is_off(&lines_where(&|line| line.axis == axis))
            })
    }

    /// The largest deflection of a line, measured or expected, m.
    fn deflection(&self, line: usize, expected: f64) -> f64 {
        self.lines[line].fit.slope.abs().max(expected.abs()) * self.lines[line].largest_load
    }

    /// Share of the squares of the deflections that is left of some lines; the larger one of
    /// measured and expected counts, so that no unit is favoured.
    pub fn left(&self, part: &[usize], expected: &[f64], log_scale: f64) -> f64 {
        let factor = log_scale.exp();
        let (mut left, mut all) = (0.0, 0.0);
        for &k in part {
            let line = &self.lines[k];
            let off = ((line.fit.slope - factor * expected[k]).abs() - 2.0 * line.fit.error).max(0.0);
            left += (off * line.largest_load).powi(2);
            all += self.deflection(k, factor * expected[k]).powi(2);
        }
        if all > 0.0 { left / all } else { 0.0 }
    }

    /// Share of the squares that is scatter about the lines: what does not follow the load, no
    /// factor cures.
    pub fn scattered(&self, part: &[usize], expected: &[f64], log_scale: f64) -> f64 {
        let all: f64 = part.iter().map(|&k| self.deflection(k, log_scale.exp() * expected[k]).powi(2)).sum();
        let scatter: f64 = part.iter().map(|&k| self.lines[k].fit.scatter.powi(2)).sum();
        if all > 0.0 { scatter / all } else { 0.0 }
    }

    /// What it costs that the readings, once they are corrected, are larger than any that a rod
    /// survives.
    fn bent_too_far(&self, relabelling: &Relabelling) -> f64 {
        let is_too_far = |line: &Line| {
            let reading = relabelling.reading[line.axis.index()][line.channel.index()];
            (line.fit.slope * reading).abs() * line.largest_load > BENT * self.length
        };
        if relabelling.body == 0 && self.lines.iter().any(is_too_far) { BENT_TOO_FAR } else { 0.0 }
    }

    /// What the slopes say of a rod, no mistakes.
    pub fn verdict_of(&self, physics: &Physics) -> Verdict {
        self.seen(physics, &Relabelling::default()).verdict()
    }

    /// Ln of the factor that the lines of some channels have in common, measured over expected.
    pub fn log_scale_of(&self, channels: &[Axis]) -> f64 {
        self.seen(self.base, &Relabelling::default()).log_scale_of(channels)
    }

    /// True where a part that is loose, by nobody knows how much, explains about as much.
    pub fn may_be_loose(&self, mistake: &PossibleMistake) -> bool {
        let verdict = self.seen(self.base, &mistake.relabelling).verdict();
        let loose = self.seen(self.base, &Relabelling::default()).log_evidence_of_loose();
        verdict.log_evidence + RARE + mistake.log_prior < loose + ODDS
    }

    /// The lines with a relabelling undone, beside a rod.
    pub fn seen<'s>(&'s self, physics: &'s Physics, relabelling: &Relabelling) -> Seen<'s> {
        let view = |line: &Line| {
            let (axis, channel) = (line.axis.index(), line.channel.index());
            View {
                channel: Axis::ALL[relabelling.channel[channel]],
                axis: Axis::ALL[relabelling.axis[axis]],
                factor: relabelling.load[axis] / relabelling.reading[axis][channel],
            }
        };
        let views = self.lines.iter().map(view).collect();
        Seen { lines: self.lines, pair: self.pair, physics, views }
    }
}

/// The search for the mistakes that explain these lines.
pub(super) struct MistakeSearch<'a> {
    pub lines: LinesOnRod<'a>,
    /// All that may have been made.
    pub possible: &'a [PossibleMistake],
    /// By number of the body, from 1; `None` where the readings cannot be on it.
    pub bodies: &'a [Option<Physics>],
    /// So many times softer than its file the rod may be beside any of them.
    pub softer: f64,
}

impl MistakeSearch<'_> {
    /// What the rod then is; `None` where the readings cannot be on it.
    pub fn physics(&self, relabelling: &Relabelling) -> Option<&Physics> {
        match relabelling.body {
            0 => Some(self.lines.base),
            number => self.bodies[number - 1].as_ref(),
        }
    }

    /// Mistakes together, where what remains is near to what each of them allows.
    pub fn combination(&self, mistakes: Vec<usize>) -> Option<Combination> {
        let relabelling = self.relabelling(&mistakes)?;
        if relabelling.body == 0 && !self.lines.is_possible {
            let score = f64::NEG_INFINITY;
            return mistakes.is_empty().then_some(Combination {
                mistakes,
                relabelling,
                log_scale: 0.0,
                score,
            });
        }
        let own = self.scored(mistakes, relabelling)?;
        let is_softer = own.log_scale >= 0.0 && own.log_scale <= self.softer.ln();
        let is_near = |&number: &usize| own.log_scale.abs() <= self.possible[number].within.ln();
        (is_softer || own.mistakes.iter().all(is_near)).then_some(own)
    }

    fn gained(after: &Combination, before: &Combination) -> f64 {
        if after.score.is_finite() { after.score - before.score } else { 0.0 }
    }

    /// Mistakes together that explain more than any fewer of them, the likeliest first.
    pub fn likeliest(&self) -> Vec<Combination> {
        let Some(base) = self.combination(Vec::new()) else { return Vec::new() };
        let mut best = base.score;
        let mut frontier = vec![base];
        let mut likeliest: Vec<Combination> = Vec::new();
        for _ in 0..MOST_MISTAKES {
            let mut next: Vec<Combination> = Vec::new();
            for from in &frontier {
                for number in 0..self.possible.len() {
                    let mut mistakes = from.mistakes.clone();
                    if mistakes.contains(&number) {
                        continue;
                    }
                    mistakes.push(number);
                    mistakes.sort_unstable();
                    if next.iter().any(|known| known.mistakes == mistakes) {
                        continue;
                    }
                    next.extend(self.combination(mistakes).filter(|own| Self::gained(own, from) > ODDS));
                }
            }
            next.sort_by(|a, b| b.score.total_cmp(&a.score));
            next.truncate(BEAM);
            match next.first() {
                Some(first) if first.score > best + ODDS => best = first.score,
                _ => break,
            }
            // of as many mistakes the likelier come first, and more where these are needed
            likeliest.splice(0..0, next.iter().cloned());
            frontier = next;
        }
        likeliest
    }

    /// The same without regard to that.
    pub fn without(&self, mistakes: &[usize]) -> Option<Combination> {
        self.scored(mistakes.to_vec(), self.relabelling(mistakes)?)
    }

    /// What undoes all of them; `None` where they contradict each other.
    fn relabelling(&self, mistakes: &[usize]) -> Option<Relabelling> {
        let undone = mistakes.iter().map(|&number| &self.possible[number].relabelling);
        undone.into_iter().try_fold(Relabelling::default(), |all, one| all.and(one))
    }

    /// Mistakes together, however far from 1 the factor is that all lines have in common.
    fn scored(&self, mistakes: Vec<usize>, relabelling: Relabelling) -> Option<Combination> {
        let seen = self.lines.seen(self.physics(&relabelling)?, &relabelling);
        let Verdict { log_evidence, log_scale, .. } = seen.verdict();
        let prior: f64 = mistakes.iter().map(|&number| RARE + self.possible[number].log_prior).sum();
        let score = log_evidence + prior - self.lines.bent_too_far(&relabelling);
        Some(Combination { mistakes, relabelling, log_scale, score })
    }
}

/// The physics of each body; `None` where the readings cannot be on it.
pub(super) fn physics(bodies: &[Body], pairs: &[[Option<f64>; 2]]) -> Vec<Option<Physics>> {
    let of_body = |body: &Body| {
        let pairs: Vec<[Option<f64>; 2]> = pairs
            .iter()
            .map(|[load, read]| [load.map(|s| s * body.stations[0]), read.map(|s| s * body.stations[1])])
            .collect();
        let tip = body.rod.length() + crate::units::UM;
        let is_on_it = pairs.iter().flatten().flatten().all(|station| *station <= tip);
        let physics = Physics::new(&body.rod, &pairs).ok().filter(|_| is_on_it)?;
        (0..pairs.len()).all(|pair| physics.compliance(pair).iter().all(|c| c.is_finite())).then_some(physics)
    };
    bodies.iter().map(of_body).collect()
}
