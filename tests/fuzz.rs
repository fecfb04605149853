//! Every reader, fed with what a file may hold after everything has gone wrong: it reads or
//! refuses, with a place inside the file, within a second, and what it has read it writes and reads
//! again.
//!
//! Two seconds within `cargo test`; a minute, or an hour, with
//! `RODCAL_FUZZ_SECONDS=3600 cargo test --test all -- fuzz::`. Input number n is the same in every
//! run, whatever the time; a failure prints n, and `RODCAL_FUZZ_FROM=n` begins there;
//! `RODCAL_FUZZ_INPUTS=N` ends after so many.

#![allow(clippy::unwrap_used)]

mod corpus;
mod mutation;
mod round_trips;

use std::panic::{AssertUnwindSafe, catch_unwind};
use std::path::Path;
use std::time::{Duration, Instant};

use rodcal::calibration::Campaign;
use rodcal::design::{DesignSpace, Search, Searched};
use rodcal::diagnosis::rig::OwnEffect;
use rodcal::files::text_of_bytes;
use rodcal::report::runs::Run;
use rodcal::rig::readings::Readings;
use rodcal::robot::{Robot, corrections_from_csv};
use rodcal::rod::Rod;
use rodcal::{Error, Result};
use rodcal_trial::answers;
use rodcal_trial::archive::Manifest;
use rodcal_trial::rig::residuals;

use self::corpus::CORPUS;
use self::mutation::mutated;

