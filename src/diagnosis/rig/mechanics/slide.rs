//! Friction and play along a recording: what they do depends on which way it went before.
//!
//! ```text
//! load driven          g ← min(max(g, F − f), F + f)                       play operator: the force that the rod feels
//! displacement driven  x ← min(max(x, u − p), u + p)                       play operator: the rod behind its play
//!                      s ← min(max(s, x − q), x + q)                       the slider behind a play of its own
//!                      z ← min(max(z + Δs/d, −1), 1)                       stop operator: friction, d its presliding travel
//!                      F = x/C + f·z in contact, 0 in the gap; no friction in the slider's gap
//! ```
//!
//! f the friction, p the play, q that of the slider alone, C the compliance. Within its play a rod
//! stays where friction holds it, |x| ≤ f·C, and returns as far as that by itself. Without
//! presliding z is the direction of motion. Sources: A. Visintin, *Differential Models of
//! Hysteresis*, 1994, ch. III; J. Awrejcewicz, P. Olejnik, *Appl. Mech. Rev.* 58 (2005) 389–411
//! (dry friction).

use super::load_history::{instants, runs};
use crate::diagnosis::rig::numbering::numbered;
use crate::diagnosis::rig::recording::datum::Datum;

/// Share of a play over which a contact is made, at most.
const RAMP: f64 = 0.3;
/// Rounding of a contact, as a share of the play.
const TOUCHING: f64 = 1e-9;

/// Which data follow which.
#[derive(Debug, Clone, Default)]
pub struct Course {
    /// Runs, where friction follows the direction of motion, as instants of data.
    pub hung: Vec<Vec<Vec<usize>>>,
    /// Imposed displacements of one sensor in one run, in their order.
    pub imposed: Vec<Vec<usize>>,
    /// Each datum that was read beside an imposed displacement, and the datum of that one: the
    /// largest of its instant.
    pub beside: Vec<(usize, usize)>,
}

impl Course {
    pub fn of(data: &[Datum]) -> Course {
        let mut course = Course::default();
        for run in runs(data) {
            let imposed: Vec<usize> = run.iter().copied().filter(|&i| data[i].imposed.is_some()).collect();
            let sensors = numbered(imposed.iter().map(|&i| data[i].stations()));
            for sensor in 0..sensors.iter().max().map_or(0, |last| last + 1) {
                let of_sensor = imposed.iter().zip(&sensors).filter(|(_, own)| **own == sensor);
                course.imposed.push(of_sensor.map(|(&i, _)| i).collect());
            }
            for instant in instants(data, &run) {
                let size = |i: usize| data[i].imposed.map(|imposed| imposed.displacement.abs());
                let sized = instant.iter().filter_map(|&i| Some((i, size(i)?)));
                let Some((largest, _)) = sized.max_by(|a, b| a.1.total_cmp(&b.1)) else { continue };
                let others = instant.iter().filter(|&&i| data[i].imposed.is_none());
                course.beside.extend(others.map(|&i| (i, largest)));
            }
            if imposed.is_empty() && run.iter().any(|&i| data[i].motion.is_some()) {
                course.hung.push(instants(data, &run));
            }
        }
        course
    }
}

/// Friction and play of a hung load: the force that the rod feels, and to which side of its play it
/// leans.
#[derive(Debug, Clone, Copy, Default)]
pub struct Hung {
    /// Along the positive axis, N.
    pub force: f64,
    /// 1, −1, or 0 where nothing is felt.
    pub side: f64,
}

impl Hung {
    /// After a load `load` (N, along the positive axis) with the friction `friction` (N).
    pub fn next(self, load: f64, friction: f64) -> Hung {
        let force = self.force.max(load - friction).min(load + friction);
        Hung { force, side: if force == 0.0 { 0.0 } else { force.signum() } }
    }
}

/// What an imposed displacement meets.
#[derive(Debug, Clone, Copy, Default)]
pub struct Met {
    /// Displacement of the rod behind its play, m.
    pub rod: f64,
    /// Displacement of the slider, m.
    slider: f64,
    /// Which way friction would act in contact, −1 to 1.
    turned: f64,
    /// Force of friction over its largest, −1 to 1.
    pub friction: f64,
    /// 1, or 0 in the gap, and between them where the contact is just made.
    pub contact: f64,
}

impl Met {
    /// The same where the rod is not bent.
    pub fn unbent(&self) -> Met {
        Met { rod: 0.0, ..*self }
    }
}

/// Play and friction as an imposed displacement meets them.
#[derive(Debug, Clone, Copy)]
pub struct Slide {
    /// Play on either side, m.
    pub play: f64,
    /// Play of the slider on either side, m.
    pub slider_play: f64,
    /// Presliding travel, m; 0: friction turns round at once.
    pub presliding: f64,
    /// Where friction still holds the rod against its own stiffness: f·C, m.
    pub held: f64,
    /// Over so much travel at most a contact is made, m: the usual step from reading to reading.
    pub step: f64,
}

