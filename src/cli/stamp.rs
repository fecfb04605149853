//! The time of a report, for those who ask for it with `--stamp`: without it the same input gives
//! the same bytes.

use std::time::{SystemTime, UNIX_EPOCH};

use rodcal::{Error, Result};

/// What states the time instead of the clock, in seconds since 1970: for builds that can be
/// repeated (reproducible-builds.org).
const STATED: &str = "SOURCE_DATE_EPOCH";
/// The last second of the year 9999.
const LAST: u64 = 253_402_300_799;

/// Now, or the time that the environment states, as "2026-05-01 09:30:00 UTC".
///
/// # Errors
/// [`Error::Argument`] where what the environment states is no time.
pub fn time() -> Result<String> {
    let seconds = match std::env::var_os(STATED) {
        Some(text) => stated(&text.to_string_lossy())?,
        None => SystemTime::now().duration_since(UNIX_EPOCH).map_or(0, |since| since.as_secs()),
    };
    Ok(written(seconds))
}

fn stated(text: &str) -> Result<u64> {
    text.parse().ok().filter(|seconds| *seconds <= LAST).ok_or_else(|| Error::Argument {
        name: STATED,
        found: format!("\"{text}\""),
        expected: format!("whole seconds since 1970, 0 to {LAST}"),
    })
}

fn written(seconds: u64) -> String {
    let (mut day, second) = (seconds / 86_400, seconds % 86_400);
    let is_leap =
        |year: u64| year.is_multiple_of(4) && (!year.is_multiple_of(100) || year.is_multiple_of(400));
    let mut year = 1970;
    while day >= 365 + u64::from(is_leap(year)) {
        day -= 365 + u64::from(is_leap(year));
        year += 1;
    }
    let february = 28 + u64::from(is_leap(year));
    let mut month = 1;
    for days in [31, february, 31, 30, 31, 30, 31, 31, 30, 31, 30] {
        if day < days {
            break;
        }
        (day, month) = (day - days, month + 1);
    }
    let (hour, minute, second) = (second / 3600, second / 60 % 60, second % 60);
    format!("{year}-{month:02}-{:02} {hour:02}:{minute:02}:{second:02} UTC", day + 1)
}

#[cfg(test)]
mod tests {
    use super::*;

    /// By `date -u -d @SECONDS`.
    #[test]
    fn seconds_are_written_as_a_date() {
        for (seconds, date) in [
            (0, "1970-01-01 00:00:00 UTC"),
            (951_782_399, "2000-02-28 23:59:59 UTC"),
            (951_868_799, "2000-02-29 23:59:59 UTC"),
            (1_767_225_599, "2025-12-31 23:59:59 UTC"),
            (4_107_542_400, "2100-03-01 00:00:00 UTC"),
            (LAST, "9999-12-31 23:59:59 UTC"),
        ] {
            assert_eq!(written(seconds), date);
        }
    }

    #[test]
    fn what_is_no_time_is_refused() {
        assert!(stated("1767225599").is_ok());
        for text in ["", "-1", "today", "253402300800"] {
            assert!(stated(text).is_err(), "{text}");
        }
    }
}
