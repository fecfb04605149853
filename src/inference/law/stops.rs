//! Several stop operators side by side (L. Prandtl 1928; A. Yu. Ishlinskii 1944): a part that slips
//! at a few places, each at a load of its own.
//!
//! ```text
//! S[x] = Σ w_k·(x − P_{r_k}[x]),   Σ w_k = 1,   r_1 < r_2 < … < r
//! ```
//!
//! P_r is a play of half width r. At first S grows as x does; from each r_k on by w_k less, and
//! twice as far on the way back (G. Masing 1926). With many of them any such loop can be drawn: two
//! or three are a law, more are a curve.

/// Most of them.
pub(super) const MOST: usize = 3;

/// Widths and slopes of the narrower ones, as shares of the widest and of the whole.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Stops {
    count: usize,
    widths: [f64; MOST],
    shares: [f64; MOST],
}

/// A width as a share of the next wider one: nearer to it they are one, and a much narrower one has
/// slipped before the first reading.
const RATIO: (f64, f64) = (0.03, 0.97);
const SHARE: (f64, f64) = (0.0, 1.0);
/// Those of a first look.
const RATIOS: [f64; 2] = [0.25, 0.6];
const SHARES: [f64; 2] = [0.35, 0.7];

impl Stops {
    /// Two and three, in the middle of what is possible.
    pub const TWO: Stops = Stops { count: 2, widths: [0.5, 1.0, 1.0], shares: [0.5, 0.5, 0.0] };
    /// See [`Stops::TWO`].
    pub const THREE: Stops = Stops { count: 3, widths: [0.25, 0.5, 1.0], shares: [0.4, 0.3, 0.3] };

    /// The narrower ones from the narrowest on: width as a share of the widest, share of the whole
    /// slope; as far as that is possible, and two at least.
    pub fn new(narrower: &[(f64, f64)]) -> Stops {
        let mut all = Stops { count: narrower.len().clamp(1, MOST - 1) + 1, ..Stops::TWO };
        let mut rest = 1.0;
        for k in 0..all.count - 1 {
            let (width, share) = narrower.get(k).copied().unwrap_or((all.widths[k], 0.0));
            (all.widths[k], all.shares[k]) = (width.clamp(0.0, 1.0), share.clamp(0.0, rest));
            rest -= all.shares[k];
        }
        (all.widths[all.count - 1], all.shares[all.count - 1]) = (1.0, rest);
        all
    }

    /// How many.
    pub fn count(&self) -> usize {
        self.count
    }

    /// Those that are not the widest, from the narrowest on: width as a share of the widest, share
    /// of the whole slope.
    pub fn narrower(&self) -> impl Iterator<Item = (f64, f64)> + '_ {
        self.widths.iter().copied().zip(self.shares).take(self.count - 1)
    }

    /// Numbers whose prior is even: each width as a share of the next wider one, then each share of
    /// what the narrower ones leave.
    pub(super) fn numbers(&self) -> Vec<f64> {
        let narrower = self.count - 1;
        let mut rest = 1.0;
        let ratios = (0..narrower).map(|k| self.widths[k] / self.widths[k + 1]);
        let mut numbers: Vec<f64> = ratios.collect();
        for share in &self.shares[..narrower] {
            numbers.push(if rest > 0.0 { share / rest } else { 0.0 });
            rest -= share;
        }
        numbers
    }

    /// Of such numbers.
    pub(super) fn of_numbers(numbers: &[f64]) -> Stops {
        let (ratios, shares) = numbers.split_at(numbers.len() / 2);
        let (mut rest, mut narrower) = (1.0, Vec::with_capacity(ratios.len()));
        for (k, share) in shares.iter().enumerate() {
            narrower.push((ratios[k..].iter().product(), share * rest));
            rest *= 1.0 - share;
        }
        Stops::new(&narrower)
    }

    /// From where to where its numbers may be.
    pub(super) fn ranges(&self) -> Vec<(f64, f64)> {
        let narrower = self.count - 1;
        [vec![RATIO; narrower], vec![SHARE; narrower]].concat()
    }

    /// As many of them for a first look: all ratios alike, all shares alike.
    pub(super) fn first(&self) -> Vec<Stops> {
        let narrower = self.count - 1;
        let alike = |ratio: f64| SHARES.map(|share| [vec![ratio; narrower], vec![share; narrower]].concat());
        RATIOS.into_iter().flat_map(alike).map(|numbers| Stops::of_numbers(&numbers)).collect()
    }

    /// S at x, `half` the half width of the widest, `plays` where each play is.
    pub(super) fn follow(&self, plays: &mut [f64; MOST], x: f64, half: f64) -> f64 {
        let mut sum = 0.0;
        for ((play, width), share) in plays.iter_mut().zip(self.widths).zip(self.shares).take(self.count) {
            // a play moves only where its edge is met
            *play = play.clamp(x - half * width, x + half * width);
            sum += share * (x - *play);
        }
        sum
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Half slips at 1, the other half at 4: slope 1, ½ and 0, and twice as far on the way back.
    #[test]
    fn each_slips_at_its_own_width() {
        let stops = Stops::new(&[(0.25, 0.5)]);
        let mut plays = [0.0; MOST];
        let way = [0.5, 1.0, 2.0, 4.0, 9.0, 8.0, 7.0, 5.0, 1.0, 0.0];
        let followed = way.map(|x| stops.follow(&mut plays, x, 4.0));
        assert_eq!(followed, [0.5, 1.0, 1.5, 2.5, 2.5, 1.5, 0.5, -0.5, -2.5, -2.5]);
    }

    #[test]
    fn numbers_are_those_of_the_stops() {
        for stops in Stops::TWO.first().into_iter().chain(Stops::THREE.first()) {
            let again = Stops::of_numbers(&stops.numbers());
            assert_eq!(again.count(), stops.count());
            let pairs = || again.narrower().zip(stops.narrower());
            assert!(pairs().all(|(a, b)| (a.0 - b.0).abs() < 1e-12 && (a.1 - b.1).abs() < 1e-12));
            let within = |(number, (low, high)): (f64, (f64, f64))| low <= number && number <= high;
            assert!(stops.numbers().into_iter().zip(stops.ranges()).all(within));
        }
        // what the first takes is not left for the second
        let two: Vec<(f64, f64)> = Stops::new(&[(0.2, 0.8), (0.5, 0.7)]).narrower().collect();
        assert!((two[1].1 - 0.2).abs() < 1e-12, "{two:?}");
    }
}