impl Slide {
    /// After a displacement `u` (m), moved to in `direction` (1, −1, 0 at rest).
    pub fn next(&self, met: Met, u: f64, direction: f64) -> Met {
        let rod = match self.play > 0.0 {
            true => met.rod.max(-self.held).min(self.held).max(u - self.play).min(u + self.play),
            false => u,
        };
        let slider = met.slider.max(rod - self.slider_play).min(rod + self.slider_play);
        let turned = match self.presliding > 0.0 {
            true => (met.turned + (slider - met.slider) / self.presliding).clamp(-1.0, 1.0),
            false => direction,
        };
        Met {
            rod,
            slider,
            turned,
            friction: turned * self.contact(self.slider_play, rod - slider, direction),
            contact: self.contact(self.play, u - rod, direction),
        }
    }

    /// Contact across a play where one side is `ahead` of the other, moved in `direction`: 1, or 0
    /// in the gap.
    fn contact(&self, play: f64, ahead: f64, direction: f64) -> f64 {
        let depth = ahead.abs() - play;
        let ramp = self.step.min(RAMP * play);
        if depth >= -TOUCHING * play {
            1.0
        } else if direction * ahead > 0.0 && ramp > 0.0 {
            // the last piece of the gap belongs to the contact ahead, in part: what is measured
            // then changes with the play without a jump
            (1.0 + depth / ramp).max(0.0)
        } else {
            0.0
        }
    }
}

/// The usual step of an imposed displacement from reading to reading, m.
pub fn usual_step(data: &[Datum], course: &Course) -> f64 {
    let steps = course.imposed.iter().flat_map(|line| {
        line.windows(2).map(|pair| (data[pair[1]].drive() - data[pair[0]].drive()).abs()).collect::<Vec<_>>()
    });
    let mut steps: Vec<f64> = steps.filter(|step| *step > 0.0).collect();
    steps.sort_by(f64::total_cmp);
    steps.get(steps.len() / 2).copied().unwrap_or_default()
}

#[cfg(test)]
mod tests {
    use super::*;

    fn through(slide: Slide, path: &[f64]) -> Vec<(f64, f64, f64)> {
        let (mut met, mut before) = (Met::default(), 0.0);
        let next = |&u: &f64| {
            let direction = if u > before { 1.0 } else { -1.0 };
            before = u;
            met = slide.next(met, u, direction);
            (met.rod, met.friction, met.contact)
        };
        path.iter().map(next).collect()
    }

    /// A hung load is held back on the way up and on the way down, and nothing moves within 2f of a
    /// turn.
    #[test]
    fn friction_lags_behind_a_hung_load() {
        let mut hung = Hung::default();
        let felt: Vec<f64> = [0.5, 5.0, 10.0, 9.0, 8.5, 5.0, 0.0, -5.0]
            .map(|load| {
                hung = hung.next(load, 1.0);
                hung.force
            })
            .into();
        assert_eq!(felt, [0.0, 4.0, 9.0, 9.0, 9.0, 6.0, 1.0, -4.0]);
        assert_eq!(hung.side, -1.0);
    }

    #[test]
    fn a_free_rod_returns_to_the_middle_of_its_play_and_a_held_one_stays() {
        let slide = Slide { play: 1.0, slider_play: 0.0, presliding: 0.0, held: 0.0, step: 0.0 };
        let rod = |slide: Slide| -> Vec<f64> {
            through(slide, &[3.0, 5.0, 3.0, 0.5, -0.5, -3.0]).iter().map(|met| met.0).collect()
        };
        assert_eq!(rod(slide), [2.0, 4.0, 2.0, 0.0, 0.0, -2.0]);
        assert_eq!(rod(Slide { held: 9.0, ..slide }), [2.0, 4.0, 4.0, 1.5, 0.5, -2.0]);
        // what is within the gap touches nothing
        let gap = Slide { held: 9.0, step: 0.1, ..slide };
        let contact: Vec<f64> = through(gap, &[3.0, 5.0, 4.0, 2.5, 0.0]).iter().map(|met| met.2).collect();
        assert_eq!(contact, [1.0, 1.0, 0.0, 1.0, 1.0]);
    }

    #[test]
    fn presliding_is_travelled_before_friction_has_turned_round() {
        let slide = Slide { play: 0.0, slider_play: 0.0, presliding: 0.5, held: 0.0, step: 0.0 };
        let friction: Vec<f64> =
            through(slide, &[0.25, 2.0, 1.5, 1.25, 0.0]).iter().map(|met| met.1).collect();
        assert_eq!(friction, [0.5, 1.0, 0.0, -0.5, -1.0]);
        let at_once = Slide { presliding: 0.0, ..slide };
        assert_eq!(through(at_once, &[0.25, 0.2]), [(0.25, 1.0, 1.0), (0.2, -1.0, 1.0)]);
        // a slider with a play of its own: no friction in its gap, and the rod is bent all the same
        let loose = Slide { slider_play: 0.5, step: 0.0, ..at_once };
        let path = [1.0, 2.0, 1.5, 1.25, 1.0, 0.0];
        let met = [(1.0, 1.0), (2.0, 1.0), (1.5, 0.0), (1.25, 0.0), (1.0, -1.0), (0.0, -1.0)];
        let found: Vec<(f64, f64)> = through(loose, &path).iter().map(|met| (met.0, met.1)).collect();
        assert!(found.iter().zip(met).all(|(found, met)| found.0 == met.0 && found.1 == met.1), "{found:?}");
    }
}
