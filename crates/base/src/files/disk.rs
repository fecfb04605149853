//! Every operation that changes the disk, one by one: what can fail, and be interrupted, at each.

use std::fs::File;
use std::io::{Result, Write};
use std::path::Path;

use self::faults::{Struck, strike};

pub(super) fn create_directory(path: &Path) -> Result<()> {
    strike()?;
    std::fs::create_dir(path)
}

/// A new file; there must be none of its name.
pub(super) fn create_file(path: &Path) -> Result<File> {
    strike()?;
    std::fs::OpenOptions::new().write(true).create_new(true).open(path)
}

/// To the end of a file, which is made if missing.
pub(super) fn open_to_append(path: &Path) -> Result<File> {
    strike()?;
    std::fs::OpenOptions::new().create(true).append(true).open(path)
}

/// Only so many bytes of a file stay.
pub(super) fn shorten(path: &Path, length: u64) -> Result<()> {
    strike()?;
    std::fs::OpenOptions::new().write(true).open(path)?.set_len(length)
}

/// All of it; of what is interrupted a part is written.
pub(super) fn write(file: &mut File, contents: &[u8]) -> Result<()> {
    match strike() {
        Ok(()) => file.write_all(contents),
        Err(Struck(error)) => {
            file.write_all(&contents[..contents.len() / 2])?;
            Err(error)
        }
    }
}

pub(super) fn sync(file: &File) -> Result<()> {
    strike()?;
    file.sync_data()
}

/// In one step; what stands at `to` is replaced, unless it is a directory with something in it.
pub(super) fn rename(from: &Path, to: &Path) -> Result<()> {
    strike()?;
    std::fs::rename(from, to)
}

/// In one step; `to` must be free.
pub(super) fn rename_to_free(from: &Path, to: &Path) -> Result<()> {
    strike()?;
    // where the file system has no such step: a link fails where something stands
    rustix::fs::renameat_with(rustix::fs::CWD, from, rustix::fs::CWD, to, rustix::fs::RenameFlags::NOREPLACE)
        .or_else(|error| match error {
            rustix::io::Errno::EXIST => Err(error.into()),
            _ => std::fs::hard_link(from, to).and_then(|()| std::fs::remove_file(from)),
        })
}

/// Two names change places in one step.
pub(super) fn exchange(a: &Path, b: &Path) -> Result<()> {
    strike()?;
    let (cwd, flags) = (rustix::fs::CWD, rustix::fs::RenameFlags::EXCHANGE);
    Ok(rustix::fs::renameat_with(cwd, a, cwd, b, flags)?)
}

/// A second name of the same file.
pub(super) fn link(from: &Path, to: &Path) -> Result<()> {
    strike()?;
    std::fs::hard_link(from, to)
}

pub(super) fn copy(from: &Path, to: &Path) -> Result<()> {
    strike()?;
    std::fs::copy(from, to).map(drop)
}

pub(super) fn remove_file(path: &Path) -> Result<()> {
    strike()?;
    std::fs::remove_file(path)
}

/// An empty one.
pub(super) fn remove_directory(path: &Path) -> Result<()> {
    strike()?;
    std::fs::remove_dir(path)
}

pub(super) fn remove_tree(path: &Path) -> Result<()> {
    strike()?;
    std::fs::remove_dir_all(path)
}

/// Faults for tests: the `n`-th operation of this thread fails, once or with all that follow.
///
/// A run that is killed leaves what is there when *everything* from some operation on fails,
/// cleaning up included. Builds with debug assertions (tests) read one from the environment too:
/// `RODCAL_FAULT="fail 7"`, or `"kill 7"`, which ends the process there.
pub mod faults {
    use std::cell::Cell;
    use std::io::Error;

    /// Whether this build reads a fault from the environment.
    pub const IN_ENVIRONMENT: bool = cfg!(debug_assertions);

    /// What goes wrong.
    #[derive(Debug, Clone, Copy, PartialEq, Eq)]
    pub enum Fault {
        /// The operation of this number fails, from 1.
        Once(usize),
        /// It fails and so does whatever follows.
        From(usize),
        /// The process ends there.
        Kill(usize),
    }

    thread_local! {
        static PLANNED: Cell<Option<Fault>> = Cell::new(of_environment());
        static DONE: Cell<usize> = const { Cell::new(0) };
    }

    /// The error of an operation that was not carried out.
    pub(super) struct Struck(pub(super) Error);

    impl From<Struck> for Error {
        fn from(struck: Struck) -> Error {
            struck.0
        }
    }

    /// Runs `job` with a fault; true where there were operations enough for it to strike.
    pub fn with<T>(fault: Fault, job: impl FnOnce() -> T) -> (T, bool) {
        let (Fault::Once(at) | Fault::From(at) | Fault::Kill(at)) = fault;
        PLANNED.set(Some(fault));
        DONE.set(0);
        let result = job();
        PLANNED.set(None);
        (result, DONE.get() >= at)
    }

    pub(super) fn strike() -> Result<(), Struck> {
        let Some(fault) = PLANNED.get() else { return Ok(()) };
        let done = DONE.get() + 1;
        DONE.set(done);
        let is_now = match fault {
            Fault::Once(at) => done == at,
            Fault::From(at) => done >= at,
            Fault::Kill(at) if done == at => std::process::exit(137),
            Fault::Kill(_) => false,
        };
        match is_now {
            true => Err(Struck(Error::other("a fault that a test asked for"))),
            false => Ok(()),
        }
    }

    fn of_environment() -> Option<Fault> {
        if !IN_ENVIRONMENT {
            return None;
        }
        let stated = std::env::var("RODCAL_FAULT").ok()?;
        let (kind, number) = stated.split_once(' ')?;
        let at = number.parse().ok()?;
        match kind {
            "fail" => Some(Fault::Once(at)),
            "kill" => Some(Fault::Kill(at)),
            _ => None,
        }
    }
}
