//! What a rig remembers of its loads: friction that has to turn round, creep by a chain of springs
//! and dampers, hysteresis by plays.

/// Friction by P. R. Dahl's model (*A solid friction model*, TOR-0158(3107–18)-1, 1968): on its way
/// the slide's resistance goes to ±f exponentially with the distance travelled since it turned,
///
/// z → ±f + (z ∓ f)·exp(−|travel|/presliding).
pub fn friction_after(z: f64, force: f64, travel: f64, presliding: f64) -> f64 {
    let goal = force * travel.signum();
    if travel == 0.0 { z } else { goal + (z - goal) * (-travel.abs() / presliding).exp() }
}

/// z of the equation of R. Bouc (1967) and Y.-K. Wen (J. Eng. Mech. Div. ASCE 102, 1976) after a
/// change of x, by Euler's method in small steps:
///
/// dz/dx = 1 − (s·sgn(z·dx) + 1 − s)·|z/r|ⁿ
pub fn slipped_after(mut z: f64, change: f64, (r, n, s): (f64, f64, f64)) -> f64 {
    const STEPS: usize = 2000;
    let step = change / STEPS as f64;
    for _ in 0..STEPS {
        let along = if z * change < 0.0 { 1.0 - 2.0 * s } else { 1.0 };
        z += step * (1.0 - along * (z / r).abs().powf(n));
    }
    z
}

/// Decades of relaxation times in the chain, and elements in each.
const DECADES: usize = 6;
const PER_DECADE: usize = 2;

/// Creep compliance, relative to the elastic one, a time t (s) after a load came: a Prony series of
/// Kelvin elements,
///
/// J(t) = (k/m)·Σ (1 − exp(−t/τᵢ)), τᵢ = τ₀·10^(i/m), m in each decade,
///
/// which grows by k in every decade of time between the first and the last relaxation time.
pub fn creep_compliance(per_decade: f64, shortest: f64) -> impl Fn(f64) -> f64 {
    let rate = |i: usize| -1.0 / (shortest * 10f64.powf(i as f64 / PER_DECADE as f64));
    let rates: Vec<f64> = (0..=DECADES * PER_DECADE).map(rate).collect();
    move |t| {
        let all = || rates.iter().map(|rate| 1.0 - (rate * t).exp()).sum::<f64>();
        if t > 0.0 { per_decade / PER_DECADE as f64 * all() } else { 0.0 }
    }
}

/// Play operators with thresholds spread evenly from 0 to half of the largest load.
const PLAYS: usize = 32;

/// Hysteresis of Prandtl and Ishlinskii (A. Visintin, *Differential Models of Hysteresis*, ch.
/// III):
///
/// out = (1 − 2h)·F + (8h/F_max)·∫₀^(F_max/2) p_r[F] dr,   p_r ← max(F − r, min(F + r, p_r))
///
/// A rod that was loaded to F_max before follows F − 2h·F·(1 − F/F_max) up and F + 2h·F·(1 −
/// F/F_max) down: the loop is closed at both ends and at half load as wide as the share h of F_max.
/// A virgin one does not come back to zero.
#[derive(Debug, Clone)]
pub struct Plays {
    fraction: f64,
    largest: f64,
    plays: [f64; PLAYS],
}

impl Plays {
    /// Of this loop width, for loads up to `largest`.
    pub fn new(fraction: f64, largest: f64, is_exercised: bool) -> Self {
        let mut plays = Plays { fraction, largest, plays: [0.0; PLAYS] };
        if is_exercised {
            plays.load(largest);
            plays.load(0.0);
        }
        plays
    }

    /// The load that is felt when `force` hangs there, N.
    pub fn load(&mut self, force: f64) -> f64 {
        let step = self.largest / 2.0 / PLAYS as f64;
        for (k, play) in self.plays.iter_mut().enumerate() {
            let r = (k as f64 + 0.5) * step;
            *play = (force - r).max((force + r).min(*play));
        }
        let integral = self.plays.iter().sum::<f64>() * step;
        (1.0 - 2.0 * self.fraction) * force + 8.0 * self.fraction / self.largest * integral
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn creep_grows_by_its_share_in_every_decade() {
        let at = creep_compliance(0.03, 1.0);
        assert!((at(1e4) - at(1e3) - 0.03).abs() < 1e-3);
        assert!((at(1e3) - at(1e2) - 0.03).abs() < 1e-3);
        assert_eq!(at(0.0), 0.0);
    }

    #[test]
    fn friction_turns_round_within_its_presliding() {
        let up = friction_after(0.0, 1.0, 100e-6, 5e-6);
        assert!((up - 1.0).abs() < 1e-6);
        let turning = friction_after(up, 1.0, -5e-6, 5e-6);
        assert!(turning < 0.0 && turning > -0.5);
        assert!((friction_after(up, 1.0, -100e-6, 5e-6) + 1.0).abs() < 1e-6);
        assert_eq!(friction_after(0.3, 1.0, 0.0, 5e-6), 0.3);
    }

    #[test]
    fn an_exercised_loop_is_closed_and_as_wide_as_it_says() {
        let mut plays = Plays::new(0.05, 20.0, true);
        let zero = plays.load(0.0);
        let up = plays.load(10.0) - zero;
        let top = plays.load(20.0) - zero;
        let down = plays.load(10.0) - zero;
        let back = plays.load(0.0) - zero;
        assert!((down - up - 0.05 * 20.0).abs() < 0.01, "{up} {down}");
        assert!(back.abs() < 1e-12, "{back}");
        assert!((up + down - 20.0).abs() < 0.05 && (top - 20.0).abs() < 0.05, "{up} {down} {top}");
    }

    #[test]
    fn a_virgin_rod_does_not_come_back() {
        let mut plays = Plays::new(0.05, 20.0, false);
        assert_eq!(plays.load(0.0), 0.0);
        plays.load(20.0);
        assert!(plays.load(0.0) > 0.2);
    }
}
