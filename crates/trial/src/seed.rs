//! The number from which every random number of a trial comes.

use std::fmt::{Display, Formatter};
use std::str::FromStr;

use rodcal_base::error::Result;
use rodcal_base::statistics::Random;
use serde::{Deserialize, Deserializer, Serialize, Serializer};

/// A seed of up to 128 bits. Whoever guesses it can make the key.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Seed(pub u128);

impl Seed {
    /// One that nobody guesses.
    ///
    /// # Errors
    /// [`rodcal_base::Error::Numerical`] where the operating system has no random numbers.
    pub fn secret() -> Result<Seed> {
        Random::secret_seed().map(Seed)
    }

    /// Whether so few numbers are as small that all of them can be tried out: below 2⁶⁴.
    pub fn is_small(self) -> bool {
        u64::try_from(self.0).is_ok()
    }
}

/// As it may be given: 64 bits in decimal digits, more in hexadecimal ones.
impl Display for Seed {
    fn fmt(&self, f: &mut Formatter<'_>) -> std::fmt::Result {
        match self.is_small() {
            true => write!(f, "{}", self.0),
            false => write!(f, "{:#x}", self.0),
        }
    }
}

impl FromStr for Seed {
    type Err = String;

    fn from_str(text: &str) -> std::result::Result<Seed, String> {
        let number = match text.strip_prefix("0x") {
            Some(digits) => u128::from_str_radix(digits, 16),
            None => text.parse(),
        };
        number
            .map(Seed)
            .map_err(|_| "expected a whole number from 0 to 2^128 - 1, or 0x and hexadecimal digits".into())
    }
}

// a number where JSON has it, else as text: its readers know 64 bits
impl Serialize for Seed {
    fn serialize<S: Serializer>(&self, serializer: S) -> std::result::Result<S::Ok, S::Error> {
        match u64::try_from(self.0) {
            Ok(short) => serializer.serialize_u64(short),
            Err(_) => serializer.collect_str(self),
        }
    }
}

impl<'de> Deserialize<'de> for Seed {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> std::result::Result<Seed, D::Error> {
        #[derive(Deserialize)]
        #[serde(untagged)]
        enum Written {
            Number(u64),
            Text(String),
        }
        match Written::deserialize(deserializer)? {
            Written::Number(number) => Ok(Seed(number.into())),
            Written::Text(text) => text.parse().map_err(serde::de::Error::custom),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_seed_is_read_as_it_is_written() {
        for seed in [0, 7, u64::MAX.into(), 1 << 64, u128::MAX].map(Seed) {
            assert_eq!(seed.to_string().parse(), Ok(seed));
            let json = serde_json::to_string(&seed).unwrap();
            assert_eq!(serde_json::from_str::<Seed>(&json).unwrap(), seed);
        }
        assert!("-1".parse::<Seed>().is_err() && "0x".parse::<Seed>().is_err());
    }
}
