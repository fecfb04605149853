//! What a law of a rod's file remembers.

/// Shares that were written with eight digits.
const ROUNDING: f64 = 1e-6;

/// How what went before acts.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
#[non_exhaustive]
pub enum LawMemory {
    /// The formula's variable is what a play leaves of it; the constant `r` is half the play's
    /// width, in the unit of the variable.
    Stop,
    /// The formula's variable is where a play leaves it; the constant `r` is half the play's width.
    Play,
    /// The formula's variable is what two plays leave of it: the share `w1` of the one of half
    /// width `r1`, all else of that of half width `r`.
    TwoStops,
    /// The same of three plays, `r1` with `w1`, `r2` with `w2`, and `r`.
    ThreeStops,
    /// The formula's variable is z of a Bouc–Wen loop, dz/dx = 1 − (s·sgn(z·dx) + 1 − s)·|z/r|ⁿ;
    /// the constants `r`, in the unit of the variable, `n` and `s` = β/(β + γ).
    BoucWen,
    /// The formula's variable is what it lacks of its lagged self; the constant `tau` is the lag's
    /// time, s.
    Lag,
}

/// A constant that a memory needs.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct MemoryConstant {
    /// In files.
    pub name: &'static str,
    /// Its least and largest value; nothing where all above 0 are possible.
    pub range: Option<(f64, f64)>,
}

impl MemoryConstant {
    /// True for a value that it can have.
    pub fn may_be(&self, value: f64) -> bool {
        match self.range {
            None => value > 0.0,
            Some((low, high)) => low <= value && value <= high,
        }
    }

    /// `r > 0`, `n from 1 to 8`.
    pub fn description(&self) -> String {
        match self.range {
            None => format!("{} > 0", self.name),
            Some((low, high)) => format!("{} from {low} to {high}", self.name),
        }
    }
}

impl LawMemory {
    /// All of them.
    pub const ALL: [LawMemory; 6] = [
        LawMemory::Stop,
        LawMemory::Play,
        LawMemory::TwoStops,
        LawMemory::ThreeStops,
        LawMemory::BoucWen,
        LawMemory::Lag,
    ];

    /// In files.
    pub fn key(self) -> &'static str {
        match self {
            LawMemory::Stop => "stop",
            LawMemory::Play => "play",
            LawMemory::TwoStops => "two_stops",
            LawMemory::ThreeStops => "three_stops",
            LawMemory::BoucWen => "bouc_wen",
            LawMemory::Lag => "lag",
        }
    }

    /// All keys, in a sentence: `"stop", "play" or "lag"`.
    pub fn keys() -> String {
        let quoted: Vec<String> =
            LawMemory::ALL.iter().map(|memory| format!("\"{}\"", memory.key())).collect();
        match quoted.split_last() {
            Some((last, others)) => format!("{} or {last}", others.join(", ")),
            None => String::new(),
        }
    }

    /// What its constants, each possible by itself, would have to be together; `None` if they are.
    pub fn amiss(self, own: impl Fn(&str) -> f64) -> Option<&'static str> {
        let is_wider = |wide: &str, narrow: &str| own(wide) >= own(narrow);
        match self {
            LawMemory::TwoStops if !is_wider("r", "r1") => Some("r1 up to r"),
            LawMemory::ThreeStops if !(is_wider("r", "r2") && is_wider("r2", "r1")) => {
                Some("r1 up to r2, and r2 up to r")
            }
            LawMemory::ThreeStops if own("w1") + own("w2") > 1.0 + ROUNDING => Some("w1 + w2 up to 1"),
            _ => None,
        }
    }

    /// What it makes of the variable, after a law.
    pub(super) fn description(self) -> &'static str {
        match self {
            LawMemory::Stop => ", of what a play leaves of it",
            LawMemory::Play => ", of where a play leaves it",
            LawMemory::TwoStops => ", of what two plays leave of it",
            LawMemory::ThreeStops => ", of what three plays leave of it",
            LawMemory::BoucWen => ", of what a Bouc–Wen loop makes of it",
            LawMemory::Lag => ", of what it lacks of its lagged self",
        }
    }

    /// The constants that are its own.
    pub fn constants(self) -> &'static [MemoryConstant] {
        const fn own(name: &'static str, range: Option<(f64, f64)>) -> MemoryConstant {
            MemoryConstant { name, range }
        }
        const R: MemoryConstant = own("r", None);
        const FIRST: [MemoryConstant; 2] = [own("r1", None), own("w1", Some((0.0, 1.0)))];
        const SECOND: [MemoryConstant; 2] = [own("r2", None), own("w2", Some((0.0, 1.0)))];
        match self {
            LawMemory::Stop | LawMemory::Play => &[R],
            LawMemory::TwoStops => const { &[R, FIRST[0], FIRST[1]] },
            LawMemory::ThreeStops => const { &[R, FIRST[0], FIRST[1], SECOND[0], SECOND[1]] },
            LawMemory::BoucWen => const { &[R, own("n", Some((1.0, 8.0))), own("s", Some((0.5, 1.0)))] },
            LawMemory::Lag => const { &[own("tau", None)] },
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn stops_are_in_their_order() {
        let three = |r1: f64, r2: f64, w2: f64| {
            LawMemory::ThreeStops.amiss(|name| match name {
                "r1" => r1,
                "r2" => r2,
                "w2" => w2,
                "w1" => 0.5,
                _ => 3.0,
            })
        };
        assert_eq!((three(1.0, 2.0, 0.5), three(1.0, 2.0, 0.6)), (None, Some("w1 + w2 up to 1")));
        assert!(three(2.5, 2.0, 0.2).is_some() && three(1.0, 3.5, 0.2).is_some());
        assert_eq!(LawMemory::Stop.amiss(|_| 1.0), None);
    }

    #[test]
    fn keys_are_a_sentence() {
        assert!(
            LawMemory::keys().starts_with("\"stop\", \"play\", ")
                && LawMemory::keys().ends_with(" or \"lag\"")
        );
    }
}