/// A reader by its name: what it says of bytes.
type Reader = (&'static str, fn(Vec<u8>) -> Result<()>);

const READERS: [Reader; 15] = [
    ("rod", |bytes| {
        let rod = Rod::from_toml("f", &text_of_bytes("f", bytes)?)?;
        let written = rod.to_toml(&[]);
        Rod::from_toml("f", &written).unwrap_or_else(|e| panic!("what was written: {e}\n{written}"));
        Ok(())
    }),
    ("robot", |bytes| {
        let robot = Robot::from_text("f", &text_of_bytes("f", bytes)?, None, None)?;
        if let Ok(written) = robot.to_toml(&[]) {
            Robot::from_text("f", &written, None, None)
                .unwrap_or_else(|e| panic!("what was written: {e}\n{written}"));
        }
        Ok(())
    }),
    ("campaign", |bytes| {
        let poses = |name: &str| match name {
            "readings.csv" => Ok(corpus::READINGS.to_owned()),
            "rod.toml" => Ok(corpus::ROD.to_owned()),
            _ => Ok(corpus::POSES.to_owned()),
        };
        Campaign::from_texts("f", &text_of_bytes("f", bytes)?, &poses).map(drop)
    }),
    ("measurements", |bytes| {
        let text = text_of_bytes("f", bytes)?;
        Campaign::from_texts("c", corpus::CAMPAIGN, &|name| match name {
            "readings.csv" => Ok(corpus::READINGS.to_owned()),
            "rod.toml" => Ok(corpus::ROD.to_owned()),
            _ => Ok(text.clone()),
        })
        .map(drop)
    }),
    ("readings", |bytes| {
        let readings = Readings::from_text("f", &text_of_bytes("f", bytes)?)?;
        let written = readings.to_csv(&[]);
        Readings::from_text("f", &written).unwrap_or_else(|e| panic!("what was written: {e}\n{written}"));
        Ok(())
    }),
    ("design", |bytes| {
        let open = |name: &str| Ok((name.to_owned(), corpus::TUBES.to_owned()));
        DesignSpace::from_toml("f", &text_of_bytes("f", bytes)?, &open).map(drop)
    }),
    ("catalogue", |bytes| {
        let text = text_of_bytes("f", bytes)?;
        DesignSpace::from_toml("d", corpus::DESIGN, &|_| Ok(("f".to_owned(), text.clone()))).map(drop)
    }),
    ("effects", |bytes| OwnEffect::from_toml("f", &text_of_bytes("f", bytes)?).map(drop)),
    ("poses", |bytes| {
        let (_, tx90) = Robot::builtin("tx90").unwrap();
        let robot = Robot::from_text("r", tx90, None, None)?;
        robot.poses_from_csv("f", &text_of_bytes("f", bytes)?).map(drop)
    }),
    ("corrections", |bytes| corrections_from_csv("f", &text_of_bytes("f", bytes)?, 6).map(drop)),
    ("result", |bytes| Run::from_text("d", "f", &text_of_bytes("f", bytes)?).map(drop)),
    ("kept search", |bytes| {
        let open = |name: &str| Ok((name.to_owned(), corpus::TUBES.to_owned()));
        let space = DesignSpace::from_toml("d", corpus::DESIGN, &open)?;
        Search::from_text(&space, Searched::All, "f", &text_of_bytes("f", bytes)?).map(drop)
    }),
    ("manifest", |bytes| in_folder("manifest.json", &bytes, |folder| Manifest::read(folder).map(drop))),
    ("answers", |bytes| in_folder("f", &bytes, |folder| answers::read(&folder.join("f")).map(drop))),
    ("residuals", |bytes| in_folder("f", &bytes, |folder| residuals::read(&folder.join("f")).map(drop))),
];

/// What takes a file alone: one with these bytes, in a folder of its own.
fn in_folder(name: &str, bytes: &[u8], read: impl Fn(&Path) -> Result<()>) -> Result<()> {
    let folder = tempfile::tempdir().unwrap();
    std::fs::write(folder.path().join(name), bytes).unwrap();
    read(folder.path())
}

/// Every reader reads an input; what is said of it lies in a file that it names.
fn read(name_of_input: &str, bytes: &[u8]) {
    let lines = bytes.iter().filter(|&&byte| byte == b'\n').count() + 1;
    for (name, read) in READERS {
        let start = Instant::now();
        let result = catch_unwind(AssertUnwindSafe(|| read(bytes.to_vec())));
        let what =
            || format!("{name_of_input} to the reader of a {name}: {}", String::from_utf8_lossy(bytes));
        let Ok(result) = result else { panic!("{}", what()) };
        assert!(start.elapsed() < Duration::from_secs(5), "{:?} for {}", start.elapsed(), what());
        if let Err(error) = result {
            let said = error.to_string();
            assert!(said.len() < 2000 && !said.contains('\u{1b}'), "{said}\n{}", what());
            if let Error::Input { at, .. } | Error::Syntax { at, .. } = &error
                && at.file == "f"
            {
                assert!(at.line <= lines + 1, "{said}\n{}", what());
            }
        }
    }
}

#[test]
fn whatever_a_file_holds_it_is_read_or_refused() {
    let number = |name: &str| std::env::var(name).ok().and_then(|text| text.parse::<u64>().ok());
    let time = Duration::from_secs(number("RODCAL_FUZZ_SECONDS").unwrap_or(1));
    let (start, mut n) = (Instant::now(), number("RODCAL_FUZZ_FROM").unwrap_or(0));
    let (first, most) = (n, number("RODCAL_FUZZ_INPUTS").unwrap_or(u64::MAX));
    while start.elapsed() < time && n - first < most {
        read(&format!("input {n}"), &mutated(&*CORPUS, n));
        n += 1;
    }
    assert!(n - first > 20, "only {} inputs", n - first);
}

/// What is a book's length in place of a word is not repeated in what is said of it.
#[test]
fn no_word_of_a_file_makes_a_message_long() {
    let long = "x".repeat(5000);
    for text in CORPUS.iter() {
        let is_end = |c: char| !c.is_alphanumeric() && c != '_';
        let mut at = 0;
        for word in text.split(is_end) {
            if !word.is_empty() {
                read("a long word", [&text[..at], &long, &text[at + word.len()..]].concat().as_bytes());
            }
            at += word.len();
            at += text[at..].chars().next().map_or(0, char::len_utf8);
        }
    }
}

/// The corpus itself is read: mutations begin at what goes deep.
#[test]
fn every_reader_reads_some_of_the_corpus() {
    for (name, read) in READERS {
        let count = CORPUS.iter().filter(|text| read(text.as_bytes().to_vec()).is_ok()).count();
        assert!(count > 0, "the reader of a {name} refuses all of it");
    }
}
