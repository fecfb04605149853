//! A share of cases with its interval.

use std::fmt;

use serde::{Serialize, Serializer};
use serde_json::json;

/// Quantile of the normal distribution for 95 %.
const Z: f64 = 1.959_964;

/// So many of so many.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq)]
pub struct Rate {
    /// Cases of which it is so.
    pub count: usize,
    /// Cases that were counted.
    pub total: usize,
}

impl Rate {
    /// Counts one more case.
    pub fn add(&mut self, is_so: bool) {
        self.total += 1;
        self.count += usize::from(is_so);
    }

    /// Of cases.
    pub fn of<T>(cases: impl IntoIterator<Item = T>, is_so: impl Fn(T) -> bool) -> Rate {
        let mut rate = Rate::default();
        cases.into_iter().for_each(|case| rate.add(is_so(case)));
        rate
    }

    /// The share; `None` of nothing.
    pub fn share(&self) -> Option<f64> {
        (self.total > 0).then(|| self.count as f64 / self.total as f64)
    }

    /// Its 95 % interval (E. B. Wilson, *JASA* 22 (1927) 209).
    pub fn interval(&self) -> Option<[f64; 2]> {
        let (p, n) = (self.share()?, self.total as f64);
        let centre = p + Z * Z / (2.0 * n);
        let half = Z * (p * (1.0 - p) / n + Z * Z / (4.0 * n * n)).sqrt();
        let scale = 1.0 + Z * Z / n;
        Some([((centre - half) / scale).max(0.0), ((centre + half) / scale).min(1.0)])
    }
}

/// `{"count", "of", "share", "lo", "hi"}`.
impl Serialize for Rate {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        let [lo, hi] = self.interval().map_or([None; 2], |[lo, hi]| [Some(lo), Some(hi)]);
        json!({"count": self.count, "of": self.total, "share": self.share(), "lo": lo, "hi": hi})
            .serialize(serializer)
    }
}

/// `12 of 40, 30.0 % (18.1 to 45.4)`.
impl fmt::Display for Rate {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let (Some(share), Some([lo, hi])) = (self.share(), self.interval()) else {
            return f.write_str("no case");
        };
        let [share, lo, hi] = [share, lo, hi].map(|part| 100.0 * part);
        write!(f, "{} of {}, {share:.1} % ({lo:.1} to {hi:.1})", self.count, self.total)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_interval_is_wilsons() {
        // R. G. Newcombe, Statistics in Medicine 17 (1998) 857, Table I: 15 of 148
        let [lo, hi] = Rate { count: 15, total: 148 }.interval().unwrap();
        assert!((lo - 0.0624).abs() < 5e-5 && (hi - 0.1605).abs() < 5e-5, "{lo} {hi}");
        assert_eq!(Rate::default().interval(), None);
        assert_eq!(Rate { count: 0, total: 20 }.interval().unwrap()[0], 0.0);
    }
}
